!> Whether a linkage can be divided into the elements of a deck, or solved in nodal displacements:
!! its links are straight ways between two pins, one of them is driven, and no springs act.
module nodal_checks
  use bending_checks, only: carries_pin
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use drive_cards, only: drive_angle
  use kinds, only: wp
  use models, only: model_t, needs_frequencies, solver_band, solver_dense
  use text, only: lower_case
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: check_nodal

contains

  !> Errors: SOLVER dense or band, or else a mesh of given elements, for the frequencies of another
  !! linkage; the message names the card that makes it another one. After other errors it may be
  !! their consequence.
  pure subroutine check_nodal(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose links have their meshes

    character(len=*), parameter :: kind = &
      " is for links with two pins each, one of them driven, without springs and dampers; "// &
      "expected "
    type(token_t) :: card
    character(len=:), allocatable :: what
    integer :: i

    if (.not. needs_frequencies(model) .or. has_errors(diagnostics)) return
    call find_other_card(model, card, what)
    if (len(what) == 0) return
    if (model%solver == solver_dense .or. model%solver == solver_band) then
      call add_error(diagnostics, model%solver_word, "SOLVER "// &
        lower_case(model%solver_word%text)//kind//"SOLVER auto or deformation", card, what)
      return
    end if
    do i = 1, size(model%meshes)
      if (.not. any(model%links%mesh == i) .or. model%meshes(i)%accuracy > 0.0_wp) cycle
      call add_error(diagnostics, model%meshes(i)%keyword, "MESH with 'elements='"//kind// &
        "'accuracy='", card, what)
      return
    end do
  end subroutine check_nodal

  !> The first card that makes a linkage another one, and what it has.
  pure subroutine find_other_card(model, card, what)
    type(model_t), intent(in) :: model
    type(token_t), intent(out) :: card
    character(len=:), allocatable, intent(out) :: what !! empty: there is none

    integer :: i

    what = ""
    card = token_t("", 0, 0)
    do i = 1, size(model%links)
      if (size(model%links(i)%pins) <= 2) cycle
      card = model%links(i)%name
      what = "this link has more pins"
      return
    end do
    do i = 1, size(model%points)
      if (.not. carries_pin(model, i)) cycle
      card = model%points(i)%name
      what = "this point is a pin of its link"
      return
    end do
    if (size(model%sliders) > 0) then
      card = model%sliders(1)%pin
      what = "this pin slides"
    else if (size(model%welds) > 0) then
      card = model%welds(1)%pin
      what = "links are welded here"
    else if (size(model%springs) > 0) then
      card = model%springs(1)%keyword
      what = "the first "//trim(merge("damper", "spring", model%springs(1)%damps))//" is here"
    else if (size(model%drives) > 1) then
      card = model%drives(2)%keyword
      what = "the second drive is here"
    else if (any(model%drives%kind > drive_angle) .or. any(model%drives%is_free)) then
      card = model%drives(1)%keyword
      what = "this drive does not hold a link on a ground pivot"
    end if
  end subroutine find_other_card

end module nodal_checks
