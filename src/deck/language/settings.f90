!> SET, VARY and `--set`: names that stand for values.
module settings
  use card_reader, only: check_form, has_key, read_name
  use card_table, only: pattern_of
  use cards, only: card_t
  use deck_source, only: append_source, line_count, source_from_text, source_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use errors, only: error_of_writing, error_t
  use expressions, only: find_names, is_expression, operand_t
  use name_index, only: find_name, name_index_t, new_name_index
  use spelling, only: nearest_word, suggestion
  use text, only: joined, same_word, string_t
  use tokens, only: is_name, split_words, token_t, token_texts
  use units, only: dimension_none, read_unit, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: setting_t, settings_t, read_settings, look_up_setting, warn_of_unused_settings, &
    find_references, written_value, options_path, no_name

  !> In place of a path: the lines of `--set` among those of the source.
  character(len=*), parameter :: options_path = "<command line>"

  !> In place of a name on a VARY card with a table: the deck does not take this column.
  character(len=*), parameter :: no_name = "-"

  !> A name and where its value comes from.
  type :: setting_t
    type(token_t) :: name              !! on its card
    type(token_t) :: value             !! of SET or `--set`, possibly a `$name` itself, or the first
                                       !! word of an expression; without a line if it cannot be read
    type(token_t), allocatable :: words(:) !! of an expression; not allocated: it is none
    integer, allocatable :: uses(:)    !! numbers of the settings whose `$name`s the value has; 0:
                                       !! unknown
    integer :: card = 0                !! number of its card
    integer :: column = 0              !! of the table on its VARY card, which gives its values; 0:
                                       !! this has none
    logical :: is_varied = .false.     !! by VARY
    logical :: varies = .false.        !! by VARY, or because something that it uses does
    logical :: is_overridden = .false. !! by `--set`
    logical :: is_used = .false.       !! a card or another setting uses it
    integer :: root = 0                !! number of the setting at the end of its chain of `$name`s,
                                       !! often itself; 0: it has no value, after an error
  end type setting_t

  type :: settings_t
    type(setting_t), allocatable :: list(:) !! (settings) in the order of the deck
    type(name_index_t) :: names             !! of the list
    type(unit_system_t) :: system           !! units of bare numbers
    integer, allocatable :: order(:)        !! numbers of the settings, each behind those it uses
    type(operand_t), allocatable :: operands(:) !! (settings) the values that do not vary; of others
                                            !! and after an error, without a line
  end type settings_t

contains

  !> Reads the SET cards and the names on VARY cards, then applies the command line, which
  !! overrides them. Their values are found by `find_fixed_values`.
  !!
  !! Errors: a card of the wrong form, an invalid name, a name given twice, an option that names no
  !! setting.
  pure subroutine read_settings(cards, options, source, diagnostics, settings)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(string_t), intent(in) :: options(:)          !! of the command line, each `name=value`
    type(source_t), intent(inout) :: source           !! the options are appended to it as places of
                                                      !! messages
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(settings_t), intent(out) :: settings         !! of all cards with a valid name

    integer :: i, count, first

    allocate (settings%list(most_settings(cards)))
    count = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "SET")) then
        call read_setting(cards(i), i, diagnostics, settings%list, count)
      else if (same_word(cards(i)%keyword%text, "VARY")) then
        call read_varied_names(cards(i), i, diagnostics, settings%list, count)
      end if
    end do
    settings%list = settings%list(:count)
    settings%names = new_name_index(token_texts(settings%list%name))
    do i = 1, count
      first = find_name(settings%names, settings%list(i)%name%text)
      if (first == i) cycle
      call add_error(diagnostics, settings%list(i)%name, "'"//settings%list(i)%name%text// &
        "' has a value already", settings%list(first)%name, "first defined here")
    end do
    call take_options(options, source, diagnostics, settings)
  end subroutine read_settings

  !> How many names the SET and VARY cards of a deck can have.
  pure function most_settings(cards) result(most)
    type(card_t), intent(in) :: cards(:)
    integer :: most

    integer :: i

    most = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "SET")) most = most + 1
      if (same_word(cards(i)%keyword%text, "VARY")) most = most + size(cards(i)%words)
    end do
  end function most_settings

  !> Reads `SET name value` or `SET name expression`.
  pure subroutine read_setting(card, number, diagnostics, list, count)
    type(card_t), intent(in) :: card
    integer, intent(in) :: number !! of the card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(setting_t), intent(inout) :: list(:)
    integer, intent(inout) :: count

    integer :: before
    logical :: fine

    call check_form(card, diagnostics, fine)
    if (size(card%words) == 0) return
    before = count
    call append_name(card%words(1), number, diagnostics, list, count)
    ! Its words are no value, if the card has an equals sign.
    if (count > before .and. fine .and. size(card%entries) == 0) call take_value(card%words(2:), &
      list(count))
  end subroutine read_setting

  !> Reads the name on `VARY name …`, or the names on `VARY name … table=`, where a dash leaves out
  !! a column. Their values are read once all names are known.
  pure subroutine read_varied_names(card, number, diagnostics, list, count)
    type(card_t), intent(in) :: card
    integer, intent(in) :: number !! of the card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(setting_t), intent(inout) :: list(:)
    integer, intent(inout) :: count

    integer :: before, k
    logical :: fine, has_table

    call check_form(card, diagnostics, fine)
    has_table = has_key(card, "table")
    if (size(card%words) == 1 .and. .not. has_table) call add_error(diagnostics, card%keyword, &
      "this card is too short; expected: "//pattern_of("VARY"), kind=error_of_writing)
    do k = 1, merge(size(card%words), min(size(card%words), 1), has_table)
      if (has_table .and. card%words(k)%text == no_name) cycle
      before = count
      call append_name(card%words(k), number, diagnostics, list, count)
      if (count == before) cycle
      list(count)%is_varied = .true.
      if (has_table) list(count)%column = k
    end do
  end subroutine read_varied_names

  !> Appends a setting without a value. Errors: its name is none; then it is left out.
  pure subroutine append_name(word, number, diagnostics, list, count)
    type(token_t), intent(in) :: word
    integer, intent(in) :: number !! of the card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(setting_t), intent(inout) :: list(:)
    integer, intent(inout) :: count

    call read_name(word, diagnostics)
    if (.not. is_name(word%text)) return
    count = count + 1
    list(count)%name = word
    list(count)%card = number
    list(count)%value = token_t("", 0, 0)
  end subroutine append_name

  !> Replaces values in the deck by those of the command line.
  pure subroutine take_options(options, source, diagnostics, settings)
    type(string_t), intent(in) :: options(:)
    type(source_t), intent(inout) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    type(settings_t), intent(inout) :: settings

    character(len=*), parameter :: option = "--set "
    type(token_t), allocatable :: words(:)
    character(len=:), allocatable :: lines
    integer :: i, number, first

    if (size(options) == 0) return
    first = line_count(source)
    lines = ""
    do i = 1, size(options)
      lines = lines//option//options(i)%text//achar(10)
    end do
    call append_source(source, source_from_text(options_path, lines), 0)
    do i = 1, size(options)
      ! The option, the name and the equals sign come before the value.
      words = split_words(option//options(i)%text, first + i)
      number = find_name(settings%names, words(2)%text)
      if (number == 0) then
        call add_error(diagnostics, words(2), source%path//" has no SET or VARY '"// &
          words(2)%text//"'"//suggestion(words(2)%text, settings%names%name))
        cycle
      end if
      call mark_as_used(settings, settings%list(number))
      settings%list(number)%is_varied = .false.
      settings%list(number)%is_overridden = .true.
      call take_value(words(4:), settings%list(number))
    end do
  end subroutine take_options

  !> Takes the words of a value: one, or an expression.
  pure subroutine take_value(words, setting)
    type(token_t), intent(in) :: words(:)
    type(setting_t), intent(inout) :: setting

    setting%value = words(1)
    if (allocated(setting%words)) deallocate (setting%words)
    if (is_expression(words)) setting%words = words
  end subroutine take_value

  !> The `$name`s in a value.
  pure subroutine find_references(setting, names)
    type(setting_t), intent(in) :: setting              !! of SET or VARY
    type(token_t), allocatable, intent(out) :: names(:) !! in their order

    if (allocated(setting%words)) then
      call find_names(setting%words, names)
    else if (index(setting%value%text, "$") == 1) then
      allocate (names(1))
      names(1) = setting%value
    else
      allocate (names(0))
    end if
  end subroutine find_references

  !> Marks what the deck's own value of an overridden setting uses: it counts as used.
  pure subroutine mark_as_used(settings, setting)
    type(settings_t), intent(inout) :: settings
    type(setting_t), intent(in) :: setting

    type(token_t), allocatable :: names(:)
    integer :: i, used

    call find_references(setting, names)
    do i = 1, size(names)
      used = find_name(settings%names, names(i)%text(2:))
      if (used > 0) settings%list(used)%is_used = .true.
    end do
  end subroutine mark_as_used

  !> The value of a setting as it is written.
  pure function written_value(setting) result(text)
    type(setting_t), intent(in) :: setting !! of SET or `--set`
    character(len=:), allocatable :: text

    text = setting%value%text
    if (allocated(setting%words)) text = joined(token_texts(setting%words), " ")
  end function written_value

  !> Finds the setting that a `$name` refers to, and marks it as used.
  !!
  !! Errors: `$` without a name or joined to other text, an unknown name.
  pure subroutine look_up_setting(word, settings, diagnostics, number)
    type(token_t), intent(in) :: word                 !! containing a `$`
    type(settings_t), intent(inout) :: settings       !! the setting found is marked as used
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(out) :: number                    !! of the setting; 0 after an error

    character(len=:), allocatable :: hint
    integer :: nearest

    number = 0
    if (word%text == "$") then
      call add_error(diagnostics, word, "the name of a SET or VARY card must follow this '$'")
      return
    else if (index(word%text, "$") /= 1 .or. .not. is_name(word%text(2:))) then
      call add_error(diagnostics, word, &
        "'"//word%text//"' joins something to a '$'; '$name' is a whole value: arithmetic "// &
        "stands on SET cards, as in SET half -0.5*$name")
      return
    end if
    number = find_name(settings%names, word%text(2:))
    if (number > 0) then
      settings%list(number)%is_used = .true.
      return
    end if
    hint = joined_unit(word%text(2:), settings)
    if (len(hint) == 0) hint = joined_minus(word%text(2:), settings)
    nearest = nearest_word(word%text(2:), settings%names%name)
    if (len(hint) == 0 .and. nearest > 0) hint = " (did you mean '$"// &
      settings%list(nearest)%name%text//"'?)"
    call add_error(diagnostics, word, "no SET or VARY card defines '"//word%text//"'"//hint)
  end subroutine look_up_setting

  !> The hint for a name that is a known one followed by a unit; else empty.
  pure function joined_unit(name, settings) result(hint)
    character(len=*), intent(in) :: name
    type(settings_t), intent(in) :: settings
    character(len=:), allocatable :: hint

    integer, parameter :: longest_unit = 32
    type(unit_t) :: measure
    type(error_t), allocatable :: error
    integer :: length

    hint = ""
    do length = len(name) - 1, max(1, len(name) - longest_unit), -1
      if (find_name(settings%names, name(:length)) == 0) cycle
      call read_unit(name(length + 1:), dimension_none, measure, error)
      if (allocated(error)) cycle
      hint = "; '$"//name(:length)// &
        "' is a whole value: write its unit in the value, as in SET "//name(:length)// &
        " 100"//name(length + 1:)
      return
    end do
  end function joined_unit

  !> The hint for a name that is a known one followed by a minus sign; else empty.
  pure function joined_minus(name, settings) result(hint)
    character(len=*), intent(in) :: name
    type(settings_t), intent(in) :: settings
    character(len=:), allocatable :: hint

    integer :: length

    hint = ""
    do length = len(name) - 1, 1, -1
      if (name(length + 1:length + 1) /= "-") cycle
      if (find_name(settings%names, name(:length)) == 0) cycle
      hint = "; names hold minus signs: a blank ends this one, '$"//name(:length)//" "// &
        name(length + 1:)//"'"
      return
    end do
  end function joined_minus

  !> Adds a warning for each SET that nothing uses, as a rule a mistake. After errors it adds none:
  !! a wrong `$name` may be the reason.
  pure subroutine warn_of_unused_settings(settings, diagnostics)
    type(settings_t), intent(in) :: settings          !! after all `$name`s have been looked up
    type(diagnostics_t), intent(inout) :: diagnostics !! warnings are added

    integer :: i

    if (has_errors(diagnostics)) return
    do i = 1, size(settings%list)
      if (settings%list(i)%is_used .or. settings%list(i)%is_varied) cycle
      if (find_name(settings%names, settings%list(i)%name%text) /= i) cycle
      call add_warning(diagnostics, settings%list(i)%name, "'"//settings%list(i)%name%text// &
        "' is set and not used")
    end do
  end subroutine warn_of_unused_settings

end module settings
