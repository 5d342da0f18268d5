!> Contribution of masses fixed to a link to the mass matrix of its deformations.
!!
!! A mass m is fixed to the cross-section at its place, beside the axis by an offset e to the left.
!! With the rotation θ of the cross-section it moves by u − e θ along the link and by v across it,
!! and its own moment of inertia I turns by θ: `½ m ((u − e θ)² + v²) + ½ I θ²`.
module lump_displacements
  use body_lumps, only: has_turning_lumps, lump_inertias, lump_masses, lump_offsets, lump_places
  use deformation_places, only: displacement_row, rotation_row
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  use linkages, only: body_t
  implicit none (type, external)
  private

  public :: lump_arms_t, add_lump_displacements, add_lump_rotations, rows_before_lumps, &
    new_lump_arms

  !> What bending does to the masses that turn with the cross-sections of a link.
  type :: lump_arms_t
    !> (lumps, unknowns) `−√m e θ`, along the link [s]
    real(wp), allocatable :: displacement(:, :)
    real(wp), allocatable :: linear(:, :) !! (lumps, 2) the same of 1 − ξ and ξ across [√kg]
    real(wp), allocatable :: turn(:, :)   !! (lumps, unknowns) `√L θ` [√m/√J]
  end type lump_arms_t

contains

  !> Adds rows for the masses of a link: the displacement at their places times the root of the
  !! mass. Scalar products of columns then include these masses.
  pure subroutine add_lump_displacements(body, shapes)
    type(body_t), intent(in) :: body                    !! the masses
    type(deformation_shapes_t), intent(inout) :: shapes !! of this body, without lumps

    real(wp), allocatable :: mass(:), xi(:)
    integer :: i, rows

    mass = lump_masses(body)
    if (size(mass) == 0) return
    xi = lump_places(body)
    shapes%lumps = size(mass)
    call add_rows(shapes, size(mass), rows)
    do i = 1, size(mass)
      shapes%displacement(rows + i, :) = sqrt(mass(i))*displacement_row(shapes, xi(i))
      shapes%linear(rows + i, :) = sqrt(mass(i))*[1.0_wp - xi(i), xi(i)]
    end do
  end subroutine add_lump_displacements

  !> Adds rows for the masses of a link that have a moment of inertia of their own: the rotation of
  !! the cross-section at their places times its root.
  pure subroutine add_lump_rotations(body, shapes)
    type(body_t), intent(in) :: body                    !! the masses
    type(deformation_shapes_t), intent(inout) :: shapes !! bending of this body, with its lumps

    real(wp), allocatable :: inertia(:), xi(:)
    integer :: i, row

    inertia = lump_inertias(body)
    shapes%turning_lumps = count(inertia > 0.0_wp)
    if (shapes%turning_lumps == 0) return
    xi = lump_places(body)
    call add_rows(shapes, shapes%turning_lumps, row)
    do i = 1, size(inertia)
      if (inertia(i) <= 0.0_wp) cycle
      row = row + 1
      shapes%displacement(row, :) = sqrt(inertia(i))*rotation_row(shapes, xi(i))
      shapes%linear(row, :) = sqrt(inertia(i))/shapes%length*[-1.0_wp, 1.0_wp]
    end do
  end subroutine add_lump_rotations

  !> Number of the rows of displacements before those of the masses.
  pure function rows_before_lumps(shapes) result(rows)
    type(deformation_shapes_t), intent(in) :: shapes !! with its lumps
    integer :: rows

    rows = size(shapes%displacement, 1) - shapes%turning_lumps - shapes%lumps
  end function rows_before_lumps

  !> The arms of all masses of a link of which one turns with its cross-section; else none.
  pure function new_lump_arms(body, shapes) result(arms)
    type(body_t), intent(in) :: body                 !! the masses
    type(deformation_shapes_t), intent(in) :: shapes !! bending of this body
    type(lump_arms_t) :: arms

    real(wp), allocatable :: mass(:), xi(:), offset(:)
    real(wp) :: rotation(shapes%unknowns)
    integer :: i, lumps

    mass = lump_masses(body)
    xi = lump_places(body)
    offset = lump_offsets(body)
    lumps = merge(size(mass), 0, has_turning_lumps(body))
    allocate (arms%displacement(lumps, shapes%unknowns), arms%linear(lumps, 2), &
      arms%turn(lumps, shapes%unknowns))
    do i = 1, lumps
      rotation = rotation_row(shapes, xi(i))
      arms%displacement(i, :) = -sqrt(mass(i))*offset(i)*rotation
      arms%linear(i, :) = -sqrt(mass(i))*offset(i)/shapes%length*[-1.0_wp, 1.0_wp]
      arms%turn(i, :) = sqrt(shapes%length)*rotation
    end do
  end function new_lump_arms

  !> Adds empty rows at the end.
  pure subroutine add_rows(shapes, number, before)
    type(deformation_shapes_t), intent(inout) :: shapes
    integer, intent(in) :: number  !! of new rows
    integer, intent(out) :: before !! rows so far

    real(wp), allocatable :: displacement(:, :), linear(:, :)

    before = size(shapes%displacement, 1)
    allocate (displacement(before + number, shapes%unknowns), linear(before + number, 2))
    displacement(:before, :) = shapes%displacement
    linear(:before, :) = shapes%linear
    call move_alloc(displacement, shapes%displacement)
    call move_alloc(linear, shapes%linear)
  end subroutine add_rows

end module lump_displacements
