!> The kinds of the quadruple-precision build: in place of src/base/kinds.f90.
module kinds
  use, intrinsic :: iso_fortran_env, only: int64, real128, real64
  implicit none (type, external)
  private

  public :: wp, long, fineness

  integer, parameter :: wp = real128 !! working precision: IEEE quadruple
  integer, parameter :: long = int64 !! file sizes and other counts that may pass 2³¹

  !> Rounding of the working precision in units of that of a double: 2⁻⁶⁰.
  real(wp), parameter :: fineness = epsilon(1.0_wp)/epsilon(1.0_real64)

end module kinds
