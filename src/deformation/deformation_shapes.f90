!> A link's own deformations as unknowns: Legendre coefficients of its curvature, shear strain and
!! axial strain, element by element.
!!
!! Scaled as here, these unknowns have the elastic energy `½ yᵀy`: the stiffness matrix is the unit
!! matrix, exact and the same at every position. In an element of length h the curvature is `θ' = Σ
!! y_j √((2j+1)/(EI h)) P_j`, the shear strain `v' − θ` likewise with kGA, the axial strain with EA.
!! θ is the rotation of cross-sections; without shear it is v'. Displacements are counted from the
!! chord: they vanish at both ends of the link. Elements are equal, or end where they are told to.
module deformation_shapes
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values, once_integrated, twice_integrated
  implicit none (type, external)
  private

  public :: deformation_shapes_t, bending_shapes, axial_shapes, bending_unknowns, bending_column, &
    shear_scale

  !> What every unknown does. A function of the place is held as its Legendre coefficients in every
  !! element, one after the other, each coefficient times √(μ h/(2j+1)): then `∫ μ f g dx` is the
  !! scalar product. With rotary inertia those of its rotation follow, times √(ρI h/(2j+1)), and the
  !! scalar product is `∫ μ f g + ρI θ_f θ_g dx`.
  type :: deformation_shapes_t
    real(wp) :: length = 0.0_wp                  !! of the link [m]
    real(wp) :: shear_stiffness = 0.0_wp         !! kGA [N]; 0: rigid in shear
    integer :: elements = 0
    logical :: by_degree = .false.               !! unknowns of all elements degree by degree, and
                                                 !! not element by element
    real(wp), allocatable :: last(:)             !! (0:elements) place of the last end of each
                                                 !! element, in mean elements
    real(wp), allocatable :: part(:)             !! (elements) length of each, in mean elements
    real(wp), allocatable :: middle(:)           !! (elements) place of its middle, in mean elements
    integer :: coefficients = 0                  !! of the displacement in an element
    integer :: rotations = 0                     !! coefficients of the rotation in an element; none
                                                 !! without rotary inertia
    integer :: lumps = 0                         !! masses besides that of the link, see
                                                 !! `lump_displacements`
    integer :: unknowns = 0
    !> (coefficients × elements, then rotations × elements, then lumps; unknowns) scaled
    real(wp), allocatable :: displacement(:, :)
    real(wp), allocatable :: linear(:, :)        !! (as displacement, 2) the functions 1 − ξ and ξ,
                                                 !! scaled
    real(wp), allocatable :: weight(:)           !! (coefficients) the scale √(μ h/(2j+1)) of a mean
                                                 !! element
    real(wp), allocatable :: rotation_weight(:)  !! (rotations) the scale √(ρI h/(2j+1)) of a mean
                                                 !! element
    real(wp), allocatable :: start_slope(:)      !! (unknowns) θ at the link's first end; bending
                                                 !! only
    real(wp), allocatable :: slope(:, :)         !! (Gauss points, unknowns) v' times √(Gauss
                                                 !! weight); bending only
    integer, allocatable :: first_point(:)       !! (elements + 1) number of the first Gauss point
                                                 !! of each
    real(wp), allocatable :: place(:)            !! (Gauss points) ξ, from 0 to 1 along the link
    real(wp), allocatable :: root(:)             !! (Gauss points) √(Gauss weight) [√m]
  end type deformation_shapes_t

contains

  !> Unknowns of an element whose transverse displacement is of degree `order`: curvatures of degree
  !! 0 to order − 2, and with shear as many shear strains, each after the curvature of its degree.
  elemental function bending_unknowns(order, sheared) result(unknowns)
    integer, intent(in) :: order
    logical, intent(in) :: sheared
    integer :: unknowns

    unknowns = merge(2, 1, sheared)*(order - 1)
  end function bending_unknowns

  !> Number of the curvature of degree j in an element; with shear the strain of its degree has the
  !! next one.
  pure function bending_column(shapes, element, j) result(column)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: element, j
    integer :: column

    integer :: kinds

    kinds = merge(2, 1, shapes%shear_stiffness > 0.0_wp)
    column = 1 + merge(kinds*(j*shapes%elements + element - 1), &
      (element - 1)*shapes%unknowns/shapes%elements + kinds*j, shapes%by_degree)
  end function bending_column

  !> `√((2j+1)/(kGA h))`: shear strain P_j of a unit unknown [1/√J].
  elemental function shear_scale(j, shear_stiffness, h) result(scale)
    integer, intent(in) :: j
    real(wp), intent(in) :: shear_stiffness !! kGA [N]
    real(wp), intent(in) :: h               !! [m]
    real(wp) :: scale

    scale = sqrt((2*j + 1)/(shear_stiffness*h))
  end function shear_scale

  !> Unknowns of the transverse displacement of polynomial degree `order` in every element.
  !!
  !! As kGA grows, what the shear strains do vanishes like 1/√kGA, and slender beams remain: nothing
  !! locks.
  pure function bending_shapes(length, line_density, bending_stiffness, elements, order, &
      shear_stiffness, rotary_inertia, ends, cuts) result(shapes)
    real(wp), intent(in) :: length            !! [m]
    real(wp), intent(in) :: line_density      !! μ [kg/m]
    real(wp), intent(in) :: bending_stiffness !! EI [N m²]
    integer, intent(in) :: elements
    integer, intent(in) :: order              !! at least 3
    real(wp), intent(in), optional :: shear_stiffness !! kGA [N]; absent or 0: rigid in shear
    real(wp), intent(in), optional :: rotary_inertia  !! ρI [kg m]; absent or 0: none
    real(wp), intent(in), optional :: ends(0:) !! (0:elements) ξ where elements end, from 0 to 1;
                                               !! absent: they are equal
    real(wp), intent(in), optional :: cuts(:)  !! ξ where the axial force jumps inside elements;
                                               !! absent: nowhere
    type(deformation_shapes_t) :: shapes

    real(wp) :: h, scale, coefficient(0:order), slope_coefficient(0:order)
    integer :: e, j, column
    logical :: sheared

    sheared = .false.
    if (present(shear_stiffness)) sheared = shear_stiffness > 0.0_wp
    shapes = empty_shapes(length, line_density, elements, order + 1, &
      elements*bending_unknowns(order, sheared), rotary_inertia, ends)
    if (sheared) shapes%shear_stiffness = shear_stiffness
    allocate (shapes%start_slope(shapes%unknowns))
    call place_gauss_points(shapes, order + 1, cuts)
    allocate (shapes%slope(size(shapes%place), shapes%unknowns))
    do e = 1, elements
      h = length/elements*shapes%part(e)
      do j = 0, order - 2
        column = bending_column(shapes, e, j)
        scale = 0.5_wp*h*sqrt((2*j + 1)/(bending_stiffness*h))
        slope_coefficient = 0.0_wp
        slope_coefficient(:j + 1) = scale*once_integrated(j)
        coefficient = 0.0_wp
        coefficient(:j + 2) = 0.5_wp*h*scale*twice_integrated(j)
        ! Beyond its element a curvature P_0 has turned the link, and P_0 and P_1 have moved it; the
        ! chord takes both back.
        call add_unknown(shapes, e, column, 0.5_wp*h*scale*merge(2.0_wp - 8.0_wp/3.0_wp*j, 0.0_wp, &
          j < 2), merge(2.0_wp*scale, 0.0_wp, j == 0), coefficient, slope_coefficient, .true.)
        if (.not. sheared) cycle
        column = column + 1
        scale = shear_scale(j, shear_stiffness, h)
        slope_coefficient = 0.0_wp
        slope_coefficient(j) = scale
        coefficient = 0.0_wp
        coefficient(:j + 1) = 0.5_wp*h*scale*once_integrated(j)
        call add_unknown(shapes, e, column, merge(h*scale, 0.0_wp, j == 0), 0.0_wp, coefficient, &
          slope_coefficient, .false.)
      end do
    end do
  end function bending_shapes

  !> What one unknown does along the link: in its element, beyond it, and to the chord.
  pure subroutine add_unknown(shapes, e, column, end_value, end_slope, coefficient, &
    slope_coefficient, turns)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: e, column
    real(wp), intent(in) :: end_value, end_slope   !! displacement and slope at the end of its
                                                   !! element, grown in it
    real(wp), intent(in) :: coefficient(0:), slope_coefficient(0:) !! Legendre coefficients of both
                                                                   !! in it
    logical, intent(in) :: turns                   !! cross-sections follow the slope

    real(wp) :: h, chord, line(0:1)
    integer :: k

    h = shapes%length/shapes%elements
    chord = (end_value + end_slope*h*(shapes%elements - shapes%last(e)))/shapes%length
    shapes%start_slope(column) = -chord
    do k = 1, shapes%elements
      line = -chord*h*[shapes%middle(k), 0.5_wp*shapes%part(k)]
      if (k > e) line = line + [end_value + end_slope*h*(shapes%middle(k) - shapes%last(e)), &
        0.5_wp*h*end_slope*shapes%part(k)]
      call set_element(shapes, k, column, line, slope=-chord + merge(end_slope, 0.0_wp, k > e))
    end do
    call add_in_element(shapes, e, column, coefficient, slope_coefficient, turns)
  end subroutine add_unknown

  !> Unknowns of the axial displacement of polynomial degree `degree` in every element. The
  !! elongation of the link as a whole is not among them: the uniform strain is taken out, and the
  !! displacement vanishes at both ends.
  pure function axial_shapes(length, line_density, axial_stiffness, elements, degree, &
    ends) result(shapes)
    real(wp), intent(in) :: length          !! [m]
    real(wp), intent(in) :: line_density    !! μ [kg/m]
    real(wp), intent(in) :: axial_stiffness !! EA [N]
    integer, intent(in) :: elements
    integer, intent(in) :: degree           !! at least 1
    real(wp), intent(in), optional :: ends(0:) !! as in `bending_shapes`
    type(deformation_shapes_t) :: shapes

    real(wp) :: h, scale, elongation
    integer :: e, j, k, column

    shapes = empty_shapes(length, line_density, elements, degree + 1, elements*degree - 1, &
      ends=ends)
    h = length/elements
    column = 0
    ! Uniform strains of the elements that add up to nothing: e of them stretched, the next one
    ! shortened by as much.
    do e = 1, elements - 1
      column = column + 1
      elongation = h/sqrt(axial_stiffness*h*shapes%last(e)*shapes%last(e + 1)/shapes%part(e + 1))
      do k = 1, elements
        if (k <= e) call set_element(shapes, k, column, elongation*[shapes%middle(k), &
          0.5_wp*shapes%part(k)])
        if (k == e + 1) call set_element(shapes, k, column, elongation*shapes%last(e)*[0.5_wp, &
          -0.5_wp])
      end do
    end do
    do e = 1, elements
      h = length/elements*shapes%part(e)
      do j = 1, degree - 1
        column = elements - 1 + merge((j - 1)*elements + e, (e - 1)*(degree - 1) + j, &
          shapes%by_degree)
        scale = 0.5_wp*h*sqrt((2*j + 1)/(axial_stiffness*h))
        call add_in_element(shapes, e, column, scale*once_integrated(j))
      end do
    end do
  end function axial_shapes

  pure function empty_shapes(length, line_density, elements, coefficients, unknowns, &
    rotary_inertia, ends) result(shapes)
    real(wp), intent(in) :: length, line_density
    integer, intent(in) :: elements, coefficients, unknowns
    real(wp), intent(in), optional :: rotary_inertia
    real(wp), intent(in), optional :: ends(0:)
    type(deformation_shapes_t) :: shapes

    real(wp) :: h
    integer :: j, k

    shapes%length = length
    shapes%elements = elements
    shapes%coefficients = coefficients
    shapes%unknowns = unknowns
    shapes%by_degree = present(ends) .or. elements == 1
    allocate (shapes%last(0:elements))
    shapes%last = [(real(k, wp), k=0, elements)]
    if (present(ends)) shapes%last = elements*ends
    shapes%part = shapes%last(1:) - shapes%last(:elements - 1)
    shapes%middle = 0.5_wp*(shapes%last(:elements - 1) + shapes%last(1:))
    h = length/elements
    shapes%weight = [(sqrt(line_density*h/(2*j + 1)), j=0, coefficients - 1)]
    allocate (shapes%rotation_weight(0))
    if (present(rotary_inertia)) then
      if (rotary_inertia > 0.0_wp) then
        shapes%rotations = coefficients - 1
        shapes%rotation_weight = [(sqrt(rotary_inertia*h/(2*j + 1)), j=0, shapes%rotations - 1)]
      end if
    end if
    allocate (shapes%displacement((coefficients + shapes%rotations)*elements, unknowns))
    allocate (shapes%linear(size(shapes%displacement, 1), 2))
    shapes%displacement = 0.0_wp
    shapes%linear = 0.0_wp
    do k = 1, elements
      associate (row => (k - 1)*coefficients)
        shapes%linear(row + 1:row + 2, 1) = sqrt(shapes%part(k))*shapes%weight(1:2)* &
          [1.0_wp - shapes%middle(k)/elements, -0.5_wp*shapes%part(k)/elements]
        shapes%linear(row + 1:row + 2, 2) = sqrt(shapes%part(k))*shapes%weight(1:2)* &
          [shapes%middle(k)/elements, 0.5_wp*shapes%part(k)/elements]
      end associate
      if (shapes%rotations == 0) cycle
      shapes%linear(first_rotation(shapes, k), :) = &
        sqrt(shapes%part(k))*shapes%rotation_weight(1)/length*[-1.0_wp, 1.0_wp]
    end do
  end function empty_shapes

  !> Row in `displacement` of the first coefficient of the rotation in an element.
  pure function first_rotation(shapes, element) result(row)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: element
    integer :: row

    row = shapes%coefficients*shapes%elements + (element - 1)*shapes%rotations + 1
  end function first_rotation

  !> Gauss points of all elements, enough for `∫ N v'²` with a quadratic N, on either side of every
  !! cut.
  pure subroutine place_gauss_points(shapes, points, cuts)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: points !! an element, or a part of one
    real(wp), intent(in), optional :: cuts(:)

    real(wp) :: x(points), w(points), here(0:1)
    integer :: k

    call gauss_rule(x, w)
    allocate (shapes%place(0), shapes%root(0), shapes%first_point(shapes%elements + 1))
    do k = 1, shapes%elements
      shapes%first_point(k) = size(shapes%place) + 1
      here = shapes%last(k - 1:k)
      if (present(cuts)) then
        do
          here(1) = min(shapes%last(k), minval(shapes%elements*cuts, &
            mask=shapes%elements*cuts > here(0)))
          if (here(1) >= shapes%last(k)) exit
          call add_points(shapes, here, x, w)
          here(0) = here(1)
        end do
      end if
      call add_points(shapes, here, x, w)
    end do
    shapes%first_point(shapes%elements + 1) = size(shapes%place) + 1
  end subroutine place_gauss_points

  !> Those of one interval.
  pure subroutine add_points(shapes, interval, x, w)
    type(deformation_shapes_t), intent(inout) :: shapes
    real(wp), intent(in) :: interval(2) !! in mean elements
    real(wp), intent(in) :: x(:), w(:)  !! points and weights from −1 to 1

    shapes%place = [shapes%place, (0.5_wp*sum(interval) + 0.5_wp*(interval(2) - interval(1))*x)/ &
      shapes%elements]
    shapes%root = [shapes%root, &
      sqrt(0.5_wp*shapes%length/shapes%elements*w*(interval(2) - interval(1)))]
  end subroutine add_points

  !> Gives an unknown a linear displacement in an element, `line(0) + line(1) ζ`, and its slope,
  !! which cross-sections share.
  pure subroutine set_element(shapes, element, column, line, slope)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: element, column
    real(wp), intent(in) :: line(0:1)
    real(wp), intent(in), optional :: slope

    integer :: row

    row = (element - 1)*shapes%coefficients
    shapes%displacement(row + 1:row + 2, column) = &
      sqrt(shapes%part(element))*shapes%weight(1:2)*line
    if (.not. present(slope)) return
    if (shapes%rotations > 0) then
      shapes%displacement(first_rotation(shapes, element), column) = &
        sqrt(shapes%part(element))*shapes%rotation_weight(1)*slope
    end if
    associate (first => shapes%first_point(element), last => shapes%first_point(element + 1) - 1)
      shapes%slope(first:last, column) = slope*shapes%root(first:last)
    end associate
  end subroutine set_element

  !> Adds what an unknown does in its own element.
  pure subroutine add_in_element(shapes, element, column, coefficient, slope_coefficient, turns)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: element, column
    real(wp), intent(in) :: coefficient(0:)
    real(wp), intent(in), optional :: slope_coefficient(0:)
    logical, intent(in), optional :: turns !! cross-sections have the slope as well; with
                                           !! `slope_coefficient`

    real(wp) :: zeta
    integer :: row, i

    row = (element - 1)*shapes%coefficients
    associate (entry => shapes%displacement(row + 1:row + size(coefficient), column))
      entry = entry + sqrt(shapes%part(element))*shapes%weight(:size(coefficient))*coefficient
    end associate
    if (.not. present(slope_coefficient)) return
    if (turns .and. shapes%rotations > 0) then
      ! Of the slope of a curvature the last coefficient is zero.
      row = first_rotation(shapes, element)
      associate (entry => shapes%displacement(row:row + shapes%rotations - 1, column))
        entry = entry + &
          sqrt(shapes%part(element))*shapes%rotation_weight*slope_coefficient(:shapes%rotations - 1)
      end associate
    end if
    do i = shapes%first_point(element), shapes%first_point(element + 1) - 1
      zeta = 2.0_wp*(shapes%place(i)*shapes%elements - shapes%middle(element))/shapes%part(element)
      shapes%slope(i, column) = shapes%slope(i, column) + shapes%root(i)* &
        dot_product(slope_coefficient, legendre_values(size(slope_coefficient) - 1, zeta))
    end do
  end subroutine add_in_element

end module deformation_shapes
