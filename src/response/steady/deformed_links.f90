!> The shape of a link whose deformations are not small, with exact sines and cosines of its slope.
!! Measured from its first end, in axes that turn with the cross-section there.
!!
!! `r' = (1 + ε) e(φ)`, `φ = ψ + γ`, `ψ' = κ`, along the undeformed link: ε, γ and κ are the strains
!! that the unknowns of the deformation stand for at any size. The slope φ is a sum over the
!! unknowns, the place is integrated element by element on Gauss points.
module deformed_links
  use gauss_collocation, only: collocation_t, new_collocation
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use link_rows, only: strain_rows, strain_rows_t
  implicit none (type, external)
  private

  public :: link_points_t, new_link_points, deformed_link_t, deformed_link

  !> Points in an element above the degree of its displacement.
  integer, parameter :: more_points = 3

  !> Strains and rotations at points along a link, per unit of its unknowns: the curves of held
  !! ends, own modes. Rotations are those against the first end.
  type :: link_points_t
    integer :: elements = 0
    type(collocation_t) :: rule                    !! of an element
    real(wp), allocatable :: length(:)             !! (elements) [m]
    real(wp), allocatable :: place(:)              !! (points) from the first end, element by
                                                   !! element [m]
    real(wp), allocatable :: node_place(:)         !! (0:elements) [m]
    real(wp) :: elongation = 0.0_wp                !! axial strain of the elongation unknown
    real(wp), allocatable :: axial(:, :)           !! (points, 1 − curves:own) axial strain
    real(wp), allocatable :: curvature(:, :)       !! (points, 1 − curves:own) [1/m]
    real(wp), allocatable :: shear(:, :)           !! (points, 1 − curves:own) shear strain
    real(wp), allocatable :: turn(:, :)            !! (points, 1 − curves:own) [rad]
    real(wp), allocatable :: node_turn(:, :)       !! (0:elements, 1 − curves:own) [rad]
  end type link_points_t

  !> The shape at many instants.
  type :: deformed_link_t
    real(wp), allocatable :: place(:, :, :)      !! (samples, 2, points) [m]
    real(wp), allocatable :: tangent(:, :, :)    !! (samples, 2, points) r'
    real(wp), allocatable :: slope(:, :)         !! (samples, points) φ [rad]
    real(wp), allocatable :: turn(:, :)          !! (samples, points) ψ [rad]
    real(wp), allocatable :: node_place(:, :, :) !! (samples, 2, 0:elements) [m]
    real(wp), allocatable :: node_turn(:, :)     !! (samples, 0:elements) [rad]
  end type deformed_link_t

contains

  !> Points of a link that bends.
  pure function new_link_points(link) result(points)
    type(link_modes_t), intent(in) :: link
    type(link_points_t) :: points

    type(strain_rows_t) :: start, rows
    integer :: e, i, n, own

    associate (shapes => link%bending_shapes)
      own = link%modes + link%axial_modes
      points%elements = shapes%elements
      points%rule = new_collocation(shapes%coefficients + more_points)
      n = size(points%rule%node)
      points%length = shapes%part*(shapes%length/shapes%elements)
      allocate (points%node_place(0:shapes%elements), points%place(n*shapes%elements))
      points%node_place = shapes%last*(shapes%length/shapes%elements)
      allocate (points%axial(size(points%place), 1 - link%curves:own))
      allocate (points%curvature, points%shear, points%turn, mold=points%axial)
      allocate (points%node_turn(0:shapes%elements, 1 - link%curves:own))
      start = strain_rows(link, 0.0_wp)
      points%elongation = start%elongation
      points%axial = 0.0_wp
      points%shear = 0.0_wp
      do e = 1, shapes%elements
        do i = 1, n
          associate (at => n*(e - 1) + i)
            points%place(at) = points%node_place(e - 1) + points%length(e)*points%rule%node(i)
            rows = strain_rows(link, points%place(at)/shapes%length)
            points%axial(at, 1:) = rows%axial
            points%curvature(at, :) = rows%curvature
            points%turn(at, :) = rows%rotation - start%rotation
            if (shapes%shear_stiffness > 0.0_wp) points%shear(at, :) = &
              rows%shear/shapes%shear_stiffness
          end associate
        end do
      end do
      do e = 0, shapes%elements
        rows = strain_rows(link, points%node_place(e)/shapes%length)
        points%node_turn(e, :) = rows%rotation - start%rotation
      end do
    end associate
  end function new_link_points

  !> The shape of a link.
  pure function deformed_link(points, elongation, own) result(shape_of)
    type(link_points_t), intent(in) :: points
    real(wp), intent(in) :: elongation(:) !! (samples) its elongation unknown [√J]
    real(wp), intent(in) :: own(:, :)     !! (samples, curves + own) curves of held ends, own modes
                                          !! [√J]
    type(deformed_link_t) :: shape_of

    real(wp), dimension(size(own, 1), size(points%rule%node)) :: axial, slope, along, across
    integer :: e, first, last, n, samples

    samples = size(own, 1)
    n = size(points%rule%node)
    allocate (shape_of%place(samples, 2, size(points%place)))
    allocate (shape_of%tangent, mold=shape_of%place)
    allocate (shape_of%node_place(samples, 2, 0:points%elements))
    allocate (shape_of%node_turn(samples, 0:points%elements))
    shape_of%turn = matmul(own, transpose(points%turn))
    shape_of%slope = shape_of%turn + matmul(own, transpose(points%shear))
    shape_of%node_turn = matmul(own, transpose(points%node_turn))
    shape_of%node_place(:, :, 0) = 0.0_wp
    do e = 1, points%elements
      first = n*(e - 1) + 1
      last = n*e
      axial = matmul(own, transpose(points%axial(first:last, :))) + &
        points%elongation*spread(elongation, 2, n)
      slope = shape_of%slope(:, first:last)
      ! r' less the axis of the undeformed link, without the cancellation in 1 − cos φ.
      along = axial - 2.0_wp*(1.0_wp + axial)*sin(0.5_wp*slope)**2
      across = (1.0_wp + axial)*sin(slope)
      shape_of%tangent(:, 1, first:last) = 1.0_wp + along
      shape_of%tangent(:, 2, first:last) = across
      associate (h => points%length(e), before => shape_of%node_place(:, :, e - 1), &
        after => shape_of%node_place(:, :, e), here => shape_of%place(:, :, first:last))
        here(:, 1, :) = spread(before(:, 1), 2, n) + h*(spread(points%rule%node, 1, samples) + &
          matmul(along, transpose(points%rule%matrix)))
        here(:, 2, :) = spread(before(:, 2), 2, n) + h*matmul(across, transpose(points%rule%matrix))
        after(:, 1) = before(:, 1) + h*(1.0_wp + matmul(along, points%rule%weight))
        after(:, 2) = before(:, 2) + h*matmul(across, points%rule%weight)
      end associate
    end do
  end function deformed_link

end module deformed_links
