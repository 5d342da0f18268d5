!> Words of a deck with their places.
module tokens
  use errors, only: error_of_input, error_t, set_error
  use text, only: character_count, string_t
  implicit none (type, external)
  private

  public :: token_t, is_before, earlier, later, split_words, token_part, list_items, token_texts, &
    code_length, is_name, name_length, check_name

  !> A word and its place. In place of a `$name` it has the text of the value, the place of the
  !! `$name` and the place of the value.
  type :: token_t
    character(len=:), allocatable :: text !! as written, or the value of a `$name`
    integer :: line = 0                   !! in the source, from 1; 0: no place
    integer :: column = 0                 !! of its first character, from 1; a tab is one character
    integer :: set_line = 0               !! where the value of a `$name` is set; 0: this is no
                                          !! `$name`; negative: unknown, already reported as an
                                          !! error
    integer :: set_column = 0             !! of the first character of this value
    logical :: is_computed = .false.      !! the value does not stand there as it is: an expression
                                          !! begins there, or a range
  end type token_t

  character(len=*), parameter :: blanks = " "//achar(9)
  character(len=*), parameter :: name_characters = &
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.'"

contains

  !> Whether a word stands before another one; one without a place stands before all.
  pure function is_before(word, other) result(is)
    type(token_t), intent(in) :: word, other
    logical :: is

    is = word%line < other%line .or. (word%line == other%line .and. word%column < other%column)
  end function is_before

  !> The first of two words, or the only one that has a place.
  pure function earlier(word, other) result(first)
    type(token_t), intent(in) :: word, other
    type(token_t) :: first

    first = word
    if (word%line == 0 .or. (other%line > 0 .and. is_before(other, word))) first = other
  end function earlier

  !> The last of two words, or the only one that has a place.
  pure function later(word, other) result(last)
    type(token_t), intent(in) :: word, other
    type(token_t) :: last

    last = word
    if (is_before(word, other)) last = other
  end function later

  !> Length of a line without its comment [bytes].
  pure function code_length(line) result(length)
    character(len=*), intent(in) :: line !! of a deck
    integer :: length

    length = scan(line, "!#") - 1
    if (length < 0) length = len(line)
  end function code_length

  !> Splits a line at blanks and tabs; an equals sign is a word of its own.
  pure function split_words(line, number) result(words)
    character(len=*), intent(in) :: line !! without its comment
    integer, intent(in) :: number        !! of the line in the source
    type(token_t), allocatable :: words(:)

    integer :: pass, count, first, last, column

    do pass = 1, 2
      count = 0
      column = 0
      last = 0
      first = 1
      do
        ! The column of the new word is counted from the old one.
        if (last > 0) column = column - 1 + character_count(line(first:last))
        call next_word(line, first, last, column)
        if (first > len(line)) exit
        count = count + 1
        if (pass == 2) words(count) = token_t(line(first:last), number, column)
      end do
      if (pass == 1) allocate (words(count))
    end do
  end function split_words

  !> Moves from the word that ends at `last` to the next one; `column` counts characters, not bytes.
  pure subroutine next_word(line, first, last, column)
    character(len=*), intent(in) :: line
    integer, intent(out) :: first    !! byte at which the next word begins; past the line if there
                                     !! is none
    integer, intent(inout) :: last   !! byte at which it ends
    integer, intent(inout) :: column !! of the first character of the word

    integer :: i

    first = last + 1
    do while (first <= len(line))
      if (scan(line(first:first), blanks) == 0) exit
      first = first + 1
      column = column + 1
    end do
    column = column + 1
    last = first
    if (first > len(line)) return
    if (line(first:first) == "=") return
    do i = first + 1, len(line)
      if (scan(line(i:i), blanks//"=") == 1) exit
      last = i
    end do
  end subroutine next_word

  !> A part of a word. In the value of a `$name`, the part has its own place where the value is set,
  !! but the place of the whole `$name` where it is used.
  pure function token_part(word, first, last) result(part)
    type(token_t), intent(in) :: word  !! as written, or a value
    integer, intent(in) :: first, last !! byte of its text
    type(token_t) :: part

    part = part_behind(word, character_count(word%text(:first - 1)), first, last)
  end function token_part

  !> `token_part`, with the number of characters before it.
  pure function part_behind(word, before, first, last) result(part)
    type(token_t), intent(in) :: word
    integer, intent(in) :: before, first, last
    type(token_t) :: part

    part = token_t(word%text(first:last), word%line, word%column, word%set_line, word%set_column, &
      word%is_computed)
    if (word%is_computed) return
    if (word%set_line > 0) then
      part%set_column = word%set_column + before
    else if (word%set_line == 0) then
      part%column = word%column + before
    end if
  end function part_behind

  !> The items of a list: one word with commas between the items.
  pure function list_items(word) result(items)
    type(token_t), intent(in) :: word !! a list, or a single item
    type(token_t), allocatable :: items(:)

    integer :: i, first, last, before

    allocate (items(1 + count([(word%text(i:i) == ",", i=1, len(word%text))])))
    first = 1
    before = 0
    do i = 1, size(items)
      last = len(word%text)
      if (i < size(items)) last = first + index(word%text(first:), ",") - 2
      items(i) = part_behind(word, before, first, last)
      before = before + character_count(word%text(first:last)) + 1
      first = last + 2
    end do
  end function list_items

  !> The texts of words, without their places.
  pure function token_texts(words) result(texts)
    type(token_t), intent(in) :: words(:) !! (words)
    type(string_t) :: texts(size(words))

    integer :: i

    do i = 1, size(words)
      texts(i)%text = words(i)%text
    end do
  end function token_texts

  !> Whether a word is a valid name: letters, digits and `_ - . '`.
  pure function is_name(word)
    character(len=*), intent(in) :: word !! not empty
    logical :: is_name

    is_name = verify(word, name_characters) == 0
  end function is_name

  !> How many leading characters of a text may be those of a name.
  pure function name_length(text) result(length)
    character(len=*), intent(in) :: text
    integer :: length

    length = verify(text, name_characters) - 1
    if (length < 0) length = len(text)
  end function name_length

  !> Errors: a word is not a valid name.
  pure subroutine check_name(word, error)
    character(len=*), intent(in) :: word               !! not empty
    type(error_t), allocatable, intent(inout) :: error !! unchanged if it is valid

    if (.not. is_name(word)) call set_error(error, error_of_input, "'"//word// &
      "' is not a name (letters a to z, digits and _ - . ' make one)")
  end subroutine check_name

end module tokens
