! src/vibration/mixed/ - frequencies of linkages of many links: cost grows with their number.
! In: a linkage in parts, their own modes, a pose. Out: modes with errors, and in `chords_t` what
! each mode does to points and parts, so that all else takes them as it takes those of few links.
! Begin with `new_mixed_form` here, `assemble_rest` and `modes_on_border` in `mixed_positions.f90`.
! Not here: the factor of the matrices (`src/base/sparse`), their eigenvalues (`src/eigen`).

!> The mixed form of the equations at a position: strains, displacements, and a multiplier for every
!! condition between them.
!!
!! Unknowns of a part are its own modes, and y: its elongation and the curves of its held ends, in
!! which the elastic energy is ½|y|². Besides there are the displacements p of points and rotations,
!! and for each row b·p of `border_rows` a multiplier μ of the condition `y/w − b·p = 0`, for each
!! constraint `g·p = 0` another:
!!
!!     | 1  .  Wᵀ .  |           | M_yy M_yp .  . |
!!     | .  .  -Bᵀ Gᵀ|  z  =  λ  | M_py M_pp .  . |  z
!!     | W -B  .  .  |           | .    .    .  . |
!!     | .  G  .  .  |           | .    .    .  . |
!!
!! Every block belongs to one part, spring or line: the matrices are sums of small ones. No basis of
!! p is formed; the multipliers are the forces. The matrix has as many negative eigenvalues as there
!! are multipliers, and each frequency below a shift σ of `K − σM` adds one. Strains are kept: the
!! stiffness matrix B W² Bᵀ would square the ratio of EA to EI, and lose as many digits.
module mixed_form
  use border_unknowns, only: border_unknowns_t
  use elastic_linkages, only: elastic_linkage_t, spring_t
  use elastic_positions, only: elastic_position_t
  use elastic_terminals, only: elastic_terminal_t
  use element_matrices, only: elements_t, new_elements
  use elimination_plan, only: elimination_plan_t, new_elimination_plan
  use kinds, only: wp
  use link_modes, only: link_modes_t
  implicit none (type, external)
  private

  public :: mixed_form_t, new_mixed_form, unknowns_of, place_elements

  !> Numbers of unknowns and elements of a linkage. Those of elements are these at a position, where
  !! blocks have passed places of a link.
  type :: mixed_form_t
    type(border_unknowns_t) :: numbers  !! of displacements, rows, constraints
    integer, allocatable :: own(:)      !! (parts) number of the unknown before its own modes, those
                                        !! across and then along
    integer :: rows = 0                 !! number of the unknown before y
    integer :: displacements = 0        !! before p
    integer :: multipliers = 0          !! before those of rows, then of constraints
    integer :: unknowns = 0
    integer :: conditions = 0           !! number of multipliers
    real(wp) :: unit = 1.0_wp           !! of p: what the softest unit of y displaces [m/√J]
    integer :: spring = 0               !! number of the element before those of springs, likewise:
    integer :: tension = 0
    integer :: line = 0
    integer :: drive = 0
    integer :: point = 0
    integer :: carried = 0
    integer :: cut = 0
    type(elements_t) :: elements
    type(elimination_plan_t) :: plan
  end type mixed_form_t

  !> A list that grows.
  type :: list_t
    integer, allocatable :: item(:)
    integer :: length = 0
  end type list_t

contains

  !> Numbers everything.
  pure function new_mixed_form(at) result(form)
    type(elastic_position_t), intent(in) :: at !! of the linkage
    type(mixed_form_t) :: form

    integer :: k, n

    form%numbers = at%numbers
    allocate (form%own(size(at%model%links)))
    n = 0
    do k = 1, size(at%model%links)
      form%own(k) = n
      n = n + at%model%links(k)%modes + at%model%links(k)%axial_modes
    end do
    form%rows = n
    form%displacements = n + size(form%numbers%rows)
    form%multipliers = form%displacements + form%numbers%unknowns
    form%conditions = size(form%numbers%rows) + form%numbers%constraints
    form%unknowns = form%multipliers + form%conditions
    form%unit = 0.0_wp
    do k = 1, size(at%model%links)
      if (at%model%links(k)%bends) form%unit = max(form%unit, at%model%links(k)%elongation, &
        at%elastic%linkage%bodies(k)%length*maxval(at%model%links(k)%curve_rotation))
    end do
    if (.not. form%unit > 0.0_wp) form%unit = 1.0_wp
    form%spring = size(at%model%links)
    form%tension = form%spring + size(at%elastic%springs)
    form%line = form%tension + size(at%elastic%tensions)
    form%drive = form%line + size(at%elastic%linkage%sliders)
    form%point = form%drive + size(at%elastic%linkage%drives)
    form%carried = form%point + size(at%elastic%is_fixed)
    form%cut = form%carried + size(at%elastic%carried)
    call place_elements(at%elastic, at%model%links, form)
  end function new_mixed_form

  !> Sets the unknowns of elements at a position, and where they have changed the order in which
  !! unknowns are eliminated.
  pure subroutine place_elements(elastic, links, form)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(mixed_form_t), intent(inout) :: form      !! of this linkage

    type(list_t) :: all
    integer, allocatable :: sizes(:), here(:)
    integer :: e, i

    e = form%cut
    do i = 1, size(elastic%ways)
      e = e + size(elastic%ways(i)%cuts)
    end do
    allocate (sizes(e), all%item(8*e))
    do i = 1, e
      here = unknowns_of(elastic, links, form, i)
      sizes(i) = size(here)
      call append(all, here)
    end do
    if (allocated(form%elements%unknown)) then
      if (size(form%elements%unknown) == all%length) then
        if (.not. any(form%elements%unknown /= all%item(:all%length))) return
      end if
    end if
    form%elements = new_elements(form%unknowns, sizes, all%item(:all%length))
    form%plan = new_elimination_plan(form%elements, [(i > form%multipliers, i=1, form%unknowns)])
  end subroutine place_elements

  !> The unknowns of an element, each once: own modes, y, displacements, multipliers.
  pure function unknowns_of(elastic, links, form, element) result(unknown)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(mixed_form_t), intent(in) :: form         !! its numbers
    integer, intent(in) :: element                 !! number
    integer, allocatable :: unknown(:)

    type(list_t) :: list
    integer :: i, k, n

    allocate (list%item(16))
    associate (numbers => form%numbers)
      if (element <= form%spring) then
        k = element
        associate (part => elastic%linkage%bodies(k))
          call append(list, [(form%own(k) + i, i=1, links(k)%modes + links(k)%axial_modes)])
          if (part%bends) then
            n = 1 + links(k)%curves
            call append(list, [(form%rows + numbers%elongation(k) + i, i=0, n - 1)])
            call add_point(form, part%first_pin, list)
            call add_point(form, part%last_pin, list)
            call add_rotation(form, elastic%rotation(1, k), list)
            call add_rotation(form, elastic%rotation(2, k), list)
            call append(list, [(form%multipliers + numbers%elongation(k) + i, i=0, n - 1)])
          else
            call add_point(form, part%first_pin, list)
            call add_rotation(form, elastic%rotation(1, k), list)
            call add_point(form, part%last_pin, list)
            do i = 1, size(part%further)
              call add_point(form, part%further(i)%pin, list)
            end do
            n = 2*(1 + size(part%further))
            call append(list, [(constraint_of(form, numbers%body_constraint(k) + i), i=1, n)])
          end if
        end associate
      else if (element <= form%tension) then
        k = element - form%spring
        call append(list, [form%rows + numbers%spring(k)])
        call add_ends(elastic, form, elastic%springs(k), list)
        call append(list, [form%multipliers + numbers%spring(k)])
      else if (element <= form%line) then
        call add_ends(elastic, form, elastic%tensions(element - form%tension), list)
      else if (element <= form%drive) then
        k = element - form%line
        call add_line(form, elastic%sliding(:, k), list)
        call add_rotation(form, elastic%sliding(1, k)%rotation, list)
        if (numbers%line_constraint(k) > 0) call append(list, &
          [constraint_of(form, numbers%line_constraint(k))])
      else if (element <= form%point) then
        k = element - form%drive
        if (numbers%drive_constraint(k) > 0) then
          call add_line(form, elastic%driven(:, k), list)
          call append(list, [constraint_of(form, numbers%drive_constraint(k))])
        end if
      else if (element <= form%carried) then
        k = element - form%point
        if (elastic%linkage%pin_mass(k) > 0.0_wp) call add_point(form, k, list)
      else if (element <= form%cut) then
        associate (this => elastic%carried(element - form%carried))
          call add_point(form, this%point, list)
          call add_rotation(form, this%rotation, list)
        end associate
      else
        k = element - form%cut
        do i = 1, size(elastic%ways)
          if (k > size(elastic%ways(i)%cuts)) then
            k = k - size(elastic%ways(i)%cuts)
            cycle
          end if
          call add_rotation(form, elastic%ways(i)%cuts(k)%rotation, list)
          exit
        end do
      end if
    end associate
    unknown = list%item(:list%length)
  end function unknowns_of

  !> Number of the multiplier of a constraint.
  pure function constraint_of(form, constraint) result(unknown)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: constraint !! number
    integer :: unknown

    unknown = form%multipliers + size(form%numbers%rows) + constraint
  end function constraint_of

  !> Adds the displacements of a point that can move.
  pure subroutine add_point(form, point, list)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: point
    type(list_t), intent(inout) :: list

    associate (first => form%numbers%point(point))
      if (first > 0) call append_new(list, [form%displacements + first, &
        form%displacements + first + 1])
    end associate
  end subroutine add_point

  !> Adds a rotation that is free.
  pure subroutine add_rotation(form, rotation, list)
    type(mixed_form_t), intent(in) :: form
    integer, intent(in) :: rotation
    type(list_t), intent(inout) :: list

    if (rotation > 0) call append_new(list, [form%displacements + form%numbers%rotation(rotation)])
  end subroutine add_rotation

  !> Adds what moves the ends of a spring.
  pure subroutine add_ends(elastic, form, spring, list)
    type(elastic_linkage_t), intent(in) :: elastic
    type(mixed_form_t), intent(in) :: form
    type(spring_t), intent(in) :: spring
    type(list_t), intent(inout) :: list

    integer :: k

    do k = 1, 2
      associate (end => elastic%load_ends(k, spring%load))
        if (spring%turns) then
          call add_rotation(form, end%rotation, list)
        else
          call add_terminal(form, end, list)
        end if
      end associate
    end do
  end subroutine add_ends

  !> Adds what moves a place: a point, and the rotation of a rigid link.
  pure subroutine add_terminal(form, terminal, list)
    type(mixed_form_t), intent(in) :: form
    type(elastic_terminal_t), intent(in) :: terminal
    type(list_t), intent(inout) :: list

    if (terminal%point > 0) call add_point(form, terminal%point, list)
    if (terminal%is_rigid) call add_rotation(form, terminal%rotation, list)
  end subroutine add_terminal

  !> Adds what moves a block along its line, or across it.
  pure subroutine add_line(form, ends, list)
    type(mixed_form_t), intent(in) :: form
    type(elastic_terminal_t), intent(in) :: ends(2) !! the guide, then the block
    type(list_t), intent(inout) :: list

    call add_terminal(form, ends(2), list)
    call add_terminal(form, ends(1), list)
  end subroutine add_line

  !> Adds numbers that are not in the list.
  pure subroutine append_new(list, item)
    type(list_t), intent(inout) :: list
    integer, intent(in) :: item(:)

    integer :: i

    do i = 1, size(item)
      if (all(list%item(:list%length) /= item(i))) call append(list, item(i:i))
    end do
  end subroutine append_new

  !> Adds numbers to the end of a list.
  pure subroutine append(list, item)
    type(list_t), intent(inout) :: list
    integer, intent(in) :: item(:)

    integer, allocatable :: more(:)

    if (list%length + size(item) > size(list%item)) then
      allocate (more(2*size(list%item) + size(item)))
      more(:list%length) = list%item(:list%length)
      call move_alloc(more, list%item)
    end if
    list%item(list%length + 1:list%length + size(item)) = item
    list%length = list%length + size(item)
  end subroutine append

end module mixed_form
