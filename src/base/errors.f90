!> An error is a value: allocated when something went wrong, and carried up to `main`, which alone
!! prints and stops.
module errors
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: error_t, place_t, outcome_t, set_error, clear_outcome, rendered
  public :: error_of_input, error_of_files, error_of_interruption, error_of_reach, &
    error_of_dead_point, error_of_numerics, error_of_writing, &
    error_of_memory

  !> Kinds of errors: wrong input, files of a run that cannot be read or written, an interruption, a
  !! position out of reach, a dead point, a numerical failure; a word that is wrong whatever the
  !! values of others, for which other variants need not be looked at; too little memory.
  integer, parameter :: error_of_input = 1, error_of_files = 2, error_of_interruption = 3, &
    error_of_reach = 4, error_of_dead_point = 5, error_of_numerics = 6, error_of_writing = 7, &
    error_of_memory = 8

  !> The place of an error. Without a file, the caller knows it.
  type :: place_t
    character(len=:), allocatable :: file
    integer :: line = 0, column = 0 !! from 1; 0: the file, or the line, as a whole
    integer :: body = 0             !! number of the link it is about, to be named where names are
                                    !! known; 0: none
    integer :: other = 0            !! number of a second link; 0: none
    integer :: pin = 0              !! number of the pin at which a block leaves this link; 0: none
  end type place_t

  type :: error_t
    integer :: kind = error_of_input      !! one of the error_of_… numbers
    type(place_t) :: place
    character(len=:), allocatable :: text !! without the place
    real(wp) :: missing = 0.0_wp          !! length by which its links are too short, negative: too
                                          !! long [m]; 0: none is said
  end type error_t

  !> An element of an array of tasks that may fail one by one: allocated if it has failed.
  type :: outcome_t
    type(error_t), allocatable :: error
  end type outcome_t

contains

  !> Makes an error; it replaces an earlier one.
  pure subroutine set_error(error, kind, text, file, line, column, body, pin, other, missing)
    type(error_t), allocatable, intent(inout) :: error !! allocated on return
    integer, intent(in) :: kind                    !! one of the error_of_… numbers
    character(len=*), intent(in) :: text           !! without the place
    character(len=*), intent(in), optional :: file !! path
    integer, intent(in), optional :: line, column  !! from 1, in the file
    integer, intent(in), optional :: body          !! number of the link it is about
    integer, intent(in), optional :: pin           !! number of the pin of a block on this link
    integer, intent(in), optional :: other         !! number of a second link
    real(wp), intent(in), optional :: missing      !! length by which they are too short [m]

    if (allocated(error)) deallocate (error)
    allocate (error)
    error%kind = kind
    error%text = text
    if (present(file)) error%place%file = file
    if (present(line)) error%place%line = line
    if (present(column)) error%place%column = column
    if (present(body)) error%place%body = body
    if (present(pin)) error%place%pin = pin
    if (present(other)) error%place%other = other
    if (present(missing)) error%missing = missing
  end subroutine set_error

  !> Makes outcomes those of tasks that have not failed.
  elemental subroutine clear_outcome(outcome)
    type(outcome_t), intent(out) :: outcome !! of one task
  end subroutine clear_outcome

  !> `my.deck:7:44: error: text`, with as much of the place as is known. An interruption is rendered
  !! without the word `error`.
  pure function rendered(error) result(message)
    type(error_t), intent(in) :: error !! with its text
    character(len=:), allocatable :: message

    character(len=32) :: numbers

    message = error%text
    if (error%kind /= error_of_interruption) message = "error: "//message
    if (.not. allocated(error%place%file)) return
    numbers = ""
    if (error%place%line > 0) write (numbers, "(a,i0)") ":", error%place%line
    if (error%place%line > 0 .and. error%place%column > 0) write (numbers, "(a,i0,a,i0)") ":", &
      error%place%line, ":", error%place%column
    message = error%place%file//trim(numbers)//": "//message
  end function rendered

end module errors
