!> Systems of ordinary differential equations, as those who integrate them see them.
module rate_systems
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: rate_system_t

  !> A system of differential equations `dy/dt = f(t, y)`.
  type, abstract :: rate_system_t
  contains
    procedure(rates_interface), deferred :: find_rates
  end type rate_system_t

  abstract interface
    !> Computes `f(t, y)`.
    subroutine rates_interface(self, time, state, rates, found)
      import :: rate_system_t, wp
      class(rate_system_t), intent(inout) :: self !! the system of equations
      real(wp), intent(in) :: time                !! t
      real(wp), intent(in) :: state(:)            !! (unknowns) y
      real(wp), intent(out) :: rates(:)           !! (unknowns) dy/dt; defined only if `found`
      logical, intent(out) :: found               !! false: no rates exist here; a shorter step is
                                                  !! tried
    end subroutine rates_interface
  end interface

end module rate_systems
