!> Remarks and failed rows that all tables of the elastic response have.
module response_notes
  use kinds, only: long, wp
  use mechanisms, only: link_lengths
  use models, only: inertia_lumped, accuracy_of_study, speed_in_words
  use response_study, only: largest_deflection
  use table_rows, only: add_failed_row, rows_t
  use text, only: append_string, string_t, to_string
  use units, only: dimension_time
  use value_words, only: in_words
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: append_response_notes, damping_note, without_note, has_response, add_failed_speed, &
    response_log

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> What is computed, with which damping, how, and what the errors are.
  pure subroutine append_response_notes(notes, variant)
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which they are appended
    type(variant_results_t), intent(in) :: variant         !! with its response computed

    call append_string(notes, "steady state at constant speed of the crank; small deformations "// &
      "of the moving linkage, in linear equations")
    call append_string(notes, damping_note(variant))
    associate (model => variant%model)
      if (model%without%keyword%line > 0) call append_string(notes, without_note(variant))
      if (model%inertia == inertia_lumped) call append_string(notes, "the mass of the links is "// &
        "distributed along them: INERTIA lumped does not apply to the response")
      call append_string(notes, "error: estimated, relative to the largest value of the "// &
        "quantity over the turn; accuracy asked for: "//to_string(accuracy_of_study(model, &
        "response")))
    end associate
    call append_method(notes, variant)
  end subroutine append_response_notes

  !> Orders and samples, over all speeds.
  pure subroutine append_method(notes, variant)
    type(string_t), allocatable, intent(inout) :: notes(:)
    type(variant_results_t), intent(in) :: variant

    integer :: order(2), samples(2), k

    order = [huge(1), 0]
    samples = [huge(1), 0]
    associate (at_speed => variant%found%response%at_speed)
      do k = 1, size(at_speed)
        if (allocated(at_speed(k)%error)) cycle
        order = [min(order(1), at_speed(k)%order), max(order(2), at_speed(k)%order)]
        samples = [min(samples(1), at_speed(k)%samples), max(samples(2), at_speed(k)%samples)]
      end do
    end associate
    if (order(2) == 0) return
    call append_string(notes, "polynomials of order "//range_words(order)// &
      " along every link, periodic motion from its values at "//range_words(samples)// &
      " crank angles of the turn")
  end subroutine append_method

  !> `10`, or `10 to 14`
  pure function range_words(range) result(words)
    integer, intent(in) :: range(2)
    character(len=:), allocatable :: words

    words = to_string(range(1))
    if (range(2) > range(1)) words = words//" to "//to_string(range(2))
  end function range_words

  !> `damping: crank none, coupler time 0.0001 s, follower ratio 0.01, damper shock`
  pure function damping_note(variant) result(note)
    type(variant_results_t), intent(in) :: variant !! with its model
    character(len=:), allocatable :: note

    integer :: b

    note = "damping:"
    associate (model => variant%model, links => variant%mechanism%links)
      do b = 1, size(links)
        associate (link => model%links(links(b)))
          if (b > 1) note = note//","
          note = note//" "//link%name%text
          if (link%rigid) then
            note = note//" rigid"
          else if (link%damping == 0) then
            note = note//" none"
          else if (model%dampings(link%damping)%has_time) then
            note = note//" time "//in_words(model%dampings(link%damping)%time, dimension_time, &
              model%units, 9)
          else
            note = note//" ratio "//to_string(model%dampings(link%damping)%ratio)
          end if
        end associate
      end do
      do b = 1, size(model%springs)
        if (model%springs(b)%damps) note = note//", damper "//model%springs(b)%name%text
      end do
    end associate
  end function damping_note

  !> The terms that are left out.
  pure function without_note(variant) result(note)
    type(variant_results_t), intent(in) :: variant !! with its model
    character(len=:), allocatable :: note

    note = ""
    associate (without => variant%model%without)
      if (without%coriolis) note = note//", coriolis"
      if (without%centripetal) note = note//", centripetal"
      if (without%tangential) note = note//", tangential"
      if (without%axial) note = note//", axial"
      if (without%quadratic) note = note//", quadratic"
    end associate
    note = "terms left out by EFFECTS response: "//note(3:)
  end function without_note

  !> Log lines: damping, terms left out, how the response was found, its error, and what limits it.
  pure function response_log(variant) result(text)
    type(variant_results_t), intent(in) :: variant !! with its response computed
    character(len=:), allocatable :: text

    integer :: range(2, 3), k, found, body, speed
    integer(long) :: applications
    real(wp) :: error, share, distance, here

    text = "response: "//damping_note(variant)//line_feed
    if (variant%model%without%keyword%line > 0) text = text//"response: "//without_note(variant)// &
      line_feed
    range(1, :) = huge(1)
    range(2, :) = 0
    found = 0
    applications = 0_long
    error = 0.0_wp
    distance = huge(1.0_wp)
    speed = 0
    associate (at_speed => variant%found%response%at_speed, model => variant%model, &
        mechanism => variant%mechanism)
      do k = 1, size(at_speed)
        applications = applications + at_speed(k)%applications
        if (allocated(at_speed(k)%error)) cycle
        found = found + 1
        call widen(range, [at_speed(k)%order, at_speed(k)%samples, at_speed(k)%slow])
        error = max(error, at_speed(k)%largest_error)
        here = at_speed(k)%distance
        if (here >= distance) cycle
        distance = here
        speed = k
      end do
      if (found == 0) then
        text = text//"response: at no speed"//line_feed
        return
      end if
      text = text//"response: orders "//range_words(range(:, 1))//", "// &
        range_words(range(:, 2))//" crank angles, "//range_words(range(:, 3))// &
        " slow coordinates; "//to_string(applications)//" applications of the equation; "// &
        "largest estimated error "//to_string(error, 2)//line_feed
      text = text//"response: nearest to resonance at speed "// &
        speed_in_words(model, speed, model%speed%value(speed))//", least |1 - rho| of a turn "// &
        to_string(distance, 3)//line_feed
      call largest_deflection(variant%found%response, link_lengths(mechanism), share, body, speed)
      if (body == 0) return
      text = text//"response: largest deflection "//to_string(100.0_wp*share, 3)// &
        " % of the length, of link "//mechanism%names(body)%text//" at speed "// &
        speed_in_words(model, speed, model%speed%value(speed))//line_feed
    end associate
  end function response_log

  !> Takes numbers into ranges.
  pure subroutine widen(range, values)
    integer, intent(inout) :: range(:, :) !! (least and most, quantities)
    integer, intent(in) :: values(:)

    range(1, :) = min(range(1, :), values)
    range(2, :) = max(range(2, :), values)
  end subroutine widen

  !> Whether there is a response at a speed.
  pure function has_response(variant, speed) result(has)
    type(variant_results_t), intent(in) :: variant !! with its response computed
    integer, intent(in) :: speed                   !! number in the deck's list
    logical :: has

    has = .not. allocated(variant%found%response%at_speed(speed)%error)
  end function has_response

  !> The row of a speed without a response, with the reason.
  pure subroutine add_failed_speed(variant, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its response computed
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    call add_failed_row(rows, [variant%model%shown_speed(speed)], &
      variant%found%response%at_speed(speed)%error%text)
  end subroutine add_failed_speed

end module response_notes
