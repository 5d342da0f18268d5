!> Formulas over time, as steps of arithmetic, with their first two derivatives: each step has those
!! of what it is made of (forward differentiation; Griewank & Walther, *Evaluating Derivatives*,
!! 2nd ed. 2008, chapter 13).
module time_formulas
  use, intrinsic :: ieee_exceptions, only: ieee_get_halting_mode, ieee_set_flag, &
    ieee_set_halting_mode, ieee_usual
  use constants, only: degree
  use degree_functions, only: cosine_of_degrees, sine_of_degrees
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: time_formula_t, formula_values, add_step, find_trouble, function_step
  public :: step_constant, step_time, step_sum, step_difference, step_product, step_quotient, &
    step_scaled, step_whole_power, step_power

  integer, parameter :: step_constant = 1    !! the constant of the step
  integer, parameter :: step_time = 2        !! [s]
  integer, parameter :: step_sum = 3
  integer, parameter :: step_difference = 4
  integer, parameter :: step_product = 5
  integer, parameter :: step_quotient = 6
  integer, parameter :: step_scaled = 7      !! times the constant
  integer, parameter :: step_whole_power = 8 !! to the constant
  integer, parameter :: step_power = 9       !! of a positive number
  integer, parameter :: step_hypot = 10
  integer, parameter :: step_sqrt = 11
  integer, parameter :: step_sin = 12        !! of an angle in radians per constant
  integer, parameter :: step_cos = 13        !! likewise
  integer, parameter :: step_tan = 14        !! likewise
  integer, parameter :: step_asin = 15       !! in degrees
  integer, parameter :: step_acos = 16       !! likewise
  integer, parameter :: step_atan = 17       !! likewise

  type :: formula_step_t
    integer :: operation = 0         !! one of the step_… constants
    integer :: first = 0, second = 0 !! steps that it takes
    real(wp) :: constant = 0.0_wp
    integer :: place(2) = 0          !! first and last byte of its operator or function in the text
  end type formula_step_t

  type :: time_formula_t
    type(formula_step_t), allocatable :: steps(:) !! the last one gives the value; not allocated:
                                                  !! there is no formula
    real(wp) :: period = 0.0_wp   !! from 0 to this it holds, then again, each time on from where it
                                  !! has ended [s]; 0: it holds at all times
    real(wp) :: way = 0.0_wp      !! in a period
  end type time_formula_t

contains

  !> Appends a step.
  pure subroutine add_step(formula, operation, first, second, constant, place)
    type(time_formula_t), intent(inout) :: formula
    integer, intent(in) :: operation !! one of the step_… constants
    integer, intent(in) :: first, second !! numbers of steps; 0: it takes none
    real(wp), intent(in) :: constant
    integer, intent(in) :: place(2)

    type(formula_step_t) :: step

    step%operation = operation
    step%first = first
    step%second = second
    step%constant = constant
    step%place = place
    if (.not. allocated(formula%steps)) allocate (formula%steps(0))
    formula%steps = [formula%steps, step]
  end subroutine add_step

  !> The step of a function of one value; 0: its derivatives are not smooth.
  pure function function_step(name) result(operation)
    character(len=*), intent(in) :: name
    integer :: operation

    operation = 0
    select case (name)
    case ("sin")
      operation = step_sin
    case ("cos")
      operation = step_cos
    case ("tan")
      operation = step_tan
    case ("asin")
      operation = step_asin
    case ("acos")
      operation = step_acos
    case ("atan")
      operation = step_atan
    case ("sqrt")
      operation = step_sqrt
    case ("hypot")
      operation = step_hypot
    end select
  end function function_step

  !> Value, rate and acceleration. Where a period begins they are those of the time that follows.
  pure function formula_values(formula, time) result(values)
    type(time_formula_t), intent(in) :: formula
    real(wp), intent(in) :: time !! [s]
    real(wp) :: values(0:2)

    real(wp), parameter :: rounding = 1.0e-12_wp
    real(wp) :: steps(0:2, size(formula%steps)), periods

    if (formula%period > 0.0_wp) then
      periods = real(floor(time/formula%period + rounding), wp)
      call evaluate_steps(formula, max(time - periods*formula%period, 0.0_wp), steps)
      steps(0, size(formula%steps)) = steps(0, size(formula%steps)) + periods*formula%way
    else
      call evaluate_steps(formula, time, steps)
    end if
    values = steps(:, size(formula%steps))
  end function formula_values

  !> All steps at a time.
  pure subroutine evaluate_steps(formula, time, v)
    type(time_formula_t), intent(in) :: formula
    real(wp), intent(in) :: time    !! [s]
    real(wp), intent(out) :: v(0:, :) !! (derivatives, steps)

    real(wp) :: c, s, x
    integer :: k

    do k = 1, size(formula%steps)
      associate (step => formula%steps(k), a => v(:, max(1, formula%steps(k)%first)), &
        b => v(:, max(1, formula%steps(k)%second)))
        select case (step%operation)
        case (step_constant)
          v(:, k) = [step%constant, 0.0_wp, 0.0_wp]
        case (step_time)
          v(:, k) = [time, 1.0_wp, 0.0_wp]
        case (step_sum)
          v(:, k) = a + b
        case (step_difference)
          v(:, k) = a - b
        case (step_product)
          v(:, k) = [a(1)*b(1), a(2)*b(1) + a(1)*b(2), a(3)*b(1) + 2.0_wp*a(2)*b(2) + a(1)*b(3)]
        case (step_quotient)
          v(0, k) = a(1)/b(1)
          v(1, k) = (a(2) - v(0, k)*b(2))/b(1)
          v(2, k) = (a(3) - 2.0_wp*v(1, k)*b(2) - v(0, k)*b(3))/b(1)
        case (step_scaled)
          v(:, k) = step%constant*a
        case (step_whole_power)
          c = step%constant
          v(:, k) = chain(a, term(1.0_wp, a(1), c), term(c, a(1), c - 1.0_wp), term(c*(c - &
            1.0_wp), a(1), c - 2.0_wp))
        case (step_power)
          ! e^(b ln a)
          x = a(2)/a(1)
          s = b(2)*log(a(1)) + b(1)*x
          v(0, k) = a(1)**b(1)
          v(1, k) = v(0, k)*s
          v(2, k) = v(0, k)*(s**2 + b(3)*log(a(1)) + 2.0_wp*b(2)*x + b(1)*(a(3)/a(1) - x**2))
        case (step_hypot)
          v(0, k) = hypot(a(1), b(1))
          v(1, k) = (a(1)*a(2) + b(1)*b(2))/v(0, k)
          v(2, k) = (a(2)**2 + a(1)*a(3) + b(2)**2 + b(1)*b(3) - v(1, k)**2)/v(0, k)
        case (step_sqrt)
          s = sqrt(a(1))
          v(:, k) = chain(a, s, 0.5_wp/s, -0.25_wp/(s*a(1)))
        case (step_sin)
          call find_angle(step%constant, a(1), x, s, c)
          v(:, k) = chain(a, s, x*c, -x**2*s)
        case (step_cos)
          call find_angle(step%constant, a(1), x, s, c)
          v(:, k) = chain(a, c, -x*s, -x**2*c)
        case (step_tan)
          call find_angle(step%constant, a(1), x, s, c)
          v(:, k) = chain(a, s/c, x/c**2, 2.0_wp*x**2*s/c**3)
        case (step_asin, step_acos)
          s = merge(1, -1, step%operation == step_asin)/(sqrt((1.0_wp - a(1))*(1.0_wp + a(1)))* &
            degree)
          x = asin(a(1))
          if (step%operation == step_acos) x = acos(a(1))
          v(:, k) = chain(a, x/degree, s, s*a(1)/((1.0_wp - a(1))*(1.0_wp + a(1))))
        case (step_atan)
          s = 1.0_wp/(1.0_wp + a(1)**2)
          v(:, k) = chain(a, atan(a(1))/degree, s/degree, -2.0_wp*a(1)*s**2/degree)
        end select
      end associate
    end do

  end subroutine evaluate_steps

  !> What a function of a step gives, from the derivatives of the function.
  pure function chain(a, value, slope, bend) result(values)
    real(wp), intent(in) :: a(0:)              !! the step
    real(wp), intent(in) :: value, slope, bend !! f, f′, f″
    real(wp) :: values(0:2)

    values = [value, slope*a(1), bend*a(1)**2 + slope*a(2)]
  end function chain

  !> `k x^n`: 0 where k is, also of infinite powers of 0.
  pure function term(k, x, n)
    real(wp), intent(in) :: k, x, n !! n a whole number
    real(wp) :: term

    term = 0.0_wp
    if (abs(k) > 0.0_wp) term = k*x**nint(n)
  end function term

  !> Sine and cosine of an angle.
  pure subroutine find_angle(unit, angle, radians, s, c)
    real(wp), intent(in) :: unit     !! 1 or a degree [rad]
    real(wp), intent(in) :: angle
    real(wp), intent(out) :: radians !! of the unit
    real(wp), intent(out) :: s, c

    radians = unit
    if (unit < 1.0_wp) then
      s = sine_of_degrees(angle)
      c = cosine_of_degrees(angle)
    else
      s = sin(angle)
      c = cos(angle)
    end if
  end subroutine find_angle

  !> The first step that is not smooth, or no number, between two times: where what it divides by is
  !! 0, or what its root is of. Zeros that a value touches are found at its least.
  pure subroutine find_trouble(formula, from, to, number, time)
    type(time_formula_t), intent(in) :: formula
    real(wp), intent(in) :: from, to !! [s]
    integer, intent(out) :: number   !! of the step; 0: there is none
    real(wp), intent(out) :: time    !! where [s]

    integer, parameter :: samples = 4096
    !> Numbers of a deck are below this, too.
    real(wp), parameter :: greatest = 1.0e30_wp
    real(wp), allocatable :: v(:, :), guards(:, :, :) !! at the last sample and at this one
    real(wp) :: at(0:samples)
    logical :: halts(size(ieee_usual))
    integer :: i, k

    number = 0
    time = from
    allocate (v(0:2, size(formula%steps)), guards(0:1, 2, size(formula%steps)))
    at = [(from + (to - from)*i/samples, i=0, samples)]
    call ieee_get_halting_mode(ieee_usual, halts)
    call ieee_set_halting_mode(ieee_usual, .false.)
    search: do i = 0, samples
      call evaluate_steps(formula, at(i), v)
      do k = 1, size(formula%steps)
        guards(:, 1, k) = guards(:, 2, k)
        guards(:, 2, k) = guard_of(formula%steps(k), v)
        time = at(i)
        if (.not. guards(0, 2, k) > 0.0_wp .or. .not. all(abs(v(:, k)) <= greatest)) then
          ! Where it is not positive at first it has the other sign, or none.
          number = k
        else if (i > 0) then
          if (touches_zero(formula, k, at(i - 1:i), guards(:, :, k))) number = k
        end if
        if (number > 0) exit search
      end do
    end do search
    call ieee_set_flag(ieee_usual, .false.)
    call ieee_set_halting_mode(ieee_usual, halts)
  end subroutine find_trouble

  !> What stays positive where a step is smooth, and its rate.
  pure function guard_of(step, v) result(guard)
    type(formula_step_t), intent(in) :: step
    real(wp), intent(in) :: v(0:, :) !! (derivatives, steps)
    real(wp) :: guard(0:1)

    real(wp) :: c, s, unit

    guard = [1.0_wp, 0.0_wp]
    associate (a => v(:, max(1, step%first)), b => v(:, max(1, step%second)))
      select case (step%operation)
      case (step_quotient)
        guard = [b(1)**2, 2.0_wp*b(1)*b(2)]
      case (step_whole_power)
        if (step%constant < 0.0_wp) guard = [a(1)**2, 2.0_wp*a(1)*a(2)]
      case (step_power, step_sqrt)
        guard = a(:2)
      case (step_hypot)
        guard = [a(1)**2 + b(1)**2, 2.0_wp*(a(1)*a(2) + b(1)*b(2))]
      case (step_tan)
        call find_angle(step%constant, a(1), unit, s, c)
        guard = [c**2, -2.0_wp*c*s*unit*a(2)]
      case (step_asin, step_acos)
        guard = [(1.0_wp - a(1))*(1.0_wp + a(1)), -2.0_wp*a(1)*a(2)]
      end select
    end associate
  end function guard_of

  !> Whether what stays positive is 0 between two times at which it is positive: at a least value.
  pure function touches_zero(formula, k, at, guards) result(touches)
    type(time_formula_t), intent(in) :: formula
    integer, intent(in) :: k              !! number of the step
    real(wp), intent(in) :: at(2)         !! [s]
    real(wp), intent(in) :: guards(0:, :) !! there
    logical :: touches

    integer, parameter :: halvings = 60
    real(wp), parameter :: rounding = 1.0e-20_wp
    real(wp) :: v(0:2, size(formula%steps)), guard(0:1), low, high, middle
    integer :: i

    touches = .false.
    if (.not. (guards(1, 1) < 0.0_wp .and. guards(1, 2) > 0.0_wp)) return
    low = at(1)
    high = at(2)
    do i = 1, halvings
      middle = 0.5_wp*(low + high)
      call evaluate_steps(formula, middle, v)
      guard = guard_of(formula%steps(k), v)
      touches = .not. guard(0) > rounding*maxval(guards(0, :))
      if (touches) return
      if (guard(1) < 0.0_wp) then
        low = middle
      else
        high = middle
      end if
    end do
  end function touches_zero

end module time_formulas
