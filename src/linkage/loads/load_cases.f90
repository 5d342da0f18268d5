!> The three load cases of which the loads of a moving linkage are made: loads that are there at
!! rest, ω2² times the case of ω2² = 1, and α2 times the case of α2 = 1. What else depends on the
!! speed is in `running_loads`.
module load_cases
  use acceleration_fields, only: acceleration_field_t, find_unit_field
  use applied_loads, only: add_standing_loads, evaluate_loads, forces_at_places, has_standing_loads
  use coordinates, only: evaluated_t
  use inertia_loads, only: distributed_load, load_t, lumped_load, pin_load
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: load_case_t, unit_loads_t, case_count, constant_case, find_unit_loads, &
    has_constant_loads, find_case_loads

  !> Load cases: 1 for ω2² = 1, 2 for α2 = 1, 3 for gravity and all else that a pose determines.
  integer, parameter :: case_count = 3, constant_case = 3

  !> The loads of one case. Inertia loads are those of an acceleration field; gravity g is the field
  !! −g.
  type :: load_case_t
    type(acceleration_field_t) :: field      !! of the inertia loads
    real(wp), allocatable :: pin_force(:, :) !! (2, pins) external forces on the pins [N]
    real(wp), allocatable :: couple(:)       !! (bodies) external torques, with the moments of
                                             !! `body_force` about their first pins [N m]
    real(wp), allocatable :: body_force(:, :) !! (2, bodies) external forces on bodies beside their
                                             !! pins [N]; not allocated: none
    real(wp), allocatable :: place_force(:, :) !! (2, loads of the linkage) those of them that act
                                             !! at places of bodies, else 0 [N]; not allocated: none
  end type load_case_t

  !> The three cases at a pose, found once for all uses.
  type :: unit_loads_t
    logical :: occurs(case_count) = .true. !! cases that do not occur are left empty
    type(load_case_t) :: of_case(case_count)
  end type unit_loads_t

contains

  !> Whether gravity, external forces or torques, or springs load a linkage.
  pure function has_constant_loads(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! its gravity and external loads
    logical :: has

    has = any(abs(linkage%gravity) > 0.0_wp) .or. any(abs(linkage%pin_force) > 0.0_wp) .or. &
      any(abs(linkage%couple) > 0.0_wp) .or. has_standing_loads(linkage)
  end function has_constant_loads

  !> The load cases at a pose, all three or only those that occur.
  pure function find_unit_loads(linkage, pose, coefficients, occurs) result(loads)
    type(linkage_t), intent(in) :: linkage                     !! bodies, pins, constant loads
    type(pose_t), intent(in) :: pose                           !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    logical, intent(in), optional :: occurs(case_count)        !! absent: all
    type(unit_loads_t) :: loads

    integer :: i

    if (present(occurs)) loads%occurs = occurs
    if (.not. any(loads%occurs)) return
    do i = 1, 2
      if (.not. loads%occurs(i)) cycle
      call find_unit_field(linkage, pose, coefficients, i, loads%of_case(i)%field)
      allocate (loads%of_case(i)%pin_force, mold=linkage%pin_force)
      allocate (loads%of_case(i)%couple, mold=linkage%couple)
      loads%of_case(i)%pin_force = 0.0_wp
      loads%of_case(i)%couple = 0.0_wp
    end do
    if (.not. loads%occurs(constant_case)) return
    associate (constant => loads%of_case(constant_case))
      allocate (constant%field%at_pin(2, size(linkage%pin_mass)), &
        constant%field%at_first(2, size(linkage%bodies)), &
        constant%field%slope(2, size(linkage%bodies)), &
        constant%field%angular(size(linkage%bodies)))
      do i = 1, 2
        constant%field%at_pin(i, :) = -linkage%gravity(i)
        constant%field%at_first(i, :) = -linkage%gravity(i)
      end do
      constant%field%slope = 0.0_wp
      constant%field%angular = 0.0_wp
      constant%pin_force = linkage%pin_force
      constant%couple = linkage%couple
      if (has_standing_loads(linkage)) call add_applied_loads(linkage, pose, constant)
    end associate
  end function find_unit_loads

  !> Adds the loads of springs and processes that a pose determines.
  pure subroutine add_applied_loads(linkage, pose, constant)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(inout) :: constant

    type(load_t) :: body_loads(size(linkage%bodies))
    type(evaluated_t), allocatable :: along(:)
    integer :: b

    call evaluate_loads(linkage, pose, along)
    call add_standing_loads(linkage, pose, along, body_loads, constant%pin_force)
    constant%couple = constant%couple + body_loads%moment
    constant%place_force = forces_at_places(linkage, pose)
    allocate (constant%body_force(2, size(body_loads)))
    do b = 1, size(body_loads)
      constant%body_force(:, b) = body_loads(b)%force
    end do
  end subroutine add_applied_loads

  !> Loads on bodies and pins in one case.
  pure subroutine find_case_loads(linkage, elements, pose, case, body_loads, pin_loads)
    type(linkage_t), intent(in) :: linkage     !! bodies and pin masses
    integer, intent(in) :: elements(:)         !! (bodies) elements whose nodes carry the mass;
                                               !! 0: distributed mass
    type(pose_t), intent(in) :: pose           !! directions of the bodies
    type(load_case_t), intent(in) :: case      !! one of `find_unit_loads`
    type(load_t), intent(out) :: body_loads(:) !! (bodies) about their first pins
    real(wp), intent(out) :: pin_loads(:, :)   !! (2, pins) [N]

    integer :: b

    do b = 1, size(linkage%bodies)
      if (elements(b) > 0) then
        body_loads(b) = lumped_load(linkage%bodies(b), b, elements(b), pose, case%field)
      else
        body_loads(b) = distributed_load(linkage%bodies(b), b, pose, case%field)
      end if
      body_loads(b)%moment = body_loads(b)%moment + case%couple(b)
      if (allocated(case%body_force)) body_loads(b)%force = body_loads(b)%force + &
        case%body_force(:, b)
    end do
    pin_loads = pin_load(linkage, case%field) + case%pin_force
  end subroutine find_case_loads

end module load_cases
