!> Units of measurement: names, dimensions and exact factors to SI.
!!
!! A factor is stored as a fraction of whole numbers (mm = 1/1000, in = 254/10000), so that 254 mm
!! becomes the double nearest to 0.254 m and converts back to 254 mm.
module units
  use constants, only: degree, pi
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: wp
  use spelling, only: suggestion
  use text, only: lower_case, string_t, to_string
  implicit none (type, external)
  private

  public :: unit_t, unit_system_t, dimension_name, wrong_unit, read_unit, new_unit_system, &
    si_units, coherent_unit, coherent_factor, name_known, to_si, from_si, in_degrees, serves_for
  public :: dimension_none, dimension_length, dimension_mass, dimension_time, dimension_angle, &
    dimension_rate
  public :: dimension_angular_acceleration, dimension_velocity, dimension_acceleration, &
    dimension_force, dimension_moment
  public :: dimension_stress, dimension_density, dimension_area, dimension_second_moment, &
    dimension_rotary_inertia
  public :: dimension_inertia, dimension_damping
  public :: dimension_line_stiffness, dimension_line_damping, dimension_turning_stiffness

  !> Exponents of length, mass, time and angle. An angle counts as a dimension here, so that rpm and
  !! 1/s are distinct.
  integer, parameter :: dimension_none(4) = [0, 0, 0, 0]
  integer, parameter :: dimension_length(4) = [1, 0, 0, 0]
  integer, parameter :: dimension_mass(4) = [0, 1, 0, 0]
  integer, parameter :: dimension_time(4) = [0, 0, 1, 0]
  integer, parameter :: dimension_angle(4) = [0, 0, 0, 1]
  integer, parameter :: dimension_rate(4) = [0, 0, -1, 1]
  integer, parameter :: dimension_angular_acceleration(4) = [0, 0, -2, 1]
  integer, parameter :: dimension_velocity(4) = [1, 0, -1, 0]
  integer, parameter :: dimension_acceleration(4) = [1, 0, -2, 0]
  integer, parameter :: dimension_force(4) = [1, 1, -2, 0]
  integer, parameter :: dimension_moment(4) = [2, 1, -2, 0]
  integer, parameter :: dimension_stress(4) = [-1, 1, -2, 0]
  integer, parameter :: dimension_density(4) = [-3, 1, 0, 0]
  integer, parameter :: dimension_rotary_inertia(4) = [1, 1, 0, 0] !! per length of a link
  integer, parameter :: dimension_inertia(4) = [2, 1, 0, 0]
  integer, parameter :: dimension_damping(4) = [2, 1, -1, 0]       !! moment per angular velocity,
                                                                   !! without the angle
  integer, parameter :: dimension_line_stiffness(4) = [0, 1, -2, 0]    !! force per length
  integer, parameter :: dimension_line_damping(4) = [0, 1, -1, 0]      !! force per velocity
  integer, parameter :: dimension_turning_stiffness(4) = [2, 1, -2, -1] !! moment per angle
  integer, parameter :: dimension_area(4) = [2, 0, 0, 0]
  integer, parameter :: dimension_second_moment(4) = [4, 0, 0, 0]

  type :: unit_t
    character(len=:), allocatable :: name !! `mm`, `lbf*s2/in`, …
    integer :: dimension(4) = 0           !! exponents of length, mass, time, angle
    real(wp) :: numerator = 1.0_wp        !! value in SI = value × numerator/denominator
    real(wp) :: denominator = 1.0_wp
  end type unit_t

  !> Units of the bare numbers in a deck, from its UNITS card.
  type :: unit_system_t
    type(unit_t) :: length !! base unit
    type(unit_t) :: mass   !! base unit
    type(unit_t) :: time   !! base unit
  end type unit_system_t

  !> 1 lbf = 1 lbm × 9.80665 m/s²; 1 lbm = 0.45359237 kg; 1 in = 0.0254 m: all exact by definition.
  real(wp), parameter :: lbm(2) = [45359237.0_wp, 100000000.0_wp]
  real(wp), parameter :: gravity(2) = [980665.0_wp, 100000.0_wp]

contains

  !> All named units; all other units are products of their powers.
  pure function named_units() result(list)
    type(unit_t), allocatable :: list(:)

    ! No array constructor: gfortran 12 would leak the memory of every name.
    allocate (list(27))
    list(1) = unit("m", dimension_length, 1.0_wp, 1.0_wp)
    list(2) = unit("mm", dimension_length, 1.0_wp, 1000.0_wp)
    list(3) = unit("cm", dimension_length, 1.0_wp, 100.0_wp)
    list(4) = unit("in", dimension_length, 254.0_wp, 10000.0_wp)
    list(5) = unit("ft", dimension_length, 3048.0_wp, 10000.0_wp)
    list(6) = unit("kg", dimension_mass, 1.0_wp, 1.0_wp)
    list(7) = unit("g", dimension_mass, 1.0_wp, 1000.0_wp)
    list(8) = unit("tonne", dimension_mass, 1000.0_wp, 1.0_wp)
    list(9) = unit("lbm", dimension_mass, lbm(1), lbm(2))
    list(10) = unit("slug", dimension_mass, lbm(1)/1.0e4_wp*gravity(1), &
      lbm(2)/1.0e4_wp*gravity(2)*0.3048_wp)
    list(11) = unit("slinch", dimension_mass, lbm(1)/1.0e4_wp*gravity(1), &
      lbm(2)/1.0e4_wp*gravity(2)*0.0254_wp)
    list(12) = unit("s", dimension_time, 1.0_wp, 1.0_wp)
    list(13) = unit("ms", dimension_time, 1.0_wp, 1000.0_wp)
    list(14) = unit("N", dimension_force, 1.0_wp, 1.0_wp)
    list(15) = unit("kN", dimension_force, 1000.0_wp, 1.0_wp)
    list(16) = unit("lbf", dimension_force, lbm(1)/1.0e4_wp*gravity(1), lbm(2)/1.0e4_wp*gravity(2))
    list(17) = unit("Pa", dimension_stress, 1.0_wp, 1.0_wp)
    list(18) = unit("kPa", dimension_stress, 1.0e3_wp, 1.0_wp)
    list(19) = unit("MPa", dimension_stress, 1.0e6_wp, 1.0_wp)
    list(20) = unit("GPa", dimension_stress, 1.0e9_wp, 1.0_wp)
    list(21) = unit("psi", dimension_stress, lbm(1)/1.0e4_wp*gravity(1), &
      lbm(2)/1.0e4_wp*gravity(2)*0.00064516_wp)
    list(22) = unit("ksi", dimension_stress, lbm(1)/1.0e1_wp*gravity(1), &
      lbm(2)/1.0e4_wp*gravity(2)*0.00064516_wp)
    list(23) = unit("rad", dimension_angle, 1.0_wp, 1.0_wp)
    list(24) = unit("deg", dimension_angle, pi, 180.0_wp)
    list(25) = unit("rpm", dimension_rate, pi, 30.0_wp)
    list(26) = unit("J", dimension_moment, 1.0_wp, 1.0_wp)
    list(27) = unit("kJ", dimension_moment, 1000.0_wp, 1.0_wp)
  end function named_units

  pure function unit(name, dimension, numerator, denominator)
    character(len=*), intent(in) :: name
    integer, intent(in) :: dimension(4)
    real(wp), intent(in) :: numerator, denominator
    type(unit_t) :: unit

    unit%name = name
    unit%dimension = dimension
    unit%numerator = numerator
    unit%denominator = denominator
  end function unit

  !> Reads `mm`, `kg/m3`, `N/mm^2`, `lbf*s2/in`, …
  !!
  !! Powers are whole numbers after a name, with or without `^`, or ² and ³. A factor after `*` or
  !! `·` multiplies, a factor after `/` divides. `°` is `deg`. Names are case-sensitive.
  !!
  !! Errors: a part is not a unit; the message suggests the nearest one of the wanted dimension.
  pure subroutine read_unit(text, wanted, measure, error)
    character(len=*), intent(in) :: text             !! without blanks
    integer, intent(in) :: wanted(4)                 !! dimension for suggestions; that of the unit
                                                     !! may differ
    type(unit_t), intent(out) :: measure             !! its name is `text`; incomplete after an
                                                     !! error
    type(error_t), allocatable, intent(out) :: error !! names the unknown part

    character(len=:), allocatable :: name
    integer :: first, last, step

    call use_ascii(text, name)
    measure = unit(name, dimension_none, 1.0_wp, 1.0_wp)
    first = 1
    step = 1
    do
      last = scan(name(first:), "*/")
      last = merge(first + last - 2, len(name), last > 0)
      call multiply_by_power(measure, name(first:last), step, wanted, error)
      if (allocated(error) .or. last >= len(name)) return
      step = merge(-1, 1, name(last + 1:last + 1) == "/")
      first = last + 2
    end do
  end subroutine read_unit

  !> A unit with its degree sign, raised powers and dots as they are named here. A subroutine:
  !! gfortran 12 keeps the length of a function result in one place for all threads.
  pure subroutine use_ascii(text, name)
    character(len=*), intent(in) :: text !! UTF-8
    character(len=:), allocatable, intent(out) :: name

    character(len=2), parameter :: sign(4) = char(194)//[char(176), char(183), char(178), char(179)]
    character(len=3), parameter :: meaning(4) = ["deg", "*  ", "2  ", "3  "]
    character(len=:), allocatable :: buffer
    integer :: at, length, i, n

    ! A sign has two bytes, and its meaning three at most.
    allocate (character(len=2*len(text)) :: buffer)
    at = 1
    length = 0
    characters: do while (at <= len(text))
      do i = 1, size(sign)
        if (text(at:min(at + 1, len(text))) /= sign(i)) cycle
        n = len_trim(meaning(i))
        buffer(length + 1:length + n) = meaning(i)
        length = length + n
        at = at + len(sign)
        cycle characters
      end do
      length = length + 1
      buffer(length:length) = text(at:at)
      at = at + 1
    end do characters
    name = buffer(:length)
  end subroutine use_ascii

  !> Multiplies (`step = 1`) or divides (`step = -1`) a unit by a named unit to a power.
  pure subroutine multiply_by_power(measure, factor, step, wanted, error)
    type(unit_t), intent(inout) :: measure
    character(len=*), intent(in) :: factor
    integer, intent(in) :: step
    integer, intent(in) :: wanted(4) !! dimension of the whole
    type(error_t), allocatable, intent(inout) :: error

    type(unit_t), allocatable :: known(:)
    character(len=:), allocatable :: name
    integer :: i, power, name_length

    power = 1
    name_length = len(factor)
    if (name_length > 1) then
      i = scan("123456789", factor(name_length:))
      if (i > 0) then
        power = i
        name_length = name_length - 1
        if (name_length > 1 .and. factor(name_length:name_length) == "^") name_length = &
          name_length - 1
      end if
    end if
    name = factor(:name_length)

    known = named_units()
    do i = 1, size(known)
      if (len(known(i)%name) /= len(name)) cycle
      if (known(i)%name /= name) cycle
      measure%dimension = measure%dimension + step*power*known(i)%dimension
      call multiply_unit(measure, known(i), step*power)
      return
    end do
    call set_error(error, error_of_input, "unknown unit '"//factor//"'"// &
      unit_hint(name, known, wanted)//"; expected a unit of "//dimension_noun(wanted))
  end subroutine multiply_by_power

  !> ` (did you mean 'in'?)`: the name here of a unit under another one, or the nearest spelling;
  !! empty if there is none.
  pure function unit_hint(name, known, wanted) result(hint)
    character(len=*), intent(in) :: name !! unknown
    type(unit_t), intent(in) :: known(:)
    integer, intent(in) :: wanted(4)     !! dimension of the whole
    character(len=:), allocatable :: hint

    select case (lower_case(name))
    case ("degree", "degrees", "grad")
      hint = "deg"
    case ("radian", "radians")
      hint = "rad"
    case ("u/min", "upm", "rev/min", "r/min")
      hint = "rpm"
    case ("inch", "inches", """", "''")
      hint = "in"
    case ("foot", "feet", "'")
      hint = "ft"
    case ("metre", "meter", "metres", "meters")
      hint = "m"
    case ("millimetre", "millimeter", "millimetres", "millimeters")
      hint = "mm"
    case ("sec", "second", "seconds")
      hint = "s"
    case ("gram", "grams", "gr")
      hint = "g"
    case ("t", "to", "ton", "tons", "tonnes")
      hint = "tonne"
    case ("lb", "lbs", "pound", "pounds")
      ! Of a force or stress, time is to the power −2.
      hint = trim(merge("lbf", "lbm", wanted(3) == -2))
    case ("newton", "newtons")
      hint = "N"
    case ("cc", "ccm")
      hint = "cm3"
    case default
      hint = suggestion(name, names_of_dimension(known, wanted))
      return
    end select
    hint = " (did you mean '"//hint//"'?)"
  end function unit_hint

  !> Names of the units of a dimension; of all units if none has this dimension. Of moments, which
  !! are products as a rule, the usual ones and all units.
  pure function names_of_dimension(known, wanted) result(names)
    type(unit_t), intent(in) :: known(:)
    integer, intent(in) :: wanted(4)
    type(string_t), allocatable :: names(:)

    character(len=*), parameter :: moments(*) = [character(len=6) :: "N*m", "N*mm", "kN*m", &
      "lbf*in", "lbf*ft"]
    integer :: i, number
    logical :: fits(size(known)), is_moment

    fits = [(all(known(i)%dimension == wanted), i=1, size(known))]
    is_moment = all(wanted == dimension_moment)
    if (.not. any(fits) .or. is_moment) fits = .true.
    number = 0
    if (is_moment) number = size(moments)
    allocate (names(number + count(fits)))
    do i = 1, number
      names(i)%text = trim(moments(i))
    end do
    do i = 1, size(known)
      if (.not. fits(i)) cycle
      number = number + 1
      names(number)%text = known(i)%name
    end do
  end function names_of_dimension

  !> A unit system from its base units.
  pure function new_unit_system(length, mass, time) result(system)
    type(unit_t), intent(in) :: length, mass, time !! base unit
    type(unit_system_t) :: system

    system%length = length
    system%mass = mass
    system%time = time
  end function new_unit_system

  !> Metre, kilogram and second.
  pure function si_units() result(system)
    type(unit_system_t) :: system

    type(error_t), allocatable :: error

    call read_unit("m", dimension_length, system%length, error)
    call read_unit("kg", dimension_mass, system%mass, error)
    call read_unit("s", dimension_time, system%time, error)
  end function si_units

  !> The unit of a bare number of the given dimension in a deck.
  !!
  !! Angles are in degrees and angular velocities in rad/s whatever the UNITS card says; all other
  !! units follow from it.
  pure function coherent_unit(system, dimension) result(measure)
    type(unit_system_t), intent(in) :: system !! from the UNITS card
    integer, intent(in) :: dimension(4)       !! exponents of length, mass, time, angle
    type(unit_t) :: measure

    type(unit_t) :: moment

    measure = coherent_factor(system, dimension)
    if (dimension(4) == 0) call name_coherent(system, measure)
    if (all(dimension == dimension_turning_stiffness)) then
      moment = coherent_factor(system, dimension_moment)
      call name_coherent(system, moment)
      measure%name = moment%name//"/rad"
    end if
  end function coherent_unit

  !> As `coherent_unit`, but without the name, which takes longer to find than the rest.
  pure function coherent_factor(system, dimension) result(measure)
    type(unit_system_t), intent(in) :: system !! from the UNITS card
    integer, intent(in) :: dimension(4)       !! exponents of length, mass, time, angle
    type(unit_t) :: measure

    if (dimension(4) /= 0) then
      if (all(dimension == dimension_angle)) measure = unit("deg", dimension, pi, 180.0_wp)
      if (all(dimension == dimension_rate)) measure = unit("rad/s", dimension, 1.0_wp, 1.0_wp)
      if (all(dimension == dimension_angular_acceleration)) measure = unit("rad/s2", dimension, &
        1.0_wp, 1.0_wp)
      if (any(dimension /= dimension_turning_stiffness)) return
    end if
    ! The angle of a stiffness is in radians.
    measure = unit("", dimension, 1.0_wp, 1.0_wp)
    call multiply_unit(measure, system%length, dimension(1))
    call multiply_unit(measure, system%mass, dimension(2))
    call multiply_unit(measure, system%time, dimension(3))
  end function coherent_factor

  !> Multiplies the factor of a unit by a power, positive or negative, of that of another.
  pure subroutine multiply_unit(measure, factor, power)
    type(unit_t), intent(inout) :: measure
    type(unit_t), intent(in) :: factor
    integer, intent(in) :: power

    if (power >= 0) then
      measure%numerator = measure%numerator*factor%numerator**power
      measure%denominator = measure%denominator*factor%denominator**power
    else
      measure%numerator = measure%numerator*factor%denominator**(-power)
      measure%denominator = measure%denominator*factor%numerator**(-power)
    end if
  end subroutine multiply_unit

  ! Names of units are found by subroutines: rows of tables need them, which threads make at the
  ! same time, and functions of deferred length would share a place for it.

  !> Names a unit `N` if it has a name of its own, else as a product such as `lbm.in/s2`.
  pure subroutine name_coherent(system, measure)
    type(unit_system_t), intent(in) :: system
    type(unit_t), intent(inout) :: measure !! whose name is set

    type(unit_t), allocatable :: known(:)
    integer :: i

    known = named_units()
    do i = 1, size(known)
      if (all(measure%dimension == dimension_moment) .and. &
        all(known(i)%dimension == dimension_force)) then
        if (same_factor(measure, product_of(known(i), system%length))) then
          measure%name = known(i)%name//"."//system%length%name
          return
        end if
      end if
      ! A moment is no energy, though its dimension is the same.
      if (all(known(i)%dimension == dimension_moment)) cycle
      if (any(known(i)%dimension /= measure%dimension)) cycle
      if (.not. same_factor(measure, known(i))) cycle
      measure%name = known(i)%name
      return
    end do
    measure%name = ""
    call append_factors(system, measure%dimension(:3), measure%name)
    if (any(measure%dimension(:3) < 0)) then
      if (len(measure%name) == 0) measure%name = "1"
      measure%name = measure%name//"/"
      call append_factors(system, -measure%dimension(:3), measure%name)
    end if
    if (len(measure%name) == 0) measure%name = "-"
  end subroutine name_coherent

  !> Names a unit `MPa` for N/mm²: as the known unit with its dimension and factor; empty if there
  !! is none.
  pure subroutine name_known(measure)
    type(unit_t), intent(inout) :: measure !! whose name is set

    type(unit_t), allocatable :: known(:)
    integer :: i

    measure%name = ""
    known = named_units()
    do i = 1, size(known)
      if (any(known(i)%dimension /= measure%dimension)) cycle
      if (.not. same_factor(measure, known(i))) cycle
      measure%name = known(i)%name
      return
    end do
  end subroutine name_known

  pure function same_factor(a, b) result(same)
    type(unit_t), intent(in) :: a, b
    logical :: same

    same = abs(a%numerator*b%denominator - b%numerator*a%denominator) <= &
      1.0e-12_wp*abs(b%numerator*a%denominator)
  end function same_factor

  pure function product_of(a, b) result(c)
    type(unit_t), intent(in) :: a, b
    type(unit_t) :: c

    c = unit(a%name//"."//b%name, a%dimension + b%dimension, a%numerator*b%numerator, &
      a%denominator*b%denominator)
  end function product_of

  !> Appends `tonne.mm2`: the base units with positive exponents, mass first.
  pure subroutine append_factors(system, exponents, name)
    type(unit_system_t), intent(in) :: system
    integer, intent(in) :: exponents(3) !! of length, mass and time
    character(len=:), allocatable, intent(inout) :: name

    integer, parameter :: in_order(3) = [2, 1, 3]
    type(string_t) :: factor(3)
    integer :: i, power
    logical :: is_first

    factor(1)%text = system%mass%name
    factor(2)%text = system%length%name
    factor(3)%text = system%time%name
    is_first = .true.
    do i = 1, 3
      power = exponents(in_order(i))
      if (power < 1) cycle
      if (.not. is_first) name = name//"."
      is_first = .false.
      name = name//factor(i)%text
      if (power > 1) name = name//to_string(power)
    end do
  end subroutine append_factors

  !> The name of a dimension, for messages; empty for a dimension without a name.
  pure function dimension_noun(dimension) result(noun)
    integer, intent(in) :: dimension(4)
    character(len=:), allocatable :: noun

    noun = ""
    if (all(dimension == dimension_none)) noun = "pure number"
    if (all(dimension == dimension_length)) noun = "length"
    if (all(dimension == dimension_mass)) noun = "mass"
    if (all(dimension == dimension_time)) noun = "time"
    if (all(dimension == dimension_angle)) noun = "angle"
    if (all(dimension == dimension_rate)) noun = "angular velocity"
    if (all(dimension == dimension_angular_acceleration)) noun = "angular acceleration"
    if (all(dimension == dimension_velocity)) noun = "velocity"
    if (all(dimension == dimension_acceleration)) noun = "acceleration"
    if (all(dimension == dimension_force)) noun = "force"
    if (all(dimension == dimension_moment)) noun = "moment"
    if (all(dimension == dimension_stress)) noun = "stress"
    if (all(dimension == dimension_density)) noun = "density"
    if (all(dimension == dimension_area)) noun = "area"
    if (all(dimension == dimension_second_moment)) noun = "second moment of area"
    if (all(dimension == dimension_inertia)) noun = "moment of inertia"
    if (all(dimension == dimension_length - dimension_angle)) noun = "length per angle"
    if (all(dimension == dimension_angle - dimension_length)) noun = "angle per length"
    if (all(dimension == dimension_damping)) noun = "moment per angular velocity"
    if (all(dimension == dimension_line_damping)) noun = "force per velocity"
    if (all(dimension == dimension_line_stiffness)) noun = "force per length"
    if (all(dimension == dimension_turning_stiffness)) noun = "moment per angle"
  end function dimension_noun

  !> `a length`, `an area`: the expected quantity in messages.
  pure function dimension_name(dimension) result(name)
    integer, intent(in) :: dimension(4) !! exponents of length, mass, time, angle
    character(len=:), allocatable :: name

    name = dimension_noun(dimension)
    if (len(name) == 0) then
      name = "a quantity of another kind"
    else if (scan(name(:1), "aeiou") == 1) then
      name = "an "//name
    else
      name = "a "//name
    end if
  end function dimension_name

  !> Whether a unit has the wanted dimension. Damping and stiffness may be written with their angle,
  !! `N*m*s/rad`, `N*m/rad`, or without, `N*m*s`, `N*m`.
  pure function serves_for(measure, wanted) result(serves)
    type(unit_t), intent(in) :: measure !! as read
    integer, intent(in) :: wanted(4)    !! exponents of length, mass, time, angle
    logical :: serves

    serves = all(measure%dimension == wanted)
    if (all(wanted == dimension_damping)) serves = serves .or. &
      all(measure%dimension == wanted - dimension_angle)
    if (all(wanted == dimension_turning_stiffness)) serves = serves .or. &
      all(measure%dimension == wanted + dimension_angle)
  end function serves_for

  !> The text of an error about a unit of the wrong dimension.
  pure function wrong_unit(measure, wanted) result(reason)
    type(unit_t), intent(in) :: measure !! as read
    integer, intent(in) :: wanted(4)    !! exponents of length, mass, time, angle
    character(len=:), allocatable :: reason

    if (len(dimension_noun(measure%dimension)) == 0) then
      reason = "'"//measure%name//"' is not a unit of "//dimension_noun(wanted)
    else if (all(wanted == dimension_none)) then
      reason = "'"//measure%name//"' is a unit of "//dimension_noun(measure%dimension)// &
        "; expected a number without unit"
    else
      reason = "'"//measure%name//"' is a unit of "//dimension_noun(measure%dimension)// &
        "; expected a unit of "//dimension_noun(wanted)
    end if
  end function wrong_unit

  !> Converts a value to SI.
  elemental function to_si(value, measure) result(si)
    real(wp), intent(in) :: value       !! in the given unit
    type(unit_t), intent(in) :: measure !! the given unit
    real(wp) :: si

    si = value*measure%numerator/measure%denominator
  end function to_si

  !> Converts a value from SI.
  elemental function from_si(si, measure) result(value)
    real(wp), intent(in) :: si          !! in SI units
    type(unit_t), intent(in) :: measure !! the unit of the result
    real(wp) :: value

    value = converted(si, measure%numerator, measure%denominator)
  end function from_si

  !> An angle in degrees.
  elemental function in_degrees(angle) result(value)
    real(wp), intent(in) :: angle !! [rad]
    real(wp) :: value

    value = converted(angle, degree, 1.0_wp)
  end function in_degrees

  !> The decimal number of 15 digits that is `si` once it is converted, if there is one: 30 degrees
  !! that are carried in radians are 30 again, not 29.999999999999996. Else the number itself.
  elemental function converted(si, numerator, denominator) result(value)
    real(wp), intent(in) :: si                     !! in SI units
    real(wp), intent(in) :: numerator, denominator !! of the unit, as in `unit_t`
    real(wp) :: value

    ! Powers of ten up to the 22nd are doubles exactly.
    integer, parameter :: digits = 15, largest_power = 22
    real(wp) :: decimal
    integer :: power

    value = si*denominator/numerator
    if (abs(numerator - denominator) <= 0.0_wp .or. abs(value) <= 0.0_wp) return
    power = digits - 1 - floor(log10(abs(value)))
    if (power < 0 .or. power > largest_power) return
    decimal = anint(value*10.0_wp**power)/10.0_wp**power
    if (abs(decimal*numerator/denominator - si) <= 0.0_wp) value = decimal
  end function converted

end module units
