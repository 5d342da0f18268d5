!> One variant of a deck: model, mechanism and results.
module variant_results
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use study_results, only: study_results_t
  implicit none (type, external)
  private

  public :: variant_results_t

  type :: variant_results_t
    type(model_t) :: model         !! description and requests of the deck, in SI
    type(mechanism_t) :: mechanism !! the model in the terms of mechanics
    type(study_results_t) :: found !! results of the studies
    character(len=:), allocatable :: unreachable !! why positions are out of reach; unallocated if
                                                 !! none is
  end type variant_results_t

end module variant_results
