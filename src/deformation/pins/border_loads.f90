!> The work that loads do on displacements of the pins and what they do to the links: since the
!! stiffness is the unit matrix, the border unknowns of the static solution.
module border_loads
  use body_lumps, only: lump_offsets
  use deformation_places, only: displacement_row, rotation_row
  use inertia_loads, only: distributed_load, load_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t, linkage_t, normal_to, turned_back
  use load_cases, only: load_case_t
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: border_work, add_link_work, own_work, accelerations_along, has_forces, work_on_bending

contains

  !> Work of a load case on every displacement.
  !!
  !! The accelerations, and so the inertia loads, are linear along the links; torques on links are
  !! carried by their pins.
  pure function border_work(linkage, links, chords, pose, case) result(work)
    type(linkage_t), intent(in) :: linkage         !! masses
    type(link_modes_t), intent(in) :: links(:)     !! (bodies)
    type(chords_t), intent(in) :: chords           !! what the displacements do to pins and links
    type(pose_t), intent(in) :: pose               !! directions of the links
    type(load_case_t), intent(in) :: case          !! acceleration field, forces, torques
    real(wp) :: work(size(chords%turn, 1))         !! (displacements) of unknowns in √J: [√J]

    integer :: b, k

    work = 0.0_wp
    do b = 1, size(links)
      call add_link_work(linkage, links(b), b, chords%across(:, :, b), chords%along(:, :, b), &
        chords%turn(:, b), pose, case, work)
    end do
    do k = 1, size(linkage%pin_mass)
      work = work - linkage%pin_mass(k)*matmul(case%field%at_pin(:, k), chords%pin(:, k, :)) + &
        matmul(case%pin_force(:, k), chords%pin(:, k, :))
    end do
  end function border_work

  !> Adds the work of a load case on a link.
  pure subroutine add_link_work(linkage, link, body, across, along, turn, pose, case, work)
    type(linkage_t), intent(in) :: linkage            !! masses
    type(link_modes_t), intent(in) :: link            !! of any kind
    integer, intent(in) :: body                       !! its number
    real(wp), intent(in) :: across(:, :), along(:, :) !! (functions, displacements) as of `chords_t`
    real(wp), intent(in) :: turn(:)                   !! (displacements)
    type(pose_t), intent(in) :: pose                  !! directions of the links
    type(load_case_t), intent(in) :: case             !! acceleration field, forces, torques
    real(wp), intent(inout) :: work(:)                !! (displacements)

    real(wp) :: at_ends(2), beside(2)
    integer :: n

    work = work + case%couple(body)*turn
    if (.not. link%bends) then
      associate (load => rigid_work(linkage, body, pose, case))
        work = work + (load(1)*along(1, :) + load(2)*across(1, :) + load(3)*turn)
      end associate
      return
    end if
    call accelerations_along(link, body, pose, case, at_ends, beside)
    n = 2 + link%curves
    work = work - matmul(transpose(across(:n, :)), matmul(link%linear(:, 1:2), beside)) - &
      matmul(transpose(along), matmul(link%axial_linear, at_ends))
    if (link%coupled) call add_coupled_loads(link, across(:n, :), along, [beside, at_ends, &
      lump_offsets(linkage%bodies(body))*dot_product(pose%direction(:, body), &
      case%field%slope(:, body))], work)
    if (has_forces(linkage%bodies(body), case)) call add_place_forces(linkage, link, body, across, &
      along, pose, case, work)
  end subroutine add_link_work

  !> Work of a load case on the own modes across a link that bends.
  pure function own_work(linkage, link, body, pose, case) result(work)
    type(linkage_t), intent(in) :: linkage   !! masses
    type(link_modes_t), intent(in) :: link   !! that bends
    integer, intent(in) :: body              !! its number
    type(pose_t), intent(in) :: pose         !! its direction
    type(load_case_t), intent(in) :: case    !! acceleration field, forces
    real(wp) :: work(link%modes)             !! [√J]

    real(wp) :: along(2), across(2), bending(1 - link%curves:link%modes)
    integer :: i

    call accelerations_along(link, body, pose, case, along, across)
    work = -matmul(across, link%participation(1:2, :))
    if (link%coupled) work = work - matmul(along, link%along_participation) - &
      dot_product(pose%direction(:, body), case%field%slope(:, body))* &
      matmul(lump_offsets(linkage%bodies(body)), link%at_mass(:, 3 + link%curves:))
    if (.not. has_forces(linkage%bodies(body), case)) return
    do i = 1, size(linkage%bodies(body)%forced)
      associate (at => linkage%bodies(body)%forced(i))
        bending = work_on_bending(link, at%place, turned_back(case%place_force(:, at%load), &
          pose%direction(:, body)))
        work = work + bending(1:)
      end associate
    end do
  end function own_work

  !> Accelerations of both ends of a link along it and across it.
  pure subroutine accelerations_along(link, body, pose, case, along, across)
    type(link_modes_t), intent(in) :: link          !! its length
    integer, intent(in) :: body                     !! its number
    type(pose_t), intent(in) :: pose                !! its direction
    type(load_case_t), intent(in) :: case           !! acceleration field
    real(wp), intent(out) :: along(2), across(2)    !! (first and last end) [m/s²]

    real(wp) :: at_ends(2, 2)
    integer :: i

    at_ends(:, 1) = case%field%at_first(:, body)
    at_ends(:, 2) = case%field%at_first(:, body) + link%length*case%field%slope(:, body)
    do i = 1, 2
      along(i) = dot_product(pose%direction(:, body), at_ends(:, i))
      across(i) = dot_product(normal_to(pose%direction(:, body)), at_ends(:, i))
    end do
  end subroutine accelerations_along

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
      matmul(transpose(across), matmul(transpose(link%at_mass(:, :size(across, 1))), load(5:)))
  end subroutine add_coupled_loads

  !> Whether forces act at places of a body in a load case.
  pure function has_forces(body, case) result(has)
    type(body_t), intent(in) :: body      !! its places
    type(load_case_t), intent(in) :: case !! its forces
    logical :: has

    has = allocated(body%forced) .and. allocated(case%place_force)
    if (has) has = size(body%forced) > 0
  end function has_forces

  !> Adds the work of forces at places of a link on the border displacements. The work of their
  !! moments about the first pin, as the chord turns, is left out: it is in that of the torques.
  pure subroutine add_place_forces(linkage, link, body, across, along, pose, case, border)
    type(linkage_t), intent(in) :: linkage
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: body
    real(wp), intent(in) :: across(:, :), along(:, :) !! (functions, border)
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp), intent(inout) :: border(:)

    real(wp) :: force(2), xi, bending(1 - link%curves:link%modes)
    integer :: c, i

    do i = 1, size(linkage%bodies(body)%forced)
      associate (at => linkage%bodies(body)%forced(i))
        force = turned_back(case%place_force(:, at%load), pose%direction(:, body))
        border = border + force(1)*along(1, :) + force(2)*across(1, :)
        xi = at%place(1)/link%length
        bending = work_on_bending(link, at%place, force)
        border = border + force(1)*xi*(along(2, :) - along(1, :))
        do c = 1, link%curves
          border = border + bending(c - link%curves)*across(2 + c, :)
        end do
      end associate
    end do
  end subroutine add_place_forces

  !> Work of a force at a place of a link that bends on the curves of its held ends and its own
  !! modes: `F_n v − F_x e θ` with the offset e of the place.
  pure function work_on_bending(link, place, force) result(work)
    type(link_modes_t), intent(in) :: link !! that bends
    real(wp), intent(in) :: place(2) !! [m]
    real(wp), intent(in) :: force(2) !! along the link and across it [N]
    real(wp) :: work(1 - link%curves:link%modes)

    real(wp) :: row(link%bending_shapes%unknowns), xi

    xi = place(1)/link%length
    row = force(2)*displacement_row(link%bending_shapes, xi)
    if (abs(place(2)) > 0.0_wp) row = row - force(1)*place(2)*rotation_row(link%bending_shapes, xi)
    work = matmul(row(:size(link%bending, 1)), link%bending)
  end function work_on_bending

  !> Work of the inertia loads of a rigid link, and of forces beside its pins, on each of the three
  !! motions of `body_displacement` [N, N, N m]. The moments of these forces are among the torques.
  pure function rigid_work(linkage, body, pose, case) result(work)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp) :: work(3)

    type(load_t) :: load

    load = distributed_load(linkage%bodies(body), body, pose, case%field)
    if (allocated(case%body_force)) load%force = load%force + case%body_force(:, body)
    work = [dot_product(pose%direction(:, body), load%force), &
      dot_product(normal_to(pose%direction(:, body)), load%force), load%moment]
  end function rigid_work

end module border_loads
