!> The kind of every real number in the program, in one place so that the whole of it can be
!! switched at once.
module kinds
  use, intrinsic :: iso_fortran_env, only: int64, real64
  implicit none (type, external)
  private

  public :: wp, long, fineness

  integer, parameter :: wp = real64  !! working precision: IEEE double
  integer, parameter :: long = int64 !! file sizes and other counts that may pass 2³¹

  !> Rounding of the working precision in units of that of a double, for tolerances that stand just
  !! above it: 1.
  real(wp), parameter :: fineness = epsilon(1.0_wp)/epsilon(1.0_real64)

end module kinds
