!> Solves `(K − μ M) x = b` with the stiffness `K = I + G` and bordered matrices G and M: the step
!! of every inverse iteration. Free motions have 0 in place of 1 in I.
module bordered_solver
  use bordered_pencil, only: bordered_pencil_t
  use kinds, only: fineness, wp
  implicit none (type, external)
  private

  public :: solve_shifted

contains

  !> Solves `(I + G − μ M) x = b`: eliminates each block together with its border rows and the
  !! right-hand side, then the border.
  !!
  !! `L D Lᵀ` without pivoting. No result depends on its accuracy: the callers measure the residual
  !! of the solution.
  pure subroutine solve_shifted(pencil, shift, right_side, solution)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: shift                 !! μ
    real(wp), intent(in) :: right_side(:)         !! (unknowns) b
    real(wp), intent(out) :: solution(:)          !! (unknowns) x

    real(wp), allocatable :: panel(:, :, :)
    real(wp) :: border(pencil%layout%border + 1, pencil%layout%border), pivot, factor
    integer :: b, i, j, k, first_single

    associate (n => pencil%layout%border, layout => pencil%layout, mass => pencil%mass, &
        geometric => pencil%geometric, loaded => pencil%loaded)
      border(:n, :) = -shift*mass%border
      if (loaded) border(:n, :) = border(:n, :) + geometric%border
      do i = 1, n - layout%free
        border(i, i) = border(i, i) + 1.0_wp
      end do
      border(n + 1, :) = right_side(:n)

      first_single = n + 1
      if (loaded) then
        allocate (panel(n + maxval(layout%size) + 1, maxval(layout%size), size(layout%size)))
        do b = 1, size(layout%size)
          call eliminate_block(pencil, shift, right_side, b, panel(:, :, b), border)
        end do
        first_single = n + 1 + sum(layout%size)
      end if
      do k = first_single, layout%unknowns
        pivot = off_zero(1.0_wp - shift*mass%diagonal(k))
        do j = 1, n
          factor = -shift*mass%coupling(j, k)/pivot
          do i = j, n
            border(i, j) = border(i, j) + shift*mass%coupling(i, k)*factor
          end do
          border(n + 1, j) = border(n + 1, j) - factor*right_side(k)
        end do
      end do

      call eliminate(border, n)
      call substitute_back(border, n, solution(:n))
      if (loaded) then
        do b = 1, size(layout%size)
          associate (m => layout%size(b), first => layout%first(b))
            do k = 1, m
              panel(m + n + 1, k, b) = panel(m + n + 1, k, b) - &
                dot_product(panel(m + 1:m + n, k, b), solution(:n))
              panel(m + 1, k, b) = panel(m + n + 1, k, b)
            end do
            call substitute_back(panel(:m + 1, :m, b), m, solution(first:first + m - 1))
          end associate
        end do
      end if
      do k = first_single, layout%unknowns
        pivot = off_zero(1.0_wp - shift*mass%diagonal(k))
        solution(k) = (right_side(k) + shift*dot_product(mass%coupling(:, k), solution(:n)))/pivot
      end do
    end associate
  end subroutine solve_shifted

  !> Eliminates a block and subtracts its contribution from the border.
  pure subroutine eliminate_block(pencil, shift, right_side, b, panel, border)
    type(bordered_pencil_t), intent(in) :: pencil !! with a G
    real(wp), intent(in) :: shift
    real(wp), intent(in) :: right_side(:)
    integer, intent(in) :: b                      !! number of the block
    real(wp), intent(out) :: panel(:, :)          !! columns of the block; below it the border's
                                                  !! rows and the right-hand side
    real(wp), intent(inout) :: border(:, :)

    real(wp) :: factor
    integer :: i, j, k, m, n, first

    m = pencil%layout%size(b)
    n = pencil%layout%border
    first = pencil%layout%first(b) - 1
    do k = 1, m
      do j = k, m
        panel(j, k) = pencil%geometric%block(j, k, b)
      end do
      panel(k, k) = 1.0_wp + panel(k, k) - shift*pencil%mass%diagonal(first + k)
      do i = 1, n
        panel(m + i, k) = pencil%geometric%coupling(i, first + k) - shift*pencil%mass%coupling(i, &
          first + k)
      end do
      panel(m + n + 1, k) = right_side(first + k)
    end do
    call eliminate(panel(:m + n + 1, :m), m)
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
  !!
  !! Four columns are taken off the others at a time, one after another in each entry: the digits
  !! are those of one column at a time, and memory is read and written a quarter as often.
  pure subroutine eliminate(panel, m)
    real(wp), intent(inout) :: panel(:, :)
    integer, intent(in) :: m

    integer, parameter :: wide = 4
    real(wp) :: factor(wide)
    integer :: i, j, k, p, last

    do k = 1, m, wide
      last = min(k + wide - 1, m)
      do p = k, last
        panel(p, p) = off_zero(panel(p, p))
        do j = p + 1, last
          factor(1) = panel(j, p)/panel(p, p)
          do i = j, size(panel, 1)
            panel(i, j) = panel(i, j) - factor(1)*panel(i, p)
          end do
        end do
      end do
      ! The last, narrower group has no columns after it.
      do j = last + 1, m
        do p = 1, wide
          factor(p) = panel(j, k + p - 1)/panel(k + p - 1, k + p - 1)
        end do
        do i = j, size(panel, 1)
          panel(i, j) = (((panel(i, j) - factor(1)*panel(i, k)) - factor(2)*panel(i, k + 1)) - &
            factor(3)*panel(i, k + 2)) - factor(4)*panel(i, k + 3)
        end do
      end do
    end do
  end subroutine eliminate

  !> A pivot, moved away from zero if it is near. The solution serves only as a direction, and keeps
  !! enough digits to be improved.
  pure function off_zero(pivot) result(moved)
    real(wp), intent(in) :: pivot
    real(wp) :: moved

    real(wp), parameter :: least_pivot = 1.0e-14_wp*fineness

    moved = pivot
    if (abs(moved) < least_pivot) moved = sign(least_pivot, pivot)
  end function off_zero

  !> Solves with the result of `eliminate`; the right-hand side is the last row of the panel.
  pure subroutine substitute_back(panel, m, solution)
    real(wp), intent(in) :: panel(:, :)
    integer, intent(in) :: m
    real(wp), intent(out) :: solution(:)

    integer :: k, last

    last = size(panel, 1)
    do k = m, 1, -1
      solution(k) = (panel(last, k) - dot_product(panel(k + 1:m, k), solution(k + 1:m)))/panel(k, k)
    end do
  end subroutine substitute_back

end module bordered_solver
