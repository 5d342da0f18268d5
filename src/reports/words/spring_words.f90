!> Springs, dampers and stops in words, for the heads of tables and the log.
module spring_words
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use natures, only: nature_t
  use output_units, only: damping_unit, stiffness_unit
  use text, only: append_string, string_t, to_string
  use units, only: coherent_unit, from_si, unit_t
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
        if (spring%side /= 0) then
          line = line//", "//side_words(model, spring%nature, load%stiffness, load%side > 0, &
            load%rest, load%damping, load%contact)
        else if (spring%damps) then
          line = line//", "//in_words(load%damping, damping_unit(model%outputs, spring%nature))
        else if (spring%stiffness > 0.0_wp) then
          line = line//", "//in_words(load%stiffness, stiffness_unit(model%outputs, &
            spring%nature))//", unloaded at "//in_words(load%rest, coherent_unit(model%units, &
            spring%nature%value))
        else if (spring%turns) then
          line = line//", a constant torque of "//in_words(load%tension, model%outputs%moment)
        else
          line = line//", a constant tension of "//in_words(load%tension, model%outputs%force)
        end if
        call append_string(lines, line)
      end associate
    end do
    do i = 1, size(model%stops)
      associate (stop => model%stops(i), loads => mechanism%linkage%loads)
        call append_string(lines, "stop "//stop%name%text//": "//stop%measure%text//", "// &
          side_words(model, stop%nature, stop%stiffness, .not. stop%is_below, stop%limit, &
          stop%damping, loads(size(loads) - size(model%stops) + i)%contact))
      end associate
    end do
  end function spring_lines

  !> `4530 N/m above 0.12 m, damping 20 N.s/m, contact within 1e-05 m`
  pure function side_words(model, nature, stiffness, is_above, limit, damping, contact) &
    result(words)
    type(model_t), intent(in) :: model
    type(nature_t), intent(in) :: nature               !! of the coordinate
    real(wp), intent(in) :: stiffness, limit, damping, contact !! [SI]
    logical, intent(in) :: is_above
    character(len=:), allocatable :: words

    type(unit_t) :: measure

    measure = coherent_unit(model%units, nature%value)
    words = in_words(stiffness, stiffness_unit(model%outputs, nature))//" "//trim(merge("above", &
      "below", is_above))//" "//in_words(limit, measure)
    if (damping > 0.0_wp) words = words//", damping "//in_words(damping, &
      damping_unit(model%outputs, nature))
    words = words//", contact within "//to_string(from_si(contact, measure), 3)//" "//measure%name
  end function side_words

  !> `4530 N/m`
  pure function in_words(value, measure) result(words)
    real(wp), intent(in) :: value !! [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: words

    words = to_string(from_si(value, measure), 12)//" "//measure%name
  end function in_words

end module spring_words
