!> Long meshes in deformation coordinates: products with mass and geometric stiffness by running sums along the links.
!!
!! Unknowns are those of `deformation_shapes`, element after element, curvatures of all links first, then strains; the stiffness
!! is the unit matrix. Nothing is assembled: work and memory grow with the number of elements, and no digits are lost to it, for
!! the deformations of an element are small numbers themselves and not differences of displacements.
module deformation_chain
  use beam_mesh, only: beam_t
  use deformation_shapes, only: curve, once_integrated
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values
  use linkages, only: linkage_t
  use long_sums, only: add_exactly, long_dot
  use pin_displacements, only: chords_t
  use symmetric_pencil, only: symmetric_pencil_t
  implicit none (type, external)
  private

  public :: deformation_chain_t, new_deformation_chain, project_modes, chain_shape

  !> One link.
  type :: chain_t
    integer :: elements = 0
    integer :: curvatures = 0   !! unknowns of an element
    integer :: strains = 0
    integer :: first_curvature = 0 !! number of the link's first unknown, minus one
    integer :: first_strain = 0
    real(wp) :: length = 0.0_wp !! of the link [m]
    real(wp), allocatable :: bend(:, :)     !! (coefficients, curvatures) Legendre coefficients of the displacement in the element
    real(wp), allocatable :: turn(:, :)     !! (coefficients − 1, curvatures) those of its slope
    real(wp), allocatable :: stretch(:, :)  !! (coefficients, strains) those of the axial displacement
    real(wp), allocatable :: weight(:)      !! μ h/(2j+1): squares of the coefficients times these are the mass
    real(wp), allocatable :: force(:, :, :) !! (coefficients − 1, coefficients − 1, 3) `h ∫ ξ^(k−1) P_i P_j dξ`
    real(wp), allocatable :: start_slope(:) !! (curvatures × elements) v' at the first end, the chord at rest
    real(wp) :: end_rotation = 0.0_wp       !! √(L/3EI), which is the norm of `start_slope`
  end type chain_t

  type, extends(symmetric_pencil_t) :: deformation_chain_t
    type(chain_t), allocatable :: links(:)
    type(chords_t) :: chords
    real(wp), allocatable :: pin_mass(:)
    real(wp), allocatable :: axial_force(:, :) !! (3, elements) coefficients of 1, ξ, ξ² in every element [N]; no elements: no loads
  contains
    procedure :: multiply
  end type deformation_chain_t

contains

  !> Everything that does not change with the position.
  pure function new_deformation_chain(linkage, beams, elements, order, axial_degree) result(chain)
    type(linkage_t), intent(in) :: linkage
    type(beam_t), intent(in) :: beams(:)
    integer, intent(in) :: elements(:), order(:), axial_degree(:) !! (bodies)
    type(deformation_chain_t) :: chain

    integer :: b, number

    chain%pin_mass = linkage%pin_mass
    allocate (chain%axial_force(3, 0), chain%links(size(beams)))
    number = 0
    do b = 1, size(beams)
      associate (body => linkage%bodies(b))
        chain%links(b) = new_chain(body%length, body%line_density, beams(b), elements(b), order(b), axial_degree(b))
      end associate
      chain%links(b)%first_curvature = number
      number = number + elements(b)*(order(b) - 1)
    end do
    do b = 1, size(beams)
      chain%links(b)%first_strain = number
      number = number + elements(b)*axial_degree(b)
    end do
    chain%unknowns = number
  end function new_deformation_chain

  pure function new_chain(length, line_density, beam, elements, order, axial_degree) result(link)
    real(wp), intent(in) :: length, line_density
    type(beam_t), intent(in) :: beam
    integer, intent(in) :: elements, order, axial_degree
    type(chain_t) :: link

    real(wp) :: h, scale
    integer :: e, j, coefficients

    h = length/elements
    coefficients = max(order, axial_degree) + 1
    link%elements = elements
    link%curvatures = order - 1
    link%strains = axial_degree
    link%length = length
    link%end_rotation = sqrt(length/(3.0_wp*beam%bending_stiffness))
    allocate (link%bend(coefficients, order - 1), link%turn(coefficients - 1, order - 1), link%stretch(coefficients, axial_degree))
    link%bend = 0.0_wp
    link%turn = 0.0_wp
    link%stretch = 0.0_wp
    do j = 0, order - 2
      scale = 0.5_wp*h*sqrt((2*j + 1)/(beam%bending_stiffness*h))
      link%bend(:j + 3, j + 1) = 0.5_wp*h*scale*curve(j)
      link%turn(:j + 2, j + 1) = scale*once_integrated(j)
    end do
    do j = 0, axial_degree - 1
      link%stretch(:j + 2, j + 1) = 0.5_wp*h*sqrt((2*j + 1)/(beam%axial_stiffness*h))*once_integrated(j)
    end do
    link%weight = [(line_density*h/(2*j + 1), j=0, coefficients - 1)]
    link%force = force_integrals(coefficients - 1, h)
    ! v'(0) = −∫ (1 − x/L) v'' dx; of the curvatures only P_0 and P_1 count.
    allocate (link%start_slope(elements*(order - 1)))
    link%start_slope = 0.0_wp
    do e = 1, elements
      link%start_slope((e - 1)*(order - 1) + 1) = -sqrt(h/beam%bending_stiffness)*(1.0_wp - (e - 0.5_wp)/elements)
      link%start_slope((e - 1)*(order - 1) + 2) = sqrt(3.0_wp*h/beam%bending_stiffness)/(6.0_wp*elements)
    end do
  end function new_chain

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
          integral(:, j, k) = integral(:, j, k) + 0.5_wp*h*w(i)*(0.5_wp*(1.0_wp + x(i)))**(k - 1)*p(j)*p
        end do
      end do
    end do
  end function force_integrals

  !> `M y` and `(I + G) y`: down the links from deformations to displacements and slopes, and back from forces to deformations.
  pure subroutine multiply(pencil, vector, mass_times, stiffness_times)
    class(deformation_chain_t), intent(in) :: pencil
    real(wp), intent(in) :: vector(:)
    real(wp), intent(out) :: mass_times(:), stiffness_times(:)

    real(wp) :: border(size(pencil%links) + 1), on_border(size(pencil%links) + 1), turned(size(pencil%links) + 1), pin(2)
    integer :: b, first_element

    border = border_of(pencil, vector)
    on_border = 0.0_wp
    turned = 0.0_wp
    mass_times = 0.0_wp
    stiffness_times = 0.0_wp
    first_element = 1
    do b = 1, size(pencil%links)
      call add_bending(pencil%links(b), pencil%chords%across(:, :, b), border, vector, mass_times, on_border)
      call add_stretching(pencil%links(b), pencil%chords%along(:, :, b), border, vector, mass_times, on_border)
      if (size(pencil%axial_force, 2) > 0) then
        call add_geometric(pencil%links(b), pencil%axial_force(:, first_element:first_element + pencil%links(b)%elements - 1), &
          pencil%chords%turn(:, b), border, vector, stiffness_times, turned)
      end if
      first_element = first_element + pencil%links(b)%elements
    end do
    do b = 1, size(pencil%pin_mass)
      if (pencil%pin_mass(b) <= 0.0_wp) cycle
      pin = matmul(pencil%chords%pin(:, b, :), border)
      on_border = on_border + pencil%pin_mass(b)*matmul(pin, pencil%chords%pin(:, b, :))
    end do
    call add_from_border(pencil, on_border, mass_times)
    call add_from_border(pencil, turned, stiffness_times)
    stiffness_times = stiffness_times + vector
  end subroutine multiply

  !> The clamped end's rotation and the links' elongations.
  pure function border_of(pencil, vector) result(border)
    class(deformation_chain_t), intent(in) :: pencil
    real(wp), intent(in) :: vector(:)
    real(wp) :: border(size(pencil%links) + 1)

    real(wp) :: parts(2)
    integer :: b, e

    border(1) = slope_at_start(pencil%links(1), vector)/pencil%links(1)%end_rotation
    do b = 1, size(pencil%links)
      associate (link => pencil%links(b))
        parts = 0.0_wp
        do e = 1, link%elements
          call add_exactly(parts, vector(link%first_strain + (e - 1)*link%strains + 1))
        end do
        border(b + 1) = sum(parts)/sqrt(real(link%elements, wp))
      end associate
    end do
  end function border_of

  !> The transpose of `border_of`.
  pure subroutine add_from_border(pencil, on_border, vector)
    class(deformation_chain_t), intent(in) :: pencil
    real(wp), intent(in) :: on_border(:)
    real(wp), intent(inout) :: vector(:)

    integer :: b, e, i

    call add_from_start(pencil%links(1), on_border(1)/pencil%links(1)%end_rotation, vector)
    do b = 1, size(pencil%links)
      associate (link => pencil%links(b))
        do e = 1, link%elements
          i = link%first_strain + (e - 1)*link%strains + 1
          vector(i) = vector(i) + on_border(b + 1)/sqrt(real(link%elements, wp))
        end do
      end associate
    end do
  end subroutine add_from_border

  !> Transverse motion of a link: its mass times displacements, and what that does to its unknowns and to the border.
  pure subroutine add_bending(link, across, border, vector, mass_times, on_border)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: across(:, :)
    real(wp), intent(in) :: border(:), vector(:)
    real(wp), intent(inout) :: mass_times(:), on_border(:)

    real(wp) :: coefficient(size(link%weight), link%elements)
    real(wp) :: value(2), slope(2), ends(2), on_ends(2), h, force(size(link%weight))
    integer :: e, i

    h = link%length/link%elements
    ends = matmul(across(1:2, :), border)
    value = 0.0_wp
    slope = [slope_at_start(link, vector), 0.0_wp]
    do e = 1, link%elements
      i = link%first_curvature + (e - 1)*link%curvatures
      associate (y => vector(i + 1:i + link%curvatures))
        coefficient(:, e) = matmul(link%bend, y)
        coefficient(1, e) = coefficient(1, e) + sum(value) + 0.5_wp*h*sum(slope) + ends(1) + (ends(2) - ends(1))*(e - 0.5_wp)/ &
          link%elements
        coefficient(2, e) = coefficient(2, e) + 0.5_wp*h*sum(slope) + 0.5_wp*(ends(2) - ends(1))/link%elements
        ! P_j is 1 at the end: what a displacement or slope has grown to is the sum of its coefficients.
        call add_exactly(value, h*sum(slope))
        call add_exactly(value, at_end(link%bend, y))
        call add_exactly(slope, at_end(link%turn, y))
      end associate
    end do
    value = 0.0_wp
    slope = 0.0_wp
    on_ends = 0.0_wp
    do e = link%elements, 1, -1
      i = link%first_curvature + (e - 1)*link%curvatures
      force = link%weight*coefficient(:, e)
      call add_back(link%bend, force, mass_times(i + 1:i + link%curvatures))
      call add_back_at_end(link%bend, sum(value), mass_times(i + 1:i + link%curvatures))
      call add_back_at_end(link%turn, sum(slope), mass_times(i + 1:i + link%curvatures))
      call add_exactly(slope, h*sum(value) + 0.5_wp*h*(force(1) + force(2)))
      call add_exactly(value, force(1))
      on_ends = on_ends + force(1)*[1.0_wp - (e - 0.5_wp)/link%elements, (e - 0.5_wp)/link%elements] + &
        0.5_wp*force(2)/link%elements*[-1.0_wp, 1.0_wp]
    end do
    call add_from_start(link, sum(slope), mass_times)
    on_border = on_border + matmul(on_ends, across(1:2, :))
  end subroutine add_bending

  !> The same for axial motion.
  pure subroutine add_stretching(link, along, border, vector, mass_times, on_border)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: along(:, :)
    real(wp), intent(in) :: border(:), vector(:)
    real(wp), intent(inout) :: mass_times(:), on_border(:)

    real(wp) :: coefficient(size(link%weight), link%elements), value(2), force(size(link%weight)), start
    integer :: e, i

    start = dot_product(along(1, :), border)
    value = 0.0_wp
    do e = 1, link%elements
      i = link%first_strain + (e - 1)*link%strains
      coefficient(:, e) = matmul(link%stretch, vector(i + 1:i + link%strains))
      coefficient(1, e) = coefficient(1, e) + sum(value) + start
      call add_exactly(value, at_end(link%stretch, vector(i + 1:i + link%strains)))
    end do
    value = 0.0_wp
    do e = link%elements, 1, -1
      i = link%first_strain + (e - 1)*link%strains
      force = link%weight*coefficient(:, e)
      call add_back(link%stretch, force, mass_times(i + 1:i + link%strains))
      call add_back_at_end(link%stretch, sum(value), mass_times(i + 1:i + link%strains))
      call add_exactly(value, force(1))
    end do
    on_border = on_border + sum(value)*along(1, :)
  end subroutine add_stretching

  !> `K_G = ∫ N v'²` of a link.
  pure subroutine add_geometric(link, axial_force, turn, border, vector, stiffness_times, on_border)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: axial_force(:, :) !! (3, elements)
    real(wp), intent(in) :: turn(:)
    real(wp), intent(in) :: border(:), vector(:)
    real(wp), intent(inout) :: stiffness_times(:), on_border(:)

    real(wp) :: moment(size(link%turn, 1), link%elements), coefficient(size(link%turn, 1)), slope(2), chord
    integer :: e, i, k

    chord = dot_product(turn, border)
    slope = [slope_at_start(link, vector), 0.0_wp]
    do e = 1, link%elements
      i = link%first_curvature + (e - 1)*link%curvatures
      coefficient = matmul(link%turn, vector(i + 1:i + link%curvatures))
      coefficient(1) = coefficient(1) + sum(slope) + chord
      moment(:, e) = 0.0_wp
      do k = 1, 3
        moment(:, e) = moment(:, e) + axial_force(k, e)*matmul(link%force(:, :, k), coefficient)
      end do
      call add_exactly(slope, at_end(link%turn, vector(i + 1:i + link%curvatures)))
    end do
    slope = 0.0_wp
    do e = link%elements, 1, -1
      i = link%first_curvature + (e - 1)*link%curvatures
      call add_back(link%turn, moment(:, e), stiffness_times(i + 1:i + link%curvatures))
      call add_back_at_end(link%turn, sum(slope), stiffness_times(i + 1:i + link%curvatures))
      call add_exactly(slope, moment(1, e))
    end do
    call add_from_start(link, sum(slope), stiffness_times)
    on_border = on_border + sum(slope)*turn
  end subroutine add_geometric

  !> Rotation of a link's first end against its chord.
  pure function slope_at_start(link, vector) result(slope)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: vector(:)
    real(wp) :: slope

    slope = long_dot(link%start_slope, vector(link%first_curvature + 1:link%first_curvature + size(link%start_slope)))
  end function slope_at_start

  !> The transpose of `slope_at_start`.
  pure subroutine add_from_start(link, moment, vector)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: moment
    real(wp), intent(inout) :: vector(:)

    integer :: i

    do i = 1, size(link%start_slope)
      vector(link%first_curvature + i) = vector(link%first_curvature + i) + moment*link%start_slope(i)
    end do
  end subroutine add_from_start

  !> Value at the end of an element.
  pure function at_end(table, y) result(value)
    real(wp), intent(in) :: table(:, :), y(:)
    real(wp) :: value

    integer :: j

    value = 0.0_wp
    ! Beyond the second unknown values and slopes vanish at the ends.
    do j = 1, min(2, size(y))
      value = value + sum(table(:, j))*y(j)
    end do
  end function at_end

  pure subroutine add_back_at_end(table, value, y)
    real(wp), intent(in) :: table(:, :), value
    real(wp), intent(inout) :: y(:)

    integer :: j

    do j = 1, min(2, size(y))
      y(j) = y(j) + sum(table(:, j))*value
    end do
  end subroutine add_back_at_end

  pure subroutine add_back(table, force, y)
    real(wp), intent(in) :: table(:, :), force(:)
    real(wp), intent(inout) :: y(:)

    y = y + matmul(force, table)
  end subroutine add_back

  !> Modes of a model that is continuous on some links, and has the mesh itself on others: starts for the modes of the mesh.
  pure subroutine project_modes(pencil, continuous, curvature, strain, vectors)
    type(deformation_chain_t), intent(in) :: pencil
    logical, intent(in) :: continuous(:)       !! (links)
    real(wp), intent(in) :: curvature(:, :, :) !! (unknowns, modes, links) of a continuous link Legendre coefficients along it, scaled
                                               !! to energy, else the unknowns of the mesh
    real(wp), intent(in) :: strain(:, :, :)
    real(wp), intent(out) :: vectors(:, :)     !! (unknowns, modes)

    integer :: b

    do b = 1, size(pencil%links)
      associate (link => pencil%links(b), number => pencil%links(b)%elements)
        if (continuous(b)) then
          call project(curvature(:, :, b), number, link%curvatures, &
            vectors(link%first_curvature + 1:link%first_curvature + number*link%curvatures, :))
          call project(strain(:, :, b), number, link%strains, &
            vectors(link%first_strain + 1:link%first_strain + number*link%strains, :))
        else
          vectors(link%first_curvature + 1:link%first_curvature + number*link%curvatures, :) = &
            curvature(:number*link%curvatures, :, b)
          vectors(link%first_strain + 1:link%first_strain + number*link%strains, :) = strain(:number*link%strains, :, b)
        end if
      end associate
    end do
  end subroutine project_modes

  !> Projects `Σ c_k P_k` of the whole link on the functions `√(2j+1) P_j` of each element, so that energies are kept.
  pure subroutine project(whole, elements, unknowns, vectors)
    real(wp), intent(in) :: whole(0:, :) !! (degrees, modes) c
    integer, intent(in) :: elements, unknowns
    real(wp), intent(inout) :: vectors(:, :)

    real(wp) :: x(unknowns + 1), w(unknowns + 1), here(0:unknowns - 1, unknowns + 1), p(0:size(whole, 1) - 1), value
    integer :: e, i, j, mode, first

    call gauss_rule(x, w)
    do i = 1, size(x)
      here(:, i) = 0.5_wp*w(i)/sqrt(real(elements, wp))*legendre_values(unknowns - 1, x(i))
      here(:, i) = here(:, i)*[(sqrt(2*j + 1.0_wp), j=0, unknowns - 1)]
    end do
    vectors = 0.0_wp
    do e = 1, elements
      first = (e - 1)*unknowns
      do i = 1, size(x)
        p = legendre_values(size(whole, 1) - 1, (2*e - 1 + x(i))/elements - 1.0_wp)
        do mode = 1, size(whole, 2)
          value = dot_product(p, whole(:, mode))
          do j = 1, unknowns
            vectors(first + j, mode) = vectors(first + j, mode) + value*here(j - 1, i)
          end do
        end do
      end do
    end do
  end subroutine project

  !> Displacement of places along a body: along it, across it, and the rotation.
  pure function chain_shape(pencil, vector, body, xi) result(displacement)
    type(deformation_chain_t), intent(in) :: pencil
    real(wp), intent(in) :: vector(:)
    integer, intent(in) :: body
    real(wp), intent(in) :: xi(:) !! from 0 to 1 along the body, ascending
    real(wp) :: displacement(3, size(xi))

    real(wp) :: border(size(pencil%links) + 1), ends(2), start, moved(2), value(2), slope(2), h, place
    integer :: e, i, next, first

    border = border_of(pencil, vector)
    ends = matmul(pencil%chords%across(1:2, :, body), border)
    start = dot_product(pencil%chords%along(1, :, body), border)
    associate (link => pencil%links(body))
      h = link%length/link%elements
      moved = 0.0_wp
      value = 0.0_wp
      slope = [slope_at_start(link, vector), 0.0_wp]
      next = 1
      do e = 1, link%elements
        i = link%first_curvature + (e - 1)*link%curvatures
        first = link%first_strain + (e - 1)*link%strains
        do while (next <= size(xi))
          place = 2.0_wp*(xi(next)*link%elements - (e - 0.5_wp))
          if (place > 1.0_wp .and. e < link%elements) exit
          displacement(1, next) = start + sum(moved) + at_place(link%stretch, vector(first + 1:first + link%strains), place)
          displacement(2, next) = ends(1) + (ends(2) - ends(1))*xi(next) + sum(value) + 0.5_wp*h*(place + 1.0_wp)*sum(slope) + &
            at_place(link%bend, vector(i + 1:i + link%curvatures), place)
          displacement(3, next) = (ends(2) - ends(1))/link%length + sum(slope) + &
            at_place(link%turn, vector(i + 1:i + link%curvatures), place)
          next = next + 1
        end do
        call add_exactly(moved, at_end(link%stretch, vector(first + 1:first + link%strains)))
        call add_exactly(value, h*sum(slope))
        call add_exactly(value, at_end(link%bend, vector(i + 1:i + link%curvatures)))
        call add_exactly(slope, at_end(link%turn, vector(i + 1:i + link%curvatures)))
      end do
    end associate
  end function chain_shape

  pure function at_place(table, y, place) result(value)
    real(wp), intent(in) :: table(:, :), y(:)
    real(wp), intent(in) :: place !! from −1 to 1 in the element
    real(wp) :: value

    value = dot_product(matmul(table, y), legendre_values(size(table, 1) - 1, place))
  end function at_place

end module deformation_chain
