!> The unknowns of the polynomial orders beyond those in use in a continuous link, for estimating
!! how much they would change.
!!
!! They are local: none reaches beyond its piece of the link (an element between masses), and they
!! vanish at its ends. Between the pieces of a link they are therefore coupled only by way of the
!! unknowns in use, and jumps of the axial force are at the ends of pieces.
module next_orders
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: next_orders_t, new_next_orders, orders_beyond, smooth_functions

  !> Number of orders beyond those in use: two pairs, either with both symmetries. The second pair
  !! relative to the first shows how fast the series falls.
  integer, parameter :: orders_beyond = 4

  !> Axial forces of continuous links without their jumps: 1, ξ, ξ².
  integer, parameter :: smooth_functions = 3

  type :: next_orders_t
    integer :: pieces = 0  !! 0: not known, for a mesh of several elements
    integer :: number = 0  !! of unknowns in each piece, lowest orders first
    real(wp), allocatable :: mass(:, :)             !! (modes, unknowns of all pieces) with the own
                                                    !! modes [s²]
    real(wp), allocatable :: participation(:, :)    !! (functions, unknowns) with 1 − ξ, ξ and,
                                                    !! across, the curves of held ends
    real(wp), allocatable :: mass_square(:, :, :)   !! (number, number, pieces) between each other
                                                    !! [s²]
    real(wp), allocatable :: geometric(:, :, :)     !! (1 + curves + modes, unknowns, 1 ξ ξ²) `∫ b
                                                    !! v' v'`; across only
    real(wp), allocatable :: geometric_square(:, :, :, :) !! (number, number, pieces, 1 ξ ξ²)
    !> Frobenius norms of the parts of `mass`, `participation` and `geometric` in each piece
    real(wp), allocatable :: mass_norm(:)           !! (pieces) [s²]
    real(wp), allocatable :: participation_norm(:)  !! (pieces)
    real(wp), allocatable :: geometric_norm(:, :)   !! (1 ξ ξ², pieces)
    logical, allocatable :: reached(:, :)           !! (pieces, jumps) whether the force that ends
                                                    !! at the jump acts in the piece
  end type next_orders_t

contains

  !> The unknowns beyond those in use, and what they have to do with these.
  pure function new_next_orders(shapes, displacement, functions, slope, jumps) result(next)
    type(deformation_shapes_t), intent(in) :: shapes !! ordered by degree
    real(wp), intent(in) :: displacement(:, :)  !! (coefficients, modes) of the own modes
    real(wp), intent(in) :: functions(:, :)     !! (coefficients, functions) imposed by the pins
    real(wp), intent(in) :: slope(:, :)         !! (Gauss points, 1 + curves + modes) with the root
                                                !! of the weight; no columns: axial
    real(wp), intent(in) :: jumps(:)            !! ξ where the axial force jumps
    type(next_orders_t) :: next

    real(wp), allocatable :: of_force(:, :), shape(:, :)
    integer, allocatable :: own(:)
    integer :: e, first, j, last, row, low, high

    next%pieces = shapes%elements
    next%number = (shapes%unknowns - shapes%kept)/shapes%elements
    allocate (next%mass_square(next%number, next%number, next%pieces))
    allocate (next%mass(size(displacement, 2), next%number*next%pieces))
    allocate (next%participation(size(functions, 2), next%number*next%pieces))
    allocate (next%geometric(size(slope, 2), next%number*next%pieces, merge(smooth_functions, 0, &
      size(slope, 2) > 0)))
    allocate (next%geometric_square(next%number, next%number, next%pieces, size(next%geometric, 3)))
    allocate (next%reached(next%pieces, size(jumps)))
    allocate (next%mass_norm(next%pieces), next%participation_norm(next%pieces))
    allocate (next%geometric_norm(size(next%geometric, 3), next%pieces))
    do e = 1, next%pieces
      own = next_columns(shapes, e, next%number)
      low = (e - 1)*next%number + 1
      high = e*next%number
      shape = shapes%displacement(:, own)
      next%mass(:, low:high) = matmul(transpose(displacement), shape)
      next%participation(:, low:high) = matmul(transpose(functions), shape)
      next%mass_norm(e) = norm2(next%mass(:, low:high))
      next%participation_norm(e) = norm2(next%participation(:, low:high))
      next%mass_square(:, :, e) = matmul(transpose(shape), shape)
      ! The middle of the piece decides: rounding may put a jump beside the end of its piece.
      next%reached(e, :) = shapes%middle(e) < shapes%elements*jumps
      if (size(slope, 2) == 0) cycle
      first = shapes%first_point(e)
      last = shapes%first_point(e + 1) - 1
      do j = 1, smooth_functions
        of_force = shapes%slope(first:last, own)
        do row = 1, last - first + 1
          of_force(row, :) = shapes%place(first + row - 1)**(j - 1)*of_force(row, :)
        end do
        next%geometric(:, low:high, j) = matmul(transpose(slope(first:last, :)), of_force)
        next%geometric_norm(j, e) = norm2(next%geometric(:, low:high, j))
        next%geometric_square(:, :, e, j) = matmul(transpose(shapes%slope(first:last, own)), &
          of_force)
      end do
    end do
  end function new_next_orders

  !> Columns of the unknowns beyond those in use in a piece, lowest orders first.
  pure function next_columns(shapes, piece, number) result(columns)
    type(deformation_shapes_t), intent(in) :: shapes
    integer, intent(in) :: piece, number
    integer :: columns(number)

    integer :: i, j, kinds, found

    kinds = number/orders_beyond
    found = 0
    do j = 0, ubound(shapes%column, 1)
      if (shapes%column(j, piece) <= shapes%kept .or. found == number) cycle
      columns(found + 1:found + kinds) = shapes%column(j, piece) + [(i, i=0, kinds - 1)]
      found = found + kinds
    end do
  end function next_columns

end module next_orders
