!> Friction in pins and sliders: the forces in the joints that it depends on, and that it changes.
module joint_friction
  use actuated_forces, only: find_actuated_forces, statics_factors_t
  use applied_loads, only: add_effort, generalised_force
  use coordinate_types, only: coordinate_t, is_angle
  use coordinates, only: evaluate, evaluated_rate, evaluated_t, slider_coordinate
  use dense_factor, only: dense_factor_t, factorize, solve
  use ground_loads, only: effort_on_ground
  use inertia_loads, only: load_t
  use joint_forces, only: add_scaled, force_at_pin, joint_forces_t
  use joint_friction_types, only: joint_friction_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: friction_t, rubbing_t, has_friction, find_friction, find_rubbing, force_in_joint
  public :: friction_rates, coulomb_efforts, put_friction, find_normal_forces, finish_friction, &
    friction_on_ground
  public :: is_solved, is_locked

  !> Whether forces in the joints are found, or grow beyond all bounds as friction rises.
  integer, parameter :: is_solved = 0, is_locked = 1

  !> The coordinate along which a joint rubs: the angle of its body against what bears the pin, or
  !! the place of its block along the line.
  type :: rubbing_t
    type(coordinate_t) :: along
    type(evaluated_t) :: at !! a pose
  end type rubbing_t

  !> Friction in the joints, and the forces that balance it.
  type :: friction_t
    integer :: state = is_solved                !! is_solved or is_locked
    integer :: locked = 0                       !! number of the friction that grows most where they
                                                !! lock
    real(wp) :: share = 1.0_wp                  !! of all coefficients at which they lock [-]
    real(wp) :: contraction = 0.0_wp            !! bound of the iteration: below 1 it is proven that
                                                !! there is one solution [-]
    type(rubbing_t), allocatable :: rubbing(:)  !! (frictions)
    real(wp), allocatable :: normal(:)          !! (frictions) force in the joint, 0 or more [N]
    real(wp), allocatable :: effort(:)          !! (frictions) couple on the body, or force along
                                                !! the line on the pin [N m] or [N]
    real(wp), allocatable :: rate(:)            !! (frictions) relative [rad/s] or [m/s]
    real(wp), allocatable :: power(:)           !! (frictions) lost, 0 or more [W]
    type(load_t), allocatable :: body_load(:)   !! (bodies) about their first pins
    real(wp), allocatable :: pin_load(:, :)     !! (2, pins) [N]
    type(joint_forces_t) :: joints              !! that balance these loads
    real(wp) :: load = 0.0_wp                   !! minus their generalised force at the first drive
                                                !! [N m] or [N]
  end type friction_t

  !> Change of the forces at which the iteration has converged, of the largest one.
  real(wp), parameter :: accuracy = 1.0e-14_wp

  !> Most steps of an iteration, and of Newton's method at one share of the coefficients.
  integer, parameter :: most_iterations = 100, most_newton = 30

  !> Shares of the coefficients go up by steps between these.
  real(wp), parameter :: largest_step = 0.05_wp, smallest_step = 1.0e-9_wp

contains

  !> Whether joints of a linkage rub.
  pure function has_friction(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! its frictions
    logical :: has

    has = .false.
    if (allocated(linkage%frictions)) has = size(linkage%frictions) > 0
  end function has_friction

  !> Friction at a pose and speed, with all other loads balanced by given forces.
  !!
  !! Forces in the joints depend linearly on the friction in them: with the unknown magnitudes x of
  !! the forces in the joints that rub, `x_k = |F_k + Σ A_kj x_j|`, where F are the forces without
  !! Coulomb friction and A_kj the force in joint k per magnitude in joint j. If the matrix of
  !! |A_kj| has a spectral radius below one, proven by a weight w > 0 of `(1 − |A|) w = 1`,
  !! this map contracts in the norm of these weights by `max (|A| w)_k/w_k`: there is one solution
  !! and iterations find it (Banach). Else the solution is followed from that without Coulomb
  !! friction, all coefficients rising together, by Newton's method. Where its determinant reaches
  !! zero on the way forces grow beyond all bounds: the linkage locks itself.
  pure subroutine find_friction(linkage, pose, coefficients, speed, factor, without, &
    friction, of_units, factors)
    type(linkage_t), intent(in) :: linkage       !! its frictions
    type(pose_t), intent(in) :: pose             !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    real(wp), intent(in) :: speed                !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: factor(:)            !! (parts) by which each part is multiplied
    type(joint_forces_t), intent(in) :: without(:) !! (parts) of the forces in the joints without
                                                 !! friction
    type(friction_t), intent(out) :: friction
    type(joint_forces_t), intent(in), optional :: of_units(:) !! (frictions) forces in the joints
                                                 !! that balance an effort of one in each; absent:
                                                 !! statics tells them
    type(statics_factors_t), intent(in), optional :: factors !! of `factorize_statics` at this pose,
                                                 !! for statics

    type(load_t) :: body_load(size(linkage%bodies))
    real(wp) :: pin_load(2, size(linkage%is_ground))
    real(wp), dimension(size(linkage%frictions)) :: viscous, coulomb
    real(wp) :: base(2, size(linkage%frictions)), influence(2, size(linkage%frictions), &
      size(linkage%frictions))
    type(joint_forces_t) :: joints
    integer :: i, j, k

    associate (rubs => linkage%frictions)
      call find_rubbing(linkage, pose, friction%rubbing)
      friction%rate = speed*friction_rates(linkage, pose, friction%rubbing, coefficients)
      coulomb = coulomb_efforts(rubs, friction%rate)
      viscous = -rubs%viscous*friction%rate
      if (present(of_units)) then
        joints = sum_of(of_units, viscous)
      else
        call put_friction(linkage, pose, friction%rubbing, viscous, body_load, pin_load)
        joints = find_actuated_forces(linkage, pose, factors, body_load, pin_load)
      end if
      do k = 1, size(rubs)
        base(:, k) = force_in_joint(linkage, joints, rubs(k))
        do i = 1, size(without)
          base(:, k) = base(:, k) + factor(i)*force_in_joint(linkage, without(i), rubs(k))
        end do
      end do
      do j = 1, size(rubs)
        if (present(of_units)) then
          joints = sum_of(of_units, merge(coulomb, 0.0_wp, [(i == j, i=1, size(rubs))]))
        else
          call put_friction(linkage, pose, friction%rubbing, merge(coulomb, 0.0_wp, [(i == j, &
            i=1, size(rubs))]), body_load, pin_load)
          joints = find_actuated_forces(linkage, pose, factors, body_load, pin_load)
        end if
        do k = 1, size(rubs)
          influence(:, k, j) = force_in_joint(linkage, joints, rubs(k))
        end do
      end do
    end associate
    call find_normal_forces(base, influence, friction)
    call finish_friction(linkage, pose, viscous, coulomb, friction)
    if (present(of_units)) then
      friction%joints = sum_of(of_units, friction%effort)
    else
      friction%joints = find_actuated_forces(linkage, pose, factors, friction%body_load, &
        friction%pin_load)
    end if
    friction%load = -generalised_force(linkage, coefficients, friction%body_load, &
      friction%pin_load)
  end subroutine find_friction

  !> Forces in the joints of all efforts together.
  pure function sum_of(of_units, effort) result(joints)
    type(joint_forces_t), intent(in) :: of_units(:) !! (frictions) of efforts of one
    real(wp), intent(in) :: effort(:)               !! (frictions) [N m] or [N]
    type(joint_forces_t) :: joints

    integer :: k

    joints = of_units(1)
    call add_scaled(joints, -1.0_wp, of_units(1))
    do k = 1, size(effort)
      call add_scaled(joints, effort(k), of_units(k))
    end do
  end function sum_of

  !> The coordinates along which all joints rub, at a pose.
  pure subroutine find_rubbing(linkage, pose, rubbing)
    type(linkage_t), intent(in) :: linkage !! its frictions
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(rubbing_t), allocatable, intent(out) :: rubbing(:) !! (frictions)

    integer :: k

    allocate (rubbing(size(linkage%frictions)))
    do k = 1, size(rubbing)
      associate (rub => linkage%frictions(k), along => rubbing(k)%along)
        if (rub%slider > 0) then
          along = slider_coordinate(linkage, rub%slider)
        else
          along%kind = is_angle
          along%at%body = [rub%against, rub%body]
        end if
        call evaluate(linkage, pose, along, rubbing(k)%at)
      end associate
    end do
  end subroutine find_rubbing

  !> Rates of all joints that rub [rad/s] or [m/s].
  pure function friction_rates(linkage, pose, rubbing, motion) result(rates)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(rubbing_t), intent(in) :: rubbing(:) !! (frictions) of `find_rubbing` at this pose
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities, or coefficients: then per
                                           !! rate of the first drive
    real(wp) :: rates(size(rubbing))

    integer :: k

    do k = 1, size(rates)
      rates(k) = evaluated_rate(linkage, pose, motion, rubbing(k)%along, rubbing(k)%at)
    end do
  end function friction_rates

  !> Couples in pins and forces along lines of Coulomb friction with forces of 1 N in the joints.
  pure function coulomb_efforts(rubs, rates) result(efforts)
    type(joint_friction_t), intent(in) :: rubs(:) !! (frictions)
    real(wp), intent(in) :: rates(:)              !! (frictions) [rad/s] or [m/s]
    real(wp) :: efforts(size(rubs))               !! [m] or [-]

    efforts = -rubs%coefficient*tanh(rates/rubs%smooth)
    where (rubs%slider == 0) efforts = efforts*rubs%radius
  end function coulomb_efforts

  !> Efforts, power and loads of friction from the forces in the joints.
  pure subroutine finish_friction(linkage, pose, viscous, coulomb, friction)
    type(linkage_t), intent(in) :: linkage      !! its frictions
    type(pose_t), intent(in) :: pose            !! pins and directions
    real(wp), intent(in) :: viscous(:)          !! (frictions) efforts [N m] or [N]
    real(wp), intent(in) :: coulomb(:)          !! (frictions) of `coulomb_efforts`
    type(friction_t), intent(inout) :: friction !! with normal forces, rates and where it rubs;
                                                !! the rest is set

    friction%effort = viscous + coulomb*friction%normal
    friction%power = -friction%effort*friction%rate
    allocate (friction%body_load(size(linkage%bodies)), friction%pin_load(2, &
      size(linkage%is_ground)))
    call put_friction(linkage, pose, friction%rubbing, friction%effort, friction%body_load, &
      friction%pin_load)
  end subroutine finish_friction

  !> Force in a joint that rubs: on the body by the pin, or along the normal of a line, or at one
  !! end of a block that keeps a body from turning, N/2 ± M/length [N].
  pure function force_in_joint(linkage, joints, rub) result(force)
    type(linkage_t), intent(in) :: linkage      !! its bodies
    type(joint_forces_t), intent(in) :: joints  !! of this linkage
    type(joint_friction_t), intent(in) :: rub   !! one of its frictions
    real(wp) :: force(2)

    if (rub%slider > 0) then
      force = [joints%guide(rub%slider), 0.0_wp]
      if (rub%turn > 0) force(1) = 0.5_wp*force(1) + joints%couple(rub%turn)/rub%reach
    else
      force = force_at_pin(linkage, joints, rub%body, rub%pin)
    end if
  end function force_in_joint

  !> Puts couples of pins and forces of sliders on the linkage.
  pure subroutine put_friction(linkage, pose, rubbing, effort, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose          !! positions and directions
    type(rubbing_t), intent(in) :: rubbing(:) !! (frictions) of `find_rubbing` at this pose
    real(wp), intent(in) :: effort(:)         !! (frictions) on the body or the pin [N m] or [N]
    type(load_t), intent(out) :: body_load(:) !! (bodies)
    real(wp), intent(out) :: pin_load(:, :)   !! (2, pins)

    integer :: k

    pin_load = 0.0_wp
    do k = 1, size(effort)
      call add_effort(linkage, pose, rubbing(k)%along, rubbing(k)%at, effort(k), body_load, &
        pin_load)
    end do
  end subroutine put_friction

  !> What friction puts on the ground beside the forces in the joints: couples of pins on ground
  !! pivots, or on blocks that do not turn, and forces along fixed guides, or by a link on the block
  !! at a ground pivot.
  pure function friction_on_ground(linkage, pose, friction) result(load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose           !! positions and directions
    type(friction_t), intent(in) :: friction   !! at this pose
    real(wp) :: load(3)                        !! fx, fy [N], moment about `reference_point` [N m]

    integer :: k

    load = 0.0_wp
    do k = 1, size(friction%effort)
      associate (rubbing => friction%rubbing(k))
        load = load + effort_on_ground(linkage, pose, rubbing%along, rubbing%at, friction%effort(k))
      end associate
    end do
  end function friction_on_ground

  !> Solves `x_k = |F_k + Σ A_kj x_j|`.
  pure subroutine find_normal_forces(base, influence, friction)
    real(wp), intent(in) :: base(:, :)           !! (2, frictions) F [N]
    real(wp), intent(in) :: influence(:, :, :)   !! (2, frictions, frictions) A [-]
    type(friction_t), intent(inout) :: friction  !! its normal forces and state are set

    real(wp), dimension(size(base, 2)) :: weight, next
    real(wp) :: bound, change
    integer :: i

    friction%normal = norm2(base, dim=1)
    friction%state = is_solved
    call find_contraction(norm2(influence, dim=1), weight, bound)
    friction%contraction = bound
    if (bound < 1.0_wp) then
      do i = 1, most_iterations
        next = norm2(forces_of(base, influence, friction%normal), dim=1)
        change = maxval(abs(next - friction%normal)/weight)
        friction%normal = next
        ! What is left to the solution is at most bound/(1 − bound) of the last change.
        if (change*bound <= (1.0_wp - bound)*accuracy*maxval(next/weight)) return
      end do
    end if
    call follow_solution(base, influence, friction)
  end subroutine find_normal_forces

  !> Forces in the joints with given magnitudes.
  pure function forces_of(base, influence, normal) result(force)
    real(wp), intent(in) :: base(:, :), influence(:, :, :), normal(:)
    real(wp) :: force(size(base, 1), size(base, 2))

    integer :: j

    force = base
    do j = 1, size(normal)
      force = force + normal(j)*influence(:, :, j)
    end do
  end function forces_of

  !> Bound by which a map with Lipschitz constants `matrix` contracts, and weights of the norm:
  !! `(1 − matrix) w = 1` has a positive solution if and only if the spectral radius is below one.
  pure subroutine find_contraction(matrix, weight, bound)
    real(wp), intent(in) :: matrix(:, :)  !! (n, n) not negative
    real(wp), intent(out) :: weight(:)    !! (n) positive
    real(wp), intent(out) :: bound        !! huge: none is found

    type(dense_factor_t) :: factor
    real(wp) :: rest(size(matrix, 1), size(matrix, 1))
    integer :: i, n

    n = size(matrix, 1)
    bound = huge(1.0_wp)
    weight = 1.0_wp
    rest = -matrix
    do i = 1, n
      rest(i, i) = rest(i, i) + 1.0_wp
    end do
    call factorize(rest, factor)
    if (.not. abs(factor%determinant) > 0.0_wp) return
    weight = solve(factor, spread(1.0_wp, 1, n))
    if (all(weight >= 1.0_wp) .and. all(weight < huge(1.0_wp))) then
      bound = maxval(matmul(matrix, weight)/weight)
    else
      weight = 1.0_wp
    end if
  end subroutine find_contraction

  !> The solution of `x = |F + s A x|` from s = 0 to s = 1.
  pure subroutine follow_solution(base, influence, friction)
    real(wp), intent(in) :: base(:, :), influence(:, :, :)
    type(friction_t), intent(inout) :: friction

    real(wp), dimension(size(base, 2)) :: here, next
    real(wp) :: share, step
    logical :: found

    here = norm2(base, dim=1)
    share = 0.0_wp
    step = largest_step
    do while (share < 1.0_wp)
      next = here
      call solve_at(base, min(1.0_wp, share + step)*influence, next, found)
      if (found) then
        share = min(1.0_wp, share + step)
        here = next
        step = min(largest_step, 2.0_wp*step)
      else
        step = 0.5_wp*step
        if (step < smallest_step) exit
      end if
    end do
    friction%normal = here
    friction%share = share
    if (share >= 1.0_wp) return
    friction%state = is_locked
    friction%locked = maxloc(here, dim=1)
  end subroutine follow_solution

  !> Newton's method from a neighbouring solution. It fails where the determinant is no longer
  !! positive: there the solution has gone through infinity.
  pure subroutine solve_at(base, influence, normal, found)
    real(wp), intent(in) :: base(:, :), influence(:, :, :)
    real(wp), intent(inout) :: normal(:)
    logical, intent(out) :: found

    type(dense_factor_t) :: factor
    real(wp) :: force(2, size(normal)), matrix(size(normal), size(normal)), residual(size(normal))
    real(wp) :: change(size(normal)), before
    integer :: i, j, k

    found = .false.
    before = huge(1.0_wp)
    do i = 1, most_newton
      force = forces_of(base, influence, normal)
      residual = norm2(force, dim=1) - normal
      do j = 1, size(normal)
        do k = 1, size(normal)
          matrix(k, j) = merge(1.0_wp, 0.0_wp, j == k)
          if (norm2(force(:, k)) > 0.0_wp) matrix(k, j) = matrix(k, j) - dot_product(force(:, k), &
            influence(:, k, j))/norm2(force(:, k))
        end do
      end do
      call factorize(matrix, factor)
      if (.not. factor%determinant > 0.0_wp) return
      change = solve(factor, residual)
      normal = normal + change
      if (any(normal < 0.0_wp)) return
      ! At its accuracy the change no longer falls.
      if (maxval(abs(change)) <= accuracy*maxval(normal)) exit
      if (maxval(abs(change)) >= before .and. maxval(abs(change)) <= 100.0_wp*accuracy* &
        maxval(normal)) exit
      before = maxval(abs(change))
    end do
    found = i <= most_newton
  end subroutine solve_at

end module joint_friction
