!> Whether the deck has all that its reports need.
module report_needs
  use card_table, only: pattern_of
  use diagnostics, only: add_error, diagnostics_t
  use link_cards, only: has_own_mass, link_t
  use models, only: bears_lumped_masses, bends_links, inertia_lumped, model_t, needs_beams, &
    needs_frequencies, needs_masses, needs_response, report_number, runs_in_time, weighs_links
  use text, only: joined, word_list
  implicit none (type, external)
  private

  public :: check_report_needs

contains

  !> Checks what reports need. Errors: a link without material, section or mesh, or without a mass;
  !! a bending link with its own mass; REPORT points without POINT cards, REPORT friction without
  !! FRICTION cards; REPORT equilibrium with several free drives.
  pure subroutine check_report_needs(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose links have their materials, sections
                                                      !! and meshes

    integer :: i, points

    do i = 1, size(model%links)
      call check_link(diagnostics, model, model%links(i))
    end do
    i = report_number(model, "equilibrium")
    ! The first drive does not act there, whatever its card says.
    if (i > 0 .and. any(model%drives(2:)%is_free)) call add_error(diagnostics, &
      model%reports(i)%keyword, "rests of a linkage with more than one free drive "// &
      "are not found yet")
    if (report_number(model, "motion") == 0) then
      do i = 1, size(model%drives)
        if (model%drives(i)%speed_word%line > 0) call add_error(diagnostics, &
          model%drives(i)%speed_word, "'speed=' is that with which a free drive begins in "// &
          "REPORT motion, and there is none")
      end do
    end if
    i = report_number(model, "geometry")
    if (i > 0 .and. .not. runs_in_time(model)) then
      if (model%reports(i)%times_word%line > 0) call add_error(diagnostics, &
        model%reports(i)%times_word, "a position is one of the first drive here, which moves "// &
        "all: expected 'crank='; 'time=' is for several drives with laws")
    end if
    i = report_number(model, "friction")
    if (i > 0 .and. size(model%frictions) == 0) call add_error(diagnostics, &
      model%reports(i)%keyword, "this report is about joints that rub, and there is no "// &
      "FRICTION card; expected: "//pattern_of("FRICTION"))
    points = report_number(model, "points")
    if (points == 0 .or. size(model%points) > 0) return
    call add_error(diagnostics, model%reports(points)%keyword, &
      "this report has a row for every POINT card, and there is none; "// &
      "expected: "//pattern_of("POINT"))
  end subroutine check_report_needs

  !> Reports what a link lacks, as a beam or as a body with a mass.
  pure subroutine check_link(diagnostics, model, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link

    character(len=:), allocatable :: lacking, way_out
    logical :: beam, mass, mesh

    beam = bends_links(model) .and. .not. link%rigid
    mass = weighs_links(model) .or. needs_frequencies(model) .or. needs_response(model)
    mesh = (needs_beams(model) .and. .not. link%rigid) .or. (needs_masses(model) .and. &
      model%inertia == inertia_lumped .and. bears_lumped_masses(link))
    if (beam .and. has_own_mass(link)) then
      call add_error(diagnostics, link%body_word, "link '"//link%name%text// &
        "' bends, and a beam has the mass of its section; "// &
        "expected 'rigid' on this card, or no '"//link%body_word%text//"='")
      return
    end if
    ! Its moment of inertia is given, or follows from the mass; of rams see `check_bodies`.
    if (.not. beam) mass = mass .and. .not. link%has_mass
    lacking = ""
    if ((beam .or. mass) .and. link%material_name%line == 0) lacking = lacking//" material"
    if ((beam .or. mass) .and. link%section_name%line == 0) lacking = lacking//" section"
    way_out = ""
    if (len(lacking) > 0 .and. .not. beam) way_out = ", or 'mass='"
    if (mesh .and. link%mesh == 0) lacking = lacking//" mesh"
    if (len(lacking) == 0) return
    call add_error(diagnostics, link%name, "link '"//link%name%text//"' has no "// &
      joined(word_list(lacking(2:)), " or ")//"; the reports asked for need "// &
      trim(merge("it  ", "them", index(lacking(2:), " ") == 0))//way_out)
  end subroutine check_link

end module report_needs
