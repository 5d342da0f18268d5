!> Where the long studies of a variant keep their results: in the journal, beside the blocks of its
!! positions.
module study_keepers
  use byte_streams, only: byte_stream_t
  use kept_results, only: keeper_t
  use task_journal, only: journal_t, keep_task, recall_task
  implicit none (type, external)
  private

  public :: study_keeper_t
  public :: kept_response, kept_stability, kept_intervals, kept_campbell, kept_transient

  !> Numbers of the studies.
  integer, parameter :: kept_response = 1, kept_stability = 2, kept_intervals = 3, &
    kept_campbell = 4, kept_transient = 5

  !> Stages, rounds and numbers have room below these; what has none is not kept. Variants have
  !! groups for their blocks, below the first group of studies.
  integer, parameter :: stages = 4, rounds = 64, numbers = 2**18, first_group = 2**20

  type, extends(keeper_t) :: study_keeper_t
    type(journal_t), pointer :: journal => null() !! of the run
    integer :: group = -1                         !! of the variant; below 0: nothing is kept
    integer :: study = 0                          !! number
  contains
    procedure :: recall_bytes
    procedure :: keep_bytes
  end type study_keeper_t

contains

  !> The number of a result among those of all studies; 0: it has none.
  pure integer function number_of(self, place)
    type(study_keeper_t), intent(in) :: self
    integer, intent(in) :: place(3)

    number_of = 0
    if (self%group < 0 .or. self%group >= first_group .or. &
      any(place >= [stages, rounds, numbers])) return
    number_of = ((self%study*stages + place(1))*rounds + place(2))*numbers + place(3)
  end function number_of

  subroutine recall_bytes(self, place, stream, found)
    class(study_keeper_t), intent(inout) :: self
    integer, intent(in) :: place(3)
    type(byte_stream_t), intent(inout) :: stream
    logical, intent(out) :: found

    character(len=:), allocatable :: bytes
    integer :: number

    found = .false.
    number = number_of(self, place)
    if (number > 0) call recall_task(self%journal, [first_group + self%group, number], bytes, found)
    if (found) call stream%open(bytes)
  end subroutine recall_bytes

  subroutine keep_bytes(self, place, stream)
    class(study_keeper_t), intent(inout) :: self
    integer, intent(in) :: place(3)
    type(byte_stream_t), intent(in) :: stream

    integer :: number

    number = number_of(self, place)
    if (number > 0) call keep_task(self%journal, [first_group + self%group, number], stream%bytes)
  end subroutine keep_bytes

end module study_keepers
