!> Substitution of values for `$name` on cards.
module substitution
  use card_reader, only: has_key
  use cards, only: card_t, entry_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_writing
  use expressions, only: operand_t, split_at_names
  use quantities, only: kind_text, product_text
  use settings, only: look_up_setting, settings_t
  use text, only: same_word
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use tokens, only: list_items, token_t
  use units, only: unit_system_t
  implicit none (type, external)
  private

  public :: slot_t, substitute, put_value

  !> The place of a `$name` with values from a VARY card.
  type :: slot_t
    integer :: card = 0    !! number of the card
    integer :: word = 0    !! number among the card's words; 0: it is in an entry
    integer :: entry = 0   !! number among the card's entries; 0: it is a word
    integer :: item = 0    !! number in the list of the entry; 0: it is the whole value
    integer :: setting = 0 !! number of its VARY among the settings
  end type slot_t

contains

  !> Replaces every `$name` by its value, and lists those whose value changes from variant to
  !! variant.
  !!
  !! Errors: a `$name` that cannot be looked up; it is marked, so that no further error is reported
  !! for it.
  pure subroutine substitute(cards, settings, diagnostics, slots)
    type(card_t), intent(inout) :: cards(:)            !! of the deck
    type(settings_t), intent(inout) :: settings        !! those in use are marked
    type(diagnostics_t), intent(inout) :: diagnostics  !! errors are added
    type(slot_t), allocatable, intent(out) :: slots(:) !! (slots) in the order of the cards

    integer :: i, k, count, first

    allocate (slots(8))
    count = 0
    do i = 1, size(cards)
      first = 1
      ! These cards take no `$name`, or theirs have been looked up already.
      if (same_word(cards(i)%keyword%text, "TITLE") .or. same_word(cards(i)%keyword%text, &
        "INCLUDE") .or. same_word(cards(i)%keyword%text, "SET")) cycle
      if (same_word(cards(i)%keyword%text, "VARY")) first = 2
      ! Before a table there are names only.
      if (first == 2 .and. has_key(cards(i), "table")) first = size(cards(i)%words) + 1
      do k = first, size(cards(i)%words)
        if (index(cards(i)%words(k)%text, "$") == 0) cycle
        call substitute_word(cards(i)%words(k), slot_t(card=i, word=k), settings, diagnostics, &
          slots, count)
      end do
      do k = 1, size(cards(i)%entries)
        if (index(cards(i)%entries(k)%value%text, "$") == 0) cycle
        call substitute_entry(cards(i)%entries(k), slot_t(card=i, entry=k), settings, diagnostics, &
          slots, count)
      end do
    end do
    slots = slots(:count)
  end subroutine substitute

  !> Replaces one `$name` by its value, or appends its slot.
  pure subroutine substitute_word(word, slot, settings, diagnostics, slots, count, in_formula)
    type(token_t), intent(inout) :: word
    type(slot_t), intent(in) :: slot !! where the word is
    type(settings_t), intent(inout) :: settings
    type(diagnostics_t), intent(inout) :: diagnostics
    type(slot_t), allocatable, intent(inout) :: slots(:)
    integer, intent(inout) :: count !! slots in use
    logical, intent(in), optional :: in_formula !! the word is a part of one

    integer :: number, root

    call look_up_setting(word, settings, diagnostics, number)
    root = 0
    if (number > 0) root = settings%list(number)%root
    if (root == 0) then
      word%set_line = -1
    else if (settings%list(root)%varies) then
      if (count == size(slots)) slots = [slots, slots]
      count = count + 1
      slots(count) = slot
      slots(count)%setting = root
    else
      call put_operand(word, settings%operands(root), settings%system, diagnostics, &
        in_formula)
    end if
  end subroutine substitute_word

  !> Gives a word the text of a value. One without a line is unknown, and so is the word then.
  !!
  !! Errors: its unit cannot stand on a card, and the word is no part of a formula.
  pure subroutine put_operand(word, operand, system, diagnostics, in_formula)
    type(token_t), intent(inout) :: word
    type(operand_t), intent(in) :: operand
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(in), optional :: in_formula !! the word is a part of one

    if (operand%word%line > 0) then
      call set_word(word, operand%word)
      if (len(word%text) > 0) return
      if (present(in_formula)) then
        if (in_formula) word%text = product_text(operand%quantity, system)
      end if
      if (len(word%text) > 0) return
      word%set_line = 0
      call add_error(diagnostics, word, "this is "//kind_text(operand%quantity, system)// &
        ", which no card takes", operand%word, "it is computed here", kind=error_of_writing)
    end if
    word%set_line = -1
  end subroutine put_operand

  !> Gives a word the text of a value, and the value's place as the place where it is set.
  pure subroutine set_word(word, value)
    type(token_t), intent(inout) :: word
    type(token_t), intent(in) :: value

    word%text = value%text
    word%set_line = value%line
    word%set_column = value%column
    word%is_computed = value%is_computed
  end subroutine set_word

  !> As `substitute_word`, for the value of a key, which may be a list or a formula.
  pure subroutine substitute_entry(entry, slot, settings, diagnostics, slots, count)
    type(entry_t), intent(inout) :: entry
    type(slot_t), intent(in) :: slot !! where the entry is
    type(settings_t), intent(inout) :: settings
    type(diagnostics_t), intent(inout) :: diagnostics
    type(slot_t), allocatable, intent(inout) :: slots(:)
    integer, intent(inout) :: count

    type(slot_t) :: place
    integer :: i

    if (is_formula(entry)) then
      entry%items = split_at_names(entry%value)
    else if (index(entry%value%text, ",") == 0) then
      call substitute_word(entry%value, slot, settings, diagnostics, slots, count)
      return
    else
      entry%items = list_items(entry%value)
    end if
    place = slot
    do i = 1, size(entry%items)
      if (index(entry%items(i)%text, "$") == 0) cycle
      place%item = i
      call substitute_word(entry%items(i), place, settings, diagnostics, slots, count, &
        is_formula(entry))
      if (entry%items(i)%set_line < 0) entry%value%set_line = -1
    end do
    call join_items(entry)
  end subroutine substitute_entry

  !> Whether the value of a key is arithmetic.
  pure function is_formula(entry) result(is)
    type(entry_t), intent(in) :: entry
    logical :: is

    is = same_word(entry%key%text, "formula")
  end function is_formula

  !> Joins the items of a list, or the parts of a formula, to its text.
  pure subroutine join_items(entry)
    type(entry_t), intent(inout) :: entry

    type(text_buffer_t) :: buffer
    integer :: i

    do i = 1, size(entry%items)
      if (is_formula(entry) .and. entry%items(i)%set_line /= 0) then
        call append_text(buffer, "("//entry%items(i)%text//")")
      else
        if (i > 1 .and. .not. is_formula(entry)) call append_text(buffer, ",")
        call append_text(buffer, entry%items(i)%text)
      end if
    end do
    entry%value%text = buffer_text(buffer)
  end subroutine join_items

  !> Puts the value of a variant into a slot. One without a line is unknown, so that no further
  !! error is reported for it.
  !!
  !! Errors: its unit cannot stand on a card.
  pure subroutine put_value(cards, slot, value, system, diagnostics)
    type(card_t), intent(inout) :: cards(:)           !! of the deck
    type(slot_t), intent(in) :: slot                  !! from `substitute`
    type(operand_t), intent(in) :: value              !! its text, and the place where it is set
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    associate (card => cards(slot%card))
      if (slot%word > 0) then
        call put_operand(card%words(slot%word), value, system, diagnostics)
        return
      end if
      associate (entry => card%entries(slot%entry))
        if (slot%item > 0) then
          call put_operand(entry%items(slot%item), value, system, diagnostics, is_formula(entry))
          call join_items(entry)
          entry%value%set_line = merge(-1, 0, any(entry%items%set_line < 0))
        else
          call put_operand(entry%value, value, system, diagnostics)
        end if
      end associate
    end associate
  end subroutine put_value

end module substitution
