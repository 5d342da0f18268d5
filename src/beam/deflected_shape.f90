!> Displacements along the links, from the displacements of the nodes.
module deflected_shape
  use beam_element, only: interpolate, to_local
  use beam_mesh, only: beam_mesh_t, element_length
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: shape_point, mid_link_sign, largest_displacement

contains

  !> Displacement of the point of a body at distance `s` from its first pin: x, y and rotation, in global axes.
  pure function shape_point(linkage, mesh, pose, vector, body, s) result(displacement)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: vector(:) !! (unknowns)
    integer, intent(in) :: body
    real(wp), intent(in) :: s         !! [m]
    real(wp) :: displacement(3)

    real(wp) :: local(3), length, position
    integer :: i

    length = element_length(mesh, linkage, body)
    position = s/length
    i = max(1, min(mesh%elements(body), 1 + int(position)))
    associate (e => pose%direction(:, body))
      local = interpolate(to_local(element_vector(mesh, vector, mesh%first_element(body) + i - 1), e), length, position - (i - 1))
      displacement = [local(1)*e + local(2)*normal_to(e), local(3)]
    end associate
  end function shape_point

  !> Displacements of the two nodes of an element; those that are held are zero.
  pure function element_vector(mesh, vector, element) result(nodal)
    type(beam_mesh_t), intent(in) :: mesh
    real(wp), intent(in) :: vector(:)
    integer, intent(in) :: element
    real(wp) :: nodal(6)

    integer :: i

    nodal = 0.0_wp
    do i = 1, 6
      if (mesh%unknown(i, element) > 0) nodal(i) = vector(mesh%unknown(i, element))
    end do
  end function element_vector

  !> The sign that makes the largest transverse displacement at mid-link positive, in that link's own axes (those of its angle).
  !!
  !! Displacements equal within 1e-9 of the largest are ties, and the first of these links round the loop decides.
  pure function mid_link_sign(linkage, mesh, pose, vector) result(sign_of_mode)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: vector(:) !! (unknowns)
    real(wp) :: sign_of_mode

    real(wp), parameter :: tie = 1.0e-9_wp
    real(wp) :: across(size(linkage%bodies)), displacement(3)
    integer :: body

    do body = 1, size(linkage%bodies)
      displacement = shape_point(linkage, mesh, pose, vector, body, 0.5_wp*linkage%bodies(body)%length)
      across(body) = linkage%bodies(body)%sense*dot_product(normal_to(pose%direction(:, body)), displacement(:2))
    end do
    body = findloc(abs(across) >= (1.0_wp - tie)*maxval(abs(across)), .true., dim=1)
    sign_of_mode = sign(1.0_wp, across(body))
  end function mid_link_sign

  !> Largest displacement of a node of each body, compared with the body's length [-].
  pure function largest_displacement(linkage, mesh, vector) result(ratio)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    real(wp), intent(in) :: vector(:) !! (unknowns) [m, rad]
    real(wp) :: ratio(size(linkage%bodies))

    real(wp) :: nodal(6)
    integer :: body, i

    ratio = 0.0_wp
    do body = 1, size(linkage%bodies)
      do i = mesh%first_element(body), mesh%first_element(body) + mesh%elements(body) - 1
        nodal = element_vector(mesh, vector, i)
        ratio(body) = max(ratio(body), norm2(nodal(1:2)), norm2(nodal(4:5)))
      end do
    end do
    ratio = ratio/linkage%bodies%length
  end function largest_displacement

end module deflected_shape
