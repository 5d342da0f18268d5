!> Strains and displacements at a place of a link, as sums over its functions.
module link_rows
  use deformation_places, only: displacement_row, rotation_row, slope_row
  use deformation_shapes, only: deformation_shapes_t, shear_scale
  use kinds, only: wp
  use legendre, only: legendre_values
  use link_modes, only: link_modes_t
  implicit none (type, external)
  private

  public :: displacement_rows, strain_rows, strain_rows_t, sums_of_rows

  !> Strains at a place per unit of the functions of a link that bends.
  type :: strain_rows_t
    real(wp) :: elongation = 0.0_wp          !! axial strain per unit of the elongation unknown
    real(wp), allocatable :: axial(:)       !! (own) axial strain
    real(wp), allocatable :: curvature(:)   !! (1 − curves:own) curves of held ends, own
                                            !! modes [1/m]
    real(wp), allocatable :: shear(:)       !! (1 − curves:own) −EI dκ/dx, or with shear strains
                                            !! kGA γ [N]
    real(wp), allocatable :: rotation(:)    !! (1 − curves:own) of the cross-section against the
                                            !! chord [rad]
  end type strain_rows_t

contains

  !> Displacement along and across a link and rotation of its cross-section, of the chord and the
  !! own modes, in the order of `moving_integrals`.
  pure function displacement_rows(link, place) result(rows)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: place(2)  !! from the first pin, in the axes of the link [m]
    real(wp), allocatable :: rows(:, :) !! (along, across, rotation; functions)

    real(wp) :: xi
    real(wp), allocatable :: row(:)
    integer :: curves, chord, own, along

    if (.not. link%bends) then
      rows = reshape([1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, -place(2), place(1), &
        1.0_wp], [3, 3])
      return
    end if
    xi = place(1)/link%length
    own = link%modes + link%axial_modes
    curves = link%curves
    chord = 4 + curves
    along = chord + 1
    if (.not. link%coupled) along = along + link%modes
    allocate (rows(3, chord + own))
    rows = 0.0_wp
    rows(2:3, 1) = [1.0_wp - xi, -1.0_wp/link%length]
    rows(2:3, 2) = [xi, 1.0_wp/link%length]
    rows(1, chord - 1:chord) = [1.0_wp - xi, xi]
    row = displacement_row(link%bending_shapes, xi)
    row = matmul(row(:size(link%bending, 1)), link%bending)
    ! At its ends a link has no displacement of its own.
    if (xi > 0.0_wp .and. xi < 1.0_wp) then
      rows(2, 3:2 + curves) = row(:curves)
      rows(2, chord + 1:chord + link%modes) = row(curves + 1:)
    end if
    row = rotation_row(link%bending_shapes, xi)
    row = matmul(row(:size(link%bending, 1)), link%bending)
    rows(3, 3:2 + curves) = row(:curves)
    rows(3, chord + 1:chord + link%modes) = row(curves + 1:)
    if (xi > 0.0_wp .and. xi < 1.0_wp) then
      row = displacement_row(link%axial_shapes, xi)
      row = matmul(row(:size(link%axial, 1)), link%axial)
      rows(1, along:along + size(row) - 1) = row
    end if
    rows(1, :) = rows(1, :) - place(2)*rows(3, :)
  end function displacement_rows

  !> Strains at a place of a link that bends.
  pure function strain_rows(link, xi) result(rows)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: xi !! from 0 to 1 along the link
    type(strain_rows_t) :: rows

    real(wp), allocatable :: row(:)
    integer :: own, kept, first

    own = link%modes + link%axial_modes
    kept = size(link%bending, 1)
    rows%elongation = link%elongation/link%length
    first = 1 - link%curves
    allocate (rows%axial(own), rows%curvature(first:own), rows%shear(first:own), &
      rows%rotation(first:own))
    rows%axial = 0.0_wp
    rows%curvature = 0.0_wp
    rows%shear = 0.0_wp
    rows%rotation = 0.0_wp
    row = slope_row(link%axial_shapes, xi)
    row = matmul(row(:size(link%axial, 1)), link%axial)
    if (link%coupled) then
      rows%axial(:link%modes) = row
    else
      rows%axial(link%modes + 1:) = row
    end if
    rows%curvature(:link%modes) = matmul(curvature_row(link, xi, kept), link%bending)
    rows%shear(:link%modes) = matmul(shear_row(link, xi, kept), link%bending)
    row = rotation_row(link%bending_shapes, xi)
    rows%rotation(:link%modes) = matmul(row(:kept), link%bending)
  end function strain_rows

  !> Sums over the curves of held ends and the own modes, at every sample.
  pure function sums_of_rows(q, chord, row) result(sums)
    real(wp), intent(in) :: q(:, :)  !! (samples, functions) amplitudes, as in `moving_integrals`
    integer, intent(in) :: chord     !! functions of the chord, curves among them
    real(wp), intent(in) :: row(:)   !! (curves + own) of `strain_rows_t`
    real(wp) :: sums(size(q, 1))

    integer :: c, curves

    curves = chord - 4
    sums = matmul(q(:, chord + 1:), row(curves + 1:))
    do c = 1, curves
      sums = sums + row(c)*q(:, 2 + c)
    end do
  end function sums_of_rows

  !> Curvature at a place per unit of the unknowns of the shapes.
  pure function curvature_row(link, xi, kept) result(row)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: xi
    integer, intent(in) :: kept
    real(wp) :: row(kept)

    real(wp) :: zeta, h
    real(wp), allocatable :: p(:)
    integer :: element, j

    row = 0.0_wp
    associate (shapes => link%bending_shapes)
      call find_place(shapes, xi, element, zeta, h)
      p = legendre_values(ubound(shapes%column, 1), zeta)
      do j = 0, ubound(shapes%column, 1)
        if (shapes%column(j, element) == 0 .or. shapes%column(j, element) > kept) cycle
        row(shapes%column(j, element)) = sqrt((2*j + 1)/(link%bending_stiffness*h))*p(j + 1)
      end do
    end associate
  end function curvature_row

  !> Shear force of a link with shear strains, kGA γ; of another, −EI dκ/dx.
  pure function shear_row(link, xi, kept) result(row)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: xi
    integer, intent(in) :: kept
    real(wp) :: row(kept)

    real(wp) :: zeta, h
    real(wp), allocatable :: p(:), slope(:)
    integer :: element, j

    row = 0.0_wp
    associate (shapes => link%bending_shapes)
      call find_place(shapes, xi, element, zeta, h)
      p = legendre_values(ubound(shapes%column, 1), zeta)
      allocate (slope, mold=p)
      slope(1) = 0.0_wp
      if (size(slope) > 1) slope(2) = 1.0_wp
      do j = 2, size(slope) - 1
        slope(j + 1) = slope(j - 1) + (2*j - 1)*p(j)
      end do
      do j = 0, ubound(shapes%column, 1)
        if (shapes%column(j, element) == 0 .or. shapes%column(j, element) > kept) cycle
        if (shapes%shear_stiffness > 0.0_wp) then
          row(shapes%column(j, element) + 1) = shapes%shear_stiffness* &
            shear_scale(j, shapes%shear_stiffness, h)*p(j + 1)
        else
          row(shapes%column(j, element)) = -2.0_wp/h*slope(j + 1)* &
            sqrt((2*j + 1)*link%bending_stiffness/h)
        end if
      end do
    end associate
  end function shear_row

  !> The element that a place is in, the place in it, from −1 to 1, and its length.
  pure subroutine find_place(shapes, xi, element, zeta, h)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: xi
    integer, intent(out) :: element
    real(wp), intent(out) :: zeta, h

    element = 1 + count(shapes%last(1:shapes%elements - 1) <= xi*shapes%elements)
    zeta = 2.0_wp*(xi*shapes%elements - shapes%middle(element))/shapes%part(element)
    h = shapes%length/shapes%elements*shapes%part(element)
  end subroutine find_place

end module link_rows
