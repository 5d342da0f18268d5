!> Words of a deck that remember where they stand.
module tokens
  use errors, only: error_of_input, error_t, set_error
  use text, only: character_count, string_t
  implicit none (type, external)
  private

  public :: token_t, split_words, token_part, list_items, token_texts, code_length, is_name, &
    check_name

  !> A word. Where `$name` stands in the deck, it has the text that `$name` stands for, and knows
  !! both places.
  type :: token_t
    character(len=:), allocatable :: text
    integer :: line = 0       !! in the deck, from 1
    integer :: column = 0     !! of its first character, from 1; a tab is one character
    integer :: set_line = 0   !! where the text of a `$name` is set; 0: it stands here; negative:
                              !! unknown, which is told
    integer :: set_column = 0
  end type token_t

  character(len=*), parameter :: blanks = " "//achar(9)
  character(len=*), parameter :: name_characters = &
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.'"

contains

  !> How much of a line stands before its comment.
  pure function code_length(line) result(length)
    character(len=*), intent(in) :: line
    integer :: length

    length = scan(line, "!#") - 1
    if (length < 0) length = len(line)
  end function code_length

  !> Splits a line at blanks; an equals sign is a word of its own.
  pure function split_words(line, number) result(words)
    character(len=*), intent(in) :: line !! without its comment
    integer, intent(in) :: number        !! of the line in the deck
    type(token_t), allocatable :: words(:)

    integer :: pass, count, first, last, column

    do pass = 1, 2
      count = 0
      column = 0
      last = 0
      first = 1
      do
        ! The old word still counts for the column of the new one.
        if (last > 0) column = column - 1 + character_count(line(first:last))
        call next_word(line, first, last, column)
        if (first > len(line)) exit
        count = count + 1
        if (pass == 2) words(count) = token_t(line(first:last), number, column)
      end do
      if (pass == 1) allocate (words(count))
    end do
  end function split_words

  !> Moves on from the word that ends at `last` to the next one; `column` follows in characters, not
  !! in bytes.
  pure subroutine next_word(line, first, last, column)
    character(len=*), intent(in) :: line
    integer, intent(out) :: first     !! byte at which the next word begins; past the line if there
                                      !! is none
    integer, intent(inout) :: last    !! byte at which it ends
    integer, intent(inout) :: column  !! of the first character of the word

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

  !> Some characters of a word. What `$name` stands for has its parts where it is set, and its place
  !! where it is used.
  pure function token_part(word, first, last) result(part)
    type(token_t), intent(in) :: word
    integer, intent(in) :: first, last !! bytes of its text
    type(token_t) :: part

    part = word
    part%text = word%text(first:last)
    if (word%set_line > 0) then
      part%set_column = word%set_column + character_count(word%text(:first - 1))
    else if (word%set_line == 0) then
      part%column = word%column + character_count(word%text(:first - 1))
    end if
  end function token_part

  !> The items of a list that is one word, with commas between them.
  pure function list_items(word) result(items)
    type(token_t), intent(in) :: word
    type(token_t), allocatable :: items(:)

    integer :: i, first, length

    allocate (items(1 + count([(word%text(i:i) == ",", i=1, len(word%text))])))
    first = 1
    do i = 1, size(items)
      length = index(word%text(first:)//",", ",") - 1
      items(i) = token_part(word, first, first + length - 1)
      first = first + length + 1
    end do
  end function list_items

  !> The words without their places.
  pure function token_texts(words) result(texts)
    type(token_t), intent(in) :: words(:)
    type(string_t) :: texts(size(words))

    integer :: i

    do i = 1, size(words)
      texts(i)%text = words(i)%text
    end do
  end function token_texts

  !> Whether a word can be a name.
  pure function is_name(word)
    character(len=*), intent(in) :: word
    logical :: is_name

    is_name = verify(word, name_characters) == 0
  end function is_name

  !> Errors: a word cannot be a name.
  pure subroutine check_name(word, error)
    character(len=*), intent(in) :: word
    type(error_t), allocatable, intent(inout) :: error

    if (.not. is_name(word)) call set_error(error, error_of_input, "'"//word// &
      "' is not a name (letters, digits and _ - . ' make one)")
  end subroutine check_name

end module tokens
