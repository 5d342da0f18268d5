!> Masses along links that bend, and places where forces act on them: their number and their places.
!!
!! A mass point bends a link sharply: the shear force jumps there, and so does the axial force.
!! Where the program chooses the orders, an element ends at every mass. Deformations are then smooth
!! inside each element, and polynomials converge as fast as without masses. The place of a force is
!! a lump without mass, behind the masses in the order of lumps.
module body_lumps
  use kinds, only: wp
  use linkages, only: body_t
  implicit none (type, external)
  private

  public :: lump_count, lump_masses, lump_places, lump_offsets, lump_inertias, has_turning_lumps, &
    force_functions_of, pieces_of, element_of_lump

  !> Masses nearer to each other or to an end than this share of the length have no element between
  !! them.
  real(wp), parameter :: least_piece = 1.0e-9_wp

contains

  !> Number of lumps of a body: its masses and the places of forces.
  pure function lump_count(body) result(number)
    type(body_t), intent(in) :: body !! its masses and forces
    integer :: number

    number = mass_count(body) + force_count(body)
  end function lump_count

  pure function mass_count(body) result(number)
    type(body_t), intent(in) :: body
    integer :: number

    number = 0
    if (allocated(body%lumps)) number = size(body%lumps)
  end function mass_count

  pure function force_count(body) result(number)
    type(body_t), intent(in) :: body
    integer :: number

    number = 0
    if (allocated(body%forced)) number = size(body%forced)
  end function force_count

  !> Masses of the lumps of a body, in the order of its lumps [kg].
  pure function lump_masses(body) result(mass)
    type(body_t), intent(in) :: body !! its masses and forces
    real(wp), allocatable :: mass(:)

    allocate (mass(lump_count(body)), source=0.0_wp)
    if (allocated(body%lumps)) mass(:size(body%lumps)) = body%lumps%mass
  end function lump_masses

  !> Places of the lumps along a body, from 0 to 1, in the order of its lumps.
  pure function lump_places(body) result(xi)
    type(body_t), intent(in) :: body !! its masses and forces
    real(wp), allocatable :: xi(:)

    xi = coordinates(body, 1)/body%length
  end function lump_places

  !> Distances of the lumps of a body from its axis, to its left, in the order of its lumps [m].
  pure function lump_offsets(body) result(offset)
    type(body_t), intent(in) :: body !! its masses and forces
    real(wp), allocatable :: offset(:)

    offset = coordinates(body, 2)
  end function lump_offsets

  pure function coordinates(body, axis) result(x)
    type(body_t), intent(in) :: body
    integer, intent(in) :: axis !! 1: along the body, 2: across it
    real(wp), allocatable :: x(:)

    integer :: i

    allocate (x(lump_count(body)))
    do i = 1, mass_count(body)
      x(i) = body%lumps(i)%place(axis)
    end do
    do i = 1, force_count(body)
      x(mass_count(body) + i) = body%forced(i)%place(axis)
    end do
  end function coordinates

  !> Moments of inertia of the lumps of a body, each about its own mass centre [kg m²].
  pure function lump_inertias(body) result(inertia)
    type(body_t), intent(in) :: body !! its masses and forces
    real(wp), allocatable :: inertia(:)

    allocate (inertia(lump_count(body)), source=0.0_wp)
    if (allocated(body%lumps)) inertia(:size(body%lumps)) = body%lumps%inertia
  end function lump_inertias

  !> Whether a body has lumps that feel the rotation of its cross-sections: beside its axis, where
  !! they couple its bending with its elongation, or with a moment of inertia of their own.
  pure function has_turning_lumps(body) result(has)
    type(body_t), intent(in) :: body !! its lumps
    logical :: has

    has = any(abs(lump_offsets(body)) > 0.0_wp .or. lump_inertias(body) > 0.0_wp)
  end function has_turning_lumps

  !> Number of functions that the lumps of a body add to those of which its axial force is made: a
  !! jump each and, if any turns with its cross-section, what this turns against.
  pure function force_functions_of(body) result(number)
    type(body_t), intent(in) :: body !! its lumps
    integer :: number

    number = lump_count(body)
    if (has_turning_lumps(body)) number = 2*number
  end function force_functions_of

  !> Ends of elements that have no mass inside, from 0 to 1 along the body: 0, the places of the
  !! masses, 1.
  pure function pieces_of(body) result(ends)
    type(body_t), intent(in) :: body !! its length and lumps
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

  !> Finds the element that contains a mass, on a mesh of equal elements, and the place of the mass
  !! in it. A mass on a node belongs to the element that ends there.
  pure subroutine element_of_lump(xi, elements, element, place)
    real(wp), intent(in) :: xi      !! from 0 to 1 along the link
    integer, intent(in) :: elements !! number of equal elements on the link
    integer, intent(out) :: element !! number on the link, from 1
    real(wp), intent(out) :: place  !! from 0 to 1 along the element

    element = max(1, min(elements, ceiling(xi*elements)))
    place = min(1.0_wp, max(0.0_wp, xi*elements - (element - 1)))
  end subroutine element_of_lump

end module body_lumps
