!> Change points at which a BRANCH card has the linkage turn off.
module change_point_checks
  use deck_lengths, only: crank_text
  use diagnostics, only: add_warning, diagnostics_t
  use kinds, only: wp
  use linkages, only: changes_branch
  use mechanisms, only: mechanism_t
  use models, only: model_t, needs_positions, rule_at_change_points
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
    !> Change points are the same if they are this near [deg] or [m].
    real(wp), parameter :: same = 1.0e-6_wp
    real(wp) :: crank, first
    integer :: i

    if (rule_at_change_points(model) /= changes_branch .or. .not. needs_positions(model)) return
    if (model%drives(1)%change_points > 0) return
    first = -huge(first)
    associate (path => mechanism%linkage%path)
      if (.not. allocated(path%bridges)) return
      place = model%branch_word
      if (place%line == 0) place = model%branches(1)%pin
      do i = 1, size(path%bridges)
        crank = path%bridges(i)%change
        if (path%period > 0.0_wp) crank = minval(model%crank%value) + modulo(crank - &
          minval(model%crank%value), path%period)
        if (crank > maxval(model%crank%value)) cycle
        ! A path that begins beside a change point has it at its end, too.
        if (i > 1 .and. abs(crank - first) < same) cycle
        if (i == 1) first = crank
        call add_warning(diagnostics, place, "change point at crank "//crank_text(model, crank, &
          6)//": by BRANCH every position keeps its side there, "//group_words(mechanism, &
          mechanism%linkage%groups(path%bridges(i)%group))//", with a corner in the motion; "// &
          "'change_points=through' on the DRIVE card has it go on smoothly, to the other side", &
          kind=i)
      end do
    end associate
  end subroutine warn_of_change_points

end module change_point_checks
