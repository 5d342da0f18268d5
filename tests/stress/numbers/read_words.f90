!> Reads words, a line each, and prints the doubles that they are as 16 hexadecimal digits, or how a message about them ends.
program read_words
  use errors, only: error_t
  use kinds, only: long, wp
  use numbers, only: read_real
  implicit none (type, external)

  type(error_t), allocatable :: error
  character(len=4096) :: word
  real(wp) :: value
  integer :: status

  do
    read (*, "(a)", iostat=status) word
    if (status /= 0) exit
    call read_real(trim(word), value, error)
    if (allocated(error)) then
      write (*, "(a)") error%text(index(error%text, "' ", back=.true.) + 2:)
    else
      write (*, "(z16.16)") transfer(value, 0_long)
    end if
  end do
end program read_words
