!> Checks of the elastic response: the links that DAMPING and GAUGE cards name, and what a steady
!! state needs.
module response_checks
  use body_checks, only: seek_link
  use card_reader, only: has_value, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use errors, only: error_of_writing
  use kinds, only: wp
  use models, only: has_gauge_histories, has_law, inertia_lumped, model_t, needs_response, &
    report_in_motion, report_number, report_with
  use name_checks, only: link_ends
  use name_index, only: name_index_t, new_name_index
  use text, only: same_word
  use tokens, only: token_t, token_texts
  use transient_cards, only: transient_card_t
  use units, only: dimension_name, dimension_none, dimension_time
  use value_words, only: in_words
  implicit none (type, external)
  private

  public :: find_dampings, find_gauges, check_response

contains

  !> Gives every bending link its damping: a card that names the link takes precedence over
  !! `DAMPING *`. Errors: an unknown link, a rigid one, two dampings for a link.
  pure subroutine find_dampings(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! damping numbers of its links are set

    type(name_index_t) :: links, pins
    type(token_t) :: place(0:size(model%links))
    integer :: i, k, link, for_all

    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(link_ends(model%links)))
    for_all = 0
    do i = 1, size(model%dampings)
      do k = 1, size(model%dampings(i)%link_names)
        associate (word => model%dampings(i)%link_names(k))
          link = 0
          if (word%text /= "*") call seek_link(word, links, pins, diagnostics, link)
          if (word%text /= "*" .and. link == 0) cycle
          if (place(link)%line > 0) then
            call add_error(diagnostics, word, "a second damping for '"//word%text//"'", &
              place(link), "the first is here")
            cycle
          end if
          place(link) = word
          if (link == 0) then
            for_all = i
          else if (model%links(link)%rigid) then
            call add_error(diagnostics, word, "link '"//word%text// &
              "' is rigid: it has no damping", model%links(link)%rigid_word, &
              "it is rigid by this word")
          else
            model%links(link)%damping = i
          end if
        end associate
      end do
    end do
    where (model%links%damping == 0 .and. .not. model%links%rigid) model%links%damping = for_all
  end subroutine find_dampings

  !> Looks up the links of GAUGE cards. Errors: an unknown link, a rigid one, a place beyond its
  !! ends.
  pure subroutine find_gauges(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! link numbers of its gauges are set

    type(name_index_t) :: links, pins
    integer :: i

    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(link_ends(model%links)))
    do i = 1, size(model%gauges)
      associate (gauge => model%gauges(i))
        call seek_link(gauge%link_name, links, pins, diagnostics, gauge%link)
        if (gauge%link == 0) cycle
        associate (link => model%links(gauge%link))
          if (link%rigid) then
            call add_error(diagnostics, gauge%link_name, "link '"//link%name%text// &
              "' is rigid: there is no strain in it", link%rigid_word, "it is rigid by this word")
          else if (link%length > 0.0_wp .and. &
            (gauge%at < 0.0_wp .or. gauge%at > link%length)) then
            call add_error(diagnostics, gauge%at_word, "a gauge beyond the end of link '"// &
              link%name%text//"'; expected 'at=' from 0 to its length", link%length_word, &
              "its length is given here")
          end if
        end associate
      end associate
    end do
  end subroutine find_gauges

  !> Checks what reports on the elastic response need. Errors: no speed, a speed of 0, an
  !! acceleration of the crank; a section without depth where strains are asked for. Warnings: cards
  !! that no report uses, lumped inertia and elements, which the response does not have.
  subroutine check_response(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(in) :: model                !! as far as its cards could be read

    call warn_of_idle_cards(diagnostics, model)
    call check_ramp(diagnostics, model)
    if (.not. needs_response(model)) return
    call check_speeds(diagnostics, model)
    call refuse_acceleration(cards, diagnostics, model)
    call check_depths(diagnostics, model)
    call check_transient(diagnostics, model)
    call check_range("campbell", diagnostics, model)
    call check_range("intervals", diagnostics, model)
    call warn_of_other_models(diagnostics, model)
  end subroutine check_response

  !> Cards that serve reports which are not requested.
  pure subroutine warn_of_idle_cards(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    character(len=*), parameter :: idle = " is used by REPORT response, strains, peaks, "// &
      "drive, validity, stability, intervals, campbell and transient only, none of which is "// &
      "asked for"
    integer :: i

    ! A report may be meant.
    if (has_errors(diagnostics)) return
    if (report_with(model, "strains") == 0 .and. report_number(model, "transient") == 0) then
      do i = 1, size(model%gauges)
        if (model%gauges(i)%name%line == 0) cycle
        call add_warning(diagnostics, model%gauges(i)%name, &
          "GAUGE is used by REPORT strains and transient only, neither of which is asked for")
      end do
    end if
    if (needs_response(model)) return
    do i = 1, size(model%dampings)
      call add_warning(diagnostics, model%dampings(i)%keyword, "DAMPING"//idle)
    end do
    if (model%without%keyword%line > 0) call add_warning(diagnostics, model%without%keyword, &
      "EFFECTS response"//idle)
  end subroutine warn_of_idle_cards

  !> The steady state is that of a crank that turns.
  pure subroutine check_speeds(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    character(len=:), allocatable :: why
    integer :: zero

    why = ": the linkage stands still, and "//report_in_motion(model)//" needs a turning crank"
    associate (speed => model%speed)
      if (size(speed%words) == 0) return
      zero = findloc(abs(speed%value) <= 0.0_wp, .true., dim=1)
      if (zero == 0) return
      if (count(speed%word == speed%word(zero)) > 1) then
        call add_error(diagnostics, speed%words(speed%word(zero)), "speed 0 in this range"//why)
      else
        call add_error(diagnostics, speed%words(speed%word(zero)), "speed 0"//why)
      end if
    end associate
  end subroutine check_speeds

  !> No steady state with an accelerating crank.
  pure subroutine refuse_acceleration(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    if (abs(model%acceleration) <= 0.0_wp) return
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "SPEED")) cycle
      if (.not. has_value(cards(i), "alpha")) cycle
      call add_error(diagnostics, value_of(cards(i), "alpha"), report_in_motion(model)// &
        " is on a steady state, and an accelerating crank has none; expected no 'alpha=', or "// &
        "alpha=0")
    end do
  end subroutine refuse_acceleration

  !> `ramp=` serves motions in time; all other reports are at the speeds themselves.
  pure subroutine check_ramp(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    if (model%ramp <= 0.0_wp .or. report_number(model, "transient") > 0 .or. &
      has_errors(diagnostics)) return
    call add_warning(diagnostics, model%ramp_word, &
      "'ramp=' is used by REPORT transient only, which is not asked for")
  end subroutine check_ramp

  !> Motions in time. Errors: a start from the steady state with a ramp; terms of the equation left
  !! out that its momenta need.
  pure subroutine check_transient(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: number

    number = report_number(model, "transient")
    if (number == 0) return
    associate (asked => model%reports(number)%transient, without => model%without)
      if (has_law(model)) then
        call check_instants(asked, diagnostics, model)
      else if (asked%lacks_turns) then
        call add_error(diagnostics, model%reports(number)%keyword, "'turns=' is missing; "// &
          "expected "//dimension_name(dimension_none), kind=error_of_writing)
      end if
      if (asked%steady .and. model%ramp > 0.0_wp) call add_error(diagnostics, asked%start_word, &
        "the steady state is that of a speed, and the crank starts at rest; expected start=rest", &
        model%ramp_word, "by this ramp")
      if (without%coriolis .or. without%centripetal .or. without%tangential) call &
        add_error(diagnostics, without%keyword, "REPORT transient has all terms of inertia; "// &
        "expected 'without=axial' or no EFFECTS response", model%reports(number)%keyword, &
        "asked for here")
    end associate
  end subroutine check_transient

  !> Motions in time by a law, whose rows are at the instants of TIME. Errors: keys about motions at
  !! a speed; instants that do not rise, or a single one.
  pure subroutine check_instants(asked, diagnostics, model)
    type(transient_card_t), intent(in) :: asked
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    call refuse_key(asked%turns_word, "turns", "it ends at the last instant of TIME", model, &
      diagnostics)
    call refuse_key(asked%crank_word, "crank", "it starts where the law is at the first "// &
      "instant of TIME", model, diagnostics)
    call refuse_key(asked%instants_word, "instants", "its rows are at the instants of TIME", &
      model, diagnostics)
    if (asked%steady) call add_error(diagnostics, asked%start_word, &
      "the steady state is that of a speed; expected start=rest", model%drives(1)%law, &
      "the crank moves by this law")
    associate (time => model%time)
      if (size(time%value) == 1) call add_error(diagnostics, time%words(time%word(1)), &
        "a motion in time goes from the first instant to the last, and there is one only")
      do i = 2, size(time%value)
        if (time%value(i) > time%value(i - 1)) cycle
        call add_error(diagnostics, time%words(time%word(i)), "a motion in time goes from "// &
          "instant to instant, and this one, "//in_words(time%value(i), dimension_time, &
          model%units, 10)//", does not come after the one before, "// &
          in_words(time%value(i - 1), dimension_time, model%units, 10))
        return
      end do
    end associate
  end subroutine check_instants

  !> Errors: a key that has no meaning beside a law is given.
  pure subroutine refuse_key(word, key, reason, model, diagnostics)
    type(token_t), intent(in) :: word !! of the key; without a line if it is not given
    character(len=*), intent(in) :: key, reason
    type(model_t), intent(in) :: model
    type(diagnostics_t), intent(inout) :: diagnostics

    if (word%line > 0) call add_error(diagnostics, word, "'"//key//"=' has no meaning beside a "// &
      "law: the motion is that of the law, and "//reason, model%drives(1)%law, &
      "its law is given here")
  end subroutine refuse_key

  !> A report on all speeds between those of the deck. Errors: a single speed; speeds of both signs.
  pure subroutine check_range(name, diagnostics, model)
    character(len=*), intent(in) :: name !! of the report
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: number

    number = report_number(model, name)
    if (number == 0 .or. size(model%speed%words) == 0) return
    associate (speed => model%speed, report => model%reports(number)%keyword)
      if (maxval(speed%value) > 0.0_wp .and. minval(speed%value) < 0.0_wp) then
        call add_error(diagnostics, speed%words(speed%word(findloc(speed%value < 0.0_wp, .true., &
          dim=1))), "a speed of the other sense: REPORT "//name//" needs speeds of one sign", &
          report, "asked for here")
      else if (.not. maxval(speed%value) > minval(speed%value)) then
        call add_error(diagnostics, report, "REPORT "//name//" needs a range of speeds; "// &
          "expected 'SPEED 20 to 60 step 1', for example", speed%words(1), &
          "there is one only")
      end if
    end associate
  end subroutine check_range

  !> Strains and stresses of bending are those of the faces, whose distance a general section need
  !! not give.
  pure subroutine check_depths(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    logical :: has_strains(size(model%links))
    integer :: i, report

    report = report_number(model, "peaks")
    has_strains = .not. model%links%rigid .and. report > 0
    if (report == 0) report = report_with(model, "strains")
    if (report == 0 .and. has_gauge_histories(model)) report = report_number(model, "transient")
    if (report == 0) return
    if (size(model%gauges) == 0) has_strains = .not. model%links%rigid
    do i = 1, size(model%gauges)
      if (model%gauges(i)%link > 0) has_strains(model%gauges(i)%link) = .true.
    end do
    do i = 1, size(model%sections)
      associate (section => model%sections(i))
        if (section%area <= 0.0_wp .or. section%depth > 0.0_wp) cycle
        if (.not. any(model%links%section == i .and. has_strains)) cycle
        call add_error(diagnostics, section%name, "section '"//section%name%text// &
          "' has no depth, and strains of bending need it; expected 'depth='", &
          model%reports(report)%keyword, "this report has strains")
      end associate
    end do
  end subroutine check_depths

  !> The response is that of continuous links with their mass along them, whatever frequencies and
  !! rigid-body loads of the same deck are computed with.
  pure subroutine warn_of_other_models(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    if (model%inertia == inertia_lumped) call add_warning(diagnostics, model%inertia_word, &
      "INERTIA lumped does not apply to "//report_in_motion(model)// &
      ": the inertia of its links is distributed")
    do i = 1, size(model%meshes)
      if (model%meshes(i)%keyword%line == 0 .or. model%meshes(i)%elements == 0) cycle
      if (model%meshes(i)%accuracy > 0.0_wp) cycle
      call add_warning(diagnostics, model%meshes(i)%keyword, "'elements=' does not apply to "// &
        report_in_motion(model)//": its links are continuous, and REPORT ... accuracy= is its "// &
        "accuracy")
      return
    end do
  end subroutine warn_of_other_models

end module response_checks
