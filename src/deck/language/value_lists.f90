!> Lists of numbers on cards: single numbers, ranges `a to b step s`, one unit for all.
module value_lists
  use card_reader, only: entry_of, has_value, read_measure, read_quantity
  use cards, only: card_t, entry_t
  use constants, only: pi
  use decimals, only: decimal_of, decimal_point, decimal_t, decimal_value
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_t
  use kinds, only: wp
  use numbers, only: number_length
  use sorting, only: ascending_order
  use text, only: same_word, to_string
  use tokens, only: list_items, token_t
  use units, only: coherent_unit, dimension_angle, dimension_none, from_si, read_unit, &
    serves_for, to_si, unit_system_t, unit_t, wrong_unit
  implicit none (type, external)
  private

  public :: value_list_t, empty_list, read_values, read_entry_list, read_entry_pair, find_items, &
    list_steps, model_value, value_number

  !> The numbers in a list on a card, each with the word it comes from.
  type :: value_list_t
    real(wp), allocatable :: value(:)      !! (values) angles in degrees, all others in SI
    integer, allocatable :: word(:)        !! (values) number of the word in `words`
    type(token_t), allocatable :: words(:) !! (words) with their places
    type(unit_t) :: unit                   !! the first that the list names; without a name if it
                                           !! names none
    real(wp), allocatable :: written(:)    !! (values) in this unit, or in that of bare numbers; as
                                           !! they are written if they are written in it
  end type value_list_t

  !> A number as it is written.
  type :: written_t
    real(wp) :: number = 0.0_wp    !! in `unit`
    type(decimal_t) :: decimal     !! the same
    type(unit_t) :: unit
    logical :: is_zero = .false.   !! bare, and the same in all units
    real(wp) :: value = 0.0_wp     !! angle in degrees, all others in SI
  end type written_t

  !> A range with more values is taken for a mistake.
  integer, parameter :: most_values = 1000000

contains

  !> A list without values.
  pure function empty_list() result(list)
    type(value_list_t) :: list

    allocate (list%value(0), list%word(0), list%words(0), list%written(0))
  end function empty_list

  !> Reads the values of a key, separated by commas, with the units of `read_values`. Without the
  !! key the list is empty.
  !!
  !! Errors: as for `read_values`; an empty item.
  pure subroutine read_entry_list(card, key, dimension, system, diagnostics, list)
    type(card_t), intent(in) :: card                  !! of any kind
    character(len=*), intent(in) :: key               !! in any case of letters
    integer, intent(in) :: dimension(4)               !! that the values must have
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(value_list_t), intent(out) :: list           !! empty without the key

    type(token_t), allocatable :: words(:)
    logical :: fine

    list = empty_list()
    if (.not. has_value(card, key)) return
    call find_items(card, key, diagnostics, words, fine)
    if (fine) call read_values(words, dimension, system, key//" value", diagnostics, list)
  end subroutine read_entry_list

  !> The values `0, step, 2 step, …` before an end, and the end, which takes the place of the last
  !! of them if it is within 1e-9 of a step of it; they have no words.
  pure subroutine list_steps(end_word, step_word, dimension, system, list)
    type(token_t), intent(in) :: end_word, step_word !! already read without errors, both above 0
    integer, intent(in) :: dimension(4)              !! of the values
    type(unit_system_t), intent(in) :: system        !! units of bare numbers
    type(value_list_t), intent(out) :: list          !! in SI

    type(diagnostics_t) :: diagnostics
    type(unit_t) :: bare
    type(written_t) :: first, last, step
    logical :: fine

    list = empty_list()
    bare = coherent_unit(system, dimension)
    first%is_zero = .true.
    first%decimal = decimal_of("0")
    call read_value(end_word, dimension, bare, diagnostics, last, fine)
    call read_value(step_word, dimension, bare, diagnostics, step, fine)
    list%unit = step%unit
    call find_points(first, last, step, dimension, list, list%written, list%value)
    if (list%value(size(list%value)) < last%value) then
      list%value = [list%value, last%value]
      list%written = [list%written, in_unit_of(list, last, last%value, dimension)]
    end if
    list%word = spread(0, 1, size(list%value))
  end subroutine list_steps

  !> Reads the two values of a key in SI; they may be equal.
  !!
  !! Errors: not two values; otherwise as for `read_quantity`.
  pure subroutine read_entry_pair(card, key, names, dimension, system, diagnostics, pair, fine)
    type(card_t), intent(in) :: card                  !! of any kind
    character(len=*), intent(in) :: key               !! in any case of letters
    character(len=*), intent(in) :: names             !! of the two, for messages: `along,offset`
    integer, intent(in) :: dimension(4)               !! that both values must have
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: pair(2)                  !! [SI]; 0 where no value was read
    logical, intent(out) :: fine                      !! whether the key exists and its values are
                                                      !! right

    type(token_t), allocatable :: words(:)
    logical :: both(2)
    integer :: i

    pair = 0.0_wp
    fine = .false.
    if (.not. has_value(card, key)) return
    call find_items(card, key, diagnostics, words, fine)
    if (.not. fine) return
    if (size(words) /= 2) then
      call add_error(diagnostics, words(min(3, size(words))), "'"//key//"=' takes two values: "// &
        key//"="//names)
      fine = .false.
      return
    end if
    do i = 1, 2
      call read_quantity(words(i), dimension, system, diagnostics, pair(i), both(i))
    end do
    fine = all(both)
  end subroutine read_entry_pair

  !> The items in the list of an existing key. Errors: an empty item.
  pure subroutine find_items(card, key, diagnostics, words, fine)
    type(card_t), intent(in) :: card                    !! of any kind
    character(len=*), intent(in) :: key                 !! in any case of letters
    type(diagnostics_t), intent(inout) :: diagnostics   !! errors are added
    type(token_t), allocatable, intent(out) :: words(:) !! (items) with their places
    logical, intent(out) :: fine                        !! whether no item is empty

    type(entry_t) :: entry
    type(token_t), allocatable :: more(:)
    integer :: i

    fine = .true.
    entry = entry_of(card, key)
    if (allocated(entry%items)) then
      allocate (words(0))
      do i = 1, size(entry%items)
        ! A statement of its own: inside an array constructor gfortran 12 would leak its memory.
        more = list_items(entry%items(i))
        words = [words, more]
      end do
    else
      words = list_items(entry%value)
    end if
    do i = 1, size(words)
      if (len(words(i)%text) > 0) cycle
      words(i)%text = ","
      call add_error(diagnostics, words(i), "a value is missing in this list")
      fine = .false.
      return
    end do
  end subroutine find_items

  !> Reads a list of numbers and ranges, with angles in degrees and all others in SI.
  !!
  !! Errors: as for `read_measure`; a range of the wrong form, too many values in a range, a value
  !! given twice.
  pure subroutine read_values(words, dimension, system, noun, diagnostics, list, to_all_digits)
    type(token_t), intent(in) :: words(:)             !! (words) the list, optionally with a unit as
                                                      !! last word
    integer, intent(in) :: dimension(4)               !! that the values must have
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    character(len=*), intent(in) :: noun              !! what the numbers are, for messages
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(value_list_t), intent(out) :: list           !! the values before the first wrong one
    logical, intent(in), optional :: to_all_digits    !! values that differ by rounding only are
                                                      !! two: a cycle may end where it began;
                                                      !! absent: they are one, given twice

    type(unit_t) :: bare
    type(written_t) :: first, last, step
    integer :: i, count, filled
    logical :: fine, exactly

    exactly = .false.
    if (present(to_all_digits)) exactly = to_all_digits
    list = empty_list()
    list%words = words
    filled = 0
    bare = coherent_unit(system, dimension)
    count = size(words)
    call read_common_unit(words, dimension, diagnostics, bare, count)
    call find_unit(words(:count), dimension, bare, count < size(words), list%unit)
    fine = .true.
    i = 1
    do while (i <= count)
      call read_value(words(i), dimension, bare, diagnostics, first, fine)
      if (.not. fine) exit
      if (i < count) then
        if (same_word(words(i + 1)%text, "to")) then
          call read_range_end(words(:count), i, dimension, bare, noun, diagnostics, last, step, &
            fine)
          if (.not. fine) exit
          call append_range(first, last, step, dimension, i, noun, diagnostics, list, filled, fine)
          if (.not. fine) exit
          i = i + 5
          cycle
        end if
      end if
      call append_points([in_unit_of(list, first, first%value, dimension)], [first%value], i, &
        list, filled)
      i = i + 1
    end do
    list%value = list%value(:filled)
    list%word = list%word(:filled)
    list%written = list%written(:filled)
    if (.not. fine) return
    ! Angles and speeds are zero or of the order of one; a pure number may have any magnitude.
    call refuse_duplicates(noun, merge(0.0_wp, 1.0_wp, all(dimension == dimension_none)), &
      exactly, diagnostics, list)
  end subroutine read_values

  !> The unit at the end of a list, or else the first after a number; none if there is none, or if
  !! it cannot be read, which is reported with its number.
  pure subroutine find_unit(words, dimension, common, has_common, unit)
    type(token_t), intent(in) :: words(:)
    integer, intent(in) :: dimension(4)
    type(unit_t), intent(in) :: common
    logical, intent(in) :: has_common
    type(unit_t), intent(inout) :: unit

    type(unit_t) :: measure
    type(error_t), allocatable :: error
    integer :: i, length

    if (has_common) unit = common
    if (has_common) return
    do i = 1, size(words)
      length = number_length(words(i)%text)
      if (length == 0 .or. length == len(words(i)%text)) cycle
      call read_unit(words(i)%text(length + 1:), dimension, measure, error)
      if (allocated(error)) return
      if (serves_for(measure, dimension)) unit = measure
      return
    end do
  end subroutine find_unit

  !> A point of a list in the list's unit: the number itself if it is written in it.
  pure function in_unit_of(list, number, point, dimension) result(value)
    type(value_list_t), intent(in) :: list
    type(written_t), intent(in) :: number
    real(wp), intent(in) :: point !! as the list has it
    integer, intent(in) :: dimension(4)
    real(wp) :: value

    value = number%number
    if (number%is_zero .or. .not. allocated(list%unit%name)) return
    if (number%unit%name /= list%unit%name) value = number_in(list%unit, point, dimension)
  end function in_unit_of

  !> The number of a point in a unit: the inverse of `model_value`.
  pure function number_in(measure, point, dimension) result(number)
    type(unit_t), intent(in) :: measure
    real(wp), intent(in) :: point !! as the list has it
    integer, intent(in) :: dimension(4)
    real(wp) :: number

    if (all(dimension == dimension_angle)) then
      number = from_si(to_si(point, degrees()), measure)
    else
      number = from_si(point, measure)
    end if
  end function number_in

  !> The degree, without its name.
  pure function degrees() result(measure)
    type(unit_t) :: measure

    measure%numerator = pi
    measure%denominator = 180.0_wp
  end function degrees

  !> A last word that is no number is the unit of all bare numbers before it; `count` is then
  !! reduced by one.
  pure subroutine read_common_unit(words, dimension, diagnostics, bare, count)
    type(token_t), intent(in) :: words(:)
    integer, intent(in) :: dimension(4)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(unit_t), intent(inout) :: bare
    integer, intent(inout) :: count

    type(unit_t) :: measure
    type(error_t), allocatable :: error

    if (count < 2) return
    if (number_length(words(count)%text) > 0 .or. same_word(words(count)%text, "to") .or. &
      same_word(words(count)%text, "step") .or. same_word(words(count - 1)%text, "to") .or. &
      same_word(words(count - 1)%text, "step")) return
    call read_unit(words(count)%text, dimension, measure, error)
    if (allocated(error)) then
      call add_error(diagnostics, words(count), error%text)
    else if (any(measure%dimension /= dimension)) then
      call add_error(diagnostics, words(count), wrong_unit(measure, dimension))
    else
      bare = measure
    end if
    count = count - 1
  end subroutine read_common_unit

  !> One number.
  pure subroutine read_value(word, dimension, bare, diagnostics, number, fine)
    type(token_t), intent(in) :: word
    integer, intent(in) :: dimension(4)
    type(unit_t), intent(in) :: bare
    type(diagnostics_t), intent(inout) :: diagnostics
    type(written_t), intent(out) :: number
    logical, intent(out) :: fine

    integer :: length

    call read_measure(word, dimension, bare, diagnostics, number%number, number%unit, fine)
    if (.not. fine) return
    length = number_length(word%text)
    number%decimal = decimal_of(word%text(:length))
    number%is_zero = length == len(word%text) .and. abs(number%number) <= 0.0_wp
    number%value = model_value(number%number, number%unit, dimension)
  end subroutine read_value

  !> A number as the list has it. An angle in degrees is not converted, so it keeps the user's
  !! digits.
  pure function model_value(number, measure, dimension) result(value)
    real(wp), intent(in) :: number
    type(unit_t), intent(in) :: measure !! its unit
    integer, intent(in) :: dimension(4)
    real(wp) :: value

    if (any(dimension /= dimension_angle)) then
      value = to_si(number, measure)
    else if (measure%name == "deg") then
      value = number
    else
      value = from_si(to_si(number, measure), degrees())
    end if
  end function model_value

  !> Reads the words `to b step s` after `words(i)`.
  pure subroutine read_range_end(words, i, dimension, bare, noun, diagnostics, last, step, fine)
    type(token_t), intent(in) :: words(:)
    integer, intent(in) :: i
    integer, intent(in) :: dimension(4)
    type(unit_t), intent(in) :: bare
    character(len=*), intent(in) :: noun
    type(diagnostics_t), intent(inout) :: diagnostics
    type(written_t), intent(out) :: last, step
    logical, intent(out) :: fine

    fine = size(words) >= i + 4
    if (fine) fine = same_word(words(i + 3)%text, "step")
    if (.not. fine) then
      call add_error(diagnostics, words(i + 1), "a range of "//noun// &
        "s is written: a to b step s"//unit_inside(words(i + 1:)))
      return
    end if
    call read_value(words(i + 2), dimension, bare, diagnostics, last, fine)
    if (fine) call read_value(words(i + 4), dimension, bare, diagnostics, step, fine)
    if (fine .and. abs(step%value) <= 0.0_wp) then
      call add_error(diagnostics, words(i + 4), "the step must not be 0")
      fine = .false.
    end if
  end subroutine read_range_end

  !> For a range with a unit among its words: its place, in words to end a pattern. Else an empty
  !! text.
  pure function unit_inside(words) result(hint)
    type(token_t), intent(in) :: words(:) !! from the `to` of a range on
    character(len=:), allocatable :: hint

    type(unit_t) :: measure
    type(error_t), allocatable :: error
    integer :: i

    hint = ""
    do i = 2, min(size(words), 5)
      if (number_length(words(i)%text) > 0 .or. same_word(words(i)%text, "step")) cycle
      call read_unit(words(i)%text, dimension_none, measure, error)
      if (.not. allocated(error)) hint = " "//words(i)%text//", its unit at the end"
      return
    end do
  end function unit_inside

  !> Appends the points of a range.
  pure subroutine append_range(first, last, step, dimension, word, noun, diagnostics, list, &
    filled, fine)
    type(written_t), intent(in) :: first, last, step
    integer, intent(in) :: dimension(4)
    integer, intent(in) :: word
    character(len=*), intent(in) :: noun
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(inout) :: list
    integer, intent(inout) :: filled
    logical, intent(out) :: fine

    real(wp), allocatable :: numbers(:), points(:)
    real(wp) :: steps

    steps = (last%value - first%value)/step%value
    fine = .false.
    if (steps < 0.0_wp) then
      call add_error(diagnostics, list%words(word + 4), "the step leads away from "// &
        list%words(word + 2)%text)
    else if (steps > most_values - 1) then
      call add_error(diagnostics, list%words(word + 4), "this range has more than "// &
        to_string(most_values)//" "//noun//"s")
    else
      call find_points(first, last, step, dimension, list, numbers, points)
      call append_points(numbers, points, word, list, filled)
      fine = .true.
    end if
  end subroutine append_range

  !> The points `a + i s` up to `b`, each the decimal number that a person would write. A last point
  !! within 1e-9 of a step of `b` becomes `b`.
  pure subroutine find_points(first, last, step, dimension, list, numbers, points)
    type(written_t), intent(in) :: first, last, step
    integer, intent(in) :: dimension(4)
    type(value_list_t), intent(in) :: list                      !! for its unit
    real(wp), allocatable, intent(out) :: numbers(:), points(:) !! as written, as the list has them

    real(wp), parameter :: hit = 1.0e-9_wp
    type(written_t) :: number
    integer :: count, i

    count = floor((last%value - first%value)/step%value + hit) + 1
    allocate (numbers(count), points(count))
    number%unit = step%unit
    do i = 1, count
      call find_point(first, step, i - 1, dimension, number, points(i))
      numbers(i) = in_unit_of(list, number, points(i), dimension)
    end do
    if (abs(points(count) - last%value) > hit*abs(step%value)) return
    numbers(count) = in_unit_of(list, last, last%value, dimension)
    points(count) = last%value
  end subroutine find_points

  !> The point `a + count s` of a range, in the unit of `s` and as the list has it. Where `a` has
  !! another unit, or the two have more digits than can be added, the point is rounded.
  pure subroutine find_point(first, step, count, dimension, number, point)
    type(written_t), intent(in) :: first, step
    integer, intent(in) :: count
    integer, intent(in) :: dimension(4)
    type(written_t), intent(inout) :: number !! has the unit of `s`
    real(wp), intent(out) :: point

    type(decimal_t) :: decimal

    if (.not. first%is_zero .and. first%unit%name /= step%unit%name) then
      point = first%value + count*step%value
      number%number = number_in(step%unit, point, dimension)
      return
    end if
    decimal = decimal_point(first%decimal, step%decimal, count)
    if (decimal%is_exact) then
      number%number = decimal_value(decimal)
    else
      number%number = first%number + count*step%number
    end if
    point = model_value(number%number, step%unit, dimension)
  end subroutine find_point

  !> Appends values that all come from one word. The arrays grow by doubling: a deck may list a
  !! million angles.
  pure subroutine append_points(numbers, points, word, list, filled)
    real(wp), intent(in) :: numbers(:), points(:) !! as written, and as the list has them
    integer, intent(in) :: word
    type(value_list_t), intent(inout) :: list
    integer, intent(inout) :: filled !! values in use

    integer :: capacity

    if (filled + size(points) > size(list%value)) then
      capacity = 2*(filled + size(points))
      list%value = [list%value(:filled), spread(0.0_wp, 1, capacity - filled)]
      list%written = [list%written(:filled), spread(0.0_wp, 1, capacity - filled)]
      list%word = [list%word(:filled), spread(0, 1, capacity - filled)]
    end if
    list%value(filled + 1:filled + size(points)) = points
    list%written(filled + 1:filled + size(points)) = numbers
    list%word(filled + 1:filled + size(points)) = word
    filled = filled + size(points)
  end subroutine append_points

  !> Errors: a value is given twice, which is a mistake or would put the same row into the table
  !! twice.
  pure subroutine refuse_duplicates(noun, least, to_all_digits, diagnostics, list)
    character(len=*), intent(in) :: noun
    real(wp), intent(in) :: least !! values are compared relative to themselves, or to this if they
                                  !! are smaller
    logical, intent(in) :: to_all_digits !! they are compared to the last digit instead
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(in) :: list

    real(wp) :: same
    integer, allocatable :: order(:)
    integer :: i, earlier, later
    logical :: told(size(list%words))

    same = merge(0.0_wp, 1.0e-12_wp, to_all_digits)
    order = ascending_order(list%value)
    told = .false.
    do i = 2, size(order)
      earlier = min(order(i - 1), order(i))
      later = max(order(i - 1), order(i))
      if (abs(list%value(later) - list%value(earlier)) > same*max(least, abs(list%value(later)))) &
        cycle
      ! Two ranges may share hundreds of values; one error per word is enough.
      if (told(list%word(later))) cycle
      told(list%word(later)) = .true.
      call add_error(diagnostics, list%words(list%word(later)), "the "//noun//" "// &
        to_string(list%value(later))//" is given twice", list%words(list%word(earlier)), &
        "first given here")
    end do
  end subroutine refuse_duplicates

  !> Number of a value in a list, compared with a tolerance for round-off of ranges and unit
  !! conversions; 0 if the list does not contain it.
  pure function value_number(list, value) result(number)
    type(value_list_t), intent(in) :: list !! may be empty
    real(wp), intent(in) :: value          !! in the unit of the list
    integer :: number

    do number = size(list%value), 1, -1
      if (abs(list%value(number) - value) <= 1.0e-9_wp*max(1.0_wp, abs(value))) return
    end do
  end function value_number

end module value_lists
