!> The smooth beginning of a contact: how deep it counts to be.
!!
!! With the depth d and the width w, ramp(d) = 0 before contact, w (x³ − ½x⁴) with x = d/w within
!! the width, d − ½w beyond it: continuous with two derivatives, never negative, and linear where
!! the contact is more than w deep. No step of an integration sees a corner.
module contacts
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: contact_ramp, contact_slope, contact_energy

contains

  !> ramp(d) [m] or [rad].
  elemental function contact_ramp(depth, width) result(ramp)
    real(wp), intent(in) :: depth !! d [m] or [rad]
    real(wp), intent(in) :: width !! w; 0: a corner
    real(wp) :: ramp

    real(wp) :: x

    if (depth <= 0.0_wp) then
      ramp = 0.0_wp
    else if (depth >= width) then
      ramp = depth - 0.5_wp*width
    else
      x = depth/width
      ramp = width*x**3*(1.0_wp - 0.5_wp*x)
    end if
  end function contact_ramp

  !> Its derivative, from 0 to 1.
  elemental function contact_slope(depth, width) result(slope)
    real(wp), intent(in) :: depth, width !! as of `contact_ramp`
    real(wp) :: slope

    real(wp) :: x

    if (depth <= 0.0_wp) then
      slope = 0.0_wp
    else if (depth >= width) then
      slope = 1.0_wp
    else
      x = depth/width
      slope = x**2*(3.0_wp - 2.0_wp*x)
    end if
  end function contact_slope

  !> Its integral from 0 [m²] or [rad²].
  elemental function contact_energy(depth, width) result(energy)
    real(wp), intent(in) :: depth, width !! as of `contact_ramp`
    real(wp) :: energy

    real(wp) :: x

    if (depth <= 0.0_wp) then
      energy = 0.0_wp
    else if (depth >= width) then
      energy = 0.5_wp*(depth - 0.5_wp*width)**2 + 0.025_wp*width**2
    else
      x = depth/width
      energy = width**2*x**4*(0.25_wp - 0.1_wp*x)
    end if
  end function contact_energy

end module contacts
