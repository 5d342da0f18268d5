!> What a linkage reaches, in words: for messages about a deck and for failed rows.
module reach_texts
  use deck_lengths, only: length_text, missing_text
  use errors, only: error_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t
  implicit none (type, external)
  private

  public :: open_linkage_text, longest_link, reach_words

contains

  !> Why a linkage closes at no crank angle: one link is longer than all the others together.
  pure function open_linkage_text(mechanism) result(text)
    type(mechanism_t), intent(in) :: mechanism !! whose linkage does not close
    character(len=:), allocatable :: text

    integer :: longest

    longest = longest_link(mechanism)
    if (longest == 0) then
      text = "the linkage closes at no crank angle: the ground pivots are farther "// &
        "apart than the three links together are long"
    else
      text = "the linkage closes at no crank angle: link '"//mechanism%names(longest)%text// &
        "' is longer than the other links and the distance of the ground pivots together"
    end if
  end function open_linkage_text

  !> Number of the longest link.
  pure function longest_link(mechanism) result(longest)
    type(mechanism_t), intent(in) :: mechanism !! a four-bar
    integer :: longest                         !! body; 0: the ground

    associate (ground => mechanism%linkage%ground_position, &
      length => mechanism%linkage%bodies%length)
      longest = maxloc(length, dim=1)
      if (norm2(ground(:, 4) - ground(:, 1)) > length(longest)) longest = 0
    end associate
  end function longest_link

  !> What does not reach, and by how much: `'rod' is 12.5 mm too short`; empty if it is not known.
  pure function reach_words(model, mechanism, error) result(words)
    type(model_t), intent(in) :: model         !! its units
    type(mechanism_t), intent(in) :: mechanism !! of this model
    type(error_t), intent(in) :: error         !! of a position out of reach
    character(len=:), allocatable :: words

    words = "a block on a GUIDE"
    if (error%place%body > 0) words = "'"//mechanism%names(error%place%body)%text//"'"
    if (index(error%text, "redundant") > 0) then
      words = words//" does not fit, by "//length_text(model, abs(error%missing), 3)
    else if (error%place%body == 0) then
      words = ""
    else if (error%place%other > 0) then
      words = words//" and '"//mechanism%names(error%place%other)%text//"' together are "// &
        missing_text(model, error%missing)
    else if (abs(error%missing) > 0.0_wp) then
      words = words//" is "//missing_text(model, error%missing)
    else
      words = words//" does not reach"
    end if
  end function reach_words

end module reach_texts
