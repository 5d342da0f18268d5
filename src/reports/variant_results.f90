!> One variant of a deck: what it asks for, and what was found.
module variant_results
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use study_results, only: study_results_t
  implicit none (type, external)
  private

  public :: variant_results_t

  type :: variant_results_t
    type(model_t) :: model
    type(mechanism_t) :: mechanism
    type(study_results_t) :: found
  end type variant_results_t

end module variant_results
