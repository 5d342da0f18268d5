!> The BALANCE cards of a model as a request, in the terms of mechanics.
module balance_requests
  use balance_cards, only: weight_make_t
  use balance_study, only: balance_request_t, counterweight_make_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t
  implicit none (type, external)
  private

  public :: balance_request_of

contains

  !> The counterweights and balance shafts that the BALANCE cards ask for. Counterweights are in the
  !! order of the card, without names in that of the deck.
  pure function balance_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with BALANCE cards
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(balance_request_t) :: request

    integer :: i

    associate (card => model%balance)
      allocate (request%bodies(0), request%radius(0))
      if (card%keyword%line > 0) then
        request%bodies = [(findloc(mechanism%links, card%links(i), dim=1), i=1, size(card%links))]
        request%radius = spread(0.0_wp, 1, size(card%links))
        if (size(card%radius) == 1) request%radius = card%radius(1)
        if (size(card%radius) > 1) request%radius = card%radius
        request%aim = card%aim
        request%make = make_of(card%make)
      end if
    end associate
    allocate (request%shafts(size(model%shafts)))
    do i = 1, size(model%shafts)
      associate (card => model%shafts(i), pair => request%shafts(i))
        pair%order = card%order
        pair%place = card%place
        pair%is_placed = card%is_placed
        pair%radius = card%radius
        pair%make = make_of(card%make)
      end associate
    end do
  end function balance_request_of

  pure function make_of(card) result(make)
    type(weight_make_t), intent(in) :: card
    type(counterweight_make_t) :: make

    make = counterweight_make_t(card%density, card%thickness, card%inertia)
  end function make_of

end module balance_requests
