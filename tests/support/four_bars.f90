!> Four-bars of numbers, without a deck.
module four_bars
  use four_bar_loops, only: find_four_bar, four_bar_t
  use kinds, only: wp
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: new_four_bar, loop_of

contains

  !> The four-bar O2–A–B–O4 without loads: pins 1 to 4, bodies crank, coupler, follower. The
  !! follower's angle is that of O4 → B.
  pure function new_four_bar(ground, length, line_density, pin_mass, crossed) result(linkage)
    real(wp), intent(in) :: ground(2, 2)    !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)       !! crank, coupler, follower [m]
    real(wp), intent(in) :: line_density(3) !! crank, coupler, follower [kg/m]
    real(wp), intent(in) :: pin_mass(2)     !! at A and B [kg]
    logical, intent(in) :: crossed          !! B to the right of A → O4; else to its left
    type(linkage_t) :: linkage

    integer :: i

    linkage%is_ground = [.true., .false., .false., .true.]
    allocate (linkage%pin_force(2, 4), linkage%couple(3))
    linkage%pin_force = 0.0_wp
    linkage%couple = 0.0_wp
    allocate (linkage%ground_position(2, 4))
    linkage%ground_position = 0.0_wp
    linkage%ground_position(:, 1) = ground(:, 1)
    linkage%ground_position(:, 4) = ground(:, 2)
    linkage%pin_mass = [0.0_wp, pin_mass, 0.0_wp]
    ! An array constructor would leak the memory of the lumps in gfortran 12.
    allocate (linkage%bodies(3))
    do i = 1, 3
      linkage%bodies(i)%first_pin = i
      linkage%bodies(i)%last_pin = i + 1
      linkage%bodies(i)%length = length(i)
      linkage%bodies(i)%line_density = line_density(i)
      if (i == 3) linkage%bodies(i)%heading = [-1.0_wp, 0.0_wp]
      allocate (linkage%bodies(i)%lumps(0), linkage%bodies(i)%further(0))
    end do
    allocate (linkage%sliders(0), linkage%turns(0), linkage%drives(1), linkage%groups(1), &
      linkage%redundancies(0), linkage%loads(0))
    linkage%drives(1)%body = 1
    linkage%groups(1)%base = [2, 4]
    linkage%groups(1)%body = [2, 3]
    linkage%groups(1)%middle = 3
    linkage%groups(1)%side = merge(-1.0_wp, 1.0_wp, crossed)
    allocate (linkage%drawing%is_drawn(4), linkage%drawing%pin(2, 4))
    linkage%drawing%is_drawn = .false.
    linkage%drawing%pin = 0.0_wp
  end function new_four_bar

  !> The loop of a four-bar.
  pure function loop_of(linkage) result(loop)
    type(linkage_t), intent(in) :: linkage !! a four-bar
    type(four_bar_t) :: loop

    type(four_bar_t), allocatable :: found

    call find_four_bar(linkage, found)
    loop = found
  end function loop_of

end module four_bars
