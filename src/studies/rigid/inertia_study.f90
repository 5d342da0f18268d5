!> Places and accelerations of the masses of a linkage, and their inertia forces and moments.
module inertia_study
  use acceleration_fields, only: acceleration_field_t, unit_fields
  use inertia_loads, only: lumped_masses, lumped_stations
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, normal_to
  use positions, only: positions_t, state_t
  implicit none (type, external)
  private

  public :: mass_t, inertia_result_t, mass_load_t, find_inertia_loads, loads_at_speed
  public :: of_link, of_body, on_link, at_pin, of_block

  !> Kinds of masses: the uniform mass of a beam, or a part of it on a node; the mass given for a
  !! link as a whole, or that of a segment of it; a mass fixed to a link; a mass at a pin; a block
  !! that turns with the link along which it slides, without its mass, which is at its pin.
  integer, parameter :: of_link = 1, of_body = 2, on_link = 3, at_pin = 4, of_block = 5

  type :: mass_t
    integer :: kind = 0               !! one of the above
    integer :: number = 0             !! of the body, pin or slider
    real(wp) :: mass = 0.0_wp         !! [kg]
    real(wp) :: place(2) = 0.0_wp     !! on a body: from its first pin, in the body's axes [m]
    real(wp) :: inertia = 0.0_wp      !! moment of inertia about its own mass centre [kg m²]
    real(wp) :: rotary_inertia = 0.0_wp !! additional, of the cross-sections of a beam [kg m²]
  end type mass_t

  !> Masses, and the unit accelerations from which those at any speed follow; zeros where there is
  !! no pose.
  type :: inertia_result_t
    type(mass_t), allocatable :: masses(:)
    real(wp), allocatable :: unit(:, :, :) !! (values of a field, ω2² = 1 or α2 = 1, states), as in
                                           !! `unit_numbers`
    integer :: pins = 0, bodies = 0        !! numbers of them
  end type inertia_result_t

  !> A mass at a position and speed.
  type :: mass_load_t
    real(wp) :: place(2) = 0.0_wp        !! in global axes [m]
    real(wp) :: acceleration(2) = 0.0_wp !! [m/s²]
    real(wp) :: force(2) = 0.0_wp        !! −m a (2.45) [N]
    real(wp) :: moment = 0.0_wp          !! −I α (2.46) [N m]
  end type mass_load_t

contains

  !> Masses and unit accelerations, once for all speeds: Ulker 2010 (2.39) to (2.46), and (3.1) to
  !! (3.18) for lumped masses.
  subroutine find_inertia_loads(linkage, elements, positions, threads, found)
    type(linkage_t), intent(in) :: linkage       !! of any kind, with masses
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(positions_t), intent(in) :: positions   !! of the run
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(inertia_result_t), intent(out) :: found !! for all positions and speeds

    integer :: i

    found%masses = masses_of(linkage, elements)
    found%pins = size(linkage%is_ground)
    found%bodies = size(linkage%bodies)
    allocate (found%unit(2*found%pins + 5*found%bodies, 2, size(positions%states)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(positions%states)
      found%unit(:, :, i) = 0.0_wp
      if (.not. allocated(positions%states(i)%error)) found%unit(:, :, i) = &
        unit_numbers(linkage, positions%states(i), size(found%unit, 1))
    end do
    !$omp end parallel do
  end subroutine find_inertia_loads

  !> All masses: body after body its uniform mass and its lumps, then the pin masses and blocks. The
  !! last lumps of a body are the blocks that slide along it.
  pure function masses_of(linkage, elements) result(masses)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(mass_t), allocatable :: masses(:)

    integer :: b, i, pin

    allocate (masses(0))
    do b = 1, size(linkage%bodies)
      associate (body => linkage%bodies(b))
        if (body%line_density > 0.0_wp) masses = [masses, uniform_masses(body, b, elements(b))]
        do i = 1, size(body%lumps) - count(linkage%sliders%body == b .and. &
          linkage%sliders%inertia > 0.0_wp)
          associate (lump => body%lumps(i))
            masses = [masses, mass_t(merge(of_body, on_link, i <= body%own_lumps), b, &
              lump%mass, lump%place, lump%inertia)]
          end associate
        end do
      end associate
    end do
    do pin = 1, size(linkage%pin_mass)
      if (linkage%pin_mass(pin) <= 0.0_wp) cycle
      masses = [masses, mass_t(at_pin, pin, linkage%pin_mass(pin))]
    end do
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%inertia > 0.0_wp) masses = [masses, mass_t(of_block, i, &
        inertia=linkage%sliders(i)%inertia)]
    end do
  end function masses_of

  !> The uniform mass of a link: on its nodes, or as a whole.
  pure function uniform_masses(body, number, elements) result(masses)
    type(body_t), intent(in) :: body
    integer, intent(in) :: number, elements
    type(mass_t), allocatable :: masses(:)

    allocate (masses(elements + 1))
    masses%kind = of_link
    masses%number = number
    if (elements > 0) then
      masses%mass = lumped_masses(body, elements)
      masses%place(1) = lumped_stations(body, elements)
      return
    end if
    ! (2.46) with I_G = m L²/12, and ρI L where rotary inertia is included
    masses(1)%mass = body%line_density*body%length
    masses(1)%place = [0.5_wp*body%length, 0.0_wp]
    masses(1)%inertia = masses(1)%mass*body%length**2/12.0_wp
    masses(1)%rotary_inertia = body%rotary_inertia*body%length
  end function uniform_masses

  !> The two unit acceleration fields as a list of values: of all pins, of the first pin of every
  !! body, the slopes along the bodies, the angular accelerations.
  pure function unit_numbers(linkage, state, numbers) result(unit)
    type(linkage_t), intent(in) :: linkage
    type(state_t), intent(in) :: state
    integer, intent(in) :: numbers !! of values of a field
    real(wp) :: unit(numbers, 2)   !! (values, ω2² = 1 or α2 = 1)

    type(acceleration_field_t) :: fields(2)
    integer :: i

    fields = unit_fields(linkage, state%pose, state%coefficients)
    do i = 1, 2
      unit(:, i) = [fields(i)%at_pin, fields(i)%at_first, fields(i)%slope, fields(i)%angular]
    end do
  end function unit_numbers

  !> Places, accelerations and inertia loads of all masses at a position and speed: Ulker 2010
  !! (2.45), (2.46).
  pure subroutine loads_at_speed(linkage, found, state, number, speed, acceleration, loads)
    type(linkage_t), intent(in) :: linkage      !! of the study
    type(inertia_result_t), intent(in) :: found !! for all positions
    type(state_t), intent(in) :: state          !! with a pose
    integer, intent(in) :: number               !! of this state
    real(wp), intent(in) :: speed               !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration        !! α2 [rad/s²]
    type(mass_load_t), intent(out) :: loads(:) !! (masses)

    real(wp) :: field(size(found%unit, 1))
    integer :: i

    field = speed**2*found%unit(:, 1, number) + acceleration*found%unit(:, 2, number)
    do i = 1, size(found%masses)
      associate (mass => found%masses(i))
        select case (mass%kind)
        case (at_pin)
          call load_at_pin(mass%number, mass%mass, state, field, loads(i))
        case (of_block)
          associate (slider => linkage%sliders(mass%number))
            call load_at_pin(slider%pin, 0.0_wp, state, field, loads(i))
            loads(i)%moment = -slider%inertia*field(2*found%pins + 4*found%bodies + slider%body)
          end associate
        case default
          call load_on_body(linkage, found, mass, state, field, loads(i))
        end select
      end associate
    end do
  end subroutine loads_at_speed

  !> The load of a mass at a pin.
  pure subroutine load_at_pin(pin, mass, state, field, load)
    integer, intent(in) :: pin
    real(wp), intent(in) :: mass
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: field(:) !! values, as in `unit_numbers`
    type(mass_load_t), intent(out) :: load

    load%place = state%pose%pin(:, pin)
    load%acceleration = field(2*pin - 1:2*pin)
    load%force = -mass*load%acceleration
  end subroutine load_at_pin

  !> The load of a mass on a body.
  pure subroutine load_on_body(linkage, found, mass, state, field, load)
    type(linkage_t), intent(in) :: linkage
    type(inertia_result_t), intent(in) :: found
    type(mass_t), intent(in) :: mass
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: field(:) !! values, as in `unit_numbers`
    type(mass_load_t), intent(out) :: load

    real(wp) :: slope(2), angular
    integer :: first, along

    first = 2*found%pins + 2*mass%number - 1
    along = first + 2*found%bodies
    slope = field(along:along + 1)
    angular = field(2*found%pins + 4*found%bodies + mass%number)
    associate (axis => state%pose%direction(:, mass%number), body => linkage%bodies(mass%number))
      load%place = state%pose%pin(:, body%first_pin) + mass%place(1)*axis + &
        mass%place(2)*normal_to(axis)
    end associate
    load%acceleration = field(first:first + 1) + mass%place(1)*slope + &
      mass%place(2)*normal_to(slope)
    load%force = -mass%mass*load%acceleration
    load%moment = -mass%inertia*angular
    if (mass%rotary_inertia > 0.0_wp) load%moment = load%moment - mass%rotary_inertia*angular
  end subroutine load_on_body

end module inertia_study
