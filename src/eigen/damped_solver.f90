!> Solves `(s² M + s C + K) x = b` for a complex s, with dampers between unknowns of the border: the
!! step of every inverse iteration on a damped mode.
module damped_solver
  use bordered_matrix, only: bordered_times_vector
  use bordered_pencil, only: bordered_pencil_t, stiffness_times_vector
  use kinds, only: fineness, wp
  implicit none (type, external)
  private

  public :: damped_system_t, solve_damped, damping_times_vector, mass_times_complex, &
    stiffness_times_complex

  !> The matrices of an eigenproblem with dampers.
  type :: damped_system_t
    type(bordered_pencil_t) :: pencil        !! K and M
    real(wp), allocatable :: dampers(:, :)   !! (border, dampers) B, rows times √c, independent
                                             !! columns: `C = B Bᵀ` [√s]
  end type damped_system_t

contains

  !> Solves `(s² M + s C + K) x = b`: eliminates each block together with its border rows and the
  !! right-hand side, then the border.
  !!
  !! `L D Lᵀ` without pivoting, of a matrix that is symmetric and not Hermitian. No result depends
  !! on its accuracy: the callers measure the residual of the solution.
  !!
  !! The order of elimination is that of `bordered_solver`, written once more for complex numbers:
  !! the language has no procedures for both, and real equations, solved a thousand times as often,
  !! would take four times as long in complex numbers.
  pure subroutine solve_damped(pencil, dampers, s, right_side, solution)
    type(bordered_pencil_t), intent(in) :: pencil !! K and M
    real(wp), intent(in) :: dampers(:, :)         !! (border, dampers) rows times √c: C is their
                                                  !! product with their transpose [√s]
    complex(wp), intent(in) :: s                  !! [1/s]
    complex(wp), intent(in) :: right_side(:)      !! (unknowns) b
    complex(wp), intent(out) :: solution(:)       !! (unknowns) x

    complex(wp), allocatable :: panel(:, :, :)
    complex(wp) :: border(pencil%layout%border + 1, pencil%layout%border), square, pivot, factor
    real(wp) :: size_of(pencil%layout%border)
    integer :: b, i, j, k, first_single

    associate (n => pencil%layout%border, layout => pencil%layout, mass => pencil%mass, &
        geometric => pencil%geometric, loaded => pencil%loaded)
      square = s**2
      border(:n, :) = square*mass%border + s*matmul(dampers, transpose(dampers))
      if (loaded) border(:n, :) = border(:n, :) + geometric%border
      do i = 1, n - layout%free
        border(i, i) = border(i, i) + 1.0_wp
      end do
      border(n + 1, :) = right_side(:n)
      ! Near a root of free motions alone, all terms of their rows may be small.
      do i = 1, n
        size_of(i) = abs(square)*mass%border(i, i) + abs(s)*sum(dampers(i, :)**2)
        if (loaded) size_of(i) = size_of(i) + abs(geometric%border(i, i))
        if (i <= n - layout%free) size_of(i) = size_of(i) + 1.0_wp
      end do

      first_single = n + 1
      if (loaded) then
        allocate (panel(n + maxval(layout%size) + 1, maxval(layout%size), size(layout%size)))
        do b = 1, size(layout%size)
          call eliminate_block(pencil, square, right_side, b, panel(:, :, b), border)
        end do
        first_single = n + 1 + sum(layout%size)
      end if
      do k = first_single, layout%unknowns
        pivot = off_zero(1.0_wp + square*mass%diagonal(k), 1.0_wp)
        do j = 1, n
          factor = square*mass%coupling(j, k)/pivot
          do i = j, n
            border(i, j) = border(i, j) - square*mass%coupling(i, k)*factor
          end do
          border(n + 1, j) = border(n + 1, j) - factor*right_side(k)
        end do
      end do

      call eliminate(border, n, size_of)
      call substitute_back(border, n, solution(:n))
      if (loaded) then
        do b = 1, size(layout%size)
          associate (m => layout%size(b), first => layout%first(b))
            do k = 1, m
              panel(m + 1, k, b) = panel(m + n + 1, k, b) - sum(panel(m + 1:m + n, k, &
                b)*solution(:n))
            end do
            call substitute_back(panel(:m + 1, :m, b), m, solution(first:first + m - 1))
          end associate
        end do
      end if
      do k = first_single, layout%unknowns
        pivot = off_zero(1.0_wp + square*mass%diagonal(k), 1.0_wp)
        solution(k) = (right_side(k) - square*sum(mass%coupling(:, k)*solution(:n)))/pivot
      end do
    end associate
  end subroutine solve_damped

  !> Eliminates a block and subtracts its contribution from the border.
  pure subroutine eliminate_block(pencil, square, right_side, b, panel, border)
    type(bordered_pencil_t), intent(in) :: pencil !! with a G
    complex(wp), intent(in) :: square             !! s²
    complex(wp), intent(in) :: right_side(:)
    integer, intent(in) :: b                      !! number of the block
    complex(wp), intent(out) :: panel(:, :)       !! columns of the block; below it the border's
                                                  !! rows and the right-hand side
    complex(wp), intent(inout) :: border(:, :)

    complex(wp) :: factor
    integer :: i, j, k, m, n, first

    m = pencil%layout%size(b)
    n = pencil%layout%border
    first = pencil%layout%first(b) - 1
    do k = 1, m
      do j = k, m
        panel(j, k) = pencil%geometric%block(j, k, b)
      end do
      panel(k, k) = 1.0_wp + panel(k, k) + square*pencil%mass%diagonal(first + k)
      do i = 1, n
        panel(m + i, k) = pencil%geometric%coupling(i, first + k) + &
          square*pencil%mass%coupling(i, first + k)
      end do
      panel(m + n + 1, k) = right_side(first + k)
    end do
    call eliminate(panel(:m + n + 1, :m), m, [(1.0_wp, k=1, m)])
    do k = 1, m
      do j = 1, n
        factor = panel(m + j, k)/panel(k, k)
        do i = j, n + 1
          border(i, j) = border(i, j) - factor*panel(m + i, k)
        end do
      end do
    end do
  end subroutine eliminate_block

  !> `L D Lᵀ` of the first m rows; the rows below are updated with them. Column k then holds that of
  !! `L D`.
  pure subroutine eliminate(panel, m, size_of)
    complex(wp), intent(inout) :: panel(:, :)
    integer, intent(in) :: m
    real(wp), intent(in) :: size_of(:) !! (m) of the terms of the diagonal

    complex(wp) :: factor
    integer :: i, j, k

    do k = 1, m
      panel(k, k) = off_zero(panel(k, k), size_of(k))
      do j = k + 1, m
        factor = panel(j, k)/panel(k, k)
        do i = j, size(panel, 1)
          panel(i, j) = panel(i, j) - factor*panel(i, k)
        end do
      end do
    end do
  end subroutine eliminate

  !> A pivot, moved away from zero if it is near.
  elemental function off_zero(pivot, size_of) result(moved)
    complex(wp), intent(in) :: pivot
    real(wp), intent(in) :: size_of !! of its terms
    complex(wp) :: moved

    real(wp), parameter :: least_pivot = 1.0e-14_wp*fineness
    real(wp) :: least

    least = max(least_pivot*size_of, sqrt(tiny(least)))
    moved = pivot
    if (abs(moved%re) + abs(moved%im) < least) moved = least
  end function off_zero

  !> Solves with the result of `eliminate`; the right-hand side is the last row of the panel.
  pure subroutine substitute_back(panel, m, solution)
    complex(wp), intent(in) :: panel(:, :)
    integer, intent(in) :: m
    complex(wp), intent(out) :: solution(:)

    integer :: k, last

    last = size(panel, 1)
    do k = m, 1, -1
      solution(k) = (panel(last, k) - sum(panel(k + 1:m, k)*solution(k + 1:m)))/panel(k, k)
    end do
  end subroutine substitute_back

  !> `C y`
  pure function damping_times_vector(dampers, vector) result(product)
    real(wp), intent(in) :: dampers(:, :)  !! (border, dampers) rows times √c
    complex(wp), intent(in) :: vector(:)   !! (unknowns) y
    complex(wp) :: product(size(vector))   !! zero beyond the border

    integer :: n

    n = size(dampers, 1)
    product = 0.0_wp
    product(:n) = matmul(dampers, matmul(vector(:n), dampers))
  end function damping_times_vector

  !> `M y`
  pure function mass_times_complex(pencil, vector) result(product)
    type(bordered_pencil_t), intent(in) :: pencil !! M
    complex(wp), intent(in) :: vector(:)          !! (unknowns) y
    complex(wp) :: product(size(vector))

    real(wp), dimension(size(vector)) :: real_part, imaginary_part

    call bordered_times_vector(pencil%layout, pencil%mass, real(vector, wp), real_part)
    call bordered_times_vector(pencil%layout, pencil%mass, aimag(vector), imaginary_part)
    product = cmplx(real_part, imaginary_part, wp)
  end function mass_times_complex

  !> `K y`
  pure function stiffness_times_complex(pencil, vector) result(product)
    type(bordered_pencil_t), intent(in) :: pencil !! K
    complex(wp), intent(in) :: vector(:)          !! (unknowns) y
    complex(wp) :: product(size(vector))

    real(wp), dimension(size(vector)) :: real_part, imaginary_part

    call stiffness_times_vector(pencil, real(vector, wp), real_part)
    call stiffness_times_vector(pencil, aimag(vector), imaginary_part)
    product = cmplx(real_part, imaginary_part, wp)
  end function stiffness_times_complex

end module damped_solver
