!> `strains.dat`: strains, forces and stresses at the gauges.
module strains_report
  use body_lines, only: place_words
  use kinds, only: wp
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, response_table_t, table_plan_t
  use response_notes, only: append_response_notes
  use table_columns, only: name_list_t, table_layout_t, table_unit
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_strains, plan_gauges, append_gauge_notes

  !> `strains.dat`.
  type, extends(response_table_t) :: strains_table_t
  contains
    procedure, nopass :: find_notes => strains_notes
    procedure, nopass :: plan => plan_gauges
    procedure, nopass :: add_position => add_strains
  end type strains_table_t

contains

  !> REPORT strains.
  subroutine describe_strains(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="strains", help="strains, forces and stresses at gauges", &
      pattern="REPORT strains [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", positions=.true., response=.true.)
    call add_table(report, strains_table_t(), "strains", "speed:speed crank:deg gauge:name "// &
      "axial_strain,bending_strain:- moment:moment axial_force,shear_force:force "// &
      "stress:stress error:-")
  end subroutine describe_strains

  !> Meaning of the columns, place of every gauge, and what all tables of the response say.
  pure subroutine strains_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its response computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_gauge_notes(notes, variant, .true.)
    call append_response_notes(notes, variant)
  end subroutine strains_notes

  !> Meaning of the values of gauges, with or without the shear force, and the place of every gauge.
  pure subroutine append_gauge_notes(notes, variant, shear)
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which they are appended
    type(variant_results_t), intent(in) :: variant         !! with its mechanism
    logical, intent(in) :: shear                           !! the table has shear forces

    character(len=:), allocatable :: force
    integer :: i

    call append_string(notes, "axial_strain: of the axis, stretched positive; bending_strain: "// &
      "of the face of the gauge, positive on the right face where the link turns left along "// &
      "its LINK card")
    force = ""
    if (shear) force = "shear_force: on the part before the gauge by the part beyond, to the "// &
      "left positive; "
    call append_string(notes, "moment: positive where the link turns left; axial_force: "// &
      "tension positive; "//force//"all looking along the LINK card, whatever the side of "// &
      "the gauge")
    call append_string(notes, "stress: largest of the section, E(|axial strain| + |bending "// &
      "strain|) at the fibre farthest from the centroid")
    do i = 1, size(variant%mechanism%gauges)
      call append_string(notes, gauge_words(variant, i))
    end do
  end subroutine append_gauge_notes

  !> `gauge mid: on link coupler, 139.7 mm from A, right`
  pure function gauge_words(variant, number) result(words)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: number
    character(len=:), allocatable :: words

    real(wp) :: place

    associate (model => variant%model, gauge => variant%mechanism%gauges(number))
      associate (link => model%links(variant%mechanism%links(gauge%body)))
        place = gauge%place*link%length
        if (gauge%is_reversed) place = (1.0_wp - gauge%place)*link%length
        if (size(model%gauges) > 0) place = model%gauges(number)%at
        words = "gauge "//gauge%name//": on link "//link%name%text//", "// &
          place_words([place, 0.0_wp], table_unit("length", model%outputs))//" from "// &
          link%pins(1)%text//", "//trim(merge("right", "left ", gauge%side > 0))//" face"
      end associate
    end associate
  end function gauge_words

  !> The names in the column `gauge`.
  pure function gauge_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    integer :: i

    list%column = "gauge"
    allocate (list%names(size(variant%mechanism%gauges)))
    do i = 1, size(list%names)
      list%names(i)%text = variant%mechanism%gauges(i)%name
    end do
  end function gauge_names

  !> Appends the rows of a position and speed, one per gauge.
  subroutine add_strains(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with a response at this speed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (found => variant%found%response%at_speed(speed), &
        gauges => variant%mechanism%gauges)
      do i = 1, size(gauges)
        call add_position_row(variant, layout, position, speed, [found%strain(:, i, position), &
          found%strain_error(i)], rows, gauges(i)%name)
      end do
    end associate
  end subroutine add_strains

  !> A column `gauge`.
  subroutine plan_gauges(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = gauge_names(variant)
  end subroutine plan_gauges

end module strains_report
