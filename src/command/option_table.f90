! src/command/ - texts about the command line: options, the manual page, completion of shells.
! Begin with `options` here, of which `manual_page_text` in `manual_page.f90` and `completion_text`
! in `shell_completion.f90` make texts.
! Not here: reading the command line (`src/command_line.f90`), help on cards
! (`src/runs/texts/card_help.f90`).

!> The table of the command line's options: `--help`, the manual page and the completion of shells
!! are made from it.
module option_table
  implicit none (type, external)
  private

  public :: option_t, options, takes_value, choices_of, option_names, column_of_help

  type :: option_t
    character(len=12) :: name = ""    !! with its two hyphens
    character(len=5) :: value = ""    !! what its value is called; blank: it has none
    character(len=24) :: choices = "" !! the values allowed, separated by blanks, if they are few
    logical :: folder = .false.       !! its value is a folder
    character(len=80) :: help = ""    !! in one line
  end type option_t

  type(option_t), parameter :: options(*) = [ &
    option_t("--check", help="read and check the decks only"), &
    option_t("--out", "DIR", folder=.true., help="write to DIR/<deck base name>/"), &
    option_t("--set", "N=V", &
      help="use V instead of the value that SET or VARY gives the name N; may be repeated"), &
    option_t("--threads", "N", help="compute N positions at a time (1)"), &
    option_t("--format", "FORM", choices="plain csv csv-only", &
      help="csv: comma-separated tables beside the plain ones; csv-only: only those (plain)"), &
    option_t("--digits", "N", &
      help="round what tables show to N significant digits, 1 to 17 (17: all)"), &
    option_t("--resume", &
      help="continue where an earlier run of the deck was killed or interrupted"), &
    option_t("--time-limit", "TIME", &
      help="stop after TIME (3h50m, 90m, 45s, 3:50:00) as at an interruption"), &
    option_t("--part", "K/N", &
      help="compute the Kth of N parts of the variants, for --join, and write no tables"), &
    option_t("--join", help="write the tables from the parts that --part computed"), &
    option_t("--quiet", &
      help="no warnings, progress or summary line; errors are still reported"), &
    option_t("--stats", help="report what was computed and how long it took"), &
    option_t("--json", &
      help="on standard output: errors, warnings and failed rows of all decks as JSON"), &
    option_t("--version", help="the program's version"), &
    option_t("--help", help="this list of options"), &
    option_t("--help-cards", help="every card and report, two lines each"), &
    option_t("--man", help="the manual page, in the format of man"), &
    option_t("--completion", "SHELL", choices="bash zsh fish", &
      help="a script that completes options and decks in a shell")]

  !> The column in which the help of `--help` begins.
  integer, parameter :: column_of_help = 22

contains

  !> Whether the option of this name has a value.
  pure logical function takes_value(name)
    character(len=*), intent(in) :: name

    integer :: i

    takes_value = any([(options(i)%name == name .and. options(i)%value /= "", i=1, size(options))])
  end function takes_value

  !> The values allowed for the option of this name, separated by blanks; empty if they are many.
  pure function choices_of(name) result(choices)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: choices

    integer :: i

    choices = ""
    do i = 1, size(options)
      if (options(i)%name == name) choices = trim(options(i)%choices)
    end do
  end function choices_of

  !> The names of all options, separated by blanks.
  pure function option_names() result(names)
    character(len=:), allocatable :: names

    integer :: i

    names = trim(options(1)%name)
    do i = 2, size(options)
      names = names//" "//trim(options(i)%name)
    end do
  end function option_names

end module option_table
