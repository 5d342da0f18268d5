!> What is remarkable in a sweep of frequencies: negative eigenvalues, links that the loads bend
!! far, frequencies less accurate than requested.
module sweep_extremes
  use kinds, only: wp
  use position_results, only: position_result_t
  use positions, only: positions_t
  use sweeps, only: has_result, sweep_t
  implicit none (type, external)
  private

  public :: sweep_extremes_t, row_place_t, widen_sweep_extremes

  !> Where a speed has negative eigenvalues: static divergence.
  type :: divergence_t
    real(wp) :: amount = 0.0_wp            !! largest −λ [1/s²]
    real(wp), allocatable :: range(:, :)   !! (2, ranges) crank angles of the first and the last of
                                           !! neighbours in the deck's list [deg]
    logical :: goes_on = .false.           !! the last position so far is in the last range
  end type divergence_t

  !> A row of the sweep.
  type :: row_place_t
    real(wp) :: crank = 0.0_wp !! [deg] or [m]
    integer :: speed = 1       !! number
  end type row_place_t

  type :: sweep_extremes_t
    type(divergence_t), allocatable :: divergence(:) !! (speeds); not allocated before any position
    real(wp) :: deflection = 0.0_wp        !! largest static one / length of its link [-]
    integer :: deflected = 1               !! number of this body
    type(row_place_t) :: at_deflection
    integer :: missed = 0                  !! rows with a frequency less accurate than requested
    real(wp) :: error = 0.0_wp             !! the largest of these, relative
    integer :: cause = 0                   !! of it, as of `position_result_t`
    type(row_place_t) :: at_error
  end type sweep_extremes_t

contains

  !> Takes the rows of some positions, in the order of the deck's list.
  pure subroutine widen_sweep_extremes(positions, sweep, extremes)
    type(positions_t), intent(in) :: positions         !! of the run, or a block of them
    type(sweep_t), intent(in) :: sweep                 !! finished, over these
    type(sweep_extremes_t), intent(inout) :: extremes  !! of the blocks before

    integer :: i, k

    if (.not. allocated(extremes%divergence)) &
      allocate (extremes%divergence(size(sweep%request%speed)))
    do i = 1, size(positions%crank)
      associate (state => positions%state(i))
        do k = 1, size(sweep%request%speed)
          if (sweep%request%axial .and. .not. allocated(positions%states(state)%error)) &
            call take_deflections(sweep%results(state)%deflection(:, k), &
            row_place_t(positions%crank(i), k), extremes)
          if (has_result(positions, sweep, state, k)) then
            call take_row(sweep%results(state), sweep%request%accuracy, &
              row_place_t(positions%crank(i), k), extremes)
          else
            extremes%divergence(k)%goes_on = .false.
          end if
        end do
      end associate
    end do
  end subroutine widen_sweep_extremes

  !> Takes the deflections of all bodies at a row.
  pure subroutine take_deflections(deflection, place, extremes)
    real(wp), intent(in) :: deflection(:) !! (bodies) [-]
    type(row_place_t), intent(in) :: place
    type(sweep_extremes_t), intent(inout) :: extremes

    integer :: body

    do body = 1, size(deflection)
      ! With a tolerance, so that of equal positions (0 and 360) the first is named.
      if (deflection(body) <= extremes%deflection*(1.0_wp + 1.0e-12_wp)) cycle
      extremes%deflection = deflection(body)
      extremes%deflected = body
      extremes%at_deflection = place
    end do
  end subroutine take_deflections

  !> Takes the eigenvalues and errors of a row.
  pure subroutine take_row(result, accuracy, place, extremes)
    type(position_result_t), intent(in) :: result !! with this row
    real(wp), intent(in) :: accuracy              !! requested
    type(row_place_t), intent(in) :: place
    type(sweep_extremes_t), intent(inout) :: extremes

    real(wp) :: error

    call take_eigenvalue(minval(result%lambda(:, place%speed)), place%crank, &
      extremes%divergence(place%speed))
    error = maxval(result%error(:, place%speed))
    if (error <= accuracy) return
    extremes%missed = extremes%missed + 1
    if (error <= extremes%error) return
    extremes%error = error
    extremes%cause = result%cause(place%speed)
    extremes%at_error = place
  end subroutine take_row

  !> Takes the lowest eigenvalue of a row.
  pure subroutine take_eigenvalue(lowest, crank, divergence)
    real(wp), intent(in) :: lowest, crank
    type(divergence_t), intent(inout) :: divergence !! of the speed

    real(wp), allocatable :: longer(:, :)
    integer :: ranges

    if (lowest >= 0.0_wp) then
      divergence%goes_on = .false.
      return
    end if
    divergence%amount = max(divergence%amount, -lowest)
    ranges = 0
    if (allocated(divergence%range)) ranges = size(divergence%range, 2)
    if (.not. divergence%goes_on) then
      allocate (longer(2, ranges + 1))
      if (ranges > 0) longer(:, :ranges) = divergence%range
      ranges = ranges + 1
      longer(:, ranges) = crank
      call move_alloc(longer, divergence%range)
    end if
    divergence%range(2, ranges) = crank
    divergence%goes_on = .true.
  end subroutine take_eigenvalue

end module sweep_extremes
