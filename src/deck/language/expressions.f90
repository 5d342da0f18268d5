!> Arithmetic in SET, with units: `SET rod $track - 2*$arm*sin(10deg)`; and in the time, for laws of
!! drives: `20deg*sin(2*pi*t/3s)`.
!!
!!   sum     = product {(+|-) product}
!!   product = signed {(*|/) signed}
!!   signed  = [+|-] atom [** signed]
!!   atom    = number[unit] | $name | pi | t | function(sum[, sum]) | (sum)
!!
!! A bare number is a pure number. A unit follows its number without a blank; it is the longest text
!! that is one, and that no letter, digit or bracket follows: 2mm*sin(10deg) is no product of mm and
!! s. Names hold minus signs, so that `$track-2` is a name.
!!
!! What depends on the time has no value while it is read: it is noted as a step of a formula, and
!! its kind is found with the value 1. A pure number that depends on the time is an angle in radians
!! where an angle is wanted, as in sin(ωt).
module expressions
  use, intrinsic :: ieee_exceptions, only: ieee_get_halting_mode, ieee_set_flag, &
    ieee_set_halting_mode, ieee_usual
  use card_reader, only: unit_apart
  use constants, only: degree, pi
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_input, error_of_writing, error_t
  use expression_functions, only: apply_function, count_values, function_names
  use kinds, only: wp
  use numbers, only: number_length, read_real
  use quantities, only: are_alike, kind_text, match_angles, multiply, quantity_t, raise, take_unit
  use spelling, only: suggestion
  use text, only: is_continuation_byte, joined
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use time_formulas, only: add_step, function_step, step_constant, step_difference, step_power, &
    step_product, step_quotient, step_scaled, step_sum, step_time, step_whole_power, time_formula_t
  use tokens, only: is_name, name_length, token_part, token_t
  use units, only: dimension_angle, dimension_none, dimension_time, read_unit, unit_system_t, &
    unit_t
  implicit none (type, external)
  private

  public :: operand_t, is_expression, find_names, split_at_names, evaluate, place_in

  !> What a `$name` in an expression stands for.
  type :: operand_t
    type(token_t) :: word          !! its text, at the place where it is set
    type(quantity_t) :: quantity   !! the same, if it is a number
    logical :: is_number = .false.
  end type operand_t

  !> An expression that is being read, and the first error in it.
  type :: reader_t
    character(len=:), allocatable :: text !! the words with a blank behind each
    type(unit_system_t) :: system         !! units of bare numbers
    logical :: has_time = .false.         !! `t` is the time
    type(time_formula_t) :: formula       !! what depends on it
    integer :: at = 1                     !! byte that is read next; no blank but the last one
    integer :: level = 0                  !! of brackets, functions and powers
    integer :: names = 0                  !! number of `$name`s that have been read
    integer :: fault(2) = 0               !! first and last byte of what is wrong; 0: nothing is
    character(len=:), allocatable :: message
    integer :: kind = error_of_writing    !! of the error: error_of_input, if it depends on values
    integer :: unusable = 0               !! number of the `$name` that is wrong; 0: none
  end type reader_t

  character(len=*), parameter :: digits = "0123456789", operators = "+-*/", &
    letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_"

  !> Each level takes about a kilobyte of the stack.
  integer, parameter :: most_levels = 40

  !> No unit has more bytes.
  integer, parameter :: longest_unit = 32

contains

  !> Whether the words of a SET behind its name are an expression. What may be a plain value is one:
  !! a single word that is a name (`5mm-2mm`, `pi`), a list, a number with its unit, or a `$name`.
  pure function is_expression(words) result(is)
    type(token_t), intent(in) :: words(:) !! one at least
    logical :: is

    type(unit_t) :: measure
    type(error_t), allocatable :: error
    integer :: first

    is = size(words) > 1
    if (is) return
    associate (text => words(1)%text)
      if (scan(text, "$(") > 0) then
        is = .not. (text == "$" .or. is_whole_name(text))
        return
      end if
      if (is_name(text) .or. index(text, ",") > 0) return
      first = number_length(text)
      if (first == 0) first = pi_length(text)
      if (first == 0 .or. first == len(text)) return
      ! The usual slip for rpm is told of where it stands.
      is = has_operation(text(first + 1:)) .and. text /= "1/min"
      if (.not. is) return
      call read_unit(text(first + 1:), dimension_none, measure, error)
      is = allocated(error)
    end associate
  end function is_expression

  !> How many leading bytes of a text are π with its sign; 0 if no operator follows them.
  pure function pi_length(text) result(length)
    character(len=*), intent(in) :: text
    integer :: length

    length = verify(text//"x", "+-") + 1
    if (index(text, "pi") /= length - 1 .or. length >= len(text)) then
      length = 0
    else if (scan(text(length + 1:length + 1), operators) == 0) then
      length = 0
    end if
  end function pi_length

  !> Whether a text is `$name` and nothing else.
  pure function is_whole_name(text) result(is)
    character(len=*), intent(in) :: text !! not empty
    logical :: is

    is = .false.
    if (text(1:1) == "$" .and. len(text) > 1) is = is_name(text(2:))
  end function is_whole_name

  !> Whether there is an operator behind a bare number, or one before something that is no unit.
  pure function has_operation(text) result(has)
    character(len=*), intent(in) :: text !! behind a number
    logical :: has

    integer :: i

    has = scan(text(1:1), operators//"^") > 0
    if (has) return
    has = .true.
    do i = 1, len(text) - 1
      if (scan(text(i:i), operators) == 0) cycle
      if (scan(text(i + 1:i + 1), digits//operators//".") > 0) return
      if (text(i + 1:min(i + 2, len(text))) /= "pi") cycle
      if (i + 2 == len(text)) return
      if (scan(text(i + 3:i + 3), letters//digits) == 0) return
    end do
    has = .false.
  end function has_operation

  !> The `$name`s of an expression in the order of its text.
  pure subroutine find_names(words, names)
    type(token_t), intent(in) :: words(:)               !! of the expression
    type(token_t), allocatable, intent(out) :: names(:) !! `$name`, or `$` where no name follows

    integer :: i, k, at, count

    count = 0
    do i = 1, size(words)
      count = count + count_dollars(words(i)%text)
    end do
    allocate (names(count))
    count = 0
    do i = 1, size(words)
      at = 0
      do k = 1, count_dollars(words(i)%text)
        at = at + index(words(i)%text(at + 1:), "$")
        count = count + 1
        names(count) = token_part(words(i), at, at + name_length(words(i)%text(at + 1:)))
      end do
    end do
  end subroutine find_names

  !> The parts of a word, each `$name` by itself.
  pure function split_at_names(word) result(parts)
    type(token_t), intent(in) :: word
    type(token_t), allocatable :: parts(:)

    integer :: count, first, last

    allocate (parts(2*count_dollars(word%text) + 1))
    count = 0
    first = 1
    do while (first <= len(word%text))
      if (word%text(first:first) == "$") then
        last = first + name_length(word%text(first + 1:))
      else
        last = first - 2 + index(word%text(first:)//"$", "$")
      end if
      count = count + 1
      parts(count) = token_part(word, first, last)
      first = last + 1
    end do
    parts = parts(:count)
  end function split_at_names

  pure function count_dollars(text) result(count_of)
    character(len=*), intent(in) :: text
    integer :: count_of

    integer :: i

    count_of = count([(text(i:i) == "$", i=1, len(text))])
  end function count_dollars

  !> Computes an expression.
  !!
  !! Errors: words that are no expression; values of kinds that do not go together, or that a
  !! function does not take; a `$name` that is no number; a result that no double holds.
  pure subroutine evaluate(words, operands, system, diagnostics, found, fine, formula)
    type(token_t), intent(in) :: words(:)             !! of the expression
    type(operand_t), intent(in) :: operands(:)        !! (names) of `find_names`
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added: one at most
    type(quantity_t), intent(out) :: found
    logical, intent(out) :: fine                      !! whether it has a value
    type(time_formula_t), intent(out), optional :: formula !! of the value over time, in the unit of
                                                      !! `found`: `t` is the time

    type(reader_t) :: reader
    logical :: halts(size(ieee_usual))

    call begin_reading(words, system, reader)
    reader%has_time = present(formula)
    ! What is too large or undefined is an error of the user: no trap, even where traps are set.
    call ieee_get_halting_mode(ieee_usual, halts)
    call ieee_set_halting_mode(ieee_usual, .false.)
    call read_sum(reader, operands, found)
    if (reader%at < len(reader%text)) call complain_of_next(reader, "the end")
    call ieee_set_flag(ieee_usual, .false.)
    call ieee_set_halting_mode(ieee_usual, halts)
    fine = reader%fault(1) == 0
    if (fine .and. present(formula)) then
      call need_step(reader, found)
      formula = reader%formula
    end if
    if (fine) return
    if (reader%unusable > 0) then
      call add_error(diagnostics, place_in(words, reader%fault), reader%message, &
        operands(reader%unusable)%word, "it is set here", kind=reader%kind)
    else
      call add_error(diagnostics, place_in(words, reader%fault), reader%message, kind=reader%kind)
    end if
  end subroutine evaluate

  pure subroutine begin_reading(words, system, reader)
    type(token_t), intent(in) :: words(:)
    type(unit_system_t), intent(in) :: system
    type(reader_t), intent(out) :: reader

    type(text_buffer_t) :: buffer
    integer :: i

    reader%system = system
    do i = 1, size(words)
      call append_text(buffer, words(i)%text)
      call append_text(buffer, " ")
    end do
    reader%text = buffer_text(buffer)
  end subroutine begin_reading

  !> The word, or the part of one, that some bytes of the text are.
  pure function place_in(words, bytes) result(place)
    type(token_t), intent(in) :: words(:)
    integer, intent(in) :: bytes(2) !! first and last one
    type(token_t) :: place

    integer :: first, k, start

    k = 1
    start = 1
    do while (k < size(words) .and. bytes(1) > start + len(words(k)%text))
      start = start + len(words(k)%text) + 1
      k = k + 1
    end do
    first = min(bytes(1) - start + 1, len(words(k)%text))
    place = token_part(words(k), first, min(bytes(2) - start + 1, len(words(k)%text)))
  end function place_in

  !> Notes the first error.
  pure subroutine complain(reader, first, last, message, kind)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: first, last    !! bytes of the text
    character(len=*), intent(in) :: message
    integer, intent(in), optional :: kind !! absent: error_of_writing

    if (reader%fault(1) > 0) return
    reader%fault = [first, last]
    reader%message = message
    if (present(kind)) reader%kind = kind
  end subroutine complain

  !> Complains of what stands where an operator may stand.
  pure subroutine complain_of_next(reader, else_expected)
    type(reader_t), intent(inout) :: reader
    character(len=*), intent(in) :: else_expected !! besides operators

    character(len=:), allocatable :: word
    integer :: last

    last = max(reader%at, reader%at - 2 + scan(reader%text(reader%at:), " ,()$"//operators))
    if (is_next(reader, "$")) last = last + name_length(reader%text(last + 1:))
    word = reader%text(reader%at:last)
    select case (word(1:1))
    case (",")
      call complain(reader, reader%at, last, "a comma stands between the values of "// &
        "a function; a list is one word without '$'")
    case (")")
      call complain(reader, reader%at, last, "this bracket has no other one")
    case ("^")
      call complain(reader, reader%at, reader%at, "a power is written 2**3")
    case default
      call complain(reader, reader%at, last, "unexpected '"//word//"'"//unit_apart(word)// &
        "; expected + - * / ** or "//else_expected)
    end select
  end subroutine complain_of_next

  !> Moves on, and over blanks.
  pure subroutine advance(reader, bytes)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: bytes

    reader%at = reader%at + bytes
    do while (reader%at < len(reader%text))
      if (reader%text(reader%at:reader%at) /= " ") exit
      reader%at = reader%at + 1
    end do
  end subroutine advance

  !> Whether one of some characters is next.
  pure function is_next(reader, characters) result(is)
    type(reader_t), intent(in) :: reader
    character(len=*), intent(in) :: characters
    logical :: is

    is = scan(reader%text(reader%at:reader%at), characters) == 1
  end function is_next

  pure recursive subroutine read_sum(reader, operands, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    type(quantity_t), intent(out) :: found

    type(quantity_t) :: other
    character :: sign
    integer :: at

    call read_product(reader, operands, found)
    do while (reader%fault(1) == 0 .and. is_next(reader, "+-"))
      at = reader%at
      sign = reader%text(at:at)
      call advance(reader, 1)
      call read_product(reader, operands, other)
      if (reader%fault(1) > 0) return
      call demand_alike(reader, at, at, sign, found, other)
      call note(reader, merge(step_sum, step_difference, sign == "+"), [at, at], found, other)
      call match_angles(found, other)
      found%value = found%value + merge(other%value, -other%value, sign == "+")
      call demand_finite(reader, at, at, found)
    end do
  end subroutine read_sum

  pure recursive subroutine read_product(reader, operands, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    type(quantity_t), intent(out) :: found

    type(quantity_t) :: other
    logical :: divides
    integer :: at

    call read_signed(reader, operands, found)
    do while (reader%fault(1) == 0 .and. is_next(reader, "*/"))
      at = reader%at
      divides = is_next(reader, "/")
      call advance(reader, 1)
      call read_signed(reader, operands, other)
      if (reader%fault(1) > 0) return
      if (divides .and. .not. abs(other%value) > 0.0_wp) then
        call complain(reader, at, at, "a division by 0", kind=error_of_input)
        return
      end if
      call note(reader, merge(step_quotient, step_product, divides), [at, at], found, other)
      call multiply(found, other, divides)
      call demand_finite(reader, at, at, found)
    end do
  end subroutine read_product

  pure recursive subroutine read_signed(reader, operands, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    type(quantity_t), intent(out) :: found

    type(quantity_t) :: power
    character(len=:), allocatable :: message
    logical :: is_negative
    integer :: at

    reader%level = reader%level + 1
    if (reader%level > most_levels) call complain(reader, reader%at, reader%at, &
      "this is nested too deeply: give a part of it a name by a SET of its own")
    if (reader%fault(1) > 0) return
    is_negative = is_next(reader, "-")
    if (is_next(reader, "+-")) call advance(reader, 1)
    call read_atom(reader, operands, found)
    if (reader%fault(1) > 0) return
    at = reader%at
    if (at < len(reader%text)) then
      if (reader%text(at:at + 1) == "**") then
        call advance(reader, 2)
        call read_signed(reader, operands, power)
        if (reader%fault(1) > 0) return
        if (power%step > 0 .and. any(found%dimension /= 0)) call complain(reader, at, at + 1, &
          "only a pure number has a power that changes in time; this is "//kind_text(found, &
          reader%system))
        call note_power(reader, [at, at + 1], found, power)
        call raise(found, power, reader%system, message)
        if (len(message) > 0) call complain(reader, at, at + 1, message, &
          kind=error_of_input)
        call demand_finite(reader, at, at + 1, found)
      end if
    end if
    if (is_negative .and. found%step > 0) then
      call scale_step(reader, -1.0_wp, found)
    else if (is_negative) then
      found%value = -found%value
    end if
    reader%level = reader%level - 1
  end subroutine read_signed

  pure recursive subroutine read_atom(reader, operands, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    type(quantity_t), intent(out) :: found

    integer :: opened, last

    opened = reader%at
    if (is_next(reader, "(")) then
      call advance(reader, 1)
      call read_sum(reader, operands, found)
      call close_bracket(reader, opened)
    else if (is_next(reader, "$")) then
      call take_operand(reader, operands, found)
    else if (is_next(reader, digits//".")) then
      call take_number(reader, found)
    else if (is_next(reader, letters)) then
      call read_word(reader, operands, found)
    else if (opened == len(reader%text)) then
      call complain(reader, opened - 1, opened - 1, &
        "a number, $name, function or ( must follow this")
    else
      last = opened
      do while (is_continuation_byte(reader%text(last + 1:last + 1)))
        last = last + 1
      end do
      call complain(reader, opened, last, "unexpected '"//reader%text(opened:last)// &
        "'; expected a number, $name, function or (")
    end if
  end subroutine read_atom

  !> Reads the end of what a bracket has begun.
  pure subroutine close_bracket(reader, opened)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: opened !! byte of the bracket

    if (reader%fault(1) > 0) return
    if (is_next(reader, ")")) then
      call advance(reader, 1)
    else if (reader%at == len(reader%text)) then
      call complain(reader, opened, opened, "this bracket is not closed")
    else
      call complain_of_next(reader, ")")
    end if
  end subroutine close_bracket

  !> Takes the value of a `$name`.
  pure subroutine take_operand(reader, operands, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    type(quantity_t), intent(out) :: found

    integer :: last

    last = reader%at + name_length(reader%text(reader%at + 1:))
    reader%names = reader%names + 1
    associate (operand => operands(reader%names))
      found = operand%quantity
      if (.not. operand%is_number .and. reader%fault(1) == 0) then
        call complain(reader, reader%at, last, "'"//reader%text(reader%at:last)//"' is '"// &
          operand%word%text//"', which is no number")
        reader%unusable = reader%names
      end if
    end associate
    call advance(reader, last + 1 - reader%at)
  end subroutine take_operand

  !> Reads a number and its unit.
  pure subroutine take_number(reader, found)
    type(reader_t), intent(inout) :: reader
    type(quantity_t), intent(out) :: found

    type(error_t), allocatable :: error
    integer :: first, last

    first = reader%at
    last = first - 1 + number_length(reader%text(first:))
    if (last < first) then
      call complain(reader, first, first, "a point alone is no number")
      return
    end if
    call read_real(reader%text(first:last), found%value, error)
    if (allocated(error)) then
      call complain(reader, first, last, error%text)
      return
    end if
    call take_unit_behind(reader, last, found)
    if (reader%fault(1) > 0) return
    call demand_finite(reader, first, last, found)
    call advance(reader, last + 1 - first)
  end subroutine take_number

  !> Reads the unit behind a number, if there is one.
  pure subroutine take_unit_behind(reader, last, found)
    type(reader_t), intent(inout) :: reader
    integer, intent(inout) :: last !! byte with which the number ends; with its unit on return
    type(quantity_t), intent(inout) :: found

    type(unit_t) :: measure
    type(error_t), allocatable :: error
    integer :: first, k

    first = last + 1
    ! The end, a sign or a bracket, but no letter: nor the degree sign.
    if (scan(reader%text(first:first), " ,()$.^"//operators) == 1) return
    do k = min(last + longest_unit, len(reader%text) - 1), first, -1
      if (scan(reader%text(k + 1:k + 1), letters//digits//"(") == 1) cycle
      if (scan(reader%text(first:k), " ,()$+-") > 0) cycle
      call read_unit(reader%text(first:k), dimension_none, measure, error)
      if (allocated(error)) cycle
      call take_unit(measure, reader%system, found)
      last = k
      return
    end do
    k = first - 2 + scan(reader%text(first:), " ,()$"//operators)
    call read_unit(reader%text(first:k), dimension_none, measure, error)
    if (allocated(error)) then
      call complain(reader, first, k, error%text(:index(error%text//";", ";") - 1))
    else
      ! A unit with a bracket behind it, as a function has.
      call complain(reader, k + 1, k + 1, "an operator is missing before this bracket")
    end if
  end subroutine take_unit_behind

  !> Reads a function, or π.
  pure recursive subroutine read_word(reader, operands, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    type(quantity_t), intent(out) :: found

    character(len=:), allocatable :: name
    integer :: first, last

    first = reader%at
    last = first - 2 + verify(reader%text(first:), letters//digits)
    name = reader%text(first:last)
    call advance(reader, last + 1 - first)
    if (count_values(name) > 0 .and. is_next(reader, "(")) then
      call read_function(reader, operands, name, first, found)
    else if (count_values(name) > 0) then
      call complain(reader, first, last, "the value of '"//name//"' stands in brackets behind it")
    else if (is_next(reader, "(")) then
      call complain(reader, first, last, "unknown function '"//name//"'"//suggestion(name, &
        function_names())//"; expected one of: "//joined(function_names()))
    else if (name == "pi") then
      found%value = pi
    else if (name == "t" .and. reader%has_time) then
      call take_time(reader, found)
    else if (reader%has_time) then
      call complain(reader, first, last, "'"//name//"' is no number"//unit_apart(name)// &
        "; the time is t, and a name of a value begins with '$'")
    else
      call complain(reader, first, last, "'"//name//"' is no number"//unit_apart(name)// &
        "; a name of a value begins with '$'")
    end if
  end subroutine read_word

  !> Reads the values of a function, and gives it them.
  pure recursive subroutine read_function(reader, operands, name, first, found)
    type(reader_t), intent(inout) :: reader
    type(operand_t), intent(in) :: operands(:)
    character(len=*), intent(in) :: name
    integer, intent(in) :: first !! byte at which it begins
    type(quantity_t), intent(out) :: found

    type(quantity_t) :: other
    character(len=:), allocatable :: message
    integer :: opened, last, step

    opened = reader%at
    last = first + len(name) - 1
    call advance(reader, 1)
    call read_sum(reader, operands, found)
    if (reader%fault(1) > 0) return
    if (count_values(name) == 2 .and. is_next(reader, ",")) then
      call advance(reader, 1)
      call read_sum(reader, operands, other)
      if (reader%fault(1) > 0) return
      call demand_alike(reader, first, last, name, found, other)
    else if (count_values(name) == 2 .and. is_next(reader, ")")) then
      call complain(reader, first, last, "'"//name//"' has two values: "//name//"(a, b)")
    end if
    if (is_next(reader, ",")) call complain(reader, first, last, "'"//name//"' has "// &
      trim(merge("two values", "one value ", count_values(name) == 2))//", and here is another one")
    call close_bracket(reader, opened)
    if (reader%fault(1) > 0) return
    call note_function(reader, name, [first, last], found, other)
    step = found%step
    call apply_function(name, other, reader%system, found, message)
    found%step = step
    if (len(message) > 0) call complain(reader, first, last, message, kind=error_of_input)
    call demand_finite(reader, first, last, found)
  end subroutine read_function

  !> Errors: two values are of different kinds.
  pure subroutine demand_alike(reader, first, last, name, one, other)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: first, last   !! bytes of the operator or function
    character(len=*), intent(in) :: name !! of it
    type(quantity_t), intent(in) :: one, other

    if (are_alike(one, other)) return
    call complain(reader, first, last, "'"//name//"' is of equal kinds: here are "// &
      kind_text(one, reader%system)//" and "//kind_text(other, reader%system))
  end subroutine demand_alike

  !> The time, in the deck's unit.
  pure subroutine take_time(reader, found)
    type(reader_t), intent(inout) :: reader
    type(quantity_t), intent(inout) :: found

    type(unit_t) :: second
    type(error_t), allocatable :: error
    real(wp) :: factor

    call read_unit("s", dimension_time, second, error)
    found%value = 1.0_wp
    call take_unit(second, reader%system, found)
    factor = found%value
    call append_step(reader, step_time, 0, 0, 0.0_wp, [0, 0], found)
    if (abs(factor - 1.0_wp) > 0.0_wp) call scale_step(reader, factor, found)
  end subroutine take_time

  !> Appends a step to the formula, which gives a value from now on.
  pure subroutine append_step(reader, operation, first, second, constant, bytes, found)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: operation, first, second !! steps that it takes
    real(wp), intent(in) :: constant
    integer, intent(in) :: bytes(2)                 !! of the operator or function in the text
    type(quantity_t), intent(inout) :: found

    call add_step(reader%formula, operation, first, second, constant, bytes)
    found%step = size(reader%formula%steps)
    found%value = 1.0_wp
  end subroutine append_step

  pure subroutine scale_step(reader, factor, found)
    type(reader_t), intent(inout) :: reader
    real(wp), intent(in) :: factor
    type(quantity_t), intent(inout) :: found

    call append_step(reader, step_scaled, found%step, 0, factor, [0, 0], found)
  end subroutine scale_step

  !> Gives a constant a step.
  pure subroutine need_step(reader, found)
    type(reader_t), intent(inout) :: reader
    type(quantity_t), intent(inout) :: found

    if (found%step == 0) call append_step(reader, step_constant, 0, 0, found%value, [0, 0], found)
  end subroutine need_step

  !> Notes an operation on two values, if one depends on the time; the second in the unit of angles
  !! of the first.
  pure subroutine note(reader, operation, bytes, found, other)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: operation, bytes(2)
    type(quantity_t), intent(inout) :: found !! the first value; it gets the step of the result
    type(quantity_t), intent(inout) :: other

    if (reader%fault(1) > 0 .or. found%step + other%step == 0) return
    call match_angles(found, other)
    if (other%step > 0 .and. abs(other%value - 1.0_wp) > 0.0_wp) call scale_step(reader, &
      other%value, other)
    call need_step(reader, found)
    call need_step(reader, other)
    call append_step(reader, operation, found%step, other%step, 0.0_wp, bytes, found)
  end subroutine note

  !> Notes a power, if it depends on the time.
  pure subroutine note_power(reader, bytes, found, power)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: bytes(2)
    type(quantity_t), intent(inout) :: found
    type(quantity_t), intent(in) :: power

    type(quantity_t) :: exponent

    if (found%step > 0 .and. power%step == 0 .and. .not. abs(power%value - anint(power%value)) > &
      0.0_wp) then
      call append_step(reader, step_whole_power, found%step, 0, power%value, bytes, found)
    else
      exponent = power
      call note(reader, step_power, bytes, found, exponent)
    end if
  end subroutine note_power

  !> Notes a function, if it depends on the time.
  !!
  !! Errors: its derivatives jump.
  pure subroutine note_function(reader, name, bytes, found, other)
    type(reader_t), intent(inout) :: reader
    character(len=*), intent(in) :: name
    integer, intent(in) :: bytes(2)
    type(quantity_t), intent(inout) :: found !! the first value; it gets the step of the result
    type(quantity_t), intent(inout) :: other !! the second one, if there is one

    real(wp) :: unit
    integer :: operation

    if (reader%fault(1) > 0 .or. found%step + other%step == 0) return
    operation = function_step(name)
    if (operation == 0) then
      call complain(reader, bytes(1), bytes(2), "'"//name//"' of what changes in time "// &
        "jumps or has corners, where a drive has no acceleration; expected a smooth function")
    else if (count_values(name) == 2) then
      call note(reader, operation, bytes, found, other)
    else
      if (any(name == ["sin", "cos", "tan"]) .and. all(found%dimension == dimension_none)) then
        found%dimension = dimension_angle
        found%in_radians = .true.
      end if
      unit = merge(1.0_wp, degree, found%in_radians)
      call append_step(reader, operation, found%step, 0, unit, bytes, found)
    end if
  end subroutine note_function

  !> Errors: no double holds a value. One that depends on the time is kept as 1.
  pure subroutine demand_finite(reader, first, last, found)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: first, last
    type(quantity_t), intent(inout) :: found

    if (found%step > 0) found%value = 1.0_wp
    if (.not. abs(found%value) <= huge(1.0_wp)) call complain(reader, first, last, &
      "the result is too large for a number", kind=error_of_input)
  end subroutine demand_finite

end module expressions
