!> Free motions of the slow coordinates of a turn, and the two levels on which what comes of them is
!! solved: with other orders, and with samples that are no multiple, so that the difference of both
!! solutions is an error.
module turn_spectra
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: fourier_plan_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use mode_numbers, only: numbers_of
  use motion_tables, only: is_in_table, motion_of_table, motion_table_t
  use refinements, only: most_samples, refinement_t, sample_numbers
  use response_levels, only: level_slot_t, level_t, need_basis, need_level, need_levels
  use slow_bases, only: own_squares
  use slow_motions, only: add_shape_frequencies, new_slow_motion, slow_mode_t, slow_modes, &
    slow_motion_t
  use sorting, only: ascending_order
  use stability_types, only: stability_request_t
  use structures, only: structure_t
  use text, only: to_string
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: turn_spectrum_t, find_spectrum, begin_refinements, set_too_slow, need_two_levels, &
    first_order, first_samples, slow_number, usual_stages

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

  !> Order and samples to begin with at every speed. Where vibrations a turn are more than samples
  !! resolve, there are as many as possible, and nothing is pending.
  !!
  !! Errors: as `need_level`.
  subroutine begin_refinements(structure, request, modes, speed, store, levels, refinement, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! accuracy; samples, if they are given
    integer, intent(in) :: modes                     !! that are resolved
    real(wp), intent(in) :: speed(:)                 !! ω2 [rad/s]
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(level_slot_t), allocatable, intent(inout) :: levels(:) !! made so far
    type(refinement_t), intent(inout) :: refinement(:) !! (speeds) with limits
    type(error_t), allocatable, intent(out) :: error !! why there is nothing at any speed

    integer :: at, first, k

    if (size(speed) == 0) return
    refinement%order = first_order(request%accuracy)
    refinement%backwards = speed < 0.0_wp
    call need_level(structure, refinement(1)%order, sample_numbers(1), refinement(1)%backwards, &
      store, levels, first, error)
    if (allocated(error)) return
    do k = 1, size(speed)
      associate (grid => levels(first)%level%grid, here => refinement(k))
        at = first_samples(grid, modes, speed(k), request%accuracy)
        here%samples = sample_numbers(merge(at, size(sample_numbers), at > 0))
        here%pending = here%pending .and. at > 0
        if (request%samples == 0) cycle
        here%samples = request%samples
        here%limits%rounds = 0
        here%pending = here%pending .and. samples_a_period*vibrations_of(grid, modes, speed(k)) &
          <= here%samples
      end associate
    end do
  end subroutine begin_refinements

  !> Says that a speed has more vibrations a turn than samples resolve.
  pure subroutine set_too_slow(request, error)
    type(stability_request_t), intent(in) :: request
    type(error_t), allocatable, intent(out) :: error

    call set_error(error, error_of_numerics, "the crank turns too slowly: more vibrations a "// &
      "turn than "//to_string(merge(request%samples, most_samples, request%samples > 0))// &
      " samples resolve")
  end subroutine set_too_slow

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
    if (samples_a_period*vibrations > most_samples) return
    at = findloc(sample_numbers >= min(nint(wanted), most_samples), .true., dim=1)
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

  !> Finds or makes both levels of all refinements that are pending, with their slow coordinates.
  !!
  !! Errors: as `need_level`, `need_basis`.
  subroutine need_two_levels(structure, request, refinement, store, levels, error, slow)
    class(structure_t), intent(in) :: structure
    type(stability_request_t), intent(in) :: request !! modes, damping
    type(refinement_t), intent(inout) :: refinement(:)
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(level_slot_t), allocatable, intent(inout) :: levels(:) !! made so far
    type(error_t), allocatable, intent(out) :: error
    integer, intent(in), optional :: slow            !! coordinates, as far as there are so many;
                                                     !! absent: `slow_number`

    integer :: coordinates, k

    call need_levels(structure, refinement, store, levels, error)
    if (allocated(error)) return
    ! None is there that is not needed.
    do k = 1, size(levels)
      associate (level => levels(k)%level)
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
  subroutine find_spectrum(level, plan, slow, speed, spectrum, error, stages, table)
    type(level_t), intent(in) :: level               !! with this many slow coordinates
    type(fourier_plan_t), intent(in) :: plan         !! for its samples
    integer, intent(in) :: slow                      !! coordinates
    real(wp), intent(in) :: speed                    !! |ω2| [rad/s]
    type(turn_spectrum_t), intent(out) :: spectrum
    type(error_t), allocatable, intent(out) :: error
    integer, intent(in), optional :: stages          !! of the collocation; absent: usual ones
    type(motion_table_t), intent(in), optional :: table !! where it has the speed, the steps are
                                                        !! from it, for free motions only

    logical :: known
    integer :: used

    used = usual_stages
    if (present(stages)) used = stages
    known = .false.
    if (present(table)) known = is_in_table(table, plan%samples, speed)
    if (known) then
      call motion_of_table(table, speed, spectrum%motion, error)
    else
      call new_slow_motion(plan, level%basis(slow), speed, used, spectrum%motion, error)
    end if
    if (allocated(error)) return
    call slow_modes(level%basis(slow), spectrum%motion, spectrum%mode, error)
    if (allocated(error)) return
    call add_shape_frequencies(level%basis(slow), spectrum%motion, speed, spectrum%mode)
    spectrum%number = numbers_of(spectrum%mode)
  end subroutine find_spectrum

end module turn_spectra
