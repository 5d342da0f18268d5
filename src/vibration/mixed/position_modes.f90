!> The modes of a linkage of many links, and how it yields to its loads, as what comes after takes
!! those of few links: in unknowns of a border and own modes.
module position_modes
  use bordered_eigensolver, only: bordered_modes_t
  use mixed_positions, only: displacements_of, find_mixed_prints, modes_on_border
  use modal_assurance, only: mode_prints_t
  use pin_displacements, only: chords_t
  use position_assembly, only: assembled_t
  use position_equations, only: position_equations_t
  implicit none (type, external)
  private

  public :: modes_of_position, prints_of_position, yields_of_position

contains

  !> Modes whose border are the modes themselves.
  pure subroutine modes_of_position(here, found, equations, modes)
    type(assembled_t), intent(inout) :: here          !! in mixed form; the layout of its model
                                                      !! becomes that of these modes
    type(bordered_modes_t), intent(in) :: found       !! in the unknowns of the form
    type(position_equations_t), intent(inout) :: equations !! chords and M become those of the
                                                      !! border
    type(bordered_modes_t), intent(out) :: modes

    call modes_on_border(here%mixed, here%elastic, here%model%links, here%pose, found, &
      equations%chords, here%model%layout, equations%pencil%mass%border, modes)
  end subroutine modes_of_position

  !> Prints of the first modes.
  pure subroutine prints_of_position(here, found, number, prints)
    type(assembled_t), intent(inout) :: here    !! in mixed form, at the position of the modes
    type(bordered_modes_t), intent(in) :: found !! in the unknowns of the form
    integer, intent(in) :: number               !! how many
    type(mode_prints_t), intent(out) :: prints

    call find_mixed_prints(here%mixed, here%model%links, found, number, prints)
  end subroutine prints_of_position

  !> What the loads of each case do to points and parts.
  pure function yields_of_position(here) result(chords)
    type(assembled_t), intent(in) :: here !! in mixed form, with loads
    type(chords_t) :: chords

    chords = displacements_of(here%mixed%form, here%elastic, here%model%links, here%pose, &
      here%mixed%solution)
  end function yields_of_position

end module position_modes
