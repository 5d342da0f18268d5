!> How springs, dampers and stops pull along their coordinates. A pull makes the coordinate smaller:
!! the effort along it is its negative.
!!
!! A spring with its damper pulls `tension + k x + c v` with the deflection x from its rest and the
!! rate v. A stop, or a spring of one side σ = ±1, pushes back what is beyond its limit: with the
!! depth δ = σ x and τ = c/k the pull is `σ k ramp(δ + τ δ̇ ramp'(δ))`, which never draws, however
!! fast it is left, and keeps its energy without damping. In statics it is `σ k ramp(δ)`.
module pulls
  use applied_load_types, only: applied_load_t, is_torsional
  use constants, only: degree
  use contacts, only: contact_energy, contact_ramp, contact_slope
  use coordinate_types, only: is_angle, is_sum
  use coordinates, only: coordinate_rate, coordinate_value
  use kinds, only: wp
  use linkages, only: linkage_t
  use pose_types, only: kinematic_coefficients_t, pose_t
  implicit none (type, external)
  private

  public :: deflection, standing_pull, moving_pull, contact_depth, pull_energy, pull_scale, &
    counts_turns, jumps

  !> Largest angle between a torsional spring and its rest; its sign changes at a half turn [rad].
  real(wp), parameter :: most_deflection = 170.0_wp*degree

contains

  !> By how much a coordinate differs from the rest of a load: an angle from −π to π, but one that a
  !! drive gives with all whole turns [m] or [rad].
  pure function deflection(linkage, pose, load) result(x)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! with the coordinate of the first drive
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp) :: x

    x = coordinate_value(linkage, pose, load%along) - load%rest
    if (is_torsional(load) .and. .not. counts_turns(load)) x = atan2(sin(x), cos(x))
  end function deflection

  !> Whether a torsional load counts whole turns: a drive gives its angle.
  elemental function counts_turns(load) result(counts)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    logical :: counts

    counts = is_torsional(load) .and. load%along%drive > 0
  end function counts_turns

  !> Whether an angle is so near to half a turn from the rest of a load, or one of a sum to half a
  !! turn, that its pull would jump.
  pure function jumps(linkage, pose, load) result(does)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(applied_load_t), intent(in) :: load !! along a coordinate
    logical :: does

    integer :: i

    does = .false.
    if (.not. load%stiffness > 0.0_wp) return
    if (is_torsional(load) .and. .not. counts_turns(load)) does = abs(deflection(linkage, pose, &
      load)) > most_deflection
    if (load%along%kind /= is_sum) return
    do i = 1, size(load%along%term)
      associate (term => linkage%coordinates(load%along%term(i)))
        if (term%kind /= is_angle .or. term%drive > 0) cycle
        does = does .or. abs(coordinate_value(linkage, pose, term)) > most_deflection
      end associate
    end do
  end function jumps

  !> What the position determines [N] or [N m].
  pure function standing_pull(linkage, pose, load) result(pull)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp) :: pull

    real(wp) :: x

    x = deflection(linkage, pose, load)
    if (load%side == 0) then
      pull = load%tension + load%stiffness*x
    else
      pull = load%side*load%stiffness*contact_ramp(load%side*x, load%contact)
    end if
  end function standing_pull

  !> What the rate adds [N] or [N m].
  pure function moving_pull(linkage, pose, rate, load) result(pull)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! positions and directions
    real(wp), intent(in) :: rate             !! of the coordinate [m/s] or [rad/s]
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp) :: pull

    real(wp) :: depth, deeper

    if (load%side == 0) then
      pull = load%damping*rate
      return
    end if
    pull = 0.0_wp
    depth = load%side*deflection(linkage, pose, load)
    if (depth <= 0.0_wp) return
    deeper = load%damping/load%stiffness*load%side*rate*contact_slope(depth, load%contact)
    pull = load%side*load%stiffness*(contact_ramp(depth + deeper, load%contact) - &
      contact_ramp(depth, load%contact))
  end function moving_pull

  !> How deep what acts on one side of its rest is pressed, and the rate of this; below 0 before.
  pure function contact_depth(linkage, pose, now, load) result(depth)
    type(linkage_t), intent(in) :: linkage            !! of the coordinate
    type(pose_t), intent(in) :: pose                  !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: now !! velocities, or coefficients
    type(applied_load_t), intent(in) :: load          !! of one side
    real(wp) :: depth(2)                              !! [m] or [rad], and per unit of the motion

    depth = load%side*[deflection(linkage, pose, load), coordinate_rate(linkage, pose, now, &
      load%along)]
  end function contact_depth

  !> Potential energy of a standing pull, 0 unloaded [J].
  pure function pull_energy(linkage, pose, load) result(energy)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp) :: energy

    real(wp) :: x

    x = deflection(linkage, pose, load)
    if (load%side == 0) then
      energy = (load%tension + 0.5_wp*load%stiffness*x)*x
    else
      energy = load%stiffness*contact_energy(load%side*x, load%contact)
    end if
  end function pull_energy

  !> What a standing pull is a difference of: its rounding is of the order of 1e-16 of it [N] or
  !! [N m].
  pure function pull_scale(linkage, pose, load) result(scale)
    type(linkage_t), intent(in) :: linkage   !! of the coordinate
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp) :: scale

    real(wp) :: x

    x = deflection(linkage, pose, load)
    scale = load%stiffness*(abs(x) + abs(load%rest))
    if (load%side /= 0) scale = scale*contact_slope(load%side*x, load%contact)
    scale = abs(load%tension) + scale
  end function pull_scale

end module pulls
