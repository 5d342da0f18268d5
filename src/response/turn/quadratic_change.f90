!> How much the terms that the linear equations leave out would change the response.
!!
!! The forces of the linkage at the deformations found, with exact kinematics, do not balance there:
!! the rest is quadratic in the loads, to first order. One more solution of the linear equations
!! with it as load is the first step of Newton's method towards the balance; its strains against
!! those found are the change.
module quadratic_change
  use elastic_equations, only: apply_equation, elastic_terms_t, load_at_speed
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use exact_forces, only: find_exact_forces
  use fourier_transform, only: fourier_plan_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use periodic_solver, only: solve_periodic
  use response_peaks, only: find_peaks
  use response_types, only: response_request_t, speed_response_t
  use strain_dampings, only: damping_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: find_quadratic_change, find_unbalanced_forces

contains

  !> The largest change of the strain of every link over the turn and along it, over its largest
  !! strain; of the outermost fibre, signs and places apart.
  !!
  !! Without a result: deformed so much, the linkage cannot be closed, or the iterations do not
  !! converge.
  subroutine find_quadratic_change(linkage, equation, request, y, tolerance, strain, step, change)
    type(linkage_t), intent(in) :: linkage          !! of the grid
    type(equation_at_speed_t), intent(in) :: equation
    type(response_request_t), intent(in) :: request !! sections
    real(wp), intent(in) :: y(:, :)                 !! (samples, unknowns) the response [√J]
    real(wp), intent(in) :: tolerance               !! remainder of the iterations
    real(wp), intent(in) :: strain(:)               !! (bodies) the largest of the response
    real(wp), allocatable, intent(inout) :: step(:, :) !! (samples, unknowns) the change of y, found
                                                    !! from a start if it is allocated
    real(wp), allocatable, intent(out) :: change(:) !! (bodies) zero for rigid links; unallocated:
                                                    !! none is found

    type(error_t), allocatable :: error
    type(speed_response_t) :: of_step
    real(wp), allocatable :: load(:, :)
    real(wp) :: remainder
    integer :: b, applications

    allocate (load, mold=y)
    call find_unbalanced_forces(linkage, equation%grid, equation%plan, equation%speed, y, load, &
      error)
    if (allocated(error) .or. .not. all(abs(load) < huge(1.0_wp))) return
    if (.not. allocated(step)) allocate (step(size(y, 1), size(y, 2)), source=0.0_wp)
    call solve_periodic(equation, load, tolerance, step, applications, remainder, error)
    if (allocated(error)) return
    allocate (change(size(linkage%bodies)))
    change = 0.0_wp
    call find_peaks(equation%grid, equation%plan, request, step, of_step, only_strains=.true.)
    do b = 1, size(change)
      if (linkage%bodies(b)%bends) change(b) = of_step%largest_strain(b)%value/ &
        max(strain(b), tiny(1.0_wp))
    end do
  end subroutine find_quadratic_change

  !> The forces that the linear equations leave out: the exact forces less those of the linear
  !! equations with all their terms.
  !!
  !! Errors: the deformed links do not reach each other.
  subroutine find_unbalanced_forces(linkage, grid, plan, speed, y, force, error)
    type(linkage_t), intent(in) :: linkage           !! of the grid
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan         !! for its samples
    real(wp), intent(in) :: speed                    !! ω2 [rad/s]
    real(wp), intent(in) :: y(:, :)                  !! (samples, unknowns) [√J]
    real(wp), intent(out) :: force(:, :)             !! (samples, unknowns) [√J]
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(damping_t) :: none
    real(wp) :: linear(size(y, 1), size(y, 2))

    allocate (none%c(size(y, 2)), source=0.0_wp)
    call find_exact_forces(linkage, grid, plan, speed, y, force, error)
    if (allocated(error)) return
    call apply_equation(grid, plan, speed, none, elastic_terms_t(), y, linear)
    force = force - load_at_speed(grid, speed) + linear - y
  end subroutine find_unbalanced_forces

end module quadratic_change
