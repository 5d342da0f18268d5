!> Drives whose forces statics cannot tell apart: a link more than needed joins what they move, and
!! they can hold it between them with any force.
module coupled_drives
  use coordinate_types, only: gradients_t
  use group_equations, only: find_gradients
  use group_factors, only: factorize_groups, group_factors_t
  use inertia_loads, only: load_t
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: find_coupled_drives

  !> A force of a drive under a unit force, or its torque as a share of the span of the linkage,
  !! that is only rounding.
  real(wp), parameter :: rounding = 1.0e-9_wp

contains

  !> The first redundancy whose force several drives can bear, so that they do no work together.
  pure subroutine find_coupled_drives(linkage, pose, redundancy, drives)
    type(linkage_t), intent(in) :: linkage !! with redundancies
    type(pose_t), intent(in) :: pose       !! away from dead points
    integer, intent(out) :: redundancy     !! its number; 0: there is none
    integer, allocatable, intent(out) :: drives(:) !! numbers of these drives

    type(gradients_t) :: gradients
    type(joint_forces_t) :: forces
    type(group_factors_t), allocatable :: factors(:)
    type(load_t) :: load(size(linkage%bodies)), no_load
    real(wp) :: pin_load(2, size(pose%pin, 2)), span
    integer :: d, k

    span = max(maxval(linkage%bodies%length), maxval(abs(pose%pin)))
    call factorize_groups(linkage, pose, factors)
    call find_gradients(linkage, pose, linkage%redundancies, gradients)
    do redundancy = 1, size(linkage%redundancies)
      load = no_load
      pin_load = 0.0_wp
      do k = gradients%last(redundancy - 1) + 1, gradients%last(redundancy)
        associate (partial => gradients%partial(k), pin => gradients%partial(k)%pin, body => &
          gradients%partial(k)%body)
          if (pin > 0) pin_load(:, pin) = pin_load(:, pin) + partial%by_pin
          if (body > 0) load(body)%moment = load(body)%moment + partial%by_angle
        end associate
      end do
      forces = find_joint_forces(linkage, pose, load, pin_load, factors)
      if (.not. allocated(forces%drive)) cycle
      drives = pack([(d, d=1, size(forces%drive))], abs(forces%drive) > rounding*max(1.0_wp, span))
      if (size(drives) > 0) return
    end do
    redundancy = 0
    drives = [integer ::]
  end subroutine find_coupled_drives

end module coupled_drives
