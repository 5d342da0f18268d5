! src/linkage/ - a planar linkage in the terms of mechanics, whatever deck it comes from.
! A `linkage_t` has pins, bodies, joints, drives, loads, groups; a `pose_t` (`pose_types.f90`) is a
! position of it. Begin with `linkage_t` here, then `find_pose` in `src/linkage/groups/poses.f90`.
! Read on in `src/linkage/plan`, `src/linkage/groups`, `src/linkage/limits`, `src/linkage/loads`,
! `src/linkage/statics`; beside them are `src/linkage/balance`, `src/linkage/four_bar`,
! `src/linkage/free`.
! Not here: how a linkage is made of cards (`src/mechanism`), bending (`src/beam`,
! `src/deformation`).

!> A planar linkage in terms of mechanics: pins, bodies between them, sliders, drives, and the
!! groups in which it is placed, moved and solved.
!!
!! The groups are found by `assembly_plan`.
!! Most are dyads: two bodies that meet in a pin, each attached to a pin whose motion is already
!! known.
module linkages
  use applied_load_types, only: applied_load_t
  use coordinate_types, only: coordinate_t
  use joint_friction_types, only: joint_friction_t
  use kinds, only: wp
  use motion_programs, only: motion_program_t
  implicit none (type, external)
  private

  public :: linkage_t, body_t, body_pin_t, lump_t, forced_place_t, slider_t, turn_t, drive_t, &
    actuator_t, drawing_t, equation_t, group_t, path_t, bridge_t, shaft_t
  public :: mobility, reference_point, is_dyad_linkage, is_actuated, follows_angle, cross, &
    normal_to, turned, turned_back
  public :: drive_of_nothing, drive_of_angle, drive_of_slider, drive_of_length, &
    drive_of_coordinate, gives_angle
  public :: rule_through, rule_stop, rule_branch
  public :: demand_length, demand_angle, demand_line, demand_turn, demand_drive
  public :: group_dyad, group_carried, group_on_line, group_through_pin, group_two_lines, &
    group_cross_slide, group_turned, group_spanned, group_placed, group_by_newton, &
    group_driven_dyad

  !> What a drive gives.
  integer, parameter :: drive_of_nothing = 0 !! the first drive of a structure
  integer, parameter :: drive_of_angle = 1   !! the angle of a body
  integer, parameter :: drive_of_slider = 2  !! the place of a slider along its line
  integer, parameter :: drive_of_length = 3  !! the length of a body
  integer, parameter :: drive_of_coordinate = 4 !! any coordinate that has a name

  !> What happens at a change point.
  integer, parameter :: rule_through = 1 !! the linkage goes on smoothly
  integer, parameter :: rule_stop = 2    !! its way ends
  integer, parameter :: rule_branch = 3  !! each position is on the side that its groups have

  !> What an equation demands: two things of a pin of a body, one of all others.
  integer, parameter :: demand_length = 1 !! the distance of a pin from the first pin of its body
  integer, parameter :: demand_angle = 2  !! its direction from there
  integer, parameter :: demand_line = 3   !! a pin on the line of a slider
  integer, parameter :: demand_turn = 4   !! bodies that turn together
  integer, parameter :: demand_drive = 5  !! the coordinate of a drive

  !> How a group is placed.
  integer, parameter :: group_dyad = 1         !! two bodies that meet in a pin (RRR)
  integer, parameter :: group_carried = 2      !! pins of a body that is placed
  integer, parameter :: group_on_line = 3      !! a body with its end on a line (RRP)
  integer, parameter :: group_through_pin = 4  !! a body whose line passes through a pin (RPR)
  integer, parameter :: group_two_lines = 5    !! a pin on two lines (PRP)
  integer, parameter :: group_cross_slide = 6  !! a body that does not turn, with a pin on a line
                                               !! and its own line through a pin (PPR)
  integer, parameter :: group_turned = 7       !! a body whose angle is given
  integer, parameter :: group_spanned = 8      !! a body between two pins
  integer, parameter :: group_placed = 9       !! a pin whose place on a line is given
  integer, parameter :: group_by_newton = 10   !! by iterations
  integer, parameter :: group_driven_dyad = 11 !! RRR with driven lengths

  !> A mass fixed to a body. In the axes of the body x is along it and y to the left, looking from
  !! its first pin to its last.
  type :: lump_t
    real(wp) :: mass = 0.0_wp      !! [kg]
    real(wp) :: place(2) = 0.0_wp  !! of its mass centre, from the first pin, in the axes of the
                                   !! body [m]
    real(wp) :: inertia = 0.0_wp   !! moment of inertia about its own mass centre [kg m²]
    real(wp) :: rotary_inertia = 0.0_wp !! ρI L of cross-sections that is in it [kg m²]
  end type lump_t

  !> A place of a body where a force acts that a pose determines.
  type :: forced_place_t
    integer :: load = 0            !! number among the loads of the linkage
    real(wp) :: place(2) = 0.0_wp  !! from the first pin, in the axes of the body [m]
  end type forced_place_t

  !> A further pin of a body.
  type :: body_pin_t
    integer :: pin = 0
    real(wp) :: place(2) = 0.0_wp  !! from the first pin, in the axes of the body [m]
  end type body_pin_t

  !> A straight link: uniform, with lumps, or a rigid shape of any kind, given by lumps alone. Its
  !! coordinate runs from its first pin to its last: from where it is placed.
  type :: body_t
    integer :: first_pin = 0              !! placed before the body, unless its group places both
    integer :: last_pin = 0
    real(wp) :: length = 0.0_wp           !! [m]
    real(wp) :: line_density = 0.0_wp     !! mass per length [kg/m]
    real(wp) :: heading(2) = [1.0_wp, 0.0_wp] !! unit vector, in its axes, whose angle is that of
                                          !! the body; [−1, 0]: its angle is that of last → first
    real(wp) :: origin(2) = 0.0_wp        !! from its first pin, in its axes: the first pin of the
                                          !! deck, from which the deck measures [m]
    real(wp) :: card_axis(2) = [1.0_wp, 0.0_wp] !! unit vector, in its axes, along which the deck
                                          !! measures
    real(wp) :: rotary_inertia = 0.0_wp   !! ρI of its cross-sections per length [kg m];
                                          !! 0: neglected
    logical :: bends = .true.             !! as a beam; else rigid
    logical :: may_brace = .false.        !! it is a beam, which may join two pins that it does not
                                          !! move: ground pivots, or pins of one other body
    integer, allocatable :: corners(:)    !! pins in their order along the axis of one that bends
                                          !! and is no straight way from its first to its last pin:
                                          !! straight from each to the next, which are welded there;
                                          !! of a closed frame the last is the first. Not allocated:
                                          !! that way, or a rigid body
    type(lump_t), allocatable :: lumps(:) !! masses fixed to it
    integer :: own_lumps = 0              !! how many of them, the first, are the link itself: none
                                          !! of a uniform link, one of a link with a mass of its
                                          !! own, else one per segment
    type(body_pin_t), allocatable :: further(:) !! pins beside its first and its last
    type(forced_place_t), allocatable :: forced(:) !! where forces act on it; not allocated: none
  end type body_t

  !> A pin that slides along a straight line: fixed, or of a body.
  type :: slider_t
    integer :: pin = 0
    integer :: body = 0                          !! that has the line; 0: it is fixed
    real(wp) :: point(2) = 0.0_wp                !! of the line: in global axes, or from the first
                                                 !! pin in the axes of the body [m]
    real(wp) :: direction(2) = [1.0_wp, 0.0_wp]  !! unit vector, likewise
    logical :: has_ends = .false.                !! the line is no longer than `ends`
    real(wp) :: ends(2) = 0.0_wp                 !! along `direction` from `point` [m]
    real(wp) :: inertia = 0.0_wp                 !! of the block, which turns with the body; among
                                                 !! the lumps of the body [kg m²]
  end type slider_t

  !> Two bodies that turn together, or a body that does not turn.
  type :: turn_t
    integer :: body = 0                         !! number, from 1
    integer :: against = 0                      !! the other one; 0: the ground
    real(wp) :: relative(2) = [1.0_wp, 0.0_wp]  !! direction of `body` in the axes of the other
    integer :: slider = 0                       !! whose block it is; 0: a weld
    integer :: pin = 0                          !! where they do
  end type turn_t

  !> An input. Its coordinate is `ratio*c + phase` with the coordinate c of the first one, or it has
  !! a law of its own, in a linkage that runs in time.
  type :: drive_t
    integer :: kind = drive_of_angle  !! one of the drive_of_… constants
    integer :: body = 0               !! that turns, or whose length changes
    integer :: against = 0            !! body from which its angle is measured; 0: the ground
    integer :: slider = 0             !! that is moved
    integer :: coordinate = 0         !! that is given, number
    logical :: is_angle = .false.     !! this coordinate is one; else a length
    real(wp) :: ratio = 1.0_wp        !! to the first drive's [-], or between angle and length
                                      !! [m/deg], [deg/m]
    real(wp) :: phase = 0.0_wp        !! [deg] or [m]
    logical :: has_law = .false.      !! its coordinate is that of `law`, plus `phase`
    type(motion_program_t) :: law     !! over the time [deg] or [m]
    logical :: is_free = .false.      !! its coordinate is given, but nothing holds it there when
                                      !! the linkage vibrates
  end type drive_t

  !> What gives an effort along a coordinate.
  type :: actuator_t
    integer :: coordinate = 0             !! number of the coordinate
    character(len=:), allocatable :: name !! for messages
  end type actuator_t

  !> Rough places of pins.
  type :: drawing_t
    logical, allocatable :: is_drawn(:) !! (pins)
    real(wp), allocatable :: pin(:, :)  !! (2, pins) in global axes [m]; zero where not drawn
    logical, allocatable :: follows(:)  !! (pins) its place follows from those of others; not
                                        !! allocated: none does
  end type drawing_t

  !> What bodies, sliders, turns and drives demand.
  type :: equation_t
    integer :: kind = 0              !! one of the demand_… constants
    integer :: body = 0              !! that it is about; 0: a pin on a fixed line, or a coordinate
    integer :: pin = 0               !! of the body, of which it gives length or direction; else 0
    real(wp) :: place(2) = 0.0_wp    !! of that pin, from the first one, in the axes of the body [m]
    integer :: number = 0            !! of the slider, turn or drive
    type(coordinate_t) :: coordinate !! that it holds. The terminals of an angle have directions
                                     !! that agree where it is fulfilled; the first one of a drive
                                     !! is still to be turned by what this gives
  end type equation_t

  !> Pins and bodies that are placed together. Those of `group_dyad` are two bodies that meet in a
  !! pin, each attached to a pin that is placed before; those of `group_carried` are pins of a body
  !! placed before.
  type :: group_t
    integer :: kind = group_dyad  !! one of the group_… constants
    integer :: base(2) = 0         !! pins that carry it
    integer :: body(2) = 0         !! bodies from each base to the middle
    integer :: middle = 0          !! pin where the bodies meet
    real(wp) :: side = 1.0_wp      !! +1: the middle lies to the left of base 1 → base 2, −1: to its
                                   !! right; on a line: beyond the foot of the perpendicular, before
    integer :: slider(2) = 0       !! whose lines place it
    real(wp) :: usual = 1.0_wp     !! of one by iterations: smallest singular value of its equations
                                   !! of an ordinary size
    integer, allocatable :: pins(:)    !! that it places
    integer, allocatable :: bodies(:)  !! that it turns
    integer, allocatable :: loaded(:)  !! bodies whose loads it bears
    type(equation_t), allocatable :: equations(:) !! as many as it has unknowns; none of
                                                  !! `group_dyad` and `group_carried`
  end type group_t

  !> A piece of the path about a change point, where equations depend on each other and two smooth
  !! ways cross: what lies between is the polynomial through nodes on both sides. Or the last piece
  !! before a limit.
  type :: bridge_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp       !! where it holds [deg] or [m]
    real(wp) :: change = 0.0_wp                  !! the change point [deg] or [m]
    real(wp) :: error = 0.0_wp                   !! estimated, of places per size of the linkage
    integer :: group = 0                         !! whose determinant is 0 there
    logical :: by_sine = .false.                 !! to a limit: the polynomial is one in this
                                                 !! determinant; else in the coordinate
    logical :: is_jump = .false.                 !! on the sides of groups it is no corner but a
                                                 !! jump: the pins that carry a dyad meet
    real(wp), allocatable :: crank(:)            !! (nodes) ascending, or towards a limit [deg], [m]
    real(wp), allocatable :: pin(:, :, :)        !! (2, pins, nodes) from `reference_point` [m]
    real(wp), allocatable :: direction(:, :, :)  !! (2, bodies, nodes)
    real(wp), allocatable :: sine(:, :)          !! (groups, nodes) as in `pose_t`
  end type bridge_t

  !> The way of a linkage with change points, or with groups that only iterations place: from the
  !! drawing over whole turns.
  type :: path_t
    real(wp), allocatable :: crank(:)            !! (stations) ascending [deg] or [m]
    real(wp), allocatable :: pin(:, :, :)        !! (2, pins, stations) from `reference_point` [m]
    real(wp), allocatable :: direction(:, :, :)  !! (2, bodies, stations)
    real(wp), allocatable :: pin_rate(:, :, :)   !! (2, pins, stations) per crank [m/deg], [-]
    real(wp), allocatable :: turn_rate(:, :)     !! (bodies, stations) per crank [rad/deg], [rad/m]
    real(wp), allocatable :: side(:, :)          !! (groups, stations) as `side` of `group_t`
    type(bridge_t), allocatable :: bridges(:)    !! between stations, ascending; over change points
                                                 !! that are known, without stations too
    real(wp) :: period = 0.0_wp                  !! after which it repeats [deg]; 0: it does not
    logical :: stops = .false.                   !! nothing closes beyond its ends
    logical :: is_lost(2) = .false.              !! dyads close beyond its first, its last station,
                                                 !! but it has not been followed there
    type(bridge_t) :: limits(2)                  !! below the first and above the last station, as
                                                 !! far as the limit of a group; without nodes: none
  end type path_t

  !> A balance shaft, geared to the first drive: with the coordinate c of this one its mass is in
  !! the direction `turns*c + phase`.
  type :: shaft_t
    integer :: turns = 0                   !! in one of the first drive; negative: against it
    real(wp) :: first_moment = 0.0_wp      !! mass × radius [kg m]
    real(wp) :: phase = 0.0_wp             !! from the global x axis [deg]
    real(wp) :: place(2) = 0.0_wp          !! of its axis in global axes [m]
    real(wp) :: radius = 0.0_wp            !! of its mass [m]
    real(wp) :: inertia = 0.0_wp           !! moment of inertia about its axis [kg m²]
  end type shaft_t

  !> Pins, bodies, what joins and drives them, and loads.
  type :: linkage_t
    logical, allocatable :: is_ground(:)           !! (pins) fixed to the ground
    real(wp), allocatable :: ground_position(:, :) !! (2, pins) [m]; zero for moving pins
    real(wp), allocatable :: pin_mass(:)           !! (pins) [kg]
    real(wp) :: gravity(2) = 0.0_wp                !! [m/s²]
    real(wp), allocatable :: pin_force(:, :)       !! (2, pins) constant external forces on the
                                                   !! pins [N]
    real(wp), allocatable :: couple(:)             !! (bodies) constant external torques [N m]
    type(applied_load_t), allocatable :: loads(:)  !! all others
    type(coordinate_t), allocatable :: coordinates(:) !! that have names, and terms of them
    type(joint_friction_t), allocatable :: frictions(:) !! of joints that rub; not allocated: none
    type(body_t), allocatable :: bodies(:)         !! in the order in which they are placed
    type(slider_t), allocatable :: sliders(:)      !! pins on lines
    type(turn_t), allocatable :: turns(:)          !! bodies that turn together
    type(drive_t), allocatable :: drives(:)        !! the first is the crank of tables and speeds
    type(actuator_t), allocatable :: actuators(:)  !! (drives) whose efforts hold and move it, while
                                                   !! the drives give its motion alone; not
                                                   !! allocated: the drives do both
    logical :: runs_in_time = .false.              !! drives have laws that do not follow the first
                                                   !! one: wherever a linkage is placed and moved
                                                   !! by the coordinate of the first drive, the time
                                                   !! in s takes its place. The first drive has a
                                                   !! law; rates are per second, and the speed is 1,
                                                   !! the acceleration 0
    real(wp) :: times(2) = 0.0_wp                  !! first and last instant, in time [s]
    type(drawing_t) :: drawing                     !! where pins are about, to start from
    logical :: has_crank = .true.                  !! the first drive turns the first body about its
                                                   !! first pin, a ground pivot
    type(group_t), allocatable :: groups(:)        !! what is placed together, in this order; the
                                                   !! crank is placed before
    type(equation_t), allocatable :: redundancies(:) !! that the others fulfil, or the linkage does
                                                   !! not fit
    type(path_t) :: path                           !! of groups without a closed form
    type(shaft_t), allocatable :: shafts(:)        !! balance shafts, of balanced linkages only
  end type linkage_t

contains

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

  !> The place from which positions are counted while they are found, so that a far-off origin of
  !! the drawing costs no digits: the crank's pivot; without a crank a ground pivot, or a fixed
  !! line.
  pure function reference_point(linkage) result(point)
    type(linkage_t), intent(in) :: linkage !! its pins and sliders
    real(wp) :: point(2)                   !! in global axes [m]

    integer :: i

    if (linkage%has_crank) then
      point = linkage%ground_position(:, linkage%bodies(1)%first_pin)
      return
    end if
    point = 0.0_wp
    i = findloc(linkage%is_ground, .true., dim=1)
    if (i > 0) then
      point = linkage%ground_position(:, i)
    else
      i = findloc(linkage%sliders%body, 0, dim=1)
      if (i > 0) point = linkage%sliders(i)%point
    end if
  end function reference_point

  !> Whether a crank and dyads of binary links are all: closed forms of four-bars and bending links
  !! know no more, and no actuators.
  pure function is_dyad_linkage(linkage) result(is)
    type(linkage_t), intent(in) :: linkage !! its bodies and groups
    logical :: is

    is = linkage%has_crank .and. all(linkage%groups%kind == group_dyad) .and. &
      size(linkage%sliders) == 0 .and. size(linkage%drives) == 1 .and. .not. is_actuated(linkage)
  end function is_dyad_linkage

  !> Whether efforts act along other coordinates than those of the drives.
  pure function is_actuated(linkage) result(is)
    type(linkage_t), intent(in) :: linkage !! its actuators
    logical :: is

    is = allocated(linkage%actuators)
  end function is_actuated

  !> Whether a linkage is placed and moved by an angle in degrees, of which derivatives are per
  !! radian; else by a length, or by the time.
  pure function follows_angle(linkage) result(follows)
    type(linkage_t), intent(in) :: linkage !! its drives
    logical :: follows

    follows = gives_angle(linkage%drives(1)) .and. .not. linkage%runs_in_time
  end function follows_angle

  !> Whether a drive gives an angle, in degrees; else a length.
  elemental function gives_angle(drive) result(is)
    type(drive_t), intent(in) :: drive
    logical :: is

    is = drive%kind == drive_of_angle .or. drive%kind == drive_of_coordinate .and. drive%is_angle
  end function gives_angle

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

  !> A vector in the axes that a unit vector gives: `a(1)` along it, `a(2)` to its left.
  pure function turned(a, axis) result(vector)
    real(wp), intent(in) :: a(2)    !! components
    real(wp), intent(in) :: axis(2) !! unit vector
    real(wp) :: vector(2)

    vector = a(1)*axis + a(2)*[-axis(2), axis(1)]
  end function turned

  !> Components of a vector along a unit vector and to its left: the inverse of `turned`.
  pure function turned_back(a, axis) result(components)
    real(wp), intent(in) :: a(2)    !! vector
    real(wp), intent(in) :: axis(2) !! unit vector
    real(wp) :: components(2)

    components = turned(a, [axis(1), -axis(2)])
  end function turned_back

end module linkages
