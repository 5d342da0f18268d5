!> Model → stops of the linkage, and the width of contacts.
module stop_builder
  use applied_load_types, only: applied_load_t, applies_along
  use kinds, only: wp
  use linkages, only: linkage_t
  use models, only: model_t
  use natures, only: nature_t
  use pull_laws, only: pull_law_t
  use rigid_bodies, only: rigid_bodies_of, total_mass
  implicit none (type, external)
  private

  public :: stops_of, contact_width

contains

  !> The stops of a model, in the order of the deck.
  pure function stops_of(model, linkage) result(loads)
    type(model_t), intent(in) :: model     !! without errors
    type(linkage_t), intent(in) :: linkage !! with its masses and coordinates
    type(applied_load_t), allocatable :: loads(:)

    integer :: i

    allocate (loads(size(model%stops)))
    do i = 1, size(loads)
      associate (load => loads(i), card => model%stops(i))
        load%kind = applies_along
        load%coordinate = card%number
        load%along = linkage%coordinates(card%number)
        load%name = card%name%text
        load%law = card%law
        load%law%contact = contact_width(linkage, card%law, card%nature)
      end associate
    end do
  end function stops_of

  !> The width in which a contact begins: that of its card, or a hundredth of the depth to which the
  !! weight of all bodies would press it, of an angle at the length of the longest [m] or [rad].
  pure function contact_width(linkage, law, nature) result(width)
    type(linkage_t), intent(in) :: linkage !! with its masses and gravity
    type(pull_law_t), intent(in) :: law    !! with the contact of the card; 0: not on it
    type(nature_t), intent(in) :: nature   !! of the coordinate
    real(wp) :: width

    integer :: elements(size(linkage%bodies))

    width = law%contact
    if (width > 0.0_wp) return
    elements = 0
    width = 0.01_wp*total_mass(linkage, rigid_bodies_of(linkage, elements))* &
      norm2(linkage%gravity)/law%stiffness
    width = width*maxval(linkage%bodies%length)**(1 - nature%value(1))
  end function contact_width

end module stop_builder
