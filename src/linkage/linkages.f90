!> A planar linkage in terms of mechanics: pins, links between them, one driven link, and dyads
!! attached to it.
!!
!! Everything but `new_four_bar` works for any linkage of mobility one that can be built from a
!! driven link and dyads. A dyad is two links that meet in a pin, each attached to a pin whose
!! motion is already known.
module linkages
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: linkage_t, body_t, lump_t, dyad_t, new_four_bar, mobility, cross, normal_to

  !> A mass fixed to a body. In the axes of the body x is along it and y to the left, looking from
  !! its first pin to its last.
  type :: lump_t
    real(wp) :: mass = 0.0_wp      !! [kg]
    real(wp) :: place(2) = 0.0_wp  !! of its mass centre, from the first pin, in the axes of the
                                   !! body [m]
    real(wp) :: inertia = 0.0_wp   !! moment of inertia about its own mass centre [kg m²]
  end type lump_t

  !> A straight link: uniform, with lumps, or a rigid shape of any kind, given by a lump alone. Its
  !! coordinate runs from its first pin to its last, in the direction round the loop.
  type :: body_t
    integer :: first_pin = 0              !! where the path round the loop enters it
    integer :: last_pin = 0               !! where the path leaves it
    real(wp) :: length = 0.0_wp           !! [m]
    real(wp) :: line_density = 0.0_wp     !! mass per length [kg/m]
    real(wp) :: sense = 1.0_wp            !! +1: its angle is that of first → last pin, −1: that of
                                          !! last → first
    real(wp) :: rotary_inertia = 0.0_wp   !! ρI of its cross-sections per length [kg m];
                                          !! 0: neglected
    logical :: bends = .true.             !! as a beam; else rigid
    type(lump_t), allocatable :: lumps(:) !! masses fixed to it
  end type body_t

  !> Two bodies that meet in a pin, each attached to a pin that is placed before.
  type :: dyad_t
    integer :: base(2) = 0      !! pins that carry it
    integer :: body(2) = 0      !! bodies from each base to the middle
    integer :: middle = 0       !! pin where the bodies meet
    real(wp) :: side = 1.0_wp   !! +1: the middle lies to the left of base 1 → base 2, −1: to its
                                !! right
  end type dyad_t

  !> Pins, bodies, dyads and constant loads.
  type :: linkage_t
    logical, allocatable :: is_ground(:)           !! (pins) fixed to the ground
    real(wp), allocatable :: ground_position(:, :) !! (2, pins) [m]; zero for moving pins
    real(wp), allocatable :: pin_mass(:)           !! (pins) [kg]
    real(wp) :: gravity(2) = 0.0_wp                !! [m/s²]
    real(wp), allocatable :: pin_force(:, :)       !! (2, pins) constant external forces on the
                                                   !! pins [N]
    real(wp), allocatable :: couple(:)             !! (bodies) constant external torques [N m]
    type(body_t), allocatable :: bodies(:)         !! in the order round the loop; the first is
                                                   !! driven about its first pin
    type(dyad_t), allocatable :: dyads(:)          !! in the order in which they are placed
  end type linkage_t

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
      if (i == 3) linkage%bodies(i)%sense = -1.0_wp
      allocate (linkage%bodies(i)%lumps(0))
    end do
    linkage%dyads = [dyad_t([2, 4], [2, 3], 3, merge(-1.0_wp, 1.0_wp, crossed))]
  end function new_four_bar

  !> Degrees of freedom by counting: `3(n − 1) − 2j` for n links with the ground and j pins of two
  !! links each (Grübler, Kutzbach). A pin where k links meet counts as k − 1 pins.
  pure function mobility(linkage) result(freedoms)
    type(linkage_t), intent(in) :: linkage !! pins and bodies
    integer :: freedoms

    integer :: pin, links, pins

    pins = 0
    do pin = 1, size(linkage%is_ground)
      links = count(linkage%bodies%first_pin == pin) + count(linkage%bodies%last_pin == pin) + &
        merge(1, 0, linkage%is_ground(pin))
      pins = pins + max(0, links - 1)
    end do
    freedoms = 3*size(linkage%bodies) - 2*pins
  end function mobility

  !> Component of `a × b` normal to the plane.
  pure function cross(a, b)
    real(wp), intent(in) :: a(2) !! first vector
    real(wp), intent(in) :: b(2) !! second vector
    real(wp) :: cross

    cross = a(1)*b(2) - a(2)*b(1)
  end function cross

  !> A vector turned by 90° counter-clockwise.
  pure function normal_to(a) result(normal)
    real(wp), intent(in) :: a(2) !! vector
    real(wp) :: normal(2)

    normal = [-a(2), a(1)]
  end function normal_to

end module linkages
