!> Mass and stiffness matrix of an eigenproblem in any form that can be multiplied by a vector.
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
      class(symmetric_pencil_t), intent(in) :: pencil !! M and K
      real(wp), intent(in) :: vector(:)               !! (unknowns) x
      real(wp), intent(out) :: mass_times(:)          !! (unknowns) M x
      real(wp), intent(out) :: stiffness_times(:)     !! (unknowns) K x
    end subroutine multiply
  end interface

end module symmetric_pencil
