!> Excerpts of modes from which they are recognised at other positions, in unknowns that mean the
!! same at all of them.
module mode_prints
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use modal_assurance, only: mode_prints_t, new_mode_prints
  use pin_displacements, only: chords_t
  implicit none (type, external)
  private

  public :: prints_of

contains

  !> Prints of the first modes. Where there are more border deformations than unknowns, the basis of
  !! these turns from position to position, and the deformations are kept in their place.
  pure function prints_of(model, chords, found, modes) result(prints)
    type(deformation_model_t), intent(in) :: model !! gives the order of the unknowns
    type(chords_t), intent(in) :: chords           !! at this position
    type(bordered_modes_t), intent(in) :: found    !! at least these modes
    integer, intent(in) :: modes                   !! how many
    type(mode_prints_t) :: prints

    real(wp), allocatable :: border(:, :)
    integer :: i, n

    if (.not. allocated(chords%weighted)) then
      prints = new_mode_prints(model%layout, found, modes)
      return
    end if
    n = size(chords%weighted, 1)
    allocate (border(n + chords%free, model%layout%border), source=0.0_wp)
    border(:n, :) = chords%weighted
    do i = 1, chords%free
      border(n + i, model%layout%border - chords%free + i) = 1.0_wp
    end do
    prints = new_mode_prints(model%layout, found, modes, border)
  end function prints_of

end module mode_prints
