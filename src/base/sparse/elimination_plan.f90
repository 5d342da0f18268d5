!> The order in which the unknowns of a sum of element matrices are eliminated: a tree of fronts.
!!
!! A front is a dense matrix, the sum of elements and of what fronts before it left. Next is always
!! the unknown with the smallest front; all unknowns that are in nothing else by then are
!! eliminated along with it (Duff and Reid, ACM TOMS 9 (1983) 302; George and Liu, SIAM Rev. 31
!! (1989) 1).
module elimination_plan
  use element_matrices, only: elements_t
  implicit none (type, external)
  private

  public :: elimination_plan_t, new_elimination_plan

  !> The tree. Lists of a front f are entries `first(f)` to `first(f + 1) − 1`. What a front takes
  !! from others are the last ones left, as on a stack.
  type :: elimination_plan_t
    integer :: unknowns = 0                  !! of the matrix
    integer :: fronts = 0                    !! in the order of elimination
    integer, allocatable :: parent(:)        !! (fronts) the front that takes what is left; 0: root
    integer, allocatable :: own(:)           !! (fronts) unknowns eliminated there, if pivots allow
    integer, allocatable :: row_first(:)     !! (fronts + 1) first row
    integer, allocatable :: row(:)           !! unknowns in the order of elimination: own ones, then
                                             !! those of the boundary
    integer, allocatable :: place(:)         !! (as `row`) its row in the parent; 0 of own unknowns
    integer, allocatable :: child_first(:)   !! (fronts + 1) first child
    integer, allocatable :: child(:)         !! fronts of which this is the parent, ascending
    integer, allocatable :: element_first(:) !! (fronts + 1) first element
    integer, allocatable :: element(:)       !! elements taken, ascending
    integer, allocatable :: entry(:)         !! (as `unknown` of the elements) entries of an element
                                             !! in the order of rows, counted from 1
    integer, allocatable :: entry_row(:)     !! (as `entry`) the rows
  end type elimination_plan_t

  !> What is not eliminated yet: elements and fronts, fronts numbered behind the elements.
  type :: quotient_t
    integer, allocatable :: weight(:)       !! (groups) unknowns of each
    integer, allocatable :: group_first(:)  !! (elements and fronts + 1) first group of each
    integer, allocatable :: group(:)        !! the groups
    integer, allocatable :: holder_first(:) !! (groups + 1) first element or front of each
    integer, allocatable :: holders(:)      !! (groups) how many
    integer, allocatable :: holder(:)       !! elements and fronts
    logical, allocatable :: is_listed(:)    !! (groups) false between uses
  end type quotient_t

contains

  !> The plan for all matrices of these elements.
  pure function new_elimination_plan(elements, late) result(plan)
    type(elements_t), intent(in) :: elements
    logical, intent(in) :: late(:) !! (unknowns) no front is chosen for their sake: multipliers
    type(elimination_plan_t) :: plan

    integer :: front_of(elements%unknowns), taken_by(size(elements%first) - 1)
    integer :: parent(elements%unknowns), number(elements%unknowns)

    plan%unknowns = elements%unknowns
    call choose_fronts(elements, late, front_of, taken_by, parent, plan%fronts)
    number = 0
    call number_fronts(parent(:plan%fronts), number(:plan%fronts))
    allocate (plan%parent(plan%fronts))
    plan%parent = 0
    call renumber(number, parent(:plan%fronts))
    plan%parent(number(:plan%fronts)) = parent(:plan%fronts)
    call renumber(number, front_of)
    call renumber(number, taken_by)
    call list_by_front(plan%fronts, plan%parent, plan%child_first, plan%child)
    call list_by_front(plan%fronts, taken_by, plan%element_first, plan%element)
    call fill_rows(elements, front_of, taken_by, plan)
    call fill_places(elements, plan)
  end function new_elimination_plan

  !> Absorption of elements. Unknowns of the same elements are treated as one, a group.
  pure subroutine choose_fronts(elements, late, front_of, taken_by, parent, fronts)
    type(elements_t), intent(in) :: elements
    logical, intent(in) :: late(:)       !! (unknowns)
    integer, intent(out) :: front_of(:)  !! (unknowns) the front of which each is an own unknown
    integer, intent(out) :: taken_by(:)  !! (elements) fronts; 0: an element without unknowns
    integer, intent(out) :: parent(:)    !! (unknowns) of fronts as they are chosen
    integer, intent(out) :: fronts       !! chosen

    type(quotient_t) :: graph
    integer, dimension(elements%unknowns) :: group, extent, list, group_front
    logical :: is_late(elements%unknowns)
    integer :: groups, all_elements, chosen, g, i, k, n, rows

    all_elements = size(taken_by)
    call group_unknowns(elements, late, group, groups, graph%weight, is_late)
    call list_groups(elements, group, groups, graph)
    parent = 0
    taken_by = 0
    group_front = 0
    fronts = 0
    do g = 1, groups
      call find_rows(graph, g, list, n, extent(g))
    end do
    do
      chosen = 0
      do g = 1, groups
        if (group_front(g) /= 0) cycle
        if (chosen /= 0) then
          if (is_late(g) .and. .not. is_late(chosen)) cycle
          if (extent(g) >= extent(chosen) .and. (is_late(g) .eqv. is_late(chosen))) cycle
        end if
        chosen = g
      end do
      if (chosen == 0) exit
      fronts = fronts + 1
      call find_rows(graph, chosen, list, n, rows)
      do i = graph%holder_first(chosen), graph%holder_first(chosen) + graph%holders(chosen) - 1
        if (graph%holder(i) > all_elements) then
          parent(graph%holder(i) - all_elements) = fronts
        else
          taken_by(graph%holder(i)) = fronts
        end if
      end do
      ! In the lists of its groups the front takes the place of what it takes.
      i = graph%group_first(all_elements + fronts)
      if (i + n > size(graph%group)) graph%group = [graph%group, graph%group, list(:n)]
      do k = 1, n
        g = list(k)
        call drop_taken(taken_by, parent, graph%holder(graph%holder_first(g):), graph%holders(g))
        if (graph%holders(g) == 0) then
          group_front(g) = fronts
        else
          graph%holder(graph%holder_first(g) + graph%holders(g)) = all_elements + fronts
          graph%holders(g) = graph%holders(g) + 1
          graph%group(i) = g
          i = i + 1
        end if
      end do
      graph%group_first(all_elements + fronts + 1) = i
      do i = graph%group_first(all_elements + fronts), i - 1
        call find_rows(graph, graph%group(i), list, n, extent(graph%group(i)))
      end do
    end do
    front_of = group_front(group)
  end subroutine choose_fronts

  !> Takes elements and fronts that have been taken out of a list.
  pure subroutine drop_taken(taken_by, parent, holder, holders)
    integer, intent(in) :: taken_by(:), parent(:)
    integer, intent(inout) :: holder(:), holders !! the list; its length

    integer :: i, kept

    kept = 0
    do i = 1, holders
      if (holder(i) > size(taken_by)) then
        if (parent(holder(i) - size(taken_by)) /= 0) cycle
      else
        if (taken_by(holder(i)) /= 0) cycle
      end if
      kept = kept + 1
      holder(kept) = holder(i)
    end do
    holders = kept
  end subroutine drop_taken

  !> The front of a group: all groups in what holds it.
  pure subroutine find_rows(graph, of, list, n, rows)
    type(quotient_t), intent(inout) :: graph !! marks are used
    integer, intent(in) :: of                !! the group
    integer, intent(inout) :: list(:)        !! (:n) the groups, the given one first
    integer, intent(out) :: n, rows          !! groups, unknowns

    integer :: g, i, k

    n = 1
    list(1) = of
    rows = graph%weight(of)
    graph%is_listed(of) = .true.
    do i = graph%holder_first(of), graph%holder_first(of) + graph%holders(of) - 1
      do k = graph%group_first(graph%holder(i)), graph%group_first(graph%holder(i) + 1) - 1
        g = graph%group(k)
        if (graph%is_listed(g)) cycle
        graph%is_listed(g) = .true.
        n = n + 1
        list(n) = g
        rows = rows + graph%weight(g)
      end do
    end do
    graph%is_listed(list(:n)) = .false.
  end subroutine find_rows

  !> Groups of unknowns that are in the same elements, numbered by their first unknowns. A group is
  !! late if all of it is.
  pure subroutine group_unknowns(elements, late, group, groups, weight, is_late)
    type(elements_t), intent(in) :: elements
    logical, intent(in) :: late(:)
    integer, intent(out) :: group(:)     !! (unknowns)
    integer, intent(out) :: groups
    integer, allocatable, intent(out) :: weight(:) !! (groups) unknowns
    logical, intent(out) :: is_late(:)   !! (groups)

    integer, dimension(size(elements%unknown) + 1) :: divided_by, part
    integer :: e, i, u, parts

    ! An element divides a part into what is in the element and what is not.
    group = 1
    parts = 1
    divided_by = 0
    do e = 1, size(elements%first) - 1
      do i = elements%first(e), elements%first(e + 1) - 1
        u = elements%unknown(i)
        if (divided_by(group(u)) /= e) then
          divided_by(group(u)) = e
          parts = parts + 1
          part(group(u)) = parts
        end if
        group(u) = part(group(u))
      end do
    end do
    part = 0
    allocate (weight(size(group)), source=0)
    is_late = .true.
    groups = 0
    do u = 1, size(group)
      if (part(group(u)) == 0) then
        groups = groups + 1
        part(group(u)) = groups
      end if
      group(u) = part(group(u))
      weight(group(u)) = weight(group(u)) + 1
      is_late(group(u)) = is_late(group(u)) .and. late(u)
    end do
  end subroutine group_unknowns

  !> Groups of each element, and elements of each group.
  pure subroutine list_groups(elements, group, groups, graph)
    type(elements_t), intent(in) :: elements
    integer, intent(in) :: group(:), groups !! (unknowns); how many
    type(quotient_t), intent(inout) :: graph

    integer :: mark(groups), element_of(size(elements%unknown)), e, g, i, n

    allocate (graph%group_first(size(elements%first) + elements%unknowns), &
      graph%group(size(elements%unknown)), graph%is_listed(groups))
    graph%is_listed = .false.
    mark = 0
    n = 0
    do e = 1, size(elements%first) - 1
      graph%group_first(e) = n + 1
      do i = elements%first(e), elements%first(e + 1) - 1
        g = group(elements%unknown(i))
        if (mark(g) == e) cycle
        mark(g) = e
        n = n + 1
        graph%group(n) = g
        element_of(n) = e
      end do
    end do
    graph%group_first(size(elements%first)) = n + 1
    call list_by_front(groups, graph%group(:n), graph%holder_first, graph%holder)
    graph%holder = element_of(graph%holder)
    graph%holders = graph%holder_first(2:) - graph%holder_first(:groups)
  end subroutine list_groups

  !> Numbers by which the fronts of every subtree follow each other, its root last.
  pure subroutine number_fronts(parent, number)
    integer, intent(in) :: parent(:)   !! (fronts) greater than the front, or 0
    integer, intent(out) :: number(:)  !! (fronts)

    integer :: fronts_below(0:size(parent)), next(0:size(parent)), f

    fronts_below = 0
    do f = 1, size(parent)
      fronts_below(parent(f)) = fronts_below(parent(f)) + fronts_below(f) + 1
    end do
    next(0) = size(parent)
    do f = size(parent), 1, -1
      number(f) = next(parent(f))
      next(parent(f)) = next(parent(f)) - fronts_below(f) - 1
      next(f) = number(f) - 1
    end do
  end subroutine number_fronts

  !> New numbers in place of old ones; 0 stays.
  pure subroutine renumber(number, list)
    integer, intent(in) :: number(:)
    integer, intent(inout) :: list(:)

    integer :: i

    do i = 1, size(list)
      if (list(i) /= 0) list(i) = number(list(i))
    end do
  end subroutine renumber

  !> For every front the items that belong to it, ascending.
  pure subroutine list_by_front(fronts, front, first, item)
    integer, intent(in) :: fronts
    integer, intent(in) :: front(:)                             !! (items) 0: none
    integer, allocatable, intent(out) :: first(:), item(:)      !! (fronts + 1), (items of fronts)

    integer :: next(fronts), i

    allocate (first(fronts + 1), item(count(front /= 0)))
    next = 0
    do i = 1, size(front)
      if (front(i) /= 0) next(front(i)) = next(front(i)) + 1
    end do
    first(1) = 1
    do i = 1, fronts
      first(i + 1) = first(i) + next(i)
      next(i) = first(i)
    end do
    do i = 1, size(front)
      if (front(i) == 0) cycle
      item(next(front(i))) = i
      next(front(i)) = next(front(i)) + 1
    end do
  end subroutine list_by_front

  !> Rows of the fronts: an unknown is in all fronts from those that take its elements up to that
  !! of which it is an own unknown.
  pure subroutine fill_rows(elements, front_of, taken_by, plan)
    type(elements_t), intent(in) :: elements
    integer, intent(in) :: front_of(:), taken_by(:) !! (unknowns), (elements)
    type(elimination_plan_t), intent(inout) :: plan

    integer, allocatable :: own_first(:), unknown(:), holder_first(:), holder(:)
    integer :: front_of_entry(size(elements%unknown)), mark(plan%fronts), rows(plan%fronts)
    integer :: e, f, i, k, pass, u

    do e = 1, size(taken_by)
      front_of_entry(elements%first(e):elements%first(e + 1) - 1) = taken_by(e)
    end do
    call list_by_front(plan%fronts, front_of, own_first, unknown)
    plan%own = own_first(2:) - own_first(:plan%fronts)
    call list_by_front(plan%unknowns, elements%unknown, holder_first, holder)
    holder = front_of_entry(holder)
    allocate (plan%row_first(plan%fronts + 1))
    ! They are counted, then listed.
    do pass = 1, 2
      mark = 0
      rows = 0
      do i = 1, size(unknown)
        u = unknown(i)
        do k = holder_first(u) - 1, holder_first(u + 1) - 1
          f = front_of(u)
          if (k >= holder_first(u)) f = holder(k)
          do while (mark(f) /= u)
            mark(f) = u
            if (pass == 2) plan%row(plan%row_first(f) + rows(f)) = u
            rows(f) = rows(f) + 1
            if (f == front_of(u)) exit
            f = plan%parent(f)
          end do
        end do
      end do
      if (pass == 2) exit
      plan%row_first(1) = 1
      do f = 1, plan%fronts
        plan%row_first(f + 1) = plan%row_first(f) + rows(f)
      end do
      allocate (plan%row(plan%row_first(plan%fronts + 1) - 1))
    end do
  end subroutine fill_rows

  !> Where children and elements are added to a front.
  pure subroutine fill_places(elements, plan)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(inout) :: plan

    integer :: row_of(plan%unknowns), entry_of(plan%unknowns), c, e, f, i, k, n

    allocate (plan%place(size(plan%row)), plan%entry(size(elements%unknown)), &
      plan%entry_row(size(elements%unknown)))
    plan%place = 0
    entry_of = 0
    do f = 1, plan%fronts
      do i = plan%row_first(f), plan%row_first(f + 1) - 1
        row_of(plan%row(i)) = i - plan%row_first(f) + 1
      end do
      do k = plan%child_first(f), plan%child_first(f + 1) - 1
        c = plan%child(k)
        do i = plan%row_first(c) + plan%own(c), plan%row_first(c + 1) - 1
          plan%place(i) = row_of(plan%row(i))
        end do
      end do
      do k = plan%element_first(f), plan%element_first(f + 1) - 1
        e = plan%element(k)
        do i = elements%first(e), elements%first(e + 1) - 1
          entry_of(elements%unknown(i)) = i - elements%first(e) + 1
        end do
        n = elements%first(e)
        do i = plan%row_first(f), plan%row_first(f + 1) - 1
          if (entry_of(plan%row(i)) == 0) cycle
          plan%entry(n) = entry_of(plan%row(i))
          plan%entry_row(n) = i - plan%row_first(f) + 1
          entry_of(plan%row(i)) = 0
          n = n + 1
        end do
      end do
    end do
  end subroutine fill_places

end module elimination_plan
