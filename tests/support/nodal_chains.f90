!> The chains of `chain_decks` in nodal displacements: an own discretisation, with nothing of the
!! program but sparse matrices and their eigenvalues.
!!
!! Every link is cut into cubic Hermite beam elements with consistent mass. Nodes have u, v and θ;
!! pins share u and v. The crank is clamped to the ground. No loads. Units: mm, tonne, s, N, MPa.
module nodal_chains
  use bordered_eigensolver, only: bordered_modes_t, start_t
  use chain_decks, only: coupler_length, crank_length, density, drive_length, follower_length, &
    ground_step, modulus, thickness, width
  use constants, only: degree, two_pi
  use element_eigensolver, only: element_pencil_t, find_element_modes
  use element_matrices, only: elements_t, new_elements
  use elimination_plan, only: elimination_plan_t, new_elimination_plan
  use errors, only: error_t
  use kinds, only: wp
  use start_extrapolation, only: extrapolated_start, remember, track_t
  implicit none (type, external)
  private

  public :: nodal_chain_t, new_nodal_chain, find_nodal_frequencies

  !> Numbers of a chain, made once, and its matrices at the position that came last. A stretch is
  !! what lies between two pins of a link; of a chain of n stages there are 3n.
  type :: nodal_chain_t
    integer :: stages = 0                 !! n
    integer, allocatable :: pin(:, :)     !! (2, stretches) where each begins and ends
    integer :: cuts = 0                   !! elements of each
    integer, allocatable :: unknown(:, :) !! (6, elements) u, v, θ at both ends; 0: held
    type(elements_t) :: elements
    type(elimination_plan_t) :: plan
    type(element_pencil_t) :: pencil
    type(track_t) :: track                !! the last positions, from which the next one starts
    type(bordered_modes_t) :: found
  end type nodal_chain_t

  !> Steps up to this serve as starts [deg].
  real(wp), parameter :: longest_step = 10.0_wp

contains

  !> A chain whose stretches are cut into elements.
  function new_nodal_chain(stages, cuts) result(chain)
    integer, intent(in) :: stages
    integer, intent(in) :: cuts !! elements of a stretch
    type(nodal_chain_t) :: chain

    integer :: e, values

    chain%stages = stages
    chain%pin = stretches_of(stages)
    chain%cuts = cuts
    call number_unknowns(chain)
    associate (list => chain%unknown)
      chain%elements = new_elements(maxval(list), [(count(list(:, e) > 0), e=1, size(list, 2))], &
        pack(list, list > 0))
    end associate
    chain%plan = new_elimination_plan(chain%elements, spread(.false., 1, chain%elements%unknowns))
    values = chain%elements%value_first(size(chain%elements%value_first)) - 1
    allocate (chain%pencil%stiffness(values), chain%pencil%mass(values))
  end function new_nodal_chain

  !> Pins at both ends of the crank, then of the coupler and of the one or two stretches of the
  !! follower of every stage. Pins: grounds G, then A, the first of couplers, then B, their second.
  pure function stretches_of(stages) result(pin)
    integer, intent(in) :: stages
    integer, allocatable :: pin(:, :)

    integer :: i, n

    allocate (pin(2, 3*stages))
    n = stages + 1
    pin(:, 1) = [1, n + 1]
    do i = 1, stages
      pin(:, 3*i - 1) = [n + i, n + stages + i]
      if (i < stages) then
        pin(:, 3*i) = [i + 1, n + i + 1]
        pin(:, 3*i + 1) = [n + i + 1, n + stages + i]
      else
        pin(:, 3*i) = [i + 1, n + stages + i]
      end if
    end do
  end function stretches_of

  !> Numbers of unknowns: displacements of pins, then the rest, link by link.
  pure subroutine number_unknowns(chain)
    type(nodal_chain_t), intent(inout) :: chain

    integer :: node(3), i, s, e, n

    n = 4*chain%stages
    e = 0
    node = 0
    allocate (chain%unknown(6, chain%cuts*size(chain%pin, 2)))
    do s = 1, size(chain%pin, 2)
      ! The upper stretch of a follower goes on with the rotation at the end of the lower one.
      if (s > 1 .and. modulo(s, 3) /= 1) then
        n = n + 1
        node = [of_pin(chain%pin(1, s)), n]
      end if
      do i = 1, chain%cuts
        e = e + 1
        chain%unknown(:3, e) = node
        if (i < chain%cuts) then
          node(:2) = [n + 1, n + 2]
          n = n + 2
        else
          node(:2) = of_pin(chain%pin(2, s))
        end if
        n = n + 1
        node(3) = n
        chain%unknown(4:, e) = node
      end do
    end do

  contains

    !> Displacements of a pin.
    pure function of_pin(pin) result(unknown)
      integer, intent(in) :: pin
      integer :: unknown(2)

      unknown = 0
      if (pin > chain%stages + 1) unknown = 2*(pin - chain%stages - 1) - [1, 0]
    end function of_pin

  end subroutine number_unknowns

  !> Places of all pins [mm]: grounds on a line, then A and B of every stage in closed form.
  pure function places_of(stages, crank) result(place)
    integer, intent(in) :: stages
    real(wp), intent(in) :: crank !! angle [deg]
    real(wp) :: place(2, 3*stages + 1)

    real(wp) :: along(2), distance, foot, height
    integer :: i, n

    n = stages + 1
    do i = 0, stages
      place(:, i + 1) = [i*ground_step, 0.0_wp]
    end do
    place(:, n + 1) = crank_length*[cos(crank*degree), sin(crank*degree)]
    do i = 1, stages
      associate (a => place(:, n + i), ground => place(:, i + 1), b => place(:, n + stages + i))
        ! B is left of the line from A to the ground.
        distance = norm2(ground - a)
        along = (ground - a)/distance
        foot = 0.5_wp*(distance + (coupler_length**2 - follower_length**2)/distance)
        height = sqrt(coupler_length**2 - foot**2)
        b = a + foot*along + height*[-along(2), along(1)]
        if (i < stages) place(:, n + i + 1) = ground + drive_length/follower_length*(b - ground)
      end associate
    end do
  end function places_of

  !> Fills K and M at a position.
  subroutine place_chain(chain, crank)
    type(nodal_chain_t), intent(inout) :: chain
    real(wp), intent(in) :: crank !! angle [deg]

    real(wp) :: place(2, 3*chain%stages + 1), stiffness(6, 6), mass(6, 6)
    logical :: free(6), both(6, 6)
    integer :: e, i, s, first, last

    place = places_of(chain%stages, crank)
    e = 0
    do s = 1, size(chain%pin, 2)
      ! All elements of a stretch are alike, but for what is held.
      call find_beam(place(:, chain%pin(2, s)) - place(:, chain%pin(1, s)), chain%cuts, &
        stiffness, mass)
      do i = 1, chain%cuts
        e = e + 1
        free = chain%unknown(:, e) > 0
        first = chain%elements%value_first(e)
        last = chain%elements%value_first(e + 1) - 1
        if (all(free)) then
          chain%pencil%stiffness(first:last) = reshape(stiffness, [36])
          chain%pencil%mass(first:last) = reshape(mass, [36])
        else
          both = spread(free, 1, 6) .and. spread(free, 2, 6)
          chain%pencil%stiffness(first:last) = pack(stiffness, both)
          chain%pencil%mass(first:last) = pack(mass, both)
        end if
      end do
    end do
  end subroutine place_chain

  !> K [N/mm, N, N·mm] and M [t, t·mm, t·mm²] of an element, in global directions.
  pure subroutine find_beam(span, cuts, stiffness, mass)
    real(wp), intent(in) :: span(2) !! of the stretch [mm]
    integer, intent(in) :: cuts     !! equal elements of it
    real(wp), intent(out) :: stiffness(6, 6), mass(6, 6)

    real(wp), parameter :: area = thickness*width, inertia = width*thickness**3/12.0_wp
    integer, parameter :: u(2) = [1, 4], w(4) = [2, 3, 5, 6]
    real(wp) :: turn(6, 6), l
    integer :: i

    l = norm2(span)/cuts
    stiffness = 0.0_wp
    mass = 0.0_wp
    stiffness(u, u) = modulus*area/l*reshape([1, -1, -1, 1], [2, 2])
    mass(u, u) = density*area*l/6.0_wp*reshape([2, 1, 1, 2], [2, 2])
    stiffness(w, w) = modulus*inertia/l**3*reshape([12.0_wp, 6.0_wp*l, -12.0_wp, 6.0_wp*l, &
      6.0_wp*l, 4.0_wp*l**2, -6.0_wp*l, 2.0_wp*l**2, -12.0_wp, -6.0_wp*l, 12.0_wp, -6.0_wp*l, &
      6.0_wp*l, 2.0_wp*l**2, -6.0_wp*l, 4.0_wp*l**2], [4, 4])
    mass(w, w) = density*area*l/420.0_wp*reshape([156.0_wp, 22.0_wp*l, 54.0_wp, -13.0_wp*l, &
      22.0_wp*l, 4.0_wp*l**2, 13.0_wp*l, -3.0_wp*l**2, 54.0_wp, 13.0_wp*l, 156.0_wp, -22.0_wp*l, &
      -13.0_wp*l, -3.0_wp*l**2, -22.0_wp*l, 4.0_wp*l**2], [4, 4])
    turn = 0.0_wp
    do i = 0, 3, 3
      turn(i + 1, i + 1:i + 2) = span/norm2(span)
      turn(i + 2, i + 1:i + 2) = [-span(2), span(1)]/norm2(span)
      turn(i + 3, i + 3) = 1.0_wp
    end do
    stiffness = matmul(transpose(turn), matmul(stiffness, turn))
    mass = matmul(transpose(turn), matmul(mass, turn))
  end subroutine find_beam

  !> The lowest frequencies at a position. Errors: those of the eigenvalue solver.
  subroutine find_nodal_frequencies(chain, crank, frequency, error)
    type(nodal_chain_t), intent(inout) :: chain      !! remembers positions
    real(wp), intent(in) :: crank                    !! angle [deg]
    real(wp), intent(out) :: frequency(:)            !! as many as wanted [Hz]
    type(error_t), allocatable, intent(out) :: error !! allocated on failure

    type(start_t) :: start

    call place_chain(chain, crank)
    start = extrapolated_start(chain%track, crank, longest_step)
    associate (found => chain%found)
      call find_element_modes(chain%elements, chain%plan, chain%pencil, size(frequency), .false., start, &
        found, error, 0.0_wp)
      if (allocated(error)) return
      call remember(chain%track, crank, found, start%modes > 0 .and. found%full_solutions == 0)
      frequency = sqrt(found%lambda(:size(frequency)))/two_pi
    end associate
  end subroutine find_nodal_frequencies

end module nodal_chains
