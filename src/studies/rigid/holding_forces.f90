!> What the first drive would have to give to hold a linkage at rest.
module holding_forces
  use applied_load_types, only: deflection
  use applied_loads, only: evaluate_loads, spring_scale
  use constants, only: degree
  use coordinates, only: evaluated_rate, evaluated_t
  use kinds, only: wp
  use lagrange, only: find_lagrange, lagrange_t
  use linkages, only: gives_angle, linkage_t
  use positions, only: find_state, state_t
  use pull_laws, only: contact_depth
  use rigid_bodies, only: rigid_body_t
  implicit none (type, external)
  private

  public :: holding_force_t, holding_sample_t

  !> The force at a coordinate, and its derivative.
  type :: holding_sample_t
    real(wp) :: crank = 0.0_wp  !! coordinate of the first drive [deg] or [m]
    real(wp) :: force = 0.0_wp  !! dU/dq less the generalised force of other loads [N m] or [N]
    real(wp) :: slope = 0.0_wp  !! in some unit: only its sign is used
    real(wp) :: scale = 0.0_wp  !! magnitude of the terms whose sum is `force` [N m] or [N]
    logical :: is_known = .false. !! false at dead points, and beyond what loads allow
  end type holding_sample_t

  !> The force as a function of the coordinate.
  type :: holding_force_t
    type(linkage_t) :: linkage                  !! with masses and loads, one free drive
    type(rigid_body_t), allocatable :: rigid(:) !! (bodies)
  contains
    procedure :: find_terms
    procedure :: sample
    procedure :: sample_with_slope
    procedure :: find_zero
    procedure :: find_extremum
    procedure :: smooth_distance
  end type holding_force_t

  integer, parameter :: most_halvings = 100

  !> Step of the sign of a derivative, as a share of the distance of samples.
  real(wp), parameter :: small_step = 1.0e-3_wp

  !> At a zero the force is below this share of its greatest scale; at a jump it is not.
  real(wp), parameter :: jump = 1.0e-6_wp

contains

  !> Potential, inertia and forces at a coordinate.
  pure subroutine find_terms(self, crank, terms, is_known, scale)
    class(holding_force_t), intent(in) :: self
    real(wp), intent(in) :: crank             !! coordinate of the first drive [deg] or [m]
    type(lagrange_t), intent(out) :: terms    !! zero where nothing is known
    logical, intent(out) :: is_known          !! false at dead points, and beyond what loads allow
    real(wp), intent(out), optional :: scale  !! as in `holding_sample_t`

    type(state_t) :: state

    if (present(scale)) scale = 0.0_wp
    state%crank = crank
    call find_state(self%linkage, state)
    is_known = .not. allocated(state%error)
    if (.not. is_known) return
    terms = find_lagrange(self%linkage, self%rigid, state%pose, state%coefficients)
    if (present(scale)) scale = abs(terms%gravity) + abs(terms%load) + &
      spring_scale(self%linkage, state%pose, state%coefficients)
  end subroutine find_terms

  !> The force at a coordinate; its slope remains 0.
  pure function sample(self, crank) result(found)
    class(holding_force_t), intent(in) :: self
    real(wp), intent(in) :: crank !! coordinate of the first drive [deg] or [m]
    type(holding_sample_t) :: found

    type(lagrange_t) :: terms

    found%crank = crank
    call self%find_terms(crank, terms, found%is_known, found%scale)
    found%force = terms%gravity + terms%load
  end function sample

  !> The force and the sign of its slope at a coordinate.
  pure function sample_with_slope(self, crank, distance) result(found)
    class(holding_force_t), intent(in) :: self
    real(wp), intent(in) :: crank    !! coordinate of the first drive [deg] or [m]
    real(wp), intent(in) :: distance !! of samples: the step is a small share of it [deg] or [m]
    type(holding_sample_t) :: found

    type(lagrange_t) :: before, after
    logical :: is_known(2)

    found = self%sample(crank)
    if (.not. found%is_known) return
    call self%find_terms(crank - small_step*distance, before, is_known(1))
    call self%find_terms(crank + small_step*distance, after, is_known(2))
    if (all(is_known)) found%slope = after%gravity + after%load - (before%gravity + before%load)
  end function sample_with_slope

  !> How far the coordinate goes from a position until a contact of a stop, or of a spring of one
  !! side, begins, ends, or is wholly pressed, about: so far the force is smooth [deg] or [m].
  pure function smooth_distance(self, crank) result(distance)
    class(holding_force_t), intent(in) :: self
    real(wp), intent(in) :: crank !! coordinate of the first drive [deg] or [m]
    real(wp) :: distance          !! huge without contacts

    type(state_t) :: state
    type(evaluated_t), allocatable :: along(:)
    real(wp) :: depth(2)
    integer :: i

    distance = huge(distance)
    if (all(self%linkage%loads%law%side == 0)) return
    state%crank = crank
    call find_state(self%linkage, state)
    if (allocated(state%error)) return
    call evaluate_loads(self%linkage, state%pose, along)
    do i = 1, size(along)
      associate (load => self%linkage%loads(i))
        if (load%law%side == 0) cycle
        depth = contact_depth(load%law, deflection(load, along(i)%value), evaluated_rate( &
          self%linkage, state%pose, state%coefficients, load%along, along(i)))
        if (gives_angle(self%linkage%drives(1))) depth(2) = depth(2)*degree
        if (abs(depth(2)) > 0.0_wp) distance = min(distance, min(abs(depth(1)), abs(depth(1) - &
          load%law%contact))/abs(depth(2)))
      end associate
    end do
  end function smooth_distance

  !> Halves between two samples whose forces have different signs.
  pure subroutine find_zero(self, one, other, scale, crank, found)
    class(holding_force_t), intent(in) :: self
    type(holding_sample_t), intent(in) :: one, other !! ascending coordinates
    real(wp), intent(in) :: scale  !! the greatest of all samples [N m] or [N]
    real(wp), intent(out) :: crank !! the zero, if it is found [deg] or [m]
    logical, intent(out) :: found  !! false at a jump, and where a force between is not known

    type(holding_sample_t) :: low, high, middle
    integer :: k

    found = .false.
    low = one
    high = other
    do k = 1, most_halvings
      crank = 0.5_wp*(low%crank + high%crank)
      if (crank <= low%crank .or. crank >= high%crank) exit
      middle = self%sample(crank)
      if (.not. middle%is_known) return
      if (middle%force*low%force > 0.0_wp) then
        low = middle
      else
        high = middle
      end if
    end do
    if (abs(high%force) < abs(low%force)) low = high
    crank = low%crank
    found = abs(low%force) <= jump*scale
  end subroutine find_zero

  !> Where the slope changes its sign between two samples of one sign, or the first place found
  !! where the force has the other sign, or is not known.
  pure function find_extremum(self, one, other) result(middle)
    class(holding_force_t), intent(in) :: self
    type(holding_sample_t), intent(in) :: one, other !! ascending coordinates, with slopes
    type(holding_sample_t) :: middle

    ! Over a shorter share of the distance the slope is rounding.
    real(wp), parameter :: shortest = 1.0e-9_wp
    real(wp) :: low, high, crank
    integer :: k

    low = one%crank
    high = other%crank
    do k = 1, most_halvings
      crank = 0.5_wp*(low + high)
      if (crank <= low .or. crank >= high) exit
      middle = self%sample_with_slope(crank, high - low)
      if (.not. middle%is_known .or. middle%force*one%force < 0.0_wp) return
      if (middle%slope*one%slope > 0.0_wp) then
        low = crank
      else
        high = crank
      end if
      if (high - low < shortest*(other%crank - one%crank)) exit
    end do
  end function find_extremum

end module holding_forces
