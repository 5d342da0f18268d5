!> Requests on links for the response of their parts, and results of parts for the links.
module part_requests
  use elastic_linkages, only: elastic_linkage_t, is_piece
  use kinds, only: wp
  use linkages, only: turned_back
  use response_types, only: damping_by_dampers, link_damping_t, peak_t, response_request_t, &
    speed_response_t
  implicit none (type, external)
  private

  public :: request_of_parts, dampings_of_parts, join_parts, join_largest

contains

  !> The request with parts for bodies. A gauge is at a place along the way of its link from part to
  !! part, a point on the nearest part; where two parts are equally near, on the first. The pieces
  !! of a way are one part here, the first of them.
  pure function request_of_parts(elastic, request) result(of_parts)
    type(elastic_linkage_t), intent(in) :: elastic     !! before it is placed
    type(response_request_t), intent(in) :: request    !! of links
    type(response_request_t) :: of_parts

    integer :: i

    of_parts = request
    of_parts%damping = dampings_of_parts(elastic, request%damping)
    of_parts%section = request%section(elastic%body)
    do i = 1, size(of_parts%gauges)
      call find_part_along(elastic, request%gauges(i)%body, request%gauges(i)%xi, &
        of_parts%gauges(i)%body, of_parts%gauges(i)%xi)
    end do
    do i = 1, size(of_parts%points)
      call find_nearest_part(elastic, request%points(i)%body, request%points(i)%place, &
        of_parts%points(i)%body, of_parts%points(i)%place)
    end do
  end function request_of_parts

  !> Every part is damped as its link is; dampers follow.
  pure function dampings_of_parts(elastic, damping) result(of_parts)
    type(elastic_linkage_t), intent(in) :: elastic     !! parts and dampers
    type(link_damping_t), intent(in) :: damping(:)     !! (links)
    type(link_damping_t), allocatable :: of_parts(:)   !! (parts), then that of dampers, if any act

    of_parts = damping(elastic%body)
    if (size(elastic%dampers) > 0) of_parts = [of_parts, link_damping_t(damping_by_dampers)]
  end function dampings_of_parts

  !> The part at a share of the way along a link.
  pure subroutine find_part_along(elastic, link, share, part, xi)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: link
    real(wp), intent(in) :: share !! 0 to 1
    integer, intent(out) :: part
    real(wp), intent(out) :: xi   !! along it, 0 to 1

    real(wp) :: left
    logical :: is_further(size(elastic%body))
    integer :: k

    is_further = are_further(elastic)
    left = share*way_length(elastic, link)
    part = 0
    do k = 1, size(elastic%body)
      if (elastic%body(k) /= link .or. is_further(k)) cycle
      if (part > 0) left = left - elastic%linkage%bodies(part)%length
      part = k
      if (left <= elastic%linkage%bodies(k)%length) exit
    end do
    xi = min(max(left/elastic%linkage%bodies(part)%length, 0.0_wp), 1.0_wp)
  end subroutine find_part_along

  !> Which parts are further pieces of a way: before it is placed each has the length of all.
  pure function are_further(elastic)
    type(elastic_linkage_t), intent(in) :: elastic
    logical :: are_further(size(elastic%body))

    are_further(:1) = .false.
    associate (way => elastic%way)
      are_further(2:) = way(2:) > 0 .and. way(2:) == way(:size(way) - 1)
    end associate
  end function are_further

  !> Length of a link along its parts [m].
  pure function way_length(elastic, link) result(length)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: link
    real(wp) :: length

    length = sum(elastic%linkage%bodies%length, mask=elastic%body == link .and. &
      .not. are_further(elastic))
  end function way_length

  !> The part to which a place on a link is nearest.
  pure subroutine find_nearest_part(elastic, link, place, part, place_on_part)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: link
    real(wp), intent(in) :: place(2)           !! from the first pin of the link, in its axes [m]
    integer, intent(out) :: part
    real(wp), intent(out) :: place_on_part(2)  !! likewise of the part [m]

    ! Places at a corner are equally near to both of its parts but for rounding.
    real(wp), parameter :: nearer = 1.0e-9_wp
    real(wp) :: here(2), apart, least
    logical :: is_further(size(elastic%body))
    integer :: k

    part = 0
    least = huge(least)
    is_further = are_further(elastic)
    do k = 1, size(elastic%body)
      if (elastic%body(k) /= link .or. is_further(k)) cycle
      here = turned_back(place - elastic%place(:, k), elastic%axis(:, k))
      associate (length => elastic%linkage%bodies(k)%length)
        apart = hypot(here(1) - min(max(here(1), 0.0_wp), length), here(2))
        if (part > 0 .and. .not. apart < least - nearer*length) cycle
      end associate
      part = k
      least = apart
      place_on_part = here
    end do
  end subroutine find_nearest_part

  !> Results of links from those of their parts: the largest values, with their places as shares of
  !! the way along the link; sums of the power.
  pure subroutine join_parts(elastic, links, found)
    type(elastic_linkage_t), intent(in) :: elastic     !! parts
    integer, intent(in) :: links                       !! how many
    type(speed_response_t), intent(inout) :: found     !! of parts; becomes that of links

    if (allocated(found%error)) return
    call join_peaks(found%largest_strain)
    call join_peaks(found%largest_stress)
    call join_peaks(found%largest_deflection)
    call join_largest(elastic, links, found%deflection)
    call join_largest(elastic, links, found%peak_error)
    if (allocated(found%buckling)) then
      if (size(found%buckling) > 0) found%buckling = found%buckling*(straight_lengths(elastic)/ &
        elastic%linkage%bodies%length)**2
    end if
    call join_largest(elastic, links, found%buckling)
    call join_largest(elastic, links, found%buckling_error)
    call join_largest(elastic, links, found%quadratic_change)
    call join_sums(found%power_lost)

  contains

    pure subroutine join_peaks(of_parts)
      type(peak_t), allocatable, intent(inout) :: of_parts(:)

      type(peak_t), allocatable :: of_links(:)
      real(wp) :: before(links)
      logical :: is_further(size(elastic%body))
      integer :: k

      if (.not. allocated(of_parts)) return
      allocate (of_links(links))
      before = 0.0_wp
      is_further = are_further(elastic)
      do k = 1, size(elastic%body)
        associate (b => elastic%body(k), length => elastic%linkage%bodies(k)%length)
          ! A further piece begins with the first: shares are those of the way.
          if (is_further(k)) before(b) = before(b) - length
          if (of_parts(k)%value > of_links(b)%value) then
            of_links(b) = of_parts(k)
            of_links(b)%xi = (before(b) + of_parts(k)%share*length)/way_length(elastic, b)
          end if
          before(b) = before(b) + length
        end associate
      end do
      call move_alloc(of_links, of_parts)
    end subroutine join_peaks

    pure subroutine join_sums(of_parts)
      real(wp), allocatable, intent(inout) :: of_parts(:)

      real(wp) :: of_links(links)
      integer :: k

      if (.not. allocated(of_parts)) return
      of_links = 0.0_wp
      do k = 1, size(elastic%body)
        of_links(elastic%body(k)) = of_links(elastic%body(k)) + of_parts(k)
      end do
      of_parts = of_links
    end subroutine join_sums

  end subroutine join_parts

  !> Length of the straight way of its link on which every part lies, by which it buckles as pinned:
  !! pins along it that the link goes through straight do not end it.
  pure function straight_lengths(elastic) result(length)
    type(elastic_linkage_t), intent(in) :: elastic
    real(wp) :: length(size(elastic%body)) !! (parts) [m]

    ! Sine of the angle below which a corner is none: drawings are rounded.
    real(wp), parameter :: straight = 1.0e-9_wp
    integer :: first, k

    length = elastic%linkage%bodies%length
    first = 1
    do k = 2, size(length) + 1
      if (k <= size(length)) then
        if (goes_on(k)) cycle
      end if
      length(first:k - 1) = sum(length(first:k - 1))
      first = k
    end do

  contains

    !> Whether a part goes on straight from the one before. Pieces between blocks have lengths of
    !! their whole way.
    pure function goes_on(k) result(does)
      integer, intent(in) :: k
      logical :: does

      does = elastic%body(k) == elastic%body(k - 1) .and. .not. (is_piece(elastic, k) .or. &
        is_piece(elastic, k - 1))
      if (does) does = norm2(elastic%axis(:, k) - elastic%axis(:, k - 1)) < straight
    end function goes_on

  end function straight_lengths

  !> The largest of the values of the parts of every link; nothing where there are none.
  pure subroutine join_largest(elastic, links, of_parts)
    type(elastic_linkage_t), intent(in) :: elastic        !! parts
    integer, intent(in) :: links                          !! how many
    real(wp), allocatable, intent(inout) :: of_parts(:)   !! becomes that of links

    real(wp), allocatable :: of_links(:)
    integer :: k

    if (.not. allocated(of_parts)) return
    if (size(of_parts) == 0) return
    allocate (of_links(links), source=-huge(1.0_wp))
    do k = 1, size(elastic%body)
      of_links(elastic%body(k)) = max(of_links(elastic%body(k)), of_parts(k))
    end do
    call move_alloc(of_links, of_parts)
  end subroutine join_largest

end module part_requests
