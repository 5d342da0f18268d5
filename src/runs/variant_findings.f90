!> What a computed variant tells beside its tables: failures, warnings, how much was computed.
module variant_findings
  use errors, only: error_of_numerics, error_of_reach, error_t, set_error
  use friction_words, only: lock_words
  use locked_rows, only: is_locked_at, lock_at
  use models, only: has_law, needs_study
  use run_findings, only: findings_t
  use run_totals, only: run_totals_t
  use study_list, only: list_studies
  use study_findings, only: note_at_position, note_failure
  use study_types, only: study_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: find_failures, find_warnings, totals_of

contains

  !> Appends the positions without a pose or forces, and what failed of the studies; or the variant
  !! as a whole, if its linkage closes at no crank angle.
  subroutine find_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant !! computed
    type(findings_t), intent(inout) :: findings    !! to which they are appended

    type(error_t), allocatable :: error
    type(study_t), allocatable :: studies(:)
    integer :: i, k

    if (.not. variant%found%class%closes) then
      if (variant%found%positions%before > 0) return
      call set_error(error, error_of_reach, variant%unreachable)
      call note_failure(variant, "variant", error, findings)
      return
    end if
    call list_studies(studies)
    associate (positions => variant%found%positions)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)))
          if (allocated(state%error)) then
            if (has_law(variant%model)) then
              call note_at_position(variant, i, state%error, findings)
            else
              call note_failure(variant, "position", state%error, findings, &
                position=positions%before + i, crank=positions%crank(i))
            end if
            cycle
          end if
        end associate
        call note_locks(variant, i, findings)
        do k = 1, size(studies)
          if (associated(studies(k)%add_failures_at)) call studies(k)%add_failures_at(variant, i, &
            findings)
        end do
      end do
    end associate
    do k = 1, size(studies)
      if (associated(studies(k)%add_failures)) call studies(k)%add_failures(variant, findings)
    end do
  end subroutine find_failures

  !> Speeds at which friction locks the linkage at a position.
  pure subroutine note_locks(variant, position, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position !! number in the deck's list, with a pose
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    integer :: k

    do k = 1, size(variant%model%speed%value)
      if (.not. is_locked_at(variant, "", position, k)) cycle
      call set_error(error, error_of_numerics, lock_words(variant%model, variant%mechanism, &
        lock_at(variant, "", position, k)))
      if (has_law(variant%model)) then
        call note_at_position(variant, position, error, findings)
      else
        call note_failure(variant, "forces", error, findings, speed=k, &
          crank=variant%found%positions%crank(position))
      end if
    end do
  end subroutine note_locks

  !> Appends warnings about results: static divergence, large deflections, accuracy that is not
  !! reached, unstable steady states.
  subroutine find_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant !! computed
    type(findings_t), intent(inout) :: findings    !! to which they are appended

    type(study_t), allocatable :: studies(:)
    integer :: k

    call list_studies(studies)
    do k = 1, size(studies)
      if (associated(studies(k)%add_warnings) .and. needs_study(variant%model, &
        studies(k)%name)) call studies(k)%add_warnings(variant, findings)
    end do
  end subroutine find_warnings

  !> Totals of one variant or a block of its positions, without times.
  function totals_of(variant) result(totals)
    type(variant_results_t), intent(in) :: variant !! computed
    type(run_totals_t) :: totals

    type(study_t), allocatable :: studies(:)
    integer :: k

    associate (positions => variant%found%positions)
      totals%variants = merge(1, 0, positions%before == 0)
      totals%rows = size(positions%crank)
      totals%positions = size(positions%states) - positions%repeated
      totals%kinematic_solutions = size(positions%states)
    end associate
    call list_studies(studies)
    do k = 1, size(studies)
      if (associated(studies(k)%add_work)) call studies(k)%add_work(variant, totals)
    end do
  end function totals_of

end module variant_findings
