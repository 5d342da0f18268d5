!> Places of pins and points at any crank angles, for drawings of a linkage.
module geometry_study
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use linkages, only: linkage_t, turned
  use poses, only: arm_to_place, place_links, pose_t
  implicit none (type, external)
  private

  public :: geometry_result_t, find_geometry

  !> Places are zero where the linkage cannot be placed.
  type :: geometry_result_t
    real(wp), allocatable :: crank(:)          !! (positions) [deg]
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

    integer :: i

    found%crank = crank
    allocate (found%outcome(size(crank)), found%pin(2, size(linkage%is_ground), size(crank)), &
      found%point(2, size(body), size(crank)), found%ahead(2, size(linkage%sliders), size(crank)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(crank)
      call place_all(linkage, body, place, crank(i), found%pin(:, :, i), found%point(:, :, i), &
        found%ahead(:, :, i), found%outcome(i)%error)
    end do
    !$omp end parallel do
  end subroutine find_geometry

  !> Places pins, points and what is ahead of sliders at one crank angle.
  pure subroutine place_all(linkage, body, place, crank, pin, point, ahead, error)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body(:)
    real(wp), intent(in) :: place(:, :), crank
    real(wp), intent(out) :: pin(:, :), point(:, :), ahead(:, :)
    type(error_t), allocatable, intent(out) :: error

    type(pose_t) :: pose
    integer :: p, i

    pin = 0.0_wp
    point = 0.0_wp
    ahead = 0.0_wp
    call place_links(linkage, crank, pose, error)
    if (allocated(error)) return
    pin = pose%pin
    do p = 1, size(body)
      point(:, p) = pose%pin(:, linkage%bodies(body(p))%first_pin) + &
        arm_to_place(pose, body(p), place(:, p))
    end do
    do i = 1, size(linkage%sliders)
      associate (slider => linkage%sliders(i))
        ahead(:, i) = slider%direction
        if (slider%body > 0) ahead(:, i) = turned(slider%direction, pose%direction(:, slider%body))
        ahead(:, i) = pose%pin(:, slider%pin) + ahead(:, i)
      end associate
    end do
  end subroutine place_all

end module geometry_study
