!> The loop of the worker ranks: they wait for jobs that the leader announces, and help.
!!
!! An announcement is complete in itself: the deck, and what the job is about. A new kind of job has
!! a word of its own, and a case in `serve_leader`.
module rank_service
  use byte_streams, only: byte_stream_t
  use deck_runs, only: blocks_announced, help_with_blocks
  use omp_lib, only: omp_get_wtime
  use kinds, only: wp
  use pauses, only: pause_for
  use rank_tasks, only: await_message, drop_results, look_again, send_stream, &
    topic_of_commands, topic_of_farewells
  use ranks, only: abandon_ranks, end_ranks, leader, rank_count, receive_message, send_message
  use text, only: string_t
  use variant_tasks, only: help_with_variants, variants_announced
  implicit none (type, external)
  private

  public :: serve_leader, dismiss_ranks

  !> First word of what ends the service.
  character(len=*), parameter :: end_announced = "end"

contains

  !> Helps with every job that the leader announces, until it dismisses all ranks.
  subroutine serve_leader(settings)
    type(string_t), intent(in) :: settings(:) !! of the command line

    character(len=:), allocatable :: bytes, word
    type(byte_stream_t) :: stream
    integer :: threads

    do
      call await_message(topic_of_commands, bytes)
      call stream%open(bytes)
      call stream%pass(threads)
      call stream%pass_text(word)
      select case (word)
      case (variants_announced)
        call help_with_variants(stream, settings, threads)
      case (blocks_announced)
        call help_with_blocks(stream, settings, threads)
      case (end_announced)
        exit
      end select
    end do
    call send_message(leader, topic_of_farewells, word)
    call end_ranks()
  end subroutine serve_leader

  !> Ends the service of all other ranks and parts from them. If they do not answer in time, all
  !! processes are ended at once, this one too.
  subroutine dismiss_ranks(status, patience)
    integer, intent(in) :: status    !! exit status of the program
    real(wp), intent(in) :: patience !! for ranks that do a task that nobody needs any more [s]

    type(byte_stream_t) :: stream
    character(len=:), allocatable :: word
    real(wp) :: start
    integer :: rank, gone
    logical :: found

    call stream%add(0)
    call stream%add_text(end_announced)
    do rank = 0, rank_count() - 1
      if (rank /= leader) call send_stream(rank, topic_of_commands, stream)
    end do
    gone = 1
    start = omp_get_wtime()
    do while (gone < rank_count())
      call drop_results()
      call receive_message(topic_of_farewells, rank, word, found)
      if (found) then
        gone = gone + 1
      else if (omp_get_wtime() - start > patience) then
        call abandon_ranks(status)
        return
      else
        call pause_for(look_again)
      end if
    end do
    call end_ranks()
  end subroutine dismiss_ranks

end module rank_service
