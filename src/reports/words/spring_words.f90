!> Springs and dampers in words, for the heads of tables and the log.
module spring_words
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use output_units, only: damping_unit, stiffness_unit
  use text, only: append_string, string_t, to_string
  use units, only: coherent_unit, dimension_angle, dimension_length, from_si, unit_t
  implicit none (type, external)
  private

  public :: spring_lines

contains

  !> `spring s: A - D, 4530 N/m, unloaded at 0.07785 m`: one line for each.
  pure function spring_lines(model, mechanism) result(lines)
    type(model_t), intent(in) :: model         !! in SI
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(string_t), allocatable :: lines(:)    !! (springs)

    character(len=:), allocatable :: line
    integer :: i, before

    allocate (lines(0))
    before = size(mechanism%linkage%loads) - size(model%springs)
    do i = 1, size(model%springs)
      associate (spring => model%springs(i), load => mechanism%linkage%loads(before + i))
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
          line = line//", "//in_words(load%damping, damping_unit(model%outputs, spring%turns))
        else if (spring%stiffness > 0.0_wp) then
          line = line//", "//in_words(load%stiffness, stiffness_unit(model%outputs, &
            spring%turns))//", unloaded at "//in_words(load%rest, coherent_unit(model%units, &
            merge(dimension_angle, dimension_length, spring%turns)))
        else if (spring%turns) then
          line = line//", a constant torque of "//in_words(load%tension, model%outputs%moment)
        else
          line = line//", a constant tension of "//in_words(load%tension, model%outputs%force)
        end if
        call append_string(lines, line)
      end associate
    end do
  end function spring_lines

  !> `4530 N/m`
  pure function in_words(value, measure) result(words)
    real(wp), intent(in) :: value !! [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: words

    words = to_string(from_si(value, measure), 12)//" "//measure%name
  end function in_words

end module spring_words
