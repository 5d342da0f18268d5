!> One beam element of any order p ≥ 3: transverse displacement of degree p, axial displacement of
!! degree q. Order 3 is the element of the thesis.
!!
!! Unknowns {u1 v1 θ1 | transverse bubbles 1 … p−3 | axial bubbles 1 … q−1 | u2 v2 θ2}: at each node
!! the displacements along and across the element and the rotation, as in (2.72); between them the
!! bubbles, which vanish at both nodes. With ξ from 0 to 1, bubbles are built from Legendre
!! polynomials on that interval. Transverse ones have `d²v/dξ² = P_j`, j = 2 … p−2, with zero value
!! and slope at the ends; axial ones have `du/dξ = P_j`, j = 1 … q−1. The stiffness matrix therefore
!! couples no bubble with any other unknown. Bubbles are lengths [m].
!!
!! With shear, θ is the rotation of the cross-section. The unknowns above bend without shear strain
!! (θ = v'). After the axial bubbles come p − 1 more unknowns, the shear strains
!! `γ = v' − θ = P_j/length`, j = 0 … p−2. For j ≥ 1 they rotate no cross-section, and v vanishes at
!! the nodes. The uniform one, j = 0, includes the curvature `6 P_1/length²`, which brings v and θ
!! back to zero at the nodes. As the shear stiffness grows, these unknowns stiffen like axial ones
!! and the slender element remains: there is no shear locking.
!!
!! Matrices are built from the Legendre coefficients of the shapes. Integrals are then sums over
!! orthogonal polynomials, exact but for rounding at any order. Values of polynomials come from the
!! recurrence. Powers of ξ would lose all digits at high orders.
module beam_element
  use kinds, only: wp
  use legendre, only: legendre_values
  implicit none (type, external)
  private

  public :: reference_element_t, new_reference_element, axial_degree, element_unknowns
  public :: element_mass, element_stiffness, element_geometric_stiffness, interpolate, with_lengths

  !> Everything about an element that depends on its order only, for length 1 and with rotations
  !! multiplied by the length.
  type :: reference_element_t
    integer :: order = 0                        !! p
    logical :: sheared = .false.                !! has shear strains
    real(wp), allocatable :: mass(:, :)         !! (unknowns, unknowns) ∫ u² + v² dξ
    real(wp), allocatable :: axial(:, :)        !! (unknowns, unknowns) ∫ (du/dξ)² dξ
    real(wp), allocatable :: bending(:, :)      !! (unknowns, unknowns) ∫ (d²v/dξ²)² dξ
    real(wp), allocatable :: rotary(:, :)       !! (unknowns, unknowns) ∫ θ² dξ
    real(wp), allocatable :: shear(:, :)        !! (unknowns, unknowns) ∫ γ² dξ; only with shear
    real(wp), allocatable :: geometric(:, :, :) !! (unknowns, unknowns, 0:2) ∫ ξⁱ (dv/dξ)² dξ
    real(wp), allocatable :: shape(:, :, :)     !! (0:p, unknowns, 4) Legendre coefficients of u,
                                                !! v, dv/dξ and, for length 1, θ
  end type reference_element_t

contains

  !> Degree q of the axial displacement of an element of order p.
  !!
  !! Order 3 is linear along the element, as in the thesis. Beyond, about a third of p is as good as
  !! the full degree: at bending frequencies a link is short compared with its axial waves.
  elemental function axial_degree(order) result(degree)
    integer, intent(in) :: order !! p
    integer :: degree

    degree = merge(1, order/3 + 1, order == 3)
  end function axial_degree

  !> Number of unknowns: six at the nodes, p − 3 transverse and q − 1 axial bubbles; with shear
  !! p − 1 more.
  elemental function element_unknowns(order, sheared) result(unknowns)
    integer, intent(in) :: order !! p
    logical, intent(in), optional :: sheared !! absent: no
    integer :: unknowns

    unknowns = order + axial_degree(order) + 2
    if (.not. present(sheared)) return
    if (sheared) unknowns = unknowns + order - 1
  end function element_unknowns

  !> Builds the matrices of an order. Shapes are integrated from their strains; 1 is added to the u,
  !! v or θ that is 1 at the first node.
  pure function new_reference_element(order, sheared) result(element)
    integer, intent(in) :: order !! p, at least 3
    logical, intent(in), optional :: sheared !! absent: no
    type(reference_element_t) :: element

    !> (0:p, unknowns)
    real(wp), dimension(:, :), allocatable :: strain, curvature, shear, along, across, turn, &
      slope, slope_xi
    integer :: n

    element%order = order
    if (present(sheared)) element%sheared = sheared
    n = element_unknowns(order, element%sheared)
    ! Allocation by assignment alone would set the lower bound to 1.
    allocate (strain(0:order, n), curvature(0:order, n), along(0:order, n), across(0:order, n), &
      turn(0:order, n), slope(0:order, n))
    strain = strain_coefficients(order, n)
    along = integrated(strain)
    along(0, 1) = along(0, 1) + 1.0_wp
    curvature = curvature_coefficients(order, n)
    turn = integrated(curvature)
    turn(0, 3) = turn(0, 3) + 1.0_wp
    slope = turn
    if (element%sheared) then
      shear = shear_coefficients(order, n)
      element%shear = products(shear, shear)
      slope = slope + shear
    end if
    across = integrated(slope)
    across(0, 2) = across(0, 2) + 1.0_wp
    slope_xi = times_xi(slope)

    element%mass = products(along, along) + products(across, across)
    element%rotary = products(turn, turn)
    element%axial = products(strain, strain)
    element%bending = products(curvature, curvature)
    allocate (element%geometric(n, n, 0:2))
    element%geometric(:, :, 0) = products(slope, slope)
    element%geometric(:, :, 1) = products(slope, slope_xi)
    element%geometric(:, :, 2) = products(slope_xi, slope_xi)
    allocate (element%shape(0:order, n, 4))
    element%shape(:, :, 1) = along
    element%shape(:, :, 2) = across
    element%shape(:, :, 3) = slope
    element%shape(:, :, 4) = turn
  end function new_reference_element

  !> Legendre coefficients of du/dξ for each unknown.
  pure function strain_coefficients(order, unknowns) result(strain)
    integer, intent(in) :: order, unknowns
    real(wp) :: strain(0:order, unknowns)

    integer :: j

    strain = 0.0_wp
    strain(0, 1) = -1.0_wp
    strain(0, unknowns - 2) = 1.0_wp
    do j = 1, axial_degree(order) - 1
      strain(j, order + j) = 1.0_wp
    end do
  end function strain_coefficients

  !> Legendre coefficients of dθ/dξ for each unknown. Those of the nodes are (2.71): 6(2ξ − 1),
  !! −1 + 3(2ξ − 1), …
  pure function curvature_coefficients(order, unknowns) result(curvature)
    integer, intent(in) :: order, unknowns
    real(wp) :: curvature(0:order, unknowns)

    integer :: j

    curvature = 0.0_wp
    curvature(1, [2, unknowns - 1]) = [6.0_wp, -6.0_wp]
    curvature(0, [3, unknowns]) = [-1.0_wp, 1.0_wp]
    curvature(1, [3, unknowns]) = 3.0_wp
    do j = 2, order - 2
      curvature(j, j + 2) = 1.0_wp
    end do
    if (unknowns > element_unknowns(order)) curvature(1, first_shear(order)) = 6.0_wp
  end function curvature_coefficients

  !> Legendre coefficients of the shear strain for each unknown.
  pure function shear_coefficients(order, unknowns) result(shear)
    integer, intent(in) :: order, unknowns
    real(wp) :: shear(0:order, unknowns)

    integer :: j

    shear = 0.0_wp
    do j = 0, order - 2
      shear(j, first_shear(order) + j) = 1.0_wp
    end do
  end function shear_coefficients

  !> Number of the uniform shear strain among the unknowns of an element with shear.
  elemental function first_shear(order) result(first)
    integer, intent(in) :: order
    integer :: first

    first = element_unknowns(order) - 2
  end function first_shear

  !> Legendre coefficients of `∫ f dξ` from 0, by `∫ P_j = (P_{j+1} − P_{j−1})/(2(2j + 1))` and
  !! `∫ P_0 = (P_0 + P_1)/2`.
  pure function integrated(coefficients) result(integral)
    real(wp), intent(in) :: coefficients(0:, :) !! (0:p, functions), zero for P_p
    real(wp) :: integral(0:ubound(coefficients, 1), size(coefficients, 2))

    integer :: j

    integral = 0.0_wp
    integral(0, :) = 0.5_wp*coefficients(0, :)
    integral(1, :) = 0.5_wp*coefficients(0, :)
    do j = 1, ubound(coefficients, 1) - 1
      integral(j + 1, :) = integral(j + 1, :) + coefficients(j, :)/(2*(2*j + 1))
      integral(j - 1, :) = integral(j - 1, :) - coefficients(j, :)/(2*(2*j + 1))
    end do
  end function integrated

  !> Legendre coefficients of `ξ f`, by ξ = (1 + x)/2 and
  !! `(2j + 1) x P_j = (j + 1) P_{j+1} + j P_{j−1}`.
  pure function times_xi(coefficients) result(product_of)
    real(wp), intent(in) :: coefficients(0:, :) !! (0:p, functions), zero for P_p
    real(wp) :: product_of(0:ubound(coefficients, 1), size(coefficients, 2))

    integer :: j

    product_of = 0.5_wp*coefficients
    do j = 0, ubound(coefficients, 1) - 1
      product_of(j + 1, :) = product_of(j + 1, :) + (j + 1)*coefficients(j, :)/(2*(2*j + 1))
      if (j > 0) product_of(j - 1, :) = product_of(j - 1, :) + j*coefficients(j, :)/(2*(2*j + 1))
    end do
  end function times_xi

  !> `∫ f_i g_j dξ` for functions for which this is symmetric in i and j, by
  !! `∫ P_j² dξ = 1/(2j + 1)`.
  pure function products(f, g) result(matrix)
    real(wp), intent(in) :: f(0:, :), g(0:, :) !! (0:p, functions) Legendre coefficients
    real(wp) :: matrix(size(f, 2), size(f, 2))

    real(wp) :: weight(0:ubound(f, 1))
    integer :: i, j

    weight = [(real(2*j + 1, wp), j=0, ubound(f, 1))]
    do j = 1, size(f, 2)
      do i = 1, j
        matrix(i, j) = sum(f(:, i)*g(:, j)/weight)
        matrix(j, i) = matrix(i, j)
      end do
    end do
  end function products

  !> Consistent mass matrix; Ulker 2010 (2.78) for order 3. Rotary inertia adds `∫ ρI θ² dx`.
  pure function element_mass(reference, line_density, length, rotary_inertia) result(mass)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: line_density               !! ρA [kg/m]
    real(wp), intent(in) :: length                     !! [m]
    real(wp), intent(in), optional :: rotary_inertia   !! ρI [kg m]; absent: none
    real(wp) :: mass(size(reference%mass, 1), size(reference%mass, 2)) !! [kg, kg m, kg m²]

    mass = line_density*length*with_lengths(reference%mass, length)
    if (.not. present(rotary_inertia)) return
    if (rotary_inertia > 0.0_wp) mass = mass + &
      rotary_inertia/length*with_lengths(reference%rotary, length)
  end function element_mass

  !> Stiffness matrix; Ulker 2010 (2.79) with entry (3, 6) = +2EI/L for order 3.
  pure function element_stiffness(reference, axial, bending, length, shear) result(stiffness)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: axial                      !! EA [N]
    real(wp), intent(in) :: bending                    !! EI [N m²]
    real(wp), intent(in) :: length                     !! [m]
    real(wp), intent(in), optional :: shear            !! kGA [N]; not used without shear strains
    real(wp) :: stiffness(size(reference%axial, 1), size(reference%axial, 2)) !! [N/m, N, N m]

    stiffness = axial/length*reference%axial + bending/length**3*reference%bending
    if (reference%sheared .and. present(shear)) stiffness = stiffness + shear/length*reference%shear
    stiffness = with_lengths(stiffness, length)
  end function element_stiffness

  !> Geometric stiffness `∫ N v'² dx` of an axial force `N(ξ) = n0 + n1 ξ + n2 ξ²`, with ξ
  !! from 0 to 1 along the element.
  !!
  !! For order 3 and n1 = n2 = 0 this is (2.84) of Ulker (2010).
  pure function element_geometric_stiffness(reference, force, length) result(stiffness)
    type(reference_element_t), intent(in) :: reference !! of the element's order
    real(wp), intent(in) :: force(0:2) !! n0, n1, n2, tension positive [N]
    real(wp), intent(in) :: length     !! [m]
    !> [N/m, N, N m]
    real(wp) :: stiffness(size(reference%geometric, 1), size(reference%geometric, 2))

    stiffness = with_lengths((force(0)*reference%geometric(:, :, &
      0) + force(1)*reference%geometric(:, :, 1) + force(2)*reference%geometric(:, :, 2))/length, &
      length)
  end function element_geometric_stiffness

  !> Turns the L θ of a reference element into θ: multiplies rows and columns of rotations by the
  !! length.
  pure function with_lengths(matrix, length) result(scaled)
    real(wp), intent(in) :: matrix(:, :) !! (unknowns, unknowns) for L θ
    real(wp), intent(in) :: length       !! of the element [m]
    real(wp) :: scaled(size(matrix, 1), size(matrix, 2))

    integer :: n

    n = size(matrix, 1)
    scaled = matrix
    scaled([3, n], :) = scaled([3, n], :)*length
    scaled(:, [3, n]) = scaled(:, [3, n])*length
  end function with_lengths

  !> Displacement inside an element: along it [m], across it [m], and the rotation of the
  !! cross-section [rad], from (2.71), the bubbles and, with shear, the shear strains.
  !!
  !! Bubbles are differences of polynomials that are equal at the ends to the last bit, so that
  !! nodal values are reproduced exactly.
  pure function interpolate(order, local, length, xi) result(displacement)
    integer, intent(in) :: order     !! p
    real(wp), intent(in) :: local(:) !! (unknowns) in the element's own axes; their number implies
                                     !! shear
    real(wp), intent(in) :: length   !! of the element [m]
    real(wp), intent(in) :: xi       !! from 0 to 1 along the element
    real(wp) :: displacement(3)

    real(wp) :: shape(4), slope(4), p(0:order), once(1:order - 1), twice(2:order - 2)
    integer :: j, n, first

    n = size(local)
    first = first_shear(order)
    shape = [(1.0_wp - xi)**2*(1.0_wp + 2.0_wp*xi), length*xi*(1.0_wp - xi)**2, &
      xi**2*(3.0_wp - 2.0_wp*xi), length*xi**2*(xi - 1.0_wp)]
    slope = [-6.0_wp*xi*(1.0_wp - xi)/length, (1.0_wp - xi)*(1.0_wp - 3.0_wp*xi), &
      6.0_wp*xi*(1.0_wp - xi)/length, xi*(3.0_wp*xi - 2.0_wp)]
    p = legendre_values(order, 2.0_wp*xi - 1.0_wp)
    once = [((p(j + 1) - p(j - 1))/(2*(2*j + 1)), j=1, order - 1)]
    twice = [((once(j + 1) - once(j - 1))/(2*(2*j + 1)), j=2, order - 2)]
    displacement(1) = (1.0_wp - xi)*local(1) + xi*local(n - 2) + &
      dot_product(once(:first - 1 - order), local(order + 1:first - 1))
    displacement(2) = dot_product(shape, local([2, 3, n - 1, n])) + dot_product(twice, &
      local(4:order))
    displacement(3) = dot_product(slope, local([2, 3, n - 1, n])) + dot_product(once(2:order - 2), &
      local(4:order))/length
    if (n == element_unknowns(order)) return
    displacement(2) = displacement(2) + xi*(1.0_wp - xi)*(1.0_wp - 2.0_wp*xi)*local(first) + &
      dot_product(once(:order - 2), local(first + 1:n - 3))
    displacement(3) = displacement(3) - 6.0_wp*xi*(1.0_wp - xi)*local(first)/length
  end function interpolate

end module beam_element
