!> Cards written back in a uniform layout, with the user's own words, for `echo.deck`.
module card_echo
  use card_reader, only: has_value
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use deck_source, only: line_origin, source_t
  use effect_cards, only: effect_words
  use numbers, only: number_length
  use report_kinds, only: kind_named, report_kind_t
  use response_cards, only: is_response_form
  use settings, only: no_name, setting_t, written_value
  use text, only: joined, lower_case, same_word, upper_case
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use tokens, only: token_texts
  use variants, only: deck_cards_t
  implicit none (type, external)
  private

  public :: echo_line_t, echo_cards

  type :: echo_line_t
    character(len=:), allocatable :: text   !! the card
    character(len=:), allocatable :: origin !! comment on its source; empty where the line cannot
                                            !! have one
  end type echo_line_t

contains

  !> The cards in the order of the deck. A `$name` stays as it is, with its SET or VARY card; a
  !! value from the command line becomes a SET card, so that the echo is complete in itself.
  pure function echo_cards(deck, cards, loads, source) result(lines)
    type(deck_cards_t), intent(in) :: deck        !! cards as written, and the values of their
                                                  !! `$name`s
    type(card_t), intent(in) :: cards(:)          !! (cards) of one variant, with values in place of
                                                  !! the `$name`s
    integer, intent(in) :: loads                  !! effects_static or effects_axial: the meaning of
                                                  !! EFFECTS, whether the deck gives it or not
    type(source_t), intent(in) :: source          !! of the cards
    type(echo_line_t) :: lines(size(cards))

    integer :: i

    do i = 1, size(cards)
      lines(i) = echo_card(deck%written(i), cards(i), deck%reports, source)
      if (same_word(cards(i)%keyword%text, "EFFECTS") .and. .not. is_response_form(cards(i))) &
        call complete_effects(cards(i), loads, lines(i))
    end do
    do i = 1, size(deck%settings%list)
      associate (setting => deck%settings%list(i))
        if (.not. setting%is_overridden) cycle
        if (setting%column > 0) then
          call override_column(setting, lines(setting%card))
        else
          lines(setting%card) = overridden_line(deck%written(setting%card), setting, source)
        end if
      end associate
    end do
  end function echo_cards

  !> Puts the SET card of a name on `VARY name … table=` before this card, on which a dash takes its
  !! place.
  pure subroutine override_column(setting, line)
    type(setting_t), intent(in) :: setting
    type(echo_line_t), intent(inout) :: line !! of the card

    integer :: first, last, i

    first = index(line%text, achar(10), back=.true.) + 1
    do i = 1, setting%column
      first = first + index(line%text(first:), " ")
    end do
    last = first - 2 + index(line%text(first:)//" ", " ")
    line%text = "SET "//setting%name%text//" "//written_value(setting)// &
      "   ! --set on the command line"//achar(10)//line%text(:first - 1)//no_name// &
      line%text(last + 1:)
  end subroutine override_column

  !> The SET card with the value from the command line; its comment gives what the deck has.
  pure function overridden_line(card, setting, source) result(line)
    type(card_t), intent(in) :: card
    type(setting_t), intent(in) :: setting
    type(source_t), intent(in) :: source
    type(echo_line_t) :: line

    line%text = "SET "//setting%name%text//" "//written_value(setting)
    line%origin = "--set on the command line; "//line_origin(source, card%keyword%line)//" has "
    if (same_word(card%keyword%text, "VARY")) then
      line%origin = line%origin//card_text(card)
    else
      line%origin = line%origin//joined(token_texts(card%words(2:)), " ")
    end if
  end function overridden_line

  !> A card with its defaults written out.
  pure function echo_card(written, card, reports, source) result(line)
    type(card_t), intent(in) :: written           !! as it stands in the deck
    type(card_t), intent(in) :: card              !! with values in place of its `$name`s
    type(report_kind_t), intent(in) :: reports(:) !! (kinds) all that exist
    type(source_t), intent(in) :: source          !! of the card
    type(echo_line_t) :: line

    type(card_kind_t) :: kind
    integer :: number

    line%text = card_text(written)
    line%origin = line_origin(source, card%keyword%line)
    if (same_word(card%keyword%text, "TITLE")) then
      line%origin = ""
    else if (.not. same_word(card%keyword%text, "REPORT")) then
      kind = kind_of_card(card%keyword%text)
      ! With `accuracy=` the program chooses the order: no default to write.
      if (.not. has_value(card, "accuracy")) call complete(card, trim(kind%entry), line)
    else
      number = kind_named(reports, lower_case(card%words(1)%text))
      call complete(card, trim(reports(number)%default), line)
    end if
  end function echo_card

  !> A card in the uniform layout: words first, single blanks, of a TABLE a row on each line.
  pure function card_text(card) result(text)
    type(card_t), intent(in) :: card
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i, row

    call append_text(buffer, upper_case(card%keyword%text))
    row = 0
    if (same_word(card%keyword%text, "TABLE")) row = column_count(card)
    do i = 1, size(card%words)
      if (row > 0 .and. mod(i - 2, max(row, 1)) == 0 .and. i > 2) call append_text(buffer, &
        " &"//achar(10)//"   ")
      call append_text(buffer, " "//card%words(i)%text)
    end do
    do i = 1, size(card%entries)
      call append_text(buffer, " "//card%entries(i)%key%text//"="//card%entries(i)%value%text)
    end do
    text = buffer_text(buffer)
  end function card_text

  !> Number of columns of a TABLE card: its words between the name and the first number.
  pure function column_count(card) result(columns)
    type(card_t), intent(in) :: card
    integer :: columns

    do columns = 0, size(card%words) - 2
      associate (text => card%words(columns + 2)%text)
        if (number_length(text) > 0 .or. index(text, "$") == 1) return
      end associate
    end do
    columns = 0
  end function column_count

  !> Writes out the word that an EFFECTS card leaves to speeds and loads.
  pure subroutine complete_effects(card, loads, line)
    type(card_t), intent(in) :: card
    integer, intent(in) :: loads
    type(echo_line_t), intent(inout) :: line

    integer :: i

    do i = 1, size(card%words)
      if (same_word(card%words(i)%text, "static") .or. same_word(card%words(i)%text, "axial")) &
        return
    end do
    call append_default(line, effect_words(loads, .false., .false.))
  end subroutine complete_effects

  !> Adds every default `key=value` whose key the card does not have.
  pure subroutine complete(card, entries, line)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: entries !! with a blank between two; empty: nothing is added
    type(echo_line_t), intent(inout) :: line

    integer :: first, next

    first = 1
    do while (first <= len(entries))
      next = first + index(entries(first:)//" ", " ")
      associate (entry => entries(first:next - 2))
        if (.not. has_value(card, entry(:index(entry, "=") - 1))) call append_default(line, entry)
      end associate
      first = next
    end do
  end subroutine complete

  !> Appends an entry that the card leaves out, and notes that it is the default.
  pure subroutine append_default(line, entry)
    type(echo_line_t), intent(inout) :: line
    character(len=*), intent(in) :: entry

    line%text = line%text//" "//entry
    line%origin = line%origin//"; "//entry//" is the default"
  end subroutine append_default

end module card_echo
