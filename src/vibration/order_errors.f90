!> Error of a model due to the finite order of its polynomials, estimated from the next orders.
module order_errors
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use pin_displacements, only: chords_t
  use reduced_assembly, only: next_order_change
  implicit none (type, external)
  private

  public :: order_error

  !> The change made by the next orders is multiplied by `order_margin`, for all orders beyond them.
  !! Where the change is above `rough_change`, the order may be far too low (a link compressed so
  !! hard that it buckles many times over), and `rough_margin` is used instead.
  real(wp), parameter :: order_margin = 1.5_wp, rough_margin = 16.0_wp, rough_change = 1.0e-5_wp

  !> Where a link is pulled so hard that it bends only at its ends, the change falls slowly from
  !! order to order. The remainder is then the sum of a geometric series times `series_margin`. The
  !! ratio of the series, between one pair of orders and the next, is limited to `most_ratio`.
  real(wp), parameter :: series_margin = 1.25_wp, most_ratio = 0.95_wp

contains

  !> Estimated relative error of every eigenvalue due to the finite polynomial order, link by link.
  pure function order_error(model, chords, force, found, modes) result(error)
    type(deformation_model_t), intent(in) :: model !! of continuous links
    type(chords_t), intent(in) :: chords           !! at this position
    real(wp), intent(in) :: force(:, :)            !! (force functions, bodies) at this speed [N]
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    integer, intent(in) :: modes                   !! number, lowest first
    real(wp) :: error(size(model%links), modes)    !! (bodies, modes) of eigenvalues

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

  !> Twice the elastic energy of a mode in the last two orders of a link. The change by the next two
  !! is compared with it.
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
      ! With shear, every order has a curvature and a shear strain in every element.
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
