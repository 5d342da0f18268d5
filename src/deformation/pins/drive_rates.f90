!> How displacements of a linkage move its free drives.
module drive_rates
  use elastic_linkages, only: elastic_linkage_t
  use elastic_positions, only: elastic_position_t
  use kinds, only: wp
  use linkages, only: drive_of_angle, drive_of_slider
  use pin_displacements, only: chords_t
  use terminal_work, only: end_slopes, find_end, line_direction, work_between
  implicit none (type, external)
  private

  public :: drive_rates_of, own_drive_rates, own_drive_compliance, own_turns_by_couples, hinged_ends

contains

  !> Motion of every free drive in some displacements.
  pure function drive_rates_of(at, chords) result(rate)
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    real(wp), allocatable :: rate(:, :) !! (free drives, displacements)

    integer :: i, number

    allocate (rate(size(at%elastic%free_drives), size(chords%turn, 1)), source=0.0_wp)
    do i = 1, size(rate, 1)
      number = at%elastic%free_drives(i)
      associate (drive => at%elastic%linkage%drives(number), ends => at%elastic%driven(:, number))
        if (drive%kind == drive_of_angle) then
          rate(i, :) = work_between(at, chords, ends, [0.0_wp, 0.0_wp], 1.0_wp)
        else if (drive%kind == drive_of_slider) then
          rate(i, :) = work_between(at, chords, ends, line_direction(at%elastic, at%pose, &
            drive%slider), 0.0_wp)
        end if
      end associate
    end do
  end function drive_rates_of

  !> Rotations at the joints of free drives that are due to own modes of one part.
  pure function own_drive_rates(at, part) result(rate)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: part         !! that bends
    real(wp), allocatable :: rate(:, :) !! (free drives, own modes)

    real(wp) :: slopes(2, at%model%links(part)%curves + at%model%links(part)%modes)
    integer :: end

    do end = 1, 2
      slopes(end, :) = end_slopes(at%model%links(part), end)
    end do
    rate = matmul(hinged_ends(at%elastic, part), slopes(:, at%model%links(part)%curves + 1:))
  end function own_drive_rates

  !> How free drives yield to their own torques by own modes of a part, R Rᵀ of all of them, in
  !! closed form.
  pure function own_drive_compliance(elastic, part) result(compliance)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    integer, intent(in) :: part                    !! that bends
    real(wp), allocatable :: compliance(:, :)

    real(wp) :: sense(size(elastic%free_drives), 2)

    sense = hinged_ends(elastic, part)
    compliance = matmul(matmul(sense, own_flexibility(elastic, part)), transpose(sense))
  end function own_drive_compliance

  !> Turns at the joints of free drives by own modes of a part under couples at its hinged ends, in
  !! closed form.
  pure function own_turns_by_couples(elastic, part, couple) result(turns)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    integer, intent(in) :: part                    !! that bends
    real(wp), intent(in) :: couple(2)              !! on its ends [N m]
    real(wp) :: turns(size(elastic%free_drives))

    turns = matmul(hinged_ends(elastic, part), matmul(own_flexibility(elastic, part), couple))
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
  pure function hinged_ends(elastic, part) result(sense)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part
    real(wp) :: sense(size(elastic%free_drives), 2) !! (free drives, ends) ±1; 0: not

    integer :: i, k, at, end

    sense = 0.0_wp
    do i = 1, size(sense, 1)
      do k = 1, 2
        associate (terminal => elastic%driven(k, elastic%free_drives(i)))
          if (terminal%part == 0 .or. terminal%rotation /= 0) cycle
          call find_end(elastic, terminal, at, end)
          if (at == part) sense(i, end) = sense(i, end) + merge(-1.0_wp, 1.0_wp, k == 1)
        end associate
      end do
    end do
  end function hinged_ends

end module drive_rates
