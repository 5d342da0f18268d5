!> Balancing of a linkage: its counterweights, its mass centre without them, and its forces with
!! them at every position. Counterweights cancel the shaking force, unless other aims are requested.
module balance_study
  use balance_shafts, only: parts_of_shafts
  use balanced_linkages, only: balanced_linkage, counterweight_lump, counterweight_make_t, &
    counterweight_t, radius_of
  use harmonics_study, only: find_cancelling_weights
  use hung_counterweights, only: obstacle_link, obstacle_loop, obstacle_none, obstacle_pin, &
    obstacle_ram, obstacle_t
  use joint_study, only: find_joints, joints_result_t
  use kinds, only: wp
  use linkages, only: linkage_t, lump_t
  use partial_balance_study, only: balance_request_t, find_partial_balance, partial_balance_t
  use positions, only: positions_t
  use rigid_bodies, only: linkage_mass_centre, rigid_bodies_of, rigid_body_t, total_mass
  implicit none (type, external)
  private

  public :: balance_result_t, balance_request_t, counterweight_make_t, find_balance, &
    has_balanced
  public :: obstacle_t, obstacle_none, obstacle_loop, obstacle_ram, obstacle_link, obstacle_pin

  type :: balance_result_t
    type(counterweight_t), allocatable :: weights(:) !! of a four-bar, on crank and follower; none
                                              !! where there is an obstacle
    type(lump_t), allocatable :: lumps(:)     !! the same as masses, a link length from their pins
                                              !! unless requested otherwise; zero where none is
                                              !! needed
    type(obstacle_t) :: obstacle              !! why there are none
    real(wp) :: mass = 0.0_wp                 !! of all moving parts, without counterweights [kg]
    real(wp), allocatable :: centre(:, :)     !! (2, states) mass centre, without counterweights
                                              !! [m]; zeros where there is no pose
    type(joints_result_t) :: balanced         !! forces with counterweights, if there are any
    type(partial_balance_t), allocatable :: partial !! for the aims and shafts that are requested
  end type balance_result_t

contains

  !> Mass centre, counterweights, and the forces with these, once for all speeds. They cancel the
  !! shaking force, see `find_cancelling_weights`; for other aims, see `partial_balance_study`.
  subroutine find_balance(linkage, elements, positions, threads, found, request, speeds, &
      accelerations)
    type(linkage_t), intent(in) :: linkage       !! of any kind, without counterweights
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(positions_t), intent(in) :: positions   !! of the run
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(balance_result_t), intent(out) :: found !! for all positions and speeds
    type(balance_request_t), intent(in), optional :: request !! other aims, balance shafts
    real(wp), intent(in), optional :: speeds(:, :) !! (speeds, states) of the first drive, for loads
                                                   !! that depend on it [rad/s] or [m/s]; absent:
                                                   !! without these
    real(wp), intent(in), optional :: accelerations(:, :) !! (speeds, states) likewise, for friction
                                                   !! [rad/s²] or [m/s²]; absent: none

    type(linkage_t) :: balanced

    call find_centres(linkage, elements, positions, threads, found)
    if (present(request)) then
      call take_partial(request, linkage, elements, threads, found)
      balanced = found%partial%linkage
    else
      call find_cancelling_weights(linkage, elements, found%weights, found%obstacle)
      balanced = balanced_linkage(linkage, found%weights)
    end if
    call find_lumps(linkage, found)
    if (.not. has_balanced(found)) return
    call find_joints(balanced, elements, positions, threads, found%balanced, speeds, &
      accelerations)
    call add_shafts(balanced, positions, found)
  end subroutine find_balance

  !> Whether there is a balanced linkage beside the given one.
  pure function has_balanced(found) result(has)
    type(balance_result_t), intent(in) :: found
    logical :: has

    has = allocated(found%partial) .or. size(found%weights) > 0
  end function has_balanced

  !> Counterweights and balance shafts for requested aims.
  subroutine take_partial(request, linkage, elements, threads, found)
    type(balance_request_t), intent(in) :: request
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:), threads
    type(balance_result_t), intent(inout) :: found

    allocate (found%partial)
    call find_partial_balance(request, linkage, elements, threads, found%partial)
    found%weights = found%partial%weights
  end subroutine take_partial

  !> Adds what the balance shafts exert to the shaking force and moment and the torque of the
  !! balanced linkage.
  subroutine add_shafts(balanced, positions, found)
    type(linkage_t), intent(in) :: balanced
    type(positions_t), intent(in) :: positions
    type(balance_result_t), intent(inout) :: found

    real(wp), allocatable :: part(:, :)
    integer :: i

    if (.not. allocated(balanced%shafts)) return
    do i = 1, size(positions%states)
      if (allocated(positions%states(i)%error)) cycle
      part = parts_of_shafts(balanced, positions%states(i)%crank)
      associate (joints => found%balanced)
        joints%shaking(:, :, i) = joints%shaking(:, :, i) + part(:3, :)
        joints%drive(1, :, i) = joints%drive(1, :, i) + part(4, :)
      end associate
    end do
  end subroutine add_shafts

  !> The counterweights as point masses.
  pure subroutine find_lumps(linkage, found)
    type(linkage_t), intent(in) :: linkage
    type(balance_result_t), intent(inout) :: found !! with its counterweights

    integer :: i

    allocate (found%lumps(size(found%weights)))
    do i = 1, size(found%weights)
      if (.not. found%weights(i)%needed) cycle
      associate (body => linkage%bodies(found%weights(i)%body))
        found%lumps(i) = counterweight_lump(found%weights(i), body, radius_of(found%weights(i), &
          body))
      end associate
    end do
  end subroutine find_lumps

  !> Mass, and the mass centre at every position, without counterweights.
  subroutine find_centres(linkage, elements, positions, threads, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    type(balance_result_t), intent(inout) :: found

    type(rigid_body_t) :: rigid(size(linkage%bodies))
    integer :: i

    rigid = rigid_bodies_of(linkage, elements)
    found%mass = total_mass(linkage, rigid)
    allocate (found%centre(2, size(positions%states)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(positions%states)
      found%centre(:, i) = 0.0_wp
      if (allocated(positions%states(i)%error)) cycle
      found%centre(:, i) = linkage_mass_centre(linkage, rigid, positions%states(i)%pose)
    end do
    !$omp end parallel do
  end subroutine find_centres

end module balance_study
