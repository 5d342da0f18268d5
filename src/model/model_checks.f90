!> Checks of names and values across cards, and what follows from them: who refers to whom, and the way round the loop.
module model_checks
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use kinds, only: wp
  use linkage_cards, only: link_t
  use models, only: effects_static, inertia_lumped, inertia_none, is_moving, model_t, needs_frequencies, needs_loads, &
    report_number
  use name_index, only: find_name, name_index_t, new_name_index
  use requests, only: report_inertia, report_kinds, report_mesh, report_shapes, report_t, value_list_t
  use spelling, only: suggestion
  use text, only: joined, same_word, string_t, to_string, word_list
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: check_model

  !> A link stubbier than this is no beam: shear and rotary inertia, which the theory leaves out, decide.
  real(wp), parameter :: least_slenderness = 10.0_wp

contains

  !> Looks up every name, checks what cards say of each other, and finds the links' order round the loop.
  subroutine check_model(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    call check_required(cards, diagnostics, model)
    call refuse_same_names(diagnostics, model)
    call find_materials_and_sections(diagnostics, model)
    call check_pins(diagnostics, model)
    call check_pin_masses(diagnostics, model)
    call find_meshes(diagnostics, model)
    call find_loop(diagnostics, model)
    call check_what_reports_need(diagnostics, model)
    call check_shapes(diagnostics, model)
    call warn_of_stubby_links(diagnostics, model)
    call warn_of_static_speeds(cards, diagnostics, model)
  end subroutine check_model

  !> Cards that no deck can do without.
  subroutine check_required(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    if (.not. has_card("GROUND") .or. .not. has_card("LINK")) then
      call missing("there are no "//trim(merge("GROUND", "LINK  ", .not. has_card("GROUND")))//" cards: no linkage is described")
    end if
    if (.not. has_card("DRIVE")) call missing("the linkage is not driven; expected: DRIVE link")
    if (.not. has_card("CRANK")) call missing("there is no CRANK card; expected: CRANK a to b step s, or a list of angles")
    if (size(model%reports) == 0) then
      call missing("there is no REPORT card; expected REPORT and one of: "//joined(word_list(report_kinds)))
    end if

  contains

    function has_card(keyword) result(has)
      character(len=*), intent(in) :: keyword
      logical :: has

      integer :: i

      has = .false.
      do i = 1, size(cards)
        has = has .or. same_word(cards(i)%keyword%text, keyword)
      end do
    end function has_card

    subroutine missing(message)
      character(len=*), intent(in) :: message

      call add_error(diagnostics, token_t("", 0, 0), message)
    end subroutine missing

  end subroutine check_required

  !> Two parts of one kind with the same name, two masses at one pin, two reports of one kind.
  subroutine refuse_same_names(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, j

    call refuse_same(model%materials%name, "material")
    call refuse_same(model%sections%name, "section")
    call refuse_same(model%grounds%pin, "ground pivot")
    call refuse_same(model%links%name, "link")
    call refuse_same(model%pin_masses%pin, "mass at pin")
    do i = 2, size(model%reports)
      do j = 1, min(i - 1, size(word_list(report_kinds)) + 1)
        if (model%reports(i)%kind == 0 .or. model%reports(i)%kind /= model%reports(j)%kind) cycle
        call add_error(diagnostics, model%reports(i)%keyword, "this report is asked for twice", model%reports(j)%keyword, &
          "first asked for here")
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
        if (first == n) cycle
        call add_error(diagnostics, names(n), "a second "//noun//" '"//names(n)%text//"'", names(first), &
          "first defined here")
      end do
    end subroutine refuse_same

  end subroutine refuse_same_names

  pure subroutine find_materials_and_sections(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: materials, sections
    integer :: i

    materials = new_name_index(token_texts(model%materials%name))
    sections = new_name_index(token_texts(model%sections%name))
    do i = 1, size(model%links)
      associate (link => model%links(i))
        if (link%material_name%line > 0) call look_up(link%material_name, materials, "material", diagnostics, link%material)
        if (link%section_name%line > 0) call look_up(link%section_name, sections, "section", diagnostics, link%section)
      end associate
    end do
  end subroutine find_materials_and_sections

  !> The pins of all links: those of link i at 2i − 1 and 2i.
  pure function link_ends(links) result(pins)
    type(link_t), intent(in) :: links(:)
    type(token_t) :: pins(2*size(links))

    integer :: i

    do i = 1, size(links)
      pins(2*i - 1:2*i) = links(i)%pin
    end do
  end function link_ends

  !> Finds a name in a list, or complains and offers the nearest.
  pure subroutine look_up(word, list, noun, diagnostics, number)
    type(token_t), intent(in) :: word
    type(name_index_t), intent(in) :: list
    character(len=*), intent(in) :: noun
    type(diagnostics_t), intent(inout) :: diagnostics
    integer, intent(out) :: number

    number = find_name(list, word%text)
    if (number == 0) call add_error(diagnostics, word, "unknown "//noun//" '"//word%text//"'"//suggestion(word%text, list%name))
  end subroutine look_up

  !> Every pin joins two links; every ground pivot carries one.
  pure subroutine check_pins(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: grounds, ends
    integer, allocatable :: uses(:)
    integer :: i, k, first

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
          if (pin%line == 0 .or. uses(2*(i - 1) + k) /= 1) cycle
          if (find_name(grounds, pin%text) > 0) cycle
          call add_error(diagnostics, pin, "pin '"//pin%text//"' is used once only; a moving pin joins two links"// &
            suggestion(pin%text, other_names(ends, grounds, pin%text)))
        end associate
      end do
    end do
    do i = 1, size(model%grounds)
      if (find_name(ends, model%grounds(i)%pin%text) > 0) cycle
      call add_error(diagnostics, model%grounds(i)%pin, "no link uses the ground pivot '"//model%grounds(i)%pin%text//"'")
    end do
  end subroutine check_pins

  !> The names that a misspelt pin may stand for: all but itself. A deck of many pins is not searched.
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

  pure subroutine check_pin_masses(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: pins, grounds
    integer :: i, number

    pins = new_name_index(token_texts(link_ends(model%links)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%pin_masses)
      associate (pin => model%pin_masses(i)%pin)
        if (find_name(grounds, pin%text) > 0) then
          call add_warning(diagnostics, pin, "a mass at the ground pivot '"//pin%text//"' has no effect")
        else
          call look_up(pin, pins, "pin", diagnostics, number)
        end if
      end associate
    end do
  end subroutine check_pin_masses

  !> Gives every link its mesh: a card that names the link goes before `MESH *`.
  pure subroutine find_meshes(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: links
    type(token_t) :: place(0:size(model%links))
    integer :: i, k, link, for_all

    links = new_name_index(token_texts(model%links%name))
    for_all = 0
    do i = 1, size(model%meshes)
      do k = 1, size(model%meshes(i)%link_names)
        associate (word => model%meshes(i)%link_names(k))
          link = 0
          if (word%text /= "*") call look_up(word, links, "link", diagnostics, link)
          if (word%text /= "*" .and. link == 0) cycle
          if (place(link)%line > 0) then
            call add_error(diagnostics, word, "a second mesh for '"//word%text//"'", place(link), "the first is here")
            cycle
          end if
          place(link) = word
          if (link > 0) model%links(link)%mesh = i
          if (link == 0) for_all = i
        end associate
      end do
    end do
    where (model%links%mesh == 0) model%links%mesh = for_all
  end subroutine find_meshes

  !> Finds the links' order round the four-bar: driven link, coupler, follower.
  subroutine find_loop(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: links, grounds
    type(token_t) :: pin
    integer :: i, position, link, grounded, far_end
    logical :: used(size(model%links))

    links = new_name_index(token_texts(model%links%name))
    grounds = new_name_index(token_texts(model%grounds%pin))
    link = 0
    if (model%drive%line > 0) call look_up(model%drive, links, "link", diagnostics, link)
    allocate (model%loop(3), model%loop_pins(4))
    model%loop = 0
    if (link == 0 .or. has_errors(diagnostics)) return

    grounded = count([(find_name(grounds, model%links(link)%pin(i)%text) > 0, i=1, 2)])
    if (size(model%links) /= 3 .or. size(model%grounds) /= 2) then
      call add_error(diagnostics, model%links(min(4, size(model%links)))%name, "only the four-bar can be solved: three links "// &
        "and two ground pivots; this deck has "//to_string(size(model%links))//" and "//to_string(size(model%grounds)))
      return
    else if (grounded /= 1) then
      call add_error(diagnostics, model%drive, "the driven link '"//model%drive%text//"' "// &
        trim(merge("turns about no ground pivot", "joins the two ground pivots", grounded == 0)))
      return
    end if

    used = .false.
    pin = model%links(link)%pin(merge(1, 2, find_name(grounds, model%links(link)%pin(1)%text) > 0))
    model%loop_pins(1) = pin
    do position = 1, 3
      used(link) = .true.
      model%loop(position) = link
      far_end = merge(2, 1, same_word(model%links(link)%pin(1)%text, pin%text))
      pin = model%links(link)%pin(far_end)
      model%loop_pins(position + 1) = pin
      if (position == 3) exit
      link = link_at(model%links, used, pin%text)
      if (link == 0 .or. find_name(grounds, pin%text) > 0) then
        call add_error(diagnostics, model%links(model%loop(position))%name, "the links do not form a loop: after '"// &
          model%links(model%loop(position))%name%text//"' it does not go on")
        return
      end if
    end do
  end subroutine find_loop

  !> The link not yet met that has a pin; 0 if there is none.
  pure function link_at(links, used, name) result(number)
    type(link_t), intent(in) :: links(:)
    logical, intent(in) :: used(:) !! (links)
    character(len=*), intent(in) :: name
    integer :: number

    integer :: n

    number = 0
    do n = 1, size(links)
      if (used(n)) cycle
      if (same_word(links(n)%pin(1)%text, name) .or. same_word(links(n)%pin(2)%text, name)) number = n
    end do
  end function link_at

  !> Beams need material, section and mesh; loads need INERTIA.
  subroutine check_what_reports_need(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, inertia, mesh
    logical :: needs_beams, needs_mass, needs_mesh

    inertia = report_number(model, report_inertia)
    mesh = report_number(model, report_mesh)
    needs_beams = needs_frequencies(model) .or. mesh > 0
    needs_mass = needs_beams .or. inertia > 0
    needs_mesh = needs_beams .or. (inertia > 0 .and. model%inertia == inertia_lumped)
    do i = 1, size(model%links)
      associate (link => model%links(i))
        if (needs_mass .and. link%material_name%line == 0) call complain(link, "material")
        if (needs_mass .and. link%section_name%line == 0) call complain(link, "section")
        if (needs_mesh .and. link%mesh == 0) call complain(link, "mesh")
      end associate
    end do
    if (model%inertia /= inertia_none) return
    if (inertia > 0) then
      call add_error(diagnostics, model%reports(inertia)%keyword, &
        "this report uses inertia loads, and there is no INERTIA card; expected: INERTIA lumped or INERTIA distributed")
    else if (needs_loads(model)) then
      call add_error(diagnostics, token_t("", 0, 0), "frequencies under the loads of the motion are asked for, "// &
        "and there is no INERTIA card; expected: INERTIA lumped or INERTIA distributed")
    end if

  contains

    subroutine complain(link, what)
      type(link_t), intent(in) :: link
      character(len=*), intent(in) :: what

      call add_error(diagnostics, link%name, "link '"//link%name%text//"' has no "//what//", which the reports asked for need")
    end subroutine complain

  end subroutine check_what_reports_need

  !> Shapes are drawn where positions are computed.
  subroutine check_shapes(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, number

    number = report_number(model, report_shapes)
    if (number == 0) return
    associate (report => model%reports(number))
      call check_values(report%crank, model%crank, "crank angle", "CRANK")
      if (model%effects == effects_static .and. size(report%speed%value) > 0) then
        call add_error(diagnostics, report%speed%words(1), &
          "static shapes do not depend on the speed: 'speed=' has no meaning here")
      else
        call check_values(report%speed, model%speed, "speed", "SPEED")
      end if
    end associate

  contains

    subroutine check_values(wanted, given, noun, card)
      type(value_list_t), intent(in) :: wanted, given
      character(len=*), intent(in) :: noun, card

      do i = 1, size(wanted%value)
        if (size(given%value) == 0 .or. value_number(given, wanted%value(i)) > 0) cycle
        call add_error(diagnostics, wanted%words(wanted%word(i)), "the "//noun//" "//to_string(wanted%value(i))// &
          " is not on the "//card//" card")
      end do
    end subroutine check_values

  end subroutine check_shapes

  !> Number of a value in a list, allowing for the last digits of ranges and of conversions; 0 if it is not there.
  pure function value_number(list, value) result(number)
    type(value_list_t), intent(in) :: list
    real(wp), intent(in) :: value
    integer :: number

    do number = size(list%value), 1, -1
      if (abs(list%value(number) - value) <= 1.0e-9_wp*max(1.0_wp, abs(value))) return
    end do
  end function value_number

  pure subroutine warn_of_stubby_links(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    if (.not. needs_frequencies(model)) return
    do i = 1, size(model%links)
      associate (link => model%links(i))
        if (link%section == 0 .or. link%length <= 0.0_wp) cycle
        associate (depth => model%sections(link%section)%depth)
          if (depth <= 0.0_wp .or. link%length >= least_slenderness*depth) cycle
          call add_warning(diagnostics, link%length_word, "link '"//link%name%text//"' is only "// &
            to_string(link%length/depth, 3)//" times as long as thick; slender-beam theory wants 10 or more")
        end associate
      end associate
    end do
  end subroutine warn_of_stubby_links

  pure subroutine warn_of_static_speeds(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    if (model%effects /= effects_static .or. .not. is_moving(model) .or. .not. needs_frequencies(model)) return
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "EFFECTS")) cycle
      call add_warning(diagnostics, cards(i)%keyword, &
        "static frequencies do not depend on the speed: they are computed once, whatever SPEED says")
    end do
  end subroutine warn_of_static_speeds

end module model_checks
