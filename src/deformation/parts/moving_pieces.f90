!> A piece of a link that bends, from a point of the link to the place under a block that slides
!! along it: its length changes as the linkage moves, and material moves through its functions.
!!
!! In the share ξ of its length l the functions N(ξ) of a slender uniform piece are the same at any
!! length. With amplitudes Q of displacements, `w(x, t) = N(x/l) Q`, a material point at a distance
!! x from the end that is a point of the link has `w' = N Q' − (l'/l) ξ N_ξ Q` (from the last end
!! (1 − ξ) N_ξ): with all polynomials of a degree among the functions, `−ξ N_ξ = N E`, and
!! `w' = N (Q' + (l'/l) E Q)`, exactly. So it is with strains, which have the unknowns as
!! amplitudes.
module moving_pieces
  use elastic_linkages, only: elastic_linkage_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use deformation_places, only: slope_row
  use deformation_shapes, only: deformation_shapes_t
  implicit none (type, external)
  private

  public :: moving_piece_t, moving_ends, new_moving_piece, amplitude_exponents, amplitude_scales, &
    slope_scales

  !> The end of a piece that is under the block; none: the length does not change.
  integer, parameter, public :: no_end = 0, first_end = 1, last_end = 2

  !> What moves with the material of a piece. Functions are those of `moving_integrals`, at the
  !! length of the tables of the link.
  type :: moving_piece_t
    integer :: moving_end = no_end
    integer :: curves = 0, modes = 0
    real(wp), allocatable :: convection(:, :) !! (functions, functions) E
    integer :: cut = 0                        !! function that is 1 along the link at the block
    real(wp), allocatable :: flux(:)          !! (functions) ∓μL ∂u/∂ξ at the block [kg]
    !> What moves of the strains in y: (curves + modes, the same) of the curves of held ends and
    !! own modes across, (1 + axial modes, the same) of the elongation and own modes along
    real(wp), allocatable :: bending(:, :), axial(:, :)
  end type moving_piece_t

contains

  !> Which end of every part is under a block that slides along its link.
  pure function moving_ends(elastic) result(moving_end)
    type(elastic_linkage_t), intent(in) :: elastic
    integer :: moving_end(size(elastic%body))

    integer :: i

    moving_end = no_end
    do i = 1, size(elastic%cut_part)
      if (elastic%cut_part(i) == 0) cycle
      moving_end(elastic%cut_part(i)) = last_end
      moving_end(elastic%cut_part(i) + 1) = first_end
    end do
  end function moving_ends

  !> The matrices of a piece.
  pure function new_moving_piece(link, moving_end) result(piece)
    type(link_modes_t), intent(in) :: link !! slender, without masses: `can_be_rescaled`
    integer, intent(in) :: moving_end      !! `first_end` or `last_end`
    type(moving_piece_t) :: piece

    real(wp), allocatable :: strain(:, :), row(:)
    integer, allocatable :: across(:), along(:)
    real(wp) :: place, sense
    integer :: chord, i, n

    piece%moving_end = moving_end
    piece%curves = link%curves
    piece%modes = link%modes
    chord = 4 + link%curves
    n = chord + link%modes + link%axial_modes
    allocate (piece%convection(n, n), piece%flux(n))
    piece%convection = 0.0_wp
    piece%flux = 0.0_wp
    place = merge(1.0_wp, 0.0_wp, moving_end == last_end)
    sense = merge(-1.0_wp, 1.0_wp, moving_end == last_end)
    across = [(2 + i, i=1, link%curves), (chord + i, i=1, link%modes)]
    along = [(chord + link%modes + i, i=1, link%axial_modes)]
    ! The chord: at the block −∂/∂ξ or ∂/∂ξ of its functions.
    associate (at_block => merge(2, 1, moving_end == last_end))
      piece%cut = chord - 2 + at_block
      piece%convection(at_block, 1:2) = sense*[-1.0_wp, 1.0_wp]
      piece%convection(piece%cut, chord - 1:chord) = sense*[-1.0_wp, 1.0_wp]
      row = slope_row(link%bending_shapes, place)
      row = link%length*matmul(row(:size(link%bending, 1)), link%bending)
      piece%convection(at_block, across) = sense*row
      row = slope_row(link%axial_shapes, place)
      row = link%length*matmul(row(:size(link%axial, 1)), link%axial)
      piece%convection(piece%cut, along) = sense*row
    end associate
    piece%flux(chord - 1:chord) = [-1.0_wp, 1.0_wp]
    piece%flux(along) = row
    piece%flux = sense*sum(link%axial_linear)*piece%flux

    strain = moved_strains(link%bending_shapes, size(link%bending, 1), moving_end)
    strain = matmul(transpose(link%bending), matmul(strain, link%bending))
    piece%convection(across, across) = strain
    piece%bending = strain
    strain = moved_strains(link%axial_shapes, size(link%axial, 1), moving_end)
    strain = matmul(transpose(link%axial), matmul(strain, link%axial))
    piece%convection(along, along) = strain
    n = size(along)
    allocate (piece%axial(0:n, 0:n), source=0.0_wp)
    piece%axial(1:, 1:) = strain
    piece%axial(0, 1:) = matmul(mean_strains(link%axial_shapes, size(link%axial, 1), moving_end), &
      link%axial)
    ! In amplitudes of displacements a curvature falls by l², a strain by l; in y both by √l.
    do i = 1, size(across)
      piece%convection(across(i), across(i)) = piece%convection(across(i), across(i)) - 2.0_wp
      piece%bending(i, i) = piece%bending(i, i) - 0.5_wp
    end do
    do i = 1, n
      piece%convection(along(i), along(i)) = piece%convection(along(i), along(i)) - 1.0_wp
    end do
    do i = 0, n
      piece%axial(i, i) = piece%axial(i, i) - 0.5_wp
    end do
  end function new_moving_piece

  !> `−ξ d/dξ`, or `(1 − ξ) d/dξ` of a piece with its first end under the block, of the strains of
  !! unit unknowns: with ζ = 2ξ − 1 of the normalized `√(2j+1) P_j(ζ)`, where
  !! `(1 + ζ) P_j' = j P_j + Σ (2k+1) P_k` and `(1 − ζ) P_j' = −j P_j + Σ (−1)^(j−1−k) (2k+1) P_k`
  !! over k < j.
  pure function moved_strains(shapes, kept, moving_end) result(moved)
    type(deformation_shapes_t), intent(in) :: shapes !! of one element
    integer, intent(in) :: kept                      !! unknowns in use
    integer, intent(in) :: moving_end
    real(wp) :: moved(kept, kept)

    integer :: j, k

    moved = 0.0_wp
    do j = 0, ubound(shapes%column, 1)
      associate (column => shapes%column(j, 1))
        if (column == 0 .or. column > kept) cycle
        moved(column, column) = -j
        do k = 0, j - 1
          if (shapes%column(k, 1) == 0) cycle
          moved(shapes%column(k, 1), column) = moved_part(j, k, moving_end)
        end do
      end associate
    end do
  end function moved_strains

  !> The mean of these.
  pure function mean_strains(shapes, kept, moving_end) result(mean)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: kept, moving_end
    real(wp) :: mean(kept)

    integer :: j

    mean = 0.0_wp
    do j = 1, ubound(shapes%column, 1)
      if (shapes%column(j, 1) == 0 .or. shapes%column(j, 1) > kept) cycle
      mean(shapes%column(j, 1)) = moved_part(j, 0, moving_end)
    end do
  end function mean_strains

  !> The part of degree k < j in what moves of degree j.
  elemental function moved_part(j, k, moving_end) result(part)
    integer, intent(in) :: j, k, moving_end
    real(wp) :: part

    part = sqrt(real((2*j + 1)*(2*k + 1), wp))
    if (moving_end == last_end) then
      part = -part
    else if (modulo(j - 1 - k, 2) == 1) then
      part = -part
    end if
  end function moved_part

  !> Powers of the length by which the functions grow whose amplitudes are in y: a displacement
  !! across a piece by 3/2, one along it by 1/2; those of the chord are displacements.
  pure function amplitude_exponents(piece) result(exponent)
    type(moving_piece_t), intent(in) :: piece
    real(wp) :: exponent(size(piece%flux))

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
    real(wp) :: scale(size(ratio), size(piece%flux))

    real(wp) :: exponent(size(piece%flux))
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
