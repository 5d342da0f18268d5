!> Converts the words of cards to values: checks of their form, names, quantities with units, keys,
!! and clear error messages.
module card_reader
  use card_table, only: card_kind_t, keys_of, kind_of_card
  use cards, only: card_t, entry_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_input, error_of_writing, error_t, set_error
  use key_hints, only: key_hint
  use kinds, only: wp
  use numbers, only: number_length, read_integer, read_real
  use spelling, only: suggestion
  use text, only: has_word, joined, same_word, string_t, to_string, word_list
  use tokens, only: check_name, token_part, token_t
  use units, only: coherent_factor, dimension_name, dimension_none, read_unit, serves_for, &
    to_si, unit_system_t, unit_t, wrong_unit
  implicit none (type, external)
  private

  public :: check_form, check_words, unit_apart, entry_of, key_of, value_of, has_key, has_value, &
    read_name, read_part_name, read_quantity, read_measure, require_positive, refuse_negative
  public :: read_entry_quantity, read_entry_count, read_entry_accuracy, read_choice

  !> Words that stand where names of links, pins and guides may stand, and are no names themselves.
  !! `left` and `right` are names in many decks, and their place on BRANCH tells them from these.
  character(len=*), parameter :: reserved_words = "rigid against free length forward backward"

contains

  !> Checks the words and keys of a card against the table of cards.
  !!
  !! Errors: too few or too many words, unknown keys, keys given twice.
  pure subroutine check_form(card, diagnostics, fine, known_keys, form)
    type(card_t), intent(in) :: card                  !! its keyword is known
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    logical, intent(out) :: fine                      !! whether the number of words is right
    logical, intent(out), optional :: known_keys      !! whether all keys are known; if not, a
                                                      !! missing key need not be reported
    character(len=*), intent(in), optional :: form    !! the card's second word, if the form depends
                                                      !! on it

    type(card_kind_t) :: kind

    kind = kind_of_card(card%keyword%text, form)
    call check_words(card, kind%least, kind%most, keys_of(kind), trim(kind%pattern), diagnostics, &
      fine, known_keys)
  end subroutine check_form

  !> As `check_form`, for a card whose form is not in the table of cards.
  pure subroutine check_words(card, least, most, keys, pattern, diagnostics, fine, known_keys)
    type(card_t), intent(in) :: card                  !! of any kind
    integer, intent(in) :: least, most                !! words besides the keyword
    character(len=*), intent(in) :: keys              !! allowed keys, separated by single blanks
    character(len=*), intent(in) :: pattern           !! correct form of the card, for messages
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    logical, intent(out) :: fine                      !! whether the number of words is right
    logical, intent(out), optional :: known_keys      !! whether all keys are known

    integer, parameter :: most_keys = 100
    type(string_t), allocatable :: allowed(:)
    integer :: i, j

    fine = size(card%words) >= least .and. size(card%words) <= most
    if (size(card%words) < least) then
      call add_error(diagnostics, card%keyword, "this card is too short; expected: "//pattern, &
        kind=error_of_writing)
    else if (size(card%words) > most) then
      call add_error(diagnostics, card%words(most + 1), "unexpected '"// &
        card%words(most + 1)%text//"'"//unit_apart(card%words(most + 1)%text)//"; expected: "// &
        pattern, kind=error_of_writing)
    end if
    allowed = word_list(keys)
    if (present(known_keys)) known_keys = .true.
    ! No card has a dozen keys: after a hundred, enough errors have been reported.
    do i = 1, min(size(card%entries), most_keys)
      associate (key => card%entries(i)%key)
        if (.not. has_word(allowed, key%text)) then
          if (present(known_keys)) known_keys = .false.
          call add_error(diagnostics, key, "unknown key '"//key%text//"'"//key_hint(key%text, &
            allowed)//"; expected: "//pattern, kind=error_of_writing)
        end if
        do j = 1, i - 1
          if (.not. same_word(card%entries(j)%key%text, key%text)) cycle
          call add_error(diagnostics, key, "'"//key%text//"=' is given twice", &
            card%entries(j)%key, "first given here")
          exit
        end do
      end associate
    end do
  end subroutine check_words

  !> For a word too many that is a unit: that a unit stands at its number. Else an empty text.
  pure function unit_apart(word) result(hint)
    character(len=*), intent(in) :: word !! unexpected
    character(len=:), allocatable :: hint

    type(unit_t) :: measure
    type(error_t), allocatable :: error

    hint = ""
    call read_unit(word, dimension_none, measure, error)
    if (.not. allocated(error)) hint = " (a unit follows its number without a blank)"
  end function unit_apart

  !> The first entry with a key. If the card has none, its words are empty and have no line; so is
  !! a value that is missing.
  pure function entry_of(card, key) result(entry)
    type(card_t), intent(in) :: card    !! of any kind
    character(len=*), intent(in) :: key !! in any case of letters
    type(entry_t) :: entry

    integer :: i

    do i = 1, size(card%entries)
      if (.not. same_word(card%entries(i)%key%text, key)) cycle
      entry = card%entries(i)
      if (len(entry%value%text) == 0) entry%value = token_t("")
      return
    end do
    entry%key = token_t("")
    entry%value = token_t("")
  end function entry_of

  !> The word before the equals sign: `entry_of`.
  pure function key_of(card, key) result(word)
    type(card_t), intent(in) :: card    !! of any kind
    character(len=*), intent(in) :: key !! in any case of letters
    type(token_t) :: word

    type(entry_t) :: entry

    entry = entry_of(card, key)
    word = entry%key
  end function key_of

  !> The word behind the equals sign: `entry_of`.
  pure function value_of(card, key) result(word)
    type(card_t), intent(in) :: card    !! of any kind
    character(len=*), intent(in) :: key !! in any case of letters
    type(token_t) :: word

    type(entry_t) :: entry

    entry = entry_of(card, key)
    word = entry%value
  end function value_of

  !> Whether a card has a key and a value of it.
  pure function has_value(card, key) result(has)
    type(card_t), intent(in) :: card    !! of any kind
    character(len=*), intent(in) :: key !! in any case of letters
    logical :: has

    type(token_t) :: word

    word = value_of(card, key)
    has = word%line > 0
  end function has_value

  !> Checks that a word is a valid name.
  !!
  !! Errors: it contains other characters.
  pure subroutine read_name(word, diagnostics)
    type(token_t), intent(in) :: word                 !! of a card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    type(error_t), allocatable :: error

    call check_name(word%text, error)
    if (allocated(error)) call add_error(diagnostics, word, error%text)
  end subroutine read_name

  !> As `read_name`, for a link, a pin, a point or a guide.
  !!
  !! Errors: also a word that stands beside such names on cards.
  pure subroutine read_part_name(word, diagnostics)
    type(token_t), intent(in) :: word                 !! of a card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    call read_name(word, diagnostics)
    if (has_word(word_list(reserved_words), word%text)) call add_error(diagnostics, word, "'"// &
      word%text//"' is no name of a link, pin or guide: the word has a meaning on cards")
  end subroutine read_part_name

  !> Reads a number with or without a unit of its own; the caller gives the unit of a bare number.
  !!
  !! Errors: no number, an unknown unit, a unit of another dimension, a number out of range.
  pure subroutine read_measure(word, dimension, bare, diagnostics, value, measure, fine)
    type(token_t), intent(in) :: word                 !! `12`, `1.5mm`, …
    integer, intent(in) :: dimension(4)               !! that the number must have
    type(unit_t), intent(in) :: bare                  !! unit of a bare number
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: value                    !! as written
    type(unit_t), intent(out) :: measure              !! its unit
    logical, intent(out) :: fine                      !! whether a value was read

    type(error_t), allocatable :: error
    type(token_t) :: place
    integer :: length

    measure = bare
    value = 0.0_wp
    fine = .false.
    place = word
    length = number_length(word%text)
    if (length == 0) then
      call add_error(diagnostics, word, "'"//word%text//"' is not a number"// &
        dash_hint(word%text)//unit_apart(word%text)//"; expected "//dimension_name(dimension), &
        kind=error_of_writing)
      return
    end if
    call read_real(word%text(:length), value, error)
    if (allocated(error)) then
      error%text = error%text//"; expected "//dimension_name(dimension)
    else if (length < len(word%text)) then
      if (word%text(length + 1:length + 1) == ",") then
        call set_error(error, error_of_input, "'"//word%text//"' is not a number: no commas "// &
          "here"//comma_hint(word%text)//"; expected "//dimension_name(dimension))
      else if (word%text(length + 1:length + 1) == ":" .or. index(word%text, "..") > 0) then
        call set_error(error, error_of_input, "'"//word%text//"' is not a number (a range "// &
          "is written: a to b step s); expected "//dimension_name(dimension))
      else if (word%text == "1/min") then
        call set_error(error, error_of_input, "'1/min' is not a unit here (did you mean "// &
          "'rpm'?); expected "//dimension_name(dimension))
      else if (scan(word%text(length + 1:length + 1), ".*/+-;)0123456789") == 1) then
        call set_error(error, error_of_input, "'"//word%text//"' is not a number; expected "// &
          dimension_name(dimension))
      else
        call read_unit(word%text(length + 1:), dimension, measure, error)
        if (allocated(error)) error%text = error%text//difference_hint(word)
        if (.not. allocated(error) .and. .not. serves_for(measure, dimension)) &
          call set_error(error, error_of_input, wrong_unit(measure, dimension))
        place = token_part(word, length + 1, len(word%text))
      end if
    end if
    if (.not. allocated(error)) then
      call check_range(word%text, value, measure, error)
      if (allocated(error)) place = word
    end if
    fine = .not. allocated(error)
    if (fine) return
    call add_error(diagnostics, place, error%text, kind=error_of_writing)
  end subroutine read_measure

  !> For a number with one decimal comma: the number with a point. Three digits after a comma may
  !! be thousands. Else an empty text.
  pure function comma_hint(word) result(hint)
    character(len=*), intent(in) :: word !! begins with a number
    character(len=:), allocatable :: hint

    integer :: comma, digits

    hint = ""
    comma = index(word, ",")
    if (comma == len(word) .or. index(word, ",", back=.true.) > comma) return
    digits = verify(word(comma + 1:)//" ", "0123456789") - 1
    if (digits == 0 .or. digits == 3) return
    hint = " (did you mean '"//word(:comma - 1)//"."//word(comma + 1:)//"'?)"
  end function comma_hint

  !> For a value of SET that would be a difference with blanks in it: that it needs them. Else an
  !! empty text.
  pure function difference_hint(word) result(hint)
    type(token_t), intent(in) :: word !! begins with a number
    character(len=:), allocatable :: hint

    integer :: sign

    hint = ""
    sign = index(word%text, "-", back=.true.)
    if (word%set_line <= 0 .or. sign < 2) return
    if (number_length(word%text(sign + 1:)) > 0) hint = " (a difference has blanks: "// &
      word%text(:sign - 1)//" - "//word%text(sign + 1:)//")"
  end function difference_hint

  !> For a number with a dash in place of its minus sign, as word processors write it: that it has
  !! one. Else an empty text.
  pure function dash_hint(word) result(hint)
    character(len=*), intent(in) :: word !! UTF-8
    character(len=:), allocatable :: hint

    character(len=3), parameter :: minus = char(226)//char(136)//char(146), &
      dash = char(226)//char(128)//char(147)

    hint = ""
    if (index(word, minus) == 1 .or. index(word, dash) == 1) hint = &
      " (did you mean '-"//word(len(minus) + 1:)//"', with the minus sign of the keyboard?)"
  end function dash_hint

  !> Errors: a number is unreasonably large or small.
  !!
  !! The limits are far from any mechanism, but narrow enough that products such as EI/L³ and their
  !! squares do not overflow.
  pure subroutine check_range(text, value, measure, error)
    character(len=*), intent(in) :: text
    real(wp), intent(in) :: value        !! as written
    type(unit_t), intent(in) :: measure
    type(error_t), allocatable, intent(inout) :: error

    real(wp), parameter :: largest = 1.0e30_wp, smallest = 1.0e-40_wp

    ! Before the conversion, which may overflow.
    if (abs(value) > largest*measure%denominator/measure%numerator) then
      call set_error(error, error_of_input, "'"//text// &
        "' is too large: numbers up to 1e30 (in SI units) are taken")
    else if (abs(value) > 0.0_wp .and. abs(value) < smallest*measure%denominator/ &
      measure%numerator) then
      call set_error(error, error_of_input, "'"//text// &
        "' is too small: numbers from 1e-40 (in SI units) are taken")
    end if
  end subroutine check_range

  !> Reads a quantity in SI. Errors: as for `read_measure`.
  pure subroutine read_quantity(word, dimension, system, diagnostics, value, fine)
    type(token_t), intent(in) :: word                 !! with or without a unit
    integer, intent(in) :: dimension(4)               !! that the quantity must have
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: value                    !! [SI]; 0 after an error
    logical, intent(out) :: fine                      !! whether a value was read

    type(unit_t) :: measure

    call read_measure(word, dimension, coherent_factor(system, dimension), diagnostics, value, &
      measure, fine)
    if (fine) then
      value = to_si(value, measure)
    else
      value = 0.0_wp ! a number out of range would overflow further on
    end if
  end subroutine read_quantity

  !> Reads the quantity of a key in SI.
  !!
  !! Errors: as for `read_measure`; a required key is missing.
  pure subroutine read_entry_quantity(card, key, dimension, system, required, diagnostics, value, &
    fine)
    type(card_t), intent(in) :: card                  !! of any kind
    character(len=*), intent(in) :: key               !! in any case of letters
    integer, intent(in) :: dimension(4)               !! that the quantity must have
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    logical, intent(in) :: required                   !! whether a missing key is an error
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: value                    !! [SI]; 0 without a value
    logical, intent(out) :: fine                      !! whether a value was read

    value = 0.0_wp
    fine = .false.
    if (has_value(card, key)) then
      call read_quantity(value_of(card, key), dimension, system, diagnostics, value, fine)
    else if (required .and. .not. has_key(card, key)) then
      call add_error(diagnostics, card%keyword, "'"//key//"=' is missing; expected "// &
        dimension_name(dimension), kind=error_of_writing)
    end if
  end subroutine read_entry_quantity

  !> Whether a card has a key, with or without a value.
  pure function has_key(card, key) result(has)
    type(card_t), intent(in) :: card    !! of any kind
    character(len=*), intent(in) :: key !! in any case of letters
    logical :: has

    integer :: i

    has = .false.
    do i = 1, size(card%entries)
      has = has .or. same_word(card%entries(i)%key%text, key)
    end do
  end function has_key

  !> Errors: the value of a key is not greater than zero.
  pure subroutine require_positive(card, key, value, diagnostics)
    type(card_t), intent(in) :: card                  !! without this key, nothing is checked
    character(len=*), intent(in) :: key               !! in any case of letters
    real(wp), intent(in) :: value                     !! of the key, in any unit
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    type(token_t) :: word

    word = value_of(card, key)
    if (word%line == 0 .or. value > 0.0_wp) return
    call add_error(diagnostics, word, "'"//key//"=' must be greater than 0, not "//word%text)
  end subroutine require_positive

  !> Errors: a value is less than zero.
  pure subroutine refuse_negative(word, value, noun, diagnostics)
    type(token_t), intent(in) :: word                 !! that the value was read from
    real(wp), intent(in) :: value                     !! in any unit
    character(len=*), intent(in) :: noun              !! what it is: `a mass`
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    if (value < 0.0_wp) call add_error(diagnostics, word, noun//" must not be negative, as "// &
      word%text//" is")
  end subroutine refuse_negative

  !> Reads the integer of a key.
  !!
  !! Errors: it is no integer, is less than `least` or more than `most`.
  pure subroutine read_entry_count(card, key, least, diagnostics, value, fine, most)
    type(card_t), intent(in) :: card                  !! of any kind
    character(len=*), intent(in) :: key               !! in any case of letters
    integer, intent(in) :: least                      !! smallest allowed value
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(out) :: value                     !! `least` without the key
    logical, intent(out) :: fine                      !! whether the key exists and its value is
                                                      !! right
    integer, intent(in), optional :: most             !! largest allowed value; absent: any

    character(len=:), allocatable :: range
    type(error_t), allocatable :: error
    type(token_t) :: word

    value = least
    fine = .false.
    word = value_of(card, key)
    if (word%line == 0) return
    range = to_string(least)//" up"
    if (present(most)) range = to_string(least)//" to "//to_string(most)
    call read_integer(word%text, value, error)
    if (allocated(error)) then
      call add_error(diagnostics, word, error%text//"; expected a whole number from "//range)
      return
    end if
    fine = value >= least
    if (present(most)) fine = fine .and. value <= most
    if (fine) return
    if (present(most)) then
      call add_error(diagnostics, word, "'"//key//"=' must be from "//range//", not "//word%text)
    else
      call add_error(diagnostics, word, "'"//key//"=' must be at least "//to_string(least)// &
        ", not "//word%text)
    end if
  end subroutine read_entry_count

  !> Reads `accuracy=`, a relative one.
  !!
  !! Errors: as for `read_measure`; it is finer or coarser than allowed.
  pure subroutine read_entry_accuracy(card, finest, coarsest, system, diagnostics, accuracy, &
    fine)
    type(card_t), intent(in) :: card                  !! of any kind
    real(wp), intent(in) :: finest, coarsest          !! smallest and largest allowed value [-]
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: accuracy                 !! [-]; 0 without a right value
    logical, intent(out) :: fine                      !! whether the key exists and its value is
                                                      !! right

    type(token_t) :: word

    accuracy = 0.0_wp
    fine = .false.
    word = value_of(card, "accuracy")
    if (word%line == 0) return
    call read_quantity(word, dimension_none, system, diagnostics, accuracy, fine)
    if (.not. fine) return
    fine = accuracy >= finest .and. accuracy <= coarsest
    if (accuracy < finest) then
      call add_error(diagnostics, word, "'accuracy=' must be at least "//to_string(finest)// &
        ", not "//word%text//": double precision gives no more than "//to_string(finest))
    else if (accuracy > coarsest) then
      call add_error(diagnostics, word, "'accuracy=' must be at most "//to_string(coarsest)// &
        ", not "//word%text)
    end if
    if (.not. fine) accuracy = 0.0_wp
  end subroutine read_entry_accuracy

  !> Reads a word that must be one of a few.
  !!
  !! Errors: it is none of them.
  pure subroutine read_choice(word, choices, diagnostics, choice)
    type(token_t), intent(in) :: word                 !! in any case of letters
    character(len=*), intent(in) :: choices           !! separated by single blanks
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(out) :: choice                    !! its number among them; 0 after an error

    type(string_t), allocatable :: list(:)
    integer :: i

    list = word_list(choices)
    choice = 0
    do i = 1, size(list)
      if (same_word(list(i)%text, word%text)) choice = i
    end do
    if (choice == 0) then
      call add_error(diagnostics, word, "unknown word '"//word%text//"'"//suggestion(word%text, &
        list)//"; expected one of: "//joined(list), kind=error_of_writing)
    end if
  end subroutine read_choice

end module card_reader
