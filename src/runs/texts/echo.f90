!> `echo.deck`: the deck as the program understood it, itself a valid deck.
module echo
  use body_lines, only: place_words
  use card_echo, only: echo_line_t
  use card_table, only: card_kind_t, card_kinds
  use effect_cards, only: effect_words
  use kinds, only: wp
  use link_bodies, only: link_center, link_inertia
  use link_cards, only: has_own_mass
  use models, only: branch_crossed, has_law, inertia_none, is_four_bar, link_mass, model_t
  use response_cards, only: response_form
  use sections, only: shape_channel
  use shear, only: link_rotary_inertia, link_shear_stiffness, shear_coefficient
  use text, only: character_count, lower_case, same_word, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use units, only: coherent_unit, dimension_area, dimension_inertia, dimension_length, &
    dimension_mass, dimension_rotary_inertia, dimension_second_moment, from_si, unit_t
  use walled_sections, only: plane_of_flanges
  implicit none (type, external)
  private

  public :: echo_text

  !> Column in which comments on cards begin.
  integer, parameter :: comment_column = 72

contains

  !> All cards with the user's own digits, defaults as cards, derived values as comments.
  pure function echo_text(model) result(text)
    type(model_t), intent(in) :: model !! of the first variant
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    do i = 1, size(model%echo)
      call append_card(buffer, model%echo(i))
    end do
    do i = 1, size(card_kinds)
      if (len_trim(card_kinds(i)%default) > 0) call append_default_card(buffer, model, &
        card_kinds(i))
    end do
    call append_derived(buffer, model)
    text = buffer_text(buffer)
  end function echo_text

  !> A card, with its origin as a comment.
  pure subroutine append_card(buffer, line)
    type(text_buffer_t), intent(inout) :: buffer
    type(echo_line_t), intent(in) :: line

    call append_text(buffer, line%text)
    if (len(line%origin) > 0) then
      call append_text(buffer, repeat(" ", max(1, comment_column - character_count(line%text)))// &
        "! "//line%origin)
    end if
    call append_text(buffer, achar(10))
  end subroutine append_card

  !> Appends the card of a default, if the deck leaves it out.
  pure subroutine append_default_card(buffer, model, kind)
    type(text_buffer_t), intent(inout) :: buffer
    type(model_t), intent(in) :: model
    type(card_kind_t), intent(in) :: kind

    select case (kind%keyword)
    case ("MESH")
      ! A model without MESH cards has a mesh only where a report needs one.
      if (size(model%meshes) > 0) call append_default_text(buffer, model, trim(kind%keyword), &
        trim(kind%default))
    case ("INERTIA")
      if (model%inertia /= inertia_none) call append_default_text(buffer, model, &
        trim(kind%keyword), trim(kind%default))
    case ("BRANCH")
      ! Other linkages have none; that of a four-bar may come from the drawing. With a card every
      ! position would keep its side at change points.
      if (is_four_bar(model) .and. all(model%drives%change_points /= 0)) &
        call append_default_text(buffer, model, trim(kind%keyword), trim(merge("crossed", &
        "open   ", model%branch == branch_crossed)))
    case ("SPEED")
      if (.not. has_law(model)) call append_default_text(buffer, model, trim(kind%keyword), &
        trim(kind%default))
    case ("EFFECTS")
      call append_default_text(buffer, model, trim(kind%keyword), effect_words(model%effects, &
        .false., .false.))
    case default
      call append_default_text(buffer, model, trim(kind%keyword), trim(kind%default))
    end select
  end subroutine append_default_card

  !> Appends a card, unless the deck has one with its keyword. An EFFECTS card on the response is
  !! not one on frequencies.
  pure subroutine append_default_text(buffer, model, keyword, value)
    type(text_buffer_t), intent(inout) :: buffer
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: keyword, value

    type(echo_line_t) :: line
    integer :: i

    do i = 1, size(model%echo)
      associate (text => model%echo(i)%text)
        if (index(lower_case(text), "effects "//response_form//" ") == 1) cycle
        if (same_word(text(:index(text//" ", " ") - 1), keyword)) return
      end associate
    end do
    line%text = keyword//" "//value
    line%origin = "default"
    call append_card(buffer, line)
  end subroutine append_default_text

  !> Values that the program derived from the cards, in the deck's units.
  pure subroutine append_derived(buffer, model)
    type(text_buffer_t), intent(inout) :: buffer
    type(model_t), intent(in) :: model

    type(unit_t) :: area, second_moment, mass, length
    character(len=:), allocatable :: derived
    integer :: i

    derived = "! derived:"
    if (len(model%variant) > 0) derived = "! derived at "//model%variant//":"
    area = coherent_unit(model%units, dimension_area)
    second_moment = coherent_unit(model%units, dimension_second_moment)
    mass = coherent_unit(model%units, dimension_mass)
    do i = 1, size(model%sections)
      ! Of a whole library only the sections in use.
      if (.not. any(model%links%section == i)) cycle
      associate (this => model%sections(i))
        call append_text(buffer, derived//" section "//this%name%text//": A = "// &
          to_string(from_si(this%area, area), 15)//" "//area%name//", I = "// &
          to_string(from_si(this%second_moment, second_moment), 15)//" "//second_moment%name)
        if (this%shape == shape_channel .and. this%plane == plane_of_flanges) then
          length = coherent_unit(model%units, dimension_length)
          call append_text(buffer, ", centroid "// &
            to_string(from_si(this%walls%centroid, length), 15)//" "//length%name// &
            " from the back of the web")
        end if
        call append_text(buffer, achar(10))
      end associate
    end do
    do i = 1, size(model%links)
      if (has_own_mass(model%links(i))) call append_body(buffer, model, i, derived)
      if (link_mass(model, i) <= 0.0_wp .or. has_own_mass(model%links(i))) cycle
      call append_text(buffer, derived//" link "//model%links(i)%name%text//": mass = "// &
        to_string(from_si(link_mass(model, i), mass), 15)//" "//mass%name//achar(10))
      call append_thickness(buffer, model, i, derived)
    end do
  end subroutine append_derived

  !> A link with a mass of its own as a rigid body.
  pure subroutine append_body(buffer, model, link, derived)
    type(text_buffer_t), intent(inout) :: buffer
    type(model_t), intent(in) :: model
    integer, intent(in) :: link             !! number in the model's list
    character(len=*), intent(in) :: derived !! beginning of the line

    type(unit_t) :: length, mass, inertia
    character(len=:), allocatable :: origin

    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    inertia = coherent_unit(model%units, dimension_inertia)
    origin = ""
    if (model%links(link)%has_mass .and. .not. model%links(link)%has_inertia) origin = &
      " (uniform link of this mass)"
    call append_text(buffer, derived//" link "//model%links(link)%name%text//": mass = "// &
      to_string(from_si(link_mass(model, link), mass), 15)//" "//mass%name// &
      ", moment of inertia = "//to_string(from_si(link_inertia(model, link), inertia), 15)//" "// &
      inertia%name//origin//" about its mass centre, "//place_words(link_center(model, link), &
      length)//" from "//model%links(link)%pins(1)%text//achar(10))
  end subroutine append_body

  !> Rotary inertia and shear stiffness of a link, if EFFECTS requests them.
  pure subroutine append_thickness(buffer, model, link, derived)
    type(text_buffer_t), intent(inout) :: buffer
    type(model_t), intent(in) :: model
    integer, intent(in) :: link             !! number in the model's list
    character(len=*), intent(in) :: derived !! beginning of the line

    type(unit_t) :: measure
    character(len=:), allocatable :: origin

    associate (this => model%links(link))
      if (link_rotary_inertia(model, link) > 0.0_wp) then
        measure = coherent_unit(model%units, dimension_rotary_inertia)
        call append_text(buffer, derived//" link "//this%name%text//": rotary inertia rho I = "// &
          to_string(from_si(link_rotary_inertia(model, link), measure), 15)//" "//measure%name// &
          achar(10))
      end if
      if (link_shear_stiffness(model, link) <= 0.0_wp) return
      measure = model%outputs%force
      associate (section => model%sections(this%section), &
        nu => model%materials(this%material)%poissons_ratio)
        origin = "Cowper"
        if (section%plane == plane_of_flanges) origin = "Cowper, nu = 0"
        if (section%shear_word%line > 0) origin = "as its section has it"
        call append_text(buffer, derived//" link "//this%name%text//": shear coefficient k = "// &
          to_string(shear_coefficient(section, nu), 15)//" ("//origin//"), k G A = "// &
          to_string(from_si(link_shear_stiffness(model, link), measure), 15)//" "//measure%name// &
          achar(10))
      end associate
    end associate
  end subroutine append_thickness

end module echo
