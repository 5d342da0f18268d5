!> Integration of ordinary differential equations by a Runge-Kutta method of order 8 with step
!! control: `rk8pd` of the GNU Scientific Library (Prince and Dormand 1981, order 8 with an error
!! estimate of order 7). Where the equations are stiff, so that its steps are as long as its
!! stability allows and not as the error allows, an implicit method goes on (`implicit_steps`), as
!! long as this takes fewer evaluations of the rates.
!!
!! The library computes in double precision, whatever the working precision.
module adaptive_integration
  use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_f_pointer, c_funloc, c_funptr, &
    c_int, c_loc, c_null_funptr, c_null_ptr, c_ptr, c_size_t
  use errors, only: error_of_numerics, error_t, set_error
  use implicit_steps, only: advance_implicitly, implicit_method_t, new_implicit_method, &
    step_implicitly
  use kinds, only: long, wp
  use rate_jacobians, only: find_jacobian, spectral_radius
  use rate_systems, only: rate_system_t
  implicit none (type, external)
  private

  public :: rate_system_t, integrator_t, open_integrator, reopen_integrator, close_integrator, &
    advance, step_by

  !> The library's data between steps. To be closed after use, and never copied.
  type :: integrator_t
    integer(long) :: steps = 0_long          !! accepted so far, of both methods
    integer(long) :: implicit_steps = 0_long !! those of the implicit method among them
    integer(long) :: evaluations = 0_long    !! of rates so far
    real(wp) :: step = 0.0_wp                !! length of the next step that the error allows, in
                                             !! the unit of time
    logical :: is_stiff = .false.            !! the next step is one of the implicit method
    integer, private :: unknowns = 0
    real(wp), allocatable, private :: scale(:) !! of `open_integrator`
    integer, private :: count = 0            !! steps since the last look at the stiffness
    integer, private :: looks = 0            !! at which the same was seen, one after the other
    integer, private :: patience = 1         !! factor of the looks that a change to the implicit
                                             !! method takes
    real(wp), private :: longest = 0.0_wp    !! step since the last look
    integer(long), private :: evaluated = 0_long !! evaluations up to the last look
    type(implicit_method_t), private :: implicit
    type(c_ptr), private :: stepper = c_null_ptr, control = c_null_ptr, evolution = c_null_ptr
  end type integrator_t

  !> The stiffness is looked at after every so many steps of either method. The equations are stiff
  !! where the fastest change goes through more than `stability_limit` of itself in a step of the
  !! explicit method: up to some 0.3 where the error limits it, from 3 on where stability does, in
  !! between where rounding does that the fastest change makes larger. After so many such looks in
  !! turn the other method goes on.
  integer, parameter :: explicit_steps_between = 100, implicit_steps_between = 4
  real(wp), parameter :: stability_limit = 0.5_wp
  integer, parameter :: looks_before_change = 5

  !> What the fastest change goes through in a step of the explicit method at the limit, and what
  !! this step costs. After a return from the implicit method the next try waits twice as long, up
  !! to a bound.
  real(wp), parameter :: explicit_reach = 3.0_wp, explicit_evaluations = 13.0_wp
  integer, parameter :: most_patience = 64

  !> A load that follows tanh(s) begins to turn over at the first |s|, and is turned over at the
  !! last; a step over its zero has at most the second change of s.
  real(wp), parameter :: begin_of_switch = 2.0_wp, widest_switch = 4.0_wp, turned_over = 20.0_wp

  !> A contact to this share of its width is not seen. The course of a depth between the ends of a
  !! step differs by no more than the second share of its rise from the cubic.
  real(wp), parameter :: unseen_depth = 1.0e-4_wp, rise_error = 1.0e-2_wp

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
    integrator%scale = scale
    integrator%step = first_step
    integrator%implicit = new_implicit_method(scale, tolerance)
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

  !> Goes on with unknowns of another kind, as many: steps, method and counts are kept.
  !!
  !! Errors: not enough memory.
  subroutine reopen_integrator(integrator, scale, tolerance, error)
    type(integrator_t), intent(inout) :: integrator  !! open
    real(wp), intent(in) :: scale(:)                 !! (unknowns) as of `open_integrator`
    real(wp), intent(in) :: tolerance                !! relative [-]
    type(error_t), allocatable, intent(out) :: error !! allocated if memory is short

    type(integrator_t) :: next

    call open_integrator(next, scale, tolerance, integrator%step, error)
    next%steps = integrator%steps
    next%implicit_steps = integrator%implicit_steps
    next%evaluations = integrator%evaluations
    next%is_stiff = integrator%is_stiff
    next%count = integrator%count
    next%looks = integrator%looks
    next%patience = integrator%patience
    next%longest = integrator%longest
    next%evaluated = integrator%evaluated
    call close_integrator(integrator)
    integrator = next
  end subroutine reopen_integrator

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
  !! and time may have been changed since the last step. No step passes over a load that turns over
  !! (`switches`): one ends where that begins, and those over it are short. None passes over a
  !! contact (`contacts`) that begins and ends in it.
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

    real(wp) :: time_before, before(size(state)), step
    real(wp), allocatable :: switches(:, :), contacts(:, :)
    logical :: is_implicit

    time_before = time
    before = state
    switches = system%switches(state)
    contacts = system%contacts(state)
    do
      call take_step(integrator, system, time, limit, state, is_implicit, error)
      if (allocated(error)) return
      if (size(switches) == 0 .and. size(contacts) == 0) exit
      step = (time - time_before)*min(share_before_switch(switches, system%switches(state)), &
        share_before_contact(contacts, system%contacts(state), time - time_before))
      ! Shorter than what time is rounded to, nothing is seen.
      if (step >= time - time_before .or. step < 16.0_wp*epsilon(1.0_c_double)*abs(time)) exit
      integrator%step = step
      time = time_before
      state = before
    end do
    integrator%steps = integrator%steps + 1_long
    if (is_implicit) then
      integrator%implicit_steps = integrator%implicit_steps + 1_long
      call look_at_gain(integrator, time - time_before)
    else
      call look_at_stiffness(integrator, system, time, state, time - time_before)
    end if
  end subroutine advance

  !> The share of a step after which it should end because a load turns over in it: one where it
  !! need not. The way of each s is taken as straight.
  pure function share_before_switch(before, after) result(share)
    real(wp), intent(in) :: before(:, :), after(:, :) !! `switches` on both sides of the step
    real(wp) :: share

    real(wp) :: way(2), length, nearest
    integer :: k

    share = 1.0_wp
    if (size(after) /= size(before)) return
    do k = 1, size(before, 2)
      way = after(:, k) - before(:, k)
      length = norm2(way)
      if (length <= widest_switch) cycle
      nearest = -dot_product(before(:, k), way/length)/length
      if (nearest <= 0.0_wp .or. nearest >= 1.0_wp) cycle
      if (norm2(before(:, k) + nearest*way) > turned_over) cycle
      share = min(share, max(nearest - begin_of_switch/length, 0.5_wp*widest_switch/length))
    end do
  end function share_before_switch

  !> The half of a step that may pass over a contact; else one. The course of a depth is taken as
  !! the cubic of its values and rates at both ends, with a hundredth of its rise between them: by
  !! more it does not differ in a step whose error is bounded.
  pure function share_before_contact(before, after, step) result(share)
    real(wp), intent(in) :: before(:, :), after(:, :) !! `contacts` on both sides of the step
    real(wp), intent(in) :: step                      !! its length
    real(wp) :: share

    real(wp) :: rise
    integer :: k

    share = 1.0_wp
    if (size(after) /= size(before)) return
    do k = 1, size(before, 2)
      if (max(before(1, k), after(1, k)) > 0.0_wp) cycle
      rise = rise_between(before(:2, k), after(:2, k), step)
      if (max(before(1, k), after(1, k)) + rise*(1.0_wp + rise_error) > unseen_depth* &
        before(3, k)) share = 0.5_wp
    end do
  end function share_before_contact

  !> By how much a cubic is above both its ends: 0 without a maximum between them.
  pure function rise_between(before, after, step) result(rise)
    real(wp), intent(in) :: before(2), after(2) !! values and rates at both ends
    real(wp), intent(in) :: step
    real(wp) :: rise

    real(wp) :: slope, a, b, c, root, t

    rise = 0.0_wp
    ! y = y₁ + a t + b t² + c t³ with t from 0 to 1; with rates that rise and then fall.
    a = before(2)*step
    if (a <= 0.0_wp .or. after(2) >= 0.0_wp) return
    slope = after(1) - before(1)
    b = 3.0_wp*slope - 2.0_wp*a - after(2)*step
    c = a + after(2)*step - 2.0_wp*slope
    root = sqrt(max(0.0_wp, b**2 - 3.0_wp*a*c))
    ! The zero of y' = a + 2 b t + 3 c t² where it falls, without a difference of equals.
    if (b > 0.0_wp) then
      t = -(b + root)/(3.0_wp*c)
    else
      t = a/(root - b)
    end if
    rise = max(0.0_wp, before(1) + t*(a + t*(b + t*c)) - max(before(1), after(1)))
  end function rise_between

  !> One step, of the method that serves here.
  !!
  !! Errors: as of `advance`.
  subroutine take_step(integrator, system, time, limit, state, is_implicit, error)
    type(integrator_t), intent(inout) :: integrator
    class(rate_system_t), intent(inout), target :: system
    real(wp), intent(inout) :: time
    real(wp), intent(in) :: limit
    real(wp), intent(inout) :: state(:)
    logical, intent(out) :: is_implicit !! the step was one of the implicit method
    type(error_t), allocatable, intent(out) :: error

    is_implicit = integrator%is_stiff
    if (is_implicit) then
      call take_implicit_step(integrator, system, time, limit, state, is_implicit)
      if (is_implicit) return
      call return_to_explicit(integrator)
    end if
    call take_explicit_step(integrator, system, time, limit, state, error)
  end subroutine take_step

  !> One step of the implicit method.
  subroutine take_implicit_step(integrator, system, time, limit, state, found)
    type(integrator_t), intent(inout) :: integrator
    class(rate_system_t), intent(inout) :: system
    real(wp), intent(inout) :: time
    real(wp), intent(in) :: limit
    real(wp), intent(inout) :: state(:)
    logical, intent(out) :: found !! false: there is none, or the explicit method needs no shorter
                                  !! one

    integer(long) :: evaluations

    evaluations = integrator%implicit%evaluations
    integrator%implicit%step = integrator%step
    call advance_implicitly(integrator%implicit, system, time, limit, state, found)
    integrator%evaluations = integrator%evaluations + integrator%implicit%evaluations - evaluations
    if (.not. found) return
    integrator%step = integrator%implicit%step
  end subroutine take_implicit_step

  !> After a step of the implicit method: the explicit one goes on where it would need fewer
  !! evaluations for the same way.
  subroutine look_at_gain(integrator, step)
    type(integrator_t), intent(inout) :: integrator
    real(wp), intent(in) :: step !! its length

    real(wp) :: evaluations

    integrator%count = integrator%count + 1
    integrator%longest = max(integrator%longest, step)
    if (integrator%count < implicit_steps_between) return
    evaluations = real(integrator%evaluations - integrator%evaluated, wp)/integrator%count
    if (integrator%longest*integrator%implicit%fastest*explicit_evaluations < &
      explicit_reach*evaluations) then
      integrator%looks = integrator%looks + 1
    else
      integrator%looks = 0
    end if
    call begin_look(integrator)
    if (integrator%looks >= looks_before_change) call return_to_explicit(integrator)
  end subroutine look_at_gain

  !> The next steps are those of the explicit method.
  pure subroutine return_to_explicit(integrator)
    type(integrator_t), intent(inout) :: integrator

    integrator%is_stiff = .false.
    integrator%patience = min(most_patience, 2*integrator%patience)
    integrator%looks = 0
    if (integrator%implicit%fastest > 0.0_wp) integrator%step = min(integrator%step, &
      stability_limit/integrator%implicit%fastest)
    call begin_look(integrator)
  end subroutine return_to_explicit

  !> After a step of the explicit method: whether its stability limits it.
  subroutine look_at_stiffness(integrator, system, time, state, step)
    type(integrator_t), intent(inout) :: integrator
    class(rate_system_t), intent(inout) :: system
    real(wp), intent(in) :: time     !! after the step
    real(wp), intent(in) :: state(:) !! likewise
    real(wp), intent(in) :: step     !! its length

    real(wp) :: rates(size(state)), jacobian(size(state), size(state))
    logical :: found

    integrator%count = integrator%count + 1
    integrator%longest = max(integrator%longest, step)
    if (integrator%count < explicit_steps_between) return
    integrator%evaluations = integrator%evaluations + 1_long
    call system%find_rates(time, state, rates, found)
    if (found) call find_jacobian(system, time, state, rates, integrator%scale, jacobian, found, &
      integrator%evaluations)
    if (found) found = integrator%longest*spectral_radius(jacobian) > stability_limit
    integrator%looks = merge(integrator%looks + 1, 0, found)
    call begin_look(integrator)
    if (integrator%looks < looks_before_change*integrator%patience) return
    integrator%is_stiff = .true.
    integrator%looks = 0
  end subroutine look_at_stiffness

  !> Steps are counted anew.
  pure subroutine begin_look(integrator)
    type(integrator_t), intent(inout) :: integrator

    integrator%count = 0
    integrator%longest = 0.0_wp
    integrator%evaluated = integrator%evaluations
  end subroutine begin_look

  !> One step of the explicit method.
  !!
  !! Errors: as of `advance`.
  subroutine take_explicit_step(integrator, system, time, limit, state, error)
    type(integrator_t), intent(inout) :: integrator
    class(rate_system_t), intent(inout), target :: system
    real(wp), intent(inout) :: time
    real(wp), intent(in) :: limit
    real(wp), intent(inout) :: state(:)
    type(error_t), allocatable, intent(out) :: error

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
    integrator%step = real(step, wp)
    time = real(library_time, wp)
    ! Both have been rounded to the precision of the library.
    if (abs(time - limit) <= epsilon(1.0_c_double)*abs(limit)) time = limit
    state = real(library_state, wp)
  end subroutine take_explicit_step

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
    integer(long) :: evaluations
    logical :: found

    if (integrator%is_stiff) then
      evaluations = integrator%implicit%evaluations
      call step_implicitly(integrator%implicit, system, time, step, state, found)
      integrator%evaluations = integrator%evaluations + integrator%implicit%evaluations - &
        evaluations
      if (.not. found) call set_error(error, error_of_numerics, "a step of the integration fails")
      return
    end if
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
