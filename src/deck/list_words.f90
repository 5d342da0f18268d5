!> Commas between the words of a card that takes a list: `CRANK 0,90,180`.
module list_words
  use diagnostics, only: add_error, diagnostics_t
  use tokens, only: list_items, token_t
  implicit none (type, external)
  private

  public :: split_at_commas

  character(len=*), parameter :: digits = "0123456789"

contains

  !> Splits words at their commas; one at the end of a word separates it from the next.
  !!
  !! Errors: nothing between two commas; a word that may be one number with its thousands grouped,
  !! `1,000`. Such words remain as they are, marked as reported.
  pure subroutine split_at_commas(words, diagnostics)
    type(token_t), allocatable, intent(inout) :: words(:) !! of a list
    type(diagnostics_t), intent(inout) :: diagnostics     !! errors are added

    type(token_t), allocatable :: split(:), items(:)
    integer :: i, k, count, last

    last = 0
    do i = 1, size(words)
      last = last + 1 + len(words(i)%text)
    end do
    allocate (split(last))
    count = 0
    do i = 1, size(words)
      if (index(words(i)%text, ",") == 0) then
        count = count + 1
        split(count) = words(i)
        cycle
      end if
      items = list_items(words(i))
      ! A comma ends this word, or begins it after another one.
      last = size(items)
      if (len(items(last)%text) == 0 .and. i < size(words)) last = last - 1
      k = 1
      if (len(items(1)%text) == 0 .and. i > 1) k = 2
      if (is_grouped(words(i)%text)) then
        call add_error(diagnostics, words(i), "'"//words(i)%text//"' may be one number or "// &
          "several: write "//without_commas(words(i)%text, "")//", or "// &
          without_commas(words(i)%text, " "))
      else if (is_empty(items(k:last))) then
        call add_error(diagnostics, words(i), "a value is missing in this list")
      else
        split(count + 1:count + 1 + last - k) = items(k:last)
        count = count + 1 + last - k
        cycle
      end if
      count = count + 1
      split(count) = words(i)
      split(count)%set_line = -1
    end do
    words = split(:count)
  end subroutine split_at_commas

  pure function is_empty(items) result(is)
    type(token_t), intent(in) :: items(:)
    logical :: is

    integer :: i

    is = .false.
    do i = 1, size(items)
      is = is .or. len(items(i)%text) == 0
    end do
  end function is_empty

  !> Whether a word is a whole number with its digits in groups of three: `1,000`, `12,500,000rpm`.
  !! `0,120,240` is none, since no number begins with a group 0.
  pure function is_grouped(word) result(is)
    character(len=*), intent(in) :: word
    logical :: is

    integer :: first, last

    is = .false.
    first = 1
    if (scan(word(1:1), "+-") == 1) first = 2
    last = index(word, ",") - 1
    if (last < first .or. last > first + 2) return
    if (verify(word(first:last), digits) > 0 .or. word(first:first) == "0") return
    do while (last < len(word))
      if (word(last + 1:last + 1) /= ",") exit
      if (last + 4 > len(word)) return
      if (verify(word(last + 2:last + 4), digits) > 0) return
      last = last + 4
    end do
    ! What follows may be a unit, but no further digit.
    if (last < len(word)) then
      if (scan(word(last + 1:last + 1), digits//".,") == 1) return
    end if
    is = .true.
  end function is_grouped

  !> A word with something else in place of its commas.
  pure function without_commas(word, separator) result(text)
    character(len=*), intent(in) :: word, separator
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    do i = 1, len(word)
      if (word(i:i) == ",") then
        text = text//separator
      else
        text = text//word(i:i)
      end if
    end do
  end function without_commas

end module list_words
