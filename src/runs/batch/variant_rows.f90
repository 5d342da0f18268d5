!> What a computed variant leaves: the rows of its tables, its findings and its totals. The journal
!! of a run keeps them as bytes.
module variant_rows
  use byte_streams, only: byte_stream_t
  use errors, only: error_t
  use kinds, only: wp
  use report_rows, only: find_rows
  use report_types, only: any_table_t, plan_table, table_plan_t
  use run_findings, only: add_failure, failure_t, findings_t, pass_findings
  use run_totals, only: pass_totals, run_totals_t
  use table_columns, only: header_columns
  use table_rows, only: add_failed_row, pass_rows, rows_t
  use tables, only: column_t
  use text, only: string_t
  use variant_checks, only: check_t, pass_check
  use variant_findings, only: find_failures, find_warnings, totals_of
  use variant_log, only: log_of_variant
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: variant_rows_t, table_part_t, find_variant_rows, fail_variant, &
    pass_variant_rows

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

  !> Passes rows, findings and totals of a variant.
  pure subroutine pass_variant_rows(stream, rows)
    type(byte_stream_t), intent(inout) :: stream
    type(variant_rows_t), intent(inout) :: rows !! new if they are read

    integer :: count, i, k

    if (.not. stream%reads) count = size(rows%tables)
    call stream%pass(count)
    if (stream%reads) allocate (rows%tables(count))
    do k = 1, size(rows%tables)
      associate (table => rows%tables(k))
        if (.not. stream%reads) count = size(table%notes)
        call stream%pass(count)
        if (stream%reads) allocate (table%notes(count))
        do i = 1, count
          call stream%pass_text(table%notes(i)%text)
        end do
        call pass_columns(stream, table%columns)
        call pass_rows(stream, table%rows)
      end associate
    end do
    call stream%pass_allocatable(rows%varied)
    call pass_check(stream, rows%check)
    call pass_findings(stream, rows%findings)
    call pass_totals(stream, rows%totals)
    call stream%pass(rows%has_failed)
    call stream%pass_text(rows%log)
    call stream%pass(rows%method)
  end subroutine pass_variant_rows

  pure subroutine pass_columns(stream, columns)
    type(byte_stream_t), intent(inout) :: stream
    type(column_t), allocatable, intent(inout) :: columns(:) !! may be unallocated

    integer :: count, i

    count = -1
    if (allocated(columns)) count = size(columns)
    call stream%pass(count)
    if (stream%reads .and. count >= 0) allocate (columns(count))
    do i = 1, count
      call stream%pass_text(columns(i)%name)
      call stream%pass_text(columns(i)%unit)
      call stream%pass(columns(i)%width)
      call stream%pass(columns(i)%least_digits)
    end do
  end subroutine pass_columns

end module variant_rows
