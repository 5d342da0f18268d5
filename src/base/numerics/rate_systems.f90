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
    procedure :: switches => no_switches
    procedure :: contacts => no_contacts
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

contains

  !> Arguments s of the loads that turn over, like tanh(s) or, against a velocity in the plane, like
  !! tanh(|s|) s/|s|. A step that is long against |s| = 1 sees little of it: where its error, by the
  !! place of its stages, is estimated as none, or where such a load passes zero just before and so
  !! has one course on both sides.
  function no_switches(self, state) result(switches)
    class(rate_system_t), intent(inout) :: self !! the system of equations
    real(wp), intent(in) :: state(:)         !! (unknowns) y
    real(wp), allocatable :: switches(:, :)  !! (2, always as many) s, or s and 0 [-]; empty: none,
                                             !! or no rates here

    allocate (switches(2, 0))
  end function no_switches

  !> Contacts that begin smoothly where a depth becomes positive. What is nothing before may be so
  !! short that a step would pass over it.
  function no_contacts(self, state) result(contacts)
    class(rate_system_t), intent(inout) :: self !! the system of equations
    real(wp), intent(in) :: state(:)         !! (unknowns) y
    real(wp), allocatable :: contacts(:, :)  !! (3, always as many) depth, its rate, and the width
                                             !! in which the contact begins; empty: none, or no
                                             !! rates here

    allocate (contacts(3, 0))
  end function no_contacts

end module rate_systems
