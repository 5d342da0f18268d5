!> LAW cards: how a drive moves in time; and the TIME card. What a law as a whole is, and
!! whether it is one, `law_checks` finds.
module law_cards
  use card_reader, only: check_form, entry_of, has_key, has_value, read_choice, &
    read_entry_quantity, read_measure, read_name, require_positive, value_of
  use card_table, only: pattern_of
  use cards, only: card_t, entry_t
  use constants, only: degree
  use diagnostics, only: add_error, diagnostics_t
  use expressions, only: evaluate, operand_t
  use kinds, only: wp
  use motion_laws, only: law_words
  use natures, only: is_angular, nature_t
  use quantities, only: kind_text, quantity_t
  use time_formulas, only: add_step, step_scaled, time_formula_t
  use tokens, only: token_t
  use units, only: coherent_factor, coherent_unit, dimension_name, dimension_time, unit_system_t, &
    unit_t
  use value_lists, only: model_value, read_values, value_list_t
  implicit none (type, external)
  private

  public :: law_card_t, read_law, read_time
  public :: table_free, table_rest, table_periodic

  ! In the order of `ends_words`.
  integer, parameter :: table_free = 1, table_rest = 2, table_periodic = 3
  character(len=*), parameter :: ends_words = "free rest periodic"

  !> One LAW card: a segment, a table, or a formula. A word without a line is not on the card.
  type :: law_card_t
    type(token_t) :: name                 !! without a line if the card cannot be read
    integer :: law = 0                    !! of a segment: one of the law_… constants
    type(token_t) :: law_word
    real(wp) :: start = 0.0_wp            !! [s]
    real(wp) :: stop = 0.0_wp             !! [s]
    type(token_t) :: start_word, stop_word
    real(wp) :: from = 0.0_wp             !! [deg], of a slider or a ram [m]
    real(wp) :: to = 0.0_wp               !! likewise
    type(token_t) :: from_word, to_word
    type(token_t) :: table_word           !! of a table
    integer :: ends = table_free          !! of a table: one of the table_… constants
    type(token_t), allocatable :: formula_words(:) !! of a formula, its parts
    type(time_formula_t) :: formula       !! likewise [deg], of a slider or a ram [m]
  end type law_card_t

contains

  !> Reads a LAW card: `name kind to= start= stop= [from=]`, `name table= [ends=]` or `name formula=
  !! [period=]`. Errors: words or keys that do not fit the card, unreadable values, a segment that
  !! stops before it starts, a formula of something else than positions.
  pure subroutine read_law(card, system, diagnostics, law, nature)
    type(card_t), intent(in) :: card                  !! the LAW card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(law_card_t), intent(out) :: law              !! as read
    type(nature_t), intent(in) :: nature              !! of the position of its drive

    type(token_t) :: nowhere
    logical :: fine, known_keys

    nowhere = token_t("", 0, 0)
    law%name = nowhere
    law%law_word = nowhere
    law%start_word = nowhere
    law%stop_word = nowhere
    law%from_word = nowhere
    law%to_word = nowhere
    law%table_word = nowhere
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine) return
    call read_name(card%words(1), diagnostics)
    if (.not. known_keys) return
    if (has_key(card, "table")) then
      call refuse_others(card, "table", ["to     ", "from   ", "start  ", "stop   ", "formula", &
        "period "], diagnostics)
      call read_table_of_law(card, diagnostics, law)
    else if (has_key(card, "formula")) then
      call refuse_others(card, "formula", ["to   ", "from ", "start", "stop ", "ends "], &
        diagnostics)
      call read_formula_of_law(card, system, nature, diagnostics, law)
    else
      call read_segment(card, system, nature, diagnostics, law)
    end if
  end subroutine read_law

  !> Errors: a word or a key that is of segments, or of another form of the card.
  pure subroutine refuse_others(card, key, others, diagnostics)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key !! that the card has
    character(len=*), intent(in) :: others(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    if (size(card%words) > 1) call add_error(diagnostics, card%words(2), "unexpected '"// &
      card%words(2)%text//"': a "//key//" is no segment; expected: "//pattern_of("LAW"))
    do i = 1, size(others)
      if (.not. has_key(card, trim(others(i)))) cycle
      call add_error(diagnostics, card%keyword, "'"//trim(others(i))// &
        "=' has no meaning beside '"//key//"='")
    end do
  end subroutine refuse_others

  !> Reads `formula= [period=]`.
  pure subroutine read_formula_of_law(card, system, nature, diagnostics, law)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(nature_t), intent(in) :: nature
    type(diagnostics_t), intent(inout) :: diagnostics
    type(law_card_t), intent(inout) :: law

    type(operand_t) :: none(0)
    type(token_t), allocatable :: words(:)
    type(entry_t) :: entry
    type(quantity_t) :: found
    type(unit_t) :: bare
    real(wp) :: period, factor
    logical :: fine
    integer :: i

    call read_entry_quantity(card, "period", dimension_time, system, .false., diagnostics, &
      law%formula%period, fine)
    if (fine) call require_positive(card, "period", law%formula%period, diagnostics)
    entry = entry_of(card, "formula")
    ! What is unknown has an error of its own.
    if (len(entry%value%text) == 0 .or. entry%value%set_line < 0) return
    if (allocated(entry%items)) then
      words = entry%items
      do i = 1, size(words)
        ! A `$name` is a value, whatever stands beside it.
        if (words(i)%set_line == 0) cycle
        words(i)%text = "("//words(i)%text//")"
        if (.not. words(i)%is_computed) words(i)%set_column = words(i)%set_column - 1
      end do
    else
      allocate (words(1))
      words(1) = entry%value
    end if
    period = law%formula%period
    call evaluate(words, none, system, diagnostics, found, fine, law%formula)
    law%formula%period = period
    if (.not. fine) return
    if (any(found%dimension /= nature%value)) then
      call add_error(diagnostics, entry%value, "the position of this drive is "// &
        dimension_name(nature%value)//", and this is "//kind_text(found, system))
      return
    end if
    bare = coherent_factor(system, nature%value)
    factor = bare%numerator/bare%denominator
    if (is_angular(nature)) factor = merge(1.0_wp/degree, 1.0_wp, found%in_radians)
    if (abs(factor - 1.0_wp) > 0.0_wp) call add_step(law%formula, step_scaled, found%step, 0, &
      factor, [0, 0])
    law%name = card%words(1)
    law%formula_words = words
  end subroutine read_formula_of_law

  !> Reads `table= [ends=]`.
  pure subroutine read_table_of_law(card, diagnostics, law)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(law_card_t), intent(inout) :: law

    integer :: choice

    if (has_value(card, "ends")) then
      call read_choice(value_of(card, "ends"), ends_words, diagnostics, choice)
      if (choice > 0) law%ends = choice
    end if
    if (.not. has_value(card, "table")) return
    law%name = card%words(1)
    law%table_word = value_of(card, "table")
  end subroutine read_table_of_law

  !> Reads `kind to= start= stop= [from=]`.
  pure subroutine read_segment(card, system, nature, diagnostics, law)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(nature_t), intent(in) :: nature
    type(diagnostics_t), intent(inout) :: diagnostics
    type(law_card_t), intent(inout) :: law

    logical :: fine(4)

    if (size(card%words) < 2) then
      call add_error(diagnostics, card%keyword, "this card is too short; expected: "// &
        pattern_of("LAW"))
      return
    end if
    if (has_key(card, "ends")) call add_error(diagnostics, card%keyword, &
      "'ends=' is for a table")
    if (has_key(card, "period")) call add_error(diagnostics, card%keyword, &
      "'period=' is for a formula")
    law%law_word = card%words(2)
    call read_choice(card%words(2), law_words, diagnostics, law%law)
    call read_position(card, "to", nature, system, .true., diagnostics, law%to, law%to_word, &
      fine(1))
    call read_position(card, "from", nature, system, .false., diagnostics, law%from, &
      law%from_word, fine(2))
    call read_entry_quantity(card, "start", dimension_time, system, .true., diagnostics, &
      law%start, fine(3))
    call read_entry_quantity(card, "stop", dimension_time, system, .true., diagnostics, law%stop, &
      fine(4))
    if (law%law == 0 .or. .not. all(fine([1, 3, 4]))) return
    law%name = card%words(1)
    law%start_word = value_of(card, "start")
    law%stop_word = value_of(card, "stop")
    if (law%stop > law%start) return
    call add_error(diagnostics, law%stop_word, "a segment stops after it starts", law%start_word, &
      "it starts here")
  end subroutine read_segment

  !> Reads a position of a drive: an angle in degrees to the last digit, or a length.
  pure subroutine read_position(card, key, nature, system, required, diagnostics, value, word, &
    fine)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    type(nature_t), intent(in) :: nature
    type(unit_system_t), intent(in) :: system
    logical, intent(in) :: required
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(out) :: value !! [deg] or [m]; 0 without a value
    type(token_t), intent(inout) :: word
    logical, intent(out) :: fine

    type(unit_t) :: measure
    real(wp) :: number

    value = 0.0_wp
    fine = .false.
    if (.not. has_value(card, key)) then
      if (required .and. .not. has_key(card, key)) call add_error(diagnostics, card%keyword, &
        "'"//key//"=' is missing; expected the position at the end of this segment")
      return
    end if
    word = value_of(card, key)
    call read_measure(word, nature%value, coherent_unit(system, nature%value), diagnostics, &
      number, measure, fine)
    if (fine) value = model_value(number, measure, nature%value)
  end subroutine read_position

  !> Reads `TIME`: instants, listed like crank angles. Errors: as for CRANK.
  pure subroutine read_time(card, system, diagnostics, time)
    type(card_t), intent(in) :: card                  !! the TIME card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(value_list_t), intent(out) :: time           !! [s]

    logical :: fine

    call check_form(card, diagnostics, fine)
    call read_values(card%words, dimension_time, system, "instant", diagnostics, time)
  end subroutine read_time

end module law_cards
