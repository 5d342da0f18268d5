!> Where a linkage rests whose drive does not act: the zeros of its generalised force.
module equilibrium_study
  use applied_load_types, only: applies_between
  use applied_loads, only: spring_scale
  use constants, only: degree, pi
  use crank_limits, only: crank_range_t, find_ranges
  use kinds, only: wp
  use lagrange, only: find_lagrange, lagrange_t
  use limits_study, only: everywhere
  use linkage_paths, only: period_of
  use linkages, only: drive_of_angle, linkage_t
  use load_tables, only: load_period
  use positions, only: find_state, state_t
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: equilibrium_t, equilibria_t, potential_t, find_equilibria, is_stable, is_unstable, &
    is_indifferent

  !> What a rest is: small displacements stay small; grow; it rests beside it, too.
  integer, parameter :: is_stable = 1, is_unstable = 2, is_indifferent = 3

  !> A position of rest.
  type :: equilibrium_t
    real(wp) :: crank = 0.0_wp         !! coordinate of the first drive [deg] or [m]
    integer :: kind = is_stable        !! one of the is_… constants
    real(wp) :: potential = 0.0_wp     !! of weights, constant forces and springs [N m]
    real(wp) :: stiffness = 0.0_wp     !! derivative of what a drive would have to give
                                       !! [N m/rad] or [N/m]
    real(wp) :: inertia = 0.0_wp       !! M at the first drive [kg m²] or [kg]
    real(wp) :: frequency = 0.0_wp     !! of small oscillations [Hz]; 0 where there are none
    real(wp) :: error = 0.0_wp         !! estimated, of the frequency, relative [-]
  end type equilibrium_t

  !> Potential and what a drive would have to give, at a position at rest.
  type :: potential_t
    real(wp) :: crank = 0.0_wp     !! coordinate of the first drive [deg] or [m]
    real(wp) :: potential = 0.0_wp !! of weights, constant forces and springs [N m]
    real(wp) :: force = 0.0_wp     !! of the drive [N m] or [N]
    logical :: is_known = .false.  !! false at dead points, and beyond what loads allow
  end type potential_t

  type :: equilibria_t
    type(equilibrium_t), allocatable :: at(:) !! ascending
    type(potential_t), allocatable :: curve(:) !! evenly over all ranges, one after the other
    integer, allocatable :: first(:)          !! (ranges) where each begins there
    integer :: gaps = 0                       !! samples at which loads or links have no value
    real(wp) :: sampled(2) = 0.0_wp           !! from, to of all samples [deg] or [m]
    logical :: is_cut = .false.               !! springs that count turns would need more of them
  end type equilibria_t

  !> What the drive would have to give, and its derivative, at a sample.
  type :: sample_t
    real(wp) :: crank = 0.0_wp
    real(wp) :: force = 0.0_wp  !! dU/dq and the like [N m] or [N]
    real(wp) :: slope = 0.0_wp  !! per coordinate in its own unit; of its sign only use is made
    real(wp) :: scale = 0.0_wp  !! of which `force` is a difference
    logical :: is_known = .false.
  end type sample_t

  integer, parameter :: samples_per_range = 1440, most_turns = 64, most_halvings = 100

  !> Below this share of what it is a difference of, a force is rounding.
  real(wp), parameter :: rounding = 1.0e-12_wp

  !> Step of the sign of a derivative, as a share of the distance of samples.
  real(wp), parameter :: small_step = 1.0e-3_wp

contains

  !> Finds all rests in all ranges of the first drive.
  !!
  !! In each range the force is sampled with its slope. Where it changes its sign, halving leads to
  !! the zero; where it has the same sign at two neighbours and its magnitude falls from both
  !! towards the other, halving of the slope's sign leads to the extremum between them, and from
  !! there to the two zeros, if there are any. Pairs are missed only if the force has several
  !! extrema between two samples.
  subroutine find_equilibria(linkage, elements, positions, found)
    type(linkage_t), intent(in) :: linkage     !! with masses and loads, one free drive
    integer, intent(in) :: elements(:)         !! (bodies) on whose nodes masses are lumped; 0:
                                               !! distributed
    real(wp), intent(in) :: positions(:)       !! of the deck: of a driven length ranges are looked
                                               !! for from there, without any everywhere
    type(equilibria_t), intent(out) :: found   !! of all ranges

    type(crank_range_t), allocatable :: ranges(:)
    type(rigid_body_t) :: rigid(size(linkage%bodies))
    real(wp), allocatable :: inside(:)
    integer, allocatable :: order(:)
    real(wp) :: ends(2)
    integer :: r

    rigid = rigid_bodies_of(linkage, elements)
    inside = positions
    if (size(inside) == 0) inside = everywhere(linkage)
    call find_ranges(linkage, inside, ranges)
    allocate (found%at(0), found%curve(0), found%first(size(ranges)))
    do r = 1, size(ranges)
      ends = [ranges(r)%from, ranges(r)%to]
      if (ranges(r)%turns) call extend_turns(linkage, rigid, ends, found%is_cut)
      found%is_cut = found%is_cut .or. any(ranges(r)%is_open)
      if (r == 1) found%sampled = ends
      found%sampled = [min(found%sampled(1), ends(1)), max(found%sampled(2), ends(2))]
      call search_range(linkage, rigid, ends, ranges(r)%turns, found)
      found%first(r) = size(found%curve) + 1
      call draw_curve(linkage, rigid, ends, found%curve)
    end do
    order = ascending_order(found%at%crank)
    found%at = found%at(order)
  end subroutine find_equilibria

  !> Appends the potential over a range: 361 positions, or 90 a turn of many turns.
  subroutine draw_curve(linkage, rigid, ends, curve)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)
    real(wp), intent(in) :: ends(2) !! [deg] or [m]
    type(potential_t), allocatable, intent(inout) :: curve(:)

    integer, parameter :: fewest = 360, each_turn = 90
    type(potential_t), allocatable :: longer(:)
    type(state_t) :: state
    type(lagrange_t) :: terms
    integer :: i, n, before

    n = fewest
    if (linkage%drives(1)%kind == drive_of_angle) n = max(n, ceiling((ends(2) - &
      ends(1))/360.0_wp)*each_turn)
    before = size(curve)
    allocate (longer(before + n + 1))
    longer(:before) = curve
    do i = 0, n
      associate (point => longer(before + 1 + i))
        point%crank = (ends(1)*(n - i) + ends(2)*i)/n
        state = state_t(crank=point%crank)
        call find_state(linkage, state)
        if (allocated(state%error)) cycle
        terms = find_lagrange(linkage, rigid, state%pose, state%coefficients)
        point%potential = terms%potential
        point%force = terms%gravity + terms%load
        point%is_known = .true.
      end associate
    end do
    call move_alloc(longer, curve)
  end subroutine draw_curve

  !> Springs from the ground to the crank count its turns: rests are where their torque is no more
  !! than all other loads can give.
  pure subroutine extend_turns(linkage, rigid, ends, is_cut)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)
    real(wp), intent(inout) :: ends(2) !! of a whole period [deg]
    logical, intent(inout) :: is_cut

    integer, parameter :: steps = 360
    type(sample_t) :: sample
    real(wp) :: stiffness, moment, most
    integer :: i

    if (load_period(linkage, period_of(linkage)) > 0.0_wp) return
    stiffness = 0.0_wp
    moment = 0.0_wp
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%kind /= applies_between .or. load%body(1) /= 0 .or. load%body(2) /= 1) cycle
        stiffness = stiffness + load%stiffness
        moment = moment + load%stiffness*load%rest
      end associate
    end do
    if (.not. stiffness > 0.0_wp) return
    most = 0.0_wp
    do i = 0, steps - 1
      call take_sample(linkage, rigid, ends(1) + (ends(2) - ends(1))*i/steps, sample)
      if (sample%is_known) most = max(most, abs(sample%force - (stiffness*sample%crank*degree - &
        moment)))
    end do
    ends = moment/stiffness + [-1.0_wp, 1.0_wp]*(1.1_wp*most/stiffness + 10.0_wp*degree)
    ends = ends/degree
    is_cut = is_cut .or. ends(2) - ends(1) > most_turns*360.0_wp
    if (ends(2) - ends(1) > most_turns*360.0_wp) ends = 0.5_wp*sum(ends) + &
      [-180.0_wp, 180.0_wp]*most_turns
  end subroutine extend_turns

  !> The rests of a range.
  subroutine search_range(linkage, rigid, ends, turns, found)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)
    real(wp), intent(in) :: ends(2)
    logical, intent(in) :: turns !! the linkage can go on beyond the ends
    type(equilibria_t), intent(inout) :: found

    type(sample_t), allocatable :: samples(:)
    type(sample_t) :: middle
    real(wp) :: scale
    logical :: repeats
    integer :: i, n, first, before

    ! A little off round numbers, at which symmetric linkages rest.
    real(wp), parameter :: off = 0.236_wp

    n = samples_per_range
    if (linkage%drives(1)%kind == drive_of_angle) n = max(n, ceiling((ends(2) - &
      ends(1))/360.0_wp)*samples_per_range)
    repeats = turns
    if (turns) repeats = load_period(linkage, period_of(linkage)) > 0.0_wp
    allocate (samples(0:n))
    do i = 0, n
      if (repeats) then
        samples(i)%crank = ends(1) + (ends(2) - ends(1))*(i + off)/n
      else
        ! Ends of ranges are dead points as a rule, near which forces change fast.
        samples(i)%crank = 0.5_wp*sum(ends) - 0.5_wp*(ends(2) - ends(1))*cos(pi*(i + off)/(n + 1))
      end if
      call take_sample(linkage, rigid, (samples(i)%crank), samples(i), (ends(2) - ends(1))/n)
    end do
    found%gaps = found%gaps + count(.not. samples%is_known)
    before = size(found%at)
    if (.not. any(samples%is_known)) return
    scale = maxval(samples%scale, mask=samples%is_known)
    i = 0
    do while (i < n)
      if (.not. (samples(i)%is_known .and. samples(i + 1)%is_known)) then
        i = i + 1
        cycle
      end if
      if (is_zero(samples(i)) .and. is_zero(samples(i + 1))) then
        first = i
        do while (i < n)
          if (.not. (samples(i + 1)%is_known .and. is_zero(samples(i + 1)))) exit
          i = i + 1
        end do
        if (first == 0 .and. i == n) then
          call add(ends(1), is_indifferent)
          call add(ends(2), is_indifferent)
        else
          call add(samples(first)%crank, is_indifferent)
          call add(samples(i)%crank, is_indifferent)
        end if
        i = i + 1
        cycle
      end if
      if (samples(i)%force*samples(i + 1)%force <= 0.0_wp) then
        if (abs(samples(i + 1)%force) > 0.0_wp) call add_zero(samples(i), samples(i + 1))
      else if (samples(i)%force*samples(i)%slope < 0.0_wp .and. &
        samples(i + 1)%force*samples(i + 1)%slope > 0.0_wp) then
        call find_extremum(linkage, rigid, samples(i), samples(i + 1), middle)
        if (middle%is_known .and. abs(middle%force) <= rounding*scale) then
          call add(middle%crank, is_unstable)
        else if (middle%is_known .and. middle%force*samples(i)%force < 0.0_wp) then
          call add_zero(samples(i), middle)
          call add_zero(middle, samples(i + 1))
        end if
      end if
      i = i + 1
    end do

  contains

    pure function is_zero(sample)
      type(sample_t), intent(in) :: sample
      logical :: is_zero

      is_zero = abs(sample%force) <= rounding*scale
    end function is_zero

    !> Halves between two samples of different signs. A jump is no zero.
    subroutine add_zero(one, other)
      type(sample_t), intent(in) :: one, other

      type(sample_t) :: low, high, half
      integer :: k

      low = one
      high = other
      do k = 1, most_halvings
        half%crank = 0.5_wp*(low%crank + high%crank)
        if (half%crank <= low%crank .or. half%crank >= high%crank) exit
        call take_sample(linkage, rigid, (half%crank), half)
        if (.not. half%is_known) return
        if (half%force*low%force > 0.0_wp) then
          low = half
        else
          high = half
        end if
      end do
      if (abs(high%force) < abs(low%force)) low = high
      if (abs(low%force) > 1.0e-6_wp*scale) return
      call add(low%crank, merge(is_stable, is_unstable, other%force > one%force))
    end subroutine add_zero

    subroutine add(crank, kind)
      real(wp), intent(in) :: crank
      integer, intent(in) :: kind

      type(equilibrium_t) :: rest
      real(wp) :: step

      rest%crank = crank
      rest%kind = kind
      step = 0.4_wp
      if (linkage%drives(1)%kind /= drive_of_angle) step = 1.0e-3_wp*(ends(2) - ends(1))
      if (.not. turns) step = min(step, 0.25_wp*max(min(crank - ends(1), ends(2) - crank), 0.0_wp))
      call describe(linkage, rigid, step, rest)
      if (repeats .and. kind /= is_indifferent) rest%crank = ends(1) + modulo(rest%crank - &
        ends(1), ends(2) - ends(1))
      found%at = [found%at, rest]
    end subroutine add

  end subroutine search_range

  !> Where the slope changes its sign between two samples of one sign, or the first place found
  !! where the force has the other sign.
  pure subroutine find_extremum(linkage, rigid, one, other, middle)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)
    type(sample_t), intent(in) :: one, other
    type(sample_t), intent(out) :: middle

    real(wp) :: low, high
    integer :: k

    low = one%crank
    high = other%crank
    do k = 1, most_halvings
      middle%crank = 0.5_wp*(low + high)
      if (middle%crank <= low .or. middle%crank >= high) exit
      call take_sample(linkage, rigid, (middle%crank), middle, high - low)
      if (.not. middle%is_known .or. middle%force*one%force < 0.0_wp) return
      if (middle%slope*one%slope > 0.0_wp) then
        low = middle%crank
      else
        high = middle%crank
      end if
      ! Then the slope is rounding.
      if (high - low < 1.0e-9_wp*(other%crank - one%crank)) exit
    end do
  end subroutine find_extremum

  !> Potential, stiffness and frequency of a rest. The stiffness is a derivative by central
  !! differences of three steps, extrapolated; its error is the last change and the rounding.
  pure subroutine describe(linkage, rigid, step, rest)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)
    real(wp), intent(in) :: step               !! the largest one [deg] or [m]
    type(equilibrium_t), intent(inout) :: rest !! its place and kind are given

    type(sample_t) :: before, after
    type(lagrange_t) :: terms
    type(state_t) :: state
    real(wp) :: slope(3), better(2), h, error, per_unit, whole
    integer :: i

    state%crank = rest%crank
    call find_state(linkage, state)
    if (.not. allocated(state%error)) then
      terms = find_lagrange(linkage, rigid, state%pose, state%coefficients)
      rest%potential = terms%potential
      rest%inertia = terms%inertia
    end if
    per_unit = merge(degree, 1.0_wp, linkage%drives(1)%kind == drive_of_angle)
    if (.not. step > 0.0_wp) return
    do i = 1, 3
      h = step/2.0_wp**(i - 1)
      call take_sample(linkage, rigid, rest%crank - h, before)
      call take_sample(linkage, rigid, rest%crank + h, after)
      if (.not. (before%is_known .and. after%is_known)) return
      slope(i) = (after%force - before%force)/(2.0_wp*h*per_unit)
    end do
    better = (4.0_wp*slope(2:) - slope(:2))/3.0_wp
    rest%stiffness = (16.0_wp*better(2) - better(1))/15.0_wp
    ! Places are rounded as well as forces.
    whole = 360.0_wp
    if (linkage%drives(1)%kind /= drive_of_angle) whole = abs(rest%crank) + &
      maxval(linkage%bodies%length)
    error = abs(rest%stiffness - better(2)) + epsilon(1.0_wp)*(4.0_wp*max(before%scale, &
      after%scale)/per_unit + 2.0_wp*abs(rest%stiffness)*whole)/h
    if (rest%kind /= is_stable .or. .not. rest%inertia > 0.0_wp) return
    if (rest%stiffness <= error) return
    rest%frequency = sqrt(rest%stiffness/rest%inertia)/(2.0_wp*pi)
    rest%error = 0.5_wp*error/rest%stiffness
  end subroutine describe

  !> Force and scale at a coordinate, and with a distance of samples the sign of the slope.
  pure subroutine take_sample(linkage, rigid, crank, sample, distance)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)
    real(wp), intent(in) :: crank
    type(sample_t), intent(out) :: sample
    real(wp), intent(in), optional :: distance

    type(state_t) :: state
    type(lagrange_t) :: terms
    type(sample_t) :: before, after
    real(wp) :: here

    here = crank
    sample%crank = here
    state%crank = here
    call find_state(linkage, state)
    sample%is_known = .not. allocated(state%error)
    if (.not. sample%is_known) return
    terms = find_lagrange(linkage, rigid, state%pose, state%coefficients)
    sample%force = terms%gravity + terms%load
    sample%scale = abs(terms%gravity) + abs(terms%load) + spring_scale(linkage, state%pose, &
      state%coefficients)
    if (.not. present(distance)) return
    call take_sample_at(here - small_step*distance, before)
    call take_sample_at(here + small_step*distance, after)
    if (before%is_known .and. after%is_known) sample%slope = after%force - before%force

  contains

    pure subroutine take_sample_at(place, near)
      real(wp), intent(in) :: place
      type(sample_t), intent(out) :: near

      type(state_t) :: beside
      type(lagrange_t) :: there

      beside%crank = place
      call find_state(linkage, beside)
      near%is_known = .not. allocated(beside%error)
      if (.not. near%is_known) return
      there = find_lagrange(linkage, rigid, beside%pose, beside%coefficients)
      near%force = there%gravity + there%load
    end subroutine take_sample_at

  end subroutine take_sample

end module equilibrium_study
