!> The output files of a run: opened together, put in place together.
module deck_outputs
  use byte_streams, only: byte_stream_t
  use errors, only: error_t
  use file_system, only: joined_path
  use kinds, only: long, wp
  use models, only: model_t
  use output_files, only: append_output, close_output, finish_output, open_output, output_file_t
  use output_folders, only: begin_files, discard_folder, echo_name, leave_folder, log_name, &
    open_folder, output_folder_t, put_in_place, refuse_names, summary_name
  use report_rows, only: find_rows
  use report_table, only: tables_of
  use report_types, only: any_table_t, plan_table, table_plan_t
  use table_columns, only: header_columns
  use table_rows, only: add_failed_row, rows_t
  use tables, only: append_later_rows, begin_variant, close_table, column_t, finish_table, &
    open_later_rows, open_table, table_file_t, write_header, write_notes, write_rows
  use task_journal, only: begun, journal_name
  use text, only: append_string, string_t, word_list
  use variant_results, only: variant_results_t
  use variant_rows, only: variant_rows_t
  implicit none (type, external)
  private

  public :: outputs_t, open_outputs, open_part, write_results, end_results, &
    write_found_rows, write_texts, publish_outputs, close_outputs, discard_outputs, forget_waiting

  !> The files of one output folder.
  type :: outputs_t
    type(output_folder_t) :: folder
    logical, private :: csv = .false.                     !! tables as comma-separated values too
    logical, private :: plain = .true.                    !! tables as plain text
    type(any_table_t), allocatable :: kinds(:)            !! (tables) of the reports of the deck
    type(table_file_t), allocatable :: tables(:)          !! in the order of `kinds`
    type(column_t), allocatable, private :: parameters(:) !! columns of the VARY parameters
    logical :: have_heads = .false.                       !! the tables; the first variant that is
                                                          !! computed brings them
    integer :: computed = 0                               !! variants with a result
    type(table_file_t), allocatable, private :: later(:, :) !! (speeds after the first, tables) rows
                                                          !! of a variant that comes in blocks
    integer(long), private :: before(2) = 0_long          !! rows before the variant that is written
    type(byte_stream_t), private :: waiting               !! values and reasons of variants that
                                                          !! failed before the tables had heads
    type(output_file_t), private :: echo, log, summary
  end type outputs_t

  !> Items of a table that are found before any of them is written.
  integer, parameter :: items_at_a_time = 4096

contains

  !> Opens the folder and every file of a run. Errors: the folder or a file cannot be made, another
  !! run is writing there, a file would replace one that is not of an earlier run.
  subroutine open_outputs(folder, model, inputs, parameters, csv, outputs, error, csv_only, digits)
    character(len=*), intent(in) :: folder           !! path of the output folder
    type(model_t), intent(in) :: model               !! of the first variant
    type(string_t), intent(in) :: inputs(:)          !! paths of the files of the deck
    type(column_t), intent(in) :: parameters(:)      !! columns of the VARY parameters
    logical, intent(in) :: csv                       !! whether to write tables as comma-separated
                                                     !! values too
    type(outputs_t), intent(out) :: outputs          !! to be discarded after an error
    type(error_t), allocatable, intent(out) :: error !! why nothing can be written
    logical, intent(in), optional :: csv_only        !! with `csv`: no plain tables
    integer, intent(in), optional :: digits          !! of numbers in tables; absent or 0: as the
                                                     !! deck says

    type(string_t), allocatable :: names(:)
    integer :: shown, i

    allocate (outputs%tables(0), names(0))
    outputs%csv = csv
    if (present(csv_only)) outputs%plain = .not. (csv .and. csv_only)
    shown = model%outputs%digits
    if (present(digits)) shown = merge(digits, shown, digits > 0)
    outputs%parameters = parameters
    call tables_of(model, outputs%kinds)
    do i = 1, size(outputs%kinds)
      if (outputs%plain) call append_string(names, trim(outputs%kinds(i)%table%name)//".dat")
      if (csv) call append_string(names, trim(outputs%kinds(i)%table%name)//".csv")
    end do
    call append_string(names, echo_name)
    call append_string(names, log_name)
    call append_string(names, summary_name)
    call open_folder(folder, "", outputs%folder, error)
    if (.not. allocated(error)) call begin_files(outputs%folder, error)
    if (.not. allocated(error)) call refuse_names(outputs%folder, names, word_list(journal_name), &
      inputs, error)
    if (allocated(error)) return
    deallocate (outputs%tables)
    allocate (outputs%tables(size(outputs%kinds)))
    associate (own => outputs%folder%own)
      do i = 1, size(outputs%kinds)
        call open_table(own, trim(outputs%kinds(i)%table%name), csv, outputs%tables(i), error, &
          .not. outputs%plain)
        if (allocated(error)) return
        outputs%tables(i)%digits = shown
        outputs%tables(i)%has_blocks = outputs%kinds(i)%table%has_blocks
      end do
      call open_output(joined_path(own, echo_name), outputs%echo, error)
      if (.not. allocated(error)) call open_output(joined_path(own, log_name), outputs%log, error)
      if (.not. allocated(error)) call open_output(joined_path(own, summary_name), &
        outputs%summary, error)
    end associate
  end subroutine open_outputs

  !> Opens the folder of a run that writes one file, a part. Errors: as for `open_outputs`.
  subroutine open_part(folder, name, inputs, outputs, error)
    character(len=*), intent(in) :: folder           !! path of the output folder
    character(len=*), intent(in) :: name             !! of the part
    type(string_t), intent(in) :: inputs(:)          !! paths of the files of the deck
    type(outputs_t), intent(out) :: outputs          !! to be discarded after an error
    type(error_t), allocatable, intent(out) :: error !! why nothing can be written

    type(string_t), allocatable :: journals(:), none(:)

    allocate (outputs%tables(0), outputs%kinds(0), none(0))
    call append_string(journals, name)
    call append_string(journals, name//begun)
    call open_folder(folder, name, outputs%folder, error)
    if (.not. allocated(error)) call refuse_names(outputs%folder, none, journals, inputs, &
      error)
  end subroutine open_part

  !> Writes the rows of a variant, or of a block of its positions, to all tables; the first block
  !! begins them. Speeds after the first wait in files of their own for the blocks that follow.
  !! Errors: there are no such files.
  subroutine write_results(outputs, variant, threads, is_block, error)
    type(outputs_t), intent(inout) :: outputs      !! opened, with the blocks before
    type(variant_results_t), intent(in) :: variant !! computed
    integer, intent(in) :: threads                 !! number to use
    logical, intent(in) :: is_block                !! all tables are of positions
    type(error_t), allocatable, intent(out) :: error

    type(table_plan_t) :: plan
    logical :: begins
    integer :: i, k, speeds, items

    begins = variant%found%positions%before == 0
    if (begins) outputs%before = rows_written(outputs)
    if (begins .and. is_block) allocate (outputs%later(max(0, size(variant%model%speed%value) - &
      1), size(outputs%tables)))
    do i = 1, size(outputs%kinds)
      call plan_table(outputs%kinds(i)%table, variant, plan)
      items = plan%items
      if (is_block) items = size(variant%found%positions%crank)
      speeds = plan%items/max(1, items)
      if (begins) call begin_planned(i, speeds)
      if (allocated(error)) return
      call write_items(outputs%tables(i), plan, variant, 0, items, threads)
      do k = 2, speeds
        call write_items(outputs%later(k - 1, i), plan, variant, (k - 1)*items, items, threads)
      end do
    end do

  contains

    !> Begins the rows of the table that is planned, those of later speeds, too.
    subroutine begin_planned(table, speeds)
      integer, intent(in) :: table, speeds !! number, count

      type(string_t), allocatable :: notes(:)
      type(column_t), allocatable :: columns(:)
      integer :: k

      call plan%table%find_notes(variant, notes)
      call header_columns(plan%layout, columns)
      call begin_rows(outputs, outputs%tables(table), variant%model%title, notes, columns, &
        variant%model%varied)
      do k = 2, speeds
        if (allocated(error)) return
        call open_later_rows(outputs%tables(table), outputs%folder%own, k, outputs%later(k - 1, &
          table), error)
      end do
    end subroutine begin_planned

  end subroutine write_results

  !> Ends the rows of a variant. Errors: rows that waited could not be written.
  subroutine end_results(outputs, error)
    type(outputs_t), intent(inout) :: outputs !! with all rows of the variant
    type(error_t), allocatable, intent(out) :: error

    integer :: i, k

    if (allocated(outputs%later)) then
      do i = 1, size(outputs%tables)
        do k = 1, size(outputs%later, 1)
          if (.not. allocated(outputs%later(k, i)%name)) cycle
          call append_later_rows(outputs%tables(i), outputs%folder%own, outputs%folder%path, &
            outputs%later(k, i), error)
          if (allocated(error)) return
        end do
      end do
      deallocate (outputs%later)
    end if
    call end_rows(outputs, outputs%before)
  end subroutine end_results

  !> Begins the rows of a variant in a table. Those of the first one that is computed follow the
  !! head and the variants that waited for it.
  subroutine begin_rows(outputs, table, title, notes, columns, varied)
    type(outputs_t), intent(in) :: outputs
    type(table_file_t), intent(inout) :: table !! one of these outputs
    character(len=*), intent(in) :: title
    type(string_t), intent(in) :: notes(:)
    type(column_t), allocatable, intent(in) :: columns(:) !! allocated for the head
    real(wp), intent(in) :: varied(:)

    type(rows_t), allocatable :: failed
    character(len=:), allocatable :: reason
    type(byte_stream_t) :: waiting
    real(wp), allocatable :: values(:)
    real(wp) :: no_place(0)

    call begin_variant(table, outputs%parameters, varied)
    if (outputs%have_heads) then
      call write_notes(table, notes)
      return
    end if
    call write_header(table, title, notes, columns)
    waiting = outputs%waiting
    waiting%reads = .true.
    do while (.not. waiting%is_at_end())
      call waiting%pass_allocatable(values)
      call waiting%pass_text(reason)
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

    type(byte_stream_t) :: none

    outputs%waiting = none
  end subroutine forget_waiting

  !> Writes the rows of some items, a number of them at a time.
  subroutine write_items(table, plan, variant, before, items, threads)
    type(table_file_t), intent(inout) :: table
    type(table_plan_t), intent(in) :: plan
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: before, items, threads

    type(rows_t), allocatable :: rows
    integer :: first

    do first = before + 1, before + items, items_at_a_time
      allocate (rows)
      call find_rows(plan, variant, first, min(first + items_at_a_time - 1, before + items), &
        threads, rows)
      call write_rows(table, rows)
      deallocate (rows)
    end do
  end subroutine write_items

  !> Writes the rows, already found, of a variant. The first one that is computed brings the columns
  !! of the tables; those that failed before wait for it.
  subroutine write_found_rows(outputs, title, found)
    type(outputs_t), intent(inout) :: outputs !! opened
    character(len=*), intent(in) :: title     !! of the deck; may be empty
    type(variant_rows_t), intent(inout) :: found !! rows of all tables

    integer(long) :: before(2)
    integer :: i

    if (found%has_failed .and. .not. outputs%have_heads) then
      call outputs%waiting%pass_allocatable(found%varied)
      call outputs%waiting%pass_text(found%findings%failed(1)%error%text)
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

  !> Closes every file, and only then puts them all in place. Tables of an earlier run that this run
  !! does not have are removed. Errors: a file is not complete, and nothing is put in place; or it
  !! cannot be.
  subroutine publish_outputs(outputs, error)
    type(outputs_t), intent(inout) :: outputs        !! all written
    type(error_t), allocatable, intent(out) :: error !! the first one

    integer :: i

    associate (path => outputs%folder%path)
      do i = 1, size(outputs%tables)
        call finish_table(outputs%tables(i), path, error)
        if (allocated(error)) return
      end do
      call finish_output(outputs%echo, joined_path(path, echo_name), error)
      if (.not. allocated(error)) call finish_output(outputs%log, joined_path(path, log_name), &
        error)
      if (.not. allocated(error)) call finish_output(outputs%summary, joined_path(path, &
        summary_name), error)
    end associate
    if (.not. allocated(error)) call put_in_place(outputs%folder, error)
  end subroutine publish_outputs

  !> Lets others write to the folder.
  subroutine close_outputs(outputs)
    type(outputs_t), intent(inout) :: outputs !! published

    call leave_folder(outputs%folder)
  end subroutine close_outputs

  !> Removes the files and the folders that this run made. Files of an earlier run stay.
  subroutine discard_outputs(outputs)
    type(outputs_t), intent(inout) :: outputs !! opened, as far as was possible, or new

    integer :: i, k

    if (allocated(outputs%tables)) then
      do i = 1, size(outputs%tables)
        call close_table(outputs%tables(i))
        if (.not. allocated(outputs%later)) cycle
        do k = 1, size(outputs%later, 1)
          call close_table(outputs%later(k, i))
        end do
      end do
    end if
    call close_output(outputs%echo)
    call close_output(outputs%log)
    call close_output(outputs%summary)
    call discard_folder(outputs%folder)
  end subroutine discard_outputs

end module deck_outputs
