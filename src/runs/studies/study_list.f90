!> All studies.
module study_list
  use rigid_studies, only: add_rigid_studies
  use studies_of_stability, only: add_stability_studies
  use study_of_frequencies, only: add_frequency_study
  use study_of_loci, only: add_loci_study
  use study_of_motion, only: add_motion_study
  use study_of_response, only: add_response_study
  use study_of_transient, only: add_transient_study
  use study_types, only: study_t
  implicit none (type, external)
  private

  public :: list_studies

contains

  !> Studies in the order in which they are made: some use the results of others.
  subroutine list_studies(list)
    type(study_t), allocatable, intent(out) :: list(:)

    allocate (list(0))
    call add_rigid_studies(list)
    call add_response_study(list)
    call add_stability_studies(list)
    call add_transient_study(list)
    call add_motion_study(list)
    call add_frequency_study(list)
    call add_loci_study(list)
  end subroutine list_studies

end module study_list
