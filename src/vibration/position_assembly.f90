!> Everything about a linkage at a position that its vibration needs, for a number of speeds.
module position_assembly
  use axial_limits, only: refuse_crushed
  use border_rows, only: damper_rows
  use bordered_matrix, only: new_bordered_layout
  use carried_bodies, only: add_carried_mass
  use deformation_model, only: deformation_model_t, renew_link
  use elastic_linkages, only: is_piece
  use elastic_positions, only: elastic_position_t, new_elastic_position
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use link_modes, only: rigid
  use linkages, only: drive_of_length
  use load_cases, only: find_unit_loads, unit_loads_t
  use mixed_positions, only: assemble_rest, find_mixed_forces, hold, mixed_position_t, &
    new_mixed_position, stiffen
  use part_displacements, only: border_size, border_t, find_part_chords
  use part_force_types, only: loaded_parts_t
  use part_forces, only: find_dyad_forces, find_part_forces
  use part_poses, only: find_part_loads, place_parts_of
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  use position_equations, only: assemble_mass, assemble_unit_loads, position_equations_t
  use positions, only: state_t
  use structures, only: find_structure_pose, has_many_parts, structure_t
  implicit none (type, external)
  private

  public :: assembled_t, new_assembled, assemble_position, choose_form, set_border, place_parts, &
    load_parts, load_mixed

  !> A linkage at a position, with its loads.
  type, extends(elastic_position_t) :: assembled_t
    type(unit_loads_t) :: loads                  !! of this pose
    real(wp), allocatable :: unit_force(:, :, :) !! (force functions, parts, cases) axial forces of
                                                 !! the unit loads [N]
    type(loaded_parts_t) :: loaded               !! what they do to its parts
    type(border_t), allocatable :: border        !! of few links
    type(mixed_position_t), allocatable :: mixed !! of many
    real(wp), allocatable :: damper_rows(:, :)   !! (border, dampers) velocity of each for unit
                                                 !! velocities of the border; only with dampers
  end type assembled_t

contains

  !> Storage for the positions of a model.
  pure function new_assembled(structure, model) result(here)
    class(structure_t), intent(in) :: structure     !! with beams
    type(deformation_model_t), intent(in) :: model !! of its parts
    type(assembled_t) :: here

    here%elastic_position_t = new_elastic_position(structure%elastic, model)
    if (model%mixed) then
      here%mixed = new_mixed_position(here%elastic_position_t)
    else
      allocate (here%border)
      allocate (here%border%primary(0))
    end if
  end function new_assembled

  !> Chooses the form of the equations of a model: mixed where there are many parts, and conditions
  !! that are independent of each other hold them at one of some positions; else with a border.
  subroutine choose_form(structure, modes, crank, model)
    class(structure_t), intent(in) :: structure         !! of parts
    integer, intent(in) :: modes                       !! wanted; 0: statics
    real(wp), intent(in) :: crank(:)                   !! of the first drive [deg] or [m]
    type(deformation_model_t), intent(inout) :: model  !! whose layout has no border yet

    type(assembled_t) :: here
    type(pose_t) :: pose
    type(error_t), allocatable :: error
    integer :: i

    model%mixed = has_many_parts(structure, modes)
    if (model%mixed) then
      here = new_assembled(structure, model)
      do i = 1, size(crank)
        call find_structure_pose(structure, crank(i), pose, error)
        if (allocated(error)) cycle
        call place_parts(structure, model, pose, here, error)
        if (allocated(error)) cycle
        call assemble_rest(here%elastic_position_t, here%mixed)
        call hold(here%pose, here%mixed, error)
        if (.not. allocated(error)) return
      end do
      model%mixed = .false.
    end if
    call set_border(structure, crank, model)
  end subroutine choose_form

  !> Gives a model the border of its linkage, as it is at most of some positions. That of closed
  !! forms is as the model has it.
  subroutine set_border(structure, crank, model)
    class(structure_t), intent(in) :: structure         !! of parts
    real(wp), intent(in) :: crank(:)                   !! of the first drive [deg] or [m]
    type(deformation_model_t), intent(inout) :: model  !! whose layout has no border yet

    type(assembled_t) :: here
    type(pose_t) :: pose
    type(error_t), allocatable :: error
    integer :: i, unknowns, free, least

    if (structure%elastic%in_closed_form) return
    here = new_assembled(structure, model)
    least = huge(least)
    do i = 1, size(crank)
      call find_structure_pose(structure, crank(i), pose, error)
      if (allocated(error)) cycle
      call place_parts(structure, model, pose, here, error)
      if (allocated(error)) cycle
      call border_size(here%elastic_position_t, unknowns, free)
      if (free >= least) cycle
      least = free
      model%layout = new_bordered_layout(unknowns, model%links%modes, model%links%axial_modes, free)
    end do
  end subroutine set_border

  !> Assembles a position: displacements of points, M, and K_G of every unit load that occurs at any
  !! of the speeds.
  !!
  !! Errors, speed by speed in `outcome`: a block is at an end of the part that it slides along; the
  !! linkage has other free motions than elsewhere; a link has no own modes; a link is compressed by
  !! more than its shear stiffness.
  subroutine assemble_position(structure, model, state, factor, equations, here, outcome, counts)
    class(structure_t), intent(in) :: structure                  !! with beams
    type(deformation_model_t), intent(in) :: model              !! of its parts
    type(state_t), intent(in) :: state            !! with a pose away from dead points
    real(wp), intent(in) :: factor(:, :)          !! (cases, speeds) of the unit loads: ω2², α2, 1
    type(position_equations_t), intent(inout) :: equations      !! of this model
    type(assembled_t), intent(inout) :: here                    !! of this model
    type(outcome_t), intent(inout) :: outcome(:)                !! (speeds) errors are kept
    type(ledger_t), intent(inout) :: counts                     !! of the work done

    type(error_t), allocatable :: error
    integer :: i

    here%loads = find_unit_loads(structure%linkage, state%pose, state%coefficients, &
      any(abs(factor) > 0.0_wp, dim=2))
    if (allocated(here%mixed)) then
      call load_mixed(structure, model, state%pose, .true., here, error)
    else
      call load_parts(structure, model, state%pose, here, equations%chords, error)
    end if
    if (allocated(error)) then
      do i = 1, size(outcome)
        if (.not. allocated(outcome(i)%error)) outcome(i)%error = error
      end do
      return
    end if
    if (size(here%elastic%dampers) > 0) here%damper_rows = &
      matmul(transpose(here%border%basis%unknown), damper_rows(here%elastic_position_t))
    here%unit_force = here%loaded%forces%axial
    call refuse_crushed(here%elastic%linkage, here%model, here%unit_force, factor, outcome)
    do i = 1, size(outcome)
      if (.not. allocated(outcome(i)%error)) cycle
      associate (body => outcome(i)%error%place%body)
        if (body > 0) body = here%elastic%body(body)
      end associate
    end do
    counts%mass_matrices = counts%mass_matrices + 1
    if (allocated(here%mixed)) then
      counts%geometric_matrices = counts%geometric_matrices + count(here%loads%occurs)
      return
    end if
    call assemble_mass(here%elastic%linkage, here%model, equations)
    call add_carried_mass(here%elastic, here%pose, equations%chords, equations%pencil%mass%border)
    call assemble_unit_loads(here%model, here%unit_force, factor, equations, counts, &
      here%loaded%forces%second_order)
  end subroutine assemble_position

  !> Places the parts, and finds what the border unknowns do to them and the forces in them.
  !!
  !! Errors: those of `place_parts` and `find_part_chords`.
  subroutine load_parts(structure, model, pose, here, chords, error)
    class(structure_t), intent(in) :: structure      !! with parts
    type(deformation_model_t), intent(in) :: model   !! of these, with a border
    type(pose_t), intent(in) :: pose                 !! of the linkage that moves
    type(assembled_t), intent(inout) :: here         !! of this model, with the loads of this pose
    type(chords_t), intent(inout) :: chords          !! of the border unknowns
    type(error_t), allocatable, intent(out) :: error

    call place_parts(structure, model, pose, here, error)
    if (allocated(error)) return
    call find_part_chords(here%elastic_position_t, any(here%loads%occurs), here%border, chords, &
      error)
    if (allocated(error)) return
    if (any(here%loads%occurs) .or. .not. here%elastic%in_closed_form) call find_part_loads( &
      structure%linkage, pose, here%loads, here%elastic_position_t, here%loaded%loads)
    if (here%elastic%in_closed_form) then
      call find_dyad_forces(structure%linkage, pose, here%loads, here%model%links, chords, &
        here%loaded%forces)
      return
    end if
    call find_part_forces(here%elastic_position_t, here%border, chords, here%loaded)
  end subroutine load_parts

  !> Places the parts, and finds their matrices and forces in mixed form, and K_G if it is asked
  !! for; without loads K is not factorized for that.
  !!
  !! Errors: those of `place_parts` and `hold`.
  subroutine load_mixed(structure, model, pose, with_stiffness, here, error)
    class(structure_t), intent(in) :: structure      !! with parts
    type(deformation_model_t), intent(in) :: model   !! of these, in mixed form
    type(pose_t), intent(in) :: pose                 !! of the linkage that moves
    logical, intent(in) :: with_stiffness
    type(assembled_t), intent(inout) :: here         !! of this model, with the loads of this pose
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: solution(:, :)

    call place_parts(structure, model, pose, here, error)
    if (allocated(error)) return
    associate (at => here%elastic_position_t, mixed => here%mixed)
      call find_part_loads(structure%linkage, pose, here%loads, at, here%loaded%loads)
      call assemble_rest(at, mixed)
      if (any(here%loads%occurs) .or. .not. with_stiffness) call hold(here%pose, mixed, error)
      if (allocated(error)) return
      call find_mixed_forces(at, mixed, here%loaded, solution)
      call move_alloc(solution, mixed%solution)
      if (with_stiffness) call stiffen(at, here%loaded, mixed)
    end associate
  end subroutine load_mixed

  !> Places the parts, and renews the own modes of those whose lengths have changed, and the lengths
  !! of rams.
  !!
  !! Errors: those of `place_parts_of`; a link has no own modes.
  subroutine place_parts(structure, model, pose, here, error)
    class(structure_t), intent(in) :: structure      !! with parts
    type(deformation_model_t), intent(in) :: model   !! of these
    type(pose_t), intent(in) :: pose                 !! of the linkage that moves
    type(assembled_t), intent(inout) :: here         !! of this model
    type(error_t), allocatable, intent(out) :: error

    integer :: i, part

    call place_parts_of(structure%linkage, pose, here%elastic, here%pose, error)
    if (allocated(error)) return
    do i = 1, size(structure%linkage%drives)
      if (structure%linkage%drives(i)%kind /= drive_of_length) cycle
      part = findloc(here%elastic%body, structure%linkage%drives(i)%body, dim=1)
      associate (ram => here%model%links(part))
        ram%length = here%elastic%linkage%bodies(part)%length
        ram%geometric(rigid, rigid, 1) = ram%length
      end associate
    end do
    do part = 1, size(here%elastic%body)
      if (.not. is_piece(here%elastic, part)) cycle
      call renew_link(model, part, here%elastic%linkage%bodies(part), here%elastic%beams(part), &
        here%elastic%held(:, part), here%model%links(part), error)
      if (allocated(error)) return
    end do
  end subroutine place_parts

end module position_assembly
