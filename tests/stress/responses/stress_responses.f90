!> The stress test of the elastic response: random mechanisms, each at an accuracy from 1e-3 to 1e-9, against the same at an
!! accuracy finer by `finer`, turned by `turned_by` and with every link that bends in two elements: other orders, other samples,
!! other axes. Estimated errors are to be above the true ones, but not by more than a factor `most_above` where these are above
!! `least_judged`.
!!
!!     responses CASES THREADS TABLE [FIRST]
!!
!! The table has one line a case; the count and the distribution of estimated/true errors are printed. Exit status 1 if an estimate
!! is too small.
program stress_responses
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use beam_mesh, only: beam_t
  use constants, only: degree
  use divided_structures, only: divide
  use errors, only: error_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use linkages, only: lump_t
  use random_mechanisms, only: family_names, new_random_case, of_resonance, random_case_t
  use response_types, only: axial_strain, bending_strain, power, response_request_t, response_t, rigid_torque, speed_response_t, &
    stress, total_torque
  use sorting, only: ascending_order
  use steady_responses, only: find_steady_responses
  implicit none (type, external)

  !> Accuracy of what counts as true, beside that of the case, and at best; what is tried after a failure.
  real(wp), parameter :: finer = 1.0e-4_wp, finest(2) = [3.0e-10_wp, 1.0e-8_wp]
  !> How the true one is turned [deg], and where its links are divided.
  real(wp), parameter :: turned_by = 50.0_wp, divided_at = 0.47_wp
  real(wp), parameter :: least_judged = 1.0e-9_wp, most_above = 100.0_wp
  !> Quantities that are zero by nature are measured against what goes with them, as the program does.
  real(wp), parameter :: by_nature = 1.0e-3_wp
  !> A case that takes longer is listed [s].
  real(wp), parameter :: slow = 2.0_wp

  !> Shares of the ratios below those printed.
  real(wp), parameter :: shares(*) = [0.0_wp, 0.001_wp, 0.01_wp, 0.1_wp, 0.5_wp, 0.9_wp, 0.99_wp, 0.999_wp, 1.0_wp]

  integer, parameter :: unjudged = 0, bounded = 1, too_large = 2, violated = 3, failed = 4
  character(len=*), parameter :: verdicts(0:4) = [character(len=9) :: "unjudged", "bounded", "TOO_LARGE", "VIOLATED", "failed"]

  !> One estimated error with the true one.
  type :: pair_t
    character(len=24) :: of = ""
    real(wp) :: estimate = 0.0_wp, true = 0.0_wp, unknown = 0.0_wp !! unknown: estimated error of the true value
    integer :: verdict = unjudged
  end type pair_t

  type :: result_t
    integer :: number = 0, family = 0, verdict = unjudged
    real(wp) :: accuracy = 0.0_wp, speed = 0.0_wp, lowest = 0.0_wp, sine = 0.0_wp, seconds = 0.0_wp, finest_seconds = 0.0_wp, &
      finest_error = 0.0_wp, balance = 0.0_wp
    logical :: reached = .false.
    character(len=:), allocatable :: reason
    type(speed_response_t) :: found
    type(pair_t), allocatable :: pairs(:)
  end type result_t

  type, bind(c) :: time_t
    integer(c_long) :: seconds, nanoseconds
  end type time_t

  interface
    function clock_gettime(clock, time) bind(c) result(status)
      import :: c_int, time_t
      integer(c_int), value :: clock
      type(time_t), intent(out) :: time
      integer(c_int) :: status
    end function clock_gettime
  end interface

  type(result_t), allocatable :: results(:)
  character(len=256) :: table
  integer :: cases, threads, first, i, unit

  call read_arguments(cases, threads, table, first)
  allocate (results(cases))
  open (newunit=unit, file=trim(table), action="write", status="replace")
  write (unit, "(a)") "# case family verdict accuracy speed speed/frequency sine order samples slow distance seconds "// &
    "finest_seconds finest_error balance worst_of estimate true largest_ratio reason"
  !$omp parallel do num_threads(threads) schedule(dynamic)
  do i = 1, cases
    call run_case(first + i - 1, results(i))
    !$omp critical
    call write_case(unit, results(i))
    flush (unit)
    !$omp end critical
  end do
  !$omp end parallel do
  close (unit)
  call report(results)
  print "(i0, a, i0, a)", count(results%verdict /= violated), " passed, ", count(results%verdict == violated), " failed"
  if (any(results%verdict == violated)) stop 1, quiet=.true.

contains

  subroutine read_arguments(cases, threads, table, first)
    integer, intent(out) :: cases, threads, first
    character(len=*), intent(out) :: table

    character(len=32) :: word

    if (command_argument_count() < 3) error stop "responses CASES THREADS TABLE [FIRST]"
    call get_command_argument(1, word)
    read (word, *) cases
    call get_command_argument(2, word)
    read (word, *) threads
    call get_command_argument(3, table)
    first = 1
    if (command_argument_count() < 4) return
    call get_command_argument(4, word)
    read (word, *) first
  end subroutine read_arguments

  !> Processor time of this thread [s].
  function thread_time() result(seconds)
    real(wp) :: seconds

    integer(c_int), parameter :: thread_clock = 3
    type(time_t) :: time
    integer(c_int) :: status

    status = clock_gettime(thread_clock, time)
    seconds = real(time%seconds, wp) + 1.0e-9_wp*real(time%nanoseconds, wp)
  end function thread_time

  subroutine run_case(number, result)
    integer, intent(in) :: number
    type(result_t), intent(out) :: result

    type(random_case_t) :: case
    type(response_t) :: found, true
    character(len=:), allocatable :: true_reason
    real(wp) :: seconds
    integer :: i

    case = new_random_case(number)
    result%number = number
    result%family = case%family
    result%accuracy = case%request%accuracy
    result%lowest = case%lowest
    result%sine = case%sine
    result%reason = "-"
    if (case%family == of_resonance) call move_to_resonance(case)
    result%speed = case%request%speed(1)
    call solve(case, case%request%accuracy, found, result%seconds, result%reason)
    result%verdict = failed
    if (result%reason /= "-") return
    result%found = found%at_speed(1)
    result%reached = result%found%largest_error <= result%accuracy
    if (.not. result%reached) result%reason = "accuracy= is not reached"
    result%verdict = unjudged
    true_reason = "-"
    do i = 1, size(finest)
      true_reason = "-"
      call solve(turned(case), max(finest(i), finer*result%accuracy), true, seconds, true_reason)
      result%finest_seconds = result%finest_seconds + seconds
      if (true_reason == "-") exit
    end do
    if (true_reason /= "-") then
      result%reason = "true values: "//true_reason
      return
    end if
    call turn_back(true%at_speed(1)%displacement)
    result%finest_error = true%at_speed(1)%largest_error
    call judge(case%request, case%structure%beams, case%structure%linkage%bodies%length, result%found, &
      true%at_speed(1), result%pairs)
    result%verdict = maxval(result%pairs%verdict)
    associate (here => result%found)
      if (case%request%terms%coriolis .and. case%request%terms%centripetal .and. case%request%terms%quadratic .and. &
        case%request%terms%axial .and. .not. any(abs(case%structure%linkage%couple) > 0.0_wp)) result%balance = &
        (here%mean_torque*result%speed - sum(here%power_lost))/max(maxval(abs(here%drive(power, :))), tiny(1.0_wp))
    end associate
  end subroutine run_case

  !> The same mechanism, turned, with its links divided by masses of nothing.
  function turned(case) result(other)
    type(random_case_t), intent(in) :: case
    type(random_case_t) :: other

    type(lump_t), allocatable :: lumps(:)
    integer :: b, n, p

    other = case
    other%request%crank = case%request%crank + turned_by
    associate (linkage => other%structure%linkage)
      linkage%gravity = rotated(linkage%gravity, turned_by)
      do p = 1, size(linkage%pin_mass)
        linkage%pin_force(:, p) = rotated(linkage%pin_force(:, p), turned_by)
        linkage%ground_position(:, p) = rotated(linkage%ground_position(:, p), turned_by)
      end do
      do b = 1, size(linkage%bodies)
        if (.not. linkage%bodies(b)%bends) cycle
        n = size(linkage%bodies(b)%lumps)
        allocate (lumps(n + 1))
        lumps(:n) = linkage%bodies(b)%lumps
        lumps(n + 1)%place(1) = divided_at*linkage%bodies(b)%length
        call move_alloc(lumps, linkage%bodies(b)%lumps)
      end do
    end associate
    call divide(other%structure)
  end function turned

  pure function rotated(vector, angle) result(other)
    real(wp), intent(in) :: vector(2), angle !! [deg]
    real(wp) :: other(2)

    other = cos(angle*degree)*vector + sin(angle*degree)*[-vector(2), vector(1)]
  end function rotated

  subroutine turn_back(displacement)
    real(wp), intent(inout) :: displacement(:, :, :)

    integer :: i, k

    do k = 1, size(displacement, 3)
      do i = 1, size(displacement, 2)
        displacement(:2, i, k) = rotated(displacement(:2, i, k), -turned_by)
      end do
    end do
  end subroutine turn_back

  subroutine solve(case, accuracy, found, seconds, reason)
    type(random_case_t), intent(in) :: case
    real(wp), intent(in) :: accuracy
    type(response_t), intent(out) :: found
    real(wp), intent(out) :: seconds
    character(len=:), allocatable, intent(inout) :: reason

    type(response_request_t) :: request
    type(link_store_t) :: store
    type(error_t), allocatable :: error

    request = case%request
    request%accuracy = accuracy
    seconds = thread_time()
    call find_steady_responses(case%structure, request, 1, store, found, error)
    seconds = thread_time() - seconds
    if (allocated(error)) then
      reason = error%text
    else if (allocated(found%at_speed(1)%error)) then
      reason = found%at_speed(1)%error%text
    end if
  end subroutine solve

  !> The speed within a factor of 1.5 of the given one at which a multiplier is nearest to 1.
  subroutine move_to_resonance(case)
    type(random_case_t), intent(inout) :: case

    real(wp), parameter :: golden = 0.381966011250105_wp
    type(response_request_t) :: request
    type(response_t) :: found
    type(link_store_t) :: store
    type(error_t), allocatable :: error
    real(wp) :: distance(21), low, high, x(2)
    integer :: i, k

    request = case%request
    request%accuracy = 1.0e-2_wp
    request%gauges = request%gauges(:1)
    request%points = request%points(:0)
    request%crank = request%crank(:1)
    request%peaks = .false.
    request%speed = [(case%request%speed(1)*1.5_wp**(real(i - 11, wp)/10.0_wp), i=1, size(distance))]
    call find_steady_responses(case%structure, request, 1, store, found, error)
    if (allocated(error)) return
    distance = huge(1.0_wp)
    do i = 1, size(distance)
      if (.not. allocated(found%at_speed(i)%error)) distance(i) = found%at_speed(i)%distance
    end do
    k = max(2, min(size(distance) - 1, minloc(distance, dim=1)))
    low = request%speed(k - 1)
    high = request%speed(k + 1)
    ! As near as chance will have it.
    do i = 1, modulo(case%number, 8)
      x = [low + golden*(high - low), high - golden*(high - low)]
      request%speed = x
      call find_steady_responses(case%structure, request, 1, store, found, error)
      if (allocated(error)) return
      if (allocated(found%at_speed(1)%error) .or. allocated(found%at_speed(2)%error)) exit
      if (found%at_speed(1)%distance < found%at_speed(2)%distance) then
        high = x(2)
      else
        low = x(1)
      end if
    end do
    case%request%speed = [0.5_wp*(low + high)]
  end subroutine move_to_resonance

  !> All estimated errors of a case with the true ones.
  subroutine judge(request, beams, lengths, found, true, pairs)
    type(response_request_t), intent(in) :: request
    type(beam_t), intent(in) :: beams(:)
    real(wp), intent(in) :: lengths(:)
    type(speed_response_t), intent(in) :: found, true
    type(pair_t), allocatable, intent(out) :: pairs(:)

    real(wp) :: errors(6), least(6), powers, strain
    integer :: i, k

    allocate (pairs(0))
    do i = 1, size(request%points)
      errors(1) = difference(found%displacement(:2, i, :), true%displacement(:2, i, :))
      errors(2) = difference(found%displacement(3:3, i, :), true%displacement(3:3, i, :), by_nature* &
        maxval(norm2(true%displacement(:2, i, :), dim=1))/lengths(request%points(i)%body))
      call add_pair(pairs, [character(len=12) :: "displacement", "rotation"], i, found%displacement_error(i), errors(:2), &
        true%displacement_error(i))
    end do
    do i = 1, size(request%gauges)
      ! Largest strain at the gauge, and what goes with it.
      strain = maxval(abs(true%strain(axial_strain, i, :))) + maxval(abs(true%strain(bending_strain, i, :)))
      associate (beam => beams(request%gauges(i)%body), section => request%section(request%gauges(i)%body))
        least = by_nature*strain*[1.0_wp, 1.0_wp, beam%bending_stiffness/section%outer, beam%axial_stiffness, &
          by_nature*beam%axial_stiffness, 0.0_wp]
      end associate
      do k = axial_strain, stress
        errors(k) = difference(found%strain(k:k, i, :), true%strain(k:k, i, :), least(k))
      end do
      call add_pair(pairs, [character(len=12) :: "axial_strain", "bending", "moment", "axial_force", "shear_force", "stress"], i, &
        found%strain_error(i), errors, true%strain_error(i))
    end do
    do k = rigid_torque, total_torque
      errors(k) = difference(found%drive(k:k, :), true%drive(k:k, :), by_nature*maxval(abs(true%drive(total_torque, :))))
    end do
    call add_pair(pairs, [character(len=12) :: "rigid", "linear", "quadratic", "total"], 0, found%drive_error, errors(:4), &
      true%drive_error)
    powers = sum(true%power_lost)
    do i = 1, size(found%peak_error)
      if (.not. true%largest_strain(i)%value > 0.0_wp) cycle
      errors(1) = abs(found%largest_strain(i)%value - true%largest_strain(i)%value)/ &
        max(true%largest_strain(i)%value, by_nature**2*maxval(true%largest_strain%value))
      errors(2) = abs(found%largest_deflection(i)%value/true%largest_deflection(i)%value - 1.0_wp)
      errors(3) = 0.0_wp
      if (powers > 0.0_wp) errors(3) = abs(found%power_lost(i) - true%power_lost(i))/powers
      call add_pair(pairs, [character(len=12) :: "strain_peak", "deflection", "power_lost"], i, found%peak_error(i), errors(:3), &
        true%peak_error(i))
    end do
  end subroutine judge

  !> One estimated error of several quantities: the largest true one counts.
  subroutine add_pair(pairs, names, number, estimate, errors, unknown)
    type(pair_t), allocatable, intent(inout) :: pairs(:)
    character(len=*), intent(in) :: names(:)
    integer, intent(in) :: number
    real(wp), intent(in) :: estimate, errors(:), unknown

    type(pair_t) :: pair

    write (pair%of, "(a,a,i0)") trim(names(maxloc(errors, dim=1))), "_", number
    pair%estimate = estimate
    pair%true = maxval(errors)
    pair%unknown = unknown
    pair%verdict = bounded
    if (.not. pair%true <= estimate) then
      ! What is not known of the true value may be to blame.
      pair%verdict = merge(unjudged, violated, pair%true - unknown <= estimate)
    else if (pair%true > least_judged .and. estimate > most_above*(pair%true + unknown)) then
      pair%verdict = too_large
    end if
    pairs = [pairs, pair]
  end subroutine add_pair

  !> Largest difference over the turn beside the largest value, or what is given; of vectors their lengths.
  pure function difference(found, true, least) result(error)
    real(wp), intent(in) :: found(:, :), true(:, :) !! (components, positions)
    real(wp), intent(in), optional :: least
    real(wp) :: error

    real(wp) :: largest

    largest = sqrt(maxval(sum(true**2, dim=1)))
    if (present(least)) largest = max(largest, least)
    error = 0.0_wp
    if (largest > 0.0_wp) error = sqrt(maxval(sum((found - true)**2, dim=1)))/largest
  end function difference

  !> The pair with the largest true error beside its estimate.
  pure function worst_of(pairs) result(worst)
    type(pair_t), intent(in) :: pairs(:)
    integer :: worst

    worst = maxloc(pairs%true/max(pairs%estimate, tiny(1.0_wp)) + 1.0e6_wp*pairs%verdict, dim=1)
  end function worst_of

  subroutine write_case(unit, result)
    integer, intent(in) :: unit
    type(result_t), intent(in) :: result

    type(pair_t) :: worst
    integer :: i

    if (allocated(result%pairs)) worst = result%pairs(worst_of(result%pairs))
    write (unit, "(i0,1x,a,1x,a,es8.0,2es13.5,f7.3,3(1x,i0),es10.2,2f8.3,2es10.2,1x,a,3es10.2,1x,a)") result%number, &
      trim(family_names(result%family)), trim(verdicts(result%verdict)), result%accuracy, result%speed, &
      abs(result%speed)/result%lowest, result%sine, result%found%order, result%found%samples, result%found%slow, &
      result%found%distance, result%seconds, result%finest_seconds, result%finest_error, result%balance, trim(worst%of), &
      worst%estimate, worst%true, worst%true/max(worst%estimate, tiny(1.0_wp)), result%reason
    if (allocated(result%pairs)) then
      do i = 1, size(result%pairs)
        associate (pair => result%pairs(i))
          if (pair%verdict < too_large) cycle
          write (unit, "(a,i0,2(1x,a),3es10.2)") "#   case ", result%number, trim(verdicts(pair%verdict)), &
            trim(pair%of)//": estimate, true, unknown", pair%estimate, pair%true, pair%unknown
        end associate
      end do
    end if
    flush (unit)
  end subroutine write_case

  !> Counts, and the distribution of the ratio of estimated to true errors.
  subroutine report(results)
    type(result_t), intent(in) :: results(:)

    real(wp), allocatable :: ratio(:), seconds(:)
    integer, allocatable :: order(:)
    integer :: i, k, f, n, pairs

    print "(a)", "family          cases bounded not_judged too_large violated failed not_reached  worst est/true: least  median"// &
      "   largest  time: median  largest [s]"
    do f = 0, size(family_names)
      ratio = [real(wp) ::]
      seconds = [real(wp) ::]
      n = 0
      pairs = 0
      do i = 1, size(results)
        if (f > 0 .and. results(i)%family /= f) cycle
        n = n + 1
        seconds = [seconds, results(i)%seconds]
        if (.not. allocated(results(i)%pairs)) cycle
        do k = 1, size(results(i)%pairs)
          associate (pair => results(i)%pairs(k))
            pairs = pairs + 1
            if (pair%true > 10.0_wp*pair%unknown) ratio = [ratio, pair%estimate/pair%true]
          end associate
        end do
      end do
      if (n == 0) cycle
      order = ascending_order(ratio)
      ratio = ratio(order)
      order = ascending_order(seconds)
      seconds = seconds(order)
      if (f == 0) then
        print "(a,i0,a,i0,a)", "estimated/true error of ", size(ratio), " of ", pairs, &
          " values whose true error is ten times above what is known of it:"
        if (size(ratio) > 0) print "(*(a,f0.1,a,es9.2))", ("  ", 100.0_wp*shares(k), "%:", &
          ratio(max(1, nint(shares(k)*size(ratio)))), k=1, size(shares))
      end if
      if (size(ratio) == 0) ratio = [0.0_wp]
      print "(a14,6i9,i12,8x,3es10.2,4x,2f9.3)", merge("all           ", family_names(max(1, f)), f == 0), n, &
        (count(results%verdict == k .and. (results%family == f .or. f == 0)), k=bounded, bounded), &
        count(results%verdict == unjudged .and. (results%family == f .or. f == 0)), &
        (count(results%verdict == k .and. (results%family == f .or. f == 0)), k=too_large, failed), &
        count(.not. results%reached .and. results%verdict /= failed .and. (results%family == f .or. f == 0)), &
        ratio(1), ratio((size(ratio) + 1)/2), ratio(size(ratio)), seconds((n + 1)/2), seconds(n)
    end do
    do i = 1, size(results)
      associate (result => results(i))
        if (result%verdict == violated) print "(a,i0,1x,a)", "violated: case ", result%number, trim(family_names(result%family))
        if (result%verdict == failed) print "(a,i0,1x,3a,f0.3,a)", "failed: case ", result%number, &
          trim(family_names(result%family)), " ", result%reason//" ", result%seconds, " s"
        if (result%seconds > slow) print "(a,i0,1x,a,es8.0,a,f0.3,a)", "slow: case ", result%number, &
          trim(family_names(result%family)), result%accuracy, " ", result%seconds, " s"
      end associate
    end do
  end subroutine report

end program stress_responses
