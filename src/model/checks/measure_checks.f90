!> Checks of MEASURE cards: the pins, links, guides and coordinates that they name, and whether
!! anything moves there.
module measure_checks
  use body_checks, only: seek_link
  use card_table, only: pattern_of
  use diagnostics, only: add_error, diagnostics_t
  use joint_checks, only: find_way, joins
  use measure_cards, only: measure_across, measure_along, measure_angle, measure_card_t, &
    measure_distance, measure_sum, measure_travel
  use models, only: model_t, report_number, report_with
  use name_checks, only: pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use named_coordinates, only: coordinate_number, find_named_coordinates, named_coordinate_t, &
    of_measure
  use natures, only: are_alike
  use report_cards, only: report_t
  use spelling, only: suggestion
  use spring_checks, only: check_ends, is_on_weld, refuse_still_links, seek_place
  use summary_cards, only: summary_card_t
  use summary_quantities, only: quantity_kinds
  use text, only: lower_case, same_word, string_t
  use tokens, only: token_part, token_t, token_texts
  use units, only: dimension_name
  implicit none (type, external)
  private

  public :: check_measures, seek_coordinate, refuse_two

contains

  !> Looks up what the cards name. Errors: an unknown pin, link, guide or coordinate; a measure that
  !! cannot change: between places of one rigid link, of two that are welded, or of the ground; a
  !! sum of angles and lengths, or of sums; a name that another coordinate has; those of
  !! `check_report`.
  pure subroutine check_measures(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! has its joints looked up; numbers of the
                                                      !! cards are set

    type(name_index_t) :: links, pins, grounds, guides
    type(named_coordinate_t), allocatable :: all_names(:)
    type(measure_card_t) :: measure
    integer :: i

    call find_named_coordinates(model, all_names)
    call check_report(diagnostics, all_names, model)
    if (size(model%measures) == 0) return
    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    guides = new_name_index(token_texts(model%guides%name))
    do i = 1, size(model%measures)
      measure = model%measures(i)
      if (measure%name%line == 0) cycle
      call refuse_taken_name(diagnostics, all_names, measure%name)
      select case (measure%kind)
      case (measure_distance)
        call check_distance(diagnostics, model, links, pins, grounds, measure)
      case (measure_angle)
        call find_links(diagnostics, model, links, pins, measure)
      case (measure_along, measure_across)
        call find_line(diagnostics, model, links, pins, grounds, guides, measure)
      case (measure_travel)
        call check_travel(diagnostics, model, links, pins, grounds, measure)
      case (measure_sum)
        call check_sum(diagnostics, all_names, measure)
      end select
      model%measures(i) = measure
    end do
  end subroutine check_measures

  !> REPORT coordinates, or motion with them. Errors: there is nothing of which it has rows; two
  !! coordinates with one name; an unknown one in `ratio_to=`, or one that nothing is compared with.
  pure subroutine check_report(diagnostics, all_names, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(named_coordinate_t), intent(in) :: all_names(:)
    type(model_t), intent(inout) :: model

    integer :: number, i, first

    do i = 1, size(model%reports)
      call refuse_idle_reference(diagnostics, model%reports(i))
    end do
    number = report_with(model, "coordinates")
    if (number == 0) number = report_in_time(model)
    if (number == 0) return
    associate (report => model%reports(number))
      if (size(all_names) == 0) then
        call add_error(diagnostics, report%keyword, "coordinates are of every MEASURE, "// &
          "SPRING, DAMPER and SLIDER, and every link whose length is driven, and there is "// &
          "none; expected: "//pattern_of("MEASURE"))
        return
      end if
      do i = 2, size(all_names)
        associate (it => all_names(i))
          first = coordinate_number(all_names, it%name)
          ! Names of measures are checked without this report; one without a place is told already.
          if (first == i .or. it%source == of_measure .or. it%word%line == 0) cycle
          call add_error(diagnostics, it%word, "'"//it%name//"' is the name of two "// &
            "coordinates; give one another name", all_names(first)%word, "the other is here")
        end associate
      end do
      if (report%ratio_to%line > 0 .and. size(all_names) == 1) call add_error(diagnostics, &
        report%ratio_to, "there is no other coordinate to be compared with '"// &
        all_names(1)%name//"'; expected: "//pattern_of("MEASURE"))
    end associate
    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (report%ratio_to%line > 0) call seek_coordinate(diagnostics, all_names, &
          report%ratio_to, report%reference)
        if (allocated(report%summary%quantities)) call find_quantities(diagnostics, all_names, &
          report%ratio_to, report%summary)
      end associate
    end do
  end subroutine check_report

  !> The coordinates of quantities of REPORT summary. Errors: an unknown one, a ratio to nothing.
  pure subroutine find_quantities(diagnostics, all_names, ratio_to, summary)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(named_coordinate_t), intent(in) :: all_names(:)
    type(token_t), intent(in) :: ratio_to
    type(summary_card_t), intent(inout) :: summary

    type(token_t) :: name
    integer :: i, at

    do i = 1, size(summary%quantities)
      if (summary%quantities(i)%of == "") cycle
      at = index(summary%words(i)%text, ":")
      name = token_part(summary%words(i), at + 1, len(summary%words(i)%text))
      call seek_coordinate(diagnostics, all_names, name, summary%quantities(i)%mode)
      if (quantity_kinds(summary%quantities(i)%kind)%name == "ratio:" .and. ratio_to%line == 0) &
        call add_error(diagnostics, summary%words(i), "a ratio is one of two coordinates: "// &
        "expected 'ratio_to=', the name of the other, on this card")
    end do
  end subroutine find_quantities

  !> Refuses `ratio_to=` of a REPORT summary without a ratio.
  pure subroutine refuse_idle_reference(diagnostics, report)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(in) :: report

    integer :: i

    if (report%ratio_to%line == 0 .or. .not. allocated(report%summary%quantities)) return
    do i = 1, size(report%summary%quantities)
      if (quantity_kinds(report%summary%quantities(i)%kind)%name == "ratio:") return
    end do
    call add_error(diagnostics, report%ratio_to, "'ratio_to=' is for quantities 'ratio:NAME', "// &
      "of which 'of=' has none")
  end subroutine refuse_idle_reference

  !> The number of a REPORT motion that has coordinates, too; 0: there is none.
  pure function report_in_time(model) result(number)
    type(model_t), intent(in) :: model
    integer :: number

    number = report_number(model, "motion")
    if (number > 0) number = merge(number, 0, model%reports(number)%with_coordinates)
  end function report_in_time

  !> A name is that of one coordinate.
  pure subroutine refuse_taken_name(diagnostics, all_names, name)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(named_coordinate_t), intent(in) :: all_names(:)
    type(token_t), intent(in) :: name

    integer :: first

    first = coordinate_number(all_names, name%text)
    ! Two measures of one name are told by `name_checks`.
    if (all_names(first)%source == of_measure) return
    call add_error(diagnostics, name, "'"//name%text//"' is the name of another coordinate: "// &
      "springs, dampers, rams and sliders have theirs", all_names(first)%word, "it is here")
  end subroutine refuse_taken_name

  pure subroutine check_distance(diagnostics, model, links, pins, grounds, measure)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds
    type(measure_card_t), intent(in) :: measure

    logical :: fine

    call seek_place(measure%places(1), links, pins, grounds, diagnostics, fine)
    call seek_place(measure%places(2), links, pins, grounds, diagnostics, fine, fine)
    if (fine) call check_ends(diagnostics, model, grounds, measure%places, .false., fine)
  end subroutine check_distance

  pure subroutine find_links(diagnostics, model, links, pins, measure)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins
    type(measure_card_t), intent(inout) :: measure

    logical :: fine
    integer :: k

    do k = 1, 2
      if (measure%links(k)%line > 0) call seek_link(measure%links(k), links, pins, diagnostics, &
        measure%link(k))
    end do
    if (all(measure%link > 0)) call refuse_still_links(diagnostics, model, measure%links, &
      measure%link, fine)
  end subroutine find_links

  pure subroutine find_line(diagnostics, model, links, pins, grounds, guides, measure)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds, guides
    type(measure_card_t), intent(inout) :: measure

    logical :: fine
    integer :: i

    call seek_place(measure%places(1), links, pins, grounds, diagnostics, fine)
    call find_way(diagnostics, model, links, guides, measure%line, measure%guide, &
      measure%line_link)
    associate (pin => measure%places(1), line => measure%line)
      if (.not. fine) return
      if (measure%line_link > 0) then
        if (joins(model, measure%line_link, pin%text)) call add_error(diagnostics, line, &
          "'"//pin%text//"' is a place of link '"//line%text//"': it does not move in its "// &
          "axes", model%links(measure%line_link)%name, "the link is here")
        do i = 1, size(model%welds)
          if (.not. any(model%welds(i)%link == measure%line_link)) cycle
          if (joins(model, measure%line_link, pin%text) .or. .not. is_on_weld(model, i, pin)) cycle
          call add_error(diagnostics, line, "'"//pin%text//"' is on a link that is welded to '"// &
            line%text//"': it does not move in its axes", model%welds(i)%pin, &
            "they are welded here")
        end do
      else if (measure%guide > 0 .and. find_name(grounds, pin%text) > 0) then
        call add_error(diagnostics, pin, "'"//pin%text//"' and the guide are fixed: nothing "// &
          "moves between them", model%grounds(find_name(grounds, pin%text))%pin, &
          "the pin is fixed here")
      end if
      if (measure%kind /= measure_across) return
      do i = 1, size(model%sliders)
        if (.not. same_word(model%sliders(i)%pin%text, pin%text) .or. .not. &
          same_word(model%sliders(i)%on%text, line%text)) cycle
        call add_error(diagnostics, line, "'"//pin%text//"' slides along '"//line%text// &
          "' and does not move across it", model%sliders(i)%pin, "it does so here")
      end do
    end associate
  end subroutine find_line

  pure subroutine check_travel(diagnostics, model, links, pins, grounds, measure)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds
    type(measure_card_t), intent(in) :: measure

    logical :: fine
    integer :: ground

    call seek_place(measure%places(1), links, pins, grounds, diagnostics, fine)
    ground = find_name(grounds, measure%places(1)%text)
    if (fine .and. ground > 0) call add_error(diagnostics, measure%places(1), "'"// &
      measure%places(1)%text//"' is fixed and does not travel", model%grounds(ground)%pin, &
      "it is fixed here")
  end subroutine check_travel

  !> The terms of a sum.
  pure subroutine check_sum(diagnostics, all_names, measure)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(named_coordinate_t), intent(in) :: all_names(:)
    type(measure_card_t), intent(in) :: measure

    integer :: i, number, first

    first = 0
    do i = 1, size(measure%terms)
      call seek_coordinate(diagnostics, all_names, measure%terms(i), number)
      if (number == 0) cycle
      if (all_names(number)%is_sum) then
        call add_error(diagnostics, measure%terms(i), "'"//measure%terms(i)%text//"' is a sum "// &
          "itself; expected the names of what it adds", all_names(number)%word, "it is here")
        cycle
      end if
      if (first == 0) first = number
      if (are_alike(all_names([first, number])%nature)) cycle
      call add_error(diagnostics, measure%terms(i), "'"//measure%terms(i)%text//"' is "// &
        dimension_name(all_names(number)%nature%value)//", and '"//all_names(first)%name//"' "// &
        dimension_name(all_names(first)%nature%value)//": a sum is of one kind", &
        measure%terms(1), "the first is here")
    end do
  end subroutine check_sum

  !> Looks up a coordinate. Errors: none has the name.
  pure subroutine seek_coordinate(diagnostics, all_names, word, number)
    type(diagnostics_t), intent(inout) :: diagnostics        !! errors are added
    type(named_coordinate_t), intent(in) :: all_names(:)     !! of the deck
    type(token_t), intent(in) :: word                        !! the name, in the deck
    integer, intent(out) :: number                           !! in the list; 0: unknown

    type(string_t) :: names(size(all_names))
    character(len=:), allocatable :: ways
    integer :: i

    number = coordinate_number(all_names, word%text)
    if (number > 0) return
    ways = ""
    do i = 1, size(names)
      names(i)%text = all_names(i)%name
      if (index(lower_case(names(i)%text), lower_case(word%text)//":") == 1) ways = ways// &
        " or '"//names(i)%text//"'"
    end do
    if (len(ways) > 0) then
      call add_error(diagnostics, word, "pin '"//word%text//"' slides in several ways; "// &
        "expected the name of one, "//ways(len(" or ") + 1:))
      return
    end if
    call add_error(diagnostics, word, "unknown coordinate '"//word%text//"'"// &
      suggestion(word%text, names)//"; expected the name of a MEASURE, a SPRING or a DAMPER, "// &
      "of a link whose length is driven, or of a pin that slides")
  end subroutine seek_coordinate

  !> Refuses a name that two coordinates have.
  pure subroutine refuse_two(diagnostics, named, word, first)
    type(diagnostics_t), intent(inout) :: diagnostics    !! an error is added
    type(named_coordinate_t), intent(in) :: named(:)     !! of the deck
    type(token_t), intent(in) :: word                    !! the name, in the deck
    integer, intent(in) :: first                         !! number of the first that has it

    integer :: i

    do i = first + 1, size(named)
      if (.not. same_word(named(i)%name, word%text)) cycle
      call add_error(diagnostics, word, "'"//word%text//"' is the name of two coordinates; "// &
        "give one another name", named(i)%word, "one is here")
      return
    end do
  end subroutine refuse_two

end module measure_checks
