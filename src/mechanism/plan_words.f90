!> The plan of a linkage in words: how it is placed, group by group.
module plan_words
  use kinds, only: wp
  use linkages, only: drive_of_nothing, group_t, group_carried, group_cross_slide, &
    group_driven_dyad, group_dyad, group_on_line, group_placed, group_spanned, &
    group_through_pin, group_turned, group_two_lines
  use mechanisms, only: mechanism_t
  use structures, only: has_beams
  use text, only: append_string, plural, string_t, to_string
  implicit none (type, external)
  private

  public :: plan_notes, group_names, group_words

contains

  !> How a linkage is placed: its links, drives and groups in their order.
  pure function plan_notes(mechanism) result(notes)
    type(mechanism_t), intent(in) :: mechanism !! of any kind
    type(string_t), allocatable :: notes(:)

    integer :: i

    associate (linkage => mechanism%linkage)
      if (any(linkage%drives%kind == drive_of_nothing)) then
        call append_string(notes, "structure of "//plural(size(linkage%bodies), "link"))
      else
        call append_string(notes, "linkage of "//to_string(size(linkage%bodies) + 1)// &
          " links with the ground, and "//plural(size(linkage%drives), "drive"))
      end if
      if (linkage%has_crank) call append_string(notes, "placed: "//mechanism%names(1)%text// &
        " turns about "//mechanism%pin_names(linkage%bodies(1)%first_pin)%text)
      do i = 1, size(linkage%groups)
        if (linkage%groups(i)%kind == group_carried) cycle
        call append_string(notes, "placed: "//group_words(mechanism, linkage%groups(i)))
      end do
      if (size(linkage%redundancies) > 0) call append_string(notes, "redundant: "// &
        plural(size(linkage%redundancies), "condition")// &
        " more than needed; "//trim(merge("elasticity divides the forces between links  ", &
        "forces between links cannot be told apart    ", has_beams(mechanism))))
    end associate
  end function plan_notes

  !> The links of a group, or its pins if it has none: `coupler and follower`.
  pure function group_names(mechanism, group) result(words)
    type(mechanism_t), intent(in) :: mechanism
    type(group_t), intent(in) :: group !! of its linkage
    character(len=:), allocatable :: words

    integer, allocatable :: bodies(:)
    integer :: i

    bodies = pack(group%body, group%body > 0)
    if (allocated(group%bodies)) then
      if (size(group%bodies) > 0) bodies = group%bodies
    end if
    words = ""
    if (size(bodies) > 0) then
      do i = 1, size(bodies)
        words = words//separator(i, size(bodies))//mechanism%names(bodies(i))%text
      end do
    else
      do i = 1, size(group%pins)
        words = words//separator(i, size(group%pins))//mechanism%pin_names(group%pins(i))%text
      end do
    end if
  end function group_names

  !> What stands before the i-th of n words of a list.
  pure function separator(i, n)
    integer, intent(in) :: i, n
    character(len=:), allocatable :: separator

    separator = ", "
    if (i == n) separator = " and "
    if (i == 1) separator = ""
  end function separator

  !> `B by coupler and follower, left of A -> O4 (RRR)`
  pure function group_words(mechanism, group) result(words)
    type(mechanism_t), intent(in) :: mechanism !! of any kind
    type(group_t), intent(in) :: group         !! of its linkage
    character(len=:), allocatable :: words

    character(len=:), allocatable :: side
    integer :: i

    side = trim(merge("forward ", "backward", group%side > 0.0_wp))
    associate (names => mechanism%names, pins => mechanism%pin_names)
      select case (group%kind)
      case (group_dyad, group_driven_dyad)
        words = pins(group%middle)%text//" by "//names(group%body(1))%text//" and "// &
          names(group%body(2))%text//", "//trim(merge("left ", "right", group%side > 0.0_wp))// &
          " of "//pins(group%base(1))%text//" -> "//pins(group%base(2))%text//" (RRR)"
      case (group_on_line)
        words = pins(group%middle)%text//" by "//names(group%body(1))%text//" and a slider, "// &
          side//" (RRP)"
      case (group_through_pin)
        words = names(group%body(1))%text//" by a block at "//pins(group%middle)%text//" (RPR)"
      case (group_two_lines)
        words = pins(group%pins(1))%text//" by two sliders (PRP)"
      case (group_cross_slide)
        words = names(group%body(1))%text//" by two sliders (PPR)"
      case (group_turned)
        words = names(group%body(1))%text//" by its angle"
      case (group_spanned)
        words = names(group%body(1))%text//" between "//pins(group%base(1))%text//" and "// &
          pins(group%middle)%text
      case (group_placed)
        words = pins(group%pins(1))%text//" by its drive"
      case default
        words = ""
        do i = 1, size(group%bodies)
          if (i > 1) words = words//", "
          words = words//names(group%bodies(i))%text
        end do
        if (size(group%bodies) == 0) then
          do i = 1, size(group%pins)
            if (i > 1) words = words//", "
            words = words//pins(group%pins(i))%text
          end do
        end if
        words = words//" together, by iterations"
      end select
    end associate
  end function group_words

end module plan_words
