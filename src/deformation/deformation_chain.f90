!> Long meshes in deformation coordinates: products with mass and geometric stiffness by running
!! sums along the links.
!!
!! The unknowns are those of `deformation_shapes`, element by element: first the bending of all
!! links, then their axial strains. The stiffness is the unit matrix. Nothing is assembled, so work
!! and memory grow in proportion to the number of elements. No digits are lost, because the
!! deformations of an element are small numbers themselves, not differences of displacements.
module deformation_chain
  use axial_forces, only: most_lump_functions
  use beam_mesh, only: beam_t
  use chain_links, only: add_back, add_back_at_end, add_from_start, add_lump_forces, &
    add_lump_moments, at_end, at_place, chain_t, new_chain, slope_at_start
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: linkage_t
  use long_sums, only: add_exactly
  use pin_displacements, only: body_displacement, border_numbers, chords_t
  use rigid_links, only: new_rigid_link
  use symmetric_pencil, only: symmetric_pencil_t
  implicit none (type, external)
  private

  public :: deformation_chain_t, new_deformation_chain, chain_shape

  !> A linkage on a long mesh, at one position and under one load.
  type, extends(symmetric_pencil_t) :: deformation_chain_t
    type(chain_t), allocatable :: links(:)
    type(chords_t) :: chords                     !! of this position
    integer, allocatable :: number(:)            !! (0:links) of the border unknowns, as in
                                                 !! `border_numbers`
    integer :: border = 0                        !! number of border unknowns
    real(wp), allocatable :: rigid_mass(:, :, :) !! (3, 3, links) of rigid links, as in
                                                 !! `link_modes_t`; zero for the others
    real(wp), allocatable :: pin_mass(:)         !! (pins) [kg]
    real(wp), allocatable :: axial_force(:, :)   !! (3, elements) coefficients of 1, ξ, ξ² in every
                                                 !! element, for a rigid link its mean force; no
                                                 !! elements: no loads [N]
    real(wp), allocatable :: jump(:, :)          !! (lumps, links) forces from the first pin to the
                                                 !! masses along the links; with masses that turn,
                                                 !! `turning_forces` follow [N]
  contains
    procedure :: multiply
  end type deformation_chain_t

contains

  !> All properties of a linkage on a long mesh that do not depend on the position.
  pure function new_deformation_chain(linkage, beams, elements, order, axial_degree) result(chain)
    type(linkage_t), intent(in) :: linkage !! lengths and masses
    type(beam_t), intent(in) :: beams(:)   !! (bodies)
    integer, intent(in) :: elements(:)     !! (bodies)
    integer, intent(in) :: order(:)        !! (bodies) polynomial degree of the transverse
                                           !! displacements
    integer, intent(in) :: axial_degree(:) !! (bodies) that of the axial displacements
    type(deformation_chain_t) :: chain

    type(link_modes_t) :: rigid_link
    integer :: b, number

    allocate (chain%number(0:size(beams)), chain%rigid_mass(3, 3, size(beams)))
    chain%number(:) = border_numbers(linkage)
    chain%border = maxval(chain%number)
    chain%rigid_mass = 0.0_wp
    chain%pin_mass = linkage%pin_mass
    allocate (chain%axial_force(3, 0), chain%links(size(beams)), &
      chain%jump(most_lump_functions(linkage), size(beams)))
    chain%jump = 0.0_wp
    number = 0
    do b = 1, size(beams)
      chain%links(b) = new_chain(linkage%bodies(b), beams(b), elements(b), order(b), &
        axial_degree(b))
      if (.not. linkage%bodies(b)%bends) then
        rigid_link = new_rigid_link(linkage%bodies(b))
        chain%rigid_mass(:, :, b) = rigid_link%rigid_mass
      end if
      chain%links(b)%first_bending = number
      number = number + elements(b)*chain%links(b)%bendings
    end do
    do b = 1, size(beams)
      chain%links(b)%first_strain = number
      number = number + elements(b)*chain%links(b)%strains
    end do
    chain%unknowns = number
  end function new_deformation_chain

  !> `M y` and `(I + G) y`. A pass along each link turns deformations into displacements and slopes;
  !! a pass back turns forces into generalized forces on the deformations.
  pure subroutine multiply(pencil, vector, mass_times, stiffness_times)
    class(deformation_chain_t), intent(in) :: pencil !! with chords and forces set
    real(wp), intent(in) :: vector(:)                !! (unknowns) y
    real(wp), intent(out) :: mass_times(:)           !! (unknowns) M y
    real(wp), intent(out) :: stiffness_times(:)      !! (unknowns) (I + G) y

    real(wp) :: border(pencil%border), on_border(pencil%border), turned(pencil%border), pin(2), &
      motion(3, pencil%border)
    real(wp), allocatable :: turned_masses(:), moments(:)
    integer :: b, first_element

    border = border_of(pencil, vector)
    on_border = 0.0_wp
    turned = 0.0_wp
    mass_times = 0.0_wp
    stiffness_times = 0.0_wp
    first_element = 1
    do b = 1, size(pencil%links)
      if (.not. pencil%links(b)%bends) then
        motion = body_displacement(pencil%chords, b)
        on_border = on_border + matmul(matmul(pencil%rigid_mass(:, :, b), matmul(motion, border)), &
          motion)
        if (size(pencil%axial_force, 2) > 0) turned = turned + pencil%axial_force(1, &
          first_element)*pencil%links(b)%length*dot_product(pencil%chords%turn(:, b), &
          border)*pencil%chords%turn(:, b)
        first_element = first_element + pencil%links(b)%elements
        cycle
      end if
      turned_masses = turns_of_masses(pencil%links(b), pencil%chords%turn(:, b), border, vector)
      moments = pencil%links(b)%lump_inertia*turned_masses
      call add_stretching(pencil%links(b), pencil%chords%along(:, :, b), border, vector, &
        turned_masses, mass_times, on_border, moments)
      call add_bending(pencil%links(b), pencil%chords%across(:, :, b), border, vector, moments, &
        mass_times, on_border)
      if (size(pencil%axial_force, 2) > 0) then
        call add_geometric(pencil%links(b), &
          pencil%axial_force(:, first_element:first_element + pencil%links(b)%elements - 1), &
          pencil%jump(:, b), pencil%chords%turn(:, b), border, vector, turned_masses, &
          stiffness_times, turned)
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

  !> The border unknowns of a vector: the clamped end's rotation and the elongations of the links.
  pure function border_of(pencil, vector) result(border)
    class(deformation_chain_t), intent(in) :: pencil
    real(wp), intent(in) :: vector(:)
    real(wp) :: border(pencil%border)

    real(wp) :: parts(2)
    integer :: b, e

    if (pencil%number(0) > 0) border(1) = slope_at_start(pencil%links(1), &
      vector)/pencil%links(1)%end_rotation
    do b = 1, size(pencil%links)
      if (pencil%number(b) == 0) cycle
      associate (link => pencil%links(b))
        parts = 0.0_wp
        do e = 1, link%elements
          call add_exactly(parts, vector(link%first_strain + (e - 1)*link%strains + 1))
        end do
        border(pencil%number(b)) = sum(parts)/sqrt(real(link%elements, wp))
      end associate
    end do
  end function border_of

  !> The transpose of `border_of`.
  pure subroutine add_from_border(pencil, on_border, vector)
    class(deformation_chain_t), intent(in) :: pencil
    real(wp), intent(in) :: on_border(:)
    real(wp), intent(inout) :: vector(:)

    integer :: b, e, i

    if (pencil%number(0) > 0) call add_from_start(pencil%links(1), &
      on_border(1)/pencil%links(1)%end_rotation, vector)
    do b = 1, size(pencil%links)
      if (pencil%number(b) == 0) cycle
      associate (link => pencil%links(b))
        do e = 1, link%elements
          i = link%first_strain + (e - 1)*link%strains + 1
          vector(i) = vector(i) + on_border(pencil%number(b))/sqrt(real(link%elements, wp))
        end do
      end associate
    end do
  end subroutine add_from_border

  !> Rotations of the cross-sections that carry masses; zero where no mass turns with them.
  pure function turns_of_masses(link, turn, border, vector) result(rotation)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: turn(:)               !! (border) rotation of its chord
    real(wp), intent(in) :: border(:), vector(:)
    real(wp) :: rotation(size(link%lump))

    real(wp) :: slope(2), coefficient(size(link%turn, 1))
    integer :: e, i, k

    rotation = 0.0_wp
    if (.not. link%lumps_turn) return
    slope = [slope_at_start(link, vector), 0.0_wp]
    do e = 1, link%elements
      i = link%first_bending + (e - 1)*link%bendings
      associate (y => vector(i + 1:i + link%bendings))
        if (any(link%lump_element == e)) then
          coefficient = matmul(link%rotate, y)
          do k = 1, size(rotation)
            if (link%lump_element(k) == e) rotation(k) = dot_product(turn, border) + sum(slope) + &
              dot_product(link%lump_value(:size(coefficient), k), coefficient)
          end do
        end if
        call add_exactly(slope, at_end(link%rotate, link%at_end, y))
      end associate
    end do
  end function turns_of_masses

  !> Adds the transverse motion of a link to `M y`, on its own unknowns and on the border.
  pure subroutine add_bending(link, across, border, vector, on_masses, mass_times, on_border)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: across(:, :) !! (3, border) of its chord
    real(wp), intent(in) :: border(:), vector(:)
    real(wp), intent(in) :: on_masses(:) !! (lumps) moments on the cross-sections that carry them
    real(wp), intent(inout) :: mass_times(:), on_border(:)

    real(wp) :: coefficient(size(link%weight), link%elements)
    real(wp) :: rotation(size(link%rotation_weight), link%elements), moment(size(link%rotate, 1))
    real(wp) :: value(2), slope(2), ends(2), on_ends(2), h, force(size(link%weight))
    integer :: e, i
    logical :: has_rotary

    h = link%length/link%elements
    has_rotary = size(link%rotation_weight) > 0
    ends = matmul(across(1:2, :), border)
    value = 0.0_wp
    slope = [slope_at_start(link, vector), 0.0_wp]
    do e = 1, link%elements
      i = link%first_bending + (e - 1)*link%bendings
      associate (y => vector(i + 1:i + link%bendings))
        coefficient(:, e) = matmul(link%bend, y)
        coefficient(1, e) = coefficient(1, e) + sum(value) + 0.5_wp*h*sum(slope) + ends(1) + &
          (ends(2) - ends(1))*(e - 0.5_wp)/link%elements
        coefficient(2, e) = coefficient(2, e) + 0.5_wp*h*sum(slope) + &
          0.5_wp*(ends(2) - ends(1))/link%elements
        if (has_rotary) then
          rotation(:, e) = matmul(link%rotate, y)
          rotation(1, e) = rotation(1, e) + sum(slope) + (ends(2) - ends(1))/link%length
        end if
        ! P_j is 1 at the end: the displacement or rotation reached there is the sum of its
        ! coefficients.
        call add_exactly(value, h*sum(slope))
        call add_exactly(value, at_end(link%bend, link%at_end, y))
        call add_exactly(slope, at_end(link%rotate, link%at_end, y))
      end associate
    end do
    value = 0.0_wp
    slope = 0.0_wp
    on_ends = 0.0_wp
    do e = link%elements, 1, -1
      i = link%first_bending + (e - 1)*link%bendings
      force = link%weight*coefficient(:, e)
      call add_lump_forces(link, e, coefficient(:, e), force)
      call add_back(link%bend, force, mass_times(i + 1:i + link%bendings))
      call add_back_at_end(link%bend, link%at_end, sum(value), mass_times(i + 1:i + link%bendings))
      call add_back_at_end(link%rotate, link%at_end, sum(slope), &
        mass_times(i + 1:i + link%bendings))
      call add_exactly(slope, h*sum(value) + 0.5_wp*h*(force(1) + force(2)))
      call add_exactly(value, force(1))
      on_ends = on_ends + force(1)*[1.0_wp - (e - 0.5_wp)/link%elements, &
        (e - 0.5_wp)/link%elements] + 0.5_wp*force(2)/link%elements*[-1.0_wp, 1.0_wp]
      if (.not. (has_rotary .or. link%lumps_turn)) cycle
      moment = 0.0_wp
      if (has_rotary) moment = link%rotation_weight*rotation(:, e)
      if (link%lumps_turn) call add_lump_moments(link, e, on_masses, moment)
      call add_back(link%rotate, moment, mass_times(i + 1:i + link%bendings))
      call add_exactly(slope, moment(1))
      on_ends = on_ends + moment(1)/link%length*[-1.0_wp, 1.0_wp]
    end do
    call add_from_start(link, sum(slope), mass_times)
    on_border = on_border + matmul(on_ends, across(1:2, :))
  end subroutine add_bending

  !> Adds the axial motion of a link to `M y`, on its own unknowns and on the border.
  pure subroutine add_stretching(link, along, border, vector, turned_masses, mass_times, &
      on_border, moments)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: along(:, :) !! (2, border) of its chord
    real(wp), intent(in) :: border(:), vector(:)
    real(wp), intent(in) :: turned_masses(:) !! (lumps) of `turns_of_masses`
    real(wp), intent(inout) :: mass_times(:), on_border(:)
    real(wp), intent(inout) :: moments(:) !! (lumps) to which those of the forces along the link are
                                          !! added

    real(wp) :: coefficient(size(link%weight), link%elements), value(2), force(size(link%weight)), &
      start, on_mass(size(link%lump))
    integer :: e, i

    on_mass = 0.0_wp
    start = dot_product(along(1, :), border)
    value = 0.0_wp
    do e = 1, link%elements
      i = link%first_strain + (e - 1)*link%strains
      coefficient(:, e) = matmul(link%stretch, vector(i + 1:i + link%strains))
      coefficient(1, e) = coefficient(1, e) + sum(value) + start
      call add_exactly(value, at_end(link%stretch, min(2, link%strains), &
        vector(i + 1:i + link%strains)))
    end do
    value = 0.0_wp
    do e = link%elements, 1, -1
      i = link%first_strain + (e - 1)*link%strains
      force = link%weight*coefficient(:, e)
      call add_lump_forces(link, e, coefficient(:, e), force, link%offset*turned_masses, on_mass)
      call add_back(link%stretch, force, mass_times(i + 1:i + link%strains))
      call add_back_at_end(link%stretch, min(2, link%strains), sum(value), &
        mass_times(i + 1:i + link%strains))
      call add_exactly(value, force(1))
    end do
    on_border = on_border + sum(value)*along(1, :)
    if (link%lumps_turn) moments = moments - link%offset*on_mass
  end subroutine add_stretching

  !> Adds a link's geometric stiffness, `K_G = ∫ N v'²`, times the vector, on its own unknowns and
  !! on the border.
  pure subroutine add_geometric(link, axial_force, jump, turn, border, vector, turned_masses, &
      stiffness_times, on_border)
    type(chain_t), intent(in) :: link
    real(wp), intent(in) :: axial_force(:, :) !! (3, elements) [N]
    real(wp), intent(in) :: jump(:)           !! (at least lumps, twice with masses that turn) [N]
    real(wp), intent(in) :: turn(:)           !! (border) rotation of its chord
    real(wp), intent(in) :: border(:), vector(:)
    real(wp), intent(in) :: turned_masses(:)  !! (lumps) of `turns_of_masses`
    real(wp), intent(inout) :: stiffness_times(:), on_border(:)

    real(wp) :: moment(size(link%turn, 1), link%elements), coefficient(size(link%turn, 1)), &
      on_masses(size(link%turn, 1)), slope(2), chord
    integer :: e, i, k

    chord = dot_product(turn, border)
    slope = [slope_at_start(link, vector), 0.0_wp]
    do e = 1, link%elements
      i = link%first_bending + (e - 1)*link%bendings
      coefficient = matmul(link%turn, vector(i + 1:i + link%bendings))
      coefficient(1) = coefficient(1) + sum(slope) + chord
      moment(:, e) = 0.0_wp
      do k = 1, 3
        moment(:, e) = moment(:, e) + axial_force(k, e)*matmul(link%force(:, :, k), coefficient)
      end do
      do k = 1, size(link%lump)
        if (e < link%lump_element(k)) moment(:, e) = moment(:, e) + &
          jump(k)*matmul(link%force(:, :, 1), coefficient)
        if (e == link%lump_element(k)) moment(:, e) = moment(:, e) + &
          jump(k)*matmul(link%before(:, :, k), coefficient)
      end do
      call add_exactly(slope, at_end(link%rotate, link%at_end, vector(i + 1:i + link%bendings)))
    end do
    slope = 0.0_wp
    do e = link%elements, 1, -1
      i = link%first_bending + (e - 1)*link%bendings
      call add_back(link%turn, moment(:, e), stiffness_times(i + 1:i + link%bendings))
      call add_back_at_end(link%rotate, link%at_end, sum(slope), &
        stiffness_times(i + 1:i + link%bendings))
      call add_exactly(slope, moment(1, e))
      if (.not. link%lumps_turn) cycle
      on_masses = 0.0_wp
      call add_lump_moments(link, e, link%length*jump(size(link%lump) + &
        1:2*size(link%lump))*turned_masses, on_masses)
      call add_back(link%rotate, on_masses, stiffness_times(i + 1:i + link%bendings))
      call add_exactly(slope, on_masses(1))
    end do
    call add_from_start(link, sum(slope), stiffness_times)
    on_border = on_border + sum(slope)*turn
  end subroutine add_geometric

  !> Displacements at places along a body: along it, across it, and the rotation.
  pure function chain_shape(pencil, vector, body, xi) result(displacement)
    type(deformation_chain_t), intent(in) :: pencil !! at a position
    real(wp), intent(in) :: vector(:)               !! (unknowns) [√J]
    integer, intent(in) :: body                     !! its number
    real(wp), intent(in) :: xi(:)                   !! (places) from 0 to 1 along the body,
                                                    !! ascending
    real(wp) :: displacement(3, size(xi))           !! (components, places) [m, m, rad]

    real(wp) :: border(pencil%border), ends(2), start, moved(2), value(2), slope(2), h, place
    integer :: e, i, next, first

    border = border_of(pencil, vector)
    ends = matmul(pencil%chords%across(1:2, :, body), border)
    start = dot_product(pencil%chords%along(1, :, body), border)
    associate (link => pencil%links(body))
      if (.not. link%bends) then
        displacement(1, :) = start
        displacement(2, :) = ends(1) + (ends(2) - ends(1))*xi
        displacement(3, :) = (ends(2) - ends(1))/link%length
        return
      end if
      h = link%length/link%elements
      moved = 0.0_wp
      value = 0.0_wp
      slope = [slope_at_start(link, vector), 0.0_wp]
      next = 1
      do e = 1, link%elements
        i = link%first_bending + (e - 1)*link%bendings
        first = link%first_strain + (e - 1)*link%strains
        do while (next <= size(xi))
          place = 2.0_wp*(xi(next)*link%elements - (e - 0.5_wp))
          if (place > 1.0_wp .and. e < link%elements) exit
          displacement(1, next) = start + sum(moved) + at_place(link%stretch, &
            vector(first + 1:first + link%strains), place)
          displacement(2, next) = ends(1) + (ends(2) - ends(1))*xi(next) + sum(value) + &
            0.5_wp*h*(place + 1.0_wp)*sum(slope) + at_place(link%bend, &
            vector(i + 1:i + link%bendings), place)
          displacement(3, next) = (ends(2) - ends(1))/link%length + sum(slope) + &
            at_place(link%rotate, vector(i + 1:i + link%bendings), place)
          next = next + 1
        end do
        call add_exactly(moved, at_end(link%stretch, min(2, link%strains), &
          vector(first + 1:first + link%strains)))
        call add_exactly(value, h*sum(slope))
        call add_exactly(value, at_end(link%bend, link%at_end, vector(i + 1:i + link%bendings)))
        call add_exactly(slope, at_end(link%rotate, link%at_end, vector(i + 1:i + link%bendings)))
      end do
    end associate
  end function chain_shape

end module deformation_chain
