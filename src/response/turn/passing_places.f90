!> Displacements and strains at places of a link along which blocks slide: a place is on one piece
!! before a block has passed it, and on the next after.
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

  !> What quantities at places of a way are made of: of all of its pieces the amplitudes of the
  !! functions, the elongation and the share of the length, then the direction of the link.
  pure function place_terms(grid, body, y) result(terms)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body        !! the first piece
    real(wp), intent(in) :: y(:, :)    !! (samples, unknowns) [√J]
    real(wp), allocatable :: terms(:, :) !! (samples, terms)

    integer :: at, b, n

    associate (last => last_piece(grid, body))
      allocate (terms(size(y, 1), sum([(terms_of(grid, b), b=body, last)]) + 2))
      at = 0
      do b = body, last
        n = terms_of(grid, b)
        terms(:, at + 1:at + n - 2) = functions_of(grid, b, y)
        terms(:, at + n - 1) = elongation_of(grid, b, y)
        terms(:, at + n) = grid%ratio(:, b)
        at = at + n
      end do
    end associate
    terms(:, at + 1:) = grid%direction(:, :, body)
  end function place_terms

  !> Number of the last piece of the way of one.
  pure function last_piece(grid, body) result(last)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    integer :: last

    last = findloc(grid%pieces%way, grid%pieces(body)%way, dim=1, back=.true.)
  end function last_piece

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
    integer, intent(in) :: body        !! the first piece
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
    integer, intent(in) :: body        !! the first piece
    real(wp), intent(in) :: share      !! of the way
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
    real(wp), intent(in) :: share    !! of the way
    real(wp), intent(in) :: terms(:)
    integer, intent(out) :: b        !! its number
    real(wp), intent(out) :: xi      !! along it, 0 to 1
    real(wp), allocatable, intent(out) :: here(:) !! its terms

    real(wp) :: left
    integer :: at, n

    left = share
    at = 0
    do b = body, last_piece(grid, body)
      n = terms_of(grid, b)
      here = terms(at + 1:at + n)
      xi = min(max(left/here(n), 0.0_wp), 1.0_wp)
      if (left <= here(n)) return
      left = left - here(n)
      at = at + n
    end do
    b = last_piece(grid, body)
  end subroutine find_piece

end module passing_places
