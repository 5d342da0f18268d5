!> Checks of MESH cards against each other and against SOLVER and INERTIA.
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

  !> Checks `accuracy=`: the program then chooses the mesh of the whole mechanism, for the
  !! deformation solver. Errors: other links with `elements=`, two different accuracies, a solver or
  !! lumped inertia that needs given elements.
  subroutine check_meshes(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! (cards) of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose links have their meshes

    integer :: accurate, divided
    ! Meshes in use, with `accuracy=` or with `elements=`.
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
        "'accuracy=' applies to the whole mechanism, and other links have 'elements='", &
        model%meshes(divided)%keyword, "their card is here")
    end if
    call refuse_other_accuracies(diagnostics, model, by_accuracy)
    ! A misspelt MESH card has been reported: it is not missing as well.
    if (model%meshes(accurate)%keyword%line == 0 .and. has_card(cards, "MESH")) return
    call check_solver(diagnostics, model, accurate)
    call check_lumped_inertia(diagnostics, model, accurate)
  end subroutine check_meshes

  !> The error of a frequency comes from all links together: only one accuracy is possible.
  pure subroutine refuse_other_accuracies(diagnostics, model, by_accuracy)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    logical, intent(in) :: by_accuracy(:) !! (meshes) in use, with `accuracy=`

    integer :: first, i

    first = findloc(by_accuracy, .true., dim=1)
    do i = first + 1, size(by_accuracy)
      if (.not. by_accuracy(i)) cycle
      associate (mine => model%meshes(i), its => model%meshes(first))
        if (abs(mine%accuracy - its%accuracy) <= 0.0_wp) cycle
        call add_error(diagnostics, mine%accuracy_word, &
          "'accuracy=' applies to the whole mechanism: "//mine%accuracy_word%text//" here is "// &
          "not "//its%accuracy_word%text//" there", its%accuracy_word, "the other accuracy is here")
      end associate
    end do
  end subroutine refuse_other_accuracies

  !> The solvers `dense` and `band` need given elements.
  pure subroutine check_solver(diagnostics, model, accurate)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: accurate !! number of the mesh with `accuracy=`

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

  !> Lumped masses sit on nodes, so the deck must give the elements.
  pure subroutine check_lumped_inertia(diagnostics, model, accurate)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: accurate !! number of the mesh with `accuracy=`

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
