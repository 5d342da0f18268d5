!> Tables of loads: over what coordinate of the linkage they are, where they end, after how much of
!! the first drive they repeat.
module load_tables
  use applied_load_types, only: applied_load_t, applies_along, counts_turns, deflection, &
    is_torsional, over_coordinate, over_nothing, over_time
  use constants, only: degree
  use coordinate_types, only: is_angle, is_sum
  use coordinates, only: coordinate_value, evaluated_t
  use cubic_splines, only: spline_values
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use drive_values, only: drive_rate
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use text, only: to_string
  use units, only: from_si
  implicit none (type, external)
  private

  public :: table_factor, refuse_beyond_tables, load_period, next_row

  !> By how much rounding may put a coordinate beyond the ends of a table, of its length.
  real(wp), parameter :: slack = 1.0e-12_wp

  !> Largest angle between a torsional spring and its rest; its sign changes at a half turn [rad].
  real(wp), parameter :: most_deflection = 170.0_wp*degree

contains

  !> Refuses a pose beyond the ends of a table, or with a torsional spring near half a turn from its
  !! rest, where its torque would jump.
  pure subroutine refuse_beyond_tables(linkage, pose, along, error)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! with the coordinate of the first drive
    type(evaluated_t), intent(in) :: along(:) !! (loads) of `evaluate_loads` at this pose
    type(error_t), allocatable, intent(inout) :: error !! allocated if there is such a table or
                                                       !! spring

    character(len=:), allocatable :: words
    real(wp) :: x, first, last
    integer :: i

    do i = 1, size(along)
      associate (load => linkage%loads(i))
        if (load%kind == applies_along) then
          if (jumps(linkage, pose, load, along(i)%value)) then
            words = "a torsional spring"
            if (load%law%side /= 0) words = "the angle of '"//load%name//"'"
            call set_error(error, error_of_numerics, words//" is turned by nearly "// &
              "half a turn or more, and its torque would jump")
            return
          end if
        end if
        if (load%over == over_nothing .or. load%table%is_periodic) cycle
        if (load%over == over_time .and. .not. pose%has_time) cycle
        x = table_variable(linkage, pose, load)
        first = load%table%x(1)
        last = load%table%x(size(load%table%x))
        if (x >= first - slack*(last - first) .and. x <= last + slack*(last - first)) cycle
        associate (here => from_si(x, load%variable_unit), unit => load%variable_unit%name, &
            end_of => from_si(merge(first, last, x < first), load%variable_unit))
          words = "the table "//load%table_name//" "//trim(merge("begins", "ends  ", x < &
            first))//" at "//to_string(end_of, 6)//" "//unit
          if (load%over == over_time) words = words//": it is over the time"
          if (allocated(load%variable_name)) words = words//": it is over '"// &
            load%variable_name//"', here "//to_string(here, 6)//" "//unit
          if (allocated(load%angle_name)) words = words//": it is over the angle of the link '"// &
            load%angle_name//"', here "//to_string(here, 6)//" "//unit//"; without 'over=' a "// &
            "table is over the first drive and its turns"
        end associate
        call set_error(error, error_of_numerics, words)
        return
      end associate
    end do
  end subroutine refuse_beyond_tables

  !> Whether an angle is so near to half a turn from the rest of a load, or one of a sum to half a
  !! turn, that its pull would jump.
  pure function jumps(linkage, pose, load, value) result(does)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of this [m] or [rad]
    logical :: does

    integer :: i

    does = .false.
    if (.not. load%law%stiffness > 0.0_wp) return
    if (is_torsional(load) .and. .not. counts_turns(load)) does = abs(deflection(load, &
      value)) > most_deflection
    if (load%along%kind /= is_sum) return
    do i = 1, size(load%along%term)
      associate (term => linkage%coordinates(load%along%term(i)))
        if (term%kind /= is_angle .or. term%drive > 0) cycle
        does = does .or. abs(coordinate_value(linkage, pose, term)) > most_deflection
      end associate
    end do
  end function jumps

  !> After how much of the first drive's angle positions and loads repeat: a whole number of periods
  !! of the positions [deg]; 0: they do not.
  pure function load_period(linkage, period) result(whole)
    type(linkage_t), intent(in) :: linkage !! its loads
    real(wp), intent(in) :: period         !! of the positions [deg]; 0: none
    real(wp) :: whole

    integer, parameter :: most_turns = 64
    real(wp) :: length
    integer :: i, turns

    whole = period
    if (.not. allocated(linkage%loads) .or. period <= 0.0_wp) return
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%kind == applies_along .and. load%law%stiffness > 0.0_wp .and. counts_turns(load)) &
          then
          if (abs(drive_rate(linkage, load%along%drive)) > 0.0_wp) whole = 0.0_wp
        end if
        if (load%over /= over_coordinate .or. load%variable%drive == 0) cycle
        if (.not. load%table%is_periodic .or. load%variable%drive > 1) whole = 0.0_wp
        if (whole <= 0.0_wp) return
        length = (load%table%x(size(load%table%x)) - load%table%x(1))/degree
        do turns = 1, most_turns
          if (abs(turns*whole/length - anint(turns*whole/length)) > 1.0e-9_wp) cycle
          whole = turns*whole
          exit
        end do
        if (turns > most_turns) whole = 0.0_wp
        if (whole <= 0.0_wp) return
      end associate
    end do
  end function load_period

  !> What the value of a load is multiplied with: 1, or the value of its table.
  pure function table_factor(linkage, pose, load) result(factor)
    type(linkage_t), intent(in) :: linkage   !! its coordinates
    type(pose_t), intent(in) :: pose         !! with the coordinate of the first drive, and the time
    type(applied_load_t), intent(in) :: load !! with a table or without
    real(wp) :: factor

    real(wp) :: values(3)

    factor = 1.0_wp
    if (load%over == over_nothing) return
    values = spline_values(load%table, table_variable(linkage, pose, load))
    factor = values(1)
  end function table_factor

  !> What the table of a load is over [m], [rad] or [s].
  pure function table_variable(linkage, pose, load) result(x)
    type(linkage_t), intent(in) :: linkage   !! its coordinates
    type(pose_t), intent(in) :: pose         !! with the coordinate of the first drive, and the time
    type(applied_load_t), intent(in) :: load !! with a table
    real(wp) :: x

    x = pose%time
    if (load%over == over_coordinate) x = coordinate_value(linkage, pose, load%variable)
  end function table_variable

  !> The first row after an instant of any table over time, or a later instant if there is none
  !! before: from row to row what such a load does is smooth [s].
  pure function next_row(linkage, time, later) result(next)
    type(linkage_t), intent(in) :: linkage   !! its loads
    real(wp), intent(in) :: time, later      !! [s]
    real(wp) :: next

    integer :: i

    next = later
    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%over == over_time) next = min(next, minval(load%table%x, load%table%x > time))
      end associate
    end do
  end function next_row

end module load_tables
