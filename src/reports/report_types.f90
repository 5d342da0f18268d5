! src/reports/ - from results to rows: what a report is, the list of reports, columns and units.
! In: a `variant_results_t`. Out: `rows_t` of each table; the values are those of studies. Begin
! with `table_t` and `plan_table` here, `list_reports` in `report_table.f90`, `find_rows` in
! `report_rows.f90`. All but REPORT summary are in `src/reports/rigid`, `src/reports/motion`,
! `src/reports/elastic`, their notes in `src/reports/words`.
! Not here: files and CSV (`src/output`), results (`src/studies`).

!> What a report and its tables are: objects that know what they need, their notes and their rows.
!!
!! A report is a record for the reader of decks, with its tables. A table extends one of the types
!! below: all rows at once, rows by speeds, rows by positions and speeds. Its procedures take the
!! results of a variant and do no mechanics. Rows are made in items, several threads at a time;
!! therefore nothing that `add_item_rows` calls has a result of deferred length, for which gfortran
!! 12 has one place for all threads.
module report_types
  use drive_motions, only: first_position, place_columns, table_place
  use drive_positions, only: shown_crank
  use friction_words, only: lock_words
  use kinds, only: wp
  use locked_rows, only: is_locked_at, lock_at
  use models, only: drives_length, has_law, model_t, nature_of_positions, report_number
  use natures, only: nature_t, of_effort, of_value
  use report_kinds, only: column_kind_t, columns_of, key_count, report_kind_t, table_kind_t
  use response_notes, only: add_failed_speed, has_response
  use table_columns, only: choose_columns, name_list_t, new_table_layout, table_factor, &
    table_layout_t
  use table_rows, only: add_failed_row, add_gap, rows_t
  use text, only: string_t
  use tokens, only: token_texts
  use units, only: from_si
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: report_record_t, add_table
  public :: table_t, whole_table_t, speed_table_t, position_table_t, state_table_t, &
    rest_table_t, response_table_t, any_table_t
  public :: table_plan_t, plan_table, add_item_rows, fit_columns, plan_links, lay_out_columns, &
    has_to_look_back, need_not_look_back

  !> What the columns and the items of a table depend on, beside its record.
  type :: table_plan_t
    class(table_t), allocatable :: table
    type(table_layout_t) :: layout      !! for the results of a variant
    integer :: items = 0                !! pieces in which its rows are found
    type(name_list_t) :: names(4)       !! in columns of names
    integer :: count = 0                !! columns that a numbered one stands for
    logical :: has_optional = .false.   !! it has its optional columns
    integer, allocatable :: drawn(:, :) !! (position and speed, items) of shapes
  end type table_plan_t

  !> A table of a report: name and columns, as the reader of decks knows them, and what follows.
  type, abstract, extends(table_kind_t) :: table_t
    type(name_list_t), allocatable :: words(:) !! in columns of names, whatever the deck
    integer :: numbered = 0                    !! columns that a numbered one stands for
  contains
    procedure, nopass :: fit => fit_columns             !! columns as a deck has them
    procedure, nopass :: plan => plan_links             !! names and columns of a variant
    procedure, nopass :: lay_out => lay_out_columns     !! columns that no record can have, too
    procedure, nopass :: looks_back => has_to_look_back !! rows or notes need several positions
    procedure(notes_of), deferred, nopass :: find_notes !! the remarks at its head
  end type table_t

  !> A table of any kind, in a list.
  type :: any_table_t
    class(table_t), allocatable :: table
  end type any_table_t

  !> A table whose rows are found at once.
  type, abstract, extends(table_t) :: whole_table_t
  contains
    procedure(all_rows), deferred, nopass :: add_all
  end type whole_table_t

  !> A table with an item for every speed of the deck.
  type, abstract, extends(table_t) :: speed_table_t
  contains
    procedure(speed_rows), deferred, nopass :: add_speed
  end type speed_table_t

  !> A table with an item for every position and speed: one block per speed; within it, position
  !! after position. It writes failed rows itself.
  type, abstract, extends(table_t) :: position_table_t
  contains
    procedure(position_rows), deferred, nopass :: add_position
    procedure, nopass :: count_speeds => speeds_of_deck
  end type position_table_t

  !> One of the rigid linkage: a position without a pose, or where friction locks the linkage, is a
  !! failed row.
  type, abstract, extends(position_table_t) :: state_table_t
  contains
    procedure, nopass :: looks_back => need_not_look_back
  end type state_table_t

  !> One of the rigid linkage at rest: an item for every position.
  type, abstract, extends(table_t) :: rest_table_t
  contains
    procedure(rest_rows), deferred, nopass :: add_at_rest
  end type rest_table_t

  !> One of the elastic response. A failed speed has one row, instead of the first position.
  type, abstract, extends(position_table_t) :: response_table_t
  end type response_table_t

  !> A report: its record for the reader of decks, and its tables in the same order.
  type :: report_record_t
    type(report_kind_t) :: kind
    type(any_table_t), allocatable :: tables(:)
  end type report_record_t

  abstract interface

    !> The remarks at the head of a table.
    subroutine notes_of(variant, notes)
      import :: string_t, variant_results_t
      type(variant_results_t), intent(in) :: variant       !! with its results
      type(string_t), allocatable, intent(out) :: notes(:) !! a line each
    end subroutine notes_of

    !> Appends all rows.
    subroutine all_rows(variant, layout, rows)
      import :: rows_t, table_layout_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! with its results
      type(table_layout_t), intent(in) :: layout     !! of this table
      type(rows_t), intent(inout) :: rows            !! to which they are appended
    end subroutine all_rows

    !> Appends the rows of a speed.
    subroutine speed_rows(variant, layout, speed, rows)
      import :: rows_t, table_layout_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! with its results
      type(table_layout_t), intent(in) :: layout     !! of this table
      integer, intent(in) :: speed                   !! number in the deck's list
      type(rows_t), intent(inout) :: rows            !! to which they are appended
    end subroutine speed_rows

    !> Appends the rows of a position and speed.
    subroutine position_rows(variant, layout, position, speed, rows)
      import :: rows_t, table_layout_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! with its results
      type(table_layout_t), intent(in) :: layout     !! of this table
      integer, intent(in) :: position                !! number in the deck's list
      integer, intent(in) :: speed                   !! number in the list of its blocks
      type(rows_t), intent(inout) :: rows            !! to which they are appended
    end subroutine position_rows

    !> Appends the rows of a position.
    subroutine rest_rows(variant, layout, position, rows)
      import :: rows_t, table_layout_t, variant_results_t
      type(variant_results_t), intent(in) :: variant !! with its results
      type(table_layout_t), intent(in) :: layout     !! of this table
      integer, intent(in) :: position                !! number in the deck's list, with a pose
      type(rows_t), intent(inout) :: rows            !! to which they are appended
    end subroutine rest_rows

  end interface

contains

  !> Appends a table to a report.
  subroutine add_table(report, table, name, columns, words, numbered, has_blocks)
    type(report_record_t), intent(inout) :: report !! its record is complete but for its tables
    class(table_t), intent(in) :: table            !! what it does
    character(len=*), intent(in) :: name           !! of the file, without ending
    character(len=*), intent(in) :: columns        !! as in `table_kind_t`
    type(name_list_t), intent(in), optional :: words(:) !! in columns of names, whatever the deck
    integer, intent(in), optional :: numbered      !! columns that a numbered one stands for
    logical, intent(in), optional :: has_blocks    !! empty lines separate variants

    type(any_table_t), allocatable :: longer(:)
    integer :: count, i

    count = 0
    if (allocated(report%tables)) count = size(report%tables)
    allocate (longer(count + 1))
    do i = 1, count
      call move_alloc(report%tables(i)%table, longer(i)%table)
    end do
    allocate (longer(count + 1)%table, source=table)
    associate (new => longer(count + 1)%table)
      new%name = name
      new%columns = columns
      if (present(words)) new%words = words
      if (present(numbered)) new%numbered = numbered
      if (present(has_blocks)) new%has_blocks = has_blocks
      report%kind%tables(count + 1) = new%table_kind_t
    end associate
    call move_alloc(longer, report%tables)
  end subroutine add_table

  !> Makes columns those of the first drive: positions of a slider or a ram are lengths, and its
  !! `effort` a force. Of a drive with a law a table of positions has the time in its first column.
  pure subroutine fit_columns(model, columns)
    type(model_t), intent(in) :: model         !! with its drives
    character(len=*), intent(inout) :: columns !! as in `table_kind_t`

    type(nature_t) :: nature

    nature = nature_of_positions(model)
    call put_for(columns, "crank:deg", "crank:"//nature%words(of_value))
    do while (index(columns, ":effort") > 0)
      call put_for(columns, ":effort", ":"//nature%words(of_effort))
    end do
    if (drives_length(model)) then
      call put_for(columns, "turning_stiffness", "line_stiffness")
      call put_for(columns, "speed:speed", "speed:"//model%speed_unit%name)
    end if
    if (has_law(model) .and. index(columns, "speed:") == 1 .and. index(columns, " time:") == 0 &
      .and. max(index(columns, " crank:"), index(columns, " crank,")) > 0) columns = &
      "time:time "//trim(columns)
  end subroutine fit_columns

  !> Puts a word for the first occurrence of another one.
  pure subroutine put_for(text, old, new)
    character(len=*), intent(inout) :: text
    character(len=*), intent(in) :: old, new

    integer :: at

    at = index(text, old)
    if (at > 0) text = text(:at - 1)//trim(new)//trim(text(at + len(old):))
  end subroutine put_for

  !> Columns and items of a table.
  subroutine plan_table(table, variant, plan)
    class(table_t), intent(in) :: table            !! of a requested report, fitted to its deck
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(out) :: plan        !! for `add_item_rows`

    integer :: i

    allocate (plan%table, source=table)
    do i = 1, size(plan%names)
      plan%names(i)%column = ""
    end do
    if (allocated(table%words)) plan%names(:size(table%words)) = table%words
    plan%count = table%numbered
    plan%items = count_items(table, variant)
    call table%plan(variant, plan)
    call table%lay_out(variant%model, plan)
    call choose_if_asked(table, variant%model, plan%layout)
  end subroutine plan_table

  !> How many items a table has, unless its plan counts them.
  pure function count_items(table, variant) result(items)
    class(table_t), intent(in) :: table
    type(variant_results_t), intent(in) :: variant
    integer :: items

    items = 1
    select type (table)
    class is (speed_table_t)
      items = size(variant%model%speed%value)
    class is (rest_table_t)
      items = size(variant%found%positions%crank)
    class is (position_table_t)
      items = size(variant%found%positions%crank)*table%count_speeds(variant)
    end select
  end function count_items

  !> The columns of the record.
  subroutine lay_out_columns(model, plan)
    type(model_t), intent(in) :: model        !! of the deck
    type(table_plan_t), intent(inout) :: plan !! with names and numbers of columns

    call new_table_layout(plan%table%table_kind_t, model%outputs, plan%count, plan%has_optional, &
      plan%names, plan%layout)
  end subroutine lay_out_columns

  !> Leaves a table the columns that its report asks for.
  subroutine choose_if_asked(table, model, layout)
    class(table_t), intent(in) :: table
    type(model_t), intent(in) :: model
    type(table_layout_t), intent(inout) :: layout

    type(column_kind_t), allocatable :: columns(:)
    integer :: number

    ! The first table of a report has its name.
    number = report_number(model, trim(table%name))
    if (number == 0) return
    if (.not. allocated(model%reports(number)%columns)) return
    call columns_of(table%table_kind_t, columns)
    call choose_columns(layout, key_count(columns), token_texts(model%reports(number)%columns))
  end subroutine choose_if_asked

  !> A column `link`, if there is one, has the names of links.
  subroutine plan_links(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(table_plan_t), intent(inout) :: plan      !! of a table

    plan%names(4)%column = "link"
    plan%names(4)%names = variant%mechanism%names
  end subroutine plan_links

  !> Blocks are those of the deck's speeds.
  pure function speeds_of_deck(variant) result(count)
    type(variant_results_t), intent(in) :: variant !! with its model
    integer :: count

    count = size(variant%model%speed%value)
  end function speeds_of_deck

  !> What most tables answer.
  pure logical function has_to_look_back()
    has_to_look_back = .true.
  end function has_to_look_back

  !> What tables answer whose rows tell of their positions only.
  pure logical function need_not_look_back()
    need_not_look_back = .false.
  end function need_not_look_back

  !> Appends the rows of an item.
  subroutine add_item_rows(plan, variant, number, rows)
    type(table_plan_t), intent(in) :: plan         !! by `plan_table`
    type(variant_results_t), intent(in) :: variant !! with its results
    integer, intent(in) :: number                  !! of the item, from 1
    type(rows_t), intent(inout) :: rows            !! to which they are added

    integer :: count, position, speed

    select type (table => plan%table)
    class is (whole_table_t)
      call table%add_all(variant, plan%layout, rows)
    class is (speed_table_t)
      call table%add_speed(variant, plan%layout, number, rows)
    class is (rest_table_t)
      associate (positions => variant%found%positions)
        associate (state => positions%states(positions%state(number)))
          if (allocated(state%error)) then
            call add_failed_row(rows, [shown_crank(variant, first_position(variant%model, &
              number))], &
              state%error%text)
          else
            call table%add_at_rest(variant, plan%layout, number, rows)
          end if
        end associate
      end associate
    class is (position_table_t)
      if (allocated(plan%drawn)) then
        position = plan%drawn(1, number)
        speed = plan%drawn(2, number)
        if (number > 1) call add_gap(rows, 2)
      else
        count = size(variant%found%positions%crank)
        position = 1 + mod(number - 1, count)
        speed = 1 + (number - 1)/count
        if (position + variant%found%positions%before == 1 .and. speed > 1) call add_gap(rows, 2)
      end if
      call add_place(table, plan%layout, variant, position, speed, rows)
    end select
  end subroutine add_item_rows

  !> The rows of a position and speed, or a failed one.
  subroutine add_place(table, layout, variant, position, speed, rows)
    class(position_table_t), intent(in) :: table
    type(table_layout_t), intent(in) :: layout
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    select type (table)
    class is (response_table_t)
      if (.not. has_response(variant, speed)) then
        if (position == 1) call add_failed_speed(variant, speed, rows)
        return
      end if
    class is (state_table_t)
      associate (states => variant%found%positions%states, &
          state => variant%found%positions%state(position))
        if (allocated(states(state)%error)) then
          call add_failed(variant, position, speed, states(state)%error%text, rows)
          return
        end if
      end associate
      if (is_locked_at(variant, table%name, position, speed)) then
        call add_locked(variant, table%name, position, speed, rows)
        return
      end if
    end select
    call table%add_position(variant, layout, position, speed, rows)
  end subroutine add_place

  !> A failed row of a position and speed.
  subroutine add_failed(variant, position, speed, reason, rows)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position, speed !! numbers
    character(len=*), intent(in) :: reason
    type(rows_t), intent(inout) :: rows

    real(wp) :: place(place_columns(variant%model))

    place = table_place(variant%model, speed, position)
    place(size(place)) = shown_crank(variant, first_position(variant%model, position))
    if (has_law(variant%model)) place(1) = from_si(place(1), table_factor("time", &
      variant%model%outputs))
    call add_failed_row(rows, place, reason)
  end subroutine add_failed

  !> A failed row where friction locks the linkage.
  subroutine add_locked(variant, table, position, speed, rows)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: table  !! name
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    character(len=:), allocatable :: words

    ! One thread at a time makes texts.
    !$omp critical (one_at_a_time)
    words = lock_words(variant%model, variant%mechanism, lock_at(variant, table, position, speed))
    !$omp end critical (one_at_a_time)
    call add_failed(variant, position, speed, words, rows)
  end subroutine add_locked

end module report_types
