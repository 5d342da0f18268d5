!> Places of the second terminal along and across the line of the first: s = e·(P₂ − P₁) with the
!! unit vector e along the line, or its normal, both turning with the first terminal.
module lines
  use coordinate_types, only: frame_t, twist_t
  use kinds, only: wp
  use linkages, only: normal_to
  implicit none (type, external)
  private

  public :: line_value, line_axis, line_couple, line_acceleration

contains

  pure function line_value(frame, is_across) result(value)
    type(frame_t), intent(in) :: frame(2)
    logical, intent(in) :: is_across !! to the left of the line; else along it
    real(wp) :: value                !! [m]

    value = dot_product(line_axis(frame, is_across), frame(2)%place - frame(1)%place)
  end function line_value

  !> e, the force that an effort of 1 puts on the second terminal, and −e on the first.
  pure function line_axis(frame, is_across) result(axis)
    type(frame_t), intent(in) :: frame(2)
    logical, intent(in) :: is_across
    real(wp) :: axis(2)

    axis = frame(1)%direction
    if (is_across) axis = normal_to(axis)
  end function line_axis

  !> n·(P₂ − P₁), the couple that an effort of 1 puts on the first terminal besides, for e turns
  !! with n ω.
  pure function line_couple(frame, is_across) result(couple)
    type(frame_t), intent(in) :: frame(2)
    logical, intent(in) :: is_across
    real(wp) :: couple

    couple = dot_product(normal_to(line_axis(frame, is_across)), frame(2)%place - frame(1)%place)
  end function line_couple

  !> e·(a₂ − a₁) + 2 ω n·(v₂ − v₁) + α n·(P₂ − P₁) − ω² s.
  pure function line_acceleration(frame, twist, slope, is_across) result(acceleration)
    type(frame_t), intent(in) :: frame(2)
    type(twist_t), intent(in) :: twist(2), slope(2) !! velocities; accelerations
    logical, intent(in) :: is_across
    real(wp) :: acceleration

    real(wp) :: axis(2), normal(2), way(2)

    axis = line_axis(frame, is_across)
    normal = normal_to(axis)
    way = frame(2)%place - frame(1)%place
    associate (turn => twist(1)%turn)
      acceleration = dot_product(axis, slope(2)%velocity - slope(1)%velocity) + &
        2.0_wp*turn*dot_product(normal, twist(2)%velocity - twist(1)%velocity) + &
        slope(1)%turn*dot_product(normal, way) - turn**2*dot_product(axis, way)
    end associate
  end function line_acceleration

end module lines
