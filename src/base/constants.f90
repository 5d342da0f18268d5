!> Mathematical constants.
module constants
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: pi, two_pi, degree

  real(wp), parameter :: pi = 3.14159265358979323846264338327950288_wp
  real(wp), parameter :: two_pi = 2.0_wp*pi
  real(wp), parameter :: degree = pi/180.0_wp !! [rad]

end module constants
