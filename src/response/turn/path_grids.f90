!> The terms of the equations of motion at crank angles anywhere, which need not turn fully: of a
!! crank and dyads from closed forms, of a linkage in parts from their series over the positions of
!! the motion, since its border unknowns are smooth functions of them only as a whole.
module path_grids
  use chebyshev_series, only: chebyshev_coefficients, chebyshev_value
  use chord_slopes, only: find_chord_slopes
  use constants, only: degree
  use crank_laws, only: crank_range_t, share_of
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: close_fourier, coefficients_of, fourier_plan_t, &
    open_fourier, value_at
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients
  use linkages, only: linkage_t
  use pin_displacements, only: chords_t, find_chords
  use poses, only: find_pose, pose_t
  use structures, only: structure_t
  use turn_grids, only: find_slope, new_turn_grid, number_border, start_grid, take_chord, &
    take_pose, turn_grid_t
  implicit none (type, external)
  private

  public :: new_path_grid, place_grid

  !> Samples of a turn, and how many times as many as of a part of the way, until the highest eighth
  !! of the coefficients of all terms are below a share of the largest term of their kind; above the
  !! second share nothing is found.
  integer, parameter :: turn_samples(*) = [64, 128, 256, 512, 1024]
  integer, parameter :: way_by_turn = 4
  real(wp), parameter :: enough = 1.0e-13_wp, most = 1.0e-9_wp

  !> Terms of one kind.
  type :: term_kind_t
    integer :: number = 0       !! of them at a crank angle
    real(wp) :: scale = 1.0_wp  !! of which a share is small
  end type term_kind_t

contains

  !> Room for the terms at crank angles anywhere, which `place_grid` gives.
  !!
  !! Errors, of a linkage in parts: those of `new_turn_grid`; its terms have too many harmonics.
  subroutine new_path_grid(structure, model, samples, grid, error, range)
    class(structure_t), intent(in) :: structure    !! linkage and beams
    type(deformation_model_t), intent(in) :: model !! own deformations of its bodies
    integer, intent(in) :: samples                 !! crank angles
    type(turn_grid_t), intent(out) :: grid         !! for `place_grid`
    type(error_t), allocatable, intent(out) :: error
    type(crank_range_t), intent(in), optional :: range !! positions between them; absent: a turn

    if (allocated(structure%elastic)) then
      call find_series(structure, model, samples, grid, error, range)
      return
    end if
    call start_grid(structure%linkage, model, samples, grid)
    call number_border(structure%linkage, grid)
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

    integer :: k

    if (allocated(grid%series)) then
      do k = 1, size(crank)
        if (grid%range%is_turn) then
          call take_terms(value_at(grid%series, modulo(crank(k), 360.0_wp)*degree), k, grid)
        else
          call take_terms(chebyshev_value(grid%series, share_of(grid%range, crank(k))), k, grid)
        end if
      end do
    else
      call place_dyads(structure%linkage, crank, grid, error)
    end if
  end subroutine place_grid

  !> Those of a crank and dyads, from the motion of the links at each angle.
  subroutine place_dyads(linkage, crank, grid, error)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank(:)
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    type(pose_t) :: pose
    type(chords_t) :: slopes
    integer :: b, k

    do k = 1, size(crank)
      call find_pose(linkage, crank(k), pose, error)
      if (allocated(error)) return
      call take_pose(linkage, pose, k, grid)
      slopes = find_chord_slopes(linkage, grid%model%links, pose, &
        find_kinematic_coefficients(linkage, pose), find_chords(linkage, grid%model%links, pose))
      grid%pin_slope(k, :, :, :) = slopes%pin
      do b = 1, size(grid%integrals)
        call take_chord(grid%model%links(b), slopes, b, grid%chord_slope(k, :, :, b))
      end do
    end do
  end subroutine place_dyads

  !> Series of all terms of a linkage in parts, from as many samples as they need: harmonics of a
  !! turn, or Chebyshev polynomials of a part of the way.
  subroutine find_series(structure, model, samples, grid, error, range)
    class(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model
    integer, intent(in) :: samples
    type(turn_grid_t), intent(out) :: grid
    type(error_t), allocatable, intent(out) :: error
    type(crank_range_t), intent(in), optional :: range

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
      terms = terms_of(grid)
      if (grid%range%is_turn) then
        allocate (coefficients, mold=terms)
        call open_fourier(n, plan)
        call coefficients_of(plan, terms, coefficients)
        call close_fourier(plan)
      else
        coefficients = chebyshev_coefficients(terms)
      end if
      tail = tail_of(kinds_of(grid), coefficients)
      ! More samples do not help against rounding.
      if (tail <= enough .or. i == size(turn_samples) .or. (tail <= most .and. tail > &
        0.1_wp*last)) exit
      last = tail
      deallocate (coefficients)
    end do
    if (tail > most) then
      call set_error(error, error_of_numerics, "the motion of the links changes too fast with "// &
        "that of the first drive: a dead point is near")
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

  !> All terms, kind after kind.
  pure function terms_of(grid) result(terms)
    type(turn_grid_t), intent(in) :: grid
    real(wp), allocatable :: terms(:, :) !! (samples, terms)

    real(wp), allocatable :: flat(:)

    flat = [real(wp) :: &
      reshape(grid%chord, [size(grid%chord)]), &
      reshape(grid%turn, [size(grid%turn)]), &
      reshape(grid%pin, [size(grid%pin)]), &
      reshape(grid%chord_slope, [size(grid%chord_slope)]), &
      reshape(grid%pin_slope, [size(grid%pin_slope)]), &
      reshape(grid%place, [size(grid%place)]), &
      reshape(grid%direction, [size(grid%direction)]), &
      reshape(grid%rate, [size(grid%rate)]), &
      reshape(grid%rate_slope, [size(grid%rate_slope)]), &
      reshape(grid%force, [size(grid%force)]), &
      reshape(grid%load, [size(grid%load)])]
    if (allocated(grid%second_order)) flat = [flat, reshape(grid%second_order, &
      [size(grid%second_order)])]
    if (allocated(grid%weighted)) flat = [flat, reshape(grid%weighted, [size(grid%weighted)])]
    if (allocated(grid%weighted_slope)) flat = [flat, reshape(grid%weighted_slope, &
      [size(grid%weighted_slope)])]
    if (allocated(grid%pieces)) flat = [flat, reshape(grid%ratio, [size(grid%ratio)]), &
      reshape(grid%stretch, [size(grid%stretch)]), reshape(grid%stretch_slope, &
      [size(grid%stretch_slope)])]
    terms = reshape(flat, [grid%samples, size(flat)/grid%samples])
  end function terms_of

  !> Kinds of terms, in the order of `terms_of`: how many there are, and what they are small
  !! beside. Where all of a kind may be zero but for rounding (slopes of what is constant, as of an
  !! open chain whose links turn together; loads that act nowhere) that is another kind's size;
  !! unit loads of different cases have different units.
  pure function kinds_of(grid) result(kinds)
    type(turn_grid_t), intent(in) :: grid
    type(term_kind_t), allocatable :: kinds(:)

    real(wp) :: length, pins, chords, forces
    integer :: c

    length = maxval(grid%model%links%length)
    pins = maxval(abs(grid%pin))
    chords = max(maxval(abs(grid%chord)), pins)
    kinds = [kind_of(size(grid%chord), chords), kind_of(size(grid%turn), &
      max(maxval(abs(grid%turn)), pins/length)), kind_of(size(grid%pin), pins), &
      kind_of(size(grid%chord_slope), max(chords, maxval(abs(grid%chord_slope)))), &
      kind_of(size(grid%pin_slope), max(pins, maxval(abs(grid%pin_slope)))), &
      kind_of(size(grid%place), maxval(abs(grid%place))), kind_of(size(grid%direction), 1.0_wp), &
      kind_of(size(grid%rate), max(1.0_wp, maxval(abs(grid%rate)))), &
      kind_of(size(grid%rate_slope), max(1.0_wp, maxval(abs(grid%rate_slope))))]
    do c = 1, grid%cases
      kinds = [kinds, kind_of(size(grid%force(:, :, :, c)), force_of(c))]
    end do
    do c = 1, grid%cases
      kinds = [kinds, kind_of(size(grid%load(:, :, c)), max(maxval(abs(grid%load(:, :, c))), &
        force_of(c)*pins))]
    end do
    do c = 1, merge(grid%cases, 0, allocated(grid%second_order))
      forces = force_of(c)*maxval(abs(grid%turn))**2*length
      kinds = [kinds, kind_of(size(grid%second_order(:, :, :, c)), &
        max(maxval(abs(grid%second_order(:, :, :, c))), forces))]
    end do
    if (allocated(grid%weighted)) kinds = [kinds, kind_of(size(grid%weighted), &
      maxval(abs(grid%weighted)))]
    if (allocated(grid%weighted_slope)) kinds = [kinds, kind_of(size(grid%weighted_slope), &
      max(maxval(abs(grid%weighted)), maxval(abs(grid%weighted_slope))))]
    if (allocated(grid%pieces)) kinds = [kinds, kind_of(size(grid%ratio), 1.0_wp), &
      kind_of(size(grid%stretch), max(1.0_wp, maxval(abs(grid%stretch)))), &
      kind_of(size(grid%stretch_slope), max(1.0_wp, maxval(abs(grid%stretch_slope))))]

  contains

    !> A kind, and how large it is.
    pure type(term_kind_t) function kind_of(number, scale)
      integer, intent(in) :: number !! of all values of the kind
      real(wp), intent(in) :: scale

      kind_of = term_kind_t(number/grid%samples, max(scale, tiny(1.0_wp)))
    end function kind_of

    !> The largest force of a load case: along the links, or what loads do, per displacement.
    pure real(wp) function force_of(case)
      integer, intent(in) :: case

      force_of = max(maxval(abs(grid%force(:, :, :, case))), maxval(abs(grid%load(:, :, case)))/ &
        max(pins, tiny(1.0_wp)))
    end function force_of

  end function kinds_of

  !> The highest eighth of the harmonics, beside the size of their kind.
  pure function tail_of(kinds, coefficients) result(tail)
    type(term_kind_t), intent(in) :: kinds(:)
    real(wp), intent(in) :: coefficients(:, :) !! (samples, terms)
    real(wp) :: tail

    integer :: at, i, n

    n = size(coefficients, 1)
    tail = 0.0_wp
    at = 0
    do i = 1, size(kinds)
      if (kinds(i)%number > 0) tail = max(tail, maxval(abs(coefficients(n - n/8:, at + 1:at + &
        kinds(i)%number)))/kinds(i)%scale)
      at = at + kinds(i)%number
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
    grid%stretch = grid%stretch(spread(1, 1, samples), :)
    grid%stretch_slope = grid%stretch_slope(spread(1, 1, samples), :)
  end subroutine resize

  !> Terms at a crank angle, in the order of `terms_of`.
  subroutine take_terms(terms, k, grid)
    real(wp), intent(in) :: terms(:)
    integer, intent(in) :: k !! number of the crank angle
    type(turn_grid_t), intent(inout) :: grid

    integer :: at

    at = 0
    call take4(grid%chord(k, :, :, :))
    call take3(grid%turn(k, :, :))
    call take4(grid%pin(k, :, :, :))
    call take4(grid%chord_slope(k, :, :, :))
    call take4(grid%pin_slope(k, :, :, :))
    call take3(grid%place(k, :, :))
    call take3(grid%direction(k, :, :))
    call take2(grid%rate(k, :))
    call take2(grid%rate_slope(k, :))
    call take4(grid%force(k, :, :, :))
    call take3(grid%load(k, :, :))
    if (allocated(grid%second_order)) call take4(grid%second_order(k, :, :, :))
    if (allocated(grid%weighted)) call take3(grid%weighted(k, :, :))
    if (allocated(grid%weighted_slope)) call take3(grid%weighted_slope(k, :, :))
    if (.not. allocated(grid%pieces)) return
    call take2(grid%ratio(k, :))
    call take2(grid%stretch(k, :))
    call take2(grid%stretch_slope(k, :))

  contains

    subroutine take2(here)
      real(wp), intent(inout) :: here(:)

      here = reshape(terms(at + 1:at + size(here)), shape(here))
      at = at + size(here)
    end subroutine take2

    subroutine take3(here)
      real(wp), intent(inout) :: here(:, :)

      here = reshape(terms(at + 1:at + size(here)), shape(here))
      at = at + size(here)
    end subroutine take3

    subroutine take4(here)
      real(wp), intent(inout) :: here(:, :, :)

      here = reshape(terms(at + 1:at + size(here)), shape(here))
      at = at + size(here)
    end subroutine take4

  end subroutine take_terms

end module path_grids
