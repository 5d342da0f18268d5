!> Counts the eigenvalues below a number without computing any.
module sturm_count
  use band_matrix, only: band_matrix_t, half_bandwidth_of, order_of
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: count_below, shifted

contains

  !> Number of eigenvalues of `K x = λ M x` below `shift`.
  !!
  !! By Sylvester's law of inertia this is the number of negative pivots of `K − shift M = L D Lᵀ`.
  !! The factorization does not pivot, to keep the band. Only a pivot near zero could cause an
  !! element growth that spoils the count; such a pivot is moved away from zero.
  pure function count_below(stiffness, mass, shift) result(number)
    type(band_matrix_t), intent(in) :: stiffness !! K
    type(band_matrix_t), intent(in) :: mass      !! M, of the same shape; positive definite except
                                                 !! in directions that K leaves stiff
    real(wp), intent(in) :: shift                !! may be negative
    integer :: number

    type(band_matrix_t) :: a
    real(wp) :: pivot, least, factor
    integer :: j, i, last

    a = shifted(stiffness, mass, -shift)
    number = 0
    do j = 1, order_of(a)
      least = tiny(1.0_wp) + epsilon(1.0_wp)*(abs(stiffness%entry(1, j)) + &
        abs(shift)*mass%entry(1, j))
      pivot = a%entry(1, j)
      if (abs(pivot) < least) pivot = -least
      if (pivot < 0.0_wp) number = number + 1
      last = min(order_of(a), j + half_bandwidth_of(a))
      do i = j + 1, last
        factor = a%entry(1 + i - j, j)/pivot
        a%entry(1:1 + last - i, i) = a%entry(1:1 + last - i, i) - &
          factor*a%entry(1 + i - j:1 + last - j, j)
      end do
    end do
  end function count_below

  !> `K + factor M`
  pure function shifted(stiffness, mass, factor) result(sum)
    type(band_matrix_t), intent(in) :: stiffness !! K
    type(band_matrix_t), intent(in) :: mass      !! M, of the same shape
    real(wp), intent(in) :: factor               !! of M
    type(band_matrix_t) :: sum

    sum%entry = stiffness%entry + factor*mass%entry
  end function shifted

end module sturm_count
