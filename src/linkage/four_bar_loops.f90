!> Four-bars: linkages whose plan is a crank and one dyad on a second ground pivot.
!!
!! What hangs on their links does not make them others: further pins, links welded on.
module four_bar_loops
  use kinds, only: wp
  use linkages, only: group_carried, group_dyad, group_turned, linkage_t
  use pose_types, only: pins_of_body, place_of_pin
  implicit none (type, external)
  private

  public :: four_bar_t, find_four_bar, is_plain

  !> The loop of a four-bar, in the order crank, coupler, follower.
  type :: four_bar_t
    integer :: body(3) = 0           !! bodies
    integer :: pin(4) = 0            !! O2, A, B, O4
    integer :: dyad = 0              !! number of the group of coupler and follower
    real(wp) :: length(3) = 0.0_wp   !! of the bodies, between these pins [m]
    real(wp) :: ground(2, 2) = 0.0_wp !! O2 and O4 in global axes [m]
  end type four_bar_t

contains

  !> The four-bar that a linkage is; not allocated if it is another one.
  pure subroutine find_four_bar(linkage, four_bar)
    type(linkage_t), intent(in) :: linkage !! with its groups
    type(four_bar_t), allocatable, intent(out) :: four_bar

    type(four_bar_t) :: found
    integer :: i, first

    if (.not. linkage%has_crank .or. size(linkage%drives) /= 1 .or. size(linkage%sliders) > 0) &
      return
    if (allocated(linkage%redundancies)) then
      if (size(linkage%redundancies) > 0) return
    end if
    if (count(linkage%groups%kind == group_dyad) /= 1) return
    do i = 1, size(linkage%groups)
      if (all(linkage%groups(i)%kind /= [group_dyad, group_carried, group_turned])) return
    end do
    found%dyad = findloc(linkage%groups%kind, group_dyad, dim=1)
    associate (dyad => linkage%groups(found%dyad))
      first = merge(2, 1, linkage%is_ground(dyad%base(1)))
      found%body = [1, dyad%body(first), dyad%body(3 - first)]
      found%pin = [linkage%bodies(1)%first_pin, dyad%base(first), dyad%middle, dyad%base(3 - first)]
    end associate
    if (.not. linkage%is_ground(found%pin(4)) .or. found%pin(4) == found%pin(1)) return
    found%ground = linkage%ground_position(:, found%pin([1, 4]))
    ! What carries the dyad may be welded to the crank.
    if (.not. any(pins_of_body(linkage%bodies(1)) == found%pin(2))) return
    do i = 1, 3
      associate (body => linkage%bodies(found%body(i)))
        found%length(i) = norm2(place_of_pin(body, found%pin(i + 1)) - place_of_pin(body, &
          found%pin(i)))
      end associate
      if (.not. found%length(i) > 0.0_wp) return
    end do
    four_bar = found
  end subroutine find_four_bar

  !> Whether a linkage is a four-bar of three links, without masses at other pins than those of its
  !! loop.
  pure function is_plain(linkage) result(is)
    type(linkage_t), intent(in) :: linkage !! with its groups
    logical :: is

    type(four_bar_t), allocatable :: four_bar
    integer :: i

    call find_four_bar(linkage, four_bar)
    is = allocated(four_bar)
    if (is) is = size(linkage%bodies) == 3 .and. all(linkage%bodies(four_bar%body)%first_pin == &
      four_bar%pin(:3)) .and. all(linkage%bodies(four_bar%body)%last_pin == four_bar%pin(2:))
    if (.not. is) return
    do i = 1, size(linkage%pin_mass)
      is = is .and. (any(four_bar%pin == i) .or. .not. linkage%pin_mass(i) > 0.0_wp)
    end do
  end function is_plain

end module four_bar_loops
