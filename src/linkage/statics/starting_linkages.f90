!> Loads of a linkage that starts from rest: resistances act with their full size at once.
module starting_linkages
  use applied_load_types, only: applied_load_t, applies_couple, is_torsional
  use group_equations, only: farthest_arm
  use kinds, only: wp
  use linkages, only: gives_angle, linkage_t
  implicit none (type, external)
  private

  public :: starting_linkage, starting_speed

  !> Speed of the first drive whose square is nothing, and with it all inertia loads [rad/s] or
  !! [m/s].
  real(wp), parameter :: starting_speed = 1.0e-150_wp

  !> A joint stands still where its rate is below this share of the drive's: it is rounding.
  real(wp), parameter :: rounding = 1.0e-12_wp

contains

  !> The linkage whose loads and friction at `starting_speed`, in either sense, are those of a start
  !! from rest: Coulomb friction, resistances, and loads in one direction of the motion act in full,
  !! dampers not at all.
  pure function starting_linkage(linkage) result(starting)
    type(linkage_t), intent(in) :: linkage !! its loads and frictions
    type(linkage_t) :: starting

    real(wp) :: span, turning, sliding
    integer :: b

    span = maxval([(farthest_arm(linkage%bodies(b)), b=1, size(linkage%bodies))])
    if (gives_angle(linkage%drives(1))) then
      turning = starting_speed*rounding
      sliding = turning*span
    else
      sliding = starting_speed*rounding
      turning = sliding/span
    end if
    starting = linkage
    starting%loads%law%damping = 0.0_wp
    starting%loads%smooth = merge(sliding, turning, is_along_line(linkage%loads))
    if (.not. allocated(linkage%frictions)) return
    starting%frictions%viscous = 0.0_wp
    starting%frictions%smooth = merge(sliding, turning, linkage%frictions%slider > 0)
  end function starting_linkage

  !> Whether a load is along a line, not about a pin.
  elemental function is_along_line(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = .not. (load%kind == applies_couple .or. is_torsional(load))
  end function is_along_line

end module starting_linkages
