!> Rigid links: no unknowns of their own, and a mass that moves with their pins.
module rigid_links
  use kinds, only: wp
  use link_modes, only: link_modes_t, rigid, stations
  use linkages, only: body_t
  use rigid_bodies, only: rigid_body, rigid_body_t
  implicit none (type, external)
  private

  public :: new_rigid_link

contains

  !> A link without deformations of its own, with the mass of its body.
  !!
  !! Its axial force is a single number, the mean over its length, so its only force function is 1.
  pure function new_rigid_link(body) result(link)
    type(body_t), intent(in) :: body !! length and masses
    type(link_modes_t) :: link

    type(rigid_body_t) :: whole

    whole = rigid_body(body, 0)
    link%bends = .false.
    link%length = body%length
    link%rigid_mass = reshape([whole%mass, 0.0_wp, -whole%first_moment(2), &
      0.0_wp, whole%mass, whole%first_moment(1), &
      -whole%first_moment(2), whole%first_moment(1), whole%inertia], [3, 3])
    allocate (link%square(0), link%participation(2, 0), link%axial_square(0), &
      link%axial_participation(2, 0))
    allocate (link%bending(0, 1:0), link%axial(0, 0), link%sag(stations, 2))
    link%sag = 0.0_wp
    allocate (link%geometric(1, 1, 1))
    link%geometric(rigid, rigid, 1) = body%length
  end function new_rigid_link

end module rigid_links
