! src/linkage/free/ - forward dynamics: the motion of a linkage under a motor and all other loads.
! In: a planned linkage, its free drives, a `drive_t`, a `gear_t`. Out: a `linkage_sample_t` at each
! instant. Begin with `start_linkage_motion` and `move_linkage_until` in `linkage_motions.f90`, then
! `find_instant` in `linkage_rates.f90`. Coordinates are those of the drives, near dead points of a
! chart (`motion_charts.f90`), of a four-bar along its curve (`loop_curves.f90`).
! Not here: inverse dynamics (`src/linkage/statics`), elastic motions in time
! (`src/response/transient`).

!> A linkage as one system of equations, without the free drives: what it demands wherever it moves,
!! also where its groups cannot be placed one after the other.
!!
!! The unknowns are displacements of all moving pins and turns of all bodies, these times lengths,
!! from a pose near by.
module whole_systems
  use constants, only: degree
  use coordinate_types, only: gradient_t
  use drive_values, only: drive_rate
  use group_equations, only: curvature_of, farthest_arm, find_gradient, misfit_of
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: demand_angle, demand_drive, demand_length, gives_angle, equation_t, &
    linkage_t, normal_to
  use plan_equations, only: append_equation, drive_equation, length_drive, line_equation, &
    pin_equation, turn_equation
  use pose_types, only: pins_of_body, pose_t
  implicit none (type, external)
  private

  public :: whole_system_t, new_whole_system, unknown_count, displaced, demands, misfits, &
    curvatures, drive_row, drive_position, drive_acceleration, rate_along

  type :: whole_system_t
    type(linkage_t) :: linkage
    integer, allocatable :: at_pin(:)             !! (pins) unknowns before its two; −1: it is fixed
    integer, allocatable :: at_body(:)            !! (bodies) number of its unknown
    real(wp), allocatable :: scale(:)             !! (bodies) length of its largest arm [m]
    type(equation_t), allocatable :: equations(:) !! with those that are redundant
  end type whole_system_t

contains

  !> The equations of a linkage, but those of its free drives.
  pure function new_whole_system(linkage, free) result(system)
    type(linkage_t), intent(in) :: linkage !! with its groups
    integer, intent(in) :: free(:)         !! numbers of the drives that are free
    type(whole_system_t) :: system

    integer, allocatable :: pins(:)
    integer :: i, k, unknowns

    system%linkage = linkage
    allocate (system%at_pin(size(linkage%is_ground)), system%at_body(size(linkage%bodies)), &
      system%scale(size(linkage%bodies)), system%equations(0))
    unknowns = 0
    do i = 1, size(linkage%is_ground)
      system%at_pin(i) = merge(-1, unknowns, linkage%is_ground(i))
      if (.not. linkage%is_ground(i)) unknowns = unknowns + 2
    end do
    do i = 1, size(linkage%bodies)
      unknowns = unknowns + 1
      system%at_body(i) = unknowns
      system%scale(i) = farthest_arm(linkage%bodies(i))
      pins = pins_of_body(linkage%bodies(i))
      do k = 2, size(pins)
        if (k > 2 .or. length_drive(linkage, i) == 0) call append_equation(system%equations, &
          pin_equation(linkage, demand_length, i, pins(k)))
        call append_equation(system%equations, pin_equation(linkage, demand_angle, i, pins(k)))
      end do
    end do
    do i = 1, size(linkage%sliders)
      call append_equation(system%equations, line_equation(i))
    end do
    do i = 1, size(linkage%turns)
      call append_equation(system%equations, turn_equation(i))
    end do
    do i = 1, size(linkage%drives)
      if (.not. any(free == i)) call append_equation(system%equations, drive_equation(i))
    end do
  end function new_whole_system

  !> Number of unknowns.
  pure function unknown_count(system) result(number)
    type(whole_system_t), intent(in) :: system !! its pins and bodies
    integer :: number

    number = 2*count(system%at_pin >= 0) + size(system%at_body)
  end function unknown_count

  !> A pose moved by the unknowns.
  pure function displaced(system, pose, unknowns) result(moved)
    type(whole_system_t), intent(in) :: system !! its pins and bodies
    type(pose_t), intent(in) :: pose           !! pins from `reference_point`, and directions
    real(wp), intent(in) :: unknowns(:)        !! displacements and turns times lengths [m]
    type(pose_t) :: moved

    real(wp) :: angle
    integer :: i

    moved%origin = pose%origin
    allocate (moved%pin, source=pose%pin)
    allocate (moved%direction, mold=pose%direction)
    do i = 1, size(system%at_pin)
      if (system%at_pin(i) >= 0) moved%pin(:, i) = pose%pin(:, i) + unknowns(system%at_pin(i) + &
        1:system%at_pin(i) + 2)
    end do
    do i = 1, size(system%at_body)
      angle = unknowns(system%at_body(i))/system%scale(i)
      moved%direction(:, i) = cos(angle)*pose%direction(:, i) + sin(angle)*normal_to( &
        pose%direction(:, i))
      moved%direction(:, i) = moved%direction(:, i)/norm2(moved%direction(:, i))
    end do
  end function displaced

  !> Gradients of all equations by the unknowns.
  pure function demands(system, pose) result(rows)
    type(whole_system_t), intent(in) :: system !! its equations
    type(pose_t), intent(in) :: pose           !! pins and directions
    real(wp), allocatable :: rows(:, :)        !! (equations, unknowns) [-], or [1/m] of angles

    real(wp) :: rate
    integer :: i

    allocate (rows(size(system%equations), unknown_count(system)))
    do i = 1, size(system%equations)
      call set_row(system, system%equations(i), pose, rows(i, :))
      rate = rate_by_gears(system, system%equations(i))
      if (abs(rate) > 0.0_wp) rows(i, :) = rows(i, :) - rate*drive_row(system, pose, 1)
    end do
  end function demands

  !> Rate of a drive that is geared to the first one, per rate of that; 0 of one that is held, and
  !! of other equations.
  pure function rate_by_gears(system, equation) result(rate)
    type(whole_system_t), intent(in) :: system
    type(equation_t), intent(in) :: equation
    real(wp) :: rate

    rate = 0.0_wp
    if (equation%kind == demand_drive) rate = drive_rate(system%linkage, equation%number)
  end function rate_by_gears

  !> Gradient of the coordinate of a drive by the unknowns.
  pure function drive_row(system, pose, drive) result(row)
    type(whole_system_t), intent(in) :: system !! its drives
    type(pose_t), intent(in) :: pose           !! pins and directions
    integer, intent(in) :: drive               !! number, from 1
    real(wp), allocatable :: row(:)            !! (unknowns)

    allocate (row(unknown_count(system)))
    call set_row(system, drive_equation(drive), pose, row)
  end function drive_row

  !> A row of the unknowns times velocities of pins and bodies.
  pure function rate_along(system, row, turn, pin) result(rate)
    type(whole_system_t), intent(in) :: system !! its pins and bodies
    real(wp), intent(in) :: row(:)             !! (unknowns) a gradient or a direction
    real(wp), intent(in) :: turn(:)            !! (bodies) angular velocities
    real(wp), intent(in) :: pin(:, :)          !! (2, pins) velocities
    real(wp) :: rate

    integer :: i

    rate = dot_product(row(system%at_body), turn*system%scale)
    do i = 1, size(system%at_pin)
      associate (at => system%at_pin(i))
        if (at >= 0) rate = rate + dot_product(row(at + 1:at + 2), pin(:, i))
      end associate
    end do
  end function rate_along

  !> Gradient of one equation by the unknowns.
  pure subroutine set_row(system, equation, pose, row)
    type(whole_system_t), intent(in) :: system
    type(equation_t), intent(in) :: equation
    type(pose_t), intent(in) :: pose
    real(wp), intent(out) :: row(:)

    type(gradient_t) :: gradient
    integer :: k, at

    row = 0.0_wp
    call find_gradient(system%linkage, equation, pose, gradient)
    do k = 1, gradient%terminals
      if (gradient%pin(k) > 0) then
        at = system%at_pin(gradient%pin(k))
        if (at >= 0) row(at + 1:at + 2) = row(at + 1:at + 2) + gradient%by_pin(:, k)
      end if
      if (gradient%body(k) == 0) cycle
      at = system%at_body(gradient%body(k))
      row(at) = row(at) + gradient%by_angle(k)/system%scale(gradient%body(k))
    end do
  end subroutine set_row

  !> By how much the equations are not fulfilled.
  pure function misfits(system, pose, crank) result(misfit)
    type(whole_system_t), intent(in) :: system !! its equations
    type(pose_t), intent(in) :: pose           !! pins and directions
    real(wp), intent(in) :: crank              !! of the first drive near by, with whole turns [deg]
                                               !! or [m]
    real(wp) :: misfit(size(system%equations)) !! [m], or [rad] of angles

    real(wp) :: now
    integer :: i

    now = drive_position(system, pose, 1, crank)
    do i = 1, size(misfit)
      misfit(i) = misfit_of(system%linkage, system%equations(i), pose, now)
    end do
  end function misfits

  !> Second derivatives of all equations along velocities of pins and bodies: q'ᵀ ∇²C q'.
  pure function curvatures(system, pose, motion) result(curvature)
    type(whole_system_t), intent(in) :: system !! its equations
    type(pose_t), intent(in) :: pose           !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities
    real(wp) :: curvature(size(system%equations))

    real(wp) :: rate
    integer :: i

    do i = 1, size(curvature)
      curvature(i) = curvature_of(system%linkage, system%equations(i), pose, motion)
      rate = rate_by_gears(system, system%equations(i))
      if (abs(rate) > 0.0_wp) curvature(i) = curvature(i) - rate*curvature_of(system%linkage, &
        drive_equation(1), pose, motion)
    end do
  end function curvatures

  !> Acceleration of the coordinate of a drive [rad/s²] or [m/s²].
  pure function drive_acceleration(system, pose, drive, motion) result(acceleration)
    type(whole_system_t), intent(in) :: system !! its drives
    type(pose_t), intent(in) :: pose           !! pins and directions
    integer, intent(in) :: drive               !! number, from 1
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities and accelerations
    real(wp) :: acceleration

    acceleration = rate_along(system, drive_row(system, pose, drive), motion%turn_slope, &
      motion%pin_slope) + curvature_of(system%linkage, drive_equation(drive), pose, motion)
  end function drive_acceleration

  !> Coordinate of a drive at a pose: the one within half a turn of a value near by [deg] or [m].
  pure function drive_position(system, pose, drive, near) result(position)
    type(whole_system_t), intent(in) :: system !! its drives
    type(pose_t), intent(in) :: pose           !! pins and directions
    integer, intent(in) :: drive               !! number, from 1
    real(wp), intent(in) :: near               !! [deg] or [m]
    real(wp) :: position

    ! The drive's misfit is what its coordinate is above its phase.
    associate (it => system%linkage%drives(drive))
      position = misfit_of(system%linkage, drive_equation(drive), pose, 0.0_wp)
      if (gives_angle(it)) position = position/degree
      position = position + it%phase
      if (gives_angle(it)) position = position + 360.0_wp*anint((near - &
        position)/360.0_wp)
    end associate
  end function drive_position

end module whole_systems
