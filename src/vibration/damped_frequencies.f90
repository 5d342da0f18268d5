!> Frequencies and damping ratios of a linkage with dampers at one position and speed.
module damped_frequencies
  use axial_forces, only: total_force
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_pencil, only: elastic_squares
  use damped_eigensolver, only: damped_modes_t, find_damped_modes
  use damped_solver, only: mass_times_complex
  use deformation_model, only: deformation_model_t
  use errors, only: error_t
  use kinds, only: wp
  use load_sizes, only: axial_sizes, second_order_work
  use matrix_rounding, only: find_matrix_errors
  use order_errors, only: order_error
  use pose_rounding, only: pose_error
  use position_equations, only: set_speed
  use position_results, only: largest_error, position_result_t, position_work_t
  use positions, only: state_t
  use structures, only: structure_t
  use vibration_models, only: mode_request_t, modes_with_dampers
  implicit none (type, external)
  private

  public :: modes_for_dampers, solve_damped_speed, whole_change

  !> Errors of eigenvalues of which those of roots are made, relative.
  type :: root_errors_t
    real(wp), allocatable :: orders(:), rounding(:), of_matrices(:) !! (roots)
  end type root_errors_t

contains

  !> Number of undamped modes that are looked for: with dampers, more than are wanted.
  pure function modes_for_dampers(structure, model, wanted) result(modes)
    type(structure_t), intent(in) :: structure     !! with beams
    type(deformation_model_t), intent(in) :: model !! of its parts
    integer, intent(in) :: wanted                  !! roots
    integer :: modes

    modes = min(modes_with_dampers(structure, wanted), max(wanted, model%layout%unknowns))
  end function modes_for_dampers

  !> Solves `(s² M + s C + K + K_G) y = 0` at a speed, with `C = Σ c b bᵀ`, b the velocity of a
  !! damper for unit velocities of the border, from the modes without dampers.
  !!
  !! To first order an error of the matrices changes a root by
  !! `Δs = −yᵀ(s² ΔM + s ΔC + ΔK) y/yᵀ(2sM + C)y`. The numerator is bounded by errors of modes
  !! without dampers: the real and the imaginary part of y are taken for modes of λ = |s|², under
  !! loads also of −|s|², and their estimated errors are added.
  !!
  !! Errors, in `result%outcome`: those of `find_damped_modes`.
  subroutine solve_damped_speed(structure, state, request, speed, work, result)
    type(structure_t), intent(in) :: structure     !! with dampers
    type(state_t), intent(in) :: state             !! with a pose
    type(mode_request_t), intent(in) :: request
    integer, intent(in) :: speed                   !! number
    type(position_work_t), intent(inout) :: work   !! with the equations of this position, and
                                                   !! `modes_for_dampers` at least without dampers
    type(position_result_t), intent(inout) :: result !! of this speed

    type(damped_modes_t) :: found
    type(bordered_modes_t) :: parts
    type(root_errors_t) :: errors, more
    type(error_t), allocatable :: error
    real(wp), allocatable :: own(:), rate(:), gain(:)
    real(wp) :: size_of
    integer :: i, modes

    associate (equations => work%continuum%equations, dampers => structure%elastic%dampers)
      call set_speed(equations, work%factor(:, speed))
      call find_damped_modes(equations%pencil, work%here%damper_rows, dampers%damping, &
        request%modes, work%continuum%found(speed), modes_for_dampers(structure, &
        work%here%model, request%modes), found, error)
    end associate
    result%counts%factorizations = result%counts%factorizations + found%solutions
    if (allocated(error)) then
      call move_alloc(error, result%outcome(speed)%error)
      return
    end if
    result%counts%proofs = result%counts%proofs + 1
    modes = size(found%s)
    parts = parts_of_roots(found, 1.0_wp)
    call find_errors(structure, state, speed, parts, work, result, errors)
    if (work%continuum%equations%pencil%loaded) then
      parts = parts_of_roots(found, -1.0_wp)
      call find_errors(structure, state, speed, parts, work, result, more)
      errors%orders = max(errors%orders, more%orders)
      errors%rounding = max(errors%rounding, more%rounding)
      errors%of_matrices = max(errors%of_matrices, more%of_matrices)
    end if
    call find_slopes(work, structure%elastic%dampers%damping, found, gain, rate)
    ! Dampers move otherwise with the position, too: |s| yᴴCy is at most |s|² yᴴMy + yᴴKy, of which
    ! the rest of this error is a share.
    errors%rounding = 2.0_wp*errors%rounding
    allocate (own(modes))
    do i = 1, modes
      size_of = abs(found%s(i))
      own(i) = 0.0_wp
      if (.not. size_of > 0.0_wp) cycle
      own(i) = whole_change(gain(i)*size_of*(errors%orders(i) + errors%rounding(i) + &
        errors%of_matrices(i)), distance_from_others(found, i))/size_of + found%error(i)
    end do
    own(:request%modes) = with_roots_above(abs(found%s), own, request%modes)
    do i = 1, request%modes
      associate (s => found%s(i), lambda => result%lambda(i, speed), &
          ratio => result%damping(i, speed))
        lambda = abs(s)**2
        if (.not. lambda > 0.0_wp) cycle
        if (found%swings(i)) then
          ! −Re s is ½ yᴴCy, with all digits of a small one.
          ratio = min(0.5_wp*rate(i), 1.0_wp)
        else
          ratio = sign(1.0_wp, -real(s, wp))
          ! As the eigenvalue of a mode that grows without swinging.
          if (ratio < 0.0_wp) lambda = -lambda
        end if
      end associate
    end do
    result%error(:, speed) = own(:request%modes)
    result%order_error = max(result%order_error, maxval(2.0_wp*gain(:request%modes)* &
      errors%orders(:request%modes)))
    if (maxval(result%error(:, speed)) > request%accuracy) result%cause(speed) = &
      largest_error(errors%orders(:request%modes), errors%rounding(:request%modes), &
      errors%of_matrices(:request%modes) + found%error(:request%modes), &
      elastic_squares(work%here%model%layout, real(found%vector(:, :request%modes), wp)) + &
      elastic_squares(work%here%model%layout, aimag(found%vector(:, :request%modes))), &
      abs(found%s(:request%modes))**2)
  end subroutine solve_damped_speed

  !> Real and imaginary parts of the vectors of all roots, two after each other, as modes of ±|s|².
  pure function parts_of_roots(found, sense) result(parts)
    type(damped_modes_t), intent(in) :: found
    real(wp), intent(in) :: sense !! ±1
    type(bordered_modes_t) :: parts

    integer :: i

    allocate (parts%lambda(2*size(found%s)), parts%vector(size(found%vector, 1), 2*size(found%s)))
    do i = 1, size(found%s)
      parts%lambda(2*i - 1:2*i) = sense*abs(found%s(i))**2
      parts%vector(:, 2*i - 1) = real(found%vector(:, i), wp)
      parts%vector(:, 2*i) = aimag(found%vector(:, i))
    end do
    parts%zeros = 2*count(.not. abs(found%s) > 0.0_wp)
    parts%near = size(parts%lambda)
  end function parts_of_roots

  !> Relative errors of these eigenvalues, both parts together.
  subroutine find_errors(structure, state, speed, parts, work, result, errors)
    type(structure_t), intent(in) :: structure
    type(state_t), intent(in) :: state
    integer, intent(in) :: speed
    type(bordered_modes_t), intent(in) :: parts
    type(position_work_t), intent(in) :: work
    type(position_result_t), intent(inout) :: result
    type(root_errors_t), intent(out) :: errors

    real(wp), dimension(size(parts%lambda)) :: of_orders, of_pose, of_entries, load_work
    integer :: n

    n = size(parts%lambda)
    associate (factor => work%factor(:, speed), equations => work%continuum%equations, &
        model => work%here%model)
      of_orders = sum(order_error(model, equations, total_force(work%here%unit_force, factor), &
        parts, n), dim=1)
      call find_matrix_errors(model, equations%chords, axial_sizes(work%here, factor), parts, n, &
        of_entries, load_work)
      load_work = load_work + second_order_work(work%here, factor, parts, n)
      call pose_error(structure, state, speed, work, load_work, parts, of_pose, result%counts)
    end associate
    errors%orders = of_orders(1::2) + of_orders(2::2)
    errors%rounding = of_pose(1::2) + of_pose(2::2)
    errors%of_matrices = of_entries(1::2) + of_entries(2::2)
  end subroutine find_errors

  !> `|s|/|yᵀ(2sM + C)y|`, ½ where a mode swings with little damping, and `yᴴCy/|s|`.
  pure subroutine find_slopes(work, constant, found, gain, rate)
    type(position_work_t), intent(in) :: work
    real(wp), intent(in) :: constant(:) !! (dampers)
    type(damped_modes_t), intent(in) :: found
    real(wp), allocatable, intent(out) :: gain(:), rate(:) !! (roots) [-]

    complex(wp) :: told(size(constant)), slope
    integer :: i, n

    n = size(work%here%damper_rows, 1)
    allocate (gain(size(found%s)), rate(size(found%s)), source=0.0_wp)
    do i = 1, size(found%s)
      associate (s => found%s(i), y => found%vector(:, i))
        if (.not. abs(s) > 0.0_wp) cycle
        told = matmul(y(:n), work%here%damper_rows)
        slope = 2.0_wp*s*sum(y*mass_times_complex(work%continuum%equations%pencil, y)) + &
          sum(constant*told**2)
        gain(i) = abs(s)/max(abs(slope), tiny(1.0_wp))
        rate(i) = sum(constant*abs(told)**2)/abs(s)
      end associate
    end do
  end subroutine find_slopes

  !> What a change to first order comes to with another root at a distance: at worst a root of
  !! `Δs² + δ Δs = δ first`, of roots that are nearly double about its square root.
  elemental function whole_change(first, distance) result(change)
    real(wp), intent(in) :: first    !! not negative [1/s]
    real(wp), intent(in) :: distance !! δ > 0 [1/s]
    real(wp) :: change               !! [1/s]

    if (4.0_wp*first <= distance) then
      change = 2.0_wp*first/(1.0_wp + sqrt(1.0_wp - 4.0_wp*first/distance))
    else
      change = 0.5_wp*(distance + sqrt(distance**2 + 4.0_wp*first*distance))
    end if
  end function whole_change

  !> Distance of a root from the nearest other, or from what is not known.
  pure function distance_from_others(found, i) result(distance)
    type(damped_modes_t), intent(in) :: found
    integer, intent(in) :: i
    real(wp) :: distance

    integer :: j

    associate (s => found%s)
      distance = found%radius - abs(s(i))
      do j = 1, size(s)
        if (j /= i) distance = min(distance, abs(s(j) - s(i)))
        if (found%swings(j)) distance = min(distance, abs(conjg(s(j)) - s(i)))
      end do
      distance = max(distance, epsilon(1.0_wp)*abs(s(i)))
    end associate
  end function distance_from_others

  !> Errors of the lowest roots, each at least as large as the distance by which a root above it may
  !! fall below it.
  pure function with_roots_above(size_of, error, modes) result(whole)
    real(wp), intent(in) :: size_of(:) !! (roots) |s| ascending [1/s]
    real(wp), intent(in) :: error(:)   !! (roots) relative
    integer, intent(in) :: modes       !! number, lowest first
    real(wp) :: whole(modes)

    integer :: i, j

    whole = error(:modes)
    do i = 1, modes
      if (.not. size_of(i) > 0.0_wp) cycle
      do j = i + 1, size(error)
        whole(i) = max(whole(i), 1.0_wp - size_of(j)*(1.0_wp - error(j))/size_of(i))
      end do
    end do
  end function with_roots_above

end module damped_frequencies
