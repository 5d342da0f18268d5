!> The modes of one model in deformation coordinates at one position, for all speeds.
module speed_solver
  use bordered_eigensolver, only: bordered_modes_t, find_bordered_modes, start_t
  use bordered_matrix, only: add_scaled, bordered_matrix_t, new_bordered_matrix
  use deformation_model, only: deformation_model_t
  use errors, only: error_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use linkages, only: linkage_t
  use load_cases, only: case_count
  use pin_displacements, only: chords_t, find_chords
  use poses, only: pose_t
  use reduced_assembly, only: next_order_change, reduced_geometric_stiffness, reduced_mass
  use start_extrapolation, only: extrapolated_start, remember, track_t
  use text, only: string_t
  implicit none (type, external)
  private

  public :: reduced_work_t, new_reduced_work, solve_reduced, combine, order_error

  !> Beyond this step neighbours say too little about each other [deg].
  real(wp), parameter :: longest_step = 10.0_wp

  !> What the next two orders leave to all the others that follow: the change they make is
  !! multiplied by this. Where it is not small, orders may be far from enough (a link pressed so
  !! hard that it buckles many times over), and more is left.
  real(wp), parameter :: order_margin = 1.5_wp, rough_margin = 16.0_wp, rough_change = 1.0e-5_wp

  !> Where a link is pulled so hard that it bends at its ends only, the change falls slowly from
  !! order to order: what is left is the sum of a geometric series, times this; and the ratio of two
  !! pairs of orders is not taken for more than the second number.
  real(wp), parameter :: series_margin = 1.25_wp, most_ratio = 0.95_wp

  !> Matrices, made once and filled at every position, and what is remembered of the last positions.
  type :: reduced_work_t
    type(bordered_matrix_t) :: mass, unit(case_count), geometric
    type(track_t), allocatable :: tracks(:) !! (speeds)
  end type reduced_work_t

contains

  pure function new_reduced_work(model, speeds) result(work)
    type(deformation_model_t), intent(in) :: model
    integer, intent(in) :: speeds
    type(reduced_work_t) :: work

    integer :: i

    work%mass = new_bordered_matrix(model%layout, .false.)
    work%geometric = new_bordered_matrix(model%layout, .true.)
    do i = 1, case_count
      work%unit(i) = work%geometric
    end do
    allocate (work%tracks(speeds))
  end function new_reduced_work

  !> Solves `(I + G_const + ω2² G_ω + α2 G_α) y = λ M y` for every speed, from the modes of the last
  !! positions.
  subroutine solve_reduced(linkage, model, pose, place, unit_force, factor, modes, &
      accurate_vectors, work, chords, found, failure, counts)
    type(linkage_t), intent(in) :: linkage
    type(deformation_model_t), intent(in) :: model
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: place                !! of the position among its neighbours [deg]
    real(wp), intent(in) :: unit_force(:, :, :)  !! (force functions, bodies, cases) of the unit
                                                 !! loads [N]; no functions: no loads
    real(wp), intent(in) :: factor(:, :)         !! (cases, speeds) of the unit loads
    integer, intent(in) :: modes
    logical, intent(in) :: accurate_vectors(:)   !! (speeds)
    type(reduced_work_t), intent(inout) :: work
    type(chords_t), intent(out) :: chords
    type(bordered_modes_t), intent(out) :: found(:) !! (speeds)
    type(string_t), intent(inout) :: failure(:)     !! (speeds)
    type(ledger_t), intent(inout) :: counts

    type(start_t) :: start
    type(error_t), allocatable :: error
    integer :: i, k
    logical :: loaded, from_track, occurs(case_count) !! of the unit loads

    chords = find_chords(linkage, model%links, pose)
    call reduced_mass(linkage, model%links, model%layout, chords, work%mass)
    counts%mass_matrices = counts%mass_matrices + 1
    do i = 1, case_count
      occurs(i) = size(unit_force, 1) > 0 .and. any(abs(factor(i, :)) > 0.0_wp)
      if (.not. occurs(i)) cycle
      call reduced_geometric_stiffness(model%links, model%layout, chords, unit_force(:, :, i), &
        work%unit(i))
      counts%geometric_matrices = counts%geometric_matrices + 1
    end do
    do k = 1, size(factor, 2)
      loaded = size(unit_force, 1) > 0 .and. any(abs(factor(:, k)) > 0.0_wp)
      if (loaded) call combine(work, factor(:, k))
      start = extrapolated_start(work%tracks(k), place, longest_step)
      call find_bordered_modes(model%layout, work%mass, work%geometric, loaded, modes, &
        accurate_vectors(k), start, found(k), error)
      counts%factorizations = counts%factorizations + found(k)%factorizations
      counts%reduced_solutions = counts%reduced_solutions + found(k)%reduced_solutions
      counts%full_solutions = counts%full_solutions + found(k)%full_solutions
      if (allocated(error)) then
        if (len(failure(k)%text) == 0) failure(k)%text = error%message
        work%tracks(k)%length = 0
        cycle
      end if
      counts%proofs = counts%proofs + 1
      from_track = found(k)%reduced_solutions + found(k)%full_solutions == 0
      if (from_track) counts%extrapolated = counts%extrapolated + 1
      call remember(work%tracks(k), place, found(k), from_track)
    end do
  end subroutine solve_reduced

  !> `G = G_const + ω2² G_ω + α2 G_α` from the unit matrices of the last position.
  pure subroutine combine(work, factor)
    type(reduced_work_t), intent(inout) :: work
    real(wp), intent(in) :: factor(case_count) !! of the unit loads

    integer :: i

    work%geometric%border = 0.0_wp
    work%geometric%coupling = 0.0_wp
    work%geometric%block = 0.0_wp
    do i = 1, case_count
      if (abs(factor(i)) > 0.0_wp) call add_scaled(work%geometric, factor(i), work%unit(i))
    end do
  end subroutine combine

  !> Relative error of every eigenvalue because the polynomials end at their order, link by link.
  pure function order_error(model, chords, force, found, modes) result(error)
    type(deformation_model_t), intent(in) :: model
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: force(:, :) !! (force functions, bodies) at this speed [N]
    type(bordered_modes_t), intent(in) :: found
    integer, intent(in) :: modes
    real(wp) :: error(size(model%links), modes)

    real(wp) :: change(size(model%links)), ratio
    integer :: b, i

    do i = 1, modes
      change = next_order_change(model%links, model%layout, chords, force, found%vector(:, i), &
        found%lambda(i))
      error(:, i) = change/max(abs(found%lambda(i)), tiny(1.0_wp))
      if (sum(error(:, i)) >= rough_change) then
        error(:, i) = rough_margin*error(:, i)
        cycle
      end if
      do b = 1, size(change)
        ratio = change(b)/max(last_order_energy(model, chords, found%vector(:, i), b), tiny(ratio))
        error(b, i) = max(order_margin, series_margin/(1.0_wp - min(ratio, most_ratio)))*error(b, i)
      end do
    end do
  end function order_error

  !> Elastic energy that a mode has in the last two orders of a link, doubled: what the change by
  !! the next two is compared with.
  pure function last_order_energy(model, chords, vector, b) result(energy)
    type(deformation_model_t), intent(in) :: model
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: vector(:) !! (unknowns) mode with yᵀMy = 1
    integer, intent(in) :: b          !! number of the body
    real(wp) :: energy                !! [1/s²]

    integer :: first, k, n, last

    associate (link => model%links(b))
      first = model%layout%first(b)
      n = size(link%bending, 1)
      ! With shear every order has a curvature and a shear strain, in every element.
      last = merge(4, 2, link%bending_shapes%shear_stiffness > 0.0_wp)*link%bending_shapes%elements
      energy = 0.0_wp
      do k = max(1, n + 1 - last), n
        energy = energy + &
          (dot_product(chords%across(3, :, b), vector(:model%layout%border))*link%bending(k, 0) + &
          dot_product(link%bending(k, 1:), vector(first:first + link%modes - 1)))**2
      end do
    end associate
  end function last_order_energy

end module speed_solver
