!> A cache of links that have been decomposed into their own modes.
!!
!! Orders are tried link by link, and variants of a mechanism mostly differ in one link, so the same
!! link is needed many times. It is taken from the store only if all its data agree to the last bit:
!! results then do not depend on what was computed before.
module link_store
  use beam_mesh, only: beam_t
  use body_lumps, only: lump_inertias, lump_masses, lump_offsets, lump_places
  use kinds, only: wp
  use link_degrees, only: link_degrees_t, same_degrees
  use link_modes, only: link_modes_t
  use linkages, only: body_t
  implicit none (type, external)
  private

  public :: link_store_t, link_key_t, new_link_key, find_link, keep_link

  !> Capacity of the store; the oldest links are overwritten.
  integer, parameter :: most_links = 24

  !> Everything that the own modes of a link depend on.
  type :: link_key_t
    real(wp) :: length = 0.0_wp         !! [m]
    real(wp) :: line_density = 0.0_wp   !! [kg/m]
    real(wp) :: rotary_inertia = 0.0_wp !! ρI [kg m]
    type(beam_t) :: beam                !! stiffnesses
    integer :: elements = 0             !! 0: one between masses along the link
    type(link_degrees_t) :: degrees     !! of its elements
    logical :: held(2) = .false.        !! first and last end, else pinned
    logical :: lumped = .false.         !! axial force constant in each element
    real(wp), allocatable :: lumps(:)   !! (4 × masses) masses along the link, their places ξ,
                                        !! offsets and moments of inertia [kg, -, m, kg m²]
  end type link_key_t

  type :: link_store_t
    integer :: made = 0                                 !! links decomposed so far
    integer, private :: held = 0                        !! links in the store
    type(link_key_t), allocatable, private :: key(:)    !! (most_links) the first `held` are in use
    type(link_modes_t), allocatable, private :: link(:) !! in the order of `key`
  end type link_store_t

contains

  !> The key of a link that bends.
  pure function new_link_key(body, beam, elements, degrees, held, lumped) result(key)
    type(body_t), intent(in) :: body    !! length, masses
    type(beam_t), intent(in) :: beam    !! stiffnesses
    integer, intent(in) :: elements     !! 0: one between masses along the link
    type(link_degrees_t), intent(in) :: degrees !! of its elements
    logical, intent(in) :: held(2)      !! first and last end, else pinned
    logical, intent(in) :: lumped       !! axial force constant in each element
    type(link_key_t) :: key

    key%length = body%length
    key%line_density = body%line_density
    key%rotary_inertia = body%rotary_inertia
    key%beam = beam
    key%elements = elements
    key%degrees = degrees
    key%held = held
    key%lumped = lumped
    key%lumps = [lump_masses(body), lump_places(body), lump_offsets(body), lump_inertias(body)]
  end function new_link_key

  !> Copies the link of a key from the store if it is there.
  pure subroutine find_link(store, key, link, found)
    type(link_store_t), intent(in) :: store   !! to search
    type(link_key_t), intent(in) :: key       !! of the link sought
    type(link_modes_t), intent(inout) :: link !! unchanged unless found
    logical, intent(out) :: found             !! whether the store holds the link

    integer :: i

    found = .false.
    do i = 1, store%held
      found = is_same(store%key(i), key)
      if (.not. found) cycle
      link = store%link(i)
      return
    end do
  end subroutine find_link

  !> Stores a link that has just been decomposed; a full store drops its oldest link.
  pure subroutine keep_link(store, key, link)
    type(link_store_t), intent(inout) :: store !! to add to
    type(link_key_t), intent(in) :: key        !! of this link
    type(link_modes_t), intent(in) :: link     !! with its own modes

    integer :: slot

    if (store%held == 0) allocate (store%key(most_links), store%link(most_links))
    slot = 1 + modulo(store%made, most_links)
    store%key(slot) = key
    store%link(slot) = link
    store%made = store%made + 1
    store%held = min(store%made, most_links)
  end subroutine keep_link

  pure function is_same(a, b)
    type(link_key_t), intent(in) :: a, b
    logical :: is_same

    is_same = a%elements == b%elements .and. same_degrees(a%degrees, b%degrees) .and. &
      all(a%held .eqv. b%held) .and. (a%lumped .eqv. b%lumped)
    if (is_same) is_same = size(a%lumps) == size(b%lumps)
    if (is_same) is_same = all(abs(a%lumps - b%lumps) <= 0.0_wp)
    if (is_same) is_same = all(abs(key_numbers(a) - key_numbers(b)) <= 0.0_wp)
  end function is_same

  pure function key_numbers(key) result(numbers)
    type(link_key_t), intent(in) :: key
    real(wp) :: numbers(6)

    numbers = [key%length, key%line_density, key%rotary_inertia, key%beam%axial_stiffness, &
      key%beam%bending_stiffness, key%beam%shear_stiffness]
  end function key_numbers

end module link_store
