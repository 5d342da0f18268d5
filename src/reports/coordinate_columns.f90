!> Columns of coordinates and drives in their own units, if these are all the same; else each row
!! has those of its coordinate, which stand in the head.
module coordinate_columns
  use kinds, only: wp
  use natures, only: angle_nature, are_alike, nature_t, of_value
  use output_units, only: output_units_t
  use table_columns, only: table_factor, table_unit
  use text, only: joined, string_t, word_list
  use units, only: from_si, unit_t
  implicit none (type, external)
  private

  public :: columns_in, shown_values, shown_unit, unit_names

contains

  !> `position:deg rate:rate`, or `position,rate:see_head`.
  pure function columns_in(natures, names, of) result(columns)
    type(nature_t), intent(in) :: natures(:) !! of all that have rows
    character(len=*), intent(in) :: names    !! of the columns
    integer, intent(in) :: of(:)             !! (columns) of the places in `words`
    character(len=:), allocatable :: columns

    type(string_t), allocatable :: list(:)
    type(nature_t) :: nature
    integer :: i

    list = word_list(names)
    if (.not. are_alike(natures)) then
      columns = joined(list, ",")//":see_head"
      return
    end if
    nature = angle_nature
    if (size(natures) > 0) nature = natures(1)
    do i = 1, size(list)
      list(i)%text = list(i)%text//":"//trim(nature%words(of(i)))
    end do
    columns = joined(list, " ")
  end function columns_in

  !> Values in the units that stand in the head.
  pure function shown_values(values, words, outputs) result(shown)
    real(wp), intent(in) :: values(:)           !! in SI, angles in degrees
    character(len=*), intent(in) :: words(:)    !! (values) of a nature
    type(output_units_t), intent(in) :: outputs !! units of the deck's results
    real(wp) :: shown(size(values))

    integer :: i

    do i = 1, size(values)
      shown(i) = from_si(values(i), table_factor(words(i), outputs))
    end do
  end function shown_values

  !> The unit of a value, which in SI and degrees is converted to it.
  pure function shown_unit(nature, outputs) result(measure)
    type(nature_t), intent(in) :: nature
    type(output_units_t), intent(in) :: outputs !! units of the deck's results
    type(unit_t) :: measure

    measure = table_unit(trim(nature%words(of_value)), outputs)
  end function shown_unit

  !> `mm, mm/s, N`
  pure function unit_names(words, outputs, between) result(names)
    character(len=*), intent(in) :: words(:)          !! of a nature
    type(output_units_t), intent(in) :: outputs       !! units of the deck's results
    character(len=*), intent(in), optional :: between !! absent: a comma
    character(len=:), allocatable :: names

    type(string_t) :: list(size(words))
    type(unit_t) :: measure
    integer :: i

    do i = 1, size(words)
      measure = table_unit(trim(words(i)), outputs)
      list(i)%text = measure%name
    end do
    names = joined(list, between)
  end function unit_names

end module coordinate_columns
