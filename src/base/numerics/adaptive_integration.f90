!> Integration of ordinary differential equations by a Runge-Kutta method of order 8 with step
!! control: `rk8pd` of the GNU Scientific Library (Prince and Dormand 1981, order 8 with an error
!! estimate of order 7).
!!
!! The only module that handles pointers of C. The library computes in double precision, whatever
!! the working precision.
module adaptive_integration
  use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_f_pointer, c_funloc, c_funptr, &
    c_int, c_loc, c_null_funptr, c_null_ptr, c_ptr, c_size_t
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: rate_system_t, integrator_t, open_integrator, close_integrator, advance, step_by

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

  !> The library's data between steps. To be closed after use, and never copied.
  type :: integrator_t
    integer(long) :: steps = 0_long       !! accepted so far
    integer(long) :: evaluations = 0_long !! of rates so far
    real(wp) :: step = 0.0_wp             !! length of the next step that the error allows, in the
                                          !! unit of time
    integer, private :: unknowns = 0
    type(c_ptr), private :: stepper = c_null_ptr, control = c_null_ptr, evolution = c_null_ptr
  end type integrator_t

  !> Passed through the library to `rates_for_library`.
  type :: request_t
    class(rate_system_t), pointer :: system => null()
    integer :: unknowns = 0
    integer :: evaluations = 0
  end type request_t

  !> gsl_odeiv2_system. Passed by its address, so that the compiler does not assume data behind it
  !! to be unchanged by the library.
  type, bind(c) :: library_system_t
    type(c_funptr) :: rates = c_null_funptr
    type(c_funptr) :: jacobian = c_null_funptr
    integer(c_size_t) :: unknowns = 0_c_size_t
    type(c_ptr) :: parameters = c_null_ptr
  end type library_system_t

  !> Status values of the library that are used here (gsl_errno.h).
  integer(c_int), parameter :: success = 0_c_int, failure = -1_c_int

  interface
    !> Actually a variable of the library that points to the method. If it were declared as one,
    !! gfortran 12 would define a second variable.
    subroutine gsl_odeiv2_step_rk8pd() bind(c)
    end subroutine gsl_odeiv2_step_rk8pd

    function gsl_set_error_handler_off() bind(c) result(previous)
      import :: c_funptr
      type(c_funptr) :: previous
    end function gsl_set_error_handler_off

    function gsl_odeiv2_step_alloc(method, unknowns) bind(c) result(stepper)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: method
      integer(c_size_t), value :: unknowns
      type(c_ptr) :: stepper
    end function gsl_odeiv2_step_alloc

    function gsl_odeiv2_control_scaled_new(absolute, relative, of_state, of_change, scale, &
      unknowns) bind(c) result(control)
      import :: c_double, c_ptr, c_size_t
      real(c_double), value :: absolute, relative, of_state, of_change
      real(c_double), intent(in) :: scale(*)
      integer(c_size_t), value :: unknowns
      type(c_ptr) :: control
    end function gsl_odeiv2_control_scaled_new

    function gsl_odeiv2_evolve_alloc(unknowns) bind(c) result(evolution)
      import :: c_ptr, c_size_t
      integer(c_size_t), value :: unknowns
      type(c_ptr) :: evolution
    end function gsl_odeiv2_evolve_alloc

    function gsl_odeiv2_evolve_apply(evolution, control, stepper, system, time, limit, step, &
      state) bind(c) result(status)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: evolution, control, stepper, system
      real(c_double), intent(inout) :: time
      real(c_double), value :: limit
      real(c_double), intent(inout) :: step, state(*)
      integer(c_int) :: status
    end function gsl_odeiv2_evolve_apply

    function gsl_odeiv2_evolve_reset(evolution) bind(c) result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: evolution
      integer(c_int) :: status
    end function gsl_odeiv2_evolve_reset

    function gsl_odeiv2_step_reset(stepper) bind(c) result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: stepper
      integer(c_int) :: status
    end function gsl_odeiv2_step_reset

    function gsl_odeiv2_step_apply(stepper, time, step, state, error, rates_before, rates_after, &
      system) bind(c) result(status)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: stepper, rates_before, rates_after, system
      real(c_double), value :: time, step
      real(c_double), intent(inout) :: state(*), error(*)
      integer(c_int) :: status
    end function gsl_odeiv2_step_apply

    subroutine gsl_odeiv2_step_free(stepper) bind(c)
      import :: c_ptr
      type(c_ptr), value :: stepper
    end subroutine gsl_odeiv2_step_free

    subroutine gsl_odeiv2_control_free(control) bind(c)
      import :: c_ptr
      type(c_ptr), value :: control
    end subroutine gsl_odeiv2_control_free

    subroutine gsl_odeiv2_evolve_free(evolution) bind(c)
      import :: c_ptr
      type(c_ptr), value :: evolution
    end subroutine gsl_odeiv2_evolve_free
  end interface

contains

  !> Prepares an integrator. It chooses steps such that the estimated error of every unknown is
  !! below `tolerance (scale + |y| + h |dy/dt|)`.
  !!
  !! Errors: not enough memory.
  subroutine open_integrator(integrator, scale, tolerance, first_step, error)
    type(integrator_t), intent(out) :: integrator    !! to be closed by `close_integrator`
    real(wp), intent(in) :: scale(:)                 !! (unknowns) in their units; values small
                                                     !! against it need no accuracy
    real(wp), intent(in) :: tolerance                !! relative [-]
    real(wp), intent(in) :: first_step               !! tried first, in the unit of time
    type(error_t), allocatable, intent(out) :: error !! allocated if memory is short

    type(c_funptr) :: previous
    integer(c_size_t) :: unknowns
    real(c_double) :: allowed

    ! The library's own handler would print and abort.
    previous = gsl_set_error_handler_off()
    integrator%unknowns = size(scale)
    integrator%step = first_step
    unknowns = size(scale, kind=c_size_t)
    allowed = real(tolerance, c_double)
    integrator%stepper = gsl_odeiv2_step_alloc(order_eight(), unknowns)
    integrator%control = gsl_odeiv2_control_scaled_new(allowed, allowed, 1.0_c_double, &
      1.0_c_double, real(scale, c_double), unknowns)
    integrator%evolution = gsl_odeiv2_evolve_alloc(unknowns)
    if (c_associated(integrator%stepper) .and. c_associated(integrator%control) .and. &
      c_associated(integrator%evolution)) return
    call close_integrator(integrator)
    call set_error(error, error_of_numerics, "not enough memory for the integration")
  end subroutine open_integrator

  !> The method of order 8, read from the library's variable.
  function order_eight() result(method)
    type(c_ptr) :: method

    type(c_ptr), pointer :: kept
    type(c_ptr) :: address

    address = transfer(c_funloc(gsl_odeiv2_step_rk8pd), address)
    call c_f_pointer(address, kept)
    method = kept
  end function order_eight

  !> Frees the library's memory.
  subroutine close_integrator(integrator)
    type(integrator_t), intent(inout) :: integrator !! may be closed already

    if (c_associated(integrator%evolution)) call gsl_odeiv2_evolve_free(integrator%evolution)
    if (c_associated(integrator%control)) call gsl_odeiv2_control_free(integrator%control)
    if (c_associated(integrator%stepper)) call gsl_odeiv2_step_free(integrator%stepper)
    integrator%evolution = c_null_ptr
    integrator%control = c_null_ptr
    integrator%stepper = c_null_ptr
  end subroutine close_integrator

  !> Takes one step, as long as the error allows but not beyond `limit`, which is met exactly. State
  !! and time may have been changed since the last step.
  !!
  !! Errors: no step is short enough, because the rates are not smooth or do not exist. State and
  !! time are unchanged then.
  subroutine advance(integrator, system, time, limit, state, error)
    type(integrator_t), intent(inout) :: integrator       !! open
    class(rate_system_t), intent(inout), target :: system !! whose rates are integrated
    real(wp), intent(inout) :: time                       !! before the step, then after it
    real(wp), intent(in) :: limit                         !! latest end of the step
    real(wp), intent(inout) :: state(:)                   !! (unknowns) at `time`
    type(error_t), allocatable, intent(out) :: error      !! allocated if no step was made

    type(request_t), target :: request
    type(library_system_t), target :: library_system
    real(c_double) :: library_time, step, library_state(integrator%unknowns)
    integer(c_int) :: status

    request%system => system
    request%unknowns = integrator%unknowns
    library_system = library_system_t(c_funloc(rates_for_library), c_null_funptr, &
      int(integrator%unknowns, c_size_t), c_loc(request))
    library_time = real(time, c_double)
    step = real(integrator%step, c_double)
    library_state = real(state, c_double)
    ! The state may not be the last one that the library remembers.
    status = gsl_odeiv2_evolve_reset(integrator%evolution)
    status = gsl_odeiv2_evolve_apply(integrator%evolution, integrator%control, integrator%stepper, &
      c_loc(library_system), library_time, real(limit, c_double), step, library_state)
    integrator%evaluations = integrator%evaluations + request%evaluations
    if (status /= success) then
      call set_error(error, error_of_numerics, "the steps of the integration shrink to nothing")
      return
    end if
    integrator%steps = integrator%steps + 1_long
    integrator%step = real(step, wp)
    time = real(library_time, wp)
    ! Both have been rounded to the precision of the library.
    if (abs(time - limit) <= epsilon(1.0_c_double)*abs(limit)) time = limit
    state = real(library_state, wp)
  end subroutine advance

  !> The state after one step of given length, whatever its error: for a place within a step that
  !! `advance` has made.
  !!
  !! Errors: the rates do not exist somewhere within the step.
  subroutine step_by(integrator, system, time, step, state, error)
    type(integrator_t), intent(inout) :: integrator       !! open
    class(rate_system_t), intent(inout), target :: system !! whose rates are integrated
    real(wp), intent(in) :: time                          !! before the step
    real(wp), intent(in) :: step                          !! its length, in the unit of time
    real(wp), intent(inout) :: state(:)                   !! (unknowns) before the step, then after
                                                          !! it
    type(error_t), allocatable, intent(out) :: error      !! allocated if no step was made

    type(request_t), target :: request
    type(library_system_t), target :: library_system
    real(c_double) :: library_state(integrator%unknowns), estimate(integrator%unknowns)
    integer(c_int) :: status

    request%system => system
    request%unknowns = integrator%unknowns
    library_system = library_system_t(c_funloc(rates_for_library), c_null_funptr, &
      int(integrator%unknowns, c_size_t), c_loc(request))
    library_state = real(state, c_double)
    status = gsl_odeiv2_step_reset(integrator%stepper)
    status = gsl_odeiv2_step_apply(integrator%stepper, real(time, c_double), real(step, c_double), &
      library_state, estimate, c_null_ptr, c_null_ptr, c_loc(library_system))
    integrator%evaluations = integrator%evaluations + request%evaluations
    if (status /= success) then
      call set_error(error, error_of_numerics, "a step of the integration fails")
      return
    end if
    state = real(library_state, wp)
  end subroutine step_by

  !> Called by the library for rates.
  function rates_for_library(time, state, rates, parameters) bind(c) result(status)
    real(c_double), value :: time
    real(c_double), intent(in) :: state(*)
    real(c_double), intent(inout) :: rates(*)
    type(c_ptr), value :: parameters
    integer(c_int) :: status

    type(request_t), pointer :: request
    logical :: found

    call c_f_pointer(parameters, request)
    request%evaluations = request%evaluations + 1
    block
      real(wp) :: found_rates(request%unknowns)

      call request%system%find_rates(real(time, wp), real(state(:request%unknowns), wp), &
        found_rates, found)
      status = failure
      if (.not. found) return
      rates(:request%unknowns) = real(found_rates, c_double)
    end block
    status = success
  end function rates_for_library

end module adaptive_integration
