!> Friction in words, for the heads of tables, the log and failed rows.
module friction_words
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use natures, only: angle_nature, length_nature
  use output_units, only: damping_unit
  use friction_study, only: lock_t
  use text, only: append_string, string_t, to_string
  use units, only: coherent_unit, dimension_length, dimension_velocity, from_si, unit_t
  implicit none (type, external)
  private

  public :: friction_lines, joint_words, lock_words

contains

  !> `friction at B of rod on the ground: radius 8 mm, coefficient 0.1 (smooth within 0.01 rad/s)`:
  !! one line for each joint that rubs.
  pure function friction_lines(model, mechanism) result(lines)
    type(model_t), intent(in) :: model         !! in SI
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(string_t), allocatable :: lines(:)    !! (joints)

    character(len=:), allocatable :: line
    type(unit_t) :: rate
    integer :: i

    allocate (lines(0))
    if (.not. allocated(mechanism%linkage%frictions)) return
    do i = 1, size(mechanism%linkage%frictions)
      associate (rub => mechanism%linkage%frictions(i))
        ! The other end of a block.
        if (rub%reach < 0.0_wp) cycle
        line = "friction "//joint_words(model, mechanism, i)//":"
        rate = model%outputs%rate
        if (rub%slider > 0) rate = coherent_unit(model%units, dimension_velocity)
        if (rub%radius > 0.0_wp) line = line//" radius "//in_words(rub%radius, &
          coherent_unit(model%units, dimension_length))//","
        if (rub%turn > 0) line = line//" length "//in_words(rub%reach, &
          coherent_unit(model%units, dimension_length))//","
        if (rub%coefficient > 0.0_wp) line = line//" coefficient "//to_string(rub%coefficient, &
          12)//" (smooth within "//in_words(rub%smooth, rate)//"),"
        if (rub%viscous > 0.0_wp) line = line//" viscous "//in_words(rub%viscous*merge(2.0_wp, &
          1.0_wp, rub%turn > 0), damping_unit(model%outputs, merge(angle_nature, length_nature, &
          rub%slider == 0)))//","
        call append_string(lines, line(:len(line) - 1))
      end associate
    end do
  end function friction_lines

  !> `at B of rod on crank`, `at B along bore`
  pure function joint_words(model, mechanism, number) result(words)
    type(model_t), intent(in) :: model         !! with its guides
    type(mechanism_t), intent(in) :: mechanism !! with names
    integer, intent(in) :: number              !! of the friction in the linkage
    character(len=:), allocatable :: words

    associate (rub => mechanism%linkage%frictions(number), linkage => mechanism%linkage)
      words = "at "//mechanism%pin_names(rub%pin)%text
      if (rub%slider > 0) then
        words = words//" along "//model%sliders(rub%slider)%on%text
        return
      end if
      words = words//" of "//mechanism%names(rub%body)%text//" on "
      if (rub%against > 0) then
        words = words//mechanism%names(rub%against)%text
      else if (linkage%is_ground(rub%pin)) then
        words = words//"the ground"
      else
        words = words//"the block"
      end if
    end associate
  end function joint_words

  !> Why a row of forces fails.
  pure function lock_words(model, mechanism, lock) result(words)
    type(model_t), intent(in) :: model         !! with its guides
    type(mechanism_t), intent(in) :: mechanism !! with names
    type(lock_t), intent(in) :: lock           !! of a position and speed
    character(len=:), allocatable :: words

    words = "friction locks the linkage: with "//to_string(lock%share, 6)// &
      " of its coefficients forces in the joints grow beyond all bounds, most "// &
      joint_words(model, mechanism, lock%friction)
  end function lock_words

  !> `8 mm`
  pure function in_words(value, measure) result(words)
    real(wp), intent(in) :: value !! [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: words

    words = to_string(from_si(value, measure))//" "//measure%name
  end function in_words

end module friction_words
