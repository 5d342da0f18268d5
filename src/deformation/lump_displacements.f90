!> Contribution of masses along a link to the mass matrix of its deformations.
module lump_displacements
  use body_lumps, only: lump_masses, lump_places
  use deformation_places, only: displacement_row
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  use linkages, only: body_t
  implicit none (type, external)
  private

  public :: add_lump_displacements

contains

  !> Adds rows for the masses along a link: the displacement there times the root of the mass.
  !! Scalar products of columns then include these masses.
  pure subroutine add_lump_displacements(body, shapes)
    type(body_t), intent(in) :: body                    !! the masses
    type(deformation_shapes_t), intent(inout) :: shapes !! of this body, without lumps

    real(wp), allocatable :: mass(:), xi(:), displacement(:, :), linear(:, :)
    integer :: i, rows

    mass = lump_masses(body)
    if (size(mass) == 0) return
    xi = lump_places(body)
    rows = size(shapes%displacement, 1)
    shapes%lumps = size(mass)
    allocate (displacement(rows + size(mass), shapes%unknowns), linear(rows + size(mass), 2))
    displacement(:rows, :) = shapes%displacement
    linear(:rows, :) = shapes%linear
    do i = 1, size(mass)
      displacement(rows + i, :) = sqrt(mass(i))*displacement_row(shapes, xi(i))
      linear(rows + i, :) = sqrt(mass(i))*[1.0_wp - xi(i), xi(i)]
    end do
    call move_alloc(displacement, shapes%displacement)
    call move_alloc(linear, shapes%linear)
  end subroutine add_lump_displacements

end module lump_displacements
