!> The frequencies of the instantaneous structure at one position, for all speeds.
module position_modes
  use assembly, only: assemble_geometric_stiffness, assemble_mass, assemble_stiffness
  use axial_forces, only: distributed_axial_forces, lumped_axial_forces
  use band_matrix, only: band_matrix_t
  use beam_mesh, only: beam_mesh_t
  use errors, only: error_t
  use inertia_loads, only: distributed_load, load_t, lumped_load, pin_load
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use mechanisms, only: mechanism_t
  use modes, only: find_modes, modes_t
  use motions, only: acceleration_field_t, find_motion, motion_t, unit_fields
  use poses, only: find_pose, pose_t
  use round_off, only: round_off_error
  use text, only: string_t
  implicit none (type, external)
  private

  public :: mode_request_t, position_result_t, solve_position, lowest_static_eigenvalue

  !> What is wanted at every position.
  type :: mode_request_t
    integer :: modes = 3
    logical :: axial = .false.         !! with the geometric stiffness of the inertia loads
    logical :: lumped = .true.         !! inertia loads on the nodes, or along the links
    logical :: dense = .true.
    real(wp), allocatable :: speed(:)  !! [rad/s]; static: one value, which has no effect
    real(wp) :: acceleration = 0.0_wp  !! [rad/s²]
  end type mode_request_t

  !> What was found there.
  type :: position_result_t
    real(wp), allocatable :: lambda(:, :)      !! (modes, speeds) ω² [1/s²]
    type(modes_t), allocatable :: modes(:)     !! (speeds); their vectors only if wanted
    type(string_t), allocatable :: failure(:)  !! (speeds) empty, or why there is no result
    real(wp), allocatable :: deflection(:, :)  !! (bodies, speeds) largest static deflection under the loads, of the length [-]
    integer :: geometric_stiffnesses = 0       !! assembled
    integer :: factorizations = 0
    integer :: solutions = 0                   !! eigenproblems solved
  end type position_result_t

contains

  !> Solves (2.88) at a pose for every speed, with or without the axial forces of the motion.
  !!
  !! Matrices are assembled once; the geometric stiffness is made of two unit matrices, one for ω2² and one for α2.
  subroutine solve_position(mechanism, pose, motion, request, want_vectors, result)
    type(mechanism_t), intent(in) :: mechanism
    type(pose_t), intent(in) :: pose
    type(motion_t), intent(in) :: motion
    type(mode_request_t), intent(in) :: request
    logical, intent(in) :: want_vectors(:) !! (speeds)
    type(position_result_t), intent(out) :: result

    type(band_matrix_t) :: stiffness, mass, total, unit_stiffness(2)
    type(error_t), allocatable :: error
    real(wp) :: factor(2)
    integer :: k
    logical :: loaded(2)

    allocate (result%lambda(request%modes, size(request%speed)), result%modes(size(request%speed)))
    allocate (result%failure(size(request%speed)), result%deflection(size(mechanism%linkage%bodies), size(request%speed)))
    result%lambda = 0.0_wp
    result%deflection = 0.0_wp
    stiffness = assemble_stiffness(mechanism%linkage, mechanism%beams, mechanism%mesh, pose)
    mass = assemble_mass(mechanism%linkage, mechanism%mesh, pose)
    loaded = request%axial .and. [any(abs(request%speed) > 0.0_wp), abs(request%acceleration) > 0.0_wp]
    if (any(loaded)) call load_position(mechanism, pose, motion, request, loaded, unit_stiffness, result)

    do k = 1, size(request%speed)
      result%failure(k)%text = ""
      factor = [request%speed(k)**2, request%acceleration]
      total = stiffness
      if (loaded(1) .and. factor(1) > 0.0_wp) total%entry = total%entry + factor(1)*unit_stiffness(1)%entry
      if (loaded(2)) total%entry = total%entry + factor(2)*unit_stiffness(2)%entry
      call find_modes(total, mass, request%modes, request%dense, .not. (loaded(2) .or. (loaded(1) .and. factor(1) > 0.0_wp)), &
        round_off_error(mechanism%linkage, mechanism%beams, mechanism%mesh), want_vectors(k), result%modes(k), error)
      result%solutions = result%solutions + 1
      result%factorizations = result%factorizations + result%modes(k)%factorizations
      if (allocated(error)) then
        result%failure(k)%text = error%message
      else
        result%lambda(:, k) = result%modes(k)%lambda
      end if
    end do
  end subroutine solve_position

  !> Geometric stiffness of the unit loads: ω2² = 1 and α2 = 1.
  subroutine load_position(mechanism, pose, motion, request, loaded, unit_stiffness, result)
    type(mechanism_t), intent(in) :: mechanism
    type(pose_t), intent(in) :: pose
    type(motion_t), intent(in) :: motion
    type(mode_request_t), intent(in) :: request
    logical, intent(in) :: loaded(2) !! which of the two loads occur
    type(band_matrix_t), intent(out) :: unit_stiffness(2)
    type(position_result_t), intent(inout) :: result

    type(acceleration_field_t) :: fields(2)
    integer :: i

    fields = unit_fields(mechanism%linkage, pose, motion)
    do i = 1, 2
      if (.not. loaded(i)) cycle
      unit_stiffness(i) = assemble_geometric_stiffness(mechanism%linkage, mechanism%mesh, pose, &
        unit_axial_forces(mechanism%linkage, mechanism%mesh, pose, fields(i), request%lumped))
      result%geometric_stiffnesses = result%geometric_stiffnesses + 1
    end do
  end subroutine load_position

  !> Axial forces in all elements under the inertia loads of an acceleration field.
  pure function unit_axial_forces(linkage, mesh, pose, field, lumped) result(force)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    logical, intent(in) :: lumped
    real(wp), allocatable :: force(:, :) !! (0:2, elements) coefficients of 1, ξ, ξ² [N]

    type(load_t) :: loads(size(linkage%bodies))
    type(joint_forces_t) :: joints
    integer :: i

    do i = 1, size(loads)
      if (lumped) then
        loads(i) = lumped_load(linkage%bodies(i), i, mesh%elements(i), pose, field)
      else
        loads(i) = distributed_load(linkage%bodies(i), i, pose, field)
      end if
    end do
    joints = find_joint_forces(linkage, pose, loads, pin_load(linkage, field))
    if (lumped) then
      force = lumped_axial_forces(linkage, mesh, pose, field, joints)
    else
      force = distributed_axial_forces(linkage, mesh, pose, field, joints)
    end if
  end function unit_axial_forces

  !> The lowest ω² of the unloaded structure at a crank angle [1/s²]: huge at a dead point, 0 where no digit of it can be found.
  function lowest_static_eigenvalue(mechanism, crank_degrees) result(lambda)
    type(mechanism_t), intent(in) :: mechanism
    real(wp), intent(in) :: crank_degrees
    real(wp) :: lambda

    type(pose_t) :: pose
    type(mode_request_t) :: request
    type(position_result_t) :: result
    type(error_t), allocatable :: error

    lambda = huge(lambda)
    call find_pose(mechanism%linkage, crank_degrees, pose, error)
    if (allocated(error)) return
    request%modes = 1
    request%speed = [0.0_wp]
    call solve_position(mechanism, pose, find_motion(mechanism%linkage, pose), request, [.false.], result)
    ! Even where its checks fail, the value is the best there is; where there is none, nothing can be vouched for.
    lambda = 0.0_wp
    if (allocated(result%modes(1)%lambda)) lambda = max(0.0_wp, result%modes(1)%lambda(1))
  end function lowest_static_eigenvalue

end module position_modes
