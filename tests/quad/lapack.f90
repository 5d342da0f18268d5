!> The routines of LAPACK that the program calls, in the kind of the quadruple-precision build: in place of src/eigen/lapack.f90.
!! ARPACK has no counterpart: SOLVER band does not converge in this build. Nor have multipliers: no elastic response, whose Fourier
!! transforms are in double precision anyway.
module lapack
  use kinds, only: wp
  use symmetric_eigensolver, only: solve_generalized
  implicit none (type, external)
  private

  public :: dsygvx, dpbtrf, dpbtrs, dgetrf, dgetrs, dgeev, dsaupd, dseupd

  integer, parameter :: not_available = -1 !! a value of info that says that a routine has failed

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

  !> `P A = L U`, the rows exchanged for the largest pivots.
  pure subroutine dgetf2(m, n, a, lda, ipiv, info)
    integer, intent(in) :: m, n, lda
    real(wp), intent(inout) :: a(lda, *)
    integer, intent(out) :: ipiv(*), info

    integer :: j, k

    info = 0
    do k = 1, min(m, n)
      ipiv(k) = k - 1 + maxloc(abs(a(k:m, k)), dim=1)
      if (.not. abs(a(ipiv(k), k)) > 0.0_wp) then
        if (info == 0) info = k
        cycle
      end if
      a([k, ipiv(k)], :n) = a([ipiv(k), k], :n)
      a(k + 1:m, k) = a(k + 1:m, k)/a(k, k)
      do j = k + 1, n
        a(k + 1:m, j) = a(k + 1:m, j) - a(k, j)*a(k + 1:m, k)
      end do
    end do
  end subroutine dgetf2

  !> The same.
  pure subroutine dgetrf(m, n, a, lda, ipiv, info)
    integer, intent(in) :: m, n, lda
    real(wp), intent(inout) :: a(lda, *)
    integer, intent(out) :: ipiv(*), info

    call dgetf2(m, n, a, lda, ipiv, info)
  end subroutine dgetrf

  !> Solves `A X = B` or `Aᵀ X = B` with these factors.
  pure subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
    character(len=1), intent(in) :: trans
    integer, intent(in) :: n, nrhs, lda, ldb, ipiv(*)
    real(wp), intent(in) :: a(lda, *)
    real(wp), intent(inout) :: b(ldb, *)
    integer, intent(out) :: info

    integer :: i, k

    info = 0
    if (trans == "N") then
      do k = 1, n
        if (ipiv(k) /= k) b([k, ipiv(k)], :nrhs) = b([ipiv(k), k], :nrhs)
      end do
      do i = 1, nrhs
        do k = 1, n
          b(k + 1:n, i) = b(k + 1:n, i) - b(k, i)*a(k + 1:n, k)
        end do
        do k = n, 1, -1
          b(k, i) = b(k, i)/a(k, k)
          b(:k - 1, i) = b(:k - 1, i) - b(k, i)*a(:k - 1, k)
        end do
      end do
    else
      do i = 1, nrhs
        do k = 1, n
          b(k, i) = (b(k, i) - dot_product(a(:k - 1, k), b(:k - 1, i)))/a(k, k)
        end do
        do k = n, 1, -1
          b(k, i) = b(k, i) - dot_product(a(k + 1:n, k), b(k + 1:n, i))
        end do
      end do
      do k = n, 1, -1
        if (ipiv(k) /= k) b([k, ipiv(k)], :nrhs) = b([ipiv(k), k], :nrhs)
      end do
    end if
  end subroutine dgetrs

  subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
    character(len=1), intent(in) :: jobvl, jobvr
    integer, intent(in) :: n, lda, ldvl, ldvr, lwork
    real(wp), intent(inout) :: a(lda, *), wr(*), wi(*), vl(ldvl, *), vr(ldvr, *), work(*)
    integer, intent(out) :: info

    info = not_available
  end subroutine dgeev

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
