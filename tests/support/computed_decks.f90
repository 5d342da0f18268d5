!> Decks that tests write down: read, computed, and the tables that reports make of them.
module computed_decks
  use cards, only: card_t, read_cards
  use variant_readings, only: read_variant
  use deck_source, only: source_from_text, source_t
  use diagnostics, only: diagnostics_t, has_errors, render_errors
  use errors, only: error_t, rendered
  use file_system, only: remove_file
  use link_store, only: link_store_t
  use models, only: model_t
  use report_rows, only: find_rows
  use report_table, only: reports, tables_of
  use report_types, only: any_table_t, plan_table, table_plan_t
  use table_columns, only: header_columns
  use table_rows, only: rows_t
  use tables, only: column_t, finish_table, open_table, table_file_t, write_header, write_rows
  use task_journal, only: journal_t
  use text, only: string_t
  use variant_results, only: variant_results_t
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use variants, only: deck_cards_t, read_deck_cards
  implicit none (type, external)
  private

  public :: read_text, compute_text, plan_of_table, rows_of_table, table_text, row_lines

  !> The file that a table is written to and read from again.
  character(len=*), parameter :: scratch = "computed_decks.scratch"

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Reads a variant of a deck, its first if none is named.
  subroutine read_text(text, model, complaint, variant)
    character(len=*), intent(in) :: text
    type(model_t), intent(out) :: model
    character(len=:), allocatable, intent(out) :: complaint !! empty if the deck is sound
    integer, intent(in), optional :: variant                !! number

    type(source_t) :: source
    type(card_t), allocatable :: cards(:)
    type(deck_cards_t) :: deck_cards
    type(diagnostics_t) :: diagnostics
    type(string_t) :: no_settings(0)
    integer :: number

    number = 1
    if (present(variant)) number = variant
    source = source_from_text("x.deck", text)
    call read_cards(source, cards, diagnostics)
    call read_deck_cards(cards, no_settings, source, reports(), diagnostics, deck_cards)
    if (.not. has_errors(diagnostics)) call read_variant(deck_cards, number, cards, diagnostics, &
      model)
    complaint = render_errors(diagnostics, source)
  end subroutine read_text

  !> Reads a variant of a deck and makes all studies that it asks for.
  subroutine compute_text(text, found, complaint, variant, threads)
    character(len=*), intent(in) :: text
    type(variant_results_t), intent(out) :: found
    character(len=:), allocatable, intent(out) :: complaint !! empty if nothing went wrong
    integer, intent(in), optional :: variant                !! number; else the first
    integer, intent(in), optional :: threads                !! else one

    type(model_t) :: model
    type(variant_run_t) :: run
    type(journal_t) :: no_journal
    type(link_store_t) :: store
    type(error_t), allocatable :: error
    integer :: number

    call read_text(text, model, complaint, variant)
    if (len(complaint) > 0) return
    number = 1
    if (present(threads)) number = threads
    call begin_variant_run(run, model)
    call compute_variant(run, number, no_journal, -1, store, error)
    if (allocated(error)) complaint = rendered(error)
    found = run%results
  end subroutine compute_text

  !> Columns and items of a table whose report the deck asks for; without a table if there is none.
  subroutine plan_of_table(found, name, plan)
    type(variant_results_t), intent(in) :: found
    character(len=*), intent(in) :: name
    type(table_plan_t), intent(out) :: plan

    type(any_table_t), allocatable :: tables(:)
    integer :: i

    call tables_of(found%model, tables)
    do i = 1, size(tables)
      if (tables(i)%table%name == name) call plan_table(tables(i)%table, found, plan)
    end do
  end subroutine plan_of_table

  !> All rows of a table whose report the deck asks for.
  subroutine rows_of_table(found, name, threads, rows)
    type(variant_results_t), intent(in) :: found
    character(len=*), intent(in) :: name
    integer, intent(in) :: threads
    type(rows_t), intent(out) :: rows

    type(table_plan_t) :: plan

    call plan_of_table(found, name, plan)
    call find_rows(plan, found, 1, plan%items, threads, rows)
  end subroutine rows_of_table

  !> A table whose report the deck asks for, as it stands on the disk.
  subroutine table_text(found, name, text)
    type(variant_results_t), intent(in) :: found
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(out) :: text

    type(table_plan_t) :: plan
    type(rows_t) :: rows
    type(string_t), allocatable :: notes(:)
    type(column_t), allocatable :: columns(:)
    type(table_file_t) :: table
    type(error_t), allocatable :: error
    integer :: unit, length

    text = ""
    call plan_of_table(found, name, plan)
    call plan%table%find_notes(found, notes)
    call rows_of_table(found, name, 1, rows)
    call open_table(".", scratch, .false., table, error)
    if (allocated(error)) return
    call header_columns(plan%layout, columns)
    call write_header(table, found%model%title, notes, columns)
    call write_rows(table, rows)
    call finish_table(table, ".", error)
    if (allocated(error)) return
    inquire (file=scratch//".dat", size=length)
    deallocate (text)
    allocate (character(len=length) :: text)
    open (newunit=unit, file=scratch//".dat", access="stream", form="unformatted", status="old", &
      action="read")
    read (unit) text
    close (unit)
    call remove_file(scratch//".dat")
  end subroutine table_text

  !> The lines of a table that are rows.
  pure function row_lines(text) result(rows)
    character(len=*), intent(in) :: text
    character(len=500), allocatable :: rows(:)

    integer :: start, length

    allocate (rows(0))
    start = 1
    do while (start <= len(text))
      length = index(text(start:), line_feed) - 1
      if (length > 0 .and. text(start:start) /= "#") rows = [character(len=500) :: rows, &
        text(start:start + length - 1)]
      start = start + length + 1
    end do
  end function row_lines

end module computed_decks
