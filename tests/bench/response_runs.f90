!> The elastic response that is timed: what is asked for, a run of the program, and how far two results are apart.
module response_runs
  use deformation_model, only: deformation_model_t, new_deformation_model
  use errors, only: error_t
  use kinds, only: long, wp
  use link_degrees, only: link_degrees_t, uniform_degrees
  use link_store, only: link_store_t
  use mechanisms, only: mechanism_t, new_mechanism
  use models, only: model_t
  use response_types, only: axial_strain, bending_strain, damping_time, gauge_t, linear_torque, quadratic_torque, &
    response_point_t, response_request_t, response_t, shear_force, speed_response_t, total_torque
  use steady_responses, only: find_steady_responses
  use turn_grids, only: new_turn_grid, turn_grid_t
  implicit none (type, external)
  private

  public :: request_of, run_response, largest_difference, degrees_of, new_grid, memory_of_process, watch_t, start_watch, &
    read_watch

  !> Kelvin and Voigt's time of every link [s].
  real(wp), parameter :: damping = 1.0e-4_wp

  !> Crank angles at which results are wanted: every 5°.
  integer, parameter :: positions = 72

  !> Speed of a single one, and the lowest and highest of many [rad/s].
  real(wp), parameter :: single_speed = 20.0_wp, lowest_speed = 5.0_wp, highest_speed = 60.0_wp

  !> When something began.
  type :: watch_t
    integer(long) :: count = 0_long
    real(wp) :: processor = 0.0_wp !! [s]
  end type watch_t

contains

  subroutine start_watch(watch)
    type(watch_t), intent(out) :: watch

    call cpu_time(watch%processor)
    call system_clock(watch%count)
  end subroutine start_watch

  !> Time since then, by the clock and of the processor, all threads together [s].
  subroutine read_watch(watch, wall, processor)
    type(watch_t), intent(in) :: watch
    real(wp), intent(out) :: wall, processor

    integer(long) :: now, rate

    call system_clock(now, rate)
    call cpu_time(processor)
    wall = real(now - watch%count, wp)/rate
    processor = processor - watch%processor
  end subroutine read_watch

  !> Strains in the middle of coupler and follower, displacements of the coupler's end and middle, and the torque.
  pure function request_of(mechanism, speeds, accuracy) result(request)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: speeds
    real(wp), intent(in) :: accuracy
    type(response_request_t) :: request

    integer :: i

    request%speed = [single_speed]
    if (speeds > 1) request%speed = [(lowest_speed + (highest_speed - lowest_speed)*(i - 1)/(speeds - 1), i=1, speeds)]
    request%crank = [((360.0_wp/positions)*(i - 1), i=1, positions)]
    request%accuracy = accuracy
    allocate (request%damping(size(mechanism%beams)), request%section(size(mechanism%beams)))
    request%damping%kind = damping_time
    request%damping%value = damping
    ! Stresses and the strain of the outer fibre are multiples of others, which are the ones compared.
    request%section%outer = 1.0_wp
    request%section%modulus = 1.0_wp
    request%gauges = [gauge_t(2, 0.5_wp, 1.0_wp), gauge_t(3, 0.5_wp, 1.0_wp)]
    associate (length => mechanism%linkage%bodies(2)%length)
      request%points = [response_point_t(2, [length, 0.0_wp]), response_point_t(2, [0.5_wp*length, 0.0_wp])]
    end associate
  end function request_of

  !> All that the program does for a deck except reading and writing.
  subroutine run_response(model, speeds, accuracy, threads, response, wall, processor, error)
    type(model_t), intent(in) :: model
    integer, intent(in) :: speeds, threads
    real(wp), intent(in) :: accuracy
    type(response_t), intent(out) :: response
    real(wp), intent(out) :: wall, processor !! [s]
    type(error_t), allocatable, intent(out) :: error

    type(mechanism_t) :: mechanism
    type(link_store_t) :: store
    type(watch_t) :: watch

    call start_watch(watch)
    mechanism = new_mechanism(model)
    call find_steady_responses(mechanism%structure_t, request_of(mechanism, speeds, accuracy), threads, store, response, error)
    call read_watch(watch, wall, processor)
  end subroutine run_response

  !> Largest difference of any quantity at any crank angle, relative to its largest value over the turn.
  pure function largest_difference(this, exact) result(difference)
    type(speed_response_t), intent(in) :: this, exact
    real(wp) :: difference

    integer, parameter :: strains(3) = [axial_strain, bending_strain, shear_force]
    integer, parameter :: torques(3) = [linear_torque, quadratic_torque, total_torque]
    integer :: g, i

    difference = 0.0_wp
    do i = 1, size(exact%displacement, 2)
      difference = max(difference, relative(this%displacement(:2, i, :), exact%displacement(:2, i, :)), &
        relative(this%displacement(3:, i, :), exact%displacement(3:, i, :)))
    end do
    do g = 1, size(exact%strain, 2)
      do i = 1, size(strains)
        associate (k => strains(i))
          difference = max(difference, relative(this%strain(k:k, g, :), exact%strain(k:k, g, :)))
        end associate
      end do
    end do
    do i = 1, size(torques)
      associate (k => torques(i))
        difference = max(difference, relative(this%drive(k:k, :), exact%drive(k:k, :)))
      end associate
    end do
  end function largest_difference

  !> Of vectors their lengths.
  pure function relative(values, exact) result(difference)
    real(wp), intent(in) :: values(:, :), exact(:, :) !! (components, positions)
    real(wp) :: difference

    difference = sqrt(maxval(sum((values - exact)**2, dim=1))/maxval(sum(exact**2, dim=1)))
  end function relative

  !> Degrees of the links of an order, as the program chooses them for links of one piece.
  pure function degrees_of(mechanism, order) result(degrees)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: order
    type(link_degrees_t) :: degrees(size(mechanism%beams))

    integer :: b

    do b = 1, size(degrees)
      degrees(b) = uniform_degrees(1, order, max(4, order - 4))
    end do
  end function degrees_of

  !> Terms of the equations over a turn. Errors: own modes of the links could not be found.
  subroutine new_grid(mechanism, order, samples, grid, error)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: order, samples
    type(turn_grid_t), intent(out) :: grid
    type(error_t), allocatable, intent(out) :: error

    type(deformation_model_t) :: model
    type(link_store_t) :: store
    integer :: links

    links = size(mechanism%beams)
    call new_deformation_model(mechanism%linkage, mechanism%beams, spread(0, 1, links), spread(order, 1, links), &
      spread(.false., 1, links), model, error, store, degrees_of(mechanism, order))
    if (.not. allocated(error)) call new_turn_grid(mechanism, model, samples, grid, error)
  end subroutine new_grid

  !> Most memory that this process has held so far [bytes]; 0 where the system does not say.
  function memory_of_process() result(bytes)
    real(wp) :: bytes

    character(len=200) :: line
    integer :: unit, status

    bytes = 0.0_wp
    open (newunit=unit, file="/proc/self/status", status="old", action="read", iostat=status)
    if (status /= 0) return
    do
      read (unit, "(a)", iostat=status) line
      if (status /= 0) exit
      if (index(line, "VmHWM:") /= 1) cycle
      read (line(7:index(line, "kB") - 1), *, iostat=status) bytes
      bytes = 1024.0_wp*bytes
      exit
    end do
    close (unit)
  end function memory_of_process

end module response_runs
