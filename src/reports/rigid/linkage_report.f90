!> `linkage.dat`: class, mobility, ranges and special positions of a linkage, on both branches
!! (assembly modes).
module linkage_report
  use kinds, only: wp
  use linkage_notes, only: angle_note
  use limits_study, only: event_names, special_position_t
  use report_kinds, only: four_bars, report_kind_t
  use report_types, only: add_table, report_record_t, whole_table_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string, trimmed_list
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_linkage

  character(len=*), parameter :: branch_names(2) = [character(len=7) :: "open", "crossed"]
  integer, parameter :: digits = 12

  !> `linkage.dat` of a four-bar.
  type, extends(whole_table_t) :: linkage_table_t
  contains
    procedure, nopass :: find_notes => linkage_remarks
    procedure, nopass :: add_all => add_linkage
  end type linkage_table_t

contains

  !> REPORT linkage.
  subroutine describe_linkage(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="linkage", help="class, limits and special positions", &
      pattern="REPORT linkage [format=]", &
      studies="limits", linkages=four_bars)
    call add_table(report, linkage_table_t(), "linkage", "branch,event:name crank,theta3,"// &
      "theta4,transmission_angle:deg", words=linkage_words())
  end subroutine describe_linkage

  !> Class, mobility, ranges, change points, and the meaning of the words in the table.
  pure subroutine linkage_remarks(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its linkage study computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: i, branch

    associate (found => variant%found%branches, &
        names => variant%mechanism%names, link => variant%mechanism%four_bar%body)
      call append_string(notes, variant%found%class%grashof)
      call append_string(notes, "mobility 3(n - 1) - 2j of n = "//to_string(found%links)// &
        " links, ground included, and j pins: "//to_string(found%mobility))
      do branch = 1, size(found%of)
        do i = 1, size(found%of(branch)%ranges)
          associate (range => found%of(branch)%ranges(i))
            call append_string(notes, trim(branch_names(branch))//" branch: "// &
              range_text("link "//names(link(1))%text, range%crank, range%crank_turns)//", "// &
              range_text("link "//names(link(3))%text, range%follower, range%follower_turns))
          end associate
        end do
      end do
      call append_string(notes, change_text(found%change_points))
    end associate
    call append_string(notes, &
      "crank_limit: coupler and follower in line, the crank turns back; "// &
      "follower_limit: crank and coupler in line, the follower turns back; "// &
      "change_point: all links in line, the branches meet")
    call append_string(notes, angle_note(variant))
    if (size(variant%model%measures) > 0) call append_string(notes, "least and greatest values "// &
      "of measures, springs and dampers: REPORT linkage format=linkage")
  end subroutine linkage_remarks

  !> The words in the columns `branch` and `event`.
  pure function linkage_words() result(lists)
    type(name_list_t) :: lists(2)

    lists(1)%column = "branch"
    lists(1)%names = trimmed_list(branch_names)
    lists(2)%column = "event"
    lists(2)%names = trimmed_list(event_names)
  end function linkage_words

  !> Appends one row per special position, by crank angle; one block per branch. A failed row
  !! without a place if the linkage does not close.
  subroutine add_linkage(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its linkage study computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: nowhere(0)
    integer :: i, branch

    if (.not. variant%found%class%closes) then
      call add_failed_row(rows, nowhere, variant%unreachable)
      return
    end if
    do branch = 1, size(branch_names)
      if (branch > 1) call add_gap(rows, 2)
      associate (positions => variant%found%branches%of(branch)%positions)
        do i = 1, size(positions)
          call add_row(rows, name_cell(trim(branch_names(branch)), column_width(layout, 1))// &
            name_cell(trim(event_names(positions(i)%event)), column_width(layout, 2))// &
            cells(layout, 3, [positions(i)%crank, positions(i)%coupler, positions(i)%follower, &
            positions(i)%transmission_angle]))
        end do
      end associate
    end do
  end subroutine add_linkage

  !> `link crank from -30 to 45.5 deg`, or `link follower turns fully`
  pure function range_text(name, range, turns) result(text)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: range(2) !! [deg]
    logical, intent(in) :: turns
    character(len=:), allocatable :: text

    if (turns) then
      text = name//" turns fully"
    else
      text = name//" from "//to_string(range(1), digits)//" to "//to_string(range(2), digits)// &
        " deg"
    end if
  end function range_text

  !> `change points: crank 0, follower 180 deg; …`, or `change points: none`
  pure function change_text(points) result(text)
    type(special_position_t), intent(in) :: points(:)
    character(len=:), allocatable :: text

    integer :: i

    text = "change points: none"
    do i = 1, size(points)
      if (i == 1) text = "change points:"
      if (i > 1) text = text//";"
      text = text//" crank "//to_string(points(i)%crank, digits)//", follower "// &
        to_string(points(i)%follower, digits)//" deg"
    end do
  end function change_text

end module linkage_report
