!> `inertia.dat`: masses, their accelerations and inertia forces.
module inertia_report
  use drive_motions, only: drive_rates, place_columns, table_place
  use inertia_study, only: at_pin, loads_at_speed, mass_load_t, mass_t, of_block, of_body, on_link
  use kinds, only: wp
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: is_of_four_bar
  use report_kinds, only: four_bars, other_linkages, report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t, table_plan_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_inertia, describe_other_inertia

  !> Prefixes of the names of pins with masses, of links to which masses are fixed, and of the pins
  !! of blocks.
  character(len=*), parameter :: pin_mark = "pin:", mass_mark = "mass:", block_mark = "block:"

  !> `inertia.dat`.
  type, extends(state_table_t) :: inertia_table_t
  contains
    procedure, nopass :: find_notes => inertia_notes
    procedure, nopass :: plan => plan_inertia
    procedure, nopass :: add_position => add_inertia
  end type inertia_table_t

contains

  !> REPORT inertia.
  subroutine describe_inertia(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="inertia", help="masses, their accelerations and "// &
      "inertia forces", pattern="REPORT inertia [format=]", studies="inertia", &
      positions=.true., masses=.true., weighs=.true., reserved=.true., &
      numbers=46, linkages=four_bars)
    call add_table(report, inertia_table_t(), "inertia", "speed:speed crank:deg mass:# "// &
      "link:name x,y:length ax,ay:acceleration Fx,Fy:force m:mass moment?:moment")
  end subroutine describe_inertia

  !> REPORT inertia of linkages that are no four-bars.
  subroutine describe_other_inertia(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="inertia", help="of other linkages: masses and their "// &
      "inertia forces", pattern="REPORT inertia [format=]", studies="inertia", &
      positions=.true., masses=.true., weighs=.true., reserved=.true., &
      linkages=other_linkages)
    call add_table(report, inertia_table_t(), "inertia", "speed:speed crank:deg mass:# "// &
      "link:name x,y:length ax,ay:acceleration Fx,Fy:force m:mass moment:moment")
  end subroutine describe_other_inertia

  !> The kinds of masses in the table, and the crank's angular acceleration.
  pure subroutine inertia_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its inertia loads computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    associate (masses => variant%found%inertia%masses, mechanism => variant%mechanism)
      if (any(mechanism%load_elements > 0)) call append_string(notes, &
        "lumped inertia: masses on the mesh nodes, F = -m a")
      if (any(is_spread(mechanism))) call append_string(notes, &
        "distributed inertia: one row per link at its mass centre, F = -m a, "// &
        "moment = -I alpha about the mass centre"// &
        trim(merge(", with rotary inertia", "                     ", variant%model%rotary)))
      if (any(masses%kind == of_body)) call append_string(notes, "links with a mass of their "// &
        "own: one row per link at its mass centre, F = -m a, moment = -I alpha about it")
      if (has_segments(masses)) call append_string(notes, "links of several segments: one row "// &
        "per segment, likewise")
      if (any(masses%kind == on_link)) call append_string(notes, &
        "masses fixed to links in rows of their own, "//mass_mark//"LINK")
    end associate
    if (is_of_four_bar(variant%model, "inertia")) then
      call append_string(notes, "masses at pins in rows of their own")
    else
      call append_string(notes, "masses at pins, with those of sliders, in rows of their own; "// &
        block_mark//"PIN, the moment of a block that turns with a link")
    end if
    call append_string(notes, acceleration_note(variant%model))
  end subroutine inertia_notes

  !> Whether a link is several masses.
  pure function has_segments(masses) result(has)
    type(mass_t), intent(in) :: masses(:)
    logical :: has

    integer :: i

    has = .false.
    do i = 2, size(masses)
      has = has .or. (all(masses(i - 1:i)%kind == of_body) .and. masses(i - 1)%number == &
        masses(i)%number)
    end do
  end function has_segments

  !> Which links have mass distributed along them (bodies).
  pure function is_spread(mechanism) result(is)
    type(mechanism_t), intent(in) :: mechanism
    logical :: is(size(mechanism%names))

    is = mechanism%load_elements == 0 .and. mechanism%linkage%bodies%line_density > 0.0_wp
  end function is_spread

  !> Whether the table of a four-bar has a column of moments: not if all masses are point masses.
  pure function has_moments(variant) result(has)
    type(variant_results_t), intent(in) :: variant !! with its inertia loads computed
    logical :: has

    has = any(variant%found%inertia%masses%kind == of_body) .or. any(is_spread(variant%mechanism))
  end function has_moments

  !> Names in the column `link`: of links, of pins, of links to which masses are fixed, and of pins
  !! of blocks, the last three with their prefixes.
  pure function inertia_owners(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    integer :: i

    list%column = "link"
    associate (mechanism => variant%mechanism)
      do i = 1, size(mechanism%names)
        call append_string(list%names, mechanism%names(i)%text)
      end do
      do i = 1, size(mechanism%pin_names)
        call append_string(list%names, pin_mark//mechanism%pin_names(i)%text)
      end do
      do i = 1, size(mechanism%names)
        if (size(mechanism%linkage%bodies(i)%lumps) > 0) call append_string(list%names, &
          mass_mark//mechanism%names(i)%text)
      end do
      do i = 1, size(mechanism%linkage%sliders)
        if (mechanism%linkage%sliders(i)%inertia > 0.0_wp) call append_string(list%names, &
          block_mark//mechanism%pin_names(mechanism%linkage%sliders(i)%pin)%text)
      end do
    end associate
  end function inertia_owners

  !> Appends the rows of a position and speed, one per mass.
  subroutine add_inertia(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its inertia loads computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    type(mass_load_t) :: loads(size(variant%found%inertia%masses))
    real(wp) :: place(place_columns(variant%model)), rates(2), moment(merge(1, 0, &
      has_moments(variant) .or. .not. is_of_four_bar(variant%model, "inertia")))
    integer :: i, state, next

    state = variant%found%positions%state(position)
    place = table_place(variant%model, speed, position)
    next = size(place) + 1
    rates = drive_rates(variant%model, speed, position)
    associate (inertia => variant%found%inertia)
      call loads_at_speed(variant%mechanism%linkage, inertia, &
        variant%found%positions%states(state), state, rates(1), rates(2), loads)
      do i = 1, size(loads)
        moment = loads(i)%moment
        call add_row(rows, cells(layout, 1, place)//integer_cell(i, "mass")// &
          owner_cell(variant%mechanism, inertia%masses(i), column_width(layout, next + 1))// &
          cells(layout, next + 2, [loads(i)%place, loads(i)%acceleration, loads(i)%force, &
          inertia%masses(i)%mass, moment]))
      end do
    end associate
  end subroutine add_inertia

  !> The link or pin to which a mass belongs.
  pure function owner_cell(mechanism, mass, width) result(cell)
    type(mechanism_t), intent(in) :: mechanism
    type(mass_t), intent(in) :: mass
    integer, intent(in) :: width
    character(len=width) :: cell

    select case (mass%kind)
    case (at_pin)
      cell = name_cell(pin_mark//mechanism%pin_names(mass%number)%text, width)
    case (of_block)
      cell = name_cell(block_mark//mechanism%pin_names(mechanism%linkage%sliders(mass%number)% &
        pin)%text, width)
    case (on_link)
      cell = name_cell(mass_mark//mechanism%names(mass%number)%text, width)
    case default
      cell = name_cell(mechanism%names(mass%number)%text, width)
    end select
  end function owner_cell

  !> The owners of masses, and whether there are moments.
  subroutine plan_inertia(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = inertia_owners(variant)
    plan%has_optional = has_moments(variant)
  end subroutine plan_inertia

end module inertia_report
