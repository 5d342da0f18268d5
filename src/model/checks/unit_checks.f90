!> Warnings about bare numbers that are in another unit than the results: who reads N in the tables
!! takes a bare 10 for 10 N, and in a deck of mm, kg and s it is 10 kg mm/s²; or that only another
!! unit makes likely: 1500 is a number of turns a minute.
module unit_checks
  use card_reader, only: has_value, value_of
  use cards, only: card_t
  use diagnostics, only: add_warning, diagnostics_t, has_errors
  use errors, only: error_t
  use kinds, only: wp
  use models, only: drives_length, model_t
  use numbers, only: number_length, read_real
  use text, only: same_word, to_string
  use tokens, only: token_t
  use units, only: coherent_unit, dimension_force, dimension_moment, dimension_rate, from_si, &
    read_unit, to_si, unit_t
  implicit none (type, external)
  private

  public :: check_bare_units

  !> Above it a bare speed is doubted: a crank at 1900 rpm [rad/s].
  real(wp), parameter :: fastest_crank = 200.0_wp

contains

  !> Warns once of bare forces, of bare torques and of bare speeds, if results have another unit for
  !! them. Zeros are the same in all units.
  pure subroutine check_bare_units(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! to which warnings are added
    type(model_t), intent(in) :: model                !! with its units

    call check_quantity(cards, "forces", coherent_unit(model%units, dimension_force), &
      model%outputs%force, diagnostics)
    call check_quantity(cards, "torques", coherent_unit(model%units, dimension_moment), &
      model%outputs%moment, diagnostics)
    ! Velocities of a slider or a ram are in the deck's own unit in tables, too.
    if (drives_length(model)) return
    call check_quantity(cards, "speeds", coherent_unit(model%units, dimension_rate), &
      model%outputs%rate, diagnostics)
    call check_speeds(cards, model, diagnostics)
  end subroutine check_bare_units

  !> Warns of the first bare speed that is rather one in rpm, unless all bare speeds are told of.
  pure subroutine check_speeds(cards, model, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(model_t), intent(in) :: model
    type(diagnostics_t), intent(inout) :: diagnostics

    type(unit_t) :: bare, rpm
    type(error_t), allocatable :: error
    type(token_t), allocatable :: words(:)
    real(wp) :: speed
    integer :: i, k

    bare = coherent_unit(model%units, dimension_rate)
    if (has_errors(diagnostics) .or. .not. are_same(bare, model%outputs%rate)) return
    call read_unit("rpm", dimension_rate, rpm, error)
    do i = 1, size(cards)
      call find_words(cards(i), "speeds", words)
      do k = 1, size(words)
        if (.not. is_bare(words(k))) cycle
        call read_real(words(k)%text, speed, error)
        if (abs(to_si(speed, bare)) <= fastest_crank) cycle
        call add_warning(diagnostics, words(k), "bare speeds are in "//bare%name//", and "// &
          words(k)%text//" "//bare%name//" is "//to_string(from_si(to_si(speed, bare), rpm), 5)// &
          " rpm; expected a unit: '"//words(k)%text//"rpm' or '"//words(k)%text//bare%name//"'")
        return
      end do
    end do
  end subroutine check_speeds

  !> Whether two units are one, but for rounding.
  elemental function are_same(a, b) result(are)
    type(unit_t), intent(in) :: a, b !! of one dimension
    logical :: are

    are = abs(to_si(1.0_wp, a)/to_si(1.0_wp, b) - 1.0_wp) <= 1.0e-12_wp
  end function are_same

  !> Warns of the first bare number of a quantity.
  pure subroutine check_quantity(cards, noun, bare, shown, diagnostics)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: noun    !! forces, torques or speeds
    type(unit_t), intent(in) :: bare, shown !! unit of bare numbers, unit of results
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t), allocatable :: words(:)
    integer :: i, k

    if (are_same(bare, shown)) return
    do i = 1, size(cards)
      call find_words(cards(i), noun, words)
      do k = 1, size(words)
        if (.not. is_bare(words(k))) cycle
        call add_warning(diagnostics, words(k), "bare "//noun//" are in "//bare%name//" ("// &
          to_string(from_si(to_si(1.0_wp, bare), shown))//" "//shown%name//"), and results in "// &
          shown%name//"; did you mean '"//words(k)%text//deck_name(shown%name)//"'?")
        return
      end do
    end do
  end subroutine check_quantity

  !> The words of a card that give a quantity without a unit at the end of a list.
  pure subroutine find_words(card, noun, words)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: noun
    type(token_t), allocatable, intent(out) :: words(:)

    character(len=6) :: keyword

    allocate (words(0))
    keyword = card%keyword%text
    if (noun == "forces" .and. same_word(trim(keyword), "FORCE")) then
      ! Beside a table the words are a direction.
      if (has_value(card, "table")) return
      words = card%words(min(2, size(card%words) + 1):)
    else if (noun == "torques" .and. same_word(trim(keyword), "TORQUE")) then
      words = card%words(min(2, size(card%words) + 1):)
    else if (noun == "torques" .and. (same_word(trim(keyword), "MOTOR") .or. &
      same_word(trim(keyword), "LOAD"))) then
      call append_value(card, "torque", words)
      call append_value(card, "stall", words)
    else if (noun == "torques" .and. same_word(trim(keyword), "SPRING")) then
      call append_value(card, "torque", words)
    else if (noun == "forces" .and. same_word(trim(keyword), "SPRING")) then
      call append_value(card, "force", words)
    else if (noun == "speeds" .and. same_word(trim(keyword), "SPEED")) then
      if (size(card%words) == 0) return
      if (number_length(card%words(size(card%words))%text) > 0) words = card%words
    else if (noun == "speeds" .and. same_word(trim(keyword), "MOTOR")) then
      call append_value(card, "noload", words)
    else if (noun == "speeds" .and. same_word(trim(keyword), "REPORT")) then
      if (size(card%words) == 0) return
      if (same_word(card%words(1)%text, "motion")) call append_value(card, "speed", words)
    end if
  end subroutine find_words

  !> Appends the value of a key, if the card has it.
  pure subroutine append_value(card, key, words)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    type(token_t), allocatable, intent(inout) :: words(:)

    type(token_t) :: word

    ! gfortran 12 leaks a function's result in an array constructor.
    word = value_of(card, key)
    if (word%line > 0) words = [words, word]
  end subroutine append_value

  !> Whether a word is a number other than 0 without a unit.
  pure function is_bare(word) result(is)
    type(token_t), intent(in) :: word
    logical :: is

    type(error_t), allocatable :: error
    real(wp) :: value

    is = .false.
    if (len(word%text) == 0 .or. number_length(word%text) /= len(word%text)) return
    call read_real(word%text, value, error)
    is = .not. allocated(error) .and. abs(value) > 0.0_wp
  end function is_bare

  !> `N*m`, as a deck writes what tables call `N.m`.
  pure function deck_name(name) result(text)
    character(len=*), intent(in) :: name
    character(len=len(name)) :: text

    integer :: i

    do i = 1, len(name)
      text(i:i) = merge("*", name(i:i), name(i:i) == ".")
    end do
  end function deck_name

end module unit_checks
