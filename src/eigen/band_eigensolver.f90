!> Lowest modes of band matrices, by ARPACK with shift and invert.
module band_eigensolver
  use band_matrix, only: band_matrix_t, band_times_vector, order_of
  use cholesky_factor, only: factor_band, solve_with_factor
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use lapack, only: dsaupd, dseupd
  use sorting, only: ascending_order
  use text, only: to_string
  implicit none (type, external)
  private

  public :: solve_band

  integer, parameter :: most_restarts = 1000

contains

  !> Solves `K x = λ M x` for the lowest λ as `K⁻¹ M x = θ x` for the largest θ = 1/λ (ARPACK mode 3
  !! with shift 0).
  !!
  !! The start vector is fixed, so that the same matrices give the same digits whatever was solved
  !! before. ARPACK keeps state between its calls, so that threads take turns. Errors: K is not
  !! positive definite, too many modes, ARPACK does not converge.
  subroutine solve_band(stiffness, mass, modes, want_vectors, inverse, vectors, error)
    type(band_matrix_t), intent(in) :: stiffness !! positive definite
    type(band_matrix_t), intent(in) :: mass
    integer, intent(in) :: modes                 !! at least two fewer than the unknowns
    logical, intent(in) :: want_vectors
    real(wp), intent(out) :: inverse(:)          !! (modes) 1/λ, largest first
    real(wp), allocatable, intent(out) :: vectors(:, :) !! (unknowns, modes); (unknowns, 0) unless
                                                        !! wanted
    type(error_t), allocatable, intent(out) :: error

    type(band_matrix_t) :: factor
    real(wp), allocatable :: residual(:), basis(:, :), workd(:), workl(:), lambda(:), z(:, :)
    logical, allocatable :: selected(:)
    real(wp) :: tolerance
    integer :: n, basis_size, iparam(11), ipntr(11), info, i

    allocate (vectors(order_of(stiffness), 0))
    factor = stiffness
    call factor_band(factor, error)
    if (allocated(error)) return
    n = order_of(stiffness)
    if (modes > n - 2) then
      call set_error(error, error_of_numerics, &
        "ARPACK finds at least two modes fewer than there are unknowns")
      return
    end if
    ! A basis of the whole space leaves no residual, and ARPACK divides by it.
    basis_size = min(n - 1, max(2*modes + 1, 20))
    allocate (residual(n), basis(n, basis_size), workd(3*n), workl(basis_size*(basis_size + 8)))
    allocate (selected(basis_size), lambda(modes), z(n, merge(modes, 1, want_vectors)))
    basis = 0.0_wp
    workd = 0.0_wp
    workl = 0.0_wp
    z = 0.0_wp
    lambda = 0.0_wp
    selected = .false.
    ! Not constant: a constant vector can be orthogonal to a mode by symmetry.
    residual = [(1.0_wp + 0.5_wp*sin(real(i, wp)), i=1, n)]
    iparam = 0
    iparam([1, 3, 7]) = [1, most_restarts, 3]
    ipntr = 0
    !$omp critical (arpack)
    call iterate(factor, mass, modes, residual, basis, iparam, ipntr, workd, workl, tolerance, info)
    if (info == 0) then
      call dseupd(want_vectors, "A", selected, lambda, z, n, 0.0_wp, "G", n, "LM", modes, &
        tolerance, residual, basis_size, basis, n, iparam, ipntr, workd, workl, size(workl), info)
    end if
    !$omp end critical (arpack)
    if (info /= 0) then
      call set_error(error, error_of_numerics, "ARPACK did not converge (info = "// &
        to_string(info)//")")
      return
    end if
    call sort_modes(lambda, z, want_vectors, inverse, vectors)
  end subroutine solve_band

  !> Runs ARPACK's reverse communication to its end.
  subroutine iterate(factor, mass, modes, residual, basis, iparam, ipntr, workd, workl, tolerance, &
    info)
    type(band_matrix_t), intent(in) :: factor, mass
    integer, intent(in) :: modes
    real(wp), intent(inout), contiguous :: residual(:), basis(:, :), workd(:), workl(:)
    integer, intent(inout) :: iparam(11), ipntr(11)
    real(wp), intent(out) :: tolerance
    integer, intent(out) :: info

    integer :: ido, n

    n = size(residual)
    ido = 0
    info = 1 ! the start vector is ours
    tolerance = 0.0_wp ! machine precision; ARPACK writes into it
    do
      call dsaupd(ido, "G", n, "LM", modes, tolerance, residual, size(basis, 2), basis, n, iparam, &
        ipntr, workd, workl, size(workl), info)
      if (all(ido /= [-1, 1, 2])) return
      associate (x => workd(ipntr(1):ipntr(1) + n - 1), y => workd(ipntr(2):ipntr(2) + n - 1))
        if (ido == 1) then
          y = workd(ipntr(3):ipntr(3) + n - 1) ! M x is here already
        else
          y = band_times_vector(mass, x)
        end if
        if (ido /= 2) call solve_with_factor(factor, y)
      end associate
    end do
  end subroutine iterate

  !> Puts the modes in ascending order of λ. ARPACK's own order depends on how it converged.
  pure subroutine sort_modes(lambda, z, want_vectors, inverse, vectors)
    real(wp), intent(in) :: lambda(:), z(:, :)
    logical, intent(in) :: want_vectors
    real(wp), intent(out) :: inverse(:)
    real(wp), allocatable, intent(inout) :: vectors(:, :)

    integer :: order(size(lambda))

    order = ascending_order(lambda)
    inverse = 1.0_wp/lambda(order)
    if (want_vectors) vectors = z(:, order)
  end subroutine sort_modes

end module band_eigensolver
