!> The lowest modes of `K x = λ M x` by products with vectors only, for a stiffness near the unit
!! matrix.
module subspace_eigensolver
  use band_matrix, only: band_matrix_t, band_times_vector, new_band_matrix
  use dense_eigensolver, only: solve_dense
  use eigenvalue_gaps, only: relative_gap
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: fineness, wp
  use long_sums, only: long_dot
  use nodal_eigensolver, only: find_definite_shift
  use sturm_count, only: shifted
  use symmetric_pencil, only: symmetric_pencil_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: subspace_modes_t, find_subspace_modes

  !> Modes found, with their errors and the work done.
  type :: subspace_modes_t
    real(wp), allocatable :: lambda(:)             !! (modes) ascending [1/s²]
    real(wp), allocatable :: vector(:, :)          !! (unknowns, modes) with xᵀMx = 1
    real(wp), allocatable :: mass_times(:, :)      !! (unknowns, modes) M x
    real(wp), allocatable :: stiffness_times(:, :) !! (unknowns, modes) K x
    real(wp), allocatable :: error(:)              !! (modes) estimated relative error of λ
    integer :: products = 0                        !! of a vector with both matrices
  end type subspace_modes_t

  !> The basis restarts with the modes found so far when it has grown by this many times their
  !! number.
  integer, parameter :: most_growth = 8

  integer, parameter :: most_steps = 100

  !> Relative gap assumed between the last requested mode and the next one, which is not computed.
  real(wp), parameter :: unknown_gap = 1.0e-3_wp

  !> Error of an eigenvalue from the rounding of long sums, in units of ε.
  real(wp), parameter :: rounding = 32.0_wp

contains

  !> Davidson's method (J. Comput. Phys. 17 (1975) 87): the residuals of the best vectors in a
  !! subspace are added to it. Except for the axial forces, the stiffness is the unit matrix, so a
  !! residual is nearly the correction that its vector needs.
  !!
  !! Errors: two start vectors coincide; no convergence; the small dense problem fails.
  subroutine find_subspace_modes(pencil, start, accurate_vectors, found, error)
    class(symmetric_pencil_t), intent(in) :: pencil  !! K and M
    real(wp), intent(in) :: start(:, :)              !! (unknowns, modes) near the modes requested
    logical, intent(in) :: accurate_vectors          !! all digits in the vectors, too
    type(subspace_modes_t), intent(out) :: found     !! as many as in `start`
    type(error_t), allocatable, intent(out) :: error !! allocated on failure

    real(wp), allocatable :: basis(:, :), mass_times(:, :), stiffness_times(:, :), small(:, :)
    real(wp) :: residual(size(start, 1)), squared(size(start, 2))
    logical :: converged(size(start, 2))
    real(wp), allocatable, dimension(:, :) :: small_mass, small_stiffness
    integer :: i, step, modes, number, known

    modes = size(start, 2)
    allocate (basis(size(start, 1), (most_growth + 1)*modes))
    allocate (mass_times, mold=basis)
    allocate (stiffness_times, mold=basis)
    allocate (small_mass(size(basis, 2), size(basis, 2)))
    allocate (small_stiffness, mold=small_mass)
    number = 0
    known = 0
    do i = 1, modes
      call extend(pencil, start(:, i), basis, mass_times, stiffness_times, number, found%products)
    end do
    if (number < modes) then
      call set_error(error, error_of_numerics, "two modes have the same starting vector")
      return
    end if
    do step = 1, most_steps
      do i = known + 1, number
        call project(basis(:, i), mass_times(:, :i), stiffness_times(:, :i), small_mass(:i, i), &
          small_stiffness(:i, i))
      end do
      known = number
      call solve_small(small_mass(:number, :number), small_stiffness(:number, :number), modes, &
        found%lambda, small, error)
      if (allocated(error)) return
      found%vector = matmul(basis(:, :number), small)
      found%mass_times = matmul(mass_times(:, :number), small)
      found%stiffness_times = matmul(stiffness_times(:, :number), small)
      if (number + modes > size(basis, 2)) then
        number = 0
        known = 0
        do i = 1, modes
          call extend(pencil, found%vector(:, i), basis, mass_times, stiffness_times, number, &
            found%products)
        end do
      end if
      do i = 1, modes
        residual = found%stiffness_times(:, i) - found%lambda(i)*found%mass_times(:, i)
        squared(i) = long_dot(residual, residual)/long_dot(found%vector(:, i), found%vector(:, i))
        converged(i) = squared(i) <= merge(1.0e-24_wp, 1.0e-17_wp*fineness*gap(found%lambda, i), &
          accurate_vectors)
        if (.not. converged(i)) call extend(pencil, residual, basis, mass_times, stiffness_times, &
          number, found%products)
      end do
      if (all(converged)) exit
    end do
    if (.not. all(converged)) then
      call set_error(error, error_of_numerics, "no convergence in "//to_string(most_steps)// &
        " steps on the long mesh")
      return
    end if
    found%error = [(squared(i)*long_dot(found%vector(:, i), found%vector(:, i))/(gap(found%lambda, &
      i)*abs(found%lambda(i))) + &
      rounding*epsilon(1.0_wp)*(1.0_wp + long_dot(found%vector(:, i), &
      found%vector(:, i))/abs(found%lambda(i))), i=1, modes)]
  end subroutine find_subspace_modes

  !> Adds a direction to the basis, made perpendicular to it and of unit length, and its products
  !! with both matrices.
  subroutine extend(pencil, direction, basis, mass_times, stiffness_times, number, products)
    class(symmetric_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: direction(:)
    real(wp), intent(inout) :: basis(:, :), mass_times(:, :), stiffness_times(:, :)
    integer, intent(inout) :: number, products

    real(wp) :: unit(size(direction)), length
    integer :: j, pass

    ! A full basis, or one that spans all unknowns, takes no more.
    if (number == min(size(basis, 2), size(direction))) return
    unit = direction/norm2(direction)
    do pass = 1, 3
      do j = 1, number
        unit = unit - dot_product(basis(:, j), unit)*basis(:, j)
      end do
      length = norm2(unit)
      ! Only rounding is left: the direction is in the basis already.
      if (length < 1.0e-3_wp*epsilon(1.0_wp)) return
      unit = unit/length
      if (length > 0.5_wp) exit
    end do
    number = number + 1
    products = products + 1
    basis(:, number) = unit
    call pencil%multiply(unit, mass_times(:, number), stiffness_times(:, number))
  end subroutine extend

  !> What a new vector of the basis adds to the two matrices in it: their last column.
  pure subroutine project(new, mass_times, stiffness_times, mass, stiffness)
    real(wp), intent(in) :: new(:) !! the last vector
    real(wp), intent(in) :: mass_times(:, :), stiffness_times(:, :) !! (unknowns, all up to it)
    real(wp), intent(out) :: mass(:), stiffness(:)

    integer :: i

    do i = 1, size(mass_times, 2)
      mass(i) = long_dot(new, mass_times(:, i))
      stiffness(i) = long_dot(new, stiffness_times(:, i))
    end do
  end subroutine project

  !> Rayleigh–Ritz: the modes in the subspace of the basis.
  subroutine solve_small(mass, stiffness, modes, lambda, small, error)
    real(wp), intent(in) :: mass(:, :), stiffness(:, :) !! in the basis; the upper triangles are
                                                        !! read
    integer, intent(in) :: modes
    real(wp), allocatable, intent(out) :: lambda(:)
    real(wp), allocatable, intent(out) :: small(:, :) !! (basis vectors, modes)
    type(error_t), allocatable, intent(out) :: error

    type(band_matrix_t) :: m, k
    real(wp) :: shift, inverse(modes)
    integer :: i, j, factorizations

    m = new_band_matrix(size(mass, 2), size(mass, 2) - 1)
    k = m
    do j = 1, size(mass, 2)
      do i = j, size(mass, 2)
        m%entry(1 + i - j, j) = mass(j, i)
        k%entry(1 + i - j, j) = stiffness(j, i)
      end do
    end do
    factorizations = 0
    call find_definite_shift(k, m, shift, factorizations)
    call solve_dense(shifted(k, m, shift), m, modes, .true., inverse, small, error)
    if (allocated(error)) return
    lambda = 1.0_wp/inverse - shift
    do i = 1, modes
      ! Scaled to unit mass.
      small(:, i) = small(:, i)/sqrt(dot_product(small(:, i), band_times_vector(m, small(:, i))))
    end do
  end subroutine solve_small

  !> Relative distance of an eigenvalue to the nearest other one, computed or not; never 0.
  pure function gap(lambda, i)
    real(wp), intent(in) :: lambda(:)
    integer, intent(in) :: i
    real(wp) :: gap

    gap = relative_gap(lambda, i)
    ! Beyond the last one there may be another, which has not been computed.
    if (i == size(lambda)) gap = min(gap, unknown_gap)
    gap = max(gap, epsilon(gap))
  end function gap

end module subspace_eigensolver
