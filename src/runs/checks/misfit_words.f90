!> What a redundant equation is about, as its card names it, and by how much it is not fulfilled.
module misfit_words
  use constants, only: degree
  use deck_lengths, only: length_text, missing_text
  use joint_cards, only: weld_t
  use kinds, only: wp
  use linkages, only: demand_angle, demand_length, demand_line, equation_t
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use text, only: same_word, to_string
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: name_redundancy, misfit_text, amount_text

contains

  !> `'bar'`, `SLIDER B bore rod`, `WELD of 'b' at 'C'`, `CLAMP of 'b' at 'O'`, and its place.
  pure subroutine name_redundancy(model, mechanism, equation, place, words)
    type(model_t), intent(in) :: model         !! as read
    type(mechanism_t), intent(in) :: mechanism !! of this model
    type(equation_t), intent(in) :: equation   !! a redundancy of its linkage
    type(token_t), intent(out) :: place        !! in the deck
    character(len=:), allocatable, intent(out) :: words

    select case (equation%kind)
    case (demand_length, demand_angle)
      place = model%links(mechanism%links(equation%body))%name
      words = "'"//place%text//"'"
    case (demand_line)
      place = model%sliders(equation%number)%pin
      words = slider_words(model, equation%number)
    case default
      associate (turn => mechanism%linkage%turns(equation%number), pins => mechanism%pin_names)
        if (turn%slider > 0) then
          place = model%sliders(turn%slider)%turned
          words = slider_words(model, turn%slider)
        else if (turn%against > 0) then
          place = place_of_weld(model%welds, pins(turn%pin)%text, &
            model%links(mechanism%links(turn%body))%name)
          words = "WELD of '"//mechanism%names(turn%body)%text//"' at '"//pins(turn%pin)%text//"'"
        else
          place = place_of_weld(model%clamps, pins(turn%pin)%text, &
            model%links(mechanism%links(turn%body))%name)
          words = "CLAMP of '"//mechanism%names(turn%body)%text//"' at '"//pins(turn%pin)%text//"'"
        end if
      end associate
    end select
  end subroutine name_redundancy

  !> A SLIDER as its card has it: `SLIDER B bore rod`.
  pure function slider_words(model, number) result(words)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the slider
    character(len=:), allocatable :: words

    associate (slider => model%sliders(number))
      words = "SLIDER "//slider%pin%text//" "//slider%on%text
      if (slider%turned_link > 0) words = words//" "//slider%turned%text
    end associate
  end function slider_words

  !> Where a card of a pin names a link; its pin, if it names none.
  pure function place_of_weld(welds, pin, link) result(place)
    type(weld_t), intent(in) :: welds(:)
    character(len=*), intent(in) :: pin
    type(token_t), intent(in) :: link !! its name
    type(token_t) :: place

    integer :: i, k

    place = link
    do i = 1, size(welds)
      if (.not. same_word(welds(i)%pin%text, pin)) cycle
      place = welds(i)%pin
      do k = 1, size(welds(i)%links)
        place = welds(i)%links(k)
        if (same_word(place%text, link%text)) return
      end do
    end do
  end function place_of_weld

  !> By how much, and in which sense: `3 mm too short`, `3 mm off its line`.
  pure function misfit_text(model, mechanism, equation, misfit) result(words)
    type(model_t), intent(in) :: model         !! as read
    type(mechanism_t), intent(in) :: mechanism !! of this model
    type(equation_t), intent(in) :: equation   !! a redundancy of its linkage
    real(wp), intent(in) :: misfit             !! of `largest_misfit` [m]
    character(len=:), allocatable :: words

    words = amount_text(model, mechanism, equation, misfit)
    select case (equation%kind)
    case (demand_length)
      words = missing_text(model, misfit)
    case (demand_angle)
      words = words//" aside of pin '"//mechanism%pin_names(equation%pin)%text//"'"
    case (demand_line)
      words = words//" off its line"
    case default
      associate (turn => mechanism%linkage%turns(equation%number))
        words = "'"//mechanism%names(turn%body)%text//"' turned by "//words
        if (turn%against > 0) then
          words = words//" against '"//mechanism%names(turn%against)%text//"'"
        else
          words = words//" from its angle"
        end if
      end associate
    end select
  end function misfit_text

  !> By how much: a length, of what turns together an angle.
  pure function amount_text(model, mechanism, equation, misfit) result(words)
    type(model_t), intent(in) :: model         !! as read
    type(mechanism_t), intent(in) :: mechanism !! of this model
    type(equation_t), intent(in) :: equation   !! a redundancy of its linkage
    real(wp), intent(in) :: misfit             !! of `largest_misfit` [m]
    character(len=:), allocatable :: words

    if (any(equation%kind == [demand_length, demand_angle, demand_line])) then
      words = length_text(model, abs(misfit), 6)
    else
      words = to_string(abs(misfit)/mechanism%linkage%bodies(mechanism%linkage%turns( &
        equation%number)%body)%length/degree, 6)//" deg"
    end if
  end function amount_text

end module misfit_words
