!> Inertia loads of moving links: the forces that their masses exert on the linkage.
module inertia_loads
  use acceleration_fields, only: acceleration_field_t, point_acceleration
  use kinds, only: wp
  use linkages, only: body_t, cross, linkage_t
  use poses, only: arm_to_place, pose_t
  implicit none (type, external)
  private

  public :: load_t, lumped_masses, lumped_stations, lumped_load, distributed_load, pin_load

  !> Resultant load on a body.
  type :: load_t
    real(wp) :: force(2) = 0.0_wp !! [N]
    real(wp) :: moment = 0.0_wp   !! about its first pin, counter-clockwise [N m]
  end type load_t

contains

  !> Masses of a uniform link at the nodes of equal elements: half the mass of each neighbouring
  !! element [kg].
  pure function lumped_masses(body, elements) result(masses)
    type(body_t), intent(in) :: body !! its uniform part
    integer, intent(in) :: elements  !! number of equal elements
    real(wp) :: masses(elements + 1)

    masses = body%line_density*body%length/elements
    masses(1) = 0.5_wp*masses(1)
    masses(elements + 1) = 0.5_wp*masses(elements + 1)
  end function lumped_masses

  !> Distances of the nodes of equal elements from the first pin [m].
  pure function lumped_stations(body, elements) result(stations)
    type(body_t), intent(in) :: body !! its length
    integer, intent(in) :: elements  !! number of equal elements
    real(wp) :: stations(elements + 1)

    integer :: i

    stations = [(body%length*i/elements, i=0, elements)]
  end function lumped_stations

  !> Inertia load of a link whose mass is lumped on its nodes: `F = −m a` at each, Ulker 2010 (3.1)
  !! to (3.18). Its lumps are included.
  pure function lumped_load(body, number, elements, pose, field) result(load)
    type(body_t), intent(in) :: body !! with its lumps
    integer, intent(in) :: number    !! of the body in the linkage
    integer, intent(in) :: elements  !! number of equal elements
    type(pose_t), intent(in) :: pose !! directions of the bodies
    type(acceleration_field_t), intent(in) :: field !! accelerations of all points
    type(load_t) :: load

    real(wp) :: masses(elements + 1), stations(elements + 1), force(2)
    integer :: i

    masses = lumped_masses(body, elements)
    stations = lumped_stations(body, elements)
    do i = 1, elements + 1
      force = -masses(i)*point_acceleration(field, number, stations(i))
      load%force = load%force + force
      load%moment = load%moment + stations(i)*cross(pose%direction(:, number), force)
    end do
    call add_lump_loads(body, number, pose, field, load)
  end function lumped_load

  !> Inertia load of a link with uniform mass, `f(s) = −μ (a_first + s slope)`: force (2.45) and
  !! moment about the first pin. Its lumps are included.
  !!
  !! With rotary inertia a moment −ρI α per length acts along the link.
  pure function distributed_load(body, number, pose, field) result(load)
    type(body_t), intent(in) :: body !! with its lumps
    integer, intent(in) :: number    !! of the body in the linkage
    type(pose_t), intent(in) :: pose !! directions of the bodies
    type(acceleration_field_t), intent(in) :: field !! accelerations of all points
    type(load_t) :: load

    real(wp) :: mass

    mass = body%line_density*body%length
    load%force = -mass*(field%at_first(:, number) + 0.5_wp*body%length*field%slope(:, number))
    load%moment = -mass*body%length*cross(pose%direction(:, number), &
      0.5_wp*field%at_first(:, number) + body%length/3.0_wp*field%slope(:, number))
    if (body%rotary_inertia > 0.0_wp) load%moment = load%moment - &
      body%rotary_inertia*body%length*field%angular(number)
    call add_lump_loads(body, number, pose, field, load)
  end function distributed_load

  !> Adds `F = −m a` (2.45) and `M = −I α` (2.46) of the lumps of a body.
  pure subroutine add_lump_loads(body, number, pose, field, load)
    type(body_t), intent(in) :: body
    integer, intent(in) :: number
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(load_t), intent(inout) :: load

    real(wp) :: arm(2), force(2)
    integer :: i

    if (.not. allocated(body%lumps)) return
    do i = 1, size(body%lumps)
      associate (lump => body%lumps(i))
        arm = arm_to_place(pose, number, lump%place)
        force = -lump%mass*point_acceleration(field, number, lump%place(1), lump%place(2))
        load%force = load%force + force
        load%moment = load%moment + cross(arm, force) - lump%inertia*field%angular(number)
      end associate
    end do
  end subroutine add_lump_loads

  !> Inertia forces of the pin masses [N].
  pure function pin_load(linkage, field) result(force)
    type(linkage_t), intent(in) :: linkage          !! its pin masses
    type(acceleration_field_t), intent(in) :: field !! accelerations of all points
    real(wp) :: force(2, size(linkage%pin_mass))

    integer :: i

    do i = 1, size(force, 2)
      force(:, i) = -linkage%pin_mass(i)*field%at_pin(:, i)
    end do
  end function pin_load

end module inertia_loads
