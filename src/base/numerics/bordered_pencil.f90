!> The eigenproblem `(I + G) y = λ M y` of bordered matrices.
module bordered_pencil
  use bordered_matrix, only: bordered_matrix_t, layout_t, new_bordered_matrix
  implicit none (type, external)
  private

  public :: bordered_pencil_t, new_bordered_pencil

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

end module bordered_pencil
