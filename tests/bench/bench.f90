!> Times the program's solvers and the usual ones, in turn, and writes tables.
!!
!!     bench PROGRAM FOLDER LIBRARIES [short|corners|linkages|response|scale]
!!
!! `short`: a few cases once. `corners`: only the decks of tests/bench/corners, those that are slow once or three times.
!! `linkages`: only linkages in parts, eleven times. `response`: only the elastic response. `scale`: only chains of many links.
!! `memory ACCURACY SPEEDS THREADS`: prints the memory that one elastic response takes.
!! PROGRAM is also timed as a whole; tables go to FOLDER; LIBRARIES names the BLAS that was linked. Run in the root of the repository.
program bench
  use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
  use bench_cases, only: plan_t, table_names, with_accuracy
  use bench_corners, only: corner_t, prepare_corner, read_corners, time_corner, write_corners
  use bench_linkages, only: linkage_case_t, prepare_linkage, read_linkages, time_linkage, write_linkages
  use bench_models, only: base_t, read_base
  use bench_plans, only: plan_cases
  use bench_ratios, only: write_ratios
  use bench_response, only: plan_responses, prepare_response, print_memory, response_bench_t, time_response, write_responses
  use bench_runs, only: prepare_case, seconds_since, time_case
  use bench_scale, only: chain_case_t, plan_chains, prepare_chain, time_chain, write_chains
  use bench_tables, only: write_plan, write_times
  use errors, only: error_t, rendered
  use exact_values, only: exact_values_t, read_exact_values
  use file_system, only: make_directories
  use kinds, only: long, wp
  use machine, only: machine_notes
  use omp_lib, only: omp_get_num_procs
  use text, only: string_t, to_string, word_list
  implicit none (type, external)

  integer, parameter :: repetitions = 7, of_long = 3, of_linkages = 11, short_repetitions = 1
  character(len=*), parameter :: job_list = "--version inputs/mechanism1.deck inputs/exact.deck tests/bench/typical.deck"
  character(len=*), parameter :: long_job_list = " tests/bench/positions.deck tests/bench/variants.deck"
  type(plan_t) :: plan
  type(corner_t), allocatable :: corners(:)
  type(linkage_case_t), allocatable :: linkages(:)
  type(chain_case_t), allocatable :: chains(:)
  type(response_bench_t) :: responses
  type(base_t) :: base
  type(exact_values_t) :: exact
  type(error_t), allocatable :: error
  type(string_t), allocatable :: words(:), notes(:), jobs(:), made(:)
  real(wp), allocatable :: times(:, :)
  integer(long) :: start
  character(len=4096) :: executable
  integer :: i, k, order(3), rounds
  real(wp) :: accuracy
  integer :: speeds, threads
  character(len=:), allocatable :: part
  logical :: short, done

  words = arguments()
  if (.not. any(size(words) == [3, 4, 7])) &
    call give_up("usage: bench PROGRAM FOLDER LIBRARIES [short|corners|linkages|response|scale]")
  if (size(words) == 7) then
    if (words(4)%text /= "memory") call give_up(words(4)%text//": not memory")
    read (words(5)%text, *) accuracy
    read (words(6)%text, *) speeds
    read (words(7)%text, *) threads
    call read_base("inputs/exact.deck", base, error)
    call give_up_on(error)
    call print_memory(base, accuracy, speeds, threads, error)
    call give_up_on(error)
    stop, quiet=.true.
  end if
  part = "all"
  if (size(words) == 4) part = words(4)%text
  if (.not. any(part == [character(len=8) :: "all", "short", "corners", "linkages", "response", "scale"])) &
    call give_up(part//": not short, corners, linkages, response or scale")
  short = part == "short"
  rounds = merge(short_repetitions, repetitions, short)
  if (part == "linkages") rounds = of_linkages
  call make_directories(words(2)%text, done, made)
  if (.not. done) call give_up(words(2)%text//": this folder cannot be created")
  call read_base("inputs/exact.deck", base, error)
  call give_up_on(error)
  call read_exact_values("tests/exact/mechanism1.dat", exact, error)
  call give_up_on(error)

  call system_clock(start)
  if (is_wanted("solvers")) plan = plan_cases(omp_get_num_procs(), short)
  order = 3
  do i = 1, plan%count
    associate (this => plan%cases(i))
      ! Nodal solvers get the orders that the program chose just before.
      if (this%order(1) == 0) this%order = order
      call prepare_case(base, exact, this)
      if (this%solver == with_accuracy) order = this%order
    end associate
  end do
  allocate (corners(0))
  if (is_wanted("corners")) call read_corners(short, corners, error)
  call give_up_on(error)
  do i = 1, size(corners)
    call prepare_corner(corners(i), error)
    call give_up_on(error)
    write (output_unit, "(a)") "bench: "//corners(i)%name//" solved once, "//to_string(seconds_since(start), 3)//" s"
    flush (output_unit)
  end do
  allocate (linkages(0))
  if (is_wanted("linkages")) call read_linkages(short, linkages, error)
  call give_up_on(error)
  do i = 1, size(linkages)
    call prepare_linkage(linkages(i), error)
    call give_up_on(error)
  end do
  allocate (chains(0))
  if (is_wanted("scale")) call plan_chains(short, chains, error)
  call give_up_on(error)
  do i = 1, size(chains)
    call prepare_chain(chains(i), error)
    call give_up_on(error)
  end do
  allocate (responses%cases(0))
  if (is_wanted("response")) then
    responses = plan_responses(short)
    call get_command_argument(0, executable)
    call prepare_response(base, trim(executable), words(2)%text, responses, error)
    call give_up_on(error)
  end if
  write (output_unit, "(a)") "bench: "//to_string(plan%count)//" cases and "// &
    to_string(size(corners) + size(linkages) + size(chains))//" decks solved once, "//to_string(seconds_since(start), 3)//" s"

  ! In turn: a slow minute of the machine then comes to all.
  jobs = word_list(job_list//long_job_list)
  if (short) jobs = word_list(job_list)
  if (.not. is_wanted("solvers")) jobs = jobs(:0)
  allocate (times(size(jobs), rounds))
  do k = 1, rounds
    do i = 1, plan%count
      if (len(plan%cases(i)%failure) > 0 .or. (plan%cases(i)%is_long .and. k > of_long)) cycle
      call time_case(base, plan%cases(i), error)
      call give_up_on(error)
    end do
    do i = 1, size(corners)
      if (k > corners(i)%most_rounds) cycle
      call time_corner(corners(i), error)
      call give_up_on(error)
    end do
    do i = 1, size(linkages)
      call time_linkage(linkages(i), error)
      call give_up_on(error)
    end do
    do i = 1, size(chains)
      call time_chain(chains(i), error)
      call give_up_on(error)
    end do
    do i = 1, size(responses%cases)
      call time_response(base, words(2)%text, i, responses, error)
      call give_up_on(error)
    end do
    do i = 1, size(jobs)
      times(i, k) = time_of_process(words(1)%text, words(2)%text, jobs(i)%text)
    end do
    write (output_unit, "(a)") "bench: "//to_string(k)//" of "//to_string(rounds)//" rounds, "// &
      to_string(seconds_since(start), 3)//" s"
  end do

  notes = machine_notes(words(3)%text)
  if (is_wanted("linkages")) call write_linkages(words(2)%text, notes, linkages, error)
  call give_up_on(error)
  if (is_wanted("scale")) call write_chains(words(2)%text, notes, chains, error)
  call give_up_on(error)
  if (is_wanted("response")) call write_responses(words(2)%text, notes, base, responses, error)
  call give_up_on(error)
  if (is_wanted("corners")) call write_corners(words(2)%text, notes, corners, error)
  call give_up_on(error)
  if (.not. is_wanted("solvers")) stop, quiet=.true.
  do i = 1, size(table_names())
    call write_plan(words(2)%text, i, notes, plan, error)
    call give_up_on(error)
  end do
  call write_ratios(words(2)%text, notes, plan, error)
  call give_up_on(error)
  call write_times(words(2)%text, "processes", notes, jobs, times, error)
  call give_up_on(error)

contains

  !> Whether a part of the tables is timed: all parts are, or this one only.
  logical function is_wanted(name)
    character(len=*), intent(in) :: name

    is_wanted = part == "all" .or. part == "short" .or. part == name
  end function is_wanted

  function arguments() result(list)
    type(string_t), allocatable :: list(:)

    integer :: n, length

    allocate (list(command_argument_count()))
    do n = 1, size(list)
      call get_command_argument(n, length=length)
      allocate (character(len=length) :: list(n)%text)
      call get_command_argument(n, list(n)%text)
    end do
  end function arguments

  !> From the start of a shell to the end of the program [s].
  function time_of_process(executable, folder, job) result(seconds)
    character(len=*), intent(in) :: executable, folder, job !! a deck, or an option
    real(wp) :: seconds

    integer(long) :: begun
    integer :: status

    call system_clock(begun)
    call execute_command_line(executable//" --quiet --out "//folder//"/runs "//job//" > /dev/null", exitstat=status)
    seconds = seconds_since(begun)
    if (status /= 0) call give_up(executable//" "//job//" ended with status "//to_string(status))
  end function time_of_process

  subroutine give_up_on(failure)
    type(error_t), allocatable, intent(in) :: failure

    if (allocated(failure)) call give_up(rendered(failure))
  end subroutine give_up_on

  subroutine give_up(message)
    character(len=*), intent(in) :: message

    write (error_unit, "(a)") "bench: "//message
    stop 2, quiet=.true.
  end subroutine give_up

end program bench
