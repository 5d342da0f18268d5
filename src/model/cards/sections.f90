!> SECTION card: the cross-section of a link.
module sections
  use card_reader, only: check_form, has_key, has_value, read_choice, read_entry_quantity, &
    read_name, require_positive, value_of
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use constants, only: pi
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use tokens, only: token_t
  use units, only: dimension_area, dimension_length, dimension_none, dimension_second_moment, &
    unit_system_t
  use walled_sections, only: new_box, new_channel, new_i_section, walled_section_t
  implicit none (type, external)
  private

  public :: outer_distance, section_t, read_section
  public :: shape_rectangle, shape_circle, shape_tube, shape_box, shape_i, shape_channel, &
    shape_general

  type :: section_t
    type(token_t) :: name
    integer :: shape = 0               !! one of the shape_… constants; 0: unknown
    real(wp) :: area = 0.0_wp          !! [m²]
    real(wp) :: second_moment = 0.0_wp !! about the axis normal to the plane of motion [m⁴]
    real(wp) :: depth = 0.0_wp         !! in the plane of motion [m]; 0: not given
    real(wp) :: inner_share = 0.0_wp   !! inner/outer diameter of a tube [-]
    integer :: plane = 0               !! of an I section or channel: plane_of_web or
                                       !! plane_of_flanges; 0: unknown
    type(walled_section_t) :: walls    !! of a box, an I section or a channel
    real(wp) :: shear_coefficient = 0.0_wp !! from the deck [-]; 0: not given
    type(token_t) :: shear_word        !! its value on the card; without a line if not given
  end type section_t

  ! In the order of the words in the table of cards.
  integer, parameter :: shape_rectangle = 1, shape_circle = 2, shape_tube = 3, shape_box = 4, &
    shape_i = 5, shape_channel = 6, shape_general = 7

contains

  !> Largest distance of a fibre from the centroid, in the plane of motion [m].
  elemental function outer_distance(section) result(distance)
    type(section_t), intent(in) :: section !! as read, with a depth
    real(wp) :: distance

    distance = 0.5_wp*section%depth
    if (section%walls%depth > 0.0_wp) distance = max(section%walls%centroid, &
      section%walls%depth - section%walls%centroid)
  end function outer_distance

  !> Reads `SECTION name rectangle thickness= width= | circle diameter= | tube outer= inner= |
  !! box thickness= width= wall= | I or channel depth= width= web= flange= plane=web|flanges |
  !! general A= I= [depth=]`, all of them with `[shear_coefficient=]`. Errors: words or keys that do
  !! not fit the shape, an invalid name, an unknown shape, a missing or unreadable value, a
  !! dimension of 0 or less, `inner=` not below `outer=`, walls that leave no room between them, a
  !! shear coefficient outside (0, 1].
  pure subroutine read_section(card, system, diagnostics, section)
    type(card_t), intent(in) :: card                  !! the SECTION card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(section_t), intent(out) :: section           !! as read

    type(card_kind_t) :: kind
    logical :: fine

    section%name = card%keyword
    section%shear_word = token_t("", 0, 0)
    if (size(card%words) > 0) then
      section%name = card%words(1)
      call read_name(section%name, diagnostics)
    end if
    if (size(card%words) < 2) then
      call check_form(card, diagnostics, fine)
      return
    end if
    kind = kind_of_card(card%keyword%text)
    call read_choice(card%words(2), trim(kind%choices), diagnostics, section%shape)
    select case (section%shape)
    case (shape_rectangle)
      call read_rectangle(card, system, diagnostics, section)
    case (shape_circle)
      call read_circle(card, system, diagnostics, section)
    case (shape_tube)
      call read_tube(card, system, diagnostics, section)
    case (shape_box)
      call read_box(card, system, diagnostics, section)
    case (shape_i)
      call read_flanged(card, "I", system, diagnostics, section)
    case (shape_channel)
      call read_flanged(card, "channel", system, diagnostics, section)
    case (shape_general)
      call read_general(card, system, diagnostics, section)
    end select
    if (section%shape > 0) call read_shear_coefficient(card, system, diagnostics, section)
  end subroutine read_section

  pure subroutine read_shear_coefficient(card, system, diagnostics, section)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    character(len=*), parameter :: key = "shear_coefficient"
    logical :: fine

    if (.not. has_key(card, key)) return
    section%shear_word = card%keyword
    call read_entry_quantity(card, key, dimension_none, system, .false., diagnostics, &
      section%shear_coefficient, fine)
    if (.not. fine) return
    section%shear_word = value_of(card, key)
    if (section%shear_coefficient > 0.0_wp .and. section%shear_coefficient <= 1.0_wp) return
    call add_error(diagnostics, section%shear_word, &
      "'shear_coefficient=' must be above 0 and at most 1, not "//section%shear_word%text)
  end subroutine read_shear_coefficient

  !> `I = width thickness³/12`, the thickness in the plane of motion.
  pure subroutine read_rectangle(card, system, diagnostics, section)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    real(wp) :: thickness, width
    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys, form="rectangle")
    call read_positive(card, "thickness", dimension_length, system, known_keys, diagnostics, &
      thickness)
    call read_positive(card, "width", dimension_length, system, known_keys, diagnostics, width)
    section%area = thickness*width
    section%second_moment = width*thickness**3/12.0_wp
    section%depth = thickness
  end subroutine read_rectangle

  !> `I = π d⁴/64`
  pure subroutine read_circle(card, system, diagnostics, section)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    real(wp) :: diameter
    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys, form="circle")
    call read_positive(card, "diameter", dimension_length, system, known_keys, diagnostics, &
      diameter)
    section%area = pi*diameter**2/4.0_wp
    section%second_moment = pi*diameter**4/64.0_wp
    section%depth = diameter
  end subroutine read_circle

  !> `I = π (D² − d²)(D² + d²)/64`, factored to keep all digits of a thin wall.
  pure subroutine read_tube(card, system, diagnostics, section)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    real(wp) :: outer, inner
    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys, form="tube")
    call read_positive(card, "outer", dimension_length, system, known_keys, diagnostics, outer)
    call read_positive(card, "inner", dimension_length, system, known_keys, diagnostics, inner)
    call require_less(card, "inner", inner, "outer", outer, diagnostics, fine)
    if (.not. fine) return
    section%area = pi*(outer - inner)*(outer + inner)/4.0_wp
    section%second_moment = section%area*(outer**2 + inner**2)/16.0_wp
    if (outer > 0.0_wp) section%inner_share = inner/outer
    section%depth = outer
  end subroutine read_tube

  !> Reads a rectangular tube.
  pure subroutine read_box(card, system, diagnostics, section)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    real(wp) :: thickness, width, wall
    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys, form="box")
    call read_positive(card, "thickness", dimension_length, system, known_keys, diagnostics, &
      thickness)
    call read_positive(card, "width", dimension_length, system, known_keys, diagnostics, width)
    call read_positive(card, "wall", dimension_length, system, known_keys, diagnostics, wall)
    if (min(thickness, width, wall) <= 0.0_wp) return
    if (thickness <= width) then
      call require_less(card, "wall", 2.0_wp*wall, "thickness", thickness, diagnostics, fine, &
        "half of ")
    else
      call require_less(card, "wall", 2.0_wp*wall, "width", width, diagnostics, fine, "half of ")
    end if
    if (fine) call take_walls(new_box(thickness, width, wall), section)
  end subroutine read_box

  !> Reads an I section or a channel.
  pure subroutine read_flanged(card, form, system, diagnostics, section)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: form !! of the card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    type(card_kind_t) :: kind
    real(wp) :: depth, width, web, flange
    logical :: fine, known_keys, has_room

    call check_form(card, diagnostics, fine, known_keys, form=form)
    call read_positive(card, "depth", dimension_length, system, known_keys, diagnostics, depth)
    call read_positive(card, "width", dimension_length, system, known_keys, diagnostics, width)
    call read_positive(card, "web", dimension_length, system, known_keys, diagnostics, web)
    call read_positive(card, "flange", dimension_length, system, known_keys, diagnostics, flange)
    kind = kind_of_card(card%keyword%text, form)
    if (has_value(card, "plane")) then
      call read_choice(value_of(card, "plane"), trim(kind%choices), diagnostics, section%plane)
    else if (known_keys .and. .not. has_key(card, "plane")) then
      call add_error(diagnostics, card%keyword, "'plane=' is missing; expected plane=web or "// &
        "plane=flanges, whichever lies in the plane of motion")
    end if
    if (min(depth, width, web, flange) <= 0.0_wp) return
    call require_less(card, "flange", 2.0_wp*flange, "depth", depth, diagnostics, fine, "half of ")
    call require_less(card, "web", web, "width", width, diagnostics, has_room)
    if (.not. (fine .and. has_room) .or. section%plane == 0) return
    if (section%shape == shape_i) then
      call take_walls(new_i_section(depth, width, web, flange, section%plane), section)
    else
      call take_walls(new_channel(depth, width, web, flange, section%plane), section)
    end if
  end subroutine read_flanged

  !> Gives a section the properties of its walls.
  pure subroutine take_walls(walls, section)
    type(walled_section_t), intent(in) :: walls
    type(section_t), intent(inout) :: section

    section%walls = walls
    section%area = walls%area
    section%second_moment = walls%second_moment
    section%depth = walls%depth
  end subroutine take_walls

  !> Errors: of two dimensions that could be read, one is not less than the other.
  pure subroutine require_less(card, key, value, limit_key, limit, diagnostics, fine, share)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key, limit_key !! of the two dimensions
    real(wp), intent(in) :: value, limit           !! compared; 0 after an error
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(out) :: fine                   !! false after an error
    character(len=*), intent(in), optional :: share !! of the limit, for the message: `half of `

    type(token_t) :: word, limit_word
    character(len=:), allocatable :: fraction

    fine = limit <= 0.0_wp .or. value < limit
    if (fine) return
    fraction = ""
    if (present(share)) fraction = share
    word = value_of(card, key)
    limit_word = value_of(card, limit_key)
    call add_error(diagnostics, word, "'"//key//"=' must be less than "//fraction//"'"// &
      limit_key//"=', "//limit_word%text//", not "//word%text)
  end subroutine require_less

  pure subroutine read_general(card, system, diagnostics, section)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(section_t), intent(inout) :: section

    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys, form="general")
    call read_positive(card, "A", dimension_area, system, known_keys, diagnostics, section%area)
    call read_positive(card, "I", dimension_second_moment, system, known_keys, diagnostics, &
      section%second_moment)
    call read_positive(card, "depth", dimension_length, system, .false., diagnostics, section%depth)
  end subroutine read_general

  !> Reads a quantity greater than zero; 0 after an error.
  pure subroutine read_positive(card, key, dimension, system, required, diagnostics, value)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    type(unit_system_t), intent(in) :: system
    logical, intent(in) :: required !! a missing key is an error
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(out) :: value !! [SI]

    logical :: fine

    call read_entry_quantity(card, key, dimension, system, required, diagnostics, value, fine)
    if (fine) call require_positive(card, key, value, diagnostics)
    value = max(value, 0.0_wp)
  end subroutine read_positive

end module sections
