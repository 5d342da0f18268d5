!> Vibrations of a linkage out of its plane of motion: an estimate of the lowest frequency, for the
!! frequencies and the response in the plane are computed as if there were none.
!!
!! The linkage is a grillage at rest. Its links bend out of the plane as slender beams and twist
!! (St. Venant); axial forces, shear and the rotary inertia of bending are left out. A revolute
!! joint whose axis is normal to the plane transmits the displacement w and both tilts; the rotation
!! about the pin is one in the plane. Pins on the ground are held by their bearings, the crank by
!! its shaft. Rigid links move as rigid bodies. Masses beside the axis of a link turn with it; a
!! moment of inertia is taken as that of a body that extends along the link.
module out_of_plane
  use band_matrix, only: full_band
  use beam_element, only: element_stiffness, new_reference_element, reference_element_t, &
    with_lengths
  use body_lumps, only: pieces_of
  use constants, only: two_pi
  use dense_eigensolver, only: solve_dense
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: normal_to
  use poses, only: find_pose, pose_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_out_of_plane_frequency, grillage_frequency

  !> Crank angles of a turn that are looked at, and how near to the lowest frequency among them
  !! minima are that are followed between them.
  integer, parameter :: positions = 48
  real(wp), parameter :: may_be_lowest = 1.05_wp

  !> Rounds of parabolas through points that move closer, and how.
  integer, parameter :: rounds = 8
  real(wp), parameter :: narrowing = 0.3_wp

  !> Polynomial degree of the deflection of a link, or of each piece between masses along it, and of
  !! the second solution, which shows what the first lacks.
  integer, parameter :: order = 9, order_above = 12

  !> No error is stated smaller: rounding of stiffnesses beside the lowest eigenvalue.
  real(wp), parameter :: least_error = 1.0e-10_wp

  !> Unknowns of a pin or of a place on a link: w and two tilts.
  integer, parameter :: of_node = 3

  !> Numbers of the unknowns.
  type :: numbering_t
    integer :: unknowns = 0
    integer, allocatable :: anchor(:) !! (pins) pin whose unknowns move it: another one if both
                                      !! are on a rigid link
    integer, allocatable :: pin(:)    !! (pins) number before its w and its tilts about the global
                                      !! axes; negative: held
    integer, allocatable :: inner(:)  !! (bodies) number before those of its inner nodes, then those
                                      !! of its elements
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

    real(wp) :: at_position(0:positions + 1), crank, last_gain, lowest, finer
    integer :: k

    relative_error = 0.0_wp
    if (size(structure%beams) == 0) return
    if (any(structure%linkage%bodies%bends .and. (structure%beams%out_of_plane_stiffness <= 0.0_wp &
      .or. structure%beams%torsional_stiffness <= 0.0_wp))) return
    do k = 1, positions
      call frequency_at((360.0_wp*(k - 1))/positions, order, at_position(k))
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
    call frequency_at(crank, order_above, finer)
    if (allocated(error)) return
    relative_error = least_error + (2.0_wp*abs(lowest - finer) + last_gain)/lowest
    frequency = lowest

  contains

    !> The lowest frequency at a crank angle [deg].
    subroutine frequency_at(angle, degree, found)
      real(wp), intent(in) :: angle
      integer, intent(in) :: degree
      real(wp), intent(out) :: found

      type(pose_t) :: pose

      found = huge(found)
      call find_pose(structure%linkage, angle, pose, error)
      if (allocated(error)) return
      call grillage_frequency(structure, pose, found, error, degree)
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
        call frequency_at(at - step, order, f(-1))
        if (.not. allocated(error)) call frequency_at(at + step, order, f(1))
        if (allocated(error)) return
        bend = f(-1) + f(1) - 2.0_wp*f(0)
        next = at
        if (f(-1) < f(0)) next = at - step
        if (f(1) < min(f(-1), f(0))) next = at + step
        if (f(0) <= min(f(-1), f(1)) .and. bend > 0.0_wp) next = at + 0.5_wp*step*(f(-1) - &
          f(1))/bend
        call frequency_at(next, order, f(0))
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
  subroutine grillage_frequency(structure, pose, frequency, error, degree)
    class(structure_t), intent(in) :: structure      !! bending links with known stiffnesses
    type(pose_t), intent(in) :: pose
    real(wp), intent(out) :: frequency               !! [Hz]
    type(error_t), allocatable, intent(out) :: error !! why there is none
    integer, intent(in), optional :: degree          !! of the polynomials; absent: `order`

    type(numbering_t) :: numbering
    type(reference_element_t) :: reference
    real(wp), allocatable :: stiffness(:, :), mass(:, :), vectors(:, :)
    real(wp) :: inverse(1)
    integer :: b, highest

    highest = order
    if (present(degree)) highest = degree
    reference = new_reference_element(highest)
    numbering = numbers_of(structure, reference)
    allocate (stiffness(numbering%unknowns, numbering%unknowns))
    allocate (mass, mold=stiffness)
    stiffness = 0.0_wp
    mass = 0.0_wp
    frequency = huge(frequency)
    do b = 1, size(structure%linkage%bodies)
      if (structure%linkage%bodies(b)%bends) then
        call add_beam(structure, pose, numbering, reference, highest, b, stiffness, mass)
      else
        call add_rigid_link(structure, pose, numbering, b, mass)
      end if
    end do
    call add_pin_masses(structure, pose, numbering, mass)
    if (numbering%unknowns == 0) return
    call solve_dense(full_band(stiffness), full_band(mass), 1, .false., inverse, vectors, error)
    if (allocated(error)) return
    if (inverse(1) > 0.0_wp) frequency = 1.0_wp/(two_pi*sqrt(inverse(1)))
  end subroutine grillage_frequency

  !> Numbers the unknowns: pins that are free to move, then what is on the links.
  pure function numbers_of(structure, reference) result(numbering)
    class(structure_t), intent(in) :: structure
    type(reference_element_t), intent(in) :: reference
    type(numbering_t) :: numbering

    integer :: b, p, pieces

    associate (linkage => structure%linkage)
      numbering%anchor = [(p, p=1, size(linkage%is_ground))]
      do b = 1, size(linkage%bodies)
        if (linkage%bodies(b)%bends) cycle
        associate (anchor => numbering%anchor)
          where (anchor == anchor(linkage%bodies(b)%last_pin)) &
            anchor = anchor(linkage%bodies(b)%first_pin)
        end associate
      end do
      allocate (numbering%pin(size(linkage%is_ground)))
      numbering%pin = -1
      do p = 1, size(linkage%is_ground)
        if (any(linkage%is_ground .and. numbering%anchor == numbering%anchor(p))) cycle
        associate (first => numbering%pin(numbering%anchor(p)))
          if (first < 0) then
            first = numbering%unknowns
            numbering%unknowns = numbering%unknowns + of_node
          end if
          numbering%pin(p) = first
        end associate
      end do
      allocate (numbering%inner(size(linkage%bodies)))
      do b = 1, size(linkage%bodies)
        numbering%inner(b) = numbering%unknowns
        if (.not. linkage%bodies(b)%bends) cycle
        pieces = size(pieces_of(linkage%bodies(b))) - 1
        numbering%unknowns = numbering%unknowns + of_node*(pieces - 1) + &
          pieces*(size(reference%mass, 1) - 2*of_node)
      end do
    end associate
  end function numbers_of

  !> Twist, displacement and slope of a link at one of its pins, per unit of every unknown.
  pure function pin_rows(pose, numbering, body, pin) result(rows)
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: body, pin
    real(wp) :: rows(of_node, numbering%unknowns)

    real(wp) :: arm(2)

    rows = 0.0_wp
    associate (first => numbering%pin(pin), axis => pose%direction(:, body))
      if (first < 0) return
      ! A tilt (φx, φy) moves the place (x, y) by φx y − φy x; the slope along an axis is minus the
      ! tilt about its normal.
      arm = pose%pin(:, pin) - pose%pin(:, numbering%anchor(pin))
      rows(1, first + 2:first + 3) = axis
      rows(2, first + 1:first + 3) = [1.0_wp, arm(2), -arm(1)]
      rows(3, first + 2:first + 3) = -normal_to(axis)
    end associate
  end function pin_rows

  !> Twist, displacement and slope of a link that bends at one of the ends of its pieces.
  pure function node_rows(structure, pose, numbering, body, node, pieces) result(rows)
    class(structure_t), intent(in) :: structure
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: body, node, pieces !! node from 0 to `pieces`
    real(wp) :: rows(of_node, numbering%unknowns)

    integer :: i

    if (node == 0) then
      rows = pin_rows(pose, numbering, body, structure%linkage%bodies(body)%first_pin)
    else if (node == pieces) then
      rows = pin_rows(pose, numbering, body, structure%linkage%bodies(body)%last_pin)
    else
      rows = 0.0_wp
      do i = 1, of_node
        rows(i, numbering%inner(body) + of_node*(node - 1) + i) = 1.0_wp
      end do
    end if
  end function node_rows

  !> Adds a link that bends, with the masses along it. The axial unknowns of the element are twists
  !! here.
  pure subroutine add_beam(structure, pose, numbering, reference, degree, b, stiffness, mass)
    class(structure_t), intent(in) :: structure
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    type(reference_element_t), intent(in) :: reference
    integer, intent(in) :: degree, b
    real(wp), intent(inout) :: stiffness(:, :), mass(:, :)

    real(wp), allocatable :: ends(:), rows(:, :), part(:, :), density(:)
    real(wp) :: here(of_node, numbering%unknowns), h
    integer :: e, i, n, bubbles, first, pieces

    n = size(reference%mass, 1)
    bubbles = n - 2*of_node
    allocate (rows(n, numbering%unknowns), density(n))
    associate (body => structure%linkage%bodies(b), beam => structure%beams(b))
      ends = pieces_of(body)
      pieces = size(ends) - 1
      first = numbering%inner(b) + of_node*(pieces - 1)
      density = body%line_density
      density([1, (i, i=degree + 1, n - 2)]) = beam%polar_inertia
      do e = 1, pieces
        h = body%length*(ends(e + 1) - ends(e))
        rows = 0.0_wp
        rows(:of_node, :) = node_rows(structure, pose, numbering, b, e - 1, pieces)
        do i = 1, bubbles
          rows(of_node + i, first + bubbles*(e - 1) + i) = 1.0_wp
        end do
        rows(n - 2:, :) = node_rows(structure, pose, numbering, b, e, pieces)
        part = element_stiffness(reference, beam%torsional_stiffness, &
          beam%out_of_plane_stiffness, h)
        stiffness = stiffness + matmul(transpose(rows), matmul(part, rows))
        ! Twists and displacements are not coupled.
        part = h*with_lengths(reference%mass, h)*spread(density, 2, n)
        mass = mass + matmul(transpose(rows), matmul(part, rows))
      end do
      do i = 1, size(body%lumps)
        associate (lump => body%lumps(i))
          e = minloc(abs(ends*body%length - lump%place(1)), dim=1) - 1
          here = node_rows(structure, pose, numbering, b, e, pieces)
          call add_square(lump%mass, here(2, :) + lump%place(2)*here(1, :), mass)
          call add_square(lump%inertia, here(3, :), mass)
        end associate
      end do
    end associate
  end subroutine add_beam

  !> Adds the mass of a rigid link.
  pure subroutine add_rigid_link(structure, pose, numbering, b, mass)
    class(structure_t), intent(in) :: structure
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    integer, intent(in) :: b
    real(wp), intent(inout) :: mass(:, :)

    real(wp) :: rows(of_node, numbering%unknowns)
    integer :: i

    associate (body => structure%linkage%bodies(b))
      rows = pin_rows(pose, numbering, b, body%first_pin)
      associate (m => body%line_density*body%length)
        call add_square(m, rows(2, :) + 0.5_wp*body%length*rows(3, :), mass)
        call add_square(m*body%length**2/12.0_wp, rows(3, :), mass)
      end associate
      call add_square(structure%beams(b)%polar_inertia*body%length, rows(1, :), mass)
      do i = 1, size(body%lumps)
        associate (lump => body%lumps(i))
          call add_square(lump%mass, rows(2, :) + lump%place(1)*rows(3, :) + &
            lump%place(2)*rows(1, :), mass)
          call add_square(lump%inertia, rows(3, :), mass)
        end associate
      end do
    end associate
  end subroutine add_rigid_link

  pure subroutine add_pin_masses(structure, pose, numbering, mass)
    class(structure_t), intent(in) :: structure
    type(pose_t), intent(in) :: pose
    type(numbering_t), intent(in) :: numbering
    real(wp), intent(inout) :: mass(:, :)

    real(wp) :: rows(of_node, numbering%unknowns)
    integer :: p

    do p = 1, size(numbering%pin)
      rows = pin_rows(pose, numbering, 1, p)
      call add_square(structure%linkage%pin_mass(p), rows(2, :), mass)
    end do
  end subroutine add_pin_masses

  !> Adds `factor · row rowᵀ`.
  pure subroutine add_square(factor, row, matrix)
    real(wp), intent(in) :: factor, row(:)
    real(wp), intent(inout) :: matrix(:, :)

    integer :: j

    do j = 1, size(row)
      matrix(:, j) = matrix(:, j) + factor*row(j)*row
    end do
  end subroutine add_square

end module out_of_plane
