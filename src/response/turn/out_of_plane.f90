!> Vibrations of a linkage out of its plane of motion: an estimate of the lowest frequency, for the
!! frequencies and the response in the plane are computed as if there were none.
!!
!! The linkage is a grillage at rest, of the straight parts between its points that the plane has,
!! too. Parts that bend do so out of the plane as slender beams, and twist (St. Venant); axial
!! forces, shear and the rotary inertia of bending are left out. A revolute joint whose axis is
!! normal to the plane transmits the displacement w and both tilts, as a weld does; the rotation
!! about the pin is one in the plane. So does a block, which embraces the link or the guide that it
!! slides along. Pins on the ground are held by their bearings, the crank by its shaft, blocks on
!! the ground by their guides. Rigid links move as rigid bodies. Masses beside the axis of a link
!! turn with it; a moment of inertia is taken as that of a body that extends along the part that it
!! is on, of a rigid link along the axis of its card. Springs and dampers do nothing.
module out_of_plane
  use beam_element, only: new_reference_element, reference_element_t
  use beam_mesh, only: beam_t
  use body_lumps, only: pieces_of
  use bordered_eigensolver, only: bordered_modes_t, start_t
  use constants, only: two_pi
  use elastic_linkages, only: elastic_linkage_t
  use element_eigensolver, only: element_pencil_t, find_element_modes
  use element_matrices, only: elements_t, new_elements
  use elimination_plan, only: elimination_plan_t, new_elimination_plan
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: lump_t, normal_to, turned, turned_back
  use part_poses, only: place_parts_of
  use pose_types, only: pins_of_body
  use poses, only: find_pose, pose_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_out_of_plane_frequency, grillage_frequency, new_grillage_element

  !> Crank angles of a turn that are looked at, and how near to the lowest frequency among them
  !! minima are that are followed between them.
  integer, parameter :: positions = 48
  real(wp), parameter :: may_be_lowest = 1.05_wp

  !> Rounds of parabolas through points that move closer, and how.
  integer, parameter :: rounds = 8
  real(wp), parameter :: narrowing = 0.3_wp

  !> Polynomial degree of deflection and twist of a part, or of each piece between masses along it,
  !! and of the second solution, which shows what the first lacks: it has a higher even and a higher
  !! odd degree, and shapes may be even or odd.
  integer, parameter :: order = 9, order_above = 12

  !> No error is stated smaller: rounding of stiffnesses beside the lowest eigenvalue.
  real(wp), parameter :: least_error = 1.0e-10_wp

  !> Unknowns of a point or of a place on a part: w and two tilts.
  integer, parameter :: of_node = 3

  !> Matrices of a piece of length 1: of w and slope at its first end, bubbles, and the same at its
  !! last end; and of the twists.
  type :: grillage_element_t
    real(wp), allocatable :: bending(:, :), deflection(:, :) !! stiffness, mass
    real(wp), allocatable :: torsion(:, :), twist(:, :)
  end type grillage_element_t

  !> Numbers of the unknowns.
  type :: numbering_t
    integer :: unknowns = 0
    integer, allocatable :: anchor(:) !! (points) point whose unknowns move it: another one if both
                                      !! are on a rigid link, or one is a block on the other
    integer, allocatable :: point(:)  !! (points) number before its w and its tilts about the global
                                      !! axes; negative: held
    integer, allocatable :: inner(:)  !! (parts) number before those of its inner nodes, then the
                                      !! bubbles of its pieces
  end type numbering_t

  !> How a point or a place on a part moves.
  type :: motion_t
    integer :: unknown(of_node) = 0             !! numbers of what moves it; 0: held
    real(wp) :: rows(of_node, of_node) = 0.0_wp !! twist, displacement and slope along an axis, per
                                                !! unit of each
  end type motion_t

  !> K and M, element after element. There is room for more.
  type :: grillage_t
    integer :: values = 0                          !! of the elements so far
    integer, allocatable :: sizes(:), unknown(:)   !! as of `new_elements`
    real(wp), allocatable :: stiffness(:), mass(:) !! values
  end type grillage_t

contains

  !> The lowest frequency over the turn, also between the crank angles looked at.
  !!
  !! Errors: a position cannot be reached; the eigenvalues cannot be found.
  subroutine find_out_of_plane_frequency(structure, frequency, relative_error, error)
    class(structure_t), intent(in) :: structure      !! with beams
    real(wp), allocatable, intent(out) :: frequency  !! [Hz]; unallocated if the stiffnesses of a
                                                     !! link out of the plane are not known
    real(wp), intent(out) :: relative_error          !! estimated
    type(error_t), allocatable, intent(out) :: error !! why there is none

    type(elastic_linkage_t) :: elastic
    type(grillage_element_t) :: element
    type(start_t) :: start
    real(wp) :: at_position(0:positions + 1), crank, last_gain, lowest, finer, rounding
    integer :: k

    relative_error = 0.0_wp
    if (size(structure%beams) == 0) return
    if (any(structure%linkage%bodies%bends .and. (structure%beams%out_of_plane_stiffness <= 0.0_wp &
      .or. structure%beams%torsional_stiffness <= 0.0_wp))) return
    elastic = structure%elastic
    element = new_grillage_element(order)
    do k = 1, positions
      call frequency_at((360.0_wp*(k - 1))/positions, at_position(k))
      if (allocated(error)) return
    end do
    at_position([0, positions + 1]) = at_position([positions, 1])
    lowest = huge(lowest)
    crank = 0.0_wp
    last_gain = 0.0_wp
    do k = 1, positions
      if (at_position(k) > min(may_be_lowest*minval(at_position), at_position(k - 1), &
        at_position(k + 1))) cycle
      call descend((360.0_wp*(k - 1))/positions, at_position(k))
      if (allocated(error)) return
    end do
    element = new_grillage_element(order_above)
    call frequency_at(crank, finer, rounding)
    if (allocated(error)) return
    relative_error = least_error + rounding + (2.0_wp*abs(lowest - finer) + last_gain)/lowest
    frequency = lowest

  contains

    !> The lowest frequency at a crank angle [deg].
    subroutine frequency_at(angle, found, rounding)
      real(wp), intent(in) :: angle
      real(wp), intent(out) :: found
      real(wp), intent(out), optional :: rounding

      type(pose_t) :: pose, placed

      found = huge(found)
      call find_pose(structure%linkage, angle, pose, error)
      if (.not. allocated(error)) call place_parts_of(structure%linkage, pose, elastic, placed, &
        error)
      if (allocated(error)) return
      call grillage_frequency(structure%beams, elastic, placed, element, start, found, error, &
        rounding)
    end subroutine frequency_at

    !> From a minimum among the crank angles looked at to that between them.
    subroutine descend(from, there)
      real(wp), intent(in) :: from, there

      real(wp) :: at, best, f(-1:1), next, step, bend
      integer :: round

      if (there < lowest) crank = from
      lowest = min(lowest, there)
      at = from
      best = there
      step = 360.0_wp/positions
      do round = 1, rounds
        f(0) = best
        call frequency_at(at - step, f(-1))
        if (.not. allocated(error)) call frequency_at(at + step, f(1))
        if (allocated(error)) return
        bend = f(-1) + f(1) - 2.0_wp*f(0)
        next = at
        if (f(-1) < f(0)) next = at - step
        if (f(1) < min(f(-1), f(0))) next = at + step
        if (f(0) <= min(f(-1), f(1)) .and. bend > 0.0_wp) next = at + 0.5_wp*step*(f(-1) - &
          f(1))/bend
        call frequency_at(next, f(0))
        if (allocated(error)) return
        if (f(0) < lowest) then
          last_gain = lowest - f(0)
          lowest = f(0)
          crank = next
        end if
        if (f(0) < best) then
          best = f(0)
          at = next
        end if
        step = narrowing*step
      end do
    end subroutine descend

  end subroutine find_out_of_plane_frequency

  !> The lowest frequency at a position, from `K x = λ M x`; huge without mass.
  !!
  !! Errors: the eigenvalue cannot be found, or be proven to be the lowest.
  subroutine grillage_frequency(beams, elastic, pose, element, start, frequency, error, rounding)
    type(beam_t), intent(in) :: beams(:)             !! (links) stiffnesses of those that bend
    type(elastic_linkage_t), intent(in) :: elastic   !! at the position
    type(pose_t), intent(in) :: pose                 !! of its points and parts
    type(grillage_element_t), intent(in) :: element
    type(start_t), intent(inout) :: start            !! modes nearby, or none; become those here
    real(wp), intent(out) :: frequency               !! [Hz]
    type(error_t), allocatable, intent(out) :: error !! why there is none
    real(wp), intent(out), optional :: rounding      !! relative bound

    type(numbering_t) :: numbering
    type(grillage_t) :: grillage
    type(elements_t) :: elements
    type(elimination_plan_t) :: plan
    type(element_pencil_t) :: pencil
    type(bordered_modes_t) :: found
    integer :: k

    numbering = numbers_of(elastic, element)
    allocate (grillage%sizes(0), grillage%unknown(0), grillage%stiffness(0), grillage%mass(0))
    frequency = huge(frequency)
    if (present(rounding)) rounding = 0.0_wp
    do k = 1, size(elastic%body)
      if (elastic%linkage%bodies(k)%bends) then
        call add_beam(elastic, pose, numbering, element, k, grillage)
      else
        call add_rigid_link(elastic, pose, numbering, k, beams(elastic%body(k))%polar_inertia, &
          grillage)
      end if
    end do
    call add_point_masses(elastic, pose, numbering, grillage)
    pencil%stiffness = grillage%stiffness(:grillage%values)
    pencil%mass = grillage%mass(:grillage%values)
    if (.not. any(abs(pencil%mass) > 0.0_wp)) return
    elements = new_elements(numbering%unknowns, grillage%sizes, grillage%unknown)
    if (start%modes > 0) then
      if (size(start%direction, 1) /= elements%unknowns) start%modes = 0
    end if
    plan = new_elimination_plan(elements, spread(.false., 1, elements%unknowns))
    call find_element_modes(elements, plan, pencil, 1, .false., start, found, error, 0.0_wp)
    if (allocated(error)) return
    start%modes = size(found%lambda)
    start%lambda = found%lambda
    start%direction = found%mass_times
    frequency = sqrt(found%lambda(1))/two_pi
    if (present(rounding)) rounding = 0.5_wp*found%error(1)
  end subroutine grillage_frequency

  !> An element of any degree. That of twists is the axial one of an order that has their degree.
  pure function new_grillage_element(degree) result(element)
    integer, intent(in) :: degree !! of deflection and twist, at least 4
    type(grillage_element_t) :: element

    type(reference_element_t) :: reference
    integer, allocatable :: own(:)
    integer :: i, n, axial_order

    reference = new_reference_element(degree)
    n = size(reference%mass, 1)
    own = [2, 3, (i, i=4, degree), n - 1, n]
    element%bending = reference%bending(own, own)
    element%deflection = reference%mass(own, own)
    axial_order = 3*(degree - 1)
    reference = new_reference_element(axial_order)
    n = size(reference%mass, 1)
    own = [1, (i, i=axial_order + 1, n - 3), n - 2]
    element%torsion = reference%axial(own, own)
    element%twist = reference%mass(own, own)
  end function new_grillage_element

  !> Unknowns of a piece beside those of its ends.
  elemental function bubbles_of(element) result(number)
    type(grillage_element_t), intent(in) :: element
    integer :: number

    number = size(element%bending, 1) + size(element%torsion, 1) - 2*of_node
  end function bubbles_of

  !> Numbers the unknowns: points that are free to move, then what is on the parts.
  pure function numbers_of(elastic, element) result(numbering)
    type(elastic_linkage_t), intent(in) :: elastic
    type(grillage_element_t), intent(in) :: element
    type(numbering_t) :: numbering

    logical :: held(size(elastic%is_fixed))
    integer, allocatable :: pins(:)
    integer :: i, k, p, pieces

    numbering%anchor = [(p, p=1, size(held))]
    associate (linkage => elastic%linkage, anchor => numbering%anchor)
      do k = 1, size(linkage%bodies)
        if (linkage%bodies(k)%bends) cycle
        pins = pins_of_body(linkage%bodies(k))
        do i = 2, size(pins)
          call join(pins(1), pins(i), anchor)
        end do
      end do
      held = linkage%is_ground
      do i = 1, size(linkage%sliders)
        associate (slider => linkage%sliders(i))
          if (slider%body == 0) then
            held(slider%pin) = .true.
          else if (elastic%contact(i) > 0) then
            call join(elastic%contact(i), slider%pin, anchor)
          else
            k = findloc(elastic%body, slider%body, dim=1)
            call join(linkage%bodies(k)%first_pin, slider%pin, anchor)
          end if
        end associate
      end do
    end associate
    allocate (numbering%point(size(held)))
    numbering%point = -1
    do p = 1, size(held)
      if (any(held .and. numbering%anchor == numbering%anchor(p))) cycle
      associate (first => numbering%point(numbering%anchor(p)))
        if (first < 0) then
          first = numbering%unknowns
          numbering%unknowns = numbering%unknowns + of_node
        end if
        numbering%point(p) = first
      end associate
    end do
    allocate (numbering%inner(size(elastic%body)))
    do k = 1, size(elastic%body)
      numbering%inner(k) = numbering%unknowns
      if (.not. elastic%linkage%bodies(k)%bends) cycle
      pieces = size(pieces_of(elastic%linkage%bodies(k))) - 1
      numbering%unknowns = numbering%unknowns + of_node*(pieces - 1) + &
        pieces*bubbles_of(element)
    end do
  end function numbers_of

  !> Lets two points, and all that move with them, move as one rigid body.
  pure subroutine join(one, other, anchor)
    integer, intent(in) :: one, other
    integer, intent(inout) :: anchor(:) !! (points)

    integer :: from, to

    from = anchor(other)
    to = anchor(one)
    where (anchor == from) anchor = to
  end subroutine join

  !> How a point moves, along an axis.
  pure function point_motion(pose, numbering, axis, point) result(motion)
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    real(wp), intent(in) :: axis(2) !! unit vector
    integer, intent(in) :: point
    type(motion_t) :: motion

    real(wp) :: arm(2)
    integer :: i

    if (numbering%point(point) < 0) return
    motion%unknown = [(numbering%point(point) + i, i=1, of_node)]
    ! A tilt (φx, φy) moves the place (x, y) by φx y − φy x; the slope along an axis is minus the
    ! tilt about its normal.
    arm = pose%pin(:, point) - pose%pin(:, numbering%anchor(point))
    motion%rows(1, 2:) = axis
    motion%rows(2, :) = [1.0_wp, arm(2), -arm(1)]
    motion%rows(3, 2:) = -normal_to(axis)
  end function point_motion

  !> How a part that bends moves at one of the ends of its pieces, along its axis.
  pure function node_motion(elastic, pose, numbering, part, node, pieces) result(motion)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: part, node, pieces !! node from 0 to `pieces`
    type(motion_t) :: motion

    integer :: i

    associate (body => elastic%linkage%bodies(part))
      if (node == 0) then
        motion = point_motion(pose, numbering, pose%direction(:, part), body%first_pin)
      else if (node == pieces) then
        motion = point_motion(pose, numbering, pose%direction(:, part), body%last_pin)
      else
        do i = 1, of_node
          motion%unknown(i) = numbering%inner(part) + of_node*(node - 1) + i
          motion%rows(i, i) = 1.0_wp
        end do
      end if
    end associate
  end function node_motion

  !> Adds a part that bends, with the masses along it. Twists and displacements are not coupled.
  pure subroutine add_beam(elastic, pose, numbering, element, part, grillage)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    type(grillage_element_t), intent(in) :: element
    integer, intent(in) :: part
    type(grillage_t), intent(inout) :: grillage

    real(wp), allocatable :: ends(:)
    type(motion_t) :: first, last
    real(wp) :: h
    integer :: e, i, bubble, pieces

    associate (body => elastic%linkage%bodies(part), beam => elastic%beams(part))
      ends = pieces_of(body)
      pieces = size(ends) - 1
      bubble = numbering%inner(part) + of_node*(pieces - 1)
      do e = 1, pieces
        h = body%length*(ends(e + 1) - ends(e))
        first = node_motion(elastic, pose, numbering, part, e - 1, pieces)
        last = node_motion(elastic, pose, numbering, part, e, pieces)
        first%rows(3, :) = h*first%rows(3, :)
        last%rows(3, :) = h*last%rows(3, :)
        call add_piece(beam%out_of_plane_stiffness/h**3*element%bending, &
          body%line_density*h*element%deflection, first, last, [2, 3], bubble, grillage)
        call add_piece(beam%torsional_stiffness/h*element%torsion, &
          beam%polar_inertia*h*element%twist, first, last, [1], bubble, grillage)
      end do
      do i = 1, size(body%lumps)
        e = minloc(abs(ends*body%length - body%lumps(i)%place(1)), dim=1) - 1
        call add_lump(body%lumps(i), [0.0_wp, body%lumps(i)%place(2)], 0.0_wp, &
          node_motion(elastic, pose, numbering, part, e, pieces), grillage)
      end do
    end associate
  end subroutine add_beam

  !> Adds a piece: its matrices are of some rows at its first end, bubbles, and those at its last.
  pure subroutine add_piece(stiffness, mass, first, last, own, bubble, grillage)
    real(wp), intent(in) :: stiffness(:, :), mass(:, :)
    type(motion_t), intent(in) :: first, last
    integer, intent(in) :: own(:)     !! the rows
    integer, intent(inout) :: bubble !! number before its bubbles; becomes that of the last one
    type(grillage_t), intent(inout) :: grillage

    real(wp) :: rows(size(mass, 1), 2*of_node + size(mass, 1) - 2*size(own))
    integer :: unknown(size(rows, 2)), i, to

    rows = 0.0_wp
    unknown(:of_node) = first%unknown
    rows(:size(own), :of_node) = first%rows(own, :)
    ! Ends on the same rigid link have the same unknowns.
    to = merge(0, of_node, last%unknown(1) == first%unknown(1))
    unknown(of_node + 1:2*of_node) = merge(0, last%unknown, to == 0)
    rows(size(mass, 1) - size(own) + 1:, to + 1:to + of_node) = last%rows(own, :)
    do i = 1, size(mass, 1) - 2*size(own)
      bubble = bubble + 1
      unknown(2*of_node + i) = bubble
      rows(size(own) + i, 2*of_node + i) = 1.0_wp
    end do
    call add_forms(stiffness, mass, rows, unknown, grillage)
  end subroutine add_piece

  !> Adds the mass of a rigid link, uniform or a lump for each of its segments, and what is fixed to
  !! it.
  pure subroutine add_rigid_link(elastic, pose, numbering, part, polar_inertia, grillage)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: part
    real(wp), intent(in) :: polar_inertia !! per length of its segments [kg m]
    type(grillage_t), intent(inout) :: grillage

    type(lump_t) :: lump
    real(wp) :: from(2), way(2), axis(2)
    integer :: i

    associate (body => elastic%linkage%bodies(part))
      axis = body%card_axis
      if (body%own_lumps == 0) then
        lump%mass = body%line_density*body%length
        lump%place(1) = 0.5_wp*body%length
        lump%inertia = lump%mass*body%length**2/12.0_wp
        call add_on_link(lump, axis, polar_inertia*body%length, grillage)
      end if
      ! Each segment begins where the one before it ends, and its mass centre is in its middle.
      from = body%origin
      do i = 1, size(body%lumps)
        lump = body%lumps(i)
        if (i > body%own_lumps) then
          call add_on_link(lump, body%card_axis, 0.0_wp, grillage)
          cycle
        end if
        way = 2.0_wp*(lump%place - from)
        from = from + way
        if (body%own_lumps > 1) axis = way/norm2(way)
        lump%inertia = lump%inertia - lump%rotary_inertia
        call add_on_link(lump, axis, polar_inertia*norm2(way), grillage)
      end do
    end associate

  contains

    !> Adds what extends along an axis in those of the link.
    pure subroutine add_on_link(lump, axis, polar, grillage)
      type(lump_t), intent(in) :: lump
      real(wp), intent(in) :: axis(2)
      real(wp), intent(in) :: polar        !! moment of inertia about it [kg m²]
      type(grillage_t), intent(inout) :: grillage

      call add_lump(lump, turned_back(lump%place, axis), polar, point_motion(pose, numbering, &
        turned(axis, pose%direction(:, part)), elastic%linkage%bodies(part)%first_pin), grillage)
    end subroutine add_on_link

  end subroutine add_rigid_link

  !> Adds the masses at pins, and what is fixed where parts meet.
  pure subroutine add_point_masses(elastic, pose, numbering, grillage)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    type(grillage_t), intent(inout) :: grillage

    integer :: i, p

    do p = 1, size(numbering%point)
      call add_lump(lump_t(mass=elastic%linkage%pin_mass(p)), [0.0_wp, 0.0_wp], 0.0_wp, &
        point_motion(pose, numbering, [1.0_wp, 0.0_wp], p), grillage)
    end do
    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        call add_lump(lump_t(mass=this%mass, inertia=this%inertia), this%arm, 0.0_wp, &
          point_motion(pose, numbering, pose%direction(:, elastic%ways(this%way)%first_part), &
          this%point), grillage)
      end associate
    end do
  end subroutine add_point_masses

  !> Adds a mass at the end of an arm, and its moments of inertia.
  pure subroutine add_lump(lump, arm, polar, motion, grillage)
    type(lump_t), intent(in) :: lump
    real(wp), intent(in) :: arm(2)         !! along the axis of the motion, and to its left [m]
    real(wp), intent(in) :: polar          !! moment of inertia about that axis [kg m²]
    type(motion_t), intent(in) :: motion
    type(grillage_t), intent(inout) :: grillage

    real(wp) :: row(of_node), mass(of_node, of_node)

    row = [arm(2), 1.0_wp, arm(1)]
    mass = lump%mass*spread(row, 1, of_node)*spread(row, 2, of_node)
    mass(1, 1) = mass(1, 1) + polar
    mass(3, 3) = mass(3, 3) + lump%inertia
    if (any(abs(mass) > 0.0_wp)) call add_forms(0.0_wp*mass, mass, motion%rows, motion%unknown, &
      grillage)
  end subroutine add_lump

  !> Adds an element, `rowsᵀ · form · rows` for both matrices.
  pure subroutine add_forms(stiffness, mass, rows, unknown, grillage)
    real(wp), intent(in) :: stiffness(:, :), mass(:, :) !! the forms
    real(wp), intent(in) :: rows(:, :)
    integer, intent(in) :: unknown(:) !! numbers of the columns of the rows, none twice; 0: held
    type(grillage_t), intent(inout) :: grillage

    integer, allocatable :: own(:)
    integer :: i, n

    own = pack([(i, i=1, size(unknown))], unknown > 0)
    n = size(own)
    grillage%sizes = [grillage%sizes, n]
    grillage%unknown = [grillage%unknown, unknown(own)]
    call append(stiffness, grillage%stiffness)
    call append(mass, grillage%mass)
    grillage%values = grillage%values + n**2

  contains

    !> Appends the values of a matrix to those of all elements. Room doubles.
    pure subroutine append(form, value)
      real(wp), intent(in) :: form(:, :)
      real(wp), allocatable, intent(inout) :: value(:)

      real(wp) :: element(n, n)

      element = matmul(transpose(rows(:, own)), matmul(form, rows(:, own)))
      if (grillage%values + n**2 > size(value)) value = [value, value, element]
      value(grillage%values + 1:grillage%values + n**2) = reshape(element, [n**2])
    end subroutine append

  end subroutine add_forms

end module out_of_plane
