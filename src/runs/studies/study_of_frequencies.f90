!> Frequencies at every position and speed, in blocks of positions that are tasks of a job.
module study_of_frequencies
  use byte_streams, only: byte_stream_t
  use frequency_memory, only: add_frequency_memory
  use frequency_study, only: add_work, begin_sweep, block_count, block_of, missed_states, &
    most_attempts, solve_block
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use link_store, only: link_store_t
  use mode_requests, only: drawn_states, mode_request_of
  use models, only: speed_in_words
  use named_parts, only: name_outcomes
  use position_results, only: error_of_divergence, error_of_orders, error_of_position, &
    frequency_of, position_result_t
  use positions, only: by_crank_angle
  use progress, only: show_progress
  use rank_tasks, only: help_with_tasks
  use run_findings, only: failure_t, findings_t
  use run_totals, only: run_totals_t, widen
  use study_findings, only: judge_deflection, most_deflection, note_failure_here, note_warning, &
    unit_of_positions
  use structures, only: in_parts
  use study_types, only: add_study, study_t, variant_run_t
  use sweep_bytes, only: pass_result
  use sweep_extremes, only: row_place_t, widen_sweep_extremes
  use sweeps, only: has_result
  use tasks, only: run_tasks
  use text, only: plural, to_string
  use text_buffer, only: append_text
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

  !> The blocks of an attempt of a sweep.
  type, extends(job_t) :: sweep_job_t
    type(variant_run_t), pointer :: variant => null() !! with the positions
    type(vibration_models_t) :: models                !! that serve the states
    integer :: attempt = 1                            !! number
    integer, allocatable :: states(:)                 !! that are solved in it, by crank angle
    integer :: before = 0                             !! blocks before those of these states
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

    call add_study(list, study_t(study_name, keeps=.true., compute=compute_frequencies, &
      add_failures_at=add_frequency_failures, add_warnings=add_frequency_warnings, &
      add_work=add_frequency_work, add_memory=add_frequency_memory))
  end subroutine add_frequency_study

  !> Solves every position that has a pose. Positions that need higher orders than the samples by
  !! which orders were chosen are solved again, with orders chosen for them.
  subroutine compute_frequencies(run)
    type(variant_run_t), intent(inout), target :: run

    type(sweep_job_t) :: job
    integer :: made

    associate (positions => run%results%found%positions, sweep => run%results%found%sweep)
      call begin_job(job, run)
      made = run%store%made
      do
        call begin_attempt(job, run, run%store)
        if (allocated(run%error)) return
        call announce_attempt(job, run)
        call run_tasks(job, job%before + 1, job%before + block_count(size(job%states)), &
          threads_of(run), run%journal, run%group)
        if (was_interrupted()) return
        call add_work(sweep, job%states)
        job%states = missed_states(sweep, job%states)
        if (size(job%states) == 0 .or. job%attempt == most_attempts) exit
        job%attempt = job%attempt + 1
      end do
      sweep%counts%link_models = run%store%made - made
      call name_links(run%results)
      call widen_sweep_extremes(positions, sweep, run%results%found%extremes)
    end associate
  end subroutine compute_frequencies

  !> Makes the models of an attempt: orders are chosen at some of its states. In the first one
  !! those of a list that comes in blocks serve all blocks.
  subroutine begin_attempt(job, run, store)
    type(sweep_job_t), intent(inout) :: job   !! with the attempt and its states
    type(variant_run_t), intent(inout) :: run !! its error is set without models
    type(link_store_t), intent(inout) :: store

    associate (positions => run%results%found%positions, sweep => run%results%found%sweep)
      job%before = (job%attempt - 1)*block_count(states_of(run)) + block_count(positions%before)
      job%solved = positions%before + size(positions%states) - size(job%states)
      if (job%attempt == 1 .and. allocated(run%models)) then
        job%models = run%models
      else if (job%attempt == 1 .and. allocated(run%blocks)) then
        call new_vibration_models(sweep%structure, run%blocks%sample, &
          by_crank_angle(run%blocks%sample), sweep%request, sweep%request%accuracy, store, &
          job%models, sweep%counts, run%error)
        run%models = job%models
      else
        call new_vibration_models(sweep%structure, positions, job%states, sweep%request, &
          sweep%request%accuracy, store, job%models, sweep%counts, run%error)
      end if
      if (job%attempt == 1) sweep%models = job%models
    end associate
  end subroutine begin_attempt

  !> States of the whole list.
  pure integer function states_of(run)
    type(variant_run_t), intent(in) :: run

    states_of = size(run%results%found%sweep%results)
    if (allocated(run%blocks)) states_of = size(run%blocks%first_alike)
  end function states_of

  !> Makes the words by which other ranks help with an attempt.
  subroutine announce_attempt(job, run)
    type(sweep_job_t), intent(inout) :: job !! at its attempt
    type(variant_run_t), intent(in) :: run

    type(byte_stream_t) :: announced

    if (.not. allocated(run%announcement)) return
    call append_text(announced%bytes, run%announcement)
    call pass_attempt(announced, job)
    job%announcement = announced%bytes%storage(:announced%bytes%length)
  end subroutine announce_attempt

  !> Passes the number of an attempt, and which states are solved again in it.
  subroutine pass_attempt(stream, job)
    type(byte_stream_t), intent(inout) :: stream
    type(sweep_job_t), intent(inout) :: job !! with all states, if it is read

    integer :: count, i

    call stream%pass(job%attempt)
    if (job%attempt == 1) return
    count = size(job%states)
    call stream%pass(count)
    do i = 1, count
      call stream%pass(job%states(i))
    end do
    job%states = job%states(:count)
  end subroutine pass_attempt

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
      if (request%method == by_orders) then
        run%results%found%sweep%structure = in_parts(run%results%mechanism, request%modes)
      else
        run%results%found%sweep%structure = run%results%mechanism%structure_t
      end if
      job%states = by_crank_angle(positions)
    end associate
    job%variant => run
  end subroutine begin_job

  !> Helps the leader with the blocks of a sweep that it has announced: does all that comes before
  !! them, and then the blocks that it hands out.
  subroutine help_with_sweep(run, stream)
    type(variant_run_t), intent(inout), target :: run !! with positions
    type(byte_stream_t), intent(inout) :: stream      !! that announces them

    type(sweep_job_t) :: job
    type(link_store_t) :: store

    call begin_job(job, run)
    call pass_attempt(stream, job)
    ! An error is that of the leader too, who does not call for help then.
    call begin_attempt(job, run, store)
    call help_with_tasks(job, threads_of(run))
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

    call solve_block(self%variant%results%found%sweep%structure, &
      self%variant%results%found%positions, &
      self%models, block_of(self%states, number - self%before), &
      self%variant%results%found%sweep)
  end subroutine run_block

  !> Passes the results of a block.
  subroutine pass_block(self, number, stream)
    class(sweep_job_t), intent(inout) :: self
    integer, intent(in) :: number
    type(byte_stream_t), intent(inout) :: stream

    type(position_result_t) :: none
    integer, allocatable :: block(:)
    integer :: i

    block = block_of(self%states, number - self%before)
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

    self%solved = self%solved + size(block_of(self%states, number - self%before))
    call show_progress(self%variant%progress, self%solved, states_of(self%variant))
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
    if (.not. allocated(variant%found%extremes%divergence)) return
    do k = 1, size(variant%found%extremes%divergence)
      warning = divergences(variant, k)
      call note_warning(variant, study_name, warning, findings)
    end do
    warning = deflections(variant)
    call note_warning(variant, study_name, warning, findings)
    if (variant%found%sweep%request%method /= by_orders) return
    warning = missed_accuracy(variant)
    call note_warning(variant, study_name, warning, findings)
  end subroutine add_frequency_warnings

  !> The crank angles at which an eigenvalue is negative at one speed.
  pure function divergences(variant, speed) result(warning)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: speed !! number
    type(warning_t) :: warning   !! without a text if there is none

    character(len=:), allocatable :: ranges
    type(unit_t) :: unit
    integer :: i

    warning%kind = of_divergence
    unit = unit_of_positions(variant%model)
    ranges = ""
    associate (divergence => variant%found%extremes%divergence(speed))
      if (.not. allocated(divergence%range)) return
      warning%amount = divergence%amount
      do i = 1, size(divergence%range, 2)
        if (i > 1) ranges = ranges//", "
        ranges = ranges//to_string(from_si(divergence%range(1, i), unit), 10)
        if (divergence%range(2, i) > divergence%range(1, i) .or. divergence%range(2, i) < &
          divergence%range(1, i)) ranges = ranges//" to "// &
          to_string(from_si(divergence%range(2, i), unit), 10)
      end do
    end associate
    warning%text = "static divergence at speed "//speed_in_words(variant%model, speed, &
      variant%found%sweep%request%speed(speed))//", crank "//ranges// &
      " "//unit%name//": an eigenvalue is negative, and so is the frequency written"
  end function divergences

  !> `speed 20 rad/s, crank 45 deg`
  pure function words_of(place, variant) result(words)
    type(row_place_t), intent(in) :: place
    type(variant_results_t), intent(in) :: variant
    character(len=:), allocatable :: words

    type(unit_t) :: unit

    unit = unit_of_positions(variant%model)
    words = "speed "//speed_in_words(variant%model, place%speed, &
      variant%found%sweep%request%speed(place%speed))//", crank "// &
      to_string(from_si(place%crank, unit), 12)//" "//unit%name
  end function words_of

  !> The largest static deflection under the loads, if it is too large for the theory of the axial
  !! frequencies.
  pure function deflections(variant) result(warning)
    type(variant_results_t), intent(in) :: variant
    type(warning_t) :: warning !! without a text if there is none

    warning%kind = of_deflection
    associate (extremes => variant%found%extremes)
      if (extremes%deflection <= most_deflection) return
      warning%text = "the "//trim(merge("loads        ", "inertia loads", &
        variant%found%sweep%request%constant))//" at "//words_of(extremes%at_deflection, &
        variant)//" deflect link '"//variant%mechanism%names(extremes%deflected)%text//"'"
      call judge_deflection(extremes%deflection, "frequencies under these loads mean", &
        "axial frequencies", warning)
    end associate
  end function deflections

  !> Number of rows with a frequency less accurate than requested, the worst of them, and what
  !! limits it there.
  pure function missed_accuracy(variant) result(warning)
    type(variant_results_t), intent(in) :: variant
    type(warning_t) :: warning !! without a text if there is none

    warning%kind = of_accuracy
    associate (extremes => variant%found%extremes)
      if (extremes%missed == 0) return
      warning%amount = extremes%error
      warning%text = "the accuracy "//to_string(variant%found%sweep%request%accuracy)// &
        " is not reached in "//plural(extremes%missed, "row")//": the error is up to "// &
        to_string(extremes%error, 2)//", at "//words_of(extremes%at_error, variant)// &
        " ("//reason_of(extremes%cause)//")"
    end associate
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
