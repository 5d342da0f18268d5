!> Natural frequencies of a linkage frozen at the positions of a turn, under the axial forces of its
!! motion, from the slow coordinates and what follows them.
module frozen_modes
  use band_matrix, only: full_band
  use dense_eigensolver, only: solve_dense
  use errors, only: error_t
  use kinds, only: wp
  use slow_bases, only: frozen_matrices, slow_basis_t
  implicit none (type, external)
  private

  public :: find_frozen_frequencies

contains

  !> Frequencies at every second sample of the coarse grid, in ascending order at each, and how fast
  !! the modes fade, `½ xᵀC x/xᵀM x`.
  !!
  !! Errors: the stiffness is not positive definite: a link buckles under the forces.
  subroutine find_frozen_frequencies(basis, speed, frequency, fading, error)
    type(slow_basis_t), intent(in) :: basis          !! with its followers
    real(wp), intent(in) :: speed                    !! ω2 [rad/s]
    real(wp), intent(out) :: frequency(:, :)         !! (modes, positions) [rad/s]: half as many as
                                                     !! samples
    real(wp), intent(out) :: fading(:, :)            !! (modes, positions) [1/s]
    type(error_t), allocatable, intent(out) :: error !! why there are none

    real(wp), dimension(basis%number, basis%number) :: mass, stiffness, damping
    real(wp) :: inverse(size(frequency, 1))
    real(wp), allocatable :: vectors(:, :)
    integer :: i, k

    do k = 1, size(frequency, 2)
      ! Of slow coordinates about as fast as those that follow them the followers take more
      ! stiffness than there is; the slowest of all are as good without them.
      do i = 1, 2
        call frozen_matrices(basis, speed, 2*k - 1, mass, stiffness, damping, alone=i == 2)
        call solve_dense(full_band(stiffness), full_band(mass), size(inverse), .true., inverse, &
          vectors, error)
        if (.not. allocated(error)) exit
      end do
      if (allocated(error)) return
      frequency(:, k) = 1.0_wp/sqrt(inverse)
      do i = 1, size(inverse)
        fading(i, k) = 0.5_wp*dot_product(vectors(:, i), matmul(damping, vectors(:, i)))/inverse(i)
      end do
    end do
  end subroutine find_frozen_frequencies

end module frozen_modes
