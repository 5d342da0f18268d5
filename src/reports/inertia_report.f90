!> `inertia.dat`: masses, their accelerations and inertia forces.
module inertia_report
  use acceleration_fields, only: acceleration_field_t, point_acceleration, scaled_sum, unit_fields
  use inertia_loads, only: lumped_masses, lumped_stations
  use kinds, only: wp
  use link_cards, only: has_own_mass
  use linkages, only: lump_t, normal_to
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use poses, only: pose_t
  use positions, only: positions_t
  use tables, only: append_column, append_real_columns, column_t, integer_cell, integer_column, &
    name_cell, name_column, real_cells, real_column, table_t, write_failure, write_gap, &
    write_header, write_row
  use text, only: append_string, string_t
  use units, only: coherent_unit, dimension_acceleration, dimension_force, dimension_length, &
    dimension_mass, dimension_moment, from_si, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: write_inertia

  !> The units of the table.
  type :: measures_t
    type(unit_t) :: length, mass, acceleration, force, moment
  end type measures_t

  !> What comes before the names of pins, and of links to which masses are fixed.
  character(len=*), parameter :: pin_mark = "pin:", mass_mark = "mass:"

contains

  !> One row a mass (lumped) or a link (distributed, or with a mass of its own), one a mass fixed to
  !! a link, then one a pin that has a mass; one block a speed.
  subroutine write_inertia(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(measures_t) :: measures
    type(column_t), allocatable :: columns(:)
    type(string_t), allocatable :: owners(:), notes(:)
    logical :: own(size(mechanism%names)), has_moment
    integer :: i, k

    measures = measures_of(model%units)
    owners = owners_of(mechanism)
    own = has_own_mass(model%links(model%loop))
    has_moment = any(own .or. is_spread(mechanism))
    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, real_column("crank", "deg"))
    call append_column(columns, integer_column("mass"))
    call append_column(columns, name_column("link", owners))
    call append_real_columns(columns, "x y", measures%length%name)
    call append_real_columns(columns, "ax ay", measures%acceleration%name)
    call append_real_columns(columns, "Fx Fy", measures%force%name)
    call append_column(columns, real_column("m", measures%mass%name))
    if (has_moment) call append_column(columns, real_column("moment", measures%moment%name))
    notes = notes_of(model, mechanism, own)
    call write_header(table, model%title, notes, columns)
    do k = 1, size(model%speed%value)
      if (k > 1) call write_gap(table, 2)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)))
          if (allocated(state%error)) then
            call write_failure(table, [model%speed%value(k), positions%crank(i)], &
              state%error%message)
          else
            call write_position(table, mechanism, own, measures, columns, state%pose, &
              scaled_sum(unit_fields(mechanism%linkage, state%pose, state%coefficients), &
              model%speed%value(k), model%acceleration), [model%speed%value(k), &
              positions%crank(i)], has_moment)
          end if
        end associate
      end do
    end do
  end subroutine write_inertia

  !> Names of links, of masses fixed to them and of pins with masses, as they stand in the column
  !! `link`.
  pure function owners_of(mechanism) result(owners)
    type(mechanism_t), intent(in) :: mechanism
    type(string_t), allocatable :: owners(:)

    integer :: i

    do i = 1, size(mechanism%names)
      call append_string(owners, mechanism%names(i)%text)
    end do
    do i = 1, size(mechanism%pin_names)
      call append_string(owners, pin_mark//mechanism%pin_names(i)%text)
    end do
    do i = 1, size(mechanism%names)
      if (size(mechanism%linkage%bodies(i)%lumps) > 0) call append_string(owners, &
        mass_mark//mechanism%names(i)%text)
    end do
  end function owners_of

  !> Which links have a mass that is distributed along them.
  pure function is_spread(mechanism) result(is)
    type(mechanism_t), intent(in) :: mechanism
    logical :: is(size(mechanism%names))

    is = mechanism%load_elements == 0 .and. mechanism%linkage%bodies%line_density > 0.0_wp
  end function is_spread

  pure function notes_of(model, mechanism, own) result(notes)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    logical, intent(in) :: own(:) !! (bodies) whether a link has a mass of its own
    type(string_t), allocatable :: notes(:)

    integer :: b, lumps

    if (any(mechanism%load_elements > 0)) call append_string(notes, &
      "lumped inertia: masses on the mesh nodes, F = -m a")
    if (any(is_spread(mechanism))) call append_string(notes, &
      "distributed inertia: a row a link at its mass centre, F = -m a, "// &
      "moment = -I alpha about the mass centre"// &
      trim(merge(", with rotary inertia", "                     ", model%rotary)))
    if (any(own)) call append_string(notes, &
      "links with a mass of their own: a row a link at its mass centre, F = -m a, "// &
      "moment = -I alpha about the mass centre")
    lumps = 0
    do b = 1, size(own)
      lumps = lumps + size(mechanism%linkage%bodies(b)%lumps)
    end do
    if (lumps > count(own)) call append_string(notes, &
      "masses fixed to links in rows of their own, "//mass_mark//"LINK")
    call append_string(notes, "masses at pins in rows of their own")
    call append_string(notes, acceleration_note(model))
  end function notes_of

  pure function measures_of(system) result(measures)
    type(unit_system_t), intent(in) :: system
    type(measures_t) :: measures

    measures%length = coherent_unit(system, dimension_length)
    measures%mass = coherent_unit(system, dimension_mass)
    measures%acceleration = coherent_unit(system, dimension_acceleration)
    measures%force = coherent_unit(system, dimension_force)
    measures%moment = coherent_unit(system, dimension_moment)
  end function measures_of

  !> All masses at one position and speed.
  subroutine write_position(table, mechanism, own, measures, columns, pose, field, place, &
    has_moment)
    type(table_t), intent(inout) :: table
    type(mechanism_t), intent(in) :: mechanism
    logical, intent(in) :: own(:)    !! (bodies) whether the first lump is the link itself
    type(measures_t), intent(in) :: measures
    type(column_t), intent(in) :: columns(:)
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    real(wp), intent(in) :: place(2) !! speed and crank angle [rad/s, deg]
    logical, intent(in) :: has_moment

    integer :: body, pin, i, number

    number = 0
    do body = 1, size(mechanism%names)
      associate (this => mechanism%linkage%bodies(body), name => mechanism%names(body)%text)
        if (this%line_density > 0.0_wp) call write_link(body)
        do i = 1, size(this%lumps)
          if (i == 1 .and. own(body)) then
            call write_lump(name, body, this%lumps(i))
          else
            call write_lump(mass_mark//name, body, this%lumps(i))
          end if
        end do
      end associate
    end do
    do pin = 1, size(mechanism%pin_names)
      associate (mass => mechanism%linkage%pin_mass(pin))
        if (mass <= 0.0_wp) cycle
        call write_mass(pin_mark//mechanism%pin_names(pin)%text, pose%pin(:, pin), &
          field%at_pin(:, pin), mass, 0.0_wp)
      end associate
    end do

  contains

    !> The uniform mass of a link: on its nodes, or as a whole.
    subroutine write_link(body)
      integer, intent(in) :: body

      real(wp), allocatable :: masses(:), stations(:)
      real(wp) :: moment
      integer :: i

      associate (this => mechanism%linkage%bodies(body))
        moment = 0.0_wp
        if (mechanism%load_elements(body) > 0) then
          masses = lumped_masses(this, mechanism%load_elements(body))
          stations = lumped_stations(this, mechanism%load_elements(body))
        else
          masses = [this%line_density*this%length]
          stations = [0.5_wp*this%length]
          ! (2.46) with I_G = m L²/12, and ρI L where rotary inertia is asked for
          moment = -masses(1)*this%length**2/12.0_wp*field%angular(body)
          if (this%rotary_inertia > 0.0_wp) moment = moment - &
            this%rotary_inertia*this%length*field%angular(body)
        end if
        do i = 1, size(masses)
          call write_mass(mechanism%names(body)%text, pose%pin(:, this%first_pin) + &
            stations(i)*pose%direction(:, body), point_acceleration(field, body, stations(i)), &
            masses(i), moment)
        end do
      end associate
    end subroutine write_link

    subroutine write_lump(owner, body, lump)
      character(len=*), intent(in) :: owner
      integer, intent(in) :: body
      type(lump_t), intent(in) :: lump

      associate (axis => pose%direction(:, body))
        call write_mass(owner, pose%pin(:, mechanism%linkage%bodies(body)%first_pin) + &
          lump%place(1)*axis + lump%place(2)*normal_to(axis), point_acceleration(field, body, &
          lump%place(1), lump%place(2)), lump%mass, -lump%inertia*field%angular(body))
      end associate
    end subroutine write_lump

    subroutine write_mass(owner, position, acceleration, mass, moment)
      character(len=*), intent(in) :: owner
      real(wp), intent(in) :: position(2), acceleration(2), mass !! [m, m/s², kg]
      real(wp), intent(in) :: moment                             !! [N m]

      real(wp) :: moments(merge(1, 0, has_moment))

      moments = from_si(moment, measures%moment)
      number = number + 1
      call write_row(table, real_cells(place)//integer_cell(number, columns(3)%name)// &
        name_cell(owner, columns(4)%width)//real_cells([from_si(position, measures%length), &
        from_si(acceleration, measures%acceleration), from_si(-mass*acceleration, measures%force), &
        from_si(mass, measures%mass), moments]))
    end subroutine write_mass

  end subroutine write_position

end module inertia_report
