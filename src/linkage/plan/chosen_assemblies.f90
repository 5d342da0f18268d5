!> The assembly that cards describe which are about other pins than those that dyads place: links
!! more than needed give a pin a second way to be placed.
!!
!! Such a card is carried over: of the assemblies at a position of the deck it takes those that
!! have its pin on its side.
module chosen_assemblies
  use errors, only: error_t
  use group_equations, only: world_line
  use kinds, only: wp
  use linkages, only: cross, follows_angle, linkage_t, reference_point
  use plan_problems, only: new_problem, plan_problem_t, problem_sides_differ
  use plan_sides, only: card_about, find_line, problem_of_group, side_t, undecided_t
  use pose_types, only: drawn_pose, pose_t
  use poses, only: place_groups
  use redundancies, only: refuse_misfit
  implicit none (type, external)
  private

  public :: choose_assembly

  !> Groups whose sides are tried, and positions, at most.
  integer, parameter :: most_groups = 10, most_places = 100

  !> So far beside the first position of the deck one more is tried [deg].
  real(wp), parameter :: beside = 10.0_wp

  !> Below this sine a pin is on neither side.
  real(wp), parameter :: flat = 1.0e-6_wp

contains

  !> Chooses the sides of groups without a card so that all cards hold. Of several such assemblies
  !! it takes those that fit, then those that are most as drawn.
  !!
  !! Problems: no assembly has the sides of all cards; several have.
  pure subroutine choose_assembly(linkage, sides, undecided, cranks, problem)
    type(linkage_t), intent(inout) :: linkage       !! planned; sides of its groups are set
    type(side_t), intent(in) :: sides(:)            !! of its pins
    type(undecided_t), intent(in) :: undecided      !! of this plan
    real(wp), intent(in) :: cranks(:)               !! positions that may be tried [deg] or [m]
    type(plan_problem_t), allocatable, intent(inout) :: problem !! why there is no such assembly

    integer, allocatable :: groups(:), chosen(:)
    logical, allocatable :: closes(:), fits(:), holds(:, :), is_good(:)
    logical :: is_open(min(size(undecided%groups), most_groups)), is_flat
    real(wp), allocatable :: side(:), places(:)
    integer :: i, k

    if (size(undecided%cards) == 0) return
    groups = [pack(undecided%groups, undecided%is_open), pack(undecided%groups, .not. &
      undecided%is_open)]
    is_open = [(i <= count(undecided%is_open), i=1, size(is_open))]
    groups = groups(:size(is_open))
    side = linkage%groups%side
    places = cranks(:min(size(cranks), most_places))
    if (follows_angle(linkage)) places = [places, cranks(1) + beside]
    do i = 1, size(places)
      call try_assemblies(linkage, sides(undecided%cards), groups, side, places(i), closes, fits, &
        holds, is_flat)
      if (is_flat .or. .not. any(closes)) cycle
      is_good = closes .and. all(holds, dim=1)
      if (.not. any(is_good)) then
        problem = contradiction(linkage, sides, undecided, groups, places(i), closes, holds)
        return
      end if
      if (any(is_good .and. fits)) is_good = is_good .and. fits
      ! The sides of the drawing stay, if they may.
      chosen = [(popcnt(iand(k, mask_of(.not. is_open))), k=0, size(closes) - 1)]
      is_good = is_good .and. chosen == minval(chosen, mask=is_good)
      chosen = pack([(k, k=0, size(closes) - 1)], is_good)
      if (size(chosen) > 1) then
        k = 1 + trailz(ieor(chosen(1), chosen(2)))
        problem = problem_of_group(linkage%groups(groups(k)), sides)
      else
        call turn_sides(groups, chosen(1), side)
        linkage%groups%side = side
        if (.not. any(is_good .and. fits)) call refuse_misfit_of_cards(linkage, sides, undecided, &
          groups, places(i), closes .and. fits, holds, problem)
      end if
      return
    end do
    if (any(is_open)) problem = problem_of_group(linkage%groups(groups(1)), sides)
  end subroutine choose_assembly

  !> All assemblies at a position: bit i of their numbers, from 0, turns the side of group i + 1.
  pure subroutine try_assemblies(linkage, cards, groups, side, crank, closes, fits, holds, is_flat)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: cards(:)
    integer, intent(in) :: groups(:)   !! numbers
    real(wp), intent(in) :: side(:)    !! of all groups
    real(wp), intent(in) :: crank
    logical, allocatable, intent(out) :: closes(:), fits(:) !! (assemblies)
    logical, allocatable, intent(out) :: holds(:, :) !! (cards, assemblies) the pin is on its side
    logical, intent(out) :: is_flat    !! a pin is on neither side

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp) :: its_sides(size(side)), correction, sine
    integer :: k, i

    allocate (closes(0:2**size(groups) - 1), fits(0:2**size(groups) - 1), holds(size(cards), &
      0:2**size(groups) - 1))
    closes = .false.
    fits = .false.
    holds = .false.
    is_flat = .false.
    do k = 0, size(closes) - 1
      its_sides = side
      call turn_sides(groups, k, its_sides)
      pose = drawn_pose(linkage, reference_point(linkage))
      if (allocated(error)) deallocate (error)
      call place_groups(linkage, crank, pose, correction, error, its_sides)
      closes(k) = .not. allocated(error)
      if (.not. closes(k)) cycle
      do i = 1, size(cards)
        sine = sine_of(linkage, cards(i), pose)
        is_flat = is_flat .or. abs(sine) < flat
        holds(i, k) = sine*cards(i)%side > 0.0_wp
      end do
      call refuse_misfit(linkage, pose, crank, error)
      fits(k) = .not. allocated(error)
    end do
  end subroutine try_assemblies

  !> Turns the sides of the groups of an assembly.
  pure subroutine turn_sides(groups, number, side)
    integer, intent(in) :: groups(:)
    integer, intent(in) :: number !! of the assembly, from 0
    real(wp), intent(inout) :: side(:)

    integer :: i

    do i = 1, size(groups)
      if (btest(number, i - 1)) side(groups(i)) = -side(groups(i))
    end do
  end subroutine turn_sides

  !> The number whose bits are those that are true.
  pure function mask_of(bits) result(mask)
    logical, intent(in) :: bits(:)
    integer :: mask

    integer :: i

    mask = sum([(merge(2**(i - 1), 0, bits(i)), i=1, size(bits))])
  end function mask_of

  !> On which side a pin is at a pose: as `side` of a card, times the sine of the angle between its
  !! ways, or on a line the cosine of that between way and line.
  pure function sine_of(linkage, card, pose) result(sine)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: card
    type(pose_t), intent(in) :: pose
    real(wp) :: sine

    real(wp) :: axis(2), point(2), way(2)
    integer :: slider, base

    base = card%base(1)
    if (card%on_line) then
      call find_line(linkage, card%pin, slider, base)
      call world_line(linkage, pose, slider, axis, point)
    else
      axis = pose%pin(:, card%base(2)) - pose%pin(:, base)
    end if
    way = pose%pin(:, card%pin) - pose%pin(:, base)
    sine = merge(dot_product(axis, way), cross(axis, way), card%on_line)
    if (abs(sine) > 0.0_wp) sine = sine/(norm2(axis)*norm2(way))
  end function sine_of

  !> The first card that does not hold with those before it, and one of them with which it never
  !! holds; or that about a group on whose other side it holds.
  pure function contradiction(linkage, sides, undecided, groups, crank, closes, holds) &
    result(problem)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(undecided_t), intent(in) :: undecided
    integer, intent(in) :: groups(:)
    real(wp), intent(in) :: crank
    logical, intent(in) :: closes(0:), holds(:, 0:)
    type(plan_problem_t) :: problem

    integer :: i, j, other

    i = 1
    do while (any(closes .and. all(holds(:i, :), dim=1)))
      i = i + 1
    end do
    other = 0
    do j = 1, i - 1
      if (.not. any(closes .and. holds(j, :) .and. holds(i, :))) other = undecided%cards(j)
    end do
    if (other == 0) other = opponent_of(linkage, sides, undecided%cards([i]), groups, crank, &
      .false.)
    problem = problem_of_cards(sides, undecided%cards(i), other)
  end function contradiction

  !> A problem if the linkage fits on the other side of a group that has a card, or of the pin of
  !! one that was carried over.
  pure subroutine refuse_misfit_of_cards(linkage, sides, undecided, groups, crank, fits, holds, &
    problem)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(undecided_t), intent(in) :: undecided
    integer, intent(in) :: groups(:)
    real(wp), intent(in) :: crank
    logical, intent(in) :: fits(:), holds(:, :)
    type(plan_problem_t), allocatable, intent(inout) :: problem

    integer :: i, number, other

    number = undecided%cards(1)
    other = opponent_of(linkage, sides, undecided%cards, groups, crank, .true.)
    do i = 1, size(undecided%cards)
      if (other > 0 .or. .not. any(fits .and. .not. holds(i, :) .and. count(holds, dim=1) == &
        size(undecided%cards) - 1)) cycle
      number = undecided%cards(i)
      if (size(undecided%cards) > 1) other = undecided%cards(merge(2, 1, i == 1))
      problem = problem_of_cards(sides, number, 0)
    end do
    if (other > 0) problem = problem_of_cards(sides, max(number, other), min(number, other))
  end subroutine refuse_misfit_of_cards

  !> The card about a group on whose other side some cards hold; 0: there is none.
  pure function opponent_of(linkage, sides, cards, groups, crank, must_fit) result(opponent)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: cards(:)  !! numbers
    integer, intent(in) :: groups(:) !! whose sides are tried
    real(wp), intent(in) :: crank
    logical, intent(in) :: must_fit  !! links more than needed
    integer :: opponent

    logical, allocatable :: closes(:), fits(:), holds(:, :)
    logical :: is_flat
    real(wp) :: side(size(linkage%groups))
    integer :: g

    do g = 1, size(linkage%groups)
      opponent = card_about(sides, linkage%groups(g))
      if (opponent == 0) cycle
      side = linkage%groups%side
      side(g) = -side(g)
      call try_assemblies(linkage, sides(cards), groups, side, crank, closes, fits, holds, is_flat)
      if (any(closes .and. all(holds, dim=1) .and. (fits .or. .not. must_fit))) return
    end do
    opponent = 0
  end function opponent_of

  !> A card that does not hold with another one.
  pure function problem_of_cards(sides, number, other) result(problem)
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: number, other !! of the cards; other 0: there is none
    type(plan_problem_t) :: problem

    problem = new_problem(problem_sides_differ, [sides(number)%pin], number=number)
    problem%on_line = sides(number)%on_line
    problem%other = other
  end function problem_of_cards

end module chosen_assemblies
