!> Times as people write them: `3h50m`, `90m`, `45s`, `1d12h`, and `3:50:00` as batch systems do.
module durations
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: wp
  use numbers, only: read_integer
  implicit none (type, external)
  private

  public :: read_duration

  !> The units, the largest first, and how many seconds they have.
  character(len=*), parameter :: unit_letters = "dhms"
  integer, parameter :: unit_seconds(4) = [86400, 3600, 60, 1]

  !> More of a unit than this is a slip [-].
  integer, parameter :: most = 1000000

contains

  !> Reads a time. Errors: it has no unit, an unknown one or one twice, a smaller unit before a
  !! larger one, no digits before a unit, or it is zero.
  pure subroutine read_duration(word, seconds, error)
    character(len=*), intent(in) :: word             !! without blanks
    real(wp), intent(out) :: seconds                 !! [s] above 0
    type(error_t), allocatable, intent(out) :: error !! without a place: what is expected

    integer :: at, last, unit, used, number
    logical :: is_sound

    seconds = 0.0_wp
    if (index(word, ":") > 0) then
      call read_clock(word, seconds, is_sound)
    else
      is_sound = len(word) > 0
      used = 0
      at = 1
      do while (at <= len(word) .and. is_sound)
        last = at + verify(word(at:)//" ", "0123456789") - 2
        call read_count(word(at:last), number, is_sound)
        unit = 0
        if (last < len(word)) unit = index(unit_letters, word(last + 1:last + 1))
        is_sound = is_sound .and. unit > used
        if (.not. is_sound) exit
        seconds = seconds + real(number, wp)*real(unit_seconds(unit), wp)
        used = unit
        at = last + 2
      end do
    end if
    if (is_sound .and. seconds > 0.0_wp) return
    seconds = 0.0_wp
    call set_error(error, error_of_input, "a time such as 3h50m, 90m, 45s or 3:50:00")
  end subroutine read_duration

  !> `3:50:00` or `1-12:00:00`: hours, minutes and seconds, before them perhaps days.
  pure subroutine read_clock(word, seconds, is_sound)
    character(len=*), intent(in) :: word
    real(wp), intent(out) :: seconds
    logical, intent(out) :: is_sound

    integer :: numbers(4), first, minutes, dash
    logical :: sound(4)

    seconds = 0.0_wp
    dash = index(word, "-")
    first = index(word, ":")
    minutes = index(word, ":", back=.true.)
    is_sound = dash < first .and. first < minutes
    if (.not. is_sound) return
    numbers = 0
    sound = .true.
    if (dash > 0) call read_count(word(:dash - 1), numbers(1), sound(1))
    call read_count(word(dash + 1:first - 1), numbers(2), sound(2))
    call read_count(word(first + 1:minutes - 1), numbers(3), sound(3))
    call read_count(word(minutes + 1:), numbers(4), sound(4))
    is_sound = all(sound) .and. all(numbers(3:) < 60)
    seconds = sum(real(numbers, wp)*real(unit_seconds, wp))
  end subroutine read_clock

  !> A whole number without a sign.
  pure subroutine read_count(digits, number, is_sound)
    character(len=*), intent(in) :: digits
    integer, intent(out) :: number
    logical, intent(out) :: is_sound

    type(error_t), allocatable :: error

    number = 0
    is_sound = len(digits) > 0 .and. verify(digits, "0123456789") == 0
    if (.not. is_sound) return
    call read_integer(digits, number, error)
    is_sound = .not. allocated(error) .and. number <= most
  end subroutine read_count

end module durations
