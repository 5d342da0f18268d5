!> Starts for the modes at a position, extrapolated from neighbouring positions.
module start_extrapolation
  use bordered_eigensolver, only: bordered_modes_t, new_start, start_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: track_t, extrapolated_start, remember

  !> Number of positions remembered: a parabola through three.
  integer, parameter :: depth = 3

  !> The modes at the last positions of a sweep, every mode with a consistent sign.
  type :: track_t
    integer :: length = 0                       !! number of positions remembered
    real(wp) :: place(depth) = 0.0_wp           !! their crank angles, the latest first [deg]
    real(wp), allocatable :: lambda(:, :)       !! (modes, depth) [1/s²]
    real(wp), allocatable :: direction(:, :, :) !! (unknowns, modes, depth) M y
  end type track_t

contains

  !> Modes expected at a place, by the Lagrange polynomial through those remembered. No start if the
  !! last position is farther away than `reach`; of the others, only those within three times
  !! `reach` are used.
  pure function extrapolated_start(track, place, reach) result(start)
    type(track_t), intent(in) :: track !! latest positions
    real(wp), intent(in) :: place      !! crank angle [deg]
    real(wp), intent(in) :: reach      !! longest step [deg]
    type(start_t) :: start

    real(wp) :: weight(depth)
    integer :: i, j, used

    if (track%length == 0) then
      start = new_start()
      return
    end if
    used = count(abs(track%place(:track%length) - place) <= depth*reach)
    if (abs(track%place(1) - place) > reach .or. used == 0) then
      start = new_start()
      return
    end if
    start%modes = size(track%lambda, 1)
    weight = 1.0_wp
    do i = 1, used
      do j = 1, used
        if (j /= i) weight(i) = weight(i)*(place - track%place(j))/(track%place(i) - track%place(j))
      end do
    end do
    start%lambda = weight(1)*track%lambda(:, 1)
    start%direction = weight(1)*track%direction(:, :, 1)
    do i = 2, used
      start%lambda = start%lambda + weight(i)*track%lambda(:, i)
      start%direction = start%direction + weight(i)*track%direction(:, :, i)
    end do
  end function extrapolated_start

  !> Adds the modes found at a place to a track. Modes that do not come from this track start it
  !! again.
  pure subroutine remember(track, place, found, from_track)
    type(track_t), intent(inout) :: track       !! of a sweep
    real(wp), intent(in) :: place               !! crank angle [deg]
    type(bordered_modes_t), intent(in) :: found !! modes there
    logical, intent(in) :: from_track           !! the modes were found from a start of this track

    real(wp) :: sense
    integer :: i, modes

    modes = size(found%lambda)
    if (.not. from_track) then
      track%length = 0
      if (allocated(track%lambda)) deallocate (track%lambda, track%direction)
      allocate (track%lambda(modes, depth), track%direction(size(found%vector, 1), modes, depth))
    else if (modes < size(track%lambda, 1) .or. any(found%origin /= [(i, i=1, modes)])) then
      ! The order of the modes has changed, or some are no longer needed.
      track%lambda = track%lambda(found%origin, :)
      track%direction = track%direction(:, found%origin, :)
    end if
    do i = min(track%length, depth - 1), 1, -1
      track%place(i + 1) = track%place(i)
      track%lambda(:, i + 1) = track%lambda(:, i)
      track%direction(:, :, i + 1) = track%direction(:, :, i)
    end do
    track%place(1) = place
    do i = 1, modes
      sense = 1.0_wp
      if (from_track) sense = sign(1.0_wp, dot_product(found%vector(:, i), &
        track%direction(:, i, 1)))
      track%lambda(i, 1) = found%lambda(i)
      track%direction(:, i, 1) = sense*found%mass_times(:, i)
    end do
    track%length = min(track%length + 1, depth)
  end subroutine remember

end module start_extrapolation
