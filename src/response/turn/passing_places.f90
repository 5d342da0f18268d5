!> Displacements and strains at places of a link along which a block slides: a place is on one piece
!! before the block has passed it, and on the other after.
!!
!! At a place quantities have kinks where the block passes it, and the shear force jumps, while all
!! that they are made of is smooth over the turn: between samples this is interpolated, not they.
module passing_places
  use elastic_equations, only: elongation_of, functions_of
  use kinds, only: wp
  use link_rows, only: displacement_rows, strain_rows, strain_rows_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: place_terms, point_at_place, gauge_at_place

contains

  !> What quantities at places of a link are made of: of both of its pieces the amplitudes of the
  !! functions, the elongation and the share of the length, then the direction of the link.
  pure function place_terms(grid, body, y) result(terms)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body        !! the piece before the block; that behind it follows
    real(wp), intent(in) :: y(:, :)    !! (samples, unknowns) [√J]
    real(wp), allocatable :: terms(:, :) !! (samples, terms)

    integer :: at, b, n

    allocate (terms(size(y, 1), terms_of(grid, body) + terms_of(grid, body + 1) + 2))
    at = 0
    do b = body, body + 1
      n = terms_of(grid, b)
      terms(:, at + 1:at + n - 2) = functions_of(grid, b, y)
      terms(:, at + n - 1) = elongation_of(grid, b, y)
      terms(:, at + n) = grid%ratio(:, b)
      at = at + n
    end do
    terms(:, at + 1:) = grid%direction(:, :, body)
  end function place_terms

  !> Number of the terms of a piece.
  pure function terms_of(grid, body) result(number)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    integer :: number

    number = grid%integrals(body)%chord + grid%integrals(body)%own + 2
  end function terms_of

  !> The displacement of a point in fixed axes and the rotation of its cross-section.
  pure function point_at_place(grid, body, place, terms) result(values)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body        !! the piece before the block
    real(wp), intent(in) :: place(2)   !! from its first end, in the axes of the link [m]
    real(wp), intent(in) :: terms(:)   !! of `place_terms` at a crank angle
    real(wp) :: values(3)              !! x, y, rotation [m, m, rad]

    real(wp), allocatable :: here(:)
    real(wp) :: local(3), xi
    integer :: b

    call find_piece(grid, body, place(1)/grid%model%links(body)%length, terms, b, xi, here)
    associate (link => grid%model%links(b), ratio => here(size(here)), e => terms(size(terms) - &
      1:))
      local = matmul(displacement_rows(link, [xi*link%length, 0.0_wp]), here(:size(here) - 2))
      local(3) = local(3)/ratio
      local(1) = local(1) - place(2)*local(3)
      values = [e(1)*local(1) - e(2)*local(2), e(2)*local(1) + e(1)*local(2), local(3)]
    end associate
  end function point_at_place

  !> Axial strain, curvature and shear force at a place.
  pure function gauge_at_place(grid, body, share, terms) result(values)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body        !! the piece before the block
    real(wp), intent(in) :: share      !! of the way along both pieces
    real(wp), intent(in) :: terms(:)   !! of `place_terms` at a crank angle
    real(wp) :: values(3)              !! [-, 1/m, N]

    type(strain_rows_t) :: rows
    real(wp), allocatable :: here(:)
    real(wp) :: xi
    integer :: b, chord

    call find_piece(grid, body, share, terms, b, xi, here)
    rows = strain_rows(grid%model%links(b), xi)
    chord = grid%integrals(b)%chord
    associate (ratio => here(size(here)), own => here(chord + 1:size(here) - 2), curves => &
      here(3:chord - 2), elongation => here(size(here) - 1))
      values(1) = elongation*rows%elongation + dot_product(own, rows%axial)/ratio
      values(2) = (dot_product(curves, rows%curvature(:0)) + dot_product(own, &
        rows%curvature(1:)))/ratio**2
      values(3) = (dot_product(curves, rows%shear(:0)) + dot_product(own, rows%shear(1:)))/ratio**3
    end associate
  end function gauge_at_place

  !> The piece on which a place is at a crank angle.
  pure subroutine find_piece(grid, body, share, terms, b, xi, here)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: share    !! of the way along both pieces
    real(wp), intent(in) :: terms(:)
    integer, intent(out) :: b        !! its number
    real(wp), intent(out) :: xi      !! along it, 0 to 1
    real(wp), allocatable, intent(out) :: here(:) !! its terms

    integer :: n

    n = terms_of(grid, body)
    associate (before => terms(n))
      if (share <= before) then
        b = body
        xi = min(max(share/before, 0.0_wp), 1.0_wp)
        here = terms(:n)
      else
        b = body + 1
        here = terms(n + 1:size(terms) - 2)
        xi = min(max(1.0_wp - (1.0_wp - share)/here(size(here)), 0.0_wp), 1.0_wp)
      end if
    end associate
  end subroutine find_piece

end module passing_places
