!> Matching of equations with unknowns, and the component of them that depends on no other: after
!! Dulmage and Mendelsohn (1958) and Tarjan (1972), for some dozens of unknowns.
module unknown_matching
  implicit none (type, external)
  private

  public :: matching_t, match_unknowns, source_component

  !> Which equation determines which unknown.
  type :: matching_t
    integer, allocatable :: equation_of(:) !! (unknowns) 0: none
    integer, allocatable :: unknown_of(:)  !! (equations) 0: none; it is redundant
    logical, allocatable :: is_loose(:)    !! (unknowns) not determined: unmatched, or as free as
                                           !! an unmatched one
  end type matching_t

contains

  !> A largest matching; equations before others, in their order.
  pure function match_unknowns(has) result(matching)
    logical, intent(in) :: has(:, :) !! (unknowns, equations) whether an equation has an unknown
    type(matching_t) :: matching

    logical :: seen(size(has, 1)), found, grows
    integer :: e, u

    allocate (matching%equation_of(size(has, 1)), matching%unknown_of(size(has, 2)))
    matching%equation_of = 0
    matching%unknown_of = 0
    do e = 1, size(has, 2)
      seen = .false.
      call augment(has, e, seen, matching, found)
    end do
    ! What could take the place of a loose unknown is as loose.
    matching%is_loose = matching%equation_of == 0
    grows = .true.
    do while (grows)
      grows = .false.
      do e = 1, size(has, 2)
        u = matching%unknown_of(e)
        if (u == 0) cycle
        if (matching%is_loose(u)) cycle
        if (any(has(:, e) .and. matching%is_loose)) then
          matching%is_loose(u) = .true.
          grows = .true.
        end if
      end do
    end do
  end function match_unknowns

  !> Finds an unknown for an equation, others giving way.
  pure recursive subroutine augment(has, equation, seen, matching, found)
    logical, intent(in) :: has(:, :)
    integer, intent(in) :: equation
    logical, intent(inout) :: seen(:) !! (unknowns) tried before
    type(matching_t), intent(inout) :: matching
    logical, intent(out) :: found

    integer :: u

    found = .false.
    do u = 1, size(has, 1)
      if (.not. has(u, equation) .or. seen(u)) cycle
      seen(u) = .true.
      found = matching%equation_of(u) == 0
      if (.not. found) call augment(has, matching%equation_of(u), seen, matching, found)
      if (found) then
        matching%equation_of(u) = equation
        matching%unknown_of(equation) = u
        return
      end if
    end do
  end subroutine augment

  !> The smallest component of the unknowns that its own equations determine, with nothing else
  !! known; of several, that with the lowest number. Empty if every component has loose unknowns.
  pure function source_component(has, matching, node, companion) result(component)
    logical, intent(in) :: has(:, :)           !! (unknowns, equations)
    type(matching_t), intent(in) :: matching   !! of these
    integer, intent(in) :: node(:)             !! (unknowns) number of what they belong to: the two
                                               !! of a pin to one; ascending from 1
    integer, intent(in), optional :: companion(:) !! (nodes) another one without which it is of no
                                               !! use, as a body is without its first pin; 0: none
    integer, allocatable :: component(:)       !! ascending numbers of these

    logical, allocatable :: needs(:, :), reached(:)
    logical :: grows
    integer, allocatable :: smallest(:)
    integer :: n, u, i, k

    n = maxval([0, node])
    allocate (needs(n, n), reached(n), component(0), smallest(0))
    needs = .false.
    do u = 1, size(has, 1)
      needs(node(u), node(u)) = .true.
      if (matching%equation_of(u) == 0) cycle
      do k = 1, size(has, 1)
        if (has(k, matching%equation_of(u))) needs(node(k), node(u)) = .true.
      end do
    end do
    if (present(companion)) then
      do i = 1, n
        if (companion(i) > 0) needs(companion(i), i) = .true.
      end do
    end if
    do i = 1, n
      reached = needs(:, i)
      grows = .true.
      do while (grows)
        grows = .false.
        do k = 1, n
          if (.not. reached(k)) cycle
          if (any(needs(:, k) .and. .not. reached)) then
            reached = reached .or. needs(:, k)
            grows = .true.
          end if
        end do
      end do
      if (any([(matching%is_loose(u) .and. reached(node(u)), u=1, size(node))])) cycle
      smallest = pack([(k, k=1, n)], reached)
      if (size(component) == 0 .or. size(smallest) < size(component)) component = smallest
    end do
  end function source_component

end module unknown_matching
