!> Stiffness, mass and geometric stiffness matrices of the whole linkage, assembled from nodal beam
!! elements.
module assembly
  use band_matrix, only: add_to_band, band_matrix_t, new_band_matrix
  use beam_element, only: element_geometric_stiffness, element_mass, element_stiffness
  use beam_mesh, only: beam_mesh_t, beam_t, element_length
  use body_lumps, only: element_of_lump, lump_inertias, lump_masses, lump_offsets, lump_places
  use element_axes, only: turned_to_global
  use element_places, only: element_point_mass, element_point_rotation, element_stiffness_to
  use kinds, only: wp
  use linkages, only: linkage_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: assemble_stiffness, assemble_mass, assemble_geometric_stiffness, add_axial_jumps, &
    add_turning_forces

contains

  !> Elastic stiffness K of Ulker 2010 (2.88), from the element matrices of (2.79).
  pure function assemble_stiffness(linkage, beams, mesh, pose) result(stiffness)
    type(linkage_t), intent(in) :: linkage !! lengths of its bodies
    type(beam_t), intent(in) :: beams(:)   !! (bodies) stiffnesses
    type(beam_mesh_t), intent(in) :: mesh  !! elements and unknowns
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    type(band_matrix_t) :: stiffness

    real(wp), allocatable :: element(:, :)
    integer :: body, i

    stiffness = new_band_matrix(mesh%unknowns, mesh%half_bandwidth)
    do body = 1, size(linkage%bodies)
      element = turned_to_global(element_stiffness(mesh%reference(body), &
        beams(body)%axial_stiffness, beams(body)%bending_stiffness, element_length(mesh, linkage, &
        body), beams(body)%shear_stiffness), pose%direction(:, body))
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        call add_to_band(stiffness, element, mesh%unknown(:size(element, 1), i))
      end do
    end do
  end function assemble_stiffness

  !> Consistent mass M of Ulker 2010 (2.88), including the masses of the pins and those along the
  !! links.
  pure function assemble_mass(linkage, mesh, pose) result(mass)
    type(linkage_t), intent(in) :: linkage !! masses of bodies, lumps and pins
    type(beam_mesh_t), intent(in) :: mesh  !! elements and unknowns
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    type(band_matrix_t) :: mass

    real(wp), allocatable :: element(:, :)
    integer :: body, i, pin

    mass = new_band_matrix(mesh%unknowns, mesh%half_bandwidth)
    do body = 1, size(linkage%bodies)
      element = turned_to_global(element_mass(mesh%reference(body), &
        linkage%bodies(body)%line_density, element_length(mesh, linkage, body), &
        linkage%bodies(body)%rotary_inertia), pose%direction(:, body))
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        call add_to_band(mass, element, mesh%unknown(:size(element, 1), i))
      end do
      call add_lump_masses(linkage, mesh, pose, body, mass)
    end do
    do pin = 1, size(linkage%pin_mass)
      do i = 1, 2
        call add_to_band(mass, reshape([linkage%pin_mass(pin)], [1, 1]), mesh%pin_unknown(i:i, pin))
      end do
    end do
  end function assemble_mass

  !> Adds `m NᵀN` of every mass fixed to a link, at its place in its element, and the inertia of its
  !! rotation.
  pure subroutine add_lump_masses(linkage, mesh, pose, body, mass)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: body
    type(band_matrix_t), intent(inout) :: mass

    real(wp), allocatable :: lump(:), xi(:), offset(:), inertia(:), element(:, :)
    real(wp) :: place
    integer :: i, number

    lump = lump_masses(linkage%bodies(body))
    xi = lump_places(linkage%bodies(body))
    offset = lump_offsets(linkage%bodies(body))
    inertia = lump_inertias(linkage%bodies(body))
    do i = 1, size(lump)
      call element_of_lump(xi(i), mesh%elements(body), number, place)
      element = lump(i)*element_point_mass(mesh%reference(body), element_length(mesh, linkage, &
        body), place, offset(i))
      if (inertia(i) > 0.0_wp) element = element + &
        inertia(i)*element_point_rotation(mesh%reference(body), element_length(mesh, linkage, &
        body), place)
      element = turned_to_global(element, pose%direction(:, body))
      call add_to_band(mass, element, mesh%unknown(:size(element, 1), &
        mesh%first_element(body) + number - 1))
    end do
  end subroutine add_lump_masses

  !> Geometric stiffness of the axial forces: Ulker 2010 (2.84) in every element, generalized to
  !! forces that vary along it.
  pure function assemble_geometric_stiffness(linkage, mesh, pose, axial_force) result(stiffness)
    type(linkage_t), intent(in) :: linkage     !! lengths of its bodies
    type(beam_mesh_t), intent(in) :: mesh      !! elements and unknowns
    type(pose_t), intent(in) :: pose           !! directions of the bodies
    real(wp), intent(in) :: axial_force(0:, :) !! (0:2, elements) coefficients of 1, ξ, ξ² [N]
    type(band_matrix_t) :: stiffness

    real(wp), allocatable :: element(:, :)
    integer :: body, i

    stiffness = new_band_matrix(mesh%unknowns, mesh%half_bandwidth)
    do body = 1, size(linkage%bodies)
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        element = turned_to_global(element_geometric_stiffness(mesh%reference(body), &
          axial_force(:, i), element_length(mesh, linkage, body)), pose%direction(:, body))
        call add_to_band(stiffness, element, mesh%unknown(:size(element, 1), i))
      end do
    end do
  end function assemble_geometric_stiffness

  !> Adds the geometric stiffness of constant axial forces, each acting from the first pin of a body
  !! up to one of the masses along it.
  pure subroutine add_axial_jumps(linkage, mesh, pose, body, jump, stiffness)
    type(linkage_t), intent(in) :: linkage          !! lengths and lumps of its bodies
    type(beam_mesh_t), intent(in) :: mesh           !! elements and unknowns
    type(pose_t), intent(in) :: pose                !! directions of the bodies
    integer, intent(in) :: body                     !! number, from 1
    real(wp), intent(in) :: jump(:)                 !! (lumps) tension positive [N]
    type(band_matrix_t), intent(inout) :: stiffness !! to add to

    real(wp), allocatable :: xi(:), element(:, :)
    real(wp) :: place
    integer :: i, k, number

    xi = lump_places(linkage%bodies(body))
    do i = 1, size(jump)
      call element_of_lump(xi(i), mesh%elements(body), number, place)
      do k = 1, number
        element = turned_to_global(jump(i)*element_stiffness_to(mesh%reference(body), &
          element_length(mesh, linkage, body), merge(place, 1.0_wp, k == number)), &
          pose%direction(:, body))
        call add_to_band(stiffness, element, mesh%unknown(:size(element, 1), &
          mesh%first_element(body) + k - 1))
      end do
    end do
  end subroutine add_axial_jumps

  !> Adds the geometric stiffness of the loads on masses that turn with cross-sections of a link.
  pure subroutine add_turning_forces(linkage, mesh, pose, body, force, stiffness)
    type(linkage_t), intent(in) :: linkage          !! lengths and lumps of its bodies
    type(beam_mesh_t), intent(in) :: mesh           !! elements and unknowns
    type(pose_t), intent(in) :: pose                !! directions of the bodies
    integer, intent(in) :: body                     !! number, from 1
    real(wp), intent(in) :: force(:)                !! (lumps) of `turning_forces` [N]
    type(band_matrix_t), intent(inout) :: stiffness !! to add to

    real(wp), allocatable :: xi(:), element(:, :)
    real(wp) :: place
    integer :: i, number

    xi = lump_places(linkage%bodies(body))
    do i = 1, size(force)
      if (abs(force(i)) <= 0.0_wp) cycle
      call element_of_lump(xi(i), mesh%elements(body), number, place)
      element = turned_to_global(force(i)*linkage%bodies(body)%length* &
        element_point_rotation(mesh%reference(body), element_length(mesh, linkage, body), place), &
        pose%direction(:, body))
      call add_to_band(stiffness, element, mesh%unknown(:size(element, 1), &
        mesh%first_element(body) + number - 1))
    end do
  end subroutine add_turning_forces

end module assembly
