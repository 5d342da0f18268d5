!> The positions of a run, computed in parallel.
module position_study
  use kinds, only: wp
  use linkages, only: linkage_t
  use positions, only: find_state, list_positions, positions_t
  use linkage_paths, only: period_of
  use load_tables, only: load_period
  implicit none (type, external)
  private

  public :: find_all_positions, place_positions

contains

  !> Poses and kinematic coefficients, once for every different crank angle.
  !!
  !! Errors, in each state: the linkage does not reach the position, or it is a dead point.
  subroutine find_all_positions(linkage, crank, threads, positions, instants)
    type(linkage_t), intent(in) :: linkage      !! of mobility one
    real(wp), intent(in) :: crank(:)            !! (positions) as listed in the deck [deg]
    integer, intent(in) :: threads              !! number of OpenMP threads
    type(positions_t), intent(out) :: positions !! one state for every different angle
    real(wp), intent(in), optional :: instants(:) !! (positions) as of `list_positions` [s]

    call list_positions(crank, positions, load_period(linkage, period_of(linkage)), instants)
    call place_positions(linkage, threads, positions)
  end subroutine find_all_positions

  !> Poses and kinematic coefficients of states that have their crank angles. Errors: likewise.
  subroutine place_positions(linkage, threads, positions)
    type(linkage_t), intent(in) :: linkage        !! of mobility one
    integer, intent(in) :: threads                !! number of OpenMP threads
    type(positions_t), intent(inout) :: positions !! by `list_positions` or `list_block`

    integer :: i

    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(positions%states)
      call find_state(linkage, positions%states(i))
    end do
    !$omp end parallel do
  end subroutine place_positions

end module position_study
