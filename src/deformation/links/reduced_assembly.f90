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
      mass%border = mass%border + form_of(links(b)%linear, across) + &
        form_of(links(b)%axial_linear, along)
      first = layout%first(b) - 1
      do k = 1, links(b)%modes
        mass%diagonal(first + k) = links(b)%square(k)
        do i = 1, layout%border
          mass%coupling(i, first + k) = across(1, i)*links(b)%participation(1, k) + &
            across(2, i)*links(b)%participation(2, k)
        end do
        do j = 3, n
          mass%coupling(:, first + k) = mass%coupling(:, first + k) + &
            across(j, :)*links(b)%participation(j, k)
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

end module reduced_assembly
