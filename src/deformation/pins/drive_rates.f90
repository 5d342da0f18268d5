!> How displacements of a linkage move its drives and slides.
module drive_rates
  use border_rows, only: line_direction
  use deformation_places, only: rotation_row
  use elastic_linkages, only: elastic_linkage_t
  use elastic_positions, only: elastic_position_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: drive_of_angle, drive_of_slider, linkage_t, normal_to
  use pin_displacements, only: chords_t
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: find_drive_rates, own_drive_rates, own_drive_compliance, own_turns_by_couples, &
    slide_of, turn_of_end, end_at_joint, is_joint

contains

  !> Motion of every free drive in some displacements.
  pure subroutine find_drive_rates(linkage, at, chords, rate)
    type(linkage_t), intent(in) :: linkage
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    real(wp), allocatable, intent(out) :: rate(:, :) !! (free drives, displacements)

    integer, allocatable :: free(:)
    integer :: i

    free = pack([(i, i=1, size(linkage%drives))], linkage%drives%is_free)
    allocate (rate(size(free), size(chords%turn, 1)))
    do i = 1, size(free)
      associate (drive => linkage%drives(free(i)))
        rate(i, :) = 0.0_wp
        if (drive%kind == drive_of_angle) then
          rate(i, :) = turn_at_joint(linkage, at, chords, drive%body, drive%against)
          if (drive%against > 0) rate(i, :) = rate(i, :) - turn_at_joint(linkage, at, chords, &
            drive%against, drive%body)
        else if (drive%kind == drive_of_slider) then
          rate(i, :) = slide_of(at%elastic, at%pose, chords, drive%slider)
        end if
      end associate
    end do
  end subroutine find_drive_rates

  !> Rotation of the end of a link where it is joined to another, or to the ground.
  pure function turn_at_joint(linkage, at, chords, body, other) result(turn)
    type(linkage_t), intent(in) :: linkage
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    integer, intent(in) :: body, other
    real(wp) :: turn(size(chords%turn, 1))

    integer :: part, end

    call find_joint_end(linkage, at%elastic, body, other, part, end)
    if (at%elastic%rotation(end, part) > 0) then
      turn = chords%rotation(at%elastic%rotation(end, part), :)
    else if (at%elastic%linkage%bodies(part)%bends) then
      turn = turn_of_end(at%model%links(part), chords%turn(:, part), chords%across(3:, :, part), &
        end)
    else
      turn = chords%turn(:, part)
    end if
  end function turn_at_joint

  !> The part of a link that is joined to another, or to the ground, and its end there.
  pure subroutine find_joint_end(linkage, elastic, body, other, part, end)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: body, other
    integer, intent(out) :: part, end

    do part = findloc(elastic%body, body, dim=1), findloc(elastic%body, body, dim=1, back=.true.)
      end = end_at_joint(linkage, elastic, part, other)
      if (end > 0) return
    end do
    part = findloc(elastic%body, body, dim=1)
    end = 1
  end subroutine find_joint_end

  !> The end of a part where its link is joined to another one, or to the ground.
  pure function end_at_joint(linkage, elastic, part, other) result(number)
    type(linkage_t), intent(in) :: linkage         !! that moves: pins of its links
    type(elastic_linkage_t), intent(in) :: elastic !! its parts
    integer, intent(in) :: part                    !! number
    integer, intent(in) :: other                   !! number of the link; 0: the ground
    integer :: number                              !! 1: the first, 2: the last; 0: none

    number = 0
    if (is_joint(linkage, elastic%linkage%bodies(part)%last_pin, other)) number = 2
    if (is_joint(linkage, elastic%linkage%bodies(part)%first_pin, other)) number = 1
  end function end_at_joint

  !> Whether a point is a pin of a link, or of the ground.
  pure function is_joint(linkage, point, body)
    type(linkage_t), intent(in) :: linkage !! that moves: pins of its links
    integer, intent(in) :: point           !! number; those beyond the pins are none
    integer, intent(in) :: body            !! number of the link; 0: the ground
    logical :: is_joint

    is_joint = .false.
    if (point > size(linkage%is_ground)) return
    if (body == 0) then
      is_joint = linkage%is_ground(point)
    else
      is_joint = any(pins_of_body(linkage%bodies(body)) == point)
    end if
  end function is_joint

  !> Rotations of an end of a part that bends against its chord: of curves, then own modes.
  pure function end_slopes(link, end) result(slopes)
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: end !! 1: the first, 2: the last
    real(wp) :: slopes(link%curves + link%modes)

    real(wp) :: row(link%bending_shapes%unknowns)

    row = rotation_row(link%bending_shapes, real(end - 1, wp))
    slopes = matmul(row(:size(link%bending, 1)), link%bending)
  end function end_slopes

  !> Rotations of an end of a part that bends by its own modes.
  pure function own_slopes(link, number) result(slopes)
    type(link_modes_t), intent(in) :: link !! of the part
    integer, intent(in) :: number          !! 1: the first end, 2: the last
    real(wp) :: slopes(link%modes)         !! (own modes)

    real(wp) :: all_slopes(link%curves + link%modes)

    all_slopes = end_slopes(link, number)
    slopes = all_slopes(link%curves + 1:)
  end function own_slopes

  !> Rotations at the joints of free drives that are due to own modes of one part.
  pure function own_drive_rates(linkage, at, part) result(rate)
    type(linkage_t), intent(in) :: linkage           !! that moves: its drives
    type(elastic_position_t), intent(in) :: at       !! of it
    integer, intent(in) :: part                      !! that bends
    real(wp) :: rate(count(linkage%drives%is_free), at%model%links(part)%modes) !! (free drives,
                                                     !! own modes)

    real(wp) :: sense(size(rate, 1), 2), slopes(at%model%links(part)%modes)
    integer :: i, end

    sense = hinged_ends(linkage, at%elastic, part)
    rate = 0.0_wp
    do end = 1, 2
      if (.not. any(abs(sense(:, end)) > 0.0_wp)) cycle
      slopes = own_slopes(at%model%links(part), end)
      do i = 1, size(rate, 1)
        rate(i, :) = rate(i, :) + sense(i, end)*slopes
      end do
    end do
  end function own_drive_rates

  !> How free drives yield to their own torques by own modes of a part, R Rᵀ of all of them, in
  !! closed form.
  pure function own_drive_compliance(linkage, elastic, part) result(compliance)
    type(linkage_t), intent(in) :: linkage           !! that moves: its drives
    type(elastic_linkage_t), intent(in) :: elastic   !! of it, at this position
    integer, intent(in) :: part                      !! that bends
    real(wp) :: compliance(count(linkage%drives%is_free), count(linkage%drives%is_free))

    real(wp) :: sense(size(compliance, 1), 2)

    sense = hinged_ends(linkage, elastic, part)
    compliance = matmul(matmul(sense, own_flexibility(elastic, part)), transpose(sense))
  end function own_drive_compliance

  !> Turns at the joints of free drives by own modes of a part under couples at its hinged ends, in
  !! closed form.
  pure function own_turns_by_couples(linkage, elastic, part, couple) result(turns)
    type(linkage_t), intent(in) :: linkage           !! that moves: its drives
    type(elastic_linkage_t), intent(in) :: elastic   !! of it, at this position
    integer, intent(in) :: part                      !! that bends
    real(wp), intent(in) :: couple(2)                !! on its ends [N m]
    real(wp) :: turns(count(linkage%drives%is_free))

    turns = matmul(hinged_ends(linkage, elastic, part), matmul(own_flexibility(elastic, part), &
      couple))
  end function own_turns_by_couples

  !> Turns of the hinged ends of a part under couples there, while its held ends stay.
  !!
  !! Under couples M at its ends a beam on two hinges turns by `L/3EI + 1/(kGA L)` where they act,
  !! and by `1/(kGA L) − L/6EI` at the other end; with one end held what this end does not bear is
  !! left. With shear and without rotary inertia a part of it moves no mass, and is in no own mode.
  pure function own_flexibility(elastic, part) result(turn)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part
    real(wp) :: turn(2, 2) !! (end that turns, end with the couple) 0 at held ends [rad/N m]

    real(wp) :: here, there, sheared
    integer :: end

    associate (beam => elastic%beams(part), length => elastic%linkage%bodies(part)%length)
      sheared = 0.0_wp
      if (beam%shear_stiffness > 0.0_wp) sheared = 1.0_wp/(beam%shear_stiffness*length)
      here = length/(3.0_wp*beam%bending_stiffness) + sheared
      there = sheared - length/(6.0_wp*beam%bending_stiffness)
    end associate
    turn = reshape([here, there, there, here], [2, 2])
    do end = 1, 2
      if (.not. elastic%held(end, part)) cycle
      turn = 0.0_wp
      if (.not. elastic%held(3 - end, part)) turn(3 - end, 3 - end) = here - there**2/here
      exit
    end do
  end function own_flexibility

  !> With which sense the rotation of the hinged ends of a part is the motion of free drives.
  pure function hinged_ends(linkage, elastic, part) result(sense)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part
    real(wp) :: sense(count(linkage%drives%is_free), 2) !! (free drives, ends) ±1; 0: not

    integer :: bodies(2), d, i, k, at, end

    sense = 0.0_wp
    i = 0
    do d = 1, size(linkage%drives)
      associate (drive => linkage%drives(d))
        if (.not. drive%is_free) cycle
        i = i + 1
        if (drive%kind /= drive_of_angle) cycle
        bodies = [drive%body, drive%against]
        do k = 1, 2
          if (bodies(k) == 0) cycle
          call find_joint_end(linkage, elastic, bodies(k), bodies(3 - k), at, end)
          if (at /= part .or. elastic%rotation(end, at) /= 0) cycle
          sense(i, end) = sense(i, end) + merge(1.0_wp, -1.0_wp, k == 1)
        end do
      end associate
    end do
  end function hinged_ends

  !> Rotation of a hinged end of a part that bends: that of its chord, and what the curves of the
  !! other end add.
  pure function turn_of_end(link, chord, curve, number) result(turn)
    type(link_modes_t), intent(in) :: link   !! of the part
    real(wp), intent(in) :: chord(:)         !! (displacements) what they turn its chord
    real(wp), intent(in) :: curve(:, :)      !! (curves or more, displacements)
    integer, intent(in) :: number            !! 1: the first end, 2: the last
    real(wp) :: turn(size(chord))            !! (displacements)

    real(wp) :: slopes(link%curves + link%modes)
    integer :: i

    turn = chord
    slopes = end_slopes(link, number)
    do i = 1, link%curves
      turn = turn + slopes(i)*curve(i, :)
    end do
  end function turn_of_end

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
