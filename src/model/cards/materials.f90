!> MATERIAL card: the material of a link.
module materials
  use card_reader, only: check_form, has_key, read_entry_quantity, read_name, refuse_negative, &
    require_positive, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use kinds, only: wp
  use text, only: to_string
  use tokens, only: token_t
  use units, only: dimension_density, dimension_none, dimension_stress, unit_system_t
  use warnings, only: grade_doubt, grade_meaningless
  implicit none (type, external)
  private

  public :: material_t, read_material

  type :: material_t
    type(token_t) :: name
    real(wp) :: youngs_modulus = 0.0_wp !! [Pa]
    real(wp) :: density = 0.0_wp        !! [kg/m³]
    logical :: is_massless = .false.    !! by `density=0`
    real(wp) :: poissons_ratio = 0.0_wp !! [-]; 0 without `nu=`
    logical :: has_ratio = .false.      !! the card has `nu=`
  end type material_t

  !> Limits of the speed of longitudinal waves, √(E/ρ) [m/s]. It is 1200 in lead, 5100 in steel,
  !! 17,000 in diamond, 300 in cork; of the materials of links only rubber is slower. A unit error
  !! by a factor of 1000 (E in GPa for MPa, density in kg for tonne) turns steel's 5100 into 160.
  real(wp), parameter :: slowest_wave = 200.0_wp, fastest_wave = 30000.0_wp

  !> Beyond these no solid is left, not even rubber: a unit error by a factor of a million in E or
  !! density turns steel's 5100 m/s into 5 or 5,100,000 [m/s].
  real(wp), parameter :: impossible_slow_wave = 10.0_wp, impossible_fast_wave = 100000.0_wp

  !> Limits of what solids have. Below the least density are gases, fibres and foams, which are
  !! soft.
  real(wp), parameter :: least_modulus = 1.0e6_wp, most_modulus = 1.0e13_wp, &
    most_modulus_of_foam = 1.0e8_wp !! [Pa]
  real(wp), parameter :: least_density = 100.0_wp, most_density = 25000.0_wp !! [kg/m³]

contains

  !> Reads `MATERIAL name E= density= [nu=]`. Errors: words or keys that do not fit the card, an
  !! invalid name, a missing or unreadable value, E of 0 or less, a density below 0, ν
  !! outside (−1, 0.5].
  !! Warning: a speed of sound, E or a density that point to wrong units.
  pure subroutine read_material(card, system, diagnostics, material)
    type(card_t), intent(in) :: card                  !! the MATERIAL card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(material_t), intent(out) :: material         !! as read

    type(token_t) :: word
    logical :: fine, known_keys, is_whole, has_modulus, has_density

    call check_form(card, diagnostics, fine, known_keys)
    is_whole = fine .and. known_keys
    material%name = card%keyword
    if (size(card%words) > 0) then
      material%name = card%words(1)
      call read_name(material%name, diagnostics)
    end if
    call read_entry_quantity(card, "E", dimension_stress, system, known_keys, diagnostics, &
      material%youngs_modulus, has_modulus)
    if (has_modulus) call require_positive(card, "E", material%youngs_modulus, diagnostics)
    call read_entry_quantity(card, "density", dimension_density, system, known_keys, diagnostics, &
      material%density, has_density)
    material%is_massless = has_density .and. abs(material%density) <= 0.0_wp
    if (has_density) call refuse_negative(value_of(card, "density"), &
      material%density, "'density='", diagnostics)
    call read_entry_quantity(card, "nu", dimension_none, system, .false., diagnostics, &
      material%poissons_ratio, fine)
    material%has_ratio = has_key(card, "nu")
    if (fine .and. (material%poissons_ratio <= -1.0_wp .or. material%poissons_ratio > 0.5_wp)) then
      word = value_of(card, "nu")
      call add_error(diagnostics, word, "'nu=' must be above -1 and at most 0.5, not "//word%text)
    end if

    ! A unit after a blank is refused, and its number has the wrong one.
    if (.not. (is_whole .and. has_modulus .and. has_density)) return
    if (material%youngs_modulus <= 0.0_wp .or. material%density < 0.0_wp) return
    if (material%is_massless) then
      call check_alone(material, diagnostics)
      return
    end if
    call check_wave_speed(material, sqrt(material%youngs_modulus/material%density), diagnostics)
  end subroutine read_material

  !> Adds a warning if E or the density are those of no solid: both may be wrong by one factor, by
  !! which the speed of sound stays right.
  pure subroutine check_alone(material, diagnostics)
    type(material_t), intent(in) :: material
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: what

    ! Of a deck with errors the units may be others.
    if (has_errors(diagnostics)) return
    what = "E = "//to_string(material%youngs_modulus, 3)//" Pa of '"//material%name%text//"'"
    if (material%youngs_modulus < least_modulus .or. material%youngs_modulus > most_modulus) then
      what = what//" is that of no solid (rubber: 1e6 to 1e7, steel: 2.1e11, diamond: 1.1e12)"
    else if (material%density > most_density .or. material%density < least_density .and. &
      material%density > 0.0_wp .and. material%youngs_modulus > most_modulus_of_foam) then
      what = "density "//to_string(material%density, 3)//" kg/m3 of '"//material%name%text// &
        "' is that of no solid with E = "//to_string(material%youngs_modulus, 3)// &
        " Pa (balsa: 150, steel: 7850, osmium: 22600)"
    else
      return
    end if
    call add_warning(diagnostics, material%name, what//": are the units of E and density "// &
      "right? Write them, as in E=210GPa density=7850kg/m3", grade=grade_doubt)
  end subroutine check_alone

  !> Adds a warning if sound would be too slow or too fast for a material.
  pure subroutine check_wave_speed(material, wave_speed, diagnostics)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: wave_speed !! above 0 [m/s]
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: sound
    real(wp) :: amount

    if (wave_speed >= slowest_wave .and. wave_speed <= fastest_wave) then
      call check_alone(material, diagnostics)
      return
    end if
    amount = max(slowest_wave/wave_speed, wave_speed/fastest_wave)
    sound = "sound would travel through '"//material%name%text//"' at "//to_string(wave_speed)// &
      " m/s (lead: 1200, steel: 5100, diamond: 17000)"
    if (wave_speed < impossible_slow_wave .or. wave_speed > impossible_fast_wave) then
      call add_warning(diagnostics, material%name, sound//": the unit of E or density is "// &
        "wrong, and frequencies computed with it mean nothing", grade=grade_meaningless, &
        amount=amount)
    else
      call add_warning(diagnostics, material%name, sound// &
        ": are the units of E and density right?", grade=grade_doubt, amount=amount)
    end if
  end subroutine check_wave_speed

end module materials
