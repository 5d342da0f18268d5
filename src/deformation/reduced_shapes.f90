!> Displacements along the links of a mode given in the own modes of the links.
module reduced_shapes
  use bordered_matrix, only: layout_t
  use deformation_places, only: displacement_row, rotation_row
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: normal_to
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  use reduced_assembly, only: first_axial
  implicit none (type, external)
  private

  public :: reduced_shape_point

contains

  !> Displacement of a point of a body: x, y and rotation, in global axes.
  pure function reduced_shape_point(links, layout, chords, pose, vector, body, &
    xi) result(displacement)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(layout_t), intent(in) :: layout       !! of these links
    type(chords_t), intent(in) :: chords       !! of this position
    type(pose_t), intent(in) :: pose           !! directions of the links
    real(wp), intent(in) :: vector(:)          !! (unknowns) [√J]
    integer, intent(in) :: body                !! its number
    real(wp), intent(in) :: xi                 !! from 0 at the body's first pin to 1 at its last
    real(wp) :: displacement(3)                !! [m, m, rad]

    real(wp) :: ends(3), axial_ends(2), own(0:links(body)%modes), across, along
    real(wp), allocatable :: unknown(:), row(:)
    integer :: first
    logical :: inside

    associate (link => links(body), border => vector(:layout%border), axis => pose%direction(:, &
      body))
      ends = matmul(chords%across(:, :, body), border)
      axial_ends = matmul(chords%along(:, :, body), border)
      across = (1.0_wp - xi)*ends(1) + xi*ends(2)
      along = (1.0_wp - xi)*axial_ends(1) + xi*axial_ends(2)
      displacement = [along*axis + across*normal_to(axis), dot_product(chords%turn(:, body), &
        border)]
      if (.not. link%bends) return
      first = layout%first(body)
      own(0) = ends(3)
      own(1:) = vector(first:first + link%modes - 1)
      unknown = matmul(link%bending, own)
      ! At its ends a link has no displacement of its own, and at the clamp no rotation: set
      ! exactly, without rounding.
      inside = xi > 0.0_wp .and. xi < 1.0_wp
      row = displacement_row(link%bending_shapes, xi)
      if (inside) across = across + dot_product(row(:size(unknown)), unknown)
      row = rotation_row(link%bending_shapes, xi)
      displacement(3) = displacement(3) + dot_product(row(:size(unknown)), unknown)
      if (link%clamped .and. xi <= 0.0_wp) displacement(3) = 0.0_wp
      if (link%coupled) then
        unknown = matmul(link%axial, own(1:))
      else
        first = first_axial(layout, links, body)
        unknown = matmul(link%axial, vector(first:first + link%axial_modes - 1))
      end if
      row = displacement_row(link%axial_shapes, xi)
      if (inside) along = along + dot_product(row(:size(unknown)), unknown)
      displacement(:2) = along*axis + across*normal_to(axis)
    end associate
  end function reduced_shape_point

end module reduced_shapes
