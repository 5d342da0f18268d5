!> Solves `(K − μ M) x = b` with the stiffness `K = I + G` and bordered matrices G and M: the step
!! of every inverse iteration. Free motions have 0 in place of 1 in I.
module bordered_solver
  use bordered_pencil, only: bordered_pencil_t
  use kinds, only: fineness, wp
  implicit none (type, external)
  private

  public :: solve_shifted

  !> Own modes whose pivot is below this share of their stiffness are eliminated last.
  real(wp), parameter :: small_pivot = 1.0e-6_wp

contains

  !> Solves `(I + G − μ M) x = b`: eliminates each block together with its border rows and the
  !! right-hand side, then the border.
  !!
  !! `L D Lᵀ` without pivoting, but own modes with small pivots come last, with the border: in their
  !! places elimination would leave no digit. Pivots are small where μ is an eigenvalue of a link
  !! with its border held and of the linkage, too: a beam that is hinged and free has the
  !! frequencies of one that is clamped and hinged. No result depends on the accuracy of the
  !! solution: the callers measure its residual.
  pure subroutine solve_shifted(pencil, shift, right_side, solution)
    type(bordered_pencil_t), intent(in) :: pencil !! G and M
    real(wp), intent(in) :: shift                 !! μ
    real(wp), intent(in) :: right_side(:)         !! (unknowns) b
    real(wp), intent(out) :: solution(:)          !! (unknowns) x

    integer, allocatable :: late(:)
    integer :: small

    call eliminate_all(pencil, shift, right_side, [integer ::], solution, small)
    if (small == 0) return
    late = [small]
    do
      call eliminate_all(pencil, shift, right_side, late, solution, small)
      if (small == 0) return
      late = [late, small]
    end do
  end subroutine solve_shifted

  !> The same with some own modes eliminated last, unless another one has a small pivot.
  pure subroutine eliminate_all(pencil, shift, right_side, late, solution, small)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: shift
    real(wp), intent(in) :: right_side(:)
    integer, intent(in) :: late(:)       !! own modes that are eliminated with the border
    real(wp), intent(out) :: solution(:) !! undefined where there is a small pivot
    integer, intent(out) :: small        !! own mode with a small pivot; 0: there is none

    real(wp), allocatable :: panel(:, :, :)
    real(wp) :: border(pencil%layout%border + size(late) + 1, pencil%layout%border + size(late))
    real(wp) :: on_border(pencil%layout%border + size(late)), pivot, factor
    integer :: b, i, j, k, n, first_single

    small = 0
    associate (layout => pencil%layout, mass => pencil%mass, geometric => pencil%geometric, &
        loaded => pencil%loaded)
      n = layout%border
      border(:n, :n) = -shift*mass%border
      if (loaded) border(:n, :n) = border(:n, :n) + geometric%border
      do i = 1, n - layout%free
        border(i, i) = border(i, i) + 1.0_wp
      end do
      border(n + size(late) + 1, :n) = right_side(:n)
      if (size(late) > 0) call fill_late(pencil, shift, right_side, late, border)
      n = n + size(late)

      first_single = layout%border + 1
      if (loaded) then
        allocate (panel(n + maxval(layout%size) + 1, maxval(layout%size), size(layout%size)))
        do b = 1, size(layout%size)
          call eliminate_block(pencil, shift, right_side, b, late, panel(:, :, b), border, small)
          if (small > 0) return
        end do
        first_single = first_single + sum(layout%size)
      end if
      do k = first_single, layout%unknowns
        pivot = 1.0_wp - shift*mass%diagonal(k)
        if (abs(pivot) < small_pivot) then
          if (any(late == k)) cycle
          small = k
          return
        end if
        do j = 1, layout%border
          factor = -shift*mass%coupling(j, k)/pivot
          do i = j, layout%border
            border(i, j) = border(i, j) + shift*mass%coupling(i, k)*factor
          end do
          border(n + 1, j) = border(n + 1, j) - factor*right_side(k)
        end do
      end do

      call eliminate(border, n)
      call substitute_back(border, n, on_border)
      solution(:layout%border) = on_border(:layout%border)
      if (loaded) then
        do b = 1, size(layout%size)
          associate (m => layout%size(b), first => layout%first(b))
            do k = 1, m
              panel(m + n + 1, k, b) = panel(m + n + 1, k, b) - &
                dot_product(panel(m + 1:m + n, k, b), on_border)
              panel(m + 1, k, b) = panel(m + n + 1, k, b)
            end do
            call substitute_back(panel(:m + 1, :m, b), m, solution(first:first + m - 1))
          end associate
        end do
      end if
      do k = first_single, layout%unknowns
        pivot = 1.0_wp - shift*mass%diagonal(k)
        if (abs(pivot) < small_pivot) cycle
        solution(k) = (right_side(k) + shift*dot_product(mass%coupling(:, k), &
          solution(:layout%border)))/pivot
      end do
      solution(late) = on_border(layout%border + 1:)
    end associate
  end subroutine eliminate_all

  !> Rows of the border of own modes that are eliminated with it.
  pure subroutine fill_late(pencil, shift, right_side, late, border)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: shift
    real(wp), intent(in) :: right_side(:)
    integer, intent(in) :: late(:)
    real(wp), intent(inout) :: border(:, :) !! below these rows the right-hand side

    integer :: b, i, j, n

    n = pencil%layout%border
    do i = 1, size(late)
      associate (k => late(i), layout => pencil%layout)
        border(n + i, :n) = -shift*pencil%mass%coupling(:, k)
        border(n + i, n + 1:) = 0.0_wp
        border(n + i, n + i) = 1.0_wp - shift*pencil%mass%diagonal(k)
        border(n + size(late) + 1, n + i) = right_side(k)
        if (.not. pencil%loaded) cycle
        border(n + i, :n) = border(n + i, :n) + pencil%geometric%coupling(:, k)
        do b = 1, size(layout%size)
          associate (first => layout%first(b), last => layout%first(b) + layout%size(b) - 1)
            if (k < first .or. k > last) cycle
            do j = 1, i
              if (late(j) >= first .and. late(j) <= last) border(n + i, n + j) = border(n + i, &
                n + j) + pencil%geometric%block(k - first + 1, late(j) - first + 1, b)
            end do
          end associate
        end do
      end associate
    end do
  end subroutine fill_late

  !> Eliminates a block and subtracts its contribution from the border.
  pure subroutine eliminate_block(pencil, shift, right_side, b, late, panel, border, small)
    type(bordered_pencil_t), intent(in) :: pencil !! with a G
    real(wp), intent(in) :: shift
    real(wp), intent(in) :: right_side(:)
    integer, intent(in) :: b                      !! number of the block
    integer, intent(in) :: late(:)                !! own modes that belong to the border
    real(wp), intent(out) :: panel(:, :)          !! columns of the block; below it the border's
                                                  !! rows and the right-hand side
    real(wp), intent(inout) :: border(:, :)
    integer, intent(out) :: small                 !! own mode with a small pivot; 0: there is none

    real(wp) :: factor
    integer :: i, j, k, m, n, first

    m = pencil%layout%size(b)
    n = pencil%layout%border + size(late)
    first = pencil%layout%first(b) - 1
    do k = 1, m
      do j = k, m
        panel(j, k) = pencil%geometric%block(j, k, b)
      end do
      panel(k, k) = 1.0_wp + panel(k, k) - shift*pencil%mass%diagonal(first + k)
      do i = 1, pencil%layout%border
        panel(m + i, k) = pencil%geometric%coupling(i, first + k) - shift*pencil%mass%coupling(i, &
          first + k)
      end do
      panel(m + n + 1, k) = right_side(first + k)
    end do
    if (size(late) > 0) call move_to_border(pencil, b, late, panel)
    call eliminate(panel(:m + n + 1, :m), m)
    small = 0
    do k = 1, m
      if (abs(panel(k, k)) < small_pivot) small = first + k
    end do
    if (small > 0) return
    do k = 1, m
      do j = 1, n
        factor = panel(m + j, k)/panel(k, k)
        do i = j, n + 1
          border(i, j) = border(i, j) - factor*panel(m + i, k)
        end do
      end do
    end do
  end subroutine eliminate_block

  !> Moves own modes from a block to rows of the border; rows of the unit matrix keep their places.
  pure subroutine move_to_border(pencil, b, late, panel)
    type(bordered_pencil_t), intent(in) :: pencil !! with a G
    integer, intent(in) :: b
    integer, intent(in) :: late(:)
    real(wp), intent(inout) :: panel(:, :)

    integer :: i, k, m, n

    m = pencil%layout%size(b)
    n = pencil%layout%border
    do i = 1, size(late)
      k = late(i) - pencil%layout%first(b) + 1
      panel(m + n + i, :m) = 0.0_wp
      if (k >= 1 .and. k <= m) panel(m + n + i, :m) = pencil%geometric%block(k, :m, b)
    end do
    do i = 1, size(late)
      k = late(i) - pencil%layout%first(b) + 1
      if (k < 1 .or. k > m) cycle
      panel(k, :k) = 0.0_wp
      panel(k:, k) = 0.0_wp
      panel(k, k) = 1.0_wp
    end do
  end subroutine move_to_border

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
