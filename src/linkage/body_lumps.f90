!> Masses along links that bend: how many there are, and where they sit.
!!
!! A mass point bends a link sharply: its shear force jumps there, and the axial force, too. Where
!! orders are left to the program an element ends at every mass, so that the deformations are smooth
!! inside and polynomials converge as fast as they do without.
module body_lumps
  use kinds, only: wp
  use linkages, only: body_t
  implicit none (type, external)
  private

  public :: lump_count, lump_masses, lump_places, pieces_of, element_of_lump

  !> Masses nearer to each other than this share of the length, or to an end, have no element
  !! between them.
  real(wp), parameter :: least_piece = 1.0e-9_wp

contains

  !> How many lumps a body has.
  pure function lump_count(body) result(number)
    type(body_t), intent(in) :: body
    integer :: number

    number = 0
    if (allocated(body%lumps)) number = size(body%lumps)
  end function lump_count

  !> Masses of the lumps of a body [kg].
  pure function lump_masses(body) result(mass)
    type(body_t), intent(in) :: body
    real(wp), allocatable :: mass(:)

    allocate (mass(0))
    if (allocated(body%lumps)) mass = body%lumps%mass
  end function lump_masses

  !> Their places, from 0 to 1 along the body.
  pure function lump_places(body) result(xi)
    type(body_t), intent(in) :: body
    real(wp), allocatable :: xi(:)

    integer :: i

    allocate (xi(0))
    if (allocated(body%lumps)) xi = [(body%lumps(i)%place(1)/body%length, i=1, size(body%lumps))]
  end function lump_places

  !> Ends of the elements that have no mass inside, from 0 to 1 along the body.
  pure function pieces_of(body) result(ends)
    type(body_t), intent(in) :: body
    real(wp), allocatable :: ends(:)

    real(wp), allocatable :: xi(:)
    real(wp) :: next

    xi = lump_places(body)
    ends = [0.0_wp]
    do
      next = minval(xi, mask=xi >= ends(size(ends)) + least_piece)
      if (next > 1.0_wp - least_piece) exit
      ends = [ends, next]
    end do
    ends = [ends, 1.0_wp]
  end function pieces_of

  !> The element of a mesh of equal elements that a mass is in, or at whose last end it sits, and
  !! its place there, from 0 to 1.
  pure subroutine element_of_lump(xi, elements, element, place)
    real(wp), intent(in) :: xi       !! from 0 to 1 along the link
    integer, intent(in) :: elements
    integer, intent(out) :: element
    real(wp), intent(out) :: place

    element = max(1, min(elements, ceiling(xi*elements)))
    place = min(1.0_wp, max(0.0_wp, xi*elements - (element - 1)))
  end subroutine element_of_lump

end module body_lumps
