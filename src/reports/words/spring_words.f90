!> Springs, dampers and stops in words, for the heads of tables and the log.
module spring_words
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use output_units, only: damping_unit
  use pull_laws, only: law_words
  use text, only: append_string, string_t, to_string
  use units, only: from_si, unit_t
  implicit none (type, external)
  private

  public :: spring_lines

contains

  !> `spring s: A - D, 4530 N/m, unloaded at 0.07785 m`: one line for each. Then stops.
  pure function spring_lines(model, mechanism) result(lines)
    type(model_t), intent(in) :: model         !! in SI
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(string_t), allocatable :: lines(:)    !! (springs)

    character(len=:), allocatable :: line
    type(unit_t) :: measure
    integer :: i

    allocate (lines(0))
    do i = 1, size(model%springs)
      associate (spring => model%springs(i), &
          load => mechanism%linkage%loads(size(model%processes) + i))
        line = trim(merge("damper", "spring", spring%damps))//" "//spring%name%text//": "// &
          spring%ends(1)%text
        if (.not. spring%turns) then
          line = line//" - "//spring%ends(2)%text
        else if (spring%link(2) > 0) then
          line = line//", links "//spring%link_names(1)%text//" and "//spring%link_names(2)%text
        else
          line = line//", link "//spring%link_names(1)%text//" and the ground"
        end if
        if (spring%damps) then
          measure = damping_unit(model%outputs, spring%nature)
          line = line//", "//to_string(from_si(load%law%damping, measure), 12)//" "//measure%name
        else
          line = line//", "//law_words(load%law, spring%nature, model%outputs)
        end if
        call append_string(lines, line)
      end associate
    end do
    do i = 1, size(model%stops)
      associate (stop => model%stops(i), loads => mechanism%linkage%loads)
        call append_string(lines, "stop "//stop%name%text//": "//stop%measure%text//", "// &
          law_words(loads(size(loads) - size(model%stops) + i)%law, stop%nature, model%outputs))
      end associate
    end do
  end function spring_lines

end module spring_words
