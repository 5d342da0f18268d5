!> Deformation coordinates of a link: Legendre coefficients of its curvature, shear strain and axial
!! strain, element by element.
!!
!! Scaled as here, the elastic energy, Ulker 2010 (2.68), is `½ yᵀy`: the stiffness matrix is the
!! unit matrix, exact and the same at every position. In an element of length h the curvature is
!! `θ' = Σ y_j √((2j+1)/(EI h)) P_j`; the shear strain `v' − θ` has kGA in place of EI, the axial
!! strain EA. θ is the rotation of cross-sections; without shear it is v'. Displacements are
!! measured from the chord: they vanish at both ends of the link. Elements are of equal length
!! unless their ends are given.
module deformation_shapes
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values, once_integrated, twice_integrated
  implicit none (type, external)
  private

  !> A link without mass has shapes, too: this line density is in the scale of its displacements,
  !! and in M no digit of masses that it carries [kg/m].
  real(wp), parameter :: least_line_density = 1.0e-40_wp

  public :: deformation_shapes_t, bending_shapes, axial_shapes, bending_unknowns, shear_scale

  !> Effect of every unknown along the link. A function is stored as its Legendre coefficients in
  !! every element, element by element, each coefficient times √(μ h/(2j+1)): `∫ μ f g dx` is then
  !! the scalar product. With rotary inertia, the coefficients of its rotation follow, times √(ρI
  !! h/(2j+1)), and the scalar product is `∫ μ f g + ρI θ_f θ_g dx`.
  !!
  !! `[mean elements]`: in units of the mean element length.
  type :: deformation_shapes_t
    real(wp) :: length = 0.0_wp                 !! of the link [m]
    real(wp) :: shear_stiffness = 0.0_wp        !! kGA [N]; 0: rigid in shear
    integer :: elements = 0
    logical :: by_degree = .false.              !! unknowns ordered by degree, within a degree by
                                                !! element; else by element
    integer, allocatable :: column(:, :)        !! (0:highest degree, elements) number of the
                                                !! unknown of this curvature (axial: strain; those
                                                !! of degree 0 have none of their own); 0: none
    integer :: kept = 0                         !! unknowns in use, the first of all; the rest are
                                                !! those of higher orders
    real(wp), allocatable :: last(:)            !! (0:elements) end of each element; entry 0 is the
                                                !! first pin [mean elements]
    real(wp), allocatable :: part(:)            !! (elements) length of each [mean elements]
    real(wp), allocatable :: middle(:)          !! (elements) place of its middle [mean elements]
    integer :: coefficients = 0                 !! of the displacement in an element
    integer :: rotations = 0                    !! coefficients of the rotation in an element; 0
                                                !! without rotary inertia
    integer :: lumps = 0                        !! masses along the link, see `lump_displacements`
    integer :: turning_lumps = 0                !! those with a moment of inertia of their own
    integer :: unknowns = 0
    !> (coefficients × elements, then rotations × elements, lumps, turning lumps; unknowns) scaled
    !! [s]
    real(wp), allocatable :: displacement(:, :)
    real(wp), allocatable :: linear(:, :)       !! (rows of `displacement`, 2) the functions
                                                !! 1 − ξ and ξ, scaled [√kg]
    real(wp), allocatable :: weight(:)          !! (coefficients) the scale √(μ h/(2j+1)) of a mean
                                                !! element [√kg]
    real(wp), allocatable :: rotation_weight(:) !! (rotations) the scale √(ρI h/(2j+1)) of a mean
                                                !! element [√kg m]
    real(wp), allocatable :: start_slope(:)     !! (unknowns) θ at the link's first end; bending
                                                !! only [rad/√J]
    real(wp), allocatable :: end_slope(:)       !! (unknowns) θ at its last end; bending only
                                                !! [rad/√J]
    real(wp), allocatable :: slope(:, :)        !! (Gauss points, unknowns) v' times √(Gauss
                                                !! weight); bending only [√m/√J]
    integer, allocatable :: first_point(:)      !! (elements + 1) number of the first Gauss point of
                                                !! each
    real(wp), allocatable :: place(:)           !! (Gauss points) ξ, from 0 to 1 along the link
    real(wp), allocatable :: root(:)            !! (Gauss points) √(Gauss weight) [√m]
  end type deformation_shapes_t

contains

  !> Number of unknowns of an element whose transverse displacement is of degree `order`: curvatures
  !! of degree 0 to order − 2 and, with shear, as many shear strains, each after the curvature of
  !! its degree.
  elemental function bending_unknowns(order, sheared) result(unknowns)
    integer, intent(in) :: order   !! polynomial degree of the displacement
    logical, intent(in) :: sheared !! with shear strains
    integer :: unknowns

    unknowns = merge(2, 1, sheared)*(order - 1)
  end function bending_unknowns

  !> Numbers of the unknowns of every degree in every element, and how many of them are in use: as
  !! many degrees as given for each element. The unknowns of `beyond` further degrees come last.
  pure subroutine number_unknowns(shapes, first, degrees, beyond, kinds, before)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: first      !! lowest degree
    integer, intent(in) :: degrees(:) !! (elements) number of degrees in use
    integer, intent(in) :: beyond     !! number of further degrees in each element
    integer, intent(in) :: kinds      !! unknowns of a degree
    integer, intent(in) :: before     !! unknowns that come before all of these

    integer :: e, i, j, next

    allocate (shapes%column(0:first + maxval(degrees) + beyond - 1, shapes%elements))
    shapes%column = 0
    next = before + 1
    if (shapes%by_degree) then
      do j = first, first + maxval(degrees) - 1
        do e = 1, shapes%elements
          if (j < first + degrees(e)) call set_column(shapes%column(j, e), next, kinds)
        end do
      end do
      shapes%kept = next - 1
      do i = 0, beyond - 1
        do e = 1, shapes%elements
          call set_column(shapes%column(first + degrees(e) + i, e), next, kinds)
        end do
      end do
    else
      do e = 1, shapes%elements
        do j = first, first + degrees(e) - 1
          call set_column(shapes%column(j, e), next, kinds)
        end do
      end do
      shapes%kept = next - 1
    end if
  end subroutine number_unknowns

  !> Gives a column the next number.
  pure subroutine set_column(column, next, kinds)
    integer, intent(out) :: column
    integer, intent(inout) :: next
    integer, intent(in) :: kinds !! numbers that it takes

    column = next
    next = next + kinds
  end subroutine set_column

  !> `√((2j+1)/(kGA h))`: coefficient of P_j in the shear strain, per unit of the unknown [1/√J].
  elemental function shear_scale(j, shear_stiffness, h) result(scale)
    integer, intent(in) :: j                !! degree, from 0
    real(wp), intent(in) :: shear_stiffness !! kGA [N]
    real(wp), intent(in) :: h               !! length of the element [m]
    real(wp) :: scale

    scale = sqrt((2*j + 1)/(shear_stiffness*h))
  end function shear_scale

  !> Transverse deformations of a link, of polynomial degree `order` in every element, or of one of
  !! its own in each.
  !!
  !! As kGA grows, the effect of the shear strains vanishes like 1/√kGA and leaves the slender beam:
  !! there is no shear locking.
  pure function bending_shapes(length, line_density, bending_stiffness, elements, order, &
      shear_stiffness, rotary_inertia, ends, cuts, orders, beyond) result(shapes)
    real(wp), intent(in) :: length                    !! [m]
    real(wp), intent(in) :: line_density              !! μ [kg/m]
    real(wp), intent(in) :: bending_stiffness         !! EI [N m²]
    integer, intent(in) :: elements                   !! how many
    integer, intent(in) :: order                      !! at least 3
    real(wp), intent(in), optional :: shear_stiffness !! kGA [N]; absent or 0: rigid in shear
    real(wp), intent(in), optional :: rotary_inertia  !! ρI [kg m]; absent or 0: none
    real(wp), intent(in), optional :: ends(0:)        !! (0:elements) ξ of element ends, from 0 to
                                                      !! 1; absent: equal elements
    real(wp), intent(in), optional :: cuts(:)         !! (jumps) ξ where the axial force jumps
                                                      !! inside elements; absent: no jumps
    integer, intent(in), optional :: orders(:)        !! (elements) order in each; absent: `order`
    integer, intent(in), optional :: beyond           !! further orders, whose unknowns come last;
                                                      !! only with `ends` or for one element
    type(deformation_shapes_t) :: shapes

    real(wp), allocatable :: coefficient(:), slope_coefficient(:)
    real(wp) :: h, scale
    integer :: own(elements), more, e, j, column
    logical :: sheared

    sheared = .false.
    if (present(shear_stiffness)) sheared = shear_stiffness > 0.0_wp
    own = order
    if (present(orders)) own = orders
    more = 0
    if (present(beyond)) more = beyond
    shapes = empty_shapes(length, line_density, elements, maxval(own) + more + 1, &
      sum(bending_unknowns(own + more, sheared)), rotary_inertia, ends)
    call number_unknowns(shapes, 0, own - 1, more, merge(2, 1, sheared), 0)
    if (sheared) shapes%shear_stiffness = shear_stiffness
    allocate (shapes%start_slope(shapes%unknowns), shapes%end_slope(shapes%unknowns))
    allocate (coefficient(0:maxval(own) + more), slope_coefficient(0:maxval(own) + more))
    call place_gauss_points(shapes, own + more + 1, cuts)
    allocate (shapes%slope(size(shapes%place), shapes%unknowns))
    do e = 1, elements
      h = length/elements*shapes%part(e)
      do j = 0, own(e) + more - 2
        column = shapes%column(j, e)
        scale = 0.5_wp*h*sqrt((2*j + 1)/(bending_stiffness*h))
        slope_coefficient = 0.0_wp
        slope_coefficient(:j + 1) = scale*once_integrated(j)
        coefficient = 0.0_wp
        coefficient(:j + 2) = 0.5_wp*h*scale*twice_integrated(j)
        ! Beyond its element, a curvature P_0 leaves a rotation, and P_0 and P_1 leave a
        ! displacement; the chord takes both back.
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

  !> Fills in the effect of one unknown: in its element, beyond it, and on the chord.
  pure subroutine add_unknown(shapes, e, column, end_value, end_slope, coefficient, &
    slope_coefficient, turns)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: e, column
    real(wp), intent(in) :: end_value             !! displacement gained over its element
    real(wp), intent(in) :: end_slope             !! slope gained over its element
    real(wp), intent(in) :: coefficient(0:)       !! Legendre coefficients of the displacement in
                                                  !! its element
    real(wp), intent(in) :: slope_coefficient(0:) !! those of the slope
    logical, intent(in) :: turns                  !! cross-sections follow the slope

    real(wp) :: h, chord, line(0:1)
    integer :: k

    h = shapes%length/shapes%elements
    chord = (end_value + end_slope*h*(shapes%elements - shapes%last(e)))/shapes%length
    shapes%start_slope(column) = -chord
    shapes%end_slope(column) = end_slope - chord
    do k = 1, shapes%elements
      line = -chord*h*[shapes%middle(k), 0.5_wp*shapes%part(k)]
      if (k > e) line = line + [end_value + end_slope*h*(shapes%middle(k) - shapes%last(e)), &
        0.5_wp*h*end_slope*shapes%part(k)]
      call set_element(shapes, k, column, line, slope=-chord + merge(end_slope, 0.0_wp, k > e))
    end do
    call add_in_element(shapes, e, column, coefficient, slope_coefficient, turns)
  end subroutine add_unknown

  !> Axial deformations of a link, of polynomial degree `degree` in every element. The elongation of
  !! the whole link is not among them: the uniform strain is taken out, and the displacement
  !! vanishes at both ends.
  pure function axial_shapes(length, line_density, axial_stiffness, elements, degree, &
    ends, degrees, beyond) result(shapes)
    real(wp), intent(in) :: length             !! [m]
    real(wp), intent(in) :: line_density       !! μ [kg/m]
    real(wp), intent(in) :: axial_stiffness    !! EA [N]
    integer, intent(in) :: elements            !! how many
    integer, intent(in) :: degree              !! at least 1
    real(wp), intent(in), optional :: ends(0:) !! as in `bending_shapes`
    integer, intent(in), optional :: degrees(:) !! (elements) degree in each; absent: `degree`
    integer, intent(in), optional :: beyond     !! as in `bending_shapes`
    type(deformation_shapes_t) :: shapes

    real(wp) :: h, scale, elongation
    integer :: own(elements), more, e, j, k, column

    own = degree
    if (present(degrees)) own = degrees
    more = 0
    if (present(beyond)) more = beyond
    shapes = empty_shapes(length, line_density, elements, maxval(own) + more + 1, &
      sum(own + more) - 1, ends=ends)
    call number_unknowns(shapes, 1, own - 1, more, 1, elements - 1)
    h = length/elements
    column = 0
    ! Uniform strains of the elements that sum to zero: elements 1 to e stretched, the next one
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
      do j = 1, own(e) + more - 1
        column = shapes%column(j, e)
        scale = 0.5_wp*h*sqrt((2*j + 1)/(axial_stiffness*h))
        call add_in_element(shapes, e, column, scale*once_integrated(j))
      end do
    end do
  end function axial_shapes

  !> Shapes with scales and element ends set, and all displacements zero.
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
    shapes%weight = [(sqrt(max(line_density, least_line_density)*h/(2*j + 1)), j=0, &
      coefficients - 1)]
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

  !> Row in `displacement` of the first rotation coefficient of an element.
  pure function first_rotation(shapes, element) result(row)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: element
    integer :: row

    row = shapes%coefficients*shapes%elements + (element - 1)*shapes%rotations + 1
  end function first_rotation

  !> Gauss points of all elements, on either side of every cut, enough to integrate `∫ N v'²` with a
  !! quadratic N exactly.
  pure subroutine place_gauss_points(shapes, points, cuts)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: points(:) !! (elements) in each, or per part between cuts
    real(wp), intent(in), optional :: cuts(:)

    real(wp) :: x(maxval(points)), w(maxval(points)), here(0:1)
    integer :: k, n

    n = 0
    allocate (shapes%place(0), shapes%root(0), shapes%first_point(shapes%elements + 1))
    do k = 1, shapes%elements
      shapes%first_point(k) = size(shapes%place) + 1
      if (points(k) /= n) then
        n = points(k)
        call gauss_rule(x(:n), w(:n))
      end if
      here = shapes%last(k - 1:k)
      if (present(cuts)) then
        do
          here(1) = min(shapes%last(k), minval(shapes%elements*cuts, &
            mask=shapes%elements*cuts > here(0)))
          if (here(1) >= shapes%last(k)) exit
          call add_gauss_points(shapes, here, x(:n), w(:n))
          here(0) = here(1)
        end do
      end if
      call add_gauss_points(shapes, here, x(:n), w(:n))
    end do
    shapes%first_point(shapes%elements + 1) = size(shapes%place) + 1
  end subroutine place_gauss_points

  !> Adds the Gauss points of one interval.
  pure subroutine add_gauss_points(shapes, interval, x, w)
    type(deformation_shapes_t), intent(inout) :: shapes
    real(wp), intent(in) :: interval(2) !! in mean elements
    real(wp), intent(in) :: x(:), w(:)  !! points and weights from −1 to 1

    shapes%place = [shapes%place, (0.5_wp*sum(interval) + 0.5_wp*(interval(2) - interval(1))*x)/ &
      shapes%elements]
    shapes%root = [shapes%root, &
      sqrt(0.5_wp*shapes%length/shapes%elements*w*(interval(2) - interval(1)))]
  end subroutine add_gauss_points

  !> Gives an unknown a linear displacement in an element, `line(0) + line(1) ζ`, with the slope
  !! that belongs to it. Cross-sections follow this slope.
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

  !> Adds the effect of an unknown in its own element.
  pure subroutine add_in_element(shapes, element, column, coefficient, slope_coefficient, turns)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: element, column
    real(wp), intent(in) :: coefficient(0:)
    real(wp), intent(in), optional :: slope_coefficient(0:)
    logical, intent(in), optional :: turns !! cross-sections follow the slope; required with
                                           !! `slope_coefficient`

    real(wp) :: zeta
    integer :: row, i

    row = (element - 1)*shapes%coefficients
    associate (entry => shapes%displacement(row + 1:row + size(coefficient), column))
      entry = entry + sqrt(shapes%part(element))*shapes%weight(:size(coefficient))*coefficient
    end associate
    if (.not. present(slope_coefficient)) return
    if (turns .and. shapes%rotations > 0) then
      ! The last coefficient of the slope of a curvature is zero.
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
