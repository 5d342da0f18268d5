!> Elements in global axes.
module element_axes
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: turned_to_global, to_local

contains

  !> An element matrix in the global axes: `Tᵀ A T`, T made of the transpose of (2.75) at either
  !! node. Bubbles do not turn.
  pure function turned_to_global(matrix, direction) result(turned)
    real(wp), intent(in) :: matrix(:, :)
    real(wp), intent(in) :: direction(2) !! unit vector along the element
    real(wp) :: turned(size(matrix, 1), size(matrix, 2))

    real(wp) :: t(2, 2)
    integer :: first(2), k

    t = rotation(direction)
    first = first_of_nodes(size(matrix, 1))
    turned = matrix
    do k = 1, 2
      turned(:, first(k):first(k) + 1) = matmul(turned(:, first(k):first(k) + 1), t)
    end do
    do k = 1, 2
      turned(first(k):first(k) + 1, :) = matmul(transpose(t), turned(first(k):first(k) + 1, :))
    end do
  end function turned_to_global

  !> Unknowns of an element with nodal displacements in global axes, seen in the element's own.
  pure function to_local(displacement, direction) result(local)
    real(wp), intent(in) :: displacement(:)
    real(wp), intent(in) :: direction(2)
    real(wp) :: local(size(displacement))

    integer :: first(2), k

    first = first_of_nodes(size(displacement))
    local = displacement
    do k = 1, 2
      local(first(k):first(k) + 1) = matmul(rotation(direction), &
        displacement(first(k):first(k) + 1))
    end do
  end function to_local

  !> Where the displacements of either node stand among the unknowns of an element.
  pure function first_of_nodes(unknowns) result(first)
    integer, intent(in) :: unknowns
    integer :: first(2)

    first = [1, unknowns - 2]
  end function first_of_nodes

  pure function rotation(direction) result(t)
    real(wp), intent(in) :: direction(2)
    real(wp) :: t(2, 2)

    t = reshape([direction(1), -direction(2), direction(2), direction(1)], [2, 2])
  end function rotation

end module element_axes
