!> What is found at a position, and the room it takes to find it.
module position_results
  use deformation_chain, only: deformation_chain_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use modal_assurance, only: mode_prints_t
  use shape_samples, only: shapes_t
  use speed_solver, only: reduced_work_t
  use text, only: string_t
  implicit none (type, external)
  private

  public :: position_result_t, position_work_t, of_frequency

  !> A frequency is off by half of what its eigenvalue is.
  real(wp), parameter :: of_frequency = 0.5_wp

  !> What was found at a position.
  type :: position_result_t
    real(wp), allocatable :: lambda(:, :)      !! (modes, speeds) ω² [1/s²]
    real(wp), allocatable :: error(:, :)       !! (modes, speeds) relative error of the frequency
    type(string_t), allocatable :: failure(:)  !! (speeds) empty, or why there is no result
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
    type(reduced_work_t) :: continuum, mesh
    type(deformation_chain_t) :: chain
  end type position_work_t

end module position_results
