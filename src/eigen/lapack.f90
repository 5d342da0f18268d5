!> Explicit interfaces of the LAPACK and ARPACK routines in use.
module lapack
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: dsygvx, dpbtrf, dpbtrs, dsaupd, dseupd

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
