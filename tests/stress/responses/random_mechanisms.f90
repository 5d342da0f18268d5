!> Random mechanisms with all that a deck can hold for the elastic response.
module random_mechanisms
  use constants, only: pi, two_pi
  use divided_structures, only: divide
  use four_bars, only: new_four_bar
  use kinds, only: wp
  use linkages, only: linkage_t, lump_t
  use random_numbers, only: generator_t, happens, new_generator, one_of, power, uniform
  use response_types, only: damping_ratio, damping_time, gauge_t, response_point_t, response_request_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: random_case_t, new_random_case, family_names, of_resonance

  type :: random_case_t
    integer :: number = 0
    integer :: family = 0
    type(structure_t) :: structure
    type(response_request_t) :: request
    real(wp) :: lowest = 0.0_wp !! frequency of the links by themselves, as pinned, the lowest [rad/s]
    real(wp) :: sine = 0.0_wp   !! least sine of the transmission angle over the turn
  end type random_case_t

  integer, parameter :: of_light = 1, of_heavy = 2, of_rigid = 3, of_masses = 4, of_offsets = 5, of_shear = 6, of_loads = 7, &
    of_fast = 8, of_slow = 9, of_dead_points = 10, of_no_damping = 11, of_strong_damping = 12, of_resonance = 13, of_terms = 14, &
    of_all = 15

  character(len=*), parameter :: family_names(*) = [character(len=14) :: "light", "heavy", "rigid", "masses", "offsets", "shear", &
    "loads", "fast", "slow", "dead_points", "no_damping", "strong_damping", "resonance", "terms", "all"]

contains

  !> The case of a number: families in turns, accuracies from 1e-3 to 1e-9 in each.
  function new_random_case(number) result(case)
    integer, intent(in) :: number !! from 1
    type(random_case_t) :: case

    type(generator_t) :: draw

    draw = new_generator(number)
    case%number = number
    case%family = modulo(number - 1, size(family_names)) + 1
    call draw_linkage(draw, case)
    call draw_request(draw, case)
    case%request%accuracy = 10.0_wp**(-3 - modulo((number - 1)/size(family_names), 7))
  end function new_random_case

  subroutine draw_linkage(draw, case)
    type(generator_t), intent(inout) :: draw
    type(random_case_t), intent(inout) :: case

    real(wp) :: ground, length(3), angle, origin(2), density(3), thickness(3), modulus(3), width(3), link_mass, frequency, euler
    logical :: crossed, some, bends(3)
    integer :: b

    call draw_lengths(draw, case%family == of_dead_points, ground, length, case%sine)
    call uniform(draw, 0.0_wp, two_pi, angle)
    call uniform(draw, -1.0_wp, 1.0_wp, origin(1))
    call uniform(draw, -1.0_wp, 1.0_wp, origin(2))
    call happens(draw, 0.5_wp, crossed)
    do b = 1, 3
      call power(draw, 9.8_wp, 11.4_wp, modulus(b))
      call power(draw, 3.0_wp, 3.95_wp, density(b))
      if (case%family == of_shear) then
        call power(draw, -1.5_wp, -0.6_wp, thickness(b))
      else
        call power(draw, -2.6_wp, -1.2_wp, thickness(b))
      end if
      thickness(b) = thickness(b)*length(b)
      call power(draw, -2.5_wp, -1.0_wp, width(b))
    end do
    ! Links of one machine are not of any thickness beside each other.
    call happens(draw, 0.5_wp, some)
    if (some) then
      thickness = thickness(1)/length(1)*length
      width = width(1)
      modulus = modulus(1)
      density = density(1)
    end if
    bends = .true.
    call happens(draw, 0.3_wp, some)
    if (case%family == of_rigid .or. (case%family == of_all .and. some)) call draw_rigid(draw, bends)
    case%structure%linkage = new_four_bar(reshape([origin, origin + ground*[cos(angle), sin(angle)]], [2, 2]), length, &
      density*thickness*width, [0.0_wp, 0.0_wp], crossed)
    allocate (case%structure%beams(3), case%request%section(3))
    case%lowest = huge(1.0_wp)
    link_mass = sum(density*thickness*width*length)/3.0_wp
    call draw_pin_masses(draw, case%family, link_mass, case%structure%linkage)
    do b = 1, 3
      associate (body => case%structure%linkage%bodies(b), beam => case%structure%beams(b), &
        section => case%request%section(b))
        body%bends = bends(b)
        call draw_lumps(draw, case%family, body%line_density*length(b), length(b), bends(b), body%lumps)
        if (.not. bends(b)) cycle
        beam%axial_stiffness = modulus(b)*thickness(b)*width(b)
        beam%bending_stiffness = beam%axial_stiffness*thickness(b)**2/12.0_wp
        section%outer = thickness(b)/2.0_wp
        section%modulus = modulus(b)
        call draw_effects(draw, case%family, density(b), thickness(b), width(b), modulus(b), beam%shear_stiffness, &
          body%rotary_inertia)
        frequency = (pi/length(b))**2*sqrt(beam%bending_stiffness/(body%line_density + (2.0_wp*sum(body%lumps%mass) + &
          0.5_wp*sum(case%structure%linkage%pin_mass))/length(b)))
        case%lowest = min(case%lowest, frequency)
      end associate
    end do
    if (.not. any(bends)) error stop "nothing bends"
    euler = minval(pi**2*case%structure%beams%bending_stiffness/length**2, mask=bends)
    call draw_loads(draw, case%family, euler, case%sine, minval(length), case%structure%linkage)
    call divide(case%structure)
  end subroutine draw_linkage

  !> Four lengths such that the crank turns fully.
  subroutine draw_lengths(draw, narrow, ground, length, sine)
    type(generator_t), intent(inout) :: draw
    logical, intent(in) :: narrow !! dead points are near
    real(wp), intent(out) :: ground, length(3), sine

    real(wp) :: cosine
    integer :: i

    do
      call power(draw, -1.2_wp, 0.2_wp, ground)
      do i = 1, 3
        call power(draw, -1.2_wp, 0.2_wp, length(i))
      end do
      cosine = max(abs(length(2)**2 + length(3)**2 - (ground - length(1))**2), &
        abs(length(2)**2 + length(3)**2 - (ground + length(1))**2))/(2.0_wp*length(2)*length(3))
      if (cosine >= 1.0_wp) cycle
      sine = sqrt(1.0_wp - cosine**2)
      if (narrow .and. sine > 0.05_wp .and. sine < 0.25_wp) exit
      if (.not. narrow .and. sine > 0.3_wp) exit
    end do
  end subroutine draw_lengths

  subroutine draw_rigid(draw, bends)
    type(generator_t), intent(inout) :: draw
    logical, intent(inout) :: bends(3)

    integer :: i, count_of

    call one_of(draw, 2, count_of)
    call one_of(draw, 3, i)
    if (count_of == 1) then
      bends(i) = .false.
    else
      bends = .false.
      bends(i) = .true.
    end if
  end subroutine draw_rigid

  subroutine draw_pin_masses(draw, family, link_mass, linkage)
    type(generator_t), intent(inout) :: draw
    integer, intent(in) :: family
    real(wp), intent(in) :: link_mass
    type(linkage_t), intent(inout) :: linkage

    logical :: some
    integer :: p

    do p = 2, 3
      call happens(draw, 0.3_wp, some)
      if (.not. some .and. family /= of_heavy) cycle
      call power(draw, -1.5_wp, merge(1.5_wp, 0.0_wp, family == of_heavy), linkage%pin_mass(p))
      linkage%pin_mass(p) = linkage%pin_mass(p)*link_mass
    end do
  end subroutine draw_pin_masses

  !> Masses on a link; a rigid one is a shape of any kind half the time.
  subroutine draw_lumps(draw, family, link_mass, length, bends, lumps)
    type(generator_t), intent(inout) :: draw
    integer, intent(in) :: family
    real(wp), intent(in) :: link_mass, length
    logical, intent(in) :: bends
    type(lump_t), allocatable, intent(inout) :: lumps(:)

    integer :: number, i
    logical :: some, beside

    number = 0
    select case (family)
    case (of_masses, of_offsets)
      call one_of(draw, 3, number)
      call happens(draw, 0.7_wp, some)
      if (.not. some) number = 0
    case (of_rigid, of_loads, of_all)
      call one_of(draw, 3, number)
      number = number - 1
    end select
    if (allocated(lumps)) deallocate (lumps)
    allocate (lumps(number))
    do i = 1, number
      call power(draw, -2.0_wp, 0.5_wp, lumps(i)%mass)
      lumps(i)%mass = lumps(i)%mass*link_mass
      call uniform(draw, 0.05_wp, 0.95_wp, lumps(i)%place(1))
      call happens(draw, 0.15_wp, some)
      if (some) lumps(i)%place(1) = merge(0.0_wp, 1.0_wp, lumps(i)%place(1) < 0.5_wp)
      call happens(draw, 0.5_wp, beside)
      if (family == of_offsets .or. .not. bends .or. (beside .and. family == of_all)) then
        call uniform(draw, -0.25_wp, 0.25_wp, lumps(i)%place(2))
        call power(draw, -4.0_wp, -1.5_wp, lumps(i)%inertia)
        lumps(i)%inertia = lumps(i)%inertia*lumps(i)%mass*length**2
        call happens(draw, 0.3_wp, some)
        if (some) lumps(i)%inertia = 0.0_wp
      end if
      lumps(i)%place = lumps(i)%place*length
    end do
  end subroutine draw_lumps

  subroutine draw_effects(draw, family, density, thickness, width, modulus, shear_stiffness, rotary_inertia)
    type(generator_t), intent(inout) :: draw
    integer, intent(in) :: family
    real(wp), intent(in) :: density, thickness, width, modulus
    real(wp), intent(inout) :: shear_stiffness, rotary_inertia

    integer :: kind

    call one_of(draw, 6, kind)
    if (family /= of_shear .and. (family /= of_all .or. kind <= 3)) return
    if (kind /= 5) rotary_inertia = density*width*thickness**3/12.0_wp
    if (kind /= 6) shear_stiffness = modulus*thickness*width/3.1_wp
  end subroutine draw_effects

  subroutine draw_loads(draw, family, euler, sine, length, linkage)
    type(generator_t), intent(inout) :: draw
    integer, intent(in) :: family
    real(wp), intent(in) :: euler, sine, length
    type(linkage_t), intent(inout) :: linkage

    real(wp) :: size_of, angle
    logical :: some
    integer :: p, b

    call happens(draw, 0.3_wp, some)
    if (family /= of_loads .and. .not. some) return
    call uniform(draw, 0.0_wp, two_pi, angle)
    linkage%gravity = 9.81_wp*[cos(angle), sin(angle)]
    if (family /= of_loads .and. family /= of_all) return
    do p = 2, 3
      call uniform(draw, 0.0_wp, two_pi, angle)
      call power(draw, -3.0_wp, -0.7_wp, size_of)
      linkage%pin_force(:, p) = size_of*sine*euler*[cos(angle), sin(angle)]
    end do
    do b = 1, 3
      call happens(draw, 0.5_wp, some)
      if (.not. some) cycle
      call uniform(draw, -0.05_wp, 0.05_wp, size_of)
      linkage%couple(b) = size_of*sine*euler*length
    end do
  end subroutine draw_loads

  !> Speed, damping, terms, points and gauges.
  subroutine draw_request(draw, case)
    type(generator_t), intent(inout) :: draw
    type(random_case_t), intent(inout) :: case

    real(wp) :: share, value
    logical :: some
    integer :: b, i, kind

    associate (request => case%request, linkage => case%structure%linkage)
      select case (case%family)
      case (of_fast)
        call power(draw, -1.0_wp, -0.4_wp, share)
      case (of_slow)
        call power(draw, -3.0_wp, -2.0_wp, share)
      case default
        call power(draw, -2.2_wp, -0.8_wp, share)
      end select
      if (case%family == of_dead_points) share = share*case%sine
      call happens(draw, 0.1_wp, some)
      request%speed = [merge(-1.0_wp, 1.0_wp, some)*share*case%sine*case%lowest]
      allocate (request%damping(3))
      call one_of(draw, 4, kind)
      call power(draw, -4.0_wp, -1.0_wp, value)
      if (case%family == of_strong_damping) call power(draw, -1.0_wp, 0.3_wp, value)
      do b = 1, 3
        if (.not. linkage%bodies(b)%bends) cycle
        if (case%family == of_no_damping .or. (kind == 4 .and. case%family /= of_strong_damping)) cycle
        call happens(draw, 0.1_wp, some)
        if (some .and. case%family /= of_strong_damping) cycle
        call one_of(draw, 2, i)
        if (kind <= 2) i = kind
        request%damping(b)%kind = merge(damping_time, damping_ratio, i == 1)
        request%damping(b)%value = merge(value/case%lowest, min(0.9_wp, value), i == 1)
      end do
      if (case%family == of_resonance .or. case%family == of_all) then
        call happens(draw, 0.5_wp, some)
        if (some) request%damping%value = 1.0e-2_wp*request%damping%value
      end if
      if (case%family == of_terms) then
        call happens(draw, 0.5_wp, request%terms%coriolis)
        call happens(draw, 0.5_wp, request%terms%centripetal)
        call happens(draw, 0.5_wp, request%terms%axial)
        call happens(draw, 0.5_wp, request%terms%quadratic)
      end if
      allocate (request%gauges(0), request%points(0))
      do b = 1, 3
        request%points = [request%points, response_point_t(b, [linkage%bodies(b)%length, 0.0_wp])]
        call uniform(draw, 0.0_wp, 1.0_wp, share)
        call uniform(draw, -0.3_wp, 0.3_wp, value)
        request%points = [request%points, response_point_t(b, [share, value]*linkage%bodies(b)%length)]
        if (.not. linkage%bodies(b)%bends) cycle
        request%gauges = [request%gauges, gauge_t(b, 0.5_wp)]
        call uniform(draw, 0.0_wp, 1.0_wp, share)
        request%gauges = [request%gauges, gauge_t(b, share, -1.0_wp, -1.0_wp)]
      end do
      ! The follower's last pin is fixed: its first is the moving one.
      request%points(5)%place = 0.0_wp
      request%crank = [(2.0_wp*i, i=0, 179)]
      request%peaks = .true.
    end associate
  end subroutine draw_request

end module random_mechanisms
