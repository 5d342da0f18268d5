!> Whether the crank of a linkage turns fully.
module full_turns
  use errors, only: error_t
  use four_bar_limits, only: crank_reach, reach_t
  use four_bar_loops, only: find_four_bar, four_bar_t
  use kinds, only: wp
  use linkage_paths, only: has_change_points, period_of
  use linkages, only: drive_of_angle, linkage_t
  use low_points, only: find_gap
  use poses, only: find_moving_pose, pose_t
  implicit none (type, external)
  private

  public :: turns_fully

contains

  !> Whether the first drive turns a link fully, without a dead point, and all positions repeat
  !! after a turn. For a four-bar that is a closed form; with others it is tried every half degree,
  !! and where a group comes near a dead point in between.
  pure function turns_fully(linkage, through) result(turns)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    logical, intent(in) :: through         !! a linkage that is no four-bar may go through change
                                           !! points
    logical :: turns

    integer, parameter :: samples = 720
    type(four_bar_t), allocatable :: four_bar
    type(reach_t) :: reach
    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp), allocatable :: cranks(:), sine(:, :)
    real(wp) :: place
    logical :: has_gap
    integer :: i

    call find_four_bar(linkage, four_bar)
    if (allocated(four_bar)) then
      reach = crank_reach(four_bar%ground, four_bar%length)
      turns = reach%closes .and. reach%least <= 0.0_wp .and. reach%most >= 180.0_wp
      ! The transmission angle is least and greatest as the crank passes the line of the ground.
      cranks = reach%ground + [0.0_wp, 180.0_wp]
    else
      turns = linkage%drives(1)%kind == drive_of_angle .and. abs(period_of(linkage) - 360.0_wp) <= &
        0.0_wp
      cranks = [(360.0_wp*i/samples, i=0, samples + 1)]
    end if
    allocate (sine(size(linkage%groups), size(cranks)))
    if (allocated(four_bar) .or. .not. through) turns = turns .and. .not. has_change_points(linkage)
    do i = 1, size(cranks)
      if (.not. turns) return
      call find_moving_pose(linkage, cranks(i), pose, error)
      turns = .not. allocated(error)
      if (turns) sine(:, i) = pose%sine
      if (allocated(four_bar) .or. i < 3 .or. .not. turns) cycle
      call find_gap(linkage, cranks(i - 2:i), sine(:, i - 2:i), has_gap, place)
      turns = .not. has_gap
    end do
  end function turns_fully

end module full_turns
