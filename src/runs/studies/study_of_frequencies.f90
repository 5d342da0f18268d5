!> Frequencies at every position and speed, in blocks of positions that are tasks of a job.
module study_of_frequencies
  use byte_streams, only: byte_stream_t
  use errors, only: error_t
  use frequency_memory, only: add_frequency_memory
  use frequency_study, only: begin_sweep, block_count, block_of, finish_sweep, missed_states, &
    most_attempts, solve_block
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use mechanisms, only: mechanism_t
  use mode_requests, only: drawn_states, mode_request_of
  use models, only: model_t, speed_in_words
  use named_parts, only: name_outcomes
  use position_results, only: error_of_divergence, error_of_orders, error_of_position, &
    frequency_of, position_result_t
  use positions, only: by_crank_angle, positions_t
  use progress, only: show_progress
  use rank_tasks, only: help_with_tasks
  use run_findings, only: failure_t, findings_t
  use run_totals, only: run_totals_t, widen
  use study_findings, only: judge_deflection, most_deflection, note_failure_here, note_warning, &
    unit_of_positions
  use study_types, only: add_study, study_t, variant_run_t
  use sweep_bytes, only: pass_result
  use sweeps, only: has_result, sweep_t
  use tasks, only: run_tasks
  use text, only: plural, to_string
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  use vibration_models, only: by_band, by_orders, mode_request_t, new_vibration_models, &
    vibration_models_t
  use warnings, only: warning_t
  implicit none (type, external)
  private

  public :: add_frequency_study, help_with_sweep

  character(len=*), parameter :: study_name = "frequencies"

  !> Kinds of warnings: an eigenvalue is negative, the loads bend a link too much, the accuracy is
  !! not reached.
  integer, parameter :: of_divergence = 1, of_deflection = 2, of_accuracy = 3

  !> The blocks of a sweep.
  type, extends(job_t) :: sweep_job_t
    type(variant_run_t), pointer :: variant => null() !! with the positions
    type(vibration_models_t) :: models                !! that serve the states
    integer, allocatable :: states(:)                 !! of the sweep, by crank angle
    integer :: solved = 0                             !! states
  contains
    procedure :: run => run_block
    procedure :: pass => pass_block
    procedure :: finish => finish_block
  end type sweep_job_t

contains

  !> Appends the study of this file.
  subroutine add_frequency_study(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t(study_name, compute=compute_frequencies, &
      add_failures_at=add_frequency_failures, add_warnings=add_frequency_warnings, &
      add_work=add_frequency_work, add_memory=add_frequency_memory))
  end subroutine add_frequency_study

  !> Solves every position that has a pose. Positions that need higher orders than the samples by
  !! which orders were chosen are solved again, with orders chosen for them.
  subroutine compute_frequencies(run)
    type(variant_run_t), intent(inout), target :: run

    type(sweep_job_t) :: job
    integer :: attempt, made

    associate (mechanism => run%results%mechanism, positions => run%results%found%positions, &
        sweep => run%results%found%sweep, store => run%store)
      call begin_job(job, run)
      if (allocated(run%announcement)) job%announcement = run%announcement
      made = store%made
      do attempt = 1, most_attempts
        call new_vibration_models(mechanism%structure_t, positions, job%states, sweep%request, &
          sweep%request%accuracy, store, job%models, sweep%counts, run%error)
        if (allocated(run%error)) return
        if (attempt == 1) sweep%models = job%models
        job%solved = size(positions%states) - size(job%states)
        call run_tasks(job, 1, block_count(size(job%states)), threads_of(run), run%journal, &
          merge(run%group, -1, attempt == 1))
        ! Other ranks do not know which positions are solved again. They are few.
        if (allocated(job%announcement)) deallocate (job%announcement)
        job%states = missed_states(sweep, job%states)
        if (size(job%states) == 0 .or. was_interrupted()) exit
      end do
      sweep%counts%link_models = store%made - made
      call finish_sweep(sweep)
      call name_links(run%results)
    end associate
  end subroutine compute_frequencies

  !> ARPACK serves one thread at a time: others would only wait.
  pure integer function threads_of(run)
    type(variant_run_t), intent(in) :: run

    threads_of = merge(1, run%threads, run%results%found%sweep%request%method == by_band)
  end function threads_of

  !> The sweep without results, and its states by crank angle.
  subroutine begin_job(job, run)
    type(sweep_job_t), intent(inout) :: job
    type(variant_run_t), intent(inout), target :: run !! with positions

    type(mode_request_t) :: request

    associate (model => run%results%model, positions => run%results%found%positions)
      request = mode_request_of(model, run%results%mechanism)
      call begin_sweep(request, drawn_states(model, positions, request%speed), &
        size(positions%states), run%results%found%sweep)
      job%states = by_crank_angle(positions)
    end associate
    job%variant => run
  end subroutine begin_job

  !> Helps the leader with the blocks of a sweep that it has announced: does all that comes before
  !! them, and then the blocks that it hands out.
  subroutine help_with_sweep(run)
    type(variant_run_t), intent(inout), target :: run !! with positions

    type(sweep_job_t) :: job
    type(link_store_t) :: store
    type(error_t), allocatable :: error

    call begin_job(job, run)
    associate (sweep => run%results%found%sweep)
      ! An error is that of the leader too, who does not call for help then.
      call new_vibration_models(run%results%mechanism%structure_t, run%results%found%positions, &
        job%states, sweep%request, sweep%request%accuracy, store, job%models, sweep%counts, error)
      call help_with_tasks(job, threads_of(run))
    end associate
  end subroutine help_with_sweep

  !> Puts names into the errors of rows.
  subroutine name_links(variant)
    type(variant_results_t), intent(inout) :: variant

    integer :: i

    associate (results => variant%found%sweep%results)
      do i = 1, size(results)
        if (allocated(results(i)%outcome)) call name_outcomes(variant, results(i)%outcome)
      end do
    end associate
  end subroutine name_links

  !> Solves a block of the sweep.
  subroutine run_block(self, number)
    class(sweep_job_t), intent(inout) :: self
    integer, intent(in) :: number

    call solve_block(self%variant%results%mechanism%structure_t, &
      self%variant%results%found%positions, &
      self%models, block_of(self%states, number), self%variant%results%found%sweep)
  end subroutine run_block

  !> Passes the results of a block.
  subroutine pass_block(self, number, stream)
    class(sweep_job_t), intent(inout) :: self
    integer, intent(in) :: number
    type(byte_stream_t), intent(inout) :: stream

    type(position_result_t) :: none
    integer, allocatable :: block(:)
    integer :: i

    block = block_of(self%states, number)
    do i = 1, size(block)
      associate (result => self%variant%results%found%sweep%results(block(i)))
        if (stream%reads) result = none
        call pass_result(stream, result)
      end associate
    end do
  end subroutine pass_block

  !> Counts the states of a block and shows the progress.
  subroutine finish_block(self, number)
    class(sweep_job_t), intent(inout) :: self
    integer, intent(in) :: number

    self%solved = self%solved + size(block_of(self%states, number))
    call show_progress(self%variant%progress, self%solved, &
      size(self%variant%results%found%sweep%results))
  end subroutine finish_block

  !> Speeds without frequencies at a position.
  pure subroutine add_frequency_failures(variant, position, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position
    type(findings_t), intent(inout) :: findings

    type(failure_t) :: failure
    integer :: k

    associate (found => variant%found, state => variant%found%positions%state(position))
      if (.not. allocated(found%sweep%results)) return
      do k = 1, size(found%sweep%request%speed)
        if (has_result(found%positions, found%sweep, state, k)) cycle
        failure%stage = study_name
        failure%error = found%sweep%results(state)%outcome(k)%error
        failure%crank = found%positions%crank(position)
        failure%speed = found%sweep%request%speed(k)
        failure%speed_words = "speed "//speed_in_words(variant%model, k, failure%speed)
        call note_failure_here(variant, failure, findings)
      end do
    end associate
  end subroutine add_frequency_failures

  pure subroutine add_frequency_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(warning_t) :: warning
    integer :: k

    ! Function results go through a variable: gfortran 12 does not free them if they are arguments.
    associate (model => variant%model, positions => variant%found%positions, &
        sweep => variant%found%sweep)
      do k = 1, size(sweep%request%speed)
        warning = divergences(model, positions, sweep, k)
        call note_warning(variant, study_name, warning, findings)
      end do
      if (sweep%request%axial) then
        warning = deflections(model, variant%mechanism, positions, sweep)
        call note_warning(variant, study_name, warning, findings)
      end if
      if (sweep%request%method == by_orders) then
        warning = missed_accuracy(model, positions, sweep)
        call note_warning(variant, study_name, warning, findings)
      end if
    end associate
  end subroutine add_frequency_warnings

  !> The crank angles at which an eigenvalue is negative at one speed. Neighbours in the deck's
  !! list are joined to ranges.
  pure function divergences(model, positions, sweep, speed) result(warning)
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: speed !! number
    type(warning_t) :: warning             !! without a text if there is none

    character(len=:), allocatable :: ranges
    type(unit_t) :: unit
    integer :: i, first

    warning%kind = of_divergence
    unit = unit_of_positions(model)
    ranges = ""
    first = 0
    do i = 1, size(positions%crank)
      if (diverges(positions, sweep, i, speed)) then
        warning%amount = max(warning%amount, &
          -minval(sweep%results(positions%state(i))%lambda(:, speed)))
        if (first == 0) first = i
      end if
      if (first == 0) cycle
      if (i < size(positions%crank)) then
        if (diverges(positions, sweep, i + 1, speed)) cycle
      end if
      if (len(ranges) > 0) ranges = ranges//", "
      ranges = ranges//to_string(from_si(positions%crank(first), unit), 10)
      if (i > first) ranges = ranges//" to "//to_string(from_si(positions%crank(i), unit), 10)
      first = 0
    end do
    if (len(ranges) == 0) return
    warning%text = "static divergence at speed "// &
      speed_in_words(model, speed, sweep%request%speed(speed))//", crank "//ranges// &
      " "//unit%name//": an eigenvalue is negative, and so is the frequency written"
  end function divergences

  !> `speed 20 rad/s, crank 45 deg`
  pure function place_of_row(model, sweep, crank, speed) result(place)
    type(model_t), intent(in) :: model
    type(sweep_t), intent(in) :: sweep
    real(wp), intent(in) :: crank !! [deg] or [m]
    integer, intent(in) :: speed  !! number
    character(len=:), allocatable :: place

    type(unit_t) :: unit

    unit = unit_of_positions(model)
    place = "speed "//speed_in_words(model, speed, sweep%request%speed(speed))//", crank "// &
      to_string(from_si(crank, unit), 12)//" "//unit%name
  end function place_of_row

  !> Whether the lowest eigenvalue at a position and speed is negative.
  pure function diverges(positions, sweep, position, speed)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: position, speed !! numbers
    logical :: diverges

    associate (state => positions%state(position))
      diverges = has_result(positions, sweep, state, speed)
      if (diverges) diverges = any(sweep%results(state)%lambda(:, speed) < 0.0_wp)
    end associate
  end function diverges

  !> The largest static deflection under the loads, if it is too large for the theory of the axial
  !! frequencies.
  pure function deflections(model, mechanism, positions, sweep) result(warning)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(warning_t) :: warning             !! without a text if there is none

    real(wp) :: largest
    integer :: i, body, speed, at_body, at_speed, at_position

    warning%kind = of_deflection
    largest = 0.0_wp
    at_body = 1
    at_speed = 1
    at_position = 1
    do i = 1, size(positions%crank)
      if (allocated(positions%states(positions%state(i))%error)) cycle
      do speed = 1, size(sweep%request%speed)
        do body = 1, size(mechanism%names)
          ! With a tolerance, so that of equal positions (0 and 360) the first is named.
          if (sweep%results(positions%state(i))%deflection(body, &
            speed) <= largest*(1.0_wp + 1.0e-12_wp)) cycle
          largest = sweep%results(positions%state(i))%deflection(body, speed)
          at_body = body
          at_speed = speed
          at_position = i
        end do
      end do
    end do
    if (largest <= most_deflection) return
    warning%text = "the "//trim(merge("loads        ", "inertia loads", &
      sweep%request%constant))//" at "//place_of_row(model, sweep, positions%crank(at_position), &
      at_speed)//" deflect link '"//mechanism%names(at_body)%text//"'"
    call judge_deflection(largest, "frequencies under these loads mean", "axial frequencies", &
      warning)
  end function deflections

  !> Number of rows with a frequency less accurate than requested, the worst of them, and what
  !! limits it there.
  pure function missed_accuracy(model, positions, sweep) result(warning)
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(warning_t) :: warning             !! without a text if there is none

    real(wp) :: worst, error
    integer :: i, k, rows, at_position, at_speed

    warning%kind = of_accuracy
    worst = 0.0_wp
    rows = 0
    at_position = 1
    at_speed = 1
    do i = 1, size(positions%crank)
      do k = 1, size(sweep%request%speed)
        if (.not. has_result(positions, sweep, positions%state(i), k)) cycle
        error = maxval(sweep%results(positions%state(i))%error(:, k))
        if (error <= sweep%request%accuracy) cycle
        rows = rows + 1
        if (error <= worst) cycle
        worst = error
        at_position = i
        at_speed = k
      end do
    end do
    if (rows == 0) return
    warning%amount = worst
    warning%text = "the accuracy "//to_string(sweep%request%accuracy)// &
      " is not reached in "//plural(rows, "row")//": the error is up to "//to_string(worst, 2)// &
      ", at "//place_of_row(model, sweep, positions%crank(at_position), at_speed)// &
      " ("//reason_of(sweep%results(positions%state(at_position))%cause(at_speed))//")"
  end function missed_accuracy

  !> What limits the accuracy of a row, in words.
  pure function reason_of(cause) result(text)
    integer, intent(in) :: cause
    character(len=:), allocatable :: text

    select case (cause)
    case (error_of_orders)
      text = "the highest polynomial orders cannot resolve such short waves"
    case (error_of_position)
      text = "so close to a dead point round-off leaves no more digits of the position"
    case (error_of_divergence)
      text = "near a divergence loads and stiffness nearly cancel, and digits are lost"
    case default
      text = "round-off in double precision leaves no more digits"
    end select
  end function reason_of

  pure subroutine add_frequency_work(variant, totals)
    type(variant_results_t), intent(in) :: variant
    type(run_totals_t), intent(inout) :: totals

    integer :: i, k

    associate (sweep => variant%found%sweep)
      totals%kinematic_solutions = totals%kinematic_solutions + sweep%counts%kinematic_solutions
      totals%has_frequencies = allocated(sweep%results)
      if (.not. totals%has_frequencies) return
      totals%speeds = size(sweep%request%speed)
      totals%counts = sweep%counts
      do i = 1, size(sweep%results)
        associate (result => sweep%results(i))
          if (.not. allocated(result%outcome)) cycle
          do k = 1, size(result%outcome)
            if (allocated(result%outcome(k)%error)) cycle
            totals%largest_error = max(totals%largest_error, maxval(result%error(:, k)))
            call widen(totals%lowest, frequency_of(result%lambda(1, k)))
            call widen(totals%highest, frequency_of(result%lambda(size(result%lambda, 1), k)))
          end do
        end associate
      end do
    end associate
  end subroutine add_frequency_work

end module study_of_frequencies
