!> `geometry.dat` and `motion_places.dat`: pins, links and points at any crank angles, and at the
!! instants of a motion, for drawings.
module geometry_report
  use geometry_study, only: geometry_result_t
  use kinds, only: wp
  use linkage_notes, only: notes_on_linkage
  use mechanisms, only: pins_of_body
  use motion_pins_report, only: add_early_end, time_in_table
  use points_report, only: point_names
  use models, only: model_t, runs_in_time
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, table_plan_t, whole_table_t
  use spring_cards, only: spring_card_t
  use table_columns, only: cells, column_width, in_column, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell, real_cells
  use text, only: append_string, same_word, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_geometry

  !> Stands in the column `link` for the fixed pivots.
  character(len=*), parameter :: ground = "(ground)"

  !> `geometry.dat`.
  type, extends(whole_table_t) :: geometry_table_t
  contains
    procedure, nopass :: find_notes => geometry_notes
    procedure, nopass :: fit => fit_geometry
    procedure, nopass :: plan => plan_geometry
    procedure, nopass :: add_all => add_geometry
  end type geometry_table_t

  !> `motion_places.dat`.
  type, extends(whole_table_t) :: motion_places_table_t
  contains
    procedure, nopass :: find_notes => places_notes
    procedure, nopass :: plan => plan_geometry
    procedure, nopass :: add_all => add_motion_places
  end type motion_places_table_t

contains

  !> REPORT geometry.
  subroutine describe_geometry(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="geometry", help="where pins, links and points are, for "// &
      "drawings", pattern="REPORT geometry crank=a,b,... [time=a,b,...]", offered=.false., &
      studies="geometry")
    call add_table(report, geometry_table_t(), "geometry", "crank:deg link,part,place:name x,"// &
      "y:length")
    call add_table(report, motion_places_table_t(), "motion_places", "time:time link,part,"// &
      "place:name x,y:length")
  end subroutine describe_geometry

  !> Class, limit positions and transmission angles of the linkage, and the order of the rows.
  pure subroutine geometry_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with class and kinematics computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = notes_on_linkage(variant)
    call append_row_notes(variant, notes)
  end subroutine geometry_notes

  !> The order of the rows.
  pure subroutine places_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_row_notes(variant, notes)
  end subroutine places_notes

  pure subroutine append_row_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant
    type(string_t), allocatable, intent(inout) :: notes(:)

    call append_string(notes, &
      "links one after the other, each from pin to pin, then its points; global axes")
    if (size(variant%mechanism%linkage%sliders) > 0) call append_string(notes, &
      "then the sliders on guides and links; ahead: 1 m from a slider in the sense of its line")
    if (size(variant%model%springs) > 0) call append_string(notes, "then springs and dampers "// &
      "with both ends; torsional ones with their pin, and side: a pin of each link there")
  end subroutine append_row_notes

  !> The names in the columns `link`, `part` and `place`.
  pure function geometry_words(variant) result(lists)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: lists(3)

    type(name_list_t) :: points
    integer :: i, k

    lists(1)%column = "link"
    lists(1)%names = variant%mechanism%names
    call append_string(lists(1)%names, ground)
    do i = 1, size(variant%model%guides)
      call append_string(lists(1)%names, variant%model%guides(i)%name%text)
    end do
    do i = 1, size(variant%model%springs)
      call append_string(lists(1)%names, variant%model%springs(i)%name%text)
    end do
    lists(2)%column = "part"
    call append_string(lists(2)%names, "pin")
    call append_string(lists(2)%names, "point")
    if (size(variant%mechanism%linkage%sliders) > 0) then
      call append_string(lists(2)%names, "slider")
      call append_string(lists(2)%names, "ahead")
    end if
    if (size(variant%model%springs) > 0) then
      call append_string(lists(2)%names, "spring")
      call append_string(lists(2)%names, "damper")
      call append_string(lists(2)%names, "side")
    end if
    lists(3)%column = "place"
    lists(3)%names = variant%mechanism%pin_names
    do i = 1, size(variant%model%springs)
      ! One may be on a GROUND pin that is none of the linkage.
      do k = 1, merge(1, 2, variant%model%springs(i)%turns)
        call append_string(lists(3)%names, variant%model%springs(i)%ends(k)%text)
      end do
    end do
    points = point_names(variant)
    do i = 1, size(points%names)
      call append_string(lists(3)%names, points%names(i)%text)
    end do
  end function geometry_words

  !> Appends the rows of all positions, one after the other.
  subroutine add_geometry(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its geometry computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (found => variant%found%geometry)
      do i = 1, size(found%crank)
        if (i > 1) call add_gap(rows, 2)
        if (allocated(found%outcome(i)%error)) then
          call add_failed_row(rows, [in_column(layout, 1, found%crank(i))], &
            found%outcome(i)%error%text)
        else
          call add_drawing(variant, layout, found, i, cells(layout, 1, [found%crank(i)]), rows)
        end if
      end do
    end associate
  end subroutine add_geometry

  !> Of several drives with laws the linkage is where it is at instants.
  pure subroutine fit_geometry(model, columns)
    type(model_t), intent(in) :: model         !! with its drives
    character(len=*), intent(inout) :: columns !! of the record

    if (runs_in_time(model)) columns = "time:time link,part,place:name x,y:length"
    call fit_columns(model, columns)
  end subroutine fit_geometry

  !> Appends the rows of all instants, and a failed row if the motion ends before its end time.
  subroutine add_motion_places(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion and the places in it
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    do i = 1, variant%found%motion%count
      if (i > 1) call add_gap(rows, 2)
      call add_drawing(variant, layout, variant%found%motion_places, i, real_cells( &
        [time_in_table(variant%model, i)]), rows)
    end do
    call add_early_end(variant, rows)
  end subroutine add_motion_places

  !> Appends the rows of a position. One empty line between links and between a link and its points,
  !! and before a slider or a spring.
  subroutine add_drawing(variant, layout, found, position, first, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    type(geometry_result_t), intent(in) :: found
    integer, intent(in) :: position       !! its number in these
    character(len=*), intent(in) :: first !! cell of every row: crank angle or time
    type(rows_t), intent(inout) :: rows

    integer, allocatable :: pins(:)
    character(len=:), allocatable :: line
    integer :: body, pin, point, slider, i
    logical :: is_first

    associate (linkage => variant%mechanism%linkage, points => variant%mechanism%points, &
        names => variant%mechanism%names, pin_names => variant%mechanism%pin_names)
      do pin = 1, size(linkage%is_ground)
        if (linkage%is_ground(pin)) call add_place(layout, first, ground, "pin", &
          pin_names(pin)%text, found%pin(:, pin, position), rows)
      end do
      do body = 1, size(linkage%bodies)
        call add_gap(rows, 1)
        pins = pins_of_body(linkage%bodies(body))
        do i = 1, size(pins)
          call add_place(layout, first, names(body)%text, "pin", &
            pin_names(pins(i))%text, found%pin(:, pins(i), position), rows)
        end do
        is_first = .true.
        do point = 1, size(points)
          if (points(point)%body /= body) cycle
          if (is_first) call add_gap(rows, 1)
          is_first = .false.
          call add_place(layout, first, names(body)%text, "point", &
            points(point)%name, found%point(:, point, position), rows)
        end do
      end do
      do slider = 1, size(linkage%sliders)
        call add_gap(rows, 1)
        pin = linkage%sliders(slider)%pin
        call find_line_name(variant, slider, line)
        call add_place(layout, first, line, "slider", pin_names(pin)%text, &
          found%pin(:, pin, position), rows)
        call add_place(layout, first, line, "ahead", pin_names(pin)%text, &
          found%ahead(:, slider, position), rows)
      end do
      do i = 1, size(variant%model%springs)
        call add_gap(rows, 1)
        call add_spring(variant, layout, variant%model%springs(i), found, position, first, rows)
      end do
    end associate
  end subroutine add_drawing

  !> Appends two rows for the ends of a spring or damper, or, for a torsional one, a row for its pin
  !! and one for each of its links, as the card names them: the first pin of that link that is
  !! another one. A single link turns against the ground.
  subroutine add_spring(variant, layout, spring, found, position, first, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    type(spring_card_t), intent(in) :: spring
    type(geometry_result_t), intent(in) :: found
    integer, intent(in) :: position
    character(len=*), intent(in) :: first
    type(rows_t), intent(inout) :: rows

    character(len=:), allocatable :: part
    integer, allocatable :: pins(:)
    integer :: k, i, body

    part = trim(merge("damper", "spring", spring%damps))
    associate (mechanism => variant%mechanism)
      do k = 1, merge(1, 2, spring%turns)
        call add_place(layout, first, spring%name%text, part, spring%ends(k)%text, &
          place_of(variant, spring%ends(k)%text, found, position), rows)
      end do
      if (.not. spring%turns) return
      do k = 1, 2
        if (spring%link(k) == 0) cycle
        body = findloc(mechanism%links, spring%link(k), dim=1)
        pins = pins_of_body(mechanism%linkage%bodies(body))
        do i = 1, size(pins)
          if (same_word(mechanism%pin_names(pins(i))%text, spring%ends(1)%text)) cycle
          call add_place(layout, first, spring%name%text, "side", &
            mechanism%pin_names(pins(i))%text, found%pin(:, pins(i), position), rows)
          exit
        end do
      end do
    end associate
  end subroutine add_spring

  !> Where an end of a spring is: a pin, a POINT, or a GROUND pin that only springs use [m].
  pure function place_of(variant, name, found, position) result(x)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: name
    type(geometry_result_t), intent(in) :: found
    integer, intent(in) :: position
    real(wp) :: x(2)

    integer :: i

    x = 0.0_wp
    associate (mechanism => variant%mechanism, grounds => variant%model%grounds)
      do i = 1, size(grounds)
        if (same_word(grounds(i)%pin%text, name)) x = grounds(i)%position
      end do
      do i = 1, size(mechanism%points)
        if (same_word(mechanism%points(i)%name, name)) x = found%point(:, i, position)
      end do
      do i = 1, size(mechanism%pin_names)
        if (same_word(mechanism%pin_names(i)%text, name)) x = found%pin(:, i, position)
      end do
    end associate
  end function place_of

  !> The guide or the link along which a slider slides.
  pure subroutine find_line_name(variant, slider, name)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: slider !! number
    character(len=:), allocatable, intent(out) :: name

    associate (card => variant%model%sliders(slider), &
        body => variant%mechanism%linkage%sliders(slider)%body)
      if (body > 0) then
        name = variant%mechanism%names(body)%text
      else
        name = variant%model%guides(card%guide)%name%text
      end if
    end associate
  end subroutine find_line_name

  !> Appends a row.
  subroutine add_place(layout, first, link, part, place, x, rows)
    type(table_layout_t), intent(in) :: layout
    character(len=*), intent(in) :: first, link, part, place
    real(wp), intent(in) :: x(2)
    type(rows_t), intent(inout) :: rows

    call add_row(rows, first//name_cell(link, column_width(layout, 2))// &
      name_cell(part, column_width(layout, 3))//name_cell(place, column_width(layout, 4))// &
      cells(layout, 5, x))
  end subroutine add_place

  !> Names of links, parts and places.
  subroutine plan_geometry(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(:3) = geometry_words(variant)
  end subroutine plan_geometry

end module geometry_report
