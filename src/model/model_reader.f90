!> Cards → model.
module model_reader
  use body_checks, only: check_bodies
  use card_reader, only: check_form, read_choice
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use effect_cards, only: effects_axial, effects_static, effects_t, read_effects
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: wp
  use linkage_cards, only: set_default_mesh
  use loop_finder, only: find_loop
  use mesh_checks, only: check_meshes
  use models, only: is_loaded, is_moving, model_t, needs_mesh
  use name_checks, only: check_names
  use numbers, only: read_integer
  use part_reader, only: read_parts
  use report_kinds, only: report_kind_t
  use request_cards, only: read_crank, read_speed
  use request_checks, only: card_names, check_requests, check_required
  use shear, only: check_shear
  use spelling, only: suggestion
  use text, only: lower_case, same_word, string_t, to_string, word_list
  use tokens, only: token_t
  use units, only: dimension_length, dimension_mass, dimension_time, read_unit, si_units, &
    unit_system_t, unit_t, wrong_unit
  implicit none (type, external)
  private

  public :: read_model

contains

  !> Turns cards into a model and checks all that can be checked without mechanics.
  !!
  !! The model is complete only if `diagnostics` has no errors afterwards.
  subroutine read_model(cards, reports, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(report_kind_t), intent(in) :: reports(:) !! that there are
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(out) :: model

    model%title = ""
    model%variant = ""
    allocate (model%varied(0))
    model%drive = token_t("", 0, 0)
    model%shear_word = token_t("", 0, 0)
    model%modes_word = token_t("", 0, 0)
    model%inertia_word = token_t("", 0, 0)
    model%solver_word = token_t("", 0, 0)
    model%gravity_word = token_t("", 0, 0)
    model%motor%keyword = token_t("", 0, 0)
    allocate (model%crank%value(0), model%crank%word(0), model%crank%words(0))
    model%speed%value = [0.0_wp]
    model%speed%word = [0]
    allocate (model%speed%words(0))

    call check_keywords(cards, diagnostics)
    call refuse_second_cards(cards, diagnostics)
    call read_units(cards, diagnostics, model%units)
    call read_parts(cards, reports, diagnostics, model)
    call read_requests(cards, diagnostics, model)
    if (size(model%meshes) == 0 .and. needs_mesh(model)) then
      deallocate (model%meshes)
      allocate (model%meshes(1))
      call set_default_mesh(model%meshes(1))
    end if
    call check_required(cards, reports, diagnostics, model)
    call check_names(diagnostics, model)
    call check_bodies(diagnostics, model)
    call find_loop(diagnostics, model)
    call check_requests(cards, diagnostics, model)
    call check_shear(diagnostics, model)
    call check_meshes(cards, diagnostics, model)
  end subroutine read_model

  !> Complains about every card that does not exist.
  pure subroutine check_keywords(cards, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    type(string_t), allocatable :: known(:)
    integer :: i, k

    known = word_list(card_names)
    do i = 1, size(cards)
      associate (keyword => cards(i)%keyword)
        if (any([(same_word(known(k)%text, keyword%text), k=1, size(known))])) cycle
        call add_error(diagnostics, keyword, "unknown card '"//keyword%text//"'"// &
          suggestion(keyword%text, known))
      end associate
    end do
  end subroutine check_keywords

  !> Most cards say something that can be said only once.
  pure subroutine refuse_second_cards(cards, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=*), parameter :: single = &
      "TITLE UNITS GRAVITY MOTOR BRANCH CRANK SPEED INERTIA EFFECTS SOLVER MODES"
    type(string_t), allocatable :: names(:)
    integer :: i, k, first

    names = word_list(single)
    do k = 1, size(names)
      first = 0
      do i = 1, size(cards)
        if (.not. same_word(cards(i)%keyword%text, names(k)%text)) cycle
        if (first > 0) then
          call add_error(diagnostics, cards(i)%keyword, "a second "//names(k)%text//" card", &
            cards(first)%keyword, "the first is here")
        else
          first = i
        end if
      end do
    end do
  end subroutine refuse_second_cards

  !> Reads `UNITS length mass time`, which may stand anywhere. A deck without it is read on in SI,
  !! to find its other errors.
  subroutine read_units(cards, diagnostics, system)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(unit_system_t), intent(out) :: system

    integer :: i
    logical :: fine

    system = si_units()
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "UNITS")) cycle
      call check_form(cards(i), 3, 3, "", "UNITS length mass time", diagnostics, fine)
      if (.not. fine) exit
      call read_one(cards(i)%words(1), dimension_length, system%length)
      call read_one(cards(i)%words(2), dimension_mass, system%mass)
      call read_one(cards(i)%words(3), dimension_time, system%time)
      exit
    end do

  contains

    subroutine read_one(word, dimension, measure)
      type(token_t), intent(in) :: word
      integer, intent(in) :: dimension(4)
      type(unit_t), intent(inout) :: measure

      type(unit_t) :: candidate
      type(error_t), allocatable :: error

      call read_unit(word%text, dimension, candidate, error)
      if (allocated(error)) then
        call add_error(diagnostics, word, error%text)
      else if (any(candidate%dimension /= dimension)) then
        call add_error(diagnostics, word, wrong_unit(candidate, dimension))
      else
        measure = candidate
      end if
    end subroutine read_one

  end subroutine read_units

  !> Reads the cards that say what to compute, and settles what follows from what they leave out.
  subroutine read_requests(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    integer :: i
    type(effects_t) :: effects
    logical :: fine

    effects%shear_word = token_t("", 0, 0)
    do i = 1, size(cards)
      select case (lower_case(cards(i)%keyword%text))
      case ("title")
        if (size(cards(i)%words) == 0) cycle
        model%title = cards(i)%words(1)%text
        if (cards(i)%words(1)%column == cards(i)%keyword%column + len("TITLE")) then
          call add_error(diagnostics, cards(i)%words(1), &
            "a blank must stand between TITLE and its text")
        end if
      case ("drive")
        call check_form(cards(i), 1, 1, "", "DRIVE link", diagnostics, fine)
        if (.not. fine) cycle
        if (model%drive%line > 0) then
          call add_error(diagnostics, cards(i)%words(1), &
            "the linkage is driven twice; it has one driven link", model%drive, "first driven here")
        else
          model%drive = cards(i)%words(1)
        end if
      case ("branch")
        call read_option(cards(i), "BRANCH open|crossed", "open crossed", model%branch)
      case ("crank")
        call read_crank(cards(i), model%units, diagnostics, model%crank)
      case ("speed")
        call read_speed(cards(i), model%units, diagnostics, model%speed, model%acceleration)
      case ("inertia")
        call read_option(cards(i), "INERTIA lumped|distributed", "lumped distributed", &
          model%inertia, model%inertia_word)
      case ("effects")
        call read_effects(cards(i), diagnostics, effects)
      case ("solver")
        call read_option(cards(i), "SOLVER auto|deformation|dense|band", &
          "auto deformation dense band", model%solver, model%solver_word)
      case ("modes")
        call read_modes(cards(i), diagnostics, model)
      end select
    end do
    model%effects = effects%loads
    if (effects%loads == 0) model%effects = merge(effects_axial, effects_static, &
      is_moving(model) .or. is_loaded(model))
    model%rotary = effects%rotary
    model%shear = effects%shear
    model%shear_word = effects%shear_word

  contains

    subroutine read_option(card, pattern, choices, option, word)
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: pattern, choices
      integer, intent(inout) :: option
      type(token_t), intent(inout), optional :: word

      integer :: choice

      call check_form(card, 1, 1, "", pattern, diagnostics, fine)
      if (.not. fine) return
      call read_choice(card%words(1), choices, diagnostics, choice)
      if (choice == 0) return
      option = choice
      if (present(word)) word = card%words(1)
    end subroutine read_option

  end subroutine read_requests

  pure subroutine read_modes(card, diagnostics, model)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(error_t), allocatable :: error
    logical :: fine
    integer :: modes

    call check_form(card, 1, 1, "", "MODES number", diagnostics, fine)
    if (.not. fine) return
    call read_integer(card%words(1)%text, modes, error)
    if (.not. allocated(error) .and. modes < 1) call set_error(error, error_of_input, &
      "the number of modes must be at least 1, not "//to_string(modes))
    if (allocated(error)) then
      call add_error(diagnostics, card%words(1), error%text)
    else
      model%modes = modes
      model%modes_word = card%words(1)
    end if
  end subroutine read_modes

end module model_reader
