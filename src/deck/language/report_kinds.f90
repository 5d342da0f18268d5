!> Records of the table of reports: name, tables, columns and needs of each report.
!!
!! The table itself is in `report_table`, where reports are computed and written; it is passed to
!! the procedures that read a deck.
module report_kinds
  use errors, only: error_t
  use kinds, only: wp
  use numbers, only: read_real
  use text, only: append_string, string_t, word_list
  implicit none (type, external)
  private

  public :: report_kind_t, table_kind_t, column_kind_t, report_names, kind_named, columns_of, &
    is_column_of, default_number, kind_of_linkage, key_count
  public :: any_linkage, four_bars, other_linkages, format_words

  !> The linkages that a report is about; in `format=`, those as which a linkage is written.
  integer, parameter :: any_linkage = 0, four_bars = 1, other_linkages = 2

  !> The words of `format=`, in the order of four_bars and other_linkages.
  character(len=*), parameter :: format_words = "four_bar linkage"

  !> One table of a report. Columns with the same unit are separated by commas, with the unit after
  !! a colon, and these groups by blanks: `crank:deg x,y:length`. A unit is given as printed in the
  !! table, or as a quantity (`length`, `force`, …) in the units of the deck's results; `speed`
  !! stands for a speed as the deck gives it, `#` for whole numbers, `name` for names. A column name
  !! that ends with `*` stands for a series of numbered columns; one that ends with `?` is omitted
  !! in some tables.
  type :: table_kind_t
    character(len=24) :: name = ""     !! of the table; blank: unused record
    character(len=320) :: columns = "" !! with units, as above
    logical :: has_blocks = .true.     !! empty lines separate the variants of a deck
  end type table_kind_t

  type :: report_kind_t
    character(len=12) :: name = ""    !! in small letters
    character(len=64) :: help = ""    !! in one line
    character(len=160) :: pattern = "" !! correct form of the card, its keys end with `=`; blank:
                                       !! the name alone
    character(len=64) :: default = "" !! default entries of its card; blank: none
    character(len=64) :: studies = "" !! that provide its rows, separated by blanks
    logical :: positions = .false.    !! it has rows for every crank angle
    logical :: masses = .false.       !! it uses masses and their loads
    logical :: weighs = .false.       !! so it does at rest and without gravity
    logical :: beams = .false.        !! it uses links as beams
    logical :: frequencies = .false.  !! it uses natural frequencies
    logical :: response = .false.     !! it uses the elastic response of links at constant speed
    logical :: offered = .true.       !! listed in the error about a misspelt report
    logical :: reserved = .false.     !! its column names are refused on VARY cards even in decks
                                      !! without it
    integer :: linkages = any_linkage !! that it is about; two records may have one name
    integer :: numbers = 0            !! how many numbers its studies keep for each position
    type(table_kind_t) :: tables(4)   !! those with a name
  end type report_kind_t

  !> One column, or a series of numbered columns.
  type :: column_kind_t
    character(len=:), allocatable :: name !! without its mark
    character(len=:), allocatable :: unit !! as in `table_kind_t`
    logical :: is_numbered = .false.      !! marked with `*`
    logical :: is_optional = .false.      !! marked with `?`
  end type column_kind_t

contains

  !> The names of all reports offered to users, separated by blanks.
  pure function report_names(kinds) result(names)
    type(report_kind_t), intent(in) :: kinds(:) !! (reports) the table of reports
    character(len=:), allocatable :: names

    integer :: i

    names = ""
    do i = 1, size(kinds)
      if (kinds(i)%offered .and. kind_named(kinds, trim(kinds(i)%name)) == i) names = names//" "// &
        trim(kinds(i)%name)
    end do
    names = names(2:)
  end function report_names

  !> The number of a report in the table; 0 if there is none of this name.
  pure function kind_named(kinds, name) result(number)
    type(report_kind_t), intent(in) :: kinds(:) !! (reports) the table of reports
    character(len=*), intent(in) :: name        !! in small letters
    integer :: number

    do number = 1, size(kinds)
      if (kinds(number)%name == name) return
    end do
    number = 0
  end function kind_named

  !> The number of a report on a kind of linkages in the table; 0 if there is none.
  pure function kind_of_linkage(kinds, name, is_four_bar) result(number)
    type(report_kind_t), intent(in) :: kinds(:) !! (reports) the table of reports
    character(len=*), intent(in) :: name        !! in small letters
    logical, intent(in) :: is_four_bar          !! else any other linkage
    integer :: number

    do number = 1, size(kinds)
      if (kinds(number)%name == name .and. any(kinds(number)%linkages == [any_linkage, &
        merge(four_bars, other_linkages, is_four_bar)])) return
    end do
    number = 0
  end function kind_of_linkage

  !> The number that a report's card has for a key by default; 0 without one.
  pure function default_number(kind, key) result(number)
    type(report_kind_t), intent(in) :: kind !! the report
    character(len=*), intent(in) :: key     !! in small letters, without `=`
    real(wp) :: number

    type(error_t), allocatable :: error
    type(string_t), allocatable :: entries(:)
    integer :: i

    number = 0.0_wp
    entries = word_list(trim(kind%default))
    do i = 1, size(entries)
      associate (entry => entries(i)%text)
        if (index(entry, key//"=") == 1) call read_real(entry(len(key) + 2:), number, error)
      end associate
    end do
  end function default_number

  !> The columns of a table, in their order.
  pure subroutine columns_of(table, columns)
    type(table_kind_t), intent(in) :: table                     !! of a report
    type(column_kind_t), allocatable, intent(out) :: columns(:) !! (columns)

    type(string_t), allocatable :: names(:), units(:)
    integer :: i, last

    call split_columns(trim(table%columns), names, units)
    allocate (columns(size(names)))
    do i = 1, size(columns)
      last = len(names(i)%text)
      columns(i)%is_numbered = names(i)%text(last:) == "*"
      columns(i)%is_optional = names(i)%text(last:) == "?"
      if (columns(i)%is_numbered .or. columns(i)%is_optional) last = last - 1
      columns(i)%name = names(i)%text(:last)
      columns(i)%unit = units(i)%text
    end do
  end subroutine columns_of

  !> How many columns say what a row is about: the first ones, with times, speeds, positions, names
  !! and whole numbers. The others have values.
  pure function key_count(columns) result(count)
    type(column_kind_t), intent(in) :: columns(:) !! of a table
    integer :: count

    do count = 0, size(columns) - 1
      associate (next => columns(count + 1))
        if (all(next%name /= [character(len=5) :: "time", "speed", "crank"]) .and. &
          all(next%unit /= [character(len=4) :: "name", "#"])) return
      end associate
    end do
    count = size(columns)
  end function key_count

  !> Splits a list of columns into names with their marks and the unit of each.
  pure subroutine split_columns(list, names, units)
    character(len=*), intent(in) :: list
    type(string_t), allocatable, intent(out) :: names(:), units(:)

    integer :: first, last, colon, comma

    allocate (names(0), units(0))
    first = 1
    do while (first <= len(list))
      last = first + index(list(first:)//" ", " ") - 2
      colon = first + index(list(first:last), ":") - 1
      do while (first < colon)
        comma = first + scan(list(first:colon), ",:") - 1
        call append_string(names, list(first:comma - 1))
        call append_string(units, list(colon + 1:last))
        first = comma + 1
      end do
      first = last + 2
    end do
  end subroutine split_columns

  !> Whether a report has a column of this name.
  pure function is_column_of(kind, name) result(is)
    type(report_kind_t), intent(in) :: kind !! the report
    character(len=*), intent(in) :: name    !! case counts
    logical :: is

    type(column_kind_t), allocatable :: columns(:)
    integer :: i, t

    is = .false.
    do t = 1, size(kind%tables)
      call columns_of(kind%tables(t), columns)
      do i = 1, size(columns)
        if (columns(i)%is_numbered) then
          is = is .or. is_numbered(name, columns(i)%name)
        else
          is = is .or. columns(i)%name == name
        end if
      end do
    end do
  end function is_column_of

  !> Whether a name is a word followed by a number.
  pure function is_numbered(name, word) result(is)
    character(len=*), intent(in) :: name, word
    logical :: is

    is = .false.
    if (len(name) > len(word) .and. index(name, word) == 1) is = &
      verify(name(len(word) + 1:), "0123456789") == 0
  end function is_numbered

end module report_kinds
