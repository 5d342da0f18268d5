!> Free motions of a pencil: unknowns at the end of the border that deform nothing. Without loads
!! they are its modes of eigenvalue zero.
module free_motions
  use bordered_matrix, only: bordered_times_vector
  use bordered_pencil, only: bordered_pencil_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: balancing_factors, balanced_pencil, rest_modes, eigenvalue_scale

contains

  !> Powers of two by which the free motions are to be multiplied, so that each has about the
  !! largest mass of the other unknowns. Their units are arbitrary; powers of two round nothing.
  pure function balancing_factors(pencil) result(factor)
    type(bordered_pencil_t), intent(in) :: pencil !! M
    real(wp) :: factor(pencil%layout%free)

    integer :: i, stiff

    associate (n => pencil%layout%border, mass => pencil%mass)
      stiff = n - pencil%layout%free
      factor = largest_mass(pencil)
      do i = 1, size(factor)
        associate (own => mass%border(stiff + i, stiff + i))
          if (own > 0.0_wp .and. factor(i) > 0.0_wp) then
            factor(i) = 2.0_wp**((exponent(factor(i)) - exponent(own))/2)
          else
            factor(i) = 1.0_wp
          end if
        end associate
      end do
    end associate
  end function balancing_factors

  !> Largest diagonal entry of M of the unknowns that are no free motions.
  pure function largest_mass(pencil) result(largest)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp) :: largest

    integer :: i

    largest = max(0.0_wp, maxval(pencil%mass%diagonal(pencil%layout%border + 1:)))
    do i = 1, pencil%layout%border - pencil%layout%free
      largest = max(largest, pencil%mass%border(i, i))
    end do
  end function largest_mass

  !> The pencil with its free motions multiplied by factors.
  pure function balanced_pencil(pencil, factor) result(balanced)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: factor(:)             !! (free motions)
    type(bordered_pencil_t) :: balanced

    integer :: i, k

    balanced = pencil
    do i = 1, size(factor)
      k = pencil%layout%border - size(factor) + i
      call scale_unknown(balanced%mass%border, balanced%mass%coupling, k, factor(i))
      if (pencil%loaded) call scale_unknown(balanced%geometric%border, &
        balanced%geometric%coupling, k, factor(i))
    end do
  end function balanced_pencil

  !> Multiplies row and column of an unknown of the border.
  pure subroutine scale_unknown(border, coupling, k, factor)
    real(wp), intent(inout) :: border(:, :), coupling(:, :)
    integer, intent(in) :: k !! its number
    real(wp), intent(in) :: factor

    border(:, k) = factor*border(:, k)
    border(k, :) = factor*border(k, :)
    coupling(k, size(border, 2) + 1:) = factor*coupling(k, size(border, 2) + 1:)
  end subroutine scale_unknown

  !> The modes of eigenvalue zero of a pencil without loads: free motions, orthonormal in M.
  pure subroutine rest_modes(pencil, vector, mass_times)
    type(bordered_pencil_t), intent(in) :: pencil !! M
    real(wp), intent(out) :: vector(:, :)         !! (unknowns, free motions) with yᵀMy = 1
    real(wp), intent(out) :: mass_times(:, :)     !! (unknowns, free motions) M y

    real(wp) :: square
    integer :: i, j, pass

    vector = 0.0_wp
    do i = 1, size(vector, 2)
      associate (y => vector(:, i))
        y(pencil%layout%border - size(vector, 2) + i) = 1.0_wp
        ! Twice: the second pass restores the orthogonality that the first loses to rounding.
        do pass = 1, 2
          do j = 1, i - 1
            y = y - dot_product(mass_times(:, j), y)*vector(:, j)
          end do
          call bordered_times_vector(pencil%layout, pencil%mass, y, mass_times(:, i))
          square = dot_product(y, mass_times(:, i))
          ! Not positive where rounding leaves nothing of M: no proof holds then.
          if (.not. square > 0.0_wp) exit
          y = y/sqrt(square)
          mass_times(:, i) = mass_times(:, i)/sqrt(square)
        end do
      end associate
    end do
  end subroutine rest_modes

  !> A size of eigenvalues beside which those of free motions may vanish: the reciprocal of the
  !! largest entry on the diagonal of M. The lowest eigenvalue of what deforms is hardly less.
  pure function eigenvalue_scale(pencil) result(scale)
    type(bordered_pencil_t), intent(in) :: pencil !! M, balanced
    real(wp) :: scale                             !! [1/s²]

    real(wp) :: largest
    integer :: i

    largest = largest_mass(pencil)
    do i = pencil%layout%border - pencil%layout%free + 1, pencil%layout%border
      largest = max(largest, pencil%mass%border(i, i))
    end do
    scale = 1.0_wp/max(largest, tiny(largest))
  end function eigenvalue_scale

end module free_motions
