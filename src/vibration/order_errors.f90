!> What the polynomials of a model leave out: estimated from the next two orders.
module order_errors
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use pin_displacements, only: chords_t
  use reduced_assembly, only: next_order_change
  implicit none (type, external)
  private

  public :: order_error

  !> What the next two orders leave to all the others that follow: the change they make is
  !! multiplied by this. Where it is not small, orders may be far from enough (a link pressed so
  !! hard that it buckles many times over), and more is left.
  real(wp), parameter :: order_margin = 1.5_wp, rough_margin = 16.0_wp, rough_change = 1.0e-5_wp

  !> Where a link is pulled so hard that it bends at its ends only, the change falls slowly from
  !! order to order: what is left is the sum of a geometric series, times this; and the ratio of two
  !! pairs of orders is not taken for more than the second number.
  real(wp), parameter :: series_margin = 1.25_wp, most_ratio = 0.95_wp

contains

  !> Relative error of every eigenvalue because the polynomials end at their order, link by link.
  pure function order_error(model, chords, force, found, modes) result(error)
    type(deformation_model_t), intent(in) :: model
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: force(:, :) !! (force functions, bodies) at this speed [N]
    type(bordered_modes_t), intent(in) :: found
    integer, intent(in) :: modes
    real(wp) :: error(size(model%links), modes)

    real(wp) :: change(size(model%links)), ratio
    integer :: b, i

    do i = 1, modes
      change = next_order_change(model%links, model%layout, chords, force, found%vector(:, i), &
        found%lambda(i))
      error(:, i) = change/max(abs(found%lambda(i)), tiny(1.0_wp))
      if (sum(error(:, i)) >= rough_change) then
        error(:, i) = rough_margin*error(:, i)
        cycle
      end if
      do b = 1, size(change)
        ratio = change(b)/max(last_order_energy(model, chords, found%vector(:, i), b), tiny(ratio))
        error(b, i) = max(order_margin, series_margin/(1.0_wp - min(ratio, most_ratio)))*error(b, i)
      end do
    end do
  end function order_error

  !> Elastic energy that a mode has in the last two orders of a link, doubled: what the change by
  !! the next two is compared with.
  pure function last_order_energy(model, chords, vector, b) result(energy)
    type(deformation_model_t), intent(in) :: model
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: vector(:) !! (unknowns) mode with yᵀMy = 1
    integer, intent(in) :: b          !! number of the body
    real(wp) :: energy                !! [1/s²]

    integer :: first, k, n, last

    associate (link => model%links(b))
      first = model%layout%first(b)
      n = size(link%bending, 1)
      ! With shear every order has a curvature and a shear strain, in every element.
      last = merge(4, 2, link%bending_shapes%shear_stiffness > 0.0_wp)*link%bending_shapes%elements
      energy = 0.0_wp
      do k = max(1, n + 1 - last), n
        energy = energy + &
          (dot_product(chords%across(3, :, b), vector(:model%layout%border))*link%bending(k, 0) + &
          dot_product(link%bending(k, 1:), vector(first:first + link%modes - 1)))**2
      end do
    end associate
  end function last_order_energy

end module order_errors
