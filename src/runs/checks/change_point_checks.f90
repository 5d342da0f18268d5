!> Change points at which a BRANCH card has the linkage turn off.
module change_point_checks
  use bridges, only: change_point_t, change_points_of
  use deck_lengths, only: crank_text
  use diagnostics, only: add_warning, diagnostics_t
  use linkages, only: rule_branch
  use mechanisms, only: mechanism_t
  use models, only: model_t, needs_positions, rule_at_change_points, runs_in_time
  use plan_words, only: group_words
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: warn_of_change_points

contains

  !> Warns at every change point between the positions of the deck where each is on its side: there
  !! are corners in the motion, which a user rarely means. Whoever writes `change_points=branch`
  !! does.
  subroutine warn_of_change_points(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors
    type(mechanism_t), intent(in) :: mechanism        !! of this model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which warnings are added

    type(token_t) :: place
    type(change_point_t), allocatable :: points(:)
    integer :: i

    if (rule_at_change_points(model) /= rule_branch .or. .not. needs_positions(model) .or. &
      runs_in_time(model)) return
    if (model%drives(1)%change_points > 0) return
    call change_points_of(mechanism%linkage, minval(model%crank%value), maxval(model%crank%value), &
      points)
    place = model%branch_word
    if (place%line == 0 .and. size(points) > 0) place = model%branches(1)%pin
    do i = 1, size(points)
      call add_warning(diagnostics, place, "change point at crank "//crank_text(model, &
        points(i)%crank, 6)//": by BRANCH every position keeps its side there, "//group_words( &
        mechanism, mechanism%linkage%groups(points(i)%group))//", with a corner in the motion; "// &
        "'change_points=through' on the DRIVE card has it go on smoothly, to the other side", &
        kind=i)
    end do
  end subroutine warn_of_change_points

end module change_point_checks
