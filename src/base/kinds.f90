! src/base/ - what any file may use: kinds of numbers, constants, errors, warnings, units.
! A failure is an `error_t`, allocated where it happens and passed up. Begin with `set_error` in
! `errors.f90`. Units of decks are read by `read_unit` in `units.f90`; `output_units.f90` has those
! of results, `natures.f90` those of coordinates.
! Not here: text (`src/base/words`), files, signals, ranks (`src/base/system`), matrices and
! integration (`src/base/numerics`).

!> The kinds of numbers, in one place so that the whole program can be switched to another
!! precision.
module kinds
  use, intrinsic :: iso_fortran_env, only: int64, real64
  implicit none (type, external)
  private

  public :: wp, long, fineness

  integer, parameter :: wp = real64  !! working precision: IEEE double
  integer, parameter :: long = int64 !! file sizes and other counts that may pass 2³¹

  !> Machine epsilon of the working precision divided by that of a double, for tolerances just above
  !! round-off; 1 for doubles.
  real(wp), parameter :: fineness = epsilon(1.0_wp)/epsilon(1.0_real64)

end module kinds
