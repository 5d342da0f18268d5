!> What holds the links where they meet: by pins, welds, clamps, drives.
module joint_kinds
  use elastic_linkages, only: shared_pin
  use joint_study, only: joint_t
  use linkages, only: drive_of_angle, drive_of_slider, linkage_t
  implicit none (type, external)
  private

  public :: kinds_of_joints, joint_words

  !> Of a joint: nothing else is there, it turns against something there, against nothing, a drive
  !! holds it against another link or along its line, it turns with the ground.
  integer, parameter :: joint_free = 1, joint_pinned = 2, joint_welded = 3, joint_driven = 4, &
    joint_clamped = 5

  !> The words of these, in their order.
  character(len=*), parameter :: joint_words(5) = [character(len=7) :: "free", "pinned", &
    "welded", "driven", "clamped"]

  !> What a joint turns with, if it is none of the joints.
  integer, parameter :: ground = 0, nothing = -1

contains

  !> The kind of every joint, 1 for the first of `joint_words` and so on. A drive that is free holds
  !! nothing.
  pure function kinds_of_joints(linkage, joints) result(kind)
    type(linkage_t), intent(in) :: linkage !! its turns and drives
    type(joint_t), intent(in) :: joints(:) !! of `list_joints`
    integer :: kind(size(joints))

    logical :: is_driven(size(joints)), is_there(size(joints))
    integer :: group(size(joints)) !! least number of those that turn together
    integer :: i, pin

    group = [(i, i=1, size(joints))]
    is_driven = .false.
    do i = 1, size(linkage%turns)
      associate (turn => linkage%turns(i))
        if (turn%slider > 0) then
          call join(group, [joint_of(joints, turn%body, turn%pin), findloc(joints%slider, &
            turn%slider, dim=1)])
        else
          call join(group, [joint_of(joints, turn%body, turn%pin), joint_of(joints, &
            turn%against, turn%pin)])
        end if
      end associate
    end do
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%is_free) cycle
        if (drive%kind == drive_of_slider) is_driven = is_driven .or. joints%slider == drive%slider
        if (drive%kind /= drive_of_angle) cycle
        pin = shared_pin(linkage, drive%body, drive%against)
        call join(group, [joint_of(joints, drive%body, pin), joint_of(joints, drive%against, pin)])
        is_driven = is_driven .or. joints%slider == 0 .and. joints%pin == pin .and. &
          (joints%body == drive%body .or. joints%body == drive%against)
      end associate
    end do
    do i = 1, size(joints)
      is_there = joints%pin == joints(i)%pin
      kind(i) = joint_pinned
      if (group(i) == ground) then
        kind(i) = joint_clamped
      else if (is_driven(i)) then
        kind(i) = joint_driven
      else if (.not. linkage%is_ground(joints(i)%pin)) then
        if (all(pack(group, is_there) == group(i))) kind(i) = joint_welded
        if (count(is_there) == 1) kind(i) = joint_free
      end if
    end do
  end function kinds_of_joints

  !> Lets two joints turn together.
  pure subroutine join(group, pair)
    integer, intent(inout) :: group(:)
    integer, intent(in) :: pair(2) !! joints, or the ground

    integer :: both(2), i

    if (any(pair == nothing)) return
    both = ground
    do i = 1, 2
      if (pair(i) /= ground) both(i) = group(pair(i))
    end do
    where (group == both(1) .or. group == both(2)) group = minval(both)
  end subroutine join

  !> Number of the joint of a body at a pin.
  pure function joint_of(joints, body, pin) result(number)
    type(joint_t), intent(in) :: joints(:)
    integer, intent(in) :: body, pin
    integer :: number

    number = ground
    if (body == 0) return
    number = findloc(joints%slider == 0 .and. joints%body == body .and. joints%pin == pin, &
      .true., dim=1)
    if (number == 0) number = nothing
  end function joint_of

end module joint_kinds
