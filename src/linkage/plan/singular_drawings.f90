!> Drawings that close where the equations of the links depend on each other: at this position, or
!! at every one.
module singular_drawings
  use constants, only: degree
  use coordinate_types, only: gradients_t
  use dense_factor, only: dense_factor_t, factorize, solve
  use group_equations, only: farthest_arm, find_gradients
  use kinds, only: wp
  use linkages, only: drive_of_nothing, follows_angle, equation_t, linkage_t, reference_point, &
    turned
  use plan_equations, only: append_drive_equations, list_joint_equations
  use pose_types, only: drawn_pose, pose_t
  implicit none (type, external)
  private

  public :: find_singularity, linearize

contains

  !> Whether a drawing closes, and its equations depend on each other there and wherever the first
  !! drive moves from it; and which bodies they leave free to turn.
  pure subroutine find_singularity(linkage, crank, everywhere, turns)
    type(linkage_t), intent(in) :: linkage !! with its drawing
    real(wp), intent(in) :: crank          !! coordinate of the first drive there [deg] or [m]
    logical, intent(out) :: everywhere
    logical, allocatable, intent(out) :: turns(:) !! (bodies)

    !> Drawings have six digits, places found here more; turns of others are below this share.
    real(wp), parameter :: drawn = 1.0e-6_wp, found = 1.0e-9_wp, little = 0.1_wp
    !> Least singular values below this are none.
    real(wp), parameter :: least = 1.0e-4_wp
    !> How far the first drive is moved [rad], or as a share of the linkage.
    real(wp), parameter :: ways(*) = [0.0_wp, 0.05_wp, -0.05_wp, 0.1_wp, -0.1_wp]
    type(equation_t), allocatable :: equations(:)
    type(pose_t) :: start, pose
    real(wp), allocatable :: vector(:)
    real(wp) :: misfit, value, unit, span
    integer :: i, moved

    everywhere = .false.
    allocate (turns(size(linkage%bodies)))
    turns = .false.
    if (.not. all(linkage%drawing%is_drawn .or. linkage%is_ground)) return
    start = drawn_pose(linkage, reference_point(linkage))
    do i = 1, size(linkage%is_ground)
      if (linkage%is_ground(i)) start%pin(:, i) = linkage%ground_position(:, i) - start%origin
    end do
    call list_joint_equations(linkage, equations)
    call append_drive_equations(linkage, equations)
    span = max(maxval(abs(start%pin)), maxval(linkage%bodies%length))
    unit = span
    if (follows_angle(linkage)) unit = 1.0_wp/degree
    if (linkage%drives(1)%kind == drive_of_nothing) unit = 0.0_wp
    moved = 0
    do i = 1, size(ways)
      pose = start
      call improve(linkage, equations, crank + ways(i)*unit, merge(0, 30, i == 1), pose, misfit, &
        value, vector)
      if (misfit > span*merge(drawn, found, i == 1)) then
        if (i == 1) return
        cycle
      end if
      if (value > least) return
      if (i > 1) moved = moved + 1
      if (i == 1) turns = abs(vector(2*size(start%pin, 2) + 1:)) > little*maxval(abs(vector))
    end do
    everywhere = moved > 0
  end subroutine find_singularity

  !> Gauss and Newton's method, damped so that dependent equations do no harm; the misfit that is
  !! left, and the least singular value with its vector.
  pure subroutine improve(linkage, equations, crank, iterations, pose, misfit, value, vector)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equations(:)
    real(wp), intent(in) :: crank
    integer, intent(in) :: iterations
    type(pose_t), intent(inout) :: pose
    real(wp), intent(out) :: misfit !! [m]
    real(wp), intent(out) :: value  !! of the matrix with rows of length one
    real(wp), allocatable, intent(out) :: vector(:) !! two of each pin, one of each body

    real(wp), parameter :: damping = 1.0e-10_wp
    real(wp), allocatable :: matrix(:, :), misfits(:), step(:)
    type(dense_factor_t) :: factor
    integer :: i

    do i = 0, iterations
      call linearize(linkage, equations, pose, crank, matrix, misfits, misfit)
      call factorize(normal_matrix(matrix, damping), factor)
      if (i == iterations) exit
      step = -solve(factor, matmul(misfits, matrix))
      call move(linkage, step, pose)
    end do
    ! Not across any vector that geometry makes likely.
    vector = [(1.0_wp + 0.37_wp*sin(2.3_wp*i), i=1, size(matrix, 2))]
    do i = 1, 20
      vector = solve(factor, vector)
      vector = vector/norm2(vector)
    end do
    value = norm2(matmul(matrix, vector))
  end subroutine improve

  pure function normal_matrix(matrix, damping) result(normal)
    real(wp), intent(in) :: matrix(:, :)
    real(wp), intent(in) :: damping
    real(wp) :: normal(size(matrix, 2), size(matrix, 2))

    integer :: i

    normal = matmul(transpose(matrix), matrix)
    ! A ground pivot has no equations: it does not move.
    do i = 1, size(normal, 1)
      normal(i, i) = normal(i, i) + merge(damping, 1.0_wp, any(abs(matrix(:, i)) > 0.0_wp))
    end do
  end function normal_matrix

  !> Gradients by all unknowns with rows of length one, ground pivots having none, and misfits by
  !! the same factors.
  pure subroutine linearize(linkage, equations, pose, crank, matrix, misfits, largest)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equations(:)
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: crank
    real(wp), allocatable, intent(out) :: matrix(:, :) !! (equations, unknowns)
    real(wp), allocatable, intent(out) :: misfits(:)
    real(wp), intent(out) :: largest                   !! misfit [m]

    type(gradients_t) :: gradients
    real(wp) :: row
    integer :: i, k, first_angle

    first_angle = 2*size(pose%pin, 2)
    allocate (matrix(size(equations), first_angle + size(linkage%bodies)), &
      misfits(size(equations)))
    matrix = 0.0_wp
    largest = 0.0_wp
    call find_gradients(linkage, pose, equations, gradients, crank, misfits)
    do i = 1, size(equations)
      do k = gradients%last(i - 1) + 1, gradients%last(i)
        associate (partial => gradients%partial(k))
          if (partial%pin > 0) then
            associate (at => 2*partial%pin)
              if (.not. linkage%is_ground(partial%pin)) matrix(i, at - 1:at) = matrix(i, &
                at - 1:at) + partial%by_pin
            end associate
          end if
          if (partial%body > 0) then
            associate (at => first_angle + partial%body)
              matrix(i, at) = matrix(i, at) + partial%by_angle/farthest_arm(linkage%bodies( &
                partial%body))
            end associate
          end if
        end associate
      end do
      row = norm2(matrix(i, :))
      if (.not. row > 0.0_wp) row = 1.0_wp
      matrix(i, :) = matrix(i, :)/row
      misfits(i) = misfits(i)/row
      largest = max(largest, abs(misfits(i)))
    end do
  end subroutine linearize

  pure subroutine move(linkage, step, pose)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: step(:)
    type(pose_t), intent(inout) :: pose

    real(wp) :: angle
    integer :: i, first_angle

    first_angle = 2*size(pose%pin, 2)
    do i = 1, size(pose%pin, 2)
      pose%pin(:, i) = pose%pin(:, i) + step(2*i - 1:2*i)
    end do
    do i = 1, size(linkage%bodies)
      angle = step(first_angle + i)/farthest_arm(linkage%bodies(i))
      pose%direction(:, i) = turned(pose%direction(:, i), [cos(angle), sin(angle)])
      pose%direction(:, i) = pose%direction(:, i)/norm2(pose%direction(:, i))
    end do
  end subroutine move

end module singular_drawings
