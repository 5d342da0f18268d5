! src/reports/rigid/ - tables of the rigid linkage: kinematics, forces, friction, balance, limits.
! In: a `variant_results_t`. Out: rows. A file describes one report, or a few, for `list_reports` in
! `src/reports/report_table.f90`. Begin with `describe_joints` here. Shared: `plan_joints` here,
! `pin_names` in `pins_report.f90`, `point_names` in `points_report.f90`.
! Not here: results (`src/studies/rigid`, `src/studies/balance`), notes on loads
! (`src/reports/words`), motions (`src/reports/motion`).

!> `reactions.dat` of linkages that are no four-bars; `drives.dat` and `shaking.dat` of any.
module joints_report
  use coordinate_columns, only: columns_in, shown_values, unit_names
  use drive_motions, only: drive_rates, place_columns, table_place
  use joint_study, only: drives_at_speed, joint_t, joints_at_speed
  use kinds, only: wp
  use effort_sources, only: effort_source_t, find_effort_sources
  use load_notes, only: acceleration_note, append_load_notes
  use models, only: model_t
  use natures, only: are_alike, of_effort, of_rate, of_value
  use pins_report, only: pin_names
  use position_rows, only: add_position_row
  use report_kinds, only: other_linkages, report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, state_table_t, table_plan_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_joints, describe_drives, describe_drives_as_drive, drive_columns, &
    plan_joints, joint_owners, &
    owner_cell, drives_notes, reference_words, open_words, add_open_row, friction_note

  !> Where friction is in the columns, of a linkage with FRICTION cards.
  character(len=*), parameter :: friction_note = "friction: within fx and fy of a block along "// &
    "its line, within moment in a pin, on both links or on the guide of the block; a ground "// &
    "pivot bears the opposite"

  !> What `drives.dat` has of every drive.
  integer, parameter :: of_drives(3) = [of_value, of_rate, of_effort]

  !> `reactions.dat` of other linkages.
  type, extends(state_table_t) :: joints_table_t
  contains
    procedure, nopass :: find_notes => joints_notes
    procedure, nopass :: plan => plan_joints
    procedure, nopass :: add_position => add_joints
  end type joints_table_t

  !> `drives.dat`.
  type, extends(state_table_t) :: drives_table_t
  contains
    procedure, nopass :: find_notes => drives_notes
    procedure, nopass :: plan => plan_drives
    procedure, nopass :: fit => fit_drives
    procedure, nopass :: add_position => add_drives
  end type drives_table_t

  !> `shaking.dat`.
  type, extends(state_table_t) :: shaking_table_t
  contains
    procedure, nopass :: find_notes => drives_notes
    procedure, nopass :: add_position => add_shaking
  end type shaking_table_t

contains

  !> REPORT reactions of linkages that are no four-bars.
  subroutine describe_joints(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="reactions", help="of other linkages: forces and "// &
      "moments in all joints", pattern="REPORT reactions [columns=] [format=]", studies="joints", &
      positions=.true., masses=.true., linkages=other_linkages)
    call add_table(report, joints_table_t(), "reactions", "speed:speed crank:deg pin,"// &
      "link:name fx,fy:force moment:moment")
  end subroutine describe_joints

  !> REPORT drives.
  subroutine describe_drives(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="drives", help="torques or forces of all drives, shaking "// &
      "force and moment", studies="joints", positions=.true., masses=.true.)
    call add_drives_tables(report)
  end subroutine describe_drives

  !> REPORT drive of linkages that are no four-bars, as REPORT drives was called.
  subroutine describe_drives_as_drive(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="drive", help="of other linkages: older name of "// &
      "REPORT drives", offered=.false., studies="joints", positions=.true., masses=.true., &
      linkages=other_linkages)
    call add_drives_tables(report)
  end subroutine describe_drives_as_drive

  !> Tables of the drives, the first by the name of the report.
  subroutine add_drives_tables(report)
    type(report_record_t), intent(inout) :: report !! with its name

    call add_table(report, drives_table_t(), trim(report%kind%name), "speed:speed crank:deg "// &
      "drive:name position:deg rate:rate force:moment")
    call add_table(report, shaking_table_t(), "shaking", "speed:speed crank:deg shaking_x,"// &
      "shaking_y:force shaking_moment:moment")
  end subroutine add_drives_tables

  !> On what the forces act, axes and signs, loads.
  pure subroutine joints_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "forces in global axes on the link at the pin; of a guide: by "// &
      "the guide on the pin; of a block on a link: by the block on that link")
    call append_string(notes, "moment: on the link, of a weld or of a block on which it cannot "// &
      "turn; counter-clockwise positive")
    if (size(variant%model%frictions) > 0) call append_string(notes, friction_note)
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine joints_notes

  !> The names in the column `link`: links, and the guides of the deck.
  pure function joint_owners(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    integer :: i

    list%column = "link"
    list%names = variant%mechanism%names
    do i = 1, size(variant%model%guides)
      call append_string(list%names, variant%model%guides(i)%name%text)
    end do
  end function joint_owners

  !> Appends the rows of a position and speed, one per joint.
  subroutine add_joints(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its joints computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp), allocatable :: forces(:, :)
    real(wp) :: place(place_columns(variant%model)), rates(2)
    integer :: i, next

    place = table_place(variant%model, speed, position)
    next = size(place) + 1
    rates = drive_rates(variant%model, speed, position)
    associate (mechanism => variant%mechanism, joints => variant%found%joints%joints)
      forces = joints_at_speed(variant%found%joints, variant%found%positions%state(position), &
        rates(1), rates(2), speed)
      do i = 1, size(joints)
        if (variant%found%joints%is_open(i, variant%found%positions%state(position))) then
          call add_open_row(rows, place, variant, joints(i))
          cycle
        end if
        call add_row(rows, cells(layout, 1, place)// &
          name_cell(mechanism%pin_names(joints(i)%pin)%text, column_width(layout, next))// &
          owner_cell(variant, joints(i), column_width(layout, next + 1))// &
          cells(layout, next + 2, forces(:, i)))
      end do
    end associate
  end subroutine add_joints

  !> Why a joint has no forces.
  pure function open_words(variant, joint) result(words)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(joint_t), intent(in) :: joint             !! of this linkage
    character(len=:), allocatable :: words

    character(len=:), allocatable :: owner

    if (joint%body > 0) then
      owner = "link '"//variant%mechanism%names(joint%body)%text//"'"
    else
      owner = "guide '"//variant%model%guides(variant%model%sliders(joint%slider)%guide)%name% &
        text//"'"
    end if
    words = "the force on "//owner//" at '"//variant%mechanism%pin_names(joint%pin)%text// &
      "' cannot be told: rigid links alone hold each other there"
  end function open_words

  !> Appends a failed row for a joint that has no forces.
  subroutine add_open_row(rows, place, variant, joint)
    type(rows_t), intent(inout) :: rows            !! to which it is appended
    real(wp), intent(in) :: place(:)               !! first values of the row
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(joint_t), intent(in) :: joint             !! of this linkage

    character(len=:), allocatable :: words

    ! One thread at a time makes texts.
    !$omp critical (one_at_a_time)
    words = open_words(variant, joint)
    !$omp end critical (one_at_a_time)
    call add_failed_row(rows, place, words)
  end subroutine add_open_row

  !> The cell of the link or the guide of a joint.
  function owner_cell(variant, joint, width) result(cell)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(joint_t), intent(in) :: joint             !! of this linkage
    integer, intent(in) :: width                   !! of the column
    character(len=width) :: cell

    if (joint%body > 0) then
      cell = name_cell(variant%mechanism%names(joint%body)%text, width)
    else
      cell = name_cell(variant%model%guides(variant%model%sliders(joint%slider)%guide)%name%text, &
        width)
    end if
  end function owner_cell

  !> Units and signs of the drives, about what shaking moments are, loads.
  pure subroutine drives_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    type(effort_source_t), allocatable :: sources(:)
    integer :: i

    call find_effort_sources(variant%model, sources)
    do i = 1, size(sources)
      call append_string(notes, "drive "//sources(i)%name//": "// &
        unit_names(sources(i)%nature%words(of_drives), variant%model%outputs))
    end do
    call append_string(notes, "force: of the drive on what it moves, positive in the sense of "// &
      "its position")
    call append_string(notes, "shaking: resultant of -m a of all masses; shaking_moment: of "// &
      "these and of -I alpha of all links, about "//reference_words(variant)//"; weights and "// &
      "external loads are not included")
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine drives_notes

  !> The point about which shaking moments are: `pin O2`.
  pure function reference_words(variant) result(words)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    character(len=:), allocatable :: words

    integer :: i

    associate (linkage => variant%mechanism%linkage)
      i = findloc(linkage%is_ground, .true., dim=1)
      if (linkage%has_crank) i = linkage%bodies(1)%first_pin
      if (i > 0) then
        words = "pin "//variant%mechanism%pin_names(i)%text
      else
        i = findloc(linkage%sliders%body, 0, dim=1)
        words = "the point of guide "//variant%model%guides(variant%model%sliders(i)%guide)%name% &
          text
      end if
    end associate
  end function reference_words

  !> The names in the column `drive`: driven links, and pins of driven sliders; or the coordinates
  !! of ACTUATE cards.
  pure function drive_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its model
    type(name_list_t) :: list

    type(effort_source_t), allocatable :: sources(:)
    integer :: i

    call find_effort_sources(variant%model, sources)
    list%column = "drive"
    allocate (list%names(size(sources)))
    do i = 1, size(sources)
      list%names(i)%text = sources(i)%name
    end do
  end function drive_names

  !> The columns of `drive.dat`.
  pure function drive_columns(model) result(columns)
    type(model_t), intent(in) :: model !! with its drives
    character(len=:), allocatable :: columns

    type(effort_source_t), allocatable :: sources(:)

    call find_effort_sources(model, sources)
    columns = "speed:speed crank:deg drive:name "//columns_in(sources%nature, &
      "position rate force", of_drives)
  end function drive_columns

  !> Appends the rows of a position and speed, one per drive.
  subroutine add_drives(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its joints computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    type(effort_source_t), allocatable :: sources(:)
    real(wp), allocatable :: values(:, :)
    real(wp) :: rates(2)
    integer :: i

    rates = drive_rates(variant%model, speed, position)
    associate (model => variant%model, positions => variant%found%positions, &
        linkage => variant%mechanism%linkage)
      values = drives_at_speed(linkage, variant%found%joints, &
        positions%states(positions%state(position)), positions%state(position), &
        positions%crank(position), rates(1), rates(2), speed)
      call find_effort_sources(model, sources)
      do i = 1, size(values, 2)
        if (.not. are_alike(sources%nature)) values(:, i) = shown_values(values(:, i), &
          sources(i)%nature%words(of_drives), model%outputs)
        call add_position_row(variant, layout, position, speed, values(:, i), rows, &
          sources(i)%name)
      end do
    end associate
  end subroutine add_drives

  !> Appends the row of a position and speed: shaking force and moment.
  subroutine add_shaking(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its joints computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (rates => drive_rates(variant%model, speed, position), &
        state => variant%found%positions%state(position), shaking => variant%found%joints%shaking)
      call add_position_row(variant, layout, position, speed, &
        rates(1)**2*shaking(:, 1, state) + rates(2)*shaking(:, 2, state), rows)
    end associate
  end subroutine add_shaking

  !> Columns `pin` and `link`, where that of a block is its guide.
  subroutine plan_joints(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = pin_names(variant)
    plan%names(2) = joint_owners(variant)
  end subroutine plan_joints

  !> A column `drive`.
  subroutine plan_drives(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = drive_names(variant)
  end subroutine plan_drives

  !> Columns in the units of the drives.
  pure subroutine fit_drives(model, columns)
    type(model_t), intent(in) :: model         !! with its drives
    character(len=*), intent(inout) :: columns !! of the record

    columns = drive_columns(model)
    call fit_columns(model, columns)
  end subroutine fit_drives

end module joints_report
