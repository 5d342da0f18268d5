!> What a run has done, in a line or two, for standard output.
module success_text
  use figures_command, only: shell_word
  use kinds, only: long, wp
  use output_units, only: output_units_t
  use run_totals, only: is_empty, run_totals_t, value_range_t
  use text, only: plural, to_string
  use units, only: coherent_unit, dimension_length, from_si, unit_t
  implicit none (type, external)
  private

  public :: text_of_success

  !> Longest line that is not broken [characters].
  integer, parameter :: longest_line = 120

  integer, parameter :: digits = 4 !! of frequencies and torques

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> `my: 3 tables in outputs/my; f1 23.4 to 31.8 Hz, f3 up to 96.2 Hz, estimated relative error at
  !! most 2e-11; figures: flexmech-plot outputs/my`. Before it a line for results that mean nothing.
  pure function text_of_success(name, folder, tables, failed_rows, totals, modes, units, warning, &
    command) result(text)
    character(len=*), intent(in) :: name       !! of the deck
    character(len=*), intent(in) :: folder     !! with the outputs
    integer, intent(in) :: tables              !! number
    integer(long), intent(in) :: failed_rows   !! of all tables
    type(run_totals_t), intent(in) :: totals   !! of all variants
    integer, intent(in) :: modes               !! number
    type(output_units_t), intent(in) :: units  !! of the deck's results
    character(len=*), intent(in) :: warning    !! why the results mean nothing; empty: they do
    character(len=*), intent(in) :: command    !! that draws figures; empty: not known
    character(len=:), allocatable :: text

    character(len=:), allocatable :: line, figures

    line = name//": "//plural(tables, "table")
    if (totals%variants > 1) line = line//" of "//to_string(totals%variants)//" variants"
    line = line//" in "//folder
    if (failed_rows > 0) line = line//", "//to_string(failed_rows)//" failed row"// &
      trim(merge("s", " ", failed_rows > 1))
    if (.not. is_empty(totals%lowest)) then
      line = line//"; f1 "//range_text(totals%lowest, "Hz")
      if (modes > 1) line = line//", f"//to_string(modes)//" up to "// &
        to_string(totals%highest%most, digits)//" Hz"
      line = line//", estimated relative error at most "//to_string(totals%largest_error, 2)
    else if (.not. is_empty(totals%torque)) then
      line = line//"; driving torque "//torque_text(totals%torque, units%moment)
    end if
    line = line//response_words(totals, coherent_unit(units%system, dimension_length))
    if (len(command) > 0) then
      figures = "figures: "//command//" "//shell_word(folder)
      if (len(line) + len(figures) + 2 <= longest_line) then
        line = line//"; "//figures
      else
        line = line//line_feed//name//": "//figures
      end if
    end if
    text = ""
    if (len(warning) > 0) text = name//": WARNING: "//warning//line_feed
    text = text//line//line_feed
  end function text_of_success

  !> `23.4 to 31.8 Hz`, or `23.4 Hz` if these are the same.
  pure function range_text(range, unit) result(text)
    type(value_range_t), intent(in) :: range !! not empty
    character(len=*), intent(in) :: unit     !! of its values
    character(len=:), allocatable :: text

    text = to_string(range%least, digits)
    if (to_string(range%most, digits) /= text) text = text//" to "//to_string(range%most, digits)
    text = text//" "//unit
  end function range_text

  !> `; largest strain 0.000721, displacement 4.99 mm`, as far as these are known.
  pure function response_words(totals, length) result(text)
    type(run_totals_t), intent(in) :: totals
    type(unit_t), intent(in) :: length
    character(len=:), allocatable :: text

    text = ""
    if (totals%strain >= 0.0_wp) text = ", strain "//to_string(totals%strain, digits)
    if (totals%displacement >= 0.0_wp) text = text//", displacement "// &
      to_string(from_si(totals%displacement, length), digits)//" "//length%name
    if (len(text) > 0) text = "; largest"//text(2:)
  end function response_words

  pure function torque_text(torque, unit) result(text)
    type(value_range_t), intent(in) :: torque !! [N m]
    type(unit_t), intent(in) :: unit    !! of moments
    character(len=:), allocatable :: text

    text = range_text(value_range_t(from_si(torque%least, unit), from_si(torque%most, unit)), &
      unit%name)
  end function torque_text

end module success_text
