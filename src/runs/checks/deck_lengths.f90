! src/runs/checks/ - what mechanics refuses or warns of before a run, at words of the deck.
! In: a `model_t` without errors. Out: errors and warnings in `diagnostics_t`. Begin with
! `check_mechanics` in `deck_checks.f90`; it calls `check_linkage` in `linkage_checks.f90` where
! there is no four-bar, `report_problem` in `plan_faults.f90` where there is no plan.
! Not here: checks without mechanics (`src/model/checks`), what fails in a computation
! (`src/runs/variant_findings.f90`).

!> Lengths and positions in the unit of a deck, as its messages have them.
module deck_lengths
  use kinds, only: wp
  use models, only: drives_length, model_t, runs_in_time
  use text, only: to_string
  use units, only: coherent_unit, dimension_length, from_si, unit_t
  use value_words, only: in_words
  implicit none (type, external)
  private

  public :: in_deck, length_text, missing_text, crank_text, unit_of_crank, word_of_positions

contains

  !> A length in the unit of the deck.
  pure function in_deck(model, length) result(value)
    type(model_t), intent(in) :: model !! as read
    real(wp), intent(in) :: length     !! [m]
    real(wp) :: value

    value = from_si(length, coherent_unit(model%units, dimension_length))
  end function in_deck

  !> `12.5 mm`
  pure function length_text(model, length, digits) result(words)
    type(model_t), intent(in) :: model !! as read
    real(wp), intent(in) :: length     !! [m]
    integer, intent(in) :: digits      !! at most
    character(len=:), allocatable :: words

    words = in_words(length, dimension_length, model%units, digits)
  end function length_text

  !> `12.5 mm too short`
  pure function missing_text(model, missing) result(words)
    type(model_t), intent(in) :: model !! as read
    real(wp), intent(in) :: missing    !! by how much a length is too short; negative: too long [m]
    character(len=:), allocatable :: words

    words = length_text(model, abs(missing), 6)//" too "//trim(merge("short", "long ", &
      missing > 0.0_wp))
  end function missing_text

  !> The unit of the positions of the first drive in the deck, in time of instants.
  pure function unit_of_crank(model) result(unit)
    type(model_t), intent(in) :: model !! as read
    character(len=:), allocatable :: unit

    type(unit_t) :: measure

    unit = trim(merge("s  ", "deg", runs_in_time(model)))
    if (.not. drives_length(model) .or. runs_in_time(model)) return
    measure = coherent_unit(model%units, dimension_length)
    unit = measure%name
  end function unit_of_crank

  !> `crank`, of lengths `position`, or in time `time`: what the positions of a deck are.
  pure function word_of_positions(model) result(word)
    type(model_t), intent(in) :: model !! as read
    character(len=:), allocatable :: word

    word = trim(merge("position", "crank   ", drives_length(model)))
    if (runs_in_time(model)) word = "time"
  end function word_of_positions

  !> A position of the first drive: in degrees, of a slider or a ram in the unit of the deck; in
  !! time an instant.
  pure function crank_text(model, crank, digits) result(words)
    type(model_t), intent(in) :: model !! as read
    real(wp), intent(in) :: crank      !! [deg] or [m]
    integer, intent(in) :: digits      !! at most
    character(len=:), allocatable :: words

    if (drives_length(model) .and. .not. runs_in_time(model)) then
      words = to_string(in_deck(model, crank), digits)
    else
      words = to_string(crank, digits)
    end if
  end function crank_text

end module deck_lengths
