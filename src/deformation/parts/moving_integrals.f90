!> Integrals over a link that moves: mass between all its functions, and what couples motion along
!! it with motion across it as it turns.
!!
!! The displacement of a link, `d = e u + n v` with its directions e and n, is a sum of functions:
!! those of its chord (1 − ξ and ξ across, the curves of held ends; 1 − ξ and ξ along; of a rigid
!! link its motion along and across at the first pin and its rotation), then its own modes. With
!! `e' = h n`, `n' = −h e` the acceleration per ω2² of a link whose functions have the amplitudes Q
!! is `m Q'' + J (2 h Q' + h' Q) − h² m_t Q` as forces on the functions: the displacement is that of
!! Ulker 2010 (2.65), its rate that of (2.66), and the integrals are those of the kinetic energy,
!! (2.67) and (2.76).
module moving_integrals
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t
  use lump_displacements, only: lump_arms_t, new_lump_arms, rows_before_lumps
  implicit none (type, external)
  private

  public :: moving_integrals_t, new_moving_integrals, chord_functions

  type :: moving_integrals_t
    integer :: chord = 0                  !! functions of the chord
    integer :: own = 0                    !! own modes, transverse, then axial
    real(wp), allocatable :: mass(:, :)   !! m: `∫ μ (u u + v v) + ρI θ θ dx`, with all masses on
                                          !! the link
    real(wp), allocatable :: swap(:, :)   !! J: `∫ μ (v_a u_b − u_a v_b) dx`, antisymmetric
    real(wp), allocatable :: rotary(:, :) !! `∫ ρI θ θ dx`, which is in m and not in m_t; empty:
                                          !! none
    real(wp), allocatable :: at_mass(:, :) !! (functions, masses) of a coupled link: m v at each
  end type moving_integrals_t

contains

  !> Number of functions of the chord of a link.
  elemental function chord_functions(link) result(number)
    type(link_modes_t), intent(in) :: link !! bends or is rigid
    integer :: number

    number = merge(4 + link%curves, 3, link%bends)
  end function chord_functions

  !> The integrals of a link.
  pure function new_moving_integrals(body, link) result(integrals)
    type(body_t), intent(in) :: body       !! its masses
    type(link_modes_t), intent(in) :: link !! its functions
    type(moving_integrals_t) :: integrals

    if (link%bends) then
      integrals = integrals_of_beam(body, link)
    else
      integrals = integrals_of_rigid_link(body, link)
    end if
  end function new_moving_integrals

  pure function integrals_of_rigid_link(body, link) result(integrals)
    type(body_t), intent(in) :: body
    type(link_modes_t), intent(in) :: link
    type(moving_integrals_t) :: integrals

    real(wp) :: mass, first(2)

    integrals%chord = chord_functions(link)
    integrals%mass = link%rigid_mass
    mass = link%rigid_mass(1, 1)
    first = [link%rigid_mass(2, 3), -link%rigid_mass(1, 3)]
    integrals%swap = reshape([0.0_wp, mass, first(1), -mass, 0.0_wp, first(2), &
      -first(1), -first(2), 0.0_wp], [3, 3])
    allocate (integrals%rotary(merge(3, 0, body%rotary_inertia > 0.0_wp), &
      merge(3, 0, body%rotary_inertia > 0.0_wp)), integrals%at_mass(3, 0))
    if (body%rotary_inertia <= 0.0_wp) return
    integrals%rotary = 0.0_wp
    integrals%rotary(3, 3) = body%rotary_inertia*body%length
  end function integrals_of_rigid_link

  !> In scaled coefficients integrals of products are scalar products: of displacements across (v),
  !! along (u), rotations of cross-sections (turns), and of the same at masses.
  pure function integrals_of_beam(body, link) result(integrals)
    type(body_t), intent(in) :: body
    type(link_modes_t), intent(in) :: link
    type(moving_integrals_t) :: integrals

    type(lump_arms_t) :: arms
    real(wp), allocatable :: v(:, :), u(:, :), spin(:, :), shape(:, :), shape_along(:, :)
    integer :: curves, kept, kept_along, all_functions, coefficients, rows, e, i, first, lumps, &
      turning, across_rows, along_rows, own_first, along_first

    associate (bending => link%bending_shapes, axial => link%axial_shapes)
      integrals%chord = chord_functions(link)
      curves = link%curves
      integrals%own = link%modes + link%axial_modes
      all_functions = integrals%chord + integrals%own
      kept = size(link%bending, 1)
      kept_along = size(link%axial, 1)
      own_first = integrals%chord + 1
      along_first = own_first
      if (.not. link%coupled) along_first = own_first + link%modes
      lumps = bending%lumps
      turning = bending%turning_lumps
      coefficients = max(bending%coefficients, axial%coefficients)
      rows = coefficients*bending%elements
      allocate (v(rows + lumps, all_functions), u(rows + lumps, all_functions))
      allocate (spin(bending%rotations*bending%elements + turning, all_functions))
      v = 0.0_wp
      u = 0.0_wp
      spin = 0.0_wp
      shape = matmul(bending%displacement(:, :kept), link%bending)
      shape_along = matmul(axial%displacement(:, :kept_along), link%axial)
      across_rows = bending%coefficients
      along_rows = axial%coefficients
      do e = 1, bending%elements
        associate (to => (e - 1)*coefficients, from => (e - 1)*across_rows, &
          from_along => (e - 1)*along_rows)
          v(to + 1:to + across_rows, 1:2) = bending%linear(from + 1:from + across_rows, :)
          v(to + 1:to + across_rows, 3:2 + curves) = shape(from + 1:from + across_rows, :curves)
          v(to + 1:to + across_rows, own_first:own_first + link%modes - 1) = &
            shape(from + 1:from + across_rows, curves + 1:)
          u(to + 1:to + along_rows, curves + 3:curves + 4) = &
            axial%linear(from_along + 1:from_along + along_rows, :)
          u(to + 1:to + along_rows, along_first:along_first + size(shape_along, 2) - 1) = &
            shape_along(from_along + 1:from_along + along_rows, :)
        end associate
      end do
      first = rows_before_lumps(bending)
      if (bending%rotations > 0) then
        i = across_rows*bending%elements
        call copy_across(spin(:first - i, :), i)
      end if
      call copy_across(spin(first - across_rows*bending%elements + 1:, :), first + lumps)
      call copy_across(v(rows + 1:, :), first)
      i = along_rows*axial%elements
      u(rows + 1:, curves + 3:curves + 4) = axial%linear(i + 1:, :)
      u(rows + 1:, along_first:along_first + size(shape_along, 2) - 1) = shape_along(i + 1:, :)
      if (link%coupled) then
        arms = new_lump_arms(body, bending)
        u(rows + 1:, 1:2) = u(rows + 1:, 1:2) + arms%linear
        shape = matmul(arms%displacement(:, :kept), link%bending)
        u(rows + 1:, 3:2 + curves) = u(rows + 1:, 3:2 + curves) + shape(:, :curves)
        u(rows + 1:, own_first:own_first + link%modes - 1) = u(rows + 1:, &
          own_first:own_first + link%modes - 1) + shape(:, curves + 1:)
      end if
      integrals%mass = matmul(transpose(v), v) + matmul(transpose(u), u) + &
        matmul(transpose(spin), spin)
      integrals%swap = matmul(transpose(v), u)
      integrals%swap = integrals%swap - transpose(integrals%swap)
      rows = bending%rotations*bending%elements
      allocate (integrals%rotary(merge(all_functions, 0, rows > 0), merge(all_functions, 0, &
        rows > 0)))
      if (rows > 0) integrals%rotary = matmul(transpose(spin(:rows, :)), spin(:rows, :))
      ! The own modes are orthogonal: set exactly.
      do i = 1, integrals%own
        integrals%mass(own_first:, integrals%chord + i) = 0.0_wp
        if (i <= link%modes) then
          integrals%mass(integrals%chord + i, integrals%chord + i) = link%square(i)
        else
          integrals%mass(integrals%chord + i, integrals%chord + i) = &
            link%axial_square(i - link%modes)
        end if
      end do
      allocate (integrals%at_mass(all_functions, merge(lumps, 0, link%coupled)))
      do i = 1, size(integrals%at_mass, 2)
        ! The root of every mass is in its row: 1 − ξ and ξ add up to it.
        associate (row => v(size(v, 1) - lumps + i, :))
          integrals%at_mass(:, i) = sum(row(1:2))*row
        end associate
      end do
    end associate

  contains

    !> Rows of functions across the link, from those of the shapes after `before`.
    pure subroutine copy_across(rows_of, before)
      real(wp), intent(inout) :: rows_of(:, :)
      integer, intent(in) :: before

      integer :: n

      n = size(rows_of, 1)
      associate (from => link%bending_shapes%linear)
        rows_of(:, 1:2) = from(before + 1:before + n, :)
      end associate
      rows_of(:, 3:2 + curves) = shape(before + 1:before + n, :curves)
      rows_of(:, own_first:own_first + link%modes - 1) = shape(before + 1:before + n, curves + 1:)
    end subroutine copy_across

  end function integrals_of_beam

end module moving_integrals
