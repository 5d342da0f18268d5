!> How much the next polynomial orders would lower an eigenvalue, piece by piece of every link.
!!
!! With r the residual of a mode in the equations of the unknowns of these orders, and C their
!! matrix `K + K_G − λ M`, the eigenvalue falls by `rᵀ C⁻¹ r` as long as that is little. The unknowns of
!! one piece are not coupled with those of another.
module order_changes
  use bordered_matrix, only: layout_t
  use kinds, only: wp
  use link_modes, only: clamp, link_modes_t, rigid
  use next_orders, only: next_orders_t, smooth_functions
  use pin_displacements, only: chords_t
  use reduced_assembly, only: first_axial
  implicit none (type, external)
  private

  public :: order_change_t, part_count, part_of, find_order_changes

  !> The change of an eigenvalue by the next orders in one part: a piece, along or across.
  type :: order_change_t
    real(wp) :: near = 0.0_wp   !! by the first half of these orders [1/s²]
    real(wp) :: all = 0.0_wp    !! by all of them [1/s²]
    logical :: definite = .true. !! C is positive definite; if not, the orders are far too low, and
                                 !! the changes are magnitudes only
  end type order_change_t

contains

  !> Number of parts of all links: every piece across, then every piece along, link by link.
  pure function part_count(links) result(count)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    integer :: count

    count = sum(links%next%pieces + links%axial_next%pieces)
  end function part_count

  !> Number of a part.
  pure function part_of(links, body, piece, along) result(part)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    integer, intent(in) :: body, piece         !! numbers
    logical, intent(in) :: along               !! the axial displacement
    integer :: part

    part = sum(links(:body - 1)%next%pieces + links(:body - 1)%axial_next%pieces) + piece
    if (along) part = part + links(body)%next%pieces
  end function part_of

  !> The changes of some eigenvalues by the next orders.
  pure subroutine find_order_changes(links, layout, chords, force, vectors, lambda, change)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(layout_t), intent(in) :: layout       !! of these links
    type(chords_t), intent(in) :: chords       !! of this position
    real(wp), intent(in) :: force(:, :)        !! (force functions, bodies) at this speed; no
                                               !! functions: static [N]
    real(wp), intent(in) :: vectors(:, :)      !! (unknowns, modes) with yᵀMy = 1
    real(wp), intent(in) :: lambda(:)          !! (modes) their eigenvalues [1/s²]
    type(order_change_t), intent(out) :: change(:, :) !! (parts, modes)

    real(wp) :: ends(3), turn
    integer :: b, e, i, k, first, last, axial, part, low, high

    part = 0
    do b = 1, size(links)
      associate (link => links(b), next => links(b)%next)
        first = layout%first(b)
        last = first + link%modes - 1
        do e = 1, next%pieces
          part = part + 1
          low = (e - 1)*next%number + 1
          high = e*next%number
          block
            real(wp) :: residual(next%number), slopes(2 + link%modes, merge(next%number, 0, &
              size(force, 1) > 0)), square(next%number, next%number), matrix(next%number, &
              next%number)

            square = 0.0_wp
            if (size(force, 1) > 0) call weigh(next, e, force(:, b), low, high, slopes, square)
            do i = 1, size(lambda)
              associate (border => vectors(:layout%border, i), own => vectors(first:last, i))
                do k = 1, 3
                  ends(k) = dot_product(chords%across(k, :, b), border)
                end do
                do k = 1, next%number
                  residual(k) = -lambda(i)*(dot_product(ends, next%participation(:, low + k - 1)) + &
                    dot_product(own, next%mass(:, low + k - 1)))
                end do
                if (size(force, 1) > 0) then
                  turn = dot_product(chords%turn(:, b), border)
                  do k = 1, next%number
                    residual(k) = residual(k) + turn*slopes(rigid, k) + ends(3)*slopes(clamp, k) + &
                      dot_product(own, slopes(clamp + 1:, k))
                  end do
                end if
              end associate
              matrix = square - lambda(i)*next%mass_square(:, :, e)
              call eliminate(matrix, residual, change(part, i))
            end do
          end block
        end do
      end associate
      associate (next => links(b)%axial_next)
        axial = first_axial(layout, links, b)
        last = axial + links(b)%axial_modes - 1
        do e = 1, next%pieces
          part = part + 1
          low = (e - 1)*next%number + 1
          block
            real(wp) :: residual(next%number), matrix(next%number, next%number)

            do i = 1, size(lambda)
              associate (border => vectors(:layout%border, i), own => vectors(axial:last, i))
                do k = 1, 2
                  ends(k) = dot_product(chords%along(k, :, b), border)
                end do
                do k = 1, next%number
                  residual(k) = -lambda(i)*(dot_product(ends(1:2), next%participation(:, low + k - &
                    1)) + dot_product(own, next%mass(:, low + k - 1)))
                end do
              end associate
              matrix = -lambda(i)*next%mass_square(:, :, e)
              call eliminate(matrix, residual, change(part, i))
            end do
          end block
        end do
      end associate
    end do
  end subroutine find_order_changes

  !> The geometric stiffness of a piece's unknowns at the present axial forces, with the own modes
  !! and with each other.
  pure subroutine weigh(next, piece, force, low, high, slopes, square)
    type(next_orders_t), intent(in) :: next
    integer, intent(in) :: piece
    real(wp), intent(in) :: force(:) !! 1, ξ, ξ², jumps [N]
    integer, intent(in) :: low, high !! numbers of its unknowns
    real(wp), intent(out) :: slopes(:, :)
    real(wp), intent(out) :: square(:, :)

    real(wp) :: smooth(smooth_functions)
    integer :: j

    smooth = force(:smooth_functions)
    do j = 1, size(next%reached, 2)
      if (next%reached(piece, j)) smooth(1) = smooth(1) + force(smooth_functions + j)
    end do
    slopes = smooth(1)*next%geometric(:, low:high, 1)
    square = smooth(1)*next%geometric_square(:, :, piece, 1)
    do j = 2, smooth_functions
      slopes = slopes + smooth(j)*next%geometric(:, low:high, j)
      square = square + smooth(j)*next%geometric_square(:, :, piece, j)
    end do
  end subroutine weigh

  !> `rᵀ C⁻¹ r`, by elimination: of the first half of the unknowns, and of all.
  pure subroutine eliminate(matrix, residual, change)
    real(wp), intent(inout) :: matrix(:, :)  !! C less the unit matrix; destroyed
    real(wp), intent(inout) :: residual(:)   !! r; destroyed
    type(order_change_t), intent(out) :: change

    !> Pivots below this are not trusted: the eigenvalue is near, or above, those of the new
    !! unknowns alone.
    real(wp), parameter :: least_pivot = 0.1_wp
    real(wp) :: pivot, factor
    integer :: i, j, k, n

    n = size(residual)
    do k = 1, n
      pivot = 1.0_wp + matrix(k, k)
      if (pivot < least_pivot) then
        change%definite = .false.
        pivot = max(abs(pivot), least_pivot)
      end if
      change%all = change%all + residual(k)**2/pivot
      if (2*k <= n) change%near = change%all
      do j = k + 1, n
        factor = matrix(j, k)/pivot
        residual(j) = residual(j) - factor*residual(k)
        do i = j, n
          matrix(i, j) = matrix(i, j) - factor*matrix(i, k)
        end do
      end do
    end do
  end subroutine eliminate

end module order_changes
