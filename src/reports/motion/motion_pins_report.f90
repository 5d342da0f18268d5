! src/reports/motion/ - tables of REPORT motion, the forward dynamics of a linkage.
! In: the `motion_result_t` of a variant. Out: rows at every instant: drives, energies, pins, forces
! in joints. Begin with `describe_motion` in `motion_report.f90`; here is what its tables share:
! time, and the row of an early end.
! Not here: the motion (`src/studies/motion/motion_study.f90`), elastic motions in time
! (`src/reports/elastic`).

!> `motion_pins.dat`: where the pins are while the linkage moves under its motor and loads.
module motion_pins_report
  use kinds, only: wp
  use pins_report, only: plan_pins
  use models, only: model_t, report_number
  use report_types, only: whole_table_t
  use table_columns, only: cells, column_width, table_factor, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell, real_cells
  use text, only: append_string, string_t
  use units, only: from_si
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: motion_pins_table_t, time_in_table, add_early_end

  !> `motion_pins.dat`.
  type, extends(whole_table_t) :: motion_pins_table_t
  contains
    procedure, nopass :: find_notes => motion_pins_notes
    procedure, nopass :: plan => plan_pins
    procedure, nopass :: add_all => add_motion_pins
  end type motion_pins_table_t

contains

  !> The axes.
  pure subroutine motion_pins_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    if (size(variant%mechanism%pin_names) > 0) call append_string(notes, "global axes; "// &
      "instants of motion.dat")
  end subroutine motion_pins_notes

  !> Appends, for every instant, a row per moving pin, and a failed row if the motion ends before
  !! its end time.
  subroutine add_motion_pins(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion and the pins of it
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (motion => variant%found%motion)
      do i = 1, motion%count
        call add_instant(i, motion%samples(i)%pin)
      end do
    end associate
    call add_early_end(variant, rows)

  contains

    subroutine add_instant(instant, pin)
      integer, intent(in) :: instant !! number
      real(wp), intent(in) :: pin(:, :)

      integer :: p

      associate (mechanism => variant%mechanism)
        do p = 1, size(mechanism%pin_names)
          if (mechanism%linkage%is_ground(p)) cycle
          call add_row(rows, real_cells([time_in_table(variant%model, instant)])//name_cell( &
            mechanism%pin_names(p)%text, column_width(layout, 2))//cells(layout, 3, pin(:, p)))
        end do
      end associate
    end subroutine add_instant

  end subroutine add_motion_pins

  !> Appends a failed row if a motion ends before its end time.
  subroutine add_early_end(variant, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion
    type(rows_t), intent(inout) :: rows            !! of a table whose first column is the time

    associate (motion => variant%found%motion)
      if (allocated(motion%error)) call add_failed_row(rows, [from_si(motion%last%time, &
        table_factor("time", variant%model%outputs))], motion%error%text)
    end associate
  end subroutine add_early_end

  !> Time of an instant in the unit of the table: the number that the deck has or would have.
  pure function time_in_table(model, number) result(time)
    type(model_t), intent(in) :: model !! with REPORT motion
    integer, intent(in) :: number !! of the instant, from 1
    real(wp) :: time

    associate (instants => model%reports(report_number(model, "motion"))%instants)
      time = from_si(instants%value(number), table_factor("time", model%outputs))
      if (instants%unit%name == model%units%time%name) time = instants%written(number)
    end associate
  end function time_in_table

end module motion_pins_report
