!> `geometry.dat`: pins, links and points at any crank angles, for drawings.
module geometry_report
  use linkage_notes, only: notes_on_linkage
  use points_report, only: point_names
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: geometry_notes, geometry_words, add_geometry

  !> Stands in the column `link` for the fixed pivots.
  character(len=*), parameter :: ground = "(ground)"

contains

  !> Class, limit positions and transmission angles of the linkage, and the order of the rows.
  pure subroutine geometry_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with class and kinematics computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = notes_on_linkage(variant)
    call append_string(notes, &
      "links one after the other, each from pin to pin, then its points; global axes")
  end subroutine geometry_notes

  !> The names in the columns `link`, `part` and `place`.
  pure function geometry_words(variant) result(lists)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: lists(3)

    type(name_list_t) :: points
    integer :: i

    lists(1)%column = "link"
    lists(1)%names = variant%mechanism%names
    call append_string(lists(1)%names, ground)
    lists(2)%column = "part"
    call append_string(lists(2)%names, "pin")
    call append_string(lists(2)%names, "point")
    lists(3)%column = "place"
    lists(3)%names = variant%mechanism%pin_names
    points = point_names(variant)
    do i = 1, size(points%names)
      call append_string(lists(3)%names, points%names(i)%text)
    end do
  end function geometry_words

  !> Appends the rows of a position, or one failed row. One empty line between links and between a
  !! link and its points, two between positions.
  subroutine add_geometry(variant, layout, position, rows)
    type(variant_results_t), intent(in) :: variant !! with its geometry computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the list of REPORT geometry
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: body, pin, point
    logical :: is_first

    if (position > 1) call add_gap(rows, 2)
    associate (found => variant%found%geometry, linkage => variant%mechanism%linkage, &
        points => variant%mechanism%points)
      if (allocated(found%outcome(position)%error)) then
        call add_failed_row(rows, [found%crank(position)], found%outcome(position)%error%text)
        return
      end if
      do pin = 1, size(linkage%is_ground)
        if (linkage%is_ground(pin)) call add_pin(variant, layout, position, 0, pin, rows)
      end do
      do body = 1, size(linkage%bodies)
        call add_gap(rows, 1)
        call add_pin(variant, layout, position, body, linkage%bodies(body)%first_pin, rows)
        call add_pin(variant, layout, position, body, linkage%bodies(body)%last_pin, rows)
        is_first = .true.
        do point = 1, size(points)
          if (points(point)%body /= body) cycle
          if (is_first) call add_gap(rows, 1)
          is_first = .false.
          call add_row(rows, cells(layout, 1, [found%crank(position)])// &
            name_cell(variant%mechanism%names(body)%text, column_width(layout, 2))// &
            name_cell("point", column_width(layout, 3))// &
            name_cell(points(point)%name, column_width(layout, 4))// &
            cells(layout, 5, found%point(:, point, position)))
        end do
      end do
    end associate
  end subroutine add_geometry

  subroutine add_pin(variant, layout, position, body, pin, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: position, body, pin !! numbers; body 0: the ground
    type(rows_t), intent(inout) :: rows

    character(len=:), allocatable :: link

    link = ground
    if (body > 0) link = variant%mechanism%names(body)%text
    call add_row(rows, cells(layout, 1, [variant%found%geometry%crank(position)])// &
      name_cell(link, column_width(layout, 2))//name_cell("pin", column_width(layout, 3))// &
      name_cell(variant%mechanism%pin_names(pin)%text, column_width(layout, 4))// &
      cells(layout, 5, variant%found%geometry%pin(:, pin, position)))
  end subroutine add_pin

end module geometry_report
