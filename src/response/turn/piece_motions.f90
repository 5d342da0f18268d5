!> What moves with the material of pieces between blocks, pins, masses and forces along a way
!! (`moving_pieces`).
!!
!! Their functions are those at the length of the tables, with amplitudes of displacements: masses
!! are a share of those of the tables, the share of the length. With `E = (a' E₁ + b' E₂)/l` the
!! displacement of a material point has the derivatives `Q' + E Q` and `Q'' + 2 E Q' + (E' + E²) Q`.
module piece_motions
  use kinds, only: wp
  use moving_pieces, only: amplitude_exponents, amplitude_scales, slope_scales
  use turn_grids, only: moves, turn_grid_t
  implicit none (type, external)
  private

  public :: scale_amplitudes, scale_slopes, scale_share, add_convection, add_moved, moved_back, &
    add_flux, work_of_flux, add_strain_convection

contains

  !> Amplitudes of displacements from those of the functions; of forces likewise the other way.
  pure subroutine scale_amplitudes(grid, body, q)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(inout) :: q(:, :) !! (samples, functions)

    if (moves(grid, body)) q = amplitude_scales(grid%pieces(body), grid%ratio(:, body))*q
  end subroutine scale_amplitudes

  !> The same of slopes that axial forces act on.
  pure subroutine scale_slopes(grid, body, slope)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(inout) :: slope(:, :) !! (samples, 1 + curves + modes)

    if (moves(grid, body)) slope = slope_scales(grid%pieces(body), grid%ratio(:, body))*slope
  end subroutine scale_slopes

  !> Integrals over the length of a piece from those over that of the tables.
  pure subroutine scale_share(grid, body, integral)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(inout) :: integral(:, :) !! (samples, any)

    integer :: i

    if (.not. moves(grid, body)) return
    do i = 1, size(integral, 2)
      integral(:, i) = grid%ratio(:, body)*integral(:, i)
    end do
  end subroutine scale_share

  !> `E Q` or, with the rates of the rates of the ends, `E' Q`: what moves of amplitudes with the
  !! material.
  pure function moved_by(matrices, slides, rates, q) result(moved)
    real(wp), intent(in) :: matrices(:, :, :) !! (amplitudes, amplitudes, ends)
    logical, intent(in) :: slides(2)          !! ends
    real(wp), intent(in) :: rates(:, :)       !! (samples, ends) of the ends by the length
    real(wp), intent(in) :: q(:, :)           !! (samples, amplitudes)
    real(wp) :: moved(size(q, 1), size(q, 2))

    integer :: end

    moved = 0.0_wp
    do end = 1, 2
      if (slides(end)) moved = moved + spread(rates(:, end), 2, size(q, 2))*matmul(q, &
        transpose(matrices(:, :, end)))
    end do
  end function moved_by

  !> Derivatives of the displacements of material points from those of the amplitudes.
  pure subroutine add_convection(grid, body, q, first, second)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)                   !! (samples, functions) Q
    real(wp), intent(inout) :: first(:, :)            !! Q', becomes Q' + E Q
    real(wp), intent(inout), optional :: second(:, :) !! Q'', likewise

    real(wp), allocatable :: moved(:, :)

    if (.not. moves(grid, body)) return
    associate (piece => grid%pieces(body), drift => grid%drift(:, :, body))
      moved = moved_by(piece%convection, piece%slides, drift, q)
      ! 2 E Q' + E' Q + E² Q
      if (present(second)) second = second + moved_by(piece%convection, piece%slides, &
        grid%drift_slope(:, :, body), q) + moved_by(piece%convection, piece%slides, drift, &
        2.0_wp*first + moved)
      first = first + moved
    end associate
  end subroutine add_convection

  !> Adds what moves at constant unknowns as the length changes, but for the chord and the scales:
  !! `S' y` is that of the chord, (l'/l) P Q of the scales and E Q.
  pure subroutine add_moved(grid, body, q, moved)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)        !! (samples, functions) Q
    real(wp), intent(inout) :: moved(:, :) !! likewise: of the chord, in amplitudes of functions

    if (.not. moves(grid, body)) return
    call scale_amplitudes(grid, body, moved)
    associate (piece => grid%pieces(body), drift => grid%drift(:, :, body))
      moved = moved + moved_by(piece%convection, piece%slides, drift, q) + scaled(grid, body, q)
    end associate
  end subroutine add_moved

  !> Forces on Q from those on what moves at constant unknowns: (l'/l) P + Eᵀ.
  pure function moved_back(grid, body, forces) result(back)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body            !! a piece
    real(wp), intent(in) :: forces(:, :)   !! (samples, functions)
    real(wp) :: back(size(forces, 1), size(forces, 2))

    integer :: end

    back = scaled(grid, body, forces)
    associate (piece => grid%pieces(body))
      do end = 1, 2
        if (piece%slides(end)) back = back + spread(grid%drift(:, end, body), 2, size(forces, &
          2))*matmul(forces, piece%convection(:, :, end))
      end do
    end associate
  end function moved_back

  !> (l'/l) P of some amplitudes.
  pure function scaled(grid, body, q)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)     !! (samples, functions)
    real(wp) :: scaled(size(q, 1), size(q, 2))

    associate (drift => grid%drift(:, :, body))
      scaled = spread(drift(:, 2) - drift(:, 1), 2, size(q, 2))* &
        spread(amplitude_exponents(grid%pieces(body)), 1, size(q, 1))*q
    end associate
  end function scaled

  !> Adds the momentum that passes blocks where the strain of the axis jumps: `μ c'² ∂u/∂x`, c being
  !! the place of the block, before it with a minus sign.
  pure subroutine add_flux(grid, body, q, force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)        !! (samples, functions) Q
    real(wp), intent(inout) :: force(:, :) !! (samples, functions) on amplitudes of the tables

    integer :: end

    if (.not. moves(grid, body)) return
    do end = 1, 2
      associate (along => 2 + grid%pieces(body)%curves + end)
        if (grid%pieces(body)%slides(end)) force(:, along) = force(:, along) + passing(grid, body, &
          end, matmul(q, grid%pieces(body)%slope(:, end)))
      end associate
    end do
  end subroutine add_flux

  !> The momentum that passes an end of a piece.
  pure function passing(grid, body, end, strain) result(force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body, end
    real(wp), intent(in) :: strain(:)    !! (samples) ∂u/∂ξ there
    real(wp) :: force(size(strain))

    force = merge(1, -1, end == 1)*grid%pieces(body)%mass*grid%ratio(:, body)* &
      grid%drift(:, end, body)**2*strain
  end function passing

  !> What that momentum works on the mean of S' y at both sides of the block: the jump of S' y is
  !! −c' times that of ∂u/∂x.
  pure function work_of_flux(grid, body, q, moved) result(work)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :), moved(:, :) !! (samples, functions) of y and of S' y
    real(wp) :: work(size(q, 1))

    real(wp) :: strain(size(q, 1))
    integer :: end

    work = 0.0_wp
    if (.not. moves(grid, body)) return
    do end = 1, 2
      associate (piece => grid%pieces(body))
        if (.not. piece%slides(end)) cycle
        strain = matmul(q, piece%slope(:, end))
        work = work + passing(grid, body, end, strain)*(moved(:, 2 + piece%curves + end) - &
          grid%rate(:, body)*q(:, end) + 0.5_wp*grid%drift(:, end, body)*strain)
      end associate
    end do
  end function work_of_flux

  !> Adds to rates of strains in y what moves through the pieces with their material.
  pure subroutine add_strain_convection(grid, w, y, w_rates, rates)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: w(:, :)          !! (samples, deformations) of ends of parts
    real(wp), intent(in) :: y(:, :)          !! (samples, unknowns)
    real(wp), intent(inout) :: w_rates(:, :) !! (samples, deformations)
    real(wp), intent(inout) :: rates(:, :)   !! (samples, unknowns), of own modes

    real(wp), allocatable :: strain(:, :), moved(:, :)
    integer :: b, i, n

    do b = 1, size(grid%integrals)
      if (.not. moves(grid, b)) cycle
      associate (piece => grid%pieces(b), first => grid%first(b), along => grid%first_along(b), &
        drift => grid%drift(:, :, b), elongation => grid%elongation(b))
        if (.not. any(piece%slides)) cycle
        n = piece%curves + piece%modes
        allocate (strain(size(y, 1), n))
        strain(:, :piece%curves) = w(:, grid%curve(:piece%curves, b))
        strain(:, piece%curves + 1:) = y(:, first:first + piece%modes - 1)
        moved = moved_by(piece%bending, piece%slides, drift, strain)
        do i = 1, piece%curves
          w_rates(:, grid%curve(i, b)) = w_rates(:, grid%curve(i, b)) + moved(:, i)
        end do
        rates(:, first:first + piece%modes - 1) = rates(:, first:first + piece%modes - 1) + &
          moved(:, piece%curves + 1:)
        n = size(piece%axial, 1)
        strain = reshape([w(:, elongation), y(:, along:along + n - 2)], [size(y, 1), n])
        moved = moved_by(piece%axial, piece%slides, drift, strain)
        w_rates(:, elongation) = w_rates(:, elongation) + moved(:, 1)
        rates(:, along:along + n - 2) = rates(:, along:along + n - 2) + moved(:, 2:)
        deallocate (strain)
      end associate
    end do
  end subroutine add_strain_convection

end module piece_motions
