!> Links as rigid bodies: three numbers are all that inertia can tell of a body that turns and moves
!! in a plane.
module rigid_bodies
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, normal_to
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: rigid_body_t, rigid_body, rigid_bodies_of, mass_centre, central_inertia, &
    total_mass, linkage_mass_centre

  type :: rigid_body_t
    real(wp) :: mass = 0.0_wp            !! [kg]
    real(wp) :: first_moment(2) = 0.0_wp !! mass times place of the mass centre, from the first pin,
                                         !! in the axes of the body [kg m]
    real(wp) :: inertia = 0.0_wp         !! moment of inertia about the first pin [kg m²]
  end type rigid_body_t

contains

  !> Mass, first moment and moment of inertia of a body with all its lumps.
  !!
  !! The uniform part is `m, m L/2, m L²/3`, with rotary inertia `ρI L` more; on the nodes of n
  !! equal elements its moment of inertia about the mass centre is `(m L²/12)(1 + 2/n²)`, and
  !! cross-sections turn nothing.
  pure function rigid_body(body, elements) result(rigid)
    type(body_t), intent(in) :: body
    integer, intent(in) :: elements !! on whose nodes the mass of the link sits; 0: it is
                                    !! distributed along the link
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

  !> The same for all bodies of a linkage.
  pure function rigid_bodies_of(linkage, elements) result(rigid)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:) !! (bodies) as above
    type(rigid_body_t) :: rigid(size(linkage%bodies))

    integer :: b

    do b = 1, size(rigid)
      rigid(b) = rigid_body(linkage%bodies(b), elements(b))
    end do
  end function rigid_bodies_of

  !> Place of the mass centre, from the first pin, in the axes of the body [m]; of a body without
  !! mass the first pin.
  pure function mass_centre(rigid) result(place)
    type(rigid_body_t), intent(in) :: rigid
    real(wp) :: place(2)

    place = 0.0_wp
    if (rigid%mass > 0.0_wp) place = rigid%first_moment/rigid%mass
  end function mass_centre

  !> Moment of inertia about the mass centre [kg m²].
  pure function central_inertia(rigid) result(inertia)
    type(rigid_body_t), intent(in) :: rigid
    real(wp) :: inertia

    inertia = rigid%inertia - dot_product(rigid%first_moment, mass_centre(rigid))
  end function central_inertia

  !> Mass of all that moves [kg].
  pure function total_mass(linkage, rigid) result(mass)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies) of the linkage
    real(wp) :: mass

    mass = sum(rigid%mass) + sum(linkage%pin_mass, mask=.not. linkage%is_ground)
  end function total_mass

  !> Place of the mass centre of a linkage; of one without mass the place of its driven body's pivot
  !! [m].
  pure function linkage_mass_centre(linkage, rigid, pose) result(centre)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies) of the linkage
    type(pose_t), intent(in) :: pose
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
