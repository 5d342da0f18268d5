!> `coordinates.dat`: springs, dampers, rams, sliders and measures: how long they are, how they
!! move, what acts along them. `ratios.dat`: how they move per movement of one of them.
module coordinates_report
  use coordinate_columns, only: columns_in, shown_values, unit_names
  use coordinate_study, only: coordinate_ratio, coordinate_state, coordinate_state_t, &
    is_without_direction
  use drive_motions, only: drive_rates, place_columns, table_place
  use drive_positions, only: shown_crank
  use joint_study, only: drives_at_speed
  use kinds, only: wp
  use load_notes, only: acceleration_note, actuator_words
  use models, only: model_t, report_number
  use named_coordinates, only: find_named_coordinates, named_coordinate_t
  use natures, only: are_alike, nature_t, of_acceleration, of_effort, of_rate, of_value
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, rest_table_t, state_table_t, &
    table_plan_t
  use table_columns, only: cells, column_width, name_list_t, table_factor, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t
  use units, only: from_si, to_si
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_coordinates, shown_state, state_columns, coordinate_names, coordinate_notes, &
    state_at, find_lost_coordinate, has_direction, has_ratio, ratio_at, ratio_unit

  !> `coordinates.dat`.
  type, extends(state_table_t) :: coordinates_table_t
  contains
    procedure, nopass :: find_notes => coordinates_notes
    procedure, nopass :: plan => plan_coordinates
    procedure, nopass :: fit => fit_coordinates
    procedure, nopass :: add_position => add_coordinates
  end type coordinates_table_t

  !> `ratios.dat`.
  type, extends(rest_table_t) :: ratios_table_t
  contains
    procedure, nopass :: find_notes => ratios_notes
    procedure, nopass :: plan => plan_coordinates
    procedure, nopass :: fit => fit_ratios
    procedure, nopass :: add_at_rest => add_ratios
  end type ratios_table_t

contains

  !> REPORT coordinates.
  subroutine describe_coordinates(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="coordinates", help="springs, rams, sliders, measures: "// &
      "places, rates, forces", pattern="REPORT coordinates [ratio_to=] [columns=]", &
      studies="coordinates", positions=.true.)
    call add_table(report, coordinates_table_t(), "coordinates", "speed:speed crank:deg "// &
      "coordinate:name value,rate,acceleration,effort:see_head power:power")
    call add_table(report, ratios_table_t(), "ratios", "crank:deg coordinate:name ratio:see_head")
  end subroutine describe_coordinates

  !> Units and signs, the acceleration of the drive.
  pure subroutine coordinates_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = coordinate_notes(variant)
    call append_string(notes, acceleration_note(variant%model))
  end subroutine coordinates_notes

  !> What the rows of each coordinate are, where they have units of their own; signs.
  pure function coordinate_notes(variant) result(notes)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(string_t), allocatable :: notes(:)

    integer :: i

    allocate (notes(0))
    associate (listed => variant%mechanism%coordinates)
      do i = 1, size(listed)
        if (.not. are_alike(listed%nature)) call append_string(notes, listed(i)%name//": "// &
          unit_names(listed(i)%nature%words, variant%model%outputs))
      end do
    end associate
    call append_string(notes, "effort: of the spring, damper or drive itself, positive where "// &
      "it makes the coordinate grow: a stretched spring has an effort below 0")
    call append_string(notes, "power: effort times rate, what it gives the linkage")
    if (size(variant%model%actuators) > 0) call append_string(notes, &
      actuator_words(variant%model))
  end function coordinate_notes

  !> What the ratios are.
  pure subroutine ratios_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: i, reference

    reference = reference_of(variant%model)
    associate (listed => variant%mechanism%coordinates)
      allocate (notes(0))
      call append_string(notes, "ratio: change of the coordinate per change of "// &
        listed(reference)%name//"; a force along "// &
        "the coordinate is balanced by ratio times it along "//listed(reference)%name)
      if (are_alike(listed%nature)) return
      do i = 1, size(listed)
        if (i /= reference) call append_string(notes, listed(i)%name//": "// &
          ratio_unit(variant%model, listed([i, reference])%nature))
      end do
    end associate
  end subroutine ratios_notes

  !> The coordinate to which ratios refer.
  pure function reference_of(model) result(reference)
    type(model_t), intent(in) :: model
    integer :: reference

    reference = model%reports(report_number(model, "coordinates"))%reference
  end function reference_of

  !> The names in the column `coordinate`.
  pure function coordinate_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    integer :: i

    list%column = "coordinate"
    allocate (list%names(size(variant%mechanism%coordinates)))
    do i = 1, size(list%names)
      list%names(i)%text = variant%mechanism%coordinates(i)%name
    end do
  end function coordinate_names

  !> A column `coordinate`.
  subroutine plan_coordinates(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = coordinate_names(variant)
  end subroutine plan_coordinates

  !> Columns of values.
  pure function state_columns(model) result(columns)
    type(model_t), intent(in) :: model !! with its springs, drives and measures
    character(len=:), allocatable :: columns

    type(named_coordinate_t), allocatable :: named(:)

    call find_named_coordinates(model, named)
    columns = columns_in(named%nature, "value rate acceleration effort", [of_value, of_rate, &
      of_acceleration, of_effort])//" power:power"
  end function state_columns

  pure subroutine fit_coordinates(model, columns)
    type(model_t), intent(in) :: model         !! with its springs, drives and measures
    character(len=*), intent(inout) :: columns !! of the record

    columns = "speed:speed crank:deg coordinate:name "//state_columns(model)
    call fit_columns(model, columns)
  end subroutine fit_coordinates

  pure subroutine fit_ratios(model, columns)
    type(model_t), intent(in) :: model         !! with its springs, drives and measures
    character(len=*), intent(inout) :: columns !! of the record

    type(named_coordinate_t), allocatable :: named(:)

    call find_named_coordinates(model, named)
    if (are_alike(named%nature)) columns = "crank:deg coordinate:name ratio:-"
    call fit_columns(model, columns)
  end subroutine fit_ratios

  !> Appends the rows of a position and speed, one per coordinate.
  subroutine add_coordinates(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: place(place_columns(variant%model))
    integer :: i

    associate (listed => variant%mechanism%coordinates)
      do i = 1, size(listed)
        if (has_direction(variant, position, i)) then
          call add_position_row(variant, layout, position, speed, shown_state(variant, &
            i, state_at(variant, position, speed, i)), rows, listed(i)%name)
        else
          place = table_place(variant%model, speed, position)
          call add_meeting_row(variant, i, place, rows)
        end if
      end do
    end associate
  end subroutine add_coordinates

  !> A coordinate at a position and speed.
  pure function state_at(variant, position, speed, number) result(state)
    type(variant_results_t), intent(in) :: variant !! with its positions, and forces of drives that
                                                   !! move along
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    integer, intent(in) :: number                  !! of the coordinate, from 1
    type(coordinate_state_t) :: state

    real(wp) :: drives(3, size(variant%mechanism%linkage%drives)), rates(2), force

    rates = drive_rates(variant%model, speed, position)
    force = 0.0_wp
    associate (positions => variant%found%positions, linkage => variant%mechanism%linkage, &
        listed => variant%mechanism%coordinates(number))
      if (listed%drive > 0) then
        drives = drives_at_speed(linkage, variant%found%joints, &
          positions%states(positions%state(position)), positions%state(position), &
          positions%crank(position), rates(1), rates(2), speed)
        force = drives(3, listed%drive)
      end if
      associate (at => positions%states(positions%state(position)))
        state = coordinate_state(linkage, at%pose, at%coefficients, positions%crank(position), &
          number, force, rates)
      end associate
    end associate
  end function state_at

  !> The values of a row: in SI but for degrees, and where the columns have no unit in those of the
  !! results.
  pure function shown_state(variant, number, state) result(values)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    integer, intent(in) :: number                  !! of the coordinate
    type(coordinate_state_t), intent(in) :: state
    real(wp) :: values(5)

    values = [state%value, state%rate, state%acceleration, state%effort, state%power]
    associate (listed => variant%mechanism%coordinates)
      if (.not. are_alike(listed%nature)) values(:4) = shown_values(values(:4), &
        listed(number)%nature%words, variant%model%outputs)
    end associate
  end function shown_state

  !> A failed row where the ends of a coordinate meet.
  subroutine add_meeting_row(variant, number, place, rows)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: number       !! of the coordinate
    real(wp), intent(in) :: place(:)    !! first values of the row
    type(rows_t), intent(inout) :: rows

    character(len=:), allocatable :: words

    ! One thread at a time makes texts.
    !$omp critical (one_at_a_time)
    words = meeting_words(variant, number)
    !$omp end critical (one_at_a_time)
    call add_failed_row(rows, place, words)
  end subroutine add_meeting_row

  !> Why a coordinate has no rate.
  pure function meeting_words(variant, number) result(words)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    integer, intent(in) :: number                  !! of the coordinate
    character(len=:), allocatable :: words

    words = "the ends of '"//variant%mechanism%coordinates(number)%name//"' meet: its line has "// &
      "no direction"
  end function meeting_words

  !> Appends the rows of a position: the ratio of every other coordinate; one failed row where the
  !! reference does not move.
  subroutine add_ratios(variant, layout, position, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    character(len=:), allocatable :: words
    real(wp) :: place(1)
    integer :: i, reference

    reference = reference_of(variant%model)
    place = variant%found%positions%crank(position)
    if (.not. has_ratio(variant, position, reference)) then
      ! One thread at a time makes texts.
      !$omp critical (one_at_a_time)
      words = why_without_ratio(variant, position, reference)
      !$omp end critical (one_at_a_time)
      call add_failed_row(rows, [shown_crank(variant, place(1))], words)
      return
    end if
    associate (listed => variant%mechanism%coordinates)
      do i = 1, size(listed)
        if (i /= reference) call add_row(rows, cells(layout, 1, place)//name_cell(listed(i)%name, &
          column_width(layout, 2))//cells(layout, 3, [ratio_at(variant, position, i, reference)]))
      end do
    end associate
  end subroutine add_ratios

  !> Why a row of a position fails; empty if none does.
  pure function find_lost_coordinate(variant, position) result(words)
    type(variant_results_t), intent(in) :: variant !! with its positions
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    character(len=:), allocatable :: words

    integer :: i

    words = ""
    do i = 1, size(variant%mechanism%coordinates)
      if (has_direction(variant, position, i)) cycle
      words = meeting_words(variant, i)
      return
    end do
    do i = 1, size(variant%model%reports)
      associate (reference => variant%model%reports(i)%reference)
        if (reference == 0 .or. len(words) > 0) cycle
        if (.not. has_ratio(variant, position, reference)) words = why_without_ratio(variant, &
          position, reference)
      end associate
    end do
  end function find_lost_coordinate

  !> The ratio of a coordinate to another one at a position, in the units of lengths of the results
  !! and radians.
  pure function ratio_at(variant, position, number, reference) result(ratio)
    type(variant_results_t), intent(in) :: variant !! with its positions
    integer, intent(in) :: position                !! number in the deck's list, where `has_ratio`
    integer, intent(in) :: number, reference       !! of the coordinates
    real(wp) :: ratio

    logical :: moves

    associate (positions => variant%found%positions, linkage => variant%mechanism%linkage, &
        listed => variant%mechanism%coordinates, outputs => variant%model%outputs)
      associate (at => positions%states(positions%state(position)))
        call coordinate_ratio(linkage, at%pose, at%coefficients, number, reference, ratio, moves)
      end associate
      if (.not. are_alike(listed([number, reference])%nature)) ratio = to_si(from_si(ratio, &
        table_factor(listed(number)%nature%in_ratio, outputs)), &
        table_factor(listed(reference)%nature%in_ratio, outputs))
    end associate
  end function ratio_at

  !> Unit of a ratio.
  pure function ratio_unit(model, natures) result(unit)
    type(model_t), intent(in) :: model
    type(nature_t), intent(in) :: natures(2) !! of the coordinate, of that to which it is compared
    character(len=:), allocatable :: unit

    unit = "-"
    if (.not. are_alike(natures)) unit = unit_names(natures%in_ratio, model%outputs, "/")
  end function ratio_unit

  !> Whether a coordinate moves at a position, so that others have ratios to it.
  pure function has_ratio(variant, position, reference) result(has)
    type(variant_results_t), intent(in) :: variant !! with its positions
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: reference               !! number of the coordinate
    logical :: has

    real(wp) :: ratio

    has = has_direction(variant, position, reference)
    if (.not. has) return
    associate (linkage => variant%mechanism%linkage, positions => variant%found%positions)
      associate (at => positions%states(positions%state(position)))
        call coordinate_ratio(linkage, at%pose, at%coefficients, reference, reference, ratio, has)
      end associate
    end associate
  end function has_ratio

  !> Why it does not move.
  pure function why_without_ratio(variant, position, reference) result(words)
    type(variant_results_t), intent(in) :: variant !! with its positions
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: reference               !! number of the coordinate
    character(len=:), allocatable :: words

    if (has_direction(variant, position, reference)) then
      words = "'"//variant%mechanism%coordinates(reference)%name//"' does not move there: "// &
        "nothing has a ratio to it"
    else
      words = meeting_words(variant, reference)
    end if
  end function why_without_ratio

  !> Whether a coordinate has a rate at a position.
  pure function has_direction(variant, position, number) result(has)
    type(variant_results_t), intent(in) :: variant !! with its positions
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: number                  !! of the coordinate
    logical :: has

    associate (linkage => variant%mechanism%linkage, positions => variant%found%positions)
      has = .not. is_without_direction(linkage, positions%states(positions%state(position))%pose, &
        linkage%coordinates(number))
    end associate
  end function has_direction

end module coordinates_report
