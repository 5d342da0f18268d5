!> An error is a value: allocated when something went wrong, and carried up to `main`, which alone
!! prints and stops.
module errors
  implicit none (type, external)
  private

  public :: error_t, set_error

  type :: error_t
    character(len=:), allocatable :: message
  end type error_t

contains

  !> Makes `error` say `message`.
  pure subroutine set_error(error, message)
    type(error_t), allocatable, intent(inout) :: error
    character(len=*), intent(in) :: message

    if (.not. allocated(error)) allocate (error)
    error%message = message
  end subroutine set_error

end module errors
