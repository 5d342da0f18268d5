!> Where a linkage rests whose drive does not act, over all ranges of its first drive.
module equilibrium_study
  use applied_load_types, only: applied_load_t, counts_turns
  use constants, only: degree
  use crank_limits, only: crank_range_t, find_ranges
  use equilibrium_search, only: equilibrium_t, search_range
  use holding_forces, only: holding_force_t, holding_sample_t
  use kinds, only: wp
  use lagrange, only: lagrange_t
  use limits_study, only: everywhere
  use linkage_paths, only: period_of
  use linkages, only: gives_angle, linkage_t
  use load_tables, only: load_period
  use rigid_bodies, only: rigid_bodies_of
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: equilibria_t, find_equilibria

  !> Potential and what a drive would have to give, at a position at rest.
  type :: potential_t
    real(wp) :: crank = 0.0_wp     !! coordinate of the first drive [deg] or [m]
    real(wp) :: potential = 0.0_wp !! of weights, constant forces and springs [N m]
    real(wp) :: force = 0.0_wp     !! of the drive [N m] or [N]
    logical :: is_known = .false.  !! false at dead points, and beyond what loads allow
  end type potential_t

  type :: equilibria_t
    type(equilibrium_t), allocatable :: at(:) !! ascending
    type(potential_t), allocatable :: curve(:) !! evenly over all ranges, one after the other
    integer, allocatable :: first(:)          !! (ranges) where each begins there
    integer :: gaps = 0                       !! samples at which loads or links have no value
    real(wp) :: sampled(2) = 0.0_wp           !! from, to of all samples [deg] or [m]
    logical :: is_cut = .false.               !! springs that count turns would need more of them
  end type equilibria_t

contains

  !> Finds all rests in all ranges of the first drive.
  subroutine find_equilibria(linkage, elements, positions, found)
    type(linkage_t), intent(in) :: linkage     !! with masses and loads, one free drive
    integer, intent(in) :: elements(:)         !! (bodies) on whose nodes masses are lumped; 0:
                                               !! distributed
    real(wp), intent(in) :: positions(:)       !! of the deck: of a driven length ranges are looked
                                               !! for from there, without any everywhere
    type(equilibria_t), intent(out) :: found   !! of all ranges

    type(holding_force_t) :: holding
    type(crank_range_t), allocatable :: ranges(:)
    type(equilibrium_t), allocatable :: rests(:)
    real(wp), allocatable :: inside(:)
    integer, allocatable :: order(:)
    real(wp) :: ends(2)
    integer :: gaps, r

    holding%linkage = linkage
    holding%rigid = rigid_bodies_of(linkage, elements)
    inside = positions
    if (size(inside) == 0) inside = everywhere(linkage)
    call find_ranges(linkage, inside, ranges)
    allocate (found%at(0), found%curve(0), found%first(size(ranges)))
    do r = 1, size(ranges)
      ends = [ranges(r)%from, ranges(r)%to]
      if (ranges(r)%turns) then
        call extend_turns(holding, ends, found%is_cut)
      else
        call choose_turn(linkage, positions, ends)
      end if
      found%is_cut = found%is_cut .or. any(ranges(r)%is_open)
      if (r == 1) found%sampled = ends
      found%sampled = [min(found%sampled(1), ends(1)), max(found%sampled(2), ends(2))]
      call search_range(holding, ends, ranges(r)%turns, rests, gaps)
      found%at = [found%at, rests]
      found%gaps = found%gaps + gaps
      found%first(r) = size(found%curve) + 1
      call draw_curve(holding, ends, found%curve)
    end do
    order = ascending_order(found%at%crank)
    found%at = found%at(order)
  end subroutine find_equilibria

  !> Appends the potential over a range: 361 positions, or 90 a turn of many turns.
  pure subroutine draw_curve(holding, ends, curve)
    type(holding_force_t), intent(in) :: holding
    real(wp), intent(in) :: ends(2) !! [deg] or [m]
    type(potential_t), allocatable, intent(inout) :: curve(:)

    integer, parameter :: fewest = 360, each_turn = 90
    type(potential_t), allocatable :: longer(:)
    type(lagrange_t) :: terms
    integer :: i, n, before

    n = fewest
    if (gives_angle(holding%linkage%drives(1))) n = max(n, ceiling((ends(2) - &
      ends(1))/360.0_wp)*each_turn)
    before = size(curve)
    allocate (longer(before + n + 1))
    longer(:before) = curve
    do i = 0, n
      associate (point => longer(before + 1 + i))
        point%crank = (ends(1)*(n - i) + ends(2)*i)/n
        call holding%find_terms(point%crank, terms, point%is_known)
        point%potential = terms%potential
        point%force = terms%gravity + terms%load
      end associate
    end do
    call move_alloc(longer, curve)
  end subroutine draw_curve

  !> Springs and stops on the angle of the first drive count its turns: rests are where their torque
  !! is no more than all other loads can give, and within a turn before a stop.
  pure subroutine extend_turns(holding, ends, is_cut)
    type(holding_force_t), intent(in) :: holding
    real(wp), intent(inout) :: ends(2) !! of a whole period [deg]
    logical, intent(inout) :: is_cut   !! these would be more than `most_turns`

    integer, parameter :: steps = 360, most_turns = 64
    type(holding_force_t) :: others
    type(holding_sample_t) :: sample
    real(wp) :: stiffness, moment, most, press, reach(2)
    integer :: i

    if (load_period(holding%linkage, period_of(holding%linkage)) > 0.0_wp) return
    if (.not. any(counts_drive(holding%linkage%loads))) return
    others = holding
    where (counts_drive(others%linkage%loads)) others%linkage%loads%law%stiffness = 0.0_wp
    most = 0.0_wp
    do i = 0, steps - 1
      sample = others%sample(ends(1) + (ends(2) - ends(1))*i/steps)
      if (sample%is_known) most = max(most, abs(sample%force))
    end do
    associate (loads => holding%linkage%loads)
      associate (is_spring => counts_drive(loads) .and. loads%law%side == 0)
        stiffness = sum(loads%law%stiffness, mask=is_spring)
        moment = sum(loads%law%stiffness*loads%law%rest, mask=is_spring)
      end associate
      reach = [huge(1.0_wp), -huge(1.0_wp)]
      if (stiffness > 0.0_wp) reach = moment/stiffness + [-1.0_wp, 1.0_wp]*(1.1_wp*most/stiffness &
        + 10.0_wp*degree)
      do i = 1, size(loads)
        associate (stop => loads(i))
          if (.not. counts_drive(stop) .or. stop%law%side == 0) cycle
          press = 1.1_wp*(most + abs(stiffness*stop%law%rest - moment))/stop%law%stiffness + &
            10.0_wp*degree
          reach(1) = min(reach(1), stop%law%rest - merge(360.0_wp*degree, press, stop%law%side > 0))
          reach(2) = max(reach(2), stop%law%rest + merge(press, 360.0_wp*degree, stop%law%side > 0))
        end associate
      end do
    end associate
    ends = reach/degree
    is_cut = is_cut .or. ends(2) - ends(1) > most_turns*360.0_wp
    if (ends(2) - ends(1) > most_turns*360.0_wp) ends = 0.5_wp*sum(ends) + &
      [-180.0_wp, 180.0_wp]*most_turns
  end subroutine extend_turns

  !> Of a range that is less than a turn, the turn that the deck is about: with one of its positions
  !! in it, or else that nearest to the rest of a load that counts turns.
  pure subroutine choose_turn(linkage, positions, ends)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: positions(:) !! of the deck [deg]
    real(wp), intent(inout) :: ends(2)   !! [deg]

    real(wp) :: turns
    integer :: i

    if (.not. gives_angle(linkage%drives(1))) return
    if (.not. any(counts_drive(linkage%loads))) return
    do i = 1, size(positions)
      turns = floor((positions(i) - ends(1))/360.0_wp)
      if (positions(i) - 360.0_wp*turns > ends(2)) cycle
      ends = ends + 360.0_wp*turns
      return
    end do
    i = findloc(counts_drive(linkage%loads), .true., dim=1)
    ends = ends + 360.0_wp*anint((linkage%loads(i)%law%rest/degree - 0.5_wp*sum(ends))/360.0_wp)
  end subroutine choose_turn

  !> Whether a load is along the angle of the first drive, with its turns.
  elemental function counts_drive(load) result(counts)
    type(applied_load_t), intent(in) :: load
    logical :: counts

    counts = counts_turns(load) .and. load%along%drive == 1 .and. load%law%stiffness > 0.0_wp
  end function counts_drive

end module equilibrium_study
