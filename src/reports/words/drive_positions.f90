!> Positions of the first drive as tables show them.
module drive_positions
  use kinds, only: wp
  use models, only: drives_length
  use table_columns, only: table_factor, table_unit
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

    shown = crank
    if (drives_length(variant%model)) shown = from_si(crank, table_factor("length", &
      variant%model%outputs))
  end function shown_crank

  !> The unit of the first drive in tables.
  pure function unit_of_drive(variant) result(unit)
    type(variant_results_t), intent(in) :: variant !! its model
    character(len=:), allocatable :: unit

    type(unit_t) :: length

    unit = "deg"
    if (.not. drives_length(variant%model)) return
    length = table_unit("length", variant%model%outputs)
    unit = length%name
  end function unit_of_drive

end module drive_positions
