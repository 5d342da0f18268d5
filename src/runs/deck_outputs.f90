!> The output files of a run: opened together, put in place together.
module deck_outputs
  use byte_streams, only: get_reals, get_string, put_reals, put_string
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: is_directory, joined_path, make_directories, remove_empty_directory
  use kinds, only: long, wp
  use models, only: model_t, report_number
  use output_files, only: append_output, discard_output, finish_output, open_output, &
    output_file_t, publish_output, remove_output
  use report_kinds, only: table_kind_t
  use report_rows, only: find_rows
  use report_table, only: plan_table, reports, table_in_units, table_notes, table_plan_t
  use table_columns, only: header_columns
  use table_rows, only: add_failed_row, rows_t
  use tables, only: begin_variant, column_t, discard_table, finish_table, open_table, &
    publish_table, table_t, write_header, write_notes, write_rows
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variant_results, only: variant_results_t
  use variant_rows, only: variant_rows_t
  implicit none (type, external)
  private

  public :: outputs_t, open_outputs, open_folder, refuse_folder, tables_of, write_variant, &
    write_found_rows, write_texts, publish_outputs, discard_outputs, forget_waiting

  !> The files of one output folder.
  type :: outputs_t
    character(len=:), allocatable :: folder
    logical, private :: csv = .false.                     !! tables as comma-separated values too
    logical, private :: plain = .true.                    !! tables as plain text
    type(string_t), allocatable, private :: is_new(:)     !! folders that this run made, outermost
                                                          !! first
    type(table_kind_t), allocatable :: kinds(:)           !! (tables) names and columns, from the
                                                          !! table of reports
    type(table_t), allocatable :: tables(:)               !! in the order of `kinds`
    type(column_t), allocatable, private :: parameters(:) !! columns of the VARY parameters
    logical :: have_heads = .false.                       !! the tables; the first variant that is
                                                          !! computed brings them
    integer :: computed = 0                               !! variants with a result
    type(text_buffer_t), private :: waiting               !! values and reasons of variants that
                                                          !! failed before the tables had heads
    type(output_file_t), private :: echo, log, summary
  end type outputs_t

  character(len=*), parameter :: echo_name = "echo.deck", log_name = "run.log", &
    summary_name = "summary.json"

  !> Items of a table that are found before any of them is written.
  integer, parameter :: items_at_a_time = 4096

contains

  !> Makes the folder and opens every file in it under a temporary name. Errors: the folder or a
  !! file cannot be made.
  subroutine open_outputs(folder, model, parameters, csv, outputs, error, csv_only)
    character(len=*), intent(in) :: folder           !! path of the output folder
    type(model_t), intent(in) :: model               !! of the first variant
    type(column_t), intent(in) :: parameters(:)      !! columns of the VARY parameters
    logical, intent(in) :: csv                       !! whether to write tables as comma-separated
                                                     !! values too
    type(outputs_t), intent(out) :: outputs          !! to be discarded after an error
    type(error_t), allocatable, intent(out) :: error !! why nothing can be written
    logical, intent(in), optional :: csv_only        !! with `csv`: no plain tables

    integer :: i

    call open_folder(folder, outputs, error)
    if (allocated(error)) return
    outputs%csv = csv
    if (present(csv_only)) outputs%plain = .not. (csv .and. csv_only)
    outputs%parameters = parameters
    outputs%kinds = tables_of(model)
    deallocate (outputs%tables)
    allocate (outputs%tables(size(outputs%kinds)))
    ! Checked now: a folder with the name of a file would stop the renaming when some files are in
    ! place and others are not.
    do i = 1, size(outputs%kinds)
      if (outputs%plain) call refuse_folder(joined_path(folder, &
        trim(outputs%kinds(i)%name)//".dat"), error)
      if (csv) call refuse_folder(joined_path(folder, trim(outputs%kinds(i)%name)//".csv"), error)
    end do
    call refuse_folder(joined_path(folder, echo_name), error)
    call refuse_folder(joined_path(folder, log_name), error)
    call refuse_folder(joined_path(folder, summary_name), error)
    if (allocated(error)) return
    do i = 1, size(outputs%kinds)
      call open_table(folder, trim(outputs%kinds(i)%name), csv, outputs%tables(i), error, &
        .not. outputs%plain)
      if (allocated(error)) return
      outputs%tables(i)%has_blocks = outputs%kinds(i)%has_blocks
    end do
    call open_output(folder, echo_name, outputs%echo, error)
    if (.not. allocated(error)) call open_output(folder, log_name, outputs%log, error)
    if (.not. allocated(error)) call open_output(folder, summary_name, outputs%summary, error)
  end subroutine open_outputs

  !> Makes the folder, of a run that writes no tables. Errors: it cannot be made.
  subroutine open_folder(folder, outputs, error)
    character(len=*), intent(in) :: folder           !! path of the output folder
    type(outputs_t), intent(out) :: outputs          !! to be discarded after an error
    type(error_t), allocatable, intent(out) :: error !! why nothing can be written

    logical :: made

    outputs%folder = folder
    allocate (outputs%tables(0), outputs%kinds(0))
    call make_directories(folder, made, outputs%is_new)
    if (.not. made) call set_error(error, error_of_files, &
      "this folder cannot be created; is there a file of that name?", folder)
  end subroutine open_folder

  !> The tables that a model requests: the first table of every report, in the order of all
  !! reports, then the second ones.
  pure function tables_of(model) result(list)
    type(model_t), intent(in) :: model !! of the first variant
    type(table_kind_t), allocatable :: list(:)

    integer :: i, t, number

    allocate (list(0))
    do t = 1, size(reports(1)%tables)
      do i = 1, size(reports)
        number = report_number(model, reports(i)%name)
        if (number == 0) cycle
        associate (kind => model%reports(number)%kind)
          if (kind%tables(t)%name == "" .or. kind%linkages /= reports(i)%linkages) cycle
          list = [list, table_in_units(kind%tables(t), model)]
        end associate
      end do
    end do
  end function tables_of

  !> Errors: there is a folder with the path of a file.
  subroutine refuse_folder(path, error)
    character(len=*), intent(in) :: path               !! of the file
    type(error_t), allocatable, intent(inout) :: error !! as it was if there is none

    if (is_directory(path)) call set_error(error, error_of_files, &
      "this is a folder, and a file is to be written there", path)
  end subroutine refuse_folder

  !> Writes the rows of a variant to all tables, a number of items at a time.
  subroutine write_variant(outputs, variant, threads)
    type(outputs_t), intent(inout) :: outputs      !! opened
    type(variant_results_t), intent(in) :: variant !! computed
    integer, intent(in) :: threads                 !! number to use

    type(table_plan_t) :: plan
    type(string_t), allocatable :: notes(:)
    type(column_t), allocatable :: columns(:)
    integer(long) :: before(2)
    integer :: i, first

    before = rows_written(outputs)
    do i = 1, size(outputs%kinds)
      call plan_table(outputs%kinds(i), variant, plan)
      call table_notes(plan%name, variant, notes)
      associate (table => outputs%tables(i))
        call header_columns(plan%layout, columns)
        call begin_rows(outputs, table, variant%model%title, notes, columns, variant%model%varied)
        do first = 1, plan%items, items_at_a_time
          call write_items(table, plan, variant, first, &
            min(first + items_at_a_time - 1, plan%items), threads)
        end do
      end associate
    end do
    call end_rows(outputs, before)
  end subroutine write_variant

  !> Begins the rows of a variant in a table. Those of the first one that is computed follow the
  !! head and the variants that waited for it.
  subroutine begin_rows(outputs, table, title, notes, columns, varied)
    type(outputs_t), intent(in) :: outputs
    type(table_t), intent(inout) :: table !! one of these outputs
    character(len=*), intent(in) :: title
    type(string_t), intent(in) :: notes(:)
    type(column_t), allocatable, intent(in) :: columns(:) !! allocated for the head
    real(wp), intent(in) :: varied(:)

    type(rows_t), allocatable :: failed
    character(len=:), allocatable :: reason
    real(wp) :: values(size(varied)), no_place(0)
    integer :: at

    call begin_variant(table, outputs%parameters, varied)
    if (outputs%have_heads) then
      call write_notes(table, notes)
      return
    end if
    call write_header(table, title, notes, columns)
    at = 1
    do while (at <= outputs%waiting%length)
      call get_reals(outputs%waiting%storage, at, values)
      call get_string(outputs%waiting%storage, at, reason)
      allocate (failed)
      call add_failed_row(failed, no_place, reason)
      call begin_variant(table, outputs%parameters, values)
      call write_rows(table, failed)
      deallocate (failed)
      ! All notes are in the head.
      call write_notes(table, notes)
    end do
    call begin_variant(table, outputs%parameters, varied)
  end subroutine begin_rows

  !> Counts a variant that has left its rows.
  pure subroutine end_rows(outputs, before)
    type(outputs_t), intent(inout) :: outputs
    integer(long), intent(in) :: before(2) !! of `rows_written`

    integer(long) :: now(2)

    now = rows_written(outputs)
    if (now(1) > before(1) .or. now(2) == before(2)) outputs%computed = outputs%computed + 1
    outputs%have_heads = .true.
    call forget_waiting(outputs)
  end subroutine end_rows

  !> Numbers of rows and of failed ones, in all tables.
  pure function rows_written(outputs) result(numbers)
    type(outputs_t), intent(in) :: outputs
    integer(long) :: numbers(2)

    numbers = [sum(outputs%tables%rows), sum(outputs%tables%failed_rows)]
  end function rows_written

  !> Forgets variants that wait for the heads of the tables.
  pure subroutine forget_waiting(outputs)
    type(outputs_t), intent(inout) :: outputs !! opened

    type(text_buffer_t) :: none

    outputs%waiting = none
  end subroutine forget_waiting

  subroutine write_items(table, plan, variant, first, last, threads)
    type(table_t), intent(inout) :: table
    type(table_plan_t), intent(in) :: plan
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: first, last, threads

    type(rows_t) :: rows

    call find_rows(plan, variant, first, last, threads, rows)
    call write_rows(table, rows)
  end subroutine write_items

  !> Writes the rows, already found, of a variant. The first one that is computed brings the columns
  !! of the tables; those that failed before wait for it.
  subroutine write_found_rows(outputs, title, found)
    type(outputs_t), intent(inout) :: outputs !! opened
    character(len=*), intent(in) :: title     !! of the deck; may be empty
    type(variant_rows_t), intent(in) :: found !! rows of all tables

    integer(long) :: before(2)
    integer :: i

    if (found%has_failed .and. .not. outputs%have_heads) then
      call put_reals(outputs%waiting, found%varied)
      call put_string(outputs%waiting, found%findings%failed(1)%error%text)
      return
    end if
    before = rows_written(outputs)
    do i = 1, size(outputs%tables)
      associate (table => outputs%tables(i), part => found%tables(i))
        call begin_rows(outputs, table, title, part%notes, part%columns, found%varied)
        call write_rows(table, part%rows)
      end associate
    end do
    call end_rows(outputs, before)
  end subroutine write_found_rows

  !> Writes the files beside the tables.
  subroutine write_texts(outputs, echo, log, summary)
    type(outputs_t), intent(inout) :: outputs !! opened
    character(len=*), intent(in) :: echo      !! text of `echo.deck`
    character(len=*), intent(in) :: log       !! text of `run.log`
    character(len=*), intent(in) :: summary   !! text of `summary.json`

    call append_output(outputs%echo, echo)
    call append_output(outputs%log, log)
    call append_output(outputs%summary, summary)
  end subroutine write_texts

  !> Checks that every file is complete on the disk, and only then renames them all. Tables of an
  !! earlier run that this run does not have are removed. Errors: a file is not complete, and
  !! nothing is renamed; or a file cannot be renamed.
  subroutine publish_outputs(outputs, error)
    type(outputs_t), intent(inout) :: outputs        !! all written
    type(error_t), allocatable, intent(out) :: error !! the first one

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
    call remove_old_tables(outputs)
  end subroutine publish_outputs

  !> Removes tables of reports, and forms of tables, that are no longer requested.
  subroutine remove_old_tables(outputs)
    type(outputs_t), intent(in) :: outputs

    integer :: i, t

    do i = 1, size(reports)
      do t = 1, size(reports(i)%tables)
        associate (name => reports(i)%tables(t)%name)
          if (name == "") cycle
          if (all(outputs%kinds%name /= name) .or. .not. outputs%plain) &
            call remove_output(outputs%folder, trim(name)//".dat")
          if (all(outputs%kinds%name /= name) .or. .not. outputs%csv) &
            call remove_output(outputs%folder, trim(name)//".csv")
        end associate
      end do
    end do
  end subroutine remove_old_tables

  !> Removes the temporary files, and the folders that this run made. Files of an earlier run stay.
  subroutine discard_outputs(outputs)
    type(outputs_t), intent(inout) :: outputs !! opened, as far as was possible, or new

    integer :: i

    if (.not. allocated(outputs%folder)) return
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
