!> Mass and geometric stiffness of a linkage in the own modes of its links.
!!
!! Unknowns: the border (the rotations of held ends and the elongations of the links), then the
!! transverse own modes link by link (the blocks), then the axial own modes. The elastic stiffness
!! is the unit matrix in all of them. A rigid link has no unknowns.
module reduced_assembly
  use body_lumps, only: lump_offsets
  use bordered_matrix, only: bordered_matrix_t, layout_t, new_bordered_layout
  use deformation_places, only: displacement_row, rotation_row
  use inertia_loads, only: distributed_load, load_t
  use kinds, only: wp
  use link_modes, only: link_modes_t, rigid, stations
  use linkages, only: body_t, linkage_t, normal_to, turned_back
  use load_cases, only: load_case_t
  use pin_displacements, only: body_displacement, border_numbers, chords_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: reduced_layout, reduced_mass, reduced_geometric_stiffness, reduced_deflection, &
    first_axial

contains

  !> Numbers of the unknowns: border, blocks of transverse modes, axial modes.
  pure function reduced_layout(linkage, links) result(layout)
    type(linkage_t), intent(in) :: linkage     !! which links bend
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(layout_t) :: layout

    layout = new_bordered_layout(maxval(border_numbers(linkage)), links%modes, links%axial_modes)
  end function reduced_layout

  !> Number of the first axial unknown of a body.
  pure function first_axial(layout, links, body) result(first)
    type(layout_t), intent(in) :: layout       !! of these links
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    integer, intent(in) :: body                !! its number
    integer :: first

    first = layout%unknowns - sum(links(body:)%axial_modes) + 1
  end function first_axial

  !> `M = SᵀmS`: diagonal between the own modes, with a border for the motion that the pins impose
  !! on the links.
  pure subroutine reduced_mass(linkage, links, layout, chords, mass)
    type(linkage_t), intent(in) :: linkage         !! pin masses
    type(link_modes_t), intent(in) :: links(:)     !! (bodies)
    type(layout_t), intent(in) :: layout           !! of these links
    type(chords_t), intent(in) :: chords           !! of this position
    type(bordered_matrix_t), intent(inout) :: mass !! of this layout, without blocks [s²]

    real(wp) :: across(size(chords%across, 1), layout%border), along(2, layout%border), &
      motion(3, layout%border), moved
    integer :: b, i, j, k, n, first

    mass%border = 0.0_wp
    do b = 1, size(links)
      if (.not. links(b)%bends) then
        motion = body_displacement(chords, b)
        mass%border = mass%border + matmul(transpose(motion), matmul(links(b)%rigid_mass, motion))
        cycle
      end if
      n = 2 + links(b)%curves
      across = chords%across(:, :, b)
      along = chords%along(:, :, b)
      mass%border = mass%border + form_of(links(b)%linear, across(:n, :)) + &
        matmul(transpose(along), matmul(links(b)%axial_linear, along))
      first = layout%first(b) - 1
      do k = 1, links(b)%modes
        mass%diagonal(first + k) = links(b)%square(k)
        do i = 1, layout%border
          moved = across(1, i)*links(b)%participation(1, k) + &
            across(2, i)*links(b)%participation(2, k)
          do j = 3, n
            moved = moved + across(j, i)*links(b)%participation(j, k)
          end do
          mass%coupling(i, first + k) = moved
        end do
      end do
      if (links(b)%coupled) call add_coupled_mass(links(b), across(:n, :), along, first, mass)
      first = first_axial(layout, links, b) - 1
      do k = 1, links(b)%axial_modes
        mass%diagonal(first + k) = links(b)%axial_square(k)
        do i = 1, layout%border
          mass%coupling(i, first + k) = along(1, i)*links(b)%axial_participation(1, k) + &
            along(2, i)*links(b)%axial_participation(2, k)
        end do
      end do
    end do
    do b = 1, size(linkage%pin_mass)
      if (linkage%pin_mass(b) <= 0.0_wp) cycle
      do k = 1, layout%border
        mass%border(:, k) = mass%border(:, k) + linkage%pin_mass(b)* &
          (chords%pin(1, b, :)*chords%pin(1, b, k) + chords%pin(2, b, :)*chords%pin(2, b, k))
      end do
    end do
  end subroutine reduced_mass

  !> `FᵀAF` of a symmetric matrix A.
  pure function form_of(matrix, functions) result(form)
    real(wp), intent(in) :: matrix(:, :)    !! (functions, functions)
    real(wp), intent(in) :: functions(:, :) !! (functions, border)
    real(wp) :: form(size(functions, 2), size(functions, 2))

    real(wp) :: product(size(functions, 1))
    integer :: i, j, k

    do j = 1, size(functions, 2)
      do k = 1, size(functions, 1)
        product(k) = dot_product(matrix(:, k), functions(:, j))
      end do
      do i = 1, size(functions, 2)
        form(i, j) = dot_product(functions(:, i), product)
      end do
    end do
  end function form_of

  !> Adds what couples the motions of a link across and along: masses beside its axis.
  pure subroutine add_coupled_mass(link, across, along, first, mass)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: across(:, :), along(:, :) !! (functions, border)
    integer, intent(in) :: first                      !! number of its first unknown, minus one
    type(bordered_matrix_t), intent(inout) :: mass

    real(wp) :: cross(size(across, 2), size(across, 2))
    integer :: i, k

    cross = matmul(transpose(across), matmul(link%cross_linear, along))
    mass%border = mass%border + cross + transpose(cross)
    do k = 1, link%modes
      do i = 1, size(across, 2)
        mass%coupling(i, first + k) = mass%coupling(i, first + k) + &
          along(1, i)*link%along_participation(1, k) + along(2, i)*link%along_participation(2, k)
      end do
    end do
  end subroutine add_coupled_mass

  !> `K_G = ∫ N v'² dx` of all links: full blocks between own modes, and a border for the rotation
  !! of the chords and the curves of held ends.
  pure subroutine reduced_geometric_stiffness(links, layout, chords, force, stiffness)
    type(link_modes_t), intent(in) :: links(:)          !! (bodies)
    type(layout_t), intent(in) :: layout                !! of these links
    type(chords_t), intent(in) :: chords                !! of this position
    real(wp), intent(in) :: force(:, :)                 !! (force functions, bodies) coefficients,
                                                        !! tension positive [N]
    type(bordered_matrix_t), intent(inout) :: stiffness !! of this layout, with blocks [-]

    real(wp), allocatable :: slopes(:, :)
    real(wp) :: added(layout%border)
    integer :: b, c, i, j, k, m, n, first

    stiffness%border = 0.0_wp
    do b = 1, size(links)
      m = links(b)%modes
      slopes = force(1, b)*links(b)%geometric(:, :, 1)
      do j = 2, size(links(b)%geometric, 3)
        slopes = slopes + force(j, b)*links(b)%geometric(:, :, j)
      end do
      first = layout%first(b) - 1
      n = rigid + links(b)%curves
      do k = 1, m
        stiffness%block(:m, k, b) = slopes(n + 1:, n + k)
        do i = 1, layout%border
          stiffness%coupling(i, first + k) = chords%turn(i, b)*slopes(rigid, n + k)
        end do
        do c = 1, links(b)%curves
          do i = 1, layout%border
            stiffness%coupling(i, first + k) = stiffness%coupling(i, first + k) + &
              chords%across(2 + c, i, b)*slopes(rigid + c, n + k)
          end do
        end do
      end do
      do i = 1, layout%border
        added = stiffness%border(:, i) + moment_on(rigid)*chords%turn(:, b)
        do c = 1, links(b)%curves
          added = added + moment_on(rigid + c)*chords%across(2 + c, :, b)
        end do
        stiffness%border(:, i) = added
      end do
    end do

  contains

    !> What a unit of border unknown i does to the chord or a curve of body b.
    pure function moment_on(row) result(moment)
      integer, intent(in) :: row
      real(wp) :: moment

      integer :: j

      moment = chords%turn(i, b)*slopes(rigid, row)
      do j = 1, links(b)%curves
        moment = moment + chords%across(2 + j, i, b)*slopes(rigid + j, row)
      end do
    end function moment_on

  end subroutine reduced_geometric_stiffness

  !> Static displacements along and across every link, at its stations, under the loads of a load
  !! case.
  !!
  !! The accelerations, and so the inertia loads, are linear along the links; torques on links are
  !! carried by their pins. Since the stiffness is the unit matrix, every unknown equals the work of
  !! the loads on its own shape.
  pure subroutine reduced_deflection(linkage, links, layout, chords, pose, case, displacement)
    type(linkage_t), intent(in) :: linkage         !! masses
    type(link_modes_t), intent(in) :: links(:)     !! (bodies)
    type(layout_t), intent(in) :: layout           !! of these links
    type(chords_t), intent(in) :: chords           !! of this position
    type(pose_t), intent(in) :: pose               !! directions of the links
    type(load_case_t), intent(in) :: case          !! acceleration field, forces, torques
    real(wp), intent(out) :: displacement(:, :, :) !! (along and across, stations, bodies) [m]

    real(wp) :: border(layout%border), load(load_count(links), size(links)), along(2), &
      at_ends(2, 2), ends(size(chords%across, 1)), axial_ends(2), xi
    integer :: b, i, k, n

    border = 0.0_wp
    load = 0.0_wp
    do b = 1, size(links)
      border = border + case%couple(b)*chords%turn(:, b)
      at_ends(:, 1) = case%field%at_first(:, b)
      at_ends(:, 2) = case%field%at_first(:, b) + links(b)%length*case%field%slope(:, b)
      do i = 1, 2
        along(i) = dot_product(pose%direction(:, b), at_ends(:, i))
        load(i, b) = dot_product(normal_to(pose%direction(:, b)), at_ends(:, i))
      end do
      if (links(b)%bends) then
        n = 2 + links(b)%curves
        border = border - matmul(transpose(chords%across(:n, :, b)), &
          matmul(links(b)%linear(:, 1:2), load(:2, b))) - &
          matmul(transpose(chords%along(:, :, b)), matmul(links(b)%axial_linear, along))
        if (links(b)%coupled) then
          load(3:4, b) = along
          k = size(links(b)%at_mass, 1)
          load(5:4 + k, b) = lump_offsets(linkage%bodies(b))*dot_product(pose%direction(:, b), &
            case%field%slope(:, b))
          call add_coupled_loads(links(b), chords%across(:n, :, b), chords%along(:, :, b), &
            load(:4 + k, b), border)
        end if
      else
        border = border + matmul(rigid_work(linkage, b, pose, case), body_displacement(chords, b))
      end if
      if (has_forces(linkage%bodies(b), case)) call add_place_forces(linkage, links(b), b, chords, &
        pose, case, border)
    end do
    do k = 1, size(linkage%pin_mass)
      border = border - linkage%pin_mass(k)*matmul(case%field%at_pin(:, k), chords%pin(:, k, :)) + &
        matmul(case%pin_force(:, k), chords%pin(:, k, :))
    end do
    do b = 1, size(links)
      ends = matmul(chords%across(:, :, b), border)
      axial_ends = matmul(chords%along(:, :, b), border)
      do i = 1, stations
        xi = real(i - 1, wp)/(stations - 1)
        displacement(1, i, b) = (1.0_wp - xi)*axial_ends(1) + xi*axial_ends(2)
        displacement(2, i, b) = (1.0_wp - xi)*ends(1) + xi*ends(2)
        if (.not. links(b)%bends) cycle
        displacement(2, i, b) = displacement(2, i, b) + dot_product(links(b)%curve_station(i, :), &
          ends(3:2 + links(b)%curves)) - dot_product(links(b)%sag(i, :), load(:size(links(b)%sag, &
          2), b))
      end do
      if (links(b)%bends .and. has_forces(linkage%bodies(b), case)) call add_sag_under_forces( &
        linkage, links(b), b, pose, case, displacement(2, :, b))
    end do
  end subroutine reduced_deflection

  !> Most loads of any link of which its static deflection is made.
  pure function load_count(links) result(most)
    type(link_modes_t), intent(in) :: links(:)
    integer :: most

    integer :: b

    most = 2
    do b = 1, size(links)
      most = max(most, size(links(b)%sag, 2))
    end do
  end function load_count

  !> Adds the work that the inertia loads of masses beside the axis of a link do on the border.
  !!
  !! The accelerations of the axis, as displacements, move such a mass but for the centripetal part
  !! of the offset, `−ω² e` across the link.
  pure subroutine add_coupled_loads(link, across, along, load, border)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: across(:, :), along(:, :) !! (functions, border)
    real(wp), intent(in) :: load(:) !! accelerations of both ends across and along, then that part
    real(wp), intent(inout) :: border(:)

    border = border - matmul(transpose(across), matmul(link%cross_linear, load(3:4))) - &
      matmul(transpose(along), matmul(transpose(link%cross_linear(1:2, :)), load(1:2))) - &
      matmul(transpose(across), matmul(transpose(link%at_mass), load(5:)))
  end subroutine add_coupled_loads

  !> Whether forces act at places of a body in a load case.
  pure function has_forces(body, case) result(has)
    type(body_t), intent(in) :: body
    type(load_case_t), intent(in) :: case
    logical :: has

    has = allocated(body%forced) .and. allocated(case%place_force)
    if (has) has = size(body%forced) > 0
  end function has_forces

  !> Adds the work that forces at places of a link do on the border, beside that of their moments
  !! about its first pin as the chord turns, which is among the torques.
  pure subroutine add_place_forces(linkage, link, body, chords, pose, case, border)
    type(linkage_t), intent(in) :: linkage
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: body
    type(chords_t), intent(in) :: chords
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp), intent(inout) :: border(:)

    real(wp) :: force(2), xi, bending(1 - link%curves:link%modes)
    integer :: c, i

    do i = 1, size(linkage%bodies(body)%forced)
      associate (at => linkage%bodies(body)%forced(i))
        force = turned_back(case%place_force(:, at%load), pose%direction(:, body))
        border = border + force(1)*chords%along(1, :, body) + force(2)*chords%across(1, :, body)
        if (.not. link%bends) cycle
        xi = at%place(1)/link%length
        bending = work_on_bending(link, at%place, force)
        border = border + force(1)*xi*(chords%along(2, :, body) - chords%along(1, :, body))
        do c = 1, link%curves
          border = border + bending(c - link%curves)*chords%across(2 + c, :, body)
        end do
      end associate
    end do
  end subroutine add_place_forces

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

  !> Work of a force at a place of a link that bends on the curves of its held ends and its own
  !! modes: `F_n v − F_x e θ` with the offset e of the place.
  pure function work_on_bending(link, place, force) result(work)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: place(2) !! [m]
    real(wp), intent(in) :: force(2) !! along the link and across it [N]
    real(wp) :: work(1 - link%curves:link%modes)

    real(wp) :: row(link%bending_shapes%unknowns), xi

    xi = place(1)/link%length
    row = force(2)*displacement_row(link%bending_shapes, xi)
    if (abs(place(2)) > 0.0_wp) row = row - force(1)*place(2)*rotation_row(link%bending_shapes, xi)
    work = matmul(row(:size(link%bending, 1)), link%bending)
  end function work_on_bending

  !> Work of the inertia loads of a rigid link on each of the three motions of `body_displacement`
  !! [N, N, N m].
  pure function rigid_work(linkage, body, pose, case) result(work)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp) :: work(3)

    type(load_t) :: load

    load = distributed_load(linkage%bodies(body), body, pose, case%field)
    work = [dot_product(pose%direction(:, body), load%force), &
      dot_product(normal_to(pose%direction(:, body)), load%force), load%moment]
  end function rigid_work

end module reduced_assembly
