!> Contributions to the matrices of a beam element from a mass or a force at a place inside it.
module element_places
  use beam_element, only: reference_element_t, with_lengths
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values
  implicit none (type, external)
  private

  public :: element_point_mass, element_part_stiffness

contains

  !> `NᵀN` of the displacements along and across the element at a place: the mass matrix of a unit
  !! mass there.
  pure function element_point_mass(reference, length, xi) result(mass)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: length !! of the element [m]
    real(wp), intent(in) :: xi     !! place, from 0 to 1 along the element
    real(wp) :: mass(size(reference%mass, 1), size(reference%mass, 2)) !! [-, m, m²]

    real(wp) :: p(0:reference%order)

    p = legendre_values(reference%order, 2.0_wp*xi - 1.0_wp)
    mass = with_lengths(square(matmul(p, reference%shape(:, :, 1))) + &
      square(matmul(p, reference%shape(:, :, 2))), length)
  end function element_point_mass

  !> Geometric stiffness `∫ v'² dx` of a unit axial force that acts from the first node up to a
  !! place.
  pure function element_part_stiffness(reference, length, xi) result(stiffness)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: length !! of the element [m]
    real(wp), intent(in) :: xi     !! place, from 0 to 1 along the element
    real(wp) :: stiffness(size(reference%mass, 1), size(reference%mass, 2)) !! [1/m, -, m]

    real(wp) :: x(reference%order + 1), w(reference%order + 1)
    integer :: i

    call gauss_rule(x, w)
    stiffness = 0.0_wp
    do i = 1, size(x)
      stiffness = stiffness + 0.5_wp*xi*w(i)*square(matmul(legendre_values(reference%order, &
        xi*(1.0_wp + x(i)) - 1.0_wp), reference%shape(:, :, 3)))
    end do
    stiffness = with_lengths(stiffness/length, length)
  end function element_part_stiffness

  pure function square(row)
    real(wp), intent(in) :: row(:)
    real(wp) :: square(size(row), size(row))

    square = spread(row, 2, size(row))*spread(row, 1, size(row))
  end function square

end module element_places
