!> Model → damping and gauges on the bodies of the linkage, for the elastic response.
module response_parts
  use attached_parts, only: body_of, place_on_body, runs_against
  use kinds, only: wp
  use models, only: model_t
  use response_cards, only: side_left
  implicit none (type, external)
  private

  public :: body_damping_t, body_gauge_t, dampings_of, gauges_of
  public :: damping_none, damping_by_time, damping_by_ratio

  integer, parameter :: damping_none = 0, damping_by_time = 1, damping_by_ratio = 2

  !> The damping of a body.
  type :: body_damping_t
    integer :: kind = damping_none !! one of the damping_… constants
    real(wp) :: value = 0.0_wp     !! Kelvin-Voigt time [s], or ratio of its own modes [-]
  end type body_damping_t

  !> A gauge on a body.
  type :: body_gauge_t
    character(len=:), allocatable :: name
    integer :: body = 0              !! number in the linkage, from 1
    real(wp) :: place = 0.0_wp       !! from the first pin of the body, relative to its length: 0 to
                                     !! 1
    integer :: side = 1              !! +1: on the face to the left of the direction of the body,
                                     !! −1: to its right
    logical :: is_reversed = .false. !! the LINK card runs against the body: left turns along one
                                     !! are right turns along the other
  end type body_gauge_t

contains

  !> The damping of every body. A damping of 0 is none.
  pure function dampings_of(model) result(dampings)
    type(model_t), intent(in) :: model !! without errors
    type(body_damping_t) :: dampings(size(model%loop))

    integer :: i

    do i = 1, size(model%loop)
      if (model%links(model%loop(i))%damping == 0) cycle
      associate (card => model%dampings(model%links(model%loop(i))%damping))
        if (card%time > 0.0_wp) dampings(i) = body_damping_t(damping_by_time, card%time)
        if (card%ratio > 0.0_wp) dampings(i) = body_damping_t(damping_by_ratio, card%ratio)
      end associate
    end do
  end function dampings_of

  !> The gauges in the order of the deck. In a deck without GAUGE cards there is one in the middle
  !! of every bending link, on its left, with the name of the link.
  pure function gauges_of(model) result(gauges)
    type(model_t), intent(in) :: model           !! without errors
    type(body_gauge_t), allocatable :: gauges(:) !! (gauges)

    integer :: i, filled

    if (size(model%gauges) > 0) then
      allocate (gauges(size(model%gauges)))
      do i = 1, size(gauges)
        associate (card => model%gauges(i))
          gauges(i) = gauge_on(model, card%link, card%at, card%side == side_left)
          gauges(i)%name = card%name%text
        end associate
      end do
      return
    end if
    allocate (gauges(count(.not. model%links(model%loop)%rigid)))
    filled = 0
    do i = 1, size(model%loop)
      associate (link => model%links(model%loop(i)))
        if (link%rigid) cycle
        filled = filled + 1
        gauges(filled) = gauge_on(model, model%loop(i), 0.5_wp*link%length, .true.)
        gauges(filled)%name = link%name%text
      end associate
    end do
  end function gauges_of

  !> A gauge without its name, from the axes of its LINK card to those of its body.
  pure function gauge_on(model, link, at, is_left) result(gauge)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link    !! number in the model's list
    real(wp), intent(in) :: at     !! from the first pin of its card [m]
    logical, intent(in) :: is_left !! of the direction of its card
    type(body_gauge_t) :: gauge

    real(wp) :: place(2)

    gauge%body = body_of(model, link)
    gauge%is_reversed = runs_against(model, gauge%body)
    place = place_on_body(model, gauge%body, [at, merge(1.0_wp, -1.0_wp, is_left)])
    gauge%place = place(1)/model%links(link)%length
    gauge%side = nint(place(2))
  end function gauge_on

end module response_parts
