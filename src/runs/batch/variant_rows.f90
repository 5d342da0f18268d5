!> What a computed variant leaves: the rows of its tables, its findings and its totals. The journal
!! of a run keeps them as bytes.
module variant_rows
  use byte_streams, only: get_integers, get_logicals, get_reals, get_string, put_integers, &
    put_logicals, put_reals, put_string
  use errors, only: error_t
  use kinds, only: wp
  use report_rows, only: find_rows
  use report_types, only: any_table_t, plan_table, table_plan_t
  use run_findings, only: add_failure, failure_t, findings_t, get_findings, &
    put_findings
  use run_totals, only: get_totals, put_totals, run_totals_t
  use table_columns, only: header_columns
  use table_rows, only: add_failed_row, get_rows, put_rows, rows_t
  use tables, only: column_t
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variant_checks, only: check_t, get_check, put_check
  use variant_findings, only: find_failures, find_warnings, totals_of
  use variant_log, only: log_of_variant
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: variant_rows_t, table_part_t, find_variant_rows, fail_variant, put_variant_rows, &
    get_variant_rows

  !> The part of a table that belongs to a variant.
  type :: table_part_t
    type(string_t), allocatable :: notes(:)   !! lines of its head
    type(column_t), allocatable :: columns(:) !! without those of what varies; of the variant that
                                              !! leads
    type(rows_t) :: rows
  end type table_part_t

  !> All that a variant leaves.
  type :: variant_rows_t
    real(wp), allocatable :: varied(:)           !! (parameters) values, in the units of their VARY
                                                 !! cards
    type(table_part_t), allocatable :: tables(:) !! in the order of the deck's tables
    type(check_t) :: check
    type(findings_t) :: findings
    type(run_totals_t) :: totals
    logical :: has_failed = .false.              !! as a whole: there are failed rows only
    character(len=:), allocatable :: log         !! what `run.log` says of it, and
    integer :: method = 0                        !! how its frequencies were found; of the variant
                                                 !! that leads
  end type variant_rows_t

contains

  !> Rows, findings and totals of a computed variant. Several threads may call it at the same time,
  !! for different variants.
  subroutine find_variant_rows(tables, variant, threads, leads, rows)
    type(any_table_t), intent(in) :: tables(:)     !! of the deck
    type(variant_results_t), intent(in) :: variant !! computed
    integer, intent(in) :: threads                 !! number to use
    logical, intent(in) :: leads                   !! whether heads of tables and log are to be its
    type(variant_rows_t), intent(out) :: rows      !! with all that is to be written

    type(table_plan_t) :: plans(size(tables))
    integer :: i

    allocate (rows%tables(size(tables)))
    ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one place
    ! for all threads.
    !$omp critical (one_at_a_time)
    rows%varied = variant%model%varied
    rows%totals = totals_of(variant)
    call find_failures(variant, rows%findings)
    call find_warnings(variant, rows%findings)
    do i = 1, size(tables)
      call plan_table(tables(i)%table, variant, plans(i))
      call tables(i)%table%find_notes(variant, rows%tables(i)%notes)
      if (leads) call header_columns(plans(i)%layout, rows%tables(i)%columns)
    end do
    if (leads) then
      rows%log = log_of_variant(variant)
      if (rows%totals%has_frequencies) rows%method = variant%found%sweep%request%method
    end if
    !$omp end critical (one_at_a_time)
    do i = 1, size(tables)
      call find_rows(plans(i), variant, 1, plans(i)%items, threads, rows%tables(i)%rows)
    end do
  end subroutine find_variant_rows

  !> A variant that cannot be computed: a failed row in every table, and a failure of the run.
  subroutine fail_variant(tables, variant, varied, error, rows)
    integer, intent(in) :: tables             !! number of tables of the deck
    character(len=*), intent(in) :: variant   !! `L=-5mm`
    real(wp), intent(in) :: varied(:)         !! (parameters) values, in the units of their VARY
                                              !! cards
    type(error_t), intent(in) :: error        !! the reason
    type(variant_rows_t), intent(out) :: rows !! with all that is to be written

    type(failure_t) :: failure
    real(wp) :: no_place(0)
    integer :: i

    rows%has_failed = .true.
    rows%varied = varied
    rows%totals%variants = 1
    allocate (rows%tables(tables))
    do i = 1, tables
      allocate (rows%tables(i)%notes(0))
      call add_failed_row(rows%tables(i)%rows, no_place, error%text)
    end do
    failure%stage = "variant"
    failure%error = error
    failure%variant = variant
    failure%varied = varied
    call add_failure(rows%findings, failure)
  end subroutine fail_variant

  !> Appends rows, findings and totals to a buffer as bytes.
  pure subroutine put_variant_rows(buffer, rows)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_variant_rows`
    type(variant_rows_t), intent(in) :: rows     !! of a variant

    integer :: i, k

    call put_integers(buffer, [size(rows%varied), size(rows%tables)])
    call put_reals(buffer, rows%varied)
    do k = 1, size(rows%tables)
      associate (table => rows%tables(k))
        call put_integers(buffer, [size(table%notes)])
        do i = 1, size(table%notes)
          call put_string(buffer, table%notes(i)%text)
        end do
        call put_columns(buffer, table%columns)
        call put_rows(buffer, table%rows)
      end associate
    end do
    call put_check(buffer, rows%check)
    call put_findings(buffer, rows%findings)
    call put_totals(buffer, rows%totals)
    call put_logicals(buffer, [rows%has_failed, allocated(rows%log)])
    if (.not. allocated(rows%log)) return
    call put_string(buffer, rows%log)
    call put_integers(buffer, [rows%method])
  end subroutine put_variant_rows

  pure subroutine put_columns(buffer, columns)
    type(text_buffer_t), intent(inout) :: buffer
    type(column_t), allocatable, intent(in) :: columns(:) !! may be unallocated

    integer :: i

    call put_logicals(buffer, [allocated(columns)])
    if (.not. allocated(columns)) return
    call put_integers(buffer, [size(columns)])
    do i = 1, size(columns)
      call put_string(buffer, columns(i)%name)
      call put_string(buffer, columns(i)%unit)
      call put_integers(buffer, [columns(i)%width])
    end do
  end subroutine put_columns

  !> Reads what `put_variant_rows` wrote.
  pure subroutine get_variant_rows(bytes, at, rows)
    character(len=*), intent(in) :: bytes     !! of `put_variant_rows`, among others
    integer, intent(inout) :: at              !! place of the first byte; on return, after the last
    type(variant_rows_t), intent(out) :: rows !! of a variant

    integer :: counts(2), notes(1), method(1), i, k
    logical :: marks(2)

    call get_integers(bytes, at, counts)
    allocate (rows%varied(counts(1)), rows%tables(counts(2)))
    call get_reals(bytes, at, rows%varied)
    do k = 1, size(rows%tables)
      associate (table => rows%tables(k))
        call get_integers(bytes, at, notes)
        allocate (table%notes(notes(1)))
        do i = 1, size(table%notes)
          call get_string(bytes, at, table%notes(i)%text)
        end do
        call get_columns(bytes, at, table%columns)
        call get_rows(bytes, at, table%rows)
      end associate
    end do
    call get_check(bytes, at, rows%check)
    call get_findings(bytes, at, rows%findings)
    call get_totals(bytes, at, rows%totals)
    call get_logicals(bytes, at, marks)
    rows%has_failed = marks(1)
    if (.not. marks(2)) return
    call get_string(bytes, at, rows%log)
    call get_integers(bytes, at, method)
    rows%method = method(1)
  end subroutine get_variant_rows

  pure subroutine get_columns(bytes, at, columns)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(column_t), allocatable, intent(out) :: columns(:)

    integer :: numbers(1), i
    logical :: are_there(1)

    call get_logicals(bytes, at, are_there)
    if (.not. are_there(1)) return
    call get_integers(bytes, at, numbers)
    allocate (columns(numbers(1)))
    do i = 1, size(columns)
      call get_string(bytes, at, columns(i)%name)
      call get_string(bytes, at, columns(i)%unit)
      call get_integers(bytes, at, numbers)
      columns(i)%width = numbers(1)
    end do
  end subroutine get_columns

end module variant_rows
