!> What the meshes of all links are together, and what else on the deck must suit them.
module mesh_checks
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use models, only: inertia_lumped, model_t, needs_inertia, solver_band, solver_dense
  use request_checks, only: has_card
  use text, only: lower_case
  implicit none (type, external)
  private

  public :: check_meshes

contains

  !> Where an accuracy is wanted, the program chooses the mesh of the whole mechanism, for a solver
  !! of its own.
  subroutine check_meshes(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model !! whose links have their meshes

    integer :: accurate, divided
    !> used, and given so
    logical :: by_accuracy(size(model%meshes)), by_elements(size(model%meshes))

    by_elements = .false.
    by_elements(pack(model%links%mesh, model%links%mesh > 0)) = .true.
    by_accuracy = by_elements .and. model%meshes%accuracy > 0.0_wp
    by_elements = by_elements .and. model%meshes%elements > 0 .and. .not. by_accuracy
    accurate = findloc(by_accuracy, .true., dim=1)
    divided = findloc(by_elements, .true., dim=1)
    if (accurate == 0) return
    if (divided > 0) then
      call add_error(diagnostics, model%meshes(accurate)%accuracy_word, &
        "'accuracy=' is for the whole mechanism, and other "//"links have 'elements='", &
        model%meshes(divided)%keyword, "their card is here")
    end if
    call refuse_other_accuracies(diagnostics, model, by_accuracy)
    ! A MESH card that is there, but misspelt, is not missing as well.
    if (model%meshes(accurate)%keyword%line == 0 .and. has_card(cards, "MESH")) return
    call check_solver(diagnostics, model, accurate)
    call check_lumped_inertia(diagnostics, model, accurate)
  end subroutine check_meshes

  !> The error of a frequency comes from all links together.
  pure subroutine refuse_other_accuracies(diagnostics, model, by_accuracy)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    logical, intent(in) :: by_accuracy(:) !! (meshes)

    integer :: first, i

    first = findloc(by_accuracy, .true., dim=1)
    do i = first + 1, size(by_accuracy)
      if (.not. by_accuracy(i)) cycle
      associate (mine => model%meshes(i), its => model%meshes(first))
        if (abs(mine%accuracy - its%accuracy) <= 0.0_wp) cycle
        call add_error(diagnostics, mine%accuracy_word, &
          "'accuracy=' is for the whole mechanism: "//mine%accuracy_word%text//" here is not "// &
          its%accuracy_word%text//" there", its%accuracy_word, "the other accuracy is here")
      end associate
    end do
  end subroutine refuse_other_accuracies

  pure subroutine check_solver(diagnostics, model, accurate)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: accurate

    if (model%solver /= solver_dense .and. model%solver /= solver_band) return
    associate (mesh => model%meshes(accurate))
      if (mesh%keyword%line == 0) then
        call add_error(diagnostics, model%solver_word, "there is no MESH card, and SOLVER "// &
          lower_case(model%solver_word%text)// &
          " needs one with 'elements='; expected MESH ... elements=, or SOLVER auto or deformation")
      else
        call add_error(diagnostics, model%solver_word, &
          "'accuracy=' needs the deformation solver: SOLVER auto or deformation", &
          mesh%accuracy_word, "'accuracy=' is given here")
      end if
    end associate
  end subroutine check_solver

  !> Lumped masses sit on the nodes that the user has chosen.
  pure subroutine check_lumped_inertia(diagnostics, model, accurate)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: accurate

    if (model%inertia /= inertia_lumped) return
    if (.not. needs_inertia(model)) return
    associate (mesh => model%meshes(accurate))
      if (mesh%keyword%line == 0) then
        call add_error(diagnostics, model%inertia_word, &
          "there is no MESH card, and lumped inertia needs one with 'elements='; "// &
          "expected MESH ... elements= or INERTIA distributed")
      else
        call add_error(diagnostics, model%inertia_word, &
          "lumped inertia puts the masses on nodes, and 'accuracy=' leaves the "// &
          "nodes to the program; expected INERTIA distributed or MESH ... elements=", &
          mesh%accuracy_word, "'accuracy=' is given here")
      end if
    end associate
  end subroutine check_lumped_inertia

end module mesh_checks
