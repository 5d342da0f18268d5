!> Chains of ever more four-bars: the program at rest and under loads, and sparse finite elements at rest.
module bench_scale
  use bench_cases, only: median_of
  use bench_linkages, only: run_model
  use chain_decks, only: chain_deck
  use computed_decks, only: read_text
  use constants, only: two_pi
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use models, only: model_t
  use nodal_chains, only: find_nodal_frequencies, new_nodal_chain, nodal_chain_t
  use table_rows, only: add_row, rows_t
  use tables, only: column_t, finish_table, integer_cell, integer_column, name_cell, name_column, open_table, &
    real_cells, real_column, table_file_t, write_header, write_rows
  use text, only: string_t, to_string, word_list
  use variant_runs, only: variant_run_t
  implicit none (type, external)
  private

  public :: chain_case_t, plan_chains, prepare_chain, time_chain, write_chains

  integer, parameter :: at_rest = 1, under_loads = 2, coarse = 3, fine = 4, solvers = 4
  character(len=*), parameter :: solver_words = "program program_loaded elements_4 elements_16"

  !> Elements of a stretch between two pins.
  integer, parameter :: cuts(coarse:fine) = [4, 16]

  integer, parameter :: modes = 3, positions = 36 !! from 0 deg by one degree

  !> A chain, and what came of it.
  type :: chain_case_t
    integer :: stages = 0, unknowns(solvers) = 0
    logical :: mixed(solvers) = .false.  !! the program's equations are in mixed form
    real(wp) :: error(solvers) = 0.0_wp  !! the program's estimate; of others the difference to the program, relative
    type(model_t) :: model(at_rest:under_loads)
    real(wp), allocatable :: time(:, :)  !! (solvers, rounds) of the processor, a position [s]
    real(wp), allocatable :: each(:, :)  !! (solvers, rounds) without what is done once a run [s]
  end type chain_case_t

contains

  !> What is timed; in a short run little. Errors: those of a deck.
  subroutine plan_chains(short, chains, error)
    logical, intent(in) :: short
    type(chain_case_t), allocatable, intent(out) :: chains(:)
    type(error_t), allocatable, intent(out) :: error

    character(len=*), parameter :: nl = achar(10)
    character(len=*), parameter :: cards = "MESH * accuracy=1e-8"//nl//"MODES 3"//nl//"REPORT frequencies"//nl
    character(len=:), allocatable :: complaint, more
    integer :: i, k

    allocate (chains(merge(3, 7, short)))
    do i = 1, size(chains)
      chains(i)%stages = 2**(i - 1)
      allocate (chains(i)%time(solvers, 0), chains(i)%each(solvers, 0))
      do k = at_rest, under_loads
        more = cards//"CRANK 0 to "//to_string(positions - 1)//" step 1"//nl
        if (k == under_loads) more = more//"SPEED 10"//nl//"EFFECTS axial"//nl
        call read_text(chain_deck(chains(i)%stages, more), chains(i)%model(k), complaint)
        if (len(complaint) > 0) call set_error(error, error_of_numerics, complaint)
        if (allocated(error)) return
      end do
    end do
  end subroutine plan_chains

  !> Solves a chain once by all. Errors: a position fails.
  subroutine prepare_chain(this, error)
    type(chain_case_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    real(wp) :: frequency(modes, positions), exact(modes, positions), seconds, each
    integer :: i, k

    do k = under_loads, at_rest, -1
      call run_model(this%model(k), run, seconds, each, error)
      if (allocated(error)) return
      associate (sweep => run%results%found%sweep)
        this%unknowns(k) = sweep%models%continuum%layout%unknowns
        this%mixed(k) = sweep%models%continuum%mixed
        do i = 1, positions
          this%error(k) = max(this%error(k), maxval(sweep%results(i)%error(:, 1)))
          exact(:, i) = sqrt(sweep%results(i)%lambda(:, 1))/two_pi
        end do
      end associate
    end do
    do k = coarse, fine
      call run_elements(this%stages, cuts(k), frequency, this%unknowns(k), seconds, each, error)
      if (allocated(error)) return
      this%error(k) = maxval(abs(frequency/exact - 1.0_wp))
    end do
  end subroutine prepare_chain

  !> Finite elements at all positions, each started from those before. Errors: a position fails.
  subroutine run_elements(stages, cut, frequency, unknowns, seconds, each, error)
    integer, intent(in) :: stages, cut
    real(wp), intent(out) :: frequency(modes, positions) !! [Hz]
    integer, intent(out) :: unknowns
    real(wp), intent(out) :: seconds, each !! of the processor: all, and without numbers of unknowns and their order [s]
    type(error_t), allocatable, intent(out) :: error

    type(nodal_chain_t) :: chain
    real(wp) :: begun, numbered, ended
    integer :: i

    call cpu_time(begun)
    chain = new_nodal_chain(stages, cut)
    call cpu_time(numbered)
    do i = 1, positions
      call find_nodal_frequencies(chain, real(i - 1, wp), frequency(:, i), error)
      if (allocated(error)) exit
    end do
    call cpu_time(ended)
    seconds = ended - begun
    each = ended - numbered
    unknowns = chain%elements%unknowns
  end subroutine run_elements

  !> One more round: all of them, one at once behind the other. Errors: a position fails.
  subroutine time_chain(this, error)
    type(chain_case_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    real(wp) :: frequency(modes, positions), seconds(solvers), each(solvers)
    integer :: k, n

    do k = at_rest, under_loads
      call run_model(this%model(k), run, seconds(k), each(k), error)
      if (allocated(error)) return
    end do
    do k = coarse, fine
      call run_elements(this%stages, cuts(k), frequency, n, seconds(k), each(k), error)
      if (allocated(error)) return
    end do
    n = size(this%time, 2)
    this%time = reshape([this%time, seconds/positions], [solvers, n + 1])
    this%each = reshape([this%each, each/positions], [solvers, n + 1])
  end subroutine time_chain

  !> Writes `scale.dat`. Errors: the file could not be written.
  subroutine write_chains(folder, notes, chains, error)
    character(len=*), intent(in) :: folder
    type(string_t), intent(in) :: notes(:) !! the machine
    type(chain_case_t), intent(in) :: chains(:)
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(10)
    type(string_t), allocatable :: names(:)
    type(string_t) :: each_run
    integer :: i, k

    names = word_list(solver_words)
    call open_table(folder, "scale", .false., file, error)
    if (allocated(error)) return
    columns(1) = name_column("solver", names)
    columns(2) = integer_column("stages")
    columns(3) = integer_column("links")
    columns(4) = integer_column("unknowns")
    columns(5) = integer_column("mixed")
    columns(6) = integer_column("repetitions")
    columns(7) = real_column("minimum", "s")
    columns(8) = real_column("median", "s")
    columns(9) = real_column("each", "s")
    columns(10) = real_column("error", "-")
    each_run%text = to_string(positions)//" positions by 1 deg, each started from those before; minimum and median: of a run, "// &
      "divided by its positions;"
    call write_header(file, "chains of four-bars, three modes: processor time per position, one thread", [notes, each_run, &
      string_t("each: the least without what is done once per run; mixed: 1 where the program's equations are in mixed form;"), &
      string_t("program: at rest, accuracy=1e-8; program_loaded: with the axial forces of 10 rad/s; elements_4, elements_16:"), &
      string_t("so many cubic beam elements between two pins of a link, at rest, sparse, with the program's eigenvalue solver;"), &
      string_t("error: the largest that the program estimates; of elements the largest difference to its frequencies, relative")], &
      columns)
    do k = 1, solvers
      do i = 1, size(chains)
        associate (this => chains(i))
          call add_row(rows, name_cell(names(k)%text, columns(1)%width)//integer_cell(this%stages, "stages")// &
            integer_cell(2*this%stages + 1, "links")//integer_cell(this%unknowns(k), "unknowns")// &
            integer_cell(merge(1, 0, this%mixed(k)), "mixed")//integer_cell(size(this%time, 2), "repetitions")// &
            real_cells([minval(this%time(k, :)), median_of(this%time(k, :)), minval(this%each(k, :)), this%error(k)]))
        end associate
      end do
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_chains

end module bench_scale
