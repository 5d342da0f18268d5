!> Times the elastic response of the first mechanism: the program, and general methods on the same periodic problem.
module bench_response
  use bench_cases, only: median_of
  use bench_models, only: base_t
  use elastic_equations, only: apply_equation, elastic_terms_t, load_at_speed
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: close_fourier, coefficients_of, fourier_plan_t, open_fourier, value_at
  use kinds, only: long, wp
  use mechanisms, only: mechanism_t, new_mechanism
  use periodic_solver, only: approximate_solution
  use response_runs, only: largest_difference, memory_of_process, new_grid, read_watch, request_of, run_response, start_watch, &
    watch_t
  use response_series, only: first_of_gauge, first_of_torque, response_series_of, series_count
  use response_types, only: axial_strain, bending_strain, response_request_t, response_t, shear_force, speed_response_t, &
    total_torque
  use slow_bases, only: new_slow_basis, slow_basis_t
  use slow_motions, only: new_slow_motion, slow_motion_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: column_t, finish_table, integer_cell, integer_column, name_cell, name_column, open_table, &
    real_cells, real_column, table_file_t, write_header, write_rows
  use text, only: string_t, to_string, word_list
  use strain_dampings, only: damping_t
  use turn_grids, only: turn_grid_t
  use whole_turn, only: collocate, read_motion, turn_matrices_of, turn_matrices_t, write_matrices, write_shapes
  implicit none (type, external)
  private

  public :: response_bench_t, plan_responses, prepare_response, time_response, write_responses, print_memory

  integer, parameter :: with_program = 1, with_collocation = 2, with_bvp = 3, with_radau = 4, with_lsoda = 5
  character(len=*), parameter :: method_words = "accuracy collocation solve_bvp radau lsoda"

  !> Steps and stages of the collocation: those of the prototype.
  integer, parameter :: steps = 192, stages = 6

  !> Samples of the matrices given to general methods, and of the motion that they return.
  integer, parameter :: matrix_samples = 128, motion_samples = 256

  !> The accuracy of the result that errors are differences to, and that whose orders the general methods get.
  real(wp), parameter :: exact_accuracy = 1.0e-11_wp, common_accuracy = 1.0e-6_wp

  !> Repetitions of a part that is timed alone.
  integer, parameter :: part_rounds = 7

  !> Samples of the slow coordinates, as the program has them, and what it asks of the iterations.
  integer, parameter :: basis_samples = 96

  type :: response_case_t
    integer :: method = with_program
    real(wp) :: asked = common_accuracy
    integer :: speeds = 1, threads = 1
    integer :: most_rounds = huge(1)
    integer :: order = 0, samples = 0, unknowns = 0, slow = 0
    integer(long) :: applications = 0_long
    real(wp) :: estimated = 0.0_wp, true = 0.0_wp
    real(wp) :: memory = 0.0_wp           !! [bytes]
    real(wp), allocatable :: wall(:), processor(:) !! one a round [s]
    character(len=:), allocatable :: failure !! why it is not timed; empty if it is
  end type response_case_t

  !> A part of a run.
  type :: part_t
    real(wp) :: asked = 0.0_wp
    character(len=:), allocatable :: name
    integer :: number = 0             !! of times in the run
    real(wp) :: each = 0.0_wp         !! [s]
  end type part_t

  type :: response_bench_t
    type(response_case_t), allocatable :: cases(:)
    type(speed_response_t) :: exact   !! at the single speed
  end type response_bench_t

contains

  !> What is timed; in a short run little.
  pure function plan_responses(short) result(bench)
    logical, intent(in) :: short
    type(response_bench_t) :: bench

    integer :: i

    allocate (bench%cases(merge(6, 14, short)))
    if (short) then
      bench%cases(:3)%asked = [1.0e-3_wp, 1.0e-6_wp, 1.0e-9_wp]
      bench%cases(4:5)%speeds = 3
      bench%cases(5)%threads = 2
      bench%cases(6)%method = with_collocation
    else
      bench%cases(:8)%asked = [(10.0_wp**(-i), i=3, 10)]
      bench%cases(9:10)%speeds = 100
      bench%cases(10)%threads = 2
      bench%cases(11:14)%method = [with_collocation, with_bvp, with_radau, with_lsoda]
    end if
    do i = 1, size(bench%cases)
      associate (this => bench%cases(i))
        this%failure = ""
        allocate (this%wall(0), this%processor(0))
        if (this%speeds > 1) this%most_rounds = 3
        if (this%method == with_collocation .or. this%method == with_bvp) this%most_rounds = 2
        if (this%method == with_radau .or. this%method == with_lsoda) this%most_rounds = 1
        if (this%method /= with_program) this%asked = 0.0_wp
      end associate
    end do
  end function plan_responses

  !> The result that errors are differences to, and what memory the runs of the program take. Errors: there is no such result.
  subroutine prepare_response(base, executable, folder, bench, error)
    type(base_t), intent(in) :: base
    character(len=*), intent(in) :: executable !! this program
    character(len=*), intent(in) :: folder     !! for files that pass by
    type(response_bench_t), intent(inout) :: bench
    type(error_t), allocatable, intent(out) :: error

    type(response_t) :: response
    type(response_case_t) :: exact
    real(wp) :: wall, processor
    integer :: i

    exact%asked = exact_accuracy
    call run_response(base%model, exact%speeds, exact%asked, exact%threads, response, wall, processor, error)
    if (allocated(error)) return
    if (allocated(response%at_speed(1)%error)) then
      error = response%at_speed(1)%error
      return
    end if
    bench%exact = response%at_speed(1)
    do i = 1, size(bench%cases)
      associate (this => bench%cases(i))
        if (this%method == with_program) this%memory = memory_of(this, executable, folder)
      end associate
    end do
  end subroutine prepare_response

  !> Memory of a run in a process of its own, without that of the process [bytes]; 0: not known.
  function memory_of(this, executable, folder) result(bytes)
    type(response_case_t), intent(in) :: this
    character(len=*), intent(in) :: executable, folder
    real(wp) :: bytes

    character(len=:), allocatable :: file
    integer :: status, unit

    bytes = 0.0_wp
    file = folder//"/memory.txt"
    call execute_command_line(executable//" - "//folder//" - memory "//to_string(this%asked)//" "//to_string(this%speeds)//" "// &
      to_string(this%threads)//" > "//file, exitstat=status)
    open (newunit=unit, file=file, status="old", action="read", iostat=status)
    if (status /= 0) return
    read (unit, *, iostat=status) bytes
    close (unit, status="delete")
  end function memory_of

  !> Prints the memory that a run takes [bytes]. Errors: it cannot be started.
  subroutine print_memory(base, accuracy, speeds, threads, error)
    type(base_t), intent(in) :: base
    real(wp), intent(in) :: accuracy
    integer, intent(in) :: speeds, threads
    type(error_t), allocatable, intent(out) :: error

    type(response_t) :: response
    real(wp) :: before, wall, processor

    before = memory_of_process()
    call run_response(base%model, speeds, accuracy, threads, response, wall, processor, error)
    print "(es12.4)", memory_of_process() - before
  end subroutine print_memory

  !> One more round of a case. General methods come after those of the program, which chooses the orders.
  subroutine time_response(base, folder, this, bench, error)
    type(base_t), intent(in) :: base
    character(len=*), intent(in) :: folder
    integer, intent(in) :: this !! number of the case
    type(response_bench_t), intent(inout) :: bench
    type(error_t), allocatable, intent(out) :: error

    integer :: i

    associate (case => bench%cases(this))
      if (len(case%failure) > 0 .or. size(case%wall) >= case%most_rounds) return
      if (case%method == with_program) then
        call time_program(base, bench%exact, case, error)
        return
      end if
      do i = 1, this
        if (bench%cases(i)%method == with_program .and. bench%cases(i)%speeds == 1 .and. &
          bench%cases(i)%asked <= common_accuracy) exit
      end do
      case%order = bench%cases(i)%order
      if (case%method == with_bvp) case%slow = bench%cases(i)%slow
      call time_other(base, folder, bench%exact, case)
    end associate
  end subroutine time_response

  subroutine time_program(base, exact, this, error)
    type(base_t), intent(in) :: base
    type(speed_response_t), intent(in) :: exact
    type(response_case_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(response_t) :: response
    real(wp) :: wall, processor
    integer :: i

    call run_response(base%model, this%speeds, this%asked, this%threads, response, wall, processor, error)
    if (allocated(error)) return
    this%applications = 0
    this%order = 0
    this%samples = 0
    this%slow = 0
    this%estimated = 0.0_wp
    do i = 1, size(response%at_speed)
      associate (found => response%at_speed(i))
        if (allocated(found%error)) then
          call set_error(error, error_of_numerics, "speed "//to_string(i)//": "//found%error%text)
          return
        end if
        this%applications = this%applications + found%applications
        this%order = max(this%order, found%order)
        this%samples = max(this%samples, found%samples)
        this%slow = max(this%slow, found%slow)
        this%estimated = max(this%estimated, found%largest_error)
      end associate
    end do
    if (this%speeds == 1) this%true = largest_difference(response%at_speed(1), exact)
    this%wall = [this%wall, wall]
    this%processor = [this%processor, processor]
  end subroutine time_program

  !> A general method, its matrices not counted.
  subroutine time_other(base, folder, exact, this)
    type(base_t), intent(in) :: base
    character(len=*), intent(in) :: folder
    type(speed_response_t), intent(in) :: exact
    type(response_case_t), intent(inout) :: this

    type(mechanism_t) :: mechanism
    type(response_request_t) :: request
    type(turn_grid_t) :: grid
    type(turn_matrices_t) :: matrices
    type(watch_t) :: watch
    type(error_t), allocatable :: error
    real(wp), allocatable :: y(:, :)
    real(wp) :: wall, processor

    mechanism = new_mechanism(base%model)
    request = request_of(mechanism, 1, common_accuracy)
    call new_grid(mechanism, this%order, matrix_samples, grid, error)
    if (.not. allocated(error)) then
      this%unknowns = grid%unknowns
      call turn_matrices_of(grid, request%speed(1), request%damping(1)%value, matrices)
      if (this%method == with_collocation) then
        this%samples = steps
        call start_watch(watch)
        call collocate(matrices, steps, stages, y, error)
        call read_watch(watch, wall, processor)
      else
        this%samples = 0
        call run_scipy(mechanism, folder, request%speed(1), grid, matrices, this, y, wall, processor, error)
      end if
    end if
    if (.not. allocated(error)) call find_difference(mechanism, request, this%order, y, exact, this%true, error)
    if (allocated(error)) then
      this%failure = error%text
      return
    end if
    this%wall = [this%wall, wall]
    this%processor = [this%processor, processor]
  end subroutine time_other

  !> tests/bench/steady_state.py in a process of its own. It takes the time without its start. Errors: no python3 with scipy; no
  !! solution.
  subroutine run_scipy(mechanism, folder, speed, grid, matrices, this, y, wall, processor, error)
    type(mechanism_t), intent(in) :: mechanism
    character(len=*), intent(in) :: folder
    real(wp), intent(in) :: speed
    type(turn_grid_t), intent(in) :: grid
    type(turn_matrices_t), intent(in) :: matrices
    type(response_case_t), intent(inout) :: this
    real(wp), allocatable, intent(out) :: y(:, :)
    real(wp), intent(out) :: wall, processor
    type(error_t), allocatable, intent(out) :: error

    character(len=*), parameter :: numbers = "OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python3 -B tests/bench/steady_state.py "
    character(len=:), allocatable :: files
    type(string_t), allocatable :: methods(:)
    type(turn_grid_t) :: coarse
    type(fourier_plan_t) :: plan, coarse_plan
    type(slow_basis_t) :: basis
    real(wp) :: header(4)
    integer :: status

    wall = 0.0_wp
    processor = 0.0_wp
    call execute_command_line("python3 -c 'import scipy' 2> /dev/null", exitstat=status)
    if (status /= 0) then
      call set_error(error, error_of_numerics, "this python3 has no scipy")
      return
    end if
    call new_grid(mechanism, this%order, basis_samples, coarse, error)
    if (allocated(error)) return
    call open_fourier(basis_samples, coarse_plan)
    call open_fourier(matrix_samples, plan)
    call new_slow_basis(coarse, coarse_plan, plan, max(1, this%slow), damping_t([real(wp) ::]), basis, error)
    call close_fourier(plan)
    call close_fourier(coarse_plan)
    if (.not. allocated(error)) call write_matrices(folder//"/matrices.bin", matrices, error)
    if (.not. allocated(error)) call write_shapes(folder//"/shapes.bin", basis%shape, error)
    if (allocated(error)) return
    methods = word_list("- - bvp radau lsoda")
    files = folder//"/matrices.bin "//folder//"/shapes.bin "//folder//"/motion.bin"
    call execute_command_line(numbers//methods(this%method)%text//" "//files//" "//to_string(motion_samples)//" "// &
      to_string(speed), exitstat=status)
    if (status == 0) then
      allocate (y(motion_samples, grid%unknowns))
      call read_motion(folder//"/motion.bin", header, y, error)
      wall = header(1)
      processor = header(2)
      this%applications = nint(header(4), long)
    else
      call set_error(error, error_of_numerics, "tests/bench/steady_state.py found no solution")
    end if
    call execute_command_line("rm -f "//files)
  end subroutine run_scipy

  !> Error of a motion, from the same quantities as those of the program. Errors: none that happen here.
  subroutine find_difference(mechanism, request, order, y, exact, difference, error)
    type(mechanism_t), intent(in) :: mechanism
    type(response_request_t), intent(in) :: request
    integer, intent(in) :: order
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    type(speed_response_t), intent(in) :: exact
    real(wp), intent(out) :: difference
    type(error_t), allocatable, intent(out) :: error

    type(speed_response_t) :: found
    type(turn_grid_t) :: grid
    type(fourier_plan_t) :: plan
    real(wp), allocatable :: series(:, :), coefficients(:, :), values(:)
    integer :: first, g, i, k

    difference = 0.0_wp
    call new_grid(mechanism, order, size(y, 1), grid, error)
    if (allocated(error)) return
    call open_fourier(size(y, 1), plan)
    allocate (series(size(y, 1), series_count(request)), coefficients(size(y, 1), series_count(request)))
    call response_series_of(grid, plan, request, request%speed(1), y, series)
    call coefficients_of(plan, series, coefficients)
    call close_fourier(plan)
    found = exact
    do k = 1, size(request%crank)
      values = value_at(coefficients, request%crank(k)*acos(-1.0_wp)/180.0_wp)
      do i = 1, size(request%points)
        found%displacement(:, i, k) = values(3*i - 2:3*i)
      end do
      do g = 1, size(request%gauges)
        first = first_of_gauge(request, g)
        associate (body => request%gauges(g)%body)
          found%strain(axial_strain, g, k) = values(first)
          found%strain(bending_strain, g, k) = request%gauges(g)%side*request%section(body)%outer*values(first + 1)
          found%strain(shear_force, g, k) = request%gauges(g)%side*values(first + 2)
        end associate
      end do
      first = first_of_torque(request)
      found%drive(:3, k) = values(first:first + 2)
      found%drive(total_torque, k) = sum(values(first:first + 2))
    end do
    difference = largest_difference(found, exact)
  end subroutine find_difference

  !> Writes `response.dat`, a row a case, and `response_parts.dat`. Errors: a file could not be written.
  subroutine write_responses(folder, notes, base, bench, error)
    character(len=*), intent(in) :: folder
    type(string_t), intent(in) :: notes(:) !! the machine
    type(base_t), intent(in) :: base
    type(response_bench_t), intent(in) :: bench
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(16)
    type(string_t), allocatable :: methods(:)
    integer :: i

    methods = word_list(method_words)
    call open_table(folder, "response", .false., file, error)
    if (allocated(error)) return
    columns(1) = name_column("method", methods)
    columns(2) = real_column("asked", "-")
    columns(3) = integer_column("speeds")
    columns(4) = integer_column("threads")
    columns(5) = integer_column("order")
    columns(6) = integer_column("samples")
    columns(7) = integer_column("unknowns")
    columns(8) = integer_column("slow")
    columns(9) = integer_column("applications")
    columns(10) = integer_column("repetitions")
    columns(11) = real_column("median", "s")
    columns(12) = real_column("minimum", "s")
    columns(13) = real_column("processor", "s")
    columns(14) = real_column("estimated", "-")
    columns(15) = real_column("true", "-")
    columns(16) = real_column("memory", "MB")
    call write_header(file, "first mechanism of Ulker (2010): steady elastic response, damping time 1e-4 s", [notes, &
      string_t("one speed: 20 rad/s; more: from 5 to 60 rad/s; 72 crank angles, 2 gauges, 2 points, the torque"), &
      string_t("median and minimum: by the clock; processor: the least, all threads together; estimated, true: largest errors "// &
      "relative to the largest over the turn; true: against accuracy=1e-11, which is good to about that; 0: not known"), &
      string_t("order, samples, slow: the highest that the program chose; applications: of the equation, all speeds together; "// &
      "of radau and lsoda: evaluations"), &
      string_t("general methods: all unknowns of that order, without the time for their matrices"), &
      string_t("memory: of a process of its own beyond what it holds before")], columns)
    do i = 1, size(bench%cases)
      associate (this => bench%cases(i))
        if (len(this%failure) > 0) then
          call add_failed_row(rows, [real(wp) ::], "method="//methods(this%method)%text//": "//this%failure)
          cycle
        end if
        call add_row(rows, name_cell(methods(this%method)%text, columns(1)%width)//real_cells([this%asked])// &
          integer_cell(this%speeds, "speeds")//integer_cell(this%threads, "threads")//integer_cell(this%order, "order")// &
          integer_cell(this%samples, "samples")//integer_cell(this%unknowns, "unknowns")//integer_cell(this%slow, "slow")// &
          integer_cell(int(this%applications), "applications")//integer_cell(size(this%wall), "repetitions")// &
          real_cells([median_of(this%wall), minval(this%wall), minval(this%processor), this%estimated, this%true, &
          this%memory*1.0e-6_wp]))
      end associate
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
    if (.not. allocated(error)) call write_parts(folder, notes, base, bench, error)
  end subroutine write_responses

  !> Where the time of one speed goes. Errors: a file could not be written.
  subroutine write_parts(folder, notes, base, bench, error)
    character(len=*), intent(in) :: folder
    type(string_t), intent(in) :: notes(:)
    type(base_t), intent(in) :: base
    type(response_bench_t), intent(in) :: bench
    type(error_t), allocatable, intent(out) :: error

    type(part_t), allocatable :: parts(:)
    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(6)
    type(string_t), allocatable :: names(:)
    real(wp) :: whole
    integer :: i, k

    names = word_list("models_and_grids slow_coordinates slow_motion applications approximate_inverses quantities rest")
    call open_table(folder, "response_parts", .false., file, error)
    if (allocated(error)) return
    columns(1) = real_column("asked", "-")
    columns(2) = name_column("part", names)
    columns(3) = integer_column("number")
    columns(4) = real_column("each", "s")
    columns(5) = real_column("total", "s")
    columns(6) = real_column("share", "-")
    call write_header(file, "first mechanism of Ulker (2010): parts of the time of one speed, 20 rad/s", [notes, &
      string_t("processor time; each part timed alone; rest: what they leave of the whole, with results and errors")], columns)
    do i = 1, size(bench%cases)
      associate (this => bench%cases(i))
        if (this%method /= with_program .or. this%speeds > 1) cycle
        if (.not. any(abs(log10(this%asked) + [6, 9]) < 0.1_wp)) cycle  ! others ask for 0
        call time_parts(base, this, parts, error)
        if (allocated(error)) return
        whole = minval(this%processor)
        parts(size(parts))%each = whole - sum(parts%number*parts%each)
        parts(size(parts))%number = 1
        do k = 1, size(parts)
          associate (total => parts(k)%number*parts(k)%each)
            call add_row(rows, real_cells([this%asked])//name_cell(names(k)%text, columns(2)%width)// &
              integer_cell(parts(k)%number, "number")//real_cells([parts(k)%each, total, total/whole]))
          end associate
        end do
      end associate
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_parts

  !> Times what a run of the program is made of. Errors: those of the program.
  subroutine time_parts(base, this, parts, error)
    type(base_t), intent(in) :: base
    type(response_case_t), intent(in) :: this
    type(part_t), allocatable, intent(out) :: parts(:)
    type(error_t), allocatable, intent(out) :: error

    type(mechanism_t) :: mechanism
    type(response_request_t) :: request
    type(turn_grid_t), target :: grid
    type(turn_grid_t) :: coarse
    type(fourier_plan_t), target :: plan
    type(fourier_plan_t) :: coarse_plan
    type(slow_basis_t), target :: basis
    type(slow_motion_t), target :: motion
    type(equation_at_speed_t) :: equation
    type(watch_t) :: watch
    real(wp), allocatable :: damping(:), y(:, :), force(:, :), series(:, :)
    real(wp) :: wall, least(6), seconds
    integer :: above, order, round, samples

    mechanism = new_mechanism(base%model)
    request = request_of(mechanism, 1, this%asked)
    allocate (parts(7))
    parts(:6)%number = [1, 1, 1, int(this%applications), int(this%applications), 1]
    do above = 0, 1
      order = this%order + 2*above
      samples = this%samples
      if (above == 1) samples = merge(3*samples/2, 4*samples/3, iand(samples, samples - 1) == 0)
      least = huge(least)
      do round = 1, part_rounds
        call start_watch(watch)
        call new_grid(mechanism, order, samples, grid, error)
        if (allocated(error)) return
        call new_grid(mechanism, order, min(samples, basis_samples), coarse, error)
        if (allocated(error)) return
        call add_time(1)
        damping = spread(request%damping(1)%value, 1, grid%unknowns)
        call open_fourier(coarse%samples, coarse_plan)
        call open_fourier(samples, plan)
        call start_watch(watch)
        call new_slow_basis(coarse, coarse_plan, plan, this%slow, damping_t(damping), basis, error)
        if (allocated(error)) return
        call add_time(2)
        if (above == 0) then
          call start_watch(watch)
          call new_slow_motion(plan, basis, request%speed(1), 3, motion, error)
          if (allocated(error)) return
          call add_time(3)
        else
          least(3) = 0.0_wp
        end if
        equation%grid => grid
        equation%plan => plan
        equation%basis => basis
        equation%motion => motion
        equation%speed = request%speed(1)
        equation%damping = damping_t(damping)
        force = load_at_speed(grid, request%speed(1))
        y = force
        call start_watch(watch)
        call apply_equation(grid, plan, request%speed(1), damping_t(damping), elastic_terms_t(), y, force)
        call add_time(4)
        if (above == 0) then
          call start_watch(watch)
          call approximate_solution(equation, force, y)
          call add_time(5)
        else
          least(5) = 0.0_wp
        end if
        if (allocated(series)) deallocate (series)
        allocate (series(samples, series_count(request)))
        call start_watch(watch)
        call response_series_of(grid, plan, request, request%speed(1), y, series)
        call add_time(6)
        call close_fourier(coarse_plan)
        call close_fourier(plan)
      end do
      ! Half of the applications are on the finer grid.
      least(4) = 0.5_wp*least(4)
      parts(:6)%each = parts(:6)%each + least
    end do

  contains

    subroutine add_time(part)
      integer, intent(in) :: part

      call read_watch(watch, wall, seconds)
      least(part) = min(least(part), seconds)
    end subroutine add_time

  end subroutine time_parts

end module bench_response
