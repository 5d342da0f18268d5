!> The files of a run: opened together, put in place together.
module deck_outputs
  use balance_report, only: write_balance, write_harmonics
  use branch_report, only: write_branches
  use errors, only: error_t, set_error
  use file_system, only: is_directory, joined_path, make_directories, remove_empty_directory
  use frequency_report, only: write_frequencies, write_shapes
  use inertia_report, only: write_inertia
  use kinematics_report, only: write_kinematics
  use lagrange_report, only: write_lagrange
  use linkage_report, only: write_linkage
  use mesh_report, only: write_mesh
  use models, only: model_t, report_number
  use motion_report, only: write_motion
  use output_files, only: append_output, discard_output, finish_output, open_output, &
    output_file_t, publish_output, remove_output
  use points_report, only: write_points
  use reactions_report, only: write_reactions
  use request_cards, only: report_balance, report_branches, report_frequencies, report_inertia, &
    report_kind_count, report_kinematics, report_lagrange, report_linkage, report_mesh, &
    report_motion, report_points, report_reactions, report_shapes
  use run_findings, only: linkage_notes
  use tables, only: begin_variant, column_t, discard_table, finish_table, open_table, &
    publish_table, table_t
  use text, only: string_t
  use variant_runs, only: variant_run_t
  implicit none (type, external)
  private

  public :: outputs_t, open_outputs, write_variant, write_texts, publish_outputs, discard_outputs

  type :: outputs_t
    character(len=:), allocatable :: folder
    logical, private :: csv = .false.
    type(string_t), allocatable, private :: is_new(:)        !! folders that were not there before,
                                                             !! outermost first
    integer, allocatable, private :: kind(:)                 !! of each table
    type(table_t), allocatable :: tables(:)
    type(output_file_t), private :: echo, log, summary
  end type outputs_t

  !> A report has the table of its own number; those with two have another one behind all these.
  integer, parameter :: table_harmonics = report_kind_count + 1
  integer, parameter :: table_kind_count = table_harmonics

  character(len=*), parameter :: echo_name = "echo.deck", log_name = "run.log", &
    summary_name = "summary.json"

contains

  !> Makes the folder and opens every file in it under a temporary name.
  subroutine open_outputs(folder, model, csv, outputs, error)
    character(len=*), intent(in) :: folder
    type(model_t), intent(in) :: model
    logical, intent(in) :: csv !! whether tables are wanted as comma-separated values too
    type(outputs_t), intent(out) :: outputs
    type(error_t), allocatable, intent(out) :: error

    integer :: i
    logical :: made

    outputs%folder = folder
    outputs%csv = csv
    outputs%kind = pack([(i, i=1, table_kind_count)], &
      [(report_number(model, report_of(i)) > 0, i=1, table_kind_count)])
    allocate (outputs%tables(size(outputs%kind)))
    call make_directories(folder, made, outputs%is_new)
    if (.not. made) then
      call set_error(error, &
        folder//": error: this folder cannot be made; is there a file of that name?")
      return
    end if
    ! A folder where a file is to be would show only when some files are in place and others are
    ! not.
    do i = 1, size(outputs%kind)
      call refuse_folder(joined_path(folder, table_name(outputs%kind(i))//".dat"), error)
      if (csv) call refuse_folder(joined_path(folder, table_name(outputs%kind(i))//".csv"), error)
    end do
    call refuse_folder(joined_path(folder, echo_name), error)
    call refuse_folder(joined_path(folder, log_name), error)
    call refuse_folder(joined_path(folder, summary_name), error)
    if (allocated(error)) return
    do i = 1, size(outputs%kind)
      call open_table(folder, table_name(outputs%kind(i)), csv, outputs%tables(i), error)
      if (allocated(error)) return
    end do
    call open_output(folder, echo_name, outputs%echo, error)
    if (.not. allocated(error)) call open_output(folder, log_name, outputs%log, error)
    if (.not. allocated(error)) call open_output(folder, summary_name, outputs%summary, error)
  end subroutine open_outputs

  subroutine refuse_folder(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(inout) :: error

    if (is_directory(path)) call set_error(error, &
      path//": error: this is a folder, and a file is to be written there")
  end subroutine refuse_folder

  !> The report that a table belongs to.
  pure function report_of(table) result(report)
    integer, intent(in) :: table !! its kind
    integer :: report

    report = table
    if (table == table_harmonics) report = report_balance
  end function report_of

  !> The name of a table, without `.dat` and `.csv`.
  pure function table_name(kind) result(name)
    integer, intent(in) :: kind
    character(len=:), allocatable :: name

    name = ""
    select case (kind)
    case (report_kinematics)
      name = "kinematics"
    case (report_inertia)
      name = "inertia"
    case (report_mesh)
      name = "mesh"
    case (report_frequencies)
      name = "frequencies"
    case (report_shapes)
      name = "shapes"
    case (report_branches)
      name = "branches"
    case (report_reactions)
      name = "reactions"
    case (report_points)
      name = "points"
    case (report_lagrange)
      name = "lagrange"
    case (report_linkage)
      name = "linkage"
    case (report_balance)
      name = "balance"
    case (table_harmonics)
      name = "harmonics"
    case (report_motion)
      name = "motion"
    end select
  end function table_name

  !> Writes the rows of a variant to all tables.
  subroutine write_variant(outputs, parameters, run, threads)
    type(outputs_t), intent(inout) :: outputs
    type(column_t), intent(in) :: parameters(:) !! columns of what varies
    type(variant_run_t), intent(in) :: run
    integer, intent(in) :: threads

    integer :: i

    do i = 1, size(outputs%kind)
      associate (table => outputs%tables(i), model => run%model, mechanism => run%mechanism, &
          positions => run%positions, sweep => run%sweep)
        call begin_variant(table, parameters, model%varied)
        select case (outputs%kind(i))
        case (report_kinematics)
          call write_kinematics(table, model, mechanism, positions, linkage_notes(mechanism, &
            positions))
        case (report_inertia)
          call write_inertia(table, model, mechanism, positions)
        case (report_mesh)
          call write_mesh(table, model, mechanism, positions)
        case (report_frequencies)
          call write_frequencies(table, model, positions, sweep, threads)
        case (report_shapes)
          call write_shapes(table, model, mechanism, positions, sweep)
        case (report_branches)
          call write_branches(table, model, positions, sweep, run%branches)
        case (report_reactions)
          call write_reactions(table, model, mechanism, positions)
        case (report_points)
          call write_points(table, model, mechanism, positions)
        case (report_lagrange)
          call write_lagrange(table, model, mechanism, positions)
        case (report_motion)
          call write_motion(table, model, mechanism, run%motion)
        case (report_linkage)
          call write_linkage(table, model, mechanism)
        case (report_balance)
          call write_balance(table, model, mechanism, positions)
        case (table_harmonics)
          call write_harmonics(table, model, mechanism)
        end select
      end associate
    end do
  end subroutine write_variant

  !> Writes what comes after the tables, and tells what is in them.
  subroutine write_texts(outputs, echo, log, summary)
    type(outputs_t), intent(inout) :: outputs
    character(len=*), intent(in) :: echo, log, summary

    call append_output(outputs%echo, echo)
    call append_output(outputs%log, log)
    call append_output(outputs%summary, summary)
  end subroutine write_texts

  !> Checks that every file is complete on the disk, and only then renames them all; tables that an
  !! earlier run left and this one
  !> was not asked for are removed. Errors: a file is not complete; nothing has been renamed then.
  subroutine publish_outputs(outputs, error)
    type(outputs_t), intent(inout) :: outputs
    type(error_t), allocatable, intent(out) :: error

    integer :: i

    do i = 1, size(outputs%tables)
      call finish_table(outputs%tables(i), error)
      if (allocated(error)) return
    end do
    call finish_output(outputs%echo, error)
    if (allocated(error)) return
    call finish_output(outputs%log, error)
    if (allocated(error)) return
    call finish_output(outputs%summary, error)
    if (allocated(error)) return

    do i = 1, size(outputs%tables)
      call publish_table(outputs%tables(i), error)
      if (allocated(error)) return
    end do
    call publish_output(outputs%echo, error)
    if (allocated(error)) return
    call publish_output(outputs%log, error)
    if (allocated(error)) return
    call publish_output(outputs%summary, error)
    if (allocated(error)) return
    do i = 1, table_kind_count
      if (all(outputs%kind /= i)) call remove_output(outputs%folder, table_name(i)//".dat")
      if (all(outputs%kind /= i) .or. .not. outputs%csv) call remove_output(outputs%folder, &
        table_name(i)//".csv")
    end do
  end subroutine publish_outputs

  !> Leaves the folder as it was.
  subroutine discard_outputs(outputs)
    type(outputs_t), intent(inout) :: outputs

    integer :: i

    do i = 1, size(outputs%tables)
      call discard_table(outputs%tables(i))
    end do
    call discard_output(outputs%echo)
    call discard_output(outputs%log)
    call discard_output(outputs%summary)
    do i = size(outputs%is_new), 1, -1
      call remove_empty_directory(outputs%is_new(i)%text)
    end do
  end subroutine discard_outputs

end module deck_outputs
