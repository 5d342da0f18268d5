!> Values of SET and VARY: which names they use, in which order they follow from each other, and
!! what arithmetic gives.
module setting_values
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_t
  use expressions, only: evaluate, operand_t
  use name_index, only: find_name
  use quantities, only: quantity_text, read_number
  use settings, only: find_references, look_up_setting, settings_t
  use text, only: same_word
  use tokens, only: token_t
  use units, only: dimension_length, dimension_mass, dimension_time, read_unit, si_units, &
    unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: find_fixed_values, find_varying_values, mark_uses

contains

  !> Finds the values that do not vary.
  !!
  !! Errors: unknown `$name`s, values that refer to themselves, expressions that have no value.
  pure subroutine find_fixed_values(cards, diagnostics, settings)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(settings_t), intent(inout) :: settings       !! as read; those in use are marked

    type(operand_t), allocatable :: operands(:)
    integer :: i, number

    call find_uses(diagnostics, settings)
    call find_order(diagnostics, settings)
    settings%system = system_of(cards, settings)
    allocate (operands(size(settings%list)))
    do i = 1, size(settings%order)
      number = settings%order(i)
      call find_root(settings, number)
      if (settings%list(number)%root == 0 .or. settings%list(number)%varies) cycle
      call find_value(settings, number, diagnostics, operands)
      if (operands(number)%word%line == 0) settings%list(number)%root = 0
    end do
    call move_alloc(operands, settings%operands)
  end subroutine find_fixed_values

  !> Finds which settings each one uses. Errors: unknown `$name`s.
  pure subroutine find_uses(diagnostics, settings)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(settings_t), intent(inout) :: settings

    type(token_t), allocatable :: names(:)
    integer, allocatable :: uses(:)
    integer :: i, k

    do i = 1, size(settings%list)
      call find_references(settings%list(i), names)
      allocate (uses(size(names)), source=0)
      do k = 1, size(names)
        call look_up_setting(names(k), settings, diagnostics, uses(k))
      end do
      call move_alloc(uses, settings%list(i)%uses)
    end do
  end subroutine find_uses

  !> Puts the settings in an order in which each one follows those that it uses.
  !!
  !! Errors: settings that are defined by themselves; one of the uses on such a way becomes unknown.
  pure subroutine find_order(diagnostics, settings)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(settings_t), intent(inout) :: settings

    integer :: way(size(settings%list)), next(size(settings%list)), i, at, used, depth, count
    logical :: is_done(size(settings%list)), is_told(size(settings%list))

    allocate (settings%order(size(settings%list)))
    next = 0
    is_done = .false.
    is_told = .false.
    count = 0
    do i = 1, size(settings%list)
      depth = 0
      if (.not. is_done(i)) then
        depth = 1
        way(depth) = i
      end if
      ! A way from name to name; no recursion, since it may have thousands.
      do while (depth > 0)
        at = way(depth)
        next(at) = next(at) + 1
        if (next(at) > size(settings%list(at)%uses)) then
          depth = depth - 1
          count = count + 1
          settings%order(count) = at
          is_done(at) = .true.
          cycle
        end if
        used = settings%list(at)%uses(next(at))
        if (used == 0) cycle
        if (is_done(used)) cycle
        if (next(used) == 0) then
          depth = depth + 1
          way(depth) = used
          cycle
        end if
        if (.not. is_told(used)) call tell_of_loop(diagnostics, settings, next, &
          way(findloc(way(:depth), used, dim=1):depth))
        is_told(used) = .true.
        settings%list(at)%uses(next(at)) = 0
      end do
    end do

  end subroutine find_order

  !> Adds the error `'a' is defined by itself: $a -> $b -> $a`, at the name that leads on.
  pure subroutine tell_of_loop(diagnostics, settings, next, loop)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: next(:) !! (settings) number of the use that leads on
    integer, intent(in) :: loop(:) !! numbers of the settings, each of which uses the next one

    type(token_t), allocatable :: names(:)
    character(len=:), allocatable :: chain
    integer :: i

    chain = ""
    do i = 1, size(loop)
      chain = chain//"$"//settings%list(loop(i))%name%text//" -> "
    end do
    associate (first => settings%list(loop(1)))
      call find_references(first, names)
      call add_error(diagnostics, names(next(loop(1))), "'"//first%name%text// &
        "' is defined by itself: "//chain//"$"//first%name%text)
    end associate
  end subroutine tell_of_loop

  !> The units of bare numbers: those of the UNITS card, or SI where it is wrong.
  pure function system_of(cards, settings) result(system)
    type(card_t), intent(in) :: cards(:) !! of the deck
    type(settings_t), intent(in) :: settings
    type(unit_system_t) :: system

    integer :: i

    system = si_units()
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "UNITS")) cycle
      if (size(cards(i)%words) /= 3) return
      call read_base_unit(cards(i)%words(1), dimension_length, settings, system%length)
      call read_base_unit(cards(i)%words(2), dimension_mass, settings, system%mass)
      call read_base_unit(cards(i)%words(3), dimension_time, settings, system%time)
      return
    end do
  end function system_of

  !> A unit on the UNITS card, which may be a `$name`. One that is wrong is reported elsewhere.
  pure subroutine read_base_unit(word, dimension, settings, measure)
    type(token_t), intent(in) :: word
    integer, intent(in) :: dimension(4)
    type(settings_t), intent(in) :: settings
    type(unit_t), intent(inout) :: measure !! unchanged, if it cannot be read

    type(unit_t) :: found
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    integer :: i, number

    text = word%text
    do i = 1, size(settings%list)
      if (index(text, "$") /= 1) exit
      number = find_name(settings%names, text(2:))
      if (number == 0) return
      text = settings%list(number)%value%text
    end do
    call read_unit(text, dimension, found, error)
    if (allocated(error)) return
    if (all(found%dimension == dimension)) measure = found
  end subroutine read_base_unit

  !> Finds the setting that gives one its text, and whether it varies.
  pure subroutine find_root(settings, number)
    type(settings_t), intent(inout) :: settings !! those that this one uses are known
    integer, intent(in) :: number               !! of the setting

    integer :: k

    associate (setting => settings%list(number))
      setting%root = number
      setting%varies = setting%is_varied
      if (setting%value%line == 0 .and. .not. setting%is_varied) setting%root = 0
      do k = 1, size(setting%uses)
        if (setting%root == 0) exit
        if (setting%uses(k) == 0) then
          setting%root = 0
          exit
        end if
        associate (used => settings%list(setting%uses(k)))
          setting%varies = setting%varies .or. used%varies
          if (used%root == 0 .or. .not. allocated(setting%words)) setting%root = used%root
        end associate
      end do
    end associate
  end subroutine find_root

  !> Finds the value of one setting that is no VARY. Errors: those of an expression.
  pure subroutine find_value(settings, number, diagnostics, operands)
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: number                     !! of the setting
    type(diagnostics_t), intent(inout) :: diagnostics
    type(operand_t), intent(inout) :: operands(:)     !! (settings) those that this one uses are
                                                      !! known; without a line after an error

    type(operand_t), allocatable :: used(:)
    logical :: fine
    integer :: k

    associate (setting => settings%list(number))
      if (.not. allocated(setting%words)) then
        if (size(setting%uses) > 0) then
          operands(number) = operands(setting%uses(1))
        else
          call take_word(setting%value, settings%system, operands(number))
        end if
        return
      end if
      allocate (used(size(setting%uses)))
      fine = .true.
      do k = 1, size(used)
        used(k) = operands(setting%uses(k))
        fine = fine .and. used(k)%word%line > 0
      end do
      operands(number)%word = token_t("", 0, 0)
      ! What it uses has an error of its own.
      if (.not. fine) return
      call evaluate(setting%words, used, settings%system, diagnostics, operands(number)%quantity, &
        fine)
      operands(number)%is_number = fine
      if (.not. fine) return
      operands(number)%word = setting%value
      operands(number)%word%is_computed = .true.
      operands(number)%word%text = quantity_text(operands(number)%quantity, settings%system)
    end associate
  end subroutine find_value

  !> The value that a word gives.
  pure subroutine take_word(word, system, operand)
    type(token_t), intent(in) :: word
    type(unit_system_t), intent(in) :: system
    type(operand_t), intent(out) :: operand

    operand%word = word
    call read_number(word%text, system, operand%quantity, operand%is_number)
  end subroutine take_word

  !> Finds the values that vary, of one variant.
  !!
  !! Errors: those of expressions; such a setting has a word without a line, as one of a VARY has
  !! that is not given.
  pure subroutine find_varying_values(settings, numbers, words, diagnostics, operands)
    type(settings_t), intent(in) :: settings          !! with fixed values
    integer, intent(in) :: numbers(:)                 !! (given) numbers of VARYs among the settings
    type(token_t), intent(in) :: words(:)             !! (given) their values
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(operand_t), allocatable, intent(out) :: operands(:) !! (settings) the fixed ones, too

    integer :: i, k

    operands = settings%operands
    do k = 1, size(numbers)
      call take_word(words(k), settings%system, operands(numbers(k)))
    end do
    do i = 1, size(settings%order)
      associate (setting => settings%list(settings%order(i)))
        if (setting%varies .and. .not. setting%is_varied .and. setting%root > 0) &
          call find_value(settings, settings%order(i), diagnostics, operands)
      end associate
    end do
  end subroutine find_varying_values

  !> Marks the settings on which the values of some depend.
  pure subroutine mark_uses(settings, is_needed)
    type(settings_t), intent(in) :: settings !! with their uses
    logical, intent(inout) :: is_needed(:) !! (settings)

    integer :: i, k

    do i = size(settings%order), 1, -1
      associate (setting => settings%list(settings%order(i)))
        if (.not. is_needed(settings%order(i))) cycle
        do k = 1, size(setting%uses)
          if (setting%uses(k) > 0) is_needed(setting%uses(k)) = .true.
        end do
      end associate
    end do
  end subroutine mark_uses

end module setting_values
