!> Forces in the joints of a linkage that moves freely: the multipliers of all its equations as one
!! system, which dead points do not disturb.
module free_forces
  use applied_loads, only: generalised_force
  use body_points, only: find_point_coefficients, point_coefficients_t
  use coordinate_types, only: gradients_t, partial_t
  use dense_factor, only: dense_factor_t, factorize, solve, solve_transposed
  use drive_values, only: drive_rate
  use group_equations, only: find_gradients
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t, take_reaction
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, demand_drive, equation_t, linkage_t
  use pose_types, only: pose_t
  use rigid_bodies, only: central_inertia, mass_centre, rigid_body_t
  use whole_systems, only: curvatures, demands, drive_row, rate_along, unknown_count, whole_system_t
  implicit none (type, external)
  private

  public :: loads_t, free_equations_t, new_free_equations, add_free_loads, bent_motion, &
    forces_of_loads, forces_of_motion

  !> Loads on all bodies, about their first pins, and on all pins.
  type :: loads_t
    type(load_t), allocatable :: body(:)
    real(wp), allocatable :: pin(:, :)   !! (2, pins) [N]
  end type loads_t

  !> Equations at a state.
  type :: free_equations_t
    type(gradients_t) :: gradients, first_drive   !! of all equations, of the first drive
    real(wp), allocatable :: gear(:)              !! (equations) share of the first drive's in each
    type(dense_factor_t) :: factor                !! of all gradients above the velocities
    type(dense_factor_t) :: mass                  !! of M, with the inertia on the first drive
    type(loads_t), allocatable :: inertia(:)      !! (coordinates) `−m h_k`
    real(wp), allocatable :: driven(:)            !! (coordinates) rate of the first drive
    real(wp) :: on_drive = 0.0_wp                 !! moment of inertia on the first drive: that of a
                                                  !! rotor before its gear [kg m²]
  end type free_equations_t

contains

  !> Gradients, inertia and their factors.
  pure subroutine new_free_equations(whole, rigid, pose, per, on_drive, equations)
    type(whole_system_t), intent(in) :: whole      !! of a linkage that is not redundant
    type(rigid_body_t), intent(in) :: rigid(:)     !! (bodies)
    type(pose_t), intent(in) :: pose               !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: per(:) !! (coordinates) velocities per rate
    real(wp), intent(in) :: on_drive               !! inertia on the first drive [kg m²]
    type(free_equations_t), intent(out) :: equations

    type(point_coefficients_t) :: point
    real(wp), allocatable :: rows(:, :), matrix(:, :), row(:)
    real(wp) :: mass(size(per), size(per))
    integer :: b, i, k, l, m, p

    m = size(whole%equations)
    call find_gradients(whole%linkage, pose, whole%equations, equations%gradients)
    call find_gradients(whole%linkage, pose, whole%drives(:1), equations%first_drive)
    rows = demands(whole, pose, equations%gradients)
    allocate (matrix(m + size(per), unknown_count(whole)))
    matrix(:m, :) = rows
    do k = 1, size(per)
      row = as_unknowns(whole, per(k))
      matrix(m + k, :) = row/norm2(row)
    end do
    call factorize(matrix, equations%factor)
    allocate (equations%gear(m), equations%inertia(size(per)), equations%driven(size(per)))
    do i = 1, m
      equations%gear(i) = 0.0_wp
      if (whole%equations(i)%kind == demand_drive) equations%gear(i) = drive_rate(whole%linkage, &
        whole%equations(i)%number)
    end do
    do k = 1, size(per)
      equations%driven(k) = rate_along(whole, drive_row(whole, pose, 1), per(k)%turn, per(k)%pin)
      associate (loads => equations%inertia(k))
        allocate (loads%body(size(rigid)), loads%pin(2, size(pose%pin, 2)))
        do b = 1, size(rigid)
          point = find_point_coefficients(whole%linkage, pose, per(k), b, mass_centre(rigid(b)))
          call load_mass(whole%linkage, pose, rigid(b), b, point%place, point%rate, &
            per(k)%turn(b), loads%body(b))
        end do
        do p = 1, size(pose%pin, 2)
          loads%pin(:, p) = -whole%linkage%pin_mass(p)*per(k)%pin(:, p)
        end do
        do l = 1, size(per)
          mass(l, k) = -generalised_force(whole%linkage, per(l), loads%body, loads%pin)
        end do
      end associate
    end do
    equations%on_drive = on_drive
    do k = 1, size(per)
      mass(:, k) = mass(:, k) + on_drive*equations%driven(k)*equations%driven
    end do
    call factorize(mass, equations%mass)
  end subroutine new_free_equations

  !> Velocities as a row of the unknowns.
  pure function as_unknowns(whole, velocities) result(row)
    type(whole_system_t), intent(in) :: whole
    type(kinematic_coefficients_t), intent(in) :: velocities
    real(wp), allocatable :: row(:)

    integer :: i

    allocate (row(unknown_count(whole)))
    row(whole%at_body) = velocities%turn*whole%scale
    do i = 1, size(whole%at_pin)
      associate (at => whole%at_pin(i))
        if (at >= 0) row(at + 1:at + 2) = velocities%pin(:, i)
      end associate
    end do
  end function as_unknowns

  !> Inertia of a body with an acceleration of its mass centre.
  pure subroutine load_mass(linkage, pose, rigid, body, centre, acceleration, angular, load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(rigid_body_t), intent(in) :: rigid
    integer, intent(in) :: body             !! number
    real(wp), intent(in) :: centre(2)       !! in global axes [m]
    real(wp), intent(in) :: acceleration(2) !! of it
    real(wp), intent(in) :: angular         !! acceleration
    type(load_t), intent(inout) :: load     !! to which it is added

    real(wp) :: force(2)

    force = -rigid%mass*acceleration
    load%force = load%force + force
    load%moment = load%moment + cross(centre - pose%pin(:, linkage%bodies(body)%first_pin), force) &
      - central_inertia(rigid)*angular
  end subroutine load_mass

  !> The motion with present rates and no rates of change of the coordinates.
  pure function bent_motion(whole, pose, now, equations) result(bent)
    type(whole_system_t), intent(in) :: whole      !! of `equations`
    type(pose_t), intent(in) :: pose               !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(free_equations_t), intent(in) :: equations   !! of this pose
    type(kinematic_coefficients_t) :: bent         !! velocities and accelerations

    real(wp) :: right(unknown_count(whole)), slopes(unknown_count(whole))
    integer :: p

    right = 0.0_wp
    right(:size(whole%equations)) = -curvatures(whole, pose, now)
    slopes = solve(equations%factor, right)
    bent = now
    bent%turn_slope = slopes(whole%at_body)/whole%scale
    bent%pin_slope = 0.0_wp
    do p = 1, size(whole%at_pin)
      if (whole%at_pin(p) >= 0) bent%pin_slope(:, p) = slopes(whole%at_pin(p) + &
        1:whole%at_pin(p) + 2)
    end do
  end function bent_motion

  !> Adds applied loads, weights, constant forces and couples, and the inertia of a motion.
  pure subroutine add_free_loads(whole, rigid, pose, motion, body_load, pin_load, loads)
    type(whole_system_t), intent(in) :: whole      !! of the linkage
    type(rigid_body_t), intent(in) :: rigid(:)     !! (bodies)
    type(pose_t), intent(in) :: pose               !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities and accelerations
    type(load_t), intent(in) :: body_load(:)       !! (bodies) of all applied loads
    real(wp), intent(in) :: pin_load(:, :)         !! (2, pins) likewise [N]
    type(loads_t), intent(inout) :: loads          !! to which they are added

    type(point_coefficients_t) :: point
    integer :: b, p

    associate (linkage => whole%linkage)
      do b = 1, size(rigid)
        point = find_point_coefficients(linkage, pose, motion, b, mass_centre(rigid(b)))
        call load_mass(linkage, pose, rigid(b), b, point%place, point%slope - linkage%gravity, &
          motion%turn_slope(b), loads%body(b))
        loads%body(b)%force = loads%body(b)%force + body_load(b)%force
        loads%body(b)%moment = loads%body(b)%moment + body_load(b)%moment + linkage%couple(b)
      end do
      do p = 1, size(linkage%is_ground)
        loads%pin(:, p) = loads%pin(:, p) + pin_load(:, p) + linkage%pin_force(:, p) + &
          linkage%pin_mass(p)*(linkage%gravity - motion%pin_slope(:, p))
      end do
    end associate
  end subroutine add_free_loads

  !> Forces in the joints of a linkage that moves freely under loads: with the inertia of the
  !! ü that follows from them.
  pure function forces_of_loads(whole, pose, per, equations, loads, drive_force) result(joints)
    type(whole_system_t), intent(in) :: whole      !! of `equations`
    type(pose_t), intent(in) :: pose               !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: per(:) !! (coordinates) velocities per rate
    type(free_equations_t), intent(in) :: equations !! of this pose
    type(loads_t), intent(in) :: loads             !! with the inertia of present rates
    real(wp), intent(in) :: drive_force            !! on the first drive, but for the inertia of ü
                                                   !! there [N m] or [N]
    type(joint_forces_t) :: joints

    type(loads_t) :: all
    real(wp) :: along(size(per))
    integer :: b, k

    do k = 1, size(per)
      along(k) = generalised_force(whole%linkage, per(k), loads%body, loads%pin) + &
        drive_force*equations%driven(k)
    end do
    along = solve(equations%mass, along)
    all = loads
    do k = 1, size(per)
      do b = 1, size(all%body)
        all%body(b)%force = all%body(b)%force + along(k)*equations%inertia(k)%body(b)%force
        all%body(b)%moment = all%body(b)%moment + along(k)*equations%inertia(k)%body(b)%moment
      end do
      all%pin = all%pin + along(k)*equations%inertia(k)%pin
    end do
    call forces_of_motion(whole, pose, equations, all, drive_force - &
      equations%on_drive*dot_product(equations%driven, along), joints)
  end function forces_of_loads

  !> Forces in the joints that balance all loads, those of inertia among them.
  pure subroutine forces_of_motion(whole, pose, equations, loads, drive_force, joints, imbalance)
    type(whole_system_t), intent(in) :: whole      !! of `equations`
    type(pose_t), intent(in) :: pose               !! pins and directions
    type(free_equations_t), intent(in) :: equations !! of this pose
    type(loads_t), intent(in) :: loads             !! with all inertia but that on the drive
    real(wp), intent(in) :: drive_force            !! on the first drive [N m] or [N]
    type(joint_forces_t), intent(out) :: joints
    real(wp), intent(out), optional :: imbalance   !! what no force in a joint balances, if these
                                                   !! are not the loads of the motion, as a share
                                                   !! of them [-]

    real(wp) :: right(unknown_count(whole)), lambda(size(whole%equations) + 1), all
    integer :: b, i, m, further

    associate (linkage => whole%linkage)
      m = size(whole%equations)
      right = -drive_force*drive_row(whole, pose, 1)
      further = 0
      do b = 1, size(linkage%bodies)
        further = further + size(linkage%bodies(b)%further)
        call load_unknowns(whole, linkage%bodies(b)%first_pin, loads%body(b)%force, right)
        right(whole%at_body(b)) = right(whole%at_body(b)) - loads%body(b)%moment/whole%scale(b)
      end do
      do i = 1, size(linkage%is_ground)
        call load_unknowns(whole, i, loads%pin(:, i), right)
      end do
      all = norm2(right)
      right = solve_transposed(equations%factor, right)
      if (present(imbalance)) imbalance = norm2(right(m + 1:))/max(all, tiny(all))
      lambda(:m) = right(:m)
      lambda(m + 1) = drive_force - dot_product(equations%gear, lambda(:m))
      allocate (joints%on_first(2, size(linkage%bodies)), joints%on_last(2, size(linkage%bodies)), &
        joints%on_further(2, further), joints%guide(size(linkage%sliders)), &
        joints%couple(size(linkage%turns)), joints%drive(size(linkage%drives)))
      do b = 1, size(linkage%bodies)
        joints%on_first(:, b) = -loads%body(b)%force
      end do
      joints%on_last = 0.0_wp
      joints%on_further = 0.0_wp
      joints%guide = 0.0_wp
      joints%couple = 0.0_wp
      joints%drive = 0.0_wp
      do i = 1, m
        associate (gradients => equations%gradients)
          call put_equation(linkage, whole%equations(i), gradients%partial(gradients%last(i - 1) + &
            1:gradients%last(i)), lambda(i), joints)
        end associate
      end do
      call put_equation(linkage, whole%drives(1), equations%first_drive%partial( &
        :equations%first_drive%last(1)), lambda(m + 1), joints)
      joints%torque = joints%drive(1)
    end associate
  end subroutine forces_of_motion

  !> Puts a load of a pin on the right-hand side; ground pivots bear theirs.
  pure subroutine load_unknowns(whole, pin, force, right)
    type(whole_system_t), intent(in) :: whole
    integer, intent(in) :: pin
    real(wp), intent(in) :: force(2)
    real(wp), intent(inout) :: right(:)

    associate (at => whole%at_pin(pin))
      if (at >= 0) right(at + 1:at + 2) = right(at + 1:at + 2) - force
    end associate
  end subroutine load_unknowns

  !> Puts the force that an equation stands for into the joints, as `find_joint_forces` does.
  pure subroutine put_equation(linkage, equation, partial, lambda, joints)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equation
    type(partial_t), intent(in) :: partial(:) !! its gradient
    real(wp), intent(in) :: lambda
    type(joint_forces_t), intent(inout) :: joints

    integer :: k

    do k = 1, size(partial)
      associate (body => partial(k)%body)
        if (body > 0 .and. partial(k)%pin > 0) joints%on_first(:, body) = joints%on_first(:, &
          body) - lambda*partial(k)%by_pin
      end associate
    end do
    call take_reaction(linkage, equation, lambda, partial(size(partial))%by_pin, joints)
  end subroutine put_equation

end module free_forces
