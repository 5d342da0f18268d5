!> The positions of a run, found on all threads.
module position_study
  use kinds, only: wp
  use linkages, only: linkage_t
  use positions, only: find_state, list_positions, positions_t
  implicit none (type, external)
  private

  public :: find_all_positions

contains

  !> Positions and kinematic coefficients, once for every different angle. Those that the linkage
  !! cannot take have their error.
  subroutine find_all_positions(linkage, crank, threads, positions)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank(:) !! [deg]
    integer, intent(in) :: threads
    type(positions_t), intent(out) :: positions

    integer :: i

    call list_positions(crank, positions)
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(positions%states)
      call find_state(linkage, positions%states(i))
    end do
    !$omp end parallel do
  end subroutine find_all_positions

end module position_study
