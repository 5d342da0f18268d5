!> A link's own deformations as unknowns: Legendre coefficients of its curvature and strain, element by element.
!!
!! Scaled as here, these unknowns have the elastic energy `½ yᵀy`: the stiffness matrix is the unit matrix, exact and the same at
!! every position. In an element of length h the curvature is `v'' = Σ y_j √((2j+1)/(EI h)) P_j`, and the strain likewise with EA.
!! Displacements are counted from the chord: they vanish at both ends of the link.
module deformation_shapes
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values, twice_integrated
  implicit none (type, external)
  private

  public :: deformation_shapes_t, bending_shapes, axial_shapes, displacement_row, slope_row, curve, once_integrated

  !> What every unknown does. A function of the place is held as its Legendre coefficients in every element, one after the other,
  !! each coefficient times √(μ h/(2j+1)): then `∫ μ f g dx` is the scalar product.
  type :: deformation_shapes_t
    real(wp) :: length = 0.0_wp                  !! of the link [m]
    integer :: elements = 0
    integer :: coefficients = 0                  !! of the displacement in an element
    integer :: unknowns = 0
    real(wp), allocatable :: displacement(:, :)  !! (coefficients × elements, unknowns) scaled
    real(wp), allocatable :: linear(:, :)        !! (coefficients × elements, 2) the functions 1 − ξ and ξ, scaled
    real(wp), allocatable :: weight(:)           !! (coefficients) the scale √(μ h/(2j+1))
    real(wp), allocatable :: start_slope(:)      !! (unknowns) v' at the link's first end; bending only
    real(wp), allocatable :: slope(:, :)         !! (Gauss points, unknowns) v' times √(Gauss weight); bending only
    real(wp), allocatable :: place(:)            !! (Gauss points) ξ, from 0 to 1 along the link
    real(wp), allocatable :: root(:)             !! (Gauss points) √(Gauss weight) [√m]
  end type deformation_shapes_t

contains

  !> Unknowns of the transverse displacement of polynomial degree `order` in every element: `order − 1` an element.
  pure function bending_shapes(length, line_density, bending_stiffness, elements, order) result(shapes)
    real(wp), intent(in) :: length            !! [m]
    real(wp), intent(in) :: line_density      !! μ [kg/m]
    real(wp), intent(in) :: bending_stiffness !! EI [N m²]
    integer, intent(in) :: elements
    integer, intent(in) :: order              !! at least 3
    type(deformation_shapes_t) :: shapes

    real(wp) :: h, scale, end_value, end_slope, chord, coefficient(0:order), slope_coefficient(0:order), line(0:1)
    integer :: e, j, k, column

    shapes = empty_shapes(length, line_density, elements, order + 1, elements*(order - 1))
    h = length/elements
    allocate (shapes%start_slope(shapes%unknowns))
    call place_gauss_points(shapes, order + 1)
    allocate (shapes%slope(size(shapes%place), shapes%unknowns))
    do e = 1, elements
      do j = 0, order - 2
        column = (e - 1)*(order - 1) + j + 1
        scale = 0.5_wp*h*sqrt((2*j + 1)/(bending_stiffness*h))
        slope_coefficient = 0.0_wp
        slope_coefficient(:j + 1) = scale*once_integrated(j)
        coefficient = 0.0_wp
        coefficient(:j + 2) = 0.5_wp*h*scale*curve(j)
        ! Beyond its element a curvature P_0 has turned the link, and P_0 and P_1 have moved it; the chord takes both back.
        end_slope = merge(2.0_wp*scale, 0.0_wp, j == 0)
        end_value = 0.5_wp*h*scale*merge(2.0_wp - 8.0_wp/3.0_wp*j, 0.0_wp, j < 2)
        chord = (end_value + end_slope*h*(elements - e))/length
        shapes%start_slope(column) = -chord
        do k = 1, elements
          line = -chord*h*[k - 0.5_wp, 0.5_wp]
          if (k > e) line = line + [end_value + end_slope*h*(k - e - 0.5_wp), 0.5_wp*h*end_slope]
          call set_element(shapes, k, column, line, slope=-chord + merge(end_slope, 0.0_wp, k > e))
        end do
        call add_in_element(shapes, e, column, coefficient, slope_coefficient)
      end do
    end do
  end function bending_shapes

  !> Unknowns of the axial displacement of polynomial degree `degree` in every element. The elongation of the link as a whole is not
  !! among them: the uniform strain is taken out, and the displacement vanishes at both ends.
  pure function axial_shapes(length, line_density, axial_stiffness, elements, degree) result(shapes)
    real(wp), intent(in) :: length          !! [m]
    real(wp), intent(in) :: line_density    !! μ [kg/m]
    real(wp), intent(in) :: axial_stiffness !! EA [N]
    integer, intent(in) :: elements
    integer, intent(in) :: degree           !! at least 1
    type(deformation_shapes_t) :: shapes

    real(wp) :: h, scale, elongation
    integer :: e, j, k, column

    shapes = empty_shapes(length, line_density, elements, degree + 1, elements*degree - 1)
    h = length/elements
    column = 0
    ! Uniform strains of the elements that add up to nothing: e of them stretched, the next one shortened by as much.
    do e = 1, elements - 1
      column = column + 1
      elongation = h/sqrt(axial_stiffness*h*e*(e + 1.0_wp))
      do k = 1, elements
        if (k <= e) call set_element(shapes, k, column, elongation*[k - 0.5_wp, 0.5_wp])
        if (k == e + 1) call set_element(shapes, k, column, elongation*e*[0.5_wp, -0.5_wp])
      end do
    end do
    do e = 1, elements
      do j = 1, degree - 1
        column = column + 1
        scale = 0.5_wp*h*sqrt((2*j + 1)/(axial_stiffness*h))
        call add_in_element(shapes, e, column, scale*once_integrated(j))
      end do
    end do
  end function axial_shapes

  pure function empty_shapes(length, line_density, elements, coefficients, unknowns) result(shapes)
    real(wp), intent(in) :: length, line_density
    integer, intent(in) :: elements, coefficients, unknowns
    type(deformation_shapes_t) :: shapes

    real(wp) :: h
    integer :: j, k

    shapes%length = length
    shapes%elements = elements
    shapes%coefficients = coefficients
    shapes%unknowns = unknowns
    h = length/elements
    shapes%weight = [(sqrt(line_density*h/(2*j + 1)), j=0, coefficients - 1)]
    allocate (shapes%displacement(coefficients*elements, unknowns), shapes%linear(coefficients*elements, 2))
    shapes%displacement = 0.0_wp
    shapes%linear = 0.0_wp
    do k = 1, elements
      associate (row => (k - 1)*coefficients)
        shapes%linear(row + 1:row + 2, 1) = shapes%weight(1:2)*[1.0_wp - (k - 0.5_wp)/elements, -0.5_wp/elements]
        shapes%linear(row + 1:row + 2, 2) = shapes%weight(1:2)*[(k - 0.5_wp)/elements, 0.5_wp/elements]
      end associate
    end do
  end function empty_shapes

  !> Gauss points of all elements, enough for `∫ N v'²` with a quadratic N.
  pure subroutine place_gauss_points(shapes, points)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: points !! an element

    real(wp) :: x(points), w(points)
    integer :: k

    call gauss_rule(x, w)
    allocate (shapes%place(points*shapes%elements), shapes%root(points*shapes%elements))
    do k = 1, shapes%elements
      shapes%place((k - 1)*points + 1:k*points) = (k - 0.5_wp + 0.5_wp*x)/shapes%elements
      shapes%root((k - 1)*points + 1:k*points) = sqrt(0.5_wp*shapes%length/shapes%elements*w)
    end do
  end subroutine place_gauss_points

  !> Gives an unknown a linear displacement in an element, `line(0) + line(1) ζ`, and its slope.
  pure subroutine set_element(shapes, element, column, line, slope)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: element, column
    real(wp), intent(in) :: line(0:1)
    real(wp), intent(in), optional :: slope

    integer :: row, points

    row = (element - 1)*shapes%coefficients
    shapes%displacement(row + 1:row + 2, column) = shapes%weight(1:2)*line
    if (.not. present(slope)) return
    points = size(shapes%place)/shapes%elements
    associate (here => (element - 1)*points)
      shapes%slope(here + 1:here + points, column) = slope*shapes%root(here + 1:here + points)
    end associate
  end subroutine set_element

  !> Adds what an unknown does in its own element.
  pure subroutine add_in_element(shapes, element, column, coefficient, slope_coefficient)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: element, column
    real(wp), intent(in) :: coefficient(0:)
    real(wp), intent(in), optional :: slope_coefficient(0:)

    real(wp) :: zeta
    integer :: row, points, i

    row = (element - 1)*shapes%coefficients
    associate (entry => shapes%displacement(row + 1:row + size(coefficient), column))
      entry = entry + shapes%weight(:size(coefficient))*coefficient
    end associate
    if (.not. present(slope_coefficient)) return
    points = size(shapes%place)/shapes%elements
    do i = (element - 1)*points + 1, element*points
      zeta = 2.0_wp*(shapes%place(i)*shapes%elements - (element - 0.5_wp))
      shapes%slope(i, column) = shapes%slope(i, column) + shapes%root(i)* &
        dot_product(slope_coefficient, legendre_values(size(slope_coefficient) - 1, zeta))
    end do
  end subroutine add_in_element

  !> Legendre coefficients of `∫ P_j` from −1.
  pure function once_integrated(j) result(coefficient)
    integer, intent(in) :: j
    real(wp) :: coefficient(0:j + 1)

    coefficient = 0.0_wp
    coefficient(j + 1) = 1.0_wp/(2*j + 1)
    if (j == 0) coefficient(0) = 1.0_wp
    if (j > 0) coefficient(j - 1) = -1.0_wp/(2*j + 1)
  end function once_integrated

  !> Legendre coefficients of `∫∫ P_j`, both from −1.
  pure function curve(j) result(coefficient)
    integer, intent(in) :: j
    real(wp) :: coefficient(0:j + 2)

    coefficient = 0.0_wp
    select case (j)
    case (0)
      coefficient = [2.0_wp/3.0_wp, 1.0_wp, 1.0_wp/3.0_wp]
    case (1)
      coefficient = [-1.0_wp/3.0_wp, -0.4_wp, 0.0_wp, 1.0_wp/15.0_wp]
    case default
      coefficient(j - 2:j + 2:2) = twice_integrated(j)
    end select
  end function curve

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

end module deformation_shapes
