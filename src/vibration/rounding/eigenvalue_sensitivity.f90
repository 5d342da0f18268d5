! src/vibration/rounding/ - what rounding does to the frequencies at a position.
! In: modes and matrices of a position. Out: relative errors of eigenvalues, for `solve_position` in
! `src/vibration/position_solver.f90`. Begin with `pose_error` in `pose_rounding.f90` (the position
! is rounded), `find_matrix_errors` in `matrix_rounding.f90` (M and K_G are).
! Not here: errors of polynomial orders (`src/vibration/models`), of iterations (`src/eigen`), of
! nodal matrices (`src/beam/round_off.f90`).

!> Sensitivity of eigenvalues to changes of the matrices at a position.
!!
!! The eigenvalue of a mode of `(K + K_G) y = λ M y` with yᵀMy = 1 changes, to first order, by
!! `yᵀ(ΔK_G − λ ΔM) y`. This is found as the difference of the works `yᵀ(K + K_G − λM) y` in two
!! sets of matrices, so that the original matrices need not be kept.
module eigenvalue_sensitivity
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_matrix, only: bordered_times_vector
  use bordered_pencil, only: bordered_pencil_t, elastic_square
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: residual_work

contains

  !> `yᵀ(K + K_G − λM) y` of the lowest modes [1/s²]. In the matrices of the modes themselves it is
  !! zero except for rounding.
  pure function residual_work(pencil, found, modes) result(work)
    type(bordered_pencil_t), intent(in) :: pencil !! matrices, possibly other than those of the
                                                  !! modes
    type(bordered_modes_t), intent(in) :: found   !! modes with yᵀMy = 1 in their own matrices
    integer, intent(in) :: modes                  !! number, lowest first
    real(wp) :: work(modes)

    real(wp) :: product(pencil%layout%unknowns)
    integer :: i

    do i = 1, modes
      associate (y => found%vector(:, i))
        call bordered_times_vector(pencil%layout, pencil%mass, y, product)
        work(i) = elastic_square(pencil%layout, y) - found%lambda(i)*dot_product(y, product)
        if (.not. pencil%loaded) cycle
        call bordered_times_vector(pencil%layout, pencil%geometric, y, product)
        work(i) = work(i) + dot_product(y, product)
      end associate
    end do
  end function residual_work

end module eigenvalue_sensitivity
