!> `frequencies.dat`, `shapes.dat` and `shape_pins.dat`: natural frequencies with their estimated
!! errors, mode shapes.
module frequency_report
  use drive_positions, only: shown_crank
  use errors, only: error_t
  use frequency_study, only: damping_values, failure_at, find_displacements, &
    find_stations, frequency_values, has_result, link_of_part
  use joint_kinds, only: joint_words, kinds_of_joints
  use joint_study, only: joint_t, list_joints
  use joints_report, only: owner_cell, plan_joints
  use kinds, only: wp
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: effects_static, inertia_distributed, inertia_lumped, is_damped, is_loaded, &
    is_moving, is_sprung, model_t, needs_loads, report_number, speed_in_table
  use points_report, only: point_names
  use report_cards, only: report_t
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, fit_columns, need_not_look_back, plan_links, &
    position_table_t, report_record_t, table_plan_t
  use table_columns, only: cells, column_width, name_list_t, table_factor, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t, to_string, trimmed_list
  use units, only: from_si, to_si, unit_t
  use value_lists, only: value_list_t, value_number
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_frequencies, describe_shapes, effects_notes, is_drawn, shown_speed

  !> `frequencies.dat`.
  type, extends(position_table_t) :: frequency_table_t
  contains
    procedure, nopass :: looks_back => need_not_look_back
    procedure, nopass :: find_notes => frequency_notes
    procedure, nopass :: plan => plan_frequencies
    procedure, nopass :: fit => fit_frequencies
    procedure, nopass :: count_speeds => speeds_of_sweep
    procedure, nopass :: add_position => add_frequencies
  end type frequency_table_t

  !> `shapes.dat`.
  type, extends(position_table_t) :: shape_table_t
  contains
    procedure, nopass :: find_notes => shape_notes
    procedure, nopass :: plan => plan_shapes
    procedure, nopass :: count_speeds => speeds_of_sweep
    procedure, nopass :: add_position => add_shapes
  end type shape_table_t

  !> `shape_pins.dat`.
  type, extends(position_table_t) :: shape_pins_table_t
  contains
    procedure, nopass :: find_notes => shape_pins_notes
    procedure, nopass :: plan => plan_shape_pins
    procedure, nopass :: count_speeds => speeds_of_sweep
    procedure, nopass :: add_position => add_shape_pins
  end type shape_pins_table_t

contains

  !> REPORT frequencies.
  subroutine describe_frequencies(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="frequencies", help="natural frequencies with estimated "// &
      "errors", pattern="REPORT frequencies [columns=]", studies="frequencies", positions=.true., &
      beams=.true., frequencies=.true., reserved=.true.)
    call add_table(report, frequency_table_t(), "frequencies", "speed:speed crank:deg f*:Hz "// &
      "error*:-")
  end subroutine describe_frequencies

  !> REPORT shapes.
  subroutine describe_shapes(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="shapes", help="mode shapes along the links", &
      pattern="REPORT shapes [crank=a,b,...] [speed=...] [points=]", default="points=21", &
      studies="frequencies", positions=.true., beams=.true., frequencies=.true., reserved=.true.)
    call add_table(report, shape_table_t(), "shapes", "speed:speed crank:deg mode:# "// &
      "frequency:Hz link:name s,x,y:length ux,uy:mass^-1/2 rotation:rotation")
    call add_table(report, shape_pins_table_t(), "shape_pins", "speed:speed crank:deg mode:# "// &
      "pin,link,joint:name x,y:length ux,uy:mass^-1/2 rotation:rotation")
  end subroutine describe_shapes

  !> Effects in the equations, motions that nothing holds, and the meaning of the error columns.
  pure subroutine frequency_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its sweep computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: free

    notes = effects_notes(variant%model)
    free = variant%found%sweep%models%continuum%layout%free
    if (free > 0) call append_string(notes, "free motions: "//to_string(free)// &
      trim(merge(" (held by loads alone)", " (frequency 0)        ", needs_loads(variant%model))))
    call append_string(notes, &
      "error1, error2, ...: estimated relative errors of f1, f2, ...: of mesh and round-off")
    if (is_damped(variant%model)) call add_damper_notes(variant%model, notes)
  end subroutine frequency_notes

  !> What frequencies are with dampers.
  pure subroutine add_damper_notes(model, notes)
    type(model_t), intent(in) :: model
    type(string_t), allocatable, intent(inout) :: notes(:)

    call append_string(notes, "with dampers, motions like exp(s t): f1, f2, ... are "// &
      "|s|/(2 pi), ascending by size, of every complex pair "// &
      "s = 2 pi f (-zeta +- i sqrt(1 - zeta^2)) and of every real s by itself")
    call append_string(notes, "zeta1, zeta2, ...: their damping ratios -Re s/|s|: 1 of a "// &
      "real s < 0, which does not swing, of which a mode has two; -1 of s > 0; 0 of s = 0; "// &
      "each is off by its error at most")
    if (needs_loads(model) .and. is_moving(model)) call append_string(notes, &
      "the forces by which dampers resist the motion of the linkage are not among the loads")
  end subroutine add_damper_notes

  !> Effects in the equations of the frequencies: axial forces of which loads, rotary inertia,
  !! shear.
  pure function effects_notes(model) result(notes)
    type(model_t), intent(in) :: model !! with frequencies
    type(string_t), allocatable :: notes(:)

    if (model%effects == effects_static) then
      call append_string(notes, &
        "static frequencies of the instantaneous structure; they do not depend on the speed")
    else if (.not. needs_loads(model)) then
      call append_string(notes, &
        "frequencies of the instantaneous structure at rest: no axial forces")
    else
      call append_string(notes, &
        "frequencies of the instantaneous structure with the axial forces of its "// &
        loads_in_words(model))
      call append_string(notes, acceleration_note(model))
      call append_string(notes, "a negative frequency stands for sqrt(-lambda)/(2 pi) of a "// &
        "negative eigenvalue: static divergence")
    end if
    if (model%rotary .and. model%shear) then
      call append_string(notes, "links with rotary inertia and shear (Timoshenko)")
    else if (model%rotary) then
      call append_string(notes, "links with rotary inertia (Rayleigh)")
    else if (model%shear) then
      call append_string(notes, "links with shear")
    end if
  end function effects_notes

  !> `motion; lumped inertia`
  pure function loads_in_words(model) result(words)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: words

    words = ""
    if (is_moving(model)) words = " and of motion"
    if (is_loaded(model)) words = words//" and of constant loads"
    if (is_sprung(model)) words = words//" and of springs"
    words = words(9:)
    if (model%inertia == inertia_lumped) words = words//"; lumped inertia"
    if (model%inertia == inertia_distributed) words = words//"; distributed inertia"
  end function loads_in_words

  !> Appends the row of a position and speed, or a failed row.
  subroutine add_frequencies(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its sweep computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list
    integer, intent(in) :: speed                   !! number in the sweep's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (found => variant%found, state => variant%found%positions%state(position))
      associate (place => [shown_speed(variant, speed), found%positions%crank(position)])
        if (has_result(found%positions, found%sweep, state, speed)) then
          if (is_damped(variant%model)) then
            call add_row(rows, cells(layout, 1, [place, frequency_values(found%sweep, state, &
              speed), damping_values(found%sweep, state, speed)]))
          else
            call add_row(rows, cells(layout, 1, [place, frequency_values(found%sweep, state, &
              speed)]))
          end if
        else
          call add_failed(variant, position, speed, rows)
        end if
      end associate
    end associate
  end subroutine add_frequencies

  !> A row without a result, with the reason.
  subroutine add_failed(variant, position, speed, rows)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    type(error_t) :: error

    associate (found => variant%found)
      error = failure_at(found%positions, found%sweep, found%positions%state(position), speed)
      call add_failed_row(rows, [shown_speed(variant, speed), shown_crank(variant, &
        found%positions%crank(position))], error%text)
    end associate
  end subroutine add_failed

  !> A speed of the sweep in the unit of results.
  pure function shown_speed(variant, speed) result(value)
    type(variant_results_t), intent(in) :: variant !! with its sweep
    integer, intent(in) :: speed                   !! number in the sweep's list
    real(wp) :: value

    value = speed_in_table(variant%model, speed, variant%found%sweep%request%speed(speed))
  end function shown_speed

  !> Effects in the equations, normalisation of the shapes, direction of `s`.
  pure subroutine shape_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: b

    notes = effects_notes(variant%model)
    associate (mechanism => variant%mechanism)
      if (mechanism%is_four_bar .and. size(mechanism%pin_names) == 4) then
        call append_string(notes, "shapes are normalised: phi' M phi = 1; s runs along each "// &
          "link round the loop from "//mechanism%pin_names(1)%text//" to "// &
          mechanism%pin_names(4)%text)
        return
      end if
      call append_string(notes, "shapes are normalised: phi' M phi = 1; s runs along the pins "// &
        "of each link")
      do b = 1, size(mechanism%names)
        call append_string(notes, "s along link "//mechanism%names(b)%text//": "// &
          way_along(mechanism, b))
      end do
    end associate
  end subroutine shape_notes

  !> `A - B - C`: the pins along a link.
  pure function way_along(mechanism, body) result(words)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: body !! number
    character(len=:), allocatable :: words

    integer, allocatable :: pins(:)
    integer :: i

    associate (link => mechanism%linkage%bodies(body))
      pins = [link%first_pin, link%last_pin]
      if (allocated(link%corners)) pins = link%corners
    end associate
    words = mechanism%pin_names(pins(1))%text
    do i = 2, size(pins)
      words = words//" - "//mechanism%pin_names(pins(i))%text
    end do
  end function way_along

  !> Positions and speeds whose shapes are requested, in the order of the table.
  pure function drawn_rows(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with REPORT shapes, its sweep computed
    integer, allocatable :: list(:, :)             !! (position and speed, rows)

    integer :: all(2, size(variant%found%positions%crank)*size(variant%found%sweep%request%speed))
    integer :: i, k, n

    n = 0
    associate (crank => variant%found%positions%crank, speed => variant%found%sweep%request%speed, &
        report => variant%model%reports(report_number(variant%model, "shapes")))
      do k = 1, size(speed)
        do i = 1, size(crank)
          if (.not. is_drawn(report, crank(i), speed(k))) cycle
          n = n + 1
          all(:, n) = [i, k]
        end do
      end do
    end associate
    list = all(:, :n)
  end function drawn_rows

  !> Whether REPORT shapes requests a position and speed. Without `crank=` it requests all
  !! positions, without `speed=` all speeds.
  pure function is_drawn(report, crank, speed) result(is)
    type(report_t), intent(in) :: report !! the card
    real(wp), intent(in) :: crank        !! [deg]
    real(wp), intent(in) :: speed        !! [rad/s]
    logical :: is

    is = is_chosen(report%crank, crank) .and. is_chosen(report%speed, speed)
  end function is_drawn

  !> Whether a list contains a value; an empty list contains all.
  pure function is_chosen(list, value) result(is)
    type(value_list_t), intent(in) :: list
    real(wp), intent(in) :: value
    logical :: is

    is = size(list%value) == 0
    if (.not. is) is = value_number(list, value) > 0
  end function is_chosen

  !> Appends the rows along every link, for every mode at a position and speed, or one failed row.
  !! One empty line between links, two between modes.
  subroutine add_shapes(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its sweep computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list
    integer, intent(in) :: speed                   !! number in the sweep's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp), allocatable :: frequencies(:), station(:, :, :)
    integer :: mode

    associate (found => variant%found, state => variant%found%positions%state(position))
      if (.not. has_result(found%positions, found%sweep, state, speed)) then
        call add_failed(variant, position, speed, rows)
        return
      end if
      frequencies = frequency_values(found%sweep, state, speed)
      call find_stations(variant%mechanism%structure_t, found%positions%states(state), &
        found%sweep%request%points, station)
      do mode = 1, variant%model%modes
        if (mode > 1) call add_gap(rows, 2)
        call add_mode(variant, layout, position, speed, mode, frequencies(mode), station, rows)
      end do
    end associate
  end subroutine add_shapes

  !> The rows of a mode. A corner of a link stands twice, as the end of one part and where the next
  !! begins.
  subroutine add_mode(variant, layout, position, speed, mode, frequency, station, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: position, speed, mode
    real(wp), intent(in) :: frequency !! [Hz]
    real(wp), intent(in) :: station(:, :, :) !! (3, points, parts) by `find_stations` [m]
    type(rows_t), intent(inout) :: rows

    real(wp) :: place(2)
    integer :: part, link, before, i, state

    state = variant%found%positions%state(position)
    place = [shown_speed(variant, speed), variant%found%positions%crank(position)]
    associate (shape => variant%found%sweep%results(state)%shapes(speed)%displacement)
      before = 0
      do part = 1, size(shape, 3)
        link = link_of_part(variant%mechanism%structure_t, part)
        if (before > 0 .and. link /= before) call add_gap(rows, 1)
        before = link
        do i = 1, size(shape, 2)
          call add_row(rows, cells(layout, 1, place)//integer_cell(mode, "mode")// &
            cells(layout, 4, [frequency])//name_cell(variant%mechanism%names(link)%text, &
            column_width(layout, 5))//cells(layout, 6, [distance(station(1, :, part), i), &
            station(2:, i, part), shown_displacement(variant, shape(:, i, part, mode))]))
        end do
      end do
    end associate

  contains

    !> The distance along a link of one of equal parts, which is a share of a length in the unit of
    !! the table, without the rounding of another.
    pure function distance(along, i)
      real(wp), intent(in) :: along(:) !! [m]
      integer, intent(in) :: i
      real(wp) :: distance

      type(unit_t) :: length
      real(wp) :: ends(2)

      length = table_factor("length", variant%model%outputs)
      associate (n => size(along))
        ends = from_si(along([1, n]), length)
        distance = to_si((ends(1)*(n - i) + ends(2)*(i - 1))/(n - 1), length)
      end associate
    end function distance

  end subroutine add_mode

  !> A displacement of a normalised mode, which has the unit mass^(-1/2), and a rotation.
  pure function shown_displacement(variant, displacement) result(shown)
    type(variant_results_t), intent(in) :: variant
    real(wp), intent(in) :: displacement(3) !! as of `shapes_t`
    real(wp) :: shown(3)

    shown = sqrt(to_si(1.0_wp, table_factor("mass", variant%model%outputs)))*displacement
    shown(3) = to_si(shown(3), table_factor("length", variant%model%outputs))
  end function shown_displacement

  !> Effects in the equations, rows, what holds joints.
  pure subroutine shape_pins_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = effects_notes(variant%model)
    call append_string(notes, "shapes are normalised: phi' M phi = 1; every link at its pins, "// &
      "then blocks, which move with their pin and turn with their line")
    if (size(rigid_points(variant)) > 0) call append_string(notes, "then POINTs of rigid links")
    call append_string(notes, "joint: clamped to the ground, driven against another link or "// &
      "along its line, welded to all that is there, pinned to it, free where nothing is")
  end subroutine shape_pins_notes

  !> The POINTs of rigid links.
  pure function rigid_points(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    integer, allocatable :: list(:)                !! their numbers

    integer :: p

    associate (points => variant%mechanism%points, bodies => variant%mechanism%linkage%bodies)
      list = pack([(p, p=1, size(points))], .not. bodies(points%body)%bends)
    end associate
  end function rigid_points

  !> Appends the rows of all joints, and of points of rigid links, for every mode at a position and
  !! speed, or one failed row. Two empty lines between modes.
  subroutine add_shape_pins(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its sweep computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list
    integer, intent(in) :: speed                   !! number in the sweep's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    type(joint_t), allocatable :: joints(:)
    integer, allocatable :: kinds(:), points(:)
    real(wp), allocatable :: x(:, :), moved(:, :, :)
    real(wp) :: places(2, size(variant%mechanism%points))
    integer :: mode, i

    associate (found => variant%found, mechanism => variant%mechanism, &
        state => variant%found%positions%state(position))
      if (.not. has_result(found%positions, found%sweep, state, speed)) then
        call add_failed(variant, position, speed, rows)
        return
      end if
      call list_joints(mechanism%linkage, joints)
      kinds = kinds_of_joints(mechanism%linkage, joints)
      points = rigid_points(variant)
      do i = 1, size(places, 2)
        places(:, i) = mechanism%points(i)%place
      end do
      call find_displacements(mechanism%structure_t, found%positions%states(state), joints, &
        mechanism%points(points)%body, places(:, points), &
        found%sweep%results(state)%shapes(speed)%displacement, x, moved)
      do mode = 1, variant%model%modes
        if (mode > 1) call add_gap(rows, 2)
        do i = 1, size(joints)
          call add_place(mechanism%pin_names(joints(i)%pin)%text, owner_cell(variant, joints(i), &
            column_width(layout, 5)), trim(joint_words(kinds(i))))
        end do
        do i = size(joints) + 1, size(x, 2)
          associate (point => mechanism%points(points(i - size(joints))))
            call add_place(point%name, name_cell(mechanism%names(point%body)%text, &
              column_width(layout, 5)), "free")
          end associate
        end do
      end do
    end associate

  contains

    subroutine add_place(name, link, joint)
      character(len=*), intent(in) :: name, link, joint

      call add_row(rows, cells(layout, 1, [shown_speed(variant, speed), &
        variant%found%positions%crank(position)])//integer_cell(mode, "mode")//name_cell(name, &
        column_width(layout, 4))//link//name_cell(joint, column_width(layout, 6))// &
        cells(layout, 7, [x(:, i), shown_displacement(variant, moved(:, i, mode))]))
    end subroutine add_place

  end subroutine add_shape_pins

  !> A column for every mode.
  subroutine plan_frequencies(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%count = variant%model%modes
  end subroutine plan_frequencies

  !> An item for every position and speed that is drawn.
  subroutine plan_shapes(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    call plan_links(variant, plan)
    plan%drawn = drawn_rows(variant)
    plan%items = size(plan%drawn, 2)
  end subroutine plan_shapes

  !> The names of pins and points, links and guides, joints.
  subroutine plan_shape_pins(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    type(name_list_t) :: points
    integer :: i

    call plan_shapes(variant, plan)
    call plan_joints(variant, plan)
    points = point_names(variant)
    do i = 1, size(points%names)
      call append_string(plan%names(1)%names, points%names(i)%text)
    end do
    plan%names(3)%column = "joint"
    plan%names(3)%names = trimmed_list(joint_words)
  end subroutine plan_shape_pins

  !> With dampers there are damping ratios.
  pure subroutine fit_frequencies(model, columns)
    type(model_t), intent(in) :: model         !! of the deck
    character(len=*), intent(inout) :: columns !! of the record

    if (is_damped(model)) columns = trim(columns)//" zeta*:-"
    call fit_columns(model, columns)
  end subroutine fit_frequencies

  !> Blocks are those of the speeds of the sweep.
  pure function speeds_of_sweep(variant) result(count)
    type(variant_results_t), intent(in) :: variant !! with its sweep
    integer :: count

    count = size(variant%found%sweep%request%speed)
  end function speeds_of_sweep

end module frequency_report
