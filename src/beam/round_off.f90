!> Effect of rounding in assembled matrices on eigenvalues.
module round_off
  use beam_mesh, only: beam_mesh_t, beam_t, element_length
  use kinds, only: wp
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: round_off_error

contains

  !> Error of an eigenvalue λ from the rounding of K alone: `ε ‖K_e‖/‖M_e‖`, the largest over all
  !! bodies [1/s²].
  !!
  !! Element stiffnesses grow without bound as elements shrink, and in a smooth mode nearly all of
  !! them cancels. A solver in nodal unknowns cannot recover the lost digits; residuals and inertia
  !! counts of the same matrices do not show the loss. The order of an element does not matter: its
  !! nodal stiffness is that of order 3, and bubbles stand alone on the diagonal, where nothing can
  !! cancel. The same holds for all shear strains except the uniform one, whose share of the bending
  !! stiffness, 12EI/h³, is below that of a node.
  pure function round_off_error(linkage, beams, mesh, body) result(error)
    type(linkage_t), intent(in) :: linkage !! lengths and line densities
    type(beam_t), intent(in) :: beams(:)   !! (bodies) stiffnesses
    type(beam_mesh_t), intent(in) :: mesh  !! number of elements
    integer, intent(in), optional :: body  !! only this one; absent: all
    real(wp) :: error

    real(wp) :: length, stiffness
    integer :: i

    error = 0.0_wp
    do i = 1, size(beams)
      if (present(body)) then
        if (i /= body) cycle
      end if
      length = element_length(mesh, linkage, i)
      stiffness = max(2.0_wp*beams(i)%axial_stiffness/length, &
        24.0_wp*beams(i)%bending_stiffness/length**3)
      error = max(error, epsilon(1.0_wp)*stiffness/(linkage%bodies(i)%line_density*length))
    end do
  end function round_off_error

end module round_off
