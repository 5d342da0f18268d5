!> Motion programs: a position over time by segments with dwells between them, or by a cubic spline
!! through a table, and the instants at which its derivatives jump.
module motion_programs
  use cubic_splines, only: cubic_spline_t, spline_values
  use kinds, only: wp
  use motion_laws, only: law_modified_sine, law_modified_trapezoid, law_parabolic, &
    motion_segment_t, motion_values
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: motion_program_t, program_values, program_values_inside, program_breaks

  !> Positions in any unit u.
  type :: motion_program_t
    type(motion_segment_t), allocatable :: segments(:) !! one after another; not allocated: a table
    type(cubic_spline_t) :: spline    !! of a table, less the mean rate
    logical :: rests = .false.        !! beyond the ends of the table it stands still
    real(wp) :: rate = 0.0_wp         !! of a periodic table, that goes on from where it has ended
                                      !! [u/s]
  end type motion_program_t

  !> Instants nearer to each other than this share of the time are one.
  real(wp), parameter :: same = 1.0e-12_wp

contains

  !> Position, velocity and acceleration. Where they jump they are those of the time that follows.
  pure function program_values(program, time) result(values)
    type(motion_program_t), intent(in) :: program
    real(wp), intent(in) :: time !! [s]
    real(wp) :: values(0:2)      !! [u, u/s, u/s²]

    if (allocated(program%segments)) then
      values = motion_values(program%segments, time)
      return
    end if
    values = spline_values(program%spline, time)
    associate (x => program%spline%x, y => program%spline%y, n => size(program%spline%x))
      if (program%rests .and. time <= x(1)) values = [y(1), 0.0_wp, merge(values(2), 0.0_wp, &
        time >= x(1))]
      if (program%rests .and. time >= x(n)) values = [y(n), 0.0_wp, 0.0_wp]
      values = values + [program%rate*(time - x(1)), program%rate, 0.0_wp]
    end associate
  end function program_values

  !> The same; at the ends of a smooth piece those that it has inside.
  pure function program_values_inside(program, time, inside) result(values)
    type(motion_program_t), intent(in) :: program
    real(wp), intent(in) :: time   !! [s]
    real(wp), intent(in) :: inside !! another time of the piece, not at its ends [s]
    real(wp) :: values(0:2)

    ! A few roundings inside: what is smooth there does not notice them.
    values = program_values(program, time + sign(min(16.0_wp*spacing(max(abs(time), &
      abs(inside))), abs(inside - time)), inside - time))
  end function program_values_inside

  !> Instants between two others at which the position, or a derivative of it, jumps.
  pure function program_breaks(program, from, to) result(breaks)
    type(motion_program_t), intent(in) :: program
    real(wp), intent(in) :: from, to    !! [s]
    real(wp), allocatable :: breaks(:)  !! rising, none at `from` and `to` [s]

    real(wp), allocatable :: all(:)
    real(wp) :: last, period
    integer :: i

    if (allocated(program%segments)) then
      all = [real(wp) ::]
      do i = 1, size(program%segments)
        associate (segment => program%segments(i))
          all = [all, segment%start + (segment%stop - segment%start)*breaks_of(segment%law), &
            segment%stop]
        end associate
      end do
    else
      all = program%spline%x
      if (program%spline%is_periodic) then
        period = all(size(all)) - all(1)
        all = [(program%spline%x + i*period, i=floor((from - all(1))/period), &
          floor((to - all(1))/period))]
      end if
    end if
    all = all(ascending_order(all))
    allocate (breaks(0))
    last = from
    do i = 1, size(all)
      if (all(i) <= last + same*(to - from) .or. all(i) >= to - same*(to - from)) cycle
      last = all(i)
      breaks = [breaks, last]
    end do
  end function program_breaks

  !> Shares of the time of a rise at which derivatives of its law jump, its end left out.
  pure function breaks_of(law) result(shares)
    integer, intent(in) :: law
    real(wp), allocatable :: shares(:)

    select case (law)
    case (law_parabolic)
      shares = [0.0_wp, 0.5_wp]
    case (law_modified_sine)
      shares = [0.0_wp, 0.125_wp, 0.875_wp]
    case (law_modified_trapezoid)
      shares = [0.0_wp, 0.125_wp, 0.375_wp, 0.625_wp, 0.875_wp]
    case default
      shares = [0.0_wp]
    end select
  end function breaks_of

end module motion_programs
