!> The part of pFUnit 4 that the unit tests use, with its semantics, for machines without pFUnit.
!!
!! The rules are pFUnit's: a tolerance is absolute (default 0: exact) or, in `assertRelativelyEqual`, a fraction of the
!! expected value; a scalar is compared with every element of an array; NaN satisfies nothing; blanks around a string
!! do not count. `translate_tests.py` turns `@assertEqual(a, b, tolerance=t)` into
!! `call assert_relation("assertEqual", a, b, file, line, tolerance=t)`. No argument has allocatable components: their
!! deallocation behind every assertion would be a third of what the compiler has to do for a test.
module funit
  use, intrinsic :: ieee_arithmetic, only: ieee_all, ieee_get_status, ieee_is_finite, ieee_set_halting_mode, ieee_set_status, &
    ieee_status_type
  use, intrinsic :: iso_fortran_env, only: int64, output_unit, real32, real64
  implicit none (type, external)
  private

  public :: anyExceptions                                  ! this name is pFUnit's
  public :: assert_relation, assert_truth, assert_finite   ! called by translated tests
  public :: run_test, finish                               ! called by the driver program

  !> Both sides of an assertion, whatever their type and rank: the elements in array order, and the shape.
  type :: values_t
    character(:), allocatable :: type
    integer, allocatable :: shape(:)
    real(real64), allocatable :: reals(:)
    integer(int64), allocatable :: integers(:) !! logicals too, as 0 and 1
    character(:), allocatable :: string
  end type values_t

  interface values
    module procedure :: values_of_double, values_of_single, values_of_integer, values_of_long, values_of_logical
    module procedure :: values_of_string
  end interface values

  !> The pairs that pFUnit compares: `left` is what it calls expected, `right` what it calls actual.
  interface assert_relation
    module procedure :: assert_double_double, assert_integer_double, assert_single_double, assert_single_single
    module procedure :: assert_integer_single, assert_integer_integer, assert_integer_long, assert_long_long
    module procedure :: assert_logical_logical, assert_string_string
  end interface assert_relation

  interface assert_truth
    module procedure :: assert_scalar_truth, assert_array_truth
  end interface assert_truth

  interface assert_finite
    module procedure :: assert_finite_double, assert_finite_single
  end interface assert_finite

  abstract interface
    subroutine procedure_without_arguments()
    end subroutine procedure_without_arguments
  end interface

  ! Module variables, against the habit of the project: assertions have no argument that could carry them.
  character(:), allocatable :: failure_of_this_test
  integer :: passed = 0
  integer :: failed = 0

contains

  !> Has an assertion of the running test failed? Translated tests return when it has.
  logical function anyExceptions()
    anyExceptions = allocated(failure_of_this_test)
  end function anyExceptions

  !> Run one test between what its module asks for before and after each, and print `ok` or `not ok` with the reason.
  subroutine run_test(suite, name, test, before, after)
    character(*), intent(in) :: suite
    character(*), intent(in) :: name
    procedure(procedure_without_arguments) :: test
    procedure(procedure_without_arguments), optional :: before
    procedure(procedure_without_arguments), optional :: after

    character(:), allocatable :: full_name

    full_name = suite//" "//name
    if (.not. asked_for(full_name)) return

    ! Printed first and flushed, so that a crash can be laid at the right door.
    write (output_unit, "(a)") "# "//full_name
    flush (output_unit)

    if (allocated(failure_of_this_test)) deallocate (failure_of_this_test)
    if (present(before)) call before()
    if (.not. anyExceptions()) then
      call test()
      if (present(after)) call after()
    end if

    if (anyExceptions()) then
      failed = failed + 1
      write (output_unit, "(a)") "not ok "//full_name//": "//failure_of_this_test
    else
      passed = passed + 1
      write (output_unit, "(a)") "ok "//full_name
    end if
    flush (output_unit)
  end subroutine run_test

  !> Words on the command line choose tests: those whose "suite name" holds one of them, but none that holds what follows a `-`.
  !! A blank at the end of a word counts: "test_x " is that suite alone.
  logical function asked_for(full_name)
    character(*), intent(in) :: full_name

    character(256) :: word
    integer :: i, length, chosen

    asked_for = .false.
    chosen = 0
    do i = 1, command_argument_count()
      call get_command_argument(i, word, length)
      if (word(1:1) == "-") then
        if (index(full_name, word(2:length)) > 0) then
          asked_for = .false.
          return
        end if
      else
        chosen = chosen + 1
        asked_for = asked_for .or. index(full_name, word(:length)) > 0
      end if
    end do
    asked_for = asked_for .or. chosen == 0
  end function asked_for

  !> The count, and exit status 2 when a test has failed.
  subroutine finish()
    write (output_unit, "(i0,a,i0,a)") passed, " passed, ", failed, " failed"
    flush (output_unit)
    if (failed > 0) stop 2, quiet=.true.
  end subroutine finish

  subroutine assert_scalar_truth(name, condition, file, line, message)
    character(*), intent(in) :: name !! assertTrue or assertFalse
    logical, intent(in) :: condition
    character(*), intent(in) :: file
    integer, intent(in) :: line
    character(*), intent(in), optional :: message

    call assert_array_truth(name, [condition], file, line, message)
  end subroutine assert_scalar_truth

  subroutine assert_array_truth(name, condition, file, line, message)
    character(*), intent(in) :: name !! assertTrue or assertFalse
    logical, intent(in) :: condition(:)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    character(*), intent(in), optional :: message

    if (any(condition .neqv. (name == "assertTrue"))) call fail(name, "", file, line, message)
  end subroutine assert_array_truth

  subroutine assert_finite_double(name, x, file, line, message)
    character(*), intent(in) :: name
    real(real64), intent(in) :: x
    character(*), intent(in) :: file
    integer, intent(in) :: line
    character(*), intent(in), optional :: message

    type(ieee_status_type) :: status
    logical :: finite

    call disarm(status)
    finite = ieee_is_finite(x)
    call ieee_set_status(status)
    if (.not. finite) call fail(name, "", file, line, message)
  end subroutine assert_finite_double

  subroutine assert_finite_single(name, x, file, line, message)
    character(*), intent(in) :: name
    real(real32), intent(in) :: x
    character(*), intent(in) :: file
    integer, intent(in) :: line
    character(*), intent(in), optional :: message

    type(values_t) :: x_

    x_ = values(x)
    call assert_finite(name, x_%reals(1), file, line, message)
  end subroutine assert_finite_single

  subroutine assert_values(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name !! of the relation: assertEqual, assertLessThan, ...
    type(values_t), intent(in) :: left
    type(values_t), intent(in) :: right
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance !! a real of either kind
    character(*), intent(in), optional :: message

    character(:), allocatable :: reason

    if (size(left%shape) > 0 .and. size(left%shape) /= size(right%shape)) then
      reason = "ranks "//to_string(size(left%shape))//" and "//to_string(size(right%shape))//" do not conform"
    else if (any(left%shape /= right%shape(:size(left%shape)))) then
      reason = "shapes "//list(left%shape)//" and "//list(right%shape)//" do not conform"
    else
      select case (left%type//" "//right%type)
      case ("double double", "integer double", "single double", "single single", "integer single")
        reason = reason_of_reals(name, left, right, tolerance_value(tolerance))
      case ("integer integer", "integer long", "long long", "logical logical")
        reason = reason_of_integers(name, left, right)
      case ("string string")
        reason = reason_of_strings(left%string, right%string)
      case default
        reason = "pFUnit does not compare "//left%type//" (expected) with "//right%type//" (actual)"
      end select
    end if
    if (len(reason) > 0) call fail(name, reason, file, line, message)
  end subroutine assert_values

  subroutine assert_double_double(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    real(real64), intent(in) :: left(..)
    real(real64), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_double_double

  subroutine assert_integer_double(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    integer, intent(in) :: left(..)
    real(real64), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_integer_double

  subroutine assert_single_double(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    real(real32), intent(in) :: left(..)
    real(real64), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_single_double

  subroutine assert_single_single(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    real(real32), intent(in) :: left(..)
    real(real32), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_single_single

  subroutine assert_integer_single(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    integer, intent(in) :: left(..)
    real(real32), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_integer_single

  subroutine assert_integer_integer(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    integer, intent(in) :: left(..)
    integer, intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_integer_integer

  subroutine assert_integer_long(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    integer, intent(in) :: left(..)
    integer(int64), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_integer_long

  subroutine assert_long_long(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    integer(int64), intent(in) :: left(..)
    integer(int64), intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_long_long

  subroutine assert_logical_logical(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    logical, intent(in) :: left(..)
    logical, intent(in) :: right(..)
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_logical_logical

  subroutine assert_string_string(name, left, right, file, line, tolerance, message)
    character(*), intent(in) :: name
    character(*), intent(in) :: left
    character(*), intent(in) :: right
    character(*), intent(in) :: file
    integer, intent(in) :: line
    class(*), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message

    call assert_values(name, values(left), values(right), file, line, tolerance, message)
  end subroutine assert_string_string

  !> Why the relation does not hold, at the first element where it does not; empty when it holds.
  function reason_of_reals(name, left, right, tolerance) result(reason)
    character(*), intent(in) :: name
    type(values_t), intent(in) :: left
    type(values_t), intent(in) :: right
    real(real64), intent(in) :: tolerance
    character(:), allocatable :: reason

    type(ieee_status_type) :: status
    logical, allocatable :: holds(:)
    real(real64), allocatable :: l(:)
    integer :: i

    call disarm(status)
    if (allocated(left%reals)) then
      l = spread_scalar(left%reals, size(right%reals))
    else
      l = spread_scalar(real(left%integers, real64), size(right%reals))
    end if
    associate (r => right%reals)
      select case (name)
      case ("assertEqual")
        ! The equality (spelt so that the compiler does not warn) for infinities, whose difference is no number.
        holds = (r <= l .and. r >= l) .or. abs(r - l) <= tolerance
      case ("assertNotEqual")
        holds = abs(r - l) > tolerance
      case ("assertRelativelyEqual")
        holds = abs(r - l) <= tolerance*abs(l) .and. abs(l) > 0.0_real64
      case ("assertLessThan")
        holds = l < r + tolerance
      case ("assertLessThanOrEqual")
        holds = l <= r + tolerance
      case ("assertGreaterThan")
        holds = l > r - tolerance
      case ("assertGreaterThanOrEqual")
        holds = l >= r - tolerance
      end select
      reason = ""
      if (.not. all(holds)) then
        i = findloc(holds, .false., dim=1)
        reason = sides(name, real_text(l(i)), real_text(r(i)))//", difference "//real_text(r(i) - l(i))// &
          ", tolerance "//real_text(tolerance)//at_index(i, right%shape)
        if (name == "assertRelativelyEqual" .and. .not. abs(l(i)) > 0.0_real64) reason = reason//" (nothing is relative to zero)"
      end if
    end associate
    call ieee_set_status(status)
  end function reason_of_reals

  function reason_of_integers(name, left, right) result(reason)
    character(*), intent(in) :: name
    type(values_t), intent(in) :: left
    type(values_t), intent(in) :: right
    character(:), allocatable :: reason

    logical, allocatable :: holds(:)
    integer(int64), allocatable :: l(:)
    integer :: i

    allocate (l(size(right%integers)))
    if (size(left%shape) == 0) then
      l = left%integers(1)
    else
      l = left%integers
    end if
    associate (r => right%integers)
      select case (name)
      case ("assertEqual")
        holds = l == r
      case ("assertNotEqual")
        holds = l /= r
      case ("assertLessThan")
        holds = l < r
      case ("assertLessThanOrEqual")
        holds = l <= r
      case ("assertGreaterThan")
        holds = l > r
      case ("assertGreaterThanOrEqual")
        holds = l >= r
      case default
        holds = [(.false., i=1, size(r))]
      end select
      reason = ""
      if (all(holds)) return
      i = findloc(holds, .false., dim=1)
      if (left%type == "logical") then
        reason = sides(name, merge("T", "F", l(i) == 1), merge("T", "F", r(i) == 1))//at_index(i, right%shape)
      else
        reason = sides(name, long_text(l(i)), long_text(r(i)))//at_index(i, right%shape)
      end if
    end associate
  end function reason_of_integers

  function reason_of_strings(left, right) result(reason)
    character(*), intent(in) :: left
    character(*), intent(in) :: right
    character(:), allocatable :: reason

    reason = ""
    ! Fortran calls strings equal that differ by blanks at the end, but these have none there; the length is for tabs.
    if (left /= right .or. len(left) /= len(right)) reason = sides("assertEqual", '"'//left//'"', '"'//right//'"')
  end function reason_of_strings

  function sides(name, left, right) result(text)
    character(*), intent(in) :: name
    character(*), intent(in) :: left
    character(*), intent(in) :: right
    character(:), allocatable :: text

    if (index(name, "Equal") > 0 .and. index(name, "Or") == 0) then
      text = "expected "//left//" but found "//right
    else
      text = "left "//left//", right "//right
    end if
  end function sides

  !> Keep the first failure: it is the one that explains the others.
  subroutine fail(name, reason, file, line, message)
    character(*), intent(in) :: name
    character(*), intent(in) :: reason
    character(*), intent(in) :: file
    integer, intent(in) :: line
    character(*), intent(in), optional :: message

    character(:), allocatable :: text

    if (anyExceptions()) return
    text = file//":"//to_string(line)//": "//name
    if (len(reason) > 0) text = text//": "//reason
    if (present(message)) text = text//" ("//trim(message)//")"
    failure_of_this_test = text
  end subroutine fail

  !> NaN must fail an assertion, not stop the program, so the traps of the debug build are off while numbers are compared.
  subroutine disarm(status)
    type(ieee_status_type), intent(out) :: status

    call ieee_get_status(status)
    call ieee_set_halting_mode(ieee_all, .false.)
  end subroutine disarm

  function spread_scalar(x, n) result(y)
    real(real64), intent(in) :: x(:)
    integer, intent(in) :: n
    real(real64), allocatable :: y(:)

    if (size(x) == n) then
      y = x
    else
      allocate (y(n), source=x(1))
    end if
  end function spread_scalar

  function tolerance_value(tolerance) result(t)
    class(*), intent(in), optional :: tolerance
    real(real64) :: t

    t = 0.0_real64
    if (.not. present(tolerance)) return
    select type (tolerance)
    type is (real(real64))
      t = tolerance
    type is (real(real32))
      t = real(tolerance, real64)
    class default
      t = -1.0_real64 ! nothing passes: pFUnit would not compile this
    end select
  end function tolerance_value

  function values_of_double(x) result(v)
    real(real64), intent(in) :: x(..)
    type(values_t) :: v

    v%type = "double"
    v%shape = shape(x)
    select rank (x)
    rank (0)
      v%reals = [x]
    rank (1)
      v%reals = [x] ! not x alone: gfortran would keep its lower bound, 0 for an expression
    rank (2)
      v%reals = reshape(x, [size(x)])
    rank default
      error stop "funit: rank above 2"
    end select
  end function values_of_double

  function values_of_single(x) result(v)
    real(real32), intent(in) :: x(..)
    type(values_t) :: v

    type(ieee_status_type) :: status

    call disarm(status) ! the conversion of a signalling NaN is an operation
    v%shape = shape(x)
    select rank (x)
    rank (0)
      v%reals = [real(x, real64)]
    rank (1)
      v%reals = [real(x, real64)]
    rank (2)
      v%reals = real(reshape(x, [size(x)]), real64)
    rank default
      error stop "funit: rank above 2"
    end select
    v%type = "single"
    call ieee_set_status(status)
  end function values_of_single

  function values_of_integer(x) result(v)
    integer, intent(in) :: x(..)
    type(values_t) :: v

    v%type = "integer"
    v%shape = shape(x)
    select rank (x)
    rank (0)
      v%integers = [int(x, int64)]
    rank (1)
      v%integers = [int(x, int64)]
    rank (2)
      v%integers = int(reshape(x, [size(x)]), int64)
    rank default
      error stop "funit: rank above 2"
    end select
  end function values_of_integer

  function values_of_long(x) result(v)
    integer(int64), intent(in) :: x(..)
    type(values_t) :: v

    v%type = "long"
    v%shape = shape(x)
    select rank (x)
    rank (0)
      v%integers = [x]
    rank (1)
      v%integers = [x]
    rank (2)
      v%integers = reshape(x, [size(x)])
    rank default
      error stop "funit: rank above 2"
    end select
  end function values_of_long

  function values_of_logical(x) result(v)
    logical, intent(in) :: x(..)
    type(values_t) :: v

    select rank (x)
    rank (0)
      v = values(merge(1, 0, x))
    rank (1)
      v = values(merge(1, 0, x))
    rank (2)
      v = values(merge(1, 0, x))
    rank default
      error stop "funit: rank above 2"
    end select
    v%type = "logical"
  end function values_of_logical

  function values_of_string(x) result(v)
    character(*), intent(in) :: x
    type(values_t) :: v

    character(*), parameter :: blanks = " "//achar(9)
    integer :: first

    allocate (v%shape(0))
    v%type = "string"
    first = verify(x, blanks)
    v%string = ""
    if (first > 0) v%string = x(first:verify(x, blanks, back=.true.))
  end function values_of_string

  function at_index(i, shape) result(text)
    integer, intent(in) :: i !! in array order
    integer, intent(in) :: shape(:)
    character(:), allocatable :: text

    select case (size(shape))
    case (0)
      text = ""
    case (1)
      text = ", at index "//list([i])
    case default
      text = ", at index "//list([modulo(i - 1, shape(1)) + 1, (i - 1)/shape(1) + 1])
    end select
  end function at_index

  function list(numbers) result(text)
    integer, intent(in) :: numbers(:)
    character(:), allocatable :: text

    integer :: i

    text = "["
    do i = 1, size(numbers)
      if (i > 1) text = text//","
      text = text//to_string(numbers(i))
    end do
    text = text//"]"
  end function list

  function to_string(i) result(text)
    integer, intent(in) :: i
    character(:), allocatable :: text

    text = long_text(int(i, int64))
  end function to_string

  function long_text(i) result(text)
    integer(int64), intent(in) :: i
    character(:), allocatable :: text

    character(24) :: buffer

    write (buffer, "(i0)") i
    text = trim(buffer)
  end function long_text

  function real_text(x) result(text)
    real(real64), intent(in) :: x
    character(:), allocatable :: text

    character(40) :: buffer

    write (buffer, "(g0)") x
    text = trim(buffer)
  end function real_text

end module funit
