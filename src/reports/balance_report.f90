!> `balance.dat` and `harmonics.dat`: what a linkage does to its ground, as it is and with
!! counterweights.
module balance_report
  use attached_parts, only: place_on_body
  use constants, only: degree
  use counterweights, only: balanced_linkage, counterweight_lump, counterweight_t, &
    find_counterweights, linkage_mass_centre, total_mass
  use crank_cycle, only: cycle_t, cycle_values, drive_torque, largest_values, quantity_count, &
    quantity_names, shaking_moment, turns_freely, usual_values
  use harmonics, only: highest_harmonic, spectrum_of, spectrum_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use linkages, only: linkage_t, lump_t
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use numbers, only: shortest_text
  use positions, only: positions_t, state_t
  use reactions, only: find_unit_reactions, reactions_at, reactions_t
  use settled_cycles, only: find_settled_cycles, least_share
  use tables, only: append_column, append_real_columns, column_t, name_cell, name_column, &
    real_cells, real_column, table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t, to_string, trimmed_list
  use units, only: coherent_unit, dimension_force, dimension_length, dimension_mass, &
    dimension_moment, from_si, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: write_balance, write_harmonics

  !> The units of the tables.
  type :: measures_t
    type(unit_t) :: length, mass, first_moment, force, moment
  end type measures_t

  character(len=*), parameter :: linkage_names(2) = [character(len=8) :: "given", "balanced"]

contains

  !> One row a position, one block a speed.
  subroutine write_balance(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(measures_t) :: measures
    type(counterweight_t) :: weights(2)
    type(linkage_t) :: balanced
    integer :: i, k

    measures = measures_of(model%units)
    weights = find_counterweights(mechanism%linkage, mechanism%load_elements)
    balanced = balanced_linkage(mechanism%linkage, weights)
    call write_header(table, model%title, balance_remarks(model, mechanism, weights, measures), &
      balance_columns(measures))
    do k = 1, size(model%speed%value)
      if (k > 1) call write_gap(table, 2)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)), speed => model%speed%value(k))
          if (allocated(state%error)) then
            call write_failure(table, [speed, positions%crank(i)], state%error%message)
          else
            call write_row(table, &
              real_cells([speed, positions%crank(i), &
              from_si(linkage_mass_centre(mechanism%linkage, mechanism%load_elements, state%pose), &
              measures%length), reactions_of(mechanism%linkage, mechanism%load_elements, state, &
              speed, model%acceleration, measures), reactions_of(balanced, &
              mechanism%load_elements, state, speed, model%acceleration, measures)]))
          end if
        end associate
      end do
    end do
  end subroutine write_balance

  pure function measures_of(system) result(measures)
    type(unit_system_t), intent(in) :: system
    type(measures_t) :: measures

    measures%length = coherent_unit(system, dimension_length)
    measures%mass = coherent_unit(system, dimension_mass)
    measures%first_moment = coherent_unit(system, dimension_mass + dimension_length)
    measures%force = coherent_unit(system, dimension_force)
    measures%moment = coherent_unit(system, dimension_moment)
  end function measures_of

  pure function balance_columns(measures) result(columns)
    type(measures_t), intent(in) :: measures
    type(column_t), allocatable :: columns(:)

    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, real_column("crank", "deg"))
    call append_real_columns(columns, "xG yG", measures%length%name)
    call append_real_columns(columns, "shaking_x shaking_y", measures%force%name)
    call append_real_columns(columns, "shaking_moment torque", measures%moment%name)
    call append_real_columns(columns, "balanced_x balanced_y", measures%force%name)
    call append_real_columns(columns, "balanced_moment balanced_torque", measures%moment%name)
  end function balance_columns

  !> Shaking force and moment and driving torque at a position and speed, in the units of the table.
  pure function reactions_of(linkage, elements, state, speed, acceleration, measures) result(cells)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: speed, acceleration !! of the crank [rad/s, rad/s²]
    type(measures_t), intent(in) :: measures
    real(wp) :: cells(4)

    type(reactions_t) :: reactions

    reactions = reactions_at(find_unit_reactions(linkage, elements, state%pose, &
      state%coefficients), speed, acceleration)
    cells = [from_si(reactions%shaking_force, measures%force), &
      from_si([reactions%shaking_moment, reactions%joints%torque], measures%moment)]
  end function reactions_of

  !> What the columns are, masses and counterweights.
  pure function balance_remarks(model, mechanism, weights, measures) result(list)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(counterweight_t), intent(in) :: weights(:)
    type(measures_t), intent(in) :: measures
    type(string_t), allocatable :: list(:)

    integer :: i

    list = quantity_remarks(model, mechanism)
    call append_string(list, "G: mass centre of the moving masses, without counterweights")
    call append_string(list, &
      "total mass: "//to_string(from_si(total_mass(mechanism%linkage, mechanism%load_elements), &
      measures%mass), 12)//" "//measures%mass%name)
    do i = 1, size(weights)
      call add_counterweight(model, mechanism, weights(i), measures, list)
    end do
  end function balance_remarks

  !> What both tables have to say of their quantities.
  pure function quantity_remarks(model, mechanism) result(list)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(string_t), allocatable :: list(:)

    call append_string(list, &
      "shaking force: sum of the inertia forces -m a; shaking moment: that of these and of all "// &
      "-I alpha, about "//mechanism%pin_names(1)%text//"; torque: of the drive on link "// &
      mechanism%names(1)%text//", with gravity and loads")
    call append_string(list, &
      "balanced: with the counterweights of balance.dat, each as far from its ground pivot as "// &
      "its link is long")
    call append_string(list, acceleration_note(model))
  end function quantity_remarks

  !> Mass × radius and angle, and the card that makes it.
  pure subroutine add_counterweight(model, mechanism, weight, measures, list)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(counterweight_t), intent(in) :: weight
    type(measures_t), intent(in) :: measures
    type(string_t), allocatable, intent(inout) :: list(:)

    type(lump_t) :: lump
    real(wp) :: place(2)
    character(len=:), allocatable :: from, to

    associate (body => mechanism%linkage%bodies(weight%body), &
      name => mechanism%names(weight%body)%text)
      if (.not. weight%needed) then
        call append_string(list, "link "//name//" needs no counterweight")
        return
      end if
      from = mechanism%pin_names(merge(body%first_pin, body%last_pin, body%sense > 0.0_wp))%text
      to = mechanism%pin_names(merge(body%last_pin, body%first_pin, body%sense > 0.0_wp))%text
      call append_string(list, "counterweight of link "//name//": mass x radius "// &
        shortest_text(from_si(norm2(weight%first_moment), measures%first_moment))//" "// &
        measures%first_moment%name//", at "// &
        shortest_text(atan2(weight%first_moment(2), weight%first_moment(1))/degree)// &
        " deg from "//from//" -> "//to)
      lump = counterweight_lump(weight, body, body%length)
      ! Going from card to body and back is the same.
      place = from_si(place_on_body(model, weight%body, lump%place), measures%length) + 0.0_wp
      call append_string(list, &
        "card, with the link's length for a radius (the shaking force depends on mass x radius "// &
        "only, "//"moment and torque on the radius too):")
      call append_string(list, "MASS "//name//" at="//shortest_text(place(1))//" offset="// &
        shortest_text(place(2))//" "//shortest_text(from_si(lump%mass, measures%mass))// &
        measures%mass%name)
    end associate
  end subroutine add_counterweight

  !> One row a quantity of a linkage, one block a speed; none where there is no whole turn.
  subroutine write_harmonics(table, model, mechanism)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism

    type(measures_t) :: measures
    type(column_t), allocatable :: columns(:)
    type(string_t), allocatable :: remarks(:)
    type(linkage_t) :: linkages(2)
    type(cycle_t) :: turns(2)
    ! More than this is not what rounding does.
    real(wp), parameter :: unsettled = 1.0e-10_wp
    real(wp) :: change
    integer :: k

    measures = measures_of(model%units)
    columns = harmonic_columns()
    remarks = quantity_remarks(model, mechanism)
    if (.not. turns_freely(mechanism%linkage)) then
      call append_string(remarks, &
        "no rows: the crank does not turn fully, or comes to a dead point, and there is no cycle")
      call write_header(table, model%title, remarks, columns)
      return
    end if
    linkages(1) = mechanism%linkage
    linkages(2) = balanced_linkage(linkages(1), find_counterweights(linkages(1), &
      mechanism%load_elements))
    call find_settled_cycles(linkages, mechanism%load_elements, model%speed%value, &
      model%acceleration, turns, change)
    call append_string(remarks, &
      "over a whole turn of the crank: largest absolute value, root of the mean square, mean, "// &
      "and "// &
      "mean + sum of h_k cos(k crank + phase_k); speed and acceleration are the same all round")
    call append_string(remarks, "forces in "//measures%force%name//", moments and torques in "// &
      measures%moment%name//", phases in deg; a phase is 0 where its h is only rounding")
    call append_string(remarks, "samples: "//to_string(size(turns(1)%part, 3))// &
      "; every second of them gives the same to "//to_string(change, 2)//" of the largest value")
    if (change > unsettled) call append_string(remarks, &
      "harmonics have not settled: the crank passes next to a dead point, "// &
      "or the shaking force through zero")
    call write_header(table, model%title, remarks, columns)
    do k = 1, size(model%speed%value)
      if (was_interrupted()) return
      if (k > 1) call write_gap(table, 2)
      call write_speed(table, mechanism, linkages, turns, model%speed%value(k), &
        model%acceleration, measures, columns)
    end do
  end subroutine write_harmonics

  pure function harmonic_columns() result(columns)
    type(column_t), allocatable :: columns(:)

    integer :: i

    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, name_column("linkage", trimmed_list(linkage_names)))
    call append_column(columns, name_column("quantity", trimmed_list(quantity_names)))
    ! Their units are those of the quantity of the row.
    call append_real_columns(columns, "largest rms mean", "-")
    do i = 1, highest_harmonic
      call append_column(columns, real_column("h"//to_string(i), "-"))
    end do
    do i = 1, highest_harmonic
      call append_column(columns, real_column("phase"//to_string(i), "deg"))
    end do
  end function harmonic_columns

  !> The rows of a speed.
  subroutine write_speed(table, mechanism, linkages, turns, speed, acceleration, measures, columns)
    type(table_t), intent(inout) :: table
    type(mechanism_t), intent(in) :: mechanism
    type(linkage_t), intent(in) :: linkages(:)
    type(cycle_t), intent(in) :: turns(:)
    real(wp), intent(in) :: speed, acceleration !! of the crank [rad/s, rad/s²]
    type(measures_t), intent(in) :: measures
    type(column_t), intent(in) :: columns(:)

    ! Harmonics smaller than this share of what is usual have no digit that tells where they begin.
    real(wp), parameter :: unknown_phase = 1.0e-12_wp
    real(wp), allocatable :: values(:, :)
    real(wp) :: largest(quantity_count, 2), phase(highest_harmonic), unit_value, &
      usual(quantity_count)
    type(spectrum_t) :: spectrum
    integer :: i, q

    do i = 1, size(linkages)
      largest(:, i) = largest_values(linkages(i), mechanism%load_elements, turns(i), speed, &
        acceleration)
    end do
    usual = max(maxval(largest, dim=2), least_share*usual_values(linkages(1), &
      mechanism%load_elements, speed, acceleration))
    do i = 1, size(linkages)
      values = cycle_values(turns(i), speed, acceleration)
      do q = 1, quantity_count
        spectrum = spectrum_of(values(:, q))
        phase = 0.0_wp
        where (abs(spectrum%coefficient) > unknown_phase*usual(q)) &
          phase = atan2(aimag(spectrum%coefficient), real(spectrum%coefficient))/degree
        unit_value = from_si(1.0_wp, measures%force)
        if (q == shaking_moment .or. q == drive_torque) unit_value = from_si(1.0_wp, &
          measures%moment)
        call write_row(table, real_cells([speed])//name_cell(trim(linkage_names(i)), &
          columns(2)%width)//name_cell(trim(quantity_names(q)), columns(3)%width)// &
          real_cells([unit_value*[largest(q, i), spectrum%rms, spectrum%mean, &
          abs(spectrum%coefficient)], phase]))
      end do
    end do
  end subroutine write_speed

end module balance_report
