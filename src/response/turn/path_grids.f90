!> The terms of the equations of motion at crank angles anywhere, which need not turn fully: of a
!! crank and dyads from closed forms, of a linkage in parts from their series over the positions of
!! the motion, since its border unknowns are smooth functions of them only as a whole.
module path_grids
  use chebyshev_series, only: chebyshev_coefficients, chebyshev_value
  use chord_slopes, only: find_chord_slopes
  use constants, only: degree
  use crank_laws, only: covered_range_t, place_in
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: close_fourier, coefficients_of, fourier_plan_t, &
    open_fourier, value_at
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients
  use pin_displacements, only: chords_t, find_chords
  use position_assembly, only: assembled_t
  use poses, only: find_pose, pose_t
  use structures, only: structure_t
  use text, only: to_string
  use turn_grids, only: find_slope, new_turn_grid, start_grid, take_chord, take_pose, turn_grid_t
  implicit none (type, external)
  private

  public :: new_path_grid, place_grid

  !> Samples of a turn, and how many times as many as of a part of the way, until the highest eighth
  !! of the coefficients of all terms are below a share of the largest term of their kind; above the
  !! second share nothing is found.
  integer, parameter :: turn_samples(*) = [64, 128, 256, 512, 1024]
  integer, parameter :: way_by_turn = 4
  real(wp), parameter :: enough = 1.0e-13_wp, most = 1.0e-9_wp

  !> Rounding of a place in the range.
  real(wp), parameter :: little = 1.0e-9_wp

  !> Room for kinds of terms.
  integer, parameter :: most_kinds = 32

  !> Terms of one kind: those of an array of the grid, or of a load case of it.
  type :: term_kind_t
    real(wp), pointer, contiguous :: values(:, :) => null() !! (samples, terms)
  end type term_kind_t

  !> Every kind of terms of a grid.
  type :: term_list_t
    type(term_kind_t) :: kinds(most_kinds) !! the first `number`
    integer :: number = 0
  end type term_list_t

  !> Lists terms, and gives them room for other numbers of samples.
  interface add
    procedure :: add_functions, add_vectors, add_matrices
  end interface add

contains

  !> Room for the terms at crank angles anywhere, which `place_grid` gives.
  !!
  !! Errors, of a linkage in parts: those of `new_turn_grid`; its terms have too long series.
  subroutine new_path_grid(structure, model, samples, grid, error, range)
    class(structure_t), intent(in) :: structure    !! linkage and beams
    type(deformation_model_t), intent(in) :: model !! own deformations of its bodies
    integer, intent(in) :: samples                 !! crank angles
    type(turn_grid_t), intent(out) :: grid         !! for `place_grid`
    type(error_t), allocatable, intent(out) :: error
    type(covered_range_t), intent(in), optional :: range !! positions between them; absent: a turn

    type(assembled_t), allocatable :: here

    if (.not. structure%elastic%in_closed_form) then
      call find_series(structure, model, samples, grid, error, range)
      return
    end if
    allocate (here)
    call start_grid(structure, model, samples, here, grid, error)
    call move_alloc(here, grid%here)
    deallocate (grid%second_order)
    allocate (grid%chord_slope, mold=grid%chord)
    allocate (grid%pin_slope, mold=grid%pin)
    grid%chord_slope = 0.0_wp
  end subroutine new_path_grid

  !> The terms at given crank angles, with derivatives of the chords and pins: the angles need not
  !! be even.
  !!
  !! Errors, of a crank and dyads: the crank cannot reach one of them, or meets a dead point there.
  subroutine place_grid(structure, crank, grid, error)
    class(structure_t), intent(in) :: structure      !! of the grid
    real(wp), intent(in) :: crank(:)                 !! (samples) crank angles [deg]
    type(turn_grid_t), intent(inout), target :: grid !! by `new_path_grid`
    type(error_t), allocatable, intent(out) :: error !! why the grid has no terms

    type(term_list_t) :: list
    integer :: k

    if (allocated(grid%series)) then
      call list_terms(grid, list)
      do k = 1, size(crank)
        if (grid%range%is_turn) then
          call take_terms(value_at(grid%series, modulo(crank(k), 360.0_wp)*degree), k, list)
        else if (abs(place_in(grid%range, crank(k))) <= 1.0_wp + little) then
          call take_terms(chebyshev_value(grid%series, place_in(grid%range, crank(k))), k, list)
        else
          call set_error(error, error_of_numerics, "the law of the first drive swings faster "// &
            "than the instants of TIME tell: expected more of them")
          return
        end if
      end do
    else
      call place_dyads(structure, crank, grid, error)
    end if
  end subroutine place_grid

  !> Those of a crank and dyads, from the motion of the links at each angle.
  subroutine place_dyads(structure, crank, grid, error)
    class(structure_t), intent(in) :: structure
    real(wp), intent(in) :: crank(:)
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    type(assembled_t), allocatable :: here
    type(pose_t) :: pose
    type(chords_t) :: slopes
    integer :: b, k

    call move_alloc(grid%here, here)
    do k = 1, size(crank)
      call find_pose(structure%linkage, crank(k), pose, error)
      if (.not. allocated(error)) call take_pose(structure, pose, k, here, grid, error)
      if (allocated(error)) exit
      slopes = find_chord_slopes(structure%linkage, grid%model%links, pose, &
        find_kinematic_coefficients(structure%linkage, pose), find_chords(structure%linkage, &
        grid%model%links, pose))
      grid%pin_slope(k, :, :, :) = slopes%pin
      do b = 1, size(grid%integrals)
        call take_chord(grid%model%links(b), slopes, b, grid%chord_slope(k, :, :, b))
      end do
    end do
    call move_alloc(here, grid%here)
  end subroutine place_dyads

  !> Series of all terms of a linkage in parts, from as many samples as they need: harmonics of a
  !! turn, or Chebyshev polynomials of a part of the way.
  subroutine find_series(structure, model, samples, grid, error, range)
    class(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model
    integer, intent(in) :: samples
    type(turn_grid_t), intent(out) :: grid
    type(error_t), allocatable, intent(out) :: error
    type(covered_range_t), intent(in), optional :: range

    type(fourier_plan_t) :: plan
    type(term_list_t) :: list
    real(wp), allocatable :: terms(:, :), coefficients(:, :)
    real(wp) :: tail, last
    integer :: i, n

    last = huge(last)
    do i = 1, size(turn_samples)
      n = turn_samples(i)
      if (present(range)) n = merge(n, n/way_by_turn, range%is_turn)
      call new_turn_grid(structure, model, n, grid, error, range=range)
      if (allocated(error)) return
      if (allocated(grid%weighted)) call add_slopes(grid)
      call join_terms(grid, terms)
      if (grid%range%is_turn) then
        allocate (coefficients, mold=terms)
        call open_fourier(n, plan)
        call coefficients_of(plan, terms, coefficients)
        call close_fourier(plan)
      else
        coefficients = chebyshev_coefficients(terms)
      end if
      tail = tail_of(grid, coefficients)
      ! More samples do not help against rounding.
      if (tail <= enough .or. i == size(turn_samples) .or. (tail <= most .and. tail > &
        0.1_wp*last)) exit
      last = tail
      deallocate (coefficients)
    end do
    if (tail > most) then
      call set_error(error, error_of_numerics, "the equations change too fast with the "// &
        "position of the first drive for "//to_string(n)//" terms: a dead point is near, or "// &
        "the way is very short")
      return
    end if
    grid%tail = tail
    call move_alloc(coefficients, grid%series)
    grid%samples = samples
    call list_terms(grid, list)
  end subroutine find_series

  !> d/dθ2 of the deformations.
  subroutine add_slopes(grid)
    type(turn_grid_t), intent(inout) :: grid

    integer :: i

    allocate (grid%weighted_slope, mold=grid%weighted)
    do i = 1, grid%border
      call find_slope(grid, grid%weighted(:, :, i), grid%weighted_slope(:, :, i))
    end do
  end subroutine add_slopes

  !> All terms of a grid, kind after kind, with room for its samples.
  pure subroutine list_terms(grid, list)
    type(turn_grid_t), intent(inout), target :: grid
    type(term_list_t), intent(out) :: list !! into the grid

    associate (n => grid%samples)
      call add(grid%chord, n, list)
      call add(grid%turn, n, list)
      call add(grid%pin, n, list)
      call add(grid%chord_slope, n, list)
      call add(grid%pin_slope, n, list)
      call add(grid%place, n, list)
      call add(grid%direction, n, list)
      call add(grid%rate, n, list)
      call add(grid%rate_slope, n, list)
      call add(grid%force, n, list, grid%cases)
      call add(grid%load, n, list, grid%cases)
      call add(grid%second_order, n, list, grid%cases)
      call add(grid%weighted, n, list)
      call add(grid%weighted_slope, n, list)
      call add(grid%ratio, n, list)
      call add(grid%drift, n, list)
      call add(grid%drift_slope, n, list)
    end associate
  end subroutine list_terms

  !> Adds the terms of an array, if there are any.
  pure subroutine add_functions(values, samples, list)
    real(wp), allocatable, intent(inout), target :: values(:, :) !! (samples, functions)
    integer, intent(in) :: samples         !! that it gets room for
    type(term_list_t), intent(inout) :: list

    real(wp), pointer, contiguous :: functions(:, :)

    if (.not. allocated(values)) return
    if (size(values, 1) /= samples) values = values(spread(1, 1, samples), :)
    functions => values
    call add_kinds(functions, list)
  end subroutine add_functions

  !> The same.
  pure subroutine add_vectors(values, samples, list, cases)
    real(wp), allocatable, intent(inout), target :: values(:, :, :)
    integer, intent(in) :: samples
    type(term_list_t), intent(inout) :: list
    integer, intent(in), optional :: cases !! over which the last subscript runs, each a kind of
                                           !! its own; absent: one

    real(wp), pointer, contiguous :: functions(:, :)

    if (.not. allocated(values)) return
    if (size(values, 1) /= samples) values = values(spread(1, 1, samples), :, :)
    functions(1:samples, 1:size(values, 2)*size(values, 3)) => values
    call add_kinds(functions, list, cases)
  end subroutine add_vectors

  !> The same.
  pure subroutine add_matrices(values, samples, list, cases)
    real(wp), allocatable, intent(inout), target :: values(:, :, :, :)
    integer, intent(in) :: samples
    type(term_list_t), intent(inout) :: list
    integer, intent(in), optional :: cases

    real(wp), pointer, contiguous :: functions(:, :)

    if (.not. allocated(values)) return
    if (size(values, 1) /= samples) values = values(spread(1, 1, samples), :, :, :)
    functions(1:samples, 1:size(values, 2)*size(values, 3)*size(values, 4)) => values
    call add_kinds(functions, list, cases)
  end subroutine add_matrices

  !> Adds each of the kinds of which some functions are.
  pure subroutine add_kinds(functions, list, number)
    real(wp), intent(inout), pointer, contiguous :: functions(:, :) !! (samples, functions)
    type(term_list_t), intent(inout) :: list
    integer, intent(in), optional :: number !! absent: 1

    integer :: i, kinds, n

    kinds = 1
    if (present(number)) kinds = number
    n = size(functions, 2)/kinds
    do i = 1, kinds
      list%number = list%number + 1
      list%kinds(list%number)%values => functions(:, (i - 1)*n + 1:i*n)
    end do
  end subroutine add_kinds

  !> What kinds of terms are small beside, if not their own largest, in the order of `list_terms`.
  !! Where all of a kind may be zero but for rounding (slopes of what is constant, as of an open
  !! chain whose links turn together; loads that act nowhere) that is another kind's size; unit
  !! loads of different cases have different units.
  pure function beside(grid) result(size_of)
    type(turn_grid_t), intent(in) :: grid
    real(wp), allocatable :: size_of(:)

    real(wp) :: chords, force(grid%cases), length, pins
    integer :: c

    length = maxval(grid%model%links%length)
    pins = maxval(abs(grid%pin))
    chords = max(maxval(abs(grid%chord)), pins)
    do c = 1, grid%cases
      ! The largest force: along the links, or what loads do, per displacement.
      force(c) = max(maxval(abs(grid%force(:, :, :, c))), maxval(abs(grid%load(:, :, c)))/ &
        max(pins, tiny(1.0_wp)))
    end do
    size_of = [chords, pins/length, pins, chords, pins, 0.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, force, &
      force*pins]
    if (allocated(grid%second_order)) size_of = [size_of, &
      force*maxval(abs(grid%turn))**2*length]
    if (allocated(grid%weighted)) size_of = [size_of, 0.0_wp, maxval(abs(grid%weighted))]
    if (allocated(grid%pieces)) size_of = [size_of, 1.0_wp, 1.0_wp, 1.0_wp]
  end function beside

  !> All terms in one table.
  subroutine join_terms(grid, terms)
    type(turn_grid_t), intent(inout), target :: grid
    real(wp), allocatable, intent(out) :: terms(:, :) !! (samples, terms)

    type(term_list_t) :: list
    integer :: at, i, n

    call list_terms(grid, list)
    allocate (terms(grid%samples, sum([(size(list%kinds(i)%values, 2), i=1, list%number)])))
    at = 0
    do i = 1, list%number
      n = size(list%kinds(i)%values, 2)
      terms(:, at + 1:at + n) = list%kinds(i)%values
      at = at + n
    end do
  end subroutine join_terms

  !> The highest eighth of the coefficients, beside the size of their kind.
  function tail_of(grid, coefficients) result(tail)
    type(turn_grid_t), intent(inout), target :: grid
    real(wp), intent(in) :: coefficients(:, :) !! (samples, terms) of `join_terms`
    real(wp) :: tail

    type(term_list_t) :: list
    real(wp), allocatable :: size_of(:)
    integer :: at, i, m, n

    call list_terms(grid, list)
    size_of = beside(grid)
    n = size(coefficients, 1)
    tail = 0.0_wp
    at = 0
    do i = 1, list%number
      m = size(list%kinds(i)%values, 2)
      if (m > 0) tail = max(tail, maxval(abs(coefficients(n - n/8:, at + 1:at + m)))/ &
        max(size_of(i), maxval(abs(list%kinds(i)%values)), tiny(1.0_wp)))
      at = at + m
    end do
  end function tail_of

  !> Takes terms at a crank angle.
  pure subroutine take_terms(terms, k, list)
    real(wp), intent(in) :: terms(:)          !! of a row of `join_terms`
    integer, intent(in) :: k                  !! number of the crank angle
    type(term_list_t), intent(inout) :: list  !! of the grid

    integer :: at, i, n

    at = 0
    do i = 1, list%number
      n = size(list%kinds(i)%values, 2)
      list%kinds(i)%values(k, :) = terms(at + 1:at + n)
      at = at + n
    end do
  end subroutine take_terms

end module path_grids
