!> The rests of a range of the first drive: zeros of the holding force.
module equilibrium_search
  use constants, only: degree, pi
  use holding_forces, only: holding_force_t, holding_sample_t
  use kinds, only: wp
  use lagrange, only: lagrange_t
  use linkage_paths, only: period_of
  use linkages, only: gives_angle
  use load_tables, only: load_period
  implicit none (type, external)
  private

  public :: equilibrium_t, search_range

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

  !> A range that is searched, and what is found there.
  type :: range_search_t
    type(holding_force_t) :: holding
    real(wp) :: ends(2)               !! of the range [deg] or [m]
    logical :: turns                  !! the linkage can go on beyond the ends
    logical :: repeats                !! and has the same forces there
    type(holding_sample_t), allocatable :: samples(:) !! (0:) ascending
    real(wp) :: scale = 0.0_wp        !! the greatest of all samples [N m] or [N]
    type(equilibrium_t), allocatable :: rests(:)
  contains
    procedure :: take_samples
    procedure :: find_rests
    procedure :: is_flat
    procedure :: add_flat
    procedure :: search_between
    procedure :: add_zero
    procedure :: add_rest
  end type range_search_t

  integer, parameter :: samples_per_range = 1440

  !> Below this share of what it is a difference of, a force is rounding.
  real(wp), parameter :: rounding = 1.0e-12_wp

contains

  !> The rests of a range.
  !!
  !! The force is sampled with its slope. Where it changes its sign, halving leads to the zero;
  !! where it has the same sign at two neighbours and its magnitude falls from both towards the
  !! other, halving of the slope's sign leads to the extremum between them, and from there to the
  !! two zeros, if there are any. Pairs are missed only if the force has several extrema between
  !! two samples.
  pure subroutine search_range(holding, ends, turns, rests, gaps)
    type(holding_force_t), intent(in) :: holding
    real(wp), intent(in) :: ends(2) !! of the range [deg] or [m]
    logical, intent(in) :: turns    !! the linkage can go on beyond the ends
    type(equilibrium_t), allocatable, intent(out) :: rests(:)
    integer, intent(out) :: gaps    !! samples at which nothing is known

    type(range_search_t) :: search

    search%holding = holding
    search%ends = ends
    search%turns = turns
    search%repeats = turns
    if (turns) search%repeats = load_period(holding%linkage, period_of(holding%linkage)) > 0.0_wp
    allocate (search%rests(0))
    call search%take_samples()
    gaps = count(.not. search%samples%is_known)
    if (any(search%samples%is_known)) then
      search%scale = maxval(search%samples%scale, mask=search%samples%is_known)
      call search%find_rests()
    end if
    call move_alloc(search%rests, rests)
  end subroutine search_range

  !> Samples over the whole range: evenly where forces repeat, else closer together at its ends.
  pure subroutine take_samples(self)
    class(range_search_t), intent(inout) :: self

    ! A little off round numbers, at which symmetric linkages rest.
    real(wp), parameter :: off = 0.236_wp
    real(wp) :: crank
    integer :: i, n

    n = samples_per_range
    associate (ends => self%ends)
      if (gives_angle(self%holding%linkage%drives(1))) n = max(n, ceiling((ends(2) - &
        ends(1))/360.0_wp)*samples_per_range)
      allocate (self%samples(0:n))
      do i = 0, n
        if (self%repeats) then
          crank = ends(1) + (ends(2) - ends(1))*(i + off)/n
        else
          ! Ends of ranges are dead points as a rule, near which forces change fast.
          crank = 0.5_wp*sum(ends) - 0.5_wp*(ends(2) - ends(1))*cos(pi*(i + off)/(n + 1))
        end if
        self%samples(i) = self%holding%sample_with_slope(crank, (ends(2) - ends(1))/n)
      end do
    end associate
  end subroutine take_samples

  !> Goes from sample to sample: stretches without a force, and zeros between two samples.
  pure subroutine find_rests(self)
    class(range_search_t), intent(inout) :: self !! with its samples; gets rests

    integer :: i, last

    i = 0
    do while (i < ubound(self%samples, 1))
      if (self%is_flat(i) .and. self%is_flat(i + 1)) then
        call self%add_flat(i, last)
        i = last + 1
      else
        call self%search_between(i)
        i = i + 1
      end if
    end do
  end subroutine find_rests

  !> Whether there is no force at a sample.
  pure function is_flat(self, i) result(flat)
    class(range_search_t), intent(in) :: self
    integer, intent(in) :: i
    logical :: flat

    associate (sample => self%samples(i))
      flat = sample%is_known .and. abs(sample%force) <= rounding*self%scale
    end associate
  end function is_flat

  !> Adds the ends of a stretch without a force.
  pure subroutine add_flat(self, first, last)
    class(range_search_t), intent(inout) :: self
    integer, intent(in) :: first !! sample
    integer, intent(out) :: last !! the last sample of the stretch

    last = first
    do while (last < ubound(self%samples, 1))
      if (.not. self%is_flat(last + 1)) exit
      last = last + 1
    end do
    if (first == 0 .and. last == ubound(self%samples, 1)) then
      call self%add_rest(self%ends(1), is_indifferent)
      call self%add_rest(self%ends(2), is_indifferent)
    else
      call self%add_rest(self%samples(first)%crank, is_indifferent)
      call self%add_rest(self%samples(last)%crank, is_indifferent)
    end if
  end subroutine add_flat

  !> Adds what rests between a sample and the next one: none, one, or two beside an extremum.
  pure subroutine search_between(self, i)
    class(range_search_t), intent(inout) :: self
    integer, intent(in) :: i !! the first of the two samples

    type(holding_sample_t) :: one, other, middle

    one = self%samples(i)
    other = self%samples(i + 1)
    if (.not. (one%is_known .and. other%is_known)) return
    if (one%force*other%force <= 0.0_wp) then
      if (abs(other%force) > 0.0_wp) call self%add_zero(one, other)
      return
    end if
    if (.not. (one%force*one%slope < 0.0_wp .and. other%force*other%slope > 0.0_wp)) return
    middle = self%holding%find_extremum(one, other)
    if (.not. middle%is_known) return
    if (abs(middle%force) <= rounding*self%scale) then
      call self%add_rest(middle%crank, is_unstable)
    else if (middle%force*one%force < 0.0_wp) then
      call self%add_zero(one, middle)
      call self%add_zero(middle, other)
    end if
  end subroutine search_between

  !> Adds the rest between two samples of different signs, unless the force jumps there.
  pure subroutine add_zero(self, one, other)
    class(range_search_t), intent(inout) :: self
    type(holding_sample_t), intent(in) :: one, other !! ascending coordinates

    real(wp) :: crank
    logical :: found

    call self%holding%find_zero(one, other, self%scale, crank, found)
    if (found) call self%add_rest(crank, merge(is_stable, is_unstable, other%force > one%force))
  end subroutine add_zero

  !> Adds a rest with its stiffness and frequency.
  pure subroutine add_rest(self, crank, kind)
    class(range_search_t), intent(inout) :: self
    real(wp), intent(in) :: crank !! [deg] or [m]
    integer, intent(in) :: kind   !! one of the is_… constants

    type(equilibrium_t) :: rest
    real(wp) :: step

    rest%crank = crank
    rest%kind = kind
    associate (ends => self%ends)
      step = 0.4_wp
      if (.not. gives_angle(self%holding%linkage%drives(1))) step = 1.0e-3_wp*(ends(2) - &
        ends(1))
      if (.not. self%turns) step = min(step, 0.25_wp*max(min(crank - ends(1), ends(2) - crank), &
        0.0_wp))
      call describe_rest(self%holding, min(step, 0.5_wp*self%holding%smooth_distance(crank)), rest)
      if (self%repeats .and. kind /= is_indifferent) rest%crank = ends(1) + modulo(rest%crank - &
        ends(1), ends(2) - ends(1))
    end associate
    self%rests = [self%rests, rest]
  end subroutine add_rest

  !> Potential, stiffness and frequency of a rest. The stiffness is a derivative by central
  !! differences of three steps, extrapolated; its error is the last change and the rounding.
  pure subroutine describe_rest(holding, step, rest)
    type(holding_force_t), intent(in) :: holding
    real(wp), intent(in) :: step               !! the largest one [deg] or [m]
    type(equilibrium_t), intent(inout) :: rest !! its place and kind are given

    type(holding_sample_t) :: before, after
    type(lagrange_t) :: terms
    real(wp) :: slope(3), better(2), h, error, per_unit, whole
    logical :: is_angle, is_known
    integer :: i

    call holding%find_terms(rest%crank, terms, is_known)
    rest%potential = terms%potential
    rest%inertia = terms%inertia
    is_angle = gives_angle(holding%linkage%drives(1))
    per_unit = merge(degree, 1.0_wp, is_angle)
    if (.not. step > 0.0_wp) return
    do i = 1, 3
      h = step/2.0_wp**(i - 1)
      before = holding%sample(rest%crank - h)
      after = holding%sample(rest%crank + h)
      if (.not. (before%is_known .and. after%is_known)) return
      slope(i) = (after%force - before%force)/(2.0_wp*h*per_unit)
    end do
    better = (4.0_wp*slope(2:) - slope(:2))/3.0_wp
    rest%stiffness = (16.0_wp*better(2) - better(1))/15.0_wp
    ! Places are rounded as well as forces.
    whole = 360.0_wp
    if (.not. is_angle) whole = abs(rest%crank) + maxval(holding%linkage%bodies%length)
    error = abs(rest%stiffness - better(2)) + epsilon(1.0_wp)*(4.0_wp*max(before%scale, &
      after%scale)/per_unit + 2.0_wp*abs(rest%stiffness)*whole)/h
    if (rest%kind /= is_stable .or. .not. rest%inertia > 0.0_wp) return
    if (rest%stiffness <= error) return
    rest%frequency = sqrt(rest%stiffness/rest%inertia)/(2.0_wp*pi)
    rest%error = 0.5_wp*error/rest%stiffness
  end subroutine describe_rest

end module equilibrium_search
