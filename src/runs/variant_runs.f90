!> Computes one variant of a deck; a deck without VARY has just one.
module variant_runs
  use campbell_study, only: find_campbell_of
  use errors, only: error_of_reach, error_t
  use frequency_study, only: begin_sweep, block_count, block_of, finish_sweep, missed_states, &
    most_attempts, solve_block
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use drawn_cranks, only: starting_cranks
  use home_ranges, only: find_home_range
  use kinds, only: wp
  use link_store, only: link_store_t
  use linkage_motion_study, only: begin_linkage_motion, continue_linkage_motion, &
    finish_linkage_motion, linkage_motion_request_t, linkage_motion_under_way_t
  use linkage_paths, only: leave_path
  use linkage_study, only: class_of_other, classify_linkage
  use linkages, only: linkage_t
  use loci_study, only: follow_loci
  use mechanisms, only: mechanism_t, new_mechanism
  use models, only: has_law, model_t, motion_goes_through, needs_positions, needs_study, &
    report_number
  use motion_study, only: begin_motion, continue_motion, finish_motion, motion_request_t, &
    motion_under_way_t
  use position_study, only: find_all_positions
  use positions, only: by_crank_angle, refuse_change_points
  use progress, only: progress_t, show_progress
  use rank_tasks, only: help_with_tasks
  use reach_texts, only: open_linkage_text, reach_words
  use report_studies, only: find_study, study_names
  use response_study, only: find_response
  use stability_study, only: find_intervals_of, find_stability_of
  use structures, only: holds_at_change_points
  use study_requests, only: campbell_request_of, drawn_states, intervals_request_of, &
    linkage_motion_request_of, mode_request_of, motion_request_of, response_request_of, &
    stability_request_of, transient_request_of
  use sweep_bytes, only: get_result, put_result
  use sweeps, only: sweep_t
  use task_journal, only: journal_t
  use tasks, only: run_tasks
  use text_buffer, only: text_buffer_t
  use variant_results, only: variant_results_t
  use transient_responses, only: find_transients
  use vibration_models, only: by_band, mode_request_t, new_vibration_models, vibration_models_t
  implicit none (type, external)
  private

  public :: variant_run_t, begin_variant_run, compute_variant, help_with_sweep

  !> A variant under way. Its tasks are the blocks of its sweep.
  type, extends(job_t) :: variant_run_t
    type(variant_results_t) :: results
    type(progress_t) :: progress                  !! silent unless it is started
    type(vibration_models_t), private :: models   !! that serve the states
    integer, allocatable, private :: states(:)    !! of the sweep, by crank angle
    integer, private :: solved = 0                !! states
  contains
    procedure :: run => run_block
    procedure :: pack => pack_block
    procedure :: unpack => unpack_block
    procedure :: finish => finish_block
  end type variant_run_t

  !> Instants of a motion after which the progress is shown.
  integer, parameter :: instants_at_a_time = 100

contains

  !> Puts a model and its mechanism in place.
  subroutine begin_variant_run(run, model)
    type(variant_run_t), intent(inout) :: run !! new
    type(model_t), intent(in) :: model        !! without errors

    run%results%model = model
    run%results%mechanism = new_mechanism(model)
  end subroutine begin_variant_run

  !> Makes all studies that a variant requests. Several variants may be computed at the same time.
  !!
  !! Errors: the own modes of a link could not be found.
  subroutine compute_variant(run, threads, journal, group, store, error)
    type(variant_run_t), intent(inout) :: run    !! begun; on return with all results
    integer, intent(in) :: threads               !! on which it is computed
    type(journal_t), intent(inout) :: journal    !! of the deck
    integer, intent(in) :: group                 !! of the blocks in the journal; below 0: they are
                                                 !! not kept
    type(link_store_t), intent(inout) :: store   !! own modes of links found before
    type(error_t), allocatable, intent(out) :: error !! of the variant as a whole

    integer :: i

    associate (model => run%results%model, linkage => run%results%mechanism%linkage, &
        found => run%results%found)
      call find_positions_of(run%results, threads)
      call name_positions(run%results)
      if (run%results%mechanism%is_four_bar) then
        call classify_linkage(linkage, found%class)
        call explain_positions(run%results)
      else
        found%class = class_of_other()
      end if
      if (found%class%reach%closes .and. .not. (model%is_structure .or. has_law(model))) &
        call find_home_range(linkage, starting_cranks(model, linkage), model%crank%value, &
        has_gaps(run%results), found%home)
      call find_study("kinematics", threads, run%results)
      do i = 1, size(study_names)
        if (study_names(i) == "kinematics" .or. .not. needs_study(model, study_names(i))) cycle
        if (was_interrupted()) return
        select case (study_names(i))
        case ("motion")
          if (run%results%mechanism%is_four_bar) then
            call compute_motion(run)
          else
            call compute_linkage_motion(run)
          end if
        case ("response")
          call compute_response(run, threads, store)
        case ("stability")
          call compute_stability(run, threads, store)
        case ("intervals")
          call compute_intervals(run, threads, store)
        case ("campbell")
          call compute_campbell(run, threads, store)
        case ("transient")
          call compute_transient(run, store)
        case ("frequencies")
          call compute_sweep(run, threads, journal, group, store, error)
          if (allocated(error)) return
        case ("loci")
          call follow_loci(run%results%mechanism%structure_t, found%positions, found%sweep, &
            found%loci)
        case default
          call find_study(study_names(i), threads, run%results)
        end select
      end do
      if (allocated(found%geometry%outcome)) then
        do i = 1, size(found%geometry%outcome)
          call name_parts(run%results%model, run%results%mechanism, found%geometry%outcome(i)%error)
        end do
      end if
      call name_parts(run%results%model, run%results%mechanism, found%linkage_motion%error)
    end associate
  end subroutine compute_variant

  !> The positions that the reports need.
  subroutine find_positions_of(variant, threads)
    type(variant_results_t), intent(inout) :: variant !! with model and mechanism
    integer, intent(in) :: threads

    real(wp) :: none(0)

    associate (model => variant%model, linkage => variant%mechanism%linkage)
      ! Crank angles that no report needs must not fail.
      if (needs_positions(model)) then
        call find_all_positions(linkage, model%crank%value, threads, variant%found%positions, &
          has_law(model))
        if ((needs_study(model, "reactions") .or. needs_study(model, "joints") .or. &
          needs_study(model, "friction") .or. needs_study(model, "frequencies")) .and. .not. &
          holds_at_change_points(variant%mechanism)) call refuse_change_points( &
          variant%found%positions)
      else
        call find_all_positions(linkage, none, threads, variant%found%positions)
      end if
    end associate
  end subroutine find_positions_of

  !> Whether positions are out of reach, or ranges are asked for.
  pure function has_gaps(variant) result(has)
    type(variant_results_t), intent(in) :: variant !! with positions
    logical :: has

    integer :: i

    has = report_number(variant%model, "linkage") > 0
    do i = 1, size(variant%found%positions%states)
      if (has) return
      associate (state => variant%found%positions%states(i))
        if (allocated(state%error)) has = state%error%kind == error_of_reach .and. &
          state%error%place%pin == 0
      end associate
    end do
  end function has_gaps

  !> Puts names into the errors of positions.
  subroutine name_positions(variant)
    type(variant_results_t), intent(inout) :: variant !! with positions

    integer :: i

    do i = 1, size(variant%found%positions%states)
      call name_parts(variant%model, variant%mechanism, variant%found%positions%states(i)%error)
    end do
  end subroutine name_positions

  !> Says of a linkage that closes nowhere why, at all its positions. There are such in decks with
  !! VARY only.
  subroutine explain_positions(variant)
    type(variant_results_t), intent(inout) :: variant !! with positions and class

    integer :: i

    associate (states => variant%found%positions%states)
      if (variant%found%class%reach%closes) return
      ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one place
      ! for all threads.
      !$omp critical (one_at_a_time)
      variant%unreachable = open_linkage_text(variant%mechanism)
      !$omp end critical (one_at_a_time)
      do i = 1, size(states)
        if (.not. allocated(states(i)%error)) cycle
        if (states(i)%error%kind == error_of_reach) states(i)%error%text = variant%unreachable
      end do
    end associate
  end subroutine explain_positions

  !> Forward motion, a number of instants at a time.
  subroutine compute_motion(run)
    type(variant_run_t), intent(inout) :: run

    type(motion_under_way_t) :: under_way
    type(motion_request_t) :: request
    type(linkage_t) :: linkage

    associate (mechanism => run%results%mechanism, motion => run%results%found%motion)
      request = motion_request_of(run%results%model)
      linkage = mechanism%linkage
      call leave_path(linkage, request%start_angle)
      call begin_motion(request, linkage, mechanism%load_elements, under_way, motion)
      do while (.not. under_way%is_over)
        call continue_motion(under_way, instants_at_a_time, motion)
        call show_progress(run%progress, motion%count, size(motion%samples))
      end do
      call finish_motion(under_way, motion)
    end associate
  end subroutine compute_motion

  !> Forward motion of a linkage that is no four-bar.
  subroutine compute_linkage_motion(run)
    type(variant_run_t), intent(inout) :: run

    type(linkage_motion_under_way_t) :: under_way
    type(linkage_motion_request_t) :: request
    type(linkage_t) :: linkage

    associate (mechanism => run%results%mechanism, motion => run%results%found%linkage_motion)
      request = linkage_motion_request_of(run%results%model)
      linkage = mechanism%linkage
      if (.not. motion_goes_through(run%results%model)) call leave_path(linkage, request%start)
      call begin_linkage_motion(request, linkage, mechanism%load_elements, under_way, motion, &
        mechanism%structure_t)
      do while (.not. under_way%is_over)
        call continue_linkage_motion(under_way, instants_at_a_time, motion)
        call show_progress(run%progress, motion%count, size(motion%samples))
      end do
      call finish_linkage_motion(under_way, motion)
    end associate
  end subroutine compute_linkage_motion

  !> The elastic response at all speeds.
  subroutine compute_response(run, threads, store)
    type(variant_run_t), intent(inout) :: run
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store

    integer :: k

    associate (mechanism => run%results%mechanism, response => run%results%found%response)
      call find_response(mechanism%structure_t, response_request_of(run%results%model, mechanism), &
        threads, store, response)
      do k = 1, size(response%at_speed)
        if (.not. allocated(response%at_speed(k)%error)) cycle
        call name_parts(run%results%model, mechanism, response%at_speed(k)%error)
      end do
    end associate
  end subroutine compute_response

  !> The exponents of the motion at all speeds.
  subroutine compute_stability(run, threads, store)
    type(variant_run_t), intent(inout) :: run
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store

    integer :: k

    associate (mechanism => run%results%mechanism, stability => run%results%found%stability)
      call find_stability_of(mechanism%structure_t, stability_request_of(run%results%model, &
        mechanism), &
        threads, store, stability)
      do k = 1, size(stability%at_speed)
        if (.not. allocated(stability%at_speed(k)%error)) cycle
        call name_parts(run%results%model, mechanism, stability%at_speed(k)%error)
      end do
    end associate
  end subroutine compute_stability

  !> The intervals of speed in which vibrations grow.
  subroutine compute_intervals(run, threads, store)
    type(variant_run_t), intent(inout) :: run
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store

    integer :: k

    associate (mechanism => run%results%mechanism, intervals => run%results%found%intervals)
      call find_intervals_of(mechanism%structure_t, intervals_request_of(run%results%model, &
        mechanism), &
        threads, store, intervals)
      do k = 1, size(intervals%gap)
        call name_part(run%results%model, mechanism, intervals%gap(k)%error)
      end do
    end associate
  end subroutine compute_intervals

  !> Bands and exponents at all speeds, and critical speeds.
  subroutine compute_campbell(run, threads, store)
    type(variant_run_t), intent(inout) :: run
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store

    integer :: k

    associate (mechanism => run%results%mechanism, campbell => run%results%found%campbell)
      call find_campbell_of(mechanism%structure_t, campbell_request_of(run%results%model, &
        mechanism), &
        threads, store, campbell)
      do k = 1, size(campbell%at_speed)
        if (.not. allocated(campbell%at_speed(k)%error)) cycle
        call name_parts(run%results%model, mechanism, campbell%at_speed(k)%error)
      end do
    end associate
  end subroutine compute_campbell

  !> Elastic motions in time at all speeds.
  subroutine compute_transient(run, store)
    type(variant_run_t), intent(inout) :: run
    type(link_store_t), intent(inout) :: store

    integer :: k

    associate (mechanism => run%results%mechanism, transient => run%results%found%transient)
      call find_transients(mechanism%structure_t, transient_request_of(run%results%model, &
        mechanism), store, transient)
      do k = 1, size(transient%at_speed)
        if (.not. allocated(transient%at_speed(k)%error)) cycle
        call name_parts(run%results%model, mechanism, transient%at_speed(k)%error)
      end do
    end associate
  end subroutine compute_transient

  !> Frequencies at every position that has a pose. Positions that need higher orders than the
  !! samples by which orders were chosen are solved again, with orders chosen for them.
  subroutine compute_sweep(run, threads, journal, group, store, error)
    type(variant_run_t), intent(inout) :: run
    integer, intent(in) :: threads
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: group
    type(link_store_t), intent(inout) :: store
    type(error_t), allocatable, intent(out) :: error

    integer :: attempt, made

    associate (mechanism => run%results%mechanism, positions => run%results%found%positions, &
        sweep => run%results%found%sweep)
      call begin_sweep_of(run)
      made = store%made
      do attempt = 1, most_attempts
        call new_vibration_models(mechanism%structure_t, positions, run%states, sweep%request, &
          sweep%request%accuracy, store, run%models, sweep%counts, error)
        if (allocated(error)) return
        if (attempt == 1) sweep%models = run%models
        run%solved = size(positions%states) - size(run%states)
        ! ARPACK serves one thread at a time: others would only wait.
        call run_tasks(run, 1, block_count(size(run%states)), &
          merge(1, threads, sweep%request%method == by_band), journal, &
          merge(group, -1, attempt == 1))
        ! Other ranks do not know which positions are solved again. They are few.
        if (allocated(run%announcement)) deallocate (run%announcement)
        run%states = missed_states(sweep, run%states)
        if (size(run%states) == 0 .or. was_interrupted()) exit
      end do
      sweep%counts%link_models = store%made - made
      call finish_sweep(sweep)
      call name_links(run%results%model, mechanism, sweep)
    end associate
  end subroutine compute_sweep

  !> The sweep without results, and its states by crank angle.
  subroutine begin_sweep_of(run)
    type(variant_run_t), intent(inout) :: run !! with positions

    type(mode_request_t) :: request

    associate (model => run%results%model, positions => run%results%found%positions)
      request = mode_request_of(model, run%results%mechanism)
      call begin_sweep(request, drawn_states(model, positions, request%speed), &
        size(positions%states), run%results%found%sweep)
      run%states = by_crank_angle(positions)
    end associate
  end subroutine begin_sweep_of

  !> Helps the leader with the blocks of a sweep that it has announced: does all that comes before
  !! them, and then the blocks that it hands out.
  subroutine help_with_sweep(run, threads)
    type(variant_run_t), intent(inout) :: run !! begun
    integer, intent(in) :: threads            !! number to use

    type(link_store_t) :: store
    type(error_t), allocatable :: error

    call find_positions_of(run%results, threads)
    call begin_sweep_of(run)
    associate (sweep => run%results%found%sweep)
      ! An error is that of the leader too, who does not call for help then.
      call new_vibration_models(run%results%mechanism%structure_t, run%results%found%positions, &
        run%states, sweep%request, sweep%request%accuracy, store, run%models, sweep%counts, error)
      call help_with_tasks(run, merge(1, threads, sweep%request%method == by_band))
    end associate
  end subroutine help_with_sweep

  !> Puts the name of the link before every error that is about one: a sweep knows its number only.
  subroutine name_links(model, mechanism, sweep)
    type(model_t), intent(in) :: model         !! its units
    type(mechanism_t), intent(in) :: mechanism !! with names
    type(sweep_t), intent(inout) :: sweep

    integer :: i, k

    do i = 1, size(sweep%results)
      if (.not. allocated(sweep%results(i)%outcome)) cycle
      do k = 1, size(sweep%results(i)%outcome)
        call name_parts(model, mechanism, sweep%results(i)%outcome(k)%error)
      end do
    end do
  end subroutine name_links

  !> Puts names into an error if there is one.
  subroutine name_parts(model, mechanism, error)
    type(model_t), intent(in) :: model                 !! its units
    type(mechanism_t), intent(in) :: mechanism         !! with names
    type(error_t), allocatable, intent(inout) :: error !! may be unallocated: no error

    if (allocated(error)) call name_part(model, mechanism, error)
  end subroutine name_parts

  !> Puts the name of the link before an error that is about one; of a block that leaves its link,
  !! both names; says what does not reach.
  subroutine name_part(model, mechanism, error)
    type(model_t), intent(in) :: model         !! its units
    type(mechanism_t), intent(in) :: mechanism !! with names
    type(error_t), intent(inout) :: error

    if (error%place%pin > 0) then
      error%text = "the block at "//mechanism%pin_names(error%place%pin)%text//" leaves '"// &
        mechanism%names(error%place%body)%text//"'"
    else if (abs(error%missing) > 0.0_wp) then
      ! One thread at a time makes texts: see above.
      !$omp critical (one_at_a_time)
      error%text = "out of reach: "//reach_words(model, mechanism, error)
      !$omp end critical (one_at_a_time)
    else if (error%place%body > 0) then
      error%text = "link '"//mechanism%names(error%place%body)%text//"': "//error%text
    end if
  end subroutine name_part

  !> Solves a block of the sweep.
  subroutine run_block(self, number)
    class(variant_run_t), intent(inout) :: self
    integer, intent(in) :: number

    call solve_block(self%results%mechanism%structure_t, self%results%found%positions, &
      self%models, block_of(self%states, number), self%results%found%sweep)
  end subroutine run_block

  !> The results of a block.
  subroutine pack_block(self, number, bytes)
    class(variant_run_t), intent(in) :: self
    integer, intent(in) :: number
    type(text_buffer_t), intent(inout) :: bytes

    integer, allocatable :: block(:)
    integer :: i

    block = block_of(self%states, number)
    do i = 1, size(block)
      call put_result(bytes, self%results%found%sweep%results(block(i)))
    end do
  end subroutine pack_block

  subroutine unpack_block(self, number, bytes)
    class(variant_run_t), intent(inout) :: self
    integer, intent(in) :: number
    character(len=*), intent(in) :: bytes

    integer, allocatable :: block(:)
    integer :: i, at

    block = block_of(self%states, number)
    at = 1
    do i = 1, size(block)
      call get_result(bytes, at, self%results%found%sweep%results(block(i)))
    end do
  end subroutine unpack_block

  !> Counts the states of a block and shows the progress.
  subroutine finish_block(self, number)
    class(variant_run_t), intent(inout) :: self
    integer, intent(in) :: number

    self%solved = self%solved + size(block_of(self%states, number))
    call show_progress(self%progress, self%solved, size(self%results%found%sweep%results))
  end subroutine finish_block

end module variant_runs
