!> A linkage of beams in own modes of its links.
module deformation_model_types
  use bordered_matrix, only: layout_t
  use link_degrees, only: link_degrees_t
  use link_modes, only: link_modes_t
  implicit none (type, external)
  private

  public :: deformation_model_t

  type :: deformation_model_t
    integer, allocatable :: elements(:)         !! (bodies) of equal length; 0: a continuous link,
                                                !! one element between masses along the link
    integer, allocatable :: order(:)            !! (bodies) polynomial degree of the transverse
                                                !! displacement, the highest of all elements
    type(link_degrees_t), allocatable :: degrees(:) !! (bodies) of continuous links, piece by piece
    logical, allocatable :: lumped(:)           !! (bodies) axial force constant in each element;
                                                !! else quadratic along the link
    type(link_modes_t), allocatable :: links(:) !! (bodies) own modes, or a rigid link
    type(layout_t) :: layout                    !! of the unknowns in the bordered matrices
    logical :: mixed = .false.                  !! many links: equations are in mixed form
  end type deformation_model_t

end module deformation_model_types
