!> The exponents of two vibrations whose multipliers meet, at any speed near that: by the slow
!! motion, or by the whole equation.
module meeting_exponents
  use constants, only: pi
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use exponent_meetings, only: exponent_pair_t
  use floquet_exponents, only: find_floquet_modes, find_floquet_pair, floquet_mode_t, floquet_pair_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use interruption, only: was_interrupted
  use kinds, only: wp
  use motion_tables, only: motion_table_t
  use multiplier_stations, only: left_of, plane_t, state_of
  use order_transfer, only: transferred_halves
  use response_levels, only: level_t, set_equation
  use response_types, only: no_damping
  use stability_types, only: stability_request_t
  use turn_spectra, only: find_spectrum, turn_spectrum_t
  implicit none (type, external)
  private

  public :: meeting_t, meeting_pair_t, open_pair, close_pair, begin_with, find_numbers, bound_growth

  !> Two motions are those of the meeting if no more than this is left of them beside the plane at a
  !! speed near by, and their angles are as near as this to the mean one [turns].
  real(wp), parameter :: most_left = 0.9_wp, near_enough = 0.35_wp

  !> Real parts above this are off the circle, and angles as near as this are that of a meeting.
  real(wp), parameter :: off_circle = 1.0e-6_wp, at_angle = 5.0e-3_wp

  !> Exponents farther from each other than this are found each by itself, well enough.
  real(wp), parameter :: apart_enough = 0.1_wp

  !> The square of the difference of exponents by the whole equation is to change by no more than
  !! this share of the largest in the last round; it is not found where it changes by more than the
  !! second, or where the difference is farther than the third from that of the slow motion [turns].
  real(wp), parameter :: fine_change = 1.0e-5_wp, most_change = 1.0e-3_wp, farthest = 1.0e-2_wp

  !> Exponents of the slow motion that differ by no more than the first are of one mode at speeds
  !! near each other; those of a pair σ, −σ̄ by no more than the second.
  real(wp), parameter :: same_mode = 0.03_wp, of_pair = 1.0e-5_wp

  !> No smaller change of one exponent is asked for [turns].
  real(wp), parameter :: least_change = 1.0e-12_wp

  !> Actions change by this share for other reasons than a meeting, near it.
  real(wp), parameter :: other_change = 0.02_wp

  !> Two multipliers that meet, by the slow motion.
  type :: meeting_t
    type(plane_t), allocatable :: plane(:) !! their spaces at speeds about it
    real(wp) :: from = 0.0_wp, at = 0.0_wp, to = 0.0_wp !! where they are off the circle, and most
    real(wp) :: growth = 0.0_wp            !! there [nepers a turn]
    logical :: is_own = .false.            !! of one vibration: real multipliers, else those of two
  end type meeting_t

  type, extends(exponent_pair_t) :: meeting_pair_t
    type(stability_request_t), pointer :: request => null()
    type(level_t), pointer :: level => null()
    integer :: slow = 0               !! coordinates
    type(motion_table_t), pointer :: table => null() !! not by the whole equation: of slow motions
    logical :: whole = .false.        !! by the whole equation
    type(meeting_t) :: meeting
    type(fourier_plan_t) :: plan      !! open
    type(turn_spectrum_t) :: spectrum !! at the last speed
    type(floquet_pair_t) :: pair      !! at the last speed
    logical :: was_conjugate = .false. !! the first mode of the pair stands for its conjugate
    !> The modes found last each by itself, and their exponents by the slow motion; of the first
    !! only, where it has those of the second
    type(floquet_mode_t), allocatable :: each(:)
    complex(wp), allocatable :: slow_each(:)
    real(wp) :: largest = 0.0_wp       !! square of their difference at any speed so far
    real(wp) :: doubt = 0.0_wp         !! largest change in the last round, in terms of that
    integer :: number(2) = 0          !! of both vibrations by their shapes, at the last speed
    real(wp) :: action(2) = 0.0_wp    !! of both, without sign, in the slow motion there
    type(error_t), allocatable :: error !! why there is none at the last speed
  contains
    procedure :: evaluate
    procedure :: find_spectrum => find_its_spectrum
  end type meeting_pair_t

contains

  !> Makes the exponents of a meeting ready for evaluation on a level.
  subroutine open_pair(request, level, slow, meeting, whole, pair, table)
    type(stability_request_t), intent(in), target :: request !! damping, terms
    type(level_t), intent(in), target :: level               !! with the slow coordinates
    integer, intent(in) :: slow                              !! their number
    type(meeting_t), intent(in) :: meeting                   !! two multipliers; none for spectra
                                                             !! only
    logical, intent(in) :: whole                             !! by the whole equation, else by the
                                                             !! slow motion
    type(meeting_pair_t), intent(out) :: pair                !! to be closed
    type(motion_table_t), intent(in), target, optional :: table !! of the level; absent: none

    if (present(table)) pair%table => table
    pair%request => request
    pair%level => level
    pair%slow = slow
    pair%meeting = meeting
    pair%whole = whole
    pair%largest = (meeting%growth/pi)**2
    pair%is_damped = any(request%damping%kind /= no_damping)
    call open_fourier(level%grid%samples, pair%plan)
  end subroutine open_pair

  !> Ends the evaluation.
  subroutine close_pair(pair)
    type(meeting_pair_t), intent(inout) :: pair

    call close_fourier(pair%plan)
  end subroutine close_pair

  !> Finds the numbers of both vibrations at a speed, by their shapes in the slow motion.
  subroutine find_numbers(pair, speed, good)
    class(meeting_pair_t), intent(inout) :: pair !! gets them
    real(wp), intent(in) :: speed                !! |ω2| [rad/s]
    logical, intent(out) :: good

    complex(wp) :: ignored(2)
    logical :: whole

    whole = pair%whole
    pair%whole = .false.
    call pair%evaluate(speed, ignored(1), ignored(2), good)
    pair%whole = whole
  end subroutine find_numbers

  !> A bound of the growth of a meeting from a speed beside it. Exponents of two that meet differ
  !! by `√(x² − g²)`, x linear in the speed, and their actions are `√(1 − g²/x²)` of those far away.
  subroutine bound_growth(pair, speed, action, growth)
    class(meeting_pair_t), intent(inout) :: pair
    real(wp), intent(in) :: speed     !! |ω2| [rad/s]
    real(wp), intent(in) :: action(2) !! of both far from the meeting, without sign
    real(wp), intent(out) :: growth   !! no more than this [nepers a turn]; huge: not known

    complex(wp) :: total, square
    real(wp) :: ratio
    logical :: good

    growth = huge(1.0_wp)
    call pair%evaluate(speed, total, square, good)
    if (.not. good .or. real(square) <= 0.0_wp .or. minval(pair%action) <= 0.0_wp) return
    ratio = (1.0_wp + other_change)*max(1.0_wp, maxval(action)/minval(pair%action))
    growth = pi*sqrt(real(square)*(ratio**2 - 1.0_wp))
  end subroutine bound_growth

  !> Begins with the motions found on another level.
  subroutine begin_with(other, pair)
    type(meeting_pair_t), intent(in) :: other   !! evaluated, orders no higher than of the pair
    type(meeting_pair_t), intent(inout) :: pair !! of the same meeting

    integer :: i

    pair%was_conjugate = other%was_conjugate
    pair%pair%waves = other%pair%waves
    if (allocated(other%each)) then
      pair%each = other%each
      pair%slow_each = other%slow_each
      do i = 1, size(pair%each)
        pair%each(i)%motion = moved(other%each(i)%motion)
      end do
    end if
    if (.not. allocated(other%pair%known)) return
    allocate (pair%pair%known(pair%level%grid%samples, 2*pair%level%grid%unknowns, &
      size(other%pair%known, 3)))
    do i = 1, size(other%pair%known, 3)
      pair%pair%known(:, :, i) = moved(other%pair%known(:, :, i))
    end do

  contains

    !> A motion on the level of the pair.
    function moved(motion) result(there)
      real(wp), intent(in) :: motion(:, :)
      real(wp), allocatable :: there(:, :)

      call transferred_halves(other%level%grid, other%plan, pair%level%grid, pair%plan, motion, &
        there)
    end function moved

  end subroutine begin_with

  !> The free motions of the slow coordinates at a speed, or `error`.
  subroutine find_its_spectrum(self, speed)
    class(meeting_pair_t), intent(inout) :: self
    real(wp), intent(in) :: speed !! |ω2| [rad/s]

    type(turn_spectrum_t) :: spectrum

    call find_spectrum(self%level, self%plan, self%slow, speed, spectrum, self%error, &
      table=self%table)
    self%spectrum = spectrum
  end subroutine find_its_spectrum

  !> Sum and −(σ1 − σ2)² at a speed.
  subroutine evaluate(self, place, total, square, good)
    class(meeting_pair_t), intent(inout), target :: self
    real(wp), intent(in) :: place               !! |ω2| [rad/s]
    complex(wp), intent(out) :: total, square
    logical, intent(out) :: good

    type(equation_at_speed_t) :: equation
    complex(wp) :: exponent(2)
    real(wp) :: change
    integer :: attempt, mode(2), waves
    logical :: conjugate(2), each_first

    total = 0.0_wp
    square = 0.0_wp
    good = place > 0.0_wp
    if (.not. good) return
    call self%find_spectrum(place)
    good = .not. allocated(self%error)
    if (.not. good) return
    call find_modes(self%spectrum, self%meeting%plane, place, mode, conjugate, good)
    if (.not. good) return
    self%number = self%spectrum%number(mode)
    self%action = abs(self%spectrum%mode(mode)%action)
    call restore
    ! Motions near by, or each by itself, may lead to other modes: then the other way.
    if (self%whole) then
      call set_equation(self%level, self%plan, self%spectrum%motion, place, self%request%damping, &
        self%request%terms, equation)
      each_first = abs(exponent(1) - exponent(2)) > apart_enough
      do attempt = 1, 3
        call restore
        if (attempt > 1 .and. allocated(self%pair%known)) deallocate (self%pair%known)
        if (attempt == merge(1, 3, each_first)) then
          call refine_each
        else
          call refine_both
        end if
        if (good) exit
      end do
    end if
    if (self%whole .and. good) then
      self%largest = max(self%largest, abs(exponent(1) - exponent(2))**2)
      self%doubt = max(self%doubt, change/self%largest)
    end if
    total = sum(exponent)
    square = -(exponent(1) - exponent(2))**2

  contains

    !> Exponents of the slow motion.
    subroutine restore
      exponent = self%spectrum%mode(mode)%exponent
      where (conjugate) exponent = conjg(exponent)
      waves = nint(aimag(exponent(1) - exponent(2)))
      exponent(2) = exponent(2) + cmplx(0.0_wp, waves, wp)
    end subroutine restore

    !> Exponents of the whole equation, each by itself; without damping that of the first off the
    !! circle is that of the second, too.
    subroutine refine_each
      type(floquet_mode_t) :: found(2)
      type(floquet_mode_t), allocatable :: known(:) !! none: absent
      complex(wp) :: better(2), slow(2)
      integer :: n

      slow = self%spectrum%mode(mode)%exponent
      n = 2
      if (.not. self%is_damped .and. abs(real(exponent(1))) > off_circle .and. abs(exponent(1) + &
        conjg(exponent(2))) <= of_pair) n = 1
      if (is_near(slow(:n))) then
        known = self%each(:n)
        known%exponent = slow(:n) + known%exponent - self%slow_each(:n)
      end if
      call find_floquet_modes(equation, max(0.25_wp*fine_change*abs(exponent(1) - exponent(2)), &
        least_change), self%spectrum%mode, mode(:n), found(:n), known)
      ! Then nothing has been found.
      good = .not. was_interrupted()
      if (.not. good) return
      better = found%exponent
      where (conjugate) better = conjg(better)
      if (n == 1) then
        better(2) = -conjg(better(1))
        found(2)%change = found(1)%change
      end if
      better(2) = better(2) + cmplx(0.0_wp, nint(aimag(better(1) - better(2))), wp)
      call check(better(1) - better(2), exponent(1) - exponent(2), 2.0_wp*abs(better(1) - &
        better(2))*sum(found%change))
      exponent = better
      if (.not. good) return
      self%each = found(:n)
      self%slow_each = slow(:n)
    end subroutine refine_each

    !> Whether motions known are of modes with about these exponents by the slow motion.
    pure function is_near(slow) result(near)
      complex(wp), intent(in) :: slow(:)
      logical :: near

      near = allocated(self%each)
      if (near) near = size(self%each) >= size(slow)
      if (near) near = all(abs(slow - self%slow_each(:size(slow))) <= same_mode)
    end function is_near

    !> The same together, both for the first mode as it is, not its conjugate.
    subroutine refine_both
      complex(wp) :: apart
      integer :: more

      apart = exponent(1) - exponent(2)
      more = waves
      if (conjugate(1)) more = -more
      ! Motions of another sheet are of no use.
      if ((self%was_conjugate .neqv. conjugate(1)) .or. self%pair%waves /= more) then
        if (allocated(self%pair%known)) deallocate (self%pair%known)
      end if
      self%was_conjugate = conjugate(1)
      self%pair%mode = mode
      self%pair%conjugate = conjugate(1) .neqv. conjugate(2)
      self%pair%waves = more
      self%pair%tolerance = fine_change*self%largest
      call find_floquet_pair(equation, self%spectrum%mode, self%pair)
      good = .not. was_interrupted()
      if (.not. good) return
      exponent = self%pair%exponent
      call check(exponent(1) - exponent(2), merge(conjg(apart), apart, conjugate(1)), &
        self%pair%change)
    end subroutine refine_both

    !> Whether a difference is good enough.
    subroutine check(difference, slow, last_change)
      complex(wp), intent(in) :: difference, slow !! of exponents, that of the slow motion
      real(wp), intent(in) :: last_change         !! of the square, in the last round

      change = last_change
      good = change <= most_change*max(self%largest, abs(difference)**2) .and. abs(difference**2 - &
        slow**2) <= farthest*(2.0_wp*abs(slow) + farthest)
    end subroutine check

  end subroutine evaluate

  !> The two multipliers of a meeting at a speed: numbers of their modes, and whether each is the
  !! conjugate.
  pure subroutine find_modes(spectrum, plane, speed, mode, conjugate, good)
    type(turn_spectrum_t), intent(in) :: spectrum
    type(plane_t), intent(in) :: plane(:) !! at speeds near by
    real(wp), intent(in) :: speed
    integer, intent(out) :: mode(2)
    logical, intent(out) :: conjugate(2)
    logical, intent(out) :: good

    real(wp) :: apart, cost, expected, least(2), left
    integer :: i, k, kind

    mode = 0
    conjugate = .false.
    least = huge(1.0_wp)
    associate (here => plane(minloc(abs(plane%speed - speed), dim=1)))
      expected = here%turns - here%rate*log(speed/here%speed)
      do k = 1, size(spectrum%mode)
        associate (candidate => spectrum%mode(k))
          do kind = 1, merge(2, 1, candidate%is_complex)
            apart = merge(-1, 1, kind == 2)*aimag(candidate%exponent) - expected
            apart = abs(apart - anint(apart))
            if (apart > near_enough) cycle
            if (kind == 1) left = left_of(here, state_of(candidate%start, speed* &
              spectrum%motion%scale))
            if (kind == 2) left = left_of(here, state_of(conjg(candidate%start), speed* &
              spectrum%motion%scale))
            ! Two off the circle at the angle of the meeting are those, though a third mixes in.
            if (left > most_left .and. .not. (abs(real(candidate%exponent)) > off_circle .and. &
              apart < at_angle)) cycle
            cost = (apart/near_enough)**2 + (left/most_left)**2
            i = 1
            if (cost >= least(1)) i = 2
            if (cost >= least(2)) cycle
            if (i == 1) then
              mode(2) = mode(1)
              conjugate(2) = conjugate(1)
              least(2) = least(1)
            end if
            mode(i) = k
            conjugate(i) = kind == 2
            least(i) = cost
          end do
        end associate
      end do
    end associate
    good = all(mode > 0)
  end subroutine find_modes

end module meeting_exponents
