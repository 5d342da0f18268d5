!> Effect of the rounding of a position on its frequencies.
!!
!! The crank angle itself is rounded, and the nearer a dead point, the less accurately it determines
!! the rest of the linkage.
module pose_rounding
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_pencil, only: elastic_square
  use bridges, only: bridge_at, edge_sine, place_on_path, thinned
  use deformation_model, only: deformation_model_t
  use eigenvalue_gaps, only: relative_error
  use eigenvalue_sensitivity, only: residual_work
  use elastic_linkages, only: scaled_link
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients
  use ledger, only: ledger_t
  use linkages, only: group_by_newton, group_dyad, linkage_t, path_t
  use load_cases, only: case_count
  use mixed_positions, only: find_work
  use poses, only: pose_t
  use position_assembly, only: assemble_position, assembled_t, new_assembled
  use position_equations, only: new_position_equations, position_equations_t, set_speed
  use position_results, only: position_work_t
  use positions, only: state_t
  use structures, only: find_structure_pose, structure_t
  implicit none (type, external)
  private

  public :: pose_error

  !> Factors of the estimate, measured against quadruple precision: of ε/sin² far from dead points,
  !! of ε times the sensitivity near them.
  real(wp), parameter :: far_multiple = 4.0_wp, near_multiple = 2.0_wp

  !> Linkages that are more than binary links and pins: their groups are placed by iterations, or
  !! along lines, and links of many lengths follow each other; measured over a thousand random ones.
  real(wp), parameter :: multiple_of_parts = 16.0_wp

  !> Below this |sin(θ4 − θ3)| sensitivities are computed: at rest, and under loads, which
  !! themselves grow like 1/sin.
  real(wp), parameter :: near_sine = 0.15_wp, loaded_near_sine = 0.4_wp

  !> Ratio of longest to shortest length up to which the sine alone determines the accuracy of a
  !! position.
  real(wp), parameter :: usual_spread = 2.0_wp

  !> Up to this number of links each length is changed by itself; of more so many sums are.
  integer, parameter :: most_single = 24, sums_of_many = 8

  !> Relative change of a length for the sensitivities, before the factor sin².
  real(wp), parameter :: small_change = 1.0e-3_wp

contains

  !> Estimated relative error of every eigenvalue due to the rounding of the position: ε times the
  !! sensitivity of the eigenvalue to the lengths of the links.
  !!
  !! Far from dead points a multiple of `ε/sin²(θ4 − θ3)` is a bound, larger where terms cancel in
  !! λ, and where the loads of other links cancel in the axial force of one. The sine is reduced
  !! where a link of a dyad is short compared with the distances that place it, for the angle of
  !! that link takes up all of their rounding. Near dead points modes differ: some soften with the
  !! sine, others do not depend on it, and loads grow like powers of 1/sin. There each length is
  !! changed a little, and `yᵀ(ΔK_G − λ ΔM) y` is the effect. If the linkage closes with neither a
  !! longer nor a shorter link, the error is at least 1. Where links are more than needed, rigid
  !! ones among them fit with their own lengths alone: their share is that far from dead points. On
  !! a bridge over a change point lengths do not determine the place, but its nodes do.
  subroutine pose_error(structure, state, speed, work, load_work, found, error, counts)
    type(structure_t), intent(in) :: structure     !! whose position it is
    type(state_t), intent(in) :: state             !! with a pose
    integer, intent(in) :: speed                   !! number
    type(position_work_t), intent(in) :: work      !! with this position and its loads; in mixed
                                                   !! form also with the modes
    real(wp), intent(in) :: load_work(:)           !! (modes) of `find_matrix_errors` [1/s²]
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    real(wp), intent(out) :: error(:)              !! (modes) relative, of eigenvalues, lowest first
    type(ledger_t), intent(inout) :: counts        !! of poses found and matrices assembled

    real(wp) :: sine, least_sine, spread, energy, multiple
    integer :: bridge, i

    multiple = merge(1.0_wp, multiple_of_parts, structure%elastic%in_closed_form)
    spread = max(1.0_wp, length_spread(structure%linkage, state%pose)/usual_spread)
    sine = 1.0_wp
    if (size(state%pose%sine) > 0) sine = minval(abs(state%pose%sine))
    if (allocated(state%pose%coefficients)) then
      ! Over a change point places are as exact as where its bridge stands.
      bridge = bridge_of(structure%linkage%path, state%crank)
      if (bridge > 0) sine = max(sine, edge_sine(structure%linkage%path%bridges(bridge)))
    end if
    sine = sine/spread
    least_sine = near_sine
    ! Loads also contain the accelerations of short links: where lengths differ much no multiple of
    ! ε/sin² is known.
    if (any(abs(work%factor(:, speed)) > 0.0_wp)) least_sine = merge(loaded_near_sine, 1.0_wp, &
      spread <= 1.0_wp)
    ! Links that are more than needed share their loads by their stiffnesses: a change of direction
    ! counts many times. So it does in the accelerations of groups that iterations place.
    if (any(abs(work%factor(:, speed)) > 0.0_wp)) then
      if (size(structure%linkage%redundancies) > 0 .or. any(structure%linkage%groups%kind == &
        group_by_newton)) least_sine = huge(least_sine)
    end if
    do i = 1, size(error)
      energy = elastic_square(work%here%model%layout, found%vector(:, i)) + load_work(i)
      error(i) = far_multiple*epsilon(1.0_wp)/sine**2*(1.0_wp + relative_error(energy, &
        found%lambda(i)))
    end do
    if (sine >= least_sine .and. .not. allocated(state%pose%coefficients)) then
      error = 2.0_wp*multiple*error
    else
      call find_changes(structure, state, speed, sine, work, found, error, counts)
      error = 2.0_wp*multiple*error
      ! Forces that cancel at every length leave their rounding.
      if (.not. structure%elastic%in_closed_form) error = error + near_multiple*epsilon(1.0_wp)* &
        relative_error(load_work(:size(error)), found%lambda(:size(error)))
    end if
    error(:min(found%zeros, size(error))) = 0.0_wp
  end subroutine pose_error

  !> Relative errors of eigenvalues by their changes: ε times the sensitivity to the lengths of the
  !! links; on a bridge, and towards a limit, that far from dead points and the change with fewer
  !! nodes.
  subroutine find_changes(structure, state, speed, sine, work, found, error, counts)
    type(structure_t), intent(in) :: structure
    type(state_t), intent(in) :: state
    integer, intent(in) :: speed
    real(wp), intent(in) :: sine              !! of the position, reduced by short links
    type(position_work_t), intent(in) :: work
    type(bordered_modes_t), intent(in) :: found
    real(wp), intent(inout) :: error(:)       !! (modes) of a linkage far from dead points; becomes
                                              !! that of this one
    type(ledger_t), intent(inout) :: counts

    real(wp), dimension(size(error)) :: far, own_work, change, squares
    real(wp), allocatable :: trial(:, :)
    type(position_equations_t) :: equations
    type(assembled_t) :: here
    type(structure_t) :: other
    integer :: b, i, side
    logical :: reached

    far = error
    equations = new_position_equations(work%here%model)
    here = new_assembled(structure, work%here%model)
    call assemble(structure)
    own_work = 0.0_wp
    if (reached) call take_work(own_work)
    if (allocated(state%pose%coefficients)) then
      other = structure
      call thin_path(other%linkage%path, state%crank)
      call change_to(other)
      error = merge(far + change, 1.0_wp, reached)
      return
    end if
    call list_trials(size(structure%linkage%bodies), trial)
    error = 0.0_wp
    squares = 0.0_wp
    do i = 1, size(trial, 2)
      do side = 1, -1, -2
        other = structure
        do b = 1, size(trial, 1)
          if (abs(trial(b, i)) > 0.0_wp) call scale_link(other, b, 1.0_wp + &
            side*trial(b, i)*small_change*sine**2)
        end do
        call change_to(other)
        if (reached) exit
      end do
      if (reached) then
        change = epsilon(1.0_wp)*change/(small_change*sine**2)
        error = error + change
        squares = squares + change**2
      else
        change = merge(far, 1.0_wp, size(structure%linkage%redundancies) > 0)
        error = error + change
        squares = squares + size(trial, 2)*change**2
      end if
    end do
    if (size(trial, 2) < size(trial, 1)) error = sqrt(size(trial, 1)*squares/size(trial, 2))

  contains

    !> Relative changes of the eigenvalues to those of another structure.
    subroutine change_to(other)
      type(structure_t), intent(in) :: other

      call assemble(other)
      change = 0.0_wp
      if (.not. reached) return
      call take_work(change)
      change = near_multiple*abs(change - own_work)/max(abs(found%lambda(:size(far))), tiny(1.0_wp))
    end subroutine change_to

    !> The matrices of a structure.
    subroutine assemble(structure)
      type(structure_t), intent(in) :: structure

      call assemble_lengths(structure, work%here%model, state%crank, work%factor(:, speed), here, &
        equations, reached, counts)
    end subroutine assemble

    !> What the matrices at hand do in the modes.
    subroutine take_work(of_modes)
      real(wp), intent(out) :: of_modes(:)

      if (allocated(here%mixed)) then
        call find_work(here%mixed, work%factor(:, speed), work%continuum%found(speed), of_modes)
      else
        of_modes = residual_work(equations%pencil, found, size(of_modes))
      end if
    end subroutine take_work

  end subroutine find_changes

  !> Which lengths are changed together, and in which sense: of few links each by itself, of many
  !! some sums of all with signs without order. The mean square of such changes is the sum of the
  !! squares of those of single links, and their sum is at most √n times the root of that.
  pure subroutine list_trials(links, trial)
    integer, intent(in) :: links                     !! number
    real(wp), allocatable, intent(out) :: trial(:, :) !! (links, trials)

    real(wp) :: seed
    integer :: b, i

    allocate (trial(links, merge(links, sums_of_many, links <= most_single)), source=0.0_wp)
    seed = 0.5_wp
    do i = 1, size(trial, 2)
      if (links <= most_single) then
        trial(i, i) = 1.0_wp
        cycle
      end if
      do b = 1, links
        seed = modulo(997.0_wp*seed + 0.6180339887498949_wp, 1.0_wp)
        trial(b, i) = merge(1.0_wp, -1.0_wp, seed < 0.5_wp)
      end do
    end do
  end subroutine list_trials

  !> The bridge of a path at a coordinate; 0: it is towards a limit.
  pure function bridge_of(path, crank) result(number)
    type(path_t), intent(in) :: path
    real(wp), intent(in) :: crank !! where places are on polynomials [deg]
    integer :: number

    number = bridge_at(path, place_on_path(path, crank))
  end function bridge_of

  !> Takes the outermost nodes of the polynomials through which places at a coordinate are found.
  pure subroutine thin_path(path, crank)
    type(path_t), intent(inout) :: path
    real(wp), intent(in) :: crank

    integer :: bridge, i

    bridge = bridge_of(path, crank)
    if (bridge > 0) path%bridges(bridge) = thinned(path%bridges(bridge))
    if (bridge > 0) return
    do i = 1, 2
      if (allocated(path%limits(i)%crank)) path%limits(i) = thinned(path%limits(i))
    end do
  end subroutine thin_path

  !> Makes a link longer or shorter.
  pure subroutine scale_link(structure, body, factor)
    type(structure_t), intent(inout) :: structure
    integer, intent(in) :: body
    real(wp), intent(in) :: factor

    call scaled_link(structure%linkage, structure%elastic, body, factor)
    ! A redundant link that has become longer would not fit.
    deallocate (structure%linkage%redundancies)
    allocate (structure%linkage%redundancies(0))
  end subroutine scale_link

  !> Ratio of the largest of all lengths and distances between the bases of dyads to the shortest
  !! link of a group.
  pure function length_spread(linkage, pose) result(spread)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    real(wp) :: spread

    real(wp) :: largest, shortest
    integer :: i

    largest = maxval(linkage%bodies%length)
    shortest = huge(shortest)
    do i = 1, size(linkage%groups)
      associate (group => linkage%groups(i))
        if (group%kind == group_dyad) then
          largest = max(largest, norm2(pose%pin(:, group%base(2)) - pose%pin(:, group%base(1))))
          shortest = min(shortest, minval(linkage%bodies(group%body)%length))
        else if (allocated(group%bodies)) then
          if (size(group%bodies) > 0) shortest = min(shortest, &
            minval(linkage%bodies(group%bodies)%length))
        end if
      end associate
    end do
    spread = 1.0_wp
    if (shortest < huge(shortest)) spread = largest/shortest
  end function length_spread

  !> Assembles M, and K_G of one speed, of a linkage whose lengths may differ slightly from those of
  !! the model.
  subroutine assemble_lengths(structure, model, crank, factor, here, equations, reached, counts)
    type(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model
    real(wp), intent(in) :: crank              !! [deg]
    real(wp), intent(in) :: factor(case_count) !! of the unit loads: ω2², α2, 1
    type(assembled_t), intent(inout) :: here   !! of the model
    type(position_equations_t), intent(inout) :: equations !! of the model
    logical, intent(out) :: reached            !! whether the linkage closes there
    type(ledger_t), intent(inout) :: counts

    type(state_t) :: state
    type(error_t), allocatable :: error
    type(outcome_t) :: outcome(1)

    allocate (state%pose)
    call find_structure_pose(structure, crank, state%pose, error)
    counts%kinematic_solutions = counts%kinematic_solutions + 1
    reached = .not. allocated(error)
    if (.not. reached) return
    state%coefficients = find_kinematic_coefficients(structure%linkage, state%pose)
    here%elastic = structure%elastic
    call assemble_position(structure, model, state, reshape(factor, [case_count, 1]), equations, &
      here, outcome, counts)
    reached = .not. allocated(outcome(1)%error)
    if (reached) call set_speed(equations, factor)
  end subroutine assemble_lengths

end module pose_rounding
