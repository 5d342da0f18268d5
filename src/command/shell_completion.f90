!> Scripts with which shells complete the options and the decks of the program, from the table of
!! options.
module shell_completion
  use option_table, only: option_names, options
  use program_version, only: program_name
  use text, only: in_single_quotes
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: completion_text

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> The text of `--completion`; empty for another shell than bash, zsh and fish.
  pure function completion_text(shell) result(text)
    character(len=*), intent(in) :: shell
    character(len=:), allocatable :: text

    type(text_buffer_t) :: file

    select case (shell)
    case ("bash")
      call append_bash(file)
    case ("zsh")
      call append_zsh(file)
    case ("fish")
      call append_fish(file)
    end select
    text = buffer_text(file)
  end function completion_text

  !> In bash `=` is a word of its own: `--format=csv` is three.
  pure subroutine append_bash(file)
    type(text_buffer_t), intent(inout) :: file

    integer :: i

    call append_line(file, "# Completion of "//program_name//" in bash.")
    call append_line(file, "_"//program_name//"() {")
    call append_line(file, &
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}")
    call append_line(file, "  COMPREPLY=()")
    call append_line(file, "  if [[ $word == = ]]; then")
    call append_line(file, "    word=")
    call append_line(file, "  elif [[ $before == = ]]; then")
    call append_line(file, "    before=${COMP_WORDS[COMP_CWORD-2]}")
    call append_line(file, "  fi")
    call append_line(file, "  case $before in")
    do i = 1, size(options)
      if (options(i)%value == "") cycle
      call append_line(file, "    "//trim(options(i)%name)//")")
      if (options(i)%folder) then
        call append_line(file, "      compopt -o filenames")
        call append_line(file, "      mapfile -t COMPREPLY < <(compgen -d -- ""$word"")")
      else if (options(i)%choices /= "") then
        call append_line(file, "      mapfile -t COMPREPLY < <(compgen -W '"// &
          trim(options(i)%choices)//"' -- ""$word"")")
      end if
      call append_line(file, "      return ;;")
    end do
    call append_line(file, "  esac")
    call append_line(file, "  if [[ $word == -* ]]; then")
    call append_line(file, "    mapfile -t COMPREPLY < <(compgen -W '"//option_names()// &
      "' -- ""$word"")")
    call append_line(file, "  else")
    call append_line(file, "    compopt -o filenames")
    call append_line(file, "    mapfile -t COMPREPLY < <(compgen -f -X '!*.deck' -- ""$word""")
    call append_line(file, "                             compgen -d -- ""$word"")")
    call append_line(file, "  fi")
    call append_line(file, "}")
    call append_line(file, "complete -F _"//program_name//" "//program_name)
  end subroutine append_bash

  pure subroutine append_zsh(file)
    type(text_buffer_t), intent(inout) :: file

    character(len=:), allocatable :: entry
    integer :: i

    call append_line(file, "#compdef "//program_name)
    call append_line(file, "# Completion of "//program_name//" in zsh.")
    call append_line(file, "_arguments \")
    do i = 1, size(options)
      entry = trim(options(i)%name)
      ! An option that may be repeated is marked; its value may follow a blank or `=`.
      if (index(options(i)%help, "may be repeated") > 0) entry = "*"//entry
      if (options(i)%value /= "") entry = entry//"="
      entry = entry//"["//zsh_words(trim(options(i)%help))//"]"
      if (options(i)%value /= "") entry = entry//":"//trim(options(i)%value)//":"
      if (options(i)%choices /= "") entry = entry//"("//trim(options(i)%choices)//")"
      if (options(i)%folder) entry = entry//"_files -/"
      call append_line(file, "  "//in_single_quotes(entry)//" \")
    end do
    call append_line(file, "  '*:deck:_files -g ""*.deck""'")
  end subroutine append_zsh

  !> Colons and brackets end a part of an entry.
  pure function zsh_words(words) result(text)
    character(len=*), intent(in) :: words
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    do i = 1, len(words)
      if (scan(words(i:i), ":[]\") > 0) text = text//"\"
      text = text//words(i:i)
    end do
  end function zsh_words

  pure subroutine append_fish(file)
    type(text_buffer_t), intent(inout) :: file

    character(len=*), parameter :: begin = "complete -c "//program_name
    integer :: i

    call append_line(file, "# Completion of "//program_name//" in fish.")
    call append_line(file, begin//" -f")
    call append_line(file, begin//" -k -a '(__fish_complete_suffix .deck)'")
    do i = 1, size(options)
      call append_text(file, begin//" -l "//trim(options(i)%name(3:)))
      if (options(i)%value /= "") call append_text(file, " -x")
      if (options(i)%choices /= "") call append_text(file, " -a '"//trim(options(i)%choices)//"'")
      if (options(i)%folder) call append_text(file, " -a '(__fish_complete_directories)'")
      call append_text(file, " -d "//in_single_quotes(trim(options(i)%help))//line_feed)
    end do
  end subroutine append_fish

  pure subroutine append_line(file, line)
    type(text_buffer_t), intent(inout) :: file
    character(len=*), intent(in) :: line

    call append_text(file, line//line_feed)
  end subroutine append_line

end module shell_completion
