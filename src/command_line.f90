!> The command line as a value.
module command_line
  use durations, only: read_duration
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: wp
  use number_text, only: most_digits
  use numbers, only: read_integer
  use option_table, only: choices_of, column_of_help, option_names, options, takes_value
  use program_version, only: program_name, version_number
  use spelling, only: suggestion
  use study_parts, only: part_t, read_part
  use text, only: joined, same_word, string_t, to_string, word_list
  use tokens, only: check_name
  implicit none (type, external)
  private

  public :: command_t, read_command_line, help_text, version_text

  type :: command_t
    character(len=:), allocatable :: program     !! as the user called it
    character(len=:), allocatable :: search_path !! of the shell, the variable PATH
    character(len=:), allocatable :: folder    !! of `--out`
    integer :: threads = 1
    type(string_t), allocatable :: decks(:)
    type(string_t), allocatable :: settings(:) !! of `--set`, each `name=value`
    logical :: check_only = .false.
    logical :: quiet = .false.
    logical :: resume = .false.
    type(part_t) :: part                       !! of `--part`
    logical :: join = .false.                  !! put parts together
    character(len=:), allocatable :: limit     !! of `--time-limit`, as it was given
    real(wp) :: most_time = huge(1.0_wp)       !! the same [s]
    logical :: csv = .false.                   !! tables as comma-separated values too
    logical :: csv_only = .false.              !! and not as plain text
    integer :: digits = 0                      !! of numbers in tables; 0: as the decks say
    logical :: stats = .false.
    logical :: json = .false.
    logical :: help = .false.
    logical :: help_cards = .false.
    logical :: version = .false.
    logical :: manual = .false.
    character(len=:), allocatable :: shell     !! of `--completion`
    character(len=:), allocatable, private :: valued !! the options with a value that were given,
                                                     !! between blanks
  end type command_t

  character(len=*), parameter :: line_feed = achar(10)
  integer, parameter :: most_threads = 1024

contains

  !> Reads the arguments of the program. Errors: an unknown option, an option without its value or
  !! given twice, a malformed setting or one given twice, no deck, standard input twice.
  subroutine read_command_line(command, error)
    type(command_t), intent(out) :: command          !! with an error, only `json` is of use
    type(error_t), allocatable, intent(out) :: error !! without a place

    type(string_t), allocatable :: words(:)
    integer :: i
    logical :: options_ended, input_taken

    words = arguments()
    command%program = program_called()
    command%search_path = search_path_of_shell()
    command%folder = "outputs"
    command%valued = " "
    allocate (command%decks(0), command%settings(0))
    options_ended = .false.
    input_taken = .false.
    i = 1
    do while (i <= size(words) .and. .not. allocated(error))
      associate (word => words(i)%text)
        if (word == "-" .and. input_taken) then
          call set_error(error, error_of_input, "standard input can be read only once")
        else if (options_ended .or. word == "-" .or. index(word, "-") /= 1) then
          command%decks = [command%decks, words(i)]
          input_taken = input_taken .or. word == "-"
        else if (word == "--") then
          options_ended = .true.
        else
          call read_command_option(words, i, command, error)
        end if
      end associate
      i = i + 1
    end do
    ! `--json` holds even if the command line is wrong before it.
    if (allocated(error)) command%json = any([(words(i)%text == "--json", i=1, size(words))])
    if (allocated(error) .or. command%help .or. command%help_cards .or. command%version .or. &
      command%manual .or. allocated(command%shell)) return
    call check_parts(command, error)
    if (allocated(error)) return
    if (size(command%decks) == 0) call set_error(error, error_of_input, &
      "no deck given; flexmech --help shows how to run one")
  end subroutine read_command_line

  !> Errors: options that contradict `--part` or `--join`.
  pure subroutine check_parts(command, error)
    type(command_t), intent(in) :: command
    type(error_t), allocatable, intent(inout) :: error

    character(len=*), parameter :: of_tables(2) = ["--format", "--digits"]
    integer :: i

    if (command%part%count > 0 .and. command%join) then
      call set_error(error, error_of_input, &
        "options --part and --join exclude each other: parts are computed one by one, then joined")
    else if (command%join .and. command%resume) then
      call set_error(error, error_of_input, &
        "option --resume has no meaning with --join: it computes nothing")
    else if (command%part%count > 0) then
      do i = 1, size(of_tables)
        if (index(command%valued, " "//of_tables(i)//" ") > 0) call set_error(error, &
          error_of_input, "option "//of_tables(i)//" has no meaning with --part: "// &
          "a part has no tables; give it with --join")
      end do
    end if
  end subroutine check_parts

  function arguments() result(words)
    type(string_t), allocatable :: words(:)

    integer :: i, length

    allocate (words(command_argument_count()))
    do i = 1, size(words)
      call get_command_argument(i, length=length)
      allocate (character(len=length) :: words(i)%text)
      if (length > 0) call get_command_argument(i, words(i)%text)
    end do
  end function arguments

  function program_called() result(name)
    character(len=:), allocatable :: name

    integer :: length

    call get_command_argument(0, length=length)
    allocate (character(len=length) :: name)
    if (length > 0) call get_command_argument(0, name)
  end function program_called

  function search_path_of_shell() result(path)
    character(len=:), allocatable :: path

    integer :: length, status

    call get_environment_variable("PATH", length=length, status=status)
    if (status /= 0) length = 0
    allocate (character(len=length) :: path)
    if (length > 0) call get_environment_variable("PATH", path)
  end function search_path_of_shell

  !> Reads one option; `i` moves on to its value if it has one. `--out=DIR` is as good as `--out
  !! DIR`.
  subroutine read_command_option(words, i, command, error)
    type(string_t), intent(in) :: words(:)
    integer, intent(inout) :: i
    type(command_t), intent(inout) :: command
    type(error_t), allocatable, intent(out) :: error

    character(len=:), allocatable :: name, value
    integer :: k

    name = words(i)%text
    k = index(name, "=")
    if (k > 0) name = name(:k - 1)
    if (takes_value(name)) then
      if (k > 0) then
        value = words(i)%text(k + 1:)
      else if (i < size(words)) then
        i = i + 1
        value = words(i)%text
      else
        value = ""
      end if
      if (len(value) == 0) then
        call set_error(error, error_of_input, "option "//name//" needs a value")
      else if (index(value, "--") == 1 .and. k == 0) then
        call set_error(error, error_of_input, "option "//name//" needs a value, and '"//value// &
          "' is an option: write "//name//"="//value//" if it is meant")
      else if (name == "--set") then
        call take_setting(value, command%settings, error)
      else if (index(command%valued, " "//name//" ") > 0) then
        call set_error(error, error_of_input, "option "//name//" is given twice")
      else
        command%valued = command%valued//name//" "
        call read_option_value(name, value, command, error)
      end if
      return
    end if
    if (k > 0) name = words(i)%text
    select case (name)
    case ("--check")
      command%check_only = .true.
    case ("--quiet")
      command%quiet = .true.
    case ("--resume")
      command%resume = .true.
    case ("--join")
      command%join = .true.
    case ("--stats")
      command%stats = .true.
    case ("--json")
      command%json = .true.
    case ("--version")
      command%version = .true.
    case ("--help", "-h")
      command%help = .true.
    case ("--help-cards")
      command%help_cards = .true.
    case ("--man")
      command%manual = .true.
    case default
      call set_error(error, error_of_input, "unknown option '"//name//"'"//suggestion(name, &
        word_list(option_names())))
    end select
  end subroutine read_command_option

  !> Takes `name=value`; that the decks have the name is checked when they are read.
  pure subroutine take_setting(word, settings, error)
    character(len=*), intent(in) :: word
    type(string_t), allocatable, intent(inout) :: settings(:)
    type(error_t), allocatable, intent(inout) :: error

    character(len=:), allocatable :: name, value
    integer :: sign, i

    sign = index(word, "=")
    if (sign < 2 .or. sign == len(word)) then
      call set_error(error, error_of_input, &
        "option --set needs a name and a value, as in --set L=100mm, not '"//word//"'")
      return
    end if
    name = word(:sign - 1)
    value = word(sign + 1:)
    call check_name(name, error)
    if (allocated(error)) then
      error%text = "option --set: "//error%text
    else if (index(value, " ") == 1 .or. scan(value, "=!#&"//achar(9)//line_feed) > 0) then
      call set_error(error, error_of_input, "option --set: '"//value// &
        "' is not one value, as a SET card has it")
    end if
    do i = 1, size(settings)
      if (.not. same_word(settings(i)%text(:index(settings(i)%text, "=") - 1), name)) cycle
      call set_error(error, error_of_input, "option --set gives '"//name//"' twice: "// &
        settings(i)%text//" and "//word)
    end do
    settings = [settings, string_t(word)]
  end subroutine take_setting

  subroutine read_option_value(name, value, command, error)
    character(len=*), intent(in) :: name, value
    type(command_t), intent(inout) :: command
    type(error_t), allocatable, intent(out) :: error

    type(error_t), allocatable :: not_a_number

    select case (name)
    case ("--out")
      command%folder = value
    case ("--threads")
      call read_integer(value, command%threads, not_a_number)
      if (allocated(not_a_number) .or. command%threads < 1 .or. command%threads > most_threads) &
        then
        call set_error(error, error_of_input, &
          "option --threads needs a number from 1 to 1024, not '"//value//"'")
      end if
    case ("--format")
      command%csv_only = value == "csv-only"
      command%csv = value == "csv" .or. command%csv_only
      call check_choice(name, "format", value, error)
    case ("--digits")
      call read_integer(value, command%digits, not_a_number)
      if (allocated(not_a_number) .or. command%digits < 1 .or. command%digits > most_digits) &
        call set_error(error, error_of_input, "option --digits needs a number from 1 to "// &
        to_string(most_digits)//", not '"//value//"'")
    case ("--part")
      call read_part(value, command%part, error)
    case ("--time-limit")
      command%limit = value
      call read_duration(value, command%most_time, not_a_number)
      if (allocated(not_a_number)) call set_error(error, error_of_input, "option "//name// &
        " needs "//not_a_number%text//", not '"//value//"'")
    case ("--completion")
      command%shell = value
      call check_choice(name, "shell", value, error)
    end select
  end subroutine read_option_value

  !> Errors: the value is none of those that the option allows.
  subroutine check_choice(name, noun, value, error)
    character(len=*), intent(in) :: name  !! of the option
    character(len=*), intent(in) :: noun  !! what its values are
    character(len=*), intent(in) :: value
    type(error_t), allocatable, intent(out) :: error

    type(string_t), allocatable :: choices(:)
    integer :: last

    choices = word_list(choices_of(name))
    if (any([(choices(last)%text == value, last=1, size(choices))])) return
    last = size(choices)
    call set_error(error, error_of_input, "unknown "//noun//" '"//value//"'"//suggestion(value, &
      choices)//"; "//name//" is "//joined(choices(:last - 1))//" or "//choices(last)%text)
  end subroutine check_choice

  !> The text of `--version`.
  pure function version_text() result(text)
    character(len=:), allocatable :: text

    text = program_name//" "//version_number
  end function version_text

  !> The text of `--help`.
  pure function help_text() result(text)
    character(len=:), allocatable :: text

    character(len=column_of_help - 1) :: head
    integer :: i

    text = "usage: flexmech [options] DECK..."//line_feed//line_feed// &
      "Computes motion, forces, balance, natural frequencies and mode shapes of flexible "// &
      "linkages."//line_feed// &
      "For every deck the tables are written to outputs/<deck base name>/. A deck named - is "// &
      "standard input."//line_feed//line_feed
    do i = 1, size(options)
      head = "  "//trim(options(i)%name)//" "//options(i)%value
      text = text//head//trim(options(i)%help)//line_feed
    end do
    text = text//line_feed// &
      "Exit status: 0 done; 1 some position or mode could not be computed (the rest is "// &
      "written);"//line_feed//"2 bad deck or command line, nothing written."//line_feed
  end function help_text

end module command_line
