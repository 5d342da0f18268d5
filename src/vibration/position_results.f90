!> What is found at a position, and the room it takes to find it.
module position_results
  use constants, only: two_pi
  use deformation_chain, only: deformation_chain_t
  use errors, only: outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use modal_assurance, only: mode_prints_t
  use shape_samples, only: shapes_t
  use speed_solver, only: speed_work_t
  implicit none (type, external)
  private

  public :: position_result_t, position_work_t, of_frequency, frequency_of, take_mesh_value

  !> A frequency is off by half of what its eigenvalue is.
  real(wp), parameter :: of_frequency = 0.5_wp

  !> What was found at a position.
  type :: position_result_t
    real(wp), allocatable :: lambda(:, :)      !! (modes, speeds) ω² [1/s²]
    real(wp), allocatable :: error(:, :)       !! (modes, speeds) relative error of the frequency
    type(outcome_t), allocatable :: outcome(:) !! (speeds) whether there is a result, or why not
    real(wp), allocatable :: deflection(:, :)  !! (bodies, speeds) largest static deflection under
                                               !! the loads, of the length [-]
    type(shapes_t), allocatable :: shapes(:)   !! (speeds) where they are wanted
    type(mode_prints_t), allocatable :: prints(:) !! (speeds) for following modes from position to
                                                  !! position
    real(wp) :: order_error = 0.0_wp           !! largest error of an eigenvalue that higher orders
                                               !! would mend
    type(ledger_t) :: counts
  end type position_result_t

  !> Room for the matrices of the models, and the last positions of a sweep.
  type :: position_work_t
    type(speed_work_t) :: continuum, mesh
    type(deformation_chain_t) :: chain
  end type position_work_t

contains

  !> `sign(λ) sqrt(|λ|)/2π`: negative past a divergence [Hz].
  elemental function frequency_of(lambda) result(frequency)
    real(wp), intent(in) :: lambda !! ω² [1/s²]
    real(wp) :: frequency

    frequency = sign(sqrt(abs(lambda)), lambda)/two_pi
  end function frequency_of

  !> Replaces what the continuous links gave by what the mesh gives; the difference is its error.
  elemental subroutine take_mesh_value(lambda_of_mesh, own_error, lambda, error)
    real(wp), intent(in) :: lambda_of_mesh, own_error !! eigenvalue of the mesh, relative error of
                                                      !! it
    real(wp), intent(inout) :: lambda, error

    real(wp) :: frequency, exact

    frequency = sign(sqrt(abs(lambda_of_mesh)), lambda_of_mesh)
    exact = sign(sqrt(abs(lambda)), lambda)
    error = (abs(frequency - exact) + error*abs(exact))/max(abs(frequency), tiny(frequency)) + &
      of_frequency*own_error
    lambda = lambda_of_mesh
  end subroutine take_mesh_value

end module position_results
