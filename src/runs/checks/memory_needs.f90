!> The memory that a run will take, estimated before it takes any.
!!
!! The estimate is on the safe side. It adds up the sizes of the data that are kept, and constants
!! measured with the peak memory of the process.
module memory_needs
  use available_memory, only: available_memory_t, memory_text
  use beam_element, only: element_unknowns
  use deformation_shapes, only: bending_unknowns
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_memory
  use kinds, only: wp
  use link_cards, only: segment_count
  use models, only: accuracy_of_study, effects_static, is_four_bar, model_t, needs_frequencies, &
    needs_response, report_number
  use response_types, only: drive_values, strain_values
  use study_requests, only: method_wanted, motion_instants_of
  use text, only: plural, to_string
  use tokens, only: token_t
  use vibration_models, only: by_band, by_dense, chosen_method
  implicit none (type, external)
  private

  public :: memory_need_t, memory_of_run, check_memory

  !> Memory of one part of a run.
  type :: memory_need_t
    real(wp) :: bytes = 0.0_wp            !! 0: the run does not have this part
    character(len=:), allocatable :: what !! name of the part, in the plural, for the message
    type(token_t) :: place                !! the card that requests it
  end type memory_need_t

  !> The parts of a run that take memory.
  integer, parameter :: of_results = 1, of_shapes = 2, of_branches = 3, of_mesh = 4, &
    of_matrices = 5, of_motion = 6, of_response = 7, parts = 7

  !> Bytes of a number; of a pose with its kinematic coefficients; of the results at a position, and
  !! at one of its speeds, without their numbers.
  real(wp), parameter :: number = 8.0_wp, of_pose = 1050.0_wp, of_position = 600.0_wp, &
    of_speed = 230.0_wp

  !> Bytes that every run takes; factor for memory that is wasted between allocated pieces.
  real(wp), parameter :: of_process = 1.0e7_wp, spare = 1.1_wp

contains

  !> Compares the estimated memory with the available memory.
  !!
  !! Errors: the run needs more; the message points at the card that requests most of it.
  subroutine check_memory(model, threads, available, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    integer, intent(in) :: threads                    !! that will compute it
    type(available_memory_t), intent(in) :: available !! on this machine
    type(diagnostics_t), intent(inout) :: diagnostics !! to which the error is appended

    type(memory_need_t) :: needs(parts)
    character(len=:), allocatable :: of_all
    real(wp) :: total
    integer :: most

    call memory_of_run(model, threads, needs)
    total = of_process + spare*sum(needs%bytes)
    if (total <= available%bytes) return
    most = maxloc(needs%bytes, dim=1)
    of_all = ""
    if (needs(most)%bytes < 0.8_wp*total) of_all = " of "//memory_text(total)//" in all"
    call add_error(diagnostics, needs(most)%place, needs(most)%what//" need "// &
      memory_text(needs(most)%bytes)//of_all//", and "//available%clause, kind=error_of_memory)
  end subroutine check_memory

  !> The memory of all parts of a run.
  subroutine memory_of_run(model, threads, needs)
    type(model_t), intent(in) :: model           !! without errors
    integer, intent(in) :: threads               !! that will compute it
    type(memory_need_t), intent(out) :: needs(:) !! (parts) some of them zero

    real(wp) :: rows !! of results
    integer :: speeds

    speeds = size(model%speed%value)
    if (model%effects == effects_static) speeds = 1
    rows = real(size(model%crank%value), wp)*speeds
    needs(of_results)%place = model%reports(1)%keyword
    if (size(model%crank%words) > 0) needs(of_results)%place = model%crank%words(1)
    needs(of_results)%what = "the results at "//plural(size(model%crank%value), "position")
    needs(of_results)%bytes = size(model%crank%value)*(of_pose + &
      number*sum(model%reports%kind%numbers))
    call add_needs_of_motion(model, needs(of_motion))
    call add_needs_of_response(model, threads, needs(of_response))
    if (any(model%links%mesh > 0) .and. all(model%links%mesh > 0 .or. model%links%rigid)) &
      call add_needs_of_mesh(model, threads, needs)
    if (.not. needs_frequencies(model)) return
    needs(of_results)%what = needs(of_results)%what//" and "//plural(speeds, "speed")
    needs(of_results)%bytes = needs(of_results)%bytes + size(model%crank%value)*of_position + &
      rows*(of_speed + 2*model%modes*number)
    call add_needs_of_shapes(model, speeds, needs(of_shapes))
    call add_branches(model, rows, needs(of_branches))
  end subroutine memory_of_run

  !> All instants of a motion, kept until they are written.
  pure subroutine add_needs_of_motion(model, need)
    type(model_t), intent(in) :: model
    type(memory_need_t), intent(inout) :: need

    integer, parameter :: numbers = 16 !! of a sample, rounded up
    integer, parameter :: of_joint = 3 !! numbers of a joint
    integer :: report, pins, columns, i

    report = report_number(model, "motion")
    if (report == 0) return
    pins = 0
    if (model%reports(report)%with_pins) pins = sum([(size(model%links(i)%pins), &
      i=1, size(model%links))])
    columns = 0
    associate (asked => model%reports(report))
      if (asked%with_accelerations) columns = max(3, size(model%drives))
      if (asked%with_power) columns = columns + 3
      if (asked%with_forces) columns = columns + of_joint*(sum([(size(model%links(i)%pins), &
        i=1, size(model%links))]) + size(model%sliders))
    end associate
    need%place = model%reports(report)%keyword
    need%what = "the "//plural(motion_instants_of(model), "instant")//" of the motion"
    need%bytes = (numbers + 2*pins + columns)*number*motion_instants_of(model)
  end subroutine add_needs_of_motion

  !> The terms of the equations at the crank angles of a turn, for several orders; vectors of the
  !! iterations, for each thread; the results, kept until they are written.
  subroutine add_needs_of_response(model, threads, need)
    type(model_t), intent(in) :: model
    integer, intent(in) :: threads
    type(memory_need_t), intent(inout) :: need

    !> Crank angles and unknowns of a link, more than most linkages take; arrays of that size that
    !! are kept, and those of a thread: as found in runs. Accuracies near round-off try more of all.
    real(wp), parameter :: samples = 1024.0_wp, unknowns = 32.0_wp, kept = 100.0_wp, &
      own = 40.0_wp, hard = 1.0e-10_wp, more = 12.0_wp
    real(wp) :: results
    integer :: report

    if (.not. needs_response(model)) return
    report = findloc(model%reports%kind%response, .true., dim=1)
    need%place = model%reports(report)%keyword
    need%what = "the elastic response at "//plural(size(model%crank%value), "position")//" and "// &
      plural(size(model%speed%value), "speed")
    results = drive_values
    if (report_number(model, "response") > 0) results = results + 3*(4 + size(model%points))
    if (report_number(model, "strains") > 0) results = results + strain_values*max(3, &
      size(model%gauges))
    need%bytes = number*(size(model%crank%value)*size(model%speed%value)*results + &
      samples*unknowns*size(model%links)*(kept + own*threads)* &
      merge(more, 1.0_wp, accuracy_of_study(model, "response") < hard))
  end subroutine add_needs_of_response

  !> Displacements at the points of all links for every mode, kept until they are written.
  pure subroutine add_needs_of_shapes(model, speeds, need)
    type(model_t), intent(in) :: model
    integer, intent(in) :: speeds
    type(memory_need_t), intent(inout) :: need

    real(wp) :: drawn
    integer :: report

    report = report_number(model, "shapes")
    if (report == 0) return
    associate (asked => model%reports(report))
      drawn = merge(size(asked%crank%value), size(model%crank%value), size(asked%crank%value) > 0)
      drawn = drawn*merge(size(asked%speed%value), speeds, size(asked%speed%value) > 0)
      need%place = asked%keyword
      need%what = "the shapes of "//plural(model%modes, "mode")//" at "//to_string(drawn, 9)// &
        " positions and speeds"
      need%bytes = drawn*model%modes*3*number*most_parts(model)*asked%points
    end associate
  end subroutine add_needs_of_shapes

  !> Straight parts of all links, at most: pins, points, blocks, masses and forces divide them.
  pure function most_parts(model) result(parts)
    type(model_t), intent(in) :: model
    integer :: parts

    integer :: i

    parts = size(model%sliders)
    if (parts > 0) parts = parts + size(model%masses) + size(model%processes)
    if (.not. is_four_bar(model)) parts = parts + size(model%points)
    do i = 1, size(model%links)
      parts = parts + segment_count(model%links(i))
    end do
  end function most_parts

  !> Loci: the prints by which modes are recognised from position to position (components of y and
  !! M y for the border and the first own modes of every link), and the rows of the table.
  pure subroutine add_branches(model, rows, need)
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: rows
    type(memory_need_t), intent(inout) :: need

    real(wp), parameter :: of_print = 200.0_wp, of_branch = 20.0_wp
    real(wp) :: kept
    integer :: report

    report = report_number(model, "branches")
    if (report == 0) return
    kept = most_parts(model) + 1 + most_parts(model)*(2.0_wp*model%modes + 2)
    need%place = model%reports(report)%keyword
    need%what = "the branches of "//plural(model%modes, "mode")//" through "//to_string(rows, 9)// &
      " positions and speeds"
    need%bytes = rows*(of_print + model%modes*(of_branch + 2*kept*number))
  end subroutine add_branches

  !> The mesh, and the matrices or vectors of its unknowns. Every thread has its own, except band
  !! matrices, with which only one thread works.
  subroutine add_needs_of_mesh(model, threads, needs)
    type(model_t), intent(in) :: model
    integer, intent(in) :: threads
    type(memory_need_t), intent(inout) :: needs(:)

    !> Copies of the table of each element's unknowns, four bytes an entry; reals per element
    !! (forces, masses).
    real(wp), parameter :: copies = 3.0_wp, of_element = 20.0_wp
    integer, allocatable :: links(:), elements(:), order(:)
    integer :: finest, i
    real(wp) :: unknowns

    ! Rigid links have no mesh.
    links = pack([(i, i=1, size(model%links))], model%links%mesh > 0)
    elements = model%meshes(model%links(links)%mesh)%elements
    order = model%meshes(model%links(links)%mesh)%order
    finest = maxloc(elements*bending_unknowns(order, model%shear), dim=1)
    needs(of_mesh)%place = model%meshes(model%links(links(finest))%mesh)%keyword
    needs(of_matrices)%place = needs(of_mesh)%place
    needs(of_mesh)%what = plural(sum(elements), "element")
    needs(of_mesh)%bytes = sum(real(elements, wp))*(copies*4*maxval(element_unknowns(order, &
      model%shear)) + of_element*number)
    if (.not. needs_frequencies(model)) return
    select case (chosen_method(method_wanted(model), &
      any(model%meshes(model%links(links)%mesh)%accuracy > 0.0_wp), elements, order, model%shear))
    case (by_dense)
      unknowns = nodal_unknowns(elements, order, model%shear)
      needs(of_matrices)%place = model%solver_word
      needs(of_matrices)%what = "dense matrices of "//to_string(unknowns, 9)// &
        " unknowns (3 of them a thread)"
      needs(of_matrices)%bytes = threads*3*number*unknowns**2
    case (by_band)
      unknowns = nodal_unknowns(elements, order, model%shear)
      needs(of_matrices)%what = "band matrices of "//to_string(unknowns, 9)//" unknowns"
      needs(of_matrices)%bytes = number*unknowns*band_numbers(model%modes, &
        maxval(element_unknowns(order, model%shear)))
    end select
  end subroutine add_needs_of_mesh

  !> Number of unknowns, as `beam_mesh` numbers them: each element brings its own less the 3 of one
  !! node. Of the 9 that three links have besides, pins share 4 and supports hold 5.
  pure function nodal_unknowns(elements, order, sheared) result(unknowns)
    integer, intent(in) :: elements(:), order(:)
    logical, intent(in) :: sheared
    real(wp) :: unknowns

    unknowns = sum(real(elements, wp)*(element_unknowns(order, sheared) - 3))
  end function nodal_unknowns

  !> Reals per unknown for ARPACK: eight band matrices, its basis, vectors.
  pure function band_numbers(modes, bandwidth) result(numbers)
    integer, intent(in) :: modes, bandwidth
    real(wp) :: numbers

    numbers = 8.0_wp*bandwidth + max(2*modes + 1, 20) + 2*modes + 8
  end function band_numbers

end module memory_needs
