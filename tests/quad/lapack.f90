!> The routines of LAPACK that the program calls, in the kind of the quadruple-precision build: in place of src/eigen/lapack.f90.
!! ARPACK has no counterpart: SOLVER band does not converge in this build.
module lapack
  use kinds, only: wp
  use symmetric_eigensolver, only: solve_generalized
  implicit none (type, external)
  private

  public :: dsygvx, dpbtrf, dpbtrs, dsaupd, dseupd

  integer, parameter :: not_available = -1 !! a value of ARPACK's info that says that it has failed

contains

  !> Eigenvalues and vectors il to iu of `A x = λ B x`; only this way of asking for them is served.
  subroutine dsygvx(itype, jobz, range, uplo, n, a, lda, b, ldb, vl, vu, il, iu, abstol, m, w, z, ldz, work, lwork, iwork, &
      ifail, info)
    integer, intent(in) :: itype, n, lda, ldb, il, iu, ldz, lwork
    character(len=1), intent(in) :: jobz, range, uplo
    real(wp), intent(in) :: vl, vu, abstol
    real(wp), intent(inout) :: a(lda, *), b(ldb, *)
    integer, intent(out) :: m, info
    real(wp), intent(inout) :: w(*), z(ldz, *), work(*)
    integer, intent(inout) :: iwork(*), ifail(*)

    real(wp) :: values(n), vectors(n, n)

    m = 0
    info = 0
    if (lwork == -1) then
      work(1) = 1.0_wp
      return
    end if
    if (itype /= 1 .or. range /= "I" .or. uplo /= "L" .or. vl > vu .or. abstol < 0.0_wp) then
      info = -1
      return
    end if
    call solve_generalized(a(:n, :n), b(:n, :n), values, vectors, info)
    if (info /= 0) return
    m = iu - il + 1
    w(:m) = values(il:iu)
    if (jobz == "V") z(:n, :m) = vectors(:, il:iu)
    ifail(:m) = 0
    iwork(1) = 0
  end subroutine dsygvx

  !> `A = L Lᵀ` in band storage.
  pure subroutine dpbtrf(uplo, n, kd, ab, ldab, info)
    character(len=1), intent(in) :: uplo
    integer, intent(in) :: n, kd, ldab
    real(wp), intent(inout) :: ab(ldab, *)
    integer, intent(out) :: info

    integer :: i, j, below

    info = -1
    if (uplo /= "L") return
    do j = 1, n
      info = j
      if (.not. ab(1, j) > 0.0_wp) return
      ab(1, j) = sqrt(ab(1, j))
      below = min(kd, n - j)
      ab(2:1 + below, j) = ab(2:1 + below, j)/ab(1, j)
      do i = 1, below
        ab(1:1 + below - i, j + i) = ab(1:1 + below - i, j + i) - ab(1 + i, j)*ab(1 + i:1 + below, j)
      end do
    end do
    info = 0
  end subroutine dpbtrf

  !> Solves with that factor.
  pure subroutine dpbtrs(uplo, n, kd, nrhs, ab, ldab, b, ldb, info)
    character(len=1), intent(in) :: uplo
    integer, intent(in) :: n, kd, nrhs, ldab, ldb
    real(wp), intent(in) :: ab(ldab, *)
    real(wp), intent(inout) :: b(ldb, *)
    integer, intent(out) :: info

    integer :: i, j, below

    info = merge(0, -1, uplo == "L")
    if (info /= 0) return
    do i = 1, nrhs
      do j = 1, n
        below = min(kd, n - j)
        b(j, i) = b(j, i)/ab(1, j)
        b(j + 1:j + below, i) = b(j + 1:j + below, i) - b(j, i)*ab(2:1 + below, j)
      end do
      do j = n, 1, -1
        below = min(kd, n - j)
        b(j, i) = (b(j, i) - dot_product(ab(2:1 + below, j), b(j + 1:j + below, i)))/ab(1, j)
      end do
    end do
  end subroutine dpbtrs

  subroutine dsaupd(ido, bmat, n, which, nev, tol, resid, ncv, v, ldv, iparam, ipntr, workd, workl, lworkl, info)
    integer, intent(inout) :: ido, info
    character(len=1), intent(in) :: bmat
    character(len=2), intent(in) :: which
    integer, intent(in) :: n, nev, ncv, ldv, lworkl
    real(wp), intent(inout) :: tol, resid(*), v(ldv, *), workd(*), workl(*)
    integer, intent(inout) :: iparam(11), ipntr(11)

    ido = 99
    info = not_available
  end subroutine dsaupd

  subroutine dseupd(rvec, howmny, select, d, z, ldz, sigma, bmat, n, which, nev, tol, resid, ncv, v, ldv, iparam, ipntr, &
      workd, workl, lworkl, info)
    logical, intent(in) :: rvec
    character(len=1), intent(in) :: howmny, bmat
    character(len=2), intent(in) :: which
    integer, intent(in) :: ldz, n, nev, ncv, ldv, lworkl
    logical, intent(inout) :: select(*)
    real(wp), intent(in) :: sigma
    real(wp), intent(inout) :: d(*), z(ldz, *), tol, resid(*), v(ldv, *), workd(*), workl(*)
    integer, intent(inout) :: iparam(11), ipntr(11), info

    info = not_available
  end subroutine dseupd

end module lapack
