!> VARY: a name with a list of values, or with a column of a table.
module variations
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t, error_count
  use errors, only: error_t
  use kinds, only: wp
  use numbers, only: number_length, read_real, shortest_text
  use report_kinds, only: is_column_of, kind_named, report_kind_t
  use summary_quantities, only: is_summary_column
  use text, only: lower_case, same_word
  use tokens, only: token_part, token_t
  use units, only: dimension_none, read_unit, si_units, unit_t
  use value_lists, only: read_values, value_list_t
  implicit none (type, external)
  private

  public :: variation_t, read_variation, read_column, get_value_word, value_word

  !> A name on a VARY card.
  type :: variation_t
    type(token_t) :: name                 !! on its card
    integer :: setting = 0                !! its number among the settings
    integer :: card = 0                   !! number of its card, whose names vary together
    character(len=:), allocatable :: unit !! of all values; empty: none
    real(wp), allocatable :: value(:)     !! (values) in this unit; there may be a million, so that
                                          !! words are made of them one by one
    type(token_t), allocatable, private :: words(:) !! of the card after its name, or of a column
    integer, allocatable, private :: word(:)        !! (values) number of the word it comes from
  end type variation_t

  !> The column of every CSV table with the reason why a row has failed.
  character(len=*), parameter :: csv_failure = "failure"

contains

  !> Reads `VARY name a to b step s` and lists of numbers, as on the CRANK card.
  !!
  !! Errors: the name is that of a column, the values have different units, the list is wrong
  !! (`read_values`). A wrong list has no values.
  pure subroutine read_variation(card, setting, cards, reports, diagnostics, variation)
    type(card_t), intent(in) :: card                  !! with at least two words, with values in
                                                      !! place of `$name`
    integer, intent(in) :: setting                    !! its number among the settings
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(report_kind_t), intent(in) :: reports(:)     !! the table of reports
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(variation_t), intent(out) :: variation       !! without values if the list is wrong

    type(token_t), allocatable :: words(:)
    type(value_list_t) :: list
    integer :: errors
    logical :: fine

    call begin_variation(card%words(1), setting, cards, reports, diagnostics, variation)
    words = card%words(2:)
    errors = error_count(diagnostics)
    call take_unit(words, diagnostics, variation%unit, fine)
    if (.not. fine) return
    call read_values(words, dimension_none, si_units(), "value", diagnostics, list)
    if (error_count(diagnostics) > errors .or. any(words%set_line < 0)) return
    variation%value = list%value
    variation%words = card%words(2:)
    variation%word = list%word
  end subroutine read_variation

  !> A variation without values. Errors: its name is that of a column.
  pure subroutine begin_variation(name, setting, cards, reports, diagnostics, variation)
    type(token_t), intent(in) :: name !! on its card
    integer, intent(in) :: setting
    type(card_t), intent(in) :: cards(:)
    type(report_kind_t), intent(in) :: reports(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(variation_t), intent(out) :: variation

    variation%name = name
    variation%setting = setting
    variation%unit = ""
    allocate (variation%value(0))
    if (is_column(name%text, cards, reports)) call add_error(diagnostics, name, "'"//name%text// &
      "' is already a column of the tables; choose another name, since a VARY becomes a "// &
      "column too")
  end subroutine begin_variation

  !> Reads the values of a name on `VARY name … table=`.
  !!
  !! Errors: the name is that of a column of results, the column of the table has no unit that there
  !! is, a word in it is no number or has another unit.
  pure subroutine read_column(name, setting, unit, words, cards, reports, diagnostics, variation)
    type(token_t), intent(in) :: name                 !! on the card
    integer, intent(in) :: setting                    !! its number among the settings
    type(token_t), intent(in) :: unit                 !! of the column; a dash: none
    type(token_t), intent(in) :: words(:)             !! (rows) with values in place of `$name`
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(report_kind_t), intent(in) :: reports(:)     !! the table of reports
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(variation_t), intent(out) :: variation       !! without values after an error

    type(unit_t) :: measure
    type(error_t), allocatable :: error
    real(wp) :: values(size(words))
    logical :: fine
    integer :: i

    call begin_variation(name, setting, cards, reports, diagnostics, variation)
    if (unit%text /= "-") then
      variation%unit = unit%text
      call read_unit(unit%text, dimension_none, measure, error)
      if (allocated(error)) then
        call add_error(diagnostics, unit, error%text(:index(error%text//";", ";") - 1)// &
          "; expected that of column '"//name%text//"', or - for pure numbers")
        return
      end if
    end if
    do i = 1, size(words)
      call read_cell(words(i), variation%unit, diagnostics, values(i), fine)
      if (.not. fine) return
    end do
    variation%value = values
    variation%words = words
    variation%word = [(i, i=1, size(words))]
  end subroutine read_column

  !> Reads a number of a column, bare or in its unit.
  pure subroutine read_cell(word, unit, diagnostics, value, fine)
    type(token_t), intent(in) :: word
    character(len=*), intent(in) :: unit
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(out) :: value
    logical, intent(out) :: fine

    type(error_t), allocatable :: error
    integer :: length

    value = 0.0_wp
    length = number_length(word%text)
    fine = length > 0
    if (fine) call read_real(word%text(:length), value, error)
    if (.not. fine) then
      call add_error(diagnostics, word, "'"//word%text//"' is not a number")
    else if (allocated(error)) then
      call add_error(diagnostics, word, error%text)
    else if (length < len(word%text) .and. word%text(length + 1:) /= unit) then
      call add_error(diagnostics, word, "'"//word%text//"' is not a number of its column: "// &
        "numbers are bare there, or in the unit at its head")
    else
      return
    end if
    fine = .false.
  end subroutine read_cell

  !> A value as text with its unit, which reads back to the same double, and its place.
  pure subroutine get_value_word(variation, number, word)
    type(variation_t), intent(in) :: variation !! with values
    integer, intent(in) :: number              !! of the value, from 1
    type(token_t), intent(out) :: word         !! at the place of the word that it comes from

    character(len=:), allocatable :: text

    word = variation%words(variation%word(number))
    text = shortest_text(variation%value(number))//variation%unit
    ! Of a range, or where the unit stands behind the last number or at the head of a column.
    word%is_computed = word%is_computed .or. word%text /= text
    word%text = text
  end subroutine get_value_word

  !> The word of any value, at the place of the first word of the card.
  pure function value_word(variation, value) result(word)
    type(variation_t), intent(in) :: variation !! with values
    real(wp), intent(in) :: value              !! in its unit
    type(token_t) :: word

    word = variation%words(1)
    word%text = shortest_text(value)//variation%unit
    word%is_computed = .true.
  end function value_word

  !> Whether a name is that of a column. Column names of some reports are refused only in decks that
  !! request them: `M`, `load` or `time` may vary elsewhere.
  pure function is_column(name, cards, reports) result(is)
    character(len=*), intent(in) :: name
    type(card_t), intent(in) :: cards(:) !! of the deck
    type(report_kind_t), intent(in) :: reports(:)
    logical :: is

    integer :: i, k

    is = name == csv_failure
    do k = 1, size(reports)
      if (reports(k)%reserved) is = is .or. is_column_of(reports(k), name)
    end do
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "REPORT") .or. size(cards(i)%words) == 0) cycle
      k = kind_named(reports, lower_case(cards(i)%words(1)%text))
      if (k == 0) cycle
      is = is .or. is_column_of(reports(k), name)
      if (reports(k)%name == "summary") is = is .or. is_summary_column(name)
    end do
  end function is_column

  !> Separates the unit from the numbers: all numbers have the same unit, or none has one, or it is
  !! the last word.
  pure subroutine take_unit(words, diagnostics, unit, fine)
    type(token_t), allocatable, intent(inout) :: words(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=:), allocatable, intent(inout) :: unit
    logical, intent(out) :: fine !! false: the units differ

    type(token_t) :: mine, first
    integer :: i, length
    logical :: at_end

    fine = .true.
    at_end = is_unit_at_end(words)
    if (at_end) then
      first = words(size(words))
      unit = first%text
      words = words(:size(words) - 1)
    end if
    do i = 1, size(words)
      length = number_length(words(i)%text)
      if (length == 0) cycle
      mine = token_part(words(i), length + 1, len(words(i)%text))
      ! Anything but a unit is left to `read_values`, which reports it.
      if (len(mine%text) > 0) then
        if (scan(mine%text(:1), ".,*/+-0123456789") == 1) cycle
      end if
      words(i) = token_part(words(i), 1, length)
      if (at_end .and. len(mine%text) == 0) cycle
      if (i == 1 .and. .not. at_end) then
        first = mine
        unit = mine%text
      end if
      if (mine%text == unit .and. .not. at_end) cycle
      fine = .false.
      if (len(mine%text) == 0) mine = words(i)
      if (len(first%text) == 0) first = words(1)
      call add_error(diagnostics, mine, &
        "all values of a VARY must have the same unit, or none", first, "another one is here")
      return
    end do
  end subroutine take_unit

  !> Whether the last word is the unit of all numbers before it.
  pure function is_unit_at_end(words) result(is)
    type(token_t), intent(in) :: words(:)
    logical :: is

    integer :: last

    last = size(words)
    is = .false.
    if (last < 2) return
    if (number_length(words(last)%text) > 0 .or. words(last)%set_line < 0 .or. &
      index(words(last)%text, "$") > 0) return
    is = .not. (is_range_word(words(last)) .or. is_range_word(words(last - 1)))
  end function is_unit_at_end

  pure function is_range_word(word) result(is)
    type(token_t), intent(in) :: word
    logical :: is

    is = same_word(word%text, "to") .or. same_word(word%text, "step")
  end function is_range_word

end module variations
