!> The forces of a turning linkage on the unknowns of its deformations, at deformations of any size.
!!
!! The links have the shapes of `deformed_links`, the loop is closed with their true chords, and the
!! inertia forces are those of the true paths of all masses. Equilibrium in the deformed linkage
!! gives the force F and the moment M on every cross-section; on an unknown with the strains ε, γ, κ
!! acts `∫ F·e ε + F·n (1 + ε_total) γ + M κ dx`. The equation of motion is `y + ω C y' = ` these
!! forces, whatever the size of y. Its linear part is that of `elastic_equations`, but for
!! `−∫ Q (ε φᵀ + φ εᵀ) dx` with the shear force Q of the rigid motion.
module exact_forces
  use body_lumps, only: lump_count
  use constants, only: degree
  use deformed_links, only: deformed_link, deformed_link_t, link_points_t, new_link_points
  use elastic_equations, only: functions_of
  use errors, only: error_t
  use fourier_transform, only: derivatives, fourier_plan_t
  use inertia_loads, only: load_t
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: cross, linkage_t, normal_to
  use poses, only: find_pose, pose_t
  use rigid_bodies, only: central_inertia, mass_centre, rigid_body, rigid_body_t
  use turn_grids, only: sense_of, turn_grid_t
  implicit none (type, external)
  private

  public :: find_exact_forces

  !> A body at all samples.
  type :: body_motion_t
    type(link_points_t) :: points                 !! of a link that bends
    type(deformed_link_t) :: link
    real(wp), allocatable :: chord(:)             !! (samples) its length [m]
    real(wp), allocatable :: turn(:)              !! (samples) of its first end against the rigid
                                                  !! linkage [rad]
    real(wp), allocatable :: axes(:, :, :)        !! (samples, 2, 2) of its first end: along, across
    real(wp), allocatable :: force(:, :, :)       !! (samples, 2, points) of the loads beyond [N]
    real(wp), allocatable :: moment(:, :)         !! (samples, points) the same [N m]
    real(wp), allocatable :: whole_force(:, :)    !! (samples, 2) load on the body [N]
    real(wp), allocatable :: whole_moment(:)      !! (samples) about its first pin [N m]
  end type body_motion_t

contains

  !> Forces on all unknowns in a periodic motion.
  !!
  !! Errors: the deformed links do not reach each other, or stand at a dead point.
  subroutine find_exact_forces(linkage, grid, plan, speed, y, force, error)
    type(linkage_t), intent(in) :: linkage           !! of the grid
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan         !! for its samples
    real(wp), intent(in) :: speed                    !! ω2 [rad/s]
    real(wp), intent(in) :: y(:, :)                  !! (samples, unknowns) [√J]
    real(wp), intent(out) :: force(:, :)             !! (samples, unknowns) [√J]
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(body_motion_t) :: motion(size(linkage%bodies))
    type(linkage_t) :: deformed
    type(pose_t), allocatable :: pose(:)
    type(joint_forces_t) :: joints
    type(load_t) :: loads(size(linkage%bodies))
    real(wp), allocatable :: pin(:, :, :), pin_load(:, :, :), on_last(:, :, :)
    integer :: b, k

    force = 0.0_wp
    call place_all(linkage, grid, y, motion, deformed, pose, error)
    if (allocated(error)) return
    allocate (pin(grid%samples, 2, size(linkage%pin_mass)), on_last(grid%samples, 2, size(motion)))
    do k = 1, grid%samples
      pin(k, :, :) = pose(k)%pin
    end do
    call find_pin_loads(linkage, plan, speed, pin, pin_load)
    do b = 1, size(motion)
      associate (at_first => pin(:, :, linkage%bodies(b)%first_pin))
        if (linkage%bodies(b)%bends) then
          call load_beam(linkage, grid, plan, speed, b, at_first, motion(b))
        else
          call load_rigid_link(linkage, grid, plan, speed, b, at_first, motion(b))
        end if
      end associate
    end do
    do k = 1, grid%samples
      do b = 1, size(motion)
        deformed%bodies(b)%length = motion(b)%chord(k)
        loads(b)%force = motion(b)%whole_force(k, :)
        loads(b)%moment = motion(b)%whole_moment(k) + linkage%couple(b)
      end do
      joints = find_joint_forces(deformed, pose(k), loads, pin_load(k, :, :))
      do b = 1, size(motion)
        ! A torque acts on a link as a pair of forces across its chord.
        on_last(k, :, b) = joints%on_last(:, b) + linkage%couple(b)/motion(b)%chord(k)* &
          normal_to(pose(k)%direction(:, b))
      end do
    end do
    do b = 1, size(motion)
      if (linkage%bodies(b)%bends) call add_work(grid, b, motion(b), on_last(:, :, b), force)
    end do
  end subroutine find_exact_forces

  !> The shapes of all links and where they are, from the pivot of the driven one.
  subroutine place_all(linkage, grid, y, motion, deformed, pose, error)
    type(linkage_t), intent(in) :: linkage
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :)
    type(body_motion_t), intent(inout) :: motion(:)
    type(linkage_t), intent(out) :: deformed         !! its lengths are those of the last sample
    type(pose_t), allocatable, intent(out) :: pose(:) !! (samples)
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: chord_angle(grid%samples, size(motion)), origin(2), axis(2), chord(2), crank, turn
    real(wp), allocatable :: q(:, :)
    integer :: b, k

    do b = 1, size(motion)
      associate (link => grid%model%links(b), body => motion(b))
        allocate (body%chord(grid%samples), body%turn(grid%samples), body%axes(grid%samples, 2, 2))
        body%chord = linkage%bodies(b)%length
        chord_angle(:, b) = 0.0_wp
        if (.not. linkage%bodies(b)%bends) cycle
        q = functions_of(grid, b, y)
        body%points = new_link_points(link)
        body%link = deformed_link(body%points, y(:, grid%elongation(b)), q(:, [(k, k=3, &
          2 + link%curves), (k, k=grid%integrals(b)%chord + 1, size(q, 2))]))
        associate (last => body%link%node_place(:, :, body%points%elements))
          body%chord = hypot(last(:, 1), last(:, 2))
          chord_angle(:, b) = atan2(last(:, 2), last(:, 1))
        end associate
      end associate
    end do
    deformed = linkage
    origin = linkage%ground_position(:, linkage%bodies(1)%first_pin)
    deformed%ground_position = deformed%ground_position - spread(origin, 2, &
      size(deformed%ground_position, 2))
    allocate (pose(grid%samples))
    do k = 1, grid%samples
      do b = 1, size(motion)
        deformed%bodies(b)%length = motion(b)%chord(k)
      end do
      crank = sense_of(grid)*(360.0_wp*(k - 1))/grid%samples + chord_angle(k, 1)/degree
      call find_pose(deformed, crank, pose(k), error)
      if (allocated(error)) return
      do b = 1, size(motion)
        axis = grid%direction(k, :, b)
        chord = pose(k)%direction(:, b)
        turn = atan2(cross(axis, chord), dot_product(axis, chord)) - chord_angle(k, b)
        axis = cos(turn)*axis + sin(turn)*normal_to(axis)
        motion(b)%turn(k) = turn
        motion(b)%axes(k, :, 1) = axis
        motion(b)%axes(k, :, 2) = normal_to(axis)
      end do
    end do
  end subroutine place_all

  !> Loads on the pins: inertia, weight, external forces.
  subroutine find_pin_loads(linkage, plan, speed, pin, load)
    type(linkage_t), intent(in) :: linkage
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed
    real(wp), intent(in) :: pin(:, :, :)                !! (samples, 2, pins) [m]
    real(wp), allocatable, intent(out) :: load(:, :, :) !! (samples, 2, pins) [N]

    integer :: i, p

    allocate (load, mold=pin)
    do p = 1, size(pin, 3)
      load(:, :, p) = inertia_of(plan, speed, linkage%gravity, pin(:, :, p))
      do i = 1, 2
        load(:, i, p) = linkage%pin_mass(p)*load(:, i, p) + linkage%pin_force(i, p)
      end do
    end do
  end subroutine find_pin_loads

  !> Inertia force and weight of a unit mass on a path: `g − ω² r''`.
  function inertia_of(plan, speed, gravity, path) result(force)
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed, gravity(2)
    real(wp), intent(in) :: path(:, :) !! (samples, 2) [m]
    real(wp) :: force(size(path, 1), 2)

    real(wp) :: first(size(path, 1), 2)
    integer :: i

    call derivatives(plan, path, first, force)
    do i = 1, 2
      force(:, i) = gravity(i) - speed**2*force(:, i)
    end do
  end function inertia_of

  !> `−ω² ψ''` of a cross-section that turns by ψ against the rigid link.
  function turning_inertia_of(grid, plan, speed, b, turn) result(moment)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed
    integer, intent(in) :: b
    real(wp), intent(in) :: turn(:) !! (samples) [rad]
    real(wp) :: moment(size(turn))

    real(wp), dimension(size(turn), 1) :: first, second

    call derivatives(plan, spread(turn, 2, 1), first, second)
    moment = -speed**2*(second(:, 1) + grid%rate_slope(:, b))
  end function turning_inertia_of

  !> A vector in the axes of the first end, in global axes.
  pure function to_global(axes, local) result(vector)
    real(wp), intent(in) :: axes(:, :, :) !! (samples, 2, 2)
    real(wp), intent(in) :: local(:, :)   !! (samples, 2)
    real(wp) :: vector(size(local, 1), 2)

    integer :: i

    do i = 1, 2
      vector(:, i) = axes(:, i, 1)*local(:, 1) + axes(:, i, 2)*local(:, 2)
    end do
  end function to_global

  !> `a × b` of every sample.
  pure function cross_of(a, b) result(product)
    real(wp), intent(in) :: a(:, :), b(:, :) !! (samples, 2)
    real(wp) :: product(size(a, 1))

    product = a(:, 1)*b(:, 2) - a(:, 2)*b(:, 1)
  end function cross_of

  !> Force and moment of all loads beyond every point of a link that bends, but for the force at its
  !! last pin: `F = ∫ p dx`, `M = ∫ r' × F + m dx`, from the point to the last end.
  subroutine load_beam(linkage, grid, plan, speed, b, at_first, motion)
    type(linkage_t), intent(in) :: linkage
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed
    integer, intent(in) :: b
    real(wp), intent(in) :: at_first(:, :)       !! (samples, 2) its first pin [m]
    type(body_motion_t), intent(inout) :: motion

    real(wp), allocatable :: load(:, :, :), couple(:, :)
    integer :: e, first, i, n, node(lump_count(linkage%bodies(b)))

    associate (body => linkage%bodies(b), points => motion%points, link => motion%link)
      allocate (motion%force, mold=link%place)
      allocate (motion%moment, mold=link%turn)
      allocate (motion%whole_force(grid%samples, 2), motion%whole_moment(grid%samples))
      do i = 1, size(node)
        node(i) = minloc(abs(points%node_place - body%lumps(i)%place(1)), dim=1) - 1
      end do
      n = size(points%rule%node)
      allocate (load(grid%samples, 2, n), couple(grid%samples, n))
      motion%whole_force = 0.0_wp
      motion%whole_moment = 0.0_wp
      call add_lumps(points%elements)
      do e = points%elements, 1, -1
        first = n*(e - 1)
        load = 0.0_wp
        couple = 0.0_wp
        do i = 1, n
          if (body%line_density > 0.0_wp) load(:, :, i) = body%line_density*inertia_of(plan, &
            speed, linkage%gravity, at_first + to_global(motion%axes, link%place(:, :, first + i)))
          if (body%rotary_inertia > 0.0_wp) couple(:, i) = &
            body%rotary_inertia*turning_inertia_of(grid, plan, speed, b, motion%turn + &
            link%turn(:, first + i))
        end do
        call integrate(points%length(e), first)
        call add_lumps(e - 1)
      end do
    end associate

  contains

    !> From the last end of an element to its points and its first end.
    subroutine integrate(h, first)
      real(wp), intent(in) :: h
      integer, intent(in) :: first !! points before those of the element

      real(wp) :: slope(grid%samples, n)
      integer :: i, j

      associate (rule => motion%points%rule)
        do i = 1, n
          motion%force(:, :, first + i) = motion%whole_force
          do j = 1, n
            motion%force(:, :, first + i) = motion%force(:, :, first + i) + h*(rule%weight(j) - &
              rule%matrix(i, j))*load(:, :, j)
          end do
          slope(:, i) = couple(:, i) + cross_of(to_global(motion%axes, motion%link%tangent(:, :, &
            first + i)), motion%force(:, :, first + i))
        end do
        do i = 1, n
          motion%moment(:, first + i) = motion%whole_moment + h*matmul(slope, rule%weight - &
            rule%matrix(i, :))
        end do
        motion%whole_moment = motion%whole_moment + h*matmul(slope, rule%weight)
        do j = 1, n
          motion%whole_force = motion%whole_force + h*rule%weight(j)*load(:, :, j)
        end do
      end associate
    end subroutine integrate

    !> The masses at a node.
    subroutine add_lumps(at)
      integer, intent(in) :: at !! number of the node

      real(wp), dimension(grid%samples, 2) :: arm, weight
      integer :: i

      do i = 1, size(node)
        if (node(i) /= at) cycle
        associate (lump => linkage%bodies(b)%lumps(i), turn => motion%link%node_turn(:, at))
          arm(:, 1) = -lump%place(2)*sin(turn)
          arm(:, 2) = lump%place(2)*cos(turn)
          arm = to_global(motion%axes, arm)
          weight = lump%mass*inertia_of(plan, speed, linkage%gravity, at_first + arm + &
            to_global(motion%axes, motion%link%node_place(:, :, at)))
          motion%whole_force = motion%whole_force + weight
          motion%whole_moment = motion%whole_moment + cross_of(arm, weight) + &
            lump%inertia*turning_inertia_of(grid, plan, speed, b, motion%turn + turn)
        end associate
      end do
    end subroutine add_lumps

  end subroutine load_beam

  !> The load on a rigid link.
  subroutine load_rigid_link(linkage, grid, plan, speed, b, at_first, motion)
    type(linkage_t), intent(in) :: linkage
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed
    integer, intent(in) :: b
    real(wp), intent(in) :: at_first(:, :)
    type(body_motion_t), intent(inout) :: motion

    type(rigid_body_t) :: rigid
    real(wp) :: arm(grid%samples, 2)

    rigid = rigid_body(linkage%bodies(b), 0)
    arm = to_global(motion%axes, spread(mass_centre(rigid), 1, grid%samples))
    motion%whole_force = rigid%mass*inertia_of(plan, speed, linkage%gravity, at_first + arm)
    motion%whole_moment = cross_of(arm, motion%whole_force) + &
      central_inertia(rigid)*turning_inertia_of(grid, plan, speed, b, motion%turn)
  end subroutine load_rigid_link

  !> Adds the work of axial force, shear force and moment on the unknowns of a link.
  pure subroutine add_work(grid, b, motion, on_last, force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b
    type(body_motion_t), intent(in) :: motion
    real(wp), intent(in) :: on_last(:, :)    !! (samples, 2) force at its last pin [N]
    real(wp), intent(inout) :: force(:, :)   !! (samples, unknowns)

    real(wp), dimension(size(on_last, 1), size(motion%points%place)) :: axial, shear, moment
    real(wp) :: here(size(on_last, 1), 2), weight
    real(wp) :: work(size(on_last, 1), &
      lbound(motion%points%axial, 2):ubound(motion%points%axial, 2))
    integer :: i, m, n

    associate (points => motion%points, link => motion%link, modes => grid%model%links(b)%modes)
      n = size(points%rule%node)
      do i = 1, size(points%place)
        weight = points%length((i - 1)/n + 1)*points%rule%weight(modulo(i - 1, n) + 1)
        here = motion%force(:, :, i) + on_last
        moment(:, i) = weight*(motion%moment(:, i) + cross_of(to_global(motion%axes, &
          link%node_place(:, :, points%elements) - link%place(:, :, i)), on_last))
        here = to_local(here)
        axial(:, i) = weight*(cos(link%slope(:, i))*here(:, 1) + sin(link%slope(:, i))*here(:, 2))
        shear(:, i) = weight*cross_of(link%tangent(:, :, i), here)
      end do
      work = matmul(axial, points%axial) + matmul(shear, points%shear) + matmul(moment, &
        points%curvature)
      m = grid%elongation(b)
      force(:, m) = force(:, m) + points%elongation*sum(axial, dim=2)
      if (grid%model%links(b)%curves > 0) force(:, 1) = force(:, 1) + work(:, 0)
      force(:, grid%first(b):grid%first(b) + modes - 1) = work(:, 1:modes)
      force(:, grid%first_along(b):grid%first_along(b) + grid%model%links(b)%axial_modes - 1) = &
        work(:, modes + 1:)
    end associate

  contains

    pure function to_local(vector) result(local)
      real(wp), intent(in) :: vector(:, :)
      real(wp) :: local(size(vector, 1), 2)

      integer :: i

      do i = 1, 2
        local(:, i) = motion%axes(:, 1, i)*vector(:, 1) + motion%axes(:, 2, i)*vector(:, 2)
      end do
    end function to_local

  end subroutine add_work

end module exact_forces
