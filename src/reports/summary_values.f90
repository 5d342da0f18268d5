!> The quantities of REPORT summary over all positions and speeds of a variant: what its table has a
!! row of, and what `evaluate` gives.
!!
!! Values and failures are those of the tables that have a row for each of them. A new quantity is a
!! record of `summary_quantities` and a case of `find_value`.
module summary_values
  use coordinate_study, only: coordinate_state_t
  use coordinates_report, only: find_lost_coordinate, has_direction, has_ratio, ratio_at, state_at
  use drive_motions, only: drive_rates
  use errors, only: error_t
  use friction_words, only: lock_words
  use frequency_study, only: damping_values, failure_at, frequency_values, has_result
  use joint_study, only: drives_at_speed, frame_at_speed, joints_at_speed
  use joints_report, only: open_words
  use kinds, only: wp
  use kinematics_study, only: transmission_at
  use locked_rows, only: is_locked_at, lock_at
  use models, only: report_number
  use response_notes, only: has_response
  use summary_quantities, only: quantity_kinds, quantity_name, quantity_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: summary_value_t, find_summary, find_lack

  !> A value at a position and speed.
  type :: value_t
    logical :: is_there = .false. !! false: the row of its table has failed
    real(wp) :: value = 0.0_wp    !! in SI, or in the unit of its column
    real(wp) :: error = 0.0_wp    !! estimated [-]
  end type value_t

  !> A quantity over the positions and speeds at which it is there, in SI or in the unit of its
  !! column. Places are numbers of a position and a speed, the first with this value.
  type :: summary_value_t
    integer :: count = 0               !! of places where it is there
    real(wp) :: least = 0.0_wp, mean = 0.0_wp, greatest = 0.0_wp
    real(wp) :: error = 0.0_wp         !! the greatest, estimated; 0 of quantities without one [-]
    integer :: least_at(2) = 0, greatest_at(2) = 0
    integer :: failed_at(2) = 0        !! the first place without it; 0: none
  end type summary_value_t

contains

  !> Every quantity over its positions and speeds, in the order of their table.
  subroutine find_summary(variant, values, places, failed)
    type(variant_results_t), intent(in) :: variant !! computed, with REPORT summary
    type(summary_value_t), allocatable, intent(out) :: values(:) !! (quantities)
    integer, intent(out) :: places !! number of positions and speeds
    integer, intent(out) :: failed !! at how many of them a quantity is not there

    logical, allocatable :: lacks(:, :)
    type(value_t) :: found
    integer :: i, k, q, speeds

    associate (summary => variant%model%reports(report_number(variant%model, "summary"))%summary, &
        positions => size(variant%found%positions%crank))
      speeds = 0
      do q = 1, size(summary%quantities)
        speeds = max(speeds, speed_count(variant, summary%reports(q)))
      end do
      allocate (lacks(positions, speeds), source=.false.)
      allocate (values(size(summary%quantities)))
      do q = 1, size(values)
        do k = 1, speed_count(variant, summary%reports(q))
          do i = 1, positions
            call find_value(variant, summary%quantities(q), trim(summary%reports(q)), i, k, found)
            call add_value(found, [i, k], values(q))
            if (found%is_there) cycle
            ! Static frequencies are those of all speeds.
            if (speed_count(variant, summary%reports(q)) < speeds) lacks(i, :) = .true.
            lacks(i, k) = .true.
          end do
        end do
      end do
    end associate
    where (values%count > 0) values%mean = values%mean/values%count
    places = size(lacks)
    failed = count(lacks)
  end subroutine find_summary

  !> Takes a value into a range, whose mean is the sum so far.
  pure subroutine add_value(found, place, range)
    type(value_t), intent(in) :: found
    integer, intent(in) :: place(2)
    type(summary_value_t), intent(inout) :: range

    if (.not. found%is_there) then
      if (range%failed_at(1) == 0) range%failed_at = place
      return
    end if
    if (range%count == 0 .or. found%value < range%least) then
      range%least = found%value
      range%least_at = place
    end if
    if (range%count == 0 .or. found%value > range%greatest) then
      range%greatest = found%value
      range%greatest_at = place
    end if
    range%count = range%count + 1
    range%mean = range%mean + found%value
    range%error = max(range%error, found%error)
  end subroutine add_value

  !> Number of speeds of a report's table.
  pure function speed_count(variant, report) result(count)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report !! name
    integer :: count

    count = size(variant%model%speed%value)
    if (report == "frequencies") count = size(variant%found%sweep%request%speed)
  end function speed_count

  !> A quantity at a position and speed.
  subroutine find_value(variant, quantity, report, position, speed, found)
    type(variant_results_t), intent(in) :: variant
    type(quantity_t), intent(in) :: quantity
    character(len=*), intent(in) :: report    !! that has it, of this linkage
    integer, intent(in) :: position, speed    !! numbers
    type(value_t), intent(out) :: found

    real(wp) :: rates(2), values(2*variant%model%modes), frame(6), &
      drives(3, size(variant%mechanism%linkage%drives))

    associate (model => variant%model, results => variant%found, &
        state => variant%found%positions%state(position), &
        name => quantity_kinds(quantity%kind)%name)
      found%is_there = is_computed(variant, table_of(report, name), position, speed)
      if (found%is_there .and. report == "coordinates") then
        found%is_there = has_direction(variant, position, quantity%mode)
        if (found%is_there .and. name == "ratio:") found%is_there = has_ratio(variant, position, &
          reference_of(variant))
      end if
      if (.not. found%is_there) return
      rates = drive_rates(model, speed, position)
      select case (report)
      case ("frequencies")
        values = frequency_values(results%sweep, state, speed)
        found%error = values(model%modes + quantity%mode)
        if (name == "zeta*") values(:model%modes) = damping_values(results%sweep, state, speed)
        found%value = values(quantity%mode)
      case ("kinematics")
        found%value = transmission_at(variant%mechanism%linkage, variant%mechanism%four_bar, &
          results%positions%states(state))
      case ("drives")
        drives = drives_at_speed(variant%mechanism%linkage, results%joints, &
          results%positions%states(state), state, results%positions%crank(position), rates(1), &
          rates(2), speed)
        frame = frame_at_speed(variant%mechanism%linkage, results%joints, state, rates(1), &
          rates(2), speed)
        if (name == "torque") found%value = drives(3, 1)
        if (name == "shaking_force") found%value = norm2(frame(:2))
        if (name == "shaking_moment") found%value = frame(3)
      case ("frame")
        frame = frame_at_speed(variant%mechanism%linkage, results%joints, state, rates(1), &
          rates(2), speed)
        found%value = norm2(frame(4:5))
      case ("bearings")
        found%value = greatest_force(variant, state, rates, speed)
      case ("coordinates")
        found%value = coordinate_quantity(variant, trim(name), position, speed, quantity%mode)
      case ("strains", "response", "torque")
        call find_elastic_value(variant, trim(name), position, speed, found)
      end select
    end associate
  end subroutine find_value

  !> A quantity of a coordinate, which has it at this position.
  pure function coordinate_quantity(variant, name, position, speed, number) result(value)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: name
    integer, intent(in) :: position, speed
    integer, intent(in) :: number !! of the coordinate
    real(wp) :: value

    type(coordinate_state_t) :: state

    value = 0.0_wp
    if (name == "ratio:") then
      value = ratio_at(variant, position, number, reference_of(variant))
      return
    end if
    state = state_at(variant, position, speed, number)
    select case (name)
    case ("value:")
      value = state%value
    case ("rate:")
      value = state%rate
    case ("effort:")
      value = state%effort
    case ("power:")
      value = state%power
    end select
  end function coordinate_quantity

  !> The coordinate to which ratios of REPORT summary refer.
  pure function reference_of(variant) result(reference)
    type(variant_results_t), intent(in) :: variant
    integer :: reference

    reference = variant%model%reports(report_number(variant%model, "summary"))%reference
  end function reference_of

  !> The greatest force in any joint [N].
  pure function greatest_force(variant, state, rates, speed) result(greatest)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: state
    real(wp), intent(in) :: rates(2)
    integer, intent(in) :: speed
    real(wp) :: greatest

    real(wp) :: forces(3, size(variant%found%joints%joints))

    forces = joints_at_speed(variant%found%joints, state, rates(1), rates(2), speed)
    greatest = maxval(norm2(forces(:2, :), dim=1))
  end function greatest_force

  !> A quantity of the elastic response: of gauges or points the greatest.
  pure subroutine find_elastic_value(variant, name, position, speed, found)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: name
    integer, intent(in) :: position, speed
    type(value_t), intent(inout) :: found

    associate (at_speed => variant%found%response%at_speed(speed))
      select case (name)
      case ("strain")
        found%value = maxval(abs(at_speed%strain(1, :, position) + at_speed%strain(2, :, position)))
        found%error = maxval(at_speed%strain_error)
      case ("stress")
        found%value = maxval(at_speed%strain(6, :, position))
        found%error = maxval(at_speed%strain_error)
      case ("displacement")
        found%value = maxval(norm2(at_speed%displacement(:2, :, position), dim=1))
        found%error = maxval(at_speed%displacement_error)
      case ("elastic_torque")
        found%value = at_speed%drive(4, position)
        found%error = at_speed%drive_error
      end select
    end associate
  end subroutine find_elastic_value

  !> The table of a report that has a quantity.
  pure function table_of(report, quantity) result(table)
    character(len=*), intent(in) :: report, quantity !! names
    character(len=11) :: table

    table = report
    if (report == "drives" .and. index(quantity, "shaking") == 1) table = "shaking"
  end function table_of

  !> Whether a report's table has a row at a position and speed.
  pure function is_computed(variant, report, position, speed) result(is)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report
    integer, intent(in) :: position, speed
    logical :: is

    associate (found => variant%found, state => variant%found%positions%state(position))
      select case (report)
      case ("strains", "response", "torque")
        is = has_response(variant, speed)
      case ("frequencies")
        is = has_result(found%positions, found%sweep, state, speed)
      case default
        is = .not. allocated(found%positions%states(state)%error)
        if (is) is = .not. is_locked_at(variant, report, position, speed)
        if (is .and. report == "bearings") is = .not. any(found%joints%is_open(:, state))
      end select
    end associate
  end function is_computed

  !> Why a quantity is nowhere; not allocated if all are somewhere.
  subroutine find_lack(variant, values, reason)
    type(variant_results_t), intent(in) :: variant   !! as of `find_summary`
    type(summary_value_t), intent(in) :: values(:)   !! its values
    character(len=:), allocatable, intent(out) :: reason

    integer :: lacking

    lacking = findloc(values%count, 0, dim=1)
    if (lacking == 0) return
    associate (summary => variant%model%reports(report_number(variant%model, "summary"))%summary)
      ! One thread at a time makes texts.
      !$omp critical (one_at_a_time)
      call find_reason(variant, summary%reports(lacking), values(lacking)%failed_at, reason)
      if (any(values%count > 0)) reason = quantity_name(summary%quantities(lacking))//": "//reason
      !$omp end critical (one_at_a_time)
    end associate
  end subroutine find_lack

  !> Why a report has no row at a place.
  pure subroutine find_reason(variant, report, at, reason)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report
    integer, intent(in) :: at(2) !! position and speed without a row
    character(len=:), allocatable, intent(out) :: reason

    type(error_t) :: error

    associate (found => variant%found, state => variant%found%positions%state(at(1)))
      select case (report)
      case ("strains", "response", "torque")
        reason = found%response%at_speed(at(2))%error%text
      case ("frequencies")
        error = failure_at(found%positions, found%sweep, state, at(2))
        reason = error%text
      case default
        if (allocated(found%positions%states(state)%error)) then
          reason = found%positions%states(state)%error%text
        else if (is_locked_at(variant, report, at(1), at(2))) then
          reason = lock_words(variant%model, variant%mechanism, lock_at(variant, report, at(1), &
            at(2)))
        else if (report == "coordinates") then
          reason = find_lost_coordinate(variant, at(1))
        else
          reason = open_words(variant, found%joints%joints(findloc(found%joints%is_open(:, state), &
            .true., dim=1)))
        end if
      end select
    end associate
  end subroutine find_reason

end module summary_values
