! src/runs/studies/ - studies as a run knows them: requests of a model, failures, warnings, memory.
! In: a `variant_run_t`. Out: its results; `findings_t`, `run_totals_t`. Begin with `study_t` here
! and `list_studies` in `study_list.f90`; `add_motion_study` in `study_of_motion.f90` is an example.
! Not here: the computations (`src/studies`), tables of the results (`src/reports`).

!> What a study is: how it is computed, what of it may fail, what it warns of, how much it took.
!!
!! A study is a record of procedures in a file of its own; `study_list` has all of them. Its results
!! are a component of `study_results_t`, from which the tables are made.
module study_types
  use errors, only: error_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use models, only: model_t
  use position_blocks, only: position_blocks_t
  use progress, only: progress_t
  use run_findings, only: findings_t
  use run_totals, only: run_totals_t
  use task_journal, only: journal_t
  use tokens, only: token_t
  use variant_results, only: variant_results_t
  use vibration_models, only: vibration_models_t
  implicit none (type, external)
  private

  public :: study_t, variant_run_t, memory_need_t, memory_needs_t, add_study, add_need, &
    bytes_of_number

  !> Bytes of a number.
  real(wp), parameter :: bytes_of_number = 8.0_wp

  !> A variant under way, with what its studies take.
  type :: variant_run_t
    type(variant_results_t) :: results
    type(position_blocks_t), allocatable :: blocks !! of a long list; the results are those of one
    type(vibration_models_t), allocatable :: models !! of all blocks; not allocated before the first
    type(progress_t) :: progress                   !! silent unless it is started
    integer :: threads = 1                         !! on which it is computed
    type(link_store_t), pointer :: store => null() !! own modes of links found before
    type(journal_t), pointer :: journal => null()  !! of the deck
    integer :: group = -1                          !! of the blocks in the journal; below 0: they
                                                   !! are not kept
    character(len=:), allocatable :: announcement  !! by which other ranks help with blocks; not
                                                   !! allocated: they do not
    character(len=12) :: under_way = ""            !! name of the study, if it keeps nothing in the
                                                   !! journal
    type(error_t), allocatable :: error            !! of the variant as a whole
  end type variant_run_t

  !> Memory of one part of a run.
  type :: memory_need_t
    real(wp) :: bytes = 0.0_wp
    character(len=:), allocatable :: what !! name of the part, in the plural, for the message
    type(token_t) :: place                !! the card that requests it
  end type memory_need_t

  !> Memory of a run; the first need is that of the results at positions.
  type :: memory_needs_t
    integer :: threads = 1 !! that will compute it
    integer :: kept = 0    !! positions whose results are kept at a time
    type(memory_need_t), allocatable :: list(:)
  end type memory_needs_t

  !> A study. Procedures that are not there have nothing to do.
  type :: study_t
    character(len=12) :: name = ""      !! as the records of reports have it
    logical :: keeps = .false.          !! results in the journal, for `--resume`
    procedure(computation), pointer, nopass :: compute => null()
    procedure(findings_at), pointer, nopass :: add_failures_at => null() !! of a position
    procedure(findings_of), pointer, nopass :: add_failures => null()
    procedure(findings_of), pointer, nopass :: add_warnings => null()    !! if a report needs it
    procedure(work_of), pointer, nopass :: add_work => null()
    procedure(memory_of), pointer, nopass :: add_memory => null()
  end type study_t

  abstract interface

    !> Computes the study. Several variants may be computed at the same time.
    subroutine computation(run)
      import :: variant_run_t
      type(variant_run_t), intent(inout), target :: run !! with the results of the studies before
    end subroutine computation

    !> Appends what failed at a position that has a pose.
    pure subroutine findings_at(variant, position, findings)
      import :: findings_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! computed
      integer, intent(in) :: position                !! number in the deck's list
      type(findings_t), intent(inout) :: findings    !! to which it is appended
    end subroutine findings_at

    !> Appends what failed, or warnings.
    pure subroutine findings_of(variant, findings)
      import :: findings_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! computed
      type(findings_t), intent(inout) :: findings    !! to which they are appended
    end subroutine findings_of

    !> Adds how much was computed, and between which limits the results are.
    pure subroutine work_of(variant, totals)
      import :: run_totals_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! computed, or without this study
      type(run_totals_t), intent(inout) :: totals    !! of this variant
    end subroutine work_of

    !> Appends the memory that the study takes, estimated on the safe side.
    subroutine memory_of(model, needs)
      import :: memory_needs_t, model_t
      type(model_t), intent(in) :: model           !! without errors, that may not need the study
      type(memory_needs_t), intent(inout) :: needs !! of the run
    end subroutine memory_of

  end interface

contains

  !> Appends a study.
  subroutine add_study(list, study)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which it is appended
    type(study_t), intent(in) :: study

    list = [list, study]
  end subroutine add_study

  !> Appends the memory of one part of a run.
  pure subroutine add_need(needs, place, what, bytes)
    type(memory_needs_t), intent(inout) :: needs !! to which it is appended
    type(token_t), intent(in) :: place           !! the card that requests it
    character(len=*), intent(in) :: what         !! name of the part, in the plural
    real(wp), intent(in) :: bytes

    type(memory_need_t), allocatable :: longer(:)
    integer :: count

    ! A constructor with the new one leaks its text (gfortran 12).
    count = size(needs%list)
    allocate (longer(count + 1))
    longer(:count) = needs%list
    longer(count + 1)%bytes = bytes
    longer(count + 1)%what = what
    longer(count + 1)%place = place
    call move_alloc(longer, needs%list)
  end subroutine add_need

end module study_types
