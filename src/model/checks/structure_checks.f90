!> Decks without a DRIVE whose linkage is a structure: frames, trusses, rigid links on springs.
module structure_checks
  use card_table, only: pattern_of
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use models, only: is_moving, model_t, needs_frequencies, report_number
  use text, only: joined, word_list
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: describes_structure, take_structure, check_structure

  !> What there is of a structure; the quantities of REPORT summary are those of these.
  character(len=*), parameter :: reports_of_structures = &
    "frequencies shapes reactions bearings frame geometry summary"

contains

  !> Whether a deck without a DRIVE means a structure: it clamps links, or asks for frequencies, or
  !! where the links are, as figures do.
  pure function describes_structure(model) result(describes)
    type(model_t), intent(in) :: model !! with its cards read; without drives
    logical :: describes

    describes = size(model%clamps) > 0 .or. needs_frequencies(model) .or. report_number(model, &
      "geometry") > 0
  end function describes_structure

  !> Gives a structure its one position, at which the crank of tables is 0.
  pure subroutine take_structure(model)
    type(model_t), intent(inout) :: model !! with its cards read

    model%is_structure = .true.
    model%crank%value = [0.0_wp]
    model%crank%word = [0]
  end subroutine take_structure

  !> Checks a structure. Errors: a report about a linkage that moves, a speed.
  pure subroutine check_structure(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! with its reports

    type(token_t) :: place
    integer :: i, k

    if (.not. model%is_structure) return
    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (len_trim(report%kind%name) == 0) cycle
        if (.not. is_of_structures(report%kind%name)) call refuse(diagnostics, &
          report%keyword, "REPORT "//trim(report%kind%name))
        if (.not. allocated(report%summary%reports)) cycle
        do k = 1, size(report%summary%reports)
          if (.not. is_of_structures(report%summary%reports(k))) call refuse( &
            diagnostics, report%summary%words(k), "'"//report%summary%words(k)%text//"'")
        end do
      end associate
    end do
    if (.not. is_moving(model)) return
    place = token_t("", 0, 0)
    if (size(model%speed%words) > 0) place = model%speed%words(1)
    call add_error(diagnostics, place, "a structure does not move: expected no SPEED, or a "// &
      "DRIVE card for the link that turns")
  end subroutine check_structure

  !> Refuses what only linkages that move have.
  pure subroutine refuse(diagnostics, word, what)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(token_t), intent(in) :: word
    character(len=*), intent(in) :: what !! it is

    call add_error(diagnostics, word, what//" is about a linkage that moves, and this deck "// &
      "has no DRIVE; expected: "//pattern_of("DRIVE")//", with CRANK; of a structure there "// &
      "are "//joined(word_list(reports_of_structures)))
  end subroutine refuse

  !> Whether a report has rows of a structure.
  pure function is_of_structures(name) result(is)
    character(len=*), intent(in) :: name !! of the report
    logical :: is

    is = index(" "//reports_of_structures//" ", " "//trim(name)//" ") > 0
  end function is_of_structures

end module structure_checks
