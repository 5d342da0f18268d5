!> One link on a long mesh: displacement, slope and strain that the unknowns of an element cause
!! inside it and at its end.
module chain_links
  use beam_mesh, only: beam_t
  use body_lumps, only: element_of_lump, has_turning_lumps, lump_inertias, lump_masses, &
    lump_offsets, lump_places
  use deformation_shapes, only: bending_unknowns, shear_scale
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values, once_integrated, twice_integrated
  use link_modes, only: curve_rotations
  use linkages, only: body_t
  use long_sums, only: long_dot
  implicit none (type, external)
  private

  public :: chain_t, new_chain, slope_at_start, add_from_start, at_end, add_back_at_end, add_back, &
    at_place, add_lump_forces, add_lump_moments

  !> A link on a long mesh. A rigid link has no unknowns, and its arrays are empty or not allocated.
  type :: chain_t
    logical :: bends = .true.
    integer :: elements = 0
    integer :: bendings = 0                     !! transverse unknowns of an element: curvatures
                                                !! and, with shear, as many shear strains,
                                                !! alternating
    integer :: at_end = 0                       !! the first of them, the only ones with a
                                                !! displacement or slope at the end of the element
    logical :: sheared = .false.                !! with shear strains
    integer :: strains = 0                      !! axial unknowns of an element
    integer :: first_bending = 0                !! number of the link's first transverse unknown,
                                                !! minus one
    integer :: first_strain = 0                 !! number of its first axial unknown, minus one
    real(wp) :: length = 0.0_wp                 !! of the link [m]
    real(wp), allocatable :: bend(:, :)         !! (coefficients, bendings) Legendre coefficients of
                                                !! the transverse displacement in the element [m/√J]
    real(wp), allocatable :: turn(:, :)         !! (coefficients − 1, bendings) those of its slope
                                                !! v' [rad/√J]
    real(wp), allocatable :: rotate(:, :)       !! (coefficients − 1, bendings) those of the
                                                !! rotation of cross-sections [rad/√J]
    real(wp), allocatable :: stretch(:, :)      !! (coefficients, strains) those of the axial
                                                !! displacement [m/√J]
    real(wp), allocatable :: weight(:)          !! (coefficients) μ h/(2j+1), mass per squared
                                                !! coefficient of displacement [kg]
    real(wp), allocatable :: rotation_weight(:) !! (coefficients − 1) ρI h/(2j+1), the same for the
                                                !! rotation; empty without rotary inertia [kg m²]
    real(wp), allocatable :: force(:, :, :)     !! (coefficients − 1, coefficients − 1, 3)
                                                !! `h ∫ ξ^(k−1) P_i P_j dξ` [m]
    real(wp), allocatable :: lump(:)            !! (lumps) masses along the link [kg]
    real(wp), allocatable :: offset(:)          !! (lumps) beside its axis, to its left [m]
    real(wp), allocatable :: lump_inertia(:)    !! (lumps) their own moments of inertia [kg m²]
    logical :: lumps_turn = .false.             !! some are beside the axis or have a moment of
                                                !! inertia
    integer, allocatable :: lump_element(:)     !! (lumps) element that each mass is in
    real(wp), allocatable :: lump_value(:, :)   !! (coefficients, lumps) P_j at the mass
    !> (coefficients − 1, coefficients − 1, lumps) `h ∫ P_i P_j dξ` from the start of its element to
    !! the mass [m]
    real(wp), allocatable :: before(:, :, :)
    real(wp), allocatable :: start_slope(:)     !! (bendings × elements) rotation of the first end
                                                !! against the chord [rad/√J]
    real(wp) :: end_rotation = 0.0_wp           !! the norm of `start_slope` [rad/√J]
  end type chain_t

contains

  !> All properties of a link on a long mesh that do not depend on the position.
  pure function new_chain(body, beam, elements, order, axial_degree) result(link)
    type(body_t), intent(in) :: body    !! length, masses, whether it bends
    type(beam_t), intent(in) :: beam    !! its stiffnesses
    integer, intent(in) :: elements     !! all of one length
    integer, intent(in) :: order        !! polynomial degree of the transverse displacement
    integer, intent(in) :: axial_degree !! that of the axial displacement
    type(chain_t) :: link

    real(wp) :: h, rotation(2)
    integer :: j, coefficients

    h = body%length/elements
    coefficients = max(order, axial_degree) + 1
    link%elements = elements
    link%length = body%length
    link%bends = body%bends
    allocate (link%lump(0), link%offset(0), link%lump_inertia(0))
    if (.not. body%bends) then
      allocate (link%start_slope(0))
      return
    end if
    link%sheared = beam%shear_stiffness > 0.0_wp
    link%bendings = bending_unknowns(order, link%sheared)
    ! Curvatures of degree 0 and 1 and, between them in the numbering, a uniform shear strain.
    link%at_end = merge(3, 2, link%sheared)
    link%strains = axial_degree
    rotation = curve_rotations(body%length, beam%bending_stiffness, beam%shear_stiffness, &
      [.true., .false.])
    link%end_rotation = rotation(1)
    call fill_bending(link, beam, order, coefficients)
    allocate (link%stretch(coefficients, axial_degree))
    link%stretch = 0.0_wp
    do j = 0, axial_degree - 1
      link%stretch(:j + 2, j + 1) = &
        0.5_wp*h*sqrt((2*j + 1)/(beam%axial_stiffness*h))*once_integrated(j)
    end do
    link%weight = [(body%line_density*h/(2*j + 1), j=0, coefficients - 1)]
    link%rotation_weight = [(body%rotary_inertia*h/(2*j + 1), j=0, merge(coefficients - 2, -1, &
      body%rotary_inertia > 0.0_wp))]
    link%force = force_integrals(coefficients - 1, h)
    link%start_slope = start_slopes(link, beam)
    call place_lumps(link, body, coefficients)
  end function new_chain

  !> Assigns the masses along a link to their elements.
  pure subroutine place_lumps(link, body, coefficients)
    type(chain_t), intent(inout) :: link
    type(body_t), intent(in) :: body
    integer, intent(in) :: coefficients

    real(wp), allocatable :: xi(:)
    real(wp) :: x(coefficients), w(coefficients), p(coefficients - 1), place
    integer :: i, k

    link%lump = lump_masses(body)
    link%offset = lump_offsets(body)
    link%lump_inertia = lump_inertias(body)
    link%lumps_turn = has_turning_lumps(body)
    xi = lump_places(body)
    allocate (link%lump_element(size(xi)), link%lump_value(coefficients, size(xi)))
    allocate (link%before(coefficients - 1, coefficients - 1, size(xi)))
    link%before = 0.0_wp
    call gauss_rule(x, w)
    do i = 1, size(xi)
      call element_of_lump(xi(i), link%elements, link%lump_element(i), place)
      link%lump_value(:, i) = legendre_values(coefficients - 1, 2.0_wp*place - 1.0_wp)
      do k = 1, size(x)
        p = legendre_values(coefficients - 2, place*(1.0_wp + x(k)) - 1.0_wp)
        link%before(:, :, i) = link%before(:, :, i) + 0.5_wp*body%length/link%elements*place*w(k)* &
          spread(p, 2, size(p))*spread(p, 1, size(p))
      end do
    end do
  end subroutine place_lumps

  !> Legendre coefficients of displacement, slope and rotation for the transverse unknowns of an
  !! element.
  pure subroutine fill_bending(link, beam, order, coefficients)
    type(chain_t), intent(inout) :: link
    type(beam_t), intent(in) :: beam
    integer, intent(in) :: order, coefficients

    real(wp) :: h, scale
    integer :: j, column

    h = link%length/link%elements
    allocate (link%bend(coefficients, link%bendings), link%turn(coefficients - 1, link%bendings))
    link%bend = 0.0_wp
    link%turn = 0.0_wp
    link%rotate = link%turn
    column = 0
    do j = 0, order - 2
      column = column + 1
      scale = 0.5_wp*h*sqrt((2*j + 1)/(beam%bending_stiffness*h))
      link%bend(:j + 3, column) = 0.5_wp*h*scale*twice_integrated(j)
      link%turn(:j + 2, column) = scale*once_integrated(j)
      link%rotate(:, column) = link%turn(:, column)
      if (.not. link%sheared) cycle
      column = column + 1
      scale = shear_scale(j, beam%shear_stiffness, h)
      link%bend(:j + 2, column) = 0.5_wp*h*scale*once_integrated(j)
      link%turn(j + 1, column) = scale
    end do
  end subroutine fill_bending

  !> `θ(0) = −∫ (1 − x/L) θ' dx − ∫ γ dx/L`. Only P_0 and P_1 of the curvatures and P_0 of the shear
  !! strains contribute.
  pure function start_slopes(link, beam) result(slope)
    type(chain_t), intent(in) :: link
    type(beam_t), intent(in) :: beam
    real(wp) :: slope(link%bendings*link%elements)

    real(wp) :: h
    integer :: e, first

    h = link%length/link%elements
    slope = 0.0_wp
    do e = 1, link%elements
      first = (e - 1)*link%bendings
      slope(first + 1) = -sqrt(h/beam%bending_stiffness)*(1.0_wp - (e - 0.5_wp)/link%elements)
      if (link%sheared) slope(first + 2) = -sqrt(h/beam%shear_stiffness)/link%length
      slope(first + link%at_end) = sqrt(3.0_wp*h/beam%bending_stiffness)/(6.0_wp*link%elements)
    end do
  end function start_slopes

  !> `h ∫ ξ^(k−1) P_i P_j dξ` for k = 1, 2, 3.
  pure function force_integrals(coefficients, h) result(integral)
    integer, intent(in) :: coefficients
    real(wp), intent(in) :: h
    real(wp) :: integral(coefficients, coefficients, 3)

    real(wp) :: x(coefficients + 1), w(coefficients + 1), p(coefficients)
    integer :: i, j, k

    call gauss_rule(x, w)
    integral = 0.0_wp
    do i = 1, size(x)
      p = legendre_values(coefficients - 1, x(i))
      do k = 1, 3
        do j = 1, coefficients
          integral(:, j, k) = integral(:, j, k) + 0.5_wp*h*w(i)*(0.5_wp*(1.0_wp + x(i)))**(k - &
            1)*p(j)*p
        end do
      end do
    end do
  end function force_integrals

  !> Rotation of a link's first end against its chord.
  pure function slope_at_start(link, vector) result(slope)
    type(chain_t), intent(in) :: link !! on a long mesh
    real(wp), intent(in) :: vector(:) !! (unknowns) of the whole linkage [√J]
    real(wp) :: slope                 !! [rad]

    slope = long_dot(link%start_slope, &
      vector(link%first_bending + 1:link%first_bending + size(link%start_slope)))
  end function slope_at_start

  !> The transpose of `slope_at_start`: adds the effect of a moment at the first end.
  pure subroutine add_from_start(link, moment, vector)
    type(chain_t), intent(in) :: link    !! on a long mesh
    real(wp), intent(in) :: moment       !! [N m]
    real(wp), intent(inout) :: vector(:) !! (unknowns) of the whole linkage

    integer :: i

    do i = 1, size(link%start_slope)
      vector(link%first_bending + i) = vector(link%first_bending + i) + moment*link%start_slope(i)
    end do
  end subroutine add_from_start

  !> Value of a function at the end of an element, where every P_j is 1.
  pure function at_end(table, count, y) result(value)
    real(wp), intent(in) :: table(:, :) !! (coefficients, unknowns) `bend`, `rotate` or `stretch` of
                                        !! the link
    real(wp), intent(in) :: y(:)        !! (unknowns) of the element
    integer, intent(in) :: count        !! unknowns with a value there, the first of all
    real(wp) :: value

    integer :: j

    value = 0.0_wp
    do j = 1, count
      value = value + sum(table(:, j))*y(j)
    end do
  end function at_end

  !> The transpose of `at_end`: adds the effect of a force or moment at the end of an element.
  pure subroutine add_back_at_end(table, count, value, y)
    real(wp), intent(in) :: table(:, :) !! (coefficients, unknowns) as in `at_end`
    real(wp), intent(in) :: value       !! force or moment
    integer, intent(in) :: count        !! as in `at_end`
    real(wp), intent(inout) :: y(:)     !! (unknowns) of the element

    integer :: j

    do j = 1, count
      y(j) = y(j) + sum(table(:, j))*value
    end do
  end subroutine add_back_at_end

  !> Adds the generalized forces on the unknowns of an element, from the forces on the Legendre
  !! coefficients.
  pure subroutine add_back(table, force, y)
    real(wp), intent(in) :: table(:, :) !! (coefficients, unknowns) as in `at_end`
    real(wp), intent(in) :: force(:)    !! (coefficients)
    real(wp), intent(inout) :: y(:)     !! (unknowns) of the element

    y = y + matmul(force, table)
  end subroutine add_back

  !> Adds the forces `m v` of the masses in an element, as forces on the Legendre coefficients of
  !! the displacement; of masses that move by less than the axis, `m (u − e θ)`.
  pure subroutine add_lump_forces(link, element, coefficient, force, back, on_mass)
    type(chain_t), intent(in) :: link      !! with its masses
    integer, intent(in) :: element         !! its number
    real(wp), intent(in) :: coefficient(:) !! (coefficients) of the displacement
    real(wp), intent(inout) :: force(:)    !! (coefficients)
    real(wp), intent(in), optional :: back(:)       !! (lumps) e θ; absent: 0
    real(wp), intent(inout), optional :: on_mass(:) !! (lumps) the force of each in this element

    real(wp) :: moved
    integer :: i

    do i = 1, size(link%lump)
      if (link%lump_element(i) /= element) cycle
      moved = dot_product(link%lump_value(:, i), coefficient)
      if (present(back)) moved = moved - back(i)
      force = force + link%lump(i)*moved*link%lump_value(:, i)
      if (present(on_mass)) on_mass(i) = link%lump(i)*moved
    end do
  end subroutine add_lump_forces

  !> Adds moments at the masses in an element, as moments on the Legendre coefficients of the
  !! rotation.
  pure subroutine add_lump_moments(link, element, at_mass, moment)
    type(chain_t), intent(in) :: link    !! with its masses
    integer, intent(in) :: element       !! its number
    real(wp), intent(in) :: at_mass(:)   !! (lumps)
    real(wp), intent(inout) :: moment(:) !! (coefficients − 1)

    integer :: i

    do i = 1, size(link%lump)
      if (link%lump_element(i) == element) moment = moment + &
        at_mass(i)*link%lump_value(:size(moment), i)
    end do
  end subroutine add_lump_moments

  !> Value of a function at a place in an element.
  pure function at_place(table, y, place) result(value)
    real(wp), intent(in) :: table(:, :) !! (coefficients, unknowns) as in `at_end`
    real(wp), intent(in) :: y(:)        !! (unknowns) of the element
    real(wp), intent(in) :: place       !! from −1 to 1 in the element
    real(wp) :: value

    value = dot_product(matmul(table, y), legendre_values(size(table, 1) - 1, place))
  end function at_place

end module chain_links
