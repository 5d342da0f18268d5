!> A link between its pins: what it does of its own, taken apart once a run from what its pins make
!! it do.
!!
!! The displacement of a link is that of its chord, linear between the pins, and its own
!! deformation, which vanishes at both ends (for the clamped link the cubic bending curve that turns
!! its clamped end against the chord is kept apart, too). The own vibrations of the deformation,
!! with the ends held, are the unknowns: mass and stiffness between them are diagonal and do not
!! depend on the position. A position enters only through what the pins do (Craig and Bampton, AIAA
!! J. 6 (1968) 1313, with all modes kept, so that nothing is left out).
module link_modes
  use deformation_places, only: displacement_row, slope_row
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  use next_orders, only: new_next_orders, next_orders_t
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: link_modes_t, held_shapes, new_link_modes, end_rotation, rigid, clamp, &
    stations

  !> Numbers of the first two rows of slopes: the chord's, and the curve of the clamped end; own
  !! modes follow.
  integer, parameter :: rigid = 1, clamp = 2

  !> Places along a link, its ends among them, at which the static deflection is looked at.
  integer, parameter :: stations = 9

  type :: link_modes_t
    integer :: modes = 0        !! transverse
    integer :: axial_modes = 0
    logical :: clamped = .false.
    logical :: bends = .true.                         !! else all that follows is zero or empty but
                                                      !! for the next two
    real(wp) :: length = 0.0_wp                       !! [m]
    !> Mass of a rigid link: between the displacements of its first pin, along it and across it, and
    !! its rotation [kg, kg m, kg m²]
    real(wp) :: rigid_mass(3, 3) = 0.0_wp
    real(wp) :: bending_stiffness = 0.0_wp            !! EI [N m²]
    real(wp) :: elongation = 0.0_wp                   !! √(L/EA): of a unit unknown [m/√J]
    real(wp) :: end_rotation = 0.0_wp                 !! √(L/3EI + 1/(kGA L)): of a unit unknown of
                                                      !! the clamped end [rad/√J]
    real(wp), allocatable :: square(:)                !! (modes) 1/ω² of the link with its ends
                                                      !! held, descending [s²]
    !> (3, modes) `∫ μ f w + ρI θ_f θ_w dx` with 1 − ξ, ξ and the curve of the clamped end
    real(wp), allocatable :: participation(:, :)
    real(wp) :: linear(3, 3) = 0.0_wp                 !! the same between these three
    real(wp) :: axial_linear(2, 2) = 0.0_wp           !! `∫ μ f g dx` of 1 − ξ and ξ along the link,
                                                      !! which turn nothing
    real(wp), allocatable :: axial_square(:)          !! (axial modes) [s²]
    real(wp), allocatable :: axial_participation(:, :) !! (2, axial modes)
    real(wp), allocatable :: geometric(:, :, :)       !! (2 + modes, 2 + modes, force functions) `∫
                                                      !! b v' v' dx`
    !> Norms of the magnitudes of which the curve of the clamped end (0) and the own modes are made:
    !! as large as the modes, or larger where terms cancel in them (0:modes; modes) [√kg]
    real(wp), allocatable :: terms(:)                 !! from 0
    real(wp), allocatable :: axial_terms(:)
    real(wp), allocatable :: slope_norm(:)            !! (2 + modes) norms of the slopes of the
                                                      !! chord, the curve of the clamped end, the
                                                      !! own modes
    real(wp), allocatable :: slope_terms(:)           !! (2 + modes) and of the magnitudes in them
    type(next_orders_t) :: next                       !! of the transverse displacement
    type(next_orders_t) :: axial_next
    real(wp) :: clamp_station(stations) = 0.0_wp      !! the curve of the clamped end there
    real(wp) :: sag(stations, 2) = 0.0_wp             !! deflection there of the held link under the
                                                      !! loads μ (1 − ξ) and μ ξ
    real(wp), allocatable :: bending(:, :)            !! (bending unknowns, 0:modes) the modes in
                                                      !! the unknowns of the shapes
    real(wp), allocatable :: axial(:, :)              !! (axial unknowns, axial modes)
    type(deformation_shapes_t) :: bending_shapes, axial_shapes
  end type link_modes_t

contains

  !> The displacements whose singular values are √(1/ω²) of the link with its ends held, and the
  !! unknowns of each.
  !!
  !! For the clamped link its rotation at the clamp is held as well: the shapes are those
  !! perpendicular to the curve that turns it.
  pure subroutine held_shapes(shapes, kept, clamped, basis, displacement)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: kept    !! unknowns in use, the first of all
    logical, intent(in) :: clamped !! at the first end, else hinged
    real(wp), allocatable, intent(out) :: basis(:, :)        !! (kept, shapes) orthonormal
    real(wp), allocatable, intent(out) :: displacement(:, :) !! (coefficients, shapes)

    real(wp) :: mirror(kept)
    integer :: i, first

    first = merge(2, 1, clamped)
    allocate (basis(kept, kept - first + 1))
    basis = 0.0_wp
    do i = first, kept
      basis(i, i - first + 1) = 1.0_wp
    end do
    if (clamped) then
      ! Householder's reflection that takes the first axis to the curve of the clamped end; the
      ! other axes go to its complement.
      mirror = clamp_curve(shapes, kept)
      mirror(1) = mirror(1) + sign(1.0_wp, mirror(1))
      mirror = mirror/norm2(mirror)
      do i = 1, kept - 1
        basis(:, i) = basis(:, i) - 2.0_wp*mirror*mirror(i + 1)
      end do
    end if
    displacement = matmul(shapes%displacement(:, :kept), basis)
  end subroutine held_shapes

  !> The unknowns of the curve that turns the first end: unit length, the moment linear along the
  !! link.
  pure function clamp_curve(shapes, kept) result(curve)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: kept
    real(wp) :: curve(kept)

    curve = shapes%start_slope(:kept)/norm2(shapes%start_slope(:kept))
  end function clamp_curve

  !> Everything about a link that does not change with the position.
  pure subroutine new_link_modes(bending, axial, clamped, stiffness, lumped, jumps, own, &
    axial_own, link)
    type(deformation_shapes_t), intent(in) :: bending !! shapes of transverse displacement
    type(deformation_shapes_t), intent(in) :: axial   !! shapes of axial displacement
    logical, intent(in) :: clamped          !! its first end is clamped to a moving body, not hinged
    real(wp), intent(in) :: stiffness(2)    !! EA and EI [N, N m²]; `bending` knows kGA
    logical, intent(in) :: lumped           !! axial forces are constant in each element; else 1, ξ,
                                            !! ξ² along the link
    real(wp), intent(in) :: jumps(:)        !! ξ where they jump as well: to a force that acts from
                                            !! the first end up to there
    real(wp), intent(in) :: own(:, :)       !! (kept, modes) right singular vectors of the held
                                            !! shapes, in the unknowns in use, the first of all
    real(wp), intent(in) :: axial_own(:, :) !! (axial kept, axial modes)
    type(link_modes_t), intent(out) :: link !! with all its integrals

    real(wp), allocatable :: shape(:, :), slope(:, :), functions(:, :)
    integer :: i, kept, moved

    kept = size(own, 1)
    link%modes = size(own, 2)
    link%axial_modes = size(axial_own, 2)
    link%clamped = clamped
    link%length = bending%length
    link%bending_stiffness = stiffness(2)
    link%elongation = sqrt(bending%length/stiffness(1))
    link%end_rotation = end_rotation(bending%length, stiffness(2), bending%shear_stiffness)
    link%bending_shapes = bending
    link%axial_shapes = axial
    allocate (link%bending(kept, 0:link%modes))
    link%bending(:, 0) = 0.0_wp
    if (clamped) link%bending(:, 0) = clamp_curve(bending, kept)
    link%bending(:, 1:) = own
    call turn_last_end_up(link)
    link%axial = axial_own

    ! In scaled coefficients the integrals of products are scalar products.
    shape = matmul(bending%displacement(:, :kept), link%bending)
    link%square = [(dot_product(shape(:, i + 1), shape(:, i + 1)), i=1, link%modes)]
    allocate (link%participation(3, link%modes))
    link%participation(1:2, :) = matmul(transpose(bending%linear), shape(:, 2:))
    link%participation(3, :) = matmul(shape(:, 1), shape(:, 2:))
    link%linear(1:2, 1:2) = matmul(transpose(bending%linear), bending%linear)
    moved = bending%coefficients*bending%elements
    associate (line => bending%linear(:moved, :), &
      lumps => bending%linear(size(bending%linear, 1) - bending%lumps + 1:, :))
      link%axial_linear = matmul(transpose(line), line) + matmul(transpose(lumps), lumps)
    end associate
    link%linear(1:2, 3) = matmul(transpose(bending%linear), shape(:, 1))
    link%linear(3, 1:2) = link%linear(1:2, 3)
    link%linear(3, 3) = dot_product(shape(:, 1), shape(:, 1))

    allocate (slope(size(bending%place), link%modes + 2))
    slope(:, rigid) = bending%root
    slope(:, clamp:) = matmul(bending%slope(:, :kept), link%bending)
    call integrate_slopes(bending, lumped, jumps, slope, link%geometric)
    allocate (link%terms(0:link%modes))
    link%terms = norms_of_terms(bending%displacement(:, :kept), link%bending)
    link%slope_norm = norm2(slope, dim=1)
    link%slope_terms = [link%slope_norm(rigid), norms_of_terms(bending%slope(:, :kept), &
      link%bending)]
    call place_stations(link)
    call add_axial(axial, size(axial_own, 1), link)
    if (bending%by_degree .and. bending%unknowns > kept .and. .not. lumped) then
      functions = reshape([bending%linear, shape(:, 1)], [size(shape, 1), 3])
      link%next = new_next_orders(bending, shape(:, 2:), functions, slope, jumps)
    end if
  end subroutine new_link_modes

  !> Norms of the columns of `|A| |B|`.
  pure function norms_of_terms(a, b) result(norms)
    real(wp), intent(in) :: a(:, :), b(:, :)
    real(wp) :: norms(size(b, 2))

    norms = norm2(matmul(abs(a), abs(b)), dim=1)
  end function norms_of_terms

  !> Rotation of a link's end under a moment there that does unit work, the other end hinged: the
  !! norm of the start slopes.
  elemental function end_rotation(length, bending_stiffness, shear_stiffness) result(rotation)
    real(wp), intent(in) :: length            !! [m]
    real(wp), intent(in) :: bending_stiffness !! EI [N m²]
    real(wp), intent(in) :: shear_stiffness   !! kGA [N]; 0: rigid in shear
    real(wp) :: rotation                      !! √(L/3EI + 1/(kGA L)) [rad/√J]

    real(wp) :: squared

    squared = length/(3.0_wp*bending_stiffness)
    if (shear_stiffness > 0.0_wp) squared = squared + 1.0_wp/(shear_stiffness*length)
    rotation = sqrt(squared)
  end function end_rotation

  !> Gives every own mode a positive slope at the last end: the same mode has the same sign in
  !! models of any order.
  pure subroutine turn_last_end_up(link)
    type(link_modes_t), intent(inout) :: link

    real(wp) :: row(link%bending_shapes%unknowns)
    integer :: i

    row = slope_row(link%bending_shapes, 1.0_wp)
    do i = 1, link%modes
      if (dot_product(row(:size(link%bending, 1)), link%bending(:, i)) < 0.0_wp) link%bending(:, &
        i) = -link%bending(:, i)
    end do
  end subroutine turn_last_end_up

  !> `∫ b f g dx` of slopes f and g, for every axial force function b.
  pure subroutine integrate_slopes(shapes, lumped, jumps, slope, integral)
    type(deformation_shapes_t), intent(in) :: shapes
    logical, intent(in) :: lumped
    real(wp), intent(in) :: jumps(:)
    real(wp), intent(in) :: slope(:, :) !! (Gauss points, functions) with the root of the weight
    real(wp), allocatable, intent(out) :: integral(:, :, :)

    real(wp) :: force(size(shapes%place)), sum_so_far(size(slope, 2), size(slope, 2))
    integer :: i, j, smooth, first, last, order(size(jumps))

    smooth = merge(shapes%elements, 3, lumped)
    allocate (integral(size(slope, 2), size(slope, 2), smooth + size(jumps)))
    do j = 1, smooth
      force = force_function(shapes, lumped, j)
      integral(:, :, j) = matmul(transpose(slope), spread(force, 2, size(slope, 2))*slope)
    end do
    ! The force that ends at a jump is 1 up to there: integrals are summed up along the link.
    sum_so_far = 0.0_wp
    first = 1
    order = ascending_order(jumps)
    do i = 1, size(jumps)
      last = count(shapes%place < jumps(order(i)))
      sum_so_far = sum_so_far + matmul(transpose(slope(first:last, :)), slope(first:last, :))
      integral(:, :, smooth + order(i)) = sum_so_far
      first = last + 1
    end do
  end subroutine integrate_slopes

  !> One of the axial forces of which all others are made, at the Gauss points.
  pure function force_function(shapes, lumped, j) result(force)
    type(deformation_shapes_t), intent(in) :: shapes
    logical, intent(in) :: lumped
    integer, intent(in) :: j
    real(wp) :: force(size(shapes%place))

    if (lumped) then
      force = merge(1.0_wp, 0.0_wp, ceiling(shapes%place*shapes%elements) == j)
    else
      force = shapes%place**(j - 1)
    end if
  end function force_function

  pure subroutine place_stations(link)
    type(link_modes_t), intent(inout) :: link

    real(wp) :: row(link%bending_shapes%unknowns), at_station(0:link%modes)
    integer :: i

    do i = 1, stations
      row = displacement_row(link%bending_shapes, real(i - 1, wp)/(stations - 1))
      at_station = matmul(row(:size(link%bending, 1)), link%bending)
      link%clamp_station(i) = at_station(0)
      link%sag(i, :) = matmul(link%participation(1:2, :), at_station(1:))
    end do
  end subroutine place_stations

  pure subroutine add_axial(axial, kept, link)
    type(deformation_shapes_t), intent(in) :: axial
    integer, intent(in) :: kept
    type(link_modes_t), intent(inout) :: link

    real(wp), allocatable :: shape(:, :)
    real(wp) :: no_slope(0, 0), no_jumps(0)
    integer :: i

    shape = matmul(axial%displacement(:, :kept), link%axial)
    link%axial_square = [(dot_product(shape(:, i), shape(:, i)), i=1, link%axial_modes)]
    link%axial_participation = matmul(transpose(axial%linear), shape)
    link%axial_terms = norms_of_terms(axial%displacement(:, :kept), link%axial)
    if (axial%by_degree .and. axial%unknowns > kept) link%axial_next = new_next_orders(axial, &
      shape, axial%linear, no_slope, no_jumps)
  end subroutine add_axial

end module link_modes
