!> Displacements along the links, from the unknowns of their elements.
module deflected_shape
  use beam_element, only: element_unknowns, interpolate
  use beam_mesh, only: beam_mesh_t, element_length
  use element_axes, only: to_local
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: shape_point

contains

  !> Displacement of the point of a body at distance `s` from its first pin, in global axes: x and
  !! y [m], rotation [rad].
  pure function shape_point(linkage, mesh, pose, vector, body, s) result(displacement)
    type(linkage_t), intent(in) :: linkage !! lengths of its bodies
    type(beam_mesh_t), intent(in) :: mesh  !! elements and unknowns
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    real(wp), intent(in) :: vector(:)      !! (unknowns) of the mesh
    integer, intent(in) :: body            !! number, from 1
    real(wp), intent(in) :: s              !! [m]
    real(wp) :: displacement(3)

    real(wp) :: local(3), length, position
    integer :: i

    length = element_length(mesh, linkage, body)
    position = s/length
    i = max(1, min(mesh%elements(body), 1 + int(position)))
    associate (e => pose%direction(:, body))
      local = interpolate(mesh%order(body), to_local(element_vector(mesh, vector, body, i), e), &
        length, position - (i - 1))
      displacement = [local(1)*e + local(2)*normal_to(e), local(3)]
    end associate
  end function shape_point

  !> Unknowns of the i-th element of a body; held ones are zero.
  pure function element_vector(mesh, vector, body, i) result(values)
    type(beam_mesh_t), intent(in) :: mesh
    real(wp), intent(in) :: vector(:)
    integer, intent(in) :: body, i
    real(wp) :: values(element_unknowns(mesh%order(body), mesh%sheared))

    integer :: k

    values = 0.0_wp
    associate (unknown => mesh%unknown(:size(values), mesh%first_element(body) + i - 1))
      do k = 1, size(values)
        if (unknown(k) > 0) values(k) = vector(unknown(k))
      end do
    end associate
  end function element_vector

end module deflected_shape
