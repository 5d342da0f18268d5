!> Proofs that no mode is missing: by sums of squares and, where these are too coarse, by a Cholesky
!! factorization.
module completeness_proof
  use band_matrix, only: band_matrix_t, full_band
  use bordered_matrix, only: all_unknowns, bordered_times_vector, dense_form
  use bordered_pencil, only: bordered_pencil_t
  use cholesky_factor, only: factor_band
  use errors, only: error_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: count_limit, count_margin, rest_norm, squared_norm, perpendicular, projected_norm, &
    is_complete

  !> Relative distance from the last mode to the upper end of the interval in which modes are
  !! counted.
  real(wp), parameter :: count_margin = 1.0e-8_wp

  !> Rounding error of a difference of sums of squares, relative to the largest sum; and the largest
  !! error accepted.
  real(wp), parameter :: loss = 100.0_wp*epsilon(1.0_wp), most_loss = 1.0e-3_wp

contains

  !> Upper end of the interval in which modes are counted.
  pure function count_limit(lambda) result(limit)
    real(wp), intent(in) :: lambda !! eigenvalue of the last mode [1/s²]
    real(wp) :: limit              !! [1/s²]

    limit = lambda + count_margin*abs(lambda)
  end function count_limit

  !> Frobenius norm of `P E P`, where `E = μM − G` and P projects on the complement of the given
  !! directions.
  !!
  !! `‖P E P‖² = ‖E‖² − 2 ‖E Q‖² + ‖Qᵀ E Q‖²` for an orthonormal basis Q of these directions.
  pure function rest_norm(pencil, limit, directions) result(norm)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: limit                 !! μ [1/s²]
    real(wp), intent(in) :: directions(:, :)      !! (unknowns, directions) linearly independent
    real(wp) :: norm

    real(wp) :: q(size(directions, 1), size(directions, 2)), e_times_q(size(directions, 1), &
      size(directions, 2))
    real(wp) :: product(size(directions, 1)), square
    integer :: i

    do i = 1, size(q, 2)
      q(:, i) = perpendicular(directions(:, i), q(:, :i - 1))
      call bordered_times_vector(pencil%layout, pencil%mass, q(:, i), product)
      e_times_q(:, i) = limit*product
      if (pencil%loaded) then
        call bordered_times_vector(pencil%layout, pencil%geometric, q(:, i), product)
        e_times_q(:, i) = e_times_q(:, i) - product
      end if
    end do
    square = squared_norm(pencil, limit)
    if (loss*square < most_loss) then
      norm = projected_norm(square, q, e_times_q)
    else
      ! With many modes ‖E‖² is so large that the difference has no digits left: the projected
      ! matrix itself is computed.
      norm = worked_out_norm(pencil, limit, q)
    end if
  end function rest_norm

  !> The same norm, computed column by column of `P E P`.
  pure function worked_out_norm(pencil, limit, q) result(norm)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: limit
    real(wp), intent(in) :: q(:, :) !! orthonormal columns
    real(wp) :: norm

    real(wp) :: column(pencil%layout%unknowns), product(pencil%layout%unknowns), &
      turned(pencil%layout%unknowns), square
    integer :: i

    square = 0.0_wp
    do i = 1, pencil%layout%unknowns
      column = 0.0_wp
      column(i) = 1.0_wp
      column = column - matmul(q, q(i, :))
      call bordered_times_vector(pencil%layout, pencil%mass, column, product)
      if (pencil%loaded) then
        call bordered_times_vector(pencil%layout, pencil%geometric, column, turned)
        product = limit*product - turned
      else
        product = limit*product
      end if
      product = product - matmul(q, matmul(product, q))
      square = square + dot_product(product, product)
    end do
    norm = sqrt(square)
  end function worked_out_norm

  !> Unit vector along the part of a direction that is perpendicular to others.
  pure function perpendicular(direction, others) result(unit)
    real(wp), intent(in) :: direction(:) !! (unknowns) independent of the others
    real(wp), intent(in) :: others(:, :) !! (unknowns, others) orthonormal columns
    real(wp) :: unit(size(direction))

    integer :: j, pass

    unit = direction
    ! Twice: the second pass restores the orthogonality that the first loses to rounding.
    do pass = 1, 2
      do j = 1, size(others, 2)
        unit = unit - dot_product(others(:, j), unit)*others(:, j)
      end do
    end do
    unit = unit/sqrt(dot_product(unit, unit))
  end function perpendicular

  !> `√(‖E‖² − 2 ‖E Q‖² + ‖Qᵀ E Q‖²)`, rounded up.
  pure function projected_norm(square, q, e_times_q) result(norm)
    real(wp), intent(in) :: square          !! ‖E‖²
    real(wp), intent(in) :: q(:, :)         !! (unknowns, directions) orthonormal columns
    real(wp), intent(in) :: e_times_q(:, :) !! (unknowns, directions) E Q
    real(wp) :: norm

    real(wp) :: rest
    integer :: i, j

    rest = square
    do i = 1, size(q, 2)
      rest = rest - 2.0_wp*dot_product(e_times_q(:, i), e_times_q(:, i)) + dot_product(q(:, i), &
        e_times_q(:, i))**2
      do j = 1, i - 1
        rest = rest + 2.0_wp*dot_product(q(:, j), e_times_q(:, i))**2
      end do
    end do
    ! The possible loss in the subtraction is added.
    norm = sqrt(max(rest, 0.0_wp) + loss*square)
  end function projected_norm

  !> `‖μM − G‖²`, Frobenius norm.
  pure function squared_norm(pencil, limit) result(square)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: limit                 !! μ [1/s²]
    real(wp) :: square

    integer :: b, i, k, first

    associate (n => pencil%layout%border, layout => pencil%layout, mass => pencil%mass, &
        geometric => pencil%geometric)
      if (.not. pencil%loaded) then
        square = limit**2*(sum(mass%border**2) + 2.0_wp*sum(mass%coupling(:, n + 1:)**2) + &
          sum(mass%diagonal(n + 1:)**2))
        return
      end if
      square = sum((limit*mass%border - geometric%border)**2) + &
        sum((limit*mass%diagonal(n + 1:))**2)
      do k = n + 1, layout%unknowns
        do i = 1, n
          square = square + 2.0_wp*(limit*mass%coupling(i, k) - geometric%coupling(i, k))**2
        end do
      end do
      do b = 1, size(layout%size)
        first = layout%first(b) - 1
        do k = 1, layout%size(b)
          square = square - 2.0_wp*limit*mass%diagonal(first + k)*geometric%block(k, k, b)
          do i = 1, layout%size(b)
            square = square + geometric%block(i, k, b)**2
          end do
        end do
      end do
    end associate
  end function squared_norm

  !> Whether no modes other than those given lie below a limit. Sharper than sums of squares, which
  !! are too coarse under heavy loads.
  !!
  !! With s = |μ|, `K − μM + Σ (μ + s − λ_i)(M y_i)(M y_i)ᵀ` differs from `K − μM` by at most as
  !! many positive terms as modes are given. If it is positive definite, `K − μM` has no more
  !! negative eigenvalues than there are terms, however inaccurate λ_i and y_i are. It is proven to
  !! be so if its Cholesky factorization succeeds after a bound of the rounding has been subtracted
  !! from the diagonal (Demmel 1989; Rump 2006).
  subroutine is_complete(pencil, limit, lambda, mass_times, proven)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: limit                 !! μ [1/s²]
    real(wp), intent(in) :: lambda(:)             !! (modes) [1/s²]
    real(wp), intent(in) :: mass_times(:, :)      !! (unknowns, modes) M y
    logical, intent(out) :: proven                !! .false.: nothing is proven

    real(wp), allocatable :: dense(:, :), geometric_form(:, :)
    type(band_matrix_t) :: band
    type(error_t), allocatable :: error
    real(wp) :: margin, lift
    integer :: i, j, n

    n = pencil%layout%unknowns
    dense = dense_form(pencil%layout, pencil%mass, all_unknowns(pencil%layout))
    ! Sum of the magnitudes of all terms of the diagonal: the rounding is proportional to it.
    margin = n
    do i = 1, n
      margin = margin + abs(limit)*dense(i, i)
    end do
    dense = -limit*dense
    if (pencil%loaded) then
      geometric_form = dense_form(pencil%layout, pencil%geometric, all_unknowns(pencil%layout))
      do i = 1, n
        margin = margin + abs(geometric_form(i, i))
      end do
      dense = dense + geometric_form
    end if
    do i = 1, n
      dense(i, i) = dense(i, i) + 1.0_wp
    end do
    do i = 1, size(lambda)
      lift = max(0.0_wp, limit + abs(limit) - lambda(i))
      margin = margin + lift*dot_product(mass_times(:, i), mass_times(:, i))
      do j = 1, n
        dense(:, j) = dense(:, j) + lift*mass_times(j, i)*mass_times(:, i)
      end do
    end do
    ! Rounding of the sums and, for the factorization, (n + 2) ε/2 times the trace.
    margin = margin*epsilon(margin)*(n + 2 + 8*size(lambda))
    do i = 1, n
      dense(i, i) = dense(i, i) - margin
    end do
    band = full_band(dense)
    call factor_band(band, error)
    proven = .not. allocated(error)
  end subroutine is_complete

end module completeness_proof
