!> The memory that frequencies take.
module frequency_memory
  use beam_element, only: element_unknowns
  use deformation_shapes, only: bending_unknowns
  use kinds, only: wp
  use link_cards, only: segment_count
  use models, only: effects_static, is_four_bar, model_t, needs_frequencies, report_number
  use mode_requests, only: method_wanted
  use study_types, only: add_need, bytes_of_number, memory_needs_t
  use text, only: plural, to_string
  use tokens, only: token_t
  use vibration_models, only: by_band, by_dense, chosen_method
  implicit none (type, external)
  private

  public :: add_frequency_memory, add_branches_memory

contains

  !> Eigenvalues and errors at every position and speed, shapes, and what the solvers take.
  subroutine add_frequency_memory(model, needs)
    type(model_t), intent(in) :: model
    type(memory_needs_t), intent(inout) :: needs

    !> Bytes of the results at a position, and at one of its speeds, without their numbers.
    real(wp), parameter :: of_position = 600.0_wp, of_speed = 230.0_wp
    integer :: speeds

    call add_mesh_memory(model, needs)
    if (.not. needs_frequencies(model)) return
    speeds = speed_count(model)
    ! Results at positions are one need of the run.
    needs%list(1)%what = needs%list(1)%what//" and "//plural(speeds, "speed")
    needs%list(1)%bytes = needs%list(1)%bytes + needs%kept*(of_position + &
      speeds*(of_speed + 2*model%modes*bytes_of_number))
    call add_shapes_memory(model, needs)
  end subroutine add_frequency_memory

  !> Speeds of frequencies.
  pure function speed_count(model) result(count)
    type(model_t), intent(in) :: model
    integer :: count

    count = size(model%speed%value)
    if (model%effects == effects_static) count = 1
  end function speed_count

  !> Displacements at the points of all links for every mode, kept until they are written.
  pure subroutine add_shapes_memory(model, needs)
    type(model_t), intent(in) :: model
    type(memory_needs_t), intent(inout) :: needs

    real(wp) :: drawn
    integer :: report

    report = report_number(model, "shapes")
    if (report == 0) return
    associate (asked => model%reports(report))
      drawn = merge(size(asked%crank%value), size(model%crank%value), size(asked%crank%value) > 0)
      drawn = drawn*merge(size(asked%speed%value), speed_count(model), size(asked%speed%value) > 0)
      call add_need(needs, asked%keyword, "the shapes of "//plural(model%modes, "mode")//" at "// &
        to_string(drawn, 9)//" positions and speeds", &
        drawn*model%modes*3*bytes_of_number*most_parts(model)*asked%points)
    end associate
  end subroutine add_shapes_memory

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
  pure subroutine add_branches_memory(model, needs)
    type(model_t), intent(in) :: model
    type(memory_needs_t), intent(inout) :: needs

    real(wp), parameter :: of_print = 200.0_wp, of_branch = 20.0_wp
    real(wp) :: kept, rows
    integer :: report

    report = report_number(model, "branches")
    if (report == 0) return
    kept = most_parts(model) + 1 + most_parts(model)*(2.0_wp*model%modes + 2)
    rows = real(size(model%crank%value), wp)*speed_count(model)
    call add_need(needs, model%reports(report)%keyword, "the branches of "// &
      plural(model%modes, "mode")//" through "//to_string(rows, 9)//" positions and speeds", &
      rows*(of_print + model%modes*(of_branch + 2*kept*bytes_of_number)))
  end subroutine add_branches_memory

  !> The mesh, and the matrices or vectors of its unknowns. Every thread has its own, except band
  !! matrices, with which only one thread works.
  subroutine add_mesh_memory(model, needs)
    type(model_t), intent(in) :: model
    type(memory_needs_t), intent(inout) :: needs

    !> Copies of the table of each element's unknowns, four bytes an entry; reals per element
    !! (forces, masses).
    real(wp), parameter :: copies = 3.0_wp, of_element = 20.0_wp
    integer, allocatable :: links(:), elements(:), order(:)
    integer :: finest, i
    real(wp) :: unknowns
    type(token_t) :: place

    ! Rigid links have no mesh.
    if (.not. (any(model%links%mesh > 0) .and. all(model%links%mesh > 0 .or. &
      model%links%rigid))) return
    links = pack([(i, i=1, size(model%links))], model%links%mesh > 0)
    elements = model%meshes(model%links(links)%mesh)%elements
    order = model%meshes(model%links(links)%mesh)%order
    finest = maxloc(elements*bending_unknowns(order, model%shear), dim=1)
    place = model%meshes(model%links(links(finest))%mesh)%keyword
    call add_need(needs, place, plural(sum(elements), "element"), sum(real(elements, wp))* &
      (copies*4*maxval(element_unknowns(order, model%shear)) + of_element*bytes_of_number))
    if (.not. needs_frequencies(model)) return
    select case (chosen_method(method_wanted(model), &
      any(model%meshes(model%links(links)%mesh)%accuracy > 0.0_wp), elements, order, model%shear))
    case (by_dense)
      unknowns = nodal_unknowns(elements, order, model%shear)
      call add_need(needs, model%solver_word, "dense matrices of "//to_string(unknowns, 9)// &
        " unknowns (3 of them a thread)", needs%threads*3*bytes_of_number*unknowns**2)
    case (by_band)
      unknowns = nodal_unknowns(elements, order, model%shear)
      call add_need(needs, place, "band matrices of "//to_string(unknowns, 9)//" unknowns", &
        bytes_of_number*unknowns*band_numbers(model%modes, maxval(element_unknowns(order, &
        model%shear))))
    end select
  end subroutine add_mesh_memory

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

end module frequency_memory
