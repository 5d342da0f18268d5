!> How springs, dampers and stops pull along their coordinates. A pull makes the coordinate smaller:
!! the effort along it is its negative.
!!
!! A spring with its damper pulls `tension + k x + c v` with the deflection x from its rest and the
!! rate v. A stop, or a spring of one side σ = ±1, pushes back what is beyond its limit: with the
!! depth δ = σ x and τ = c/k the pull is `σ k ramp(δ + τ δ̇ ramp'(δ))`, which never draws, however
!! fast it is left, and keeps its energy without damping. In statics it is `σ k ramp(δ)`.
module pulls
  use applied_load_types, only: applied_load_t, is_torsional
  use contacts, only: contact_energy, contact_ramp, contact_slope
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: deflection, standing_pull, moving_pull, contact_depth, pull_energy, pull_scale, &
    counts_turns

contains

  !> By how much a coordinate differs from the rest of a load: an angle from −π to π, but one that a
  !! drive gives with all whole turns [m] or [rad].
  pure function deflection(load, value) result(x)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp) :: x

    x = value - load%rest
    if (is_torsional(load) .and. .not. counts_turns(load)) x = atan2(sin(x), cos(x))
  end function deflection

  !> Whether a torsional load counts whole turns: a drive gives its angle.
  elemental function counts_turns(load) result(counts)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    logical :: counts

    counts = is_torsional(load) .and. load%along%drive > 0
  end function counts_turns

  !> What the position determines [N] or [N m].
  pure function standing_pull(load, value) result(pull)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp) :: pull

    real(wp) :: x

    x = deflection(load, value)
    if (load%side == 0) then
      pull = load%tension + load%stiffness*x
    else
      pull = load%side*load%stiffness*contact_ramp(load%side*x, load%contact)
    end if
  end function standing_pull

  !> What the rate adds [N] or [N m].
  pure function moving_pull(load, value, rate) result(pull)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp), intent(in) :: rate             !! of it [m/s] or [rad/s]
    real(wp) :: pull

    real(wp) :: depth, deeper

    if (load%side == 0) then
      pull = load%damping*rate
      return
    end if
    pull = 0.0_wp
    depth = load%side*deflection(load, value)
    if (depth <= 0.0_wp) return
    deeper = load%damping/load%stiffness*load%side*rate*contact_slope(depth, load%contact)
    pull = load%side*load%stiffness*(contact_ramp(depth + deeper, load%contact) - &
      contact_ramp(depth, load%contact))
  end function moving_pull

  !> How deep what acts on one side of its rest is pressed, and the rate of this; below 0 before.
  pure function contact_depth(load, value, rate) result(depth)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp), intent(in) :: rate             !! of it [m/s] or [rad/s]
    real(wp) :: depth(2)                     !! [m] or [rad], and per unit of the motion

    depth = load%side*[deflection(load, value), rate]
  end function contact_depth

  !> Potential energy of a standing pull, 0 unloaded [J].
  pure function pull_energy(load, value) result(energy)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp) :: energy

    real(wp) :: x

    x = deflection(load, value)
    if (load%side == 0) then
      energy = (load%tension + 0.5_wp*load%stiffness*x)*x
    else
      energy = load%stiffness*contact_energy(load%side*x, load%contact)
    end if
  end function pull_energy

  !> What a standing pull is a difference of: its rounding is of the order of 1e-16 of it [N] or
  !! [N m].
  pure function pull_scale(load, value) result(scale)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp) :: scale

    real(wp) :: x

    x = deflection(load, value)
    scale = load%stiffness*(abs(x) + abs(load%rest))
    if (load%side /= 0) scale = scale*contact_slope(load%side*x, load%contact)
    scale = abs(load%tension) + scale
  end function pull_scale

end module pulls
