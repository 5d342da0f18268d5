!> Tables of numbers in files of their own: `table=moves.dat` on a card stands for the TABLE card
!! with the rows of that file.
!!
!! Such a file has a line `units s deg`, the unit of each column, and then rows of numbers. As a
!! TABLE card its numbers go the way of all cards: every one has its place in its file, values may
!! be `$name`s, and `echo.deck` stands alone.
module table_files
  use cards, only: card_t
  use deck_source, only: append_source, file_of_line, first_line, last_line, path_from_deck, &
    read_file, source_line, source_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_t
  use text, only: plural, same_word
  use tokens, only: code_length, split_words, token_t
  implicit none (type, external)
  private

  public :: add_table_files

  !> Key of all cards that take a table.
  character(len=*), parameter :: key = "table"

contains

  !> Appends a TABLE card for every file that a card names by `table=`, once however often it is
  !! named. A name that is that of a TABLE card of the deck is no file.
  !!
  !! The path is relative to the file that the card is in; in the card and its TABLE it becomes that
  !! from the deck's folder. The lines of the files are appended to `source`. Errors: a `$name`, a
  !! file that cannot be read, one without its line of units, a row that is longer or shorter than
  !! this line.
  subroutine add_table_files(source, cards, diagnostics)
    type(source_t), intent(inout) :: source              !! the deck and the files that it includes
    type(card_t), allocatable, intent(inout) :: cards(:) !! (cards) of all of them
    type(diagnostics_t), intent(inout) :: diagnostics    !! errors are added

    integer :: i, k, written

    written = size(cards)
    do i = 1, written
      do k = 1, size(cards(i)%entries)
        if (.not. same_word(cards(i)%entries(k)%key%text, key)) cycle
        if (len(cards(i)%entries(k)%value%text) == 0) cycle
        if (has_table(cards(:written), cards(i)%entries(k)%value%text)) cycle
        call take_file(source, cards, i, k, written, diagnostics)
      end do
    end do
  end subroutine add_table_files

  !> Whether there is a TABLE card of a name, which is compared to the letter, as files are.
  pure function has_table(cards, name) result(has)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: name
    logical :: has

    integer :: i

    has = .true.
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "TABLE") .or. size(cards(i)%words) == 0) cycle
      if (cards(i)%words(1)%text == name) return
    end do
    has = .false.
  end function has_table

  !> Reads the file of one entry, unless it is read already.
  subroutine take_file(source, cards, card, entry, written, diagnostics)
    type(source_t), intent(inout) :: source
    type(card_t), allocatable, intent(inout) :: cards(:)
    integer, intent(in) :: card, entry !! numbers, of the card and in it
    integer, intent(in) :: written     !! cards that are not from tables
    type(diagnostics_t), intent(inout) :: diagnostics

    type(card_t), allocatable :: more(:)
    type(source_t) :: file
    type(token_t) :: word
    type(error_t), allocatable :: error
    character(len=:), allocatable :: path
    logical :: fine

    word = cards(card)%entries(entry)%value
    if (index(word%text, "$") == 1) then
      call add_error(diagnostics, word, &
        "files are read before values are set: '"//key//"=' takes no '"//word%text//"'")
      ! It is looked up no more.
      cards(card)%entries(entry)%value%set_line = -1
      return
    end if
    path = word%text
    associate (deck_file => source%files(file_of_line(source, word%line)))
      if (index(path, "/") /= 1) path = &
        deck_file%path(:index(deck_file%path, "/", back=.true.))//path
    end associate
    cards(card)%entries(entry)%value%text = path_from_deck(source, path)
    if (has_table(cards(written + 1:), cards(card)%entries(entry)%value%text)) return
    call read_file(path, file, error)
    if (allocated(error)) then
      call add_error(diagnostics, word, "the table '"//path//"' cannot be read: "//error%text)
      return
    end if
    call append_source(source, file, word%line)
    allocate (more(size(cards) + 1))
    more(:size(cards)) = cards
    call read_rows(source, size(source%files), cards(card)%entries(entry)%value, &
      more(size(more)), diagnostics, fine)
    if (fine) call move_alloc(more, cards)
  end subroutine take_file

  !> The TABLE card of a file: its name, the units of its columns, its numbers row by row.
  pure subroutine read_rows(source, file, name, card, diagnostics, fine)
    type(source_t), intent(in) :: source
    integer, intent(in) :: file       !! its number in the source
    type(token_t), intent(in) :: name !! word of the card that names it
    type(card_t), intent(out) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(out) :: fine

    type(token_t), allocatable :: words(:)
    character(len=:), allocatable :: text
    integer :: line, columns, count, first

    allocate (card%words(64), card%entries(0))
    columns = 0
    count = 0
    fine = .true.
    do line = first_line(source, file), last_line(source, file)
      text = source_line(source, line)
      words = split_words(text(:code_length(text)), line)
      if (size(words) == 0) cycle
      if (columns == 0) then
        fine = same_word(words(1)%text, "units") .and. size(words) > 1
        if (.not. fine) then
          call add_error(diagnostics, words(1), "a table begins with the units of its columns, "// &
            "such as: units s deg")
          return
        end if
        columns = size(words) - 1
        card%keyword = words(1)
        card%keyword%text = "TABLE"
        words(1)%text = name%text
      else if (size(words) /= columns) then
        ! The first word too many, or the last of a row that is too short.
        call add_error(diagnostics, words(min(columns + 1, size(words))), "this row has "// &
          plural(size(words), "number")//", and the table "//plural(columns, "column"), &
          card%keyword, "its units are here")
        fine = .false.
        return
      end if
      do while (count + size(words) > size(card%words))
        call enlarge(card%words)
      end do
      first = count + 1
      count = count + size(words)
      card%words(first:count) = words
    end do
    card%words = card%words(:count)
    fine = columns > 0
    if (fine) return
    call add_error(diagnostics, name, "the table '"//name%text//"' is empty")
  end subroutine read_rows

  !> Doubles an array.
  pure subroutine enlarge(words)
    type(token_t), allocatable, intent(inout) :: words(:)

    type(token_t), allocatable :: larger(:)

    allocate (larger(2*size(words)))
    larger(:size(words)) = words
    call move_alloc(larger, words)
  end subroutine enlarge

end module table_files
