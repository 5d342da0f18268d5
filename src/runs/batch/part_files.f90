!> The files of a study's parts: which there are, whether they belong together, what they hold.
module part_files
  use errors, only: error_of_files, error_of_input, error_t, set_error
  use file_system, only: file_exists, find_matching_files, joined_path
  use study_parts, only: first_variant, last_variant, part_beginning, part_name, part_of_name, &
    part_t
  use task_journal, only: add_journal_file, begun, has_task, journal_t, new_journal, read_title
  use text, only: append_string, joined, plural, string_t, to_string
  implicit none (type, external)
  private

  public :: refuse_part, find_parts, read_parts

  !> Missing parts for which a message has commands.
  integer, parameter :: most_commands = 3

  !> Lines of a title before the deck: version, compiler, form of the bytes.
  integer, parameter :: lines_of_program = 3

contains

  !> Errors: a deck has no parts, or not so many.
  pure subroutine refuse_part(deck, variants, varies, part, error)
    character(len=*), intent(in) :: deck !! its path
    integer, intent(in) :: variants      !! number
    logical, intent(in) :: varies        !! whether the deck has a VARY card that is in use
    type(part_t), intent(in) :: part     !! to be computed; its count is 0: to be joined
    type(error_t), allocatable, intent(inout) :: error

    if (.not. varies) then
      call set_error(error, error_of_input, "a deck without VARY has no parts", deck)
    else if (part%count > variants) then
      call set_error(error, error_of_input, "there are "//plural(part%count, "part")// &
        " and only "//plural(variants, "variant"), deck)
    end if
  end subroutine refuse_part

  !> Finds the parts of a study. Errors: there are none, some are missing, there are those of
  !! several divisions, one is of another study.
  subroutine find_parts(folder, base, deck, title, variants, count, error)
    character(len=*), intent(in) :: folder !! with the parts
    character(len=*), intent(in) :: base   !! name of the deck
    character(len=*), intent(in) :: deck   !! its path
    character(len=*), intent(in) :: title  !! of journals of this study
    integer, intent(in) :: variants        !! number
    integer, intent(out) :: count          !! of parts
    type(error_t), allocatable, intent(out) :: error

    type(string_t), allocatable :: names(:)
    integer, allocatable :: counts(:)
    type(part_t) :: part
    integer :: i

    count = 0
    call find_matching_files(folder, part_beginning(base), names)
    allocate (counts(0))
    do i = 1, size(names)
      part = part_of_name(base, names(i)%text)
      if (part%count > 0) counts = [counts, part%count]
    end do
    if (size(counts) == 0) then
      call set_error(error, error_of_input, "there is no part of it in "//folder// &
        "; flexmech --part 1/16 "//deck//" computes the first of 16", deck)
      return
    end if
    count = counts(1)
    if (any(counts /= count)) then
      call refuse_mixture(folder, base, deck, counts, error)
    else if (count > variants) then
      call refuse_part(deck, variants, .true., part_t(1, count), error)
    else if (size(counts) < count) then
      call refuse_gaps(folder, base, deck, count, error)
    end if
    do i = 1, count
      if (allocated(error)) return
      call compare_titles(joined_path(folder, part_name(base, part_t(i, count))), deck, title, &
        error)
    end do
  end subroutine find_parts

  !> Errors: the title of a part is not that of the study.
  subroutine compare_titles(path, deck, title, error)
    character(len=*), intent(in) :: path  !! of the part
    character(len=*), intent(in) :: deck  !! path of the deck
    character(len=*), intent(in) :: title !! of the study
    type(error_t), allocatable, intent(inout) :: error

    character(len=:), allocatable :: found
    integer :: of_program

    call read_title(path, found)
    if (len(found) == len(title) .and. found == title) return
    of_program = end_of_program(title)
    if (end_of_program(found) == 0) then
      call set_error(error, error_of_files, "this is no part of a study, or its start is damaged", &
        path)
    else if (found(:end_of_program(found)) /= title(:of_program)) then
      call set_error(error, error_of_files, "this part was computed by another version of the "// &
        "program: "//first_line(found)//" built by "//first_line(found(len(first_line(found)) &
        + 2:))//", this is "//first_line(title)//" built by "// &
        first_line(title(len(first_line(title)) + 2:)), path)
    else
      call set_error(error, error_of_files, "this part is of another deck than "//deck// &
        ", or of other values of --set", path)
    end if
  end subroutine compare_titles

  !> Place of the last character that is about the program, not the deck; 0: there is no such text.
  pure function end_of_program(title) result(last)
    character(len=*), intent(in) :: title
    integer :: last

    integer :: i, length

    last = 0
    do i = 1, lines_of_program
      length = index(title(last + 1:), achar(10))
      if (length == 0) last = 0
      if (length == 0) return
      last = last + length
    end do
  end function end_of_program

  pure function first_line(text) result(line)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: line

    line = text(:index(text//achar(10), achar(10)) - 1)
  end function first_line

  !> Says which files are in the way where there are parts of several divisions.
  subroutine refuse_mixture(folder, base, deck, counts, error)
    character(len=*), intent(in) :: folder, base, deck
    integer, intent(in) :: counts(:) !! (files) into how many parts the study was divided
    type(error_t), allocatable, intent(inout) :: error

    type(string_t), allocatable :: list(:)
    integer :: i, complete, sets

    complete = 0
    sets = 0
    allocate (list(0))
    do i = 1, size(counts)
      if (any(counts(:i - 1) == counts(i))) cycle
      call append_string(list, to_string(count(counts == counts(i)))//" of "//to_string(counts(i)))
      if (count(counts == counts(i)) < counts(i)) cycle
      complete = counts(i)
      sets = sets + 1
    end do
    if (sets == 1) then
      call set_error(error, error_of_input, "beside all "//plural(complete, "part")// &
        " of one division there are others: remove "// &
        other_names(folder, base, complete)//" from "//folder, deck)
    else
      call set_error(error, error_of_input, "there are parts of several divisions in "//folder// &
        ", "//joined(list)//": remove those that are not to be joined", deck)
    end if
  end subroutine refuse_mixture

  !> The names of the parts of other divisions.
  function other_names(folder, base, complete) result(text)
    character(len=*), intent(in) :: folder, base
    integer, intent(in) :: complete !! number of parts of the division that is complete
    character(len=:), allocatable :: text

    type(string_t), allocatable :: names(:)
    type(part_t) :: part
    integer :: i, more

    call find_matching_files(folder, part_beginning(base), names)
    text = ""
    more = -most_commands
    do i = 1, size(names)
      part = part_of_name(base, names(i)%text)
      if (part%count == 0 .or. part%count == complete) cycle
      more = more + 1
      if (more <= 0) text = text//", "//names(i)%text
    end do
    text = text(3:)
    if (more > 0) text = text//" and "//to_string(more)//" more"
  end function other_names

  !> Says which parts are missing, and how to compute them.
  subroutine refuse_gaps(folder, base, deck, count, error)
    character(len=*), intent(in) :: folder, base, deck
    integer, intent(in) :: count !! of parts
    type(error_t), allocatable, intent(inout) :: error

    character(len=:), allocatable :: path, commands
    integer :: missing(count), i, number

    number = 0
    commands = ""
    do i = 1, count
      path = joined_path(folder, part_name(base, part_t(i, count)))
      if (file_exists(path)) cycle
      number = number + 1
      missing(number) = i
      if (number > most_commands) cycle
      commands = commands//", flexmech "
      if (file_exists(path//begun)) commands = commands//"--resume "
      commands = commands//"--part "//to_string(i)//"/"//to_string(count)//" "//deck
    end do
    if (number > most_commands) commands = commands//", …"
    call set_error(error, error_of_input, "part"//trim(merge("s", " ", number > 1))//" "// &
      numbers_text(missing(:number))//" of "//to_string(count)//trim(merge(" are", " is ", number &
      > 1))//" missing: run "//commands(3:), deck)
  end subroutine refuse_gaps

  !> `3, 5 to 9 and 12`.
  pure function numbers_text(numbers) result(text)
    integer, intent(in) :: numbers(:) !! ascending, at least one
    character(len=:), allocatable :: text

    type(string_t), allocatable :: ranges(:)
    integer :: first, last

    allocate (ranges(0))
    first = 1
    do while (first <= size(numbers))
      last = first
      do while (last < size(numbers))
        if (numbers(last + 1) /= numbers(last) + 1) exit
        last = last + 1
      end do
      ! Two of them are no range.
      if (last == first + 1) last = first
      if (last == first) call append_string(ranges, to_string(numbers(first)))
      if (last > first) call append_string(ranges, to_string(numbers(first))//" to "// &
        to_string(numbers(last)))
      first = last + 1
    end do
    last = size(ranges)
    text = joined(ranges(:max(1, last - 1)))
    if (last > 1) text = text//" and "//ranges(last)%text
  end function numbers_text

  !> A journal with all tasks of the parts that `find_parts` found. Errors: one is damaged.
  subroutine read_parts(folder, base, title, variants, count, group, journal, error)
    character(len=*), intent(in) :: folder, base, title
    integer, intent(in) :: variants, count     !! numbers of them and of the parts
    integer, intent(in) :: group               !! of the variants in journals
    type(journal_t), intent(out) :: journal
    type(error_t), allocatable, intent(out) :: error

    character(len=:), allocatable :: path
    logical :: is_whole
    integer :: i, k

    call new_journal(folder, title, journal)
    do i = 1, count
      path = joined_path(folder, part_name(base, part_t(i, count)))
      call add_journal_file(journal, path, is_whole)
      if (.not. is_whole) then
        call set_error(error, error_of_files, "this part is damaged: it ends before its last "// &
          "variant does; compute it again", path)
        return
      end if
    end do
    do i = 1, count
      do k = first_variant(part_t(i, count), variants), last_variant(part_t(i, count), variants)
        if (has_task(journal, [group, k])) cycle
        call set_error(error, error_of_files, "this part has no variant "//to_string(k)// &
          ": it is damaged, or another part has been given its name; compute it again", &
          joined_path(folder, part_name(base, part_t(i, count))))
        return
      end do
    end do
  end subroutine read_parts

end module part_files
