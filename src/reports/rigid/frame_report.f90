!> `frame.dat`: what shakes the frame, and all that it bears.
module frame_report
  use drive_motions, only: drive_rates
  use joint_study, only: frame_at_speed
  use joints_report, only: reference_words
  use kinds, only: wp
  use load_notes, only: acceleration_note, append_load_notes
  use models, only: report_number
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t
  use table_columns, only: table_layout_t, table_unit
  use table_rows, only: rows_t
  use text, only: append_string, same_word, string_t, to_string
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_frame

  !> `frame.dat`.
  type, extends(state_table_t) :: frame_table_t
  contains
    procedure, nopass :: find_notes => frame_notes
    procedure, nopass :: add_position => add_frame
  end type frame_table_t

contains

  !> REPORT frame.
  subroutine describe_frame(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="frame", help="shaking force, and force and moment on "// &
      "the frame", pattern="REPORT frame [about=x,y|pin] [columns=]", studies="joints", &
      positions=.true., masses=.true., numbers=82)
    call add_table(report, frame_table_t(), "frame", "speed:speed crank:deg shaking_x,"// &
      "shaking_y:force shaking_moment:moment frame_x,frame_y:force frame_moment:moment")
  end subroutine describe_frame

  !> Whose definitions these are, about which point moments are, loads.
  pure subroutine frame_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "shaking: resultant of the inertia forces -m a of all masses, "// &
      "and moment of these and of -I alpha of all links (shaking force and moment of Berkof "// &
      "and Lowen); weights and external loads are not included")
    call append_string(notes, "frame: resultant of all forces of the linkage on the frame, at "// &
      "ground pivots, guides and drives, with weights and external loads (shaking force of "// &
      "Norton, -(F12 + F14) of a four-bar), and their moment with the reaction of the drives")
    call append_string(notes, "moments about "//point_words(variant)//", counter-clockwise "// &
      "positive; forces in global axes")
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine frame_notes

  !> `pin O2`, `the point 100 50 mm`
  pure function point_words(variant) result(words)
    type(variant_results_t), intent(in) :: variant
    character(len=:), allocatable :: words

    type(unit_t) :: length

    length = table_unit("length", variant%model%outputs)
    associate (report => variant%model%reports(report_number(variant%model, "frame")))
      if (report%about_pin%line > 0) then
        words = "pin "//report%about_pin%text
      else if (report%has_about) then
        words = "the point "//to_string(from_si(report%about(1), length), 12)//" "// &
          to_string(from_si(report%about(2), length), 12)//" "//length%name
      else
        words = reference_words(variant)
      end if
    end associate
  end function point_words

  !> The point about which the card wants the moments.
  pure subroutine find_point(variant, point)
    type(variant_results_t), intent(in) :: variant
    real(wp), allocatable, intent(out) :: point(:) !! in global axes [m]; not allocated: the card
                                                   !! has none

    integer :: i

    associate (report => variant%model%reports(report_number(variant%model, "frame")), &
        grounds => variant%model%grounds)
      if (report%has_about) point = report%about
      if (report%about_pin%line == 0) return
      do i = 1, size(grounds)
        if (same_word(grounds(i)%pin%text, report%about_pin%text)) point = grounds(i)%position
      end do
    end associate
  end subroutine find_point

  !> Appends the row of a position and speed.
  subroutine add_frame(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its joints computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    real(wp), allocatable :: point(:)

    call find_point(variant, point)
    associate (rates => drive_rates(variant%model, speed, position), &
        state => variant%found%positions%state(position))
      ! A point that is not allocated is an argument that is absent.
      call add_position_row(variant, layout, position, speed, frame_at_speed( &
        variant%mechanism%linkage, variant%found%joints, state, rates(1), rates(2), speed, point), &
        rows)
    end associate
  end subroutine add_frame

end module frame_report
