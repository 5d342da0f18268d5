!> Transforms element matrices and vectors between the element's axes and the global ones.
module element_axes
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: turned_to_global, to_local

contains

  !> An element matrix in global axes: `Tᵀ A T`, where T has the transpose of (2.75) at each node.
  !! Bubbles and shear strains keep the element's axes.
  pure function turned_to_global(matrix, direction) result(turned)
    real(wp), intent(in) :: matrix(:, :) !! (unknowns, unknowns) in the element's axes
    real(wp), intent(in) :: direction(2) !! unit vector along the element
    real(wp) :: turned(size(matrix, 1), size(matrix, 2))

    real(wp) :: t(2, 2)
    integer :: first(2), k

    t = rotation(direction)
    first = first_of_nodes(size(matrix, 1))
    turned = matrix
    do k = 1, 2
      turned(:, first(k):first(k) + 1) = matmul(turned(:, first(k):first(k) + 1), t)
    end do
    do k = 1, 2
      turned(first(k):first(k) + 1, :) = matmul(transpose(t), turned(first(k):first(k) + 1, :))
    end do
  end function turned_to_global

  !> Unknowns of an element in its own axes, from nodal displacements in global axes.
  pure function to_local(displacement, direction) result(local)
    real(wp), intent(in) :: displacement(:) !! (unknowns) nodal displacements in global axes
    real(wp), intent(in) :: direction(2)    !! unit vector along the element
    real(wp) :: local(size(displacement))

    integer :: first(2), k

    first = first_of_nodes(size(displacement))
    local = displacement
    do k = 1, 2
      local(first(k):first(k) + 1) = matmul(rotation(direction), &
        displacement(first(k):first(k) + 1))
    end do
  end function to_local

  !> Index of the first displacement of each node among the unknowns of an element.
  pure function first_of_nodes(unknowns) result(first)
    integer, intent(in) :: unknowns
    integer :: first(2)

    first = [1, unknowns - 2]
  end function first_of_nodes

  !> Matrix that turns global components into those along and across the element.
  pure function rotation(direction) result(t)
    real(wp), intent(in) :: direction(2)
    real(wp) :: t(2, 2)

    t = reshape([direction(1), -direction(2), direction(2), direction(1)], [2, 2])
  end function rotation

end module element_axes
