!> The command that draws the figures of a run.
module figures_command
  use file_system, only: file_exists, joined_path
  use text, only: in_single_quotes
  implicit none (type, external)
  private

  public :: command_for_figures, shell_word

  character(len=*), parameter :: plot_program = "flexmech-plot", plot_script = &
    "plots/flexmech-plot"

contains

  !> The command, without the output folder that follows it: `flexmech-plot` if it is installed
  !! beside the program, `plots/flexmech-plot` in a checkout; empty if there is neither.
  function command_for_figures(program, search_path) result(command)
    character(len=*), intent(in) :: program     !! as the user called it, perhaps with its folder
    character(len=*), intent(in) :: search_path !! folders between colons, the variable PATH
    character(len=:), allocatable :: command

    character(len=:), allocatable :: beside
    integer :: slash, first, last

    command = ""
    slash = index(program, "/", back=.true.)
    if (slash > 0) then
      beside = program(:slash)//plot_program
      if (file_exists(beside)) command = shell_word(beside)
    else
      first = 1
      do while (first <= len(search_path))
        last = index(search_path(first:)//":", ":") + first - 2
        if (last >= first) then
          if (file_exists(joined_path(search_path(first:last), plot_program))) &
            command = plot_program
        end if
        first = last + 2
      end do
    end if
    if (command == "" .and. file_exists(plot_script)) command = plot_script
  end function command_for_figures

  !> A path as a word of the shell: in quotes if it has signs that mean something there.
  pure function shell_word(path) result(word)
    character(len=*), intent(in) :: path !! of a file or folder
    character(len=:), allocatable :: word

    character(len=*), parameter :: plain = "abcdefghijklmnopqrstuvwxyz"// &
      "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+,=:@%"

    word = path
    if (verify(path, plain) > 0) word = in_single_quotes(path)
  end function shell_word

end module figures_command
