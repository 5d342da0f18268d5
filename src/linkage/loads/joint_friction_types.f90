!> Friction in the joints of a linkage.
module joint_friction_types
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: joint_friction_t

  !> What rubs: two bodies on a pin, a body on a ground pivot, or the block of a slider on its line.
  !! With the force F in the joint and the relative rate v, a couple `radius μ |F| tanh(v/smooth) +
  !! viscous v` in a pin, or a force `μ |F| tanh(v/smooth) + viscous v` along a line, resists.
  type :: joint_friction_t
    integer :: pin = 0                !! number
    integer :: body = 0               !! that turns on the pin; not of a slider
    integer :: against = 0            !! the body that bears the pin; 0: the ground, or a block that
                                      !! does not turn
    integer :: slider = 0             !! whose block rubs on its line; 0: the pin rubs
    integer :: turn = 0               !! by which the block keeps a body from turning, so that its
                                      !! two ends press on the line; each is a friction of its own
    real(wp) :: reach = 0.0_wp        !! then the length of the block, negative at one end [m]
    integer :: joint = 0              !! number of the joint among those that rub: the ends of a
                                      !! block have the same
    real(wp) :: radius = 0.0_wp       !! of the bearing; not of a slider [m]
    real(wp) :: coefficient = 0.0_wp  !! μ of Coulomb friction [-]
    real(wp) :: viscous = 0.0_wp      !! [N m s/rad] or [N s/m]
    real(wp) :: smooth = 0.01_wp      !! rate within which Coulomb friction changes its sign
                                      !! smoothly [rad/s] or [m/s]
  end type joint_friction_t

end module joint_friction_types
