!> The program's own models of what is timed, made from one deck.
module bench_models
  use bench_cases, only: bench_case_t, with_band, with_dsygv, with_dsygvx
  use deck_checks, only: check_mechanics
  use deck_readings, only: deck_t, read_deck
  use deck_source, only: source_t
  use diagnostics, only: diagnostics_t, has_errors, render_errors
  use errors, only: error_of_input, error_t, set_error
  use exact_values, only: bench_speed
  use kinds, only: wp
  use linkage_cards, only: mesh_t
  use models, only: effects_axial, effects_static, model_t, report_number, solver_auto, solver_band, solver_dense
  use report_cards, only: report_t
  implicit none (type, external)
  private

  public :: base_t, read_base, model_of, refusal

  !> The deck that all cases are made from.
  type :: base_t
    type(model_t) :: model
    type(source_t) :: source
  end type base_t

contains

  !> The model of a deck, with frequencies as its only report. Errors: those of the deck.
  subroutine read_base(path, base, error)
    character(len=*), intent(in) :: path
    type(base_t), intent(out) :: base
    type(error_t), allocatable, intent(out) :: error

    type(deck_t) :: deck
    type(report_t), allocatable :: reports(:)
    type(mesh_t), allocatable :: meshes(:)
    integer :: i

    call read_deck(path, 1, deck)
    if (len(deck%errors) > 0) then
      call set_error(error, error_of_input, "this deck is refused:"//achar(10)//deck%errors, path)
      return
    end if
    base%model = deck%model
    base%source = deck%source
    associate (model => base%model)
      allocate (reports(1))
      reports(1) = model%reports(report_number(model, "frequencies"))
      call move_alloc(reports, model%reports)
      ! A mesh for every link.
      allocate (meshes(size(model%links)))
      do i = 1, size(meshes)
        meshes(i) = model%meshes(model%links(i)%mesh)
        model%links(i)%mesh = i
      end do
      call move_alloc(meshes, model%meshes)
    end associate
  end subroutine read_base

  !> The model that a deck of a case would give.
  pure function model_of(base, this) result(model)
    type(base_t), intent(in) :: base
    type(bench_case_t), intent(in) :: this
    type(model_t) :: model

    integer :: i

    model = base%model
    model%modes = this%modes
    model%crank%value = [((i - 1)*this%step, i=1, this%positions)]
    model%crank%word = [(1, i=1, this%positions)]
    model%speed%value = [merge(bench_speed, 0.0_wp, this%moving)]
    model%speed%word = [1]
    model%effects = merge(effects_axial, effects_static, this%moving)
    model%solver = solver_auto
    if (any(this%solver == [with_dsygv, with_dsygvx])) model%solver = solver_dense
    if (this%solver == with_band) model%solver = solver_band
    do i = 1, size(model%links)
      associate (mesh => model%meshes(i))
        mesh%elements = this%elements(i)
        mesh%order = this%order(i)
        mesh%accuracy = this%accuracy
      end associate
    end do
  end function model_of

  !> What the program says first where it refuses such a deck; empty if it does not.
  function refusal(base, model) result(message)
    type(base_t), intent(in) :: base
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: message

    character(len=*), parameter :: mark = ": error: "
    type(diagnostics_t) :: diagnostics

    message = ""
    call check_mechanics(model, diagnostics)
    if (.not. has_errors(diagnostics)) return
    message = render_errors(diagnostics, base%source)
    message = message(index(message, mark) + len(mark):index(message, achar(10)) - 1)
  end function refusal

end module bench_models
