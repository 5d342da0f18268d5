!> Computes one variant of a deck; a deck without VARY has just one.
module variant_runs
  use drawn_cranks, only: starting_cranks
  use errors, only: error_of_reach, error_t
  use home_ranges, only: find_home_range
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use linkage_study, only: classify_linkage
  use mechanisms, only: new_mechanism
  use models, only: has_law, model_t, needs_positions, needs_study, report_number
  use named_parts, only: name_parts
  use position_study, only: find_all_positions
  use positions, only: refuse_change_points
  use reach_texts, only: open_linkage_text
  use structures, only: holds_at_change_points
  use study_list, only: is_made, list_studies
  use study_of_frequencies, only: help_with_sweep
  use study_types, only: study_t, variant_run_t
  use task_journal, only: journal_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: variant_run_t, begin_variant_run, compute_variant, help_with_variant

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
    type(journal_t), intent(inout), target :: journal !! of the deck
    integer, intent(in) :: group                 !! of the blocks in the journal; below 0: they are
                                                 !! not kept
    type(link_store_t), intent(inout), target :: store !! own modes of links found before
    type(error_t), allocatable, intent(out) :: error !! of the variant as a whole

    type(study_t), allocatable :: studies(:)
    integer :: i

    run%threads = threads
    run%journal => journal
    run%group = group
    run%store => store
    call place_variant(run%results, threads)
    call list_studies(studies)
    do i = 1, size(studies)
      if (.not. is_made(studies(i), run%results%model)) cycle
      if (was_interrupted()) return
      call studies(i)%compute(run)
      if (allocated(run%error)) then
        call move_alloc(run%error, error)
        return
      end if
    end do
  end subroutine compute_variant

  !> Helps the leader with the blocks of frequencies that it has announced.
  subroutine help_with_variant(run, threads)
    type(variant_run_t), intent(inout) :: run !! begun
    integer, intent(in) :: threads            !! number to use

    run%threads = threads
    call find_positions_of(run%results, threads)
    call help_with_sweep(run)
  end subroutine help_with_variant

  !> The positions that the reports need, what kind of linkage it is, and its range.
  subroutine place_variant(variant, threads)
    type(variant_results_t), intent(inout) :: variant !! with model and mechanism
    integer, intent(in) :: threads

    associate (model => variant%model, linkage => variant%mechanism%linkage, &
        found => variant%found)
      call find_positions_of(variant, threads)
      call name_positions(variant)
      if (variant%mechanism%is_four_bar) then
        call classify_linkage(variant%mechanism%four_bar, found%class)
        call explain_positions(variant)
      end if
      if (found%class%closes .and. .not. (model%is_structure .or. has_law(model))) &
        call find_home_range(linkage, starting_cranks(model, linkage), model%crank%value, &
        has_gaps(variant), found%home)
    end associate
  end subroutine place_variant

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
        if ((needs_study(model, "joints") .or. &
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
