!> Drives that are given by other drives, whatever the lengths of links: they count as drives of the
!! linkage, but hold nothing.
module repeated_drives
  use kinds, only: wp
  use linkages, only: equation_t, linkage_t
  use plan_equations, only: append_drive_equations
  use pose_types, only: pose_of_pins, pose_t
  use singular_drawings, only: linearize
  implicit none (type, external)
  private

  public :: find_repeated_drive

contains

  !> The first drive whose coordinate is a sum of those of drives before it, and the one with the
  !! largest share in it.
  !!
  !! Gradients by the places of pins and angles of bodies, no parts holding these, depend on each
  !! other wherever pins are. They are found where no drawing has them.
  pure subroutine find_repeated_drive(linkage, number, first)
    type(linkage_t), intent(in) :: linkage !! planned
    integer, intent(out) :: number         !! of the drive; 0: there is none
    integer, intent(out) :: first          !! of the other one

    real(wp), parameter :: rounding = 1.0e-9_wp
    type(equation_t), allocatable :: equations(:)
    real(wp), allocatable :: matrix(:, :), misfits(:), basis(:, :), shares(:, :)
    real(wp) :: share, largest, unused
    integer :: i, k, n

    number = 0
    first = 0
    allocate (equations(0))
    call append_drive_equations(linkage, equations)
    n = size(equations)
    if (n < 2) return
    call linearize(linkage, equations, any_pose(linkage), 0.0_wp, matrix, misfits, unused)
    ! Rows made orthogonal, each a sum of the first ones.
    basis = matrix
    allocate (shares(n, n))
    shares = 0.0_wp
    do i = 1, n
      shares(i, i) = 1.0_wp
      do k = 1, i - 1
        share = dot_product(basis(i, :), basis(k, :))
        basis(i, :) = basis(i, :) - share*basis(k, :)
        shares(i, :) = shares(i, :) - share*shares(k, :)
      end do
      largest = norm2(basis(i, :))
      if (largest <= rounding) then
        number = equations(i)%number
        first = equations(maxloc(abs(shares(i, :i - 1)), dim=1))%number
        return
      end if
      basis(i, :) = basis(i, :)/largest
      shares(i, :) = shares(i, :)/largest
    end do
  end subroutine find_repeated_drive

  !> Pins and bodies where nothing is likely to be in one line.
  pure function any_pose(linkage) result(pose)
    type(linkage_t), intent(in) :: linkage
    type(pose_t) :: pose

    real(wp) :: pins(2, size(linkage%is_ground)), angle, span
    integer :: i

    span = maxval(linkage%bodies%length)
    do i = 1, size(pins, 2)
      pins(:, i) = span*[sin(2.3_wp*i), cos(3.7_wp*i + 1.0_wp)]
      if (linkage%is_ground(i)) pins(:, i) = linkage%ground_position(:, i)
    end do
    pose = pose_of_pins(linkage, pins)
    do i = 1, size(linkage%bodies)
      angle = 1.7_wp*i + 0.4_wp
      pose%direction(:, i) = [cos(angle), sin(angle)]
    end do
  end function any_pose

end module repeated_drives
