!> Mass and geometric stiffness of a linkage in the own modes of its links.
!!
!! Unknowns: the border (the rotations of held ends and the elongations of the links), then the
!! transverse own modes link by link (the blocks), then the axial own modes. The elastic stiffness
!! is the unit matrix in all of them. A rigid link has no unknowns.
module reduced_assembly
  use bordered_matrix, only: bordered_matrix_t, layout_t, new_bordered_layout
  use kinds, only: wp
  use link_modes, only: link_modes_t, rigid
  use linkages, only: linkage_t
  use pin_displacements, only: body_displacement, border_numbers, chords_t
  implicit none (type, external)
  private

  public :: reduced_layout, reduced_mass, reduced_geometric_stiffness, first_axial
  public :: add_link_mass, add_link_stiffness

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
      motion(3, layout%border)
    integer :: b, k, n, first, last, axial

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
      first = layout%first(b)
      last = first + links(b)%modes - 1
      mass%diagonal(first:last) = links(b)%square
      axial = first_axial(layout, links, b)
      mass%diagonal(axial:axial + links(b)%axial_modes - 1) = links(b)%axial_square
      call add_link_mass(links(b), across(:n, :), along, mass%border, &
        mass%coupling(:, first:last), mass%coupling(:, axial:axial + links(b)%axial_modes - 1))
    end do
    do b = 1, size(linkage%pin_mass)
      if (linkage%pin_mass(b) <= 0.0_wp) cycle
      do k = 1, layout%border
        mass%border(:, k) = mass%border(:, k) + linkage%pin_mass(b)* &
          (chords%pin(1, b, :)*chords%pin(1, b, k) + chords%pin(2, b, :)*chords%pin(2, b, k))
      end do
    end do
  end subroutine reduced_mass

  !> The mass of a link that bends, between displacements that move it and its own modes.
  pure subroutine add_link_mass(link, across, along, border, coupling, axial_coupling)
    type(link_modes_t), intent(in) :: link       !! that bends
    real(wp), intent(in) :: across(:, :), along(:, :) !! (functions, displacements) as of `chords_t`
    real(wp), intent(inout) :: border(:, :)      !! (displacements, displacements) grows
    real(wp), intent(inout) :: coupling(:, :)    !! (displacements, modes) is set
    real(wp), intent(inout) :: axial_coupling(:, :) !! (displacements, axial modes) is set

    integer :: i, j, k

    border = border + form_of(link%linear, across) + form_of(link%axial_linear, along)
    do k = 1, link%modes
      do i = 1, size(border, 1)
        coupling(i, k) = across(1, i)*link%participation(1, k) + &
          across(2, i)*link%participation(2, k)
      end do
      do j = 3, size(across, 1)
        coupling(:, k) = coupling(:, k) + across(j, :)*link%participation(j, k)
      end do
    end do
    if (link%coupled) call add_coupled_mass(link, across, along, border, coupling)
    do k = 1, link%axial_modes
      do i = 1, size(border, 1)
        axial_coupling(i, k) = along(1, i)*link%axial_participation(1, k) + &
          along(2, i)*link%axial_participation(2, k)
      end do
    end do
  end subroutine add_link_mass

  !> `FᵀAF` of a symmetric matrix A.
  pure function form_of(matrix, functions) result(form)
    real(wp), intent(in) :: matrix(:, :)    !! (functions, functions)
    real(wp), intent(in) :: functions(:, :) !! (functions or more, border)
    real(wp) :: form(size(functions, 2), size(functions, 2))

    real(wp) :: product(size(matrix, 1))
    integer :: i, j, k, n

    n = size(matrix, 1)
    do j = 1, size(functions, 2)
      do k = 1, n
        product(k) = dot_product(matrix(:, k), functions(:n, j))
      end do
      do i = 1, size(functions, 2)
        form(i, j) = dot_product(functions(:n, i), product)
      end do
    end do
  end function form_of

  !> Adds what couples the motions of a link across and along: masses beside its axis.
  pure subroutine add_coupled_mass(link, across, along, border, coupling)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: across(:, :), along(:, :)
    real(wp), intent(inout) :: border(:, :), coupling(:, :)

    real(wp) :: cross(size(across, 2), size(across, 2))
    integer :: i, k

    cross = matmul(transpose(across), matmul(link%cross_linear, along))
    border = border + cross + transpose(cross)
    do k = 1, link%modes
      do i = 1, size(across, 2)
        coupling(i, k) = coupling(i, k) + along(1, i)*link%along_participation(1, k) + &
          along(2, i)*link%along_participation(2, k)
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

    integer :: b, first

    stiffness%border = 0.0_wp
    do b = 1, size(links)
      first = layout%first(b)
      call add_link_stiffness(links(b), chords%turn(:, b), chords%across(3:, :, b), force(:, b), &
        stiffness%border, stiffness%coupling(:, first:first + links(b)%modes - 1), &
        stiffness%block(:, :, b))
    end do
  end subroutine reduced_geometric_stiffness

  !> `K_G = ∫ N v'² dx` of a link, between displacements that turn it and its own modes.
  pure subroutine add_link_stiffness(link, turn, curve, force, border, coupling, block)
    type(link_modes_t), intent(in) :: link    !! of any kind
    real(wp), intent(in) :: turn(:)           !! (displacements) what they turn its chord
    real(wp), intent(in) :: curve(:, :)       !! (curves or more, displacements)
    real(wp), intent(in) :: force(:)          !! (force functions) coefficients, tension positive
                                              !! [N]
    real(wp), intent(inout) :: border(:, :)   !! (displacements, displacements) grows
    real(wp), intent(inout) :: coupling(:, :) !! (displacements, modes) is set
    real(wp), intent(inout) :: block(:, :)    !! (modes or more, modes or more) is set

    real(wp) :: slopes(rigid + link%curves + link%modes, rigid + link%curves + link%modes), &
      added(size(turn))
    integer :: c, i, j, k, m, n

    m = link%modes
    slopes = force(1)*link%geometric(:, :, 1)
    do j = 2, size(link%geometric, 3)
      slopes = slopes + force(j)*link%geometric(:, :, j)
    end do
    n = rigid + link%curves
    do k = 1, m
      block(:m, k) = slopes(n + 1:, n + k)
      do i = 1, size(turn)
        coupling(i, k) = turn(i)*slopes(rigid, n + k)
      end do
      do c = 1, link%curves
        do i = 1, size(turn)
          coupling(i, k) = coupling(i, k) + curve(c, i)*slopes(rigid + c, n + k)
        end do
      end do
    end do
    do i = 1, size(turn)
      added = border(:, i) + moment_on(rigid)*turn
      do c = 1, link%curves
        added = added + moment_on(rigid + c)*curve(c, :)
      end do
      border(:, i) = added
    end do

  contains

    !> What a unit of displacement i does to the chord or a curve.
    pure function moment_on(row) result(moment)
      integer, intent(in) :: row
      real(wp) :: moment

      integer :: j

      moment = turn(i)*slopes(rigid, row)
      do j = 1, link%curves
        moment = moment + curve(j, i)*slopes(rigid + j, row)
      end do
    end function moment_on

  end subroutine add_link_stiffness

end module reduced_assembly
