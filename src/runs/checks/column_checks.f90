!> Columns that REPORT cards choose: what there are depends on the linkage.
module column_checks
  use diagnostics, only: add_error, diagnostics_t
  use models, only: model_t
  use report_kinds, only: column_kind_t, columns_of
  use report_table, only: tables_of_report
  use report_types, only: any_table_t
  use spelling, only: suggestion
  use text, only: append_string, has_word, joined, string_t, to_string
  implicit none (type, external)
  private

  public :: check_columns

contains

  !> Errors: a column that the table does not have.
  subroutine check_columns(model, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    type(any_table_t), allocatable :: tables(:)
    type(column_kind_t), allocatable :: columns(:)
    type(string_t), allocatable :: names(:), shown(:)
    integer :: i, k

    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (.not. allocated(report%columns)) cycle
        call tables_of_report(report%kind, model, tables)
        call columns_of(tables(1)%table%table_kind_t, columns)
        call list_names(columns, model%modes, names, shown)
        do k = 1, size(report%columns)
          associate (word => report%columns(k))
            if (has_word(names, word%text)) cycle
            call add_error(diagnostics, word, "REPORT "//trim(report%kind%name)// &
              " has no column '"//word%text//"'"//suggestion(word%text, names)// &
              "; expected some of: "//joined(shown))
          end associate
        end do
      end associate
    end do
  end subroutine check_columns

  !> The names of columns, and how a message lists them.
  pure subroutine list_names(columns, count, names, shown)
    type(column_kind_t), intent(in) :: columns(:)
    integer, intent(in) :: count !! columns that a numbered one stands for
    type(string_t), allocatable, intent(out) :: names(:), shown(:)

    integer :: i, k

    allocate (names(0), shown(0))
    do i = 1, size(columns)
      associate (column => columns(i))
        if (.not. column%is_numbered) then
          call append_string(names, column%name)
          call append_string(shown, column%name)
          cycle
        end if
        do k = 1, count
          call append_string(names, column%name//to_string(k))
        end do
        call append_string(shown, column%name//"1")
        if (count > 1) shown(size(shown))%text = column%name//"1 to "//column%name//to_string(count)
      end associate
    end do
  end subroutine list_names

end module column_checks
