!> Sorting of real numbers.
module sorting
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: ascending_order

contains

  !> The permutation that sorts `values` in ascending order, by merge sort; equal values keep their
  !! order.
  pure function ascending_order(values) result(order)
    real(wp), intent(in) :: values(:) !! to be sorted
    integer :: order(size(values))

    integer :: merged(size(values)), i, width, first, middle, last, left, right, k
    logical :: take_left

    order = [(i, i=1, size(values))]
    ! Most lists are already sorted.
    if (all(values(2:) >= values(:size(values) - 1))) return
    width = 1
    do while (width < size(values))
      do first = 1, size(values), 2*width
        middle = min(first + width, size(values) + 1)
        last = min(first + 2*width, size(values) + 1)
        left = first
        right = middle
        do k = first, last - 1
          take_left = left < middle
          if (take_left .and. right < last) take_left = values(order(left)) <= values(order(right))
          if (take_left) then
            merged(k) = order(left)
            left = left + 1
          else
            merged(k) = order(right)
            right = right + 1
          end if
        end do
      end do
      order = merged
      width = 2*width
    end do
  end function ascending_order

end module sorting
