!> The units in which results are given, and their digits: the units of the deck where they have a
!! name, else those customary for the quantity. What bare numbers of a deck mean is not affected.
module output_units
  use errors, only: error_t
  use number_text, only: most_digits
  use natures, only: nature_t
  use units, only: coherent_unit, dimension_force, dimension_moment, dimension_rate, &
    dimension_stress, dimension_time, name_known, read_unit, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: output_units_t, new_output_units, table_name, stress_unit, stress_factor, power_unit, &
    power_factor, stiffness_unit, damping_unit

  !> Angles are in degrees, angular accelerations in rad/s², frequencies in Hz.
  type :: output_units_t
    type(unit_system_t) :: system !! of all quantities that are not below
    type(unit_t) :: force
    type(unit_t) :: moment        !! and torque
    type(unit_t) :: energy
    type(unit_t) :: rate          !! angular velocity
    integer :: digits = most_digits !! significant ones of the numbers in tables
  end type output_units_t

contains

  !> The units of a deck that asks for no others.
  !!
  !! Forces and moments: N and N m, or lbf and lbf in where lengths are in inches or feet. But where
  !! the deck's own unit of force has a name (tonne mm/s² is N, slinch in/s² is lbf) it is kept, and
  !! moments are in it times the unit of length. Energies: J; where lengths are in inches or feet,
  !! the unit of moments. Angular velocities: rad/s.
  pure function new_output_units(system) result(outputs)
    type(unit_system_t), intent(in) :: system !! from the UNITS card
    type(output_units_t) :: outputs

    logical :: imperial

    imperial = system%length%name == "in" .or. system%length%name == "ft"
    outputs%system = system
    outputs%force = coherent_unit(system, dimension_force)
    outputs%moment = coherent_unit(system, dimension_moment)
    if (scan(outputs%force%name, "./") > 0) then
      if (imperial) then
        outputs%force = unit_of("lbf", dimension_force)
        outputs%moment = unit_of("lbf*in", dimension_moment)
      else
        outputs%force = unit_of("N", dimension_force)
        outputs%moment = unit_of("N*m", dimension_moment)
      end if
    end if
    outputs%energy = unit_of("J", dimension_moment)
    if (imperial) outputs%energy = outputs%moment
    outputs%rate = unit_of("rad/s", dimension_rate)
  end function new_output_units

  !> The unit of stresses: that of forces per square of that of lengths, by its own name if it has
  !! one: `MPa`, `psi`, `lbf/ft2`.
  pure function stress_unit(outputs) result(measure)
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    type(unit_t) :: measure

    measure = stress_factor(outputs)
    call name_known(measure)
    if (len(measure%name) == 0) measure%name = outputs%force%name//"/"// &
      outputs%system%length%name//"2"
  end function stress_unit

  !> As `stress_unit`, without the name.
  pure function stress_factor(outputs) result(measure)
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    type(unit_t) :: measure

    associate (force => outputs%force, length => outputs%system%length)
      measure%dimension = dimension_stress
      measure%numerator = force%numerator*length%denominator**2
      measure%denominator = force%denominator*length%numerator**2
    end associate
  end function stress_factor

  !> The unit of power: that of energies per second, W or kW where energies are in J or kJ.
  pure function power_unit(outputs) result(measure)
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    type(unit_t) :: measure

    measure = power_factor(outputs)
    select case (outputs%energy%name)
    case ("J")
      measure%name = "W"
    case ("kJ")
      measure%name = "kW"
    case default
      measure%name = outputs%energy%name//"/s"
    end select
  end function power_unit

  !> As `power_unit`, without the name.
  pure function power_factor(outputs) result(measure)
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    type(unit_t) :: measure

    measure%dimension = dimension_moment - dimension_time
    measure%numerator = outputs%energy%numerator
    measure%denominator = outputs%energy%denominator
  end function power_factor

  !> The unit of stiffness along a coordinate: of what acts along it per its change.
  pure function stiffness_unit(outputs, nature) result(measure)
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    type(nature_t), intent(in) :: nature        !! of the coordinate
    type(unit_t) :: measure

    measure = effort_per_change(outputs, nature, "")
    measure%dimension = nature%stiffness
  end function stiffness_unit

  !> The unit of damping along a coordinate: that of stiffness times that of time.
  pure function damping_unit(outputs, nature) result(measure)
    type(output_units_t), intent(in) :: outputs !! of the deck's results
    type(nature_t), intent(in) :: nature        !! of the coordinate
    type(unit_t) :: measure

    associate (time => outputs%system%time)
      measure = effort_per_change(outputs, nature, "."//time%name)
      measure%dimension = nature%damping
      measure%numerator = measure%numerator*time%numerator
      measure%denominator = measure%denominator*time%denominator
    end associate
  end function damping_unit

  !> Without the dimension. Changes of angles are in radians.
  pure function effort_per_change(outputs, nature, factor) result(measure)
    type(output_units_t), intent(in) :: outputs
    type(nature_t), intent(in) :: nature
    character(len=*), intent(in) :: factor !! in the name, behind the effort
    type(unit_t) :: measure

    type(unit_t) :: effort, change

    effort = outputs%force
    if (all(nature%effort == dimension_moment)) effort = outputs%moment
    change%name = "rad"
    if (nature%value(4) == 0) change = coherent_unit(outputs%system, nature%value)
    measure%numerator = effort%numerator*change%denominator
    measure%denominator = effort%denominator*change%numerator
    measure%name = effort%name//factor//"/"//change%name
  end function effort_per_change

  !> A unit known to exist, with the name that tables have.
  pure function unit_of(text, dimension) result(measure)
    character(len=*), intent(in) :: text
    integer, intent(in) :: dimension(4)
    type(unit_t) :: measure

    type(error_t), allocatable :: error

    call read_unit(text, dimension, measure, error)
    measure%name = table_name(measure)
  end function unit_of

  !> `N.m` and `mm2` for `N*m` and `mm^2`, as tables write products and powers.
  pure function table_name(measure) result(name)
    type(unit_t), intent(in) :: measure !! as a deck writes it
    character(len=:), allocatable :: name

    integer :: i

    name = ""
    do i = 1, len(measure%name)
      select case (measure%name(i:i))
      case ("*")
        name = name//"."
      case ("^")
      case default
        name = name//measure%name(i:i)
      end select
    end do
  end function table_name

end module output_units
