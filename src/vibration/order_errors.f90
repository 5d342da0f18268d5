!> Error of a model due to the finite order of its polynomials, estimated from the next orders.
module order_errors
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use order_changes, only: find_order_changes, order_change_t, part_count
  use pin_displacements, only: chords_t
  implicit none (type, external)
  private

  public :: order_error

  !> The change made by the next orders, and what their series leaves, is multiplied by
  !! `order_margin`. Where the change of the eigenvalue is above `rough_change`, the order may be far
  !! too low (a link compressed so hard that it buckles many times over), and `rough_margin` is used
  !! instead.
  real(wp), parameter :: order_margin = 1.5_wp, rough_margin = 16.0_wp, rough_change = 1.0e-5_wp

  !> What a pair of orders changes is a share of what the pair before does. The orders beyond are
  !! taken for a geometric series of this ratio, which is limited to `most_ratio`.
  real(wp), parameter :: most_ratio = 0.95_wp

contains

  !> Estimated relative error of every eigenvalue due to the finite polynomial order, part by part:
  !! the pieces of every link across, then along.
  pure function order_error(model, chords, force, found, modes) result(error)
    type(deformation_model_t), intent(in) :: model !! of continuous links
    type(chords_t), intent(in) :: chords           !! at this position
    real(wp), intent(in) :: force(:, :)            !! (force functions, bodies) at this speed [N]
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    integer, intent(in) :: modes                   !! number, lowest first
    real(wp) :: error(part_count(model%links), modes) !! (parts, modes) of eigenvalues

    type(order_change_t) :: change(size(error, 1), modes)
    integer :: i

    call find_order_changes(model%links, model%layout, chords, force, found%vector(:, :modes), &
      found%lambda(:modes), change)
    do i = 1, modes
      error(:, i) = remainder(change(:, i))/max(abs(found%lambda(i)), tiny(1.0_wp))
      error(:, i) = merge(rough_margin, order_margin, sum(error(:, i)) >= rough_change .or. &
        any(.not. change(:, i)%definite))*error(:, i)
    end do
  end function order_error

  !> The change by the next orders and, as a geometric series, by all beyond them.
  elemental function remainder(change)
    type(order_change_t), intent(in) :: change
    real(wp) :: remainder !! [1/s²]

    real(wp) :: ratio, last

    last = max(0.0_wp, change%all - change%near)
    ratio = min(last/max(change%near, tiny(last)), most_ratio)
    remainder = change%all + last*ratio/(1.0_wp - ratio)
  end function remainder

end module order_errors
