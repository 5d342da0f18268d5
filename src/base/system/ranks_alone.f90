!> A single process: nobody to send anything to.
submodule (ranks) ranks_alone
  implicit none (type, external)

contains

  impure module subroutine start_ranks()
  end subroutine start_ranks

  impure module subroutine end_ranks()
  end subroutine end_ranks

  impure module subroutine abandon_ranks(status)
    integer, intent(in) :: status

    associate (nobody => status)
    end associate
  end subroutine abandon_ranks

  impure module function own_rank() result(rank)
    integer :: rank

    rank = leader
  end function own_rank

  impure module function rank_count() result(count)
    integer :: count

    count = 1
  end function rank_count

  impure module function ranks_here() result(count)
    integer :: count

    count = 1
  end function ranks_here

  impure module subroutine send_message(rank, topic, bytes)
    integer, intent(in) :: rank, topic
    character(len=*), intent(in) :: bytes

    associate (nowhere => rank, none => topic, lost => bytes)
    end associate
  end subroutine send_message

  impure module subroutine receive_message(topic, rank, bytes, found)
    integer, intent(in) :: topic
    integer, intent(out) :: rank
    character(len=:), allocatable, intent(inout) :: bytes
    logical, intent(out) :: found

    rank = leader
    found = .false.
    associate (none => topic, same => bytes)
    end associate
  end subroutine receive_message

end submodule ranks_alone
