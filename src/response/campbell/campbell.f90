!> The Campbell diagram of a linkage: at every speed the bands of its frozen frequencies and the
!! Floquet frequencies of its motion, and its critical speeds.
module campbell
  use campbell_types, only: campbell_t
  use critical_speeds, only: find_critical_speeds
  use errors, only: error_t
  use frozen_bands, only: find_bands, new_dense_basis
  use interruption, only: was_interrupted
  use kept_results, only: keeper_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use response_levels, only: level_slot_t, need_basis, need_level
  use response_types, only: no_damping
  use slow_bases, only: slow_basis_t
  use stability, only: find_stability
  use stability_types, only: stability_request_t, stability_t
  use structures, only: structure_t
  use turn_spectra, only: first_order, slow_number
  implicit none (type, external)
  private

  public :: find_campbell

  !> Samples of the grids from which the linkage is resampled.
  integer, parameter :: samples_of_bands = 96

  !> Orders and slow coordinates of the second solution above those of the first.
  integer, parameter :: orders_above = 2, slow_above = 3

contains

  !> Finds all of it. Speeds are of one sign.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found. Those of a speed
  !! are in its result.
  subroutine find_campbell(structure, request, threads, store, found, error, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds, modes, accuracy
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(campbell_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error !! why there is nothing at any speed
    class(keeper_t), intent(inout), optional :: keeper !! of exponents and critical speeds

    type(stability_t) :: exponents
    type(slow_basis_t) :: basis(2)
    type(error_t), allocatable :: buckles
    real(wp) :: frequency(2)
    integer :: k, modes

    found%damped = any(request%damping%kind /= no_damping)
    allocate (found%at_speed(size(request%speed)), found%critical(0), found%gap(0))
    call find_stability(structure, request, threads, store, exponents, error, keeper)
    if (allocated(error)) return
    call find_bases
    if (allocated(error)) return
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) &
    !$omp private(k, modes, buckles)
    do k = 1, size(request%speed)
      if (was_interrupted()) cycle
      associate (here => found%at_speed(k))
        if (allocated(exponents%at_speed(k)%error)) then
          here%error = exponents%at_speed(k)%error
        else
          here%exponent = exponents%at_speed(k)%exponent
          modes = size(here%exponent)
          call find_bands(basis(1), basis(2), abs(request%speed(k)), modes, here%band, buckles)
          if (allocated(buckles)) deallocate (here%band)
        end if
      end associate
    end do
    !$omp end parallel do
    frequency = [huge(1.0_wp), 0.0_wp]
    do k = 1, size(request%speed)
      if (.not. allocated(found%at_speed(k)%exponent)) cycle
      associate (here => found%at_speed(k)%exponent%frequency)
        frequency = [min(frequency(1), minval(here)), max(frequency(2), maxval(here))]
      end associate
      if (.not. allocated(found%at_speed(k)%band)) cycle
      associate (band => found%at_speed(k)%band)
        frequency = [min(frequency(1), band(1)%mean), max(frequency(2), band(size(band))%mean)]
      end associate
    end do
    if (frequency(2) <= 0.0_wp .or. was_interrupted()) return
    deallocate (found%critical, found%gap)
    call find_critical_speeds(structure, request, frequency, threads, store, found%critical, &
      found%gap, found%left_out, error, keeper)
    if (allocated(error)) return
    found%critical%speed = sign(found%critical%speed, request%speed(1))
    do k = 1, size(found%gap)
      found%gap(k)%speed = sign(found%gap(k)%speed, request%speed(1))
    end do

  contains

    !> The linkage at the positions of frozen frequencies, twice.
    subroutine find_bases
      type(level_slot_t), allocatable :: levels(:)
      integer :: i, level, slow

      allocate (levels(0))
      do i = 1, 2
        call need_level(structure, first_order(request%accuracy) + (i - 1)*orders_above, &
          samples_of_bands, request%speed(1) < 0.0_wp, store, levels, level, error)
        if (allocated(error)) return
        associate (here => levels(level)%level)
          slow = min(here%grid%unknowns, slow_number(here%grid, request%modes) + (i - 1)* &
            slow_above)
          call need_basis(slow, request%damping, here, error, .true.)
          if (allocated(error)) return
          call new_dense_basis(here%basis(slow), i == 1, basis(i))
        end associate
      end do
    end subroutine find_bases

  end subroutine find_campbell

end module campbell
