!> Where the first drive is in the drawing of a linkage.
module drawn_cranks
  use constants, only: degree
  use group_equations, only: misfit_of
  use kinds, only: wp
  use linkage_paths, only: period_of
  use linkages, only: gives_angle, linkage_t
  use models, only: model_t, report_number, runs_in_time
  use plan_equations, only: drive_equation
  use pose_types, only: drawn_pose, pose_t
  implicit none (type, external)
  private

  public :: starting_cranks

contains

  !> Coordinates of the first drive from which the linkage may be followed [deg] or [m], in time
  !! instants [s]: that of the drawing, if there is one, then those of the deck, in its order.
  pure function starting_cranks(model, linkage) result(cranks)
    type(model_t), intent(in) :: model     !! its positions
    type(linkage_t), intent(in) :: linkage !! with its drives, planned
    real(wp), allocatable :: cranks(:)     !! one at least

    integer :: motion

    allocate (cranks(0))
    if (any(linkage%drawing%is_drawn .and. .not. linkage%is_ground) .or. model%is_structure) &
      cranks = [drawn_crank(model, linkage)]
    cranks = [cranks, model%crank%value]
    motion = report_number(model, "motion")
    if (motion > 0) cranks = [cranks, model%reports(motion)%start_angle]
    if (size(cranks) == 0) cranks = [0.0_wp]
  end function starting_cranks

  !> The coordinate of the first drive in the drawing [deg] or [m]; 0 where it is not drawn. A
  !! drawing shows no whole turns, but with drives geared to the first one they matter: those are
  !! taken that bring these nearest to the drawing. Beyond that, those are taken with which the
  !! drawing is nearest to the positions of the deck: a path that does not close has an end.
  pure function drawn_crank(model, linkage) result(crank)
    type(model_t), intent(in) :: model     !! its positions
    type(linkage_t), intent(in) :: linkage !! with its drives, planned
    real(wp) :: crank

    !> Turns that are looked at if there is no period.
    integer, parameter :: most_turns = 8
    !> Turns are told apart where the misfits of drives differ by more than this [rad].
    real(wp), parameter :: rounding = 1.0e-9_wp
    type(pose_t) :: pose
    real(wp) :: misfit, least, period
    integer :: turns, nearest, all_turns

    crank = 0.0_wp
    if (model%is_structure) return
    if (runs_in_time(model)) then
      crank = drawn_time(model, linkage)
      return
    end if
    ! The drive is off by the coordinate that is sought.
    pose = drawn_pose(linkage, [0.0_wp, 0.0_wp])
    crank = misfit_of(linkage, drive_equation(linkage, 1), pose, 0.0_wp)
    if (.not. gives_angle(linkage%drives(1))) return
    crank = crank/degree
    nearest = 0
    least = huge(least)
    period = period_of(linkage)
    all_turns = most_turns
    if (period > 0.0_wp) all_turns = nint(period/360.0_wp)
    do turns = 0, all_turns - 1
      misfit = misfit_of_drives(linkage, pose, crank + 360.0_wp*turns, 2)
      if (misfit > least - rounding) cycle
      least = misfit
      nearest = turns
    end do
    crank = near_positions(model, crank + 360.0_wp*nearest, period)
  end function drawn_crank

  !> The instant of the deck at which the drives are nearest to the drawing [s].
  pure function drawn_time(model, linkage) result(time)
    type(model_t), intent(in) :: model
    type(linkage_t), intent(in) :: linkage
    real(wp) :: time

    type(pose_t) :: pose
    real(wp) :: misfit, least
    integer :: i

    time = linkage%times(1)
    pose = drawn_pose(linkage, [0.0_wp, 0.0_wp])
    least = huge(least)
    do i = 1, size(model%crank%value)
      misfit = misfit_of_drives(linkage, pose, model%crank%value(i), 1)
      if (misfit >= least) cycle
      least = misfit
      time = model%crank%value(i)
    end do
  end function drawn_time

  !> A crank angle that is moved by whole periods to the positions of the deck, the first of those
  !! of CRANK and of REPORT motion that are there; to the nearest end of their range, or into it by
  !! as few periods as do.
  pure function near_positions(model, crank, period) result(near)
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: crank, period !! [deg]; period 0: there is none
    real(wp) :: near

    real(wp) :: lowest, highest
    integer :: report

    near = crank
    if (.not. period > 0.0_wp) return
    report = report_number(model, "motion")
    if (size(model%crank%value) > 0) then
      lowest = minval(model%crank%value)
      highest = maxval(model%crank%value)
    else if (report > 0) then
      lowest = model%reports(report)%start_angle
      highest = lowest
    else
      return
    end if
    if (crank < lowest) near = crank + period*floor((lowest - crank)/period + 0.5_wp)
    if (near < lowest .and. near + period <= highest) near = near + period
    if (crank > highest) near = crank - period*floor((crank - highest)/period + 0.5_wp)
    if (near > highest .and. near - period >= lowest) near = near - period
  end function near_positions

  !> How far drives are from a drawing, in radians, and in lengths of the largest body: of those
  !! from a number on all that move.
  pure function misfit_of_drives(linkage, drawn, crank, first) result(misfit)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: drawn
    real(wp), intent(in) :: crank !! [deg], in time [s]
    integer, intent(in) :: first  !! number
    real(wp) :: misfit

    real(wp) :: one
    integer :: i

    misfit = 0.0_wp
    do i = first, size(linkage%drives)
      if (.not. abs(linkage%drives(i)%ratio) > 0.0_wp) cycle
      one = abs(misfit_of(linkage, drive_equation(linkage, i), drawn, crank))
      if (.not. gives_angle(linkage%drives(i))) one = one/maxval(linkage%bodies%length)
      misfit = misfit + one
    end do
  end function misfit_of_drives

end module drawn_cranks
