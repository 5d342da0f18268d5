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

  !> Terms of one kind: those of an array of the grid, or of a load case of it.
  type :: term_kind_t
    real(wp), pointer, contiguous :: values(:, :) => null() !! (samples, terms)
  end type term_kind_t

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
    type(turn_grid_t), intent(inout) :: grid         !! by `new_path_grid`
    type(error_t), allocatable, intent(out) :: error !! why the grid has no terms

    type(term_kind_t), allocatable :: kinds(:)
    integer :: k

    if (allocated(grid%series)) then
      call list_terms(grid, kinds)
      do k = 1, size(crank)
        if (grid%range%is_turn) then
          call take_terms(value_at(grid%series, modulo(crank(k), 360.0_wp)*degree), k, kinds)
        else if (abs(place_in(grid%range, crank(k))) <= 1.0_wp + little) then
          call take_terms(chebyshev_value(grid%series, place_in(grid%range, crank(k))), k, kinds)
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
    call resize(grid, samples)
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

  !> All terms of a grid, kind after kind.
  pure subroutine list_terms(grid, kinds)
    type(turn_grid_t), intent(inout), target :: grid
    type(term_kind_t), allocatable, intent(out) :: kinds(:) !! into the grid

    integer :: c, n, s

    s = grid%samples
    allocate (kinds(14 + 3*grid%cases))
    kinds(1)%values(1:s, 1:size(grid%chord)/s) => grid%chord
    kinds(2)%values(1:s, 1:size(grid%turn)/s) => grid%turn
    kinds(3)%values(1:s, 1:size(grid%pin)/s) => grid%pin
    kinds(4)%values(1:s, 1:size(grid%chord_slope)/s) => grid%chord_slope
    kinds(5)%values(1:s, 1:size(grid%pin_slope)/s) => grid%pin_slope
    kinds(6)%values(1:s, 1:size(grid%place)/s) => grid%place
    kinds(7)%values(1:s, 1:size(grid%direction)/s) => grid%direction
    kinds(8)%values => grid%rate
    kinds(9)%values => grid%rate_slope
    n = 9
    do c = 1, grid%cases
      kinds(n + 1)%values(1:s, 1:size(grid%force(1, :, :, c))) => grid%force(:, :, :, c)
      kinds(n + 2)%values => grid%load(:, :, c)
      n = n + 2
      if (.not. allocated(grid%second_order)) cycle
      n = n + 1
      kinds(n)%values(1:s, 1:grid%border**2) => grid%second_order(:, :, :, c)
    end do
    if (allocated(grid%weighted)) then
      kinds(n + 1)%values(1:s, 1:size(grid%weighted)/s) => grid%weighted
      kinds(n + 2)%values(1:s, 1:size(grid%weighted)/s) => grid%weighted_slope
      n = n + 2
    end if
    if (allocated(grid%pieces)) then
      kinds(n + 1)%values => grid%ratio
      kinds(n + 2)%values(1:s, 1:size(grid%drift)/s) => grid%drift
      kinds(n + 3)%values(1:s, 1:size(grid%drift)/s) => grid%drift_slope
      n = n + 3
    end if
    kinds = kinds(:n)
  end subroutine list_terms

  !> What kinds of terms are small beside, if not their own largest, in the order of `list_terms`.
  !! Where all of a kind may be zero but for rounding (slopes of what is constant, as of an open
  !! chain whose links turn together; loads that act nowhere) that is another kind's size; unit
  !! loads of different cases have different units.
  pure function beside(grid) result(size_of)
    type(turn_grid_t), intent(in) :: grid
    real(wp), allocatable :: size_of(:)

    real(wp) :: chords, force, length, pins
    integer :: c

    length = maxval(grid%model%links%length)
    pins = maxval(abs(grid%pin))
    chords = max(maxval(abs(grid%chord)), pins)
    size_of = [chords, pins/length, pins, chords, pins, 0.0_wp, 1.0_wp, 1.0_wp, 1.0_wp]
    do c = 1, grid%cases
      ! The largest force: along the links, or what loads do, per displacement.
      force = max(maxval(abs(grid%force(:, :, :, c))), maxval(abs(grid%load(:, :, c)))/max(pins, &
        tiny(1.0_wp)))
      size_of = [size_of, force, force*pins]
      if (allocated(grid%second_order)) size_of = [size_of, force*maxval(abs(grid%turn))**2*length]
    end do
    if (allocated(grid%weighted)) size_of = [size_of, 0.0_wp, maxval(abs(grid%weighted))]
    if (allocated(grid%pieces)) size_of = [size_of, 1.0_wp, 1.0_wp, 1.0_wp]
  end function beside

  !> All terms in one table.
  subroutine join_terms(grid, terms)
    type(turn_grid_t), intent(inout) :: grid
    real(wp), allocatable, intent(out) :: terms(:, :) !! (samples, terms)

    type(term_kind_t), allocatable :: kinds(:)
    integer :: at, i

    call list_terms(grid, kinds)
    allocate (terms(grid%samples, sum([(size(kinds(i)%values, 2), i=1, size(kinds))])))
    at = 0
    do i = 1, size(kinds)
      terms(:, at + 1:at + size(kinds(i)%values, 2)) = kinds(i)%values
      at = at + size(kinds(i)%values, 2)
    end do
  end subroutine join_terms

  !> The highest eighth of the coefficients, beside the size of their kind.
  function tail_of(grid, coefficients) result(tail)
    type(turn_grid_t), intent(inout) :: grid
    real(wp), intent(in) :: coefficients(:, :) !! (samples, terms) of `join_terms`
    real(wp) :: tail

    type(term_kind_t), allocatable :: kinds(:)
    real(wp), allocatable :: size_of(:)
    integer :: at, i, m, n

    call list_terms(grid, kinds)
    size_of = beside(grid)
    n = size(coefficients, 1)
    tail = 0.0_wp
    at = 0
    do i = 1, size(kinds)
      m = size(kinds(i)%values, 2)
      if (m > 0) tail = max(tail, maxval(abs(coefficients(n - n/8:, at + 1:at + m)))/ &
        max(size_of(i), maxval(abs(kinds(i)%values)), tiny(1.0_wp)))
      at = at + m
    end do
  end function tail_of

  !> Gives the terms room for another number of samples.
  pure subroutine resize(grid, samples)
    type(turn_grid_t), intent(inout) :: grid
    integer, intent(in) :: samples

    grid%samples = samples
    grid%chord = grid%chord(spread(1, 1, samples), :, :, :)
    grid%turn = grid%turn(spread(1, 1, samples), :, :)
    grid%pin = grid%pin(spread(1, 1, samples), :, :, :)
    grid%chord_slope = grid%chord_slope(spread(1, 1, samples), :, :, :)
    grid%pin_slope = grid%pin_slope(spread(1, 1, samples), :, :, :)
    grid%place = grid%place(spread(1, 1, samples), :, :)
    grid%direction = grid%direction(spread(1, 1, samples), :, :)
    grid%rate = grid%rate(spread(1, 1, samples), :)
    grid%rate_slope = grid%rate_slope(spread(1, 1, samples), :)
    grid%force = grid%force(spread(1, 1, samples), :, :, :)
    grid%load = grid%load(spread(1, 1, samples), :, :)
    if (allocated(grid%second_order)) grid%second_order = grid%second_order(spread(1, 1, &
      samples), :, :, :)
    if (allocated(grid%weighted)) grid%weighted = grid%weighted(spread(1, 1, samples), :, :)
    if (allocated(grid%weighted_slope)) grid%weighted_slope = grid%weighted_slope(spread(1, 1, &
      samples), :, :)
    if (.not. allocated(grid%pieces)) return
    grid%ratio = grid%ratio(spread(1, 1, samples), :)
    grid%drift = grid%drift(spread(1, 1, samples), :, :)
    grid%drift_slope = grid%drift_slope(spread(1, 1, samples), :, :)
  end subroutine resize

  !> Takes terms at a crank angle.
  pure subroutine take_terms(terms, k, kinds)
    real(wp), intent(in) :: terms(:)          !! of a row of `join_terms`
    integer, intent(in) :: k                  !! number of the crank angle
    type(term_kind_t), intent(inout) :: kinds(:) !! of the grid

    integer :: at, i, n

    at = 0
    do i = 1, size(kinds)
      n = size(kinds(i)%values, 2)
      kinds(i)%values(k, :) = terms(at + 1:at + n)
      at = at + n
    end do
  end subroutine take_terms

end module path_grids
