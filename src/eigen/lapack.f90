!> Explicit interfaces of the LAPACK and ARPACK routines in use.
module lapack
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: dsygvx, dpbtrf, dpbtrs, dsaupd, dseupd, dgetrf, dgetrs, dgeev

  interface
    !> Selected eigenvalues and eigenvectors of `A x = λ B x`, both symmetric, B positive definite
    !! (LAPACK).
    subroutine dsygvx(itype, jobz, range, uplo, n, a, lda, b, ldb, vl, vu, il, iu, abstol, m, w, &
        z, ldz, work, lwork, iwork, ifail, info)
      import :: wp
      integer, intent(in) :: itype, n, lda, ldb, il, iu, ldz, lwork
      character(len=1), intent(in) :: jobz, range, uplo
      real(wp), intent(in) :: vl, vu, abstol
      real(wp), intent(inout) :: a(lda, *), b(ldb, *)
      integer, intent(out) :: m, info
      real(wp), intent(inout) :: w(*), z(ldz, *), work(*)
      integer, intent(inout) :: iwork(*), ifail(*)
    end subroutine dsygvx

    !> Cholesky factorization of a symmetric positive definite band matrix (LAPACK).
    pure subroutine dpbtrf(uplo, n, kd, ab, ldab, info)
      import :: wp
      character(len=1), intent(in) :: uplo
      integer, intent(in) :: n, kd, ldab
      real(wp), intent(inout) :: ab(ldab, *)
      integer, intent(out) :: info
    end subroutine dpbtrf

    !> Solves for right-hand sides with the factor from `dpbtrf` (LAPACK).
    pure subroutine dpbtrs(uplo, n, kd, nrhs, ab, ldab, b, ldb, info)
      import :: wp
      character(len=1), intent(in) :: uplo
      integer, intent(in) :: n, kd, nrhs, ldab, ldb
      real(wp), intent(in) :: ab(ldab, *)
      real(wp), intent(inout) :: b(ldb, *)
      integer, intent(out) :: info
    end subroutine dpbtrs

    !> Factorization of a general matrix with row interchanges (LAPACK).
    pure subroutine dgetrf(m, n, a, lda, ipiv, info)
      import :: wp
      integer, intent(in) :: m, n, lda
      real(wp), intent(inout) :: a(lda, *)
      integer, intent(out) :: ipiv(*), info
    end subroutine dgetrf

    !> Solves for right-hand sides with the factors from `dgetrf` (LAPACK).
    pure subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: wp
      character(len=1), intent(in) :: trans
      integer, intent(in) :: n, nrhs, lda, ldb
      real(wp), intent(in) :: a(lda, *)
      integer, intent(in) :: ipiv(*)
      real(wp), intent(inout) :: b(ldb, *)
      integer, intent(out) :: info
    end subroutine dgetrs

    !> Eigenvalues, and eigenvectors if wanted, of a general matrix (LAPACK).
    subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
      import :: wp
      character(len=1), intent(in) :: jobvl, jobvr
      integer, intent(in) :: n, lda, ldvl, ldvr, lwork
      real(wp), intent(inout) :: a(lda, *), work(*)
      real(wp), intent(inout) :: wr(*), wi(*), vl(ldvl, *), vr(ldvr, *)
      integer, intent(out) :: info
    end subroutine dgeev

    !> One step of the implicitly restarted Lanczos method by reverse communication (ARPACK).
    subroutine dsaupd(ido, bmat, n, which, nev, tol, resid, ncv, v, ldv, iparam, ipntr, workd, &
      workl, lworkl, info)
      import :: wp
      integer, intent(inout) :: ido, info
      character(len=1), intent(in) :: bmat
      character(len=2), intent(in) :: which
      integer, intent(in) :: n, nev, ncv, ldv, lworkl
      real(wp), intent(inout) :: tol, resid(*), v(ldv, *), workd(*), workl(*)
      integer, intent(inout) :: iparam(11), ipntr(11)
    end subroutine dsaupd

    !> Eigenvalues and eigenvectors once `dsaupd` has converged (ARPACK).
    subroutine dseupd(rvec, howmny, select, d, z, ldz, sigma, bmat, n, which, nev, tol, resid, &
        ncv, v, ldv, iparam, ipntr, workd, workl, lworkl, info)
      import :: wp
      logical, intent(in) :: rvec
      character(len=1), intent(in) :: howmny, bmat
      character(len=2), intent(in) :: which
      integer, intent(in) :: ldz, n, nev, ncv, ldv, lworkl
      logical, intent(inout) :: select(*)
      real(wp), intent(in) :: sigma
      real(wp), intent(inout) :: d(*), z(ldz, *), tol, resid(*), v(ldv, *), workd(*), workl(*)
      integer, intent(inout) :: iparam(11), ipntr(11), info
    end subroutine dseupd
  end interface

end module lapack
