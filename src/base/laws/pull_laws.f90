! src/base/laws/ - what acts along a coordinate, by its value and rate alone.
! A card has a `pull_law_t`, the load that is made of it has the same one: a new parameter is a
! component here, and its part of the pull, the energy and the words.
! Begin with `pull_law_t` here; the smooth beginning of a contact is `contacts.f90`.
! Not here: along which coordinate it acts (`src/linkage/loads/applied_load_types.f90`), how its
! card is read (`src/model/cards/spring_cards.f90`, `src/model/cards/stop_cards.f90`).

!> How springs, dampers and stops pull along their coordinates. A pull makes the coordinate smaller:
!! the effort along it is its negative.
!!
!! A spring with its damper pulls `tension + k x + c v` with the deflection x from its rest and the
!! rate v. A stop, or a spring of one side σ = ±1, pushes back what is beyond its limit: with the
!! depth δ = σ x and τ = c/k the pull is `σ k ramp(δ + τ δ̇ ramp'(δ))`, which never draws, however
!! fast it is left, and keeps its energy without damping. In statics it is `σ k ramp(δ)`.
module pull_laws
  use contacts, only: contact_energy, contact_ramp, contact_slope
  use kinds, only: wp
  use natures, only: is_angular, nature_t
  use output_units, only: damping_unit, output_units_t, stiffness_unit
  use text, only: to_string
  use units, only: coherent_unit, from_si, unit_t
  implicit none (type, external)
  private

  public :: pull_law_t, standing_pull, moving_pull, contact_depth, pull_energy, pull_scale, &
    law_words

  type :: pull_law_t
    real(wp) :: tension = 0.0_wp   !! [N] or [N m]
    real(wp) :: stiffness = 0.0_wp !! [N/m] or [N m/rad]
    real(wp) :: rest = 0.0_wp      !! [m] or [rad]
    real(wp) :: damping = 0.0_wp   !! [N s/m] or [N m s/rad]
    integer :: side = 0            !! of its rest where the pull acts only: 1 above, −1 below; 0: it
                                   !! acts on both
    real(wp) :: contact = 0.0_wp   !! of one side: width in which the pull begins [m] or [rad]
  end type pull_law_t

contains

  !> What the position determines [N] or [N m].
  pure function standing_pull(law, x) result(pull)
    type(pull_law_t), intent(in) :: law
    real(wp), intent(in) :: x !! deflection from its rest [m] or [rad]
    real(wp) :: pull

    if (law%side == 0) then
      pull = law%tension + law%stiffness*x
    else
      pull = law%side*law%stiffness*contact_ramp(law%side*x, law%contact)
    end if
  end function standing_pull

  !> What the rate adds [N] or [N m].
  pure function moving_pull(law, x, rate) result(pull)
    type(pull_law_t), intent(in) :: law
    real(wp), intent(in) :: x, rate !! deflection [m] or [rad], and per second
    real(wp) :: pull

    real(wp) :: depth, deeper

    if (law%side == 0) then
      pull = law%damping*rate
      return
    end if
    pull = 0.0_wp
    depth = law%side*x
    if (depth <= 0.0_wp) return
    deeper = law%damping/law%stiffness*law%side*rate*contact_slope(depth, law%contact)
    pull = law%side*law%stiffness*(contact_ramp(depth + deeper, law%contact) - &
      contact_ramp(depth, law%contact))
  end function moving_pull

  !> How deep what acts on one side of its rest is pressed, and the rate of this; below 0 before.
  pure function contact_depth(law, x, rate) result(depth)
    type(pull_law_t), intent(in) :: law
    real(wp), intent(in) :: x, rate !! deflection [m] or [rad], and per unit of the motion
    real(wp) :: depth(2)            !! likewise

    depth = law%side*[x, rate]
  end function contact_depth

  !> Potential energy of a standing pull, 0 unloaded [J].
  pure function pull_energy(law, x) result(energy)
    type(pull_law_t), intent(in) :: law
    real(wp), intent(in) :: x !! deflection from its rest [m] or [rad]
    real(wp) :: energy

    if (law%side == 0) then
      energy = (law%tension + 0.5_wp*law%stiffness*x)*x
    else
      energy = law%stiffness*contact_energy(law%side*x, law%contact)
    end if
  end function pull_energy

  !> What a standing pull is a difference of: its rounding is of the order of 1e-16 of it [N] or
  !! [N m].
  pure function pull_scale(law, x) result(scale)
    type(pull_law_t), intent(in) :: law
    real(wp), intent(in) :: x !! deflection from its rest [m] or [rad]
    real(wp) :: scale

    scale = law%stiffness*(abs(x) + abs(law%rest))
    if (law%side /= 0) scale = scale*contact_slope(law%side*x, law%contact)
    scale = abs(law%tension) + scale
  end function pull_scale

  !> `4530 N/m, unloaded at 0.07785 m`, `a constant tension of 12 N`, or of one side `4530 N/m above
  !! 0.12 m, damping 20 N.s/m, contact within 1e-05 m`.
  pure function law_words(law, nature, outputs) result(words)
    type(pull_law_t), intent(in) :: law
    type(nature_t), intent(in) :: nature        !! of its coordinate
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    character(len=:), allocatable :: words

    type(unit_t) :: measure

    if (.not. law%stiffness > 0.0_wp) then
      if (is_angular(nature)) then
        words = "a constant torque of "//in_words(law%tension, outputs%moment)
      else
        words = "a constant tension of "//in_words(law%tension, outputs%force)
      end if
      return
    end if
    measure = coherent_unit(outputs%system, nature%value)
    words = in_words(law%stiffness, stiffness_unit(outputs, nature))
    if (law%side == 0) then
      words = words//", unloaded at "//in_words(law%rest, measure)
      return
    end if
    words = words//" "//trim(merge("above", "below", law%side > 0))//" "//in_words(law%rest, &
      measure)
    if (law%damping > 0.0_wp) words = words//", damping "//in_words(law%damping, &
      damping_unit(outputs, nature))
    words = words//", contact within "//to_string(from_si(law%contact, measure), 3)//" "// &
      measure%name
  end function law_words

  !> `4530 N/m`
  pure function in_words(value, measure) result(words)
    real(wp), intent(in) :: value !! [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: words

    words = to_string(from_si(value, measure), 12)//" "//measure%name
  end function in_words

end module pull_laws
