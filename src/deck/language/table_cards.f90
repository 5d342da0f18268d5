!> TABLE cards: columns of numbers, from the deck or from files (`table_files`). Other cards name
!! them by `table=`.
module table_cards
  use card_reader, only: read_measure
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use errors, only: error_t
  use kinds, only: wp
  use numbers, only: number_length
  use text, only: plural, same_word, to_string
  use tokens, only: token_t
  use units, only: dimension_none, read_unit, serves_for, unit_t, wrong_unit
  use value_lists, only: model_value
  implicit none (type, external)
  private

  public :: number_table_t, read_table, find_columns, column_count, table_number, check_tables

  !> Columns of numbers with the words that they come from.
  type :: number_table_t
    type(token_t) :: name
    type(token_t), allocatable :: units(:)     !! (columns) words
    type(token_t), allocatable :: words(:, :)  !! (columns, rows)
    real(wp), allocatable :: values(:, :)      !! (columns, rows) angles in degrees, all others in
                                               !! SI
  end type number_table_t

contains

  !> Reads the table that a card names.
  !!
  !! Errors: there is no such table; units of columns that are missing, too many or of the wrong
  !! dimension; numbers that cannot be read, a row that is not complete; first values of rows that
  !! do not rise.
  pure subroutine read_table(cards, word, columns, dimensions, diagnostics, table, fine)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(token_t), intent(in) :: word                 !! value of `table=`
    character(len=*), intent(in) :: columns           !! what they are: `times and angles`
    integer, intent(in) :: dimensions(:, :)           !! (4, columns) that they must have
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(number_table_t), intent(out) :: table        !! complete if it is fine
    logical, intent(out) :: fine                      !! whether it could be read

    type(unit_t) :: units(size(dimensions, 2))

    call find_columns(cards, word, size(units), columns, diagnostics, table, fine)
    if (fine) call read_units(columns, dimensions, diagnostics, units, table, fine)
    if (fine) call read_numbers(dimensions, units, diagnostics, table, fine)
    if (fine) call refuse_falling(diagnostics, table, fine)
  end subroutine read_table

  !> Finds the words of the table that a card names: units and numbers, which are not read.
  !!
  !! Errors: there is no such table; units of columns that are missing or too many; a row that is
  !! not complete.
  pure subroutine find_columns(cards, word, count, columns, diagnostics, table, fine)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(token_t), intent(in) :: word                 !! value of `table=`
    integer, intent(in) :: count                      !! of the columns that it must have
    character(len=*), intent(in) :: columns           !! what they are: `times and angles`
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(number_table_t), intent(out) :: table        !! complete but for the values, if it is fine
    logical, intent(out) :: fine                      !! whether it could be read

    integer :: number, found, rows

    fine = .false.
    allocate (table%units(0), table%words(count, 0), table%values(count, 0))
    table%name = word
    number = table_number(cards, word%text)
    if (number == 0) then
      ! A file that cannot be read has been reported.
      if (.not. has_errors(diagnostics)) call add_error(diagnostics, word, "there is no table '"// &
        word%text//"'")
      return
    end if
    associate (words => cards(number)%words)
      found = column_count(cards, word%text)
      rows = (size(words) - 1 - count)/count
      if (found /= count) then
        call add_error(diagnostics, words(min(size(words), 1 + max(1, min(found, count + 1)))), &
          "this table has the units of "//plural(found, "column")//"; expected "// &
          to_string(count)//", of "//columns, word, "it is named here")
      else if (size(words) /= 1 + count*(1 + rows)) then
        call add_error(diagnostics, words(size(words)), "the last row is not complete: "// &
          "rows have "//plural(count, "number"), word, "the table is named here")
      else
        fine = .true.
        table%units = words(2:1 + count)
        table%words = reshape(words(2 + count:), [count, rows])
      end if
    end associate
  end subroutine find_columns

  !> Number of the columns of a table: units behind its name; 0 if there is no such table.
  pure function column_count(cards, name) result(columns)
    type(card_t), intent(in) :: cards(:)     !! (cards) all of the deck
    character(len=*), intent(in) :: name     !! value of `table=`
    integer :: columns

    integer :: card, i

    columns = 0
    card = table_number(cards, name)
    if (card == 0) return
    do i = 2, size(cards(card)%words)
      if (number_length(cards(card)%words(i)%text) > 0) exit
      columns = columns + 1
    end do
  end function column_count

  !> Number of the TABLE card with a name; 0 if there is none.
  pure function table_number(cards, name) result(number)
    type(card_t), intent(in) :: cards(:)     !! (cards) all of the deck
    character(len=*), intent(in) :: name     !! value of `table=`
    integer :: number

    do number = 1, size(cards)
      if (.not. same_word(cards(number)%keyword%text, "TABLE")) cycle
      if (size(cards(number)%words) == 0) cycle
      if (cards(number)%words(1)%text == name) return
    end do
    number = 0
  end function table_number

  !> Reads the units of the columns.
  pure subroutine read_units(columns, dimensions, diagnostics, units, table, fine)
    character(len=*), intent(in) :: columns
    integer, intent(in) :: dimensions(:, :)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(unit_t), intent(out) :: units(:) !! (columns)
    type(number_table_t), intent(in) :: table
    logical, intent(out) :: fine

    type(error_t), allocatable :: error
    integer :: i

    fine = .true.
    do i = 1, size(units)
      associate (word => table%units(i))
        ! A column of pure numbers has a dash.
        units(i)%name = ""
        if (word%text == "-" .and. all(dimensions(:, i) == dimension_none)) cycle
        call read_unit(word%text, dimensions(:, i), units(i), error)
        if (.not. allocated(error)) then
          if (serves_for(units(i), dimensions(:, i))) cycle
          call add_error(diagnostics, word, wrong_unit(units(i), dimensions(:, i))// &
            "; the columns are "//columns, table%name, "it is named here")
        else
          call add_error(diagnostics, word, error%text)
        end if
        fine = .false.
      end associate
    end do
  end subroutine read_units

  !> Reads all rows.
  pure subroutine read_numbers(dimensions, units, diagnostics, table, fine)
    integer, intent(in) :: dimensions(:, :)
    type(unit_t), intent(in) :: units(:) !! (columns)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(number_table_t), intent(inout) :: table
    logical, intent(out) :: fine

    type(unit_t) :: measure
    real(wp) :: value
    integer :: i, k
    logical :: read

    fine = .true.
    deallocate (table%values)
    allocate (table%values(size(units), size(table%words, 2)), source=0.0_wp)
    do k = 1, size(table%words, 2)
      do i = 1, size(units)
        call read_measure(table%words(i, k), dimensions(:, i), units(i), diagnostics, value, &
          measure, read)
        fine = fine .and. read
        if (read) table%values(i, k) = model_value(value, measure, dimensions(:, i))
      end do
    end do
  end subroutine read_numbers

  !> Errors: a row does not have a larger first value than the one before.
  pure subroutine refuse_falling(diagnostics, table, fine)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(number_table_t), intent(in) :: table
    logical, intent(inout) :: fine

    integer :: k

    do k = 2, size(table%values, 2)
      if (table%values(1, k) > table%values(1, k - 1)) cycle
      call add_error(diagnostics, table%words(1, k), &
        "the values of the first column must rise: "//table%words(1, k)%text//" follows "// &
        table%words(1, k - 1)%text)
      fine = .false.
      return
    end do
  end subroutine refuse_falling

  !> Errors: a TABLE card of the wrong form, two of one name. Warnings: a table that no card names.
  pure subroutine check_tables(cards, diagnostics)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added

    integer :: i, first

    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "TABLE")) cycle
      associate (card => cards(i))
        if (size(card%entries) > 0) then
          call add_error(diagnostics, card%entries(1)%key, "unknown key '"// &
            card%entries(1)%key%text//"'; expected: "//pattern_of("TABLE"))
        else if (size(card%words) < 2) then
          call add_error(diagnostics, card%keyword, "this card is too short; expected: "// &
            pattern_of("TABLE"))
        else
          first = table_number(cards, card%words(1)%text)
          if (first < i) then
            call add_error(diagnostics, card%words(1), "a second table '"//card%words(1)%text// &
              "'", cards(first)%words(1), "the first is here")
          else if (.not. is_named(cards, card%words(1)%text)) then
            call add_warning(diagnostics, card%words(1), "no card names the table '"// &
              card%words(1)%text//"'")
          end if
        end if
      end associate
    end do
  end subroutine check_tables

  !> Whether any card has `table=` with a name.
  pure function is_named(cards, name) result(is)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: name
    logical :: is

    integer :: i, k

    is = .true.
    do i = 1, size(cards)
      do k = 1, size(cards(i)%entries)
        if (same_word(cards(i)%entries(k)%key%text, "table") .and. &
          cards(i)%entries(k)%value%text == name) return
      end do
    end do
    is = .false.
  end function is_named

end module table_cards
