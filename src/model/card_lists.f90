!> Lists that grow as a deck is read: cards of keywords with several meanings, of which a list holds
!! one; pins whose places follow from others.
module card_lists
  use balance_cards, only: shaft_card_t
  use drive_cards, only: branch_t
  use joint_cards, only: drawn_pin_t
  use load_cards, only: force_card_t, torque_card_t
  use process_cards, only: process_card_t
  implicit none (type, external)
  private

  public :: append_card

  !> Appends a card to the list of its kind.
  interface append_card
    module procedure append_branch, append_shaft, append_force, append_torque, append_process, &
      append_drawn_pin
  end interface append_card

contains

  pure subroutine append_branch(list, card)
    type(branch_t), allocatable, intent(inout) :: list(:) !! one longer afterwards
    type(branch_t), intent(in) :: card

    type(branch_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = card
    call move_alloc(longer, list)
  end subroutine append_branch

  pure subroutine append_shaft(list, card)
    type(shaft_card_t), allocatable, intent(inout) :: list(:) !! one longer afterwards
    type(shaft_card_t), intent(in) :: card

    type(shaft_card_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = card
    call move_alloc(longer, list)
  end subroutine append_shaft

  pure subroutine append_force(list, card)
    type(force_card_t), allocatable, intent(inout) :: list(:) !! one longer afterwards
    type(force_card_t), intent(in) :: card

    type(force_card_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = card
    call move_alloc(longer, list)
  end subroutine append_force

  pure subroutine append_torque(list, card)
    type(torque_card_t), allocatable, intent(inout) :: list(:) !! one longer afterwards
    type(torque_card_t), intent(in) :: card

    type(torque_card_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = card
    call move_alloc(longer, list)
  end subroutine append_torque

  pure subroutine append_process(list, card)
    type(process_card_t), allocatable, intent(inout) :: list(:) !! one longer afterwards
    type(process_card_t), intent(in) :: card

    type(process_card_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = card
    call move_alloc(longer, list)
  end subroutine append_process

  pure subroutine append_drawn_pin(list, card)
    type(drawn_pin_t), allocatable, intent(inout) :: list(:) !! one longer afterwards
    type(drawn_pin_t), intent(in) :: card

    type(drawn_pin_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = card
    call move_alloc(longer, list)
  end subroutine append_drawn_pin

end module card_lists
