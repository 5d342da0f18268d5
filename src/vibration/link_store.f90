!> Links that have been taken apart already: the same link need not be taken apart twice.
!!
!! Orders are tried link by link, and variants of a mechanism mostly differ in one link. A link is
!! taken from the store only where everything that it was made of is the same to the last bit, so
!! that results do not depend on what was computed before.
module link_store
  use beam_mesh, only: beam_t
  use body_lumps, only: lump_masses, lump_places
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t
  implicit none (type, external)
  private

  public :: link_store_t, link_key_t, new_link_key, find_link, keep_link

  !> Links that are kept; the oldest make room.
  integer, parameter :: most_links = 24

  !> All that a link's own modes depend on.
  type :: link_key_t
    real(wp) :: length = 0.0_wp         !! [m]
    real(wp) :: line_density = 0.0_wp   !! [kg/m]
    real(wp) :: rotary_inertia = 0.0_wp !! ρI [kg m]
    type(beam_t) :: beam
    integer :: elements = 0, order = 0  !! no elements: one between the masses
    logical :: clamped = .false., lumped = .false.
    real(wp), allocatable :: lumps(:)   !! masses along the link, then their places [kg, -]
  end type link_key_t

  type :: link_store_t
    integer :: made = 0           !! links taken apart so far
    integer, private :: held = 0
    type(link_key_t), private :: key(most_links)
    type(link_modes_t), private :: link(most_links)
  end type link_store_t

contains

  pure function new_link_key(body, beam, elements, order, clamped, lumped) result(key)
    type(body_t), intent(in) :: body
    type(beam_t), intent(in) :: beam
    integer, intent(in) :: elements, order
    logical, intent(in) :: clamped, lumped
    type(link_key_t) :: key

    key%length = body%length
    key%line_density = body%line_density
    key%rotary_inertia = body%rotary_inertia
    key%beam = beam
    key%elements = elements
    key%order = order
    key%clamped = clamped
    key%lumped = lumped
    key%lumps = [lump_masses(body), lump_places(body)]
  end function new_link_key

  !> Copies the link of a key, if it is there.
  pure subroutine find_link(store, key, link, found)
    type(link_store_t), intent(in) :: store
    type(link_key_t), intent(in) :: key
    type(link_modes_t), intent(inout) :: link
    logical, intent(out) :: found

    integer :: i

    found = .false.
    do i = 1, store%held
      found = is_same(store%key(i), key)
      if (.not. found) cycle
      link = store%link(i)
      return
    end do
  end subroutine find_link

  !> Keeps a link that has just been taken apart.
  pure subroutine keep_link(store, key, link)
    type(link_store_t), intent(inout) :: store
    type(link_key_t), intent(in) :: key
    type(link_modes_t), intent(in) :: link

    integer :: slot

    slot = 1 + modulo(store%made, most_links)
    store%key(slot) = key
    store%link(slot) = link
    store%made = store%made + 1
    store%held = min(store%made, most_links)
  end subroutine keep_link

  pure function is_same(a, b)
    type(link_key_t), intent(in) :: a, b
    logical :: is_same

    is_same = a%elements == b%elements .and. a%order == b%order .and. &
      (a%clamped .eqv. b%clamped) .and. (a%lumped .eqv. b%lumped)
    if (is_same) is_same = size(a%lumps) == size(b%lumps)
    if (is_same) is_same = all(abs(a%lumps - b%lumps) <= 0.0_wp)
    if (is_same) is_same = all(abs(numbers_of(a) - numbers_of(b)) <= 0.0_wp)
  end function is_same

  pure function numbers_of(key) result(numbers)
    type(link_key_t), intent(in) :: key
    real(wp) :: numbers(6)

    numbers = [key%length, key%line_density, key%rotary_inertia, key%beam%axial_stiffness, &
      key%beam%bending_stiffness, key%beam%shear_stiffness]
  end function numbers_of

end module link_store
