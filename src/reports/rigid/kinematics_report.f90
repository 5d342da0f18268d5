!> `kinematics.dat`: angle, angular velocity and acceleration of every link, a row each; of a
!! four-bar in one row, with the moving pins and the transmission angle.
module kinematics_report
  use drive_motions, only: drive_rates
  use kinematics_study, only: four_bar_at_speed, link_at_speed
  use linkage_notes, only: angle_note, notes_on_linkage
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use position_rows, only: add_position_row
  use report_kinds, only: four_bars, other_linkages, report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t
  use table_columns, only: table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, same_word, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_kinematics, describe_links

  !> `kinematics.dat` of a four-bar.
  type, extends(state_table_t) :: kinematics_table_t
  contains
    procedure, nopass :: find_notes => kinematics_notes
    procedure, nopass :: add_position => add_kinematics
  end type kinematics_table_t

  !> `kinematics.dat` of other linkages.
  type, extends(state_table_t) :: links_table_t
  contains
    procedure, nopass :: find_notes => links_notes
    procedure, nopass :: add_position => add_links
  end type links_table_t

contains

  !> REPORT kinematics.
  subroutine describe_kinematics(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="kinematics", help="how the links move", &
      pattern="REPORT kinematics [columns=] [format=]", positions=.true., &
      reserved=.true., linkages=four_bars)
    call add_table(report, kinematics_table_t(), "kinematics", "speed:speed crank,theta3,"// &
      "theta4:deg omega3,omega4:rate alpha3,alpha4:rad/s2 Ax,Ay,Bx,By:length "// &
      "transmission_angle:deg")
  end subroutine describe_kinematics

  !> REPORT kinematics of linkages that are no four-bars.
  subroutine describe_links(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="kinematics", help="of other linkages: how the links move", &
      pattern="REPORT kinematics [columns=] [format=]", positions=.true., &
      reserved=.true., linkages=other_linkages)
    call add_table(report, links_table_t(), "kinematics", "speed:speed crank:deg link:name "// &
      "theta:deg omega:rate alpha:rad/s2")
  end subroutine describe_links

  !> Notes on the linkage, the links and pins that the columns refer to, the crank's acceleration.
  pure subroutine kinematics_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with class and transmission angles
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = notes_on_linkage(variant)
    call append_string(notes, angle_note(variant))
    associate (names => variant%mechanism%pin_names, pin => variant%mechanism%four_bar%pin)
      if (names(pin(2))%text /= "A" .or. names(pin(3))%text /= "B") call append_string(notes, &
        "A: pin "//names(pin(2))%text//"; B: pin "//names(pin(3))%text)
    end associate
    call append_string(notes, acceleration_note(variant%model))
  end subroutine kinematics_notes

  !> Appends the row of a position and speed.
  subroutine add_kinematics(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (rates => drive_rates(variant%model, speed, position), &
        positions => variant%found%positions, mechanism => variant%mechanism)
      call add_position_row(variant, layout, position, speed, four_bar_at_speed( &
        mechanism%linkage, mechanism%four_bar, positions%states(positions%state(position)), &
        rates(1), rates(2)), rows)
    end associate
  end subroutine add_kinematics

  !> How the linkage is placed, from where to where the angle of every link is measured, the
  !! acceleration of the first drive.
  pure subroutine links_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: b

    notes = notes_on_linkage(variant)
    do b = 1, size(variant%mechanism%names)
      call append_string(notes, "angle of link "//variant%mechanism%names(b)%text//": "// &
        way_of_angle(variant, b))
    end do
    call append_string(notes, acceleration_note(variant%model))
  end subroutine links_notes

  !> `from A to B`: the pins that the angle of a link is measured from and to.
  pure function way_of_angle(variant, body) result(words)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: body
    character(len=:), allocatable :: words

    character(len=:), allocatable :: from, to
    integer :: i, first, second

    associate (mechanism => variant%mechanism, link => variant%model%links( &
        variant%mechanism%links(body)))
      ! From its ground pivot, else from the pin named first; to the next pin of the card.
      first = 1
      do i = size(link%pins), 1, -1
        if (is_ground_pin(mechanism, link%pins(i)%text)) first = i
      end do
      second = modulo(first, size(link%pins)) + 1
      from = link%pins(first)%text
      to = link%pins(second)%text
    end associate
    words = "from "//from//" to "//to
  end function way_of_angle

  pure function is_ground_pin(mechanism, name) result(is)
    type(mechanism_t), intent(in) :: mechanism
    character(len=*), intent(in) :: name
    logical :: is

    integer :: p

    is = .false.
    do p = 1, size(mechanism%pin_names)
      if (mechanism%linkage%is_ground(p)) is = is .or. same_word(mechanism%pin_names(p)%text, name)
    end do
  end function is_ground_pin

  !> Appends the rows of a position and speed, one per link.
  subroutine add_links(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: b

    associate (positions => variant%found%positions, mechanism => variant%mechanism, &
        rates => drive_rates(variant%model, speed, position))
      associate (state => positions%states(positions%state(position)))
        do b = 1, size(mechanism%names)
          call add_position_row(variant, layout, position, speed, link_at_speed( &
            mechanism%linkage, state, b, rates(1), rates(2)), rows, mechanism%names(b)%text)
        end do
      end associate
    end associate
  end subroutine add_links

end module kinematics_report
