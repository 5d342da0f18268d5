!> Kinematic coefficients of the links at a pose. Found once, they hold for every speed and
!! acceleration of the crank.
!!
!! Without a crank, or with a driven slider, θ2 is the coordinate of the first drive, an angle in
!! radians or a length. With `h = dθ/dθ2` and `h' = d²θ/dθ2²` every angular velocity is `h ω2` and
!! every angular acceleration `h α2 + h' ω2²`; the same holds for points. Setting ω2 = 1 and α2 = 0
!! in (2.22) and (2.23), (2.35) to (2.38) of Ulker (2010) gives h and h'.
!!
!! Of a linkage that runs in time all derivatives are with respect to the time: h is the angular
!! velocity, h' the angular acceleration of the true motion of all drives, and ω2 = 1, α2 = 0.
module kinematic_coefficients
  use coordinate_types, only: partial_t
  use coordinates, only: coordinate_acceleration
  use dense_factor, only: solve
  use drive_values, only: find_rates_of_drives
  use group_factors, only: factorize_group, group_factors_t
  use kinds, only: wp
  use linkages, only: demand_drive, group_t, group_carried, group_dyad, linkage_t, normal_to
  use pose_types, only: arm_to_pin, kinematic_coefficients_t
  use poses, only: arm_to_middle, pose_t
  implicit none (type, external)
  private

  public :: kinematic_coefficients_t, find_kinematic_coefficients, find_velocities, &
    angular_velocity, &
    angular_acceleration

contains

  !> Kinematic coefficients of all bodies and pins, group by group.
  !!
  !! With rates of its drives, which then need not follow the first one: velocities, and
  !! accelerations without any of the drives.
  pure function find_kinematic_coefficients(linkage, pose, rates, factors) result(coefficients)
    type(linkage_t), intent(in) :: linkage !! bodies, groups and what joins them
    type(pose_t), intent(in) :: pose       !! away from dead points
    real(wp), intent(in), optional :: rates(:) !! (drives) [rad/s] or [m/s]; absent: per rate of the
                                               !! first
    type(group_factors_t), intent(in), optional :: factors(:) !! of `factorize_groups` at this pose;
                                               !! absent: they are found
    type(kinematic_coefficients_t) :: coefficients

    real(wp), dimension(size(linkage%drives)) :: drives, accelerations

    if (allocated(pose%coefficients)) then
      coefficients = pose%coefficients
      if (.not. present(rates)) return
      ! A path is one of the first drive, which all others follow.
      coefficients%turn = rates(1)*coefficients%turn
      coefficients%pin = rates(1)*coefficients%pin
      coefficients%turn_slope = rates(1)**2*coefficients%turn_slope
      coefficients%pin_slope = rates(1)**2*coefficients%pin_slope
      return
    end if
    accelerations = 0.0_wp
    if (present(rates)) then
      drives = rates
    else
      call find_rates_of_drives(linkage, pose%crank, drives, accelerations)
    end if
    call find_coefficients(linkage, pose, drives, accelerations, .true., coefficients, factors)
  end function find_kinematic_coefficients

  !> Velocities of pins and bodies alone, with rates of the drives.
  pure subroutine find_velocities(linkage, pose, rates, coefficients, factors)
    type(linkage_t), intent(in) :: linkage !! bodies, groups and what joins them
    type(pose_t), intent(in) :: pose       !! away from dead points
    real(wp), intent(in) :: rates(:)       !! (drives) [rad/s] or [m/s]
    type(kinematic_coefficients_t), intent(out) :: coefficients !! accelerations are 0, or of no use
    type(group_factors_t), intent(in), optional :: factors(:) !! as of `find_kinematic_coefficients`

    if (allocated(pose%coefficients)) then
      coefficients = find_kinematic_coefficients(linkage, pose, rates)
    else
      call find_coefficients(linkage, pose, rates, 0.0_wp*rates, .false., coefficients, factors)
    end if
  end subroutine find_velocities

  !> Group by group.
  pure subroutine find_coefficients(linkage, pose, rates, accelerations, with_slopes, &
    coefficients, factors)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: rates(:), accelerations(:) !! (drives)
    logical, intent(in) :: with_slopes !! accelerations are wanted
    type(kinematic_coefficients_t), intent(out) :: coefficients
    type(group_factors_t), intent(in), optional :: factors(:)

    type(group_factors_t) :: own
    integer :: i

    allocate (coefficients%turn(size(linkage%bodies)), &
      coefficients%turn_slope(size(linkage%bodies)))
    allocate (coefficients%pin(2, size(linkage%is_ground)), coefficients%pin_slope(2, &
      size(linkage%is_ground)))
    coefficients%turn = 0.0_wp
    coefficients%turn_slope = 0.0_wp
    coefficients%pin = 0.0_wp
    coefficients%pin_slope = 0.0_wp
    if (linkage%has_crank) then
      coefficients%turn(1) = rates(1)
      associate (crank => linkage%bodies(1))
        coefficients%pin(:, crank%last_pin) = rates(1)*(crank%length*normal_to( &
          pose%direction(:, 1)))
        coefficients%pin_slope(:, crank%last_pin) = -rates(1)**2*(crank%length* &
          pose%direction(:, 1))
        if (linkage%runs_in_time) then
          coefficients%turn_slope(1) = accelerations(1)
          coefficients%pin_slope(:, crank%last_pin) = coefficients%pin_slope(:, crank%last_pin) + &
            accelerations(1)*(crank%length*normal_to(pose%direction(:, 1)))
        end if
      end associate
    end if
    do i = 1, size(linkage%groups)
      select case (linkage%groups(i)%kind)
      case (group_dyad)
        call move_dyad(linkage, linkage%groups(i), pose, pose%sine(i), coefficients)
      case (group_carried)
        call move_carried(linkage, linkage%groups(i), pose, coefficients)
      case default
        if (present(factors)) then
          call move_group(linkage, linkage%groups(i), pose, factors(i), rates, accelerations, &
            with_slopes, coefficients)
        else
          call factorize_group(linkage, linkage%groups(i), pose, own)
          call move_group(linkage, linkage%groups(i), pose, own, rates, accelerations, &
            with_slopes, coefficients)
        end if
      end select
    end do
  end subroutine find_coefficients

  !> Pins of a body that moves already: x' = x_first' + h n and x'' = x_first'' + h' n − h² r, with
  !! r from its first pin and n the same vector turned by 90°.
  pure subroutine move_carried(linkage, group, pose, coefficients)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(inout) :: coefficients

    real(wp) :: arm(2), h, slope
    integer :: i, first

    first = group%base(1)
    h = coefficients%turn(group%body(1))
    slope = coefficients%turn_slope(group%body(1))
    do i = 1, size(group%pins)
      arm = arm_to_pin(linkage, pose, group%body(1), group%pins(i))
      coefficients%pin(:, group%pins(i)) = coefficients%pin(:, first) + h*normal_to(arm)
      coefficients%pin_slope(:, group%pins(i)) = coefficients%pin_slope(:, first) + &
        slope*normal_to(arm) - h**2*arm
    end do
  end subroutine move_carried

  !> First and second derivatives of the unknowns of a group, from its equations: `J q' = c' − J₀
  !! q₀'` and `J q'' = c'' − q'ᵀ ∇²C q' − J₀ q₀''`, where q₀ is placed before, c' the rate of drives
  !! and c'' their acceleration, which only a linkage that runs in time has.
  pure subroutine move_group(linkage, group, pose, factors, rates, accelerations, with_slopes, &
    coefficients)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    type(pose_t), intent(in) :: pose
    type(group_factors_t), intent(in) :: factors
    real(wp), intent(in) :: rates(:), accelerations(:)
    logical, intent(in) :: with_slopes
    type(kinematic_coefficients_t), intent(inout) :: coefficients

    real(wp) :: right(size(group%equations))
    integer :: i

    associate (equations => group%equations, last => factors%gradients%last, partial => &
      factors%gradients%partial)
      coefficients%turn(group%bodies) = 0.0_wp
      coefficients%pin(:, group%pins) = 0.0_wp
      do i = 1, size(equations)
        right(i) = -along(partial(last(i - 1) + 1:last(i)), coefficients%pin, coefficients%turn)
        if (equations(i)%kind == demand_drive) right(i) = right(i) + rates(equations(i)%number)
      end do
      call store_derivatives(group, factors%scale, solve(factors%factor, right), &
        coefficients%pin, coefficients%turn)
      if (.not. with_slopes) return
      do i = 1, size(equations)
        right(i) = -along(partial(last(i - 1) + 1:last(i)), coefficients%pin_slope, &
          coefficients%turn_slope) - coordinate_acceleration(linkage, pose, coefficients, &
          equations(i)%coordinate, of_rates_alone=.true.)
        if (linkage%runs_in_time .and. equations(i)%kind == demand_drive) right(i) = right(i) + &
          accelerations(equations(i)%number)
      end do
    end associate
    call store_derivatives(group, factors%scale, solve(factors%factor, right), &
      coefficients%pin_slope, coefficients%turn_slope)
  end subroutine move_group

  !> Puts derivatives of the unknowns of a group in their places.
  pure subroutine store_derivatives(group, scales, unknowns, pin, turn)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: scales(:)
    real(wp), intent(in) :: unknowns(:)
    real(wp), intent(inout) :: pin(:, :)
    real(wp), intent(inout) :: turn(:)

    integer :: k

    do k = 1, size(group%pins)
      pin(:, group%pins(k)) = unknowns(2*k - 1:2*k)
    end do
    turn(group%bodies) = unknowns(2*size(group%pins) + 1:)/scales
  end subroutine store_derivatives

  !> A gradient times derivatives of pins and angles.
  pure function along(partial, pin, turn) result(rate)
    type(partial_t), intent(in) :: partial(:)
    real(wp), intent(in) :: pin(:, :)
    real(wp), intent(in) :: turn(:)
    real(wp) :: rate

    integer :: k

    rate = 0.0_wp
    do k = 1, size(partial)
      if (partial(k)%pin > 0) rate = rate + dot_product(partial(k)%by_pin, pin(:, partial(k)%pin))
      if (partial(k)%body > 0) rate = rate + partial(k)%by_angle*turn(partial(k)%body)
    end do
  end function along

  !> Closes the loop through a dyad once for velocities and once for accelerations.
  !!
  !! With `e` from base to middle and `n` its normal, `r3 h3 n3 − r4 h4 n4 = w`, where w is the
  !! velocity of the second base relative to the first, per ω2. Since `n3·e4 = sin(θ4 − θ3)`, the
  !! dot products with e4 and e3 separate h3 and h4: (2.22) and (2.23), or, with the accelerations
  !! w' in place of w, (2.37) and (2.38).
  pure subroutine move_dyad(linkage, dyad, pose, sine, coefficients)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: dyad
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: sine
    type(kinematic_coefficients_t), intent(inout) :: coefficients

    real(wp) :: r(2), e(2, 2), h(2), w(2)
    integer :: k

    do k = 1, 2
      r(k) = linkage%bodies(dyad%body(k))%length
      e(:, k) = arm_to_middle(linkage, dyad, pose, k)
    end do
    w = coefficients%pin(:, dyad%base(2)) - coefficients%pin(:, dyad%base(1))
    h = [dot_product(w, e(:, 2)), dot_product(w, e(:, 1))]/(r*sine)
    coefficients%turn(dyad%body) = h
    coefficients%pin(:, dyad%middle) = coefficients%pin(:, dyad%base(1)) + &
      r(1)*h(1)*normal_to(e(:, 1))

    w = coefficients%pin_slope(:, dyad%base(2)) - coefficients%pin_slope(:, dyad%base(1)) + &
      r(1)*h(1)**2*e(:, 1) - r(2)*h(2)**2*e(:, 2)
    coefficients%turn_slope(dyad%body) = [dot_product(w, e(:, 2)), dot_product(w, e(:, 1))]/(r*sine)
    coefficients%pin_slope(:, dyad%middle) = coefficients%pin_slope(:, dyad%base(1)) + &
      r(1)*(coefficients%turn_slope(dyad%body(1))*normal_to(e(:, 1)) - h(1)**2*e(:, 1))
  end subroutine move_dyad

  !> Angular velocities of all bodies [rad/s].
  pure function angular_velocity(coefficients, speed) result(velocity)
    type(kinematic_coefficients_t), intent(in) :: coefficients !! at a pose
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    real(wp) :: velocity(size(coefficients%turn))

    velocity = coefficients%turn*speed
  end function angular_velocity

  !> Angular accelerations of all bodies [rad/s²].
  pure function angular_acceleration(coefficients, speed, acceleration) result(angular)
    type(kinematic_coefficients_t), intent(in) :: coefficients !! at a pose
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    real(wp) :: angular(size(coefficients%turn))

    angular = coefficients%turn*acceleration + coefficients%turn_slope*speed**2
  end function angular_acceleration

end module kinematic_coefficients
