!> Results of the vibration analysis at one position, and the work space for it.
module position_results
  use constants, only: two_pi
  use errors, only: outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use modal_assurance, only: mode_prints_t
  use position_assembly, only: assembled_t
  use shape_samples, only: shapes_t
  use speed_solver, only: speed_work_t
  implicit none (type, external)
  private

  public :: position_result_t, position_work_t, frequency_error, frequency_of, take_mesh_value
  public :: largest_error, error_of_orders, error_of_position, error_of_divergence, &
    error_of_rounding

  !> What the largest error of a row is made of: polynomial orders that reach their limit; the
  !! rounding of the position, as beside a dead point; terms that cancel in an eigenvalue, as beside
  !! a divergence; other rounding of the matrices.
  integer, parameter :: error_of_orders = 1, error_of_position = 2, error_of_divergence = 3, &
    error_of_rounding = 4

  !> An elastic energy this many times the eigenvalue is nearly cancelled by the loads.
  real(wp), parameter :: many_times = 100.0_wp

  type :: position_result_t
    real(wp), allocatable :: lambda(:, :)      !! (modes, speeds) ω² [1/s²]; with dampers |s|² of a
                                               !! root s, -s² where it is real and positive
    real(wp), allocatable :: damping(:, :)     !! (modes, speeds) damping ratios [-]; unallocated
                                               !! without dampers
    real(wp), allocatable :: error(:, :)       !! (modes, speeds) estimated relative error of the
                                               !! frequency
    type(outcome_t), allocatable :: outcome(:) !! (speeds) the error where there is no result
    real(wp), allocatable :: deflection(:, :)  !! (bodies, speeds) largest static deflection under
                                               !! the loads / length of the link [-]
    type(shapes_t), allocatable :: shapes(:)   !! (speeds) empty unless requested
    type(mode_prints_t), allocatable :: prints(:) !! (speeds) for following modes from position to
                                                  !! position; unallocated unless requested
    integer, allocatable :: cause(:)           !! (speeds) what the largest error is made of; 0: it
                                               !! is within the requested accuracy, or
                                               !! not known, on a mesh
    real(wp) :: order_error = 0.0_wp           !! largest relative error of an eigenvalue that
                                               !! higher orders would reduce
    type(ledger_t) :: counts                   !! of the work done here
  end type position_result_t

  !> Matrices of the models, and the modes of the last positions of a sweep.
  type :: position_work_t
    type(assembled_t) :: here       !! the present position
    real(wp), allocatable :: factor(:, :) !! (cases, speeds) of the unit loads there: ω2², α2, 1
    type(speed_work_t) :: continuum !! for the continuous links
    type(speed_work_t) :: mesh      !! for the deck's mesh
  end type position_work_t

contains

  !> What the largest of the errors of a row is made of.
  pure function largest_error(orders, position, matrices, energy, lambda) result(cause)
    real(wp), intent(in) :: orders(:), position(:), matrices(:) !! (modes) parts of the error
    real(wp), intent(in) :: energy(:) !! (modes) elastic, of unit mass, twice [1/s²]
    real(wp), intent(in) :: lambda(:) !! (modes) eigenvalues [1/s²]
    integer :: cause                  !! one of the causes above

    integer :: worst

    worst = maxloc(orders + position + matrices, dim=1)
    cause = maxloc([orders(worst), position(worst), matrices(worst)], dim=1)
    if (cause == 3) cause = merge(error_of_divergence, error_of_rounding, energy(worst) > &
      many_times*abs(lambda(worst)))
  end function largest_error

  !> Frequency of an eigenvalue, `sign(λ) sqrt(|λ|)/2π` [Hz]: negative past a divergence.
  elemental function frequency_of(lambda) result(frequency)
    real(wp), intent(in) :: lambda !! ω² [1/s²]
    real(wp) :: frequency

    frequency = sign(sqrt(abs(lambda)), lambda)/two_pi
  end function frequency_of

  !> Relative error of a frequency whose eigenvalue has the relative error e: half of it, if small;
  !! one of 1 or more reaches zero, and beyond it the frequencies that stand for negative ones.
  elemental function frequency_error(eigenvalue_error) result(error)
    real(wp), intent(in) :: eigenvalue_error !! e, not negative
    real(wp) :: error

    if (eigenvalue_error <= 1.0_wp) then
      error = eigenvalue_error/(1.0_wp + sqrt(1.0_wp - eigenvalue_error))
    else
      error = 1.0_wp + sqrt(eigenvalue_error - 1.0_wp)
    end if
  end function frequency_error

  !> Replaces the eigenvalue of the continuous links by that of the mesh. The difference of their
  !! frequencies is added to the error.
  elemental subroutine take_mesh_value(lambda_of_mesh, own_error, lambda, error)
    real(wp), intent(in) :: lambda_of_mesh !! ω² of the mesh [1/s²]
    real(wp), intent(in) :: own_error      !! relative error of that as a solution of the mesh
    real(wp), intent(inout) :: lambda      !! ω² of the continuous links; becomes that of the mesh
                                           !! [1/s²]
    real(wp), intent(inout) :: error       !! relative error of the frequency

    real(wp) :: frequency, exact

    frequency = sign(sqrt(abs(lambda_of_mesh)), lambda_of_mesh)
    exact = sign(sqrt(abs(lambda)), lambda)
    error = (abs(frequency - exact) + error*abs(exact))/max(abs(frequency), tiny(frequency)) + &
      frequency_error(own_error)
    lambda = lambda_of_mesh
  end subroutine take_mesh_value

end module position_results
