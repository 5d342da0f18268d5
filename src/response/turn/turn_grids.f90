! src/response/turn/ - the equations of motion of an elastic linkage over a turn of its crank.
! In: a structure, a `deformation_model_t`. Out: a `turn_grid_t` with all terms; the forces of a
! motion on its unknowns. Begin with `new_turn_grid` here and `apply_equation` in
! `elastic_equations.f90`; at any crank angles `place_grid` in `path_grids.f90`,
! `find_motion_matrices` in `motion_matrices.f90`.
! Not here: solutions (`src/response/steady`, `src/response/stability`, `src/response/transient`),
! equations at a position (`src/vibration/position_equations.f90`).

!> The terms of the equations of motion of an elastic linkage at evenly spaced crank angles of a
!! turn. They do not depend on the speed: one grid serves all.
!!
!! Arrays run over the crank angles first, so that loops over them are long.
module turn_grids
  use band_matrix, only: full_band
  use body_lumps, only: lump_offsets
  use border_unknowns, only: border_unknowns_t, row_spring
  use carried_bodies, only: add_carried_mass, carried_motion
  use chebyshev_series, only: chebyshev_slopes
  use constants, only: pi, two_pi
  use coordinates, only: coordinate_rate
  use crank_laws, only: covered_range_t, half_of, positions_of
  use deformation_model, only: deformation_model_t
  use elastic_linkages, only: elastic_linkage_t, is_piece
  use dense_eigensolver, only: solve_dense
  use errors, only: error_of_dead_point, error_of_numerics, error_of_reach, error_t, set_error
  use fourier_transform, only: close_fourier, derivatives, fourier_plan_t, open_fourier
  use inertia_loads, only: distributed_load, load_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use link_modes, only: link_modes_t
  use linkages, only: linkage_t, normal_to
  use load_cases, only: case_count, find_unit_loads, load_case_t
  use moving_integrals, only: chord_functions, moving_integrals_t, new_moving_integrals
  use moving_pieces, only: amplitude_scales, moving_piece_t, new_moving_piece
  use part_displacements, only: find_part_chords
  use part_forces, only: find_pull_forces, pull_forces_t
  use pin_displacements, only: body_displacement, chords_t
  use position_assembly, only: assembled_t, load_parts, new_assembled, place_parts
  use poses, only: find_pose, pose_t
  use reactions, only: find_unit_reactions, unit_reactions_t
  use reduced_assembly, only: first_axial
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: turn_grid_t, damper_t, rate_case, new_turn_grid, start_grid, take_pose, take_chord, &
    moves, sense_of, find_slope

  !> Positions of a turn at which deformations are tried as unknowns, and turns until these are
  !! taken for good.
  integer, parameter :: pivot_positions = 72, most_turns = 8

  character(len=*), parameter :: no_choice = "links hold each other more than statics needs, "// &
    "and no choice of their deformations determines all others at every position of the turn"

  !> Number of the load case of α2; of what dampers pull in the motion of the rigid linkage, per ω2,
  !! which is behind the others if there are dampers.
  integer, parameter :: of_acceleration = 2, rate_case = case_count + 1

  !> A damper over the turn. Its row of `weighted` is what unit unknowns stretch or turn it.
  type :: damper_t
    real(wp) :: damping = 0.0_wp            !! c [N s/m] or [N m s/rad]
    real(wp), allocatable :: rate(:)        !! (samples) of its length or angle, dl/dθ2
    real(wp), allocatable :: force(:, :)    !! (samples, bodies) axial forces of a unit pull
    real(wp), allocatable :: second_order(:, :, :) !! (samples, border, border) what K_G has besides
  end type damper_t

  type :: turn_grid_t
    integer :: samples = 0   !! positions, of a turn 0, 360°/n, …
    logical :: backwards = .false. !! the crank turns clockwise: crank angles 0, −360°/n, …, and
                                   !! derivatives, rates and loads per α2 are with respect to −θ2
    type(covered_range_t) :: range !! positions that it is for
    integer :: unknowns = 0
    integer :: border = 0    !! first unknowns: rotations of held ends, elongations
    type(deformation_model_t) :: model
    type(moving_integrals_t), allocatable :: integrals(:) !! (bodies)
    integer, allocatable :: first(:)       !! (bodies) number of the first transverse own mode
    integer, allocatable :: first_along(:) !! (bodies) of the first axial own mode
    integer, allocatable :: elongation(:)  !! (bodies) number of its elongation; 0: rigid
    integer, allocatable :: owner(:)       !! (unknowns) body to whose elastic energy it belongs;
                                           !! 0: to several
    !> (samples, deformations, border) deformations of parts and springs per border unknown, scaled
    !! to unit stiffness; behind them those of dampers [m] or [rad]. `elongation` numbers them. Not
    !! allocated: the border unknowns themselves are the deformations.
    real(wp), allocatable :: weighted(:, :, :)
    integer, allocatable :: deformed(:)    !! (deformations) body; 0: a spring or a damper
    type(damper_t), allocatable :: dampers(:)
    integer :: cases = case_count          !! load cases, that of dampers included
    real(wp), allocatable :: weighted_slope(:, :, :) !! d/dθ2 of `weighted`; of `path_grids` only
    ! Of `path_grids`, of a crank and dyads: room for their positions
    type(assembled_t), allocatable :: here
    !> The same, of any other linkage: (samples of the range, terms) coefficients of all terms
    real(wp), allocatable :: series(:, :)
    real(wp) :: tail = 0.0_wp !! the highest of these, beside the size of their kind
    !> What moves with the material of pieces of ways along which blocks slide; not allocated: there
    !! are none
    type(moving_piece_t), allocatable :: pieces(:) !! (bodies)
    real(wp), allocatable :: ratio(:, :)    !! (samples, bodies) length by that of the tables
    real(wp), allocatable :: drift(:, :, :) !! (samples, 2, bodies) rates of the ends of pieces
                                            !! along the link, by the length
    real(wp), allocatable :: drift_slope(:, :, :) !! their derivatives
    integer, allocatable :: curve(:, :)     !! (2, bodies) numbers of the deformations that are
                                            !! curves of held ends; with pieces only
    real(wp), allocatable :: rotation(:, :) !! (border, border) orthogonal: border unknowns as those
                                           !! of the basis, from those of the grid, which are
                                           !! nearly modes then. Not allocated: the same
    !> (samples, functions of the chord, border, bodies)
    real(wp), allocatable :: chord(:, :, :, :)
    real(wp), allocatable :: turn(:, :, :)      !! (samples, border, bodies) rotation of the chord
    real(wp), allocatable :: pin(:, :, :, :)    !! (samples, 2, pins, border); behind the pins what
                                                !! cuts carry, then its rotation at a unit arm
    real(wp), allocatable :: chord_slope(:, :, :, :) !! d/dθ2 of `chord`
    real(wp), allocatable :: pin_slope(:, :, :, :)   !! d/dθ2 of `pin`
    real(wp), allocatable :: place(:, :, :)     !! (samples, 2, pins) of the rigid linkage [m]
    real(wp), allocatable :: direction(:, :, :) !! (samples, 2, bodies)
    real(wp), allocatable :: rate(:, :)         !! (samples, bodies) h = dθ/dθ2
    real(wp), allocatable :: rate_slope(:, :)   !! (samples, bodies) dh/dθ2
    !> (samples, force functions, bodies, cases) axial forces of the unit loads [N]
    real(wp), allocatable :: force(:, :, :, :)
    !> (samples, border, border, cases) what blocks on guides that turn add to K_G between border
    !! unknowns [-]; not allocated: nothing
    real(wp), allocatable :: second_order(:, :, :, :)
    real(wp), allocatable :: load(:, :, :)      !! (samples, unknowns, cases) f of the unit loads
    real(wp), allocatable :: torque(:, :)       !! (samples, cases) of the rigid linkage [N m]
    real(wp), allocatable :: pin_mass(:)        !! (pins) [kg], and of what is carried [kg] [kg m²]
    real(wp), allocatable :: rotary_inertia(:)  !! (bodies) ρI [kg m]
  end type turn_grid_t

contains

  !> The terms at all crank angles of a turn. The displacements are those of Ulker 2010 (2.74), of
  !! points of the rigid linkage. Bodies are the parts of its links, pins their points.
  !!
  !! Errors: the crank cannot reach one of the angles; a block meets what its way is cut at; the
  !! parts and springs do not determine the displacements; there are more of them than do, and no
  !! choice among them serves at all angles.
  subroutine new_turn_grid(structure, model, samples, grid, error, backwards, range)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(deformation_model_t), intent(in) :: model   !! own deformations of its bodies
    integer, intent(in) :: samples                   !! crank angles
    type(turn_grid_t), intent(out) :: grid           !! complete unless `error` is allocated
    type(error_t), allocatable, intent(out) :: error !! why there is no grid
    logical, intent(in), optional :: backwards       !! the crank turns clockwise; absent: not
    type(covered_range_t), intent(in), optional :: range !! positions that the grid is for, at
                                                     !! `positions_of`; absent: a turn

    type(assembled_t) :: here
    type(pose_t) :: pose
    real(wp) :: position(samples)
    integer :: k

    if (present(range)) grid%range = range
    position = positions_of(grid%range, samples)
    if (present(backwards)) grid%backwards = backwards
    call start_grid(structure, model, samples, here, grid, error)
    if (allocated(error)) return
    do k = 1, samples
      call find_pose(structure%linkage, sense_of(grid)*position(k), pose, error)
      if (.not. allocated(error)) call take_pose(structure, pose, k, here, grid, error)
      if (allocated(error)) return
    end do
    if (grid%backwards) call turn_back(grid)
    call add_damper_cases(grid)
    if (allocated(grid%rotation)) call turn_unknowns(grid)
    if (allocated(grid%second_order)) then
      if (.not. any(abs(grid%second_order) > 0.0_wp)) deallocate (grid%second_order)
    end if
    call find_slopes(structure, grid, error)
  end subroutine new_turn_grid

  !> Whether a body is a piece of a way along which blocks slide.
  pure function moves(grid, body) result(yes)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    logical :: yes

    yes = allocated(grid%pieces)
    if (yes) yes = grid%pieces(body)%way > 0
  end function moves

  !> 1, or −1 where the crank turns clockwise.
  pure function sense_of(grid) result(sense)
    type(turn_grid_t), intent(in) :: grid
    real(wp) :: sense

    sense = merge(-1.0_wp, 1.0_wp, grid%backwards)
  end function sense_of

  !> Rates, and what they load, with respect to −θ2.
  pure subroutine turn_back(grid)
    type(turn_grid_t), intent(inout) :: grid

    integer :: i

    grid%rate = -grid%rate
    grid%force(:, :, :, of_acceleration) = -grid%force(:, :, :, of_acceleration)
    grid%load(:, :, of_acceleration) = -grid%load(:, :, of_acceleration)
    if (allocated(grid%second_order)) grid%second_order(:, :, :, of_acceleration) = &
      -grid%second_order(:, :, :, of_acceleration)
    do i = 1, size(grid%dampers)
      grid%dampers(i)%rate = -grid%dampers(i)%rate
    end do
  end subroutine turn_back

  !> Numbers and room for the terms, and border unknowns that are smooth functions of the crank
  !! angle.
  !!
  !! Errors: no spring holds a free drive; those of `choose_pivots`.
  subroutine start_grid(structure, model, samples, here, grid, error)
    class(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model !! own deformations of its parts
    integer, intent(in) :: samples                 !! crank angles
    type(assembled_t), intent(out) :: here         !! for `take_pose`
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    integer :: b, i, n, pins

    grid%samples = samples
    grid%model = model
    grid%unknowns = model%layout%unknowns
    grid%border = model%layout%border
    if (model%layout%free > 0) then
      call set_error(error, error_of_dead_point, "the linkage moves freely beside the motion "// &
        "of its crank: no SPRING holds a drive that is 'free'")
      return
    end if
    here = new_assembled(structure, model)
    associate (parts => structure%elastic%linkage, dampers => structure%elastic%dampers, &
        border => grid%border)
      n = size(parts%bodies)
      pins = size(parts%is_ground)
      grid%pin_mass = parts%pin_mass
      grid%rotary_inertia = parts%bodies%rotary_inertia
      call number_own_modes(grid)
      allocate (grid%integrals(n), grid%dampers(size(dampers)))
      do b = 1, n
        grid%integrals(b) = new_moving_integrals(parts%bodies(b), model%links(b))
      end do
      if (size(dampers) > 0) grid%cases = rate_case
      do i = 1, size(dampers)
        grid%dampers(i)%damping = dampers(i)%damping
        allocate (grid%dampers(i)%rate(samples), grid%dampers(i)%force(samples, n), &
          grid%dampers(i)%second_order(samples, border, border))
      end do
      allocate (grid%chord(samples, maxval(chord_functions(model%links)), border, n), &
        grid%load(samples, grid%unknowns, grid%cases), &
        grid%second_order(samples, border, border, grid%cases), source=0.0_wp)
      allocate (grid%turn(samples, border, n), grid%pin(samples, 2, pins, border), &
        grid%place(samples, 2, pins), grid%direction(samples, 2, n), grid%rate(samples, n), &
        grid%rate_slope(samples, n), grid%torque(samples, case_count))
    end associate
    call number_deformations(here%numbers, grid)
    call start_pieces(structure, here%numbers, grid)
    call start_carried(structure%elastic, grid)
    if (.not. allocated(grid%weighted)) return
    n = size(here%numbers%rows)
    if (n == grid%border .and. all(grid%deformed(:n) > 0)) return
    call choose_pivots(structure, grid%range, model, here, error)
    if (.not. allocated(error)) call find_rotation(structure, here, grid, error)
  end subroutine start_grid

  !> Room for what moves with the material of pieces.
  pure subroutine start_pieces(structure, numbers, grid)
    class(structure_t), intent(in) :: structure
    type(border_unknowns_t), intent(in) :: numbers
    type(turn_grid_t), intent(inout) :: grid

    integer :: b, n

    associate (elastic => structure%elastic)
      n = size(elastic%body)
      if (.not. any(is_piece(elastic, [(b, b=1, n)]))) return
      allocate (grid%pieces(n))
      do b = 1, n
        if (is_piece(elastic, b)) grid%pieces(b) = new_moving_piece(grid%model%links(b), &
          elastic%way(b))
      end do
    end associate
    allocate (grid%ratio(grid%samples, n), source=1.0_wp)
    allocate (grid%drift(grid%samples, 2, n), grid%drift_slope(grid%samples, 2, n), source=0.0_wp)
    grid%curve = numbers%curve
  end subroutine start_pieces

  !> Room for what cuts carry.
  pure subroutine start_carried(elastic, grid)
    type(elastic_linkage_t), intent(in) :: elastic
    type(turn_grid_t), intent(inout) :: grid

    if (size(elastic%carried) == 0) return
    grid%pin_mass = [grid%pin_mass, elastic%carried%mass, elastic%carried%inertia]
    deallocate (grid%pin)
    allocate (grid%pin(grid%samples, 2, size(grid%pin_mass), grid%border), source=0.0_wp)
  end subroutine start_carried

  !> What dampers pull in the motion of the rigid linkage, as a load case per ω2.
  pure subroutine add_damper_cases(grid)
    type(turn_grid_t), intent(inout) :: grid

    real(wp) :: pull(grid%samples)
    integer :: i, j, k, n

    n = size(grid%dampers)
    if (n == 0) return
    do i = 1, n
      pull = grid%dampers(i)%damping*grid%dampers(i)%rate
      associate (row => grid%weighted(:, size(grid%weighted, 2) - n + i, :), damper => &
          grid%dampers(i))
        do j = 1, grid%border
          grid%load(:, j, rate_case) = grid%load(:, j, rate_case) - pull*row(:, j)
          do k = 1, grid%border
            grid%second_order(:, k, j, rate_case) = grid%second_order(:, k, j, rate_case) + &
              pull*damper%second_order(:, k, j)
          end do
        end do
        do j = 1, size(damper%force, 2)
          grid%force(:, 1, j, rate_case) = grid%force(:, 1, j, rate_case) + pull*damper%force(:, j)
        end do
      end associate
    end do
  end subroutine add_damper_cases

  !> The modes of the border by itself, with the mean of its mass matrix over the turn, the slowest
  !! first. The basis of deformations may mix slow ones with fast ones; these do little.
  subroutine find_rotation(structure, here, grid, error)
    class(structure_t), intent(in) :: structure
    type(assembled_t), intent(inout) :: here  !! with pivots for its border
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    type(pose_t) :: pose
    type(chords_t) :: chords
    real(wp) :: mass(grid%border, grid%border), unit(grid%border, grid%border), &
      inverse(grid%border), functions(size(grid%chord, 2), grid%border), position(pivot_positions)
    integer :: b, i, p

    mass = 0.0_wp
    position = positions_of(grid%range, pivot_positions)
    do i = 1, pivot_positions
      call find_pose(structure%linkage, position(i), pose, error)
      if (.not. allocated(error)) call place_parts(structure, grid%model, pose, here, error)
      if (.not. allocated(error)) call find_part_chords(here%elastic_position_t, &
        .false., here%border, chords, error)
      if (allocated(error)) return
      do b = 1, size(grid%integrals)
        associate (chord => grid%integrals(b)%chord, of_body => grid%integrals(b)%mass)
          call take_chord(grid%model%links(b), chords, b, functions)
          if (moves(grid, b)) call scale_chord(grid, b, here%elastic%linkage%bodies(b)%length, &
            functions)
          mass = mass + matmul(transpose(functions(:chord, :)), matmul(of_body(:chord, :chord), &
            functions(:chord, :)))
        end associate
      end do
      do p = 1, size(chords%pin, 2)
        mass = mass + grid%pin_mass(p)*matmul(transpose(chords%pin(:, p, :)), chords%pin(:, p, :))
      end do
      call add_carried_mass(here%elastic, here%pose, chords, mass)
    end do
    unit = 0.0_wp
    do i = 1, grid%border
      unit(i, i) = 1.0_wp
    end do
    call solve_dense(full_band(unit), full_band(mass), grid%border, .true., inverse, &
      grid%rotation, error)
  end subroutine find_rotation

  !> The functions of the chord of a piece of some length with the root of its share of the mass:
  !! their integrals are those at the length of the tables then.
  pure subroutine scale_chord(grid, b, length, functions)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b
    real(wp), intent(in) :: length             !! [m]
    real(wp), intent(inout) :: functions(:, :) !! (functions of the chord, border)

    real(wp) :: ratio, scale(1, size(grid%pieces(b)%slope, 1))
    integer :: i

    ratio = length/grid%model%links(b)%length
    scale = amplitude_scales(grid%pieces(b), [ratio])
    do i = 1, grid%integrals(b)%chord
      functions(i, :) = sqrt(ratio)*scale(1, i)*functions(i, :)
    end do
  end subroutine scale_chord

  !> The terms in unknowns that are turned.
  pure subroutine turn_unknowns(grid)
    type(turn_grid_t), intent(inout) :: grid

    integer :: b, c, i, k

    associate (rotation => grid%rotation, border => grid%border)
      do k = 1, grid%samples
        do b = 1, size(grid%integrals)
          grid%chord(k, :, :, b) = matmul(grid%chord(k, :, :, b), rotation)
          grid%turn(k, :, b) = matmul(grid%turn(k, :, b), rotation)
        end do
        do i = 1, size(grid%pin, 3)
          grid%pin(k, :, i, :) = matmul(grid%pin(k, :, i, :), rotation)
        end do
        grid%weighted(k, :, :) = matmul(grid%weighted(k, :, :), rotation)
        do c = 1, grid%cases
          grid%load(k, :border, c) = matmul(grid%load(k, :border, c), rotation)
          grid%second_order(k, :, :, c) = turned_form(grid%second_order(k, :, :, c))
        end do
        do i = 1, size(grid%dampers)
          associate (form => grid%dampers(i)%second_order(k, :, :))
            form = turned_form(form)
          end associate
        end do
      end do
    end associate

  contains

    pure function turned_form(form) result(turned)
      real(wp), intent(in) :: form(:, :)
      real(wp) :: turned(grid%border, grid%border)

      turned = matmul(transpose(grid%rotation), matmul(form, grid%rotation))
    end function turned_form

  end subroutine turn_unknowns

  !> The terms at one crank angle, without the slopes of chords and pins; derivatives are with
  !! respect to θ2.
  !!
  !! Errors: those of `load_parts`; the deformations chosen do not determine all others; a block has
  !! passed what its way is cut at.
  subroutine take_pose(structure, pose, k, here, grid, error)
    class(structure_t), intent(in) :: structure
    type(pose_t), intent(in) :: pose          !! of the linkage that moves
    integer, intent(in) :: k                  !! number of the crank angle
    type(assembled_t), intent(inout) :: here  !! by `start_grid`
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    type(kinematic_coefficients_t) :: coefficients
    type(chords_t) :: chords
    type(unit_reactions_t) :: unit
    integer :: b, c, n

    coefficients = find_kinematic_coefficients(structure%linkage, pose)
    here%loads = find_unit_loads(structure%linkage, pose, coefficients)
    call load_parts(structure, grid%model, pose, here, chords, error)
    if (.not. allocated(error) .and. allocated(grid%rotation) .and. here%border%is_new) &
      call set_error(error, error_of_numerics, no_choice)
    if (allocated(error)) return
    grid%rate(k, :) = coefficients%turn(here%elastic%body)
    grid%rate_slope(k, :) = coefficients%turn_slope(here%elastic%body)
    call take_chords(here%pose, chords, k, grid)
    n = size(chords%pin, 2)
    do b = 1, size(here%elastic%carried)
      grid%pin(k, :, [n + b, n + size(here%elastic%carried) + b], :) = &
        carried_motion(here%elastic, here%pose, chords, b)
    end do
    n = size(here%numbers%rows)
    if (allocated(grid%weighted)) grid%weighted(k, :n, :) = chords%weighted
    if (allocated(grid%pieces)) call take_lengths(here%elastic, k, grid, error)
    if (allocated(error)) return
    call take_forces(here%loaded%forces%axial, k, grid)
    call find_unit_reactions(structure%linkage, spread(0, 1, size(structure%linkage%bodies)), &
      pose, coefficients, unit)
    do c = 1, case_count
      if (allocated(grid%second_order)) grid%second_order(k, :, :, c) = &
        here%loaded%forces%second_order(:, :, c)
      grid%load(k, :grid%border, c) = here%loaded%forces%work(:, c)
      do b = 1, size(grid%integrals)
        call add_own_loads(grid, b, k, inertia_work(here%elastic%linkage, grid, b, here%pose, &
          here%loaded%loads%unit%of_case(c)), grid%load(k, :, c))
      end do
      grid%torque(k, c) = unit%of_case(c)%joints%torque
    end do
    if (size(grid%dampers) > 0) call take_dampers(structure%linkage, pose, coefficients, chords, &
      k, here, grid)
  end subroutine take_pose

  !> Lengths of pieces at one crank angle. The first one tells where they begin and end, the same at
  !! all others.
  pure subroutine take_lengths(elastic, k, grid, error)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    integer, intent(in) :: k
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    integer :: b

    do b = 1, size(grid%integrals)
      if (.not. moves(grid, b)) cycle
      associate (piece => grid%pieces(b), part => elastic%linkage%bodies(b))
        grid%ratio(k, b) = part%length/grid%model%links(b)%length
        if (k == 1) piece%points = [part%first_pin, part%last_pin]
        if (any(piece%points /= [part%first_pin, part%last_pin])) then
          call refuse_meeting(elastic%body(b), error)
          return
        end if
        piece%slides = [any(elastic%contact == part%first_pin), any(elastic%contact == &
          part%last_pin)]
      end associate
    end do
  end subroutine take_lengths

  !> A block meets what its way is cut at.
  pure subroutine refuse_meeting(body, error)
    integer, intent(in) :: body !! number of the link
    type(error_t), allocatable, intent(out) :: error

    call set_error(error, error_of_reach, "a block meets a pin, a mass, the place of a force "// &
      "or another block along it", body=body)
  end subroutine refuse_meeting

  !> What the dampers do at one crank angle.
  pure subroutine take_dampers(linkage, pose, coefficients, chords, k, here, grid)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    type(chords_t), intent(in) :: chords
    integer, intent(in) :: k
    type(assembled_t), intent(in) :: here
    type(turn_grid_t), intent(inout) :: grid

    type(pull_forces_t) :: forces
    integer :: i, n

    call find_pull_forces(here%elastic_position_t, here%border, chords, forces)
    n = size(grid%weighted, 2) - size(grid%dampers)
    do i = 1, size(grid%dampers)
      grid%weighted(k, n + i, :) = forces%row(:, i)
      associate (damper => grid%dampers(i))
        damper%rate(k) = coordinate_rate(linkage, pose, coefficients, &
          linkage%loads(here%elastic%dampers(i)%load)%along)
        damper%force(k, :) = forces%axial(:, i)
        damper%second_order(k, :, :) = forces%second_order(:, :, i)
      end associate
    end do
  end subroutine take_dampers

  !> Places, directions, and what the border unknowns do to pins and chords.
  subroutine take_chords(pose, chords, k, grid)
    type(pose_t), intent(in) :: pose
    type(chords_t), intent(in) :: chords
    integer, intent(in) :: k
    type(turn_grid_t), intent(inout) :: grid

    integer :: b

    grid%place(k, :, :) = pose%pin
    grid%direction(k, :, :) = pose%direction
    grid%turn(k, :, :) = chords%turn
    grid%pin(k, :, :size(chords%pin, 2), :) = chords%pin
    do b = 1, size(grid%integrals)
      call take_chord(grid%model%links(b), chords, b, grid%chord(k, :, :, b))
    end do
  end subroutine take_chords

  !> Axial forces of the unit loads.
  subroutine take_forces(force, k, grid)
    real(wp), intent(in) :: force(:, :, :) !! (force functions, bodies, cases) [N]
    integer, intent(in) :: k
    type(turn_grid_t), intent(inout) :: grid

    if (.not. allocated(grid%force)) allocate (grid%force(grid%samples, size(force, 1), &
      size(force, 2), grid%cases), source=0.0_wp)
    grid%force(k, :, :, :case_count) = force
  end subroutine take_forces

  !> Functions of the chord of a body for every border unknown.
  pure subroutine take_chord(link, chords, body, functions)
    type(link_modes_t), intent(in) :: link     !! own deformations of the body
    type(chords_t), intent(in) :: chords       !! what the unknowns do to all chords, or its slopes
    integer, intent(in) :: body                !! number
    real(wp), intent(inout) :: functions(:, :) !! (functions, border)

    if (link%bends) then
      functions(:2 + link%curves, :) = chords%across(:2 + link%curves, :, body)
      functions(3 + link%curves:4 + link%curves, :) = chords%along(:, :, body)
    else
      functions(:3, :) = body_displacement(chords, body)
    end if
  end subroutine take_chord

  !> Derivatives of the motion of chords and pins over the turn.
  !!
  !! Errors: a block meets what its way is cut at between samples.
  subroutine find_slopes(structure, grid, error)
    class(structure_t), intent(in) :: structure
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    integer :: b, i, p

    allocate (grid%chord_slope, mold=grid%chord)
    allocate (grid%pin_slope, mold=grid%pin)
    do i = 1, grid%border
      do b = 1, size(grid%chord, 4)
        call find_slope(grid, grid%chord(:, :, i, b), grid%chord_slope(:, :, i, b))
      end do
      do p = 1, size(grid%pin, 3)
        call find_slope(grid, grid%pin(:, :, p, i), grid%pin_slope(:, :, p, i))
      end do
    end do
    if (allocated(grid%pieces)) call find_drifts(structure%elastic, grid, error)
  end subroutine find_slopes

  !> Rates of the ends of pieces along the link.
  subroutine find_drifts(elastic, grid, error)
    type(elastic_linkage_t), intent(in) :: elastic
    type(turn_grid_t), intent(inout) :: grid
    type(error_t), allocatable, intent(out) :: error

    real(wp), dimension(grid%samples, size(grid%pieces)) :: first, second
    real(wp) :: moved(grid%samples, 2), step
    integer :: b, end

    call find_slope(grid, grid%ratio, first, second)
    moved = 0.0_wp
    step = merge(two_pi, pi*half_of(grid%range), grid%range%is_turn)/grid%samples
    do b = 1, size(grid%pieces)
      if (.not. moves(grid, b)) cycle
      ! The least length between samples, where one is near.
      if (any(abs(first(:, b)) < step*second(:, b) .and. 2.0_wp*grid%ratio(:, b)*second(:, b) <= &
        first(:, b)**2)) then
        call refuse_meeting(elastic%body(b), error)
        return
      end if
      if (grid%pieces(max(b - 1, 1))%way /= grid%pieces(b)%way) moved = 0.0_wp
      do end = 1, 2
        if (end == 2) moved = moved + reshape([first(:, b), second(:, b)], [grid%samples, 2])
        if (.not. grid%pieces(b)%slides(end)) cycle
        grid%drift(:, end, b) = moved(:, 1)/grid%ratio(:, b)
        grid%drift_slope(:, end, b) = (moved(:, 2) - grid%drift(:, end, b)*first(:, &
          b))/grid%ratio(:, b)
      end do
    end do
  end subroutine find_drifts

  !> Derivatives with respect to the position of the crank, over the positions of a grid.
  subroutine find_slope(grid, values, slope, second)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: values(:, :) !! (samples, functions)
    real(wp), intent(out) :: slope(:, :) !! per rad or m
    real(wp), intent(out), optional :: second(:, :) !! derivatives

    type(fourier_plan_t) :: plan

    if (grid%range%is_turn) then
      call open_fourier(grid%samples, plan)
      call derivatives(plan, values, slope, second)
      call close_fourier(plan)
    else
      slope = chebyshev_slopes(values)/half_of(grid%range)
      if (present(second)) second = chebyshev_slopes(slope)/half_of(grid%range)
    end if
  end subroutine find_slope

  !> To which parts the deformations belong: where there are as many as unknowns, and no dampers,
  !! each is one.
  pure subroutine number_deformations(numbers, grid)
    type(border_unknowns_t), intent(in) :: numbers
    type(turn_grid_t), intent(inout) :: grid

    integer :: n

    n = size(numbers%rows)
    grid%elongation = numbers%elongation
    grid%deformed = [merge(0, numbers%rows%number, numbers%rows%kind == row_spring), &
      spread(0, 1, size(grid%dampers))]
    if (n == grid%border .and. all(grid%deformed > 0)) then
      grid%owner(:n) = grid%deformed
    else
      grid%owner(:grid%border) = 0
      allocate (grid%weighted(grid%samples, size(grid%deformed), grid%border))
    end if
  end subroutine number_deformations

  !> Deformations that determine all others at every position: the border unknowns are then smooth
  !! functions of the crank angle. From a position on where they do not, others are taken, until a
  !! whole turn needs no more.
  subroutine choose_pivots(structure, range, model, here, error)
    class(structure_t), intent(in) :: structure
    type(covered_range_t), intent(in) :: range !! positions that they are for
    type(deformation_model_t), intent(in) :: model
    type(assembled_t), intent(inout) :: here !! its border gets them
    type(error_t), allocatable, intent(out) :: error

    type(pose_t) :: pose
    type(chords_t) :: chords
    real(wp) :: position(0:pivot_positions - 1)
    integer :: i, kept

    kept = 0
    position = positions_of(range, pivot_positions)
    do i = 0, most_turns*pivot_positions - 1
      call find_pose(structure%linkage, position(modulo(i, pivot_positions)), pose, error)
      if (.not. allocated(error)) call place_parts(structure, model, pose, here, error)
      if (.not. allocated(error)) call find_part_chords(here%elastic_position_t, &
        .false., here%border, chords, error)
      if (allocated(error)) return
      kept = merge(1, kept + 1, here%border%is_new)
      if (kept > pivot_positions) return
    end do
    call set_error(error, error_of_numerics, no_choice)
  end subroutine choose_pivots

  !> Numbers of the own modes of every body, and the body to which they belong.
  pure subroutine number_own_modes(grid)
    type(turn_grid_t), intent(inout) :: grid

    integer :: b

    associate (links => grid%model%links, layout => grid%model%layout)
      allocate (grid%owner(grid%unknowns), grid%first(size(links)), grid%first_along(size(links)))
      do b = 1, size(links)
        grid%first(b) = layout%first(b)
        grid%first_along(b) = first_axial(layout, links, b)
        grid%owner(grid%first(b):grid%first(b) + links(b)%modes - 1) = b
        grid%owner(grid%first_along(b):grid%first_along(b) + links(b)%axial_modes - 1) = b
      end do
    end associate
  end subroutine number_own_modes

  !> Work of the inertia loads of a body on all its functions: `f = −∫ μ Sᵀ a dx`, the term −M Ü0 of
  !! Ulker 2010 (2.77), (2.82) and (2.83).
  pure function inertia_work(linkage, grid, b, pose, case) result(work)
    type(linkage_t), intent(in) :: linkage
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b !! number of the body
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp), allocatable :: work(:)

    real(wp), allocatable :: offset(:)
    type(load_t) :: whole

    associate (integrals => grid%integrals(b), axis => pose%direction(:, b))
      if (grid%model%links(b)%bends) then
        work = -matmul(integrals%mass(:, [1, 2, integrals%chord - 1, integrals%chord]), &
          ends_of(case, b, axis, linkage%bodies(b)%length))
        ! The accelerations of the axis, as displacements, move a mass beside it but for the
        ! centripetal part of its offset, across the link.
        if (size(integrals%at_mass, 2) > 0) then
          offset = lump_offsets(linkage%bodies(b))
          work = work - matmul(integrals%at_mass, offset)*dot_product(axis, case%field%slope(:, b))
        end if
      else
        whole = distributed_load(linkage%bodies(b), b, pose, case%field)
        work = [dot_product(axis, whole%force), dot_product(normal_to(axis), whole%force), &
          whole%moment]
      end if
    end associate
  end function inertia_work

  !> The work on the own modes of a body.
  pure subroutine add_own_loads(grid, b, k, work_on, load)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b
    integer, intent(in) :: k           !! number of the crank angle
    real(wp), intent(in) :: work_on(:) !! (functions) of the tables
    real(wp), intent(inout) :: load(:) !! (unknowns)

    real(wp) :: work(size(work_on)), scale(1, size(work_on))

    work = work_on
    if (moves(grid, b)) then
      scale = amplitude_scales(grid%pieces(b), grid%ratio(k:k, b))
      work = grid%ratio(k, b)*scale(1, :)*work
    end if

    associate (link => grid%model%links(b), chord => grid%integrals(b)%chord)
      load(grid%first(b):grid%first(b) + link%modes - 1) = work(chord + 1:chord + link%modes)
      load(grid%first_along(b):grid%first_along(b) + link%axial_modes - 1) = &
        work(chord + link%modes + 1:)
    end associate
  end subroutine add_own_loads

  !> Accelerations of both ends of a link across it and along it.
  pure function ends_of(case, body, axis, length) result(ends)
    type(load_case_t), intent(in) :: case
    integer, intent(in) :: body
    real(wp), intent(in) :: axis(2), length
    real(wp) :: ends(4)

    associate (at_first => case%field%at_first(:, body), slope => case%field%slope(:, body))
      ends(1) = dot_product(normal_to(axis), at_first)
      ends(2) = ends(1) + length*dot_product(normal_to(axis), slope)
      ends(3) = dot_product(axis, at_first)
      ends(4) = ends(3) + length*dot_product(axis, slope)
    end associate
  end function ends_of

end module turn_grids
