!> Mode shapes at equally spaced points along the links, from any kind of unknowns.
module shape_samples
  use bordered_eigensolver, only: bordered_modes_t
  use deflected_shape, only: shape_point
  use deformation_chain, only: chain_shape, deformation_chain_t
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to
  use pin_displacements, only: chords_t
  use positions, only: state_t
  use reduced_shapes, only: reduced_shape_point
  use structures, only: structure_t
  use vibration_models, only: mode_request_t
  implicit none (type, external)
  private

  public :: shapes_t, sample_reduced, sample_chain, sample_nodal

  !> Displacements along the links in every mode, in global axes, with φᵀMφ = 1. The sign does not
  !! depend on the method: the largest transverse displacement at mid-link is to the left of its
  !! link.
  type :: shapes_t
    real(wp), allocatable :: displacement(:, :, :, :) !! (x, y, rotation; points; bodies; modes)
                                                      !! [kg^-1/2, kg^-1/2, rad kg^-1/2/m]
  end type shapes_t

contains

  !> Shapes of a model in deformation coordinates.
  pure subroutine sample_reduced(linkage, model, chords, state, found, request, shapes)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_model_t), intent(in) :: model !! its links' own deformations
    type(chords_t), intent(in) :: chords           !! at this position
    type(state_t), intent(in) :: state             !! with a pose
    type(bordered_modes_t), intent(in) :: found    !! modes at this position
    type(mode_request_t), intent(in) :: request    !! modes, points along each link
    type(shapes_t), intent(out) :: shapes          !! of the modes requested

    real(wp) :: middle(3, size(model%links))
    integer :: b, i, mode

    allocate (shapes%displacement(3, request%points, size(model%links), request%modes))
    do mode = 1, request%modes
      do b = 1, size(model%links)
        do i = 1, request%points
          shapes%displacement(:, i, b, mode) = reduced_shape_point(model%links, model%layout, &
            chords, state%pose, found%vector(:, mode), b, real(i - 1, wp)/(request%points - 1))
        end do
        middle(:, b) = reduced_shape_point(model%links, model%layout, chords, state%pose, &
          found%vector(:, mode), b, 0.5_wp)
      end do
      shapes%displacement(:, :, :, mode) = mid_link_sign(linkage, state, &
        middle)*shapes%displacement(:, :, :, mode)
    end do
  end subroutine sample_reduced

  !> Shapes of a long mesh, as in `sample_reduced`.
  pure subroutine sample_chain(linkage, chain, state, vector, request, shapes)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_chain_t), intent(in) :: chain !! the long mesh at this position
    type(state_t), intent(in) :: state             !! with a pose
    real(wp), intent(in) :: vector(:, :)           !! (unknowns, modes) with xᵀMx = 1
    type(mode_request_t), intent(in) :: request    !! modes, points along each link
    type(shapes_t), intent(out) :: shapes          !! of the modes requested

    real(wp) :: middle(3, size(linkage%bodies)), local(3, request%points), at_middle(3, 1)
    integer :: b, i, mode

    allocate (shapes%displacement(3, request%points, size(linkage%bodies), request%modes))
    do mode = 1, request%modes
      do b = 1, size(linkage%bodies)
        local = chain_shape(chain, vector(:, mode), b, &
          [(real(i - 1, wp)/(request%points - 1), i=1, request%points)])
        do i = 1, request%points
          shapes%displacement(:, i, b, mode) = in_global_axes(local(:, i), state%pose%direction(:, &
            b))
        end do
        at_middle = chain_shape(chain, vector(:, mode), b, [0.5_wp])
        middle(:, b) = in_global_axes(at_middle(:, 1), state%pose%direction(:, b))
      end do
      shapes%displacement(:, :, :, mode) = mid_link_sign(linkage, state, &
        middle)*shapes%displacement(:, :, :, mode)
    end do
  end subroutine sample_chain

  !> Shapes of a mesh in nodal displacements, as in `sample_reduced`.
  pure subroutine sample_nodal(structure, state, vector, request, shapes)
    type(structure_t), intent(in) :: structure  !! with a mesh
    type(state_t), intent(in) :: state          !! with a pose
    real(wp), intent(in) :: vector(:, :)        !! (unknowns, modes) with xᵀMx = 1
    type(mode_request_t), intent(in) :: request !! modes, points along each link
    type(shapes_t), intent(out) :: shapes       !! of the modes requested

    real(wp) :: middle(3, size(structure%linkage%bodies)), length
    integer :: b, i, mode

    allocate (shapes%displacement(3, request%points, size(structure%linkage%bodies), request%modes))
    do mode = 1, request%modes
      do b = 1, size(structure%linkage%bodies)
        length = structure%linkage%bodies(b)%length
        do i = 1, request%points
          shapes%displacement(:, i, b, mode) = shape_point(structure%linkage, structure%mesh, &
            state%pose, vector(:, mode), b, length*(i - 1)/(request%points - 1))
        end do
        middle(:, b) = shape_point(structure%linkage, structure%mesh, state%pose, vector(:, mode), &
          b, 0.5_wp*length)
      end do
      shapes%displacement(:, :, :, mode) = mid_link_sign(structure%linkage, state, &
        middle)*shapes%displacement(:, :, :, mode)
    end do
  end subroutine sample_nodal

  !> Turns a displacement along and across a link to global axes; the rotation stays as it is.
  pure function in_global_axes(local, direction) result(global)
    real(wp), intent(in) :: local(3)     !! along, across, rotation
    real(wp), intent(in) :: direction(2) !! of the link
    real(wp) :: global(3)                !! x, y, rotation

    global = [local(1)*direction + local(2)*normal_to(direction), local(3)]
  end function in_global_axes

  !> The sign that makes the largest transverse displacement at mid-link positive, in that link's
  !! own axes (those of its angle).
  !!
  !! Displacements within 1e-9 of the largest count as equal; of these the first link round the loop
  !! decides.
  pure function mid_link_sign(linkage, state, middle) result(sign_of_mode)
    type(linkage_t), intent(in) :: linkage
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: middle(:, :) !! (x, y, rotation; bodies) at mid-link
    real(wp) :: sign_of_mode

    real(wp), parameter :: tie = 1.0e-9_wp
    real(wp) :: across(size(linkage%bodies))
    integer :: b

    do b = 1, size(linkage%bodies)
      across(b) = linkage%bodies(b)%sense*dot_product(normal_to(state%pose%direction(:, b)), &
        middle(:2, b))
    end do
    b = findloc(abs(across) >= (1.0_wp - tie)*maxval(abs(across)), .true., dim=1)
    sign_of_mode = sign(1.0_wp, across(b))
  end function mid_link_sign

end module shape_samples
