! src/deformation/pins/ - displacements of the pins by deformations of links, work of loads.
! Border unknowns (elongations of links, rotations of held ends) displace the pins; `chords_t` is
! what they do to links. Begin with `find_chords` here, for a crank and dyads; for any linkage with
! `elastic_position_t` in `elastic_positions.f90` and `find_border_rows` in `border_rows.f90`. Work
! of a load case: `border_work` in `border_loads.f90`; of what acts between two terminals, springs,
! blocks, drives: `terminal_work.f90`.
! Not here: deformations between the pins (`src/deformation/links`), the basis of the border at a
! position (`src/deformation/parts`).

!> Displacements of the pins caused by the elongations of the links and the rotation of the clamped
!! end.
!!
!! Of a crank and dyads whose driven link is clamped. It is statically determinate: the
!! deformations of its links are free coordinates, and the pins follow. A link moves the pins only
!! by its elongation; the driven link also by the rotation of its chord against the clamp. A rigid
!! link moves none.
module pin_displacements
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: cross, linkage_t, normal_to
  use poses, only: arm_to_middle, pose_t
  implicit none (type, external)
  private

  public :: chords_t, find_chords, held_ends, border_numbers, body_displacement

  !> Effect of the border unknowns on the chords of all links. The border unknowns are the clamped
  !! end's rotation, then the elongation of every link that bends.
  type :: chords_t
    real(wp), allocatable :: across(:, :, :) !! (2 + curves, border, bodies) transverse displacement
                                             !! at the first and last pin [m/√J], and 1 for the
                                             !! unknown of each curve of a held end; as many rows as
                                             !! the link with most curves needs
    real(wp), allocatable :: along(:, :, :)  !! (2, border, bodies) axial displacement at the first
                                             !! and last pin [m/√J]
    real(wp), allocatable :: turn(:, :)      !! (border, bodies) rotation of the chord [rad/√J]
    real(wp), allocatable :: pin(:, :, :)    !! (2, pins, border) displacement of the pins [m/√J]
    ! Of linkages that are more than binary links and pins:
    real(wp), allocatable :: rotation(:, :)  !! (rotations, border) [rad/√J]
    real(wp), allocatable :: weighted(:, :)  !! (rows, border) border deformations of parts and
                                             !! springs, in units of a unit unknown; the border's
                                             !! unknowns may turn from position to position, these
                                             !! do not
    integer :: free = 0                      !! the last border unknowns, which deform nothing
  end type chords_t

contains

  !> Ends of bodies that are held, all others being pinned: the first end of the driven body.
  pure function held_ends(bodies) result(held)
    integer, intent(in) :: bodies !! number; the first is driven
    logical :: held(2, bodies)    !! first and last end

    held = .false.
    held(1, 1) = .true.
  end function held_ends

  !> Numbers of the border unknowns; 0 where a rigid link has none.
  pure function border_numbers(linkage) result(number)
    type(linkage_t), intent(in) :: linkage    !! which links bend
    integer :: number(0:size(linkage%bodies)) !! of the clamped end's rotation, then of the
                                              !! elongation of every body

    integer :: b, last

    number = 0
    if (linkage%bodies(1)%bends) number(0) = 1
    last = number(0)
    do b = 1, size(linkage%bodies)
      if (.not. linkage%bodies(b)%bends) cycle
      last = last + 1
      number(b) = last
    end do
  end function border_numbers

  !> Places the driven link's pin, then dyad after dyad. The displacement U of the middle pin
  !! matches the elongations of both bodies, `e_k·(U − U_base k) = δ_k`, hence
  !! `U = (q n1 − p n2)/sin(θ4 − θ3)` with p and q the right-hand sides of bodies 1 and 2.
  pure function find_chords(linkage, links, pose) result(chords)
    type(linkage_t), intent(in) :: linkage     !! bodies and dyads
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(pose_t), intent(in) :: pose           !! away from dead points
    type(chords_t) :: chords

    real(wp) :: e(2, 2), right_side
    integer :: number(0:size(links)), b, i, j, k, border

    number = border_numbers(linkage)
    border = maxval(number)
    allocate (chords%pin(2, size(linkage%is_ground), border))
    chords%pin = 0.0_wp
    associate (driven => linkage%bodies(1))
      if (driven%bends) then
        chords%pin(:, driven%last_pin, number(0)) = &
          -links(1)%curve_rotation(1)*driven%length*normal_to(pose%direction(:, 1))
        chords%pin(:, driven%last_pin, number(1)) = links(1)%elongation*pose%direction(:, 1)
      end if
    end associate
    do i = 1, size(linkage%groups)
      associate (dyad => linkage%groups(i))
        do k = 1, 2
          e(:, k) = arm_to_middle(linkage, dyad, pose, k)
        end do
        do j = 1, border
          do k = 1, 2
            right_side = dot_product(e(:, k), chords%pin(:, dyad%base(k), j))
            if (j == number(dyad%body(k))) right_side = right_side + links(dyad%body(k))%elongation
            chords%pin(:, dyad%middle, j) = chords%pin(:, dyad%middle, j) + merge(-1.0_wp, 1.0_wp, &
              k == 1)*right_side/cross(e(:, 1), e(:, 2))*normal_to(e(:, 3 - k))
          end do
        end do
      end associate
    end do
    allocate (chords%across(3, border, size(links)), chords%along(2, border, size(links)), &
      chords%turn(border, size(links)), chords%rotation(0, border))
    do b = 1, size(links)
      associate (body => linkage%bodies(b), axis => pose%direction(:, b))
        do j = 1, border
          chords%across(1, j, b) = dot_product(normal_to(axis), chords%pin(:, body%first_pin, j))
          chords%across(2, j, b) = dot_product(normal_to(axis), chords%pin(:, body%last_pin, j))
          chords%across(3, j, b) = merge(1.0_wp, 0.0_wp, j == number(0) .and. links(b)%curves > 0)
          chords%along(1, j, b) = dot_product(axis, chords%pin(:, body%first_pin, j))
          chords%along(2, j, b) = dot_product(axis, chords%pin(:, body%last_pin, j))
        end do
        chords%turn(:, b) = (chords%across(2, :, b) - chords%across(1, :, b))/body%length
      end associate
    end do
  end function find_chords

  !> Effect of the border unknowns on a body as a whole: displacement of its first pin along and
  !! across it, and rotation.
  pure function body_displacement(chords, body) result(motion)
    type(chords_t), intent(in) :: chords        !! of a position
    integer, intent(in) :: body                 !! its number
    real(wp) :: motion(3, size(chords%turn, 1)) !! (3, border) [m/√J, m/√J, rad/√J]

    motion(1, :) = chords%along(1, :, body)
    motion(2, :) = chords%across(1, :, body)
    motion(3, :) = chords%turn(:, body)
  end function body_displacement

end module pin_displacements
