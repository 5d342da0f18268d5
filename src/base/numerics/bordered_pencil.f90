!> The eigenproblem `K y = λ M y` of bordered matrices with `K = I + G`; free motions, which deform
!! nothing, have 0 in place of 1.
module bordered_pencil
  use bordered_matrix, only: bordered_matrix_t, bordered_times_vector, layout_t, new_bordered_matrix
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: bordered_pencil_t, new_bordered_pencil, stiffness_times_vector, elastic_square, &
    elastic_squares

  type :: bordered_pencil_t
    type(layout_t) :: layout             !! of both matrices
    type(bordered_matrix_t) :: mass      !! M, positive definite, diagonal in its blocks [s²]
    type(bordered_matrix_t) :: geometric !! G, with blocks [-]
    logical :: loaded = .false.          !! whether there is a G; if not, `geometric` is not used
  end type bordered_pencil_t

contains

  !> Zero matrices, without loads.
  pure function new_bordered_pencil(layout) result(pencil)
    type(layout_t), intent(in) :: layout !! of both matrices
    type(bordered_pencil_t) :: pencil

    pencil%layout = layout
    pencil%mass = new_bordered_matrix(layout, .false.)
    pencil%geometric = new_bordered_matrix(layout, .true.)
  end function new_bordered_pencil

  !> `product = K vector`
  pure subroutine stiffness_times_vector(pencil, vector, product)
    type(bordered_pencil_t), intent(in) :: pencil !! G, if loaded
    real(wp), intent(in) :: vector(:)             !! (unknowns)
    real(wp), intent(out) :: product(:)           !! (unknowns)

    integer :: stiff

    associate (border => pencil%layout%border)
      stiff = border - pencil%layout%free
      if (.not. pencil%loaded) then
        product = vector
        product(stiff + 1:border) = 0.0_wp
        return
      end if
      call bordered_times_vector(pencil%layout, pencil%geometric, vector, product)
      product(:stiff) = product(:stiff) + vector(:stiff)
      product(border + 1:) = product(border + 1:) + vector(border + 1:)
    end associate
  end subroutine stiffness_times_vector

  !> Twice the elastic energy of a vector: the sum of squares of all but free motions.
  pure function elastic_square(layout, vector) result(square)
    type(layout_t), intent(in) :: layout !! of the unknowns
    real(wp), intent(in) :: vector(:)    !! (unknowns) y
    real(wp) :: square                   !! of the unit of y²

    if (layout%free == 0) then
      square = dot_product(vector, vector)
    else
      associate (stiff => vector(:layout%border - layout%free), own => vector(layout%border + 1:))
        square = dot_product(stiff, stiff) + dot_product(own, own)
      end associate
    end if
  end function elastic_square

  !> The same of several vectors.
  pure function elastic_squares(layout, vectors) result(squares)
    type(layout_t), intent(in) :: layout !! of the unknowns
    real(wp), intent(in) :: vectors(:, :) !! (unknowns, number)
    real(wp) :: squares(size(vectors, 2))

    integer :: i

    squares = [(elastic_square(layout, vectors(:, i)), i=1, size(squares))]
  end function elastic_squares

end module bordered_pencil
