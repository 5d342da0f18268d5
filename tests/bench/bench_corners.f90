!> Decks that cost the program most (tests/bench/corners/), each beside LAPACK on nodal matrices of the same links.
module bench_corners
  use assembly, only: add_axial_jumps, assemble_geometric_stiffness, assemble_mass, assemble_stiffness
  use axial_forces, only: axial_jumps
  use band_matrix, only: band_matrix_t, full_matrix, order_of
  use bench_cases, only: median_of
  use deck_readings, only: deck_t, read_deck
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use load_cases, only: case_count, find_unit_loads, unit_loads_t
  use mechanisms, only: mechanism_t, new_mechanism
  use mesh_forces, only: find_element_forces
  use models, only: effects_axial, model_t, solver_dense
  use nodal_parts, only: find_eigenvalues
  use positions, only: find_positions, positions_t, state_t
  use table_rows, only: add_row, rows_t
  use tables, only: column_t, finish_table, integer_cell, integer_column, name_cell, name_column, open_table, &
    real_cells, real_column, table_file_t, write_header, write_rows
  use task_journal, only: journal_t
  use text, only: string_t, to_string
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use vibration_models, only: by_orders, load_factors, mode_request_t
  implicit none (type, external)
  private

  public :: corner_t, read_corners, prepare_corner, time_corner, write_corners

  !> A deck, and what came of it.
  type :: corner_t
    character(len=:), allocatable :: name
    integer :: elements(3) = 1, order(3) = 3 !! of every link, for LAPACK: where possible so that its error is below the deck's 1e-8
    type(model_t) :: model
    integer :: rows = 0, modes = 0
    integer :: unknowns = 0, nodal_unknowns = 0
    integer, allocatable :: timed(:)    !! positions that LAPACK solves; each is solved alone, so that the others count alike
    integer :: most_rounds = 0          !! how often it is timed after the first time: slow decks less often
    real(wp), allocatable :: lambda(:, :) !! (modes, states) what the program found [1/s²]
    real(wp) :: nodal_error = 0.0_wp    !! largest difference of LAPACK's frequencies to the program's, relative
    character(len=:), allocatable :: failure !! why LAPACK is not timed
    real(wp), allocatable :: ours(:), theirs(:) !! processor time a row, one a round [s]
  end type corner_t

  !> Processor time that LAPACK may take in a round, and those of a whole run above which a deck is timed three times or once [s].
  real(wp), parameter :: most_seconds = 0.3_wp, thrice_above = 1.0_wp, once_above = 5.0_wp
  integer, parameter :: many = 6, thrice = 2 !! times more

contains

  !> The decks, in the order of the table. In a short run two of them. Errors: those of a deck.
  subroutine read_corners(short, corners, error)
    logical, intent(in) :: short
    type(corner_t), allocatable, intent(out) :: corners(:)
    type(error_t), allocatable, intent(out) :: error

    type(deck_t) :: deck
    integer :: i

    ! Elements of the nodal meshes end at the masses where there are few of them.
    corners = [new_corner("strip_3", [1, 1, 1], [6, 8, 9]), &
               new_corner("stout_5", [1, 1, 1], [9, 11, 11]), &
               new_corner("stout_20", [1, 1, 1], [15, 26, 26]), &
               new_corner("stout_20_apart", [1, 1, 1], [15, 26, 26]), &
               new_corner("stout_20_diverged", [1, 1, 1], [18, 30, 24]), &
               new_corner("strip_20_apart", [1, 1, 1], [12, 24, 24]), &
               new_corner("stout_3_masses", [10, 10, 10], [7, 8, 8]), &
               new_corner("stout_10_masses", [100, 100, 100], [3, 3, 3]), &
               new_corner("strip_40_masses", [40, 40, 40], [4, 4, 4]), &
               new_corner("strip_100_apart", [1, 1, 1], [38, 74, 72]), &
               new_corner("stout_100_apart", [1, 1, 1], [45, 84, 82]), &
               new_corner("stout_50_elements", [50, 50, 50], [3, 3, 3]), &
               new_corner("strip_30_dense", [30, 30, 30], [3, 3, 3])]
    if (short) corners = corners([1, 4])
    do i = 1, size(corners)
      associate (path => "tests/bench/corners/"//corners(i)%name//".deck")
        call read_deck(path, 1, deck)
        if (len(deck%errors) > 0) then
          call set_error(error, error_of_input, "this deck is refused:"//achar(10)//deck%errors, path)
          return
        end if
      end associate
      corners(i)%model = deck%model
    end do
  end subroutine read_corners

  pure function new_corner(name, elements, order) result(new)
    character(len=*), intent(in) :: name
    integer, intent(in) :: elements(3), order(3) !! of the nodal mesh
    type(corner_t) :: new

    new%name = name
    new%elements = elements
    new%order = order
    new%failure = ""
  end function new_corner

  !> The first round of a deck: rows, unknowns, the error of LAPACK beside it, how often both are timed again. Errors: a row fails.
  subroutine prepare_corner(this, error)
    type(corner_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    type(error_t), allocatable :: failure
    real(wp) :: seconds, one
    integer :: i, states

    allocate (this%theirs(0))
    call run_deck(this, run, seconds, error)
    if (allocated(error)) return
    if (seconds <= once_above) this%most_rounds = thrice
    if (seconds <= thrice_above) this%most_rounds = many
    associate (sweep => run%results%found%sweep)
      states = size(run%results%found%positions%states)
      this%rows = states*size(sweep%request%speed)
      this%modes = sweep%request%modes
      this%unknowns = run%results%mechanism%mesh%unknowns
      if (sweep%request%method == by_orders) this%unknowns = sweep%models%continuum%layout%unknowns
      allocate (this%lambda(this%modes, states))
      do i = 1, states
        if (allocated(sweep%results(i)%outcome(1)%error)) then
          call set_error(error, error_of_numerics, this%name//": "//sweep%results(i)%outcome(1)%error%text)
          return
        end if
        this%lambda(:, i) = sweep%results(i)%lambda(:, 1)
      end do
    end associate

    mechanism = new_mechanism(nodal_model(this))
    positions = find_positions(mechanism%linkage, this%model%crank%value)
    this%nodal_unknowns = mechanism%mesh%unknowns
    this%ours = [seconds/this%rows]
    this%timed = [1]
    call solve_by_lapack(this, mechanism, positions, run%results%found%sweep%request, one, failure)
    i = min(states, max(2, int(most_seconds/max(one, tiny(one)))))
    this%timed = spread_numbers(states, i)
    if (.not. allocated(failure)) call solve_by_lapack(this, mechanism, positions, run%results%found%sweep%request, one, failure)
    if (allocated(failure)) then
      this%failure = failure%text
    else
      this%theirs = [one/size(this%timed)]
    end if
  end subroutine prepare_corner

  !> Some of the numbers from 1 to the last, evenly spread.
  pure function spread_numbers(last, wanted) result(numbers)
    integer, intent(in) :: last, wanted
    integer, allocatable :: numbers(:)

    integer :: i

    numbers = [(1 + ((i - 1)*last)/wanted, i=1, wanted)]
  end function spread_numbers

  !> One more round: the program, and LAPACK at once behind it.
  subroutine time_corner(this, error)
    type(corner_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    real(wp) :: seconds

    call run_deck(this, run, seconds, error)
    if (allocated(error)) return
    this%ours = [this%ours, seconds/this%rows]
    if (len(this%failure) > 0) return
    mechanism = new_mechanism(nodal_model(this))
    positions = find_positions(mechanism%linkage, this%model%crank%value)
    call solve_by_lapack(this, mechanism, positions, run%results%found%sweep%request, seconds, error)
    this%theirs = [this%theirs, seconds/size(this%timed)]
  end subroutine time_corner

  !> All that the program does for a deck but reading and writing.
  subroutine run_deck(this, run, seconds, error)
    type(corner_t), intent(in) :: this
    type(variant_run_t), intent(out) :: run
    real(wp), intent(out) :: seconds !! of the processor
    type(error_t), allocatable, intent(out) :: error

    type(journal_t) :: no_journal
    type(link_store_t) :: store
    real(wp) :: begun, ended

    call cpu_time(begun)
    call begin_variant_run(run, this%model)
    call compute_variant(run, 1, no_journal, -1, store, error)
    call cpu_time(ended)
    seconds = ended - begun
  end subroutine run_deck

  !> The same links with the mesh for LAPACK.
  pure function nodal_model(this) result(model)
    type(corner_t), intent(in) :: this
    type(model_t) :: model

    integer :: i

    model = this%model
    model%solver = solver_dense
    model%meshes = [(model%meshes(model%links(i)%mesh), i=1, size(model%links))]
    do i = 1, size(model%links)
      model%links(i)%mesh = i
    end do
    do i = 1, size(model%links)
      associate (mesh => model%meshes(i))
        mesh%elements = this%elements(i)
        mesh%order = this%order(i)
        mesh%accuracy = 0.0_wp
      end associate
    end do
  end function nodal_model

  !> Matrices and lowest eigenvalues at the positions that are timed; no vectors, no checks. Errors: dsygvx fails.
  subroutine solve_by_lapack(this, mechanism, positions, request, seconds, error)
    type(corner_t), intent(inout) :: this     !! gets the error
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(mode_request_t), intent(in) :: request
    real(wp), intent(out) :: seconds          !! of the processor
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: lambda(this%modes, size(this%timed)), begun, ended
    integer :: i

    lambda = 0.0_wp
    call cpu_time(begun)
    do i = 1, size(this%timed)
      call solve_state(mechanism, positions%states(this%timed(i)), request, lambda(:, i), error)
      if (allocated(error)) exit
    end do
    call cpu_time(ended)
    seconds = ended - begun
    if (.not. allocated(error)) &
      this%nodal_error = maxval(0.5_wp*abs(lambda - this%lambda(:, this%timed))/abs(this%lambda(:, this%timed)))
  end subroutine solve_by_lapack

  !> `K x = λ M x` by dsygvx where compression may leave K indefinite, `M x = θ K x`, which keeps more digits, elsewhere.
  subroutine solve_state(mechanism, state, request, lambda, error)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    real(wp), intent(out) :: lambda(:)
    type(error_t), allocatable, intent(out) :: error

    type(band_matrix_t) :: stiffness, mass
    integer :: info

    call assemble(mechanism, state, request, stiffness, mass)
    call find_eigenvalues(full_matrix(mass), full_matrix(stiffness), order_of(mass), size(lambda), .true., lambda, info)
    if (info == 0) then
      lambda = 1.0_wp/lambda(size(lambda):1:-1)
    else
      call find_eigenvalues(full_matrix(stiffness), full_matrix(mass), order_of(mass), size(lambda), .false., lambda, info)
    end if
    if (info /= 0) call set_error(error, error_of_numerics, "dsygvx failed (info = "//to_string(info)//")")
  end subroutine solve_state

  !> As the program does for SOLVER dense.
  subroutine assemble(mechanism, state, request, stiffness, mass)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    type(band_matrix_t), intent(out) :: stiffness, mass

    type(band_matrix_t) :: geometric
    type(unit_loads_t) :: loads
    type(joint_forces_t) :: joints
    real(wp) :: in_element(3, sum(mechanism%mesh%elements)), factor(case_count, size(request%speed))
    integer :: b, i

    associate (linkage => mechanism%linkage, mesh => mechanism%mesh)
      stiffness = assemble_stiffness(linkage, mechanism%beams, mesh, state%pose)
      mass = assemble_mass(linkage, mesh, state%pose)
      factor = load_factors(request)
      loads = find_unit_loads(linkage, state%pose, state%coefficients, abs(factor(:, 1)) > 0.0_wp)
      do i = 1, case_count
        if (.not. loads%occurs(i)) cycle
        associate (case => loads%of_case(i))
          call find_element_forces(mechanism%structure_t, state, case, .false., in_element, joints)
          geometric = assemble_geometric_stiffness(linkage, mesh, state%pose, in_element)
          do b = 1, size(mechanism%beams)
            call add_axial_jumps(linkage, mesh, state%pose, b, axial_jumps(linkage, b, state%pose, case), geometric)
          end do
          stiffness%entry = stiffness%entry + factor(i, 1)*geometric%entry
        end associate
      end do
    end associate
  end subroutine assemble

  !> Writes `corners.dat`. Errors: the file could not be written.
  subroutine write_corners(folder, notes, corners, error)
    character(len=*), intent(in) :: folder
    type(string_t), intent(in) :: notes(:) !! the machine
    type(corner_t), intent(in) :: corners(:)
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(14)
    type(string_t) :: names(size(corners))
    integer :: i

    do i = 1, size(corners)
      names(i)%text = corners(i)%name
    end do
    call open_table(folder, "corners", .false., file, error)
    if (allocated(error)) return
    columns(1) = name_column("deck", names)
    columns(2) = integer_column("rows")
    columns(3) = integer_column("modes")
    columns(4) = integer_column("unknowns")
    columns(5) = integer_column("repetitions")
    columns(6) = real_column("median", "s")
    columns(7) = real_column("minimum", "s")
    columns(8) = integer_column("elements")
    columns(9) = integer_column("order")
    columns(10) = integer_column("nodal")
    columns(11) = integer_column("timed")
    columns(12) = real_column("dsygvx", "s")
    columns(13) = real_column("ratio", "-")
    columns(14) = real_column("difference", "-")
    call write_header(file, "decks of tests/bench/corners: processor time per row, beside LAPACK", [notes, &
      string_t("median and minimum: of the program, per row, with what is done once per run"), &
      string_t("dsygvx: the median of a row in nodal displacements, with matrices, without vectors and checks"), &
      string_t("elements and order: of the coupler there; nodal: unknowns there; timed: positions solved there"), &
      string_t("ratio: median/dsygvx; difference: largest of the frequencies of both, relative; dsygvx 0: it failed")], &
      columns)
    do i = 1, size(corners)
      associate (this => corners(i))
        call add_row(rows, name_cell(this%name, columns(1)%width)//integer_cell(this%rows, "rows")// &
          integer_cell(this%modes, "modes")//integer_cell(this%unknowns, "unknowns")// &
          integer_cell(size(this%ours), "repetitions")//real_cells([median_of(this%ours), minval(this%ours)])// &
          integer_cell(this%elements(2), "elements")//integer_cell(this%order(2), "order")// &
          integer_cell(this%nodal_unknowns, "nodal")//integer_cell(size(this%timed), "timed")//lapack_cells(this))
      end associate
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_corners

  !> Zeros where LAPACK found nothing.
  function lapack_cells(this) result(cells)
    type(corner_t), intent(in) :: this
    character(len=:), allocatable :: cells

    if (size(this%theirs) == 0) then
      cells = real_cells([0.0_wp, 0.0_wp, 0.0_wp])
    else
      cells = real_cells([median_of(this%theirs), median_of(this%ours)/median_of(this%theirs), this%nodal_error])
    end if
  end function lapack_cells

end module bench_corners
