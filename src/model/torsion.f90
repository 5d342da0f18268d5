!> Bending out of the plane of motion and torsion of sections.
module torsion
  use constants, only: pi
  use kinds, only: wp
  use sections, only: section_t, shape_circle, shape_rectangle, shape_tube
  implicit none (type, external)
  private

  public :: rectangle_torsion_constant, torsion_constant, out_of_plane_second_moment

contains

  !> Torsion constant J of a rectangle after St. Venant, GJ being the stiffness [m⁴]: with sides
  !! a ≥ b `a b³ (1/3 − 64 b/(π⁵ a) Σ tanh(nπa/2b)/n⁵)`, n = 1, 3, 5, …
  !!
  !! Σ 1/n⁵ is known, and `1 − tanh` falls exponentially.
  elemental function rectangle_torsion_constant(side, other_side) result(constant)
    real(wp), intent(in) :: side, other_side !! above 0 [m]
    real(wp) :: constant

    real(wp), parameter :: sum_of_powers = 31.0_wp/32.0_wp*1.0369277551433699263_wp
    integer, parameter :: last = 21
    !> Beyond this exponent nothing is left of a term, and `exp` might overflow.
    real(wp), parameter :: no_more = 100.0_wp
    real(wp) :: a, b, total
    integer :: n

    a = max(side, other_side)
    b = min(side, other_side)
    total = sum_of_powers
    do n = 1, last, 2
      if (n*pi*a/b > no_more) exit
      total = total - 2.0_wp/((1.0_wp + exp(n*pi*a/b))*real(n, wp)**5)
    end do
    constant = a*b**3*(1.0_wp/3.0_wp - 64.0_wp*b/(pi**5*a)*total)
  end function rectangle_torsion_constant

  !> Torsion constant of a section [m⁴]; 0 if it is none of rectangle, circle and tube.
  elemental function torsion_constant(section) result(constant)
    type(section_t), intent(in) :: section !! as read
    real(wp) :: constant

    constant = 0.0_wp
    select case (section%shape)
    case (shape_rectangle)
      constant = rectangle_torsion_constant(section%depth, section%area/section%depth)
    case (shape_circle, shape_tube)
      constant = 2.0_wp*section%second_moment
    end select
  end function torsion_constant

  !> Second moment of area for bending out of the plane [m⁴]; 0 if the section is none of rectangle,
  !! circle and tube.
  elemental function out_of_plane_second_moment(section) result(moment)
    type(section_t), intent(in) :: section !! as read
    real(wp) :: moment

    moment = 0.0_wp
    select case (section%shape)
    case (shape_rectangle)
      moment = section%area**3/(12.0_wp*section%depth**2)
    case (shape_circle, shape_tube)
      moment = section%second_moment
    end select
  end function out_of_plane_second_moment

end module torsion
