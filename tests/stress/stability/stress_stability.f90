!> The stress test of verdicts on stability: random mechanisms, with and without damping, at many speeds, each with several numbers of
!! samples over the turn. No mode may be stable with one of them and unstable with another; undecided is allowed.
!!
!!     stability CASES SPEEDS THREADS [FIRST]
!!
!! Prints every mechanism and contradiction, and the share of undecided verdicts. Exit status 1 if there is a contradiction.
program stress_stability
  use, intrinsic :: iso_fortran_env, only: output_unit
  use errors, only: error_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use random_mechanisms, only: family_names, new_random_case, random_case_t
  use response_types, only: link_damping_t
  use stability, only: find_stability
  use stability_types, only: is_unstable, stability_request_t, stability_t, stable, undecided
  implicit none (type, external)

  integer, parameter :: samples(*) = [144, 160, 192, 256]

  !> Vibrations of the slowest link in a turn, of the fastest and of the slowest speed.
  real(wp), parameter :: vibrations(2) = [2.0_wp, 12.0_wp]

  !> Why there are no exponents, up to the first number, and how often.
  type :: reason_t
    character(len=:), allocatable :: text
    integer :: times = 0
  end type reason_t

  type(reason_t), allocatable :: reasons(:)
  integer :: cases, speeds, threads, first, number, contradictions, verdicts, undecided_ones, failed, unstable_ones

  call read_arguments(cases, speeds, threads, first)
  contradictions = 0
  verdicts = 0
  undecided_ones = 0
  unstable_ones = 0
  failed = 0
  allocate (reasons(0))
  do number = first, first + cases - 1
    call try(number)
  end do
  print "(i0, a, i0, a, i0, a)", cases, " mechanisms, ", cases*speeds, " speeds, ", size(samples), " numbers of samples"
  print "(i0, a, i0, a, i0, a, f0.2, a, i0, a, f0.2, a)", verdicts, " verdicts, ", unstable_ones, " unstable, ", undecided_ones, &
    " undecided (", 100.0_wp*undecided_ones/max(1, verdicts), " %); ", failed, " speeds without exponents (", &
    100.0_wp*failed/(cases*speeds*size(samples)), " %)"
  do number = 1, size(reasons)
    print "(i8, 2a)", reasons(number)%times, " times: ", reasons(number)%text
  end do
  print "(i0, a)", contradictions, " contradictions"
  print "(i0, a, i0, a)", verdicts - contradictions, " passed, ", contradictions, " failed"
  if (contradictions > 0) stop 1

contains

  subroutine read_arguments(cases, speeds, threads, first)
    integer, intent(out) :: cases, speeds, threads, first

    character(len=32) :: word
    integer :: number(4), i, status

    number(4) = 1
    do i = 1, max(3, min(command_argument_count(), 4))
      call get_command_argument(i, word)
      read (word, *, iostat=status) number(i)
      if (status /= 0 .or. number(i) < 1) error stop "usage: stability CASES SPEEDS THREADS [FIRST]"
    end do
    cases = number(1)
    speeds = number(2)
    threads = number(3)
    first = number(4)
  end subroutine read_arguments

  !> One mechanism; every second is damped.
  subroutine try(number)
    integer, intent(in) :: number

    type(random_case_t) :: case
    type(stability_request_t) :: request
    type(stability_t) :: found(size(samples))
    type(link_store_t) :: store
    type(error_t), allocatable :: error
    integer :: i, k

    case = new_random_case(number)
    request%damping = case%request%damping
    if (modulo(number, 2) == 1) request%damping = link_damping_t()
    request%terms = case%request%terms
    request%accuracy = 1.0e-6_wp
    request%speed = [(case%lowest/vibrations(2)*(vibrations(2)/vibrations(1))**(real(k - 1, wp)/max(1, speeds - 1)), k=1, speeds)]
    do i = 1, size(samples)
      request%samples = samples(i)
      call find_stability(case%structure, request, threads, store, found(i), error)
      if (allocated(error)) then
        print "(a, i0, 3a)", "mechanism ", number, " (", trim(family_names(case%family)), "): "//error%text
        failed = failed + speeds
        return
      end if
    end do
    do k = 1, speeds
      do i = 1, size(samples)
        if (.not. allocated(found(i)%at_speed(k)%exponent)) then
          call count_failure(found(i)%at_speed(k)%error)
          cycle
        end if
        associate (verdict => found(i)%at_speed(k)%exponent%verdict)
          verdicts = verdicts + size(verdict)
          undecided_ones = undecided_ones + count(verdict == undecided)
          unstable_ones = unstable_ones + count(is_unstable(verdict))
        end associate
      end do
      call compare(number, case, request%speed(k), k, found)
    end do
    print "(a, i0, 3a, 3(i0, a))", "mechanism ", number, " (", trim(family_names(case%family)), "): so far ", &
      verdicts, " verdicts, ", undecided_ones, " undecided, ", contradictions, " contradictions"
    flush (output_unit)
  end subroutine try

  !> Counts a speed without exponents.
  subroutine count_failure(error)
    type(error_t), intent(in) :: error

    type(reason_t) :: reason
    integer :: i, length

    failed = failed + 1
    length = scan(error%text, "0123456789") - 1
    if (length < 0) length = len(error%text)
    do i = 1, size(reasons)
      if (reasons(i)%text /= error%text(:length)) cycle
      reasons(i)%times = reasons(i)%times + 1
      return
    end do
    reason%text = error%text(:length)
    reason%times = 1
    reasons = [reasons, reason]
  end subroutine count_failure

  !> No exponent that grows with one number of samples may be stable with another. Modes may be numbered otherwise: that with the same
  !! turns is meant.
  subroutine compare(number, case, speed, k, found)
    integer, intent(in) :: number, k
    type(random_case_t), intent(in) :: case
    real(wp), intent(in) :: speed
    type(stability_t), intent(in) :: found(:)

    real(wp), parameter :: same_turns = 1.0e-3_wp
    integer :: a, b, i, j

    do i = 1, size(found)
      do j = 1, size(found)
        if (i == j) cycle
        if (.not. allocated(found(i)%at_speed(k)%exponent)) cycle
        if (.not. allocated(found(j)%at_speed(k)%exponent)) cycle
        do a = 1, size(found(i)%at_speed(k)%exponent)
          associate (one => found(i)%at_speed(k)%exponent(a))
            if (.not. is_unstable(one%verdict)) cycle
            do b = 1, size(found(j)%at_speed(k)%exponent)
              associate (other => found(j)%at_speed(k)%exponent(b))
                if (other%verdict /= stable .or. abs(other%turns - one%turns) > same_turns) cycle
                ! Another mode with the same turns may be stable, if this one is there, too.
                if (any(is_unstable(found(j)%at_speed(k)%exponent%verdict) .and. &
                  abs(found(j)%at_speed(k)%exponent%turns - one%turns) <= same_turns)) cycle
                contradictions = contradictions + 1
                print "(a, i0, 3a, f0.6, a, 2(i0, a), es10.3, a, i0, 2(a, es10.3))", "mechanism ", number, " (", &
                  trim(family_names(case%family)), ") at ", speed, " rad/s: mode ", one%mode, " grows with ", samples(i), &
                  " samples, by", one%growth, ", and is stable with ", samples(j), ":", other%growth, " +-", other%error
              end associate
            end do
          end associate
        end do
      end do
    end do
  end subroutine compare

end program stress_stability
