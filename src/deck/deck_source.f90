!> The text of a deck and of the files it includes, line by line, as the user wrote it.
!!
!! Lines are numbered continuously through all files: first those of the deck, then those of each
!! file in the order of reading. A line number is thus a unique place, and only messages need to
!! look up the file.
module deck_source
  use encodings, only: is_utf8, utf8_of
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: is_directory, read_standard_input, read_text
  use text, only: character_count, to_string
  implicit none (type, external)
  private

  public :: source_t, source_file_t, standard_input, read_source, read_file, source_from_text, &
    append_source, line_count
  public :: source_line, file_of_line, first_line, last_line, line_place, line_origin, &
    path_from_deck

  !> One file of a source.
  type :: source_file_t
    character(len=:), allocatable :: path !! as given by the user; of an included file, from the
                                          !! working folder
    integer :: first_line = 1             !! number of its first line in the source
    integer :: include_line = 0           !! line of the INCLUDE card that names it; 0: none
    character(len=:), allocatable :: library_name !! of a file of the program's library, as INCLUDE
                                                  !! names it; else not allocated
  end type source_file_t

  type :: source_t
    character(len=:), allocatable :: path        !! of the deck, as given by the user
    character(len=:), allocatable :: text        !! every line ends with a line feed
    integer, allocatable :: line_start(:)        !! (lines + 1) byte at which each line begins, and
                                                 !! one past the end of the text
    type(source_file_t), allocatable :: files(:) !! (files) the deck first
  end type source_t

  character(len=*), parameter :: standard_input = "<standard input>" !! in place of a path
  character(len=*), parameter :: line_feed = achar(10), carriage_return = achar(13), tab = achar(9)
  character(len=*), parameter :: no_break_space = char(194)//char(160)
  !> At the beginning of a file in UTF-16, the Unicode of some editors.
  character(len=2), parameter :: marks_of_utf16(2) = [char(255)//char(254), char(254)//char(255)]
  character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

contains

  !> Reads a whole deck; the path `-` is standard input.
  !!
  !! Errors: no such file, a folder, a file that cannot be read or is not text.
  subroutine read_source(path, source, error)
    character(len=*), intent(in) :: path             !! `-` for standard input
    type(source_t), intent(out) :: source            !! the deck alone; not for use after an error
    type(error_t), allocatable, intent(out) :: error !! of the kind `error_of_files`

    character(len=:), allocatable :: text, reason

    if (path /= "-") then
      call read_file(path, source, error)
      return
    end if
    call read_standard_input(text, reason)
    if (reason == "" .and. text == "") reason = "there is nothing on it; expected a deck"
    call take_text(standard_input, text, reason, source, error)
  end subroutine read_source

  !> Reads a file.
  !!
  !! Errors: as for `read_source`.
  subroutine read_file(path, source, error)
    character(len=*), intent(in) :: path             !! of the file
    type(source_t), intent(out) :: source            !! this file alone; not for use after an error
    type(error_t), allocatable, intent(out) :: error !! of the kind `error_of_files`

    character(len=:), allocatable :: text, reason

    if (is_directory(path)) then
      text = ""
      reason = "this is a folder, not a deck"
    else
      call read_text(path, text, reason)
    end if
    call take_text(path, text, reason, source, error)
  end subroutine read_file

  !> Bytes that are not UTF-8 are taken for Windows-1252, in which older editors write umlauts.
  subroutine take_text(path, text, reason, source, error)
    character(len=*), intent(in) :: path
    character(len=*), intent(in) :: text
    character(len=*), intent(in) :: reason !! why it is not whole; empty if it is
    type(source_t), intent(out) :: source
    type(error_t), allocatable, intent(out) :: error

    if (reason == "") then
      source = source_from_text(path, text)
      call find_binary(source, error)
      if (allocated(error) .or. is_utf8(text)) return
      source = source_from_text(path, utf8_of(text))
    else
      call set_error(error, error_of_files, reason, path)
    end if
  end subroutine take_text

  !> A source from a text in memory: splits it into lines, which end with a line feed, a carriage
  !! return or both, and drops a byte order mark. No-break spaces, which look like blanks, become
  !! blanks.
  pure function source_from_text(path, text) result(source)
    character(len=*), intent(in) :: path !! for messages
    character(len=*), intent(in) :: text !! the last line may lack its line feed
    type(source_t) :: source

    character(len=:), allocatable :: kept
    character(len=1) :: byte
    integer :: i, lines, length
    logical :: has_mark

    allocate (character(len=len(text) + 1) :: kept)
    has_mark = index(text, byte_order_mark) == 1
    length = 0
    lines = 0
    do i = 1, len(text)
      if (i <= 3 .and. has_mark) cycle
      byte = text(i:i)
      if (byte == carriage_return) then
        if (i == len(text)) cycle
        if (text(i + 1:i + 1) == line_feed) cycle
        byte = line_feed
      end if
      length = length + 1
      kept(length:length) = byte
      if (length > 1) then
        if (kept(length - 1:length) == no_break_space) then
          length = length - 1
          kept(length:length) = " "
        end if
      end if
      if (byte == line_feed) lines = lines + 1
    end do
    if (length > 0) then
      if (kept(length:length) /= line_feed) then
        length = length + 1
        kept(length:length) = line_feed
        lines = lines + 1
      end if
    end if

    source%path = path
    source%text = kept(:length)
    allocate (source%line_start(lines + 1))
    source%line_start(1) = 1
    lines = 1
    do i = 1, length
      if (kept(i:i) /= line_feed) cycle
      lines = lines + 1
      source%line_start(lines) = i + 1
    end do
    allocate (source%files(1))
    source%files(1)%path = path
  end function source_from_text

  !> Appends the lines of another file.
  pure subroutine append_source(source, more, include_line, library_name)
    type(source_t), intent(inout) :: source !! the deck and the files included so far
    type(source_t), intent(in) :: more      !! one file
    integer, intent(in) :: include_line     !! of the INCLUDE card that names it; 0: none
    character(len=*), intent(in), optional :: library_name !! of a file of the program's library, as
                                                           !! INCLUDE names it; empty: it is none

    type(source_file_t), allocatable :: files(:)
    integer :: count

    count = size(source%files)
    allocate (files(count + 1))
    files(:count) = source%files
    files(count + 1)%path = more%path
    files(count + 1)%first_line = line_count(source) + 1
    files(count + 1)%include_line = include_line
    if (present(library_name)) then
      if (len(library_name) > 0) files(count + 1)%library_name = library_name
    end if
    call move_alloc(files, source%files)
    source%line_start = [source%line_start(:line_count(source)), len(source%text) + more%line_start]
    source%text = source%text//more%text
  end subroutine append_source

  !> Number of all lines, including those of included files.
  pure function line_count(source) result(count)
    type(source_t), intent(in) :: source !! the deck and its files
    integer :: count

    count = size(source%line_start) - 1
  end function line_count

  !> The text of a line, without its line feed.
  pure function source_line(source, number) result(line)
    type(source_t), intent(in) :: source !! the deck and its files
    integer, intent(in) :: number        !! of the line, from 1
    character(len=:), allocatable :: line

    line = source%text(source%line_start(number):source%line_start(number + 1) - 2)
  end function source_line

  !> Number of the file that contains a line; 1 is the deck.
  pure function file_of_line(source, line) result(file)
    type(source_t), intent(in) :: source !! the deck and its files
    integer, intent(in) :: line          !! from 1
    integer :: file

    do file = size(source%files), 2, -1
      if (source%files(file)%first_line <= line) return
    end do
    file = 1
  end function file_of_line

  !> Number of the first line of a file.
  pure function first_line(source, file) result(line)
    type(source_t), intent(in) :: source !! the deck and its files
    integer, intent(in) :: file          !! from 1, the deck
    integer :: line

    line = source%files(file)%first_line
  end function first_line

  !> Number of the last line of a file; of an empty file, one less than that of its first.
  pure function last_line(source, file) result(line)
    type(source_t), intent(in) :: source !! the deck and its files
    integer, intent(in) :: file          !! from 1, the deck
    integer :: line

    line = line_count(source)
    if (file < size(source%files)) line = source%files(file + 1)%first_line - 1
  end function last_line

  !> `path:line` with the line's number in its own file.
  pure function line_place(source, line) result(place)
    type(source_t), intent(in) :: source !! the deck and its files
    integer, intent(in) :: line          !! number in the source
    character(len=:), allocatable :: place

    associate (file => source%files(file_of_line(source, line)))
      place = file%path//":"//to_string(line - file%first_line + 1)
    end associate
  end function line_place

  !> The place of a line as seen from the deck: `line 7`, or `parts/steel.deck:7` in a file that it
  !! includes. It does not say where the program and its library are.
  pure function line_origin(source, line) result(origin)
    type(source_t), intent(in) :: source !! the deck and its files
    integer, intent(in) :: line          !! number in the source
    character(len=:), allocatable :: origin

    integer :: number

    number = file_of_line(source, line)
    if (number == 1) then
      origin = "line "//to_string(line)
    else if (allocated(source%files(number)%library_name)) then
      origin = source%files(number)%library_name//":"// &
        to_string(line - source%files(number)%first_line + 1)
    else
      origin = path_from_deck(source, line_place(source, line))
    end if
  end function line_origin

  !> A path relative to the folder of the deck, if it lies within it; else unchanged.
  pure function path_from_deck(source, path) result(seen)
    type(source_t), intent(in) :: source !! whose first file is the deck
    character(len=*), intent(in) :: path !! from the working folder, or absolute
    character(len=:), allocatable :: seen

    integer :: folder

    seen = path
    folder = index(source%path, "/", back=.true.)
    if (index(path, source%path(:folder)) == 1) seen = path(folder + 1:)
  end function path_from_deck

  !> Errors: the file contains a control character, so it is no text; the first one is reported.
  pure subroutine find_binary(source, error)
    type(source_t), intent(in) :: source
    type(error_t), allocatable, intent(out) :: error

    integer :: i, line
    character(len=2) :: code

    if (len(source%text) > 1) then
      if (any(marks_of_utf16 == source%text(:2))) then
        call set_error(error, error_of_files, "this file is in UTF-16; save it as UTF-8", &
          source%path)
        return
      end if
    end if
    do i = 1, len(source%text)
      if (iachar(source%text(i:i)) >= 32 .and. iachar(source%text(i:i)) /= 127) cycle
      if (source%text(i:i) == line_feed .or. source%text(i:i) == tab) cycle
      line = count(source%line_start <= i)
      write (code, "(z2.2)") iachar(source%text(i:i))
      call set_error(error, error_of_files, &
        "byte 0x"//code//" does not belong in a text; is this a deck?", source%path, line, &
        character_count(source%text(source%line_start(line):i)))
      return
    end do
  end subroutine find_binary

end module deck_source
