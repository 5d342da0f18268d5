!> Contributions to the matrices of a beam element from a mass or a force at a place inside it.
module element_places
  use beam_element, only: reference_element_t, with_lengths
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values
  implicit none (type, external)
  private

  public :: element_point_mass, element_point_rotation, element_stiffness_to

contains

  !> `NᵀN` of the displacements of a unit mass at a place, beside the axis by an offset e and fixed
  !! to the cross-section: u − e θ along the element, v across it.
  pure function element_point_mass(reference, length, xi, offset) result(mass)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: length !! of the element [m]
    real(wp), intent(in) :: xi     !! place, from 0 to 1 along the element
    real(wp), intent(in), optional :: offset !! e, to the left of the element [m]; absent: 0
    real(wp) :: mass(size(reference%mass, 1), size(reference%mass, 2)) !! [-, m, m²]

    real(wp) :: p(0:reference%order), along(size(reference%mass, 1))

    p = legendre_values(reference%order, 2.0_wp*xi - 1.0_wp)
    along = matmul(p, reference%shape(:, :, 1))
    if (present(offset)) along = along - offset/length*matmul(p, reference%shape(:, :, 4))
    mass = with_lengths(square(along) + square(matmul(p, reference%shape(:, :, 2))), length)
  end function element_point_mass

  !> `NᵀN` of the rotation θ of the cross-section at a place.
  pure function element_point_rotation(reference, length, xi) result(inertia)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: length !! of the element [m]
    real(wp), intent(in) :: xi     !! place, from 0 to 1 along the element
    real(wp) :: inertia(size(reference%mass, 1), size(reference%mass, 2)) !! [1/m², 1/m, -]

    inertia = with_lengths(square(matmul(legendre_values(reference%order, 2.0_wp*xi - 1.0_wp), &
      reference%shape(:, :, 4)))/length**2, length)
  end function element_point_rotation

  !> Geometric stiffness `∫ v'² dx` of a unit axial force that acts from the first node up to a
  !! place.
  pure function element_stiffness_to(reference, length, xi) result(stiffness)
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
  end function element_stiffness_to

  pure function square(row)
    real(wp), intent(in) :: row(:)
    real(wp) :: square(size(row), size(row))

    square = spread(row, 2, size(row))*spread(row, 1, size(row))
  end function square

end module element_places
