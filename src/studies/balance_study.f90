!> Force balancing of a linkage: its counterweights, its mass centre without them, and its forces
!! with them at every position.
module balance_study
  use balanced_linkages, only: balanced_linkage, counterweight_lump, counterweight_t
  use counterweights, only: find_counterweights
  use hung_counterweights, only: find_hung_counterweights, obstacle_link, obstacle_loop, &
    obstacle_none, obstacle_pin, obstacle_ram, obstacle_t
  use joint_study, only: find_joints, joints_result_t
  use kinds, only: wp
  use linkages, only: linkage_t, lump_t
  use positions, only: positions_t
  use reactions_study, only: find_reactions, reactions_result_t
  use rigid_bodies, only: linkage_mass_centre, rigid_bodies_of, rigid_body_t, total_mass
  implicit none (type, external)
  private

  public :: balance_result_t, find_balance, find_hung_balance
  public :: obstacle_t, obstacle_none, obstacle_loop, obstacle_ram, obstacle_link, obstacle_pin

  type :: balance_result_t
    type(counterweight_t), allocatable :: weights(:) !! of a four-bar, on crank and follower; none
                                              !! where there is an obstacle
    type(lump_t), allocatable :: lumps(:)     !! the same as point masses, one link length from
                                              !! their pins; zero where none is needed
    type(obstacle_t) :: obstacle              !! why there are none
    real(wp) :: mass = 0.0_wp                 !! of all moving parts, without counterweights [kg]
    real(wp), allocatable :: centre(:, :)     !! (2, states) mass centre, without counterweights
                                              !! [m]; zeros where there is no pose
    type(reactions_result_t) :: balanced      !! reactions of a four-bar with counterweights
    type(joints_result_t) :: balanced_joints  !! of another linkage, if it has any
  end type balance_result_t

contains

  !> Counterweights, mass centre, and the reactions of the balanced four-bar, once for all speeds.
  !! Berkof and Lowen 1969, see `counterweights`.
  subroutine find_balance(linkage, elements, positions, threads, found, speeds)
    type(linkage_t), intent(in) :: linkage       !! a four-bar, without counterweights
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(positions_t), intent(in) :: positions   !! of the run
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(balance_result_t), intent(out) :: found !! for all positions and speeds
    real(wp), intent(in), optional :: speeds(:, :) !! (speeds, states) of the first drive, for loads
                                                   !! that depend on it [rad/s] or [m/s]; absent:
                                                   !! without these

    found%weights = find_counterweights(linkage, elements)
    call find_lumps(linkage, found)
    call find_centres(linkage, elements, positions, threads, found)
    call find_reactions(balanced_linkage(linkage, found%weights), elements, positions, threads, &
      found%balanced, speeds)
  end subroutine find_balance

  !> The same of any other linkage, with counterweights where links hang on each other without a
  !! loop, see `hung_counterweights`.
  subroutine find_hung_balance(linkage, elements, positions, threads, found, speeds)
    type(linkage_t), intent(in) :: linkage       !! of any kind, without counterweights
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(positions_t), intent(in) :: positions   !! of the run
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(balance_result_t), intent(out) :: found !! for all positions and speeds
    real(wp), intent(in), optional :: speeds(:, :) !! (speeds, states) of the first drive, for loads
                                                   !! that depend on it [rad/s] or [m/s]; absent:
                                                   !! without these

    call find_hung_counterweights(linkage, elements, found%weights, found%obstacle)
    call find_lumps(linkage, found)
    call find_centres(linkage, elements, positions, threads, found)
    if (size(found%weights) > 0) call find_joints(balanced_linkage(linkage, found%weights), &
      elements, positions, threads, found%balanced_joints, speeds)
  end subroutine find_hung_balance

  !> The counterweights as point masses, as far from their pins as their links are long.
  pure subroutine find_lumps(linkage, found)
    type(linkage_t), intent(in) :: linkage
    type(balance_result_t), intent(inout) :: found !! with its counterweights

    integer :: i

    allocate (found%lumps(size(found%weights)))
    do i = 1, size(found%weights)
      if (.not. found%weights(i)%needed) cycle
      associate (body => linkage%bodies(found%weights(i)%body))
        found%lumps(i) = counterweight_lump(found%weights(i), body, body%length)
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
