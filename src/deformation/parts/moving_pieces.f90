!> A piece of a link that bends, from a to b along it: an end under a block that slides along the
!! link moves through its material as the linkage moves, and material through the functions of the
!! piece.
!!
!! In the share ξ of its length l the functions N(ξ) of a slender uniform piece are the same at any
!! length. With amplitudes Q of displacements, `w(x, t) = N((x − a)/l) Q`, a material point has
!! `w' = N Q' − (a' (1 − ξ) + b' ξ)/l N_ξ Q`: with all polynomials of a degree among the functions,
!! `−(1 − ξ) N_ξ = N E₁`, `−ξ N_ξ = N E₂`, and `w' = N (Q' + (a' E₁ + b' E₂)/l Q)`, exactly. So it
!! is with strains, which have the unknowns as amplitudes.
module moving_pieces
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use deformation_places, only: slope_row
  use deformation_shapes, only: deformation_shapes_t
  implicit none (type, external)
  private

  public :: moving_piece_t, new_moving_piece, amplitude_exponents, amplitude_scales, slope_scales

  !> Ends of a piece.
  integer, parameter :: first_end = 1, last_end = 2

  !> What moves with the material of a piece. Functions are those of `moving_integrals`, at the
  !! length of the tables of the link.
  type :: moving_piece_t
    integer :: way = 0                           !! number of its way; 0: it is no piece
    integer :: points(2) = 0                     !! where it begins and ends
    logical :: slides(2) = .false.               !! which of its ends are under blocks
    integer :: curves = 0, modes = 0
    real(wp), allocatable :: convection(:, :, :) !! (functions, functions, ends) E
    real(wp), allocatable :: slope(:, :)         !! (functions, ends) ∂u/∂ξ there
    real(wp) :: mass = 0.0_wp                    !! μL [kg]
    !> What moves of the strains in y with either end: (curves + modes, the same) of the curves of
    !! held ends and own modes across, (1 + axial modes, the same) of the elongation and own modes
    !! along
    real(wp), allocatable :: bending(:, :, :), axial(:, :, :)
  end type moving_piece_t

contains

  !> The matrices of a piece.
  pure function new_moving_piece(link, way) result(piece)
    type(link_modes_t), intent(in) :: link !! slender, without masses: `can_be_rescaled`
    integer, intent(in) :: way             !! its number
    type(moving_piece_t) :: piece

    integer :: across(link%curves + link%modes), along(link%axial_modes), chord, end, i, n

    piece%way = way
    piece%curves = link%curves
    piece%modes = link%modes
    piece%mass = sum(link%axial_linear)
    chord = 4 + link%curves
    n = chord + link%modes + link%axial_modes
    across = [(2 + i, i=1, link%curves), (chord + i, i=1, link%modes)]
    along = [(chord + link%modes + i, i=1, link%axial_modes)]
    allocate (piece%convection(n, n, 2), piece%slope(n, 2), source=0.0_wp)
    allocate (piece%bending(size(across), size(across), 2))
    allocate (piece%axial(0:size(along), 0:size(along), 2), source=0.0_wp)
    do end = first_end, last_end
      call move_chord(link, end, across, along, piece%convection(:, :, end), piece%slope(:, end))
      call move_strains(link, end, piece%bending(:, :, end), piece%axial(:, :, end))
      associate (convection => piece%convection(:, :, end))
        convection(across, across) = piece%bending(:, :, end)
        convection(along, along) = piece%axial(1:, 1:, end)
        ! In amplitudes of displacements a curvature falls by l², a strain by l; in y both by √l.
        do i = 1, size(across)
          convection(across(i), across(i)) = convection(across(i), across(i)) - grown(end, 2.0_wp)
          piece%bending(i, i, end) = piece%bending(i, i, end) - grown(end, 0.5_wp)
        end do
        do i = 1, size(along)
          convection(along(i), along(i)) = convection(along(i), along(i)) - grown(end, 1.0_wp)
        end do
        do i = 0, size(along)
          piece%axial(i, i, end) = piece%axial(i, i, end) - grown(end, 0.5_wp)
        end do
      end associate
    end do
  end function new_moving_piece

  !> A power of the length as its end moves: the first one makes it shorter.
  elemental function grown(end, power)
    integer, intent(in) :: end
    real(wp), intent(in) :: power
    real(wp) :: grown

    grown = merge(-power, power, end == first_end)
  end function grown

  !> What moves of the chord, whose functions are 1 at one end: −∂/∂ξ of all functions there.
  pure subroutine move_chord(link, end, across, along, convection, slope)
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: end
    integer, intent(in) :: across(:), along(:)    !! numbers of the functions
    real(wp), intent(inout) :: convection(:, :)   !! (functions, functions)
    real(wp), intent(inout) :: slope(:)           !! (functions) ∂u/∂ξ at the end

    real(wp), allocatable :: row(:)
    real(wp) :: place

    place = end - first_end
    associate (chord => 4 + link%curves)
      row = slope_row(link%bending_shapes, place)
      convection(end, 1:2) = [1.0_wp, -1.0_wp]
      convection(end, across) = -link%length*matmul(row(:size(link%bending, 1)), link%bending)
      row = slope_row(link%axial_shapes, place)
      slope(chord - 1:chord) = [-1.0_wp, 1.0_wp]
      slope(along) = link%length*matmul(row(:size(link%axial, 1)), link%axial)
      convection(chord - 2 + end, :) = -slope
    end associate
  end subroutine move_chord

  !> What moves of the strains, and of their mean along the link.
  pure subroutine move_strains(link, end, bending, axial)
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: end
    real(wp), intent(out) :: bending(:, :)
    real(wp), intent(inout) :: axial(0:, 0:)

    associate (across => moved_strains(link%bending_shapes, size(link%bending, 1), end), &
      along => moved_strains(link%axial_shapes, size(link%axial, 1), end))
      bending = matmul(transpose(link%bending), matmul(across, link%bending))
      axial(1:, 1:) = matmul(transpose(link%axial), matmul(along, link%axial))
    end associate
    axial(0, 1:) = matmul(mean_strains(link%axial_shapes, size(link%axial, 1), end), link%axial)
  end subroutine move_strains

  !> `−ξ d/dξ`, or of the first end `−(1 − ξ) d/dξ`, of the strains of unit unknowns: with
  !! ζ = 2ξ − 1 of the normalized `√(2j+1) P_j(ζ)`, where `(1 + ζ) P_j' = j P_j + Σ (2k+1) P_k` and
  !! `(1 − ζ) P_j' = −j P_j + Σ (−1)^(j−1−k) (2k+1) P_k` over k < j.
  pure function moved_strains(shapes, kept, end) result(moved)
    type(deformation_shapes_t), intent(in) :: shapes !! of one element
    integer, intent(in) :: kept                      !! unknowns in use
    integer, intent(in) :: end
    real(wp) :: moved(kept, kept)

    integer :: j, k

    moved = 0.0_wp
    do j = 0, ubound(shapes%column, 1)
      associate (column => shapes%column(j, 1))
        if (column == 0 .or. column > kept) cycle
        moved(column, column) = -grown(end, real(j, wp))
        do k = 0, j - 1
          if (shapes%column(k, 1) == 0) cycle
          moved(shapes%column(k, 1), column) = moved_part(j, k, end)
        end do
      end associate
    end do
  end function moved_strains

  !> The mean of these.
  pure function mean_strains(shapes, kept, end) result(mean)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: kept, end
    real(wp) :: mean(kept)

    integer :: j

    mean = 0.0_wp
    do j = 1, ubound(shapes%column, 1)
      if (shapes%column(j, 1) == 0 .or. shapes%column(j, 1) > kept) cycle
      mean(shapes%column(j, 1)) = moved_part(j, 0, end)
    end do
  end function mean_strains

  !> The part of degree k < j in what moves of degree j.
  elemental function moved_part(j, k, end) result(part)
    integer, intent(in) :: j, k, end
    real(wp) :: part

    part = -sqrt(real((2*j + 1)*(2*k + 1), wp))
    if (end == first_end .and. modulo(j - 1 - k, 2) == 1) part = -part
  end function moved_part

  !> Powers of the length by which the functions grow whose amplitudes are in y: a displacement
  !! across a piece by 3/2, one along it by 1/2; those of the chord are displacements.
  pure function amplitude_exponents(piece) result(exponent)
    type(moving_piece_t), intent(in) :: piece
    real(wp) :: exponent(size(piece%slope, 1))

    integer :: chord

    chord = 4 + piece%curves
    exponent(:2) = 0.0_wp
    exponent(3:2 + piece%curves) = 1.5_wp
    exponent(chord - 1:chord) = 0.0_wp
    exponent(chord + 1:chord + piece%modes) = 1.5_wp
    exponent(chord + piece%modes + 1:) = 0.5_wp
  end function amplitude_exponents

  !> Amplitudes of displacements at the length of the tables per unit of those of the functions.
  pure function amplitude_scales(piece, ratio) result(scale)
    type(moving_piece_t), intent(in) :: piece
    real(wp), intent(in) :: ratio(:)  !! (samples) length by that of the tables
    real(wp) :: scale(size(ratio), size(piece%slope, 1))

    real(wp) :: exponent(size(piece%slope, 1))
    integer :: i

    exponent = amplitude_exponents(piece)
    do i = 1, size(scale, 2)
      scale(:, i) = ratio**exponent(i)
    end do
  end function amplitude_scales

  !> The same of the slopes that axial forces act on: rotation of the chord, curves, own modes.
  pure function slope_scales(piece, ratio) result(scale)
    type(moving_piece_t), intent(in) :: piece
    real(wp), intent(in) :: ratio(:)
    real(wp) :: scale(size(ratio), 1 + piece%curves + piece%modes)

    scale(:, 1) = 1.0_wp
    scale(:, 2:) = spread(sqrt(ratio), 2, piece%curves + piece%modes)
  end function slope_scales

end module moving_pieces
