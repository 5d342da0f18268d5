!> What the deformations of a link do at a place.
module deformation_places
  use deformation_shapes, only: deformation_shapes_t, shear_scale
  use kinds, only: wp
  use legendre, only: legendre_values
  implicit none (type, external)
  private

  public :: displacement_row, slope_row, rotation_row

contains

  !> Displacement that a unit of every unknown gives a place.
  pure function displacement_row(shapes, xi) result(row)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: xi !! from 0 to 1 along the link
    real(wp) :: row(shapes%unknowns)

    real(wp) :: zeta
    integer :: first

    call find_element(shapes, xi, first, zeta)
    row = matmul(legendre_values(shapes%coefficients - 1, zeta)/shapes%weight, &
      shapes%displacement(first:first + shapes%coefficients - 1, :))
  end function displacement_row

  !> Slope v' that a unit of every unknown gives a place.
  pure function slope_row(shapes, xi) result(row)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: xi !! from 0 to 1 along the link
    real(wp) :: row(shapes%unknowns)

    real(wp) :: zeta, derivative(0:shapes%coefficients - 1), p(0:shapes%coefficients - 1)
    integer :: first, j

    call find_element(shapes, xi, first, zeta)
    p = legendre_values(shapes%coefficients - 1, zeta)
    derivative(:1) = [0.0_wp, 1.0_wp]
    do j = 2, shapes%coefficients - 1
      derivative(j) = derivative(j - 2) + (2*j - 1)*p(j - 1)
    end do
    row = matmul(derivative/shapes%weight*(2.0_wp*shapes%elements/shapes%length), &
      shapes%displacement(first:first + shapes%coefficients - 1, :))
  end function slope_row

  !> Rotation θ of the cross-section that a unit of every unknown gives a place: the slope without the shear strain.
  pure function rotation_row(shapes, xi) result(row)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: xi !! from 0 to 1 along the link
    real(wp) :: row(shapes%unknowns)

    real(wp) :: zeta, h, p(0:shapes%coefficients - 1)
    integer :: first, j, in_element, column

    row = slope_row(shapes, xi)
    if (shapes%shear_stiffness <= 0.0_wp) return
    call find_element(shapes, xi, first, zeta)
    h = shapes%length/shapes%elements
    p = legendre_values(shapes%coefficients - 1, zeta)
    in_element = shapes%unknowns/shapes%elements
    column = (first - 1)/shapes%coefficients*in_element
    do j = 0, in_element/2 - 1
      row(column + 2*j + 2) = row(column + 2*j + 2) - shear_scale(j, shapes%shear_stiffness, h)*p(j)
    end do
  end function rotation_row

  !> The element of a place: its first row in `displacement`, and the place in it from −1 to 1.
  pure subroutine find_element(shapes, xi, first, zeta)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: xi
    integer, intent(out) :: first
    real(wp), intent(out) :: zeta

    integer :: element

    element = max(1, min(shapes%elements, 1 + int(xi*shapes%elements)))
    first = (element - 1)*shapes%coefficients + 1
    zeta = 2.0_wp*(xi*shapes%elements - (element - 0.5_wp))
  end subroutine find_element

end module deformation_places
