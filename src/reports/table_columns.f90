!> Columns of a report's table in the units of the deck, and the cells in them.
module table_columns
  use kinds, only: wp
  use natures, only: angle_nature, length_nature
  use number_text, only: number_width
  use output_units, only: output_units_t, power_factor, power_unit, stiffness_unit, &
    stress_factor, stress_unit
  use report_kinds, only: column_kind_t, columns_of, key_count, table_kind_t
  use tables, only: append_column, column_t, digits_of_place, integer_column, name_column, &
    real_cells, real_column
  use text, only: same_word, string_t, to_string
  use units, only: coherent_factor, coherent_unit, dimension_acceleration, dimension_inertia, &
    dimension_length, dimension_mass, dimension_none, dimension_time, dimension_velocity, from_si, &
    unit_t
  implicit none (type, external)
  private

  public :: table_layout_t, name_list_t, new_table_layout, add_quantity_column, choose_columns, &
    header_columns, find_chosen_cells, cells, in_column, column_width, table_unit, table_factor

  !> The columns of one table, with the units to which numbers in SI are converted.
  type :: table_layout_t
    type(column_t), allocatable :: columns(:)
    type(unit_t), allocatable, private :: measures(:) !! (columns)
    integer, allocatable, private :: chosen(:)        !! numbers of the columns that the table has,
                                                      !! in its order; not allocated: all
  end type table_layout_t

  !> The names that may occur in a column.
  type :: name_list_t
    character(len=:), allocatable :: column !! name of the column
    type(string_t), allocatable :: names(:)
  end type name_list_t

contains

  !> The columns of a table in the units of a deck.
  pure subroutine new_table_layout(table, outputs, count, optional, names, layout)
    type(table_kind_t), intent(in) :: table     !! as the table of reports lists it
    type(output_units_t), intent(in) :: outputs !! units of the deck's results
    integer, intent(in) :: count                !! columns that a numbered one stands for
    logical, intent(in) :: optional             !! whether the table has its optional columns
    type(name_list_t), intent(in) :: names(:)   !! of the columns of names
    type(table_layout_t), intent(out) :: layout !! of the table

    type(column_kind_t), allocatable :: kinds(:)
    type(unit_t) :: measure
    integer :: i, j, filled, total

    call columns_of(table, kinds)
    total = 0
    do i = 1, size(kinds)
      total = total + columns_for(kinds(i), count, optional)
    end do
    allocate (layout%measures(total))
    filled = 0
    do i = 1, size(kinds)
      associate (kind => kinds(i))
        measure = table_unit(kind%unit, outputs)
        do j = 1, columns_for(kind, count, optional)
          filled = filled + 1
          layout%measures(filled) = measure
          if (kind%unit == "#") then
            call append_column(layout%columns, integer_column(kind%name))
          else if (kind%unit == "name") then
            call append_column(layout%columns, name_column(kind%name, names_for(kind%name, names)))
          else if (kind%is_numbered) then
            call append_column(layout%columns, real_column(kind%name//to_string(j), measure%name))
          else
            call append_column(layout%columns, real_column(kind%name, measure%name))
          end if
        end do
      end associate
      if (i > key_count(kinds) .or. filled == 0) cycle
      associate (column => layout%columns(filled))
        if (column%least_digits > 0) column%least_digits = digits_of_place
      end associate
    end do
  end subroutine new_table_layout

  !> Appends a column of real numbers.
  pure subroutine add_quantity_column(layout, name, unit, outputs)
    type(table_layout_t), intent(inout) :: layout !! of the table
    character(len=*), intent(in) :: name          !! of the column
    character(len=*), intent(in) :: unit          !! as in the table of reports
    type(output_units_t), intent(in) :: outputs   !! units of the deck's results

    type(unit_t), allocatable :: wider(:)
    integer :: n

    n = size(layout%measures)
    allocate (wider(n + 1))
    wider(:n) = layout%measures
    wider(n + 1) = table_unit(unit, outputs)
    call append_column(layout%columns, real_column(name, wider(n + 1)%name))
    call move_alloc(wider, layout%measures)
  end subroutine add_quantity_column

  !> Leaves the table the columns that say what a row is about, and some of the others, in the order
  !! in which they are named.
  pure subroutine choose_columns(layout, keys, names)
    type(table_layout_t), intent(inout) :: layout !! of the table
    integer, intent(in) :: keys                   !! number of its first columns, which stay
    type(string_t), intent(in) :: names(:)        !! in any case of letters; without others than
                                                  !! those of columns

    integer :: i, k

    layout%chosen = [(k, k=1, keys)]
    do i = 1, size(names)
      do k = keys + 1, size(layout%columns)
        if (same_word(layout%columns(k)%name, names(i)%text)) layout%chosen = [layout%chosen, k]
      end do
    end do
  end subroutine choose_columns

  !> The columns that the table has.
  pure subroutine header_columns(layout, columns)
    type(table_layout_t), intent(in) :: layout               !! of the table
    type(column_t), allocatable, intent(out) :: columns(:)   !! in its order

    integer :: i

    if (.not. allocated(layout%chosen)) then
      columns = layout%columns
      return
    end if
    do i = 1, size(layout%chosen)
      call append_column(columns, layout%columns(layout%chosen(i)))
    end do
  end subroutine header_columns

  !> Where the cells of the chosen columns are in a row of all. Without a choice none are given.
  pure subroutine find_chosen_cells(layout, first, last)
    type(table_layout_t), intent(in) :: layout       !! of the table
    integer, allocatable, intent(out) :: first(:)    !! (columns of the table) characters; not
                                                     !! allocated: the table has all
    integer, allocatable, intent(out) :: last(:)     !! likewise

    integer :: begins(size(layout%columns) + 1), i

    if (.not. allocated(layout%chosen)) return
    begins(1) = 1
    do i = 1, size(layout%columns)
      begins(i + 1) = begins(i) + layout%columns(i)%width
    end do
    first = begins(layout%chosen)
    last = begins(layout%chosen + 1) - 1
  end subroutine find_chosen_cells

  !> Number of columns that an entry of the list stands for.
  pure function columns_for(kind, count, optional) result(number)
    type(column_kind_t), intent(in) :: kind
    integer, intent(in) :: count
    logical, intent(in) :: optional
    integer :: number

    number = 1
    if (kind%is_numbered) number = count
    if (kind%is_optional .and. .not. optional) number = 0
  end function columns_for

  !> The names of a column, from the lists of several columns; none if no list is of this column.
  pure function names_for(column, names) result(list)
    character(len=*), intent(in) :: column
    type(name_list_t), intent(in) :: names(:)
    type(string_t), allocatable :: list(:)

    integer :: i

    allocate (list(0))
    do i = 1, size(names)
      if (names(i)%column == column) list = names(i)%names
    end do
  end function names_for

  !> Unit of a column. A quantity (`length`) has the unit of the deck's results. Other columns are
  !! not converted: shapes, in units made of the deck's; columns with a unit for a word (`deg`);
  !! speeds, which stand as in the deck.
  pure function table_unit(word, outputs) result(measure)
    character(len=*), intent(in) :: word        !! from the table of reports
    type(output_units_t), intent(in) :: outputs !! units of the deck's results
    type(unit_t) :: measure

    type(unit_t) :: mass, length

    mass = coherent_unit(outputs%system, dimension_mass)
    length = coherent_unit(outputs%system, dimension_length)
    select case (word)
    case ("mass^-1/2")
      measure%name = mass%name//"^-0.5"
    case ("rotation")
      measure%name = "rad."//mass%name//"^-0.5."//length%name//"^-1"
    case ("speed")
      measure%name = outputs%rate%name
    case ("rate")
      measure = outputs%rate
    case ("force")
      measure = outputs%force
    case ("moment")
      measure = outputs%moment
    case ("energy")
      measure = outputs%energy
    case ("stress")
      measure = stress_unit(outputs)
    case ("line_stiffness", "turning_stiffness")
      measure = stiffness_unit(outputs, merge(angle_nature, length_nature, &
        word == "turning_stiffness"))
    case ("power")
      measure = power_unit(outputs)
    case default
      if (is_quantity(word)) then
        measure = coherent_unit(outputs%system, dimension_of(word))
      else
        measure%name = word
      end if
    end select
  end function table_unit

  !> Unit of a quantity without its name. It makes no text, so that threads may call it at the same
  !! time.
  pure function table_factor(quantity, outputs) result(measure)
    character(len=*), intent(in) :: quantity    !! `length`, `force`, …
    type(output_units_t), intent(in) :: outputs !! units of the deck's results
    type(unit_t) :: measure

    select case (quantity)
    case ("force")
      call take_factor(outputs%force, measure)
    case ("moment")
      call take_factor(outputs%moment, measure)
    case ("rate")
      call take_factor(outputs%rate, measure)
    case ("stress")
      measure = stress_factor(outputs)
    case ("power")
      measure = power_factor(outputs)
    case default
      measure = coherent_factor(outputs%system, dimension_of(quantity))
    end select
  end function table_factor

  pure subroutine take_factor(named, measure)
    type(unit_t), intent(in) :: named
    type(unit_t), intent(inout) :: measure !! gets all but the name

    measure%dimension = named%dimension
    measure%numerator = named%numerator
    measure%denominator = named%denominator
  end subroutine take_factor

  pure function is_quantity(word) result(is)
    character(len=*), intent(in) :: word
    logical :: is

    is = any(dimension_of(word) /= dimension_none)
  end function is_quantity

  !> The dimension of a quantity in the deck's UNITS; `dimension_none` for other words.
  pure function dimension_of(word) result(dimension)
    character(len=*), intent(in) :: word
    integer :: dimension(4)

    select case (word)
    case ("length")
      dimension = dimension_length
    case ("mass")
      dimension = dimension_mass
    case ("time")
      dimension = dimension_time
    case ("velocity")
      dimension = dimension_velocity
    case ("acceleration")
      dimension = dimension_acceleration
    case ("inertia")
      dimension = dimension_inertia
    case ("mass_per_length")
      dimension = dimension_mass - dimension_length
    case ("first_moment")
      dimension = dimension_mass + dimension_length
    case default
      dimension = dimension_none
    end select
  end function dimension_of

  !> The cells of neighbouring columns; blank where the table does not have the column.
  function cells(layout, first, values) result(text)
    type(table_layout_t), intent(in) :: layout !! of the table
    integer, intent(in) :: first               !! number of the first column
    real(wp), intent(in) :: values(:)          !! quantities in SI, others in their column's unit
    character(len=number_width*size(values)) :: text

    real(wp) :: converted(size(values))
    integer :: i

    do i = 1, size(values)
      converted(i) = in_column(layout, first + i - 1, values(i))
    end do
    if (.not. allocated(layout%chosen)) then
      text = real_cells(converted)
      return
    end if
    ! Digits take time.
    text = ""
    do i = 1, size(values)
      if (any(layout%chosen == first + i - 1)) text(number_width*(i - 1) + 1:number_width*i) = &
        real_cells(converted(i:i))
    end do
  end function cells

  !> A value in the unit of its column.
  pure function in_column(layout, column, value) result(shown)
    type(table_layout_t), intent(in) :: layout !! of the table
    integer, intent(in) :: column              !! number, from 1
    real(wp), intent(in) :: value              !! a quantity in SI, any other in its column's unit
    real(wp) :: shown

    shown = from_si(value, layout%measures(column))
  end function in_column

  !> Width of a column in characters.
  pure function column_width(layout, column) result(width)
    type(table_layout_t), intent(in) :: layout !! of the table
    integer, intent(in) :: column              !! number, from 1
    integer :: width

    width = layout%columns(column)%width
  end function column_width

end module table_columns
