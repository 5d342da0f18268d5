!> The eigenproblem `(I + G) y = λ M y` of bordered matrices.
module bordered_pencil
  use bordered_matrix, only: bordered_matrix_t, layout_t, new_bordered_matrix
  implicit none (type, external)
  private

  public :: bordered_pencil_t, new_bordered_pencil

  type :: bordered_pencil_t
    type(layout_t) :: layout
    type(bordered_matrix_t) :: mass      !! M, positive definite, diagonal in its blocks [s²]
    type(bordered_matrix_t) :: geometric !! G, with blocks [-]
    logical :: loaded = .false.          !! whether there is a G; without one it is not looked at
  end type bordered_pencil_t

contains

  !> Matrices of zeros; nothing loads them.
  pure function new_bordered_pencil(layout) result(pencil)
    type(layout_t), intent(in) :: layout
    type(bordered_pencil_t) :: pencil

    pencil%layout = layout
    pencil%mass = new_bordered_matrix(layout, .false.)
    pencil%geometric = new_bordered_matrix(layout, .true.)
  end function new_bordered_pencil

end module bordered_pencil
