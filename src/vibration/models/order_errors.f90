!> Error of a model due to the finite order of its polynomials, estimated from the next orders.
module order_errors
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t
  use eigenvalue_gaps, only: relative_error
  use kinds, only: wp
  use next_orders, only: smooth_functions
  use order_changes, only: find_order_changes, order_change_t, part_count, part_of
  use position_equations, only: position_equations_t
  implicit none (type, external)
  private

  public :: order_error, with_modes_above

  !> Safety factors of the estimated change by all higher orders.
  real(wp), parameter :: order_margin = 1.5_wp       !! as a rule
  real(wp), parameter :: rough_margin = 4.0_wp       !! where the change is above `rough_change`
  real(wp), parameter :: indefinite_margin = 16.0_wp !! where the matrix of the next orders is not
                                                     !! definite: orders are far too low, as in a
                                                     !! link compressed far beyond buckling

  !> A greater relative change is not small beside the distances of eigenvalues.
  real(wp), parameter :: rough_change = 1.0e-4_wp

  !> What a pair of orders changes is a share of what the pair before does. The orders beyond are
  !! taken for a geometric series of this ratio, which is limited to `most_ratio`.
  real(wp), parameter :: most_ratio = 0.95_wp

  !> Limit of the share of a change that the orders in use add by yielding.
  real(wp), parameter :: most_echo = 0.75_wp

  !> A piece that is pulled bends in layers exp(−κx) at its ends, of which order p leaves some
  !! exp(−p²/κL). Where that is not little all orders in use yield to the next ones, by more than
  !! the echo tells. The margin that this needs, measured on wires, is 0.04 κL/p.
  real(wp), parameter :: layer_margin = 0.1_wp

contains

  !> Estimated relative error of every eigenvalue due to the finite polynomial order, part by part:
  !! the pieces of every link across, then along.
  pure function order_error(model, equations, force, found, modes) result(error)
    type(deformation_model_t), intent(in) :: model !! of continuous links
    type(position_equations_t), intent(in) :: equations !! of this position: chords, M
    real(wp), intent(in) :: force(:, :)            !! (force functions, bodies) at this speed [N]
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    integer, intent(in) :: modes                   !! number, lowest first
    real(wp) :: error(part_count(model%links), modes) !! (parts, modes) of eigenvalues

    type(order_change_t) :: change(size(error, 1), modes)
    real(wp) :: margin(size(error, 1))
    integer :: i

    call find_order_changes(model%links, model%layout, equations%chords, &
      equations%pencil%mass%border, force, found%vector(:, :modes), found%lambda(:modes), change)
    margin = layer_margins(model, force, size(margin))
    error(:, :min(found%zeros, modes)) = 0.0_wp
    do i = found%zeros + 1, modes
      error(:, i) = relative_error(margin*remainder(change(:, i)), found%lambda(i))
      if (any(.not. change(:, i)%definite)) then
        error(:, i) = indefinite_margin*error(:, i)
      else if (sum(error(:, i)) >= rough_change) then
        error(:, i) = rough_margin*error(:, i)
      end if
    end do
  end function order_error

  !> What the error of each part is multiplied by because its layers are thin: 1 in most.
  pure function layer_margins(model, force, parts) result(margin)
    type(deformation_model_t), intent(in) :: model !! of continuous links
    real(wp), intent(in) :: force(:, :)  !! (1, ξ, ξ², jumps; bodies) axial forces [N], or none
    integer, intent(in) :: parts         !! number
    real(wp) :: margin(parts)

    real(wp) :: tension, layers
    integer :: b, e, part

    margin = 1.0_wp
    if (size(force, 1) == 0) return
    do b = 1, size(model%links)
      associate (link => model%links(b), next => model%links(b)%next)
        do e = 1, next%pieces
          ! A bound of the parabola from 0 to 1.
          tension = force(1, b) + sum(force(smooth_functions + 1:size(next%reached, 2) + &
            smooth_functions, b), mask=next%reached(e, :)) + max(0.0_wp, force(2, b)) + &
            max(0.0_wp, force(3, b))
          if (tension <= 0.0_wp) cycle
          layers = sqrt(tension/link%bending_stiffness)*link%bending_shapes%length* &
            link%bending_shapes%part(e)/link%bending_shapes%elements
          part = part_of(model%links, b, e, .false.)
          margin(part) = max(1.0_wp, layer_margin*layers/model%degrees(b)%across(e))
        end do
      end associate
    end do
  end function layer_margins

  !> Errors of the lowest modes, each at least as large as the distance by which a mode above it may
  !! fall below it: with more orders modes change their places.
  !!
  !! Where eigenvalues are so near that the next orders mix their modes, the lower one falls to the
  !! lesser eigenvalue of `[λ_i − c_i, √(c_i c_j); √(c_i c_j), λ_j − c_j]` at most, with c what
  !! orders change each by itself. Below free motions at rest nothing falls.
  pure function with_modes_above(lambda, error, modes, zeros) result(whole)
    real(wp), intent(in) :: lambda(:) !! (modes found) ascending [1/s²]
    real(wp), intent(in) :: error(:)  !! (modes, and those near above them) relative
    integer, intent(in) :: modes      !! number, lowest first
    integer, intent(in), optional :: zeros !! free motions at rest, the first modes; absent: none
    real(wp) :: whole(modes)

    real(wp) :: change(size(error)), least, apart, mixed
    integer :: i, j, first

    change = abs(lambda(:size(error)))*error
    first = 1
    if (present(zeros)) first = zeros + 1
    whole(:min(first - 1, modes)) = 0.0_wp
    do i = first, modes
      least = lambda(i) - change(i)
      do j = i + 1, size(error)
        apart = 0.5_wp*((lambda(j) - change(j)) - (lambda(i) - change(i)))
        ! The lesser eigenvalue, written so that small changes are not lost beside λ, nor λ_i beside
        ! a λ_j of many times its size.
        mixed = sqrt(apart**2 + change(i)*change(j))
        if (apart > 0.0_wp) then
          least = min(least, lambda(i) - change(i) - change(i)*change(j)/(apart + mixed))
        else
          least = min(least, lambda(i) - change(i) + apart - mixed)
        end if
      end do
      whole(i) = max(error(i), relative_error(lambda(i) - least, lambda(i)))
    end do
  end function with_modes_above

  !> The change by the next orders and, as a geometric series, by all beyond them, with a margin.
  elemental function remainder(change)
    type(order_change_t), intent(in) :: change
    real(wp) :: remainder !! [1/s²]

    real(wp) :: ratio, last, echo

    last = max(0.0_wp, change%all - change%near)
    ratio = min(last/max(change%near, tiny(last)), most_ratio)
    ! The orders in use yield, what they do acts on the next again, and so on.
    echo = min(change%echo/max(change%all, tiny(echo)), most_echo)
    remainder = order_margin*(change%all + last*ratio/(1.0_wp - ratio))/(1.0_wp - echo)**2
  end function remainder

end module order_errors
