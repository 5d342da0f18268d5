!> Kinematics of a four-bar: angles, angular velocities and accelerations of the links, places of
!! the moving pins, transmission angle.
module kinematics_study
  use constants, only: degree
  use kinds, only: wp
  use four_bar_loops, only: four_bar_t
  use linkages, only: linkage_t
  use poses, only: angle_along, transmission_angle
  use positions, only: positions_t
  implicit none (type, external)
  private

  public :: kinematic_values, kinematics_result_t, find_kinematics, kinematics_at

  !> Number of values of `kinematics_at`.
  integer, parameter :: kinematic_values = 11

  !> Quantities that do not depend on the speed, in the order coupler, follower; zeros where there
  !! is no pose.
  type :: kinematics_result_t
    real(wp), allocatable :: angle(:, :)        !! (2, states) θ3 and θ4 [deg]
    real(wp), allocatable :: turn(:, :)         !! (2, states) h = dθ/dθ2 [-]
    real(wp), allocatable :: turn_slope(:, :)   !! (2, states) h' = d²θ/dθ2² [-]
    real(wp), allocatable :: pin(:, :)          !! (4, states) x and y of A, then of B [m]
    real(wp), allocatable :: transmission(:)    !! (states) transmission angle, between coupler and
                                                !! follower [deg]
    integer :: at_least = 0, at_most = 0        !! numbers, in the deck's list, of the positions of
                                                !! least and greatest transmission angle; 0: there
                                                !! is no pose at all
  end type kinematics_result_t

contains

  !> Kinematics at all positions, once for all speeds: Ulker 2010 (2.1) to (2.38), which are solved
  !! in `poses` and `kinematic_coefficients`.
  subroutine find_kinematics(linkage, four_bar, positions, threads, found)
    type(linkage_t), intent(in) :: linkage          !! a four-bar
    type(four_bar_t), intent(in) :: four_bar        !! that it is
    type(positions_t), intent(in) :: positions      !! of the run
    integer, intent(in) :: threads                  !! number of OpenMP threads
    type(kinematics_result_t), intent(out) :: found !! for all positions and speeds

    integer :: i, n

    n = size(positions%states)
    allocate (found%angle(2, n), found%turn(2, n), found%turn_slope(2, n), found%pin(4, n), &
      found%transmission(n))
    found%angle = 0.0_wp
    found%turn = 0.0_wp
    found%turn_slope = 0.0_wp
    found%pin = 0.0_wp
    found%transmission = 0.0_wp
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, n
      associate (state => positions%states(i))
        if (allocated(state%error)) cycle
        found%angle(:, i) = [angle_along(linkage, state%pose, four_bar%body(2), four_bar%pin(2)), &
          angle_along(linkage, state%pose, four_bar%body(3), four_bar%pin(4))]/degree
        found%turn(:, i) = state%coefficients%turn(four_bar%body(2:))
        found%turn_slope(:, i) = state%coefficients%turn_slope(four_bar%body(2:))
        found%pin(:, i) = [state%pose%pin(:, four_bar%pin(2)), state%pose%pin(:, four_bar%pin(3))]
        found%transmission(i) = transmission_angle(linkage, state%pose, four_bar%dyad)/degree
      end associate
    end do
    !$omp end parallel do
    call find_extremes(positions, found)
  end subroutine find_kinematics

  !> Positions of least and greatest transmission angle; of equal ones the first in the list.
  pure subroutine find_extremes(positions, found)
    type(positions_t), intent(in) :: positions
    type(kinematics_result_t), intent(inout) :: found

    real(wp) :: least, most
    integer :: i

    least = huge(least)
    most = -1.0_wp
    do i = 1, size(positions%crank)
      if (allocated(positions%states(positions%state(i))%error)) cycle
      associate (angle => found%transmission(positions%state(i)))
        if (angle < least) found%at_least = i
        if (angle > most) found%at_most = i
        least = min(least, angle)
        most = max(most, angle)
      end associate
    end do
  end subroutine find_extremes

  !> Values at a speed: θ3, θ4 [deg], ω3, ω4 [rad/s], α3, α4 [rad/s²], x and y of A and B [m],
  !! transmission angle [deg].
  pure function kinematics_at(found, state, speed, acceleration) result(values)
    type(kinematics_result_t), intent(in) :: found !! for all positions
    integer, intent(in) :: state                   !! number; with a pose
    real(wp), intent(in) :: speed                  !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration           !! α2 [rad/s²]
    real(wp) :: values(kinematic_values)

    associate (h => found%turn(:, state), slope => found%turn_slope(:, state))
      values = [found%angle(:, state), h*speed, h*acceleration + slope*speed**2, &
        found%pin(:, state), found%transmission(state)]
    end associate
  end function kinematics_at

end module kinematics_study
