!> Forces in the joints at a position and at a speed: by statics, or divided by elasticity.
module position_loads
  use actuated_forces, only: find_actuator_fault
  use elastic_reactions, only: divide_by_elasticity, elastic_division_t, divided_position_t, &
    find_divided, new_elastic_division
  use errors, only: error_of_numerics, error_t, outcome_t, set_error
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use poses, only: pose_t
  use positions, only: positions_t
  use reactions, only: find_unit_reactions, unit_reactions_t
  use running_loads, only: divided_t, find_running_loads, running_t
  use structures, only: has_elastic_reactions, structure_t
  implicit none (type, external)
  private

  public :: elastic_division_t, position_loads_t, find_division, find_position_loads, &
    find_speed_loads, fail_everywhere, take_failures

  !> Forces in the joints at a position.
  type :: position_loads_t
    type(unit_reactions_t) :: unit    !! of the unit loads
    type(divided_position_t) :: at    !! where elasticity divides forces
    type(divided_t) :: divided        !! likewise, at the last speed
  end type position_loads_t

contains

  !> The division of forces by elasticity, of linkages with more links than needed that bend.
  !!
  !! Errors: a link has no own modes.
  subroutine find_division(structure, division, error, crank)
    class(structure_t), intent(in) :: structure           !! of any kind
    type(elastic_division_t), allocatable, intent(out) :: division !! not allocated: statics tells
                                                           !! the forces, or nothing does
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(in), optional :: crank(:)             !! positions of the run; absent: some
                                                           !! over a turn

    integer :: i

    if (.not. has_elastic_reactions(structure)) return
    if (any(structure%linkage%loads%law%side /= 0)) then
      call set_error(error, error_of_numerics, "how elasticity divides forces among redundant "// &
        "links is not found with stops and springs of one side; take a redundant link or joint "// &
        "away, or put a SPRING where they are in contact")
      return
    end if
    allocate (division)
    if (present(crank)) then
      call new_elastic_division(structure, division, error, crank)
    else
      call new_elastic_division(structure, division, error, [(10.0_wp*i, i=0, 35)])
    end if
  end subroutine find_division

  !> Reactions to the unit loads.
  !!
  !! Errors: those of `find_actuator_fault` and `divide_by_elasticity`.
  subroutine find_position_loads(linkage, elements, pose, coefficients, found, error, division)
    type(linkage_t), intent(in) :: linkage       !! of any kind
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(pose_t), intent(in) :: pose             !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    type(position_loads_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error
    type(elastic_division_t), intent(in), optional :: division !! of this linkage, if its elasticity
                                                 !! divides forces

    call find_unit_reactions(linkage, elements, pose, coefficients, found%unit)
    call find_actuator_fault(linkage, found%unit%factors, error)
    if (allocated(error)) return
    if (present(division)) call divide_by_elasticity(division, pose, coefficients, found%unit, &
      found%at, error)
  end subroutine find_position_loads

  !> What a speed adds.
  !!
  !! Errors: those of `find_divided`.
  subroutine find_speed_loads(linkage, pose, coefficients, speed, acceleration, found, running, &
    error, division)
    type(linkage_t), intent(in) :: linkage       !! its loads and frictions
    type(pose_t), intent(in) :: pose             !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    real(wp), intent(in) :: speed                !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration         !! of the first drive [rad/s²] or [m/s²]
    type(position_loads_t), intent(inout) :: found !! of this pose; needed only where joints rub or
                                                 !! with a division
    type(running_t), intent(out) :: running
    type(error_t), allocatable, intent(out) :: error
    type(elastic_division_t), intent(in), optional :: division !! as of `find_position_loads`, with
                                                 !! the loads and frictions of `linkage`

    if (.not. present(division)) then
      call find_running_loads(linkage, pose, coefficients, speed, acceleration, found%unit, running)
      return
    end if
    call find_divided(division, found%at, coefficients, speed, found%divided, error)
    if (.not. allocated(error)) call find_running_loads(linkage, pose, coefficients, speed, &
      acceleration, found%unit, running, found%divided)
  end subroutine find_speed_loads

  !> No forces at any position.
  pure subroutine fail_everywhere(failure, positions)
    type(error_t), intent(in) :: failure
    type(positions_t), intent(inout) :: positions !! that get the error

    integer :: i

    do i = 1, size(positions%states)
      positions%states(i)%error = failure
    end do
  end subroutine fail_everywhere

  !> Positions at which a study has no forces.
  pure subroutine take_failures(outcome, positions)
    type(outcome_t), intent(in) :: outcome(:)     !! (states)
    type(positions_t), intent(inout) :: positions !! that get the errors

    integer :: i

    do i = 1, size(outcome)
      if (allocated(outcome(i)%error)) positions%states(i)%error = outcome(i)%error
    end do
  end subroutine take_failures

end module position_loads
