!> A linkage in parts at a position: what its displacements, loads and forces are found from.
module elastic_positions
  use border_unknowns, only: border_unknowns_t, new_border_unknowns
  use deformation_model_types, only: deformation_model_t
  use elastic_linkages, only: elastic_linkage_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: elastic_position_t, new_elastic_position

  !> Made once for a linkage; lengths, own modes and pose become those of every position.
  type :: elastic_position_t
    type(elastic_linkage_t) :: elastic   !! its parts
    type(deformation_model_t) :: model   !! their own modes
    type(pose_t) :: pose                 !! of points and parts
    type(border_unknowns_t) :: numbers   !! of displacements, rows and constraints
  end type elastic_position_t

contains

  !> A linkage that is not placed yet.
  pure function new_elastic_position(elastic, model) result(at)
    type(elastic_linkage_t), intent(in) :: elastic
    type(deformation_model_t), intent(in) :: model !! of its parts
    type(elastic_position_t) :: at

    at%elastic = elastic
    at%model = model
    at%numbers = new_border_unknowns(elastic, model%links)
  end function new_elastic_position

end module elastic_positions
