!> Two symmetric matrices that can be multiplied with a vector, whatever they look like.
module symmetric_pencil
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: symmetric_pencil_t

  type, abstract :: symmetric_pencil_t
    integer :: unknowns = 0
  contains
    procedure(multiply), deferred :: multiply
  end type symmetric_pencil_t

  abstract interface
    !> `M x` and `K x`
    pure subroutine multiply(pencil, vector, mass_times, stiffness_times)
      import :: symmetric_pencil_t, wp
      class(symmetric_pencil_t), intent(in) :: pencil
      real(wp), intent(in) :: vector(:)
      real(wp), intent(out) :: mass_times(:), stiffness_times(:)
    end subroutine multiply
  end interface

end module symmetric_pencil
