!> Grids of a turn with what periodic solutions on them need, made when a speed needs them: speeds,
!! reports of the response and of stability share them.
module response_levels
  use body_lumps, only: pieces_of
  use crank_laws, only: covered_range_t, positions_of
  use deformation_model, only: deformation_model_t, new_deformation_model
  use elastic_equations, only: elastic_terms_t
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use kinds, only: wp
  use link_degrees, only: link_degrees_t, uniform_degrees
  use link_store, only: link_store_t
  use order_transfer, only: transferred
  use refinements, only: order_on, refinement_t, samples_on
  use response_types, only: damping_by_dampers, damping_ratio, damping_time, &
    link_damping_t
  use slow_bases, only: fast_squares, new_slow_basis, slow_basis_t
  use slow_motions, only: slow_motion_t
  use position_assembly, only: set_border
  use strain_dampings, only: damping_t, shares_of
  use structures, only: structure_t
  use turn_grids, only: moves, new_turn_grid, turn_grid_t
  implicit none (type, external)
  private

  public :: level_t, level_slot_t, new_order_model, need_levels, need_level, need_basis, &
    set_equation, damping_of

  !> Degrees along a link are lower than those across it by this, and at least as high as this. The
  !! bending of the links loads them along their axes: both converge together.
  integer, parameter :: along_below = 4, least_along = 4

  !> Samples from which the slow coordinates are found.
  integer, parameter :: basis_samples = 96

  !> Positions of a turn at which the border unknowns of a linkage in parts are counted.
  integer, parameter :: border_positions = 24

  !> A grid with what its solutions need.
  type :: level_t
    integer :: order = 0
    type(turn_grid_t) :: grid, coarse
    type(slow_basis_t), allocatable :: basis(:) !! by the number of slow coordinates; empty where
                                                !! not needed
  end type level_t

  type :: level_slot_t
    type(level_t), allocatable :: level
  end type level_slot_t

contains

  !> Finds or makes both levels of all refinements that are pending, and drops those that none of
  !! these needs.
  !!
  !! Errors: as `need_level`.
  subroutine need_levels(structure, refinement, store, levels, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(refinement_t), intent(inout) :: refinement(:)
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(level_slot_t), allocatable, intent(inout) :: levels(:) !! made so far
    type(error_t), allocatable, intent(out) :: error !! why there are none

    integer :: i, k

    call drop_levels(refinement, levels)
    do k = 1, size(refinement)
      if (.not. refinement(k)%pending) cycle
      do i = 1, 2
        call need_level(structure, order_on(refinement(k), i), samples_on(refinement(k), i), &
          refinement(k)%backwards, store, levels, refinement(k)%level(i), error)
        if (allocated(error)) return
      end do
    end do
  end subroutine need_levels

  pure subroutine drop_levels(refinement, levels)
    type(refinement_t), intent(in) :: refinement(:)
    type(level_slot_t), allocatable, intent(inout) :: levels(:)

    type(level_slot_t), allocatable :: kept(:)
    logical :: needed(size(levels))
    integer :: i, k

    do k = 1, size(levels)
      associate (level => levels(k)%level)
        needed(k) = any([(any(refinement%pending .and. order_on(refinement, i) == level%order &
          .and. samples_on(refinement, i) == level%grid%samples), i=1, 2)])
      end associate
    end do
    allocate (kept(count(needed)))
    i = 0
    do k = 1, size(levels)
      if (.not. needed(k)) cycle
      i = i + 1
      call move_alloc(levels(k)%level, kept(i)%level)
    end do
    call move_alloc(kept, levels)
  end subroutine drop_levels

  !> Finds or makes a level.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine need_level(structure, order, samples, backwards, store, levels, number, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    integer, intent(in) :: order                     !! highest polynomial degree
    integer, intent(in) :: samples                   !! over the turn
    logical, intent(in) :: backwards                 !! the crank turns clockwise
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(level_slot_t), allocatable, intent(inout) :: levels(:) !! made so far
    integer, intent(out) :: number                   !! of the level
    type(error_t), allocatable, intent(out) :: error !! why there is none

    number = number_of_level(levels, order, samples, backwards)
    if (number > 0) return
    call add_slot(levels)
    number = size(levels)
    call new_level(structure, order, samples, backwards, store, levels(number)%level, error)
  end subroutine need_level

  !> Number of the level of an order and a number of samples; 0: none.
  pure function number_of_level(levels, order, samples, backwards) result(number)
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: order, samples
    logical, intent(in) :: backwards
    integer :: number

    do number = size(levels), 1, -1
      if (levels(number)%level%order == order .and. &
        levels(number)%level%grid%samples == samples .and. &
        (levels(number)%level%grid%backwards .eqv. backwards)) exit
    end do
  end function number_of_level

  !> Room for one more level; those there are not copied.
  pure subroutine add_slot(levels)
    type(level_slot_t), allocatable, intent(inout) :: levels(:)

    type(level_slot_t), allocatable :: more(:)
    integer :: i

    allocate (more(size(levels) + 1))
    do i = 1, size(levels)
      call move_alloc(levels(i)%level, more(i)%level)
    end do
    allocate (more(size(more))%level)
    call move_alloc(more, levels)
  end subroutine add_slot

  !> Makes the grids of a level.
  subroutine new_level(structure, order, samples, backwards, store, level, error)
    class(structure_t), intent(in) :: structure
    integer, intent(in) :: order, samples
    logical, intent(in) :: backwards !! the crank turns clockwise
    type(link_store_t), intent(inout) :: store
    type(level_t), intent(out) :: level
    type(error_t), allocatable, intent(out) :: error

    type(deformation_model_t) :: model

    call new_order_model(structure, order, store, model, error)
    if (allocated(error)) return
    call new_turn_grid(structure, model, samples, level%grid, error, backwards)
    if (allocated(error)) return
    if (samples > basis_samples) then
      call new_turn_grid(structure, model, basis_samples, level%coarse, error, backwards)
    else
      level%coarse = level%grid
    end if
    level%order = order
    allocate (level%basis(model%layout%unknowns))
  end subroutine new_level

  !> The links' own deformations of an order.
  !!
  !! Errors: own modes of a link could not be found.
  subroutine new_order_model(structure, order, store, model, error, range)
    class(structure_t), intent(in) :: structure        !! linkage and beams
    integer, intent(in) :: order                       !! highest polynomial degree
    type(link_store_t), intent(inout) :: store         !! links decomposed earlier
    type(deformation_model_t), intent(out) :: model
    type(error_t), allocatable, intent(out) :: error   !! why there is none
    type(covered_range_t), intent(in), optional :: range !! positions that it is for; absent: a turn

    type(covered_range_t) :: covered
    type(link_degrees_t), allocatable :: degrees(:)
    integer :: b, n, pieces, across

    associate (parts => structure%elastic)
      n = size(parts%body)
      allocate (degrees(n))
      do b = 1, n
        pieces = size(pieces_of(parts%linkage%bodies(b))) - 1
        across = max(4, order - min(pieces - 1, 3))
        degrees(b) = uniform_degrees(pieces, across, max(least_along, across - along_below))
      end do
      call new_deformation_model(parts%linkage, parts%beams, spread(0, 1, n), spread(order, 1, n), &
        spread(.false., 1, n), model, error, store, degrees, parts%held)
    end associate
    if (allocated(error)) return
    if (present(range)) covered = range
    call set_border(structure, positions_of(covered, border_positions), model)
  end subroutine new_order_model

  !> Makes the slow coordinates of a level, unless they are there.
  !!
  !! Errors: as `new_slow_basis`.
  subroutine need_basis(number, dampings, level, error, followers, known)
    integer, intent(in) :: number                    !! of slow coordinates
    type(link_damping_t), intent(in) :: dampings(:)  !! as for `damping_of`, the same for all of a
                                                     !! level
    type(level_t), intent(inout) :: level
    type(error_t), allocatable, intent(out) :: error !! why there are none
    logical, intent(in), optional :: followers       !! as for `new_slow_basis`, the same for all of
                                                     !! a level
    type(level_t), intent(in), optional :: known     !! one of lower orders with as many: without
                                                     !! followers they may be the same

    type(fourier_plan_t) :: plan, coarse_plan

    if (level%basis(number)%number > 0) return
    call open_fourier(level%grid%samples, plan)
    if (present(known)) then
      call take_known
      call close_fourier(plan)
      return
    end if
    call open_fourier(level%coarse%samples, coarse_plan)
    call new_slow_basis(level%coarse, coarse_plan, plan, number, damping_of(dampings, &
      level%grid), level%basis(number), error, followers)
    call close_fourier(plan)
    call close_fourier(coarse_plan)

  contains

    subroutine take_known
      type(fourier_plan_t) :: known_plan
      real(wp), allocatable :: shape(:, :)
      integer :: i

      call open_fourier(known%grid%samples, known_plan)
      associate (from => known%basis(number), to => level%basis(number))
        to%number = number
        to%square = fast_squares(level%grid, number)
        to%sums = from%sums
        allocate (to%shape(level%grid%samples, level%grid%unknowns, number))
        do i = 1, number
          call transferred(known%grid, known_plan, level%grid, plan, from%shape(:, :, i), shape)
          to%shape(:, :, i) = shape
        end do
      end associate
      call close_fourier(known_plan)
    end subroutine take_known

  end subroutine need_basis

  !> The equation on a level. It points to the level, the plan and the motion.
  subroutine set_equation(level, plan, motion, speed, dampings, terms, equation)
    type(level_t), intent(in), target :: level
    type(fourier_plan_t), intent(in), target :: plan  !! for its samples
    type(slow_motion_t), intent(in), target :: motion !! at this speed
    real(wp), intent(in) :: speed                     !! ω2 [rad/s]
    type(link_damping_t), intent(in) :: dampings(:)   !! as for `damping_of`
    type(elastic_terms_t), intent(in) :: terms
    type(equation_at_speed_t), intent(out) :: equation

    equation%grid => level%grid
    equation%plan => plan
    equation%basis => level%basis(motion%number)
    equation%motion => motion
    equation%speed = speed
    equation%terms = terms
    equation%damping = damping_of(dampings, level%grid)
  end subroutine set_equation

  !> Damping of every unknown: the Kelvin–Voigt time, or `2 ζ/ω` of the own modes of the link. The
  !! elongation and the rotation of the clamped end take that of its lowest own mode.
  pure function damping_of(dampings, grid) result(damping)
    type(link_damping_t), intent(in) :: dampings(:) !! (bodies), then that of dampers, if any act
    type(turn_grid_t), intent(in) :: grid
    type(damping_t) :: damping

    integer :: b, i, n

    allocate (damping%c(grid%unknowns), source=0.0_wp)
    do b = 1, size(grid%integrals)
      if (.not. grid%model%links(b)%bends) cycle
      associate (of_link => dampings(b), link => grid%model%links(b), c => damping%c)
        select case (of_link%kind)
        case (damping_time)
          where (grid%owner == b) c = of_link%value
        case (damping_ratio)
          where (grid%owner == b) c = 2.0_wp*of_link%value*sqrt(maxval(link%square))
          c(grid%first(b):grid%first(b) + link%modes - 1) = 2.0_wp*of_link%value*sqrt(link%square)
          c(grid%first_along(b):grid%first_along(b) + link%axial_modes - 1) = &
            2.0_wp*of_link%value*sqrt(link%axial_square)
        end select
      end associate
    end do
    n = 0
    if (allocated(grid%weighted)) then
      n = size(grid%weighted, 2) - size(grid%dampers)
      damping%c = [damping%c, [(damping_of_deformation(grid, dampings, i), i=1, n)], &
        grid%dampers%damping]
      if (.not. any(dampings%kind == damping_by_dampers)) damping%c(grid%unknowns + n + 1:) = 0.0_wp
    end if
    call find_powers(dampings, grid, damping)
    if (.not. allocated(grid%weighted)) return
    do b = 1, grid%border
      damping%c(b) = sum(matmul(shares_of(grid, damping, grid%unknowns + 1, size(damping%c))* &
        grid%weighted(:, :, b)**2, damping%c(grid%unknowns + 1:)))/grid%samples
    end do
  end function damping_of

  !> How `2 ζ/ω` of own modes grows with the length of a piece: with its square across, with the
  !! length along it.
  pure subroutine find_powers(dampings, grid, damping)
    type(link_damping_t), intent(in) :: dampings(:)
    type(turn_grid_t), intent(in) :: grid
    type(damping_t), intent(inout) :: damping

    integer :: b

    do b = 1, size(grid%integrals)
      if (.not. moves(grid, b) .or. dampings(b)%kind /= damping_ratio) cycle
      if (.not. allocated(damping%power)) allocate (damping%power(size(damping%c)), source=0)
      associate (power => damping%power, along => grid%first_along(b), n => grid%unknowns)
        where (grid%owner == b) power(:n) = 2
        power(along:along + grid%model%links(b)%axial_modes - 1) = 1
        if (size(power) > n) where (grid%deformed == b) power(n + 1:) = 2
      end associate
    end do
  end subroutine find_powers

  !> Damping of a deformation of a part or a spring [s].
  pure function damping_of_deformation(grid, dampings, number) result(c)
    type(turn_grid_t), intent(in) :: grid
    type(link_damping_t), intent(in) :: dampings(:)
    integer, intent(in) :: number
    real(wp) :: c

    c = 0.0_wp
    associate (b => grid%deformed(number))
      if (b == 0) return
      if (dampings(b)%kind == damping_time) c = dampings(b)%value
      if (dampings(b)%kind == damping_ratio) c = 2.0_wp*dampings(b)%value* &
        sqrt(maxval(grid%model%links(b)%square))
    end associate
  end function damping_of_deformation

end module response_levels
