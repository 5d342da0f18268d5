!> Forces in the pins, from the equilibrium of every link.
module joint_forces
  use inertia_loads, only: load_t
  use kinds, only: wp
  use linkages, only: cross, dyad_t, linkage_t, normal_to
  use poses, only: arm_to_middle, pose_t
  implicit none (type, external)
  private

  public :: joint_forces_t, find_joint_forces

  !> Forces on the bodies at their pins, and the torque of the drive.
  type :: joint_forces_t
    real(wp), allocatable :: on_first(:, :) !! (2, bodies) force on the body at its first pin [N]
    real(wp), allocatable :: on_last(:, :)  !! (2, bodies) force on the body at its last pin [N]
    real(wp) :: torque = 0.0_wp             !! of the drive on the driven body [N m]
  end type joint_forces_t

contains

  !> Forces at the pins and driving torque by Ulker 2010 (2.47) to (2.49).
  !!
  !! Dyads are removed in the reverse of the order in which they are placed. Each passes the forces
  !! at its bases on as loads on the pins that carry it, until only the driven body is left.
  pure function find_joint_forces(linkage, pose, body_load, pin_load) result(forces)
    type(linkage_t), intent(in) :: linkage   !! bodies and dyads
    type(pose_t), intent(in) :: pose         !! away from dead points
    type(load_t), intent(in) :: body_load(:) !! (bodies) all loads but pin forces
    real(wp), intent(in) :: pin_load(:, :)   !! (2, pins) loads on the pins [N]
    type(joint_forces_t) :: forces

    real(wp) :: carried(2, size(pin_load, 2))
    integer :: i

    allocate (forces%on_first(2, size(linkage%bodies)), forces%on_last(2, size(linkage%bodies)))
    forces%on_first = 0.0_wp
    forces%on_last = 0.0_wp
    carried = pin_load
    do i = size(linkage%dyads), 1, -1
      call solve_dyad(linkage, linkage%dyads(i), pose, pose%sine(i), body_load, carried, forces)
    end do
    associate (crank => linkage%bodies(1))
      forces%on_last(:, 1) = carried(:, crank%last_pin)
      forces%on_first(:, 1) = -(forces%on_last(:, 1) + body_load(1)%force)
      forces%torque = -(crank%length*cross(pose%direction(:, 1), forces%on_last(:, 1)) + &
        body_load(1)%moment)
    end associate
  end function find_joint_forces

  !> Forces in one dyad. The moments of each body about its base give the force X on the first body
  !! at the middle pin: `n3·X = p`, `n4·X = q`, hence `X = (p e4 − q e3)/sin(θ4 − θ3)`.
  pure subroutine solve_dyad(linkage, dyad, pose, sine, body_load, carried, forces)
    type(linkage_t), intent(in) :: linkage
    type(dyad_t), intent(in) :: dyad
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: sine
    type(load_t), intent(in) :: body_load(:)
    real(wp), intent(inout) :: carried(:, :) !! (2, pins) loads on pins so far [N]
    type(joint_forces_t), intent(inout) :: forces

    real(wp) :: e(2, 2), moment(2), at_middle(2, 2), at_base(2), p, q
    integer :: k

    do k = 1, 2
      associate (body => linkage%bodies(dyad%body(k)), load => body_load(dyad%body(k)))
        e(:, k) = arm_to_middle(linkage, dyad, pose, k)
        moment(k) = load%moment
        if (body%last_pin /= dyad%middle) moment(k) = load%moment + body%length*cross(e(:, k), &
          load%force)
        moment(k) = moment(k)/body%length
      end associate
    end do
    p = -moment(1)
    q = dot_product(normal_to(e(:, 2)), carried(:, dyad%middle)) + moment(2)
    at_middle(:, 1) = (p*e(:, 2) - q*e(:, 1))/sine
    at_middle(:, 2) = carried(:, dyad%middle) - at_middle(:, 1)

    do k = 1, 2
      at_base = -(at_middle(:, k) + body_load(dyad%body(k))%force)
      carried(:, dyad%base(k)) = carried(:, dyad%base(k)) - at_base
      if (linkage%bodies(dyad%body(k))%last_pin == dyad%middle) then
        forces%on_last(:, dyad%body(k)) = at_middle(:, k)
        forces%on_first(:, dyad%body(k)) = at_base
      else
        forces%on_first(:, dyad%body(k)) = at_middle(:, k)
        forces%on_last(:, dyad%body(k)) = at_base
      end if
    end do
  end subroutine solve_dyad

end module joint_forces
