!> Tables of loads: over what coordinate of the linkage they are, where they end, after how much of
!! the first drive they repeat.
module load_tables
  use applied_load_types, only: applied_load_t, applies_between, over_angle, over_drive, &
    over_nothing, over_slider, over_travel
  use constants, only: degree
  use coordinates, only: coordinate_value, slider_coordinate
  use cubic_splines, only: spline_values
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use linkages, only: drive_of_angle, linkage_t
  use load_coordinates, only: counts_turns, load_deflection
  use pose_types, only: pose_t
  use poses, only: body_angle
  use terminals, only: terminal_place
  use text, only: to_string
  implicit none (type, external)
  private

  public :: table_factor, refuse_beyond_tables, load_period

  !> By how much rounding may put a coordinate beyond the ends of a table, of its length.
  real(wp), parameter :: slack = 1.0e-12_wp

  !> Largest angle between a torsional spring and its rest; its sign changes at a half turn [rad].
  real(wp), parameter :: most_deflection = 170.0_wp*degree

contains

  !> Refuses a pose beyond the ends of a table, or with a torsional spring near half a turn from its
  !! rest, where its torque would jump.
  pure subroutine refuse_beyond_tables(linkage, pose, error)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! with the coordinate of the first drive
    type(error_t), allocatable, intent(inout) :: error !! allocated if there is such a table or
                                                       !! spring

    character(len=:), allocatable :: words
    real(wp) :: x, first, last
    integer :: i

    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%kind == applies_between .and. load%stiffness > 0.0_wp .and. &
          .not. counts_turns(linkage, load)) then
          if (abs(load_deflection(linkage, pose, load)) > most_deflection) then
            call set_error(error, error_of_numerics, "a torsional spring is turned by nearly "// &
              "half a turn or more, and its torque would jump")
            return
          end if
        end if
        if (load%over == over_nothing .or. load%table%is_periodic) cycle
        x = table_coordinate(linkage, pose, load)
        first = load%table%x(1)
        last = load%table%x(size(load%table%x))
        if (x >= first - slack*(last - first) .and. x <= last + slack*(last - first)) cycle
        words = "the table "//load%table_name//trim(merge(" begins later", " ends before ", &
          x < first))
        if (load%over == over_angle) words = words//": it is over the angle of the link '"// &
          load%over_name//"', here "//to_string(x/degree)//" deg; without 'over=' a table is "// &
          "over the first drive and its turns"
        call set_error(error, error_of_numerics, words)
        return
      end associate
    end do
  end subroutine refuse_beyond_tables

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
        if (load%kind == applies_between .and. load%body(1) == 0 .and. load%body(2) == 1 .and. &
          linkage%has_crank .and. load%stiffness > 0.0_wp) whole = 0.0_wp
        if (load%over /= over_drive) cycle
        if (.not. load%table%is_periodic) whole = 0.0_wp
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
    type(linkage_t), intent(in) :: linkage   !! its sliders and bodies
    type(pose_t), intent(in) :: pose         !! with the coordinate of the first drive
    type(applied_load_t), intent(in) :: load !! with a table or without
    real(wp) :: factor

    real(wp) :: values(3)

    factor = 1.0_wp
    if (load%over == over_nothing) return
    values = spline_values(load%table, table_coordinate(linkage, pose, load))
    factor = values(1)
  end function table_factor

  !> The coordinate that the table of a load is over [m] or [rad].
  pure function table_coordinate(linkage, pose, load) result(x)
    type(linkage_t), intent(in) :: linkage   !! its sliders and bodies
    type(pose_t), intent(in) :: pose         !! with the coordinate of the first drive
    type(applied_load_t), intent(in) :: load !! with a table
    real(wp) :: x

    select case (load%over)
    case (over_drive)
      x = pose%crank
      if (linkage%drives(1)%kind == drive_of_angle) x = x*degree
    case (over_slider)
      x = coordinate_value(linkage, pose, slider_coordinate(linkage, load%number))
    case (over_travel)
      x = dot_product(load%force, terminal_place(linkage, pose, load%at(1)) + pose%origin)/ &
        norm2(load%force)
    case (over_angle)
      x = body_angle(linkage, pose, load%number)
    case default
      x = 0.0_wp
    end select
  end function table_coordinate

end module load_tables
