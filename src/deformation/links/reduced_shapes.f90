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

    real(wp) :: ends(size(chords%across, 1)), axial_ends(2), &
      own(1 - links(body)%curves:links(body)%modes), across, along
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
      own(:0) = ends(3:2 + link%curves)
      own(1:) = vector(first:first + link%modes - 1)
      unknown = matmul(link%bending, own)
      ! At its ends a link has no displacement of its own: set exactly, without rounding.
      inside = xi > 0.0_wp .and. xi < 1.0_wp
      row = displacement_row(link%bending_shapes, xi)
      if (inside) across = across + dot_product(row(:size(unknown)), unknown)
      row = rotation_row(link%bending_shapes, xi)
      displacement(3) = displacement(3) + dot_product(row(:size(unknown)), unknown)
      if (xi <= 0.0_wp .and. link%held(1)) displacement(3) = end_rotation(chords%turn(:, body), &
        border, held_rotation(link, own(:0), 1))
      if (xi >= 1.0_wp .and. link%held(2)) displacement(3) = end_rotation(chords%turn(:, body), &
        border, held_rotation(link, own(:0), 2))
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

  !> Rotation of a held end against the chord: own modes do not turn it.
  pure function held_rotation(link, curves, which) result(rotation)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: curves(:) !! (curves) unknowns of the curves [√J]
    integer, intent(in) :: which      !! 1: the first end, 2: the last
    real(wp) :: rotation

    rotation = link%curve_rotation(1)*curves(1)
    if (link%curves == 1) return
    rotation = 0.5_wp*(rotation + merge(1.0_wp, -1.0_wp, which == 1)*link%curve_rotation(2)* &
      curves(2))
  end function held_rotation

  !> Rotation of a held end: 0 where it is clamped and the chord turns back by as much, without
  !! rounding.
  pure function end_rotation(turn, border, against_chord) result(rotation)
    real(wp), intent(in) :: turn(:), border(:) !! (border) of the chord
    real(wp), intent(in) :: against_chord      !! [rad]
    real(wp) :: rotation

    !> Rounding of the sum, in units of ε times its terms.
    real(wp), parameter :: multiple = 8.0_wp

    rotation = dot_product(turn, border) + against_chord
    if (abs(rotation) <= multiple*epsilon(1.0_wp)*(dot_product(abs(turn), abs(border)) + &
      abs(against_chord))) rotation = 0.0_wp
  end function end_rotation

end module reduced_shapes
