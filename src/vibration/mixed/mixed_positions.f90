!> A linkage of many links at a position: matrices in mixed form, forces of its loads, its modes.
module mixed_positions
  use bordered_eigensolver, only: bordered_modes_t, start_t
  use bordered_matrix, only: layout_t, new_bordered_layout
  use elastic_positions, only: elastic_position_t
  use element_eigensolver, only: check_conditions, element_pencil_t, find_element_modes
  use element_matrices, only: absolute_times_vector, times_vector
  use errors, only: error_of_dead_point, error_t, set_error
  use indefinite_factor, only: factorize, solve
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use load_cases, only: case_count
  use mixed_form, only: mixed_form_t, new_mixed_form, place_elements
  use mixed_matrices, only: add_mixed_geometric, assemble_mixed_mass, assemble_mixed_stiffness, &
    mixed_work
  use modal_assurance, only: mode_prints_t, new_mode_prints
  use part_displacements, only: chords_of
  use part_force_types, only: loaded_parts_t
  use part_forces, only: make_room, take_forces
  use pin_displacements, only: chords_t
  use poses, only: pose_t, refuse_change_point
  implicit none (type, external)
  private

  public :: mixed_position_t, new_mixed_position, assemble_rest, hold, &
    find_mixed_forces, stiffen, find_mixed_modes, displacements_of, modes_on_border, &
    find_mixed_prints, find_work, largest_work

  !> Allocated once for a model, filled at every position.
  type :: mixed_position_t
    type(mixed_form_t) :: form
    type(element_pencil_t) :: pencil           !! M, and K at one speed
    real(wp), allocatable :: at_rest(:)        !! K without loads
    real(wp), allocatable :: unit_stiffness(:, :) !! (values, cases) K_G of each unit load
    real(wp), allocatable :: solution(:, :)    !! (unknowns, cases) how the linkage yields to each
  end type mixed_position_t

contains

  !> Numbers of a linkage.
  pure function new_mixed_position(at) result(mixed)
    type(elastic_position_t), intent(in) :: at !! of the linkage
    type(mixed_position_t) :: mixed

    mixed%form = new_mixed_form(at)
    mixed%pencil%conditions = mixed%form%conditions
  end function new_mixed_position

  !> K and M of a position, without loads.
  subroutine assemble_rest(at, mixed)
    type(elastic_position_t), intent(in) :: at      !! with parts that are placed
    type(mixed_position_t), intent(inout) :: mixed  !! of this linkage

    integer :: n

    call place_elements(at%elastic, at%model%links, mixed%form)
    associate (form => mixed%form, pencil => mixed%pencil)
      n = size(form%elements%value_first)
      n = form%elements%value_first(n) - 1
      if (allocated(pencil%mass)) then
        if (size(pencil%mass) /= n) deallocate (pencil%mass, mixed%at_rest)
      end if
      if (.not. allocated(pencil%mass)) allocate (pencil%mass(n), mixed%at_rest(n))
      call assemble_mixed_stiffness(form, at, mixed%at_rest)
      call assemble_mixed_mass(form, at, pencil%mass)
      pencil%stiffness = mixed%at_rest
    end associate
  end subroutine assemble_rest

  !> Finds the factor of K at rest.
  !!
  !! Errors: a dead point or a change point, where conditions do not hold the linkage, or follow
  !! from each other.
  pure subroutine hold(pose, mixed, error)
    type(pose_t), intent(in) :: pose                !! of points and parts
    type(mixed_position_t), intent(inout) :: mixed  !! at rest
    type(error_t), allocatable, intent(out) :: error

    logical :: held

    call check_conditions(mixed%form%elements, mixed%form%plan, mixed%pencil, held)
    if (held) return
    call refuse_change_point(pose, error)
    if (.not. allocated(error)) call set_error(error, error_of_dead_point, &
      "dead point: the conditions of the linkage depend on each other here")
  end subroutine hold

  !> The forces of all load cases, and how the linkage yields to them.
  pure subroutine find_mixed_forces(at, mixed, loaded, solution)
    type(elastic_position_t), intent(in) :: at      !! of it, with parts that are placed
    type(mixed_position_t), intent(in) :: mixed     !! with the factor of `hold`
    type(loaded_parts_t), intent(inout) :: loaded   !! with loads; gets their forces
    real(wp), allocatable, intent(out) :: solution(:, :) !! (unknowns, cases)

    real(wp) :: rest(mixed%form%unknowns), product(mixed%form%unknowns)
    integer :: i, n

    call make_room(at, loaded%loads, case_count, loaded%forces)
    associate (form => mixed%form)
      allocate (solution(form%unknowns, case_count), source=0.0_wp)
      n = form%multipliers + size(form%numbers%rows)
      do i = 1, case_count
        if (.not. loaded%loads%unit%occurs(i)) cycle
        rest = mixed_work(form, at, loaded%loads, i)
        solution(:, i) = rest
        call solve(form%plan, mixed%pencil%factor, solution(:, i))
        ! Refined once: forces pass from part to part with all their digits.
        call times_vector(form%elements, mixed%at_rest, solution(:, i), product)
        rest = rest - product
        call solve(form%plan, mixed%pencil%factor, rest)
        solution(:, i) = solution(:, i) + rest
        ! The unknowns of `displacements_of` these solutions.
        loaded%forces%border(i, i) = 1.0_wp
        call take_forces(at, solution(form%rows + 1:form%displacements, i), solution(n + 1:, &
          i)/form%unit, i, loaded)
      end do
    end associate
  end subroutine find_mixed_forces

  !> K_G of every load case that occurs.
  subroutine stiffen(at, loaded, mixed)
    type(elastic_position_t), intent(in) :: at     !! with parts that are placed
    type(loaded_parts_t), intent(in) :: loaded      !! its loads and forces
    type(mixed_position_t), intent(inout) :: mixed

    integer :: i

    if (allocated(mixed%unit_stiffness)) then
      if (size(mixed%unit_stiffness, 1) /= size(mixed%at_rest)) deallocate (mixed%unit_stiffness)
    end if
    if (.not. allocated(mixed%unit_stiffness)) allocate (mixed%unit_stiffness( &
      size(mixed%at_rest), case_count), source=0.0_wp)
    do i = 1, case_count
      if (.not. loaded%loads%unit%occurs(i)) cycle
      mixed%unit_stiffness(:, i) = 0.0_wp
      call add_mixed_geometric(mixed%form, at, loaded, i, mixed%unit_stiffness(:, i))
    end do
  end subroutine stiffen

  !> The lowest modes at a speed.
  !!
  !! Errors: those of `find_element_modes`.
  subroutine find_mixed_modes(mixed, factor, modes, accurate_vectors, start, clearance, found, &
    error)
    type(mixed_position_t), intent(inout) :: mixed   !! at a position
    real(wp), intent(in) :: factor(case_count)       !! of the unit loads: ω2², α2, 1
    integer, intent(in) :: modes                     !! number wanted
    logical, intent(in) :: accurate_vectors          !! also to full precision
    type(start_t), intent(in) :: start               !! from the last positions
    real(wp), intent(in) :: clearance                !! as of `find_element_modes`
    type(bordered_modes_t), intent(inout) :: found   !! in the unknowns of the form
    type(error_t), allocatable, intent(out) :: error

    call set_stiffness(mixed, factor)
    call find_element_modes(mixed%form%elements, mixed%form%plan, mixed%pencil, modes, &
      accurate_vectors, start, found, error, clearance)
  end subroutine find_mixed_modes

  !> K of a speed.
  pure subroutine set_stiffness(mixed, factor)
    type(mixed_position_t), intent(inout) :: mixed
    real(wp), intent(in) :: factor(case_count)

    integer :: i

    mixed%pencil%stiffness = mixed%at_rest
    do i = 1, case_count
      if (abs(factor(i)) > 0.0_wp) mixed%pencil%stiffness = mixed%pencil%stiffness + &
        factor(i)*mixed%unit_stiffness(:, i)
    end do
  end subroutine set_stiffness

  !> What some solutions do to points and parts.
  pure function displacements_of(form, at, z) result(chords)
    type(mixed_form_t), intent(in) :: form         !! of the linkage
    type(elastic_position_t), intent(in) :: at     !! of it, with parts that are placed
    real(wp), intent(in) :: z(:, :)                !! (unknowns, solutions)
    type(chords_t) :: chords

    chords = chords_of(at, form%unit*z(form%displacements + 1:form%multipliers, :), z(form%rows + &
      1:form%displacements, :))
  end function displacements_of

  !> Modes as those of a bordered matrix whose border are the modes themselves: the unknown of a
  !! mode is the norm of its y, so that squares of unknowns are energies.
  pure subroutine modes_on_border(mixed, at, modes, chords, border_mass, found)
    type(mixed_position_t), intent(in) :: mixed     !! at this position
    type(elastic_position_t), intent(inout) :: at   !! of it; the layout of its model becomes that
                                                    !! of the border and own modes
    type(bordered_modes_t), intent(in) :: modes     !! in the unknowns of the form
    type(chords_t), intent(out) :: chords           !! what unit unknowns of the border do
    real(wp), allocatable, intent(out) :: border_mass(:, :) !! M between the border's [s²]
    type(bordered_modes_t), intent(out) :: found

    real(wp), allocatable :: z(:, :), without_own(:), product(:)
    real(wp) :: norm
    integer :: i, n

    n = size(modes%lambda)
    at%model%layout = new_bordered_layout(n, at%model%links%modes, at%model%links%axial_modes)
    found%lambda = modes%lambda
    found%error = modes%error
    found%near = modes%near
    allocate (found%vector(at%model%layout%unknowns, n), source=0.0_wp)
    z = modes%vector
    do i = 1, n
      norm = norm2(z(mixed%form%rows + 1:mixed%form%displacements, i))
      if (.not. norm > 0.0_wp) norm = tiny(norm)
      found%vector(i, i) = norm
      call take_own(mixed%form, at%model%links, at%model%layout, z(:, i), found%vector(:, i))
      z(:, i) = z(:, i)/norm
    end do
    chords = displacements_of(mixed%form, at, z)
    allocate (border_mass(n, n), product(size(z, 1)))
    do i = 1, n
      without_own = z(:, i)
      without_own(:mixed%form%rows) = 0.0_wp
      call times_vector(mixed%form%elements, mixed%pencil%mass, without_own, product)
      product(:mixed%form%rows) = 0.0_wp
      border_mass(:, i) = matmul(product, z)
    end do
  end subroutine modes_on_border

  !> Puts own modes of links in the order of a bordered matrix.
  pure subroutine take_own(form, links, layout, z, vector)
    type(mixed_form_t), intent(in) :: form
    type(link_modes_t), intent(in) :: links(:)
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: z(:)
    real(wp), intent(inout) :: vector(:)

    integer :: axial, first, k, own

    axial = layout%unknowns - sum(links%axial_modes)
    do k = 1, size(links)
      first = layout%first(k) - 1
      own = form%own(k)
      vector(first + 1:first + links(k)%modes) = z(own + 1:own + links(k)%modes)
      own = own + links(k)%modes
      vector(axial + 1:axial + links(k)%axial_modes) = z(own + 1:own + links(k)%axial_modes)
      axial = axial + links(k)%axial_modes
    end do
  end subroutine take_own

  !> Prints of the first modes: strains and own modes, and M of these. With K at rest the unit
  !! matrix between strains, the forces `M z` do the work of the strains of `K⁻¹ M z`.
  pure subroutine find_mixed_prints(mixed, links, modes, number, prints)
    type(mixed_position_t), intent(inout) :: mixed  !! at the position of the modes; the factor
                                                    !! becomes that of K at rest
    type(link_modes_t), intent(in) :: links(:)      !! (parts)
    type(bordered_modes_t), intent(in) :: modes     !! in the unknowns of the form
    integer, intent(in) :: number                   !! how many
    type(mode_prints_t), intent(out) :: prints

    type(bordered_modes_t) :: strains
    type(layout_t) :: layout
    real(wp) :: strained(mixed%form%unknowns, number)
    integer :: i, n

    associate (form => mixed%form)
      n = form%displacements - form%rows
      layout = new_bordered_layout(n, links%modes, links%axial_modes)
      call factorize(form%plan, form%elements, mixed%at_rest, mixed%pencil%factor)
      strained = modes%mass_times(:, :number)
      call solve(form%plan, mixed%pencil%factor, strained)
      allocate (strains%vector(layout%unknowns, number), strains%mass_times(layout%unknowns, &
        number), source=0.0_wp)
      do i = 1, number
        strains%vector(:n, i) = modes%vector(form%rows + 1:form%displacements, i)
        strains%mass_times(:n, i) = strained(form%rows + 1:form%displacements, i)
        call take_own(form, links, layout, modes%vector(:, i), strains%vector(:, i))
        call take_own(form, links, layout, strained(:, i), strains%mass_times(:, i))
      end do
    end associate
    prints = new_mode_prints(layout, strains, number)
  end subroutine find_mixed_prints

  !> `zᵀ(K − λM) z` of the lowest modes, K at a speed [1/s²]: what a change of the matrices changes
  !! of it, multipliers and all, it changes of the eigenvalue to first order.
  pure subroutine find_work(mixed, factor, modes, work)
    type(mixed_position_t), intent(inout) :: mixed !! at a position near that of the modes; its K
                                                   !! becomes that of this speed
    real(wp), intent(in) :: factor(case_count)     !! of the unit loads
    type(bordered_modes_t), intent(in) :: modes    !! in the unknowns of the form
    real(wp), intent(out) :: work(:)               !! (modes)

    real(wp) :: product(mixed%form%unknowns)
    integer :: i

    call set_stiffness(mixed, factor)
    do i = 1, size(work)
      associate (z => modes%vector(:, i))
        call times_vector(mixed%form%elements, mixed%pencil%stiffness, z, product)
        work(i) = dot_product(z, product)
        call times_vector(mixed%form%elements, mixed%pencil%mass, z, product)
        work(i) = work(i) - modes%lambda(i)*dot_product(z, product)
      end associate
    end do
  end subroutine find_work

  !> Bound of what blocks on guides, springs under tension and loads of cuts do in modes of unit
  !! mass, whatever cancels, twice [1/s²].
  pure function largest_work(mixed, factor, modes, number) result(work)
    type(mixed_position_t), intent(in) :: mixed !! at the position of the modes
    real(wp), intent(in) :: factor(case_count)  !! of the unit loads
    type(bordered_modes_t), intent(in) :: modes !! in the unknowns of the form
    integer, intent(in) :: number               !! of modes
    real(wp) :: work(number)

    real(wp) :: product(mixed%form%unknowns), value(size(mixed%unit_stiffness, 1))
    integer :: i, k

    work = 0.0_wp
    do k = 1, case_count
      if (.not. abs(factor(k)) > 0.0_wp) cycle
      value = mixed%unit_stiffness(:, k)
      value(:mixed%form%elements%value_first(mixed%form%spring + 1) - 1) = 0.0_wp
      do i = 1, number
        call absolute_times_vector(mixed%form%elements, value, modes%vector(:, i), product)
        work(i) = work(i) + abs(factor(k))*dot_product(abs(modes%vector(:, i)), product)
      end do
    end do
  end function largest_work

end module mixed_positions
