!> Reactions at a speed, from those to unit loads.
module total_reactions
  use kinds, only: wp
  use load_cases, only: case_count
  use reactions, only: reactions_t, unit_reactions_t
  implicit none (type, external)
  private

  public :: reactions_at

contains

  !> `ω2² of turning + α2 of speeding up + constant`
  pure function reactions_at(unit, speed, acceleration) result(total)
    type(unit_reactions_t), intent(in) :: unit
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    type(reactions_t) :: total

    real(wp) :: factor(case_count)
    integer :: i

    factor = [speed**2, acceleration, 1.0_wp]
    allocate (total%joints%on_first, mold=unit%of_case(1)%joints%on_first)
    allocate (total%joints%on_last, mold=unit%of_case(1)%joints%on_last)
    total%joints%on_first = 0.0_wp
    total%joints%on_last = 0.0_wp
    do i = 1, case_count
      associate (part => unit%of_case(i))
        total%joints%on_first = total%joints%on_first + factor(i)*part%joints%on_first
        total%joints%on_last = total%joints%on_last + factor(i)*part%joints%on_last
        total%joints%torque = total%joints%torque + factor(i)*part%joints%torque
        total%shaking_force = total%shaking_force + factor(i)*part%shaking_force
        total%shaking_moment = total%shaking_moment + factor(i)*part%shaking_moment
      end associate
    end do
  end function reactions_at

end module total_reactions
