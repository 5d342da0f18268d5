!> Links as rigid bodies: three numbers describe the inertia of a body that moves in a plane.
module rigid_bodies
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, normal_to
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: rigid_body_t, rigid_body, rigid_bodies_of, mass_centre, central_inertia, &
    total_mass, linkage_mass_centre

  !> Inertia of a body in plane motion.
  type :: rigid_body_t
    real(wp) :: mass = 0.0_wp            !! [kg]
    real(wp) :: first_moment(2) = 0.0_wp !! mass × position of the mass centre, from the first pin,
                                         !! in the axes of the body [kg m]
    real(wp) :: inertia = 0.0_wp         !! moment of inertia about the first pin [kg m²]
  end type rigid_body_t

contains

  !> Mass, first moment and moment of inertia of a body with all its lumps.
  !!
  !! The uniform part has `m, m L/2, m L²/3`, plus `ρI L` with rotary inertia. Lumped on the nodes
  !! of n equal elements, its moment of inertia about the mass centre is `(m L²/12)(1 + 2/n²)`, and
  !! rotary inertia is left out.
  pure function rigid_body(body, elements) result(rigid)
    type(body_t), intent(in) :: body !! with its lumps
    integer, intent(in) :: elements  !! whose nodes carry the mass of the link; 0: distributed mass
    type(rigid_body_t) :: rigid

    integer :: i

    rigid%mass = body%line_density*body%length
    rigid%first_moment = [0.5_wp*rigid%mass*body%length, 0.0_wp]
    rigid%inertia = rigid%mass*body%length**2/3.0_wp
    if (elements > 0) then
      rigid%inertia = rigid%inertia + rigid%mass*body%length**2/(6.0_wp*real(elements, wp)**2)
    else
      rigid%inertia = rigid%inertia + body%rotary_inertia*body%length
    end if
    if (.not. allocated(body%lumps)) return
    do i = 1, size(body%lumps)
      associate (lump => body%lumps(i))
        rigid%mass = rigid%mass + lump%mass
        rigid%first_moment = rigid%first_moment + lump%mass*lump%place
        rigid%inertia = rigid%inertia + lump%mass*sum(lump%place**2) + lump%inertia
      end associate
    end do
  end function rigid_body

  !> All bodies of a linkage as rigid bodies.
  pure function rigid_bodies_of(linkage, elements) result(rigid)
    type(linkage_t), intent(in) :: linkage !! its bodies
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    type(rigid_body_t) :: rigid(size(linkage%bodies))

    integer :: b

    do b = 1, size(rigid)
      rigid(b) = rigid_body(linkage%bodies(b), elements(b))
    end do
  end function rigid_bodies_of

  !> Mass centre in the axes of the body, from its first pin [m]; for a body without mass the first
  !! pin.
  pure function mass_centre(rigid) result(place)
    type(rigid_body_t), intent(in) :: rigid !! with or without mass
    real(wp) :: place(2)

    place = 0.0_wp
    if (rigid%mass > 0.0_wp) place = rigid%first_moment/rigid%mass
  end function mass_centre

  !> Moment of inertia about the mass centre [kg m²].
  pure function central_inertia(rigid) result(inertia)
    type(rigid_body_t), intent(in) :: rigid !! with or without mass
    real(wp) :: inertia

    inertia = rigid%inertia - dot_product(rigid%first_moment, mass_centre(rigid))
  end function central_inertia

  !> Mass of everything that moves: bodies with their lumps, and moving pins [kg].
  pure function total_mass(linkage, rigid) result(mass)
    type(linkage_t), intent(in) :: linkage     !! its pin masses
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies) of the linkage
    real(wp) :: mass

    mass = sum(rigid%mass) + sum(linkage%pin_mass, mask=.not. linkage%is_ground)
  end function total_mass

  !> Mass centre of a linkage in global axes; without mass the pivot of the driven body [m].
  pure function linkage_mass_centre(linkage, rigid, pose) result(centre)
    type(linkage_t), intent(in) :: linkage     !! bodies and pin masses
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies) of the linkage
    type(pose_t), intent(in) :: pose           !! positions and directions
    real(wp) :: centre(2)

    real(wp) :: mass
    integer :: i

    mass = total_mass(linkage, rigid)
    centre = pose%pin(:, linkage%bodies(1)%first_pin)
    if (mass <= 0.0_wp) return
    centre = 0.0_wp
    do i = 1, size(rigid)
      associate (body => linkage%bodies(i), axis => pose%direction(:, i))
        centre = centre + rigid(i)%mass*pose%pin(:, body%first_pin) + &
          rigid(i)%first_moment(1)*axis + rigid(i)%first_moment(2)*normal_to(axis)
      end associate
    end do
    do i = 1, size(linkage%pin_mass)
      if (.not. linkage%is_ground(i)) centre = centre + linkage%pin_mass(i)*pose%pin(:, i)
    end do
    centre = centre/mass
  end function linkage_mass_centre

end module rigid_bodies
