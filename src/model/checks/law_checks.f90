!> The law of the first drive: found from LAW cards, and its positions, speeds and accelerations at
!! the instants of TIME.
module law_checks
  use card_table, only: pattern_of
  use cards, only: card_t
  use constants, only: degree
  use cubic_splines, only: ends_at_rest, ends_not_a_knot, ends_periodic, new_cubic_spline
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use kinds, only: wp
  use law_cards, only: law_card_t, table_free, table_periodic, table_rest
  use models, only: drives_length, model_t
  use motion_laws, only: law_ramp, motion_segment_t
  use motion_programs, only: program_values
  use report_kinds, only: report_kind_t
  use sorting, only: ascending_order
  use spelling, only: suggestion
  use table_cards, only: number_table_t, read_table
  use text, only: same_word, string_t, to_string
  use tokens, only: token_t
  use units, only: dimension_angle, dimension_length, dimension_time
  implicit none (type, external)
  private

  public :: find_law, refuse_reports_of_law

  !> Instants that are nearer to each other, relative to a segment, are one; and so with positions
  !! relative to themselves: what is left by conversions of units.
  real(wp), parameter :: rounding = 1.0e-12_wp

contains

  !> Puts the motion of the first drive by its law into a model: positions in place of those of
  !! CRANK, speed and acceleration at every instant of TIME.
  !!
  !! Errors: TIME without a law; CRANK and SPEED beside one, and VARY time; a law without cards;
  !! segments that overlap, a first one that does not say where it begins, later ones that begin
  !! elsewhere than the one before ends; a table beside segments or another table, with less than
  !! two rows, with an instant beyond its ends. Warnings: a law that no DRIVE uses, a ramp that
  !! begins or ends with a jump of the velocity.
  subroutine find_law(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(inout) :: model             !! with its cards read

    type(law_card_t), allocatable :: own_cards(:)
    type(token_t) :: word
    logical :: fine

    word = token_t("", 0, 0)
    if (size(model%drives) > 0) word = model%drives(1)%law
    call warn_of_idle_laws(diagnostics, model, word)
    if (word%line == 0) then
      call refuse_cards(cards, ["TIME "], "TIME is for a drive with a law, which no DRIVE has "// &
        "(DRIVE ... law=)", diagnostics)
      return
    end if
    allocate (model%law_rates(2, 0))
    call refuse_cards(cards, ["CRANK", "SPEED"], &
      "the rows of tables are those of the instants of TIME", diagnostics, word)
    call refuse_time_as_name(cards, diagnostics)
    call find_own_cards(model, word, own_cards)
    if (size(own_cards) == 0) then
      if (.not. has_errors(diagnostics)) call add_error(diagnostics, word, "there is no law '"// &
        word%text//"'"//suggestion(word%text, law_names(model))//"; expected: "// &
        pattern_of("LAW"))
      return
    end if
    call refuse_tables_beside(own_cards, diagnostics, fine)
    if (.not. fine) return
    if (own_cards(1)%table_word%line > 0) then
      call take_table(cards, own_cards(1), diagnostics, model)
    else
      call take_segments(own_cards, diagnostics, model)
    end if
  end subroutine find_law

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

  !> Warnings: a law is not that of the first drive; once for each.
  pure subroutine warn_of_idle_laws(diagnostics, model, word)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: word

    integer :: i, k
    logical :: told

    do i = 1, size(model%laws)
      associate (name => model%laws(i)%name)
        if (name%line == 0 .or. same_word(name%text, word%text)) cycle
        told = .false.
        do k = 1, i - 1
          told = told .or. same_word(model%laws(k)%name%text, name%text)
        end do
        if (.not. told) call add_warning(diagnostics, name, "no DRIVE moves by the law '"// &
          name%text//"'")
      end associate
    end do
  end subroutine warn_of_idle_laws

  !> Errors: a law has a table and further cards.
  pure subroutine refuse_tables_beside(own_cards, diagnostics, fine)
    type(law_card_t), intent(in) :: own_cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(out) :: fine

    integer :: i, other

    fine = size(own_cards) == 1
    if (fine) return
    do i = 1, size(own_cards)
      if (own_cards(i)%table_word%line == 0) cycle
      other = merge(2, 1, i == 1)
      call add_error(diagnostics, own_cards(i)%table_word, &
        "a law is one table, or segments", own_cards(other)%name, "another card of this law")
      return
    end do
    fine = .true.
  end subroutine refuse_tables_beside

  !> A law of segments.
  pure subroutine take_segments(own_cards, diagnostics, model)
    type(law_card_t), intent(in) :: own_cards(:) !! in the order of their starts
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(motion_segment_t) :: segments(size(own_cards))
    integer :: i, before
    logical :: fine

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
    model%program%segments = segments
    call put_motion(model)
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
  pure subroutine take_table(cards, card, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(law_card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    integer, parameter :: ends(3) = [ends_not_a_knot, ends_at_rest, ends_periodic]
    type(number_table_t) :: table
    real(wp) :: slope, first, last
    integer :: dimensions(4, 2), i
    logical :: fine

    dimensions(:, 1) = dimension_time
    dimensions(:, 2) = merge(dimension_length, dimension_angle, drives_length(model))
    call read_table(cards, card%table_word, "time and position", dimensions, diagnostics, table, &
      fine)
    if (.not. fine) return
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
      associate (program => model%program)
        program%rate = slope
        program%rests = card%ends == table_rest
        program%spline = new_cubic_spline(table%values(1, :), [table%values(2, :rows - 1) - &
          slope*(table%values(1, :rows - 1) - first), merge(table%values(2, 1), &
          table%values(2, rows), card%ends == table_periodic)], ends(card%ends))
      end associate
      do i = 1, size(time%value)
        associate (t => time%value(i))
          if (card%ends /= table_free .or. (t >= first .and. t <= last)) cycle
          call add_error(diagnostics, time%words(time%word(i)), "the table '"// &
            card%table_word%text//"' goes from "//to_string(first, 10)//" to "// &
            to_string(last, 10)//" s, and this instant is "//to_string(t, 10)// &
            " s; 'ends=rest' stands still beyond, 'ends=periodic' repeats", card%table_word, &
            "its table is given here")
          return
        end associate
      end do
    end associate
    call put_motion(model)
  end subroutine take_table

  !> Puts positions, speeds and accelerations of the law into a model; its positions have the places
  !! of their instants.
  pure subroutine put_motion(model)
    type(model_t), intent(inout) :: model !! with the law

    real(wp) :: motion(0:2, size(model%time%value)), scale
    integer :: i

    do i = 1, size(model%time%value)
      motion(:, i) = program_values(model%program, model%time%value(i))
    end do
    scale = degree
    if (drives_length(model)) scale = 1.0_wp
    model%crank%value = motion(0, :)
    model%crank%written = motion(0, :)
    model%crank%word = model%time%word
    model%crank%words = model%time%words
    model%law_rates = scale*motion(1:, :)
  end subroutine put_motion

  !> Errors: a report that is about constant speed, or moves the first drive otherwise.
  pure subroutine refuse_reports_of_law(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with a law, and its reports chosen

    character(len=:), allocatable :: reason
    integer :: i

    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (report%kind%name == "transient") cycle
        if (report%kind%name == "motion") then
          reason = "moves the first drive by its motor, not by a law"
        else if (report%kind%response .or. report%kind%name == "sizing") then
          reason = "is about a crank at constant speed, not about one that moves by a law"
        else if (report%kind%beams) then
          reason = "is about positions and speeds of CRANK and SPEED, not about a law"
        else
          cycle
        end if
        call add_error(diagnostics, report%keyword, "REPORT "//trim(report%kind%name)//" "// &
          reason, model%drives(1)%law, "the law is given here")
        ! What it would need is not asked for.
        report%kind = report_kind_t()
      end associate
    end do
  end subroutine refuse_reports_of_law

end module law_checks
