!> Counterweights of linkages whose links hang on each other by pins without a loop: slider-cranks,
!! inverted ones, quick-returns, open arms.
!!
!! G. R. Tepper, G. G. Lowen: General theorems concerning full force balancing of planar linkages by
!! internal mass redistribution. J. Eng. Ind. 94 (1972) 789: counterweights can balance the shaking
!! force of a linkage if from every link a way of pins leads to the ground. Where this is the only
!! way, each link is balanced about the pin of it that is nearest to the ground, together with all
!! that hangs on the link. What hangs there then acts as a mass at that pin, wherever it turns.
module hung_counterweights
  use balanced_linkages, only: counterweight_t
  use kinds, only: wp
  use linkages, only: drive_of_length, linkage_t, turned_back
  use pose_types, only: pins_of_body, place_of_pin
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  implicit none (type, external)
  private

  public :: obstacle_t, find_hung_counterweights
  public :: obstacle_none, obstacle_loop, obstacle_ram, obstacle_link, obstacle_pin

  !> Why there are no counterweights: a loop of pins; a link whose length changes; a link, or a pin
  !! with mass, from which no way of pins leads to the ground.
  integer, parameter :: obstacle_none = 0, obstacle_loop = 1, obstacle_ram = 2, &
    obstacle_link = 3, obstacle_pin = 4

  type :: obstacle_t
    integer :: kind = obstacle_none
    integer :: number = 0 !! of the link or pin
  end type obstacle_t

  !> How links hang on each other.
  type :: hanging_t
    integer, allocatable :: pin(:)   !! (bodies) through which each hangs; 0: it does not
    integer, allocatable :: order(:) !! bodies, each behind the one on which it hangs
  end type hanging_t

contains

  !> The counterweights of all links, in the order of the bodies (B2). Their radii are the lengths
  !! of the links: a link bears the mass of the counterweights that hang on it, so that its own
  !! depends on their radii. Links that do not turn need none.
  pure subroutine find_hung_counterweights(linkage, elements, weights, obstacle)
    type(linkage_t), intent(in) :: linkage !! of any kind
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    type(counterweight_t), allocatable, intent(out) :: weights(:) !! (bodies) none if there is an
                                                                  !! obstacle
    type(obstacle_t), intent(out) :: obstacle

    type(hanging_t) :: hanging
    type(rigid_body_t) :: rigid(size(linkage%bodies))
    real(wp) :: load(size(linkage%pin_mass))
    logical :: turns(size(linkage%bodies))
    integer :: i, b

    hanging = hanging_of(linkage)
    obstacle = obstacle_of(linkage, hanging)
    allocate (weights(merge(size(linkage%bodies), 0, obstacle%kind == obstacle_none)))
    if (obstacle%kind /= obstacle_none) return
    rigid = rigid_bodies_of(linkage, elements)
    turns = bodies_that_turn(linkage)
    load = linkage%pin_mass
    do i = size(hanging%order), 1, -1
      b = hanging%order(i)
      call balance_body(linkage, b, hanging%pin(b), rigid(b), turns(b), load, weights(b))
    end do
  end subroutine find_hung_counterweights

  !> From which pin every body hangs: the ground's pins first, then those of the bodies found.
  pure function hanging_of(linkage) result(hanging)
    type(linkage_t), intent(in) :: linkage
    type(hanging_t) :: hanging

    logical :: is_reached(size(linkage%is_ground))
    integer :: b, k, before

    is_reached = linkage%is_ground
    allocate (hanging%pin(size(linkage%bodies)), hanging%order(0))
    hanging%pin = 0
    do
      before = size(hanging%order)
      do b = 1, size(linkage%bodies)
        if (hanging%pin(b) > 0) cycle
        associate (pins => pins_of_body(linkage%bodies(b)))
          k = findloc(is_reached(pins), .true., dim=1)
          if (k == 0) cycle
          hanging%pin(b) = pins(k)
          hanging%order = [hanging%order, b]
          is_reached(pins) = .true.
        end associate
      end do
      if (size(hanging%order) == before) exit
    end do
  end function hanging_of

  !> What prevents counterweights. Bodies that all hang on the ground have no loop if they are
  !! joined by as many pins as there are bodies; a pin of k links, the ground among them, counts as
  !! k − 1.
  pure function obstacle_of(linkage, hanging) result(obstacle)
    type(linkage_t), intent(in) :: linkage
    type(hanging_t), intent(in) :: hanging
    type(obstacle_t) :: obstacle

    integer :: links(size(linkage%is_ground)), b, loose

    links = merge(1, 0, linkage%is_ground)
    do b = 1, size(linkage%bodies)
      associate (pins => pins_of_body(linkage%bodies(b)))
        links(pins) = links(pins) + 1
      end associate
    end do
    b = findloc(hanging%pin, 0, dim=1)
    loose = findloc(links == 0 .and. linkage%pin_mass > 0.0_wp, .true., dim=1)
    if (b > 0) then
      obstacle = obstacle_t(obstacle_link, b)
    else if (loose > 0) then
      obstacle = obstacle_t(obstacle_pin, loose)
    else if (sum(max(links - 1, 0)) > size(linkage%bodies)) then
      obstacle = obstacle_t(obstacle_loop, 0)
    else if (any(linkage%drives%kind == drive_of_length)) then
      b = findloc(linkage%drives%kind, drive_of_length, dim=1)
      obstacle = obstacle_t(obstacle_ram, linkage%drives(b)%body)
    end if
  end function obstacle_of

  !> Which bodies turn: not those fixed to a block on a fixed guide, nor those welded to such.
  pure function bodies_that_turn(linkage) result(turns)
    type(linkage_t), intent(in) :: linkage
    logical :: turns(size(linkage%bodies))

    integer :: i, k

    turns = .true.
    do k = 1, size(linkage%turns)
      do i = 1, size(linkage%turns)
        associate (body => linkage%turns(i)%body, against => linkage%turns(i)%against)
          if (against == 0) then
            turns(body) = .false.
          else if (.not. (turns(body) .and. turns(against))) then
            turns([body, against]) = .false.
          end if
        end associate
      end do
    end do
  end function bodies_that_turn

  !> The counterweight of a body about the pin from which it hangs; its mass, that of its
  !! counterweight and those at its other pins are added to the mass at that pin.
  pure subroutine balance_body(linkage, number, pin, rigid, turns, load, weight)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number           !! of the body
    integer, intent(in) :: pin              !! from which it hangs
    type(rigid_body_t), intent(in) :: rigid
    logical, intent(in) :: turns
    real(wp), intent(inout) :: load(:)      !! (pins) masses, with all that hangs on them [kg]
    type(counterweight_t), intent(out) :: weight

    real(wp), parameter :: rounding = 1.0e-14_wp
    real(wp) :: from(2), way(2), moment_here(2), moment(2), usual
    integer :: pins(2 + size(linkage%bodies(number)%further)), k

    associate (body => linkage%bodies(number))
      pins = pins_of_body(body)
      weight%body = number
      weight%pin = pin
      weight%towards = merge(pins(2), pins(1), pins(1) == pin)
      from = place_of_pin(body, pin)
      moment = rigid%first_moment - rigid%mass*from
      usual = norm2(rigid%first_moment) + rigid%mass*norm2(from)
      load(pin) = load(pin) + rigid%mass
      do k = 1, size(pins)
        if (pins(k) == pin) cycle
        moment_here = load(pins(k))*(place_of_pin(body, pins(k)) - from)
        moment = moment + moment_here
        usual = usual + norm2(moment_here)
        load(pin) = load(pin) + load(pins(k))
      end do
      if (.not. turns) return
      way = place_of_pin(body, weight%towards) - from
      weight%first_moment = -turned_back(moment, way/norm2(way))
      weight%needed = norm2(moment) > rounding*usual
      if (weight%needed) load(pin) = load(pin) + norm2(moment)/body%length
    end associate
  end subroutine balance_body

end module hung_counterweights
