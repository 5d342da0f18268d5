!> Modes of a model in deformation coordinates at one position, speed after speed.
module speed_solver
  use bordered_eigensolver, only: bordered_modes_t, find_bordered_modes, start_t
  use deformation_model, only: deformation_model_t
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use mixed_positions, only: find_mixed_modes, mixed_position_t
  use position_equations, only: new_position_equations, position_equations_t, set_speed
  use start_extrapolation, only: extrapolated_start, remember, track_t
  implicit none (type, external)
  private

  public :: speed_work_t, new_speed_work, solve_speeds

  !> Largest step from the last position over which modes are extrapolated [deg].
  real(wp), parameter :: longest_step = 10.0_wp

  !> A mode just above those requested may be off by this many times the bound of theirs; and the
  !! largest distance at which modes are looked for.
  real(wp), parameter :: clearances = 25.0_wp, most_clearance = 0.25_wp

  !> The equations, filled at every position, and the modes of the last positions.
  type :: speed_work_t
    type(position_equations_t) :: equations !! of the present position
    type(track_t), allocatable :: tracks(:) !! (speeds) modes of the last positions
    type(bordered_modes_t), allocatable :: found(:) !! (speeds) modes of the present position
    real(wp) :: clearance = 0.0_wp          !! relative distance above the last wanted mode within
                                            !! which modes are to be found, too
  end type speed_work_t

contains

  !> Work space for a model at a number of speeds; no modes are remembered yet.
  pure function new_speed_work(model, speeds, bound) result(work)
    type(deformation_model_t), intent(in) :: model !! gives the size of the matrices
    integer, intent(in) :: speeds                  !! number of them
    real(wp), intent(in), optional :: bound        !! on the relative error of the eigenvalues of
                                                   !! continuous links: modes that are so near those
                                                   !! wanted that they may belong below them are
                                                   !! found, too; absent: 0
    type(speed_work_t) :: work

    if (present(bound)) work%clearance = min(clearances*bound, most_clearance)
    work%equations = new_position_equations(model)
    allocate (work%tracks(speeds), work%found(speeds))
  end function new_speed_work

  !> Solves `(K + K_G) y = λ M y` for every speed, starting from the modes of the last positions.
  !!
  !! Errors, speed by speed in `outcome`: no start leads to modes that are proven complete. The
  !! modes of the last positions are then forgotten.
  subroutine solve_speeds(place, factor, modes, accurate_vectors, work, outcome, counts, mixed)
    real(wp), intent(in) :: place              !! crank angle, by which modes are extrapolated [deg]
    real(wp), intent(in) :: factor(:, :)       !! (cases, speeds) of the unit loads: ω2², α2, 1
    integer, intent(in) :: modes               !! number wanted
    logical, intent(in) :: accurate_vectors(:) !! (speeds) eigenvectors also to full precision
    type(speed_work_t), intent(inout) :: work  !! with the equations of this position; gets at least
                                               !! `modes` of each speed
    type(outcome_t), intent(inout) :: outcome(:)    !! (speeds) an error already present is kept
    type(ledger_t), intent(inout) :: counts    !! of the work done
    type(mixed_position_t), intent(inout), optional :: mixed !! in which modes are found; absent: in
                                               !! the equations of `work`

    type(start_t) :: start
    type(error_t), allocatable :: error
    integer :: k
    logical :: from_track

    do k = 1, size(factor, 2)
      if (allocated(outcome(k)%error)) then
        work%tracks(k)%length = 0
        cycle
      end if
      start = extrapolated_start(work%tracks(k), place, longest_step)
      if (present(mixed)) then
        call find_mixed_modes(mixed, factor(:, k), modes, accurate_vectors(k), start, &
          work%clearance, work%found(k), error)
      else
        call set_speed(work%equations, factor(:, k))
        call find_bordered_modes(work%equations%pencil, modes, accurate_vectors(k), start, &
          work%found(k), error, work%clearance)
      end if
      counts%factorizations = counts%factorizations + work%found(k)%factorizations
      counts%reduced_solutions = counts%reduced_solutions + work%found(k)%reduced_solutions
      counts%full_solutions = counts%full_solutions + work%found(k)%full_solutions
      if (allocated(error)) then
        call move_alloc(error, outcome(k)%error)
        work%tracks(k)%length = 0
        cycle
      end if
      counts%proofs = counts%proofs + 1
      from_track = start%modes > 0 .and. &
        work%found(k)%reduced_solutions + work%found(k)%full_solutions == 0
      if (from_track) counts%extrapolated = counts%extrapolated + 1
      call remember(work%tracks(k), place, work%found(k), from_track)
    end do
  end subroutine solve_speeds

end module speed_solver
