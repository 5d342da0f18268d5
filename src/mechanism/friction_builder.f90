!> Model → friction in the joints of the linkage.
module friction_builder
  use friction_cards, only: friction_card_t
  use joint_friction_types, only: joint_friction_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use models, only: model_t
  use name_index, only: find_name, name_index_t
  implicit none (type, external)
  private

  public :: frictions_of

contains

  !> What rubs, in the order of the deck: every pair of links at a pin, and a block, or both ends of
  !! one to which a link is fixed.
  pure function frictions_of(model, links, pins, linkage) result(frictions)
    type(model_t), intent(in) :: model         !! without errors
    integer, intent(in) :: links(:)            !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins     !! names of the pins
    type(linkage_t), intent(in) :: linkage     !! its sliders, as in the model, and turns
    type(joint_friction_t), allocatable :: frictions(:)

    integer :: filled, i, k, joint, turn

    filled = 0
    do i = 1, size(model%frictions)
      filled = filled + number_of(model%frictions(i), linkage)
    end do
    allocate (frictions(filled))
    filled = 0
    joint = 0
    do i = 1, size(model%frictions)
      associate (card => model%frictions(i))
        do k = 1, number_of(card, linkage)
          filled = filled + 1
          if (k == 1 .or. card%slider == 0) joint = joint + 1
          associate (rub => frictions(filled))
            rub%joint = joint
            rub%pin = find_name(pins, card%pin%text)
            rub%coefficient = card%coefficient
            rub%viscous = card%viscous
            rub%smooth = card%smooth
            if (card%slider == 0) then
              rub%radius = card%radius
              rub%body = findloc(links, card%pairs(1, k), dim=1)
              rub%against = findloc(links, card%pairs(2, k), dim=1)
              cycle
            end if
            rub%slider = card%slider
            turn = findloc(linkage%turns%slider, card%slider, dim=1)
            if (turn == 0 .or. card%length <= 0.0_wp) cycle
            rub%turn = turn
            rub%reach = merge(card%length, -card%length, k == 1)
            rub%viscous = 0.5_wp*card%viscous
          end associate
        end do
      end associate
    end do
  end function frictions_of

  !> Number of frictions of a card.
  pure function number_of(card, linkage) result(number)
    type(friction_card_t), intent(in) :: card
    type(linkage_t), intent(in) :: linkage
    integer :: number

    number = size(card%pairs, 2)
    if (card%slider == 0) return
    number = 1
    if (card%length > 0.0_wp .and. any(linkage%turns%slider == card%slider)) number = 2
  end function number_of

end module friction_builder
