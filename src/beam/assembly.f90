!> Matrices and loads of the whole linkage.
module assembly
  use band_matrix, only: add_to_band, band_matrix_t, new_band_matrix
  use beam_element, only: element_geometric_stiffness, element_load, element_mass, element_stiffness, turned_to_global
  use beam_mesh, only: beam_mesh_t, beam_t, element_length
  use inertia_loads, only: lumped_stations, pin_load
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to
  use motions, only: acceleration_field_t, point_acceleration
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: assemble_stiffness, assemble_mass, assemble_geometric_stiffness, assemble_inertia_load

contains

  !> Elastic stiffness K of (2.88).
  pure function assemble_stiffness(linkage, beams, mesh, pose) result(stiffness)
    type(linkage_t), intent(in) :: linkage
    type(beam_t), intent(in) :: beams(:) !! (bodies)
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(band_matrix_t) :: stiffness

    real(wp) :: element(6, 6)
    integer :: body, i

    stiffness = new_band_matrix(mesh%unknowns, mesh%half_bandwidth)
    do body = 1, size(linkage%bodies)
      element = element_stiffness(beams(body)%axial_stiffness, beams(body)%bending_stiffness, element_length(mesh, linkage, body))
      element = turned_to_global(element, pose%direction(:, body))
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        call add_to_band(stiffness, element, mesh%unknown(:, i))
      end do
    end do
  end function assemble_stiffness

  !> Consistent mass M of (2.88), with the masses of the pins.
  pure function assemble_mass(linkage, mesh, pose) result(mass)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(band_matrix_t) :: mass

    real(wp) :: element(6, 6)
    integer :: body, i, pin

    mass = new_band_matrix(mesh%unknowns, mesh%half_bandwidth)
    do body = 1, size(linkage%bodies)
      element = element_mass(linkage%bodies(body)%line_density, element_length(mesh, linkage, body))
      element = turned_to_global(element, pose%direction(:, body))
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        call add_to_band(mass, element, mesh%unknown(:, i))
      end do
    end do
    do pin = 1, size(linkage%pin_mass)
      do i = 1, 2
        call add_to_band(mass, reshape([linkage%pin_mass(pin)], [1, 1]), mesh%pin_unknown(i:i, pin))
      end do
    end do
  end function assemble_mass

  !> Geometric stiffness of the axial forces: (2.84) in every element.
  pure function assemble_geometric_stiffness(linkage, mesh, pose, axial_force) result(stiffness)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: axial_force(0:, :) !! (0:2, elements) coefficients of 1, ξ, ξ² [N]
    type(band_matrix_t) :: stiffness

    integer :: body, i

    stiffness = new_band_matrix(mesh%unknowns, mesh%half_bandwidth)
    do body = 1, size(linkage%bodies)
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        call add_to_band(stiffness, turned_to_global( &
          element_geometric_stiffness(axial_force(:, i), element_length(mesh, linkage, body)), pose%direction(:, body)), &
          mesh%unknown(:, i))
      end do
    end do
  end function assemble_geometric_stiffness

  !> Inertia loads at the unknowns: forces on the nodes for lumped inertia, the consistent load for distributed.
  pure function assemble_inertia_load(linkage, mesh, pose, field, lumped) result(load)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    logical, intent(in) :: lumped
    real(wp), allocatable :: load(:) !! (unknowns) [N, N m]

    real(wp) :: pins(2, size(linkage%pin_mass))
    integer :: body, pin, i

    allocate (load(mesh%unknowns))
    load = 0.0_wp
    do body = 1, size(linkage%bodies)
      if (lumped) then
        call add_lumped_body(linkage, mesh, body, field, load)
      else
        call add_distributed_body(linkage, mesh, body, pose, field, load)
      end if
    end do
    pins = pin_load(linkage, field)
    do pin = 1, size(linkage%pin_mass)
      do i = 1, 2
        if (mesh%pin_unknown(i, pin) > 0) load(mesh%pin_unknown(i, pin)) = load(mesh%pin_unknown(i, pin)) + pins(i, pin)
      end do
    end do
  end function assemble_inertia_load

  pure subroutine add_lumped_body(linkage, mesh, body, field, load)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    integer, intent(in) :: body
    type(acceleration_field_t), intent(in) :: field
    real(wp), intent(inout) :: load(:)

    real(wp), allocatable :: stations(:)
    real(wp) :: force(6)
    integer :: i

    stations = lumped_stations(linkage%bodies(body), mesh%elements(body))
    do i = 1, mesh%elements(body)
      ! Each element brings the halves of its own mass to its two nodes.
      force = 0.0_wp
      force(1:2) = -0.5_wp*point_acceleration(field, body, stations(i))
      force(4:5) = -0.5_wp*point_acceleration(field, body, stations(i + 1))
      force = force*linkage%bodies(body)%line_density*element_length(mesh, linkage, body)
      call add_to_vector(load, force, mesh%unknown(:, mesh%first_element(body) + i - 1))
    end do
  end subroutine add_lumped_body

  pure subroutine add_distributed_body(linkage, mesh, body, pose, field, load)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    integer, intent(in) :: body
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    real(wp), intent(inout) :: load(:)

    real(wp) :: local(6), force(6), length, at_ends(2, 2)
    integer :: i, k

    length = element_length(mesh, linkage, body)
    associate (e => pose%direction(:, body), n => normal_to(pose%direction(:, body)))
      do i = 1, mesh%elements(body)
        do k = 1, 2
          at_ends(:, k) = -linkage%bodies(body)%line_density*point_acceleration(field, body, (i + k - 2)*length)
          at_ends(:, k) = [dot_product(e, at_ends(:, k)), dot_product(n, at_ends(:, k))]
        end do
        local = element_load(at_ends(:, 1), at_ends(:, 2), length)
        force = [local(1)*e + local(2)*n, local(3), local(4)*e + local(5)*n, local(6)]
        call add_to_vector(load, force, mesh%unknown(:, mesh%first_element(body) + i - 1))
      end do
    end associate
  end subroutine add_distributed_body

  pure subroutine add_to_vector(vector, small, unknown)
    real(wp), intent(inout) :: vector(:)
    real(wp), intent(in) :: small(:)
    integer, intent(in) :: unknown(:)

    integer :: i

    do i = 1, size(unknown)
      if (unknown(i) > 0) vector(unknown(i)) = vector(unknown(i)) + small(i)
    end do
  end subroutine add_to_vector

end module assembly
