!> Counterweights: masses fixed to links, each about one of its pins.
module balanced_linkages
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, lump_t, turned
  use pose_types, only: place_of_pin
  implicit none (type, external)
  private

  public :: counterweight_t, counterweight_lump, balanced_linkage

  !> A counterweight on a link, about one of its pins.
  type :: counterweight_t
    integer :: body = 0                  !! number in the linkage
    real(wp) :: first_moment(2) = 0.0_wp !! mass × position from the pin: along the way to the other
                                         !! pin, and to its left [kg m]
    logical :: needed = .false.          !! false if only rounding is left
    integer :: pin = 0                   !! about which it balances: a ground pivot, or the pin
                                         !! through which the link hangs on others
    integer :: towards = 0               !! another pin of the link
  end type counterweight_t

contains

  !> A counterweight as a point mass at a distance from its pin, in the axes of its body.
  pure function counterweight_lump(weight, body, radius) result(lump)
    type(counterweight_t), intent(in) :: weight !! one that is needed
    type(body_t), intent(in) :: body            !! that carries it
    real(wp), intent(in) :: radius              !! from the pin [m]
    type(lump_t) :: lump

    real(wp) :: from(2), way(2)

    from = place_of_pin(body, weight%pin)
    way = place_of_pin(body, weight%towards) - from
    lump%mass = norm2(weight%first_moment)/radius
    lump%place = from + turned(weight%first_moment*(radius/norm2(weight%first_moment)), &
      way/norm2(way))
  end function counterweight_lump

  !> The linkage with its counterweights, each at a distance from its pin equal to the length of its
  !! link.
  pure function balanced_linkage(linkage, weights) result(balanced)
    type(linkage_t), intent(in) :: linkage          !! without them
    type(counterweight_t), intent(in) :: weights(:) !! on different links
    type(linkage_t) :: balanced

    integer :: i

    balanced = linkage
    do i = 1, size(weights)
      if (.not. weights(i)%needed) cycle
      associate (body => balanced%bodies(weights(i)%body))
        body%lumps = [body%lumps, counterweight_lump(weights(i), body, body%length)]
      end associate
    end do
  end function balanced_linkage

end module balanced_linkages
