! src/runs/texts/ - what a run says beside its tables: summary, log, echo, JSON, progress, help.
! In: model, findings, totals. Out: texts, which the callers write; `progress.f90` writes by itself.
! Begin with `summary_text` here, `log_of_variant` in `variant_log.f90`, `findings_messages` in
! `findings_texts.f90`.
! Not here: errors of a deck with carets (`src/deck/diagnostics.f90`), words in heads of tables
! (`src/reports/words`).

!> `summary.json`, and its parts that `--json` prints too: errors, warnings and failed positions as
!! JSON.
module deck_summary
  use deck_source, only: file_of_line, last_line, path_from_deck, source_t
  use diagnostics, only: diagnostic_t, diagnostics_t, errors_of, untold_errors, untold_warnings, &
    warnings_of
  use json_text, only: add_item, add_member, json_array, json_list_t, json_null, json_object, &
    json_value
  use kinds, only: wp
  use models, only: model_t, needs_frequencies
  use program_version, only: program_name, version_number
  use run_findings, only: failure_t, findings_t, untold_failures
  use run_totals, only: run_totals_t
  use tables, only: column_t, has_unit, table_file_t
  use text, only: character_count, plural, string_t
  use tokens, only: token_t
  use warnings, only: counted_text, grade_doubt, grade_meaningless, warning_t
  implicit none (type, external)
  private

  public :: summary_text, error_list, warning_list, failure_array, add_plain_message

contains

  !> The text of `summary.json`.
  pure function summary_text(name, file, diagnostics, source, findings, model, totals, parameters, &
    tables) result(text)
    character(len=*), intent(in) :: name           !! of the output folder
    character(len=*), intent(in) :: file           !! name of the deck's file, without its folder
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck, without errors
    type(source_t), intent(in) :: source           !! lines of the deck
    type(findings_t), intent(in) :: findings       !! of all variants
    type(model_t), intent(in) :: model             !! of the first variant
    type(run_totals_t), intent(in) :: totals       !! of all variants
    type(string_t), intent(in) :: parameters(:)    !! names of the VARY parameters
    type(table_file_t), intent(in) :: tables(:)    !! with all rows written
    character(len=:), allocatable :: text

    type(json_list_t) :: object, list
    integer :: i

    call add_member(object, "program", json_value(program_name))
    call add_member(object, "version", json_value(version_number))
    call add_member(object, "deck", json_value(name))
    call add_member(object, "exit_status", json_value(merge(1, 0, findings%failures > 0)))
    call add_member(object, "counts", count_object(model, totals, tables, findings))
    call add_member(object, "warnings", json_array(warning_list(diagnostics, source, findings, &
      file)))
    call add_member(object, "failures", failure_array(findings, parameters))
    call add_member(object, "more_failures", json_value(untold_failures(findings)))
    do i = 1, size(tables)
      call add_item(list, table_object(tables(i)))
    end do
    call add_member(object, "tables", json_array(list))
    text = json_object(object)//achar(10)
  end function summary_text

  !> Numbers of variants, positions, speeds, modes, failures and rows.
  pure function count_object(model, totals, tables, findings) result(value)
    type(model_t), intent(in) :: model
    type(run_totals_t), intent(in) :: totals
    type(table_file_t), intent(in) :: tables(:)
    type(findings_t), intent(in) :: findings
    character(len=:), allocatable :: value

    type(json_list_t) :: object

    call add_member(object, "variants", json_value(totals%variants))
    call add_member(object, "positions", json_value(totals%rows))
    call add_member(object, "speeds", json_value(size(model%speed%value)))
    call add_member(object, "modes", json_value(merge(model%modes, 0, needs_frequencies(model))))
    call add_member(object, "failures", json_value(findings%failures))
    call add_member(object, "rows", json_value(sum(tables%rows)))
    call add_member(object, "failed_rows", json_value(sum(tables%failed_rows)))
    value = json_object(object)
  end function count_object

  !> Files, numbers of rows, and columns of a table.
  pure function table_object(table) result(value)
    type(table_file_t), intent(in) :: table
    character(len=:), allocatable :: value

    type(json_list_t) :: object, list
    integer :: i

    if (table%has_plain) then
      call add_member(object, "file", json_value(table%name//".dat"))
    else
      call add_member(object, "file", json_value(table%name//".csv"))
    end if
    if (table%has_csv) then
      call add_member(object, "csv", json_value(table%name//".csv"))
    else
      call add_member(object, "csv", json_null)
    end if
    call add_member(object, "rows", json_value(table%rows))
    call add_member(object, "failed_rows", json_value(table%failed_rows))
    do i = 1, size(table%columns)
      call add_item(list, column_object(table%columns(i)))
    end do
    call add_member(object, "columns", json_array(list))
    value = json_object(object)
  end function table_object

  !> Name and unit of a column; the unit is null if it has none.
  pure function column_object(column) result(value)
    type(column_t), intent(in) :: column
    character(len=:), allocatable :: value

    type(json_list_t) :: object

    call add_member(object, "name", json_value(column%name))
    if (has_unit(column)) then
      call add_member(object, "unit", json_value(column%unit))
    else
      call add_member(object, "unit", json_null)
    end if
    value = json_object(object)
  end function column_object

  !> The errors of a deck in the order of its lines, then the number of those beyond the kept ones.
  pure function error_list(diagnostics, source, file) result(list)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(source_t), intent(in) :: source           !! lines of the deck
    character(len=*), intent(in) :: file           !! name of the deck's file
    type(json_list_t) :: list

    call add_messages(list, errors_of(diagnostics), source, file)
    if (untold_errors(diagnostics) > 0) call add_plain_message(list, file, &
      plural(untold_errors(diagnostics), "more error"))
  end function error_list

  !> The warnings of a deck in the order of its lines, the number of those beyond the kept ones,
  !! then the warnings of its run; those of meaningless results before all others.
  pure function warning_list(diagnostics, source, findings, file) result(list)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(source_t), intent(in) :: source           !! lines of the deck
    type(findings_t), intent(in) :: findings       !! of its run
    character(len=*), intent(in) :: file           !! name of the deck's file
    type(json_list_t) :: list

    integer, parameter :: grades(2) = [grade_meaningless, grade_doubt]
    type(diagnostic_t), allocatable :: of_deck(:)
    type(warning_t) :: rest
    integer :: i, k

    of_deck = warnings_of(diagnostics)
    do k = 1, size(grades)
      do i = 1, size(of_deck)
        if (of_deck(i)%warning%grade == grades(k)) call add_warning_of_deck(list, of_deck(i), &
          source, file)
      end do
      if (grades(k) == grade_doubt .and. untold_warnings(diagnostics) > 0) then
        rest%text = plural(untold_warnings(diagnostics), "more warning")
        rest%variant = ""
        call add_warning_of_run(list, rest, 1, file)
      end if
      do i = 1, findings%warning_count
        if (findings%warnings(i)%grade == grades(k)) call add_warning_of_run(list, &
          findings%warnings(i), findings%variants, file)
      end do
    end do
  end function warning_list

  !> Appends a warning of a deck with its place.
  pure subroutine add_warning_of_deck(list, diagnostic, source, file)
    type(json_list_t), intent(inout) :: list
    type(diagnostic_t), intent(in) :: diagnostic
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: file

    type(json_list_t) :: object

    object = placed_message(diagnostic, source, file)
    call add_grade(object, diagnostic%warning)
    call add_item(list, json_object(object))
  end subroutine add_warning_of_deck

  !> Appends a warning of a run.
  pure subroutine add_warning_of_run(list, warning, variants, file)
    type(json_list_t), intent(inout) :: list
    type(warning_t), intent(in) :: warning
    integer, intent(in) :: variants !! of the deck
    character(len=*), intent(in) :: file

    type(json_list_t) :: object

    object = plain_message(file, counted_text(warning, variants))
    call add_grade(object, warning)
    call add_item(list, json_object(object))
  end subroutine add_warning_of_run

  !> Adds what a warning takes from the results, and the number of variants that have it.
  pure subroutine add_grade(object, warning)
    type(json_list_t), intent(inout) :: object
    type(warning_t), intent(in) :: warning

    if (warning%grade == grade_meaningless) then
      call add_member(object, "grade", json_value("meaningless"))
    else
      call add_member(object, "grade", json_value("doubt"))
    end if
    if (len(warning%variant) > 0) then
      call add_member(object, "variants", json_value(warning%variants))
    else
      call add_member(object, "variants", json_null)
    end if
  end subroutine add_grade

  !> Appends messages with their places.
  pure subroutine add_messages(list, diagnostics, source, file)
    type(json_list_t), intent(inout) :: list
    type(diagnostic_t), intent(in) :: diagnostics(:)
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: file

    integer :: i

    do i = 1, size(diagnostics)
      call add_item(list, json_object(placed_message(diagnostics(i), source, file)))
    end do
  end subroutine add_messages

  !> A message with its places.
  pure function placed_message(diagnostic, source, file) result(object)
    type(diagnostic_t), intent(in) :: diagnostic
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: file
    type(json_list_t) :: object

    object = place_members(diagnostic%place, source, file)
    call add_member(object, "message", json_value(diagnostic%message))
    call add_member(object, "second_place", second_place(diagnostic, source, file))
  end function placed_message

  !> Appends a message without a place, or about a line and column; without a second place.
  pure subroutine add_plain_message(list, file, message, line, column)
    type(json_list_t), intent(inout) :: list !! to which it is appended
    character(len=*), intent(in) :: file     !! name of the deck's file
    character(len=*), intent(in) :: message  !! in words
    integer, intent(in), optional :: line    !! number, from 1
    integer, intent(in), optional :: column  !! number, from 1; counts only with `line`

    call add_item(list, json_object(plain_message(file, message, line, column)))
  end subroutine add_plain_message

  !> A message without a place, or about a line and column.
  pure function plain_message(file, message, line, column) result(object)
    character(len=*), intent(in) :: file, message
    integer, intent(in), optional :: line, column
    type(json_list_t) :: object

    call add_member(object, "file", json_value(file))
    if (present(line) .and. present(column)) then
      call add_member(object, "line", json_value(line))
      call add_member(object, "column", json_value(column))
      call add_member(object, "length", json_value(1))
    else
      call add_member(object, "line", json_null)
      call add_member(object, "column", json_null)
      call add_member(object, "length", json_null)
    end if
    call add_member(object, "message", json_value(message))
    call add_member(object, "second_place", json_null)
  end function plain_message

  !> File, line, column and length of a word. A message about something that the deck lacks points
  !! at its last line, with the length 0.
  pure function place_members(place, source, file) result(object)
    type(token_t), intent(in) :: place
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: file
    type(json_list_t) :: object

    if (place%line > 0) then
      associate (of_line => source%files(file_of_line(source, place%line)))
        if (of_line%first_line == 1) then
          call add_member(object, "file", json_value(file))
        else
          call add_member(object, "file", json_value(path_from_deck(source, of_line%path)))
        end if
        call add_member(object, "line", json_value(place%line - of_line%first_line + 1))
      end associate
      call add_member(object, "column", json_value(place%column))
      call add_member(object, "length", json_value(character_count(place%text)))
    else
      call add_member(object, "file", json_value(file))
      call add_member(object, "line", json_value(max(1, last_line(source, 1))))
      call add_member(object, "column", json_value(1))
      call add_member(object, "length", json_value(0))
    end if
  end function place_members

  !> The second place of a message with its note, or null.
  pure function second_place(diagnostic, source, file) result(value)
    type(diagnostic_t), intent(in) :: diagnostic
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: file
    character(len=:), allocatable :: value

    type(json_list_t) :: object

    value = json_null
    if (len(diagnostic%note) == 0) return
    object = place_members(diagnostic%second_place, source, file)
    call add_member(object, "message", json_value(diagnostic%note))
    value = json_object(object)
  end function second_place

  !> Positions without a pose (speed null), positions × speeds without modes, motions that ended too
  !! soon (speed null, with their time), and variants that failed as a whole (speed and crank null),
  !! as far as they are kept.
  pure function failure_array(findings, parameters) result(value)
    type(findings_t), intent(in) :: findings    !! of all variants
    type(string_t), intent(in) :: parameters(:) !! names of the VARY parameters
    character(len=:), allocatable :: value

    type(json_list_t) :: list
    integer :: i

    do i = 1, findings%kept
      call add_item(list, failure_object(findings%failed(i), parameters))
    end do
    value = json_array(list)
  end function failure_array

  !> A failed position, or a motion that ended too soon, with its variant and the reason.
  pure function failure_object(failure, parameters) result(value)
    type(failure_t), intent(in) :: failure
    type(string_t), intent(in) :: parameters(:)
    character(len=:), allocatable :: value

    type(json_list_t) :: object, varied
    integer :: i

    do i = 1, size(parameters)
      call add_member(varied, parameters(i)%text, json_value(failure%varied(i)))
    end do
    call add_member(object, "parameters", json_object(varied))
    call add_member(object, "stage", json_value(trim(failure%stage)))
    call add_number(object, "speed", failure%speed)
    call add_number(object, "crank", failure%crank)
    call add_number(object, "time", failure%time)
    call add_member(object, "reason", json_value(failure%error%text))
    value = json_object(object)
  end function failure_object

  !> Adds a number, or null where there is none.
  pure subroutine add_number(object, name, number)
    type(json_list_t), intent(inout) :: object
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(in) :: number

    if (allocated(number)) then
      call add_member(object, name, json_value(number))
    else
      call add_member(object, name, json_null)
    end if
  end subroutine add_number

end module deck_summary
