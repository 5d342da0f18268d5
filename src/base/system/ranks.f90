!> The processes that compute a run together, and the messages between them.
!!
!! Rank 0, the leader, reads decks, writes files and talks to the user; the others do tasks for it.
!! There are two implementations of this interface, one of which is linked: `ranks_alone` for a
!! single process, `ranks_mpi` for those that `mpirun` starts. Messages are bytes with a number that
!! says what they are about. Threads may call all procedures at any time.
!!
!! (`impure` says nothing new: makedepf90 takes a line that begins with `module` for a module.)
module ranks
  implicit none (type, external)
  private

  public :: start_ranks, end_ranks, abandon_ranks, own_rank, rank_count, ranks_here, &
    send_message, receive_message, leader

  !> The rank that leads.
  integer, parameter :: leader = 0

  interface
    !> Joins the other processes.
    impure module subroutine start_ranks()
    end subroutine start_ranks

    !> Parts from the other processes, when all of them do so.
    impure module subroutine end_ranks()
    end subroutine end_ranks

    !> Ends all processes at once.
    impure module subroutine abandon_ranks(status)
      integer, intent(in) :: status !! exit status of the program
    end subroutine abandon_ranks

    !> Number of this process, from 0.
    impure module function own_rank() result(rank)
      integer :: rank
    end function own_rank

    !> Number of processes; 1 without MPI.
    impure module function rank_count() result(count)
      integer :: count
    end function rank_count

    !> Number of processes on this machine, which share its memory. All of them must call it at the
    !! same time; so it is called once, after `start_ranks`.
    impure module function ranks_here() result(count)
      integer :: count
    end function ranks_here

    !> Sends bytes to another process. Large ones are on their way only when it asks for them.
    impure module subroutine send_message(rank, topic, bytes)
      integer, intent(in) :: rank           !! to which they are sent
      integer, intent(in) :: topic          !! what they are about
      character(len=*), intent(in) :: bytes !! of any length
    end subroutine send_message

    !> Takes the next message on a topic if there is one; does not wait.
    impure module subroutine receive_message(topic, rank, bytes, found)
      integer, intent(in) :: topic                        !! what it is about
      integer, intent(out) :: rank                        !! that sent it
      character(len=:), allocatable, intent(inout) :: bytes !! of the message; unchanged without one
      logical, intent(out) :: found                       !! whether there was a message
    end subroutine receive_message
  end interface

end module ranks
