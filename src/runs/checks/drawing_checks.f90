!> A drawing may be rough: where it contradicts the lengths of links, these count, and the user is
!! told both numbers.
module drawing_checks
  use deck_lengths, only: length_text
  use diagnostics, only: add_warning, diagnostics_t
  use drive_cards, only: drive_ram
  use kinds, only: wp
  use link_cards, only: link_t
  use link_shapes, only: compare_lengths
  use models, only: model_t
  use text, only: append_string, same_word, string_t
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: check_drawing, drawing_remarks

  !> Kind of the warning, apart from other warnings at the same word.
  integer, parameter :: warning_of_drawing = 2

  !> Difference of a length from that in the drawing, relative to the length [-]: below the first
  !! coordinates are only rounded, above the second the drawing is more than rough.
  real(wp), parameter :: least_difference = 1.0e-4_wp, most_difference = 0.1_wp

contains

  !> A warning for every link whose length is off by more than a tenth in the drawing, about its
  !! worst segment.
  pure subroutine check_drawing(model, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(diagnostics_t), intent(inout) :: diagnostics !! to which the warnings are added

    real(wp), allocatable :: given(:), drawn(:), difference(:)
    integer :: i, worst

    if (size(model%drawn_pins) == 0) return
    do i = 1, size(model%links)
      call find_differences(model, i, given, drawn, difference)
      if (size(difference) == 0) cycle
      worst = maxloc(difference, dim=1)
      if (difference(worst) <= most_difference) cycle
      call add_warning(diagnostics, model%links(i)%length_word, contradiction(model, &
        model%links(i), worst, given(worst), drawn(worst)), kind=warning_of_drawing, &
        amount=difference(worst), second_place=drawn_end(model, model%links(i), worst), &
        note="the drawing is here")
    end do
  end subroutine check_drawing

  !> A line for every length that differs from that in the drawing by more than rounding.
  pure function drawing_remarks(model) result(remarks)
    type(model_t), intent(in) :: model !! without errors
    type(string_t), allocatable :: remarks(:)

    real(wp), allocatable :: given(:), drawn(:), difference(:)
    integer :: i, k

    allocate (remarks(0))
    if (size(model%drawn_pins) == 0) return
    do i = 1, size(model%links)
      call find_differences(model, i, given, drawn, difference)
      do k = 1, size(difference)
        if (difference(k) > least_difference) call append_string(remarks, "drawing: "// &
          contradiction(model, model%links(i), k, given(k), drawn(k)))
      end do
    end do
  end function drawing_remarks

  !> By how much the segments of a link are off in the drawing, relative to their lengths; 0 where
  !! card or drawing do not give them. The length of a driven ram is that of its drive.
  pure subroutine find_differences(model, number, given, drawn, difference)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number                       !! of the link
    real(wp), allocatable, intent(out) :: given(:)      !! (segments) [m]
    real(wp), allocatable, intent(out) :: drawn(:)      !! (segments) [m]
    real(wp), allocatable, intent(out) :: difference(:) !! (segments) [-]

    logical, allocatable :: known(:)

    call compare_lengths(model, model%links(number), given, drawn, known)
    if (any(model%drives%kind == drive_ram .and. model%drives%link == number)) known = .false.
    allocate (difference(size(given)))
    difference = 0.0_wp
    where (known) difference = abs(drawn - given)/given
  end subroutine find_differences

  !> `the drawing has 61.2 mm for 'j' from C to P1; its length of 50 mm counts`
  pure function contradiction(model, link, segment, given, drawn) result(words)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link
    integer, intent(in) :: segment          !! number
    real(wp), intent(in) :: given, drawn    !! [m]
    character(len=:), allocatable :: words

    words = "the drawing has "//length_text(model, drawn, 6)//" for '"//link%name%text// &
      "' from "//link%pins(segment)%text//" to "//link%pins(mod(segment, size(link%pins)) + &
      1)%text//"; its length of "//length_text(model, given, 6)//" counts"
  end function contradiction

  !> The PIN card of an end of a segment.
  pure function drawn_end(model, link, segment) result(place)
    type(model_t), intent(in) :: model !! with PIN cards
    type(link_t), intent(in) :: link
    integer, intent(in) :: segment     !! number
    type(token_t) :: place

    integer :: ends(2), k, i

    ends = [mod(segment, size(link%pins)) + 1, segment]
    place = model%drawn_pins(1)%pin
    do k = 1, 2
      do i = 1, size(model%drawn_pins)
        if (.not. same_word(model%drawn_pins(i)%pin%text, link%pins(ends(k))%text)) cycle
        place = model%drawn_pins(i)%pin
        return
      end do
    end do
  end function drawn_end

end module drawing_checks
