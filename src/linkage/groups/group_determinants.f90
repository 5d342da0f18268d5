!> Scaled determinants of groups at any pose: zero at a dead point; their signs are the branches.
module group_determinants
  use dense_factor, only: least_singular_value
  use group_equations, only: line_axis
  use group_factors, only: factorize_group, group_factors_t
  use kinds, only: wp
  use linkages, only: cross, group_by_newton, group_cross_slide, group_driven_dyad, &
    group_dyad, group_on_line, group_through_pin, group_two_lines, linkage_t
  use pose_types, only: pose_t
  use poses, only: arm_to_middle
  implicit none (type, external)
  private

  public :: determinants_of, determinant_of

contains

  !> The determinants of all groups.
  pure function determinants_of(linkage, pose) result(determinants)
    type(linkage_t), intent(in) :: linkage !! with its plan
    type(pose_t), intent(in) :: pose       !! pins and directions
    real(wp) :: determinants(size(linkage%groups))

    integer :: i

    do i = 1, size(determinants)
      determinants(i) = determinant_of(linkage, pose, i)
    end do
  end function determinants_of

  !> The determinant of a group: of two bodies, of a body and a line, and of two lines the sine or
  !! cosine of the angle at which their loci meet; of groups by iterations the smallest singular
  !! value of their equations, rows of length one, with the sign of their determinant, as a share
  !! of its usual size; 1 of what has no dead point.
  pure function determinant_of(linkage, pose, number) result(determinant)
    type(linkage_t), intent(in) :: linkage !! with its plan
    type(pose_t), intent(in) :: pose       !! pins and directions
    integer, intent(in) :: number          !! of the group, from 1
    real(wp) :: determinant

    type(group_factors_t) :: factors
    real(wp) :: way(2)

    determinant = 1.0_wp
    associate (group => linkage%groups(number))
      select case (group%kind)
      case (group_dyad, group_driven_dyad)
        determinant = cross(arm_to_middle(linkage, group, pose, 1), arm_to_middle(linkage, group, &
          pose, 2))
      case (group_on_line)
        way = pose%pin(:, group%middle) - pose%pin(:, group%base(1))
        determinant = dot_product(line_axis(linkage, pose, group%slider(1)), way)/norm2(way)
      case (group_through_pin)
        way = pose%pin(:, group%middle) - pose%pin(:, group%base(1))
        determinant = dot_product(line_axis(linkage, pose, group%slider(1)), way)/ &
          max(linkage%bodies(group%body(1))%length, norm2(way))
      case (group_two_lines, group_cross_slide)
        determinant = cross(line_axis(linkage, pose, group%slider(1)), line_axis(linkage, pose, &
          group%slider(2)))
      case (group_by_newton)
        call factorize_group(linkage, group, pose, factors)
        determinant = least_singular_value(factors%factor)/group%usual
      end select
    end associate
  end function determinant_of

end module group_determinants
