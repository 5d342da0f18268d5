!> What a coordinate or the position of a drive is: a length or an angle. Who reads its cards, or
!! shows it, asks these records for dimensions, units and words, and does not decide by itself.
module natures
  use units, only: dimension_acceleration, dimension_angle, dimension_angular_acceleration, &
    dimension_damping, dimension_force, dimension_length, dimension_line_damping, &
    dimension_line_stiffness, dimension_moment, dimension_rate, dimension_turning_stiffness, &
    dimension_velocity
  implicit none (type, external)
  private

  public :: nature_t, length_nature, angle_nature, all_natures, are_alike, is_angular
  public :: of_value, of_rate, of_acceleration, of_effort

  !> Places in `words`.
  integer, parameter :: of_value = 1, of_rate = 2, of_acceleration = 3, of_effort = 4

  type :: nature_t
    character(len=6) :: noun                        !! of the value, in messages
    character(len=6) :: effort_noun                 !! of what acts along it, in names of rows
    integer, dimension(4) :: value, rate, acceleration, effort, stiffness, damping !! dimensions
    character(len=12) :: words(4)                   !! for `table_unit`: of value, rate,
                                                    !! acceleration and effort
    character(len=6) :: in_ratio                    !! the same, of a change in a ratio
  end type nature_t

  type(nature_t), parameter :: length_nature = nature_t("length", "force", dimension_length, &
    dimension_velocity, dimension_acceleration, dimension_force, dimension_line_stiffness, &
    dimension_line_damping, [character(len=12) :: "length", "velocity", "acceleration", "force"], &
    "length")
  type(nature_t), parameter :: angle_nature = nature_t("angle", "torque", dimension_angle, &
    dimension_rate, dimension_angular_acceleration, dimension_moment, dimension_turning_stiffness, &
    dimension_damping, [character(len=12) :: "deg", "rate", "rad/s2", "moment"], "rad")

  type(nature_t), parameter :: all_natures(2) = [angle_nature, length_nature]

contains

  !> Whether all are the same.
  pure function are_alike(natures) result(are)
    type(nature_t), intent(in) :: natures(:)
    logical :: are

    are = all(natures(2:)%noun == natures(:size(natures) - 1)%noun)
  end function are_alike

  !> Whether it is an angle.
  elemental function is_angular(nature) result(is)
    type(nature_t), intent(in) :: nature
    logical :: is

    is = nature%noun == angle_nature%noun
  end function is_angular

end module natures
