!> The lowest eigenvalue at rest, roughly and without the deck's mesh: what the rounding of nodal
!! matrices is compared with.
module rest_eigenvalues
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t, new_deformation_model
  use errors, only: error_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use load_cases, only: case_count
  use mechanisms, only: mechanism_t
  use pin_displacements, only: chords_t
  use positions, only: find_positions, positions_t
  use speed_solver, only: new_reduced_work, reduced_work_t, solve_reduced
  use text, only: string_t
  implicit none (type, external)
  private

  public :: lowest_rest_eigenvalues

  integer, parameter :: low_order = 5

contains

  !> The lowest ω² of the unloaded structure at crank angles [1/s²], to a few digits; huge where
  !! there is none.
  function lowest_rest_eigenvalues(mechanism, crank) result(lambda)
    type(mechanism_t), intent(in) :: mechanism
    real(wp), intent(in) :: crank(:) !! [deg]
    real(wp) :: lambda(size(crank))

    type(positions_t) :: positions
    type(deformation_model_t) :: model
    type(reduced_work_t) :: work
    type(chords_t) :: chords
    type(bordered_modes_t) :: found(1)
    type(string_t) :: failure(1)
    type(ledger_t) :: counts
    type(error_t), allocatable :: error
    real(wp) :: no_forces(0, size(mechanism%beams), case_count), at_rest(case_count, 1)
    integer :: i

    lambda = 0.0_wp
    positions = find_positions(mechanism%linkage, crank)
    call new_deformation_model(mechanism%linkage, mechanism%beams, &
      spread(1, 1, size(mechanism%beams)), spread(low_order, 1, size(mechanism%beams)), &
      spread(.false., 1, size(mechanism%beams)), model, error)
    if (allocated(error)) return
    work = new_reduced_work(model, 1)
    at_rest = 0.0_wp
    do i = 1, size(crank)
      associate (state => positions%states(positions%state(i)))
        if (allocated(state%error)) then
          lambda(i) = huge(lambda)
          cycle
        end if
        failure(1)%text = ""
        call solve_reduced(mechanism%linkage, model, state%pose, state%crank, no_forces, at_rest, &
          1, [.false.], work, chords, found, failure, counts)
      end associate
      lambda(i) = huge(lambda)
      if (len(failure(1)%text) == 0) lambda(i) = found(1)%lambda(1)
    end do
  end function lowest_rest_eigenvalues

end module rest_eigenvalues
