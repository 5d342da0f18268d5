!> Modes followed from position to position and from speed to speed.
module study_of_loci
  use frequency_memory, only: add_branches_memory
  use loci_study, only: follow_loci
  use study_types, only: add_study, study_t, variant_run_t
  implicit none (type, external)
  private

  public :: add_loci_study

contains

  !> Appends the study of this file.
  subroutine add_loci_study(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t("loci", compute=compute_loci, add_memory=add_branches_memory))
  end subroutine add_loci_study

  !> Frequencies are made before.
  subroutine compute_loci(run)
    type(variant_run_t), intent(inout), target :: run

    associate (found => run%results%found)
      call follow_loci(found%sweep%structure, found%positions, found%sweep, found%loci)
    end associate
  end subroutine compute_loci

end module study_of_loci
