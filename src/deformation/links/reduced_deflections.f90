!> Static deflection of links in their own modes.
module reduced_deflections
  use body_lumps, only: lump_offsets
  use border_loads, only: accelerations_along, has_forces, work_on_bending
  use deformation_places, only: displacement_row
  use kinds, only: wp
  use link_modes, only: link_modes_t, stations
  use linkages, only: linkage_t, turned_back
  use load_cases, only: load_case_t
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: reduced_deflection

contains

  !> Static displacements along and across every link, at its stations, under the loads of a load
  !! case: those of the border, and of every link between its held ends.
  pure subroutine reduced_deflection(linkage, links, chords, pose, case, border, displacement)
    type(linkage_t), intent(in) :: linkage         !! masses
    type(link_modes_t), intent(in) :: links(:)     !! (bodies)
    type(chords_t), intent(in) :: chords           !! of this position
    type(pose_t), intent(in) :: pose               !! directions of the links
    type(load_case_t), intent(in) :: case          !! acceleration field, forces
    real(wp), intent(in) :: border(:)              !! (border) static solution: `border_work` [√J]
    real(wp), intent(out) :: displacement(:, :, :) !! (along and across, stations, bodies) [m]

    real(wp), allocatable :: load(:)
    real(wp) :: along(2), across(2), ends(size(chords%across, 1)), axial_ends(2), xi
    integer :: b, i

    do b = 1, size(links)
      ends = matmul(chords%across(:, :, b), border)
      axial_ends = matmul(chords%along(:, :, b), border)
      call accelerations_along(links(b), b, pose, case, along, across)
      load = across
      if (links(b)%coupled) load = [across, along, lump_offsets(linkage%bodies(b))* &
        dot_product(pose%direction(:, b), case%field%slope(:, b))]
      do i = 1, stations
        xi = real(i - 1, wp)/(stations - 1)
        displacement(1, i, b) = (1.0_wp - xi)*axial_ends(1) + xi*axial_ends(2)
        displacement(2, i, b) = (1.0_wp - xi)*ends(1) + xi*ends(2)
        if (.not. links(b)%bends) cycle
        displacement(2, i, b) = displacement(2, i, b) + dot_product(links(b)%curve_station(i, :), &
          ends(3:2 + links(b)%curves)) - dot_product(links(b)%sag(i, :), load)
      end do
      if (links(b)%bends .and. has_forces(linkage%bodies(b), case)) call add_sag_under_forces( &
        linkage, links(b), b, pose, case, displacement(2, :, b))
    end do
  end subroutine reduced_deflection

  !> Adds the deflection of a held link under the forces at its places.
  pure subroutine add_sag_under_forces(linkage, link, body, pose, case, across)
    type(linkage_t), intent(in) :: linkage
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: body
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp), intent(inout) :: across(:) !! (stations) [m]

    real(wp) :: work(1 - link%curves:link%modes), row(link%bending_shapes%unknowns), force(2), &
      along(link%axial_shapes%unknowns)
    integer :: i, kept

    work = 0.0_wp
    do i = 1, size(linkage%bodies(body)%forced)
      associate (at => linkage%bodies(body)%forced(i))
        force = turned_back(case%place_force(:, at%load), pose%direction(:, body))
        work = work + work_on_bending(link, at%place, force)
        if (.not. link%coupled) cycle
        along = displacement_row(link%axial_shapes, at%place(1)/link%length)
        work(1:) = work(1:) + force(1)*matmul(along(:size(link%axial, 1)), link%axial)
      end associate
    end do
    kept = size(link%bending, 1)
    do i = 1, size(across)
      row = displacement_row(link%bending_shapes, real(i - 1, wp)/(size(across) - 1))
      across(i) = across(i) + dot_product(matmul(row(:kept), link%bending(:, 1:)), work(1:))
    end do
  end subroutine add_sag_under_forces

end module reduced_deflections
