!> `balance.dat` and `harmonics.dat`: shaking force, shaking moment and driving torque of a
!! linkage, as given and with counterweights.
module balance_report
  use balance_study, only: has_balanced, obstacle_link, obstacle_none, obstacle_pin, obstacle_ram
  use counterweight_notes, only: append_counterweight, append_partial_notes, balanced_by_cards
  use drive_motions, only: drive_rates
  use harmonics_study, only: has_settled, highest_harmonic, is_moment, quantity_count, &
    quantity_names
  use joint_study, only: joints_result_t
  use joints_report, only: drives_notes
  use kinds, only: wp
  use load_notes, only: acceleration_note
  use position_rows, only: add_position_row
  use report_kinds, only: four_bars, other_linkages, report_kind_t
  use report_types, only: add_table, has_to_look_back, report_record_t, &
    state_table_t, table_plan_t, whole_table_t
  use table_columns, only: cells, column_width, name_list_t, table_factor, table_layout_t, &
    table_unit
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell, real_cells
  use text, only: append_string, string_t, to_string, trimmed_list
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_balance, describe_hung_balance

  character(len=*), parameter :: linkage_names(2) = [character(len=8) :: "given", "balanced"]

  !> `balance.dat` of a four-bar.
  type, extends(state_table_t) :: balance_table_t
  contains
    procedure, nopass :: looks_back => has_to_look_back
    procedure, nopass :: find_notes => balance_notes
    procedure, nopass :: add_position => add_balance
  end type balance_table_t

  !> `harmonics.dat` of a four-bar.
  type, extends(whole_table_t) :: harmonics_table_t
  contains
    procedure, nopass :: find_notes => harmonics_notes
    procedure, nopass :: add_all => add_harmonics
  end type harmonics_table_t

  !> `balance.dat` of other linkages.
  type, extends(state_table_t) :: hung_balance_table_t
  contains
    procedure, nopass :: looks_back => has_to_look_back
    procedure, nopass :: find_notes => hung_balance_notes
    procedure, nopass :: plan => plan_hung_balance
    procedure, nopass :: add_position => add_balance
  end type hung_balance_table_t

  !> `harmonics.dat` of other linkages.
  type, extends(whole_table_t) :: hung_harmonics_table_t
  contains
    procedure, nopass :: find_notes => hung_harmonics_notes
    procedure, nopass :: add_all => add_harmonics
  end type hung_harmonics_table_t

contains

  !> REPORT balance.
  subroutine describe_balance(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="balance", help="shaking force, counterweights, harmonics", &
      pattern="REPORT balance [format=]", studies="joints balance harmonics", positions=.true., &
      masses=.true., weighs=.true., numbers=210, &
      linkages=four_bars)
    call add_table(report, balance_table_t(), "balance", "speed:speed crank:deg xG,yG:length "// &
      "shaking_x,shaking_y:force shaking_moment,torque:moment balanced_x,balanced_y:force "// &
      "balanced_moment,balanced_torque:moment")
    call add_table(report, harmonics_table_t(), "harmonics", "speed:speed linkage,"// &
      "quantity:name largest,rms,mean:- h*:- phase*:deg", words=harmonics_words(), &
      numbered=highest_harmonic)
  end subroutine describe_balance

  !> REPORT balance of linkages that are no four-bars.
  subroutine describe_hung_balance(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="balance", help="of other linkages: shaking force, "// &
      "counterweights", pattern="REPORT balance [format=]", &
      studies="joints balance harmonics", positions=.true., masses=.true., weighs=.true., &
      linkages=other_linkages)
    call add_table(report, hung_balance_table_t(), "balance", "speed:speed crank:deg xG,"// &
      "yG:length shaking_x,shaking_y:force shaking_moment:moment torque:effort balanced_x?,"// &
      "balanced_y?:force balanced_moment?:moment balanced_torque?:effort")
    call add_table(report, hung_harmonics_table_t(), "harmonics", "speed:speed linkage,"// &
      "quantity:name largest,rms,mean:- h*:- phase*:deg", words=harmonics_words(), &
      numbered=highest_harmonic)
  end subroutine describe_hung_balance

  !> Meaning of the columns, total mass, counterweights.
  pure subroutine balance_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its balance computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    type(unit_t) :: mass
    integer :: i

    mass = table_unit("mass", variant%model%outputs)
    notes = quantity_notes(variant)
    call append_string(notes, "G: mass centre of the moving masses, without counterweights")
    call append_string(notes, "total mass: "// &
      to_string(from_si(variant%found%balance%mass, mass), 12)//" "//mass%name)
    if (allocated(variant%found%balance%partial)) then
      call append_partial_notes(variant, notes)
      return
    end if
    do i = 1, size(variant%found%balance%weights)
      call append_counterweight(variant, i, "card, with the link's length for a radius (the "// &
        "shaking force depends on mass x radius only, moment and torque on the radius too):", &
        notes)
    end do
  end subroutine balance_notes

  !> Of linkages that are no four-bars, for both tables: what is balanced, or why nothing is.
  pure subroutine append_balanced_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant         !! with its balance computed
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which a line is appended

    if (allocated(variant%found%balance%partial)) then
      call append_string(notes, balanced_by_cards(variant))
    else if (variant%found%balance%obstacle%kind == obstacle_none) then
      call append_string(notes, "balanced: with the counterweights of balance.dat, each as far "// &
        "from the pin about which it balances as its link is long")
    else
      call append_string(notes, "no counterweights: "//obstacle_words(variant))
    end if
  end subroutine append_balanced_notes

  !> Of linkages that are no four-bars: what is balanced, total mass, counterweights.
  pure subroutine append_hung_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant         !! with its balance computed
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which lines are appended

    type(unit_t) :: mass
    integer :: i

    mass = table_unit("mass", variant%model%outputs)
    call append_balanced_notes(variant, notes)
    associate (balance => variant%found%balance)
      call append_string(notes, "G: mass centre of the moving masses, without counterweights")
      call append_string(notes, "total mass: "//to_string(from_si(balance%mass, mass), 12)//" "// &
        mass%name)
      if (allocated(balance%partial)) then
        call append_partial_notes(variant, notes)
        return
      end if
      do i = 1, size(balance%weights)
        call append_counterweight(variant, i, "card, with the link's length for a radius "// &
          "(links on which it hangs bear its mass: with another radius their counterweights "// &
          "change):", notes)
      end do
    end associate
  end subroutine append_hung_notes

  !> Why there are no counterweights.
  pure function obstacle_words(variant) result(words)
    type(variant_results_t), intent(in) :: variant
    character(len=:), allocatable :: words

    associate (obstacle => variant%found%balance%obstacle, mechanism => variant%mechanism)
      select case (obstacle%kind)
      case (obstacle_link)
        words = "no way of pins leads from link "//mechanism%names(obstacle%number)%text// &
          " to the ground, so that none can balance its mass"
      case (obstacle_pin)
        words = "pin "//mechanism%pin_names(obstacle%number)%text//" has a mass and is on no link"
      case (obstacle_ram)
        words = "link "//mechanism%names(obstacle%number)%text//" changes its length"
      case default
        words = "links form a loop of pins; closed forms are for four-bars, and for "// &
          "slider-cranks and all others without such a loop"
      end select
    end associate
  end function obstacle_words

  !> Definition of the quantities, for both tables.
  pure function quantity_notes(variant) result(list)
    type(variant_results_t), intent(in) :: variant
    type(string_t), allocatable :: list(:)

    associate (mechanism => variant%mechanism)
      call append_string(list, "shaking force: sum of the inertia forces -m a; shaking moment: "// &
        "that of these and of all -I alpha, about "//mechanism%pin_names(1)%text// &
        "; torque: of the drive on link "//mechanism%names(1)%text//", with gravity and loads")
    end associate
    if (allocated(variant%found%balance%partial)) then
      call append_string(list, balanced_by_cards(variant))
    else
      call append_string(list, "balanced: with the counterweights of balance.dat, each as far "// &
        "from its ground pivot as its link is long")
    end if
    call append_string(list, acceleration_note(variant%model))
  end function quantity_notes

  !> Appends the row of a position and speed: mass centre, shaking force and moment, force of the
  !! first drive; the last three with counterweights too, if there are any.
  subroutine add_balance(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its joints and balance computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    real(wp) :: values(10)
    integer :: state, count

    state = variant%found%positions%state(position)
    associate (balance => variant%found%balance)
      if (is_unbalanced(variant)) then
        call add_failed_row(rows, [variant%model%shown_speed(speed), &
          variant%found%positions%crank(position)], balance%partial%error%text)
        return
      end if
      count = merge(10, 6, has_balanced(balance))
      values(:2) = balance%centre(:, state)
      values(3:6) = row_quantities(variant, variant%found%joints, position, speed)
      if (count > 6) values(7:) = row_quantities(variant, balance%balanced, position, speed)
      call add_position_row(variant, layout, position, speed, values(:count), rows)
    end associate
  end subroutine add_balance

  !> Shaking force and moment, and force of the first drive [N, N m].
  pure function row_quantities(variant, joints, position, speed) result(quantities)
    type(variant_results_t), intent(in) :: variant
    type(joints_result_t), intent(in) :: joints
    integer, intent(in) :: position, speed !! numbers in the deck's lists
    real(wp) :: quantities(4)

    real(wp) :: factor(3), rates(2)

    associate (state => variant%found%positions%state(position))
      rates = drive_rates(variant%model, speed, position)
      factor = [rates(1)**2, rates(2), 1.0_wp]
      quantities = [factor(1)*joints%shaking(:, 1, state) + factor(2)*joints%shaking(:, 2, &
        state), dot_product(factor, joints%drive(1, :, state))]
      if (size(joints%running_drive, 2) > 0) quantities(4) = quantities(4) + &
        joints%running_drive(1, speed, state)
    end associate
  end function row_quantities

  !> Whether BALANCE cards could not be followed.
  pure function is_unbalanced(variant) result(is)
    type(variant_results_t), intent(in) :: variant !! with its balance computed
    logical :: is

    is = allocated(variant%found%balance%partial)
    if (is) is = allocated(variant%found%balance%partial%error)
  end function is_unbalanced

  !> Meaning of the columns, and the number of samples with the change that halving it makes; or
  !! the reason why the table has no rows.
  pure subroutine harmonics_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its harmonics computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = quantity_notes(variant)
    call append_harmonics_notes(variant, notes)
  end subroutine harmonics_notes

  !> What harmonics are, and how many samples give them; or the reason why the table has no rows.
  pure subroutine append_harmonics_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant         !! with its harmonics computed
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which lines are appended

    type(unit_t) :: force, moment

    force = table_unit("force", variant%model%outputs)
    moment = table_unit("moment", variant%model%outputs)
    associate (found => variant%found%harmonics)
      if (.not. found%has_cycle) then
        call append_string(notes, "no rows: the crank does not turn fully, or comes to a dead "// &
          "point: there is no cycle")
        return
      end if
      if (found%turns == 0) then
        call append_string(notes, "no rows: positions and loads do not repeat with the crank: "// &
          "there is no cycle")
        return
      end if
      if (found%turns == 1) then
        call append_string(notes, "over a whole turn of the crank: largest absolute value, "// &
          "root of the mean square, mean, and mean + sum of h_k cos(k crank + phase_k); "// &
          "speed and acceleration are constant over the turn")
      else
        call append_string(notes, "over a cycle of "//to_string(found%turns)// &
          " turns of the crank: largest absolute value, root of the mean square, mean, and "// &
          "mean + sum of h_k cos(k crank/"//to_string(found%turns)//" + phase_k), so that h"// &
          to_string(found%turns)//" is once a turn; speed and acceleration are constant over "// &
          "the cycle")
      end if
      if (allocated(found%error)) then
        call append_string(notes, "no rows: "//found%error%text//" at "// &
          to_string(found%error_crank, 6)//" deg")
        return
      end if
      call append_string(notes, "forces in "//force%name//", moments and torques in "// &
        moment%name//", phases in deg; a phase is 0 where its h is only round-off")
      call append_string(notes, "samples: "//to_string(found%samples)//"; every second one "// &
        "gives the same to "//to_string(found%change, 2)//" of the largest value")
      if (.not. has_settled(found)) call append_string(notes, "harmonics have not converged: "// &
        "the crank passes close to a dead point, the shaking force through zero, or a load "// &
        "changes steeply")
    end associate
  end subroutine append_harmonics_notes

  !> The words in the columns `linkage` and `quantity`.
  pure function harmonics_words() result(lists)
    type(name_list_t) :: lists(2)

    lists(1)%column = "linkage"
    lists(1)%names = trimmed_list(linkage_names)
    lists(2)%column = "quantity"
    lists(2)%names = trimmed_list(quantity_names)
  end function harmonics_words

  !> Appends one row per linkage (as given, balanced) and quantity, one block per speed. No rows if
  !! the crank cannot make a full turn, or loads do not repeat; a failed row without a place if the
  !! linkage does not close, or has no forces somewhere on the cycle.
  subroutine add_harmonics(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its harmonics computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: unit_value, nowhere(0)
    integer :: i, k, q

    if (.not. variant%found%class%closes) call add_failed_row(rows, nowhere, &
      variant%unreachable)
    if (is_unbalanced(variant)) call add_failed_row(rows, nowhere, &
      variant%found%balance%partial%error%text)
    associate (found => variant%found%harmonics)
      if (.not. found%has_cycle .or. found%turns == 0) return
      if (allocated(found%error)) then
        call add_failed_row(rows, nowhere, found%error%text//" at "//to_string(found%error_crank, &
          6)//" deg")
        return
      end if
    end associate
    do k = 1, size(variant%model%speed%value)
      if (k > 1) call add_gap(rows, 2)
      do i = 1, size(variant%found%harmonics%of, 2)
        do q = 1, quantity_count
          ! The unit depends on the quantity of the row, not on the column.
          unit_value = from_si(1.0_wp, table_factor(trim(merge("moment", "force ", is_moment(q))), &
            variant%model%outputs))
          associate (this => variant%found%harmonics%of(q, i, k))
            call add_row(rows, cells(layout, 1, [variant%model%shown_speed(k)])// &
              name_cell(trim(linkage_names(i)), column_width(layout, 2))// &
              name_cell(trim(quantity_names(q)), column_width(layout, 3))// &
              real_cells([unit_value*[this%largest, this%rms, this%mean, this%amplitude], &
              this%phase]))
          end associate
        end do
      end do
    end do
  end subroutine add_harmonics

  !> There are columns with counterweights, if there are any.
  subroutine plan_hung_balance(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%has_optional = has_balanced(variant%found%balance)
  end subroutine plan_hung_balance

  !> Of linkages that are no four-bars: drives and loads, what is balanced.
  subroutine hung_balance_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its balance computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call drives_notes(variant, notes)
    call append_hung_notes(variant, notes)
  end subroutine hung_balance_notes

  !> Of linkages that are no four-bars: drives and loads, what is balanced, the harmonics.
  subroutine hung_harmonics_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its harmonics computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call drives_notes(variant, notes)
    call append_balanced_notes(variant, notes)
    call append_harmonics_notes(variant, notes)
  end subroutine hung_harmonics_notes

end module balance_report
