!> Linkages in parts at rest, each beside LAPACK on nodal matrices of the same parts, and the four-bar of the other tables.
module bench_linkages
  use bench_cases, only: median_of
  use bench_models, only: base_t, read_base
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use ledger, only: ledger_t
  use link_store, only: link_store_t
  use models, only: effects_axial, effects_static, model_t
  use nodal_parts, only: new_nodal_parts, nodal_parts_t, solve_nodal_parts
  use positions, only: by_crank_angle
  use table_rows, only: add_row, rows_t
  use tables, only: column_t, finish_table, integer_cell, integer_column, name_cell, name_column, open_table, &
    real_cells, real_column, table_file_t, write_header, write_rows
  use task_journal, only: journal_t
  use text, only: string_t, to_string
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use vibration_models, only: new_vibration_models, vibration_models_t
  implicit none (type, external)
  private

  public :: linkage_case_t, read_linkages, prepare_linkage, time_linkage, write_linkages, run_model

  !> A deck at an accuracy, and what came of it.
  type :: linkage_case_t
    character(len=:), allocatable :: name
    real(wp) :: accuracy = 0.0_wp
    type(model_t) :: model              !! at rest
    integer :: positions = 0, parts = 0, border = 0, unknowns = 0
    type(nodal_parts_t) :: mesh         !! of the lowest order at which LAPACK's frequencies are as accurate
    integer :: order = 0
    integer, allocatable :: timed(:)    !! positions that LAPACK solves; each is solved alone, so that the others count alike
    real(wp) :: estimate = 0.0_wp       !! largest of the program's estimated errors
    real(wp) :: nodal_error = 0.0_wp    !! largest difference of LAPACK's frequencies to the program's, relative
    real(wp), allocatable :: ours(:), each(:), moving(:), theirs(:) !! processor time a position, one a round [s]
  end type linkage_case_t

  integer, parameter :: modes = 3, most_order = 20

  !> Against which LAPACK's frequencies are compared; processor time that LAPACK may take in a round [s]; positions at least.
  real(wp), parameter :: reference_accuracy = 1.0e-11_wp, most_seconds = 0.2_wp
  integer, parameter :: fewest = 12

contains

  !> The decks of inputs/, each at two accuracies. In a short run two of them. Errors: those of a deck.
  subroutine read_linkages(short, linkages, error)
    logical, intent(in) :: short
    type(linkage_case_t), allocatable, intent(out) :: linkages(:)
    type(error_t), allocatable, intent(out) :: error

    real(wp), parameter :: accuracies(2) = [1.0e-3_wp, 1.0e-8_wp]
    type(base_t) :: base
    character(len=20) :: names(5)
    integer :: i, k

    names = [character(len=20) :: "exact", "flexible_engine", "bending_quick_return", "watt_elbows", "jansen_frames"]
    allocate (linkages(2*merge(2, size(names), short)))
    do i = 1, size(linkages)/2
      call read_base("inputs/"//trim(names(i))//".deck", base, error)
      if (allocated(error)) return
      do k = 1, 2
        associate (this => linkages(2*i - 2 + k))
          this%name = trim(names(i))
          if (i == 1) this%name = "four_bar"
          this%accuracy = accuracies(k)
          this%model = at_rest(base%model, accuracies(k), merge(10, 1, short))
        end associate
      end do
    end do
  end subroutine read_linkages

  !> The model at rest over a turn, three modes, orders by accuracy.
  pure function at_rest(base, accuracy, step) result(model)
    type(model_t), intent(in) :: base
    real(wp), intent(in) :: accuracy
    integer, intent(in) :: step !! [deg]
    type(model_t) :: model

    integer :: i

    model = base
    model%modes = modes
    model%effects = effects_static
    model%crank%value = [(real(i, wp), i=0, 360, step)]
    model%crank%word = [(1, i=0, 360, step)]
    ! The fastest: the others would be solved again and again.
    model%speed%value = [maxval(base%speed%value)]
    model%speed%word = [1]
    do i = 1, size(model%meshes)
      model%meshes(i)%elements = 1
      model%meshes(i)%order = 3
      model%meshes(i)%accuracy = accuracy
    end do
  end function at_rest

  !> Solves a case once, and chooses the order for LAPACK. Errors: a row fails; no order is accurate enough.
  subroutine prepare_linkage(this, error)
    type(linkage_case_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    real(wp) :: seconds, each
    integer :: i, number

    allocate (this%ours(0), this%each(0), this%moving(0), this%theirs(0))
    call run_model(at_rest(this%model, reference_accuracy, 30), run, seconds, each, error)
    if (.not. allocated(error)) call choose_order(this, run, error)
    if (allocated(error)) return
    call run_model(this%model, run, seconds, each, error)
    if (allocated(error)) return
    associate (sweep => run%results%found%sweep)
      this%positions = size(sweep%results)
      this%parts = size(sweep%models%continuum%links)
      this%border = sweep%models%continuum%layout%border
      this%unknowns = sweep%models%continuum%layout%unknowns
      do i = 1, this%positions
        this%estimate = max(this%estimate, maxval(sweep%results(i)%error(:, 1)))
      end do
    end associate
    this%timed = [1]
    call solve_by_lapack(this, run, seconds, error)
    number = min(this%positions, max(fewest, int(most_seconds/max(seconds, tiny(seconds)))))
    this%timed = [(1 + (i*this%positions)/number, i=0, number - 1)]
  end subroutine prepare_linkage

  !> The lowest order of elements, one a part, whose frequencies LAPACK finds as accurately as the program is asked to.
  subroutine choose_order(this, reference, error)
    type(linkage_case_t), intent(inout) :: this
    type(variant_run_t), intent(in) :: reference !! at some positions, more accurate
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: lambda(modes)
    integer :: i

    associate (structure => reference%results%mechanism%structure_t, states => reference%results%found%positions%states, &
        results => reference%results%found%sweep%results)
      do while (this%order < most_order)
        this%order = max(3, this%order + 1)
        call new_nodal_parts(structure%elastic, this%order, this%mesh, error)
        if (allocated(error)) return
        this%nodal_error = 0.0_wp
        do i = 1, size(states)
          call solve_nodal_parts(structure, states(i)%pose, this%mesh, lambda, error)
          if (allocated(error)) return
          this%nodal_error = max(this%nodal_error, maxval(0.5_wp*abs(lambda - results(i)%lambda(:, 1))/results(i)%lambda(:, 1)))
        end do
        if (this%nodal_error <= this%accuracy) return
      end do
    end associate
    call set_error(error, error_of_numerics, this%name//": LAPACK's frequencies differ by "//to_string(this%nodal_error, 2))
  end subroutine choose_order

  !> All that the program does for a deck but reading and writing. Errors: a row fails.
  subroutine run_model(model, run, seconds, each, error)
    type(model_t), intent(in) :: model
    type(variant_run_t), intent(out) :: run
    real(wp), intent(out) :: seconds, each !! of the processor: all, and without the models of the links [s]
    type(error_t), allocatable, intent(out) :: error

    type(journal_t) :: no_journal
    type(link_store_t) :: store, other_store
    type(vibration_models_t) :: models
    type(ledger_t) :: counts
    real(wp) :: begun, ended, made
    integer :: i

    call cpu_time(begun)
    call begin_variant_run(run, model)
    call compute_variant(run, 1, no_journal, -1, store, error)
    call cpu_time(ended)
    seconds = ended - begun
    each = seconds
    if (allocated(error)) return
    associate (found => run%results%found)
      do i = 1, size(found%sweep%results)
        if (.not. allocated(found%sweep%results(i)%outcome(1)%error)) cycle
        call set_error(error, error_of_numerics, found%sweep%results(i)%outcome(1)%error%text)
        return
      end do
      ! What the models take is measured by making them once more.
      call new_vibration_models(run%results%mechanism%structure_t, found%positions, by_crank_angle(found%positions), &
        found%sweep%request, found%sweep%request%accuracy, other_store, models, counts, error)
    end associate
    call cpu_time(made)
    each = seconds - min(seconds, made - ended)
  end subroutine run_model

  !> One more round: the program at rest, LAPACK at once behind it, and the program with the axial forces of the motion.
  subroutine time_linkage(this, error)
    type(linkage_case_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(model_t) :: moving
    real(wp) :: seconds, each, theirs

    call run_model(this%model, run, seconds, each, error)
    if (.not. allocated(error)) call solve_by_lapack(this, run, theirs, error)
    if (allocated(error)) return
    this%ours = [this%ours, seconds/this%positions]
    this%each = [this%each, each/this%positions]
    this%theirs = [this%theirs, theirs]
    moving = this%model
    moving%effects = effects_axial
    call run_model(moving, run, seconds, each, error)
    this%moving = [this%moving, each/this%positions]
  end subroutine time_linkage

  !> Matrices and lowest eigenvalues at the positions that are timed; no vectors, no checks. Errors: dsygvx fails.
  subroutine solve_by_lapack(this, run, seconds, error)
    type(linkage_case_t), intent(inout) :: this
    type(variant_run_t), intent(in) :: run !! with positions
    real(wp), intent(out) :: seconds       !! of the processor, a position
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: lambda(modes), begun, ended
    integer :: i

    call cpu_time(begun)
    do i = 1, size(this%timed)
      call solve_nodal_parts(run%results%mechanism%structure_t, run%results%found%positions%states(this%timed(i))%pose, &
        this%mesh, lambda, error)
      if (allocated(error)) exit
    end do
    call cpu_time(ended)
    seconds = (ended - begun)/size(this%timed)
  end subroutine solve_by_lapack

  !> Writes `linkages.dat`. Errors: the file could not be written.
  subroutine write_linkages(folder, notes, linkages, error)
    character(len=*), intent(in) :: folder
    type(string_t), intent(in) :: notes(:) !! the machine
    type(linkage_case_t), intent(in) :: linkages(:)
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(17)
    type(string_t) :: names(size(linkages))
    integer :: i

    do i = 1, size(linkages)
      names(i)%text = linkages(i)%name
    end do
    call open_table(folder, "linkages", .false., file, error)
    if (allocated(error)) return
    columns(1) = name_column("deck", names)
    columns(2) = real_column("asked", "-")
    columns(3) = integer_column("positions")
    columns(4) = integer_column("parts")
    columns(5) = integer_column("border")
    columns(6) = integer_column("unknowns")
    columns(7) = integer_column("repetitions")
    columns(8) = real_column("median", "s")
    columns(9) = real_column("minimum", "s")
    columns(10) = real_column("each", "s")
    columns(11) = real_column("moving", "s")
    columns(12) = real_column("estimate", "-")
    columns(13) = integer_column("order")
    columns(14) = integer_column("nodal")
    columns(15) = real_column("dsygvx", "s")
    columns(16) = real_column("ratio", "-")
    columns(17) = real_column("difference", "-")
    call write_header(file, "linkages in parts at rest, three modes: processor time per position, beside LAPACK", [notes, &
      string_t("median and minimum: of the program at rest, with what is done once per run; each: the median without that;"), &
      string_t("moving: each, with the axial forces of the deck's highest speed; estimate: largest error column at rest"), &
      string_t("dsygvx: the median of a position in nodal displacements, with matrices, without vectors and checks;"), &
      string_t("order: of its elements, one a part, the lowest whose frequencies differ by less than the accuracy from the"), &
      string_t("program's at 1e-11 (difference: by how much); nodal: its unknowns; ratio: median over rounds of each/dsygvx")], &
      columns)
    do i = 1, size(linkages)
      associate (this => linkages(i))
        call add_row(rows, name_cell(this%name, columns(1)%width)//real_cells([this%accuracy])// &
          integer_cell(this%positions, "positions")//integer_cell(this%parts, "parts")//integer_cell(this%border, "border")// &
          integer_cell(this%unknowns, "unknowns")//integer_cell(size(this%ours), "repetitions")// &
          real_cells([median_of(this%ours), minval(this%ours), median_of(this%each), median_of(this%moving), this%estimate])// &
          integer_cell(this%order, "order")//integer_cell(this%mesh%unknowns - this%mesh%constraints, "nodal")// &
          real_cells([median_of(this%theirs), median_of(this%each/this%theirs), this%nodal_error]))
      end associate
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_linkages

end module bench_linkages
