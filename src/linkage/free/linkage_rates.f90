!> Equations of motion of any linkage that moves by itself, in the coordinates of its free drives.
!!
!! The first drive is free, and so are those that the deck calls free; the others are held, or
!! geared to the first. With the velocities `h_k` of pins and bodies per rate of coordinate k,
!! `Σ_l M_kl c̈_l = Q_k − Σ m h_k·b`, where M_kl is `Σ m h_k·h_l` over all masses, Q_k the loads
!! along h_k, and b the accelerations with the present rates and no c̈.
module linkage_rates
  use adaptive_integration, only: rate_system_t
  use block_ends, only: refuse_leaving_block
  use body_points, only: find_point_coefficients, point_coefficients_t
  use constants, only: degree
  use dense_factor, only: dense_factor_t, factorize, solve
  use drives, only: drive_t
  use errors, only: error_t
  use group_equations, only: drive_rate
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, find_velocities, &
    kinematic_coefficients_t
  use linkages, only: drives_angle, linkage_t, reference_point
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_groups, place_links
  use rigid_bodies, only: central_inertia, mass_centre, rigid_body_t
  implicit none (type, external)
  private

  public :: moving_linkage_t, free_drives, pose_at, energies_at
  public :: no_stop, stop_dead_point, stop_no_inertia, stop_too_fast, stop_steps, &
    stop_many_steps, stop_at_end

  !> Why a motion stops; at last because a block leaves its link. For reasons 1 to 3 and 6 there
  !! are no rates.
  integer, parameter :: no_stop = 0, stop_dead_point = 1, stop_no_inertia = 2, stop_too_fast = 3, &
    stop_steps = 4, stop_many_steps = 5, stop_at_end = 6

  !> Steps begin with an angle of the first drive from −π to π: a trial step beyond `most_angle` is
  !! too long, whatever its estimated error [rad]. `most_rate` is beyond any mechanics, but short of
  !! overflow.
  real(wp), parameter :: most_angle = 9.0_wp, most_rate = 1.0e100_wp

  !> There are no rates where the scaled determinant of M is below this.
  real(wp), parameter :: least_inertia = 1.0e-13_wp

  !> A linkage in motion. Its state: coordinates of the free drives [rad] or [m], their rates, the
  !! work done so far by drive and resistances [J].
  type, extends(rate_system_t) :: moving_linkage_t
    type(linkage_t) :: linkage
    type(rigid_body_t), allocatable :: rigid(:) !! (bodies)
    integer, allocatable :: free(:)             !! numbers of the free drives; the first is 1
    class(drive_t), allocatable :: drive        !! torque or force on the first drive
    real(wp), allocatable :: taken(:)           !! (bodies) resisting torques [N m]
    real(wp), allocatable :: damping(:)         !! (bodies) of their turning [N m s]
    real(wp) :: turned = 0.0_wp                 !! whole turns of the first drive that its
                                                !! coordinate does not contain [deg]
    real(wp) :: period = 0.0_wp                 !! of the positions [deg]; 0: none
    type(pose_t) :: pose                        !! the last one, from `reference_point`: a start for
                                                !! iterations
    integer :: stop = no_stop                   !! why rates were last not found
    type(error_t), allocatable :: left          !! block that then left its link
  contains
    procedure :: find_rates => rates_of_motion
  end type moving_linkage_t

contains

  !> Numbers of the drives that are free: the first, and those that are marked.
  pure function free_drives(is_free) result(free)
    logical, intent(in) :: is_free(:)  !! (drives) marked in the deck
    integer, allocatable :: free(:)

    integer :: i

    free = pack([(i, i=1, size(is_free))], [.true., is_free(2:)])
  end function free_drives

  !> The pose at coordinates of the free drives, relative to `reference_point`.
  !!
  !! Errors: out of reach; near a dead point; iterations that do not converge; a block that leaves
  !! its link.
  subroutine pose_at(self, coordinates, pose, error)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: coordinates(:)   !! (free drives) [rad] or [m]
    type(pose_t), intent(out) :: pose
    type(error_t), allocatable, intent(out) :: error

    type(linkage_t) :: linkage
    real(wp) :: crank, correction, origin(2)
    integer :: i

    crank = coordinates(1)
    if (self%linkage%drives(1)%kind == drives_angle) then
      crank = crank/degree
      if (self%period > 0.0_wp) then
        crank = crank + modulo(self%turned, self%period)
      else
        crank = crank + self%turned
      end if
    end if
    if (size(self%free) == 1) then
      call place_links(self%linkage, crank, pose, error)
      if (allocated(error)) return
      origin = reference_point(self%linkage)
      pose%pin = pose%pin - spread(origin, 2, size(pose%pin, 2))
      return
    end if
    linkage = self%linkage
    do i = 2, size(self%free)
      associate (drive => linkage%drives(self%free(i)))
        drive%ratio = 0.0_wp
        drive%phase = coordinates(i)
        if (drive%kind == drives_angle) drive%phase = coordinates(i)/degree
      end associate
    end do
    pose = self%pose
    call place_groups(linkage, crank, pose, correction, error)
    if (.not. allocated(error)) call refuse_leaving_block(linkage, pose, error)
  end subroutine pose_at

  !> Rates of all drives from those of the free ones: the others are held or geared to the first.
  pure function rates_of_drives(self, rates) result(all_rates)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: rates(:) !! (free drives)
    real(wp) :: all_rates(size(self%linkage%drives))

    integer :: i

    all_rates = [(drive_rate(self%linkage, i)*rates(1), i=1, size(all_rates))]
    all_rates(self%free) = rates
  end function rates_of_drives

  !> Rates of the state. Not found near dead points, out of reach, and where nothing with a mass
  !! moves; `stop` gives the reason.
  subroutine rates_of_motion(self, time, state, rates, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: time      !! [s]
    real(wp), intent(in) :: state(:)  !! coordinates, rates, work
    real(wp), intent(out) :: rates(:) !! of the state; defined only if found
    logical, intent(out) :: found     !! false: `stop` is set

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: now
    type(kinematic_coefficients_t), allocatable :: per(:)
    type(dense_factor_t) :: factor
    real(wp) :: inertia(size(self%free), size(self%free)), right(size(self%free)), &
      driving(size(self%free)), direction(size(self%free)), torque
    integer :: f, k

    f = size(self%free)
    rates = 0.0_wp
    found = maxval(abs(state)) < most_rate
    if (self%linkage%drives(1)%kind == drives_angle) found = found .and. abs(state(1)) < most_angle
    if (.not. found) then
      self%stop = stop_too_fast
      return
    end if
    call pose_at(self, state(:f), pose, error)
    found = .not. allocated(error)
    if (allocated(error)) then
      if (error%place%pin > 0) then
        self%stop = stop_at_end
        self%left = error
        return
      end if
    end if
    if (found) found = all(abs(pose%sine) > dead_point_sine)
    if (.not. found) then
      self%stop = stop_dead_point
      return
    end if
    ! Accelerations while the rates of the drives do not change.
    now = find_kinematic_coefficients(self%linkage, pose, rates_of_drives(self, state(f + 1:2*f)))
    allocate (per(f))
    do k = 1, f
      direction = 0.0_wp
      direction(k) = 1.0_wp
      call find_velocities(self%linkage, pose, rates_of_drives(self, direction), per(k))
    end do
    call sum_up(self, pose, now, per, inertia, right)
    driving = 0.0_wp
    torque = self%drive%torque(time, state(1), state(f + 1))
    driving(1) = torque
    do k = 1, f
      driving(k) = driving(k) - dot_product(self%taken + self%damping*now%turn, per(k)%turn) + &
        dot_product(self%linkage%couple, per(k)%turn)
    end do
    call factorize(inertia, factor)
    found = abs(factor%determinant) > least_inertia
    if (.not. found) then
      self%stop = stop_no_inertia
      return
    end if
    rates(:f) = state(f + 1:2*f)
    rates(f + 1:2*f) = solve(factor, right + driving)
    rates(2*f + 1) = dot_product(driving, state(f + 1:2*f))
  end subroutine rates_of_motion

  !> M, and the generalised forces of gravity, constant forces and inertia without c̈.
  pure subroutine sum_up(self, pose, now, per, inertia, right)
    class(moving_linkage_t), intent(in) :: self
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: now
    type(kinematic_coefficients_t), intent(in) :: per(:)
    real(wp), intent(out) :: inertia(:, :)
    real(wp), intent(out) :: right(:)

    type(point_coefficients_t) :: point, along(size(per))
    real(wp) :: force(2), turning
    integer :: b, k, l, p

    inertia = 0.0_wp
    right = 0.0_wp
    associate (linkage => self%linkage, rigid => self%rigid)
      do b = 1, size(rigid)
        point = find_point_coefficients(linkage, pose, now, b, mass_centre(rigid(b)))
        turning = central_inertia(rigid(b))
        force = rigid(b)%mass*(linkage%gravity - point%slope)
        do k = 1, size(per)
          along(k) = find_point_coefficients(linkage, pose, per(k), b, mass_centre(rigid(b)))
          right(k) = right(k) + dot_product(force, along(k)%rate) - turning*now%turn_slope(b)* &
            per(k)%turn(b)
          do l = 1, k
            inertia(k, l) = inertia(k, l) + rigid(b)%mass*dot_product(along(k)%rate, &
              along(l)%rate) + turning*per(k)%turn(b)*per(l)%turn(b)
          end do
        end do
      end do
      do p = 1, size(linkage%is_ground)
        force = linkage%pin_mass(p)*(linkage%gravity - now%pin_slope(:, p)) + &
          linkage%pin_force(:, p)
        do k = 1, size(per)
          right(k) = right(k) + dot_product(force, per(k)%pin(:, p))
          do l = 1, k
            inertia(k, l) = inertia(k, l) + linkage%pin_mass(p)*dot_product(per(k)%pin(:, p), &
              per(l)%pin(:, p))
          end do
        end do
      end do
    end associate
    do k = 1, size(per)
      inertia(:k - 1, k) = inertia(k, :k - 1)
    end do
  end subroutine sum_up

  !> Kinetic energy, and potential energy of gravity and constant forces, 0 at the global origin
  !! [J].
  subroutine energies_at(self, coordinates, rates, kinetic, potential, error)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: coordinates(:)   !! (free drives) [rad] or [m]
    real(wp), intent(in) :: rates(:)         !! (free drives) [rad/s] or [m/s]
    real(wp), intent(out) :: kinetic
    real(wp), intent(out) :: potential
    type(error_t), allocatable, intent(out) :: error !! those of `pose_at`

    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: now
    type(point_coefficients_t) :: point
    real(wp) :: origin(2)
    integer :: b, p

    kinetic = 0.0_wp
    potential = 0.0_wp
    call pose_at(self, coordinates, pose, error)
    if (allocated(error)) return
    call find_velocities(self%linkage, pose, rates_of_drives(self, rates), now)
    origin = reference_point(self%linkage)
    associate (linkage => self%linkage, rigid => self%rigid)
      do b = 1, size(rigid)
        point = find_point_coefficients(linkage, pose, now, b, mass_centre(rigid(b)))
        kinetic = kinetic + 0.5_wp*(rigid(b)%mass*sum(point%rate**2) + &
          central_inertia(rigid(b))*now%turn(b)**2)
        potential = potential - rigid(b)%mass*dot_product(linkage%gravity, point%place + origin)
      end do
      do p = 1, size(linkage%is_ground)
        kinetic = kinetic + 0.5_wp*linkage%pin_mass(p)*sum(now%pin(:, p)**2)
        potential = potential - dot_product(linkage%pin_mass(p)*linkage%gravity + &
          linkage%pin_force(:, p), pose%pin(:, p) + origin)
      end do
    end associate
  end subroutine energies_at

end module linkage_rates
