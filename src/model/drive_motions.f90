!> How the first drive moves at a row of a table: with a speed of the deck, the same at all
!! positions, or as its law says at this instant. All reports and studies take it from here. Of a
!! linkage that runs in time what it is moved by is the time, and tables show the first drive.
module drive_motions
  use kinds, only: wp
  use models, only: has_law, model_t, runs_in_time
  use units, only: from_si
  implicit none (type, external)
  private

  public :: drive_rates, place_columns, table_place, first_position

contains

  !> Speed and acceleration of the first drive, q̇ and q̈; of the time 1 and 0.
  pure function drive_rates(model, speed, position) result(rates)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: speed       !! number in the deck's list; of a law 1
    integer, intent(in) :: position    !! number in the deck's list; of a law that of the instant
    real(wp) :: rates(2)               !! [rad/s, rad/s²], of a slider or a ram [m/s, m/s²]

    if (runs_in_time(model)) then
      rates = [1.0_wp, 0.0_wp]
    else if (has_law(model)) then
      rates = model%law_rates(:, position)
    else
      rates = [model%speed%value(speed), model%acceleration]
    end if
  end function drive_rates

  !> How many columns of a table of positions say where a row is.
  pure function place_columns(model) result(columns)
    type(model_t), intent(in) :: model !! as read
    integer :: columns

    columns = merge(3, 2, has_law(model))
  end function place_columns

  !> Where a row is: speed and position of the first drive, of a law after the time.
  pure function table_place(model, speed, position) result(place)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: speed       !! as for `drive_rates`
    integer, intent(in) :: position    !! as for `drive_rates`
    real(wp) :: place(place_columns(model)) !! the time in s, the speed as tables show it, the
                                            !! position in degrees, of a slider or a ram in m

    if (has_law(model)) then
      place = [model%time%value(position), from_si(model%law_rates(1, position), &
        model%speed_unit), first_position(model, position)]
    else
      place = [model%shown_speed(speed), first_position(model, position)]
    end if
  end function table_place

  !> The position of the first drive.
  pure function first_position(model, position) result(place)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: position    !! as for `drive_rates`
    real(wp) :: place                  !! [deg], of a slider or a ram [m]

    if (allocated(model%law_places)) then
      place = model%law_places(position)
    else
      place = model%crank%value(position)
    end if
  end function first_position

end module drive_motions
