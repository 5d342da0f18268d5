!> The quantities of REPORT summary: what each is, and the report that has it at every position.
!!
!! A new one is a record here, and a case of `find_value` in `summary_values`.
module summary_quantities
  use numbers, only: read_integer
  use errors, only: error_t
  use text, only: append_string, lower_case, string_t, to_string
  implicit none (type, external)
  private

  public :: quantity_kind_t, quantity_t, quantity_kinds, find_quantity, quantity_names, &
    quantity_name, column_names, is_summary_column

  type :: quantity_kind_t
    character(len=20) :: name = ""       !! `*` at its end stands for the number of a mode; `:`
                                         !! stands before the name of a coordinate
    character(len=8) :: unit = ""        !! of its values, as in the table of reports
    character(len=12) :: report = ""     !! with its values at every position
    logical :: of_four_bars = .false.    !! no other linkage has it
    logical :: has_error = .false.       !! its errors are estimated
    character(len=80) :: meaning = ""    !! for the head of the table
  end type quantity_kind_t

  !> A quantity that a card asks for.
  type :: quantity_t
    integer :: kind = 0 !! number among `quantity_kinds`; 0: none
    integer :: mode = 0 !! of those with a number; of a coordinate its number, once it is looked up
    character(len=64) :: of = "" !! name of the coordinate
  end type quantity_t

  type(quantity_kind_t), parameter :: quantity_kinds(*) = [ &
    quantity_kind_t("f*", "Hz", "frequencies", .false., .true., "natural frequency"), &
    quantity_kind_t("zeta*", "-", "frequencies", .false., .true., "damping ratio"), &
    quantity_kind_t("torque", "moment", "drives", .false., .false., &
    "torque or force of the first drive, of rigid links"), &
    quantity_kind_t("shaking_force", "force", "drives", .false., .false., &
    "size of the resultant of -m a of all masses"), &
    quantity_kind_t("shaking_moment", "moment", "drives", .false., .false., &
    "moment of these and of -I alpha of all links"), &
    quantity_kind_t("frame_force", "force", "frame", .false., .false., &
    "size of the resultant of all forces on the frame"), &
    quantity_kind_t("bearing_force", "force", "bearings", .false., .false., &
    "the greatest magnitude of the forces in all joints"), &
    quantity_kind_t("transmission_angle", "deg", "kinematics", .true., .false., &
    "between coupler and follower"), &
    quantity_kind_t("strain", "-", "strains", .false., .true., &
    "the greatest |axial_strain + bending_strain| of all gauges"), &
    quantity_kind_t("stress", "stress", "strains", .false., .true., &
    "the greatest stress of all gauges"), &
    quantity_kind_t("displacement", "length", "response", .false., .true., &
    "the greatest distance of all pins and points from where rigid links hold them"), &
    quantity_kind_t("elastic_torque", "moment", "torque", .false., .true., &
    "total torque of the drive of the elastic linkage"), &
    quantity_kind_t("value:", "length", "coordinates", .false., .false., &
    "length, place or angle of the coordinate"), &
    quantity_kind_t("rate:", "velocity", "coordinates", .false., .false., "how fast it changes"), &
    quantity_kind_t("effort:", "force", "coordinates", .false., .false., &
    "force or moment of its spring, damper or drive"), &
    quantity_kind_t("power:", "power", "coordinates", .false., .false., "of this effort"), &
    quantity_kind_t("ratio:", "-", "coordinates", .false., .false., &
    "change of the coordinate per change of that of ratio_to=")]

  !> What a table has of every quantity. Where a value is stands behind the least and the greatest.
  character(len=*), parameter :: values_of(4) = [character(len=8) :: "least", "mean", "greatest", &
    "error"]

contains

  !> The quantity of a name in any case of letters; of kind 0 if there is none. Whether there is the
  !! coordinate of `value:NAME` is not looked up.
  pure function find_quantity(word) result(quantity)
    character(len=*), intent(in) :: word !! `torque`, `f3`, `value:NAME`
    type(quantity_t) :: quantity

    type(error_t), allocatable :: error
    character(len=:), allocatable :: name
    integer :: i, last, mode

    last = index(word, ":")
    if (last > 0) then
      if (len(word) == last .or. len(word) > last + len(quantity%of)) return
      do i = 1, size(quantity_kinds)
        if (quantity_kinds(i)%name == lower_case(word(:last))) quantity = quantity_t(i, 0, &
          word(last + 1:))
      end do
      return
    end if
    name = lower_case(word)
    do i = 1, size(quantity_kinds)
      if (quantity_kinds(i)%name == name) quantity = quantity_t(i, 0)
      last = len_trim(quantity_kinds(i)%name) - 1
      if (.not. is_numbered(quantity_kinds(i)) .or. len(name) <= last) cycle
      if (name(:last) /= quantity_kinds(i)%name(:last)) cycle
      ! At most 999, and no 0 before it: a number is written in one way.
      if (verify(name(last + 1:), "0123456789") > 0 .or. name(last + 1:last + 1) == "0" .or. &
        len(name) > last + 3) cycle
      call read_integer(name(last + 1:), mode, error)
      if (.not. allocated(error)) quantity = quantity_t(i, mode)
    end do
    if (quantity%kind == 0) return
    if (is_numbered(quantity_kinds(quantity%kind)) .and. quantity%mode == 0) &
      quantity = quantity_t()
  end function find_quantity

  pure function is_numbered(kind) result(is)
    type(quantity_kind_t), intent(in) :: kind
    logical :: is

    is = index(kind%name, "*") > 0
  end function is_numbered

  !> The names of all quantities, of numbered ones the first.
  pure function quantity_names() result(names)
    type(string_t), allocatable :: names(:)

    integer :: i

    allocate (names(0))
    do i = 1, size(quantity_kinds)
      call append_string(names, quantity_name(quantity_t(i, 1, "NAME")))
    end do
  end function quantity_names

  !> `torque`, `f3`, `value:NAME`
  pure function quantity_name(quantity) result(name)
    type(quantity_t), intent(in) :: quantity !! that exists
    character(len=:), allocatable :: name

    name = trim(quantity_kinds(quantity%kind)%name)
    if (is_numbered(quantity_kinds(quantity%kind))) name = name(:len(name) - 1)// &
      to_string(quantity%mode)
    if (name(len(name):) == ":") name = name//trim(quantity%of)
  end function quantity_name

  !> The columns of a quantity: `torque_least`, its place (`torque_least_crank`), `torque_mean`,
  !! `torque_greatest`, its place, and `…_error` of those with estimated errors.
  pure function column_names(quantity, places) result(names)
    type(quantity_t), intent(in) :: quantity !! that exists
    type(string_t), intent(in) :: places(:)  !! (places) the columns that say where a row is
    type(string_t), allocatable :: names(:)

    character(len=:), allocatable :: name, column
    integer :: i, k

    name = quantity_name(quantity)
    i = index(name, ":")
    if (i > 0) name(i:i) = "_"
    allocate (names(0))
    do i = 1, size(values_of)
      if (values_of(i) == "error" .and. .not. quantity_kinds(quantity%kind)%has_error) cycle
      column = name//"_"//trim(values_of(i))
      call append_string(names, column)
      if (values_of(i) /= "least" .and. values_of(i) /= "greatest") cycle
      do k = 1, size(places)
        call append_string(names, column//"_"//places(k)%text)
      end do
    end do
  end function column_names

  !> Whether a name may be that of a column of a quantity.
  pure function is_summary_column(name) result(is)
    character(len=*), intent(in) :: name !! case counts
    logical :: is

    type(quantity_t) :: quantity
    integer :: i, at

    is = .false.
    do i = 1, size(values_of)
      at = index(name, "_"//trim(values_of(i)), back=.true.)
      if (at < 2) cycle
      if (name(:at - 1) /= lower_case(name(:at - 1))) cycle
      quantity = find_quantity(name(:at - 1))
      if (quantity%kind == 0) cycle
      associate (rest => name(at + len_trim(values_of(i)) + 1:))
        is = is .or. any(rest == [character(len=6) :: "", "_time", "_speed", "_crank"])
      end associate
    end do
  end function is_summary_column

end module summary_quantities
