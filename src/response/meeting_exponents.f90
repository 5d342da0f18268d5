!> The exponents of two vibrations near their meeting, at any speed: by the slow motion, or by the
!! whole equation.
module meeting_exponents
  use constants, only: pi
  use errors, only: error_t
  use exponent_meetings, only: exponent_pair_t
  use floquet_exponents, only: find_floquet_pair, floquet_pair_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use kinds, only: wp
  use order_transfer, only: transferred_halves
  use response_levels, only: damping_of, level_t
  use response_types, only: no_damping
  use stability, only: find_spectrum, turn_spectrum_t
  use stability_types, only: stability_request_t
  use vibration_branches, only: frequency_at, meeting_t, unlikeness
  implicit none (type, external)
  private

  public :: meeting_pair_t, open_pair, close_pair, begin_with, find_numbers

  !> Multipliers are those of the meeting if they are as near as this to where they are expected
  !! [turns], and if their shapes have frequencies between those of the vibrations, but for this
  !! share; of several that which is nearest and most like the vibration.
  real(wp), parameter :: near_enough = 0.05_wp, like_enough = 0.3_wp, unlike_enough = 0.4_wp

  !> Actions above this are certain of their sign, without and with damping.
  real(wp), parameter :: certain(2) = [0.1_wp, 0.6_wp]

  !> The square of the difference of exponents by the whole equation is to change by no more than
  !! this share of the largest in the last round; it is not found where it changes by more than the
  !! second, or where the difference is farther than the third from that of the slow motion [turns].
  real(wp), parameter :: fine_change = 1.0e-5_wp, most_change = 1.0e-3_wp, farthest = 5.0e-3_wp

  type, extends(exponent_pair_t) :: meeting_pair_t
    type(stability_request_t), pointer :: request => null()
    type(level_t), pointer :: level => null()
    integer :: slow = 0               !! coordinates
    logical :: whole = .false.        !! by the whole equation
    type(meeting_t) :: meeting
    type(fourier_plan_t) :: plan      !! open
    type(turn_spectrum_t) :: spectrum !! at the last speed
    type(floquet_pair_t) :: pair      !! at the last speed
    logical :: was_conjugate = .false. !! the first mode of the pair stands for its conjugate
    real(wp) :: largest = 0.0_wp       !! square of their difference at any speed so far
    real(wp) :: doubt = 0.0_wp         !! largest change in the last round, in terms of that
    integer :: number(2) = 0          !! of both vibrations by their shapes, at the last speed
    type(error_t), allocatable :: error !! why there is none at the last speed
  contains
    procedure :: evaluate
    procedure :: find_spectrum => find_its_spectrum
  end type meeting_pair_t

contains

  !> Makes the exponents of a meeting ready for evaluation on a level.
  subroutine open_pair(request, level, slow, meeting, whole, pair, growth)
    type(stability_request_t), intent(in), target :: request !! damping, terms
    type(level_t), intent(in), target :: level               !! with the slow coordinates
    integer, intent(in) :: slow                              !! their number
    type(meeting_t), intent(in) :: meeting                   !! two vibrations; none for spectra
                                                             !! only
    logical, intent(in) :: whole                             !! by the whole equation, else by the
                                                             !! slow motion
    type(meeting_pair_t), intent(out) :: pair                !! to be closed
    real(wp), intent(in), optional :: growth                 !! expected [nepers a turn]

    pair%request => request
    pair%level => level
    pair%slow = slow
    pair%meeting = meeting
    pair%whole = whole
    if (present(growth)) pair%largest = (growth/pi)**2
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

  !> Begins with the motions found on another level.
  subroutine begin_with(other, pair)
    type(meeting_pair_t), intent(in) :: other   !! evaluated, orders no higher than of the pair
    type(meeting_pair_t), intent(inout) :: pair !! of the same meeting

    real(wp), allocatable :: motion(:, :)
    integer :: i

    if (.not. allocated(other%pair%known)) return
    pair%was_conjugate = other%was_conjugate
    pair%pair%waves = other%pair%waves
    allocate (pair%pair%known(pair%level%grid%samples, 2*pair%level%grid%unknowns, &
      size(other%pair%known, 3)))
    do i = 1, size(other%pair%known, 3)
      call transferred_halves(other%level%grid, other%plan, pair%level%grid, pair%plan, &
        other%pair%known(:, :, i), motion)
      pair%pair%known(:, :, i) = motion
    end do
  end subroutine begin_with

  !> The free motions of the slow coordinates at a speed, or `error`.
  subroutine find_its_spectrum(self, speed)
    class(meeting_pair_t), intent(inout) :: self
    real(wp), intent(in) :: speed !! |ω2| [rad/s]

    type(turn_spectrum_t) :: spectrum

    call find_spectrum(self%level, self%plan, self%slow, speed, spectrum, self%error)
    self%spectrum = spectrum
  end subroutine find_its_spectrum

  !> Sum and −(σ1 − σ2)² at a speed.
  subroutine evaluate(self, place, total, square, good)
    class(meeting_pair_t), intent(inout) :: self
    real(wp), intent(in) :: place               !! |ω2| [rad/s]
    complex(wp), intent(out) :: total, square
    logical, intent(out) :: good

    complex(wp) :: exponent(2)
    integer :: mode(2), waves(2)
    logical :: conjugate(2)

    total = 0.0_wp
    square = 0.0_wp
    call self%find_spectrum(place)
    good = .not. allocated(self%error)
    if (.not. good) return
    call find_modes(self%spectrum, self%meeting, place, certain(merge(2, 1, self%is_damped)), &
      mode, conjugate, waves, exponent, good)
    if (.not. good) return
    self%number = self%spectrum%number(mode)
    if (self%whole) then
      call refine(exponent(1) - exponent(2))
      exponent = self%pair%exponent
    end if
    total = sum(exponent)
    square = -(exponent(1) - exponent(2))**2

  contains

    !> Exponents of the whole equation, both for the first mode as it is, not its conjugate.
    subroutine refine(apart)
      complex(wp), intent(in) :: apart !! by the slow motion

      integer :: more

      more = waves(2) - waves(1)
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
      call find_floquet_pair(self%level%grid, self%plan, self%level%basis(self%slow), &
        self%spectrum%motion, place, damping_of(self%request%damping, self%level%grid), &
        self%request%terms, self%spectrum%mode, self%pair)
      associate (difference => self%pair%exponent(1) - self%pair%exponent(2))
        self%largest = max(self%largest, abs(difference)**2)
        self%doubt = max(self%doubt, self%pair%change/self%largest)
        good = self%pair%change <= most_change*self%largest .and. &
          abs(difference**2 - merge(conjg(apart), apart, conjugate(1))**2) <= &
          farthest*(2.0_wp*abs(apart) + farthest)
      end associate
    end subroutine refine

  end subroutine evaluate

  !> The two multipliers of a meeting at a speed: numbers of their modes, whether each is the
  !! conjugate, turns that it has more on a common sheet, exponents on that.
  pure subroutine find_modes(spectrum, meeting, speed, certain, mode, conjugate, waves, exponent, &
    good)
    type(turn_spectrum_t), intent(in) :: spectrum
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: speed
    real(wp), intent(in) :: certain !! actions above this are certain of their sign
    integer, intent(out) :: mode(2)
    logical, intent(out) :: conjugate(2)
    integer, intent(out) :: waves(2)
    complex(wp), intent(out) :: exponent(2)
    logical, intent(out) :: good

    complex(wp) :: expected(2), value
    real(wp) :: frequency(2), apart, cost, smallest, unlike
    integer :: i, k, kind, shift

    frequency = frequency_at(meeting, speed)
    ! The first on the sheet of its positive signature, the second on the other.
    expected = cmplx(0.0_wp, [frequency(1)/speed, meeting%total - frequency(2)/speed], wp)
    good = .true.
    mode = 0
    do i = 1, 2
      smallest = huge(1.0_wp)
      do k = 1, size(spectrum%mode)
        associate (candidate => spectrum%mode(k))
          if (candidate%shape_frequency < (1.0_wp - like_enough)*meeting%shape(1)) cycle
          if (candidate%shape_frequency > (1.0_wp + like_enough)*meeting%shape(2)) cycle
          do kind = 1, merge(2, 1, candidate%is_complex)
            if (i == 2 .and. k == mode(1) .and. ((kind == 2) .eqv. conjugate(1))) cycle
            if (abs(candidate%action) > certain .and. &
              (((kind == 1) .eqv. candidate%action > 0.0_wp) .neqv. i == 1)) cycle
            value = candidate%exponent
            if (kind == 2) value = conjg(value)
            shift = nint(aimag(expected(i) - value))
            apart = abs(aimag(value - expected(i)) + shift)
            if (apart > near_enough) cycle
            ! The second is on the other sheet, as the conjugate of what it was.
            unlike = unlikeness(meeting, i, candidate, speed*spectrum%motion%scale, &
              (kind == 2) .neqv. i == 2)
            cost = (apart/near_enough)**2 + (unlike/unlike_enough)**2
            if (cost >= smallest) cycle
            smallest = cost
            mode(i) = k
            conjugate(i) = kind == 2
            waves(i) = shift
            exponent(i) = value + cmplx(0.0_wp, shift, wp)
          end do
        end associate
      end do
      good = good .and. mode(i) > 0
      if (.not. good) return
    end do
  end subroutine find_modes

end module meeting_exponents
