!> Free motions of the slow coordinates of a turn, and the two levels on which what comes of them is
!! solved: with other orders, and with samples that are no multiple, so that the difference of both
!! solutions is an error.
module turn_spectra
  use errors, only: error_t
  use fourier_transform, only: fourier_plan_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use mode_numbers, only: numbers_of
  use response_levels, only: level_slot_t, level_t, need_basis, need_level, sample_numbers
  use slow_motions, only: add_shape_frequencies, new_slow_motion, own_squares, slow_mode_t, &
    slow_modes, slow_motion_t
  use sorting, only: ascending_order
  use stability_types, only: stability_request_t
  use structures, only: structure_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: turn_spectrum_t, find_spectrum, need_two_levels, first_order, first_samples, &
    vibrations_of, slow_number, samples_a_period, orders_above

  !> Orders of the second level above those of the first; its samples are half as many more.
  integer, parameter :: orders_above = 2

  !> Slow coordinates beside those of the modes wanted, and at least; and all deformations up to so
  !! many times the frequency of these: alike links have as many alike ones, and without some of
  !! them none of their vibrations is found well.
  integer, parameter :: slow_above = 5, least_slow = 8
  real(wp), parameter :: far_above = 5.0_wp

  !> Stages of the collocation of slow motions.
  integer, parameter :: usual_stages = 4

  !> Vibrations have at least this many samples a period.
  real(wp), parameter :: samples_a_period = 6.0_wp

  !> Free motions of the slow coordinates at a speed.
  type :: turn_spectrum_t
    type(slow_motion_t) :: motion
    type(slow_mode_t), allocatable :: mode(:)
    integer, allocatable :: number(:) !! of the vibration, of every mode
  end type turn_spectrum_t

contains

  !> Polynomial degree to begin with: exponents are eigenvalues, whose errors fall twice as fast as
  !! those of shapes.
  pure function first_order(accuracy) result(order)
    real(wp), intent(in) :: accuracy
    integer :: order

    order = max(8, min(4 + 2*ceiling(-0.5_wp*log10(accuracy)), 16))
  end function first_order

  !> Samples to begin with, from the vibrations a turn of the highest mode wanted.
  pure function first_samples(grid, modes, speed, accuracy) result(at)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: modes
    real(wp), intent(in) :: speed, accuracy
    integer :: at !! of `sample_numbers`; 0: too many

    real(wp) :: vibrations, wanted

    vibrations = vibrations_of(grid, modes, speed)
    wanted = (64.0_wp + 10.0_wp*min(vibrations, 1.0e6_wp))*(0.4_wp - 0.075_wp*log10(accuracy))
    at = 0
    if (samples_a_period*vibrations > sample_numbers(size(sample_numbers))) return
    at = findloc(sample_numbers >= min(nint(wanted), sample_numbers(size(sample_numbers))), &
      .true., dim=1)
  end function first_samples

  !> Vibrations a turn of the highest mode wanted.
  pure function vibrations_of(grid, modes, speed) result(vibrations)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: modes
    real(wp), intent(in) :: speed
    real(wp) :: vibrations

    real(wp) :: square(grid%unknowns)

    square = own_squares(grid)
    square = square(ascending_order(-square))
    vibrations = 1.0_wp/max(abs(speed)*sqrt(square(min(modes, size(square)))), tiny(1.0_wp))
  end function vibrations_of

  !> Slow coordinates for so many modes.
  pure function slow_number(grid, modes) result(number)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: modes
    integer :: number

    real(wp) :: square(grid%unknowns)

    square = own_squares(grid)
    square = square(ascending_order(-square))
    number = min(grid%unknowns, max(modes + slow_above, least_slow, &
      count(square*far_above**2 > square(min(modes, size(square))))))
  end function slow_number

  !> Finds or makes two levels, with their slow coordinates.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine need_two_levels(structure, request, order, samples, backwards, store, levels, number, &
    error, slow)
    class(structure_t), intent(in) :: structure
    type(stability_request_t), intent(in) :: request !! modes, damping
    integer, intent(in) :: order, samples            !! of the first level
    logical, intent(in) :: backwards                 !! the crank turns clockwise
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(level_slot_t), allocatable, intent(inout) :: levels(:) !! made so far
    integer, intent(out) :: number(2)                !! of both among them
    type(error_t), allocatable, intent(out) :: error
    integer, intent(in), optional :: slow            !! coordinates, as far as there are so many;
                                                     !! absent: `slow_number`

    integer :: coordinates, i

    do i = 1, 2
      call need_level(structure, order + (i - 1)*orders_above, (i + 1)*samples/2, backwards, &
        store, levels, number(i), error)
      if (allocated(error)) return
      associate (level => levels(number(i))%level)
        coordinates = slow_number(level%grid, request%modes)
        if (present(slow)) coordinates = min(level%grid%unknowns, slow)
        call need_basis(coordinates, request%damping, level, error, .true.)
      end associate
      if (allocated(error)) return
    end do
  end subroutine need_two_levels

  !> Free motions of the slow coordinates of a level, with their numbers.
  !!
  !! Errors: they grow too much in a turn; their multipliers do not converge.
  subroutine find_spectrum(level, plan, slow, speed, spectrum, error, stages)
    type(level_t), intent(in) :: level               !! with this many slow coordinates
    type(fourier_plan_t), intent(in) :: plan         !! for its samples
    integer, intent(in) :: slow                      !! coordinates
    real(wp), intent(in) :: speed                    !! |ω2| [rad/s]
    type(turn_spectrum_t), intent(out) :: spectrum
    type(error_t), allocatable, intent(out) :: error
    integer, intent(in), optional :: stages          !! of the collocation; absent: usual ones

    integer :: used

    used = usual_stages
    if (present(stages)) used = stages
    call new_slow_motion(plan, level%basis(slow), speed, used, spectrum%motion, error)
    if (allocated(error)) return
    call slow_modes(level%basis(slow), spectrum%motion, spectrum%mode, error)
    if (allocated(error)) return
    call add_shape_frequencies(level%basis(slow), spectrum%motion, speed, spectrum%mode)
    spectrum%number = numbers_of(spectrum%mode)
  end subroutine find_spectrum

end module turn_spectra
