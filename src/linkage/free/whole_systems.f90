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
  use coordinate_types, only: gradients_t
  use coordinates, only: coordinate_acceleration
  use drive_values, only: drive_rate
  use group_equations, only: farthest_arm, find_gradients, misfit_of
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: demand_drive, gives_angle, equation_t, linkage_t, normal_to
  use plan_equations, only: append_equation, drive_equation, list_joint_equations
  use pose_types, only: pose_t
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
    type(equation_t), allocatable :: drives(:)    !! of all drives, free ones too
  end type whole_system_t

contains

  !> The equations of a linkage, but those of its free drives.
  pure function new_whole_system(linkage, free) result(system)
    type(linkage_t), intent(in) :: linkage !! with its groups
    integer, intent(in) :: free(:)         !! numbers of the drives that are free
    type(whole_system_t) :: system

    integer :: i, unknowns

    system%linkage = linkage
    allocate (system%at_pin(size(linkage%is_ground)), system%at_body(size(linkage%bodies)), &
      system%scale(size(linkage%bodies)), system%drives(size(linkage%drives)))
    unknowns = 0
    do i = 1, size(linkage%is_ground)
      system%at_pin(i) = merge(-1, unknowns, linkage%is_ground(i))
      if (.not. linkage%is_ground(i)) unknowns = unknowns + 2
    end do
    do i = 1, size(linkage%bodies)
      system%at_body(i) = unknowns + i
      system%scale(i) = farthest_arm(linkage%bodies(i))
    end do
    call list_joint_equations(linkage, system%equations)
    do i = 1, size(linkage%drives)
      system%drives(i) = drive_equation(linkage, i)
      if (.not. any(free == i)) call append_equation(system%equations, system%drives(i))
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
  pure function demands(system, pose, gradients) result(rows)
    type(whole_system_t), intent(in) :: system !! its equations
    type(pose_t), intent(in) :: pose           !! pins and directions
    type(gradients_t), intent(in), optional :: gradients !! of them, where they are known
    real(wp), allocatable :: rows(:, :)        !! (equations, unknowns) [-], or [1/m] of angles

    type(gradients_t) :: own
    real(wp), allocatable :: first(:)
    real(wp) :: rate
    integer :: i

    if (present(gradients)) then
      rows = rows_of(system, gradients)
    else
      call find_gradients(system%linkage, pose, system%equations, own)
      rows = rows_of(system, own)
    end if
    do i = 1, size(system%equations)
      rate = rate_by_gears(system, system%equations(i))
      if (.not. abs(rate) > 0.0_wp) cycle
      if (.not. allocated(first)) first = drive_row(system, pose, 1)
      rows(i, :) = rows(i, :) - rate*first
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

    type(gradients_t) :: gradients
    real(wp), allocatable :: rows(:, :)

    call find_gradients(system%linkage, pose, system%drives(drive:drive), gradients)
    rows = rows_of(system, gradients)
    row = rows(1, :)
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

  !> Gradients by the unknowns.
  pure function rows_of(system, gradients) result(rows)
    type(whole_system_t), intent(in) :: system
    type(gradients_t), intent(in) :: gradients
    real(wp), allocatable :: rows(:, :) !! (equations, unknowns)

    integer :: i, k, at

    allocate (rows(ubound(gradients%last, 1), unknown_count(system)))
    rows = 0.0_wp
    do i = 1, size(rows, 1)
      do k = gradients%last(i - 1) + 1, gradients%last(i)
        associate (partial => gradients%partial(k))
          if (partial%pin > 0) then
            at = system%at_pin(partial%pin)
            if (at >= 0) rows(i, at + 1:at + 2) = rows(i, at + 1:at + 2) + partial%by_pin
          end if
          if (partial%body == 0) cycle
          at = system%at_body(partial%body)
          rows(i, at) = rows(i, at) + partial%by_angle/system%scale(partial%body)
        end associate
      end do
    end do
  end function rows_of

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
      curvature(i) = curvature_of(system, pose, motion, system%equations(i))
      rate = rate_by_gears(system, system%equations(i))
      if (abs(rate) > 0.0_wp) curvature(i) = curvature(i) - rate*curvature_of(system, pose, &
        motion, system%drives(1))
    end do
  end function curvatures

  pure function curvature_of(system, pose, motion, equation) result(curvature)
    type(whole_system_t), intent(in) :: system
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: motion
    type(equation_t), intent(in) :: equation
    real(wp) :: curvature

    curvature = coordinate_acceleration(system%linkage, pose, motion, equation%coordinate, &
      of_rates_alone=.true.)
  end function curvature_of

  !> Acceleration of the coordinate of a drive [rad/s²] or [m/s²].
  pure function drive_acceleration(system, pose, drive, motion) result(acceleration)
    type(whole_system_t), intent(in) :: system !! its drives
    type(pose_t), intent(in) :: pose           !! pins and directions
    integer, intent(in) :: drive               !! number, from 1
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities and accelerations
    real(wp) :: acceleration

    acceleration = rate_along(system, drive_row(system, pose, drive), motion%turn_slope, &
      motion%pin_slope) + curvature_of(system, pose, motion, system%drives(drive))
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
      position = misfit_of(system%linkage, system%drives(drive), pose, 0.0_wp)
      if (gives_angle(it)) position = position/degree
      position = position + it%phase
      if (gives_angle(it)) position = position + 360.0_wp*anint((near - &
        position)/360.0_wp)
    end associate
  end function drive_position

end module whole_systems
