! src/reports/words/ - words for heads of tables, failed rows and the log: positions, loads, links.
! In: a `variant_results_t`, or model and mechanism. Out: lines of text, in the units of the deck's
! results. Begin with `append_load_notes` in `load_notes.f90`, which tables of forces have at their
! head. Requests of two studies are made of cards here, too: `balance_requests.f90`,
! `sizing_requests.f90`.
! Not here: plans and processes in words (`src/mechanism`), messages of a run (`src/runs/texts`).

!> Positions of the first drive as tables show them.
module drive_positions
  use coordinate_columns, only: shown_unit
  use kinds, only: wp
  use models, only: nature_of_positions
  use natures, only: nature_t, of_value
  use table_columns, only: table_factor
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: shown_crank, unit_of_drive

contains

  !> A position in the unit of tables: angles in degrees, places of a slider or a ram in the deck's
  !! lengths.
  pure function shown_crank(variant, crank) result(shown)
    type(variant_results_t), intent(in) :: variant !! with its model
    real(wp), intent(in) :: crank                  !! [deg] or [m]
    real(wp) :: shown

    type(nature_t) :: nature

    nature = nature_of_positions(variant%model)
    shown = from_si(crank, table_factor(nature%words(of_value), variant%model%outputs))
  end function shown_crank

  !> The unit of the first drive in tables.
  pure function unit_of_drive(variant) result(unit)
    type(variant_results_t), intent(in) :: variant !! its model
    character(len=:), allocatable :: unit

    type(unit_t) :: measure

    measure = shown_unit(nature_of_positions(variant%model), variant%model%outputs)
    unit = measure%name
  end function unit_of_drive

end module drive_positions
