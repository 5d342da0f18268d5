!> What a report is, as the table of reports lists it: its name, its tables and their columns, what
!! it needs.
!!
!! The table itself stands where reports are computed and written (`report_table`); whoever reads a
!! deck is given it.
module report_kinds
  use text, only: append_string, string_t
  implicit none (type, external)
  private

  public :: report_kind_t, table_kind_t, column_kind_t, report_names, kind_named, columns_of, &
    is_column_of

  !> One table of a report. Columns are separated by blanks, each with its unit behind a colon,
  !! those of one unit by commas: `crank:deg x,y:length`. A unit is written as it stands in the
  !! table, or is a quantity (`length`, `force`, …) in the deck's UNITS; `#` marks whole numbers,
  !! `name` names. A name that ends with `*` stands for as many columns as the table has numbers of
  !! them, one that ends with `?` is left out of some tables.
  type :: table_kind_t
    character(len=12) :: name = ""
    character(len=240) :: columns = ""
  end type table_kind_t

  type :: report_kind_t
    character(len=12) :: name = ""
    character(len=64) :: help = ""     !! in one line
    character(len=56) :: pattern = ""  !! the card as it should be, its keys end with `=`; blank:
                                       !! the name alone
    character(len=12) :: default = ""  !! what its card says if the user does not; blank: nothing
    character(len=32) :: studies = ""  !! that it takes its rows from
    logical :: positions = .false.     !! it has rows for every crank angle
    logical :: masses = .false.        !! it is about masses and their loads
    logical :: beams = .false.         !! it takes links as beams
    logical :: frequencies = .false.
    logical :: offered = .true.        !! to whoever has misspelt a report
    logical :: reserved = .false.      !! its columns may not vary in decks without it, either
    integer :: numbers = 0             !! that its studies keep for each position
    type(table_kind_t) :: tables(2)    !! those with a name
  end type report_kind_t

  !> One column, or as many as there are of its kind.
  type :: column_kind_t
    character(len=:), allocatable :: name, unit
    logical :: is_numbered = .false.
    logical :: is_optional = .false.
  end type column_kind_t

contains

  !> The names of all reports that are offered, separated by blanks.
  pure function report_names(kinds) result(names)
    type(report_kind_t), intent(in) :: kinds(:)
    character(len=:), allocatable :: names

    integer :: i

    names = trim(kinds(1)%name)
    do i = 2, size(kinds)
      if (kinds(i)%offered) names = names//" "//trim(kinds(i)%name)
    end do
  end function report_names

  !> The number of a report among all; 0 if there is none of that name.
  pure function kind_named(kinds, name) result(number)
    type(report_kind_t), intent(in) :: kinds(:)
    character(len=*), intent(in) :: name
    integer :: number

    do number = 1, size(kinds)
      if (kinds(number)%name == name) return
    end do
    number = 0
  end function kind_named

  !> The columns of a table, in their order.
  pure subroutine columns_of(table, columns)
    type(table_kind_t), intent(in) :: table
    type(column_kind_t), allocatable, intent(out) :: columns(:)

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

  !> Names with their marks, and the unit of each.
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

  !> Whether a name stands at the head of a column of a report.
  pure function is_column_of(kind, name) result(is)
    type(report_kind_t), intent(in) :: kind
    character(len=*), intent(in) :: name
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

  !> Whether a name is a word with a number behind it.
  pure function is_numbered(name, word) result(is)
    character(len=*), intent(in) :: name, word
    logical :: is

    is = .false.
    if (len(name) > len(word) .and. index(name, word) == 1) is = &
      verify(name(len(word) + 1:), "0123456789") == 0
  end function is_numbered

end module report_kinds
