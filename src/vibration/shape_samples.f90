!> Mode shapes at equally spaced points along the links, from any kind of unknowns.
module shape_samples
  use bordered_eigensolver, only: bordered_modes_t
  use deflected_shape, only: shape_point
  use deformation_chain, only: chain_shape, deformation_chain_t
  use deformation_model, only: deformation_model_t
  use elastic_linkages, only: elastic_linkage_t
  use kinds, only: wp
  use linkages, only: cross, drives_angle, drives_slider, linkage_t, normal_to
  use pin_displacements, only: chords_t
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  use positions, only: state_t
  use reduced_shapes, only: reduced_shape_point
  use structures, only: structure_t
  use vibration_models, only: mode_request_t
  implicit none (type, external)
  private

  public :: shapes_t, sample_reduced, sample_chain, sample_nodal

  !> Displacements along the links in every mode, in global axes, with φᵀMφ = 1. The sign is that of
  !! `sign_of`, of parts of `going_round` or `turn_of_all`, whatever the method and the number of
  !! points.
  type :: shapes_t
    real(wp), allocatable :: displacement(:, :, :, :) !! (x, y, rotation; points; bodies; modes)
                                                      !! [kg^-1/2, kg^-1/2, rad kg^-1/2/m]
  end type shapes_t

  !> Places along each link, from 0 to 1, that decide on the sign.
  real(wp), parameter :: place(5) = [0.0_wp, 0.25_wp, 0.5_wp, 0.75_wp, 1.0_wp]
  integer, parameter :: at_middle = 3, at_end = 5

  !> The driven link's pin is at rest if it moves across its link by less than this share of the
  !! largest displacement: well above the rounding of the vectors of any solver, and below what can
  !! be seen in a figure.
  real(wp), parameter :: at_rest = 1.0e-5_wp

  !> Places along each part for the turn of all: modes have many waves.
  integer, parameter :: fine = 65

  !> Within this share displacements, and distances, count as equal.
  real(wp), parameter :: tie = 1.0e-9_wp

contains

  !> Shapes of a model in deformation coordinates.
  pure subroutine sample_reduced(linkage, model, chords, pose, found, request, shapes, elastic)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_model_t), intent(in) :: model !! its links' own deformations
    type(chords_t), intent(in) :: chords           !! at this position
    type(pose_t), intent(in) :: pose               !! of its links
    type(bordered_modes_t), intent(in) :: found    !! modes at this position
    type(mode_request_t), intent(in) :: request    !! modes, points along each link
    type(shapes_t), intent(out) :: shapes          !! of the modes requested
    type(elastic_linkage_t), intent(in), optional :: elastic !! where the links have parts

    real(wp), allocatable :: at(:, :, :)
    real(wp) :: sign_of_mode
    integer :: mode

    allocate (shapes%displacement(3, request%points, size(model%links), request%modes))
    do mode = 1, request%modes
      shapes%displacement(:, :, :, mode) = sampled(mode, request%points)
      at = sampled(mode, size(place))
      if (.not. present(elastic)) then
        sign_of_mode = sign_of(linkage, pose, at)
      else if (abs(going_round(elastic, pose, at)) > at_rest*largest(at)) then
        sign_of_mode = sign(1.0_wp, going_round(elastic, pose, at))
      else
        sign_of_mode = sign(1.0_wp, turn_of_all(elastic, pose, sampled(mode, fine)))
      end if
      shapes%displacement(:, :, :, mode) = sign_of_mode*shapes%displacement(:, :, :, mode)
    end do

  contains

    !> A mode at evenly spaced places of every link.
    pure function sampled(mode, points) result(at)
      integer, intent(in) :: mode, points
      real(wp) :: at(3, points, size(model%links))

      integer :: b, i

      do b = 1, size(model%links)
        do i = 1, points
          at(:, i, b) = reduced_shape_point(model%links, model%layout, chords, pose, &
            found%vector(:, mode), b, real(i - 1, wp)/(points - 1))
        end do
      end do
    end function sampled

  end subroutine sample_reduced

  !> Shapes of a long mesh, as in `sample_reduced`.
  pure subroutine sample_chain(linkage, chain, state, vector, request, shapes)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_chain_t), intent(in) :: chain !! the long mesh at this position
    type(state_t), intent(in) :: state             !! with a pose
    real(wp), intent(in) :: vector(:, :)           !! (unknowns, modes) with xᵀMx = 1
    type(mode_request_t), intent(in) :: request    !! modes, points along each link
    type(shapes_t), intent(out) :: shapes          !! of the modes requested

    real(wp) :: at(3, size(place), size(linkage%bodies)), local(3, request%points), &
      at_places(3, size(place))
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
        at_places = chain_shape(chain, vector(:, mode), b, place)
        do i = 1, size(place)
          at(:, i, b) = in_global_axes(at_places(:, i), state%pose%direction(:, b))
        end do
      end do
      shapes%displacement(:, :, :, mode) = sign_of(linkage, state%pose, &
        at)*shapes%displacement(:, :, :, mode)
    end do
  end subroutine sample_chain

  !> Shapes of a mesh in nodal displacements, as in `sample_reduced`.
  pure subroutine sample_nodal(structure, state, vector, request, shapes)
    type(structure_t), intent(in) :: structure  !! with a mesh
    type(state_t), intent(in) :: state          !! with a pose
    real(wp), intent(in) :: vector(:, :)        !! (unknowns, modes) with xᵀMx = 1
    type(mode_request_t), intent(in) :: request !! modes, points along each link
    type(shapes_t), intent(out) :: shapes       !! of the modes requested

    real(wp) :: at(3, size(place), size(structure%linkage%bodies)), length
    integer :: b, i, mode

    allocate (shapes%displacement(3, request%points, size(structure%linkage%bodies), request%modes))
    do mode = 1, request%modes
      do b = 1, size(structure%linkage%bodies)
        length = structure%linkage%bodies(b)%length
        do i = 1, request%points
          shapes%displacement(:, i, b, mode) = shape_point(structure%linkage, structure%mesh, &
            state%pose, vector(:, mode), b, length*(i - 1)/(request%points - 1))
        end do
        do i = 1, size(place)
          at(:, i, b) = shape_point(structure%linkage, structure%mesh, state%pose, vector(:, &
            mode), b, place(i)*length)
        end do
      end do
      shapes%displacement(:, :, :, mode) = sign_of(structure%linkage, state%pose, &
        at)*shapes%displacement(:, :, :, mode)
    end do
  end subroutine sample_nodal

  !> Turns a displacement along and across a link to global axes; the rotation stays as it is.
  pure function in_global_axes(local, direction) result(global)
    real(wp), intent(in) :: local(3)     !! along, across, rotation
    real(wp), intent(in) :: direction(2) !! of the link
    real(wp) :: global(3)                !! x, y, rotation

    global = [local(1)*direction + local(2)*normal_to(direction), local(3)]
  end function in_global_axes

  !> The sign with which the driven link's moving pin goes round its ground pivot counter-clockwise.
  !!
  !! Where that pin is at rest, the sign that makes the largest transverse displacement at mid-link
  !! positive, in that link's own axes (those of its angle). Displacements within 1e-9 of the
  !! largest count as equal; of these the first link round the loop decides.
  pure function sign_of(linkage, pose, at) result(sign_of_mode)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    real(wp), intent(in) :: at(:, :, :)    !! (x, y, rotation; places; bodies), before
    real(wp) :: sign_of_mode

    real(wp) :: across(size(linkage%bodies)), round
    integer :: b

    round = dot_product(normal_to(pose%direction(:, 1)), at(:2, at_end, 1))
    if (abs(round) > at_rest*largest(at)) then
      sign_of_mode = sign(1.0_wp, round)
      return
    end if
    do b = 1, size(linkage%bodies)
      across(b) = linkage%bodies(b)%heading(1)*dot_product(normal_to(pose%direction(:, b)), at(:2, &
        at_middle, b))
    end do
    b = findloc(abs(across) >= (1.0_wp - tie)*maxval(abs(across)), .true., dim=1)
    sign_of_mode = sign(1.0_wp, across(b))
  end function sign_of

  !> The largest displacement.
  pure function largest(at)
    real(wp), intent(in) :: at(:, :, :) !! (x, y, rotation; places; bodies)
    real(wp) :: largest

    largest = sqrt(maxval(sum(at(:2, :, :)**2, dim=1)))
  end function largest

  !> How far the far end of the driven link goes round the joint of its drive, counter-clockwise,
  !! whatever the order of its pins and however it is cut.
  pure function going_round(elastic, pose, at) result(round)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose       !! of its points and parts
    real(wp), intent(in) :: at(:, :, :)    !! (x, y, rotation; places; parts)
    real(wp) :: round

    real(wp) :: arm(2), farthest
    integer :: i, k

    round = 0.0_wp
    farthest = 0.0_wp
    do k = 1, size(at, 3)
      if (.not. is_driven(elastic, k)) cycle
      do i = 1, size(at, 2)
        arm = arm_of(elastic, pose, k, real(i - 1, wp)/(size(at, 2) - 1))
        if (.not. norm2(arm) > (1.0_wp + tie)*farthest) cycle
        farthest = norm2(arm)
        round = cross(arm, at(:2, i, k))/farthest
      end do
    end do
  end function going_round

  !> How all links that bend turn together about the joint of the first drive, `∫ (r − r0) × u dx`
  !! by Simpson's rule.
  pure function turn_of_all(elastic, pose, at) result(turn)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose       !! of its points and parts
    real(wp), intent(in) :: at(:, :, :)    !! (x, y, rotation; places, odd; parts)
    real(wp) :: turn

    integer :: i, k, n
    real(wp) :: weight

    turn = 0.0_wp
    n = size(at, 2)
    do k = 1, size(at, 3)
      associate (part => elastic%linkage%bodies(k))
        if (.not. part%bends) cycle
        do i = 1, n
          weight = merge(4.0_wp, 2.0_wp, modulo(i, 2) == 0)
          if (i == 1 .or. i == n) weight = 1.0_wp
          turn = turn + weight*part%length*cross(arm_of(elastic, pose, k, real(i - 1, wp)/(n - &
            1)), at(:2, i, k))
        end do
      end associate
    end do
  end function turn_of_all

  !> From the joint of the first drive to a place of a part.
  pure function arm_of(elastic, pose, part, share) result(arm)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: part
    real(wp), intent(in) :: share !! of its way from end to end
    real(wp) :: arm(2)

    associate (first => pose%pin(:, elastic%linkage%bodies(part)%first_pin), &
        last => pose%pin(:, elastic%linkage%bodies(part)%last_pin))
      arm = first + share*(last - first) - pose%pin(:, drive_pin(elastic))
    end associate
  end function arm_of

  !> Whether a part is of the link that the first drive turns.
  pure function is_driven(elastic, part) result(is)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part !! number
    logical :: is

    is = .false.
    if (size(elastic%linkage%drives) == 0) return
    associate (drive => elastic%linkage%drives(1))
      is = drive%kind == drives_angle .and. elastic%body(part) == drive%body
    end associate
  end function is_driven

  !> The pin at which the first drive acts: of a link that turns one that stands still, or that the
  !! link has in common with the one from which its angle is measured; of a slider its own. Without
  !! a drive the first ground pivot.
  pure function drive_pin(elastic) result(pin)
    type(elastic_linkage_t), intent(in) :: elastic
    integer :: pin

    integer, allocatable :: others(:)
    integer :: i, k

    pin = max(1, findloc(elastic%linkage%is_ground, .true., dim=1))
    if (size(elastic%linkage%drives) == 0) return
    associate (parts => elastic%linkage, drive => elastic%linkage%drives(1))
      if (drive%kind == drives_slider) then
        pin = parts%sliders(drive%slider)%pin
        return
      end if
      allocate (others(0))
      do k = 1, size(elastic%body)
        if (elastic%body(k) == drive%against) others = [others, pins_of_body(parts%bodies(k))]
      end do
      do k = 1, size(elastic%body)
        if (elastic%body(k) /= drive%body) cycle
        associate (pins => pins_of_body(parts%bodies(k)))
          do i = 1, size(pins)
            pin = pins(i)
            if (any(others == pin) .or. drive%against == 0 .and. parts%is_ground(pin)) return
          end do
        end associate
      end do
    end associate
  end function drive_pin

end module shape_samples
