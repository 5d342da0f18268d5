!> The exact frequencies of the first mechanism (tests/exact/mechanism1.dat), and how far others are from them.
module exact_values
  use constants, only: two_pi
  use errors, only: error_of_files, error_t, set_error
  use kinds, only: wp
  use positions, only: positions_t
  implicit none (type, external)
  private

  public :: exact_values_t, read_exact_values, exact_states, largest_error, bench_speed

  !> Of all cases that move [rad/s].
  real(wp), parameter :: bench_speed = 20.0_wp

  !> Modes whose errors are counted.
  integer, parameter :: judged = 3

  type :: exact_values_t
    real(wp), allocatable :: speed(:), crank(:)  !! (rows) [rad/s, deg]
    real(wp), allocatable :: frequency(:, :)     !! (modes, rows) [Hz]
  end type exact_values_t

contains

  !> Reads the table, which has rows `speed crank f1 … f5`. Errors: it is not there, or not such a table.
  subroutine read_exact_values(path, exact, error)
    character(len=*), intent(in) :: path
    type(exact_values_t), intent(out) :: exact
    type(error_t), allocatable, intent(out) :: error

    character(len=200) :: line
    real(wp) :: row(7)
    integer :: unit, status

    allocate (exact%speed(0), exact%crank(0), exact%frequency(5, 0))
    open (newunit=unit, file=path, status="old", action="read", iostat=status)
    if (status /= 0) then
      call set_error(error, error_of_files, "this file cannot be read", path)
      return
    end if
    do
      read (unit, "(a)", iostat=status) line
      if (status /= 0) exit
      if (line(1:1) == "#" .or. len_trim(line) == 0) cycle
      read (line, *, iostat=status) row
      if (status /= 0) exit
      exact%speed = [exact%speed, row(1)]
      exact%crank = [exact%crank, row(2)]
      exact%frequency = reshape([exact%frequency, row(3:)], [5, size(exact%speed)])
    end do
    close (unit)
    if (status > 0 .or. size(exact%speed) == 0) call set_error(error, error_of_files, &
      "these are not rows of speed, crank, f1 to f5", path)
  end subroutine read_exact_values

  !> The numbers of the different positions of a turn at which a speed has exact values.
  pure function exact_states(exact, positions, speed) result(states)
    type(exact_values_t), intent(in) :: exact
    type(positions_t), intent(in) :: positions
    real(wp), intent(in) :: speed
    integer, allocatable :: states(:)

    integer :: i

    states = pack([(i, i=1, size(positions%states))], [(row_at(exact, positions%states(i)%crank, speed) > 0, &
      i=1, size(positions%states))])
  end function exact_states

  !> The largest relative error of the lowest frequencies over the positions that have exact values.
  pure function largest_error(exact, positions, speed, lambda) result(error)
    type(exact_values_t), intent(in) :: exact
    type(positions_t), intent(in) :: positions
    real(wp), intent(in) :: speed
    real(wp), intent(in) :: lambda(:, :) !! (modes, states) ω²; only the columns of `exact_states` are read [1/s²]
    real(wp) :: error

    integer :: i, row, modes

    error = 0.0_wp
    modes = min(judged, size(lambda, 1))
    do i = 1, size(positions%states)
      row = row_at(exact, positions%states(i)%crank, speed)
      if (row == 0) cycle
      associate (found => sign(sqrt(abs(lambda(:modes, i))), lambda(:modes, i))/two_pi)
        error = max(error, maxval(abs(found/exact%frequency(:modes, row) - 1.0_wp)))
      end associate
    end do
  end function largest_error

  !> The row of a position and speed; 0 if there is none.
  pure function row_at(exact, crank, speed) result(row)
    type(exact_values_t), intent(in) :: exact
    real(wp), intent(in) :: crank, speed
    integer :: row

    row = findloc(abs(exact%crank - crank) <= 0.0_wp .and. abs(exact%speed - speed) <= 0.0_wp, .true., dim=1)
  end function row_at

end module exact_values
