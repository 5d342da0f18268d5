!> Errors and warnings about a deck, each with its place and the line of text over a caret.
module diagnostics
  use deck_source, only: file_of_line, last_line, line_origin, line_place, source_line, source_t
  use errors, only: error_of_input
  use kinds, only: wp
  use numbers, only: number_length
  use sorting, only: ascending_order
  use text, only: append_string, character_count, is_continuation_byte, plural, string_t, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use tokens, only: token_t
  use warnings, only: counted_text, grade_doubt, grade_meaningless, join_warning, warning_t
  implicit none (type, external)
  private

  public :: diagnostics_t, add_error, add_warning, has_errors, has_other_errors, error_count, &
    render_errors, render_warnings, warning_texts, join_warnings, append_warnings, count_warnings
  public :: diagnostic_t, message_list_t, errors_of, warnings_of, untold_errors, untold_warnings
  public :: append_message, has_messages

  !> One message. Its place has no line if something is missing from the deck.
  type :: diagnostic_t
    character(len=:), allocatable :: message !! one line, without place and severity
    type(token_t) :: place                   !! the word it is about
    character(len=:), allocatable :: note    !! about the second place; empty: none
    type(token_t) :: second_place            !! a word that explains the error
    integer :: kind = error_of_input         !! of an error: one of the error_of_… numbers
    type(warning_t) :: warning               !! of a warning: grade and variants
  end type diagnostic_t

  !> Messages of one severity.
  type :: message_list_t
    integer :: total = 0                       !! including those beyond `most_kept`
    integer :: kept = 0                        !! at most `most_kept`
    type(diagnostic_t), allocatable :: list(:) !! (at least kept) in the order in which they were
                                               !! added
  end type message_list_t

  !> All messages about one deck.
  type :: diagnostics_t
    type(message_list_t) :: errors   !! for their bytes only: elsewhere by the procedures below
    type(message_list_t) :: warnings !! likewise
  end type diagnostics_t

  !> Most messages kept of each severity: a file that is no deck at all has an error in every line.
  integer, parameter :: most_kept = 100

  !> Longest part of a line that is shown [characters].
  integer, parameter :: window = 150

contains

  !> Adds an error at a word of the deck, optionally with a second word that explains it. Words
  !! marked as unknown are skipped: their error has been reported.
  pure subroutine add_error(diagnostics, place, message, second_place, note, kind)
    type(diagnostics_t), intent(inout) :: diagnostics   !! of the deck
    type(token_t), intent(in) :: place                  !! the word; without a line: something is
                                                        !! missing
    character(len=*), intent(in) :: message             !! without place and severity
    type(token_t), intent(in), optional :: second_place !! shown with `note`
    character(len=*), intent(in), optional :: note      !! about the second place
    integer, intent(in), optional :: kind               !! one of the error_of_… numbers;
                                                        !! error_of_input if not present

    type(diagnostic_t) :: new

    new%place = place
    new%message = message
    new%note = ""
    if (present(second_place)) new%second_place = second_place
    if (present(note)) new%note = note
    if (present(kind)) new%kind = kind
    call append_message(diagnostics%errors, new)
  end subroutine add_error

  !> Adds a warning at a word of the deck, optionally with a second word that explains it. Warnings
  !! of several variants are joined if they are at the same word and of the same kind and grade.
  pure subroutine add_warning(diagnostics, place, message, kind, grade, amount, second_place, note)
    type(diagnostics_t), intent(inout) :: diagnostics !! of the deck
    type(token_t), intent(in) :: place                !! the word; without a line: something is
                                                      !! missing
    character(len=*), intent(in) :: message           !! without place and severity
    integer, intent(in), optional :: kind             !! tells different warnings at the same word
                                                      !! apart; 0 if not present
    integer, intent(in), optional :: grade            !! one of the grades of `warnings`;
                                                      !! grade_doubt if not present
    real(wp), intent(in), optional :: amount          !! the larger, the worse; 0 if not present
    type(token_t), intent(in), optional :: second_place !! shown with `note`
    character(len=*), intent(in), optional :: note    !! about the second place

    type(diagnostic_t) :: new

    new%place = place
    new%message = message
    new%note = ""
    new%warning%text = message
    new%warning%variant = ""
    if (present(second_place)) new%second_place = second_place
    if (present(note)) new%note = note
    if (present(kind)) new%warning%kind = kind
    if (present(grade)) new%warning%grade = grade
    if (present(amount)) new%warning%amount = amount
    call append_message(diagnostics%warnings, new)
  end subroutine add_warning

  !> Appends a message; beyond `most_kept` it is only counted.
  pure subroutine append_message(messages, new)
    type(message_list_t), intent(inout) :: messages !! of one severity
    type(diagnostic_t), intent(in) :: new           !! with its place

    type(diagnostic_t), allocatable :: larger(:)

    ! An unknown `$name` has been reported already.
    if (new%place%set_line < 0) return
    messages%total = messages%total + 1
    if (messages%kept == most_kept) return
    if (.not. allocated(messages%list)) allocate (messages%list(4))
    if (messages%kept == size(messages%list)) then
      allocate (larger(min(most_kept, 2*messages%kept)))
      larger(:messages%kept) = messages%list
      call move_alloc(larger, messages%list)
    end if
    messages%kept = messages%kept + 1
    messages%list(messages%kept) = new
  end subroutine append_message

  !> Adds the warnings of a variant to those of the variants before: one for every word, kind and
  !! grade.
  pure subroutine join_warnings(diagnostics, more, variant)
    type(diagnostics_t), intent(inout) :: diagnostics !! of the deck
    type(diagnostics_t), intent(in) :: more           !! of one variant
    character(len=*), intent(in) :: variant           !! `L=90mm`; empty: nothing varies

    type(diagnostic_t) :: new
    integer :: i, known
    logical, allocatable :: is_new(:) !! whether a warning kept is yet without this variant

    if (more%warnings%kept == 0) return
    allocate (is_new(most_kept))
    is_new = .true.
    do i = 1, more%warnings%kept
      new = more%warnings%list(i)
      new%warning%variant = variant
      known = same_warning(diagnostics%warnings, new)
      if (known == 0) then
        known = diagnostics%warnings%kept + 1
        call append_message(diagnostics%warnings, new)
        if (known <= most_kept) is_new(known) = .false.
      else
        associate (warning => diagnostics%warnings%list(known))
          call join_warning(warning%warning, new%warning, is_new(known))
          ! The value of a `$name` is that of the worst variant.
          if (warning%warning%variant == variant) warning%place = new%place
        end associate
        is_new(known) = .false.
      end if
    end do
  end subroutine join_warnings

  !> Appends warnings as they are.
  pure subroutine append_warnings(diagnostics, more)
    type(diagnostics_t), intent(inout) :: diagnostics !! of the deck
    type(diagnostics_t), intent(in) :: more           !! whose warnings are appended

    integer :: i

    do i = 1, more%warnings%kept
      call append_message(diagnostics%warnings, more%warnings%list(i))
    end do
  end subroutine append_warnings

  !> Number, in the list, of a warning of other variants at the same word, of the same kind and
  !! grade; 0 if there is none.
  pure function same_warning(messages, warning) result(number)
    type(message_list_t), intent(in) :: messages
    type(diagnostic_t), intent(in) :: warning
    integer :: number

    do number = messages%kept, 1, -1
      associate (known => messages%list(number))
        if (len(known%warning%variant) > 0 .and. known%place%line == warning%place%line .and. &
          known%place%column == warning%place%column .and. &
          known%warning%kind == warning%warning%kind .and. &
          known%warning%grade == warning%warning%grade) return
      end associate
    end do
  end function same_warning

  !> Puts the number of variants into the warnings that were joined.
  pure subroutine count_warnings(diagnostics, variants)
    type(diagnostics_t), intent(inout) :: diagnostics !! with the warnings of all variants
    integer, intent(in) :: variants                   !! of the deck

    integer :: i

    do i = 1, diagnostics%warnings%kept
      associate (this => diagnostics%warnings%list(i))
        this%message = counted_text(this%warning, variants)
      end associate
    end do
  end subroutine count_warnings

  !> Whether there are errors.
  pure function has_errors(diagnostics) result(has)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    logical :: has

    has = diagnostics%errors%total > 0
  end function has_errors

  !> Whether there are errors or warnings.
  pure function has_messages(diagnostics) result(has)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    logical :: has

    has = diagnostics%errors%total > 0 .or. diagnostics%warnings%total > 0
  end function has_messages

  !> Whether there are errors of other kinds than one.
  pure function has_other_errors(diagnostics, kind) result(has)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    integer, intent(in) :: kind                    !! one of the error_of_… numbers
    logical :: has

    integer :: i

    has = diagnostics%errors%total > diagnostics%errors%kept
    do i = 1, diagnostics%errors%kept
      has = has .or. diagnostics%errors%list(i)%kind /= kind
    end do
  end function has_other_errors

  !> Number of errors, including those that are not kept.
  pure function error_count(diagnostics) result(count)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    integer :: count

    count = diagnostics%errors%total
  end function error_count

  !> All errors kept, in the order of the deck's lines, and the number of those not kept, ready for
  !! standard error; empty if there are none.
  pure function render_errors(diagnostics, source) result(text)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(source_t), intent(in) :: source           !! that their places refer to
    character(len=:), allocatable :: text

    text = rendered_list(diagnostics%errors, source, "error")
  end function render_errors

  !> All warnings, as `render_errors` does for errors.
  pure function render_warnings(diagnostics, source) result(text)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(source_t), intent(in) :: source           !! that their places refer to
    character(len=:), allocatable :: text

    text = rendered_list(diagnostics%warnings, source, "warning")
  end function render_warnings

  !> The warnings of a grade without path and caret, for the log.
  pure function warning_texts(diagnostics, source, grade) result(texts)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(source_t), intent(in) :: source           !! that their places refer to
    integer, intent(in) :: grade                   !! one of the grades of `warnings`
    type(string_t), allocatable :: texts(:)        !! a line each

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    allocate (texts(0))
    list = in_order(diagnostics%warnings)
    do i = 1, size(list)
      if (list(i)%warning%grade /= grade) cycle
      if (list(i)%place%line > 0) then
        call append_string(texts, line_origin(source, list(i)%place%line)//": "//list(i)%message)
      else
        call append_string(texts, list(i)%message)
      end if
    end do
    associate (warnings => diagnostics%warnings)
      if (grade == grade_doubt .and. warnings%total > warnings%kept) call append_string(texts, &
        plural(warnings%total - warnings%kept, "more warning"))
    end associate
  end function warning_texts

  !> The errors kept, in the order of the deck's lines.
  pure function errors_of(diagnostics) result(list)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(diagnostic_t), allocatable :: list(:)

    list = in_order(diagnostics%errors)
  end function errors_of

  !> The warnings kept: those that make the results meaningless, then the others, each in the order
  !! of the deck's lines.
  pure function warnings_of(diagnostics) result(list)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(diagnostic_t), allocatable :: list(:)

    list = in_order(diagnostics%warnings)
  end function warnings_of

  !> Number of errors beyond those kept.
  pure function untold_errors(diagnostics) result(count)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    integer :: count

    count = diagnostics%errors%total - diagnostics%errors%kept
  end function untold_errors

  !> Number of warnings beyond those kept.
  pure function untold_warnings(diagnostics) result(count)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    integer :: count

    count = diagnostics%warnings%total - diagnostics%warnings%kept
  end function untold_warnings

  pure function in_order(messages) result(list)
    type(message_list_t), intent(in) :: messages
    type(diagnostic_t), allocatable :: list(:)

    real(wp) :: place(messages%kept)
    integer :: i, order(messages%kept)
    logical :: first(messages%kept)

    do i = 1, messages%kept
      ! Messages without a place refer to the deck's end and come last.
      place(i) = huge(place)
      if (messages%list(i)%place%line > 0) place(i) = messages%list(i)%place%line*1.0e9_wp + &
        messages%list(i)%place%column
    end do
    order = ascending_order(place)
    first = messages%list(order)%warning%grade == grade_meaningless
    order = [pack(order, first), pack(order, .not. first)]
    allocate (list(messages%kept))
    do i = 1, messages%kept
      list(i) = messages%list(order(i))
    end do
  end function in_order

  pure function rendered_list(messages, source, severity) result(text)
    type(message_list_t), intent(in) :: messages
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: severity
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = in_order(messages)
    do i = 1, size(list)
      associate (item => list(i))
        call append_place(buffer, source, item%place, severity, item%message)
        call append_setting(buffer, source, item%place)
        if (len(item%note) > 0) call append_place(buffer, source, item%second_place, "note", &
          item%note)
      end associate
    end do
    if (messages%total > messages%kept) then
      call append_text(buffer, source%path//": "//plural(messages%total - messages%kept, &
        "more "//severity)//achar(10))
    end if
    text = buffer_text(buffer)
  end function rendered_list

  !> For a word that stands as `$name` on its card, appends the place where its text is set.
  pure subroutine append_setting(buffer, source, place)
    type(text_buffer_t), intent(inout) :: buffer
    type(source_t), intent(in) :: source
    type(token_t), intent(in) :: place

    character(len=:), allocatable :: note
    type(token_t) :: setting

    if (place%set_line <= 0) return
    ! Not by a constructor: gfortran 12 loses the text of another word there.
    setting%text = place%text
    setting%line = place%set_line
    setting%column = place%set_column
    note = "'"//written_word(source, place)//"' is set here"
    ! The unit alone, as a part of a result, does not say what it is.
    if (written_word(source, setting) /= place%text .and. .not. (place%is_computed .and. &
      number_length(place%text) == 0)) note = "'"//written_word(source, place)//"' is "// &
      place%text//", set here"
    call append_place(buffer, source, setting, "note", note)
  end subroutine append_setting

  !> Appends `path:line:column: severity: message`, the line, the caret, and the INCLUDE cards that
  !! lead to the file.
  pure subroutine append_place(buffer, source, place, severity, message)
    type(text_buffer_t), intent(inout) :: buffer
    type(source_t), intent(in) :: source
    type(token_t), intent(in) :: place
    character(len=*), intent(in) :: severity, message

    character(len=:), allocatable :: line, number
    integer :: first, marks, file

    if (place%line < 1) then
      ! Something is missing from the deck, so the message points at its end.
      call append_text(buffer, source%path//":"//to_string(max(1, last_line(source, 1)))//":1: "// &
        severity//": "//message//achar(10))
      return
    end if
    call append_text(buffer, line_place(source, place%line)//":"//to_string(place%column)//": "// &
      severity//": "//message//achar(10))
    file = file_of_line(source, place%line)
    line = blank_tabs(source_line(source, place%line))
    first = 1
    if (character_count(line) > window) first = max(1, place%column - window/2)
    line = characters(line, first, window)
    number = to_string(place%line - source%files(file)%first_line + 1)
    number = repeat(" ", max(0, 5 - len(number)))//number
    marks = max(1, min(character_count(written_word(source, place)), &
      window - (place%column - first)))
    call append_text(buffer, number//" | "//line//achar(10))
    call append_text(buffer, repeat(" ", len(number))//" | "//repeat(" ", place%column - first)// &
      repeat("^", marks)//achar(10))
    do while (source%files(file)%include_line > 0)
      call append_text(buffer, repeat(" ", len(number))//" included from "// &
        line_place(source, source%files(file)%include_line)//achar(10))
      file = file_of_line(source, source%files(file)%include_line)
    end do
  end subroutine append_place

  !> A word as it stands in the deck: its text or, where a value has replaced it, its `$name`.
  pure function written_word(source, place) result(word)
    type(source_t), intent(in) :: source
    type(token_t), intent(in) :: place
    character(len=:), allocatable :: word

    character(len=:), allocatable :: line, rest
    integer :: length

    line = source_line(source, place%line)
    rest = characters(line, place%column, len(line))
    word = place%text
    if (index(rest, word) == 1) return
    length = scan(rest, " ="//achar(9)) - 1
    if (length < 0) length = len(rest)
    ! In a list, a `$name` ends at the comma; its value may be a list itself.
    if (index(rest, "$") == 1 .and. index(rest(:length), ",") > 0) length = index(rest, ",") - 1
    word = rest(:length)
  end function written_word

  !> Replaces each tab by one blank: a tab counts as one character in columns.
  pure function blank_tabs(line) result(shown)
    character(len=*), intent(in) :: line
    character(len=len(line)) :: shown

    integer :: i

    shown = line
    do i = 1, len(line)
      if (line(i:i) == achar(9)) shown(i:i) = " "
    end do
  end function blank_tabs

  !> At most `most` characters of a UTF-8 text from character number `first`, without trailing
  !! blanks.
  pure function characters(line, first, most) result(part)
    character(len=*), intent(in) :: line
    integer, intent(in) :: first, most
    character(len=:), allocatable :: part

    integer :: i, number, start, finish

    number = 0
    start = len(line) + 1
    finish = len(line)
    do i = 1, len(line)
      if (.not. is_continuation_byte(line(i:i))) number = number + 1
      if (number == first) start = min(start, i)
      if (number == first + most) then
        finish = i - 1
        exit
      end if
    end do
    part = trim(line(start:finish))
  end function characters

end module diagnostics
