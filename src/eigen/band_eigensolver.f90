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

  !> What ARPACK keeps between two calls of its reverse communication.
  type :: arpack_t
    real(wp), allocatable :: residual(:)  !! (unknowns) at first the start vector
    real(wp), allocatable :: basis(:, :)  !! (unknowns, vectors) of the Krylov space
    real(wp), allocatable :: workd(:), workl(:)
    integer :: iparam(11) = 0, ipntr(11) = 0
    real(wp) :: tolerance = 0.0_wp        !! 0: machine precision; ARPACK writes into it
  end type arpack_t

  integer, parameter :: most_restarts = 1000

contains

  !> Solves `K x = λ M x` for the lowest λ as `K⁻¹ M x = θ x` for the largest θ = 1/λ (ARPACK mode 3
  !! with shift 0).
  !!
  !! The start vector is fixed, so that the same matrices give the same digits whatever was solved
  !! before. ARPACK keeps variables of its own between calls, so threads take turns.
  !!
  !! Errors: K is not positive definite, too many modes, ARPACK does not converge.
  subroutine solve_band(stiffness, mass, modes, want_vectors, inverse, vectors, error)
    type(band_matrix_t), intent(in) :: stiffness !! positive definite
    type(band_matrix_t), intent(in) :: mass      !! consistent, positive definite
    integer, intent(in) :: modes                 !! at least two fewer than the unknowns
    logical, intent(in) :: want_vectors          !! else eigenvalues only
    real(wp), intent(out) :: inverse(:)          !! (modes) 1/λ, largest first
    real(wp), allocatable, intent(out) :: vectors(:, :) !! (unknowns, modes); (unknowns, 0) unless
                                                        !! wanted
    type(error_t), allocatable, intent(out) :: error !! without position and speed

    type(band_matrix_t) :: factor
    type(arpack_t) :: state
    real(wp), allocatable :: lambda(:), z(:, :)
    logical, allocatable :: selected(:)
    integer :: n, basis_size, info

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
    state = new_arpack(n, basis_size)
    allocate (selected(basis_size), lambda(modes), z(n, merge(modes, 1, want_vectors)))
    z = 0.0_wp
    lambda = 0.0_wp
    selected = .false.
    !$omp critical (arpack)
    call iterate(factor, mass, modes, state, info)
    if (info == 0) then
      call dseupd(want_vectors, "A", selected, lambda, z, n, 0.0_wp, "G", n, "LM", modes, &
        state%tolerance, state%residual, basis_size, state%basis, n, state%iparam, state%ipntr, &
        state%workd, state%workl, size(state%workl), info)
    end if
    !$omp end critical (arpack)
    if (info /= 0) then
      call set_error(error, error_of_numerics, "ARPACK did not converge (info = "// &
        to_string(info)//")")
      return
    end if
    call sort_modes(lambda, z, want_vectors, inverse, vectors)
  end subroutine solve_band

  !> ARPACK before its first call, in shift and invert mode with a start vector of ours.
  pure function new_arpack(unknowns, basis_size) result(state)
    integer, intent(in) :: unknowns, basis_size
    type(arpack_t) :: state

    integer :: i

    allocate (state%basis(unknowns, basis_size), state%workd(3*unknowns), &
      state%workl(basis_size*(basis_size + 8)))
    state%basis = 0.0_wp
    state%workd = 0.0_wp
    state%workl = 0.0_wp
    ! Not constant: a constant vector can be orthogonal to a mode by symmetry.
    state%residual = [(1.0_wp + 0.5_wp*sin(real(i, wp)), i=1, unknowns)]
    state%iparam([1, 3, 7]) = [1, most_restarts, 3]
  end function new_arpack

  !> Runs ARPACK's reverse communication to its end.
  subroutine iterate(factor, mass, modes, state, info)
    type(band_matrix_t), intent(in) :: factor    !! of the stiffness matrix, by `factor_band`
    type(band_matrix_t), intent(in) :: mass
    integer, intent(in) :: modes
    type(arpack_t), intent(inout) :: state
    integer, intent(out) :: info                 !! 0 if it has converged

    integer :: ido, n

    n = size(state%residual)
    ido = 0
    info = 1 ! the start vector is ours
    do
      call dsaupd(ido, "G", n, "LM", modes, state%tolerance, state%residual, &
        size(state%basis, 2), state%basis, n, state%iparam, state%ipntr, state%workd, &
        state%workl, size(state%workl), info)
      if (all(ido /= [-1, 1, 2])) return
      associate (at => state%ipntr, workd => state%workd)
        associate (x => workd(at(1):at(1) + n - 1), y => workd(at(2):at(2) + n - 1))
          if (ido == 1) then
            y = workd(at(3):at(3) + n - 1) ! M x is here already
          else
            y = band_times_vector(mass, x)
          end if
          if (ido /= 2) call solve_with_factor(factor, y)
        end associate
      end associate
    end do
  end subroutine iterate

  !> Puts the modes in ascending order of λ. ARPACK's own order depends on how it converged.
  pure subroutine sort_modes(lambda, z, want_vectors, inverse, vectors)
    real(wp), intent(in) :: lambda(:), z(:, :) !! (modes), (unknowns, modes)
    logical, intent(in) :: want_vectors
    real(wp), intent(out) :: inverse(:)        !! (modes) 1/λ
    real(wp), allocatable, intent(inout) :: vectors(:, :)

    integer :: order(size(lambda))

    order = ascending_order(lambda)
    inverse = 1.0_wp/lambda(order)
    if (want_vectors) vectors = z(:, order)
  end subroutine sort_modes

end module band_eigensolver
