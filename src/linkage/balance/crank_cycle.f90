!> A cycle of the crank, of one turn or several: shaking force, shaking moment and drive torque as
!! periodic quantities.
module crank_cycle
  use applied_loads, only: evaluate_loads
  use balance_shafts, only: parts_of_shafts
  use coordinates, only: evaluated_t
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkages, only: linkage_t
  use load_cases, only: case_count
  use load_tables, only: refuse_beyond_tables
  use poses, only: find_pose, pose_t
  use reactions, only: find_unit_reactions, unit_reactions_t
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t, total_mass
  use running_loads, only: depends_on_speed, find_running_loads, lock_of, lock_t, running_t
  implicit none (type, external)
  private

  public :: cycle_t, parts_at, find_parts, cycle_values, find_largest_value, &
    usual_values
  public :: quantity_names, quantity_count, shaking_x, shaking_y, shaking_force, shaking_moment, &
    drive_torque

  !> Numbers of the periodic quantities.
  integer, parameter :: shaking_x = 1, shaking_y = 2, shaking_force = 3, shaking_moment = 4, &
    drive_torque = 5
  integer, parameter :: quantity_count = 5
  character(len=*), parameter :: quantity_names(quantity_count) = &
    [character(len=14) :: "shaking_x", "shaking_y", "shaking_force", "shaking_moment", "torque"]

  !> Shaking force along x and y, shaking moment and drive torque at every sample of a cycle, for
  !! each of the three load cases; and what loads that depend on the speed add to the torque.
  type :: cycle_t
    real(wp) :: period = 360.0_wp          !! [deg]
    real(wp), allocatable :: part(:, :, :) !! (4, cases, samples) [N, N, N m, N m]
    real(wp), allocatable :: running(:, :) !! (speeds, samples) added torque [N m]; not allocated,
                                           !! or no speeds: nothing is added
    type(error_t), allocatable :: error    !! why there are no values: a position beyond the ends
                                           !! of a table, or locked by friction
    real(wp) :: error_crank = 0.0_wp       !! where [deg]
  end type cycle_t

contains

  !> Shaking force, shaking moment and torque at a crank angle, with those of balance shafts, for
  !! each of the three load cases; zero where the links cannot be moved.
  pure function parts_at(linkage, elements, crank) result(part)
    type(linkage_t), intent(in) :: linkage !! whose crank turns freely
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    real(wp), intent(in) :: crank          !! [deg]
    real(wp) :: part(4, case_count)        !! as in `cycle_t`

    type(error_t), allocatable :: error
    real(wp) :: no_torque(0)

    call find_parts(linkage, elements, crank, [real(wp) ::], 0.0_wp, part, no_torque, error)
  end function parts_at

  !> The same, with the torque that loads that depend on the speed add. Errors: the links cannot be
  !! moved; beyond the ends of a table; locked by friction. But for the first the parts are found.
  pure subroutine find_parts(linkage, elements, crank, speed, acceleration, part, running, error)
    type(linkage_t), intent(in) :: linkage !! whose crank turns freely
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    real(wp), intent(in) :: crank          !! [deg]
    real(wp), intent(in) :: speed(:)       !! (speeds) ω2 [rad/s]
    real(wp), intent(in) :: acceleration   !! α2 [rad/s²]
    real(wp), intent(out) :: part(:, :)    !! (4, cases) as in `cycle_t`
    real(wp), intent(out) :: running(:)    !! (speeds) added torque [N m]
    type(error_t), allocatable, intent(inout) :: error

    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients
    type(unit_reactions_t) :: unit
    type(running_t) :: loads
    type(lock_t) :: lock
    type(evaluated_t), allocatable :: along(:)
    integer :: i

    part = 0.0_wp
    running = 0.0_wp
    call find_pose(linkage, crank, pose, error)
    if (allocated(error)) return
    coefficients = find_kinematic_coefficients(linkage, pose)
    call find_unit_reactions(linkage, elements, pose, coefficients, unit)
    do i = 1, case_count
      part(:, i) = [unit%of_case(i)%shaking_force, unit%of_case(i)%shaking_moment, &
        unit%of_case(i)%joints%torque]
    end do
    if (allocated(linkage%shafts)) part = part + parts_of_shafts(linkage, crank)
    call evaluate_loads(linkage, pose, along)
    call refuse_beyond_tables(linkage, pose, along, error)
    if (allocated(error) .or. .not. depends_on_speed(linkage)) return
    do i = 1, size(speed)
      call find_running_loads(linkage, pose, coefficients, speed(i), acceleration, unit, loads)
      lock = lock_of(loads)
      if (lock%friction > 0) then
        call set_error(error, error_of_numerics, "friction locks the linkage")
        return
      end if
      running(i) = loads%joints%torque
    end do
  end subroutine find_parts

  !> All quantities over a cycle, at a speed and an acceleration of the crank that are constant over
  !! it.
  pure function cycle_values(turn, speed, acceleration, number) result(values)
    type(cycle_t), intent(in) :: turn    !! its samples
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    integer, intent(in), optional :: number !! of the speed, for loads that depend on it; absent:
                                            !! without these
    real(wp) :: values(size(turn%part, 3), quantity_count) !! (samples, quantities)

    integer :: i

    do i = 1, size(values, 1)
      values(i, :) = quantities_of(turn%part(:, :, i), speed, acceleration)
    end do
    if (.not. (present(number) .and. allocated(turn%running))) return
    if (size(turn%running, 1) > 0) values(:, drive_torque) = values(:, drive_torque) + &
      turn%running(number, :)
  end function cycle_values

  !> All quantities, from the parts of the three load cases.
  pure function quantities_of(part, speed, acceleration) result(values)
    real(wp), intent(in) :: part(:, :), speed, acceleration
    real(wp) :: values(quantity_count)

    real(wp) :: total(4)

    total = matmul(part, [speed**2, acceleration, 1.0_wp])
    values = [total(1), total(2), norm2(total(1:2)), total(3), total(4)]
  end function quantities_of

  !> Typical magnitude of the quantities in an unbalanced linkage: a scale for what is left in a
  !! balanced one.
  !!
  !! The total mass m is taken to move with the crank at a distance L, the sum of the link lengths:
  !! force `m (L (ω2² + |α2|) + g)`, and L times that as moment and torque.
  pure function usual_values(linkage, elements, speed, acceleration) result(values)
    type(linkage_t), intent(in) :: linkage !! lengths, masses and gravity
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    real(wp), intent(in) :: speed          !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration   !! α2 [rad/s²]
    real(wp) :: values(quantity_count)

    type(rigid_body_t) :: rigid(size(linkage%bodies))
    real(wp) :: length, force

    rigid = rigid_bodies_of(linkage, elements)
    length = sum(linkage%bodies%length)
    force = total_mass(linkage, rigid)*((speed**2 + abs(acceleration))*length + &
      norm2(linkage%gravity))
    values = force
    values([shaking_moment, drive_torque]) = force*length
  end function usual_values

  !> Largest absolute value of a quantity in a cycle, also between its samples.
  !!
  !! Around each of the three highest peaks among the samples the maximum is enclosed by
  !! golden-section search. A cycle with so many samples that more of them do not change its
  !! harmonics has no peaks that its samples do not show.
  pure subroutine find_largest_value(linkage, elements, turn, quantity, speed, acceleration, &
      largest, solutions, number)
    type(linkage_t), intent(in) :: linkage !! whose crank turns freely
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    type(cycle_t), intent(in) :: turn      !! its samples
    integer, intent(in) :: quantity        !! its number
    real(wp), intent(in) :: speed          !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration   !! α2 [rad/s²]
    real(wp), intent(out) :: largest       !! absolute value
    integer, intent(out) :: solutions      !! poses found besides the samples
    integer, intent(in), optional :: number !! of the speed, for loads that depend on it; absent:
                                            !! without these

    integer, parameter :: most_peaks = 3
    real(wp), allocatable :: values(:, :), size_of(:), running(:)
    real(wp) :: peak, step
    integer :: k, at

    values = abs(cycle_values(turn, speed, acceleration, number))
    running = pack([speed], [present(number) .and. quantity == drive_torque])
    step = turn%period/size(values, 1)
    solutions = 0
    associate (value => values(:, quantity))
      largest = maxval(value)
      ! Samples that are not peaks are set to zero.
      size_of = merge(value, 0.0_wp, value >= cshift(value, 1) .and. value >= cshift(value, -1))
    end associate
    do k = 1, most_peaks
      at = maxloc(size_of, dim=1)
      if (size_of(at) <= 0.0_wp) exit
      size_of(at) = 0.0_wp
      call find_peak(linkage, elements, quantity, speed, acceleration, running, step*(at - 2), &
        step*at, peak, solutions)
      largest = max(largest, peak)
    end do
  end subroutine find_largest_value

  !> Golden-section search for the largest absolute value of a quantity between two crank angles.
  pure subroutine find_peak(linkage, elements, quantity, speed, acceleration, running, first, &
      last, peak, solutions)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:), quantity
    real(wp), intent(in) :: speed, acceleration, first, last !! angles [deg]
    real(wp), intent(in) :: running(:) !! the speed, for loads that depend on it; or empty
    real(wp), intent(out) :: peak
    integer, intent(inout) :: solutions !! each value needs another

    real(wp), parameter :: golden = 0.5_wp*(sqrt(5.0_wp) - 1.0_wp)
    ! A peak is flat: this close to it [deg] the value is exact to the last digits.
    real(wp), parameter :: near = 1.0e-7_wp
    real(wp) :: a, b, x(2), y(2)

    a = first
    b = last
    x = [b - golden*(b - a), a + golden*(b - a)]
    y = [value_at(linkage, elements, quantity, speed, acceleration, running, x(1)), &
      value_at(linkage, elements, quantity, speed, acceleration, running, x(2))]
    solutions = solutions + 2
    do while (b - a > near)
      solutions = solutions + 1
      if (y(1) >= y(2)) then
        b = x(2)
        x = [b - golden*(b - a), x(1)]
        y = [value_at(linkage, elements, quantity, speed, acceleration, running, x(1)), y(1)]
      else
        a = x(1)
        x = [x(2), a + golden*(b - a)]
        y = [y(2), value_at(linkage, elements, quantity, speed, acceleration, running, x(2))]
      end if
    end do
    peak = maxval(y)
  end subroutine find_peak

  !> Absolute value of a quantity at a crank angle; 0 where it has none.
  pure function value_at(linkage, elements, quantity, speed, acceleration, running, crank) &
    result(value)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:), quantity
    real(wp), intent(in) :: speed, acceleration, crank !! angle [deg]
    real(wp), intent(in) :: running(:) !! as in `find_peak`
    real(wp) :: value

    type(error_t), allocatable :: error
    real(wp) :: values(quantity_count), part(4, case_count), torque(size(running))

    call find_parts(linkage, elements, crank, running, acceleration, part, torque, error)
    value = 0.0_wp
    if (allocated(error)) return
    values = quantities_of(part, speed, acceleration)
    values(drive_torque) = values(drive_torque) + sum(torque)
    value = abs(values(quantity))
  end function value_at

end module crank_cycle
