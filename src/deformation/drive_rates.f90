!> How displacements of a linkage move its drives and slides.
module drive_rates
  use border_rows, only: line_direction
  use deformation_places, only: rotation_row
  use elastic_linkages, only: elastic_linkage_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: drives_angle, drives_slider, linkage_t, normal_to
  use pin_displacements, only: chords_t
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: find_drive_rates, slide_of

contains

  !> Motion of every free drive in some displacements.
  pure subroutine find_drive_rates(linkage, elastic, links, pose, chords, rate)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(link_modes_t), intent(in) :: links(:)
    type(pose_t), intent(in) :: pose
    type(chords_t), intent(in) :: chords
    real(wp), allocatable, intent(out) :: rate(:, :) !! (free drives, displacements)

    integer, allocatable :: free(:)
    integer :: i

    free = pack([(i, i=1, size(linkage%drives))], linkage%drives%is_free)
    allocate (rate(size(free), size(chords%turn, 1)))
    do i = 1, size(free)
      associate (drive => linkage%drives(free(i)))
        rate(i, :) = 0.0_wp
        if (drive%kind == drives_angle) then
          rate(i, :) = turn_at_joint(linkage, elastic, links, chords, drive%body, drive%against)
          if (drive%against > 0) rate(i, :) = rate(i, :) - turn_at_joint(linkage, elastic, links, &
            chords, drive%against, drive%body)
        else if (drive%kind == drives_slider) then
          rate(i, :) = slide_of(elastic, pose, chords, drive%slider)
        end if
      end associate
    end do
  end subroutine find_drive_rates

  !> Rotation of the end of a link where it is joined to another, or to the ground.
  pure function turn_at_joint(linkage, elastic, links, chords, body, other) result(turn)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(link_modes_t), intent(in) :: links(:)
    type(chords_t), intent(in) :: chords
    integer, intent(in) :: body, other
    real(wp) :: turn(size(chords%turn, 1))

    real(wp), allocatable :: row(:)
    integer :: i, k, kept, last
    logical :: is_here(2)

    do k = 1, size(elastic%body)
      if (elastic%body(k) /= body) cycle
      turn = chords%turn(:, k)
      if (.not. elastic%linkage%bodies(k)%bends) return
      is_here = [is_joint(elastic%linkage%bodies(k)%first_pin), &
        is_joint(elastic%linkage%bodies(k)%last_pin)]
      if (.not. any(is_here)) cycle
      last = merge(1, 2, is_here(1))
      if (elastic%rotation(last, k) > 0) then
        turn = chords%rotation(elastic%rotation(last, k), :)
        return
      end if
      kept = size(links(k)%bending, 1)
      row = rotation_row(links(k)%bending_shapes, &
        real(last - 1, wp))
      do i = 1, links(k)%curves
        turn = turn + dot_product(row(:kept), links(k)%bending(:, i - links(k)%curves))* &
          chords%across(2 + i, :, k)
      end do
      return
    end do
    turn = 0.0_wp

  contains

    !> Whether a pin joins both.
    pure function is_joint(pin)
      integer, intent(in) :: pin
      logical :: is_joint

      if (other == 0) then
        is_joint = elastic%linkage%is_ground(pin)
      else
        is_joint = any(pins_of_body(linkage%bodies(other)) == pin)
      end if
    end function is_joint

  end function turn_at_joint

  !> Slide of a block along the line of its guide.
  pure function slide_of(elastic, pose, chords, slider) result(along)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(chords_t), intent(in) :: chords
    integer, intent(in) :: slider
    real(wp) :: along(size(chords%turn, 1))

    real(wp) :: direction(2)
    integer :: part

    direction = line_direction(elastic, pose, slider)
    associate (line => elastic%linkage%sliders(slider))
      along = matmul(direction, chords%pin(:, line%pin, :))
      if (elastic%contact(slider) > 0) then
        along = along - matmul(direction, chords%pin(:, elastic%contact(slider), :))
      else if (line%body > 0) then
        part = findloc(elastic%body, line%body, dim=1)
        associate (first => elastic%linkage%bodies(part)%first_pin)
          along = along - matmul(direction, chords%pin(:, first, :)) - chords%turn(:, &
            part)*dot_product(direction, normal_to(pose%pin(:, line%pin) - pose%pin(:, first)))
        end associate
      end if
    end associate
  end function slide_of

end module drive_rates
