!> Model → damping, gauges and points on the bodies of the linkage, for the elastic response.
module response_builder
  use body_attachments, only: body_point_t, place_on_body, points_of, runs_against
  use kinds, only: wp
  use linkages, only: linkage_t
  use models, only: model_t
  use pose_types, only: pins_of_body, place_of_pin
  use text, only: string_t
  use response_cards, only: side_left
  implicit none (type, external)
  private

  public :: body_damping_t, body_gauge_t, dampings_of, gauges_of, response_points_of
  public :: damping_none, damping_by_time, damping_by_ratio

  integer, parameter :: damping_none = 0, damping_by_time = 1, damping_by_ratio = 2

  !> The damping of a body.
  type :: body_damping_t
    integer :: kind = damping_none !! one of the damping_… constants
    real(wp) :: value = 0.0_wp     !! Kelvin–Voigt time [s], or ratio of its own modes [-]
  end type body_damping_t

  !> A gauge on a body.
  type :: body_gauge_t
    character(len=:), allocatable :: name
    integer :: body = 0              !! number in the linkage, from 1
    real(wp) :: place = 0.0_wp       !! from the first pin of the body, relative to its length: 0 to
                                     !! 1; of a body with corners, along these
    integer :: side = 1              !! sign of its strain where the link turns left along its LINK
                                     !! card: +1 on the right of the card's direction, −1 on the
                                     !! left
    logical :: is_reversed = .false. !! the LINK card runs against the body: left turns along one
                                     !! are right turns along the other
  end type body_gauge_t

contains

  !> The damping of every body. A damping of 0 is none.
  pure function dampings_of(model, links) result(dampings)
    type(model_t), intent(in) :: model !! without errors
    integer, intent(in) :: links(:)    !! (bodies) numbers of their links in the model
    type(body_damping_t) :: dampings(size(links))

    integer :: i

    do i = 1, size(links)
      if (model%links(links(i))%damping == 0) cycle
      associate (card => model%dampings(model%links(links(i))%damping))
        if (card%time > 0.0_wp) dampings(i) = body_damping_t(damping_by_time, card%time)
        if (card%ratio > 0.0_wp) dampings(i) = body_damping_t(damping_by_ratio, card%ratio)
      end associate
    end do
  end function dampings_of

  !> The gauges in the order of the deck. In a deck without GAUGE cards there is one in the middle
  !! of every bending link, on its right, with the name of the link.
  pure function gauges_of(model, links, linkage) result(gauges)
    type(model_t), intent(in) :: model           !! without errors
    integer, intent(in) :: links(:)              !! (bodies) numbers of their links in the model
    type(linkage_t), intent(in) :: linkage       !! its bodies
    type(body_gauge_t), allocatable :: gauges(:) !! (gauges)

    integer :: i, filled

    if (size(model%gauges) > 0) then
      allocate (gauges(size(model%gauges)))
      do i = 1, size(gauges)
        associate (card => model%gauges(i))
          gauges(i) = gauge_on(model, links, linkage, card%link, card%at, merge(-1, 1, &
            card%side == side_left))
          gauges(i)%name = card%name%text
        end associate
      end do
      return
    end if
    allocate (gauges(count(.not. model%links(links)%rigid)))
    filled = 0
    do i = 1, size(links)
      associate (link => model%links(links(i)))
        if (link%rigid) cycle
        filled = filled + 1
        gauges(filled) = gauge_on(model, links, linkage, links(i), 0.5_wp*link%length, 1)
        gauges(filled)%name = link%name%text
      end associate
    end do
  end function gauges_of

  !> A gauge without its name, from the axes of its LINK card to those of its body.
  pure function gauge_on(model, links, linkage, link, at, side) result(gauge)
    type(model_t), intent(in) :: model
    integer, intent(in) :: links(:)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: link  !! number in the model's list
    real(wp), intent(in) :: at   !! from the first pin of its card [m]
    integer, intent(in) :: side  !! as in `body_gauge_t`
    type(body_gauge_t) :: gauge

    real(wp) :: place(2)

    gauge%body = findloc(links, link, dim=1)
    gauge%is_reversed = runs_against(linkage%bodies(gauge%body))
    gauge%side = side
    ! A ram has no length of its own, and does not bend.
    if (.not. model%links(link)%length > 0.0_wp) return
    if (allocated(linkage%bodies(gauge%body)%corners)) then
      ! Along its pins, as its card runs.
      gauge%is_reversed = .false.
      gauge%place = at/model%links(link)%length
    else
      place = place_on_body(linkage%bodies(gauge%body), [at, 0.0_wp])
      gauge%place = place(1)/model%links(link)%length
    end if
  end function gauge_on

  !> The points of REPORT response: for every moving pin the ends of the links that it joins, with
  !! names as `A:crank`, in the order of the loop, then the POINTs of the deck. The links that a pin
  !! joins have the same displacement there, and rotations of their own.
  pure function response_points_of(model, links, pins, linkage) result(points)
    type(model_t), intent(in) :: model           !! without errors
    integer, intent(in) :: links(:)              !! (bodies) numbers of their links in the model
    type(string_t), intent(in) :: pins(:)        !! names
    type(linkage_t), intent(in) :: linkage       !! of the model
    type(body_point_t), allocatable :: points(:) !! (points)

    type(body_point_t), allocatable :: of_deck(:)
    integer :: b, i, p, filled

    of_deck = points_of(model, links, linkage)
    associate (bodies => linkage%bodies, is_ground => linkage%is_ground)
      filled = 0
      do b = 1, size(bodies)
        filled = filled + count(.not. is_ground(pins_of_body(bodies(b))))
      end do
      allocate (points(filled + size(of_deck)))
      filled = 0
      do p = 1, size(is_ground)
        if (is_ground(p)) cycle
        do b = 1, size(bodies)
          if (.not. any(pins_of_body(bodies(b)) == p)) cycle
          filled = filled + 1
          points(filled)%name = pins(p)%text//":"//model%links(links(b))%name%text
          points(filled)%body = b
          points(filled)%place = place_of_pin(bodies(b), p)
        end do
      end do
    end associate
    do i = 1, size(of_deck)
      points(filled + i) = of_deck(i)
    end do
  end function response_points_of

end module response_builder
