!> The equations of groups at a pose, factorized once for all right sides: velocities and
!! accelerations, positions by Newton's method and, with the transpose, forces of every load case.
module group_factors
  use coordinate_types, only: gradients_t
  use dense_factor, only: dense_factor_t, factorize
  use group_equations, only: farthest_arm, find_gradients
  use kinds, only: wp
  use linkages, only: group_carried, group_dyad, group_t, linkage_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: group_factors_t, factorize_group, factorize_groups, group_matrix

  type :: group_factors_t
    type(gradients_t) :: gradients    !! of its equations
    real(wp), allocatable :: scale(:) !! (bodies of the group) lengths with which their angles are
                                      !! multiplied, so that all unknowns are lengths: the farthest
                                      !! of their pins [m]
    type(dense_factor_t) :: factor    !! of `group_matrix`
  end type group_factors_t

contains

  !> Those of a group with equations.
  pure subroutine factorize_group(linkage, group, pose, factors, crank, misfits)
    type(linkage_t), intent(in) :: linkage        !! bodies, sliders, turns and drives
    type(group_t), intent(in) :: group            !! of this linkage
    type(pose_t), intent(in) :: pose              !! pins and directions
    type(group_factors_t), intent(out) :: factors !! of no use if its determinant is 0
    real(wp), intent(in), optional :: crank       !! as of `misfit_of`
    real(wp), intent(out), optional :: misfits(:) !! (equations) as of `find_gradients`

    integer :: i

    call find_gradients(linkage, pose, group%equations, factors%gradients, crank, misfits)
    allocate (factors%scale(size(group%bodies)))
    do i = 1, size(group%bodies)
      factors%scale(i) = farthest_arm(linkage%bodies(group%bodies(i)))
    end do
    call factorize(group_matrix(group, factors), factors%factor)
  end subroutine factorize_group

  !> Those of all groups whose velocities and forces have no closed form.
  pure subroutine factorize_groups(linkage, pose, factors)
    type(linkage_t), intent(in) :: linkage !! its groups
    type(pose_t), intent(in) :: pose       !! pins and directions
    type(group_factors_t), allocatable, intent(out) :: factors(:) !! (groups) empty of closed forms;
                                           !! not allocated if all have one

    integer :: i

    if (all(has_closed_form(linkage%groups))) return
    allocate (factors(size(linkage%groups)))
    do i = 1, size(factors)
      if (.not. has_closed_form(linkage%groups(i))) call factorize_group(linkage, &
        linkage%groups(i), pose, factors(i))
    end do
  end subroutine factorize_groups

  elemental function has_closed_form(group) result(has)
    type(group_t), intent(in) :: group
    logical :: has

    has = group%kind == group_dyad .or. group%kind == group_carried
  end function has_closed_form

  !> Gradients of the equations of a group by its unknowns: pins first, then angles by lengths.
  pure function group_matrix(group, factors) result(matrix)
    type(group_t), intent(in) :: group
    type(group_factors_t), intent(in) :: factors !! its gradients and scales
    real(wp) :: matrix(size(group%equations), size(group%equations))

    integer :: i, k, at, first_angle

    matrix = 0.0_wp
    first_angle = 2*size(group%pins)
    do i = 1, size(group%equations)
      do k = factors%gradients%last(i - 1) + 1, factors%gradients%last(i)
        associate (partial => factors%gradients%partial(k))
          at = findloc(group%pins, partial%pin, dim=1)
          if (at > 0) matrix(i, 2*at - 1:2*at) = matrix(i, 2*at - 1:2*at) + partial%by_pin
          at = findloc(group%bodies, partial%body, dim=1)
          if (at > 0) matrix(i, first_angle + at) = matrix(i, first_angle + at) + &
            partial%by_angle/factors%scale(at)
        end associate
      end do
    end do
  end function group_matrix

end module group_factors
