! src/base/numerics/ - numerical methods: matrices, integration, series, least squares.
! Matrices of vibrations are bordered, those of nodal elements banded (`band_matrix.f90`), small
! ones full (`dense_factor.f90`). Begin with `bordered_matrix_t` here; with a `rate_system_t` and
! `advance` in `adaptive_integration.f90`; with `open_fourier` in `fourier_transform.f90`.
! Not here: solvers of eigenproblems (`src/eigen`).

!> Symmetric bordered block-diagonal matrices: a few border unknowns are coupled to all unknowns,
!! the others to the border and within their own block only.
!!
!! Order of unknowns: the border, then block after block, then single unknowns that are coupled to
!! the border only. Linkages have this form once the own vibrations of each link are separated from
!! the deformations that displace its pins.
module bordered_matrix
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: bordered_matrix_t, layout_t, new_bordered_layout, new_bordered_matrix, all_unknowns
  public :: bordered_times_vector, dense_form, add_scaled

  !> The order of the unknowns.
  type :: layout_t
    integer :: border = 0            !! unknowns of the border
    integer, allocatable :: first(:) !! (blocks) number of a block's first unknown
    integer, allocatable :: size(:)  !! (blocks) unknowns of a block
    integer, allocatable :: group(:) !! (groups) unknowns of each group after the blocks
    integer :: unknowns = 0          !! all of them
    integer :: free = 0              !! free motions: so many of the last unknowns of the border
                                     !! deform nothing
  end type layout_t

  type :: bordered_matrix_t
    real(wp), allocatable :: border(:, :)   !! (border, border)
    real(wp), allocatable :: coupling(:, :) !! (border, unknowns) rows of the border; the columns of
                                            !! the border itself are not used
    real(wp), allocatable :: diagonal(:)    !! (unknowns) beyond the border; added to that of the
                                            !! blocks
    real(wp), allocatable :: block(:, :, :) !! (largest block, largest block, blocks); empty:
                                            !! diagonal beyond the border
  end type bordered_matrix_t

contains

  !> The order of unknowns from the sizes of its parts.
  pure function new_bordered_layout(border, blocks, singles, free) result(layout)
    integer, intent(in) :: border         !! unknowns of the border
    integer, intent(in) :: blocks(:)      !! (blocks) unknowns of each block
    integer, intent(in) :: singles(:)     !! (groups) unknowns of each group after the blocks
    integer, intent(in), optional :: free !! the last unknowns of the border that are free motions;
                                          !! absent: none
    type(layout_t) :: layout

    integer :: i

    layout%border = border
    layout%size = blocks
    layout%group = singles
    layout%first = [(border + 1 + sum(blocks(:i - 1)), i=1, size(blocks))]
    layout%unknowns = border + sum(blocks) + sum(singles)
    if (present(free)) layout%free = free
  end function new_bordered_layout

  !> A zero matrix.
  pure function new_bordered_matrix(layout, with_blocks) result(matrix)
    type(layout_t), intent(in) :: layout !! order of unknowns
    logical, intent(in) :: with_blocks   !! false: diagonal beyond the border
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
    type(layout_t), intent(in) :: layout          !! of the matrix
    type(bordered_matrix_t), intent(in) :: matrix !! with or without blocks
    real(wp), intent(in) :: vector(:)             !! (unknowns)
    real(wp), intent(out) :: product(:)           !! (unknowns)

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

  !> `sum = sum + factor matrix`; either both matrices have blocks or neither has.
  pure subroutine add_scaled(sum, factor, matrix)
    type(bordered_matrix_t), intent(inout) :: sum !! of the same layout
    real(wp), intent(in) :: factor                !! any
    type(bordered_matrix_t), intent(in) :: matrix !! added

    sum%border = sum%border + factor*matrix%border
    sum%coupling = sum%coupling + factor*matrix%coupling
    sum%diagonal = sum%diagonal + factor*matrix%diagonal
    sum%block = sum%block + factor*matrix%block
  end subroutine add_scaled

  !> Rows and columns of the chosen unknowns, as a full matrix.
  pure function dense_form(layout, matrix, chosen) result(dense)
    type(layout_t), intent(in) :: layout          !! of the matrix
    type(bordered_matrix_t), intent(in) :: matrix !! with or without blocks
    integer, intent(in) :: chosen(:)              !! numbers of unknowns
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

  !> The numbers of all unknowns, for `dense_form`.
  pure function all_unknowns(layout) result(chosen)
    type(layout_t), intent(in) :: layout !! order of unknowns
    integer :: chosen(layout%unknowns)

    integer :: i

    chosen = [(i, i=1, layout%unknowns)]
  end function all_unknowns

end module bordered_matrix
