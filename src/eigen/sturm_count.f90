!> How many eigenvalues lie below a number, without computing any.
module sturm_count
  use band_matrix, only: band_matrix_t, half_bandwidth_of, order_of
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: count_below, shifted

contains

  !> Number of eigenvalues of `K x = λ M x` below `shift`.
  !!
  !! By Sylvester's law of inertia it is the number of negative pivots of `K − shift M = L D Lᵀ`.
  !! The factorization does not pivot: that keeps the band, and an element growth that would spoil
  !! the count needs a pivot near zero, which is moved away from it.
  pure function count_below(stiffness, mass, shift) result(number)
    type(band_matrix_t), intent(in) :: stiffness
    type(band_matrix_t), intent(in) :: mass !! positive definite, of the same shape
    real(wp), intent(in) :: shift
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
    type(band_matrix_t), intent(in) :: stiffness, mass
    real(wp), intent(in) :: factor
    type(band_matrix_t) :: sum

    sum%entry = stiffness%entry + factor*mass%entry
  end function shifted

end module sturm_count
