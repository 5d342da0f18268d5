!> Proofs that no mode is missing: by sums of squares and, where these are too coarse, by a Cholesky
!! factorization.
module completeness_proof
  use band_matrix, only: band_matrix_t, full_band
  use bordered_matrix, only: all_unknowns, bordered_times_vector
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

  !> The lower triangle of `A − B D⁻¹ Bᵀ`, a row for each unknown outside the tail.
  type :: condensed_t
    real(wp), allocatable :: matrix(:, :)
    real(wp), allocatable :: terms(:)     !! (rows) magnitudes of all terms of a diagonal entry:
                                          !! rounding is proportional to them, in an entry (i, j)
                                          !! to the root of those of i times those of j; where G
                                          !! has no such bound, to its rows
    integer, allocatable :: unknown(:)    !! (rows) ascending
    integer, allocatable :: row(:)        !! (unknowns) 0: in the tail
  contains
    procedure :: add_unknown
    procedure :: add_column
    procedure :: subtract_product
    procedure :: add_modes
    procedure :: subtract_rounding
  end type condensed_t

contains

  !> Upper end of the interval in which modes are counted.
  pure function count_limit(lambda) result(limit)
    real(wp), intent(in) :: lambda !! eigenvalue of the last mode [1/s²]
    real(wp) :: limit              !! [1/s²]

    limit = lambda + count_margin*abs(lambda)
  end function count_limit

  !> Frobenius norm of `P E P`, where `E = μM − G` and P projects on the complement of the given
  !! directions. It proves nothing where there are free motions, for which K is not near I.
  !!
  !! `‖P E P‖² = ‖E‖² − 2 ‖E Q‖² + ‖Qᵀ E Q‖²` for an orthonormal basis Q of these directions.
  pure function rest_norm(pencil, limit, directions) result(norm)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: limit                 !! μ [1/s²]
    real(wp), intent(in) :: directions(:, :)      !! (unknowns, directions) linearly independent
    real(wp) :: norm                              !! huge where rounding leaves no digit of it

    real(wp) :: q(size(directions, 1), size(directions, 2)), e_times_q(size(directions, 1), &
      size(directions, 2))
    real(wp) :: product(size(directions, 1)), square
    integer :: i

    norm = huge(norm)
    square = squared_norm(pencil, limit)
    if (loss*square >= most_loss) return
    do i = 1, size(q, 2)
      q(:, i) = perpendicular(directions(:, i), q(:, :i - 1))
      call bordered_times_vector(pencil%layout, pencil%mass, q(:, i), product)
      e_times_q(:, i) = limit*product
      if (pencil%loaded) then
        call bordered_times_vector(pencil%layout, pencil%geometric, q(:, i), product)
        e_times_q(:, i) = e_times_q(:, i) - product
      end if
    end do
    norm = projected_norm(square, q, e_times_q)
  end function rest_norm

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
  !! are too coarse under heavy loads and for many modes.
  !!
  !! With s = |μ|, `K − μM + Σ (μ + s − λ_i) w_i w_iᵀ` differs from `K − μM` by at most as many
  !! positive terms as modes are given, whatever the w_i. If it is positive definite, `K − μM` has
  !! no more negative eigenvalues than there are terms, however inaccurate λ_i and y_i are. It is
  !! proven to be so if its Cholesky factorization succeeds after a bound of the rounding has been
  !! subtracted from the diagonal, entry by entry (Demmel 1989; Rump 2006).
  !!
  !! Only the lower own modes of every link need to be factored. On the higher ones, the tail, the
  !! diagonal of `K − μM` dominates: by Gershgorin's circles the block of the tail is at least a
  !! diagonal matrix D. With B, which couples the tail to the other unknowns, and their block A,
  !! `A − B D⁻¹ Bᵀ > 0` proves that the whole matrix is positive definite. w_i are the entries of
  !! M y_i outside the tail. Where this is too coarse, the whole matrix is factored.
  subroutine is_complete(pencil, limit, lambda, mass_times, proven)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: limit                 !! μ [1/s²]
    real(wp), intent(in) :: lambda(:)             !! (modes) [1/s²]
    real(wp), intent(in) :: mass_times(:, :)      !! (unknowns, modes) M y
    logical, intent(out) :: proven                !! .false.: nothing is proven

    real(wp) :: dominance(pencil%layout%unknowns)

    call find_tail(pencil, limit, dominance)
    call factor_without_tail(pencil, limit, lambda, mass_times, dominance, proven)
    if (proven .or. all(dominance <= 0.0_wp)) return
    dominance = 0.0_wp
    call factor_without_tail(pencil, limit, lambda, mass_times, dominance, proven)
  end subroutine is_complete

  !> The unknowns on which the diagonal of `K − μM` dominates: as many of the last of each block as
  !! possible, and single ones. `dominance` is what Gershgorin's circles leave of the diagonal, less
  !! rounding; zero outside the tail.
  pure subroutine find_tail(pencil, limit, dominance)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: limit
    real(wp), intent(out) :: dominance(:) !! (unknowns)

    !> Share of the unit diagonal that must be left.
    real(wp), parameter :: least = 0.5_wp
    real(wp) :: left(maxval(pencil%layout%size)), single
    real(wp), dimension(maxval(pencil%layout%size)) :: others, with_this
    integer :: b, i, k, m, first

    dominance = 0.0_wp
    associate (layout => pencil%layout)
      do b = 1, size(layout%size)
        m = layout%size(b)
        first = layout%first(b) - 1
        others = 0.0_wp
        do k = m, 1, -1
          left(k) = 1.0_wp - max(0.0_wp, limit*pencil%mass%diagonal(first + k))
          with_this = others
          if (pencil%loaded) then
            left(k) = left(k) + pencil%geometric%block(k, k, b)
            do i = k + 1, m
              with_this(i) = others(i) + abs(pencil%geometric%block(i, k, b))
              with_this(k) = with_this(k) + abs(pencil%geometric%block(i, k, b))
            end do
          end if
          if (any(left(k:m) - with_this(k:m) < least)) exit
          others = with_this
        end do
        do i = k + 1, m
          dominance(first + i) = left(i) - others(i) - epsilon(1.0_wp)*(m + 4)*(2.0_wp + &
            abs(left(i)) + others(i))
        end do
      end do
      do k = layout%border + sum(layout%size) + 1, layout%unknowns
        single = 1.0_wp - max(0.0_wp, limit*pencil%mass%diagonal(k))
        if (single >= least) dominance(k) = single - 4.0_wp*epsilon(1.0_wp)
      end do
    end associate
  end subroutine find_tail

  !> The factorization of `A − B D⁻¹ Bᵀ`, with the terms of the modes added.
  pure subroutine factor_without_tail(pencil, limit, lambda, mass_times, dominance, proven)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: limit
    real(wp), intent(in) :: lambda(:)
    real(wp), intent(in) :: mass_times(:, :)
    real(wp), intent(in) :: dominance(:) !! (unknowns) D in the tail, zero outside it
    logical, intent(out) :: proven

    type(condensed_t) :: condensed
    type(band_matrix_t) :: band
    type(error_t), allocatable :: error
    integer :: b, k, kept, first

    associate (layout => pencil%layout)
      condensed = new_condensed(pencil, limit, dominance)
      do b = 1, size(layout%size)
        first = layout%first(b) - 1
        kept = count(dominance(first + 1:first + layout%size(b)) <= 0.0_wp)
        do k = 1, layout%size(b)
          call condensed%add_unknown(pencil, limit, dominance(first + k), first + k, kept, b)
        end do
      end do
      do k = layout%border + sum(layout%size) + 1, layout%unknowns
        call condensed%add_unknown(pencil, limit, dominance(k), k, 0, 0)
      end do
      call condensed%add_modes(limit, lambda, mass_times)
      call condensed%subtract_rounding(layout%unknowns + 2 + 8*size(lambda))
    end associate
    band = full_band(condensed%matrix)
    call factor_band(band, error)
    proven = .not. allocated(error)
  end subroutine factor_without_tail

  !> The border of `K − μM`; all other rows are zero.
  pure function new_condensed(pencil, limit, dominance) result(condensed)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: limit
    real(wp), intent(in) :: dominance(:) !! (unknowns) zero outside the tail
    type(condensed_t) :: condensed

    integer :: i, k, n

    associate (layout => pencil%layout, border => pencil%layout%border)
      condensed%unknown = pack(all_unknowns(layout), dominance <= 0.0_wp)
      n = size(condensed%unknown)
      allocate (condensed%row(layout%unknowns), condensed%matrix(n, n), condensed%terms(n))
      condensed%row = 0
      condensed%row(condensed%unknown) = [(i, i=1, n)]
      condensed%matrix = 0.0_wp
      condensed%terms = 1.0_wp
      condensed%terms(border - layout%free + 1:border) = 0.0_wp
      do k = 1, border
        condensed%matrix(:border, k) = -limit*pencil%mass%border(:, k)
        condensed%terms(k) = condensed%terms(k) + abs(limit*pencil%mass%border(k, k))
        if (pencil%loaded) then
          associate (geometric => pencil%geometric)
            condensed%matrix(:border, k) = condensed%matrix(:border, k) + geometric%border(:, k)
            condensed%terms(k) = condensed%terms(k) + sum(abs(geometric%border(:, k))) + &
              sum(abs(geometric%coupling(k, border + 1:)))
          end associate
        end if
        if (k <= border - layout%free) condensed%matrix(k, k) = condensed%matrix(k, k) + 1.0_wp
      end do
    end associate
  end function new_condensed

  !> Adds an unknown beyond the border: its column, or in the tail its term of `B D⁻¹ Bᵀ`.
  pure subroutine add_unknown(self, pencil, limit, dominance, unknown, kept, block)
    class(condensed_t), intent(inout) :: self
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: limit
    real(wp), intent(in) :: dominance !! its entry of D; zero outside the tail
    integer, intent(in) :: unknown
    integer, intent(in) :: kept       !! unknowns of its block outside the tail
    integer, intent(in) :: block      !! 0: a single unknown

    real(wp) :: coupling(pencil%layout%border + kept)
    integer :: rows(pencil%layout%border + kept)
    integer :: i, border, first

    border = pencil%layout%border
    coupling(:border) = -limit*pencil%mass%coupling(:, unknown)
    coupling(border + 1:) = 0.0_wp
    rows(:border) = [(i, i=1, border)]
    if (pencil%loaded) coupling(:border) = coupling(:border) + &
      pencil%geometric%coupling(:, unknown)
    if (block > 0) then
      first = pencil%layout%first(block) - 1
      rows(border + 1:) = self%row(first + 1:first + kept)
      if (pencil%loaded) coupling(border + 1:) = pencil%geometric%block(:kept, unknown - first, &
        block)
    end if
    if (self%row(unknown) > 0) then
      call self%add_column(pencil, limit, unknown, rows, coupling)
    else
      call self%subtract_product(coupling, rows, dominance)
    end if
  end subroutine add_unknown

  !> Adds the column of an unknown outside the tail.
  pure subroutine add_column(self, pencil, limit, unknown, rows, coupling)
    class(condensed_t), intent(inout) :: self
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: limit
    integer, intent(in) :: unknown
    integer, intent(in) :: rows(:)      !! of the border, then of its block
    real(wp), intent(in) :: coupling(:) !! (rows) entries

    real(wp) :: diagonal
    integer :: at, border

    at = self%row(unknown)
    border = pencil%layout%border
    diagonal = -limit*pencil%mass%diagonal(unknown)
    self%matrix(at, :border) = coupling(:border)
    self%terms(at) = self%terms(at) + abs(diagonal)
    if (pencil%loaded) self%terms(at) = self%terms(at) + &
      sum(abs(pencil%geometric%coupling(:, unknown))) + sum(abs(coupling(border + 1:)))
    self%matrix(rows(border + 1:), at) = coupling(border + 1:)
    self%matrix(at, at) = self%matrix(at, at) + 1.0_wp + diagonal
  end subroutine add_column

  !> Subtracts `b bᵀ/d` of an unknown in the tail.
  pure subroutine subtract_product(self, coupling, rows, dominance)
    class(condensed_t), intent(inout) :: self
    real(wp), intent(in) :: coupling(:) !! (rows) b
    integer, intent(in) :: rows(:)      !! ascending
    real(wp), intent(in) :: dominance   !! d

    integer :: i, j

    do j = 1, size(coupling)
      self%terms(rows(j)) = self%terms(rows(j)) + coupling(j)**2/dominance
      do i = j, size(coupling)
        self%matrix(rows(i), rows(j)) = self%matrix(rows(i), rows(j)) - coupling(i)*coupling(j)/ &
          dominance
      end do
    end do
  end subroutine subtract_product

  !> Adds `(μ + s − λ_i) w_i w_iᵀ` of all modes.
  pure subroutine add_modes(self, limit, lambda, mass_times)
    class(condensed_t), intent(inout) :: self
    real(wp), intent(in) :: limit
    real(wp), intent(in) :: lambda(:)        !! (modes)
    real(wp), intent(in) :: mass_times(:, :) !! (unknowns, modes)

    real(wp) :: column(size(self%unknown)), lift
    integer :: i, j

    do i = 1, size(lambda)
      lift = max(0.0_wp, limit + abs(limit) - lambda(i))
      column = mass_times(self%unknown, i)
      self%terms = self%terms + lift*column**2
      do j = 1, size(column)
        self%matrix(j:, j) = self%matrix(j:, j) + lift*column(j)*column(j:)
      end do
    end do
  end subroutine add_modes

  !> Subtracts a bound of the rounding from the diagonal.
  !!
  !! Rounding of the sums and, for the factorization, (n + 2) ε/2 of the terms; n times, for a
  !! matrix of n rows with entries up to d_i d_j is at most n times the diagonal of d_i².
  pure subroutine subtract_rounding(self, sums)
    class(condensed_t), intent(inout) :: self
    integer, intent(in) :: sums !! of so many terms an entry is made, at most

    integer :: i, n

    n = size(self%terms)
    do i = 1, n
      self%matrix(i, i) = self%matrix(i, i) - n*epsilon(1.0_wp)*sums*self%terms(i)
    end do
  end subroutine subtract_rounding

end module completeness_proof
