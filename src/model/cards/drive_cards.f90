!> DRIVE and BRANCH cards: what is given at a position, and in which of its assemblies the linkage
!! is. Names are looked up later, by `drive_checks`.
module drive_cards
  use card_reader, only: check_form, has_key, has_value, key_of, read_choice, read_entry_quantity, &
    read_measure, read_quantity, value_of
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use measure_cards, only: card_named, nature_of_measure
  use natures, only: angle_nature, are_alike, is_angular, length_nature, nature_t
  use numbers, only: number_length
  use spelling, only: suggestion
  use text, only: same_word, word_list
  use tokens, only: token_t
  use units, only: coherent_factor, dimension_none, to_si, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: drive_card_t, branch_t, read_drive, read_branch, kind_of_drive, nature_of_drive
  public :: drive_angle, drive_relative, drive_slider, drive_ram, drive_measured_length, &
    drive_measured_angle
  public :: branch_left, branch_right, branch_forward, branch_backward

  integer, parameter :: drive_angle = 1    !! the angle of a link
  integer, parameter :: drive_relative = 2 !! the angle of a link minus that of another
  integer, parameter :: drive_slider = 3   !! the place of a slider
  integer, parameter :: drive_ram = 4      !! the length of a link
  integer, parameter :: drive_measured_length = 5, drive_measured_angle = 6 !! a MEASURE

  ! In the order of `branch_words`.
  integer, parameter :: branch_left = 1, branch_right = 2, branch_forward = 3, branch_backward = 4
  character(len=*), parameter :: branch_words = "left right forward backward"

  !> What happens at change points, in the order of the rule_… constants.
  character(len=*), parameter :: change_point_words = "through stop branch"

  !> One DRIVE card. A word without a line is not on the card.
  type :: drive_card_t
    type(token_t) :: keyword
    integer :: kind = 0            !! one of the drive_… constants; 0: it cannot be read
    type(nature_t) :: nature = angle_nature !! of its position
    type(token_t) :: subject       !! link, pin of a slider, or MEASURE
    type(token_t) :: against       !! the other link, or the guide or link that the slider is on
    logical :: is_free = .false.   !! its position is given, but it is not held in vibration
    logical :: has_at = .false.    !! `at=` is given
    real(wp) :: at = 0.0_wp        !! [rad], of a slider or a ram [m]
    type(token_t) :: at_word
    real(wp) :: speed = 0.0_wp     !! of a free one where REPORT motion begins [rad/s] or [m/s]
    type(token_t) :: speed_word
    logical :: has_ratio = .false. !! `ratio=` is given
    real(wp) :: ratio = 0.0_wp     !! position over that of the first drive [SI: 1, m/rad or rad/m]
    type(token_t) :: ratio_word
    type(token_t) :: law           !! the name of its law
    integer :: change_points = 0   !! of the first drive: number among the words; 0: not given
    type(token_t) :: change_points_word
    real(wp) :: phase = 0.0_wp     !! position where that of the first drive is 0 [as `at`]
    integer :: link = 0            !! number of `subject` in the model's list; 0: it is a pin
    integer :: against_link = 0    !! number of `against` in the model's list; 0: it is none
    integer :: slider = 0          !! number of the slider in the model's list; 0: it is none
    integer :: measure = 0         !! number of the MEASURE in the model's list; 0: it is none
  end type drive_card_t

  !> A BRANCH card about a pin.
  type :: branch_t
    type(token_t) :: pin            !! without a line if the card cannot be read
    type(token_t) :: word           !! left, right, forward or backward
    integer :: which = 0            !! one of the branch_… constants
    type(token_t) :: from, to       !! pins: the side is that of the way from one to the other;
                                    !! without a line for forward and backward
  end type branch_t

contains

  !> What a DRIVE card drives: one of the drive_… constants; 0 if its words fit none of them. A link
  !! comes before a MEASURE of its name.
  pure function kind_of_drive(card, cards) result(kind)
    type(card_t), intent(in) :: card     !! the DRIVE card
    type(card_t), intent(in) :: cards(:) !! all of the deck
    integer :: kind

    type(nature_t) :: nature
    integer :: measure

    kind = 0
    select case (word_count(card))
    case (1)
      kind = drive_angle
      measure = card_named(cards, "MEASURE", card%words(1)%text)
      if (measure == 0 .or. card_named(cards, "LINK", card%words(1)%text) > 0) return
      nature = nature_of_measure(cards(measure), cards)
      kind = merge(drive_measured_angle, drive_measured_length, is_angular(nature))
    case (2)
      kind = merge(drive_ram, drive_slider, same_word(card%words(2)%text, "length"))
      ! The angle of a link with a word too many is no place of a block.
      if (kind == drive_slider .and. card_named(cards, "LINK", card%words(1)%text) > 0 .and. &
        max(card_named(cards, "GUIDE", card%words(2)%text), card_named(cards, "LINK", &
        card%words(2)%text)) == 0) kind = 0
    case (3)
      if (same_word(card%words(2)%text, "against")) kind = drive_relative
    end select
  end function kind_of_drive

  !> What a drive's position is.
  elemental function nature_of_drive(kind) result(nature)
    integer, intent(in) :: kind !! one of the drive_… constants; 0: an angle
    type(nature_t) :: nature

    nature = angle_nature
    if (any(kind == [drive_slider, drive_ram, drive_measured_length])) nature = length_nature
  end function nature_of_drive

  !> Number of words without `free` at the end.
  pure function word_count(card) result(words)
    type(card_t), intent(in) :: card
    integer :: words

    words = size(card%words)
    if (words == 0) return
    if (same_word(card%words(words)%text, "free")) words = words - 1
  end function word_count

  !> Reads a DRIVE card: `link`, `link against link`, `pin guide`, `link length` or `measure`, then
  !! `free`, and `law=`, of the first card `change_points=`, of a further one else `at=` or
  !! `ratio= [phase=]`. A ratio of a length to an angle is in the deck's length per degree. Errors:
  !! words or keys that do not fit the card, unreadable values, a first card with a position of its
  !! own, a further one without any.
  pure subroutine read_drive(card, kind, first, first_kind, system, diagnostics, drive)
    type(card_t), intent(in) :: card                  !! the DRIVE card
    integer, intent(in) :: kind                       !! of `kind_of_drive`
    type(card_t), intent(in) :: first                 !! the first of the deck, perhaps the same
    integer, intent(in) :: first_kind                 !! its kind
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(drive_card_t), intent(out) :: drive               !! as read; the names are not looked up

    type(token_t) :: nowhere
    logical :: fine, known_keys

    nowhere = token_t("", 0, 0)
    drive%keyword = card%keyword
    drive%subject = nowhere
    drive%against = nowhere
    drive%at_word = nowhere
    drive%speed_word = nowhere
    drive%ratio_word = nowhere
    drive%law = nowhere
    drive%change_points_word = nowhere
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine) return
    drive%kind = kind
    drive%nature = nature_of_drive(kind)
    call read_subject(card, diagnostics, drive)
    if (drive%kind == 0) return
    drive%has_at = has_key(card, "at")
    drive%has_ratio = has_key(card, "ratio")
    if (card%keyword%line == first%keyword%line .and. card%keyword%column == &
      first%keyword%column) then
      if (known_keys) call read_keys_of_first(card, diagnostics, drive)
      return
    end if
    if (has_value(card, "change_points")) then
      call add_error(diagnostics, key_of(card, "change_points"), "'change_points=' is for the "// &
        "first DRIVE, and this one goes with it by 'ratio=', stands 'at=' or has a 'law='", &
        first%keyword, "the first is here")
      return
    end if
    if (has_value(card, "law")) drive%law = value_of(card, "law")
    call read_position(card, nature_of_drive(first_kind), system, diagnostics, drive)
    if (.not. known_keys .or. drive%is_free .or. drive%has_at .or. drive%has_ratio .or. &
      has_key(card, "law")) return
    ! That the same thing is driven twice is found by `drive_checks`.
    if (drive%kind == first_kind .and. same_word(drive%subject%text, &
      first%words(1)%text)) return
    call add_error(diagnostics, drive%subject, "the linkage is driven already; a further DRIVE "// &
      "needs a freedom of its own (a linkage of mobility 1 takes one) and 'at=', 'ratio=' or "// &
      "'law='", &
      first%words(1), "first driven here")
  end subroutine read_drive

  !> Reads the keys of the first DRIVE: `law=` and `change_points=`. Errors: keys of further ones.
  pure subroutine read_keys_of_first(card, diagnostics, drive)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(drive_card_t), intent(inout) :: drive

    integer :: i

    do i = 1, size(card%entries)
      associate (entry => card%entries(i))
        if (same_word(entry%key%text, "law")) then
          if (len(entry%value%text) > 0) drive%law = entry%value
        else if (same_word(entry%key%text, "change_points")) then
          if (.not. has_value(card, "change_points")) cycle
          drive%change_points_word = entry%value
          call read_choice(entry%value, change_point_words, diagnostics, drive%change_points)
        else
          call add_error(diagnostics, entry%key, "the first DRIVE has its positions from CRANK "// &
            "or a law; '"//entry%key%text//"=' is for further ones")
          return
        end if
      end associate
    end do
  end subroutine read_keys_of_first

  !> Reads the words of a DRIVE card.
  pure subroutine read_subject(card, diagnostics, drive)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(drive_card_t), intent(inout) :: drive

    character(len=:), allocatable :: hint
    integer :: words

    words = word_count(card)
    drive%is_free = words < size(card%words)
    if (drive%kind > 0) drive%subject = card%words(1)
    if (drive%kind == drive_slider) drive%against = card%words(2)
    if (drive%kind == drive_relative) drive%against = card%words(3)
    if (drive%kind > 0) return
    if (words == 0) then
      call add_error(diagnostics, card%keyword, "this card is too short; expected: "// &
        pattern_of("DRIVE"))
    else
      ! Of two or three words the second is wrong, of four the fourth is not `free`.
      words = merge(2, 4, words < 4)
      hint = suggestion(card%words(words)%text, word_list("against free length"))
      if (number_length(card%words(words)%text) > 0) hint = " (positions are on CRANK, speeds "// &
        "on SPEED)"
      call add_error(diagnostics, card%words(words), "unexpected '"//card%words(words)%text// &
        "'"//hint//"; expected: "//pattern_of("DRIVE"))
    end if
  end subroutine read_subject

  !> Reads `at=` and `speed=`, or `ratio=` and `phase=`.
  pure subroutine read_position(card, first, system, diagnostics, drive)
    type(card_t), intent(in) :: card
    type(nature_t), intent(in) :: first !! of the first drive
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(drive_card_t), intent(inout) :: drive

    character(len=*), parameter :: of_position(*) = [character(len=5) :: "at", "speed", "ratio", &
      "phase"]
    integer :: i, k
    logical :: fine

    call read_entry_quantity(card, "at", drive%nature%value, system, .false., diagnostics, &
      drive%at, fine)
    if (fine) drive%at_word = value_of(card, "at")
    call read_entry_quantity(card, "phase", drive%nature%value, system, .false., diagnostics, &
      drive%phase, fine)
    call read_entry_quantity(card, "speed", drive%nature%rate, system, .false., diagnostics, &
      drive%speed, fine)
    if (fine .and. drive%is_free .and. .not. drive%has_ratio) drive%speed_word = value_of(card, &
      "speed")
    if (has_value(card, "ratio")) call read_ratio(value_of(card, "ratio"), &
      [drive%nature, first], system, diagnostics, drive)
    do i = 1, size(card%entries)
      associate (key => card%entries(i)%key)
        if (drive%law%line > 0 .and. any([(same_word(key%text, trim(of_position(k))), k=1, &
          size(of_position))])) then
          call add_error(diagnostics, key, "'"//key%text//"=' has no meaning beside 'law='")
          return
        else if (drive%has_at .and. (same_word(key%text, "ratio") .or. same_word(key%text, &
          "phase"))) then
          call add_error(diagnostics, key, "'"//key%text//"=' has no meaning beside 'at='")
          return
        else if (same_word(key%text, "speed") .and. .not. drive%is_free) then
          call add_error(diagnostics, key, "'speed=' is that with which a free drive begins in "// &
            "REPORT motion; expected 'free' as the last word of this card")
          return
        else if (same_word(key%text, "speed") .and. drive%has_ratio) then
          call add_error(diagnostics, key, "'speed=' has no meaning beside 'ratio=': the drive "// &
            "begins with the speed of the first one times this")
          return
        else if (same_word(key%text, "phase") .and. .not. drive%has_ratio) then
          call add_error(diagnostics, key, "'phase=' needs 'ratio='")
        end if
      end associate
    end do
  end subroutine read_position

  !> Reads the value of `ratio=`.
  pure subroutine read_ratio(word, natures, system, diagnostics, drive)
    type(token_t), intent(in) :: word
    type(nature_t), intent(in) :: natures(2) !! of this drive and of the first one
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(drive_card_t), intent(inout) :: drive

    type(unit_t) :: own, first, bare, measure
    real(wp) :: value
    logical :: fine

    drive%ratio_word = word
    if (are_alike(natures)) then
      call read_quantity(word, dimension_none, system, diagnostics, drive%ratio, fine)
      return
    end if
    own = coherent_factor(system, natures(1)%value)
    first = coherent_factor(system, natures(2)%value)
    bare%name = ""
    bare%dimension = own%dimension - first%dimension
    bare%numerator = own%numerator*first%denominator
    bare%denominator = own%denominator*first%numerator
    call read_measure(word, bare%dimension, bare, diagnostics, value, measure, fine)
    if (fine) drive%ratio = to_si(value, measure)
  end subroutine read_ratio

  !> Reads a BRANCH card: `open` or `crossed`, `pin left|right pin pin`, or `pin forward|backward`.
  !! Errors: words or keys that do not fit the card, a second card of one word.
  pure subroutine read_branch(card, diagnostics, mode, keyword, branch)
    type(card_t), intent(in) :: card                  !! the BRANCH card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(inout) :: mode                    !! 1: open, 2: crossed; unchanged by a card
                                                      !! about a pin and after an error
    type(token_t), intent(inout) :: keyword           !! of the card with open or crossed; without a
                                                      !! line before there is one
    type(branch_t), intent(out) :: branch             !! of a card about a pin

    type(token_t) :: nowhere
    integer :: choice
    logical :: fine

    nowhere = token_t("", 0, 0)
    branch%pin = nowhere
    branch%word = nowhere
    branch%from = nowhere
    branch%to = nowhere
    if (size(card%words) == 1 .and. keyword%line > 0) then
      call add_error(diagnostics, card%keyword, "a second BRANCH card", keyword, &
        "the first is here")
    end if
    call check_form(card, diagnostics, fine)
    if (.not. fine) return
    if (size(card%words) == 1) then
      if (keyword%line == 0) keyword = card%keyword
      call read_choice(card%words(1), "open crossed", diagnostics, choice)
      if (choice > 0) mode = choice
      return
    end if
    call read_choice(card%words(2), branch_words, diagnostics, choice)
    if (choice == 0) return
    if (choice <= branch_right .and. size(card%words) /= 4) then
      call add_error(diagnostics, card%words(2), "'"//card%words(2)%text// &
        "' of the way from which pin to which? expected: BRANCH pin left|right pin pin")
      return
    else if (choice > branch_right .and. size(card%words) > 2) then
      call add_error(diagnostics, card%words(3), "unexpected '"//card%words(3)%text// &
        "'; expected: BRANCH pin forward|backward")
      return
    end if
    branch%pin = card%words(1)
    branch%word = card%words(2)
    branch%which = choice
    if (choice > branch_right) return
    branch%from = card%words(3)
    branch%to = card%words(4)
  end subroutine read_branch

end module drive_cards
