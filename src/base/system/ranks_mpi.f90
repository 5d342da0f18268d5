!> The processes that `mpirun` starts, joined by MPI. Only `make MPI=yes` compiles and links this.
!!
!! One thread at a time calls MPI (MPI_THREAD_SERIALIZED, which every implementation offers). Nobody
!! waits inside MPI but for messages that are there: a process with nothing to do sleeps between two
!! looks, and its processor is free.
submodule (ranks) ranks_mpi
  use mpi_f08, only: mpi_abort, mpi_any_source, mpi_byte, mpi_comm, mpi_comm_free, mpi_comm_rank, &
    mpi_comm_size, mpi_comm_split_type, mpi_comm_type_shared, mpi_comm_world, mpi_finalize, &
    mpi_get_count, mpi_info_null, mpi_init_thread, mpi_iprobe, mpi_recv, mpi_send, mpi_status, &
    mpi_thread_serialized
  implicit none (type, external)

contains

  impure module subroutine start_ranks()
    integer :: provided

    call mpi_init_thread(mpi_thread_serialized, provided)
  end subroutine start_ranks

  impure module subroutine end_ranks()
    call mpi_finalize()
  end subroutine end_ranks

  impure module subroutine abandon_ranks(status)
    integer, intent(in) :: status

    call mpi_abort(mpi_comm_world, status)
  end subroutine abandon_ranks

  impure module function own_rank() result(rank)
    integer :: rank

    !$omp critical (messages)
    call mpi_comm_rank(mpi_comm_world, rank)
    !$omp end critical (messages)
  end function own_rank

  impure module function rank_count() result(count)
    integer :: count

    !$omp critical (messages)
    call mpi_comm_size(mpi_comm_world, count)
    !$omp end critical (messages)
  end function rank_count

  impure module function ranks_here() result(count)
    integer :: count

    type(mpi_comm) :: neighbours

    !$omp critical (messages)
    call mpi_comm_split_type(mpi_comm_world, mpi_comm_type_shared, 0, mpi_info_null, neighbours)
    call mpi_comm_size(neighbours, count)
    call mpi_comm_free(neighbours)
    !$omp end critical (messages)
  end function ranks_here

  impure module subroutine send_message(rank, topic, bytes)
    integer, intent(in) :: rank, topic
    character(len=*), intent(in) :: bytes

    !$omp critical (messages)
    call mpi_send(bytes, len(bytes), mpi_byte, rank, topic, mpi_comm_world)
    !$omp end critical (messages)
  end subroutine send_message

  impure module subroutine receive_message(topic, rank, bytes, found)
    integer, intent(in) :: topic
    integer, intent(out) :: rank
    character(len=:), allocatable, intent(inout) :: bytes
    logical, intent(out) :: found

    type(mpi_status) :: status
    integer :: length

    rank = leader
    !$omp critical (messages)
    call mpi_iprobe(mpi_any_source, topic, mpi_comm_world, found, status)
    if (found) then
      call mpi_get_count(status, mpi_byte, length)
      rank = status%mpi_source
      if (allocated(bytes)) deallocate (bytes)
      allocate (character(len=length) :: bytes)
      call mpi_recv(bytes, length, mpi_byte, rank, topic, mpi_comm_world, status)
    end if
    !$omp end critical (messages)
  end subroutine receive_message

end submodule ranks_mpi
