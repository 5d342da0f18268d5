!> What moves with the material of pieces whose lengths change over the turn (`moving_pieces`).
!!
!! Their functions are those at the length of the tables, with amplitudes of displacements: masses
!! are a share of those of the tables, the share of the length. With λ = l'/l the displacement of a
!! material point has the derivatives `Q' + λ E Q` and `Q'' + 2 λ E Q' + (λ' E + λ² E²) Q`.
module piece_motions
  use kinds, only: wp
  use moving_pieces, only: amplitude_exponents, amplitude_scales, slope_scales
  use turn_grids, only: moves, turn_grid_t
  implicit none (type, external)
  private

  public :: scale_amplitudes, scale_slopes, scale_share, add_convection, add_moved, moved_back, &
    add_flux, add_strain_convection

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

  !> Derivatives of the displacements of material points from those of the amplitudes.
  pure subroutine add_convection(grid, body, q, first, second)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)                   !! (samples, functions) Q
    real(wp), intent(inout) :: first(:, :)            !! Q', becomes Q' + λ E Q
    real(wp), intent(inout), optional :: second(:, :) !! Q'', likewise

    real(wp), allocatable :: moved(:, :)
    integer :: i

    if (.not. moves(grid, body)) return
    associate (transposed => transpose(grid%pieces(body)%convection), &
      stretch => grid%stretch(:, body), slope => grid%stretch_slope(:, body))
      moved = matmul(q, transposed)
      if (present(second)) then
        ! 2 λ E Q' + λ' E Q + λ² E² Q
        do i = 1, size(q, 2)
          second(:, i) = second(:, i) + slope*moved(:, i)
        end do
        associate (rate => matmul(2.0_wp*first + spread(stretch, 2, size(q, 2))*moved, transposed))
          do i = 1, size(q, 2)
            second(:, i) = second(:, i) + stretch*rate(:, i)
          end do
        end associate
      end if
      do i = 1, size(q, 2)
        first(:, i) = first(:, i) + stretch*moved(:, i)
      end do
    end associate
  end subroutine add_convection

  !> Adds what moves at constant unknowns as the length changes, but for the chord and the scales:
  !! `S' y` is that of the chord, λ P Q of the scales and λ E Q.
  pure subroutine add_moved(grid, body, q, moved)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)        !! (samples, functions) Q
    real(wp), intent(inout) :: moved(:, :) !! likewise: of the chord, in amplitudes of functions

    real(wp), allocatable :: part(:, :)
    integer :: i

    if (.not. moves(grid, body)) return
    call scale_amplitudes(grid, body, moved)
    associate (piece => grid%pieces(body))
      part = matmul(q, transpose(piece%convection)) + spread(amplitude_exponents(piece), 1, &
        size(q, 1))*q
    end associate
    do i = 1, size(q, 2)
      moved(:, i) = moved(:, i) + grid%stretch(:, body)*part(:, i)
    end do
  end subroutine add_moved

  !> Forces on Q from those on what moves at constant unknowns: λ (P + Eᵀ).
  pure function moved_back(grid, body, forces) result(back)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body            !! a piece whose length changes
    real(wp), intent(in) :: forces(:, :)   !! (samples, functions)
    real(wp) :: back(size(forces, 1), size(forces, 2))

    associate (piece => grid%pieces(body))
      back = matmul(forces, piece%convection) + spread(amplitude_exponents(piece), 1, &
        size(forces, 1))*forces
    end associate
    back = spread(grid%stretch(:, body), 2, size(forces, 2))*back
  end function moved_back

  !> Adds the momentum that passes the block where the strain of the axis jumps: `μ c'² ∂u/∂x`, c
  !! being the place of the block, before it with a minus sign.
  pure subroutine add_flux(grid, body, q, force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)        !! (samples, functions) Q
    real(wp), intent(inout) :: force(:, :) !! (samples, functions) on amplitudes of the tables

    if (.not. moves(grid, body)) return
    associate (piece => grid%pieces(body))
      force(:, piece%cut) = force(:, piece%cut) + grid%ratio(:, body)*grid%stretch(:, body)**2* &
        matmul(q, piece%flux)
    end associate
  end subroutine add_flux

  !> Adds to rates of strains in y what moves through the pieces with their material, `λ F y`.
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
        stretch => grid%stretch(:, b), elongation => grid%elongation(b))
        n = piece%curves + piece%modes
        allocate (strain(size(y, 1), n))
        strain(:, :piece%curves) = w(:, grid%curve(:piece%curves, b))
        strain(:, piece%curves + 1:) = y(:, first:first + piece%modes - 1)
        moved = matmul(strain, transpose(piece%bending))*spread(stretch, 2, n)
        do i = 1, piece%curves
          w_rates(:, grid%curve(i, b)) = w_rates(:, grid%curve(i, b)) + moved(:, i)
        end do
        rates(:, first:first + piece%modes - 1) = rates(:, first:first + piece%modes - 1) + &
          moved(:, piece%curves + 1:)
        n = size(piece%axial, 1)
        strain = reshape([w(:, elongation), y(:, along:along + n - 2)], [size(y, 1), n])
        moved = matmul(strain, transpose(piece%axial))*spread(stretch, 2, n)
        w_rates(:, elongation) = w_rates(:, elongation) + moved(:, 1)
        rates(:, along:along + n - 2) = rates(:, along:along + n - 2) + moved(:, 2:)
        deallocate (strain)
      end associate
    end do
  end subroutine add_strain_convection

end module piece_motions
