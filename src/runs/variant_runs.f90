!> Computes one variant of a deck; a deck without VARY has just one.
module variant_runs
  use byte_streams, only: byte_stream_t
  use drawn_cranks, only: starting_cranks
  use errors, only: error_of_reach, error_t
  use home_ranges, only: find_home_range
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use kinematics_study, only: widen_transmission_range
  use linkage_study, only: classify_linkage
  use mechanisms, only: new_mechanism
  use models, only: has_law, model_t, needs_positions, needs_study, report_number
  use named_parts, only: name_parts
  use position_blocks, only: choose_block
  use position_study, only: find_all_positions, place_positions
  use positions, only: positions_t, refuse_change_points
  use reach_texts, only: open_linkage_text
  use structures, only: holds_at_change_points
  use study_list, only: list_studies
  use study_of_frequencies, only: help_with_sweep
  use study_types, only: study_t, variant_run_t
  use task_journal, only: journal_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: variant_run_t, begin_variant_run, compute_variant, begin_computing, block_count, &
    compute_block, help_with_variant

contains

  !> Puts a model and its mechanism in place.
  subroutine begin_variant_run(run, model)
    type(variant_run_t), intent(inout) :: run !! new
    type(model_t), intent(in) :: model        !! without errors

    run%results%model = model
    run%results%mechanism = new_mechanism(model)
  end subroutine begin_variant_run

  !> Makes all studies that a variant requests, at all positions. Several variants may be computed
  !! at the same time.
  !!
  !! Errors: the own modes of a link could not be found.
  subroutine compute_variant(run, threads, journal, group, store, error)
    type(variant_run_t), intent(inout) :: run    !! begun; on return with all results
    integer, intent(in) :: threads               !! on which it is computed
    type(journal_t), intent(inout), target :: journal !! of the deck
    integer, intent(in) :: group                 !! of the blocks in the journal; below 0: they are
                                                 !! not kept
    type(link_store_t), intent(inout), target :: store !! own modes of links found before
    type(error_t), allocatable, intent(out) :: error !! of the variant as a whole

    call begin_computing(run, threads, journal, group, store)
    call compute_block(run, 1, error)
  end subroutine compute_variant

  !> Begins a variant of which `compute_block` makes the studies.
  subroutine begin_computing(run, threads, journal, group, store)
    type(variant_run_t), intent(inout) :: run         !! begun, with its blocks if there are several
    integer, intent(in) :: threads                    !! as for `compute_variant`
    type(journal_t), intent(inout), target :: journal !! likewise
    integer, intent(in) :: group                      !! likewise
    type(link_store_t), intent(inout), target :: store !! likewise

    run%threads = threads
    run%journal => journal
    run%group = group
    run%store => store
    call survey_positions(run)
  end subroutine begin_computing

  !> Number of blocks of positions.
  pure function block_count(run) result(count)
    type(variant_run_t), intent(in) :: run !! under way
    integer :: count

    count = 1
    if (allocated(run%blocks)) count = run%blocks%count
  end function block_count

  !> Makes all studies at the positions of a block, in the order of blocks.
  !!
  !! Errors: as for `compute_variant`.
  subroutine compute_block(run, number, error)
    type(variant_run_t), intent(inout) :: run    !! begun; on return with results of the block
    integer, intent(in) :: number                !! of the block, from 1
    type(error_t), allocatable, intent(out) :: error !! of the variant as a whole

    type(study_t), allocatable :: studies(:)
    integer :: i

    if (was_interrupted()) return
    if (block_count(run) > 1) call place_block(run, number)
    call name_positions(run%results)
    if (run%results%mechanism%is_four_bar) call explain_positions(run%results)
    call list_studies(studies)
    do i = 1, size(studies)
      if (.not. needs_study(run%results%model, studies(i)%name)) cycle
      if (was_interrupted()) return
      run%under_way = studies(i)%name
      if (studies(i)%keeps) run%under_way = ""
      if (associated(studies(i)%compute)) call studies(i)%compute(run)
      if (allocated(run%error)) then
        call move_alloc(run%error, error)
        return
      end if
    end do
  end subroutine compute_block

  !> Helps the leader with the blocks of frequencies that it has announced.
  subroutine help_with_variant(run, threads, block, stream)
    type(variant_run_t), intent(inout) :: run !! begun, with its blocks if there are several
    integer, intent(in) :: threads            !! number to use
    integer, intent(in) :: block              !! number, from 1
    type(byte_stream_t), intent(inout) :: stream !! of the announcement, as far as it is read

    run%threads = threads
    call place_block(run, block)
    call help_with_sweep(run, stream)
  end subroutine help_with_variant

  !> Finds all positions, block by block, and what is to be known of all before any row is written:
  !! what kind of linkage it is, its transmission angles, its range. Those of the last block stay.
  subroutine survey_positions(run)
    type(variant_run_t), intent(inout) :: run !! begun

    logical :: has_gaps
    integer :: i

    associate (found => run%results%found, mechanism => run%results%mechanism)
      has_gaps = report_number(run%results%model, "linkage") > 0
      do i = 1, block_count(run)
        call place_block(run, i)
        if (.not. has_gaps) has_gaps = is_out_of_reach(found%positions)
        if (allocated(mechanism%four_bar)) call widen_transmission_range(mechanism%linkage, &
          mechanism%four_bar, found%positions, found%transmission)
        if (was_interrupted()) return
      end do
      if (mechanism%is_four_bar) call classify_linkage(mechanism%four_bar, found%class)
      if (allocated(run%blocks)) run%results%model = run%blocks%model
      associate (model => run%results%model)
        if (found%class%closes .and. .not. (model%is_structure .or. has_law(model))) &
          call find_home_range(mechanism%linkage, starting_cranks(model, mechanism%linkage), &
          model%crank%value, has_gaps, found%home)
      end associate
    end associate
  end subroutine survey_positions

  !> The positions of a block that the reports need.
  subroutine place_block(run, number)
    type(variant_run_t), intent(inout) :: run !! begun
    integer, intent(in) :: number             !! of the block

    real(wp) :: none(0)

    associate (variant => run%results, model => run%results%model, &
        linkage => run%results%mechanism%linkage)
      if (allocated(run%blocks)) then
        call choose_block(run%blocks, number, variant%model, variant%found%positions)
        call place_positions(linkage, run%threads, variant%found%positions)
      else if (needs_positions(model)) then
        call find_all_positions(linkage, model%crank%value, run%threads, &
          variant%found%positions, model%time%value)
      else
        ! Crank angles that no report needs must not fail.
        call find_all_positions(linkage, none, run%threads, variant%found%positions)
      end if
      if (any([needs_study(model, "joints"), needs_study(model, "friction"), &
        needs_study(model, "frequencies")]) .and. .not. holds_at_change_points(variant%mechanism)) &
        call refuse_change_points(variant%found%positions)
    end associate
  end subroutine place_block

  !> Whether positions are out of reach of the linkage as a whole.
  pure function is_out_of_reach(positions) result(is)
    type(positions_t), intent(in) :: positions !! with their states
    logical :: is

    integer :: i

    is = .false.
    do i = 1, size(positions%states)
      if (is) return
      associate (state => positions%states(i))
        if (allocated(state%error)) is = state%error%kind == error_of_reach .and. &
          state%error%place%pin == 0
      end associate
    end do
  end function is_out_of_reach

  !> Puts names into the errors of positions.
  subroutine name_positions(variant)
    type(variant_results_t), intent(inout) :: variant !! with positions

    integer :: i

    do i = 1, size(variant%found%positions%states)
      call name_parts(variant, variant%found%positions%states(i)%error)
    end do
  end subroutine name_positions

  !> Says of a linkage that closes nowhere why, at all its positions. There are such in decks with
  !! VARY only.
  subroutine explain_positions(variant)
    type(variant_results_t), intent(inout) :: variant !! with positions and class

    integer :: i

    associate (states => variant%found%positions%states)
      if (variant%found%class%closes) return
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

end module variant_runs
