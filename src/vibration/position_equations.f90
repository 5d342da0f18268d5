! src/vibration/ - vibrations of the structure at a position: equations, frequencies, errors.
! In: a structure, its `vibration_models_t`, a state. Out: a `position_result_t`; of all positions a
! `sweep_t`. Begin with `solve_position` in `position_solver.f90`: `assemble_position` in
! `position_assembly.f90` gives M and K_G, `solve_speeds` in `speed_solver.f90` the modes. Forces
! that statics cannot divide: `divide_by_elasticity` in `elastic_reactions.f90`.
! Not here: orders (`src/vibration/models`), rounding (`src/vibration/rounding`), eigensolvers
! (`src/eigen`), equations over a turn (`src/response/turn`).

!> The equations of motion of a structure at a position, in its links' own deformations.
!!
!! `M ÿ + (I + K_G) y = 0` with `K_G = K_const + ω2² K_ω + α2 K_α`: the mass matrix and the three
!! unit matrices of the geometric stiffness are found once per position and hold for every speed.
!! The equations over a turn, with velocity terms, damping and loads, are those of `turn_grids` and
!! `elastic_equations`.
module position_equations
  use bordered_matrix, only: add_scaled, bordered_matrix_t
  use bordered_pencil, only: bordered_pencil_t, new_bordered_pencil
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use linkages, only: linkage_t
  use load_cases, only: case_count
  use pin_displacements, only: chords_t, find_chords
  use poses, only: pose_t
  use reduced_assembly, only: reduced_geometric_stiffness, reduced_mass
  implicit none (type, external)
  private

  public :: position_equations_t, new_position_equations
  public :: assemble_equations, assemble_mass_at, assemble_mass, assemble_unit_loads, &
    set_speed

  !> Allocated once for a model, filled at every position.
  type :: position_equations_t
    type(chords_t) :: chords                 !! motion of pins and chords due to the border unknowns
    type(bordered_pencil_t) :: pencil        !! M, and K_G at one speed
    type(bordered_matrix_t) :: unit_stiffness(case_count) !! K_G of each unit load [-]
    logical :: occurs(case_count) = .false.  !! unit loads whose matrices belong to this position
  end type position_equations_t

contains

  !> Storage for the equations of a model.
  pure function new_position_equations(model) result(equations)
    type(deformation_model_t), intent(in) :: model !! gives the size of the matrices
    type(position_equations_t) :: equations        !! empty of one in mixed form

    integer :: i

    if (model%mixed) return
    equations%pencil = new_bordered_pencil(model%layout)
    do i = 1, case_count
      equations%unit_stiffness(i) = equations%pencil%geometric
    end do
  end function new_position_equations

  !> Assembles everything that a position needs for a number of speeds: chords, M, and K_G of every
  !! unit load that occurs at any of them.
  pure subroutine assemble_equations(linkage, model, pose, unit_force, factor, equations, counts)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_model_t), intent(in) :: model !! its links' own deformations
    type(pose_t), intent(in) :: pose               !! away from dead points
    real(wp), intent(in) :: unit_force(:, :, :)    !! (force functions, bodies, cases) axial forces
                                                   !! of the unit loads [N]; no functions: no loads
    real(wp), intent(in) :: factor(:, :)           !! (cases, speeds) of the unit loads: ω2², α2, 1
    type(position_equations_t), intent(inout) :: equations !! of this model
    type(ledger_t), intent(inout) :: counts        !! of matrices assembled

    call assemble_mass_at(linkage, model, pose, equations)
    counts%mass_matrices = counts%mass_matrices + 1
    call assemble_unit_loads(model, unit_force, factor, equations, counts)
  end subroutine assemble_equations

  !> Assembles K_G of every unit load that occurs at any speed.
  pure subroutine assemble_unit_loads(model, unit_force, factor, equations, counts, second_order)
    type(deformation_model_t), intent(in) :: model !! its links' own deformations
    real(wp), intent(in) :: unit_force(:, :, :)    !! as of `assemble_equations`
    real(wp), intent(in) :: factor(:, :)           !! (cases, speeds) of the unit loads: ω2², α2, 1
    type(position_equations_t), intent(inout) :: equations !! with the chords of this position
    type(ledger_t), intent(inout) :: counts        !! of matrices assembled
    real(wp), intent(in), optional :: second_order(:, :, :) !! (border, border, cases) what is added
                                                   !! between border unknowns [-]; absent: nothing

    integer :: i

    do i = 1, case_count
      equations%occurs(i) = size(unit_force, 1) > 0 .and. any(abs(factor(i, :)) > 0.0_wp)
      if (.not. equations%occurs(i)) cycle
      call reduced_geometric_stiffness(model%links, model%layout, equations%chords, &
        unit_force(:, :, i), equations%unit_stiffness(i))
      if (present(second_order)) equations%unit_stiffness(i)%border = &
        equations%unit_stiffness(i)%border + second_order(:, :, i)
      counts%geometric_matrices = counts%geometric_matrices + 1
    end do
  end subroutine assemble_unit_loads

  !> Assembles chords and mass matrix at a pose, for a structure without loads.
  pure subroutine assemble_mass_at(linkage, model, pose, equations)
    type(linkage_t), intent(in) :: linkage                 !! of the structure
    type(deformation_model_t), intent(in) :: model         !! its links' own deformations
    type(pose_t), intent(in) :: pose                       !! away from dead points
    type(position_equations_t), intent(inout) :: equations !! of this model

    equations%chords = find_chords(linkage, model%links, pose)
    call assemble_mass(linkage, model, equations)
  end subroutine assemble_mass_at

  !> Assembles the mass matrix from the chords of a position, for a structure without loads.
  pure subroutine assemble_mass(linkage, model, equations)
    type(linkage_t), intent(in) :: linkage                 !! of the structure
    type(deformation_model_t), intent(in) :: model         !! its links' own deformations
    type(position_equations_t), intent(inout) :: equations !! of this model, with chords

    call reduced_mass(linkage, model%links, model%layout, equations%chords, equations%pencil%mass)
    equations%occurs = .false.
    equations%pencil%loaded = .false.
  end subroutine assemble_mass

  !> Sets K_G of a speed from the unit matrices: `K_G = K_const + ω2² K_ω + α2 K_α`.
  pure subroutine set_speed(equations, factor)
    type(position_equations_t), intent(inout) :: equations !! assembled at this position
    real(wp), intent(in) :: factor(case_count)             !! of the unit loads: ω2², α2, 1

    integer :: i

    equations%pencil%loaded = any(equations%occurs .and. abs(factor) > 0.0_wp)
    if (.not. equations%pencil%loaded) return
    associate (geometric => equations%pencil%geometric)
      geometric%border = 0.0_wp
      geometric%coupling = 0.0_wp
      geometric%block = 0.0_wp
      do i = 1, case_count
        if (abs(factor(i)) > 0.0_wp) call add_scaled(geometric, factor(i), &
          equations%unit_stiffness(i))
      end do
      ! Loads that no part of the linkage feels leave free motions free.
      equations%pencil%loaded = any(abs(geometric%border) > 0.0_wp) .or. &
        any(abs(geometric%coupling) > 0.0_wp) .or. any(abs(geometric%block) > 0.0_wp)
    end associate
  end subroutine set_speed

end module position_equations
