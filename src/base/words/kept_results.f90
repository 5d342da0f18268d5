!> Results of a long study that are kept, for a run that goes on after an interruption.
!!
!! A study asks for a result at the place where it would find it, and goes on as if it had: what
!! else it makes on the way is made again, and the bytes of its tables are those of a run in one
!! piece.
module kept_results
  use byte_streams, only: byte_stream_t
  use interruption, only: was_interrupted
  implicit none (type, external)
  private

  public :: keeper_t, recall_result, keep_result

  !> What has results of an earlier run, and keeps those of this one. One thread at a time calls it.
  type, abstract :: keeper_t
  contains
    procedure(recall_interface), deferred :: recall_bytes
    procedure(keep_interface), deferred :: keep_bytes
  end type keeper_t

  abstract interface

    subroutine recall_interface(self, place, stream, found)
      import :: byte_stream_t, keeper_t
      class(keeper_t), intent(inout) :: self
      integer, intent(in) :: place(3)              !! stage, round and number in the study, from 1
      type(byte_stream_t), intent(inout) :: stream !! new; on return the result is read from it
      logical, intent(out) :: found                !! whether there is one
    end subroutine recall_interface

    subroutine keep_interface(self, place, stream)
      import :: byte_stream_t, keeper_t
      class(keeper_t), intent(inout) :: self
      integer, intent(in) :: place(3)           !! likewise
      type(byte_stream_t), intent(in) :: stream !! to which the result is written
    end subroutine keep_interface

  end interface

contains

  !> Finds a result of an earlier run.
  subroutine recall_result(keeper, place, stream, found)
    class(keeper_t), intent(inout), optional :: keeper !! absent: nothing is kept
    integer, intent(in) :: place(3)                    !! stage, round and number, from 1
    type(byte_stream_t), intent(inout) :: stream       !! new
    logical, intent(out) :: found

    found = .false.
    if (.not. present(keeper)) return
    !$omp critical (one_at_a_time)
    call keeper%recall_bytes(place, stream, found)
    !$omp end critical (one_at_a_time)
  end subroutine recall_result

  !> Keeps a result, unless it is one of an earlier run or the run was interrupted on the way to it.
  subroutine keep_result(keeper, place, stream)
    class(keeper_t), intent(inout), optional :: keeper
    integer, intent(in) :: place(3)
    type(byte_stream_t), intent(in) :: stream          !! to which it is written, or that it was
                                                       !! read from

    if (.not. present(keeper)) return
    if (stream%reads .or. was_interrupted()) return
    !$omp critical (one_at_a_time)
    call keeper%keep_bytes(place, stream)
    !$omp end critical (one_at_a_time)
  end subroutine keep_result

end module kept_results
