!> Laws of drives: found from LAW cards, and the positions, speeds and accelerations of the first
!! drive at the instants of TIME.
module law_checks
  use card_table, only: pattern_of
  use cards, only: card_t
  use constants, only: degree
  use cubic_splines, only: ends_at_rest, ends_not_a_knot, ends_periodic, new_cubic_spline
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use expressions, only: place_in
  use kinds, only: wp
  use law_cards, only: law_card_t, table_free, table_periodic, table_rest
  use models, only: drives_length, model_t, runs_in_time
  use motion_laws, only: law_ramp, motion_segment_t
  use motion_programs, only: motion_program_t, program_values
  use natures, only: are_alike, nature_t
  use report_cards, only: report_t
  use report_kinds, only: report_kind_t
  use sorting, only: ascending_order
  use spelling, only: suggestion
  use table_cards, only: number_table_t, read_table
  use text, only: same_word, string_t, to_string
  use time_formulas, only: find_trouble
  use tokens, only: token_t
  use units, only: dimension_time
  use value_words, only: in_words
  implicit none (type, external)
  private

  public :: find_laws, refuse_reports_of_law

  !> Instants that are nearer to each other, relative to a segment, are one; and so with positions
  !! relative to themselves: what is left by conversions of units.
  real(wp), parameter :: rounding = 1.0e-12_wp

  !> Rates at both ends of a period that differ by no more than this share of the greatest are one.
  real(wp), parameter :: least_jump = 1.0e-9_wp

  !> Why reports do not serve several laws.
  character(len=*), parameter :: of_first = "is about the way of the first drive alone, and "// &
    "here several drives have laws; "

contains

  !> Puts the motion of drives by their laws into a model: positions of the first one in place of
  !! those of CRANK, its speed and acceleration at every instant of TIME. Where further drives have
  !! laws, instants take the place of positions.
  !!
  !! Errors: TIME without a law; CRANK and SPEED beside one, and VARY time; a law without cards;
  !! segments that overlap, a first one that does not say where it begins, later ones that begin
  !! elsewhere than the one before ends; a table or a formula beside another card; a table with less
  !! than two rows, with an instant beyond its ends; a formula that is not smooth. Of laws of
  !! further drives: the first one has none; one law of an angle and a length; a rule for change
  !! points.
  !! Warnings: a law that no DRIVE uses, a ramp or a period that begins or ends with a jump of the
  !! velocity.
  subroutine find_laws(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(inout) :: model             !! with its cards read

    type(token_t) :: word
    logical :: fine
    integer :: i

    call warn_of_idle_laws(diagnostics, model)
    if (.not. any(model%drives%law%line > 0)) then
      call refuse_cards(cards, ["TIME "], "TIME is for a drive with a law, which no DRIVE has "// &
        "(DRIVE ... law=)", diagnostics)
      return
    end if
    allocate (model%law_rates(2, 0))
    word = model%drives(1)%law
    if (word%line == 0) then
      word = model%drives(findloc(model%drives%law%line > 0, .true., dim=1))%law
      call add_error(diagnostics, word, "a law of a further drive needs one of the first, "// &
        "which has its positions from CRANK; expected 'law=' on the first DRIVE, or 'ratio=' "// &
        "or 'at=' here", model%drives(1)%keyword, "the first is here")
      return
    end if
    call refuse_cards(cards, ["CRANK", "SPEED"], &
      "the rows of tables are those of the instants of TIME", diagnostics, word)
    call refuse_time_as_name(cards, diagnostics)
    if (runs_in_time(model)) then
      call refuse_rule_of_change_points(diagnostics, model)
      call refuse_laws_of_both(diagnostics, model)
      allocate (model%programs(size(model%drives)))
    end if
    fine = .true.
    do i = 1, size(model%drives)
      if (model%drives(i)%law%line > 0) call find_law(cards, i, diagnostics, model, fine)
    end do
    if (fine) call put_motion(model)
  end subroutine find_laws

  !> The law of a drive.
  subroutine find_law(cards, number, diagnostics, model, fine)
    type(card_t), intent(in) :: cards(:)
    integer, intent(in) :: number !! of the drive, which has one
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model
    logical, intent(inout) :: fine !! all laws so far are known

    type(law_card_t), allocatable :: own_cards(:)
    type(motion_program_t) :: program
    type(diagnostics_t) :: told
    logical :: is_known, alone
    integer :: i

    associate (word => model%drives(number)%law)
      call find_own_cards(model, word, own_cards)
      if (size(own_cards) == 0) then
        fine = .false.
        if (.not. has_errors(diagnostics)) call add_error(diagnostics, word, "there is no law '"// &
          word%text//"'"//suggestion(word%text, law_names(model))//"; expected: "// &
          pattern_of("LAW"))
        return
      end if
      ! What is wrong with a law is told once.
      is_known = .false.
      do i = 1, number - 1
        is_known = is_known .or. same_word(model%drives(i)%law%text, word%text)
      end do
    end associate
    if (is_known) then
      call read_law_cards(cards, own_cards, number, told, model, program, alone)
    else
      call read_law_cards(cards, own_cards, number, diagnostics, model, program, alone)
    end if
    fine = fine .and. alone
    if (.not. alone) return
    if (number == 1) model%program = program
    if (allocated(model%programs)) model%programs(number) = program
  end subroutine find_law

  !> The program of the cards of a law.
  subroutine read_law_cards(cards, own_cards, number, diagnostics, model, program, fine)
    type(card_t), intent(in) :: cards(:)
    type(law_card_t), intent(in) :: own_cards(:) !! in the order of their starts
    integer, intent(in) :: number                !! of the drive
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(motion_program_t), intent(out) :: program
    logical, intent(out) :: fine

    call refuse_tables_beside(own_cards, diagnostics, fine)
    if (.not. fine) return
    if (own_cards(1)%table_word%line > 0) then
      call take_table(cards, own_cards(1), model%drives(number)%nature, diagnostics, model, &
        program, fine)
    else if (allocated(own_cards(1)%formula_words)) then
      call take_formula(own_cards(1), model, diagnostics, program, fine)
    else
      call take_segments(own_cards, diagnostics, program, fine)
    end if
  end subroutine read_law_cards

  !> Errors: a law is that of an angle and of a length.
  pure subroutine refuse_laws_of_both(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(nature_t) :: nature
    integer :: i, k

    do i = 2, size(model%drives)
      if (model%drives(i)%law%line == 0) cycle
      do k = 1, i - 1
        if (.not. same_word(model%drives(k)%law%text, model%drives(i)%law%text)) cycle
        if (are_alike(model%drives([i, k])%nature)) cycle
        nature = model%drives(k)%nature
        call add_error(diagnostics, model%drives(i)%law, "the law '"//model%drives(i)%law%text// &
          "' is one of "//trim(nature%noun)//"s already; expected another law", &
          model%drives(k)%law, "it is that of '"//model%drives(k)%subject%text//"' here")
        exit
      end do
    end do
  end subroutine refuse_laws_of_both

  !> Errors: a rule for change points beside laws of several drives.
  pure subroutine refuse_rule_of_change_points(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: second

    if (model%drives(1)%change_points == 0 .or. model%drives(1)%change_points == 3) return
    second = 1 + findloc(model%drives(2:)%law%line > 0, .true., dim=1)
    call add_error(diagnostics, model%drives(1)%change_points_word, "links keep their sides "// &
      "where several drives have laws; expected no 'change_points='", model%drives(second)%law, &
      "the law of another drive is here")
  end subroutine refuse_rule_of_change_points

  !> Errors: cards that do not go with the motion of the first drive.
  pure subroutine refuse_cards(cards, keywords, message, diagnostics, law)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: keywords(:)
    character(len=*), intent(in) :: message
    type(diagnostics_t), intent(inout) :: diagnostics
    type(token_t), intent(in), optional :: law !! word of the DRIVE card

    integer :: i, k

    do i = 1, size(cards)
      do k = 1, size(keywords)
        if (.not. same_word(cards(i)%keyword%text, trim(keywords(k)))) cycle
        if (present(law)) then
          call add_error(diagnostics, cards(i)%keyword, trim(keywords(k))// &
            " has no meaning beside a law: "//message, law, "its law is given here")
        else
          call add_error(diagnostics, cards(i)%keyword, message)
        end if
      end do
    end do
  end subroutine refuse_cards

  !> Errors: a VARY has the name of the first column of tables of a law.
  pure subroutine refuse_time_as_name(cards, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "VARY") .or. size(cards(i)%words) == 0) cycle
      if (cards(i)%words(1)%text == "time") call add_error(diagnostics, cards(i)%words(1), &
        "'time' is a column of the tables of a law; choose another name, since a VARY becomes "// &
        "a column too")
    end do
  end subroutine refuse_time_as_name

  !> The LAW cards of a name, segments in the order of their starts.
  pure subroutine find_own_cards(model, word, own_cards)
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: word
    type(law_card_t), allocatable, intent(out) :: own_cards(:)

    integer, allocatable :: order(:)
    integer :: i, count

    allocate (order(size(model%laws)))
    count = 0
    do i = 1, size(model%laws)
      if (.not. same_word(model%laws(i)%name%text, word%text)) cycle
      count = count + 1
      order(count) = i
    end do
    order = order(:count)
    if (count > 0) order = order(ascending_order(model%laws(order)%start))
    allocate (own_cards(count))
    do i = 1, count
      own_cards(i) = model%laws(order(i))
    end do
  end subroutine find_own_cards

  !> The names of all laws, each once.
  pure function law_names(model) result(names)
    type(model_t), intent(in) :: model
    type(string_t), allocatable :: names(:)

    integer :: i

    allocate (names(size(model%laws)))
    do i = 1, size(names)
      names(i)%text = model%laws(i)%name%text
    end do
  end function law_names

  !> Warnings: a law is that of no drive; once for each.
  pure subroutine warn_of_idle_laws(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, k
    logical :: told

    do i = 1, size(model%laws)
      associate (name => model%laws(i)%name)
        if (name%line == 0) cycle
        told = .false.
        do k = 1, size(model%drives)
          told = told .or. same_word(model%drives(k)%law%text, name%text)
        end do
        do k = 1, i - 1
          told = told .or. same_word(model%laws(k)%name%text, name%text)
        end do
        if (.not. told) call add_warning(diagnostics, name, "no DRIVE moves by the law '"// &
          name%text//"'")
      end associate
    end do
  end subroutine warn_of_idle_laws

  !> Errors: a law has a table or a formula, and further cards.
  pure subroutine refuse_tables_beside(own_cards, diagnostics, fine)
    type(law_card_t), intent(in) :: own_cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(out) :: fine

    type(token_t) :: word
    integer :: i, other

    fine = size(own_cards) == 1
    if (fine) return
    do i = 1, size(own_cards)
      word = own_cards(i)%table_word
      if (allocated(own_cards(i)%formula_words)) word = own_cards(i)%formula_words(1)
      if (word%line == 0) cycle
      other = merge(2, 1, i == 1)
      call add_error(diagnostics, word, "a law is one table, one formula, or segments", &
        own_cards(other)%name, "another card of this law")
      return
    end do
    fine = .true.
  end subroutine refuse_tables_beside

  !> A law by a formula, which has to be smooth over its period, or over the instants of TIME.
  subroutine take_formula(card, model, diagnostics, program, fine)
    type(law_card_t), intent(in) :: card
    type(model_t), intent(in) :: model
    type(diagnostics_t), intent(inout) :: diagnostics
    type(motion_program_t), intent(inout) :: program
    logical, intent(out) :: fine

    integer, parameter :: samples = 64
    real(wp) :: range(2), time, ends(0:2, 2), motion(0:2), greatest
    integer :: step, i

    program%formula = card%formula
    program%formula%period = 0.0_wp
    range = [0.0_wp, card%formula%period]
    if (range(2) <= 0.0_wp .and. size(model%time%value) > 0) range = [minval(model%time%value), &
      maxval(model%time%value)]
    if (card%formula%period <= 0.0_wp) then
      ! Drawings may be asked for beyond.
      do i = 1, size(model%reports)
        associate (asked => model%reports(i)%crank%value)
          if (model%reports(i)%times_word%line > 0 .and. size(asked) > 0) range = [min(range(1), &
            minval(asked)), max(range(2), maxval(asked))]
        end associate
      end do
    end if
    call find_trouble(program%formula, range(1), range(2), step, time)
    fine = step == 0
    if (.not. fine) then
      associate (bytes => program%formula%steps(step)%place)
        call add_error(diagnostics, place_in(card%formula_words, max(bytes, 1)), &
          "this has no value, or no acceleration, near t = "//in_words(time, dimension_time, &
          model%units, 6)//": it divides by 0, has a root of 0 or less, or grows beyond 1e30")
      end associate
      return
    end if
    if (card%formula%period <= 0.0_wp) return
    do i = 1, 2
      ends(:, i) = program_values(program, range(i))
    end do
    greatest = 0.0_wp
    do i = 0, samples
      motion = program_values(program, range(2)*i/samples)
      greatest = max(greatest, abs(motion(1)))
    end do
    program%formula%period = card%formula%period
    program%formula%way = ends(0, 2) - ends(0, 1)
    if (abs(ends(1, 2) - ends(1, 1)) > least_jump*greatest) call add_warning( &
      diagnostics, card%formula_words(1), "the velocity jumps where a period of this formula "// &
      "ends: forces are infinite there, and tables do not have them")
  end subroutine take_formula

  !> A law of segments.
  pure subroutine take_segments(own_cards, diagnostics, program, fine)
    type(law_card_t), intent(in) :: own_cards(:) !! in the order of their starts
    type(diagnostics_t), intent(inout) :: diagnostics
    type(motion_program_t), intent(inout) :: program
    logical, intent(out) :: fine

    type(motion_segment_t) :: segments(size(own_cards))
    integer :: i, before

    fine = .true.
    do i = 1, size(own_cards)
      before = max(1, i - 1)
      associate (card => own_cards(i))
        segments(i) = motion_segment_t(card%law, card%start, card%stop, card%from, card%to)
        fine = fine .and. card%stop > card%start
        if (i == 1) then
          if (card%from_word%line == 0) call add_error(diagnostics, card%name, &
            "the first segment of a law needs 'from=', the position at which it begins")
          fine = fine .and. card%from_word%line > 0
          cycle
        end if
        if (card%start < segments(before)%stop - rounding*(card%stop - card%start)) then
          call add_error(diagnostics, card%start_word, "segments of a law follow each other, "// &
            "and this one starts before another one stops", own_cards(before)%stop_word, &
            "the other one stops here")
          fine = .false.
        end if
        if (card%from_word%line > 0 .and. abs(card%from - segments(before)%to) > &
          rounding*(abs(card%from) + abs(segments(before)%to))) then
          call add_error(diagnostics, card%from_word, &
            "a segment begins where the one before ends", own_cards(before)%to_word, &
            "that one ends here")
          fine = .false.
        end if
        segments(i)%from = segments(before)%to
      end associate
    end do
    if (.not. fine) return
    call warn_of_jumps(own_cards, segments, diagnostics)
    program%segments = segments
  end subroutine take_segments

  !> Warnings: the velocity of a ramp is not that of what is before it or behind it.
  pure subroutine warn_of_jumps(own_cards, segments, diagnostics)
    type(law_card_t), intent(in) :: own_cards(:)
    type(motion_segment_t), intent(in) :: segments(:) !! of the same numbers
    type(diagnostics_t), intent(inout) :: diagnostics

    real(wp) :: velocity, neighbour
    integer :: i, k
    logical :: jumps

    do i = 1, size(segments)
      velocity = velocity_of(segments(i))
      jumps = .false.
      do k = i - 1, i + 1, 2
        neighbour = 0.0_wp
        if (k >= 1 .and. k <= size(segments)) then
          if (abs(segments(max(i, k))%start - segments(min(i, k))%stop) <= rounding* &
            (segments(i)%stop - segments(i)%start)) neighbour = velocity_of(segments(k))
        end if
        jumps = jumps .or. abs(velocity - neighbour) > rounding*abs(velocity)
      end do
      if (segments(i)%law == law_ramp .and. jumps) call add_warning(diagnostics, &
        own_cards(i)%law_word, "the velocity jumps at the ends of this ramp: forces are "// &
        "infinite there, and tables do not have them")
    end do
  end subroutine warn_of_jumps

  !> Velocity at the ends of a segment: only ramps have any.
  pure function velocity_of(segment) result(velocity)
    type(motion_segment_t), intent(in) :: segment
    real(wp) :: velocity

    velocity = 0.0_wp
    if (segment%law == law_ramp) velocity = (segment%to - segment%from)/(segment%stop - &
      segment%start)
  end function velocity_of

  !> A law by a table of positions over time: a cubic spline. Of a periodic one the position may be
  !! farther on after every period, by as much as the last row differs from the first.
  pure subroutine take_table(cards, card, nature, diagnostics, model, program, fine)
    type(card_t), intent(in) :: cards(:)
    type(law_card_t), intent(in) :: card
    type(nature_t), intent(in) :: nature !! of its positions
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(motion_program_t), intent(inout) :: program
    logical, intent(out) :: fine

    integer, parameter :: ends(3) = [ends_not_a_knot, ends_at_rest, ends_periodic]
    type(number_table_t) :: table
    real(wp) :: slope, first, last
    integer :: dimensions(4, 2), i

    dimensions(:, 1) = dimension_time
    dimensions(:, 2) = nature%value
    call read_table(cards, card%table_word, "time and position", dimensions, diagnostics, table, &
      fine)
    if (.not. fine) return
    fine = .false.
    associate (rows => size(table%values, 2), time => model%time)
      if (rows < 2) then
        call add_error(diagnostics, card%table_word, &
          "a law needs two rows at least; this table has "//to_string(rows))
        return
      end if
      first = table%values(1, 1)
      last = table%values(1, rows)
      slope = 0.0_wp
      if (card%ends == table_periodic) slope = (table%values(2, rows) - table%values(2, 1))/ &
        (last - first)
      ! The last row of a periodic table without its slope is the first one, to the last digit.
      program%rate = slope
      program%rests = card%ends == table_rest
      program%spline = new_cubic_spline(table%values(1, :), [table%values(2, :rows - 1) - &
        slope*(table%values(1, :rows - 1) - first), merge(table%values(2, 1), &
        table%values(2, rows), card%ends == table_periodic)], ends(card%ends))
      do i = 1, size(time%value)
        associate (t => time%value(i))
          if (card%ends /= table_free .or. (t >= first .and. t <= last)) cycle
          call add_error(diagnostics, time%words(time%word(i)), "the table '"// &
            card%table_word%text//"' goes from "//in_words(first, dimension_time, model%units, &
            10)//" to "//in_words(last, dimension_time, model%units, 10)//", and this instant "// &
            "is "//in_words(t, dimension_time, model%units, 10)//"; 'ends=rest' stands still "// &
            "beyond, 'ends=periodic' repeats", card%table_word, "its table is given here")
          return
        end associate
      end do
    end associate
    fine = .true.
  end subroutine take_table

  !> Puts positions, speeds and accelerations of the first drive into a model; its positions have
  !! the places of their instants. In time instants are positions.
  pure subroutine put_motion(model)
    type(model_t), intent(inout) :: model !! with the law

    real(wp) :: motion(0:2, size(model%time%value)), scale
    integer :: i

    do i = 1, size(model%time%value)
      motion(:, i) = program_values(model%program, model%time%value(i))
    end do
    scale = degree
    if (drives_length(model)) scale = 1.0_wp
    if (runs_in_time(model)) then
      model%law_places = motion(0, :)
      motion(0, :) = model%time%value
    end if
    model%crank%value = motion(0, :)
    model%crank%written = motion(0, :)
    model%crank%word = model%time%word
    model%crank%words = model%time%words
    model%law_rates = scale*motion(1:, :)
  end subroutine put_motion

  !> Errors: a report that is about constant speed, or moves the first drive otherwise; one about
  !! the way of the first drive alone, where several have laws.
  pure subroutine refuse_reports_of_law(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with a law, and its reports chosen

    character(len=:), allocatable :: reason
    integer :: i, with_law

    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        reason = reason_against(model, report)
        if (len(reason) == 0) cycle
        ! What several laws leave to one alone is against the further ones.
        with_law = 1 + findloc(model%drives(2:)%law%line > 0, .true., dim=1)
        if (index(reason, of_first) == 0) with_law = 1
        call add_error(diagnostics, report%keyword, "REPORT "//trim(report%kind%name)//" "// &
          reason, model%drives(with_law)%law, "the law is given here")
        ! What it would need is not asked for.
        report%kind = report_kind_t()
      end associate
    end do
  end subroutine refuse_reports_of_law

  !> Why a report does not serve a law; empty if it does.
  pure function reason_against(model, report) result(reason)
    type(model_t), intent(in) :: model
    type(report_t), intent(in) :: report
    character(len=:), allocatable :: reason

    reason = ""
    if (runs_in_time(model)) then
      select case (trim(report%kind%name))
      case ("linkage", "equilibrium")
        reason = of_first//"expected them on DRIVE cards with 'ratio=' or 'at=', and CRANK"
      case ("geometry")
        if (report%times_word%line == 0) reason = "with 'crank=' "//of_first//"expected 'time='"
      case ("lagrange")
        reason = of_first//"REPORT drives has the torque of every drive"
      case ("balance")
        reason = of_first//"REPORT frame and drives have the shaking force"
      case ("transient")
        reason = of_first//"expected 'law=' on the first DRIVE alone"
      end select
      if (len(reason) > 0) return
      if (report%ratio_to%line > 0) reason = "with 'ratio_to=' "//of_first//"rates have no "// &
        "ratio that a position tells"
      if (len(reason) > 0) return
    end if
    if (report%kind%name == "transient") return
    if (report%kind%name == "sizing") then
      if (report%fluctuation > 0.0_wp) reason = "with 'fluctuation=' is about a crank at "// &
        "constant mean speed, not about one that moves by a law; expected no 'fluctuation='"
    else if (report%kind%name == "motion") then
      reason = "moves the first drive by its motor, not by a law"
    else if (report%kind%response) then
      reason = "is about a crank at constant speed, not about one that moves by a law"
    else if (report%kind%beams) then
      reason = "is about positions and speeds of CRANK and SPEED, not about a law"
    end if
  end function reason_against

end module law_checks
