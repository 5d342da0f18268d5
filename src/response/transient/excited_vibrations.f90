!> Free vibrations that the start of a motion in time and jumps of the crank's motion excite, and
!! what steps in time miss of them.
!!
!! Radau's method lets what is too fast for its steps fade at once, in every solution: differences
!! of solutions do not tell of it. Of a mode of the linkage frozen at that instant with the exponent
!! σ the steps of length h make `R(σ h)^(t/h)`, R being the stability function of the method, in
!! place of `e^{σ t}`.
module excited_vibrations
  use crank_laws, only: crank_breaks, crank_law_t, crank_motion
  use errors, only: error_t
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs, dsygvx
  use motion_matrices, only: find_motion_matrices, load_at, motion_matrices_t, stiffness_at
  use path_grids, only: place_grid
  use strain_dampings, only: damping_t
  use structures, only: structure_t
  use transient_quantities, only: quantities_of
  use transient_steps, only: add_damping, elastic_state_t, kick, rates_of
  use transient_types, only: transient_request_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: excited_vibration_t, find_excited_vibrations, missed_by_steps

  type :: excited_vibration_t
    real(wp) :: time = 0.0_wp                       !! when it begins [s]
    complex(wp) :: exponent = (0.0_wp, 0.0_wp)      !! σ [1/s]
    real(wp), allocatable :: amplitude(:)           !! (quantities)
  end type excited_vibration_t

  !> A motion of the crank that changes by no more than this, relatively, does not jump.
  real(wp), parameter :: no_jump = 1.0e-12_wp

contains

  !> The vibrations that the start and the jumps of a motion excite: by the deviation from where the
  !! links would rest under the loads, and by velocities.
  !!
  !! Errors: the crank cannot reach an angle.
  subroutine find_excited_vibrations(structure, request, law, time, start, damping, grid, &
    vibration, error)
    class(structure_t), intent(in) :: structure    !! of the grid
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law           !! of the crank
    real(wp), intent(in) :: time(:)                !! of the rows, rising [s]
    real(wp), intent(in) :: start(:)               !! (2 unknowns) y, P at the first
    type(damping_t), intent(in) :: damping         !! of `damping_of`
    type(turn_grid_t), intent(inout) :: grid       !! for one crank angle
    type(excited_vibration_t), allocatable, intent(out) :: vibration(:)
    type(error_t), allocatable, intent(out) :: error

    type(motion_matrices_t) :: matrices
    type(elastic_state_t) :: state
    real(wp), allocatable :: place(:)
    real(wp), dimension(grid%unknowns) :: away, rates
    real(wp) :: before(0:2), after(0:2)
    integer :: i, n

    n = grid%unknowns
    allocate (vibration(0))
    place = [time(1), crank_breaks(law, time(1), time(size(time))), time(size(time))]
    do i = 1, size(place) - 1
      after = crank_motion(law, place(i), 0.5_wp*(place(i) + place(i + 1)))
      before = after
      if (i > 1) before = crank_motion(law, place(i), 0.5_wp*(place(i - 1) + place(i)))
      if (i > 1 .and. all(abs(after(1:) - before(1:)) <= no_jump*abs(after(1:)))) cycle
      call place_grid(structure, after(:0), grid, error)
      if (allocated(error)) return
      call find_motion_matrices(grid, matrices)
      if (i == 1) then
        away = start(:n) - at_rest(after)
        rates = rates_of(matrices, 1, after(1), start)
      else
        away = at_rest(before)
        state%value = [away, 0.0_wp*away]
        state%carry = 0.0_wp*state%value
        call kick(matrices, 1, after(1) - before(1), request%response%terms%axial, state)
        state%value(:n) = 0.0_wp
        rates = rates_of(matrices, 1, 0.0_wp, state%value)
        away = away - at_rest(after)
      end if
      call add_modes(place(i), after(1))
    end do

  contains

    !> Where the links would rest under the loads of a motion of the crank.
    function at_rest(motion) result(y)
      real(wp), intent(in) :: motion(0:2)
      real(wp) :: y(n)

      real(wp) :: stiffness(n, n), load(n, 1)
      integer :: pivot(n), info

      stiffness = stiffness_at(matrices, 1, motion(1), motion(2), request%response%terms%axial) - &
        motion(1)**2*matrices%swept(:, :, 1)
      load(:, 1) = load_at(matrices, 1, motion(1), motion(2))
      call dgetrf(n, n, stiffness, n, pivot, info)
      if (info == 0) call dgetrs("N", n, 1, stiffness, n, pivot, load, n, info)
      y = load(:, 1)
    end function at_rest

    !> Adds the modes of the frozen linkage: `M φ = 1/ω² φ`. Axial forces and the turning frame
    !! hardly change those that are fast.
    subroutine add_modes(now, speed)
      real(wp), intent(in) :: now   !! [s]
      real(wp), intent(in) :: speed !! of the crank [rad/s]

      type(excited_vibration_t) :: new
      real(wp), dimension(n, n) :: mass, unit, shape, damper, ignored
      real(wp) :: value(n), work(8*n), fading, amplitude
      integer :: iwork(5*n), fail(n), found, info, k

      mass = matrices%mass(:, :, 1)
      unit = 0.0_wp
      do k = 1, n
        unit(k, k) = 1.0_wp
      end do
      call dsygvx(1, "V", "A", "U", n, mass, n, unit, n, 0.0_wp, 0.0_wp, 0, 0, 0.0_wp, found, &
        value, shape, n, work, size(work), iwork, fail, info)
      damper = 0.0_wp
      ignored = 0.0_wp
      call add_damping(matrices, 1, damping, speed, damper, ignored)
      new%time = now
      do k = 1, found
        ! Without mass there is no vibration.
        if (value(k) <= epsilon(value)*value(found)) cycle
        associate (mode => shape(:, k), square => value(k))
          amplitude = hypot(dot_product(mode, away), dot_product(mode, rates)*sqrt(square))
          fading = -0.5_wp*dot_product(mode, matmul(damper, mode))/square
          new%exponent = -1.0_wp/(square*(fading + sqrt(cmplx(fading**2 - 1.0_wp/square, &
            0.0_wp, wp))))
          new%amplitude = amplitude*maxval(abs(quantities_of(grid, request%response, &
            reshape(mode, [1, n]))), dim=1)
        end associate
        vibration = [vibration, new]
      end do
    end subroutine add_modes

  end subroutine find_excited_vibrations

  !> What steps between rows miss of vibrations, at most: the sum of the largest values at rows.
  pure function missed_by_steps(vibration, time, steps, stages, quantities) result(missed)
    type(excited_vibration_t), intent(in) :: vibration(:)
    real(wp), intent(in) :: time(:)                       !! of the rows [s]
    integer, intent(in) :: steps                          !! between two rows
    integer, intent(in) :: stages                         !! of Radau's method
    integer, intent(in) :: quantities                     !! their number
    real(wp) :: missed(quantities)

    complex(wp) :: begun, factor
    real(wp) :: largest, length
    integer :: first, i, row

    missed = 0.0_wp
    do i = 1, size(vibration)
      associate (one => vibration(i))
        first = findloc(time > one%time, .true., dim=1)
        if (first == 0) cycle
        ! The steps to the first row are shorter than others, if it begins between rows.
        begun = log(radau_factor(one%exponent*(time(first) - one%time)/steps, stages))*steps
        largest = abs(exp(one%exponent*(time(first) - one%time)) - exp(begun))
        if (first < size(time)) then
          length = (time(first + 1) - time(first))/steps
          factor = log(radau_factor(one%exponent*length, stages))/length
        end if
        ! It fades or goes on evenly: rows twice as far from one to the next will do.
        row = first
        do while (row < size(time))
          row = min(size(time), 2*row - first + 1)
          largest = max(largest, abs(exp(one%exponent*(time(row) - one%time)) - exp(begun + &
            factor*(time(row) - time(first)))))
        end do
        missed = missed + largest*one%amplitude
      end associate
    end do
  end function missed_by_steps

  !> Stability function of Radau's method (IIA): the Padé approximation of `e^z` with one degree
  !! less in the numerator than in the denominator.
  pure complex(wp) function radau_factor(z, stages)
    complex(wp), intent(in) :: z
    integer, intent(in) :: stages

    complex(wp) :: above, below, term(2)
    integer :: i

    term = 1.0_wp
    above = 1.0_wp
    below = 1.0_wp
    do i = 0, stages - 1
      term = term*z/real((i + 1)*(2*stages - 1 - i), wp)*[real(stages - 1 - i, wp), real(i - &
        stages, wp)]
      above = above + term(1)
      below = below + term(2)
    end do
    radau_factor = above/below
  end function radau_factor

end module excited_vibrations
