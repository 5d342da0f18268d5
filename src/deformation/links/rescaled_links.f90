!> Own modes of a link whose length changes, as the distance along a guide does, from those of the
!! same link at another length.
!!
!! A slender uniform link without masses along it looks the same at any length: in its unknowns,
!! which are coefficients of strains scaled to energy, curves and own modes do not change. Let the
!! length change by the factor r. Then displacements across the link per unit of an unknown change
!! by r^(3/2); displacements along it, slopes, and the roots of the mass and of dx change by
!! r^(1/2). So every table changes by a power of r. Shear, rotary inertia and masses bring in
!! lengths that do not grow with the link.
module rescaled_links
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  use link_modes, only: link_modes_t, rigid
  use next_orders, only: next_orders_t
  implicit none (type, external)
  private

  public :: can_be_rescaled, rescale_link

contains

  !> Whether the tables of a link at another length follow from these.
  pure function can_be_rescaled(link) result(can)
    type(link_modes_t), intent(in) :: link !! at any length
    logical :: can

    can = link%bends .and. .not. link%coupled .and. link%bending_shapes%shear_stiffness <= 0.0_wp &
      .and. link%bending_shapes%rotations == 0 .and. link%bending_shapes%lumps == 0
  end function can_be_rescaled

  !> The tables of a link at another length: those of the reference times powers of the ratio of the
  !! lengths. Nothing is allocated.
  pure subroutine rescale_link(reference, length, link)
    type(link_modes_t), intent(in) :: reference !! a link that can be rescaled
    real(wp), intent(in) :: length              !! not longer than the reference [m]
    type(link_modes_t), intent(inout) :: link   !! before, a copy of the reference at any length

    real(wp) :: ratio, root, with_chord, chord_slope
    integer :: i, j

    ratio = length/reference%length
    root = sqrt(ratio)
    ! Mass between the chord and a deformation across it, slopes of both.
    with_chord = ratio**2*root
    chord_slope = ratio*root
    link%length = length
    link%elongation = root*reference%elongation
    link%curve_rotation = root*reference%curve_rotation
    link%square(:) = ratio**4*reference%square
    link%axial_square(:) = ratio**2*reference%axial_square
    link%axial_participation(:, :) = ratio*root*reference%axial_participation
    link%axial_linear = ratio*reference%axial_linear
    do j = 1, size(link%participation, 2)
      link%participation(:2, j) = with_chord*reference%participation(:2, j)
      link%participation(3:, j) = ratio**4*reference%participation(3:, j)
    end do
    link%linear(:, :) = ratio**4*reference%linear
    link%linear(:2, :) = with_chord*reference%linear(:2, :)
    link%linear(:, :2) = with_chord*reference%linear(:, :2)
    link%linear(:2, :2) = ratio*reference%linear(:2, :2)
    do j = 1, size(link%geometric, 3)
      do i = 1, size(link%geometric, 2)
        link%geometric(:, i, j) = ratio**2*reference%geometric(:, i, j)
      end do
      link%geometric(rigid, :, j) = chord_slope*reference%geometric(rigid, :, j)
      link%geometric(:, rigid, j) = chord_slope*reference%geometric(:, rigid, j)
      link%geometric(rigid, rigid, j) = ratio*reference%geometric(rigid, rigid, j)
    end do
    link%terms(:) = ratio**2*reference%terms
    link%axial_terms(:) = ratio*reference%axial_terms
    link%slope_norm(:) = ratio*reference%slope_norm
    link%slope_norm(rigid) = root*reference%slope_norm(rigid)
    link%slope_terms(:) = ratio*reference%slope_terms
    link%slope_terms(rigid) = root*reference%slope_terms(rigid)
    link%curve_station(:, :) = ratio*root*reference%curve_station
    link%sag(:, :) = ratio**4*reference%sag
    call rescale_shapes(reference%bending_shapes, length, ratio**2, link%bending_shapes)
    call rescale_shapes(reference%axial_shapes, length, ratio, link%axial_shapes)
    if (reference%next%pieces > 0) call rescale_next(reference%next, ratio, ratio**2, link%next)
    if (reference%axial_next%pieces > 0) call rescale_next(reference%axial_next, ratio, ratio, &
      link%axial_next)
  end subroutine rescale_link

  !> The shapes of a link, whose displacements grow by a factor with the root of the mass in it.
  pure subroutine rescale_shapes(reference, length, displacement, shapes)
    type(deformation_shapes_t), intent(in) :: reference
    real(wp), intent(in) :: length       !! [m]
    real(wp), intent(in) :: displacement !! factor of displacements
    type(deformation_shapes_t), intent(inout) :: shapes

    real(wp) :: ratio, root

    ratio = length/reference%length
    root = sqrt(ratio)
    shapes%length = length
    shapes%displacement(:, :) = displacement*reference%displacement
    shapes%linear(:, :) = root*reference%linear
    shapes%weight(:) = root*reference%weight
    if (.not. allocated(reference%slope)) return
    shapes%start_slope(:) = root*reference%start_slope
    shapes%end_slope(:) = root*reference%end_slope
    shapes%slope(:, :) = ratio*reference%slope
    shapes%root(:) = root*reference%root
  end subroutine rescale_shapes

  !> The unknowns of the next orders.
  pure subroutine rescale_next(reference, ratio, displacement, next)
    type(next_orders_t), intent(in) :: reference
    real(wp), intent(in) :: ratio        !! of the lengths
    real(wp), intent(in) :: displacement !! factor of displacements, with the root of the mass
    type(next_orders_t), intent(inout) :: next

    real(wp) :: chord, turned, mass
    integer :: e, j, low, high

    chord = sqrt(ratio)*displacement
    turned = ratio*sqrt(ratio)
    mass = displacement**2
    next%mass(:, :) = mass*reference%mass
    next%mass_square(:, :, :) = mass*reference%mass_square
    next%mass_norm(:) = mass*reference%mass_norm
    next%participation(:2, :) = chord*reference%participation(:2, :)
    next%participation(3:, :) = mass*reference%participation(3:, :)
    next%geometric(:, :, :) = ratio**2*reference%geometric
    if (size(next%geometric, 3) > 0) next%geometric(rigid, :, :) = &
      turned*reference%geometric(rigid, :, :)
    next%geometric_square(:, :, :, :) = ratio**2*reference%geometric_square
    do e = 1, next%pieces
      low = (e - 1)*next%number + 1
      high = e*next%number
      next%participation_norm(e) = norm_of_parts(reference%participation_norm(e), &
        sum(reference%participation(:2, low:high)**2), chord, mass)
      do j = 1, size(next%geometric, 3)
        next%geometric_norm(j, e) = norm_of_parts(reference%geometric_norm(j, e), &
          sum(reference%geometric(rigid, low:high, j)**2), turned, ratio**2)
      end do
    end do
  end subroutine rescale_next

  !> Norm of a table of which a part grows by one factor and the rest by another, smaller one: what
  !! is lost by subtraction is then little of the whole.
  pure function norm_of_parts(whole, part, factor, of_rest) result(norm)
    real(wp), intent(in) :: whole   !! norm of the table
    real(wp), intent(in) :: part    !! squared norm of the part
    real(wp), intent(in) :: factor  !! by which the part grows
    real(wp), intent(in) :: of_rest !! and the rest: at most `factor`
    real(wp) :: norm

    norm = sqrt(factor**2*part + of_rest**2*max(0.0_wp, whole**2 - part))
  end function norm_of_parts

end module rescaled_links
