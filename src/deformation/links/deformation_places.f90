!> Displacement, slope and rotation that the deformations of a link cause at a place along it.
module deformation_places
  use deformation_shapes, only: deformation_shapes_t, shear_scale
  use kinds, only: wp
  use legendre, only: legendre_values
  implicit none (type, external)
  private

  public :: displacement_row, slope_row, rotation_row

contains

  !> Displacement at a place per unit of every unknown.
  pure function displacement_row(shapes, xi) result(row)
    type(deformation_shapes_t), intent(in) :: shapes !! bending or axial
    real(wp), intent(in) :: xi                       !! from 0 to 1 along the link
    real(wp) :: row(shapes%unknowns)                 !! (unknowns) [m/√J]

    real(wp) :: zeta
    integer :: element, first

    call find_element(shapes, xi, element, zeta)
    first = (element - 1)*shapes%coefficients + 1
    row = matmul(legendre_values(shapes%coefficients - 1, &
      zeta)/(sqrt(shapes%part(element))*shapes%weight), shapes%displacement(first:first + &
      shapes%coefficients - 1, :))
  end function displacement_row

  !> Slope v' at a place per unit of every unknown.
  pure function slope_row(shapes, xi) result(row)
    type(deformation_shapes_t), intent(in) :: shapes !! bending
    real(wp), intent(in) :: xi                       !! from 0 to 1 along the link
    real(wp) :: row(shapes%unknowns)                 !! (unknowns) [rad/√J]

    real(wp) :: zeta, derivative(0:shapes%coefficients - 1), p(0:shapes%coefficients - 1)
    integer :: element, first, j

    call find_element(shapes, xi, element, zeta)
    first = (element - 1)*shapes%coefficients + 1
    p = legendre_values(shapes%coefficients - 1, zeta)
    derivative(:1) = [0.0_wp, 1.0_wp]
    do j = 2, shapes%coefficients - 1
      derivative(j) = derivative(j - 2) + (2*j - 1)*p(j - 1)
    end do
    row = matmul(derivative/(sqrt(shapes%part(element))*shapes%weight)* &
      (2.0_wp*shapes%elements/shapes%length/shapes%part(element)), &
      shapes%displacement(first:first + shapes%coefficients - 1, :))
  end function slope_row

  !> Rotation θ of the cross-section at a place per unit of every unknown: the slope without the
  !! shear strain.
  pure function rotation_row(shapes, xi) result(row)
    type(deformation_shapes_t), intent(in) :: shapes !! bending
    real(wp), intent(in) :: xi                       !! from 0 to 1 along the link
    real(wp) :: row(shapes%unknowns)                 !! (unknowns) [rad/√J]

    real(wp) :: zeta, h, p(0:shapes%coefficients - 1)
    integer :: element, j, column

    row = slope_row(shapes, xi)
    if (shapes%shear_stiffness <= 0.0_wp) return
    call find_element(shapes, xi, element, zeta)
    h = shapes%length/shapes%elements*shapes%part(element)
    p = legendre_values(shapes%coefficients - 1, zeta)
    do j = 0, ubound(shapes%column, 1)
      if (shapes%column(j, element) == 0) cycle
      column = shapes%column(j, element) + 1
      row(column) = row(column) - shear_scale(j, shapes%shear_stiffness, h)*p(j)
    end do
  end function rotation_row

  !> The element that a place is in, and the place in the element, from −1 to 1.
  pure subroutine find_element(shapes, xi, element, zeta)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: xi
    integer, intent(out) :: element
    real(wp), intent(out) :: zeta

    element = 1 + count(shapes%last(1:shapes%elements - 1) <= xi*shapes%elements)
    zeta = 2.0_wp*(xi*shapes%elements - shapes%middle(element))/shapes%part(element)
  end subroutine find_element

end module deformation_places
