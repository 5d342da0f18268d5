! src/deck/ - from files to cards: lines, words with their places, cards, messages at words.
! In: the path of a deck. Out: a `card_t` for each card, a `token_t` for each word, messages in
! `diagnostics_t`. Begin with `read_cards` here, for one file, and `read_all_cards` in
! `includes.f90`, for a deck with all that it includes.
! Not here: what cards mean, SET and VARY (`src/deck/language`), values in SI (`src/model`).

!> Cards: a keyword, words and `key=value` entries.
module cards
  use card_table, only: card_kind_number, card_kinds
  use deck_source, only: first_line, last_line, source_line, source_t
  use diagnostics, only: add_error, diagnostics_t
  use list_words, only: split_at_commas
  use text, only: character_count, same_word
  use tokens, only: code_length, split_words, token_t
  implicit none (type, external)
  private

  public :: card_t, entry_t, read_cards

  type :: entry_t
    type(token_t) :: key                   !! before the equals sign
    type(token_t) :: value                 !! after it; empty text: missing, reported as an error
    type(token_t), allocatable :: items(:) !! (items) of a list that contains a `$name`, or parts of
                                           !! such a formula, each with its own place; else not
                                           !! allocated
  end type entry_t

  type :: card_t
    type(token_t) :: keyword                 !! first word of the card
    type(token_t), allocatable :: words(:)   !! (words) without keyword and entries
    type(entry_t), allocatable :: entries(:) !! (entries) `key=value`, in the order of the card
  end type card_t

contains

  !> Reads all cards of a deck or of a file that it includes.
  !!
  !! Errors: a card after END, END in an included file or not alone on its line, `&` within a line
  !! or without a next line, `=` without a key or a value, a quote that is not closed. The cards are
  !! read as far as possible.
  pure subroutine read_cards(source, cards, diagnostics, file)
    type(source_t), intent(in) :: source               !! the deck and the files included so far
    type(card_t), allocatable, intent(out) :: cards(:) !! (cards) in the order of the file, without
                                                       !! END
    type(diagnostics_t), intent(inout) :: diagnostics  !! errors are added
    integer, intent(in), optional :: file              !! number of an included file in the source;
                                                       !! absent: the deck itself

    type(card_t), allocatable :: found(:), larger(:)
    type(token_t), allocatable :: words(:)
    type(token_t) :: end_card
    integer :: line, last, count
    logical :: ended, told

    allocate (found(64))
    count = 0
    line = 1
    last = last_line(source, 1)
    if (present(file)) then
      line = first_line(source, file)
      last = last_line(source, file)
    end if
    ended = .false.
    told = .false.
    do while (line <= last)
      call read_logical_line(source, last, line, words, diagnostics)
      if (size(words) == 0) cycle
      ! Cards after END are read nevertheless; they would otherwise be reported as missing.
      if (ended .and. .not. told) then
        call add_error(diagnostics, words(1), "nothing may follow END", end_card, &
          "the deck ends here")
        told = .true.
      end if
      if (same_word(words(1)%text, "END")) then
        if (present(file)) then
          call add_error(diagnostics, words(1), &
            "END belongs in the deck, not in a file that it includes")
          cycle
        end if
        ended = .true.
        end_card = words(1)
        if (size(words) > 1) call add_error(diagnostics, words(2), &
          "END must stand alone on its line")
        cycle
      end if
      if (count == size(found)) then
        allocate (larger(2*count))
        larger(:count) = found
        call move_alloc(larger, found)
      end if
      count = count + 1
      call sort_words(words, found(count), diagnostics)
    end do
    cards = found(:count)
  end subroutine read_cards

  !> Reads the words of one card: a line and its continuation lines. `line` moves past them.
  pure subroutine read_logical_line(source, file_end, line, words, diagnostics)
    type(source_t), intent(in) :: source
    integer, intent(in) :: file_end !! number of the last line of the file
    integer, intent(inout) :: line
    type(token_t), allocatable, intent(out) :: words(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: text
    type(token_t), allocatable :: more(:)
    type(token_t) :: ampersand
    integer :: length, last, count, inside
    logical :: continued, found

    allocate (words(0))
    count = 0
    continued = .false.
    do while (line <= file_end)
      text = source_line(source, line)
      if (.not. continued) then
        call read_title_line(text, line, words, found)
        if (.not. found) call read_quoted_include(text, line, words, found, diagnostics)
        if (found) then
          line = line + 1
          return
        end if
      end if
      length = code_length(text)
      last = verify(text(:length), " "//achar(9), back=.true.)
      line = line + 1
      if (last == 0) then
        if (continued) cycle
        exit
      end if
      continued = text(last:last) == "&"
      if (continued) then
        ampersand = token_t("&", line - 1, character_count(text(:last)))
        last = last - 1
      end if
      inside = index(text(:last), "&")
      if (inside > 0) then
        call add_error(diagnostics, token_t("&", line - 1, character_count(text(:inside))), &
          "'&' continues a card only at the end of a line")
        text(inside:inside) = " "
      end if
      more = split_words(text(:last), line - 1)
      call append_words(words, count, more)
      if (.not. continued) exit
    end do
    words = words(:count)
    if (continued) call add_error(diagnostics, ampersand, "no line follows to continue this card")
  end subroutine read_logical_line

  !> Appends words; the array grows by doubling, since a card may continue over many lines.
  pure subroutine append_words(words, count, more)
    type(token_t), allocatable, intent(inout) :: words(:)
    integer, intent(inout) :: count !! words in use
    type(token_t), intent(in) :: more(:)

    type(token_t), allocatable :: larger(:)

    if (count + size(more) > size(words)) then
      allocate (larger(2*(count + size(more))))
      larger(:count) = words(:count)
      call move_alloc(larger, words)
    end if
    words(count + 1:count + size(more)) = more
    count = count + size(more)
  end subroutine append_words

  !> A TITLE takes the rest of its line unchanged, including comment characters.
  pure subroutine read_title_line(text, line, words, found)
    character(len=*), intent(in) :: text
    integer, intent(in) :: line
    type(token_t), allocatable, intent(inout) :: words(:)
    logical, intent(out) :: found

    type(token_t), allocatable :: first(:)
    type(token_t) :: title
    integer :: start

    found = .false.
    first = split_words(text(:min(len(text), verify(text//"x", " "//achar(9)) + 5)), line)
    if (size(first) == 0) return
    if (.not. same_word(first(1)%text, "TITLE")) return
    start = verify(text, " "//achar(9)) + 5
    if (start <= len(text)) then
      if (verify(text(start:start), " "//achar(9)) == 1) return
    end if
    found = .true.
    words = first(:1)
    if (verify(text(start:), " "//achar(9)) == 0) return
    start = start - 1 + verify(text(start:), " "//achar(9))
    title%text = text(start:verify(text, " "//achar(9), back=.true.))
    title%line = line
    title%column = 1 + character_count(text(:start - 1))
    words = [words, title]
  end subroutine read_title_line

  !> An INCLUDE whose file name is in quotes: the name may contain blanks and any other characters.
  !! The quotes remain in its word.
  pure subroutine read_quoted_include(text, line, words, found, diagnostics)
    character(len=*), intent(in) :: text
    integer, intent(in) :: line
    type(token_t), allocatable, intent(inout) :: words(:)
    logical, intent(out) :: found
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t), allocatable :: more(:)
    integer :: start, finish, i

    found = .false.
    start = verify(text, " "//achar(9))
    if (start == 0 .or. start + len("INCLUDE") > len(text)) return
    if (.not. same_word(text(start:start + len("INCLUDE") - 1), "INCLUDE")) return
    finish = start + len("INCLUDE")
    if (verify(text(finish:finish), " "//achar(9)) == 1) return
    finish = finish - 1 + verify(text(finish:)//"x", " "//achar(9))
    if (finish > len(text)) return
    if (scan(text(finish:finish), """'") == 0) return
    found = .true.
    deallocate (words)
    allocate (words(2))
    words(1) = token_t(text(start:start + len("INCLUDE") - 1), line, start)
    words(2) = token_t(text(finish:), line, 1 + character_count(text(:finish - 1)))
    i = index(text(finish + 1:), text(finish:finish))
    if (i == 0) then
      words(2)%set_line = -1
      call add_error(diagnostics, token_t(text(finish:finish), line, words(2)%column), &
        "this quote is not closed")
      return
    end if
    words(2)%text = text(finish:finish + i)
    more = split_words(text(finish + i + 1:finish + i + code_length(text(finish + i + 1:))), line)
    more%column = more%column + character_count(text(:finish + i))
    words = [words, more]
  end subroutine read_quoted_include

  !> Separates words from entries: the word before an equals sign is a key, the word after it its
  !! value.
  pure subroutine sort_words(words, card, diagnostics)
    type(token_t), intent(in) :: words(:)
    type(card_t), intent(out) :: card
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i, pass, plain, keyed
    logical :: is_key, is_title

    card%keyword = words(1)
    is_title = same_word(words(1)%text, "TITLE")
    do pass = 1, 2
      plain = 0
      keyed = 0
      i = 2
      do while (i <= size(words))
        is_key = .false.
        if (i < size(words) .and. .not. is_title) is_key = words(i + 1)%text == "=" .and. &
          words(i)%text /= "="
        if (is_key) then
          keyed = keyed + 1
          if (pass == 2) call read_entry(words, i, card%entries(keyed), diagnostics)
          i = i + merge(3, 2, has_value(words, i))
        else if (words(i)%text == "=" .and. .not. is_title) then
          if (pass == 1 .and. i == 2) then
            call add_error(diagnostics, words(i), "no '=' follows the keyword of a card")
          else if (pass == 1) then
            call add_error(diagnostics, words(i), "'=' needs a key before it")
          end if
          i = i + 1
        else
          plain = plain + 1
          if (pass == 2) card%words(plain) = words(i)
          i = i + 1
        end if
      end do
      if (pass == 1) allocate (card%words(plain), card%entries(keyed))
    end do
    call split_list(card, diagnostics)
  end subroutine sort_words

  !> Splits the words of a card that takes a list at their commas.
  pure subroutine split_list(card, diagnostics)
    type(card_t), intent(inout) :: card
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: kind, i
    logical :: any_comma

    any_comma = .false.
    do i = 1, size(card%words)
      any_comma = any_comma .or. index(card%words(i)%text, ",") > 0
    end do
    if (.not. any_comma) return
    kind = card_kind_number(card%keyword%text)
    if (kind == 0) return
    if (card_kinds(kind)%is_list) call split_at_commas(card%words, diagnostics)
  end subroutine split_list

  !> Whether a value follows the key at `words(i)` and its equals sign. A word followed by an equals
  !! sign is the next key.
  pure function has_value(words, i) result(has)
    type(token_t), intent(in) :: words(:)
    integer, intent(in) :: i
    logical :: has

    has = i + 2 <= size(words)
    if (.not. has) return
    has = words(i + 2)%text /= "="
    if (has .and. i + 3 <= size(words)) has = words(i + 3)%text /= "="
  end function has_value

  pure subroutine read_entry(words, i, entry, diagnostics)
    type(token_t), intent(in) :: words(:)
    integer, intent(in) :: i
    type(entry_t), intent(out) :: entry
    type(diagnostics_t), intent(inout) :: diagnostics

    entry%key = words(i)
    if (has_value(words, i)) then
      entry%value = words(i + 2)
    else
      entry%value = token_t("", words(i + 1)%line, words(i + 1)%column + 1)
      call add_error(diagnostics, words(i + 1), "'"//words(i)%text//"=' has no value")
    end if
  end subroutine read_entry

end module cards
