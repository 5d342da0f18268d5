!> `inertia.dat`: masses, their accelerations and inertia forces.
module inertia_report
  use inertia_loads, only: lumped_masses, lumped_stations
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: inertia_lumped, model_t
  use motions, only: acceleration_field_t, point_acceleration, scaled_sum, unit_fields
  use poses, only: pose_t
  use positions, only: positions_t
  use tables, only: append_column, append_real_columns, column_t, integer_cell, integer_column, name_cell, name_column, &
    real_cells, real_column, table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t, to_string
  use units, only: coherent_unit, dimension_acceleration, dimension_force, dimension_length, dimension_mass, dimension_moment, &
    from_si, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: write_inertia

  !> The units of the table.
  type :: measures_t
    type(unit_t) :: length, mass, acceleration, force, moment
  end type measures_t

contains

  !> One row a mass (lumped) or a link (distributed), then one a pin that has a mass of its own; one block a speed.
  subroutine write_inertia(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(measures_t) :: measures
    type(column_t), allocatable :: columns(:), table_columns(:)
    type(string_t), allocatable :: owners(:), notes(:)
    integer :: i, k

    measures = measures_of(model%units)
    owners = [mechanism%names, mechanism%pin_names]
    do i = size(mechanism%names) + 1, size(owners)
      owners(i)%text = "pin:"//owners(i)%text
    end do
    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, real_column("crank", "deg"))
    call append_column(columns, integer_column("mass"))
    call append_column(columns, name_column("link", owners))
    call append_real_columns(columns, "x y", measures%length%name)
    call append_real_columns(columns, "ax ay", measures%acceleration%name)
    call append_real_columns(columns, "Fx Fy", measures%force%name)
    call append_column(columns, real_column("m", measures%mass%name))
    table_columns = columns
    if (model%inertia == inertia_lumped) then
      call append_string(notes, "lumped inertia: masses on the mesh nodes, F = -m a")
    else
      call append_string(notes, "distributed inertia: a row a link at its mass centre, F = -m a, "// &
        "moment = -I alpha about the mass centre"//trim(merge(", with rotary inertia", "                     ", model%rotary)))
      call append_column(table_columns, real_column("moment", measures%moment%name))
    end if
    call append_string(notes, "masses at pins in rows of their own")
    call append_string(notes, "angular acceleration of the crank: "//to_string(model%acceleration)//" rad/s2")
    call write_header(table, model%title, notes, table_columns)
    do k = 1, size(model%speed%value)
      if (k > 1) call write_gap(table, 2)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)))
          if (allocated(state%error)) then
            call write_failure(table, [model%speed%value(k), positions%crank(i)], state%error%message)
          else
            call write_position(table, mechanism, measures, columns, state%pose, &
              scaled_sum(unit_fields(mechanism%linkage, state%pose, state%motion), model%speed%value(k), model%acceleration), &
              [model%speed%value(k), positions%crank(i)], model%inertia == inertia_lumped)
          end if
        end associate
      end do
    end do
  end subroutine write_inertia

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
  subroutine write_position(table, mechanism, measures, columns, pose, field, place, lumped)
    type(table_t), intent(inout) :: table
    type(mechanism_t), intent(in) :: mechanism
    type(measures_t), intent(in) :: measures
    type(column_t), intent(in) :: columns(:)
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    real(wp), intent(in) :: place(2) !! speed and crank angle [rad/s, deg]
    logical, intent(in) :: lumped

    real(wp), allocatable :: masses(:), stations(:)
    real(wp) :: moment(merge(0, 1, lumped))
    integer :: body, pin, i, number

    number = 0
    do body = 1, size(mechanism%names)
      associate (this => mechanism%linkage%bodies(body))
        moment = 0.0_wp
        if (lumped) then
          masses = lumped_masses(this, mechanism%mesh%elements(body))
          stations = lumped_stations(this, mechanism%mesh%elements(body))
        else
          masses = [this%line_density*this%length]
          stations = [0.5_wp*this%length]
          ! (2.46) with I_G = m L²/12, and ρI L where rotary inertia is asked for
          moment = -masses*this%length**2/12.0_wp*field%angular(body)
          if (this%rotary_inertia > 0.0_wp) moment = moment - this%rotary_inertia*this%length*field%angular(body)
        end if
        do i = 1, size(masses)
          number = number + 1
          call write_mass(mechanism%names(body)%text, pose%pin(:, this%first_pin) + stations(i)*pose%direction(:, body), &
            point_acceleration(field, body, stations(i)), masses(i))
        end do
      end associate
    end do
    moment = 0.0_wp
    do pin = 1, size(mechanism%pin_names)
      associate (mass => mechanism%linkage%pin_mass(pin))
        if (mass <= 0.0_wp) cycle
        number = number + 1
        call write_mass("pin:"//mechanism%pin_names(pin)%text, pose%pin(:, pin), field%at_pin(:, pin), mass)
      end associate
    end do

  contains

    subroutine write_mass(owner, position, acceleration, mass)
      character(len=*), intent(in) :: owner
      real(wp), intent(in) :: position(2), acceleration(2), mass !! [m, m/s², kg]

      call write_row(table, real_cells(place)//integer_cell(number, columns(3)%name)//name_cell(owner, columns(4)%width)// &
        real_cells([from_si(position, measures%length), from_si(acceleration, measures%acceleration), &
        from_si(-mass*acceleration, measures%force), from_si(mass, measures%mass), from_si(moment, measures%moment)]))
    end subroutine write_mass

  end subroutine write_position

end module inertia_report
