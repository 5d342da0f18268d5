!> The first part of `run.log`: what the deck describes.
module run_log
  use body_lines, only: body_line, mass_line
  use drawing_checks, only: drawing_remarks
  use effect_cards, only: effect_words
  use kinds, only: wp
  use link_cards, only: has_own_mass
  use load_words, only: process_words
  use mechanisms, only: mechanism_t
  use models, only: branch_crossed, has_law, inertia_distributed, inertia_lumped, link_mass, &
    model_t, needs_frequencies
  use motor_cards, only: is_geared
  use pose_types, only: pins_of_body
  use friction_words, only: friction_lines
  use spring_words, only: spring_lines
  use text, only: plural, same_word, string_t, to_string
  use units, only: coherent_unit, dimension_acceleration, dimension_length, &
    dimension_inertia, dimension_mass, from_si, unit_t
  implicit none (type, external)
  private

  public :: model_summary

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Title, links in the order in which they are placed, masses, loads, requests: a few lines.
  pure function model_summary(model, mechanism) result(text)
    type(model_t), intent(in) :: model         !! without errors
    type(mechanism_t), intent(in) :: mechanism !! of the model
    character(len=:), allocatable :: text

    character(len=:), allocatable :: where_to
    type(string_t), allocatable :: remarks(:)
    type(unit_t) :: length, mass
    integer :: i

    text = ""
    if (len(model%title) > 0) text = model%title//line_feed
    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    do i = 1, size(mechanism%links)
      associate (link => model%links(mechanism%links(i)))
        where_to = way_of(mechanism, i)
        text = text//"link "//link%name%text//": "//where_to//", length "// &
          to_string(from_si(link%length, length), 12)//" "//length%name
        if (link_mass(model, mechanism%links(i)) > 0.0_wp) then
          text = text//", mass "//to_string(from_si(link_mass(model, mechanism%links(i)), mass), &
            12)// &
            " "//mass%name
        end if
        if (link%rigid) text = text//", rigid"
        text = text//line_feed
        if (has_own_mass(link)) text = text//body_line(model, mechanism%links(i))//line_feed
      end associate
    end do
    remarks = drawing_remarks(model)
    do i = 1, size(remarks)
      text = text//remarks(i)%text//line_feed
    end do
    do i = 1, size(model%pin_masses)
      text = text//"mass at pin "//model%pin_masses(i)%pin%text//": "// &
        to_string(from_si(model%pin_masses(i)%mass, mass), 12)//" "//mass%name//line_feed
    end do
    do i = 1, size(model%masses)
      text = text//mass_line(model, i)//line_feed
    end do
    if (mass_of_model(model) > 0.0_wp) then
      text = text//"total mass: "//to_string(from_si(mass_of_model(model), mass), 12)//" "// &
        mass%name//line_feed
    end if
    if (mechanism%is_four_bar) text = text//"branch: "//trim(merge("crossed", "open   ", &
      model%branch == branch_crossed))//line_feed
    if (model%inertia == inertia_lumped) text = text//"inertia loads: lumped"//line_feed
    if (model%inertia == inertia_distributed) text = text//"inertia loads: distributed"//line_feed
    text = text//load_lines(model)//motor_lines(model)
    remarks = spring_lines(model, mechanism)
    do i = 1, size(remarks)
      text = text//remarks(i)%text//line_feed
    end do
    remarks = friction_lines(model, mechanism)
    do i = 1, size(remarks)
      text = text//remarks(i)%text//line_feed
    end do
    if (needs_frequencies(model)) then
      text = text//"effects: "//effect_words(model%effects, model%rotary, model%shear)//line_feed
    end if
    if (has_law(model)) then
      text = text//plural(size(model%time%value), "instant")//" of "//law_text(model)//line_feed
    else if (.not. model%is_structure) then
      text = text//plural(size(model%crank%value), "crank angle")//", "// &
        plural(size(model%speed%value), "speed")//line_feed
    end if
  end function model_summary

  !> `law feed`, or `laws feed, lift`: of the drives in their order, each once.
  pure function law_text(model) result(text)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: text

    integer :: i, k
    logical :: is_new

    text = model%drives(1)%law%text
    do i = 2, size(model%drives)
      is_new = model%drives(i)%law%line > 0
      do k = 1, i - 1
        is_new = is_new .and. .not. same_word(model%drives(k)%law%text, model%drives(i)%law%text)
      end do
      if (is_new) text = text//", "//model%drives(i)%law%text
    end do
    text = trim(merge("laws", "law ", index(text, ",") > 0))//" "//text
  end function law_text

  !> `A - B - C`: the pins of a link; of a four-bar in the order of the loop.
  pure function way_of(mechanism, body) result(way)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: body
    character(len=:), allocatable :: way

    integer :: pins(2 + size(mechanism%linkage%bodies(body)%further)), i

    pins = pins_of_body(mechanism%linkage%bodies(body))
    way = mechanism%pin_names(pins(1))%text
    do i = 2, size(pins)
      way = way//" - "//mechanism%pin_names(pins(i))%text
    end do
  end function way_of

  !> Gravity, forces and torques, one per line.
  pure function load_lines(model) result(text)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: text

    type(unit_t) :: acceleration, force, moment
    integer :: i

    acceleration = coherent_unit(model%units, dimension_acceleration)
    force = model%outputs%force
    moment = model%outputs%moment
    text = ""
    if (model%gravity_word%line > 0) text = "gravity: "//pair_text(model%gravity, acceleration)// &
      line_feed
    do i = 1, size(model%forces)
      text = text//"force at pin "//model%forces(i)%pin%text//": "// &
        pair_text(model%forces(i)%force, force)//line_feed
    end do
    do i = 1, size(model%torques)
      text = text//"torque on link "//model%torques(i)%link_name%text//": "// &
        to_string(from_si(model%torques(i)%torque, moment), 12)//" "//moment%name//line_feed
    end do
    do i = 1, size(model%processes)
      text = text//process_words(model, model%processes(i))//line_feed
    end do
  end function load_lines

  !> The motor of a forward motion.
  pure function motor_lines(model) result(text)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: text

    type(unit_t) :: moment

    moment = model%outputs%moment
    text = ""
    if (model%motor%keyword%line > 0) then
      if (model%motor%is_line) then
        text = "motor: torque "//to_string(from_si(model%motor%stall, moment), 12)//" "// &
          moment%name//" at rest, none at "//to_string(from_si(model%motor%noload, &
          model%outputs%rate), 12)//" "//model%outputs%rate%name//line_feed
      else if (model%motor%table_word%line > 0) then
        text = "motor: torque by the table "//model%motor%table_word%text//", line "// &
          to_string(model%motor%line)//line_feed
      else
        text = "motor: torque "//to_string(from_si(model%motor%torque, moment), 12)//" "// &
          moment%name//line_feed
      end if
      if (is_geared(model%motor)) text = text//gear_line(model)//line_feed
    end if
  end function motor_lines

  !> `gear of the motor: ratio 40, efficiency 0.7, rotor 1.2e-05 kg.m2, on the driven link 0.0192`
  pure function gear_line(model) result(line)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: line

    type(unit_t) :: inertia

    inertia = coherent_unit(model%units, dimension_inertia)
    associate (motor => model%motor)
      line = "gear of the motor: ratio "//to_string(motor%ratio, 12)//", efficiency "// &
        to_string(motor%efficiency, 12)
      if (motor%rotor > 0.0_wp) line = line//", rotor "//to_string(from_si(motor%rotor, inertia), &
        12)//" "//inertia%name//", on the driven link "//to_string(from_si(motor%ratio**2* &
        motor%rotor, inertia), 12)//" "//inertia%name
    end associate
  end function gear_line

  !> `0, -9810 mm/s2`
  pure function pair_text(pair, measure) result(text)
    real(wp), intent(in) :: pair(2) !! [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: text

    text = to_string(from_si(pair(1), measure), 12)//", "//to_string(from_si(pair(2), measure), &
      12)//" "//measure%name
  end function pair_text

  !> Mass of all links, pin masses, and masses fixed to links [kg].
  pure function mass_of_model(model) result(mass)
    type(model_t), intent(in) :: model
    real(wp) :: mass

    integer :: i

    mass = 0.0_wp
    do i = 1, size(model%links)
      mass = mass + link_mass(model, i)
    end do
    if (size(model%pin_masses) > 0) mass = mass + sum(model%pin_masses%mass)
    if (size(model%masses) > 0) mass = mass + sum(model%masses%mass)
  end function mass_of_model

end module run_log
