!> Places of pins and points at any crank angles, and at the instants of a motion, for drawings of a
!! linkage.
module geometry_study
  use errors, only: outcome_t
  use kinds, only: wp
  use linkage_samples, only: linkage_sample_t
  use linkages, only: linkage_t, turned
  use pose_types, only: pose_of_pins
  use poses, only: arm_to_place, place_links, pose_t
  implicit none (type, external)
  private

  public :: geometry_result_t, find_geometry, find_moving_geometry

  !> Places are zero where the linkage cannot be placed.
  type :: geometry_result_t
    real(wp), allocatable :: crank(:)          !! (positions) [deg]; none of a motion
    type(outcome_t), allocatable :: outcome(:) !! (positions) why the linkage cannot be placed
    real(wp), allocatable :: pin(:, :, :)      !! (2, pins, positions) in global axes [m]
    real(wp), allocatable :: point(:, :, :)    !! (2, points, positions) in global axes [m]
    real(wp), allocatable :: ahead(:, :, :)    !! (2, sliders, positions) 1 m ahead of each slider
                                               !! on its line, in global axes [m]
  end type geometry_result_t

contains

  !> Places the links at every crank angle, at dead points too: no motion has to be determined.
  !!
  !! Errors, position by position in `found%outcome`: the linkage cannot be placed.
  subroutine find_geometry(linkage, body, place, crank, threads, found)
    type(linkage_t), intent(in) :: linkage        !! to be placed
    integer, intent(in) :: body(:)                !! (points) body to which each point is fixed
    real(wp), intent(in) :: place(:, :)           !! (2, points) from the first pin of the body, in
                                                  !! the axes of the body [m]
    real(wp), intent(in) :: crank(:)              !! (positions) [deg]
    integer, intent(in) :: threads                !! number of OpenMP threads
    type(geometry_result_t), intent(out) :: found !! in the order of `crank`

    type(pose_t) :: pose
    integer :: i

    call make_room(linkage, size(body), size(crank), found)
    found%crank = crank
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i, pose)
    do i = 1, size(crank)
      call place_links(linkage, crank(i), pose, found%outcome(i)%error)
      if (.not. allocated(found%outcome(i)%error)) call place_all(linkage, body, place, pose, i, &
        found)
    end do
    !$omp end parallel do
  end subroutine find_geometry

  !> Places the links where a motion has been. No errors.
  pure subroutine find_moving_geometry(linkage, body, place, samples, found)
    type(linkage_t), intent(in) :: linkage           !! that moves
    integer, intent(in) :: body(:)                   !! (points) as of `find_geometry`
    real(wp), intent(in) :: place(:, :)              !! (2, points) likewise [m]
    type(linkage_sample_t), intent(in) :: samples(:) !! with places of the pins
    type(geometry_result_t), intent(out) :: found    !! in the order of `samples`

    integer :: i

    call make_room(linkage, size(body), size(samples), found)
    do i = 1, size(samples)
      call place_all(linkage, body, place, pose_of_pins(linkage, samples(i)%pin), i, found)
    end do
  end subroutine find_moving_geometry

  !> Places of zero.
  pure subroutine make_room(linkage, points, positions, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: points, positions !! how many
    type(geometry_result_t), intent(out) :: found

    allocate (found%outcome(positions))
    allocate (found%pin(2, size(linkage%is_ground), positions), found%point(2, points, positions), &
      found%ahead(2, size(linkage%sliders), positions), source=0.0_wp)
  end subroutine make_room

  !> Places pins, points and what is ahead of sliders at one position.
  pure subroutine place_all(linkage, body, place, pose, position, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body(:)
    real(wp), intent(in) :: place(:, :)
    type(pose_t), intent(in) :: pose    !! of pins and bodies
    integer, intent(in) :: position     !! its number
    type(geometry_result_t), intent(inout) :: found

    integer :: p, i

    found%pin(:, :, position) = pose%pin
    do p = 1, size(body)
      found%point(:, p, position) = pose%pin(:, linkage%bodies(body(p))%first_pin) + &
        arm_to_place(pose, body(p), place(:, p))
    end do
    do i = 1, size(linkage%sliders)
      associate (slider => linkage%sliders(i), ahead => found%ahead(:, i, position))
        ahead = slider%direction
        if (slider%body > 0) ahead = turned(slider%direction, pose%direction(:, slider%body))
        ahead = pose%pin(:, slider%pin) + ahead
      end associate
    end do
  end subroutine place_all

end module geometry_study
