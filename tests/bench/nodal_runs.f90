!> The usual way to the frequencies, as lean as it can be made: matrices in nodal displacements, and a library routine for the lowest
!! eigenvalues, position by position. No vectors, no checks, no estimated errors; the program does all of these.
module nodal_runs
  use acceleration_fields, only: acceleration_field_t, unit_fields
  use assembly, only: assemble_geometric_stiffness, assemble_mass, assemble_stiffness
  use axial_forces, only: distributed_axial_forces
  use band_eigensolver, only: solve_band
  use band_matrix, only: band_matrix_t, full_matrix, order_of
  use bench_cases, only: with_band, with_dsygv
  use dense_eigensolver, only: solve_dense
  use errors, only: error_of_numerics, error_t, set_error
  use inertia_loads, only: distributed_load, load_t, pin_load
  use joint_forces, only: find_joint_forces
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use positions, only: state_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: solve_nodal_states

  interface
    !> All eigenvalues of `A x = λ B x`, symmetric, B positive definite (LAPACK).
    subroutine dsygv(itype, jobz, uplo, n, a, lda, b, ldb, w, work, lwork, info)
      import :: wp
      integer, intent(in) :: itype, n, lda, ldb, lwork
      character(len=1), intent(in) :: jobz, uplo
      real(wp), intent(inout) :: a(lda, *), b(ldb, *), w(*), work(*)
      integer, intent(out) :: info
    end subroutine dsygv
  end interface

contains

  !> The lowest eigenvalues at some positions. Errors: the routine fails at one of them.
  subroutine solve_nodal_states(mechanism, states, numbers, speed, modes, solver, threads, lambda, error)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: states(:)
    integer, intent(in) :: numbers(:)        !! of those to be solved
    real(wp), intent(in) :: speed            !! of the crank; 0: without axial forces [rad/s]
    integer, intent(in) :: modes, solver, threads
    real(wp), intent(inout) :: lambda(:, :)  !! (modes, states) ω² of those solved [1/s²]
    type(error_t), allocatable, intent(out) :: error

    type(error_t), allocatable :: failure
    integer :: i

    !$omp parallel do schedule(dynamic) num_threads(threads) default(shared) private(i, failure)
    do i = 1, size(numbers)
      call solve_state(mechanism, states(numbers(i)), speed, modes, solver, lambda(:, numbers(i)), failure)
      if (.not. allocated(failure)) cycle
      !$omp critical (keep_failure)
      call set_error(error, failure%kind, failure%text)
      !$omp end critical (keep_failure)
    end do
    !$omp end parallel do
  end subroutine solve_nodal_states

  subroutine solve_state(mechanism, state, speed, modes, solver, lambda, error)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: speed
    integer, intent(in) :: modes, solver
    real(wp), intent(out) :: lambda(:)
    type(error_t), allocatable, intent(out) :: error

    type(band_matrix_t) :: stiffness, mass, geometric
    real(wp), allocatable :: vectors(:, :)
    real(wp) :: inverse(modes)

    stiffness = assemble_stiffness(mechanism%linkage, mechanism%beams, mechanism%mesh, state%pose)
    mass = assemble_mass(mechanism%linkage, mechanism%mesh, state%pose)
    if (speed > 0.0_wp) then
      geometric = assemble_geometric_stiffness(mechanism%linkage, mechanism%mesh, state%pose, unit_axial_forces(mechanism, state))
      stiffness%entry = stiffness%entry + speed**2*geometric%entry
    end if
    inverse = 0.0_wp
    select case (solver)
    case (with_dsygv)
      call solve_all(stiffness, mass, inverse, error)
    case (with_band)
      call solve_band(stiffness, mass, modes, .false., inverse, vectors, error)
    case default
      call solve_dense(stiffness, mass, modes, .false., inverse, vectors, error)
    end select
    lambda = 0.0_wp
    if (.not. allocated(error)) lambda = 1.0_wp/inverse
  end subroutine solve_state

  !> Axial forces of distributed inertia for ω2² = 1.
  pure function unit_axial_forces(mechanism, state) result(force)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    real(wp), allocatable :: force(:, :) !! (1, ξ, ξ²; elements) [N]

    type(acceleration_field_t) :: fields(2)
    type(load_t) :: loads(size(mechanism%linkage%bodies))
    integer :: i

    associate (linkage => mechanism%linkage)
      fields = unit_fields(linkage, state%pose, state%coefficients)
      do i = 1, size(loads)
        loads(i) = distributed_load(linkage%bodies(i), i, state%pose, fields(1))
      end do
      force = distributed_axial_forces(linkage, mechanism%mesh, state%pose, fields(1), &
        find_joint_forces(linkage, state%pose, loads, pin_load(linkage, fields(1))))
    end associate
  end function unit_axial_forces

  !> `M x = θ K x` by dsygv: all eigenvalues, of which the largest are kept. That way round for the digits, as in `dense_eigensolver`.
  subroutine solve_all(stiffness, mass, inverse, error)
    type(band_matrix_t), intent(in) :: stiffness, mass
    real(wp), intent(out) :: inverse(:) !! 1/λ, largest first
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: a(:, :), b(:, :), w(:), work(:)
    real(wp) :: query(1)
    integer :: n, info

    n = order_of(stiffness)
    a = full_matrix(mass)
    b = full_matrix(stiffness)
    allocate (w(n))
    w = 0.0_wp
    query = 0.0_wp
    call dsygv(1, "N", "L", n, a, n, b, n, w, query, -1, info)
    allocate (work(max(1, nint(query(1)))))
    work = 0.0_wp
    call dsygv(1, "N", "L", n, a, n, b, n, w, work, size(work), info)
    inverse = w(n:n - size(inverse) + 1:-1)
    if (info /= 0) call set_error(error, error_of_numerics, &
      "dsygv failed (info = "//to_string(info)//")")
  end subroutine solve_all

end module nodal_runs
