!> Loads of a mechanism in words, for the heads of tables.
module load_notes
  use friction_words, only: friction_lines
  use kinds, only: wp
  use link_cards, only: has_own_mass
  use load_words, only: process_words
  use mechanisms, only: mechanism_t
  use models, only: drives_length, has_law, model_t, runs_in_time
  use spring_words, only: spring_lines
  use text, only: append_string, plural, string_t, to_string
  use units, only: coherent_unit, dimension_acceleration, from_si, unit_t
  implicit none (type, external)
  private

  public :: append_load_notes, append_motion_notes, acceleration_note, actuator_words
  public :: potential_note, work_note

  !> What `potential` is in every table.
  character(len=*), parameter :: potential_note = "potential: of weights and constant forces, "// &
    "0 with all masses and pins at the global origin, and of springs, 0 unloaded"

  !> What `work` and `energy_error` of a motion are.
  character(len=*), parameter :: work_note = "work: of the motor and of all loads without a "// &
    "potential since the start; energy_error: kinetic + potential - work, less the initial energy"

contains

  !> Inertia of every link, gravity, external loads, actuators: one line for each of them. Springs,
  !! dampers and joints that rub: one line each.
  pure subroutine append_load_notes(notes, model, mechanism)
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which they are appended
    type(model_t), intent(in) :: model                     !! in SI
    type(mechanism_t), intent(in) :: mechanism             !! of the model

    type(string_t), allocatable :: lines(:)
    character(len=:), allocatable :: line
    integer :: b

    line = "inertia:"
    do b = 1, size(mechanism%names)
      if (b > 1) line = line//","
      line = line//" "//mechanism%names(b)%text//" "//inertia_words(model, mechanism, b)
    end do
    call append_string(notes, line)
    call append_string(notes, gravity_words(model, mechanism))
    call append_string(notes, outside_loads(model, mechanism))
    if (size(model%actuators) > 0) call append_string(notes, actuator_words(model))
    lines = spring_lines(model, mechanism)
    do b = 1, size(lines)
      call append_string(notes, lines(b)%text)
    end do
    lines = friction_lines(model, mechanism)
    do b = 1, size(lines)
      call append_string(notes, lines(b)%text)
    end do
  end subroutine append_load_notes

  !> `lumped on 4 elements`
  pure function inertia_words(model, mechanism, body) result(words)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: body
    character(len=:), allocatable :: words

    associate (this => mechanism%linkage%bodies(body))
      if (has_own_mass(model%links(mechanism%links(body)))) then
        words = "a body of its own"
      else if (this%line_density <= 0.0_wp .and. sum(this%lumps(:this%own_lumps)%mass) <= 0.0_wp) &
        then
        words = "without mass"
      else if (mechanism%load_elements(body) > 0) then
        words = "lumped on "//plural(mechanism%load_elements(body), "element")
      else
        words = "distributed"
        if (this%rotary_inertia > 0.0_wp) words = "distributed with rotary inertia"
      end if
    end associate
  end function inertia_words

  !> `gravity: 0 -9.81 m/s2`
  pure function gravity_words(model, mechanism) result(line)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    character(len=:), allocatable :: line

    line = "gravity: "//vector(mechanism%linkage%gravity, coherent_unit(model%units, &
      dimension_acceleration))
  end function gravity_words

  !> `efforts: by ACTUATE along ram; DRIVE crank gives the motion alone`
  pure function actuator_words(model) result(line)
    type(model_t), intent(in) :: model !! with actuators
    character(len=:), allocatable :: line

    integer :: i

    line = "efforts: by ACTUATE along "//model%actuators(1)%name%text
    do i = 2, size(model%actuators)
      line = line//", "//model%actuators(i)%name%text
    end do
    line = line//"; DRIVE "//model%drives(1)%subject%text
    do i = 2, size(model%drives)
      line = line//", "//model%drives(i)%subject%text
    end do
    line = line//trim(merge(" gives", " give ", size(model%drives) == 1))//" the motion alone"
  end function actuator_words

  !> External loads, forces on pins and torques on links, in one line.
  pure function outside_loads(model, mechanism) result(line)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    character(len=:), allocatable :: line

    character(len=:), allocatable :: before
    type(unit_t) :: moment
    integer :: i

    line = "external loads: none"
    before = "external loads: "
    associate (linkage => mechanism%linkage)
      do i = 1, size(mechanism%pin_names)
        if (all(abs(linkage%pin_force(:, i)) <= 0.0_wp)) cycle
        line = before//"force "//vector(linkage%pin_force(:, i), model%outputs%force)// &
          " at pin "//mechanism%pin_names(i)%text
        before = line//", "
      end do
      moment = model%outputs%moment
      do i = 1, size(mechanism%names)
        if (abs(linkage%couple(i)) <= 0.0_wp) cycle
        line = before//"torque "//to_string(from_si(linkage%couple(i), moment), 12)//" "// &
          moment%name//" on link "//mechanism%names(i)%text
        before = line//", "
      end do
    end associate
    do i = 1, size(model%processes)
      line = before//process_words(model, model%processes(i))
      before = line//"; "
    end do
  end function outside_loads

  !> `0 -9.81 m/s2`, or `none`
  pure function vector(components, measure) result(words)
    real(wp), intent(in) :: components(2) !! global x and y [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: words

    words = "none"
    if (all(abs(components) <= 0.0_wp)) return
    words = to_string(from_si(components(1), measure), 12)//" "// &
      to_string(from_si(components(2), measure), 12)//" "//measure%name
  end function vector

  !> The links and pins that numbers and letters in column names stand for, where these are not
  !! their names, and the crank's angular acceleration.
  pure subroutine append_motion_notes(notes, model, mechanism, as_four_bar)
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which they are appended
    type(model_t), intent(in) :: model                     !! in SI
    type(mechanism_t), intent(in) :: mechanism             !! of the model
    logical, intent(in) :: as_four_bar                     !! the table has such columns

    character(len=*), parameter :: links(3) = ["2", "3", "4"], pins(4) = ["O2", "A ", "B ", "O4"]
    character(len=:), allocatable :: words
    integer :: i

    if (.not. as_four_bar) then
      call append_string(notes, acceleration_note(model))
      return
    end if
    words = ""
    do i = 1, 3
      associate (name => mechanism%names(mechanism%four_bar%body(i))%text)
        if (name /= links(i)) words = words//"; "//links(i)//": link "//name
      end associate
    end do
    do i = 1, 4
      associate (name => mechanism%pin_names(mechanism%four_bar%pin(i))%text)
        if (name /= trim(pins(i))) words = words//"; "//trim(pins(i))//": pin "//name
      end associate
    end do
    if (len(words) > 0) call append_string(notes, words(3:))
    call append_string(notes, acceleration_note(model))
  end subroutine append_motion_notes

  !> Angular acceleration of the crank, or the name of its law, or that nothing moves.
  pure function acceleration_note(model) result(note)
    type(model_t), intent(in) :: model !! in SI
    character(len=:), allocatable :: note

    if (model%is_structure) then
      note = "structure: one position, at rest; speed and crank are 0"
    else if (runs_in_time(model)) then
      note = "motion: "//laws_of_drives(model)
    else if (has_law(model)) then
      note = "speed and acceleration of the first drive: by law "//model%drives(1)%law%text
    else if (drives_length(model)) then
      note = "acceleration of the first drive: "//to_string(from_si(model%acceleration, &
        coherent_unit(model%units, dimension_acceleration)))//" "//name_of_acceleration(model)
    else
      note = "angular acceleration of the crank: "//to_string(model%acceleration)//" rad/s2"
    end if
  end function acceleration_note

  !> `drive upper by law a, drive fore by law b`
  pure function laws_of_drives(model) result(words)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: words

    integer :: i

    words = ""
    do i = 1, size(model%drives)
      if (model%drives(i)%law%line == 0) cycle
      if (len(words) > 0) words = words//", "
      words = words//"drive "//model%drives(i)%subject%text//" by law "//model%drives(i)%law%text
    end do
  end function laws_of_drives

  pure function name_of_acceleration(model) result(name)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: name

    type(unit_t) :: measure

    measure = coherent_unit(model%units, dimension_acceleration)
    name = measure%name
  end function name_of_acceleration

end module load_notes
