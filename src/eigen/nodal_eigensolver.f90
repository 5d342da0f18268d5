!> The lowest modes of `K x = λ M x` in nodal unknowns, checked.
module nodal_eigensolver
  use band_eigensolver, only: solve_band
  use band_matrix, only: band_matrix_t, band_times_vector, order_of
  use dense_eigensolver, only: solve_dense
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use sturm_count, only: count_below, shifted
  use text, only: to_string
  implicit none (type, external)
  private

  public :: modes_t, find_modes, find_definite_shift, most_round_off

  !> Modes found, with the results of their checks.
  type :: modes_t
    real(wp), allocatable :: lambda(:)    !! (modes) ω², ascending; negative past a divergence
                                          !! [1/s²]
    real(wp), allocatable :: vector(:, :) !! (unknowns, modes) with xᵀMx = 1; (unknowns, 0) if not
                                          !! requested
    real(wp) :: uncertainty = 0.0_wp      !! largest relative half-width of a bracket in which a
                                          !! count has confirmed an eigenvalue
    real(wp) :: residual = 0.0_wp         !! largest, relative to the terms that cancel in it
    real(wp) :: orthogonality = 0.0_wp    !! largest |xᵢᵀMxⱼ − δᵢⱼ|
    integer :: factorizations = 0         !! Cholesky factorizations and inertia counts
  end type modes_t

  !> Limits that a sound solution stays well below: residuals are near 1e-15, orthogonality near
  !! 1e-13.
  real(wp), parameter :: most_residual = 1.0e-11_wp, most_orthogonality = 1.0e-9_wp

  !> Relative half-width of an eigenvalue's bracket, and its limit after widening for round-off.
  real(wp), parameter :: bracket = 1.0e-9_wp, widest_bracket = 5.0e-6_wp

  !> Largest allowed rounding error of K, relative to the lowest eigenvalue.
  real(wp), parameter :: most_round_off = 1.0e-6_wp

  !> Factors on the round-off bounds of K and of the solver. The bound of K is generous in itself;
  !! with its factor, the bracket stays within its limit for every mesh that keeps `most_round_off`.
  real(wp), parameter :: stiffness_margin = 4.0_wp, solver_margin = 100.0_wp

contains

  !> Finds and checks the lowest modes.
  !!
  !! An indefinite K (past a divergence) is made definite by a shift σM. Every eigenvalue is
  !! confirmed by two counts: the i-th has fewer than i eigenvalues below its bracket and at least i
  !! below the upper end of the bracket. So none is wrong and none is missing. Vectors, where
  !! wanted, are checked for residual and mass orthogonality. Errors: entries beyond the range of
  !! double precision; a solver fails; a check fails, with the numbers in the message.
  subroutine find_modes(stiffness, mass, modes, dense, definite, roundoff, want_vectors, found, &
    error)
    type(band_matrix_t), intent(in) :: stiffness     !! K, with the geometric stiffness, if any
    type(band_matrix_t), intent(in) :: mass          !! M, positive definite except in directions
                                                     !! that K and K_G leave stiff
    integer, intent(in) :: modes                     !! how many
    logical, intent(in) :: dense                     !! full matrices and LAPACK; else band matrices
                                                     !! and ARPACK
    logical, intent(in) :: definite                  !! K is known to be positive definite
    real(wp), intent(in) :: roundoff                 !! error of eigenvalues from the rounding of K
                                                     !! [1/s²]
    logical, intent(in) :: want_vectors              !! besides eigenvalues
    type(modes_t), intent(out) :: found              !! modes and checks
    type(error_t), allocatable, intent(out) :: error !! allocated on failure

    real(wp) :: shift, inverse(modes)
    integer :: i

    if (.not. (all(abs(stiffness%entry) <= huge(1.0_wp)) .and. &
      all(abs(mass%entry) <= huge(1.0_wp)))) then
      call set_error(error, error_of_numerics, &
        "the matrices hold numbers beyond the range of double precision")
      return
    end if
    shift = 0.0_wp
    if (.not. definite) call find_definite_shift(stiffness, mass, shift, found%factorizations)
    if (dense) then
      call solve_dense(shifted(stiffness, mass, shift), mass, modes, want_vectors, inverse, &
        found%vector, error)
    else
      call solve_band(shifted(stiffness, mass, shift), mass, modes, want_vectors, inverse, &
        found%vector, error)
    end if
    found%factorizations = found%factorizations + 1
    if (allocated(error)) return
    found%lambda = 1.0_wp/inverse - shift
    call confirm_eigenvalues(stiffness, mass, shift, roundoff, found, error)
    if (allocated(error)) return
    do i = 1, size(found%vector, 2)
      associate (x => found%vector(:, i))
        x = x/sqrt(dot_product(x, band_times_vector(mass, x)))
      end associate
    end do
    call check_vectors(stiffness, mass, shift, found, error)
  end subroutine find_modes

  !> A shift σ for which `K + σM` is definite: four times the first of σ0, 4σ0, 16σ0, … that makes
  !! it so; 0 if K is definite and no least shift is given.
  pure subroutine find_definite_shift(stiffness, mass, shift, factorizations, least)
    type(band_matrix_t), intent(in) :: stiffness !! K
    type(band_matrix_t), intent(in) :: mass      !! M
    real(wp), intent(out) :: shift               !! σ [1/s²]
    integer, intent(inout) :: factorizations     !! counter, raised by those made here
    real(wp), intent(in), optional :: least      !! of σ0, for a K that may be singular [1/s²]

    real(wp), parameter :: small = 1.0e-8_wp

    shift = 0.0_wp
    if (.not. present(least)) then
      factorizations = factorizations + 1
      if (count_below(stiffness, mass, 0.0_wp) == 0) return
    end if
    ! A diagonal entry may vanish by chance; the largest entry of the matrix does not.
    shift = max(small*minval(abs(stiffness%entry(1, :))/mass%entry(1, :)), &
      small**2*maxval(abs(stiffness%entry))/maxval(mass%entry(1, :)))
    ! No lesser shift makes the diagonal positive.
    shift = max(shift, maxval(-stiffness%entry(1, :)/mass%entry(1, :)))
    if (present(least)) shift = max(shift, least)
    do
      factorizations = factorizations + 1
      ! If rounding has made M indefinite, there is no such shift: factorizing K + σM then fails.
      if (count_below(stiffness, mass, -shift) == 0 .or. shift > sqrt(huge(shift))) exit
      shift = 4.0_wp*shift
    end do
    ! One step more, so that the lowest shifted eigenvalue is not accidentally near zero.
    shift = 4.0_wp*shift
  end subroutine find_definite_shift

  !> Brackets every eigenvalue by inertia counts.
  !!
  !! The bracket is as wide as the error that round-off permits: that of K itself, and that of the
  !! solver, which is relative to the lowest shifted eigenvalue.
  pure subroutine confirm_eigenvalues(stiffness, mass, shift, roundoff, found, error)
    type(band_matrix_t), intent(in) :: stiffness, mass
    real(wp), intent(in) :: shift, roundoff
    type(modes_t), intent(inout) :: found
    type(error_t), allocatable, intent(inout) :: error

    real(wp) :: width, relative_width, lowest, size_of
    integer :: i, below, up_to

    lowest = found%lambda(1) + shift
    do i = 1, size(found%lambda)
      size_of = abs(found%lambda(i)) + shift
      width = bracket*abs(found%lambda(i)) + stiffness_margin*roundoff + &
        solver_margin*epsilon(1.0_wp)*size_of**2/lowest
      relative_width = width/max(abs(found%lambda(i)), epsilon(width)*width)
      found%uncertainty = max(found%uncertainty, relative_width)
      below = count_below(stiffness, mass, found%lambda(i) - width)
      up_to = count_below(stiffness, mass, found%lambda(i) + width)
      found%factorizations = found%factorizations + 2
      if (relative_width > widest_bracket .or. (i == 1 .and. roundoff > most_round_off*size_of)) &
        then
        call set_error(error, error_of_numerics, "round-off leaves mode "//to_string(i)// &
          " uncertain by "//to_string(0.5_wp*relative_width, 2)//" of its frequency; "// &
          "fewer elements or 'accuracy=' leave less")
      else if (below > i - 1) then
        call set_error(error, error_of_numerics, "a mode is missing: "//to_string(below)// &
          " eigenvalues are counted below mode "//to_string(i))
      else if (up_to < i) then
        call set_error(error, error_of_numerics, "mode "//to_string(i)// &
          " is not confirmed: only "//to_string(up_to)//" eigenvalues are counted up to it")
      end if
      if (allocated(error)) return
    end do
  end subroutine confirm_eigenvalues

  !> Checks `K x = λ M x` and `xᵢᵀMxⱼ = δᵢⱼ`.
  !!
  !! Displacements and rotations are made comparable by the diagonals:
  !! `‖D^{-1/2}(Kx − λMx)‖ ≤ tolerance ‖D^{1/2}x‖`. The tolerance grows with λ, because the solvers
  !! find 1/λ with an error relative to the largest 1/λ.
  pure subroutine check_vectors(stiffness, mass, shift, found, error)
    type(band_matrix_t), intent(in) :: stiffness, mass
    real(wp), intent(in) :: shift !! that made the stiffness definite [1/s²]
    type(modes_t), intent(inout) :: found
    type(error_t), allocatable, intent(inout) :: error

    real(wp) :: residual, tolerance, product_of, mass_times(order_of(mass)), scale(order_of(mass))
    integer :: i, j

    scale = sqrt(abs(stiffness%entry(1, :)) + maxval(abs(found%lambda))*mass%entry(1, :))
    do i = 1, size(found%vector, 2)
      mass_times = band_times_vector(mass, found%vector(:, i))
      residual = &
        norm2((band_times_vector(stiffness, found%vector(:, i)) - found%lambda(i)*mass_times)/ &
        scale)/norm2(scale*found%vector(:, i))
      tolerance = most_residual + solver_margin*epsilon(residual)*(found%lambda(i) + shift)/ &
        (found%lambda(1) + shift)
      ! Not `residual > tolerance`: NaN must not pass.
      if (.not. residual <= tolerance) then
        call set_error(error, error_of_numerics, "the residual of mode "//to_string(i)//" is "// &
          to_string(residual, 2)//", above "//to_string(tolerance, 2))
        return
      end if
      found%residual = max(found%residual, residual)
      do j = 1, i
        product_of = abs(dot_product(found%vector(:, j), mass_times) - merge(1.0_wp, 0.0_wp, &
          i == j))
        if (.not. product_of <= most_orthogonality) then
          call set_error(error, error_of_numerics, "modes "//to_string(j)//" and "//to_string(i)// &
            " are orthogonal only to "//to_string(product_of, 2)//", above "// &
            to_string(most_orthogonality))
          return
        end if
        found%orthogonality = max(found%orthogonality, product_of)
      end do
    end do
  end subroutine check_vectors

end module nodal_eigensolver
