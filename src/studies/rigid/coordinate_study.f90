!> Coordinates of a moving linkage: rates, accelerations, what acts along them, ratios.
module coordinate_study
  use applied_load_types, only: deflection
  use coordinate_types, only: coordinate_t, is_distance, is_sum
  use coordinates, only: coordinate_acceleration, coordinate_rate, coordinate_value, is_turning
  use drive_values, only: drive_value
  use kinds, only: wp
  use linkages, only: linkage_t
  use pose_types, only: kinematic_coefficients_t, pose_t
  use pull_laws, only: moving_pull, standing_pull
  use units, only: in_degrees
  implicit none (type, external)
  private

  public :: coordinate_state_t, coordinate_state, coordinate_ratio, is_without_direction

  type :: coordinate_state_t
    real(wp) :: value = 0.0_wp        !! [m] or [deg]
    real(wp) :: rate = 0.0_wp         !! [m/s] or [rad/s]
    real(wp) :: acceleration = 0.0_wp !! [m/s²] or [rad/s²]
    real(wp) :: effort = 0.0_wp       !! force or couple that makes it grow [N] or [N m]
    real(wp) :: power = 0.0_wp        !! of the effort on the linkage [W]
  end type coordinate_state_t

  !> Ends nearer to each other than this share of the longest link are at one place.
  real(wp), parameter :: least_distance = 1.0e-9_wp

  !> A rate below this share of the largest one of pins and bodies is rounding, and not moving.
  real(wp), parameter :: least_rate = 1.0e-12_wp

contains

  !> A coordinate at a pose, a speed and an acceleration of the first drive: with the coefficients
  !! s' and s'' its rate is s' ω, its acceleration s' α + s'' ω².
  pure function coordinate_state(linkage, pose, coefficients, crank, number, force, rates) &
    result(state)
    type(linkage_t), intent(in) :: linkage !! its coordinates and loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose; or velocities and
                                           !! accelerations, then with rates 1 and 0
    real(wp), intent(in) :: crank          !! coordinate of the first drive, with all whole turns:
                                           !! several have one pose [deg] or [m]
    integer, intent(in) :: number          !! of the coordinate, from 1
    real(wp), intent(in) :: force          !! of the drive that gives it; 0: none [N] or [N m]
    real(wp), intent(in) :: rates(2)       !! speed and acceleration of the first drive [rad/s] and
                                           !! [rad/s²], or [m/s] and [m/s²]
    type(coordinate_state_t) :: state

    real(wp) :: per, x
    integer :: i

    associate (coordinate => linkage%coordinates(number), speed => rates(1), &
        acceleration => rates(2))
      if (coordinate%drive > 0) then
        state%value = drive_value(linkage, coordinate%drive, crank)
      else
        state%value = coordinate_value(linkage, pose, coordinate, crank)
        if (is_turning(linkage, coordinate)) state%value = in_degrees(state%value)
      end if
      per = coordinate_rate(linkage, pose, coefficients, coordinate)
      state%rate = per*speed
      state%acceleration = per*acceleration + coordinate_acceleration(linkage, pose, &
        coefficients, coordinate)*speed**2
    end associate
    state%effort = force
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%coordinate /= number) cycle
        x = deflection(load, coordinate_value(linkage, pose, load%along))
        state%effort = state%effort - standing_pull(load%law, x) - moving_pull(load%law, x, &
          state%rate)
      end associate
    end do
    state%power = state%effort*state%rate
  end function coordinate_state

  !> Change of one coordinate per change of another: s₁'/s₂'.
  pure subroutine coordinate_ratio(linkage, pose, coefficients, number, reference, ratio, moves)
    type(linkage_t), intent(in) :: linkage !! its coordinates
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    integer, intent(in) :: number          !! of the coordinate, from 1
    integer, intent(in) :: reference       !! of the other one
    real(wp), intent(out) :: ratio         !! [-], [m/rad] or [rad/m]
    logical, intent(out) :: moves          !! whether the other one does; else there is no ratio

    real(wp) :: rate, largest

    ratio = 0.0_wp
    rate = coordinate_rate(linkage, pose, coefficients, linkage%coordinates(reference))
    largest = maxval(abs(coefficients%turn))
    largest = max(largest, maxval(abs(coefficients%pin))/maxval(linkage%bodies%length))
    moves = abs(rate) > least_rate*largest
    if (moves) ratio = coordinate_rate(linkage, pose, coefficients, &
      linkage%coordinates(number))/rate
  end subroutine coordinate_ratio

  !> Whether the ends of a distance meet: its line has no direction, and it no rate.
  pure recursive function is_without_direction(linkage, pose, coordinate) result(is)
    type(linkage_t), intent(in) :: linkage !! its bodies and coordinates
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(coordinate_t), intent(in) :: coordinate
    logical :: is

    integer :: i

    is = .false.
    if (coordinate%kind == is_distance) is = coordinate_value(linkage, pose, coordinate) < &
      least_distance*maxval(linkage%bodies%length)
    if (coordinate%kind /= is_sum) return
    do i = 1, size(coordinate%term)
      is = is .or. is_without_direction(linkage, pose, linkage%coordinates(coordinate%term(i)))
    end do
  end function is_without_direction

end module coordinate_study
