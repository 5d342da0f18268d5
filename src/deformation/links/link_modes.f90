! src/deformation/links/ - one link in its own deformations: coordinates, own modes, M and K_G.
! In: stiffnesses, length and masses of a link. Out: its `link_modes_t`; of all links M and K_G,
! with the motion of the pins given. Begin with `bending_shapes` in `deformation_shapes.f90`, in
! whose unknowns the elastic energy is ½yᵀy; then `new_link_modes` here, `reduced_mass` in
! `reduced_assembly.f90`.
! Not here: displacements of the pins (`src/deformation/pins`), all links of a linkage
! (`src/vibration/models`).

!> Component modes of a link: fixed-interface modes and constraint modes, once a run (Craig and
!! Bampton, AIAA J. 6 (1968) 1313, with all modes kept, so that nothing is left out).
!!
!! The displacement of a link is linear between the pins, as its chord moves, plus its own
!! deformation, which vanishes at both ends. An end is pinned, or held: then it turns with what is
!! fastened to it. The constraint modes turn held ends against the chord without loads between the
!! ends. With one held end there is one, without a moment at the other end. With two held ends the
!! first turns both by the same angle, the second by opposite angles.
!!
!! The own modes are the vibrations with the ends held. Mass and stiffness between them are diagonal
!! and do not depend on the position, which enters only through the pins.
!!
!! The work of an end moment on a deformation is the product of the deformation with the curve that
!! this moment causes. So these curves are also the rotations of the ends per unit of every unknown,
!! and deformations perpendicular to them do not turn held ends.
!!
!! A link vibrates across and along independently, unless a mass beside its axis couples both. The
!! own modes of a coupled link have both components, and stand in place of the transverse ones. A
!! link with masses that have a moment of inertia of their own is coupled, too.
module link_modes
  use deformation_places, only: displacement_row, slope_row
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  use lump_displacements, only: lump_arms_t, rows_before_lumps
  use next_orders, only: new_next_orders, next_orders_t
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: link_modes_t, held_shapes, coupled_shapes, new_link_modes, rigid, stations

  !> Number of the first row of slopes: that of the chord; curves of held ends and own modes follow.
  integer, parameter :: rigid = 1

  !> Places along a link, its ends among them, at which the static deflection is looked at.
  integer, parameter :: stations = 9

  type :: link_modes_t
    integer :: modes = 0        !! transverse, or of a coupled link all
    integer :: axial_modes = 0  !! 0 of a coupled link
    logical :: coupled = .false. !! masses turn with its cross-sections
    logical :: held(2) = .false. !! first and last end, else pinned; of a link that bends
    integer :: curves = 0        !! one of every held end
    logical :: bends = .true.                         !! else all that follows is zero or empty but
                                                      !! for the next two
    real(wp) :: length = 0.0_wp                       !! [m]
    !> Mass of a rigid link: between the displacements of its first pin, along it and across it, and
    !! its rotation [kg, kg m, kg m²]
    real(wp) :: rigid_mass(3, 3) = 0.0_wp
    real(wp) :: bending_stiffness = 0.0_wp            !! EI [N m²]
    real(wp) :: elongation = 0.0_wp                   !! √(L/EA): of a unit unknown [m/√J]
    real(wp) :: curve_rotation(2) = 0.0_wp            !! of `curve_rotations` [rad/√J]
    real(wp), allocatable :: square(:)                !! (modes) 1/ω² of the link with its ends
                                                      !! held, descending [s²]
    !> (2 + curves, modes) `∫ μ f w + ρI θ_f θ_w dx` with 1 − ξ, ξ and the curves of held ends
    real(wp), allocatable :: participation(:, :)
    real(wp), allocatable :: linear(:, :)             !! (2 + curves, 2 + curves) the same between
                                                      !! these
    !> (2, modes) of a coupled link, with 1 − ξ and ξ along it
    real(wp), allocatable :: along_participation(:, :)
    real(wp), allocatable :: cross_linear(:, :)       !! (2 + curves, 2) of a coupled link, the same
                                                      !! between those and these two
    real(wp) :: axial_linear(2, 2) = 0.0_wp           !! `∫ μ f g dx` of 1 − ξ and ξ along the link,
                                                      !! which turn nothing
    real(wp), allocatable :: axial_square(:)          !! (axial modes) [s²]
    real(wp), allocatable :: axial_participation(:, :) !! (2, axial modes)
    real(wp), allocatable :: geometric(:, :, :)       !! (1 + curves + modes, the same, force
                                                      !! functions) `∫ b v' v' dx`, and L θ θ at the
                                                      !! masses of a coupled link
    !> Norms of the magnitudes of which the curves of held ends (the last is 0) and the own modes
    !! are made: as large as the modes, or larger where terms cancel in them (1 − curves:modes;
    !! modes) [√kg]
    real(wp), allocatable :: terms(:)                 !! from 1 − curves
    real(wp), allocatable :: axial_terms(:)
    real(wp), allocatable :: slope_norm(:)            !! (1 + curves + modes) norms of the slopes of
                                                      !! the chord, the curves of held ends, the
                                                      !! own modes
    real(wp), allocatable :: slope_terms(:)           !! (1 + curves + modes) and of the magnitudes
                                                      !! in them
    type(next_orders_t) :: next                       !! of the transverse displacement
    type(next_orders_t) :: axial_next
    real(wp), allocatable :: curve_station(:, :)      !! (stations, curves) the curves there
    real(wp), allocatable :: sag(:, :)                !! (stations, loads) deflection there of the
                                                      !! held link under the loads μ (1 − ξ) and μ ξ
                                                      !! across it; of a coupled link also along it,
                                                      !! and under m across it at every mass
    !> (masses, 2 + curves + modes) of a coupled link: `m (1 − ξ)`, m ξ, m times the curves and the
    !! own modes there
    real(wp), allocatable :: at_mass(:, :)
    real(wp), allocatable :: bending(:, :)            !! (bending unknowns, 1 − curves:modes) curves
                                                      !! and modes in the unknowns of the shapes
    real(wp), allocatable :: axial(:, :)              !! (axial unknowns, axial modes or all)
    type(deformation_shapes_t) :: bending_shapes, axial_shapes
  end type link_modes_t

contains

  !> The displacements whose singular values are √(1/ω²) of the link with its ends held, and the
  !! unknowns of each.
  !!
  !! The rotation of a held end is held as well: the shapes are those perpendicular to the curves
  !! that turn such ends.
  pure subroutine held_shapes(shapes, kept, held, basis, displacement)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: kept    !! unknowns in use, the first of all
    logical, intent(in) :: held(2) !! first and last end, else pinned; of axial shapes none
    real(wp), allocatable, intent(out) :: basis(:, :)        !! (kept, shapes) orthonormal
    real(wp), allocatable, intent(out) :: displacement(:, :) !! (coefficients, shapes)

    real(wp) :: curves(kept, count(held)), mirror(kept, count(held))
    integer :: c, i, first

    first = count(held) + 1
    allocate (basis(kept, kept - first + 1))
    basis = 0.0_wp
    do i = first, kept
      basis(i, i - first + 1) = 1.0_wp
    end do
    if (any(held)) then
      ! Householder's reflections that take the first axis to the first curve, and the second one to
      ! the second; the other axes go to their complement.
      curves = held_curves(shapes, kept, held)
      do c = 1, size(curves, 2)
        mirror(:, c) = curves(:, c)
        if (c > 1) then
          mirror(:, c) = reflected(mirror(:, 1), mirror(:, c))
          mirror(:c - 1, c) = 0.0_wp
          mirror(:, c) = mirror(:, c)/norm2(mirror(:, c))
        end if
        mirror(c, c) = mirror(c, c) + sign(1.0_wp, mirror(c, c))
        mirror(:, c) = mirror(:, c)/norm2(mirror(:, c))
      end do
      do c = size(curves, 2), 1, -1
        do i = first, kept
          basis(:, i - first + 1) = reflected(mirror(:, c), basis(:, i - first + 1))
        end do
      end do
    end if
    displacement = matmul(shapes%displacement(:, :kept), basis)
  end subroutine held_shapes

  !> The mirror image of a vector in the plane across another one of unit length.
  pure function reflected(mirror, vector) result(image)
    real(wp), intent(in) :: mirror(:), vector(:)
    real(wp) :: image(size(vector))

    image = vector - 2.0_wp*mirror*dot_product(mirror, vector)
  end function reflected

  !> The displacements of a coupled link, across and along, from the held shapes of both: its masses
  !! beside the axis move along it with either.
  pure function coupled_shapes(across, along, arms) result(displacement)
    real(wp), intent(in) :: across(:, :) !! (rows, shapes) of bending
    real(wp), intent(in) :: along(:, :)  !! (rows, axial shapes) with the masses last
    real(wp), intent(in) :: arms(:, :)   !! (masses, shapes) what bending does along the link
    real(wp) :: displacement(size(across, 1) + size(along, 1), size(across, 2) + size(along, 2))

    integer :: rows

    displacement = 0.0_wp
    rows = size(across, 1)
    displacement(:rows, :size(across, 2)) = across
    displacement(rows + 1:, size(across, 2) + 1:) = along
    rows = size(displacement, 1) - size(arms, 1)
    displacement(rows + 1:, :size(across, 2)) = arms
  end function coupled_shapes

  !> The unknowns of the curves that turn held ends, of unit length: the moment is linear along the
  !! link. Those of both ends are as long as each other, so that their sum and difference are
  !! perpendicular.
  pure function held_curves(shapes, kept, held) result(curves)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: kept
    logical, intent(in) :: held(2)
    real(wp) :: curves(kept, count(held))

    integer :: c

    associate (first => shapes%start_slope(:kept), last => shapes%end_slope(:kept))
      if (all(held)) then
        curves(:, 1) = first + last
        curves(:, 2) = first - last
      else if (held(1)) then
        curves(:, 1) = first
      else if (held(2)) then
        curves(:, 1) = last
      end if
    end associate
    do c = 1, size(curves, 2)
      curves(:, c) = curves(:, c)/norm2(curves(:, c))
    end do
  end function held_curves

  !> Everything about a link that does not change with the position.
  pure subroutine new_link_modes(bending, axial, held, stiffness, lumped, jumps, own, &
    axial_own, link, arms)
    type(deformation_shapes_t), intent(in) :: bending !! shapes of transverse displacement
    type(deformation_shapes_t), intent(in) :: axial   !! shapes of axial displacement
    logical, intent(in) :: held(2)          !! first and last end, else pinned
    real(wp), intent(in) :: stiffness(2)    !! EA and EI [N, N m²]; `bending` knows kGA
    logical, intent(in) :: lumped           !! axial forces are constant in each element; else 1, ξ,
                                            !! ξ² along the link
    real(wp), intent(in) :: jumps(:)        !! ξ where they jump as well: to a force that acts from
                                            !! the first end up to there
    real(wp), intent(in) :: own(:, :)       !! (kept, modes) right singular vectors of the held
                                            !! shapes, in the unknowns in use, the first of all
    real(wp), intent(in) :: axial_own(:, :) !! (axial kept, axial modes)
    type(link_modes_t), intent(out) :: link !! with all its integrals
    type(lump_arms_t), intent(in), optional :: arms !! of a coupled link, whose `own` and
                                                    !! `axial_own` are parts of the same modes;
                                                    !! absent or empty: of another

    real(wp), allocatable :: shape(:, :), slope(:, :), functions(:, :), turn(:, :)
    integer :: i, j, kept, moved, first, curves

    kept = size(own, 1)
    link%modes = size(own, 2)
    link%axial_modes = size(axial_own, 2)
    if (present(arms)) link%coupled = size(arms%turn, 1) > 0
    if (link%coupled) link%axial_modes = 0
    link%held = held
    link%curves = count(held)
    link%length = bending%length
    link%bending_stiffness = stiffness(2)
    link%elongation = sqrt(bending%length/stiffness(1))
    link%curve_rotation = curve_rotations(bending%length, stiffness(2), bending%shear_stiffness, &
      held)
    link%bending_shapes = bending
    link%axial_shapes = axial
    curves = link%curves
    allocate (link%bending(kept, 1 - curves:link%modes))
    link%bending(:, :0) = held_curves(bending, kept, held)
    link%bending(:, 1:) = own
    link%axial = axial_own
    call turn_last_end_up(link)

    ! In scaled coefficients the integrals of products are scalar products.
    shape = matmul(bending%displacement(:, :kept), link%bending)
    link%square = [(dot_product(shape(:, i), shape(:, i)), i=curves + 1, curves + link%modes)]
    allocate (link%participation(2 + curves, link%modes), link%linear(2 + curves, 2 + curves))
    link%participation(1:2, :) = matmul(transpose(bending%linear), shape(:, curves + 1:))
    link%linear(1:2, 1:2) = matmul(transpose(bending%linear), bending%linear)
    moved = bending%coefficients*bending%elements
    first = rows_before_lumps(bending)
    associate (line => bending%linear(:moved, :), &
      lumps => bending%linear(first + 1:first + bending%lumps, :))
      link%axial_linear = matmul(transpose(line), line) + matmul(transpose(lumps), lumps)
    end associate
    do i = 1, curves
      link%participation(2 + i, :) = matmul(shape(:, i), shape(:, curves + 1:))
      link%linear(1:2, 2 + i) = matmul(transpose(bending%linear), shape(:, i))
      link%linear(2 + i, 1:2) = link%linear(1:2, 2 + i)
      do j = 1, curves
        link%linear(2 + i, 2 + j) = dot_product(shape(:, i), shape(:, j))
      end do
    end do

    allocate (slope(size(bending%place), 1 + curves + link%modes))
    slope(:, rigid) = bending%root
    slope(:, rigid + 1:) = matmul(bending%slope(:, :kept), link%bending)
    allocate (turn(0, 1 + curves + link%modes))
    if (link%coupled) turn = turns_at_masses(link, arms)
    call integrate_slopes(bending, lumped, jumps, slope, turn, link%geometric)
    allocate (link%terms(1 - curves:link%modes))
    link%terms = norms_of_terms(bending%displacement(:, :kept), link%bending)
    link%slope_norm = norm2(slope, dim=1)
    link%slope_terms = [link%slope_norm(rigid), norms_of_terms(bending%slope(:, :kept), &
      link%bending)]
    if (link%coupled) then
      call add_coupling(bending, axial, arms, shape, turn, link)
    else
      call add_axial(axial, size(axial_own, 1), link)
    end if
    call place_stations(link)
    if (bending%by_degree .and. bending%unknowns > kept .and. .not. lumped) then
      ! The orders beyond neither move nor turn the masses, which are at ends of pieces.
      functions = reshape([bending%linear, shape(:, :curves)], [size(shape, 1), 2 + curves])
      link%next = new_next_orders(bending, shape(:, curves + 1:), functions, slope, jumps)
    end if
  end subroutine new_link_modes

  !> `√L θ` at the masses of the chord, the curves of held ends and the own modes.
  pure function turns_at_masses(link, arms) result(turn)
    type(link_modes_t), intent(in) :: link
    type(lump_arms_t), intent(in) :: arms
    real(wp) :: turn(size(arms%turn, 1), 1 + link%curves + link%modes)

    turn(:, rigid) = sqrt(link%length)
    turn(:, rigid + 1:) = matmul(arms%turn(:, :size(link%bending, 1)), link%bending)
  end function turns_at_masses

  !> Adds what a coupled link does along its axis: by its axial unknowns, and at its masses by
  !! bending.
  pure subroutine add_coupling(bending, axial, arms, shape, turn, link)
    type(deformation_shapes_t), intent(in) :: bending, axial
    type(lump_arms_t), intent(in) :: arms
    real(wp), intent(in) :: shape(:, :) !! (rows, curves + modes) across, of the curves of held ends
                                        !! and the own modes
    real(wp), intent(in) :: turn(:, :)  !! (masses, 1 + curves + modes) of `turns_at_masses`
    type(link_modes_t), intent(inout) :: link

    real(wp), allocatable :: along(:, :), functions(:, :), terms(:, :), masses(:, :)
    integer :: i, first, kept, axial_kept, curves

    kept = size(link%bending, 1)
    axial_kept = size(link%axial, 1)
    curves = link%curves
    allocate (along(size(axial%displacement, 1), 1 - curves:link%modes))
    allocate (terms(size(along, 1), 1 - curves:link%modes), functions(size(along, 1), 2 + curves))
    along(:, :0) = 0.0_wp
    along(:, 1:) = matmul(axial%displacement(:, :axial_kept), link%axial)
    terms(:, :0) = 0.0_wp
    terms(:, 1:) = matmul(abs(axial%displacement(:, :axial_kept)), abs(link%axial))
    first = size(along, 1) - size(arms%turn, 1) + 1
    along(first:, :) = along(first:, :) + matmul(arms%displacement(:, :kept), link%bending)
    terms(first:, :) = terms(first:, :) + matmul(abs(arms%displacement(:, :kept)), &
      abs(link%bending))
    functions = 0.0_wp
    functions(first:, 1:2) = arms%linear
    functions(:, 3:) = along(:, :0)
    do i = 1, link%modes
      link%square(i) = link%square(i) + dot_product(along(:, i), along(:, i))
    end do
    link%participation = link%participation + matmul(transpose(functions), along(:, 1:))
    link%along_participation = matmul(transpose(axial%linear), along(:, 1:))
    link%linear = link%linear + matmul(transpose(functions), functions)
    link%cross_linear = matmul(transpose(functions), axial%linear)
    link%terms = sqrt(link%terms**2 + sum(terms**2, dim=1))
    link%slope_norm = sqrt(link%slope_norm**2 + sum(turn**2, dim=1))
    link%slope_terms = sqrt(link%slope_terms**2 + [sum(turn(:, rigid)**2), &
      sum(matmul(abs(arms%turn(:, :kept)), abs(link%bending))**2, dim=1)])
    first = rows_before_lumps(bending)
    masses = bending%linear(first + 1:first + bending%lumps, :)
    ! The root of every mass is in its row: 1 − ξ and ξ add up to it.
    allocate (link%at_mass(bending%lumps, 2 + curves + link%modes))
    do i = 1, bending%lumps
      link%at_mass(i, :) = sum(masses(i, :))*[masses(i, :), shape(first + i, :)]
    end do
    allocate (link%axial_square(0), link%axial_participation(2, 0), link%axial_terms(0))
    if (axial%by_degree .and. axial%unknowns > axial_kept) link%axial_next = &
      new_next_orders(axial, along(:, 1:), axial%linear, reshape([0.0_wp], [0, 0]), [real(wp) ::])
  end subroutine add_coupling

  !> Norms of the columns of `|A| |B|`.
  pure function norms_of_terms(a, b) result(norms)
    real(wp), intent(in) :: a(:, :), b(:, :)
    real(wp) :: norms(size(b, 2))

    norms = norm2(matmul(abs(a), abs(b)), dim=1)
  end function norms_of_terms

  !> Rotations of held ends by unit unknowns of the curves that turn them: the norms of what all
  !! unknowns turn. Of one held end, its rotation against the chord with the other end pinned; of
  !! two, the sum of both rotations by the first curve, and the first minus the last by the second.
  pure function curve_rotations(length, bending_stiffness, shear_stiffness, &
    held) result(rotation)
    real(wp), intent(in) :: length            !! [m]
    real(wp), intent(in) :: bending_stiffness !! EI [N m²]
    real(wp), intent(in) :: shear_stiffness   !! kGA [N]; 0: rigid in shear
    logical, intent(in) :: held(2)            !! first and last end
    real(wp) :: rotation(2)                   !! √(L/3EI + 1/(kGA L)), 0; of two held ends √(L/3EI +
                                              !! 4/(kGA L)), √(L/EI); 0 where there is no such curve
                                              !! [rad/√J]

    real(wp) :: squared

    rotation = 0.0_wp
    if (.not. any(held)) return
    squared = length/(3.0_wp*bending_stiffness)
    if (shear_stiffness > 0.0_wp) squared = squared + count(held)**2/(shear_stiffness*length)
    rotation(1) = sqrt(squared)
    if (all(held)) rotation(2) = sqrt(length/bending_stiffness)
  end function curve_rotations

  !> Lets every own mode come up to the chord at the last end, by a positive slope there or, where
  !! this end is held, by a negative curvature: the same mode has the same sign in models of any
  !! order. In a coupled link the strain is added.
  pure subroutine turn_last_end_up(link)
    type(link_modes_t), intent(inout) :: link

    real(wp) :: row(link%bending_shapes%unknowns), strain(link%axial_shapes%unknowns), upward
    integer :: i

    if (link%held(2)) then
      row = -link%length*last_curvature(link)
    else
      row = slope_row(link%bending_shapes, 1.0_wp)
    end if
    strain = slope_row(link%axial_shapes, 1.0_wp)
    do i = 1, link%modes
      upward = dot_product(row(:size(link%bending, 1)), link%bending(:, i))
      if (link%coupled) upward = upward + dot_product(strain(:size(link%axial, 1)), &
        link%axial(:, i))
      if (upward >= 0.0_wp) cycle
      link%bending(:, i) = -link%bending(:, i)
      if (link%coupled) link%axial(:, i) = -link%axial(:, i)
    end do
  end subroutine turn_last_end_up

  !> Curvature θ' at the last end per unit of every unknown.
  pure function last_curvature(link) result(row)
    type(link_modes_t), intent(in) :: link
    real(wp) :: row(link%bending_shapes%unknowns) !! [1/(m √J)]

    real(wp) :: h
    integer :: j

    row = 0.0_wp
    associate (shapes => link%bending_shapes)
      h = shapes%length/shapes%elements*shapes%part(shapes%elements)
      do j = 0, ubound(shapes%column, 1)
        associate (column => shapes%column(j, shapes%elements))
          if (column > 0) row(column) = sqrt((2*j + 1)/(link%bending_stiffness*h))
        end associate
      end do
    end associate
  end function last_curvature

  !> `∫ b f g dx` of slopes f and g, for every axial force function b; then the products of the
  !! turns at masses, one after the other.
  pure subroutine integrate_slopes(shapes, lumped, jumps, slope, turn, integral)
    type(deformation_shapes_t), intent(in) :: shapes
    logical, intent(in) :: lumped
    real(wp), intent(in) :: jumps(:)
    real(wp), intent(in) :: slope(:, :) !! (Gauss points, functions) with the root of the weight
    real(wp), intent(in) :: turn(:, :)  !! (masses, functions)
    real(wp), allocatable, intent(out) :: integral(:, :, :)

    real(wp) :: force(size(shapes%place)), sum_so_far(size(slope, 2), size(slope, 2))
    integer :: i, j, smooth, first, last, order(size(jumps))

    smooth = merge(shapes%elements, 3, lumped)
    allocate (integral(size(slope, 2), size(slope, 2), smooth + size(jumps) + size(turn, 1)))
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
    do i = 1, size(turn, 1)
      do j = 1, size(turn, 2)
        integral(:, j, smooth + size(jumps) + i) = turn(i, j)*turn(i, :)
      end do
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

    real(wp) :: row(link%bending_shapes%unknowns), at_station(1 - link%curves:link%modes)
    integer :: i

    allocate (link%sag(stations, 2), link%curve_station(stations, link%curves))
    if (link%coupled) then
      deallocate (link%sag)
      allocate (link%sag(stations, 4 + size(link%at_mass, 1)))
    end if
    do i = 1, stations
      row = displacement_row(link%bending_shapes, real(i - 1, wp)/(stations - 1))
      at_station = matmul(row(:size(link%bending, 1)), link%bending)
      link%curve_station(i, :) = at_station(:0)
      link%sag(i, :2) = matmul(link%participation(1:2, :), at_station(1:))
      if (.not. link%coupled) cycle
      link%sag(i, 3:4) = matmul(link%along_participation, at_station(1:))
      link%sag(i, 5:) = matmul(link%at_mass(:, 3 + link%curves:), at_station(1:))
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
