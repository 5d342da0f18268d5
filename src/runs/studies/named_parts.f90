!> Names in errors of studies, which know the numbers of links and pins only.
module named_parts
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use reach_texts, only: reach_words
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: name_parts, name_outcomes

contains

  !> Puts the name of the link before an error that is about one; of a block that leaves its link,
  !! both names; says what does not reach.
  subroutine name_parts(variant, error)
    type(variant_results_t), intent(in) :: variant     !! its names and units
    type(error_t), allocatable, intent(inout) :: error !! may be unallocated: no error

    if (.not. allocated(error)) return
    associate (mechanism => variant%mechanism)
      if (error%place%pin > 0) then
        error%text = "the block at "//mechanism%pin_names(error%place%pin)%text//" leaves '"// &
          mechanism%names(error%place%body)%text//"'"
      else if (abs(error%missing) > 0.0_wp) then
        ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one
        ! place for all threads.
        !$omp critical (one_at_a_time)
        error%text = "out of reach: "//reach_words(variant%model, mechanism, error)
        !$omp end critical (one_at_a_time)
      else if (error%place%body > 0) then
        error%text = "link '"//mechanism%names(error%place%body)%text//"': "//error%text
      end if
    end associate
  end subroutine name_parts

  !> The same of all errors among outcomes.
  subroutine name_outcomes(variant, outcomes)
    type(variant_results_t), intent(in) :: variant     !! its names and units
    class(outcome_t), intent(inout) :: outcomes(:)

    integer :: i

    do i = 1, size(outcomes)
      call name_parts(variant, outcomes(i)%error)
    end do
  end subroutine name_outcomes

end module named_parts
