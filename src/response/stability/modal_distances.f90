!> How near a speed is to resonance: the least `|1 − ρ|` of the multipliers ρ of a turn of the
!! slowest vibrations, of two real ones the greater. Those of all vibrations lie dense on the unit
!! circle.
!!
!! The slow motion gives all of them about; those that may be the nearest are found from the whole
!! equation, twice, with other orders and with samples that are no multiple. The second is the
!! result, the difference its error.
module modal_distances
  use byte_streams, only: byte_stream_t, pass_error
  use constants, only: two_pi
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use floquet_exponents, only: find_floquet_modes, floquet_mode_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use kept_results, only: keep_result, keeper_t, recall_result
  use kinds, only: long, wp
  use link_store, only: link_store_t
  use mode_numbers, only: growing_mode, most_spread
  use order_transfer, only: transferred_halves
  use refinements, only: add_work, begin_round, compare, raise, refinement_limits_t, refinement_t
  use response_bytes, only: pass_refinement
  use response_levels, only: level_slot_t, level_t, set_equation
  use stability_types, only: stability_request_t
  use structures, only: structure_t
  use turn_spectra, only: begin_refinements, find_spectrum, need_two_levels, set_too_slow, &
    turn_spectrum_t
  implicit none (type, external)
  private

  public :: modal_distance_t, find_modal_distances

  !> Slow coordinates beside those of the modes wanted, and stages of the collocation of motions.
  integer, parameter :: slow_above = 3, stages = 3

  !> Multipliers of the slow motion are right to this share of themselves, 2π times what exponents
  !! may be off; where the whole equation leads farther away it leads elsewhere.
  real(wp), parameter :: about = 0.02_wp*two_pi

  !> The exponent changes by no more than this share of the accuracy in the last round, and cannot
  !! by less than the least. The error is to hold many such changes.
  real(wp), parameter :: solved_to(2) = [1.0e-1_wp, 3.0e-2_wp], least_change = 1.0e-13_wp, many = &
    10.0_wp

  !> The difference of both solutions counts so many times; no error is stated smaller than this
  !! share of the accuracy: two solutions may agree by chance.
  real(wp), parameter :: safety = 3.0_wp, least_share = 1.0e-2_wp

  type(refinement_limits_t), parameter :: limits = refinement_limits_t(order=26, rounds=6, &
    work=10000000_long)

  !> At one speed.
  type :: modal_distance_t
    real(wp) :: value = 0.0_wp          !! least |1 − ρ|
    real(wp) :: error = huge(1.0_wp)    !! relative
    type(error_t), allocatable :: why   !! there is none
  end type modal_distance_t

contains

  !> Finds the distances at all speeds.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found. Those of a speed
  !! are in its result.
  subroutine find_modal_distances(structure, request, threads, store, found, error, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds, modes, accuracy
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(modal_distance_t), allocatable, intent(out) :: found(:) !! (speeds)
    type(error_t), allocatable, intent(out) :: error !! why there is nothing at any speed
    class(keeper_t), intent(inout), optional :: keeper !! of speeds, a round each, stage 2

    type(level_slot_t), allocatable :: levels(:)
    type(refinement_t) :: refinement(size(request%speed))
    integer :: k, round

    allocate (found(size(refinement)), levels(0))
    refinement%limits = limits
    call begin_refinements(structure, request, request%modes, request%speed, store, levels, &
      refinement, error)
    if (allocated(error)) return
    do k = 1, size(refinement)
      if (.not. refinement(k)%pending) call set_too_slow(request, found(k)%why)
    end do
    round = 0
    do while (any(refinement%pending))
      round = round + 1
      call need_two_levels(structure, request, refinement, store, levels, error, &
        slow=request%modes + slow_above)
      if (allocated(error)) return
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
      do k = 1, size(refinement)
        call find_at_speed(k)
      end do
      !$omp end parallel do
    end do

  contains

    !> A round at a speed, if one is pending: solved, or what an earlier run has found in it.
    subroutine find_at_speed(k)
      integer, intent(in) :: k

      type(byte_stream_t) :: stream
      logical :: begun, known

      associate (here => refinement(k))
        call begin_round(here, begun)
        if (.not. begun) return
        call recall_result(keeper, [2, round, k], stream, known)
        if (.not. known) call solve_speed(request, abs(request%speed(k)), &
          levels(here%level(1))%level, levels(here%level(2))%level, here, found(k))
        if (.not. present(keeper)) return
        call pass_refinement(stream, here)
        call stream%pass(found(k)%value)
        call stream%pass(found(k)%error)
        call pass_error(stream, found(k)%why)
        call keep_result(keeper, [2, round, k], stream)
      end associate
    end subroutine find_at_speed

  end subroutine find_modal_distances

  !> Solves one speed on both levels; raises order and samples if that is not good enough.
  subroutine solve_speed(request, speed, level, above, refinement, found)
    type(stability_request_t), intent(in) :: request
    real(wp), intent(in) :: speed
    type(level_t), intent(in), target :: level, above
    type(refinement_t), intent(inout) :: refinement
    type(modal_distance_t), intent(inout) :: found

    type(fourier_plan_t), target :: plan, above_plan
    type(turn_spectrum_t), target :: spectrum, above_spectrum
    type(equation_at_speed_t) :: equation
    type(modal_distance_t) :: here
    complex(wp), allocatable :: multiplier(:)
    real(wp), allocatable :: error(:)
    integer, allocatable :: wanted(:), near(:)
    integer :: i, slow

    slow = request%modes + slow_above
    call open_fourier(level%grid%samples, plan)
    call open_fourier(above%grid%samples, above_plan)
    attempt: block
      call find_spectrum(level, plan, min(level%grid%unknowns, slow), speed, spectrum, here%why, &
        stages)
      if (allocated(here%why)) exit attempt
      call find_spectrum(above, above_plan, min(above%grid%unknowns, slow), speed, &
        above_spectrum, here%why, stages)
      if (allocated(here%why)) exit attempt
      wanted = [(growing_mode(above_spectrum%mode, above_spectrum%number, i), i=1, &
        min(request%modes, maxval(above_spectrum%number)))]
      multiplier = exp(two_pi*above_spectrum%mode(wanted)%exponent)
      error = about*abs(multiplier)
      ! Those of vibrations that fade within the rounding of others are nothing beside them.
      if (size(wanted) < min(request%modes, size(above_spectrum%mode))) then
        error = [error, exp(-most_spread)*maxval(abs(multiplier))]
        multiplier = [multiplier, (0.0_wp, 0.0_wp)]
      end if
      near = pack([(i, i=1, size(wanted))], abs(1.0_wp - multiplier(:size(wanted))) - &
        error(:size(wanted)) <= minval(abs(1.0_wp - multiplier) + error) .and. &
        error(:size(wanted)) > least_share*request%accuracy)
      call refine
      call take_least(multiplier, error, here)
    end block attempt
    call close_fourier(above_plan)
    call close_fourier(plan)
    call settle

  contains

    !> The multipliers that may be the nearest, from the whole equation.
    subroutine refine
      type(floquet_mode_t) :: modes(size(near)), better(size(near)), known(size(near))
      integer :: mine(size(near)), i
      real(wp) :: share, tolerance(2)

      if (size(near) == 0) return
      do i = 1, size(near)
        mine(i) = minloc(abs(spectrum%mode%exponent - &
          above_spectrum%mode(wanted(near(i)))%exponent), dim=1)
      end do
      ! As accurate as the distance asks for.
      share = minval(abs(1.0_wp - multiplier(near)) + error(near))/maxval(abs(multiplier(near)))
      tolerance = max(solved_to*min(share, 1.0_wp)*request%accuracy/two_pi, least_change)
      call set_equation(level, plan, spectrum%motion, speed, request%damping, request%terms, &
        equation)
      call find_floquet_modes(equation, tolerance(1), spectrum%mode, mine, modes)
      known = modes
      do i = 1, size(near)
        call transferred_halves(level%grid, plan, above%grid, above_plan, modes(i)%motion, &
          known(i)%motion)
      end do
      call set_equation(above, above_plan, above_spectrum%motion, speed, request%damping, &
        request%terms, equation)
      call find_floquet_modes(equation, tolerance(2), above_spectrum%mode, wanted(near), better, &
        known)
      do i = 1, size(near)
        associate (slow => above_spectrum%mode(wanted(near(i)))%exponent)
          call add_work(refinement, level%grid, modes(i)%applications)
          call add_work(refinement, above%grid, better(i)%applications)
          ! Iterations that lead elsewhere say nothing.
          if (two_pi*apart_from(better(i)%exponent, slow) > about .or. max(modes(i)%change, &
            better(i)%change) > about) cycle
          multiplier(near(i)) = exp(two_pi*better(i)%exponent)
          error(near(i)) = two_pi*abs(multiplier(near(i)))*(safety*apart_from(better(i)%exponent, &
            modes(i)%exponent) + modes(i)%change + many*better(i)%change)
        end associate
      end do
    end subroutine refine

    !> Keeps the better result, and raises order and samples if it is not good enough.
    subroutine settle
      logical :: is_best

      if (allocated(here%why)) then
        if (found%error >= huge(1.0_wp)) found%why = here%why
      else
        call compare(refinement, here%error, is_best)
        if (is_best) found = here
      end if
      if (found%error > request%accuracy) call raise(refinement, 1, refinement%samples + 1)
    end subroutine settle

    !> The least distance of multipliers from 1, and how far errors may move it.
    pure subroutine take_least(multiplier, error, found)
      complex(wp), intent(in) :: multiplier(:)
      real(wp), intent(in) :: error(:)
      type(modal_distance_t), intent(inout) :: found

      real(wp), dimension(size(error)) :: distance, off

      distance = abs(1.0_wp - multiplier)
      off = error + least_share*request%accuracy*distance + 4.0_wp*epsilon(1.0_wp)
      found%value = minval(distance)
      found%error = max(minval(distance + off) - found%value, found%value - minval(distance - &
        off))/max(found%value, tiny(1.0_wp))
    end subroutine take_least

  end subroutine solve_speed

  !> Distance of an exponent from another or from its conjugate, which is of the same vibration.
  elemental function apart_from(other, exponent) result(apart)
    complex(wp), intent(in) :: other, exponent
    real(wp) :: apart

    apart = min(abs(other - exponent), abs(conjg(other) - exponent))
  end function apart_from

end module modal_distances
