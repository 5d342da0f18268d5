!> The parts of a study: ranges of its variants, each computed by a run of its own with `--part`.
module study_parts
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: long
  use numbers, only: read_integer
  use plain_numbers, only: digit_count
  use text, only: to_string
  implicit none (type, external)
  private

  public :: part_t, read_part, first_variant, last_variant, part_name, &
    part_beginning, part_of_name

  !> Which part.
  type :: part_t
    integer :: number = 0 !! from 1
    integer :: count = 0  !! of all parts; 0: the study is in one piece
  end type part_t

  character(len=*), parameter :: digits = "0123456789"

contains

  !> Reads `3/16`. Errors: it is not of this form, there is no such part.
  pure subroutine read_part(word, part, error)
    character(len=*), intent(in) :: word
    type(part_t), intent(out) :: part
    type(error_t), allocatable, intent(out) :: error !! without a place

    integer :: slash

    slash = index(word, "/")
    call take_numbers(word(:slash - 1), word(slash + 1:), part)
    if (part%count > 0) return
    call set_error(error, error_of_input, "option --part needs the number of a part and that "// &
      "of all parts, as in --part 3/16, not '"//word//"'")
  end subroutine read_part

  !> Takes the numbers of a part, if they make sense.
  pure subroutine take_numbers(number, count, part)
    character(len=*), intent(in) :: number, count !! as text
    type(part_t), intent(out) :: part             !! its count is 0 if they do not

    type(error_t), allocatable :: error
    integer :: values(2)

    if (len(number) == 0 .or. len(count) == 0) return
    if (verify(number//count, digits) > 0) return
    call read_integer(number, values(1), error)
    if (.not. allocated(error)) call read_integer(count, values(2), error)
    if (allocated(error)) return
    if (values(1) < 1 .or. values(1) > values(2)) return
    part = part_t(values(1), values(2))
  end subroutine take_numbers

  !> The first variant of a part; parts are contiguous, and their sizes differ by one at most.
  pure function first_variant(part, variants) result(first)
    type(part_t), intent(in) :: part
    integer, intent(in) :: variants !! number of all of them, at least one a part
    integer :: first

    first = 1
    if (part%count > 0) first = int((part%number - 1_long)*variants/part%count) + 1
  end function first_variant

  !> The last variant of a part.
  pure function last_variant(part, variants) result(last)
    type(part_t), intent(in) :: part
    integer, intent(in) :: variants !! number of all of them, at least one a part
    integer :: last

    last = variants
    if (part%count > 0) last = int(int(part%number, long)*variants/part%count)
  end function last_variant

  !> `my.part03of16`: as many digits as the number of parts has.
  pure function part_name(deck, part) result(name)
    character(len=*), intent(in) :: deck !! its base name
    type(part_t), intent(in) :: part
    character(len=:), allocatable :: name

    name = part_beginning(deck)//repeat("0", digit_count(int(part%count, long)) - &
      digit_count(int(part%number, long)))//to_string(part%number)//"of"//to_string(part%count)
  end function part_name

  !> With what the names of all parts of a deck begin.
  pure function part_beginning(deck) result(beginning)
    character(len=*), intent(in) :: deck !! its base name
    character(len=:), allocatable :: beginning

    beginning = deck//".part"
  end function part_beginning

  !> The part that has a name.
  pure function part_of_name(deck, name) result(part)
    character(len=*), intent(in) :: deck !! its base name
    character(len=*), intent(in) :: name !! of a file
    type(part_t) :: part                 !! its count is 0 if the name is not one of a part

    integer :: first, between

    first = len(part_beginning(deck)) + 1
    if (len(name) < first) return
    between = first - 1 + index(name(first:), "of")
    if (between < first) return
    call take_numbers(name(first:between - 1), name(between + 2:), part)
    if (part%count == 0) return
    if (part_name(deck, part) /= name) part = part_t()
  end function part_of_name

end module study_parts
