!> What a linkage puts on the frame: the resultant of all forces at the ground.
module frame_forces
  use actuated_forces, only: actuators_on_ground
  use coordinates, only: evaluate, evaluated_t
  use ground_loads, only: effort_on_ground
  use group_equations, only: line_axis
  use joint_forces, only: force_at_pin, joint_forces_t
  use kinds, only: wp
  use linkages, only: cross, drive_of_angle, drive_of_coordinate, drive_of_slider, is_actuated, &
    linkage_t, normal_to, reference_point
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: find_frame_load

contains

  !> Force and moment on the frame: opposite to those on the links at ground pivots, on the pins at
  !! fixed guides, on links that a guide keeps from turning, and of drives, or actuators, that stand
  !! on the ground; at a block on a ground pivot, those of the link that slides through it.
  !!
  !! Of a four-bar the force is −(F12 + F14), and the moment has the reaction of the motor, −T12:
  !! Norton, Design of Machinery, section 11.8.
  pure function find_frame_load(linkage, pose, forces) result(load)
    type(linkage_t), intent(in) :: linkage     !! bodies, pins, sliders, turns and drives
    type(pose_t), intent(in) :: pose           !! pins and directions
    type(joint_forces_t), intent(in) :: forces !! at this pose
    real(wp) :: load(3)                        !! fx, fy [N], moment about `reference_point` [N m]

    type(evaluated_t) :: driven
    integer :: b, t, d

    load = 0.0_wp
    do b = 1, size(linkage%bodies)
      call add_pivots(linkage, pose, forces, b, load)
    end do
    ! In linkages of a crank and dyads of binary links the crank's torque is all that there is.
    if (.not. allocated(forces%drive)) then
      load(3) = load(3) - forces%torque
      return
    end if
    call add_sliders(linkage, pose, forces, load)
    do t = 1, size(linkage%turns)
      if (linkage%turns(t)%against == 0) load(3) = load(3) - forces%couple(t)
    end do
    if (is_actuated(linkage)) then
      load = load + actuators_on_ground(linkage, pose, forces%drive)
      return
    end if
    do d = 1, size(linkage%drives)
      associate (drive => linkage%drives(d), effort => forces%drive(d))
        if (drive%kind == drive_of_angle .and. drive%against == 0) load(3) = load(3) - effort
        if (drive%kind /= drive_of_coordinate) cycle
        call evaluate(linkage, pose, linkage%coordinates(drive%coordinate), driven)
        load = load + effort_on_ground(linkage, pose, linkage%coordinates(drive%coordinate), &
          driven, effort)
      end associate
    end do
  end function find_frame_load

  !> What a body puts on its ground pivots.
  pure subroutine add_pivots(linkage, pose, forces, body, load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(joint_forces_t), intent(in) :: forces
    integer, intent(in) :: body !! number
    real(wp), intent(inout) :: load(3)

    integer :: pins(2 + size(linkage%bodies(body)%further)), i

    pins = pins_of_body(linkage%bodies(body))
    do i = 1, size(pins)
      if (linkage%is_ground(pins(i))) call add_force(linkage, pose%pin(:, pins(i)), &
        -force_at_pin(linkage, forces, body, pins(i)), load)
    end do
  end subroutine add_pivots

  !> What pins put on fixed guides, and links on blocks at ground pivots, across the line and, of
  !! a slider that its drive holds, along it.
  pure subroutine add_sliders(linkage, pose, forces, load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(joint_forces_t), intent(in) :: forces
    real(wp), intent(inout) :: load(3)

    real(wp) :: axis(2), force(2)
    integer :: i, d

    do i = 1, size(linkage%sliders)
      associate (slider => linkage%sliders(i))
        if (slider%body > 0 .and. .not. linkage%is_ground(slider%pin)) cycle
        axis = line_axis(linkage, pose, i)
        force = forces%guide(i)*normal_to(axis)
        do d = 1, merge(0, size(linkage%drives), is_actuated(linkage))
          if (linkage%drives(d)%kind == drive_of_slider .and. linkage%drives(d)%slider == i) &
            force = force + forces%drive(d)*axis
        end do
        ! This is the force on the pin.
        if (slider%body == 0) force = -force
        call add_force(linkage, pose%pin(:, slider%pin), force, load)
      end associate
    end do
  end subroutine add_sliders

  !> Adds a force on the frame at a place.
  pure subroutine add_force(linkage, place, force, load)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: place(2) !! [m]
    real(wp), intent(in) :: force(2) !! [N]
    real(wp), intent(inout) :: load(3)

    load(:2) = load(:2) + force
    load(3) = load(3) + cross(place - reference_point(linkage), force)
  end subroutine add_force

end module frame_forces
