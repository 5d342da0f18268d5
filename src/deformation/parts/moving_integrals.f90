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

  !> All functions of a link that bends, in coefficients in which integrals of products are scalar
  !! products of columns: displacements of elements, then of masses.
  type :: beam_functions_t
    real(wp), allocatable :: across(:, :) !! (rows, functions) v
    real(wp), allocatable :: along(:, :)  !! (rows, functions) u
    real(wp), allocatable :: spin(:, :)   !! (rows, functions) rotations of cross-sections, then of
                                          !! masses with a moment of inertia
  end type beam_functions_t

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

  !> Integrals of products are scalar products of the columns of `beam_functions_t`.
  pure function integrals_of_beam(body, link) result(integrals)
    type(body_t), intent(in) :: body
    type(link_modes_t), intent(in) :: link
    type(moving_integrals_t) :: integrals

    type(beam_functions_t) :: functions
    integer :: all_functions, i, lumps, rows

    integrals%chord = chord_functions(link)
    integrals%own = link%modes + link%axial_modes
    all_functions = integrals%chord + integrals%own
    functions = new_beam_functions(body, link, integrals%chord, all_functions)
    associate (v => functions%across, u => functions%along, spin => functions%spin)
      integrals%mass = matmul(transpose(v), v) + matmul(transpose(u), u) + &
        matmul(transpose(spin), spin)
      integrals%swap = matmul(transpose(v), u)
      integrals%swap = integrals%swap - transpose(integrals%swap)
      rows = link%bending_shapes%rotations*link%bending_shapes%elements
      allocate (integrals%rotary(merge(all_functions, 0, rows > 0), merge(all_functions, 0, &
        rows > 0)))
      if (rows > 0) integrals%rotary = matmul(transpose(spin(:rows, :)), spin(:rows, :))
      call set_own(link, integrals)
      lumps = link%bending_shapes%lumps
      allocate (integrals%at_mass(all_functions, merge(lumps, 0, link%coupled)))
      do i = 1, size(integrals%at_mass, 2)
        ! The root of every mass is in its row: 1 − ξ and ξ add up to it.
        associate (row => v(size(v, 1) - lumps + i, :))
          integrals%at_mass(:, i) = sum(row(1:2))*row
        end associate
      end do
    end associate
  end function integrals_of_beam

  !> The own modes are orthogonal: their masses are set exactly.
  pure subroutine set_own(link, integrals)
    type(link_modes_t), intent(in) :: link
    type(moving_integrals_t), intent(inout) :: integrals

    integer :: i

    do i = 1, integrals%own
      integrals%mass(integrals%chord + 1:, integrals%chord + i) = 0.0_wp
      if (i <= link%modes) then
        integrals%mass(integrals%chord + i, integrals%chord + i) = link%square(i)
      else
        integrals%mass(integrals%chord + i, integrals%chord + i) = &
          link%axial_square(i - link%modes)
      end if
    end do
  end subroutine set_own

  !> All functions of a link that bends.
  pure function new_beam_functions(body, link, chord, number) result(functions)
    type(body_t), intent(in) :: body
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: chord, number !! functions of the chord; all functions
    type(beam_functions_t) :: functions

    real(wp), allocatable :: shape(:, :)
    integer :: before, first, own, rows

    own = chord + 1
    shape = matmul(link%bending_shapes%displacement(:, :size(link%bending, 1)), link%bending)
    associate (bending => link%bending_shapes)
      rows = max(bending%coefficients, link%axial_shapes%coefficients)*bending%elements
      allocate (functions%across(rows + bending%lumps, number), &
        functions%along(rows + bending%lumps, number), &
        functions%spin(bending%rotations*bending%elements + bending%turning_lumps, number))
    end associate
    associate (bending => link%bending_shapes, v => functions%across, u => functions%along, &
        spin => functions%spin)
      v = 0.0_wp
      u = 0.0_wp
      spin = 0.0_wp
      call copy_elements(link, shape, own, v)
      call copy_along(link, merge(own, own + link%modes, link%coupled), rows, u)
      first = rows_before_lumps(bending)
      before = bending%coefficients*bending%elements
      if (bending%rotations > 0) call copy_across(link, shape, own, before, &
        spin(:first - before, :))
      call copy_across(link, shape, own, first + bending%lumps, spin(first - before + 1:, :))
      call copy_across(link, shape, own, first, v(rows + 1:, :))
      if (link%coupled) call add_arms(body, link, own, u(rows + 1:, :))
    end associate
  end function new_beam_functions

  !> Displacements of elements across the link.
  pure subroutine copy_elements(link, shape, own, v)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: shape(:, :)  !! (rows of `bending_shapes`, curves, then own modes)
    integer, intent(in) :: own           !! number of the first own mode
    real(wp), intent(inout) :: v(:, :)   !! (rows, functions)

    integer :: e, rows, stride

    rows = link%bending_shapes%coefficients
    stride = max(rows, link%axial_shapes%coefficients)
    do e = 1, link%bending_shapes%elements
      call copy_across(link, shape, own, (e - 1)*rows, v((e - 1)*stride + 1:(e - 1)*stride + rows, &
        :))
    end do
  end subroutine copy_elements

  !> Displacements along the link: of elements, then of masses.
  pure subroutine copy_along(link, first, before_masses, u)
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: first         !! number of the first function of own modes along the link
    integer, intent(in) :: before_masses !! rows of all elements
    real(wp), intent(inout) :: u(:, :)   !! (rows, functions)

    real(wp), allocatable :: shape(:, :)
    integer :: e, curves, last, rows, stride

    associate (axial => link%axial_shapes)
      shape = matmul(axial%displacement(:, :size(link%axial, 1)), link%axial)
      curves = link%curves
      last = first + size(shape, 2) - 1
      rows = axial%coefficients
      stride = max(rows, link%bending_shapes%coefficients)
      do e = 1, link%bending_shapes%elements
        associate (to => (e - 1)*stride, from => (e - 1)*rows)
          u(to + 1:to + rows, curves + 3:curves + 4) = axial%linear(from + 1:from + rows, :)
          u(to + 1:to + rows, first:last) = shape(from + 1:from + rows, :)
        end associate
      end do
      e = rows*axial%elements
      u(before_masses + 1:, curves + 3:curves + 4) = axial%linear(e + 1:, :)
      u(before_masses + 1:, first:last) = shape(e + 1:, :)
    end associate
  end subroutine copy_along

  !> Rows of functions across the link, from those of the shapes after `before`.
  pure subroutine copy_across(link, shape, own, before, rows)
    type(link_modes_t), intent(in) :: link
    real(wp), intent(in) :: shape(:, :)    !! (rows of `bending_shapes`, curves, then own modes)
    integer, intent(in) :: own             !! number of the first own mode
    integer, intent(in) :: before
    real(wp), intent(inout) :: rows(:, :)  !! (rows, functions)

    integer :: curves, n

    curves = link%curves
    n = size(rows, 1)
    rows(:, 1:2) = link%bending_shapes%linear(before + 1:before + n, :)
    rows(:, 3:2 + curves) = shape(before + 1:before + n, :curves)
    rows(:, own:own + link%modes - 1) = shape(before + 1:before + n, curves + 1:)
  end subroutine copy_across

  !> Masses beside the axis of a link move along it as the link bends.
  pure subroutine add_arms(body, link, own, u)
    type(body_t), intent(in) :: body
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: own         !! number of the first own mode
    real(wp), intent(inout) :: u(:, :) !! (masses, functions)

    type(lump_arms_t) :: arms
    real(wp), allocatable :: shape(:, :)
    integer :: last

    arms = new_lump_arms(body, link%bending_shapes)
    u(:, 1:2) = u(:, 1:2) + arms%linear
    shape = matmul(arms%displacement(:, :size(link%bending, 1)), link%bending)
    u(:, 3:2 + link%curves) = u(:, 3:2 + link%curves) + shape(:, :link%curves)
    last = own + link%modes - 1
    u(:, own:last) = u(:, own:last) + shape(:, link%curves + 1:)
  end subroutine add_arms

end module moving_integrals
