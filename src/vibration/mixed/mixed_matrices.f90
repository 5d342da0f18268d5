!> The matrices of the mixed form at a position, element by element, and the work of its loads.
module mixed_matrices
  use border_loads, only: add_link_work
  use border_rows, only: add_rigid, add_spring
  use elastic_linkages, only: is_piece, spring_t
  use elastic_positions, only: elastic_position_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: normal_to, turned
  use load_cases, only: constant_case
  use mixed_form, only: mixed_form_t
  use part_force_types, only: loaded_parts_t, part_loads_t
  use reduced_assembly, only: add_link_mass, add_link_stiffness
  use terminal_work, only: add_between, line_direction, turn_of_end, way_between
  implicit none (type, external)
  private

  public :: assemble_mixed_stiffness, assemble_mixed_mass, add_mixed_geometric, mixed_work

  !> Most curves and displacements of a part that bends.
  integer, parameter :: most = 8

  !> A part among the unknowns of its element: own modes, elongation, then what moves it.
  type :: local_t
    integer :: own = 0                     !! own modes, across and along
    integer :: moving = 0                  !! curves of held ends and displacements
    integer :: curves = 0                  !! of these, the first
    real(wp) :: across(4, most) = 0.0_wp   !! as of `chords_t`, for each of what moves it
    real(wp) :: along(2, most) = 0.0_wp
    real(wp) :: turn(most) = 0.0_wp
    real(wp) :: rotation(2, most) = 0.0_wp !! of both ends, if they are held
  end type local_t

contains

  !> What the unknowns of its element do to a part.
  pure function place_locally(form, at, part) result(local)
    type(mixed_form_t), intent(in) :: form         !! of the linkage
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: part                    !! its number
    type(local_t) :: local

    real(wp) :: axis(2), normal(2)
    integer :: i, j, k, first, last, number

    associate (link => at%model%links(part))
      local%own = link%modes + link%axial_modes
      local%curves = link%curves
      axis = at%pose%direction(:, part)
      normal = normal_to(axis)
      do i = 1, link%curves
        local%across(2 + i, i) = 1.0_wp
      end do
      first = form%elements%first(part) + local%own
      if (link%bends) first = first + 1 + link%curves
      last = form%elements%first(part + 1) - 1
      j = local%curves
      do i = first, last
        number = form%elements%unknown(i) - form%displacements
        if (number > form%numbers%unknowns) exit
        j = j + 1
        ! Of a rigid link only its first pin and its rotation count.
        if (j > most) exit
        do k = 1, 2
          associate (point => merge(at%elastic%linkage%bodies(part)%first_pin, &
              at%elastic%linkage%bodies(part)%last_pin, k == 1), &
              rotation => at%elastic%rotation(k, part))
            if (form%numbers%point(point) > 0) then
              if (number == form%numbers%point(point)) then
                local%along(k, j) = axis(1)*form%unit
                local%across(k, j) = normal(1)*form%unit
              else if (number == form%numbers%point(point) + 1) then
                local%along(k, j) = axis(2)*form%unit
                local%across(k, j) = normal(2)*form%unit
              end if
            end if
            if (rotation > 0) then
              if (number == form%numbers%rotation(rotation)) local%rotation(k, j) = &
                form%unit/form%numbers%size_of
            end if
          end associate
        end do
      end do
      local%moving = min(j, most)
      if (.not. link%bends) then
        local%turn = local%rotation(1, :)
      else if (is_piece(at%elastic, part)) then
        ! From the rotations of held ends: the ends of a short piece move by the same amount.
        local%turn = local%rotation(1, :) + local%rotation(2, :)
        local%turn(1) = local%turn(1) - link%curve_rotation(1)
        if (link%curves == 2) local%turn = 0.5_wp*local%turn
      else
        local%turn = (local%across(2, :) - local%across(1, :))/link%length
      end if
    end associate
  end function place_locally

  !> `K`: the unit matrix of strains, and the conditions.
  subroutine assemble_mixed_stiffness(form, at, value)
    type(mixed_form_t), intent(in) :: form         !! of the linkage
    type(elastic_position_t), intent(in) :: at     !! of it
    real(wp), intent(out) :: value(:)              !! of the elements

    real(wp) :: row(form%numbers%unknowns)
    real(wp), allocatable :: rows(:, :)
    integer :: i, k, n

    value = 0.0_wp
    row = 0.0_wp
    n = 0
    do k = 1, size(at%model%links)
      n = max(n, 2*(1 + size(at%elastic%linkage%bodies(k)%further)))
    end do
    allocate (rows(size(row), n), source=0.0_wp)
    do k = 1, size(at%model%links)
      if (at%model%links(k)%bends) then
        call add_part_conditions(form, at%model%links(k), place_locally(form, at, k), k, value)
      else
        n = 2*(1 + size(at%elastic%linkage%bodies(k)%further))
        call add_rigid(at, k, rows(:, :n))
        do i = 1, n
          call add_condition(form, k, form%elements%first(k + 1) - n + i - 1, 1.0_wp, rows(:, i), &
            value)
          call clear(form, k, rows(:, i))
        end do
      end if
    end do
    do i = 1, size(at%elastic%springs)
      k = form%spring + i
      call add_spring(at, at%elastic%springs(i), row)
      call add_spring_condition(form, at%elastic%springs(i), k, row, value)
      call clear(form, k, row)
    end do
    do i = 1, size(at%elastic%contact)
      if (form%numbers%line_constraint(i) == 0) cycle
      k = form%line + i
      call add_between(at, at%elastic%sliding(:, i), normal_to(line_direction(at%elastic, at%pose, &
        i)), 0.0_wp, row)
      call add_condition(form, k, form%elements%first(k + 1) - 1, 1.0_wp, row, value)
      call clear(form, k, row)
    end do
    do i = 1, size(at%elastic%linkage%drives)
      if (form%numbers%drive_constraint(i) == 0) cycle
      k = form%drive + i
      call add_between(at, at%elastic%driven(:, i), line_direction(at%elastic, at%pose, &
        at%elastic%linkage%drives(i)%slider), 0.0_wp, row)
      call add_condition(form, k, form%elements%first(k + 1) - 1, 1.0_wp, row, value)
      call clear(form, k, row)
    end do
  end subroutine assemble_mixed_stiffness

  !> Elongation and curves of a part, in units in which displacements have the factor 1.
  subroutine add_part_conditions(form, link, local, element, value)
    type(mixed_form_t), intent(in) :: form
    type(link_modes_t), intent(in) :: link
    type(local_t), intent(in) :: local
    integer, intent(in) :: element
    real(wp), intent(inout) :: value(:)

    real(wp) :: row(most), sense
    integer :: i, j, n, strain, multiplier

    n = form%elements%first(element + 1) - form%elements%first(element)
    call set_diagonal(form, element, spread(1.0_wp, 1, local%own + 1 + local%curves), value)
    do i = 0, local%curves
      strain = local%own + 1 + i
      multiplier = local%own + 1 + local%moving + 1 + i
      if (i == 0) then
        row = local%along(1, :) - local%along(2, :)
        call set(strain, link%elongation/form%unit)
      else
        sense = merge(-1.0_wp, 1.0_wp, i == 2)
        row = -link%length*(local%rotation(1, :) + sense*local%rotation(2, :))
        if (i == 1) row = row + local%curves*(local%across(2, :) - local%across(1, :))
        call set(strain, link%length*link%curve_rotation(i)/form%unit)
      end if
      do j = local%curves + 1, local%moving
        call set(local%own + 1 + j, row(j)/form%unit)
      end do
    end do

  contains

    !> Sets what multiplies an unknown in the condition.
    subroutine set(unknown, entry)
      integer, intent(in) :: unknown
      real(wp), intent(in) :: entry

      associate (start => form%elements%value_first(element) - 1)
        value(start + (unknown - 1)*n + multiplier) = entry
        value(start + (multiplier - 1)*n + unknown) = entry
      end associate
    end subroutine set

  end subroutine add_part_conditions

  !> Adds a condition between displacements.
  pure subroutine add_condition(form, element, place, factor, row, value)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: element
    integer, intent(in) :: place     !! of its multiplier in the list of all elements' unknowns
    real(wp), intent(in) :: factor   !! of the row
    real(wp), intent(in) :: row(:)   !! (displacements)
    real(wp), intent(inout) :: value(:)

    integer :: i, n, first, start, at, multiplier

    first = form%elements%first(element)
    n = form%elements%first(element + 1) - first
    start = form%elements%value_first(element) - 1
    multiplier = place - first + 1
    do i = 1, n
      at = form%elements%unknown(first + i - 1) - form%displacements
      if (at < 1 .or. at > size(row)) cycle
      value(start + (i - 1)*n + multiplier) = factor*row(at)
      value(start + (multiplier - 1)*n + i) = factor*row(at)
    end do
  end subroutine add_condition

  !> Adds the condition of a spring; of one that turns in units of a displacement, too.
  pure subroutine add_spring_condition(form, spring, element, row, value)
    type(mixed_form_t), intent(in) :: form
    type(spring_t), intent(in) :: spring
    integer, intent(in) :: element
    real(wp), intent(in) :: row(:)
    real(wp), intent(inout) :: value(:)

    real(wp) :: factor
    integer :: n, start

    factor = merge(form%numbers%size_of, 1.0_wp, spring%turns)
    n = form%elements%first(element + 1) - form%elements%first(element)
    start = form%elements%value_first(element) - 1
    value(start + 1) = 1.0_wp
    if (.not. spring%stiffness > 0.0_wp) then
      ! It holds nothing: its strain and its multiplier are zero, and count as one condition.
      value(start + n*n) = -1.0_wp
      return
    end if
    call add_condition(form, element, form%elements%first(element + 1) - 1, -factor, row, value)
    value(start + n) = factor/(form%unit*sqrt(spring%stiffness))
    value(start + (n - 1)*n + 1) = value(start + n)
  end subroutine add_spring_condition

  !> Sets the entries of a row to zero that an element may have set.
  pure subroutine clear(form, element, row)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: element
    real(wp), intent(inout) :: row(:)

    integer :: i, at

    do i = form%elements%first(element), form%elements%first(element + 1) - 1
      at = form%elements%unknown(i) - form%displacements
      if (at >= 1 .and. at <= size(row)) row(at) = 0.0_wp
    end do
  end subroutine clear

  !> `M`.
  pure subroutine assemble_mixed_mass(form, at, value)
    type(mixed_form_t), intent(in) :: form         !! of the linkage
    type(elastic_position_t), intent(in) :: at     !! of it
    real(wp), intent(out) :: value(:)              !! of the elements [s²]

    type(local_t) :: local
    real(wp) :: square(most, most)
    integer :: i, j, k, n, start

    value = 0.0_wp
    do k = 1, size(at%model%links)
      local = place_locally(form, at, k)
      call add_part_mass(form, at%model%links(k), local, k, value)
    end do
    do i = 1, size(at%elastic%is_fixed)
      k = form%point + i
      n = form%elements%first(k + 1) - form%elements%first(k)
      start = form%elements%value_first(k) - 1
      do j = 1, n
        value(start + (j - 1)*n + j) = at%elastic%linkage%pin_mass(i)*form%unit**2
      end do
    end do
    do i = 1, size(at%elastic%carried)
      associate (this => at%elastic%carried(i))
        k = form%carried + i
        n = form%elements%first(k + 1) - form%elements%first(k)
        start = form%elements%value_first(k)
        square(:n, :n) = 0.0_wp
        call add_carried(form, at, i, square(:n, :n))
        value(start:start + n*n - 1) = reshape(square(:n, :n), [n*n])
      end associate
    end do
    k = form%cut
    do i = 1, size(at%elastic%ways)
      do j = 1, size(at%elastic%ways(i)%cuts)
        k = k + 1
        associate (cut => at%elastic%ways(i)%cuts(j))
          if (cut%rotation > 0) value(form%elements%value_first(k)) = cut%inertia* &
            (form%unit/form%numbers%size_of)**2
        end associate
      end do
    end do
  end subroutine assemble_mixed_mass

  !> The mass of a part.
  pure subroutine add_part_mass(form, link, local, element, value)
    type(mixed_form_t), intent(in) :: form
    type(link_modes_t), intent(in) :: link
    type(local_t), intent(in) :: local
    integer, intent(in) :: element
    real(wp), intent(inout) :: value(:)

    real(wp) :: border(local%moving, local%moving), coupling(local%moving, link%modes), &
      axial(local%moving, link%axial_modes), motion(3, local%moving)
    integer :: first

    associate (m => local%moving)
      border = 0.0_wp
      if (link%bends) then
        call add_link_mass(link, local%across(:2 + link%curves, :m), local%along(:, :m), border, &
          coupling, axial)
        first = local%own + 1
        call set_diagonal(form, element, [link%square, link%axial_square], value)
        call set_block(form, element, first, 0, coupling, value)
        call set_block(form, element, first, link%modes, axial, value)
        call set_block(form, element, first, first, border, value)
      else
        motion(1, :) = local%along(1, :m)
        motion(2, :) = local%across(1, :m)
        motion(3, :) = local%turn(:m)
        call set_block(form, element, 0, 0, matmul(transpose(motion), matmul(link%rigid_mass, &
          motion)), value)
      end if
    end associate
  end subroutine add_part_mass

  !> Sets the first entries of the diagonal of an element.
  pure subroutine set_diagonal(form, element, diagonal, value)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: element
    real(wp), intent(in) :: diagonal(:)
    real(wp), intent(inout) :: value(:)

    integer :: i, n, start

    n = form%elements%first(element + 1) - form%elements%first(element)
    start = form%elements%value_first(element) - 1
    do i = 1, size(diagonal)
      value(start + (i - 1)*n + i) = diagonal(i)
    end do
  end subroutine set_diagonal

  !> Adds a block to an element after so many rows and columns, on both sides of the diagonal.
  pure subroutine set_block(form, element, row, column, block, value)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: element, row, column
    real(wp), intent(in) :: block(:, :)
    real(wp), intent(inout) :: value(:)

    integer :: i, j, n, start

    n = form%elements%first(element + 1) - form%elements%first(element)
    start = form%elements%value_first(element) - 1
    do j = 1, size(block, 2)
      do i = 1, size(block, 1)
        associate (entry => value(start + (column + j - 1)*n + row + i))
          entry = entry + block(i, j)
        end associate
        if (row /= column) then
          associate (entry => value(start + (row + i - 1)*n + column + j))
            entry = entry + block(i, j)
          end associate
        end if
      end do
    end do
  end subroutine set_block

  !> The mass of what a cut carries, between the displacements of its point and its rotation.
  pure subroutine add_carried(form, at, number, mass)
    type(mixed_form_t), intent(in) :: form
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: number
    real(wp), intent(inout) :: mass(:, :)

    real(wp) :: moved(2, size(mass, 1)), turn(size(mass, 1)), arm(2)
    integer :: j, n

    associate (this => at%elastic%carried(number))
      moved = 0.0_wp
      turn = 0.0_wp
      n = 0
      if (form%numbers%point(this%point) > 0) then
        moved(1, 1) = form%unit
        moved(2, 2) = form%unit
        n = 2
      end if
      if (this%rotation > 0) turn(n + 1) = form%unit/form%numbers%size_of
      arm = normal_to(turned(this%arm, at%pose%direction(:, at%elastic%ways(this%way)%first_part)))
      do j = 1, size(turn)
        moved(:, j) = moved(:, j) + turn(j)*arm
      end do
      do j = 1, size(turn)
        mass(:, j) = mass(:, j) + this%mass*(moved(1, :)*moved(1, j) + moved(2, :)*moved(2, j)) + &
          this%inertia*turn*turn(j)
      end do
    end associate
  end subroutine add_carried

  !> Adds `K_G` of a load case.
  subroutine add_mixed_geometric(form, at, loaded, case, value)
    type(mixed_form_t), intent(in) :: form         !! of the linkage
    type(elastic_position_t), intent(in) :: at     !! of it
    type(loaded_parts_t), intent(in) :: loaded     !! its loads and forces
    integer, intent(in) :: case                    !! number of the load case
    real(wp), intent(inout) :: value(:)            !! of the elements

    type(local_t) :: local
    real(wp) :: row(form%numbers%unknowns), turn(form%numbers%unknowns), constant
    integer :: i, k

    do k = 1, size(at%model%links)
      local = place_locally(form, at, k)
      call add_part_stiffness(form, at%model%links(k), local, loaded%forces%axial(:, k, case), k, &
        value)
    end do
    row = 0.0_wp
    turn = 0.0_wp
    do i = 1, size(at%elastic%contact)
      if (at%elastic%sliding(1, i)%rotation <= 0) cycle
      k = form%line + i
      call add_between(at, at%elastic%sliding(:, i), line_direction(at%elastic, at%pose, i), &
        0.0_wp, row)
      turn(form%numbers%rotation(at%elastic%sliding(1, i)%rotation)) = 1.0_wp/form%numbers%size_of
      call add_product(form, k, loaded%forces%guide(i, case), row, turn, value)
      call clear(form, k, row)
      call clear(form, k, turn)
    end do
    constant = merge(1.0_wp, 0.0_wp, case == constant_case)
    do i = 1, size(at%elastic%springs)
      call add_pull(at%elastic%springs(i), form%spring + i, loaded%forces%spring(i, case))
    end do
    do i = 1, size(at%elastic%tensions)
      call add_pull(at%elastic%tensions(i), form%tension + i, constant*loaded%loads%tension(i))
    end do
    do i = 1, size(at%elastic%carried)
      associate (this => at%elastic%carried(i))
        if (this%rotation <= 0) cycle
        turn(form%numbers%rotation(this%rotation)) = 1.0_wp/form%numbers%size_of
        call add_product(form, form%carried + i, 0.5_wp*loaded%loads%carried(4, i, case), turn, &
          turn, value)
        turn(form%numbers%rotation(this%rotation)) = 0.0_wp
      end associate
    end do

  contains

    !> Adds what a pull along a line does that turns with the linkage: `½ (T/l) (n·ΔU)²`.
    subroutine add_pull(spring, element, pull)
      type(spring_t), intent(in) :: spring
      integer, intent(in) :: element
      real(wp), intent(in) :: pull

      real(wp) :: way(2)

      if (spring%turns) return
      associate (ends => at%elastic%load_ends(:, spring%load))
        way = way_between(at%pose, ends)
        if (.not. norm2(way) > 0.0_wp) return
        call add_between(at, ends, normal_to(way)/norm2(way), 0.0_wp, row)
      end associate
      call add_product(form, element, 0.5_wp*pull/norm2(way), row, row, value)
      call clear(form, element, row)
    end subroutine add_pull

  end subroutine add_mixed_geometric

  !> The geometric stiffness of a part.
  pure subroutine add_part_stiffness(form, link, local, force, element, value)
    type(mixed_form_t), intent(in) :: form
    type(link_modes_t), intent(in) :: link
    type(local_t), intent(in) :: local
    real(wp), intent(in) :: force(:)
    integer, intent(in) :: element
    real(wp), intent(inout) :: value(:)

    real(wp) :: border(local%moving, local%moving), coupling(local%moving, link%modes), &
      block(link%modes, link%modes)
    integer :: first

    border = 0.0_wp
    associate (m => local%moving)
      call add_link_stiffness(link, local%turn(:m), local%across(3:, :m), force, border, coupling, &
        block)
    end associate
    first = merge(local%own + 1, 0, link%bends)
    call set_block(form, element, first, first, border, value)
    if (.not. link%bends) return
    call set_block(form, element, first, 0, coupling, value)
    call set_block(form, element, 0, 0, block, value)
  end subroutine add_part_stiffness

  !> Adds `factor (a bᵀ + b aᵀ)` of two rows to an element.
  pure subroutine add_product(form, element, factor, a, b, value)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: element
    real(wp), intent(in) :: factor, a(:), b(:)
    real(wp), intent(inout) :: value(:)

    integer :: i, j, n, first, start, p, q

    first = form%elements%first(element)
    n = form%elements%first(element + 1) - first
    start = form%elements%value_first(element) - 1
    do j = 1, n
      q = form%elements%unknown(first + j - 1) - form%displacements
      if (q < 1 .or. q > size(a)) cycle
      do i = 1, n
        p = form%elements%unknown(first + i - 1) - form%displacements
        if (p < 1 .or. p > size(a)) cycle
        value(start + (j - 1)*n + i) = value(start + (j - 1)*n + i) + &
          factor*form%unit**2*(a(p)*b(q) + b(p)*a(q))
      end do
    end do
  end subroutine add_product

  !> Work of a load case on every unknown. It leaves own modes out, which carry no force between
  !! parts.
  pure function mixed_work(form, at, loads, case) result(work)
    type(mixed_form_t), intent(in) :: form         !! of the linkage
    type(elastic_position_t), intent(in) :: at     !! of it
    type(part_loads_t), intent(in) :: loads        !! of this position
    integer, intent(in) :: case                    !! number of the load case
    real(wp) :: work(form%unknowns)

    type(local_t) :: local
    real(wp) :: on_part(most)
    integer :: i, j, k, first

    work = 0.0_wp
    associate (of_case => loads%unit%of_case(case))
      do k = 1, size(at%model%links)
        local = place_locally(form, at, k)
        on_part = 0.0_wp
        associate (m => local%moving)
          call add_link_work(at%elastic%linkage, at%model%links(k), k, local%across(:, :m), &
            local%along(:, :m), local%turn(:m), at%pose, of_case, on_part(:m))
          do i = 1, 2
            if (.not. abs(loads%end_couple(i, k, case)) > 0.0_wp) cycle
            if (at%elastic%rotation(i, k) > 0) call add_moment(form, at%elastic%rotation(i, k), &
              loads%end_couple(i, k, case), work)
            if (at%elastic%rotation(i, k) == 0) on_part(:m) = on_part(:m) + loads%end_couple(i, k, &
              case)*turn_of_end(at%model%links(k), local%turn(:m), local%across(3:, :m), i)
          end do
        end associate
        first = form%elements%first(k) + local%own + merge(1, 0, at%model%links(k)%bends) - 1
        do j = 1, local%moving
          associate (entry => work(form%elements%unknown(first + j)))
            entry = entry + on_part(j)
          end associate
        end do
      end do
      do i = 1, size(at%elastic%is_fixed)
        call add_force(form, i, of_case%pin_force(:, i) - at%elastic%linkage%pin_mass(i)* &
          of_case%field%at_pin(:, i), work)
      end do
      do i = 1, at%elastic%rotations
        call add_moment(form, i, loads%moment(i, case), work)
      end do
      do i = 1, size(at%elastic%carried)
        call add_force(form, at%elastic%carried(i)%point, loads%carried(:2, i, case), work)
        if (at%elastic%carried(i)%rotation > 0) call add_moment(form, &
          at%elastic%carried(i)%rotation, loads%carried(3, i, case), work)
      end do
    end associate

  end function mixed_work

  !> Adds the work of a force on a point.
  pure subroutine add_force(form, point, force, work)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: point
    real(wp), intent(in) :: force(2)
    real(wp), intent(inout) :: work(:)

    integer :: at

    if (form%numbers%point(point) == 0) return
    at = form%displacements + form%numbers%point(point)
    work(at:at + 1) = work(at:at + 1) + form%unit*force
  end subroutine add_force

  !> Adds the work of a moment on a rotation.
  pure subroutine add_moment(form, rotation, moment, work)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: rotation
    real(wp), intent(in) :: moment
    real(wp), intent(inout) :: work(:)

    integer :: at

    at = form%displacements + form%numbers%rotation(rotation)
    work(at) = work(at) + form%unit/form%numbers%size_of*moment
  end subroutine add_moment

end module mixed_matrices
