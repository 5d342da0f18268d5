!> Forces in the joints of linkages with more links than needed, which their elasticity divides.
module elastic_reactions
  use deformation_model, only: deformation_model_t, new_deformation_model
  use errors, only: error_of_input, error_t, set_error
  use kinematic_coefficients, only: kinematic_coefficients_t
  use load_cases, only: case_count, find_unit_loads
  use part_displacements, only: find_part_chords
  use part_forces, only: find_part_forces
  use part_poses, only: find_part_loads
  use part_reactions, only: take_part_reactions
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  use position_assembly, only: assembled_t, new_assembled, place_parts, set_border
  use reactions, only: unit_reactions_t
  use redundancies, only: body_of_redundancy
  use structures, only: structure_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: has_elastic_reactions, new_elastic_model, divide_by_elasticity

  !> Orders of the links: their border alone carries loads.
  integer, parameter :: least_order = 5

contains

  !> Whether statics alone cannot tell the forces of a linkage, and its elasticity can.
  pure function has_elastic_reactions(structure) result(has)
    class(structure_t), intent(in) :: structure !! with or without beams
    logical :: has

    has = size(structure%linkage%redundancies) > 0 .and. allocated(structure%elastic)
  end function has_elastic_reactions

  !> The links of a linkage, once for all positions.
  !!
  !! Errors: a link has no own modes.
  subroutine new_elastic_model(structure, crank, model, error)
    class(structure_t), intent(in) :: structure      !! that `has_elastic_reactions`
    real(wp), intent(in) :: crank(:)                 !! some positions of the first drive
    type(deformation_model_t), intent(out) :: model
    type(error_t), allocatable, intent(out) :: error

    integer :: parts

    parts = size(structure%elastic%body)
    call new_deformation_model(structure%elastic%linkage, structure%elastic%beams, spread(0, 1, &
      parts), spread(least_order, 1, parts), spread(.false., 1, parts), model, error, &
      held=structure%elastic%held)
    if (allocated(error)) return
    call set_border(structure, crank, model)
  end subroutine new_elastic_model

  !> Puts the forces by elasticity in place of those of statics.
  !!
  !! Errors: those of `place_parts` and `find_part_chords`; rigid links alone are more than needed,
  !! and nothing tells their forces.
  subroutine divide_by_elasticity(structure, model, pose, coefficients, unit, error)
    class(structure_t), intent(in) :: structure                !! of this model
    type(deformation_model_t), intent(in) :: model             !! of `new_elastic_model`
    type(pose_t), intent(in) :: pose                           !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! at the pose
    type(unit_reactions_t), intent(inout) :: unit              !! by statics
    type(error_t), allocatable, intent(out) :: error

    type(assembled_t) :: here
    type(chords_t) :: chords
    integer :: i

    here = new_assembled(structure, model)
    call place_parts(structure, model, pose, here, error)
    if (allocated(error)) return
    call find_part_chords(structure%linkage, here%elastic, here%model%links, here%pose, &
      model%layout%border, model%layout%free, .true., here%border, chords, error)
    if (allocated(error)) return
    if (here%border%basis%idle_constraints > 0) then
      call set_error(error, error_of_input, "the forces in links that hold the same pins "// &
        "cannot be told apart while too many of them are rigid", &
        body=body_of_redundancy(structure%linkage, 1))
      return
    end if
    here%loads = find_unit_loads(structure%linkage, pose, coefficients)
    call find_part_loads(structure%linkage, pose, here%loads, here%elastic, here%pose, &
      here%part_loads)
    call find_part_forces(structure%linkage, here%elastic, here%model%links, here%pose, &
      here%part_loads, here%border, chords, here%part_forces)
    do i = 1, case_count
      call take_part_reactions(structure%linkage, here%elastic, here%model%links, here%pose, &
        here%part_loads, here%border, here%part_forces, i, unit%of_case(i)%joints)
    end do
  end subroutine divide_by_elasticity

end module elastic_reactions
