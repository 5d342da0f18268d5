!> Checks of DRIVE and BRANCH cards: the links, pins and guides that they name.
module drive_checks
  use body_checks, only: seek_link
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use drive_cards, only: branch_forward, branch_t, drive_angle, drive_card_t, &
    drive_measured_angle, drive_measured_length, drive_ram, drive_relative, drive_slider
  use joint_checks, only: seek_pin
  use kinds, only: wp
  use measure_cards, only: measure_along, measure_angle, measure_card_t
  use models, only: model_t
  use name_checks, only: kind_of_unknown, pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use spelling, only: suggestion
  use text, only: same_word, string_t
  use tokens, only: token_texts
  implicit none (type, external)
  private

  public :: check_drives

contains

  !> Looks up what these cards name. Errors: an unknown link, pin or guide, the angle of a link
  !! without a ground pivot or with several, a link against itself, a pin that does not slide there,
  !! the length of a link with more than two pins, one thing driven twice, a clamped link
  !! driven; a branch of a fixed pin, the side of a way from a pin to itself, forward or backward of
  !! a pin that does not slide.
  pure subroutine check_drives(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! numbers of links and sliders are set

    type(name_index_t) :: links, pins, grounds, measures
    type(drive_card_t) :: drive
    integer :: i

    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    measures = new_name_index(token_texts(model%measures%name))
    do i = 1, size(model%drives)
      drive = model%drives(i)
      select case (drive%kind)
      case (drive_slider)
        call find_driven_slider(diagnostics, model, links, pins, drive)
      case (drive_angle, drive_relative, drive_ram)
        call find_driven_link(diagnostics, model, links, pins, grounds, measures, drive)
      case (drive_measured_length, drive_measured_angle)
        call find_driven_measure(diagnostics, model, measures, drive)
      end select
      model%drives(i) = drive
    end do
    call refuse_same_drives(diagnostics, model)
    call refuse_clamped(diagnostics, model)
    do i = 1, size(model%branches)
      call check_branch(diagnostics, model, links, pins, grounds, model%branches(i))
    end do
  end subroutine check_drives

  !> A clamped link does not turn, and no drive turns it.
  pure subroutine refuse_clamped(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, k

    do i = 1, size(model%drives)
      if (model%drives(i)%kind /= drive_angle .or. model%drives(i)%link == 0) cycle
      do k = 1, size(model%clamps)
        if (.not. allocated(model%clamps(k)%link)) cycle
        if (.not. any(model%clamps(k)%link == model%drives(i)%link)) cycle
        call add_error(diagnostics, model%clamps(k)%pin, "link '"// &
          model%links(model%drives(i)%link)%name%text//"' is clamped, and does not turn; "// &
          "expected the names of other links on this card, or no DRIVE of it", &
          model%drives(i)%subject, "it is driven here")
        exit
      end do
    end do
  end subroutine refuse_clamped

  !> Looks up the links of a drive.
  pure subroutine find_driven_link(diagnostics, model, links, pins, grounds, measures, drive)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds, measures
    type(drive_card_t), intent(inout) :: drive

    integer :: i, grounded

    associate (name => drive%subject%text)
      if (drive%kind == drive_angle .and. find_name(links, name) == 0 .and. find_name(pins, &
        name) == 0 .and. size(measures%name) > 0) then
        call add_error(diagnostics, drive%subject, "unknown link or measure '"//name//"'"// &
          suggestion(name, [links%name, measures%name]), kind=kind_of_unknown(name))
        return
      end if
    end associate
    call seek_link(drive%subject, links, pins, diagnostics, drive%link)
    if (drive%kind == drive_relative) then
      call seek_link(drive%against, links, pins, diagnostics, drive%against_link)
      if (drive%link > 0 .and. drive%link == drive%against_link) call add_error(diagnostics, &
        drive%against, "link '"//drive%against%text//"' cannot be driven against itself")
    end if
    if (drive%link == 0) return
    associate (link => model%links(drive%link))
      if (size(link%pins) == 0) return
      if (drive%kind == drive_ram .and. size(link%pins) > 2) then
        call add_error(diagnostics, drive%subject, "the length of link '"//link%name%text// &
          "' cannot be driven: it has more than two pins", link%name, "the link is here")
      else if (drive%kind == drive_angle .and. .not. has_errors(diagnostics)) then
        ! After errors about pins this may be their consequence.
        grounded = 0
        do i = 1, size(link%pins)
          if (find_name(grounds, link%pins(i)%text) > 0) grounded = grounded + 1
        end do
        if (grounded == 0) call add_error(diagnostics, drive%subject, "the driven link '"// &
          drive%subject%text//"' turns about no ground pivot; drive it against a link that "// &
          "does, or a MEASURE of its angle")
        if (grounded > 1) call add_error(diagnostics, drive%subject, "the driven link '"// &
          drive%subject%text//"' joins the two ground pivots")
      end if
    end associate
  end subroutine find_driven_link

  !> Looks up the measure of a drive.
  pure subroutine find_driven_measure(diagnostics, model, measures, drive)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: measures
    type(drive_card_t), intent(inout) :: drive

    drive%measure = find_name(measures, drive%subject%text)
    ! Of a card that cannot be read.
    if (drive%measure == 0) return
    associate (measure => model%measures(drive%measure))
      if (drive%kind == drive_measured_angle .and. any(abs(measure%weights - &
        anint(measure%weights)) > 0.0_wp)) call add_error(diagnostics, drive%subject, "the "// &
        "weights of angles in a sum that is driven are whole numbers: others lose turns", &
        measure%name, "the sum is here")
      if (cancels(measure)) call add_error(diagnostics, drive%subject, "'"//measure%name%text// &
        "' cannot be driven: its terms cancel each other, and it is always 0", measure%name, &
        "the sum is here")
    end associate
  end subroutine find_driven_measure

  !> Whether the weights of every term of a sum add up to nothing.
  pure function cancels(measure)
    type(measure_card_t), intent(in) :: measure
    logical :: cancels

    real(wp), parameter :: rounding = 1.0e-15_wp
    real(wp) :: total
    integer :: i, k

    cancels = size(measure%terms) > 0
    do i = 1, size(measure%terms)
      total = 0.0_wp
      do k = 1, size(measure%terms)
        if (same_word(measure%terms(k)%text, measure%terms(i)%text)) total = total + &
          measure%weights(k)
      end do
      cancels = cancels .and. .not. abs(total) > rounding*sum(abs(measure%weights))
    end do
  end function cancels

  !> Looks up the slider of a drive.
  pure subroutine find_driven_slider(diagnostics, model, links, pins, drive)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins
    type(drive_card_t), intent(inout) :: drive

    integer :: i
    logical :: known, known_way

    if (find_name(links, drive%subject%text) > 0 .and. find_name(pins, drive%subject%text) == 0) &
      then
      call add_error(diagnostics, drive%subject, "'"//drive%subject%text//"' is a link; "// &
        "expected: DRIVE link against link, DRIVE link length, DRIVE pin guide, or the name of "// &
        "a MEASURE alone")
      return
    end if
    call seek_pin(drive%subject, pins, links, diagnostics, known)
    known_way = .false.
    do i = 1, size(model%sliders)
      known_way = known_way .or. same_word(model%sliders(i)%on%text, drive%against%text)
      if (.not. same_word(model%sliders(i)%pin%text, drive%subject%text)) cycle
      if (same_word(model%sliders(i)%on%text, drive%against%text)) drive%slider = i
    end do
    if (drive%slider > 0 .or. .not. known) return
    do i = 1, size(model%guides)
      known_way = known_way .or. same_word(model%guides(i)%name%text, drive%against%text)
    end do
    if (known_way) then
      call add_error(diagnostics, drive%against, "no SLIDER card lets pin '"// &
        drive%subject%text//"' slide along '"//drive%against%text//"'")
    else
      call add_error(diagnostics, drive%against, "unknown guide '"//drive%against%text//"'"// &
        suggestion(drive%against%text, words_in_place_of_guides(model)))
    end if
  end subroutine find_driven_slider

  !> What may follow the first word of a DRIVE card: guides, links with blocks on them, other words.
  pure function words_in_place_of_guides(model) result(words)
    type(model_t), intent(in) :: model
    type(string_t), allocatable :: words(:)

    integer :: i, guides

    guides = size(model%guides)
    allocate (words(guides + size(model%sliders) + 3))
    do i = 1, guides
      words(i)%text = model%guides(i)%name%text
    end do
    do i = 1, size(model%sliders)
      words(guides + i)%text = model%sliders(i)%on%text
    end do
    words(size(words) - 2)%text = "against"
    words(size(words) - 1)%text = "free"
    words(size(words))%text = "length"
  end function words_in_place_of_guides

  !> One thing has one drive.
  pure subroutine refuse_same_drives(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer, parameter :: most_compared = 100
    integer :: i, k

    do i = 2, size(model%drives)
      if (model%drives(i)%kind == 0) cycle
      do k = 1, min(i - 1, most_compared)
        if (.not. are_same(model, model%drives(i), model%drives(k))) cycle
        call add_error(diagnostics, model%drives(i)%subject, "'"// &
          model%drives(i)%subject%text//"' is driven twice", model%drives(k)%subject, &
          "first driven here")
        exit
      end do
    end do
  end subroutine refuse_same_drives

  !> Whether two drives are of the same angle, whichever link comes first, the same slider, the same
  !! length or the same measure; a measure may be of one of these.
  pure function are_same(model, a, b) result(same)
    type(model_t), intent(in) :: model
    type(drive_card_t), intent(in) :: a, b
    logical :: same

    type(string_t) :: driven(2), other(2)
    integer :: kind, other_kind

    call find_subject(model, a, kind, driven)
    call find_subject(model, b, other_kind, other)
    same = kind == other_kind .and. (same_word(driven(1)%text, other(1)%text) .and. &
      same_word(driven(2)%text, other(2)%text) .or. kind == drive_angle .and. &
      same_word(driven(1)%text, other(2)%text) .and. same_word(driven(2)%text, other(1)%text))
  end function are_same

  !> What is driven: an angle of a link or between two, a pin on its line, the length of a link, or
  !! else a measure.
  pure subroutine find_subject(model, drive, kind, names)
    type(model_t), intent(in) :: model
    type(drive_card_t), intent(in) :: drive
    integer, intent(out) :: kind           !! a drive_… constant, `drive_angle` of any angle
    type(string_t), intent(out) :: names(2)

    kind = drive%kind
    names(1)%text = drive%subject%text
    names(2)%text = drive%against%text
    if (kind == drive_relative) kind = drive_angle
    if (drive%measure == 0) return
    associate (measure => model%measures(drive%measure))
      if (measure%kind == measure_angle) then
        kind = drive_angle
        names(1)%text = measure%links(1)%text
        names(2)%text = measure%links(2)%text
      else if (measure%kind == measure_along) then
        kind = drive_slider
        names(1)%text = measure%places(1)%text
        names(2)%text = measure%line%text
      end if
    end associate
  end subroutine find_subject

  !> Checks the pins of a BRANCH card.
  pure subroutine check_branch(diagnostics, model, links, pins, grounds, branch)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds
    type(branch_t), intent(in) :: branch

    integer :: ground
    logical :: known(3)

    ground = find_name(grounds, branch%pin%text)
    if (ground > 0) then
      call add_error(diagnostics, branch%pin, "'"//branch%pin%text//"' is fixed and has no "// &
        "branch", model%grounds(ground)%pin, "it is fixed here")
      return
    end if
    call seek_pin(branch%pin, pins, links, diagnostics, known(1))
    if (branch%which >= branch_forward) then
      if (.not. known(1) .or. slides(model, branch%pin%text)) return
      call add_error(diagnostics, branch%pin, "pin '"//branch%pin%text//"' has no SLIDER: "// &
        branch%word%text//" of which guide?")
      return
    end if
    known(2) = find_name(grounds, branch%from%text) > 0
    known(3) = find_name(grounds, branch%to%text) > 0
    if (.not. known(2)) call seek_pin(branch%from, pins, links, diagnostics, known(2))
    if (.not. known(3)) call seek_pin(branch%to, pins, links, diagnostics, known(3))
    if (.not. all(known)) return
    if (same_word(branch%from%text, branch%to%text)) then
      call add_error(diagnostics, branch%to, "the way from a pin to itself has no side")
    else if (same_word(branch%pin%text, branch%from%text) .or. same_word(branch%pin%text, &
      branch%to%text)) then
      call add_error(diagnostics, branch%pin, "pin '"//branch%pin%text// &
        "' is an end of the way on whose side it is to be")
    end if
  end subroutine check_branch

  !> Whether a pin has a SLIDER card.
  pure function slides(model, name) result(does)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: name
    logical :: does

    integer :: i

    does = .true.
    do i = 1, size(model%sliders)
      if (same_word(model%sliders(i)%pin%text, name)) return
    end do
    does = .false.
  end function slides

end module drive_checks
