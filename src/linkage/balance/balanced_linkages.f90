! src/linkage/balance/ - counterweights, balance shafts, and shaking forces over a cycle.
! In: a linkage without counterweights. Out: a `counterweight_t` for each body; `balanced_linkage`
! fixes them to it. Begin with `find_hung_counterweights` in `hung_counterweights.f90`, which cancel
! the shaking force; `find_parts` in `crank_cycle.f90` has shaking force, shaking moment and torque.
! Not here: counterweights of four-bars (`src/linkage/four_bar`), least squares over a turn
! (`src/studies/balance`).

!> Counterweights: masses fixed to links, each about one of its pins.
module balanced_linkages
  use constants, only: pi
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, lump_t, turned
  use pose_types, only: place_of_pin
  implicit none (type, external)
  private

  public :: counterweight_t, counterweight_make_t, counterweight_lump, balanced_linkage, &
    radius_of, own_inertia, disc_diameter

  !> A counterweight on a link, about one of its pins.
  type :: counterweight_t
    integer :: body = 0                  !! number in the linkage
    real(wp) :: first_moment(2) = 0.0_wp !! mass × position from the pin: along the way to the other
                                         !! pin, and to its left [kg m]
    logical :: needed = .false.          !! false if only rounding is left
    integer :: pin = 0                   !! about which it balances: a ground pivot, or the pin
                                         !! through which the link hangs on others
    integer :: towards = 0               !! another pin of the link
    real(wp) :: radius = 0.0_wp          !! of its mass centre from the pin; 0: the link's length
                                         !! [m]
    real(wp) :: inertia = 0.0_wp         !! moment of inertia about its mass centre [kg m²]
  end type counterweight_t

  !> Of what a counterweight is made: a disc, if it has a density, else a body of any shape; a point
  !! without a moment of inertia of its own.
  type :: counterweight_make_t
    real(wp) :: density = 0.0_wp         !! of the disc [kg/m³]; 0: no disc
    real(wp) :: thickness = 0.0_wp       !! of the disc, normal to the plane of motion [m]
    real(wp) :: inertia = 0.0_wp         !! of a body about its mass centre, whatever its mass
                                         !! [kg m²]
  end type counterweight_make_t

contains

  !> Moment of inertia of a counterweight about its mass centre: that given, or of the disc `m R²/2`
  !! with `m = ρ π R² t` [kg m²].
  pure function own_inertia(make, mass) result(inertia)
    type(counterweight_make_t), intent(in) :: make
    real(wp), intent(in) :: mass         !! of the counterweight [kg]
    real(wp) :: inertia

    inertia = make%inertia
    if (make%density > 0.0_wp) inertia = mass*disc_diameter(make, mass)**2/8.0_wp
  end function own_inertia

  !> Diameter of a counterweight that is a disc [m].
  pure function disc_diameter(make, mass) result(diameter)
    type(counterweight_make_t), intent(in) :: make !! with a density
    real(wp), intent(in) :: mass                   !! of the counterweight [kg]
    real(wp) :: diameter

    diameter = 2.0_wp*sqrt(mass/(pi*make%density*make%thickness))
  end function disc_diameter

  !> The distance of a counterweight's mass centre from its pin [m].
  pure function radius_of(weight, body) result(radius)
    type(counterweight_t), intent(in) :: weight !! with or without a radius of its own
    type(body_t), intent(in) :: body            !! that carries it
    real(wp) :: radius

    radius = weight%radius
    if (.not. radius > 0.0_wp) radius = body%length
  end function radius_of

  !> A counterweight as a mass at a distance from its pin, in the axes of its body.
  pure function counterweight_lump(weight, body, radius) result(lump)
    type(counterweight_t), intent(in) :: weight !! one that is needed
    type(body_t), intent(in) :: body            !! that carries it
    real(wp), intent(in) :: radius              !! from the pin [m]
    type(lump_t) :: lump

    real(wp) :: from(2), way(2)

    from = place_of_pin(body, weight%pin)
    way = place_of_pin(body, weight%towards) - from
    lump%mass = norm2(weight%first_moment)/radius
    lump%place = from + turned(weight%first_moment*(radius/norm2(weight%first_moment)), &
      way/norm2(way))
    lump%inertia = weight%inertia
  end function counterweight_lump

  !> The linkage with its counterweights.
  pure function balanced_linkage(linkage, weights) result(balanced)
    type(linkage_t), intent(in) :: linkage          !! without them
    type(counterweight_t), intent(in) :: weights(:) !! on different links
    type(linkage_t) :: balanced

    integer :: i

    balanced = linkage
    do i = 1, size(weights)
      if (.not. weights(i)%needed) cycle
      associate (body => balanced%bodies(weights(i)%body))
        body%lumps = [body%lumps, counterweight_lump(weights(i), body, radius_of(weights(i), body))]
      end associate
    end do
  end function balanced_linkage

end module balanced_linkages
