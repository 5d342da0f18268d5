!> Notes on the linkage, for the heads of tables and the log.
module linkage_notes
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
    type(variant_results_t), intent(in) :: variant !! with class and kinematics computed
    type(string_t), allocatable :: notes(:)

    character(len=:), allocatable :: limits
    integer :: i

    if (.not. variant%mechanism%is_four_bar) then
      notes = plan_notes(variant%mechanism)
      return
    end if
    associate (class => variant%found%class, found => variant%found%kinematics, &
        crank => variant%found%positions%crank, state => variant%found%positions%state)
      call append_string(notes, class%grashof)
      if (.not. class%reach%closes) then
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
      if (found%at_least == 0) return
      call append_string(notes, "transmission angle: "// &
        to_string(found%transmission(state(found%at_least)))//" deg at crank "// &
        to_string(crank(found%at_least), 10)//" to "// &
        to_string(found%transmission(state(found%at_most)))//" deg at crank "// &
        to_string(crank(found%at_most), 10))
    end associate
  end function notes_on_linkage

  !> The links with the angles theta3 and theta4, and the pins from and to which these are
  !! measured.
  pure function angle_note(variant) result(note)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    character(len=:), allocatable :: note

    associate (names => variant%mechanism%names, pins => variant%mechanism%pin_names)
      note = "3: link "//names(2)%text//", angle from "//pins(2)%text//" to "//pins(3)%text// &
        "; 4: link "//names(3)%text//", angle from "//pins(4)%text//" to "//pins(3)%text
    end associate
  end function angle_note

end module linkage_notes
