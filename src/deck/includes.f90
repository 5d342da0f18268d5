!> INCLUDE: replaces the card by the cards of the file that it names.
module includes
  use card_table, only: pattern_of
  use cards, only: card_t, read_cards
  use deck_source, only: append_source, file_of_line, read_file, source_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_input, error_t, set_error
  use file_system, only: real_path
  use program_library, only: find_library_file
  use text, only: same_word, string_t, to_string
  implicit none (type, external)
  private

  public :: read_all_cards

  !> Far more than in decks written by hand. A file may be included many times, but not endlessly.
  integer, parameter :: most_levels = 50, most_files = 1000

contains

  !> Reads the cards of a deck, with the cards of included files in place of their INCLUDE cards.
  !!
  !! The lines of the files are appended to `source`, so that every word has its place. Errors:
  !! those of `read_cards`, an INCLUDE card of the wrong form, a file that cannot be read, files
  !! that include themselves, are nested too deep or are too many, UNITS in an included file. All
  !! cards that can be found are read.
  subroutine read_all_cards(source, cards, diagnostics)
    type(source_t), intent(inout) :: source            !! the deck; included files are appended
    type(card_t), allocatable, intent(out) :: cards(:) !! (cards) INCLUDE cards remain only where a
                                                       !! file cannot be included
    type(diagnostics_t), intent(inout) :: diagnostics  !! errors are added

    type(string_t) :: chain(0:most_levels)

    call read_cards(source, cards, diagnostics)
    if (.not. any_include(cards)) return
    chain(0)%text = real_path(source%path)
    call insert_files(source, chain, 0, cards, diagnostics)
  end subroutine read_all_cards

  pure function any_include(cards) result(any_is)
    type(card_t), intent(in) :: cards(:)
    logical :: any_is

    integer :: i

    any_is = .false.
    do i = 1, size(cards)
      any_is = any_is .or. same_word(cards(i)%keyword%text, "INCLUDE")
    end do
  end function any_include

  !> Replaces the INCLUDE cards of one file by the cards of their files.
  recursive subroutine insert_files(source, chain, level, cards, diagnostics)
    type(source_t), intent(inout) :: source
    type(string_t), intent(inout) :: chain(0:) !! (0:levels) absolute paths of the files being read,
                                               !! the deck first
    integer, intent(in) :: level               !! of the file with these cards; 0 is the deck
    type(card_t), allocatable, intent(inout) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    type(card_t), allocatable :: all(:), more(:)
    integer :: i, count

    allocate (all(size(cards)))
    count = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "INCLUDE")) then
        call read_included(source, chain, level, cards(i), more, diagnostics)
        call append_cards(all, count, more)
      else
        call append_cards(all, count, cards(i:i))
      end if
    end do
    cards = all(:count)
  end subroutine insert_files

  !> Appends cards; the array grows by doubling.
  pure subroutine append_cards(cards, count, more)
    type(card_t), allocatable, intent(inout) :: cards(:)
    integer, intent(inout) :: count !! cards in use
    type(card_t), intent(in) :: more(:)

    type(card_t), allocatable :: larger(:)

    if (count + size(more) > size(cards)) then
      allocate (larger(2*(count + size(more))))
      larger(:count) = cards(:count)
      call move_alloc(larger, cards)
    end if
    cards(count + 1:count + size(more)) = more
    count = count + size(more)
  end subroutine append_cards

  !> Reads the file that an INCLUDE card names. If that fails, the card remains, in place of the
  !! unknown cards.
  recursive subroutine read_included(source, chain, level, card, cards, diagnostics)
    type(source_t), intent(inout) :: source
    type(string_t), intent(inout) :: chain(0:)
    integer, intent(in) :: level
    type(card_t), intent(in) :: card
    type(card_t), allocatable, intent(out) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    type(source_t) :: more
    type(error_t), allocatable :: error
    character(len=:), allocatable :: path, name, library_name, elsewhere
    logical :: fine

    allocate (cards(1))
    cards(1) = card
    call read_path(source, card, path, name, fine, diagnostics)
    if (.not. fine) return
    call find_library_file(name, path, library_name, elsewhere)
    call refuse_loop(source, chain(:level), path, card%keyword%line, error)
    if (level == most_levels) call set_error(error, error_of_input, &
      "files include each other more than "//to_string(most_levels)//" levels deep")
    if (size(source%files) > most_files) call set_error(error, error_of_input, &
      "more than "//to_string(most_files)//" files are included")
    if (.not. allocated(error)) then
      call read_file(path, more, error)
      if (allocated(error)) then
        if (len(elsewhere) > 0) path = name
        error%text = "'"//path//place_of(error)//"' cannot be included: "//error%text//elsewhere
      end if
    end if
    if (allocated(error)) then
      call add_error(diagnostics, card%words(1), error%text)
      return
    end if
    call append_source(source, more, card%keyword%line, library_name)
    call read_cards(source, cards, diagnostics, size(source%files))
    call drop_units(cards, diagnostics)
    chain(level + 1)%text = real_path(path)
    call insert_files(source, chain, level + 1, cards, diagnostics)
  end subroutine read_included

  !> `:line:column` of an error in a file; empty if the error concerns the file as a whole.
  pure function place_of(error) result(numbers)
    type(error_t), intent(in) :: error
    character(len=:), allocatable :: numbers

    numbers = ""
    if (error%place%line > 0) numbers = ":"//to_string(error%place%line)//":"// &
      to_string(error%place%column)
  end function place_of

  !> The path on an INCLUDE card, which is relative to the file with the card.
  subroutine read_path(source, card, path, name, fine, diagnostics)
    type(source_t), intent(in) :: source
    type(card_t), intent(in) :: card
    character(len=:), allocatable, intent(out) :: path !! from the working folder, or absolute
    character(len=:), allocatable, intent(out) :: name !! as on the card, without quotes
    logical, intent(out) :: fine                       !! false: the card is wrong
    type(diagnostics_t), intent(inout) :: diagnostics

    fine = .false.
    if (size(card%entries) > 0) then
      call add_error(diagnostics, card%entries(1)%key, &
        "a file name with an equals sign needs quotes; expected: "//pattern_of("INCLUDE"))
      return
    else if (size(card%words) == 0) then
      call add_error(diagnostics, card%keyword, "this card is too short; expected: "// &
        pattern_of("INCLUDE"))
      return
    else if (size(card%words) > 1) then
      call add_error(diagnostics, card%words(2), "unexpected '"//card%words(2)%text// &
        "'; expected: "//pattern_of("INCLUDE")//" (a name with blanks needs quotes)")
      return
    end if
    name = card%words(1)%text
    if (card%words(1)%set_line < 0) return
    if (index(name, "$") == 1) then
      call add_error(diagnostics, card%words(1), &
        "files are included before values are set: INCLUDE takes no '"//name//"'")
      return
    end if
    if (scan(name(1:1), """'") == 1) name = name(2:len(name) - 1)
    if (len_trim(name) == 0) then
      call add_error(diagnostics, card%words(1), "a file name is missing here")
      return
    end if
    fine = .true.
    path = name
    associate (file => source%files(file_of_line(source, card%keyword%line)))
      if (index(name, "/") /= 1) path = file%path(:index(file%path, "/", back=.true.))//name
    end associate
    ! This is a file named `-`, not standard input.
    if (path == "-") path = "./-"
  end subroutine read_path

  !> Errors: the file is already being read, so it would include itself.
  subroutine refuse_loop(source, chain, path, line, error)
    type(source_t), intent(in) :: source
    type(string_t), intent(in) :: chain(0:)
    character(len=*), intent(in) :: path
    integer, intent(in) :: line !! of the INCLUDE card
    type(error_t), allocatable, intent(out) :: error

    character(len=:), allocatable :: absolute, way
    integer :: level, above, at

    absolute = real_path(path)
    if (len(absolute) == 0) return
    do level = ubound(chain, 1), 0, -1
      if (chain(level)%text /= absolute) cycle
      way = path
      at = line
      do above = ubound(chain, 1), level, -1
        associate (file => source%files(file_of_line(source, at)))
          way = file%path//" -> "//way
          at = file%include_line
        end associate
      end do
      call set_error(error, error_of_input, "this file includes itself: "//way)
      return
    end do
  end subroutine refuse_loop

  !> Removes UNITS cards from an included file. UNITS belongs to the deck: an included file cannot
  !! know the deck's units and must not change them.
  pure subroutine drop_units(cards, diagnostics)
    type(card_t), allocatable, intent(inout) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    type(card_t), allocatable :: kept(:)
    integer :: i, count

    count = 0
    allocate (kept(size(cards)))
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "UNITS")) then
        call add_error(diagnostics, cards(i)%keyword, &
          "UNITS belongs in the deck, not in a file that it includes")
      else
        call append_cards(kept, count, cards(i:i))
      end if
    end do
    if (count < size(cards)) cards = kept(:count)
  end subroutine drop_units

end module includes
