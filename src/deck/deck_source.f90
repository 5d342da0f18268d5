!> The text of a deck, line by line, as the user wrote it.
module deck_source
  use, intrinsic :: iso_fortran_env, only: input_unit, iostat_end, iostat_eor
  use errors, only: error_t, set_error
  use file_system, only: is_directory
  use text, only: character_count, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: source_t, standard_input, read_source, source_from_text, line_count, source_line

  type :: source_t
    character(len=:), allocatable :: path !! as the user gave it
    character(len=:), allocatable :: text !! every line ends in a line feed
    integer, allocatable :: line_start(:) !! byte at which each line begins, and one past the end of the text
  end type source_t

  character(len=*), parameter :: standard_input = "<standard input>" !! in place of a path
  character(len=*), parameter :: line_feed = achar(10), carriage_return = achar(13), tab = achar(9)
  integer, parameter :: most_bytes = 500000000
  character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

contains

  !> Reads a whole deck; the path `-` is standard input.
  !!
  !! Errors (their message begins with the path): no such file, a folder, a file that cannot be read or is not text.
  subroutine read_source(path, source, error)
    character(len=*), intent(in) :: path
    type(source_t), intent(out) :: source
    type(error_t), allocatable, intent(out) :: error

    type(text_buffer_t) :: buffer
    integer :: unit, status
    character(len=256) :: message
    logical :: exists

    if (path == "-") then
      unit = input_unit
      message = ""
      call read_lines(unit, buffer, status, message)
      source = source_from_text(standard_input, buffer_text(buffer))
    else
      inquire (file=path, exist=exists)
      if (is_directory(path)) then
        call set_error(error, path//": error: this is a folder, not a deck")
        return
      else if (.not. exists) then
        call set_error(error, path//": error: no such file")
        return
      end if
      open (newunit=unit, file=path, status="old", action="read", access="sequential", form="formatted", &
        iostat=status, iomsg=message)
      if (status == 0) then
        call read_lines(unit, buffer, status, message)
        close (unit)
      end if
      source = source_from_text(path, buffer_text(buffer))
    end if
    if (status /= 0) then
      call set_error(error, path//": error: the deck cannot be read: "//trim(message))
      return
    end if
    call refuse_binary(source, error)
  end subroutine read_source

  !> Reads to the end of a file, lines of any length.
  subroutine read_lines(unit, buffer, status, message)
    integer, intent(in) :: unit
    type(text_buffer_t), intent(inout) :: buffer
    integer, intent(out) :: status !! 0, or what went wrong
    character(len=*), intent(inout) :: message

    character(len=8192) :: piece
    integer :: length
    logical :: in_line

    in_line = .false.
    do
      length = 0
      read (unit, "(a)", advance="no", size=length, iostat=status, iomsg=message) piece
      if (length > 0) call append_text(buffer, piece(:length))
      ! An endless device must not fill the memory: a NUL byte is no text, and nobody writes a deck of half a gigabyte.
      if (index(piece(:length), achar(0)) > 0) then
        call append_text(buffer, line_feed)
        status = 0
        return
      else if (buffer%length > most_bytes) then
        status = 1
        message = "it is larger than "//to_string(most_bytes)//" bytes"
        return
      end if
      in_line = in_line .or. length > 0
      if (status == iostat_eor) then
        call append_text(buffer, line_feed)
        in_line = .false.
      else if (status == iostat_end) then
        if (in_line) call append_text(buffer, line_feed)
        status = 0
        return
      else if (status /= 0) then
        return
      end if
    end do
  end subroutine read_lines

  !> A source from text already at hand: cuts it into lines, drops a byte order mark and carriage returns.
  pure function source_from_text(path, text) result(source)
    character(len=*), intent(in) :: path, text
    type(source_t) :: source

    character(len=:), allocatable :: kept
    integer :: i, lines, length
    logical :: has_mark

    allocate (character(len=len(text) + 1) :: kept)
    has_mark = index(text, byte_order_mark) == 1
    length = 0
    lines = 0
    do i = 1, len(text)
      if (i <= 3 .and. has_mark) cycle
      if (text(i:i) == carriage_return) then
        if (i == len(text)) cycle
        if (text(i + 1:i + 1) == line_feed) cycle
      end if
      length = length + 1
      kept(length:length) = text(i:i)
      if (text(i:i) == line_feed) lines = lines + 1
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
  end function source_from_text

  pure function line_count(source) result(count)
    type(source_t), intent(in) :: source
    integer :: count

    count = size(source%line_start) - 1
  end function line_count

  !> The text of a line, without its end.
  pure function source_line(source, number) result(line)
    type(source_t), intent(in) :: source
    integer, intent(in) :: number
    character(len=:), allocatable :: line

    line = source%text(source%line_start(number):source%line_start(number + 1) - 2)
  end function source_line

  !> Finds the first control character: no text has one.
  pure subroutine refuse_binary(source, error)
    type(source_t), intent(in) :: source
    type(error_t), allocatable, intent(inout) :: error

    integer :: i, line
    character(len=2) :: code

    do i = 1, len(source%text)
      if (iachar(source%text(i:i)) >= 32 .and. iachar(source%text(i:i)) /= 127) cycle
      if (source%text(i:i) == line_feed .or. source%text(i:i) == tab) cycle
      line = count(source%line_start <= i)
      write (code, "(z2.2)") iachar(source%text(i:i))
      call set_error(error, source%path//":"//to_string(line)//":"// &
        to_string(character_count(source%text(source%line_start(line):i)))// &
        ": error: byte 0x"//code//" is no part of a text; is this a deck?")
      return
    end do
  end subroutine refuse_binary

end module deck_source
