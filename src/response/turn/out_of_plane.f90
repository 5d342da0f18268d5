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
  use band_matrix, only: full_band
  use beam_element, only: new_reference_element, reference_element_t
  use beam_mesh, only: beam_t
  use body_lumps, only: pieces_of
  use constants, only: two_pi
  use dense_eigensolver, only: solve_dense
  use elastic_linkages, only: elastic_linkage_t, new_elastic_linkage
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
    real(wp) :: at_position(0:positions + 1), crank, last_gain, lowest, finer, rounding
    integer :: k

    relative_error = 0.0_wp
    if (size(structure%beams) == 0) return
    if (any(structure%linkage%bodies%bends .and. (structure%beams%out_of_plane_stiffness <= 0.0_wp &
      .or. structure%beams%torsional_stiffness <= 0.0_wp))) return
    if (allocated(structure%elastic)) then
      elastic = structure%elastic
    else
      elastic = new_elastic_linkage(structure%linkage, structure%beams)
    end if
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
      call grillage_frequency(structure%beams, elastic, placed, element, found, error, rounding)
    end subroutine frequency_at

    !> From a minimum among the crank angles looked at to that between them.
    subroutine descend(start, there)
      real(wp), intent(in) :: start, there

      real(wp) :: at, best, f(-1:1), next, step, bend
      integer :: round

      if (there < lowest) crank = start
      lowest = min(lowest, there)
      at = start
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
  !! Errors: the eigenvalues cannot be found.
  subroutine grillage_frequency(beams, elastic, pose, element, frequency, error, rounding)
    type(beam_t), intent(in) :: beams(:)             !! (links) stiffnesses of those that bend
    type(elastic_linkage_t), intent(in) :: elastic   !! at the position
    type(pose_t), intent(in) :: pose                 !! of its points and parts
    type(grillage_element_t), intent(in) :: element
    real(wp), intent(out) :: frequency               !! [Hz]
    type(error_t), allocatable, intent(out) :: error !! why there is none
    real(wp), intent(out), optional :: rounding      !! relative: that of the diagonal of K

    type(numbering_t) :: numbering
    real(wp), allocatable :: stiffness(:, :), mass(:, :), vectors(:, :)
    real(wp) :: inverse(1)
    integer :: i, k

    numbering = numbers_of(elastic, element)
    allocate (stiffness(numbering%unknowns, numbering%unknowns))
    allocate (mass, mold=stiffness)
    stiffness = 0.0_wp
    mass = 0.0_wp
    frequency = huge(frequency)
    if (present(rounding)) rounding = 0.0_wp
    do k = 1, size(elastic%body)
      if (elastic%linkage%bodies(k)%bends) then
        call add_beam(elastic, pose, numbering, element, k, stiffness, mass)
      else
        call add_rigid_link(elastic, pose, numbering, k, beams(elastic%body(k))%polar_inertia, mass)
      end if
    end do
    call add_point_masses(elastic, pose, numbering, mass)
    if (numbering%unknowns == 0) return
    call solve_dense(full_band(stiffness), full_band(mass), 1, present(rounding), inverse, &
      vectors, error)
    if (allocated(error)) return
    if (inverse(1) > 0.0_wp) frequency = 1.0_wp/(two_pi*sqrt(inverse(1)))
    if (.not. present(rounding)) return
    ! Beside a short part the stiffness of its neighbours is small; vectors have xᵀKx = 1.
    do i = 1, numbering%unknowns
      rounding = rounding + epsilon(1.0_wp)*stiffness(i, i)*vectors(i, 1)**2
    end do
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

  !> Twist, displacement and slope along an axis at a point, per unit of every unknown.
  pure function point_rows(pose, numbering, axis, point) result(rows)
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    real(wp), intent(in) :: axis(2) !! unit vector
    integer, intent(in) :: point
    real(wp) :: rows(of_node, numbering%unknowns)

    real(wp) :: arm(2)

    rows = 0.0_wp
    associate (first => numbering%point(point))
      if (first < 0) return
      ! A tilt (φx, φy) moves the place (x, y) by φx y − φy x; the slope along an axis is minus the
      ! tilt about its normal.
      arm = pose%pin(:, point) - pose%pin(:, numbering%anchor(point))
      rows(1, first + 2:first + 3) = axis
      rows(2, first + 1:first + 3) = [1.0_wp, arm(2), -arm(1)]
      rows(3, first + 2:first + 3) = -normal_to(axis)
    end associate
  end function point_rows

  !> Twist, displacement and slope of a part that bends at one of the ends of its pieces.
  pure function node_rows(elastic, pose, numbering, part, node, pieces) result(rows)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: part, node, pieces !! node from 0 to `pieces`
    real(wp) :: rows(of_node, numbering%unknowns)

    integer :: i

    associate (body => elastic%linkage%bodies(part))
      if (node == 0) then
        rows = point_rows(pose, numbering, pose%direction(:, part), body%first_pin)
      else if (node == pieces) then
        rows = point_rows(pose, numbering, pose%direction(:, part), body%last_pin)
      else
        rows = 0.0_wp
        do i = 1, of_node
          rows(i, numbering%inner(part) + of_node*(node - 1) + i) = 1.0_wp
        end do
      end if
    end associate
  end function node_rows

  !> Adds a part that bends, with the masses along it. Twists and displacements are not coupled.
  pure subroutine add_beam(elastic, pose, numbering, element, part, stiffness, mass)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    type(grillage_element_t), intent(in) :: element
    integer, intent(in) :: part
    real(wp), intent(inout) :: stiffness(:, :), mass(:, :)

    real(wp), allocatable :: ends(:), across(:, :), about(:, :)
    real(wp), dimension(of_node, numbering%unknowns) :: first, last
    real(wp) :: h
    integer :: e, i, m, n, bubble, pieces

    m = size(element%bending, 1)
    n = size(element%torsion, 1)
    allocate (across(m, numbering%unknowns), about(n, numbering%unknowns))
    associate (body => elastic%linkage%bodies(part), beam => elastic%beams(part))
      ends = pieces_of(body)
      pieces = size(ends) - 1
      bubble = numbering%inner(part) + of_node*(pieces - 1)
      do e = 1, pieces
        h = body%length*(ends(e + 1) - ends(e))
        first = node_rows(elastic, pose, numbering, part, e - 1, pieces)
        last = node_rows(elastic, pose, numbering, part, e, pieces)
        across = 0.0_wp
        about = 0.0_wp
        across(1, :) = first(2, :)
        across(2, :) = h*first(3, :)
        across(m - 1, :) = last(2, :)
        across(m, :) = h*last(3, :)
        about(1, :) = first(1, :)
        about(n, :) = last(1, :)
        do i = 3, m - 2
          bubble = bubble + 1
          across(i, bubble) = 1.0_wp
        end do
        do i = 2, n - 1
          bubble = bubble + 1
          about(i, bubble) = 1.0_wp
        end do
        call add_form(beam%out_of_plane_stiffness/h**3*element%bending, across, stiffness)
        call add_form(beam%torsional_stiffness/h*element%torsion, about, stiffness)
        call add_form(body%line_density*h*element%deflection, across, mass)
        call add_form(beam%polar_inertia*h*element%twist, about, mass)
      end do
      do i = 1, size(body%lumps)
        e = minloc(abs(ends*body%length - body%lumps(i)%place(1)), dim=1) - 1
        call add_lump(body%lumps(i), [0.0_wp, body%lumps(i)%place(2)], node_rows(elastic, pose, &
          numbering, part, e, pieces), mass)
      end do
    end associate
  end subroutine add_beam

  !> Adds the mass of a rigid link, uniform or a lump for each of its segments, and what is fixed to
  !! it.
  pure subroutine add_rigid_link(elastic, pose, numbering, part, polar_inertia, mass)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: part
    real(wp), intent(in) :: polar_inertia !! per length of its segments [kg m]
    real(wp), intent(inout) :: mass(:, :)

    type(lump_t) :: lump
    real(wp) :: from(2), way(2), axis(2)
    integer :: i

    associate (body => elastic%linkage%bodies(part))
      axis = body%card_axis
      if (body%own_lumps == 0) then
        lump%mass = body%line_density*body%length
        lump%place(1) = 0.5_wp*body%length
        lump%inertia = lump%mass*body%length**2/12.0_wp
        call add_on_link(lump, axis, polar_inertia*body%length, mass)
      end if
      ! Each segment begins where the one before it ends, and its mass centre is in its middle.
      from = body%origin
      do i = 1, size(body%lumps)
        lump = body%lumps(i)
        if (i > body%own_lumps) then
          call add_on_link(lump, body%card_axis, 0.0_wp, mass)
          cycle
        end if
        way = 2.0_wp*(lump%place - from)
        from = from + way
        if (body%own_lumps > 1) axis = way/norm2(way)
        lump%inertia = lump%inertia - lump%rotary_inertia
        call add_on_link(lump, axis, polar_inertia*norm2(way), mass)
      end do
    end associate

  contains

    !> Adds what extends along an axis in those of the link.
    pure subroutine add_on_link(lump, axis, polar, mass)
      type(lump_t), intent(in) :: lump
      real(wp), intent(in) :: axis(2)
      real(wp), intent(in) :: polar        !! moment of inertia about it [kg m²]
      real(wp), intent(inout) :: mass(:, :)

      real(wp) :: rows(of_node, numbering%unknowns)

      rows = point_rows(pose, numbering, turned(axis, pose%direction(:, part)), &
        elastic%linkage%bodies(part)%first_pin)
      call add_lump(lump, turned_back(lump%place, axis), rows, mass)
      call add_square(polar, rows(1, :), mass)
    end subroutine add_on_link

  end subroutine add_rigid_link

  !> Adds the masses at pins, and what is fixed where parts meet.
  pure subroutine add_point_masses(elastic, pose, numbering, mass)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    real(wp), intent(inout) :: mass(:, :)

    real(wp) :: rows(of_node, numbering%unknowns)
    integer :: i, p

    do p = 1, size(numbering%point)
      rows = point_rows(pose, numbering, [1.0_wp, 0.0_wp], p)
      call add_square(elastic%linkage%pin_mass(p), rows(2, :), mass)
    end do
    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        call add_lump(lump_t(mass=this%mass, inertia=this%inertia), this%arm, point_rows(pose, &
          numbering, pose%direction(:, elastic%ways(this%way)%first_part), this%point), mass)
      end associate
    end do
  end subroutine add_point_masses

  !> Adds a mass at the end of an arm, and its moment of inertia.
  pure subroutine add_lump(lump, arm, rows, mass)
    type(lump_t), intent(in) :: lump
    real(wp), intent(in) :: arm(2)     !! along the axis of the rows, and to its left [m]
    real(wp), intent(in) :: rows(:, :) !! (twist, displacement and slope, unknowns)
    real(wp), intent(inout) :: mass(:, :)

    call add_square(lump%mass, rows(2, :) + arm(1)*rows(3, :) + arm(2)*rows(1, :), mass)
    call add_square(lump%inertia, rows(3, :), mass)
  end subroutine add_lump

  !> Adds `factor · row rowᵀ`.
  pure subroutine add_square(factor, row, matrix)
    real(wp), intent(in) :: factor, row(:)
    real(wp), intent(inout) :: matrix(:, :)

    call add_form(reshape([factor], [1, 1]), reshape(row, [1, size(row)]), matrix)
  end subroutine add_square

  !> Adds `rowsᵀ · form · rows`. Most columns of the rows are zero.
  pure subroutine add_form(form, rows, matrix)
    real(wp), intent(in) :: form(:, :), rows(:, :)
    real(wp), intent(inout) :: matrix(:, :)

    integer, allocatable :: columns(:)
    integer :: j

    columns = pack([(j, j=1, size(rows, 2))], any(abs(rows) > 0.0_wp, dim=1))
    matrix(columns, columns) = matrix(columns, columns) + matmul(transpose(rows(:, columns)), &
      matmul(form, rows(:, columns)))
  end subroutine add_form

end module out_of_plane
