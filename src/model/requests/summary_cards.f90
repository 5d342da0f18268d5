!> `REPORT summary`: the quantities of which a variant has a row.
module summary_cards
  use card_reader, only: has_key, has_value
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use spelling, only: suggestion
  use summary_quantities, only: find_quantity, quantity_name, quantity_names, quantity_t
  use text, only: joined, same_word, string_t
  use tokens, only: token_t
  use value_lists, only: find_items
  implicit none (type, external)
  private

  public :: summary_card_t, read_summary, takes_from

  !> What the row is to have.
  type :: summary_card_t
    type(quantity_t), allocatable :: quantities(:) !! in the order of the card; not allocated: of
                                                   !! another report
    type(token_t), allocatable :: words(:)         !! (quantities)
    character(len=12), allocatable :: reports(:)   !! (quantities) that have their values, of the
                                                   !! linkage of the deck; allocated with the needs
                                                   !! of the report
  end type summary_card_t

contains

  !> Reads `REPORT summary of=f1,torque,...`. Errors: no `of=`; a quantity that there is not, or
  !! one named twice.
  pure subroutine read_summary(card, known_keys, diagnostics, summary)
    type(card_t), intent(in) :: card                  !! the REPORT card
    logical, intent(in) :: known_keys                 !! no key is unknown: a missing one is an
                                                      !! error
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(summary_card_t), intent(out) :: summary      !! the quantities that could be read

    type(token_t), allocatable :: words(:)
    type(string_t), allocatable :: names(:)
    type(quantity_t) :: quantity
    logical :: fine
    integer :: i, k, kept

    allocate (summary%quantities(0), summary%words(0))
    names = quantity_names()
    if (.not. has_key(card, "of")) then
      if (known_keys) call add_error(diagnostics, card%keyword, "'of=' is missing; expected "// &
        "quantities, one or several of: "//joined(names))
      return
    end if
    ! Without a value it is no entry, and reported as such.
    if (.not. has_value(card, "of")) return
    call find_items(card, "of", diagnostics, words, fine)
    if (.not. fine) return
    kept = 0
    do i = 1, size(words)
      quantity = find_quantity(words(i)%text)
      if (quantity%kind == 0) then
        call add_error(diagnostics, words(i), "unknown quantity '"//words(i)%text//"'"// &
          suggestion(words(i)%text, names)//"; expected one of: "//joined(names)// &
          ", or an f or a zeta of another number")
        cycle
      end if
      k = number_among(summary%quantities, quantity)
      if (k > 0) then
        call add_error(diagnostics, words(i), "'"//quantity_name(quantity)//"' is given twice", &
          words(k), "first given here")
        cycle
      end if
      summary%quantities = [summary%quantities, quantity]
      kept = kept + 1
      words(kept) = words(i)
    end do
    summary%words = words(:kept)
  end subroutine read_summary

  !> The number of a quantity in a list; 0 if it is not there.
  pure function number_among(list, quantity) result(number)
    type(quantity_t), intent(in) :: list(:)
    type(quantity_t), intent(in) :: quantity
    integer :: number

    do number = size(list), 1, -1
      if (list(number)%kind == quantity%kind .and. list(number)%mode == quantity%mode .and. &
        same_word(trim(list(number)%of), trim(quantity%of))) return
    end do
  end function number_among

  !> Whether any quantity has the values of a report.
  pure function takes_from(summary, report) result(takes)
    type(summary_card_t), intent(in) :: summary !! with its reports, or of another report
    character(len=*), intent(in) :: report      !! name
    logical :: takes

    takes = .false.
    if (allocated(summary%reports)) takes = any(summary%reports == report)
  end function takes_from

end module summary_cards
