!> Mode shapes at equally spaced points along the links, from any kind of unknowns.
module shape_samples
  use bordered_eigensolver, only: bordered_modes_t
  use deflected_shape, only: shape_point
  use deformation_model, only: deformation_model_t
  use elastic_linkages, only: elastic_linkage_t
  use kinds, only: wp
  use linkages, only: cross, drive_of_angle, drive_of_slider, linkage_t
  use pin_displacements, only: chords_t
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  use positions, only: state_t
  use reduced_shapes, only: reduced_shape_point
  use structures, only: structure_t
  use vibration_models, only: mode_request_t
  implicit none (type, external)
  private

  public :: shapes_t, sample_reduced, sample_nodal

  !> Displacements along the links in every mode, in global axes, with φᵀMφ = 1. The sign is that of
  !! `turn_at_drive`, or else `turn_of_all`, whatever the method and the number of points.
  type :: shapes_t
    real(wp), allocatable :: displacement(:, :, :, :) !! (x, y, rotation; points; bodies; modes)
                                                      !! [kg^-1/2, kg^-1/2, rad kg^-1/2/m]
  end type shapes_t

  !> Where the first drive acts.
  type :: drive_place_t
    integer :: pin = 1                !! at its joint
    logical, allocatable :: turns(:)  !! (bodies) of the link that it turns
  end type drive_place_t

  !> Places along each link that decide on the sign: of what moves most, and of integrals over
  !! modes, which have many waves.
  integer, parameter :: coarse = 5, fine = 65

  !> The far end of the driven link is at rest if it moves across by less than this share of the
  !! largest displacement: well above the rounding of the vectors of any solver, and below what can
  !! be seen in a figure.
  real(wp), parameter :: at_rest = 1.0e-5_wp

  !> Distances within this share count as equal.
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
    type(elastic_linkage_t), intent(in) :: elastic !! parts of the links

    type(drive_place_t) :: drive
    real(wp) :: turn
    integer :: mode

    drive = place_of_drive(linkage, elastic)
    allocate (shapes%displacement(3, request%points, size(model%links), request%modes))
    do mode = 1, request%modes
      turn = turn_at_drive(linkage, pose, drive, sampled(mode, coarse))
      if (.not. abs(turn) > 0.0_wp) turn = turn_of_all(linkage, pose, drive, sampled(mode, fine))
      shapes%displacement(:, :, :, mode) = sign(1.0_wp, turn)*sampled(mode, request%points)
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

  !> Shapes of a mesh in nodal displacements, as in `sample_reduced`.
  pure subroutine sample_nodal(structure, state, vector, request, shapes)
    type(structure_t), intent(in) :: structure  !! with a mesh
    type(state_t), intent(in) :: state          !! with a pose
    real(wp), intent(in) :: vector(:, :)        !! (unknowns, modes) with xᵀMx = 1
    type(mode_request_t), intent(in) :: request !! modes, points along each link
    type(shapes_t), intent(out) :: shapes       !! of the modes requested

    type(drive_place_t) :: drive
    real(wp) :: turn
    integer :: mode

    associate (linkage => structure%linkage)
      drive = place_of_drive(linkage, structure%elastic)
      allocate (shapes%displacement(3, request%points, size(linkage%bodies), request%modes))
      do mode = 1, request%modes
        turn = turn_at_drive(linkage, state%pose, drive, sampled(mode, coarse))
        if (.not. abs(turn) > 0.0_wp) turn = turn_of_all(linkage, state%pose, drive, &
          sampled(mode, fine))
        shapes%displacement(:, :, :, mode) = sign(1.0_wp, turn)*sampled(mode, request%points)
      end do
    end associate

  contains

    !> A mode at evenly spaced places of every link.
    pure function sampled(mode, points) result(at)
      integer, intent(in) :: mode, points
      real(wp) :: at(3, points, size(structure%linkage%bodies))

      integer :: b, i

      do b = 1, size(structure%linkage%bodies)
        do i = 1, points
          at(:, i, b) = shape_point(structure%linkage, structure%mesh, state%pose, vector(:, &
            mode), b, structure%linkage%bodies(b)%length*(i - 1)/(points - 1))
        end do
      end do
    end function sampled

  end subroutine sample_nodal

  !> How far the far end of the driven link goes round the joint of its drive, counter-clockwise;
  !! 0 where it is at rest. It depends neither on the order of pins and links, nor on cuts.
  pure function turn_at_drive(linkage, pose, drive, at) result(turn)
    type(linkage_t), intent(in) :: linkage      !! whose bodies are the links, or parts
    type(pose_t), intent(in) :: pose            !! of these
    type(drive_place_t), intent(in) :: drive    !! its first
    real(wp), intent(in) :: at(:, :, :)         !! (x, y, rotation; places; bodies)
    real(wp) :: turn

    real(wp) :: arm(2), farthest
    integer :: i, k

    turn = 0.0_wp
    farthest = 0.0_wp
    do k = 1, size(at, 3)
      if (.not. drive%turns(k)) cycle
      do i = 1, size(at, 2)
        arm = arm_to(linkage, pose, drive, k, real(i - 1, wp)/(size(at, 2) - 1))
        if (.not. norm2(arm) > (1.0_wp + tie)*farthest) cycle
        farthest = norm2(arm)
        turn = cross(arm, at(:2, i, k))/farthest
      end do
    end do
    if (.not. abs(turn) > at_rest*sqrt(maxval(sum(at(:2, :, :)**2, dim=1)))) turn = 0.0_wp
  end function turn_at_drive

  !> How all links that bend turn together about that joint: `∫ (r − r0) × u dx` by Simpson's rule.
  !! Cuts and the order of pins and links are not in it either.
  pure function turn_of_all(linkage, pose, drive, at) result(turn)
    type(linkage_t), intent(in) :: linkage      !! whose bodies are the links, or parts
    type(pose_t), intent(in) :: pose            !! of these
    type(drive_place_t), intent(in) :: drive    !! its first
    real(wp), intent(in) :: at(:, :, :)         !! (x, y, rotation; places, odd; bodies)
    real(wp) :: turn

    real(wp) :: weight
    integer :: i, k, n

    turn = 0.0_wp
    n = size(at, 2)
    do k = 1, size(at, 3)
      if (.not. linkage%bodies(k)%bends) cycle
      do i = 1, n
        weight = merge(4.0_wp, 2.0_wp, modulo(i, 2) == 0)
        if (i == 1 .or. i == n) weight = 1.0_wp
        turn = turn + weight*linkage%bodies(k)%length*cross(arm_to(linkage, pose, drive, k, &
          real(i - 1, wp)/(n - 1)), at(:2, i, k))
      end do
    end do
  end function turn_of_all

  !> From the joint of the drive to a place of a body, a share of its way from end to end.
  pure function arm_to(linkage, pose, drive, body, share) result(arm)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(drive_place_t), intent(in) :: drive
    integer, intent(in) :: body
    real(wp), intent(in) :: share
    real(wp) :: arm(2)

    associate (first => pose%pin(:, linkage%bodies(body)%first_pin), &
        last => pose%pin(:, linkage%bodies(body)%last_pin))
      arm = first + share*(last - first) - pose%pin(:, drive%pin)
    end associate
  end function arm_to

  !> The joint of the first drive, and what it turns: the pin of the link turned that stands still,
  !! or that this has in common with the link from which its angle is measured; of a slider its own
  !! pin; without a drive the first ground pivot.
  pure function place_of_drive(linkage, elastic) result(place)
    type(linkage_t), intent(in) :: linkage         !! whose bodies are the parts
    type(elastic_linkage_t), intent(in) :: elastic !! of these
    type(drive_place_t) :: place

    integer, allocatable :: others(:)
    integer :: i, k

    allocate (place%turns(size(linkage%bodies)), source=.false.)
    place%pin = max(1, findloc(linkage%is_ground, .true., dim=1))
    if (size(linkage%drives) == 0) return
    associate (drive => linkage%drives(1))
      if (drive%kind == drive_of_slider) place%pin = linkage%sliders(drive%slider)%pin
      if (drive%kind /= drive_of_angle) return
      place%turns = elastic%body == drive%body
      allocate (others(0))
      do k = 1, size(elastic%body)
        if (elastic%body(k) == drive%against) others = [others, pins_of_body(linkage%bodies(k))]
      end do
      do k = 1, size(elastic%body)
        if (.not. place%turns(k)) cycle
        associate (pins => pins_of_body(linkage%bodies(k)))
          do i = 1, size(pins)
            if (.not. any(others == pins(i)) .and. .not. (drive%against == 0 .and. &
              linkage%is_ground(pins(i)))) cycle
            place%pin = pins(i)
            return
          end do
        end associate
      end do
    end associate
  end function place_of_drive

end module shape_samples
