!> What a gauge shows, from axial strain and curvature at its place.
module gauge_values
  use beam_mesh, only: beam_t
  use kinds, only: wp
  use response_types, only: axial_force, axial_strain, bending_strain, gauge_t, link_section_t, &
    moment, shear_force, strain_values, stress
  implicit none (type, external)
  private

  public :: gauge_values_of

contains

  !> All values of a gauge, in the sense of the deck's link; the shear force is 0 unless given.
  pure function gauge_values_of(gauge, beam, section, axial, curvature, shear) result(values)
    type(gauge_t), intent(in) :: gauge
    type(beam_t), intent(in) :: beam           !! of its link
    type(link_section_t), intent(in) :: section
    real(wp), intent(in) :: axial              !! strain of the axis
    real(wp), intent(in) :: curvature          !! of the body [1/m]
    real(wp), intent(in), optional :: shear    !! force [N]
    real(wp) :: values(strain_values)

    values(axial_strain) = axial
    values(bending_strain) = gauge%side*gauge%sense*section%outer*curvature
    values(moment) = gauge%sense*beam%bending_stiffness*curvature
    values(axial_force) = beam%axial_stiffness*axial
    values(shear_force) = 0.0_wp
    if (present(shear)) values(shear_force) = shear
    values(stress) = section%modulus*(abs(axial) + section%outer*abs(curvature))
  end function gauge_values_of

end module gauge_values
