!> Lowest modes from full matrices, by LAPACK.
module dense_eigensolver
  use band_matrix, only: band_matrix_t, full_matrix, order_of
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use lapack, only: dsygvx
  use text, only: to_string
  implicit none (type, external)
  private

  public :: solve_dense

contains

  !> Solves `M x = θ K x` for the largest θ = 1/λ.
  !!
  !! In the form `K x = λ M x`, the error of every eigenvalue would be relative to the highest one,
  !! which belongs to axial waves in the smallest element. In this form it is relative to the lowest
  !! λ, which is wanted. Errors: LAPACK finds that K is not positive definite, or does not converge.
  recursive subroutine solve_dense(stiffness, mass, modes, want_vectors, inverse, vectors, error, &
    tolerance)
    type(band_matrix_t), intent(in) :: stiffness        !! K, positive definite
    type(band_matrix_t), intent(in) :: mass             !! M
    integer, intent(in) :: modes                        !! how many
    logical, intent(in) :: want_vectors                 !! besides eigenvalues
    real(wp), intent(out) :: inverse(:)                 !! (modes) 1/λ, largest first
    real(wp), allocatable, intent(out) :: vectors(:, :) !! (unknowns, modes) with xᵀKx = 1;
                                                        !! (unknowns, 0) unless requested
    type(error_t), allocatable, intent(out) :: error    !! allocated on failure
    real(wp), intent(in), optional :: tolerance         !! absolute, of 1/λ; absent: all digits. A
                                                        !! coarse one halves the time

    real(wp), allocatable :: a(:, :), b(:, :), w(:), z(:, :), work(:)
    integer, allocatable :: iwork(:), ifail(:)
    integer :: n, found, info
    real(wp) :: query(1), abstol
    character(len=1) :: job

    n = order_of(stiffness)
    job = merge("V", "N", want_vectors)
    a = full_matrix(mass)
    b = full_matrix(stiffness)
    allocate (w(n), z(n, merge(modes, 1, want_vectors)), iwork(5*n), ifail(n))
    w = 0.0_wp
    z = 0.0_wp
    iwork = 0
    ifail = 0
    query = 0.0_wp
    abstol = 2.0_wp*tiny(1.0_wp)
    if (present(tolerance)) abstol = tolerance
    call dsygvx(1, job, "I", "L", n, a, n, b, n, 0.0_wp, 0.0_wp, n - modes + 1, n, abstol, found, &
       w, z, n, query, -1, iwork, ifail, info)
    allocate (work(max(1, nint(query(1)))))
    work = 0.0_wp
    call dsygvx(1, job, "I", "L", n, a, n, b, n, 0.0_wp, 0.0_wp, n - modes + 1, n, abstol, found, &
       w, z, n, work, size(work), iwork, ifail, info)
    allocate (vectors(n, 0))
    if (info > n) then
      call set_error(error, error_of_numerics, &
        "the stiffness matrix is not positive definite at unknown "//to_string(info - n))
    else if (info > 0 .and. present(tolerance)) then
      ! Some vectors converge only for eigenvalues with all digits: try again without a tolerance.
      call solve_dense(stiffness, mass, modes, want_vectors, inverse, vectors, error)
    else if (info > 0 .or. found /= modes) then
      call set_error(error, error_of_numerics, "dsygvx did not converge (info = "// &
        to_string(info)//")")
    else
      inverse = w(modes:1:-1)
      if (want_vectors) vectors = z(:, modes:1:-1)
    end if
  end subroutine solve_dense

end module dense_eigensolver
