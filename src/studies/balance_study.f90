!> Force balancing of a four-bar: its counterweights, its mass centre without them, and its
!! reactions with them at every position.
module balance_study
  use counterweights, only: balanced_linkage, counterweight_lump, counterweight_t, &
    find_counterweights
  use kinds, only: wp
  use linkages, only: linkage_t, lump_t
  use positions, only: positions_t
  use reactions_study, only: find_reactions, reactions_result_t
  use rigid_bodies, only: linkage_mass_centre, rigid_bodies_of, rigid_body_t, total_mass
  implicit none (type, external)
  private

  public :: balance_result_t, find_balance, find_centres

  type :: balance_result_t
    type(counterweight_t) :: weights(2)       !! on crank and follower
    type(lump_t) :: lumps(2)                  !! the same as point masses, one link length from the
                                              !! pivot; zero where none is needed
    real(wp) :: mass = 0.0_wp                 !! of all moving parts, without counterweights [kg]
    real(wp), allocatable :: centre(:, :)     !! (2, states) mass centre, without counterweights
                                              !! [m]; zeros where there is no pose
    type(reactions_result_t) :: balanced      !! reactions with counterweights
  end type balance_result_t

contains

  !> Counterweights, mass centre, and the reactions of the balanced linkage, once for all speeds.
  !! Berkof and Lowen 1969, see `counterweights`.
  subroutine find_balance(linkage, elements, positions, threads, found)
    type(linkage_t), intent(in) :: linkage       !! a four-bar, without counterweights
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(positions_t), intent(in) :: positions   !! of the run
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(balance_result_t), intent(out) :: found !! for all positions and speeds

    type(rigid_body_t) :: rigid(size(linkage%bodies))
    type(linkage_t) :: balanced
    integer :: i

    found%weights = find_counterweights(linkage, elements)
    do i = 1, size(found%weights)
      if (.not. found%weights(i)%needed) cycle
      associate (body => linkage%bodies(found%weights(i)%body))
        found%lumps(i) = counterweight_lump(found%weights(i), body, body%length)
      end associate
    end do
    rigid = rigid_bodies_of(linkage, elements)
    found%mass = total_mass(linkage, rigid)
    allocate (found%centre(2, size(positions%states)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(positions%states)
      found%centre(:, i) = 0.0_wp
      associate (state => positions%states(i))
        if (.not. allocated(state%error)) found%centre(:, i) = &
          linkage_mass_centre(linkage, rigid, state%pose)
      end associate
    end do
    !$omp end parallel do
    balanced = balanced_linkage(linkage, found%weights)
    call find_reactions(balanced, elements, positions, threads, found%balanced)
  end subroutine find_balance

  !> The mass centre of any linkage at every position.
  subroutine find_centres(linkage, elements, positions, threads, found)
    type(linkage_t), intent(in) :: linkage       !! of any kind
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(positions_t), intent(in) :: positions   !! of the run
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(balance_result_t), intent(out) :: found !! without counterweights

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
