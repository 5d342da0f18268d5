!> The matrices of the equation of motion at crank angles anywhere, in all unknowns. They do not
!! depend on speed and acceleration.
module motion_matrices
  use elastic_equations, only: deformations_of, mass_force, slope_force, swept_force, &
    unit_geometric_force
  use kinds, only: wp
  use load_cases, only: constant_case
  use piece_motions, only: add_strain_convection
  use strain_dampings, only: lengths_of
  use turn_grids, only: rate_case, turn_grid_t
  implicit none (type, external)
  private

  public :: motion_matrices_t, find_motion_matrices, stiffness_at, load_at

  !> Matrices (unknowns, unknowns, samples).
  type :: motion_matrices_t
    real(wp), allocatable :: mass(:, :, :)  !! M [s²]
    real(wp), allocatable :: slope(:, :, :) !! G = ∫ μ SᵀS' dx [s²]
    real(wp), allocatable :: swept(:, :, :) !! W = ∫ μ S'ᵀS' dx [s²]
    !> (unknowns, unknowns, samples, cases) K_G per ω2² and α2, of the constant loads, and per ω2 of
    !! dampers
    real(wp), allocatable :: geometric(:, :, :, :)
    real(wp), allocatable :: load(:, :, :)  !! (unknowns, samples, cases) f likewise
    !> (deformations, border, samples) of the grid, with d/dθ2; not allocated: they are the border
    !! unknowns
    real(wp), allocatable :: deformed(:, :, :), deformed_slope(:, :, :)
    !> (strains, unknowns, samples) with pieces whose lengths change: of all deformations, then own
    !! modes, for unit unknowns, and their rates in the material at constant unknowns; their numbers
    !! among the dampings; (strains, samples) lengths of their pieces, by those of the tables
    real(wp), allocatable :: strain(:, :, :), strain_slope(:, :, :)
    integer, allocatable :: strain_damping(:)
    real(wp), allocatable :: strain_length(:, :)
  end type motion_matrices_t

contains

  !> All matrices, column by column.
  subroutine find_motion_matrices(grid, matrices)
    type(turn_grid_t), intent(in) :: grid !! with its terms and their slopes
    type(motion_matrices_t), intent(inout) :: matrices !! room is kept from one call to the next

    real(wp), dimension(grid%samples, grid%unknowns) :: y, force
    integer :: c, j, k, n

    n = grid%unknowns
    if (.not. allocated(matrices%mass)) then
      allocate (matrices%mass(n, n, grid%samples), matrices%slope(n, n, grid%samples))
      allocate (matrices%swept(n, n, grid%samples))
      allocate (matrices%geometric(n, n, grid%samples, grid%cases))
      allocate (matrices%load(n, grid%samples, grid%cases))
    end if
    do j = 1, n
      y = 0.0_wp
      y(:, j) = 1.0_wp
      call mass_force(grid, y, force)
      matrices%mass(:, j, :) = transpose(force)
      call slope_force(grid, y, force)
      matrices%slope(:, j, :) = transpose(force)
      call swept_force(grid, y, force)
      matrices%swept(:, j, :) = transpose(force)
      do c = 1, grid%cases
        force = 0.0_wp
        call unit_geometric_force(grid, c, y, force)
        matrices%geometric(:, j, :, c) = transpose(force)
      end do
    end do
    do c = 1, grid%cases
      matrices%load(:, :, c) = transpose(grid%load(:, :, c))
    end do
    if (allocated(grid%pieces)) then
      call find_strains(grid, matrices)
      return
    end if
    if (.not. allocated(grid%weighted_slope)) return
    if (.not. allocated(matrices%deformed)) allocate (matrices%deformed(size(grid%weighted, 2), &
      grid%border, grid%samples), matrices%deformed_slope(size(grid%weighted, 2), grid%border, &
      grid%samples))
    do k = 1, grid%samples
      matrices%deformed(:, :, k) = grid%weighted(k, :, :)
      matrices%deformed_slope(:, :, k) = grid%weighted_slope(k, :, :)
    end do
  end subroutine find_motion_matrices

  !> Strains where they move through pieces with their material.
  pure subroutine find_strains(grid, matrices)
    type(turn_grid_t), intent(in) :: grid
    type(motion_matrices_t), intent(inout) :: matrices

    real(wp) :: y(grid%samples, grid%unknowns), rates(grid%samples, grid%unknowns)
    real(wp), allocatable :: w(:, :), w_rates(:, :)
    integer :: d, i, j, n

    n = grid%unknowns
    d = size(grid%deformed)
    if (.not. allocated(grid%weighted)) d = grid%border
    if (.not. allocated(matrices%strain)) allocate (matrices%strain(d + n - grid%border, n, &
      grid%samples), matrices%strain_slope(d + n - grid%border, n, grid%samples), &
      matrices%strain_length(d + n - grid%border, grid%samples))
    matrices%strain_damping = [(i + merge(n, 0, allocated(grid%weighted)), i=1, d), &
      (i, i=grid%border + 1, n)]
    do i = 1, size(matrices%strain_damping)
      matrices%strain_length(i, :) = lengths_of(grid, matrices%strain_damping(i))
    end do
    do j = 1, n
      y = 0.0_wp
      y(:, j) = 1.0_wp
      w = deformations_of(grid, y)
      allocate (w_rates(grid%samples, d), source=0.0_wp)
      rates = 0.0_wp
      if (allocated(grid%weighted) .and. j <= grid%border) w_rates = grid%weighted_slope(:, :, j)
      call add_strain_convection(grid, w, y, w_rates, rates)
      matrices%strain(:d, j, :) = transpose(w)
      matrices%strain(d + 1:, j, :) = transpose(y(:, grid%border + 1:))
      matrices%strain_slope(:d, j, :) = transpose(w_rates)
      matrices%strain_slope(d + 1:, j, :) = transpose(rates(:, grid%border + 1:))
      deallocate (w_rates)
    end do
  end subroutine find_strains

  !> `1 + K_G` at a speed and an acceleration.
  pure function stiffness_at(matrices, sample, speed, acceleration, axial) result(stiffness)
    type(motion_matrices_t), intent(in) :: matrices
    integer, intent(in) :: sample
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    logical, intent(in) :: axial         !! with K_G
    real(wp) :: stiffness(size(matrices%mass, 1), size(matrices%mass, 1))

    integer :: i

    stiffness = 0.0_wp
    if (axial) stiffness = speed**2*matrices%geometric(:, :, sample, 1) + &
      acceleration*matrices%geometric(:, :, sample, 2) + &
      matrices%geometric(:, :, sample, constant_case)
    if (axial .and. size(matrices%geometric, 4) >= rate_case) stiffness = stiffness + &
      speed*matrices%geometric(:, :, sample, rate_case)
    do i = 1, size(stiffness, 1)
      stiffness(i, i) = stiffness(i, i) + 1.0_wp
    end do
  end function stiffness_at

  !> f at a speed and an acceleration [√J].
  pure function load_at(matrices, sample, speed, acceleration) result(load)
    type(motion_matrices_t), intent(in) :: matrices
    integer, intent(in) :: sample
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    real(wp) :: load(size(matrices%mass, 1))

    load = speed**2*matrices%load(:, sample, 1) + acceleration*matrices%load(:, sample, 2) + &
      matrices%load(:, sample, constant_case)
    if (size(matrices%load, 3) >= rate_case) load = load + speed*matrices%load(:, sample, rate_case)
  end function load_at

end module motion_matrices
