! src/base/motions/ - motions over time: what a drive is led by.
! Begin with `motion_program_t` here: segments of `motion_laws.f90`, a spline, or a formula, whose
! steps `time_formulas.f90` has with their derivatives.
! Not here: the splines (`src/base/numerics/cubic_splines.f90`); how a formula is read
! (`src/deck/language/expressions.f90`); which drive has which (`src/model/checks/law_checks.f90`).

!> Motion programs: a position over time by segments with dwells between them, by a cubic spline
!! through a table, or by a formula, and the instants at which its derivatives jump.
module motion_programs
  use cubic_splines, only: cubic_spline_t, spline_values
  use kinds, only: wp
  use motion_laws, only: law_modified_sine, law_modified_trapezoid, law_parabolic, &
    motion_segment_t, motion_values
  use sorting, only: ascending_order
  use time_formulas, only: formula_values, time_formula_t
  implicit none (type, external)
  private

  public :: motion_program_t, program_values, program_values_inside, program_breaks, &
    program_period

  !> Positions in any unit u.
  type :: motion_program_t
    type(motion_segment_t), allocatable :: segments(:) !! one after another; not allocated: a
                                      !! formula or a table
    type(time_formula_t) :: formula   !! without steps: a table
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
    else if (allocated(program%formula%steps)) then
      values = formula_values(program%formula, time)
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
    real(wp) :: last, period, range(2)
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
      all = [0.0_wp]
      if (allocated(program%spline%x)) all = program%spline%x
      range = program_period(program)
      period = range(2) - range(1)
      if (period > 0.0_wp) then
        all = [(all + i*period, i=floor((from - range(1))/period), floor((to - range(1))/period))]
      else if (allocated(program%formula%steps)) then
        all = [real(wp) ::]
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

  !> The first period of what repeats, from time to time; of what does not, no time.
  pure function program_period(program) result(range)
    type(motion_program_t), intent(in) :: program
    real(wp) :: range(2) !! [s]

    range = 0.0_wp
    if (allocated(program%formula%steps)) then
      range(2) = program%formula%period
    else if (program%spline%is_periodic) then
      range = program%spline%x([1, size(program%spline%x)])
    end if
  end function program_period

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
