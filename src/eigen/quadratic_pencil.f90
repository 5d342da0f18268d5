!> Small quadratic eigenproblems `(A0 + σ A1 + σ² A2) x = 0` with complex matrices.
module quadratic_pencil
  use kinds, only: wp
  use lapack, only: dgeev, dgetrf, dgetrs
  implicit none (type, external)
  private

  public :: find_pencil_modes

  !> Eigenvectors of the real matrix that stands for a complex one belong to its eigenvalues, or to
  !! their conjugates: then this little is left of them.
  real(wp), parameter :: of_conjugate = 1.0e-3_wp

contains

  !> All σ with their x. With μ = 1/(σ − σ0) and `B0 + B1/μ + A2/μ²` they are those of the matrix
  !! `[0, 1; −B0⁻¹A2, −B0⁻¹B1]`, written in real numbers: those near σ0 do not suffer from others
  !! that are far away, even infinitely.
  !!
  !! Where that fails, no eigenvalues are given.
  subroutine find_pencil_modes(a, near, values, vectors)
    complex(wp), intent(in) :: a(:, :, 0:)             !! (n, n, power of σ)
    complex(wp), intent(in) :: near                    !! σ0, none of the eigenvalues
    complex(wp), allocatable, intent(out) :: values(:) !! where the conjugate of
                                                       !! one is one, too, it may be
                                                       !! there twice
    complex(wp), allocatable, intent(out) :: vectors(:, :) !! (n, values) of length 1

    real(wp) :: factor(2*size(a, 1), 2*size(a, 1)), right(2*size(a, 1), 4*size(a, 1))
    real(wp) :: whole(4*size(a, 1), 4*size(a, 1)), shape(4*size(a, 1), 4*size(a, 1))
    real(wp) :: re(4*size(a, 1)), im(4*size(a, 1)), work(64*size(a, 1)), none(1, 1)
    complex(wp) :: x(size(a, 1)), pair(4*size(a, 1)), value, first(size(a, 1), size(a, 1))
    integer :: pivot(2*size(a, 1)), i, k, n, found, info

    n = size(a, 1)
    allocate (values(4*n), vectors(n, 4*n))
    first = a(:, :, 1) + 2.0_wp*near*a(:, :, 2)
    factor = in_real_numbers(a(:, :, 0) + near*(a(:, :, 1) + near*a(:, :, 2)))
    right(:, :2*n) = -in_real_numbers(a(:, :, 2))
    right(:, 2*n + 1:) = -in_real_numbers(first)
    call dgetrf(2*n, 2*n, factor, 2*n, pivot, info)
    if (info == 0) then
      call dgetrs("N", 2*n, 4*n, factor, 2*n, pivot, right, 2*n, info)
      whole = 0.0_wp
      do i = 1, 2*n
        whole(i, 2*n + i) = 1.0_wp
      end do
      whole(2*n + 1:, :) = right
      call dgeev("N", "V", 4*n, whole, 4*n, re, im, none, 1, shape, 4*n, work, size(work), info)
    end if
    found = 0
    if (info == 0) then
      do i = 1, 4*n
        k = i
        if (im(i) < 0.0_wp) k = i - 1
        pair = cmplx(shape(:, i), 0.0_wp, wp)
        if (abs(im(i)) > 0.0_wp) pair = cmplx(shape(:, k), shape(:, k + 1), wp)
        value = cmplx(re(i), im(i), wp)
        if (im(i) < 0.0_wp) pair = conjg(pair)
        x = pair(:n) + (0.0_wp, 1.0_wp)*pair(n + 1:2*n)
        if (sqrt(sum(abs(x)**2)) <= of_conjugate*sqrt(sum(abs(pair(:2*n))**2))) cycle
        if (abs(value) <= tiny(1.0_wp)) cycle
        found = found + 1
        values(found) = near + 1.0_wp/value
        vectors(:, found) = x/sqrt(sum(abs(x)**2))
      end do
    end if
    values = values(:found)
    vectors = vectors(:, :found)
  end subroutine find_pencil_modes

  !> `[Re, −Im; Im, Re]`.
  pure function in_real_numbers(a) result(whole)
    complex(wp), intent(in) :: a(:, :)
    real(wp) :: whole(2*size(a, 1), 2*size(a, 1))

    integer :: n

    n = size(a, 1)
    whole(:n, :n) = real(a, wp)
    whole(n + 1:, n + 1:) = real(a, wp)
    whole(:n, n + 1:) = -aimag(a)
    whole(n + 1:, :n) = aimag(a)
  end function in_real_numbers

end module quadratic_pencil
