!> Names across cards: duplicate definitions, and references from card to card.
module name_checks
  use diagnostics, only: add_error, add_warning, diagnostics_t
  use link_cards, only: link_t
  use models, only: model_t
  use name_index, only: find_name, name_index_t, new_name_index
  use spelling, only: suggestion
  use text, only: same_word, string_t
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: check_names, look_up, link_ends

  !> More than the number of report kinds: limits the comparisons in a deck of very many cards.
  integer, parameter :: most_reports = 100

contains

  !> Checks names, and gives each link its material, section and mesh. Errors: a name defined twice,
  !! an unknown material, section, link or pin, two meshes for a link or one for a rigid link, a
  !! moving pin at one link only, an unused ground pivot. Warning: a mass at a ground pivot.
  subroutine check_names(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(inout) :: model             !! material, section and mesh numbers of its
                                                      !! links are set

    call refuse_same_names(diagnostics, model)
    call find_materials_and_sections(diagnostics, model)
    call find_meshes(diagnostics, model)
    call check_pins(diagnostics, model)
    call check_pin_masses(diagnostics, model)
  end subroutine check_names

  !> Refuses two parts of one kind with the same name, two masses or forces at one pin, two torques
  !! or loads on one link, two reports of one kind.
  subroutine refuse_same_names(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, j

    call refuse_same(model%materials%name, "material")
    call refuse_same(model%sections%name, "section")
    call refuse_same(model%grounds%pin, "ground pivot")
    call refuse_same(model%links%name, "link")
    call refuse_same(model%pin_masses%pin, "mass at pin")
    call refuse_same(model%points%name, "point")
    call refuse_same(model%gauges%name, "gauge")
    call refuse_same(model%forces%pin, "force at pin")
    call refuse_same(model%torques%link_name, "torque on link")
    call refuse_same(model%resistances%link_name, "load on link")
    do i = 2, size(model%reports)
      do j = 1, min(i - 1, most_reports)
        if (len_trim(model%reports(i)%kind%name) == 0 .or. &
          model%reports(i)%kind%name /= model%reports(j)%kind%name) cycle
        call add_error(diagnostics, model%reports(i)%keyword, "this report is asked for twice", &
          model%reports(j)%keyword, "first asked for here")
        exit
      end do
    end do

  contains

    subroutine refuse_same(names, noun)
      type(token_t), intent(in) :: names(:)
      character(len=*), intent(in) :: noun

      type(name_index_t) :: list
      integer :: n, first

      list = new_name_index(token_texts(names))
      do n = 1, size(names)
        first = find_name(list, names(n)%text)
        if (first == n .or. names(n)%line == 0) cycle
        call add_error(diagnostics, names(n), "a second "//noun//" '"//names(n)%text//"'", &
          names(first), "first defined here")
      end do
    end subroutine refuse_same

  end subroutine refuse_same_names

  !> Looks up the materials and sections on LINK cards.
  pure subroutine find_materials_and_sections(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: materials, sections
    integer :: i

    materials = new_name_index(token_texts(model%materials%name))
    sections = new_name_index(token_texts(model%sections%name))
    do i = 1, size(model%links)
      associate (link => model%links(i))
        if (link%material_name%line > 0) call look_up(link%material_name, materials, "material", &
          diagnostics, link%material)
        if (link%section_name%line > 0) call look_up(link%section_name, sections, "section", &
          diagnostics, link%section)
      end associate
    end do
  end subroutine find_materials_and_sections

  !> Gives every link its mesh: a card that names the link takes precedence over `MESH *`.
  pure subroutine find_meshes(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: links
    type(token_t) :: place(0:size(model%links))
    integer :: i, k, link, for_all, misnamed

    links = new_name_index(token_texts(model%links%name))
    for_all = 0
    misnamed = 0
    do i = 1, size(model%meshes)
      do k = 1, size(model%meshes(i)%link_names)
        associate (word => model%meshes(i)%link_names(k))
          link = 0
          if (word%text /= "*") call look_up(word, links, "link", diagnostics, link)
          if (word%text /= "*" .and. link == 0) then
            ! Some link is meant: it is not reported to lack a mesh as well.
            misnamed = i
            cycle
          end if
          if (place(link)%line > 0) then
            call add_error(diagnostics, word, "a second mesh for '"//word%text//"'", place(link), &
              "the first is here")
            cycle
          end if
          place(link) = word
          if (link > 0) then
            model%links(link)%mesh = i
            if (model%links(link)%rigid) call add_error(diagnostics, word, "link '"//word%text// &
              "' is rigid: it has no elements", model%links(link)%rigid_word, &
              "it is rigid by this word")
          end if
          if (link == 0) for_all = i
        end associate
      end do
    end do
    where (model%links%mesh == 0 .and. .not. model%links%rigid) model%links%mesh = merge(for_all, &
      misnamed, for_all > 0)
  end subroutine find_meshes

  !> Finds a name in a list. Errors: it is not in the list; the message suggests the nearest.
  pure subroutine look_up(word, list, noun, diagnostics, number)
    type(token_t), intent(in) :: word                 !! the name, in the deck
    type(name_index_t), intent(in) :: list            !! to search
    character(len=*), intent(in) :: noun              !! kind of name, for the message: `link`
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(out) :: number                    !! in the list, from 1; 0: unknown

    number = find_name(list, word%text)
    if (number == 0) call add_error(diagnostics, word, "unknown "//noun//" '"//word%text//"'"// &
      suggestion(word%text, list%name))
  end subroutine look_up

  !> Every moving pin joins at least two links; every ground pivot carries at least one.
  pure subroutine check_pins(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: grounds, ends
    integer, allocatable :: uses(:)
    integer :: i, k, first

    ! An unreadable card would make the pins on it look unused.
    if (any(model%grounds%pin%line == 0)) return
    do i = 1, size(model%links)
      if (any(model%links(i)%pin%line == 0)) return
    end do
    grounds = new_name_index(token_texts(model%grounds%pin))
    ends = new_name_index(token_texts(link_ends(model%links)))
    allocate (uses(size(ends%name)))
    uses = 0
    do i = 1, size(uses)
      first = find_name(ends, ends%name(i)%text)
      uses(first) = uses(first) + 1
    end do
    do i = 1, size(model%links)
      do k = 1, 2
        associate (pin => model%links(i)%pin(k))
          if (uses(2*(i - 1) + k) /= 1) cycle
          if (find_name(grounds, pin%text) > 0) cycle
          call add_error(diagnostics, pin, "pin '"//pin%text// &
            "' is used once only; a moving pin joins two links"// &
            suggestion(pin%text, other_names(ends, grounds, pin%text)))
        end associate
      end do
    end do
    do i = 1, size(model%grounds)
      if (find_name(ends, model%grounds(i)%pin%text) > 0) cycle
      call add_error(diagnostics, model%grounds(i)%pin, "no link uses the ground pivot '"// &
        model%grounds(i)%pin%text//"'")
    end do
  end subroutine check_pins

  !> The pins of all links: those of link i at 2i − 1 and 2i.
  pure function link_ends(links) result(pins)
    type(link_t), intent(in) :: links(:) !! (links)
    type(token_t) :: pins(2*size(links))

    integer :: i

    do i = 1, size(links)
      pins(2*i - 1:2*i) = links(i)%pin
    end do
  end function link_ends

  !> Names that a misspelt pin may stand for: all pins and ground pivots but itself. Empty for a
  !! deck with more than 100 link ends.
  pure function other_names(ends, grounds, name) result(list)
    type(name_index_t), intent(in) :: ends, grounds
    character(len=*), intent(in) :: name
    type(string_t), allocatable :: list(:)

    integer, parameter :: most_names = 100
    integer :: n

    allocate (list(0))
    if (size(ends%name) > most_names) return
    do n = 1, size(ends%name)
      if (.not. same_word(ends%name(n)%text, name)) list = [list, ends%name(n)]
    end do
    list = [list, grounds%name]
  end function other_names

  !> Pin masses must sit at moving pins; at a ground pivot they only cause a warning.
  pure subroutine check_pin_masses(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: pins, grounds
    integer :: i, number

    pins = new_name_index(token_texts(link_ends(model%links)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%pin_masses)
      associate (pin => model%pin_masses(i)%pin)
        if (pin%line == 0) cycle
        if (find_name(grounds, pin%text) > 0) then
          call add_warning(diagnostics, pin, "a mass at the ground pivot '"//pin%text// &
            "' has no effect")
        else
          call look_up(pin, pins, "pin", diagnostics, number)
        end if
      end associate
    end do
  end subroutine check_pin_masses

end module name_checks
