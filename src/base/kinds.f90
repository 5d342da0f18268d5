!> The kind of every real number in the program, in one place so that the whole of it can be switched at once.
module kinds
  use, intrinsic :: iso_fortran_env, only: int64, real64
  implicit none (type, external)
  private

  public :: wp, long

  integer, parameter :: wp = real64  !! working precision: IEEE double
  integer, parameter :: long = int64 !! file sizes and other counts that may pass 2³¹

end module kinds
