!> A warning as a value: what it says, how much it takes from the results, and in how many variants
!! of a deck it occurs.
module warnings
  use byte_streams, only: byte_stream_t
  use kinds, only: wp
  use text, only: to_string
  implicit none (type, external)
  private

  public :: warning_t, join_warning, counted_text, pass_warning
  public :: grade_doubt, grade_meaningless

  !> Grades of warnings: the results are in doubt, or may still be what was wanted; the results mean
  !! nothing.
  integer, parameter :: grade_doubt = 1, grade_meaningless = 2

  !> Warnings of several variants that are of one kind and grade are joined into one.
  type :: warning_t
    character(len=12) :: study = ""          !! that warns of its results; of a deck blank
    integer :: kind = 0                      !! what it is about, numbered by those who warn
    integer :: grade = grade_doubt           !! grade_doubt or grade_meaningless
    real(wp) :: amount = 0.0_wp              !! the larger, the worse among those of the same kind
    character(len=:), allocatable :: text    !! one line, of the worst variant
    character(len=:), allocatable :: variant !! the worst one, `L=90mm`; empty: nothing varies
    integer :: variants = 1                  !! number of those that it occurs in
    logical :: is_alike = .true.             !! all of them give the same text
    logical :: has_worst = .false.           !! some of them are worse than others
  end type warning_t

contains

  !> Joins a warning of a further variant to one of the same kind and grade. The text is that of
  !! the worse one; of equally bad ones, of the first.
  pure subroutine join_warning(warning, more, is_new)
    type(warning_t), intent(inout) :: warning !! of the variants before
    type(warning_t), intent(in) :: more       !! of one variant
    logical, intent(in) :: is_new             !! whether the variant has yet to be counted

    ! Rounding tells no variant from another.
    real(wp), parameter :: equal = 1.0e-9_wp

    warning%is_alike = warning%is_alike .and. warning%text == more%text
    if (abs(warning%amount - more%amount) > equal*max(abs(warning%amount), abs(more%amount))) then
      warning%has_worst = .true.
      if (more%amount > warning%amount) then
        warning%amount = more%amount
        warning%text = more%text
        warning%variant = more%variant
      end if
    end if
    if (is_new) warning%variants = warning%variants + 1
  end subroutine join_warning

  !> The text after the number of variants that have the warning: `in 12 of 200 variants, the worst
  !! with L=93mm: text`.
  pure function counted_text(warning, variants) result(text)
    type(warning_t), intent(in) :: warning !! of all variants
    integer, intent(in) :: variants        !! of the deck
    character(len=:), allocatable :: text

    text = warning%text
    if (len(warning%variant) == 0) return
    if (variants == 1) then
      text = warning%variant//": "//text
      return
    end if
    if (warning%variants == variants .and. warning%is_alike) then
      text = "in all "//to_string(variants)//" variants: "//text
      return
    end if
    text = warning%variant//": "//text
    if (warning%variants > 1) text = "the "//trim(merge("worst", "first", warning%has_worst))// &
      " with "//text
    text = "in "//to_string(warning%variants)//" of "//to_string(variants)//" variants, "//text
  end function counted_text

  !> Passes a warning; an error has one without a text.
  pure subroutine pass_warning(stream, warning)
    type(byte_stream_t), intent(inout) :: stream
    type(warning_t), intent(inout) :: warning

    call stream%pass_text(warning%text)
    if (.not. allocated(warning%text)) return
    call stream%pass_text(warning%variant)
    call stream%pass_word(warning%study)
    call stream%pass(warning%kind)
    call stream%pass(warning%grade)
    call stream%pass(warning%amount)
    call stream%pass(warning%variants)
    call stream%pass(warning%is_alike)
    call stream%pass(warning%has_worst)
  end subroutine pass_warning

end module warnings
