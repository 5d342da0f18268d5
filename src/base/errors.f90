!> An error is a value: allocated when something went wrong, and carried up to `main`, which alone
!! prints and stops.
module errors
  implicit none (type, external)
  private

  public :: error_t, place_t, outcome_t, set_error, clear_outcome, rendered
  public :: error_of_input, error_of_files, error_of_interruption, error_of_reach, &
    error_of_dead_point, error_of_numerics

  !> What kind of thing went wrong: what the user wrote, the files of a run, an interruption, a
  !! position out of reach, a dead point, a computation that does not come to its end.
  integer, parameter :: error_of_input = 1, error_of_files = 2, error_of_interruption = 3, &
    error_of_reach = 4, error_of_dead_point = 5, error_of_numerics = 6

  !> Where it went wrong; without a file it is for the caller to say.
  type :: place_t
    character(len=:), allocatable :: file
    integer :: line = 0, column = 0 !! 0: the file as a whole
  end type place_t

  type :: error_t
    integer :: kind = error_of_input
    type(place_t) :: place
    character(len=:), allocatable :: text
  end type error_t

  !> Of many things that may fail, what has become of one: allocated if it has failed.
  type :: outcome_t
    type(error_t), allocatable :: error
  end type outcome_t

contains

  !> Makes `error` say `text`; what it said before is lost.
  pure subroutine set_error(error, kind, text, file, line, column)
    type(error_t), allocatable, intent(inout) :: error
    integer, intent(in) :: kind                    !! one of the error_of_… numbers
    character(len=*), intent(in) :: text
    character(len=*), intent(in), optional :: file !! path
    integer, intent(in), optional :: line, column  !! from 1; of a file

    if (allocated(error)) deallocate (error)
    allocate (error)
    error%kind = kind
    error%text = text
    if (present(file)) error%place%file = file
    if (present(line)) error%place%line = line
    if (present(column)) error%place%column = column
  end subroutine set_error

  !> Nothing has failed yet.
  elemental subroutine clear_outcome(outcome)
    type(outcome_t), intent(out) :: outcome
  end subroutine clear_outcome

  !> `my.deck:7:44: error: text`, with as much of the place as is known; an interruption is no
  !! error.
  pure function rendered(error) result(message)
    type(error_t), intent(in) :: error
    character(len=:), allocatable :: message

    character(len=32) :: numbers

    message = error%text
    if (error%kind /= error_of_interruption) message = "error: "//message
    if (.not. allocated(error%place%file)) return
    numbers = ""
    if (error%place%line > 0) write (numbers, "(a,i0,a,i0)") ":", error%place%line, ":", &
      error%place%column
    message = error%place%file//trim(numbers)//": "//message
  end function rendered

end module errors
