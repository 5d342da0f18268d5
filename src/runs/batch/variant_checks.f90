!> Checks of variants, made where they are computed, and what they come to together.
!!
!! Variants with wrong values, and those that do not reach some position, are no errors of the deck
!! as long as others are sound: their rows are failed ones. A deck is refused if its variants cannot
!! be in one table, if memory does not suffice for one, and if none is sound.
module variant_checks
  use byte_streams, only: byte_stream_t
  use card_bytes, only: pass_token
  use cards, only: card_t
  use diagnostic_bytes, only: pass_diagnostics
  use diagnostics, only: add_error, add_warning, append_warnings, count_warnings, diagnostic_t, &
    diagnostics_t, errors_of, has_errors, has_messages, has_other_errors, join_warnings
  use errors, only: error_of_memory, error_of_reach, error_of_writing, error_t, set_error
  use interruption, only: was_interrupted
  use kinds, only: wp
  use models, only: model_t
  use text, only: to_string
  use tokens, only: token_t
  use variant_readings, only: check_variant, read_values, read_variant, run_limits_t
  use variants, only: deck_cards_t, variant_count, variant_text
  implicit none (type, external)
  private

  public :: check_t, check_number, check_values, is_refused, first_error, pass_check
  public :: checks_t, find_leading, begin_checks, check_variants, join_check, refuses_deck, &
    conclude_checks

  !> What the check of a variant leaves.
  type :: check_t
    integer :: modes = 0               !! of its model; 0 if that is not complete
    integer :: effects = 0             !! likewise
    type(token_t) :: modes_word        !! on its MODES card
    type(diagnostics_t) :: diagnostics !! of this variant alone
  end type check_t

  !> Checks of variants joined in their order.
  type :: checks_t
    private
    integer :: count = 0                 !! of variants
    integer :: leading = 0               !! number of the first that is not refused; 0: none
    integer :: modes = 0, effects = 0    !! of this one
    logical :: any_sound = .false.       !! some variant has no error at all
    type(diagnostics_t) :: warnings      !! of the deck and of all variants
    type(diagnostics_t) :: failures      !! what keeps variants from being computed, as warnings
    type(diagnostics_t) :: of_first      !! of the first variant
    type(diagnostics_t) :: refusal       !! errors of the first variant for which the deck is
                                         !! refused
  end type checks_t

  !> Kinds of the warnings about variants with positions out of reach, and about those that cannot
  !! be computed, apart from other warnings at the same word.
  integer, parameter :: warning_of_reach = 1, warning_of_refusal = 3

contains

  !> Reads a variant of a deck, and checks it.
  subroutine check_number(deck_cards, number, limits, cards, model, check)
    type(deck_cards_t), intent(in) :: deck_cards         !! of all variants, without errors
    integer, intent(in) :: number                        !! of the variant
    type(run_limits_t), intent(in) :: limits
    type(card_t), allocatable, intent(inout) :: cards(:) !! of another variant, or not allocated
    type(model_t), intent(out) :: model                  !! complete only without errors
    type(check_t), intent(out) :: check

    call read_variant(deck_cards, number, cards, check%diagnostics, model)
    call check_model(model, limits, check)
  end subroutine check_number

  !> The same of any values of the VARY cards.
  subroutine check_values(deck_cards, values, limits, cards, model, check)
    type(deck_cards_t), intent(in) :: deck_cards         !! as for `check_number`
    real(wp), intent(in) :: values(:)                    !! (parameters) in the units of their cards
    type(run_limits_t), intent(in) :: limits
    type(card_t), allocatable, intent(inout) :: cards(:) !! as for `check_number`
    type(model_t), intent(out) :: model                  !! likewise
    type(check_t), intent(out) :: check

    call read_values(deck_cards, values, cards, check%diagnostics, model)
    call check_model(model, limits, check)
  end subroutine check_values

  !> Checks a model as it was read.
  subroutine check_model(model, limits, check)
    type(model_t), intent(in) :: model
    type(run_limits_t), intent(in) :: limits
    type(check_t), intent(inout) :: check !! with what reading has left

    if (has_errors(check%diagnostics)) return
    check%modes = model%modes
    check%effects = model%effects
    check%modes_word = model%modes_word
    call check_variant(model, limits, check%diagnostics)
  end subroutine check_model

  !> Whether a variant cannot be computed. One that does not reach some position can.
  pure function is_refused(check) result(is)
    type(check_t), intent(in) :: check !! of the variant
    logical :: is

    is = has_other_errors(check%diagnostics, error_of_reach)
  end function is_refused

  !> The first error of a variant in the order of the deck's lines, without its place.
  pure subroutine first_error(check, error)
    type(check_t), intent(in) :: check               !! of the variant
    type(error_t), allocatable, intent(out) :: error !! not allocated: there is none

    type(diagnostic_t), allocatable :: list(:)

    list = errors_of(check%diagnostics)
    if (size(list) > 0) call set_error(error, list(1)%kind, list(1)%message)
  end subroutine first_error

  !> Passes the check of a variant.
  pure subroutine pass_check(stream, check)
    type(byte_stream_t), intent(inout) :: stream
    type(check_t), intent(inout) :: check !! new if it is read

    call stream%pass(check%modes)
    call stream%pass(check%effects)
    call pass_token(stream, check%modes_word)
    call pass_diagnostics(stream, check%diagnostics)
  end subroutine pass_check

  !> Looks for the variant that leads: heads of tables and texts are its. Variants are checked from
  !! the first one on, until one is sound.
  !!
  !! Errors: those of `conclude_checks`. After an interruption nothing is known.
  subroutine find_leading(deck_cards, limits, diagnostics, leading)
    type(deck_cards_t), intent(in) :: deck_cards      !! without errors
    type(run_limits_t), intent(in) :: limits
    type(diagnostics_t), intent(inout) :: diagnostics !! of the deck, to which errors are added, and
                                                      !! then warnings, too
    integer, intent(out) :: leading                   !! number of the first variant that is not
                                                      !! refused

    type(checks_t) :: checks

    checks%count = variant_count(deck_cards)
    checks%warnings = diagnostics
    call check_range(deck_cards, limits, 1, checks%count, .true., checks)
    leading = checks%leading
    if (was_interrupted()) return
    if (refuses_deck(checks) .or. .not. checks%any_sound) call conclude_checks(checks, deck_cards, &
      diagnostics)
  end subroutine find_leading

  !> Checks of the variants of a deck, before the first one.
  pure function begin_checks(model, diagnostics, count) result(checks)
    type(model_t), intent(in) :: model             !! of the variant that leads
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    integer, intent(in) :: count                   !! of the variants that are to be checked
    type(checks_t) :: checks

    checks%count = count
    checks%leading = 1
    checks%modes = model%modes
    checks%effects = model%effects
    checks%any_sound = .true.
    checks%warnings = diagnostics
  end function begin_checks

  !> Checks variants without computing them.
  subroutine check_variants(deck_cards, limits, first, last, model, diagnostics)
    type(deck_cards_t), intent(in) :: deck_cards      !! without errors
    type(run_limits_t), intent(in) :: limits
    integer, intent(in) :: first, last                !! numbers of the variants
    type(model_t), intent(in) :: model                !! of the variant that leads
    type(diagnostics_t), intent(inout) :: diagnostics !! of the deck; on return, with those of the
                                                      !! variants

    type(checks_t) :: checks

    checks = begin_checks(model, diagnostics, last - first + 1)
    call check_range(deck_cards, limits, first, last, .false., checks)
    if (.not. was_interrupted()) call conclude_checks(checks, deck_cards, diagnostics)
  end subroutine check_variants

  !> Checks variants until the deck is refused, or a first one is sound if no more is wanted.
  subroutine check_range(deck_cards, limits, first, last, until_sound, checks)
    type(deck_cards_t), intent(in) :: deck_cards
    type(run_limits_t), intent(in) :: limits
    integer, intent(in) :: first, last !! numbers of the variants
    logical, intent(in) :: until_sound
    type(checks_t), intent(inout) :: checks

    type(card_t), allocatable :: cards(:)
    type(model_t) :: model
    type(check_t) :: check
    integer :: number

    do number = first, last
      call check_number(deck_cards, number, limits, cards, model, check)
      call join_check(checks, deck_cards, number, check)
      if (refuses_deck(checks) .or. until_sound .and. checks%any_sound) return
      if (was_interrupted()) return
    end do
  end subroutine check_range

  !> Joins the check of a variant to those of the variants before.
  subroutine join_check(checks, deck_cards, number, check)
    type(checks_t), intent(inout) :: checks
    type(deck_cards_t), intent(in) :: deck_cards
    integer, intent(in) :: number !! of the variant
    type(check_t), intent(in) :: check

    character(len=:), allocatable :: name

    if (number == 1) then
      checks%of_first = check%diagnostics
      ! Of a million variants, a misspelt name would be told minutes later.
      if (is_written_wrongly(check%diagnostics)) then
        call append_warnings(checks%refusal, check%diagnostics)
        call take_errors(check%diagnostics, "", checks%refusal)
        return
      end if
    end if
    ! Nearly all variants have nothing to say, and do not need their names.
    name = ""
    if (has_messages(check%diagnostics)) name = variant_text(deck_cards, number)
    call join_warnings(checks%warnings, check%diagnostics, name)
    if (lacks_memory(check%diagnostics)) then
      ! What a machine has must not make rows: other machines would make others.
      call take_errors(check%diagnostics, "with "//name//": ", checks%refusal)
      return
    end if
    checks%any_sound = checks%any_sound .or. .not. has_errors(check%diagnostics)
    if (is_refused(check)) then
      call join_failures(checks%failures, check%diagnostics, name, warning_of_refusal)
      return
    end if
    if (has_errors(check%diagnostics)) call join_failures(checks%failures, check%diagnostics, &
      name, warning_of_reach)
    if (checks%leading == 0) then
      checks%leading = number
      checks%modes = check%modes
      checks%effects = check%effects
    end if
    if (check%modes /= checks%modes) then
      call add_error(checks%refusal, check%modes_word, "with "//variant_text(deck_cards, number)// &
        ": all variants must have as many modes: they are columns of one table")
    else if (check%effects /= checks%effects) then
      call add_error(checks%refusal, deck_cards%variations(1)%name, "with "// &
        variant_text(deck_cards, number)//": of this variant and the first one, one stands "// &
        "still without loads and one does not: EFFECTS must say whether axial forces act")
    end if
  end subroutine join_check

  !> Whether some variant joined is one for which the deck is refused.
  pure function refuses_deck(checks) result(refuses)
    type(checks_t), intent(in) :: checks
    logical :: refuses

    refuses = has_errors(checks%refusal)
  end function refuses_deck

  !> Adds what all variants have left to the messages of the deck.
  !!
  !! Errors: what is wrong in all variants alike; a variant that cannot be in one table with the
  !! others, or for which memory does not suffice; those of the first one if none is sound.
  subroutine conclude_checks(checks, deck_cards, diagnostics)
    type(checks_t), intent(in) :: checks              !! with all variants joined, or the first one
                                                      !! for which the deck is refused
    type(deck_cards_t), intent(in) :: deck_cards
    type(diagnostics_t), intent(inout) :: diagnostics !! of the deck, on the way replaced by those
                                                      !! that `checks` has begun with

    if (refuses_deck(checks)) then
      call append_warnings(diagnostics, checks%refusal)
      call take_errors(checks%refusal, "", diagnostics)
    else if (checks%any_sound) then
      diagnostics = checks%warnings
      call append_warnings(diagnostics, checks%failures)
      call count_warnings(diagnostics, checks%count)
    else if (has_other_errors(checks%of_first, error_of_reach)) then
      ! As a rule it is the deck that is wrong, not this variant.
      call append_warnings(diagnostics, checks%of_first)
      call take_errors(checks%of_first, "", diagnostics)
      if (is_at_value(checks%of_first)) call add_count()
    else
      diagnostics = checks%warnings
      call count_warnings(diagnostics, checks%count)
      call take_errors(checks%of_first, "with "//variant_text(deck_cards, 1)//": ", diagnostics)
      call add_count()
    end if

  contains

    !> Says that all variants are refused, if there are more than the one that has been told of.
    subroutine add_count()
      if (checks%count == 1) return
      call add_error(diagnostics, deck_cards%variations(1)%name, to_string(checks%count)//" of "// &
        to_string(checks%count)//" variants are refused, the first one with "// &
        variant_text(deck_cards, 1))
    end subroutine add_count

  end subroutine conclude_checks

  !> Whether a variant has errors, and none of them depends on what varies.
  pure function is_written_wrongly(diagnostics) result(is)
    type(diagnostics_t), intent(in) :: diagnostics !! of the variant
    logical :: is

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(diagnostics)
    is = size(list) > 0 .and. .not. has_other_errors(diagnostics, error_of_writing)
    do i = 1, size(list)
      is = is .and. list(i)%place%set_line == 0
    end do
  end function is_written_wrongly

  !> Whether some error is at a value that SET or VARY gives.
  pure function is_at_value(diagnostics) result(is)
    type(diagnostics_t), intent(in) :: diagnostics !! of the variant
    logical :: is

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(diagnostics)
    is = any([(list(i)%place%set_line /= 0, i=1, size(list))])
  end function is_at_value

  !> Whether there is too little memory for a variant.
  pure function lacks_memory(diagnostics) result(lacks)
    type(diagnostics_t), intent(in) :: diagnostics !! of the variant
    logical :: lacks

    lacks = has_errors(diagnostics)
    if (lacks) lacks = .not. has_other_errors(diagnostics, error_of_memory)
  end function lacks_memory

  !> Turns the errors of a variant that cannot be computed, or not at all positions, into warnings,
  !! and joins them to those of the variants before.
  subroutine join_failures(failures, mine, variant, kind)
    type(diagnostics_t), intent(inout) :: failures
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: variant
    integer, intent(in) :: kind

    type(diagnostics_t) :: warnings
    type(diagnostic_t), allocatable :: list(:)
    character(len=:), allocatable :: message
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      message = "rows will be marked as failed: "//list(i)%message
      if (len(list(i)%note) > 0 .and. kind == warning_of_refusal) then
        call add_warning(warnings, list(i)%place, message, kind, second_place= &
          list(i)%second_place, note=list(i)%note)
      else
        call add_warning(warnings, list(i)%place, message, kind)
      end if
    end do
    call join_warnings(failures, warnings, variant)
  end subroutine join_failures

  !> Adds errors, each after a few words.
  subroutine take_errors(mine, before, diagnostics)
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: before !! `with L=90mm: `, or empty
    type(diagnostics_t), intent(inout) :: diagnostics

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      if (len(list(i)%note) > 0) then
        call add_error(diagnostics, list(i)%place, before//list(i)%message, &
          list(i)%second_place, list(i)%note, list(i)%kind)
      else
        call add_error(diagnostics, list(i)%place, before//list(i)%message, kind=list(i)%kind)
      end if
    end do
  end subroutine take_errors

end module variant_checks
