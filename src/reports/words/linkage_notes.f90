!> Notes on the linkage, for the heads of tables and the log.
module linkage_notes
  use drive_positions, only: shown_crank, unit_of_drive
  use kinds, only: wp
  use plan_words, only: plan_notes
  use text, only: append_string, string_t, to_string
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: notes_on_linkage, angle_note

contains

  !> Grashof class, limit positions, extreme transmission angles; or that the linkage does not
  !! close.
  pure function notes_on_linkage(variant) result(notes)
    type(variant_results_t), intent(in) :: variant !! with class and transmission angles
    type(string_t), allocatable :: notes(:)

    character(len=:), allocatable :: limits
    integer :: i

    if (.not. variant%mechanism%is_four_bar) then
      notes = plan_notes(variant%mechanism)
      call append_home_range(variant, notes)
      return
    end if
    associate (class => variant%found%class, found => variant%found%transmission)
      call append_string(notes, class%grashof)
      if (.not. class%closes) then
        call append_string(notes, variant%unreachable)
        return
      end if
      limits = "limit positions of the crank: none"
      do i = 1, size(class%limits)
        if (i == 1) limits = "limit positions of the crank:"
        limits = limits//" "//to_string(class%limits(i), 9)
      end do
      if (size(class%limits) > 0) limits = limits//" deg"
      call append_string(notes, limits)
      call append_home_range(variant, notes)
      if (found%most < 0.0_wp) return
      call append_string(notes, "transmission angle: "// &
        to_string(found%least)//" deg at crank "//to_string(found%at_least, 10)//" to "// &
        to_string(found%most)//" deg at crank "//to_string(found%at_most, 10))
    end associate
  end function notes_on_linkage

  !> The cycle, if it is longer than a turn, and the range in which the linkage is, if there are
  !! several.
  pure subroutine append_home_range(variant, notes)
    type(variant_results_t), intent(in) :: variant
    type(string_t), allocatable, intent(inout) :: notes(:)

    character(len=:), allocatable :: range

    associate (home => variant%found%home)
      if (home%period > 0.0_wp) call append_string(notes, "cycle: "//to_string(home%period, 7)// &
        " deg of the first drive, after which the linkage repeats its positions")
      if (home%ranges == 0) return
      range = "range of the first position in reach: "
      if (home%is_drawn) range = "range of the drawing: "
      call append_string(notes, range//to_string(shown_crank(variant, home%ends(1)), 9)//" to "// &
        to_string(shown_crank(variant, home%ends(2)), 9)//" "//unit_of_drive(variant)// &
        ", one of "//to_string(home%ranges)//"; positions in others are reached only by taking "// &
        "the linkage apart")
    end associate
  end subroutine append_home_range

  !> The links with the angles theta3 and theta4, and the pins from and to which these are
  !! measured.
  pure function angle_note(variant) result(note)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    character(len=:), allocatable :: note

    ! By number: names chosen by an array of numbers would leak their texts (gfortran 12).
    associate (names => variant%mechanism%names, link => variant%mechanism%four_bar%body, &
        pins => variant%mechanism%pin_names, pin => variant%mechanism%four_bar%pin)
      note = "3: link "//names(link(2))%text//", angle from "//pins(pin(2))%text//" to "// &
        pins(pin(3))%text//"; 4: link "//names(link(3))%text//", angle from "// &
        pins(pin(4))%text//" to "//pins(pin(3))%text
    end associate
  end function angle_note

end module linkage_notes
