!> A symmetric matrix of few border unknowns and many others that meet each other in blocks only.
!!
!! Unknowns are numbered: the border, then block after block, then those that meet nothing but the
!! border and themselves. Linkages have this form once the own vibrations of every link are told
!! apart from what moves the pins.
module bordered_matrix
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: bordered_matrix_t, layout_t, new_layout, new_bordered_matrix, all_unknowns
  public :: bordered_times_vector, dense_form, add_scaled

  !> How the unknowns are divided.
  type :: layout_t
    integer :: border = 0             !! unknowns of the border
    integer, allocatable :: first(:)  !! (blocks) number of a block's first unknown
    integer, allocatable :: size(:)   !! (blocks)
    integer, allocatable :: group(:)  !! sizes of the groups in which the unknowns after the blocks
                                      !! come
    integer :: unknowns = 0           !! all of them
  end type layout_t

  type :: bordered_matrix_t
    real(wp), allocatable :: border(:, :)    !! (border, border)
    real(wp), allocatable :: coupling(:, :)  !! (border, unknowns) rows of the border beyond itself;
                                             !! its first columns are not used
    real(wp), allocatable :: diagonal(:)     !! (unknowns) beyond the border, besides that of the
                                             !! blocks
    real(wp), allocatable :: block(:, :, :)  !! (largest block, largest block, blocks); no blocks: a
                                             !! diagonal
  end type bordered_matrix_t

contains

  pure function new_layout(border, blocks, singles) result(layout)
    integer, intent(in) :: border
    integer, intent(in) :: blocks(:) !! sizes
    integer, intent(in) :: singles(:) !! sizes of the groups of unknowns after the blocks
    type(layout_t) :: layout

    integer :: i

    layout%border = border
    layout%size = blocks
    layout%group = singles
    layout%first = [(border + 1 + sum(blocks(:i - 1)), i=1, size(blocks))]
    layout%unknowns = border + sum(blocks) + sum(singles)
  end function new_layout

  !> A matrix of zeros.
  pure function new_bordered_matrix(layout, with_blocks) result(matrix)
    type(layout_t), intent(in) :: layout
    logical, intent(in) :: with_blocks
    type(bordered_matrix_t) :: matrix

    integer :: largest

    allocate (matrix%border(layout%border, layout%border), matrix%coupling(layout%border, &
      layout%unknowns))
    allocate (matrix%diagonal(layout%unknowns))
    matrix%border = 0.0_wp
    matrix%coupling = 0.0_wp
    matrix%diagonal = 0.0_wp
    largest = merge(maxval(layout%size), 0, with_blocks)
    allocate (matrix%block(largest, largest, merge(size(layout%size), 0, with_blocks)))
    matrix%block = 0.0_wp
  end function new_bordered_matrix

  !> `product = matrix vector`
  pure subroutine bordered_times_vector(layout, matrix, vector, product)
    type(layout_t), intent(in) :: layout
    type(bordered_matrix_t), intent(in) :: matrix
    real(wp), intent(in) :: vector(:)   !! (unknowns)
    real(wp), intent(out) :: product(:) !! (unknowns)

    real(wp) :: on_border(layout%border), total
    integer :: i, j, k, first, m

    on_border = matmul(matrix%border, vector(:layout%border))
    do k = layout%border + 1, layout%unknowns
      total = matrix%diagonal(k)*vector(k)
      do i = 1, layout%border
        total = total + matrix%coupling(i, k)*vector(i)
        on_border(i) = on_border(i) + matrix%coupling(i, k)*vector(k)
      end do
      product(k) = total
    end do
    product(:layout%border) = on_border
    do i = 1, size(matrix%block, 3)
      first = layout%first(i)
      m = layout%size(i)
      do j = 1, m
        product(first:first + m - 1) = product(first:first + m - 1) + &
          vector(first + j - 1)*matrix%block(:m, j, i)
      end do
    end do
  end subroutine bordered_times_vector

  !> `sum = sum + factor matrix`; both have blocks or both have none.
  pure subroutine add_scaled(sum, factor, matrix)
    type(bordered_matrix_t), intent(inout) :: sum
    real(wp), intent(in) :: factor
    type(bordered_matrix_t), intent(in) :: matrix

    sum%border = sum%border + factor*matrix%border
    sum%coupling = sum%coupling + factor*matrix%coupling
    sum%diagonal = sum%diagonal + factor*matrix%diagonal
    sum%block = sum%block + factor*matrix%block
  end subroutine add_scaled

  !> Rows and columns of some unknowns, as a full matrix.
  pure function dense_form(layout, matrix, chosen) result(dense)
    type(layout_t), intent(in) :: layout
    type(bordered_matrix_t), intent(in) :: matrix
    integer, intent(in) :: chosen(:) !! numbers of unknowns
    real(wp) :: dense(size(chosen), size(chosen))

    real(wp) :: unit(layout%unknowns), column(layout%unknowns)
    integer :: j

    do j = 1, size(chosen)
      unit = 0.0_wp
      unit(chosen(j)) = 1.0_wp
      call bordered_times_vector(layout, matrix, unit, column)
      dense(:, j) = column(chosen)
    end do
  end function dense_form

  pure function all_unknowns(layout) result(chosen)
    type(layout_t), intent(in) :: layout
    integer :: chosen(layout%unknowns)

    integer :: i

    chosen = [(i, i=1, layout%unknowns)]
  end function all_unknowns

end module bordered_matrix
