!> `linkage.dat`: what a linkage can do at all, on both branches.
module linkage_report
  use branch_ranges, only: branch_range_t, find_branch_ranges
  use four_bar_limits, only: grashof_class
  use kinds, only: wp
  use kinematics_report, only: angle_note
  use linkages, only: mobility
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use sorting, only: ascending_order
  use special_positions, only: event_names, find_change_points, find_special_positions, &
    special_position_t
  use tables, only: append_column, append_real_columns, column_t, name_cell, name_column, &
    real_cells, table_t, write_gap, write_header, write_row
  use text, only: append_string, string_t, to_string, trimmed_list
  implicit none (type, external)
  private

  public :: write_linkage

  character(len=*), parameter :: branch_names(2) = [character(len=7) :: "open", "crossed"]
  real(wp), parameter :: sides(2) = [1.0_wp, -1.0_wp]
  integer, parameter :: digits = 12

contains

  !> One row a special position, in the order of crank angles; one block a branch.
  subroutine write_linkage(table, model, mechanism)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism

    type(column_t), allocatable :: columns(:)
    type(special_position_t), allocatable :: positions(:)
    integer, allocatable :: order(:)
    real(wp) :: ground(2, 2), length(3)
    integer :: i, branch

    ground = mechanism%linkage%ground_position(:, [1, 4])
    length = mechanism%linkage%bodies%length
    call append_column(columns, name_column("branch", trimmed_list(branch_names)))
    call append_column(columns, name_column("event", trimmed_list(event_names)))
    call append_real_columns(columns, "crank theta3 theta4 transmission_angle", "deg")
    call write_header(table, model%title, remarks(mechanism, ground, length), columns)
    do branch = 1, size(sides)
      if (branch > 1) call write_gap(table, 2)
      positions = find_special_positions(ground, length, sides(branch))
      order = ascending_order(positions%crank)
      do i = 1, size(order)
        associate (position => positions(order(i)))
          call write_row(table, name_cell(trim(branch_names(branch)), columns(1)%width)// &
            name_cell(trim(event_names(position%event)), columns(2)%width)// &
            real_cells([position%crank, position%coupler, position%follower, &
            position%transmission_angle]))
        end associate
      end do
    end do
  end subroutine write_linkage

  !> Class, mobility, ranges, change points, and what the words of the table mean.
  pure function remarks(mechanism, ground, length) result(list)
    type(mechanism_t), intent(in) :: mechanism
    real(wp), intent(in) :: ground(2, 2), length(3) !! [m]
    type(string_t), allocatable :: list(:)

    type(branch_range_t), allocatable :: ranges(:)
    integer :: i, branch

    call append_string(list, grashof_class(norm2(ground(:, 2) - ground(:, 1)), length))
    call append_string(list, "mobility 3(n - 1) - 2j of n = "// &
      to_string(size(mechanism%linkage%bodies) + 1)//" links, the ground among them, in pins: "// &
      to_string(mobility(mechanism%linkage)))
    do branch = 1, size(sides)
      ranges = find_branch_ranges(ground, length, sides(branch))
      do i = 1, size(ranges)
        call append_string(list, trim(branch_names(branch))//" branch: "// &
          range_text("link "//mechanism%names(1)%text, ranges(i)%crank, ranges(i)%crank_turns)// &
          ", "//range_text("link "//mechanism%names(3)%text, ranges(i)%follower, &
          ranges(i)%follower_turns))
      end do
    end do
    call append_string(list, change_text(find_change_points(ground, length)))
    call append_string(list, &
      "crank_limit: coupler and follower in line, the crank turns back; follower_limit: crank "// &
      "and "// &
      "coupler in line, the follower turns back; change_point: all links in line, the branches "// &
      "meet")
    call append_string(list, angle_note(mechanism))
  end function remarks

  !> `link crank from -30 to 45.5 deg`, `link follower turns fully`
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
