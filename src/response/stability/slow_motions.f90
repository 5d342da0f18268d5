!> The slow part of the motion of an elastic linkage: a few coordinates that follow the slow
!! vibrations over the turn, each with what the rest of the linkage does along with it.
!!
!! `y = X z` with X(θ) from subspace iterations on the mass matrix: the slow deformations (rotation
!! of the clamped end, the lowest own modes of the links) and the deformations that their inertia
!! causes, perpendicular to each other at every angle. The matrices of z do not depend on the speed.
!! At a speed the equation `(M z' + G z)' = (Gᵀ − C/ω) z' + (W − K/ω²) z + F/ω²` is solved by
!! Gauss collocation, step after step, and closed to a periodic motion. It serves as an approximate
!! inverse of the whole equation, and gives the multipliers of a turn.
!!
!! With s stages z is a polynomial of degree s in a step, and collocation is Galerkin's method with
!! such polynomials and Gauss's rule, which is exact to degree 2s − 1. So a step is a finite element
!! whose inner amplitudes are eliminated: by one fewer a coordinate than a step has stages.
module slow_motions
  use constants, only: two_pi
  use elastic_equations, only: deformations_of, functions_of, mass_force, slopes_of, &
    strain_rates, times_mass, times_swap
  use errors, only: error_of_numerics, error_t, set_error
  use fast_followers, only: add_followers, follower_products, frozen_stiffness
  use fourier_transform, only: close_fourier, coefficients_of, derivatives, fourier_plan_t, &
    open_fourier, resample, resampled, shifted, values_of
  use gauss_collocation, only: collocation_t, new_collocation
  use kinds, only: wp
  use lapack, only: dgeev, dgetrf, dgetrs
  use legendre, only: legendre_values
  use load_cases, only: constant_case
  use piece_motions, only: add_convection, scale_share
  use row_products, only: add_products, gather, products_of_rows, scatter, together
  use sorting, only: ascending_order
  use strain_dampings, only: damping_t, is_damped, shares_of
  use text, only: to_string
  use turn_grids, only: moves, rate_case, turn_grid_t
  implicit none (type, external)
  private

  public :: slow_basis_t, new_slow_basis, slow_motion_t, new_slow_motion, solve_slow, &
    slow_count, own_squares, fast_squares, slow_mode_t, slow_modes, slow_mode_shape, &
    solve_slow_shifted, &
    frozen_matrices, add_shape_frequencies

  !> Subspace iterations at most: the error of the lowest frequencies falls by the square of the
  !! ratio of frequencies each time. Where deformations change places over the turn, slow ones
  !! becoming fast, each iteration makes them do so within fewer degrees: beyond the first, one
  !! whose highest quarter of the harmonics has more than this share of X is not made.
  integer, parameter :: iterations = 3
  real(wp), parameter :: unresolved = 5.0e-3_wp

  !> Of a column at least this share of its square is left beside those before, or it is made
  !! perpendicular again.
  real(wp), parameter :: enough_left = 1.0e-3_wp

  !> Free motions that grow by more than this in a turn leave no digits of a periodic one; within
  !! the turn they may grow until numbers nearly overflow.
  real(wp), parameter :: most_growth = 1.0e12_wp, near_overflow = 1.0e100_wp

  !> The slow coordinates over the turn, for any speed.
  type :: slow_basis_t
    integer :: number = 0
    real(wp), allocatable :: shape(:, :, :)       !! (samples, unknowns, number) X, whose columns
                                                  !! are perpendicular and as long as 1
    real(wp), allocatable :: square(:)            !! (unknowns) 1/ω² of the other deformations by
                                                  !! themselves; 0 of the slow ones [s²]
    !> (samples of the coarse grid, number², matrices) in the order of `of_mass` to `of_drift`
    real(wp), allocatable :: sums(:, :, :)
    !> (5 number, 5 number, samples of the coarse grid) of the fast deformations that follow; not
    !! there where they are left out
    real(wp), allocatable :: products(:, :, :)
    real(wp), allocatable :: mass(:, :)           !! (samples, number²) M, with the followers only
  end type slow_basis_t

  integer, parameter :: of_mass = 1      !! M
  integer, parameter :: of_g = 2         !! G
  integer, parameter :: of_w = 3         !! W
  integer, parameter :: of_speed = 4     !! XᵀK_GX per ω2²
  integer, parameter :: of_loads = 5     !! XᵀK_GX of the constant loads
  integer, parameter :: of_slope = 6     !! G'
  integer, parameter :: of_rate = 7      !! XᵀCX
  integer, parameter :: of_drift = 8     !! XᵀCX', and XᵀK_GX per ω2 of dampers
  integer, parameter :: matrices = 8

  !> Load cases whose axial forces are in K_G, and the sums that have it.
  integer, parameter :: case_of_sum(*) = [1, constant_case, rate_case]
  integer, parameter :: sums_of_cases(*) = [of_speed, of_loads, of_drift]

  !> Steps of the collocation at one speed.
  type :: slow_motion_t
    integer :: number = 0, steps = 0
    type(collocation_t) :: rule
    real(wp) :: scale = 1.0_wp                 !! of momenta
    real(wp), allocatable :: transfer(:, :, :) !! (2 number, 2 number, steps) of coordinates and
                                               !! momenta over a step
    real(wp), allocatable :: inner(:, :, :)    !! (2 number, number × (stages − 1), steps) share of
                                               !! forces on inner amplitudes in those on both ends
    real(wp), allocatable :: share(:, :)       !! (stages, stages + 1) of loads at the stages in
                                               !! forces on inner amplitudes and on both ends
    real(wp), allocatable :: monodromy(:, :)   !! (2 number, 2 number) over the turn
    logical :: grows = .false.                 !! too much in a turn
    real(wp), allocatable :: factor(:, :)      !! of `1 − monodromy`
    integer, allocatable :: pivot(:)
  end type slow_motion_t

  !> A free motion of the slow coordinates, `e^{σ θ} z(θ)`.
  type :: slow_mode_t
    complex(wp) :: exponent = (0.0_wp, 0.0_wp) !! σ, its imaginary part between 0 and 1/2
    complex(wp), allocatable :: start(:)       !! (2 number) coordinates and momenta at the first
                                               !! crank angle
    logical :: is_complex = .false.            !! its conjugate is another
    real(wp) :: frequency = 0.0_wp             !! of the shape there, `√(zᴴz/zᴴM z)` [rad/s]
    real(wp) :: shape_frequency = 0.0_wp       !! over the turn, `√(∮zᴴz/∮zᴴM z)` [rad/s]
    real(wp) :: action = 0.0_wp                !! about 1 or −1 by the Krein signature, 0 at
                                               !! collisions
  end type slow_mode_t

contains

  !> Number of slow coordinates: deformations whose own frequency is below a limit, and one more; at
  !! least three, so that the slowest of all are found well.
  pure function slow_count(grid, limit) result(number)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: limit !! [rad/s]
    integer :: number

    number = min(grid%unknowns, max(3, count(own_squares(grid)*limit**2 > 1.0_wp) + 1))
  end function slow_count

  !> 1/ω² of every deformation by itself, 0 of the slow ones [s²].
  pure function fast_squares(grid, number) result(square)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: number !! of slow coordinates
    real(wp) :: square(grid%unknowns)

    integer, allocatable :: order(:)

    square = own_squares(grid)
    order = ascending_order(-square)
    square(order(:number)) = 0.0_wp
  end function fast_squares

  !> 1/ω² of every deformation by itself [s²]; those of the border from the mean of M over the turn.
  pure function own_squares(grid) result(square)
    type(turn_grid_t), intent(in) :: grid
    real(wp) :: square(grid%unknowns)

    integer :: b, i, j, k

    square = 0.0_wp
    do b = 1, size(grid%integrals)
      associate (mass => grid%integrals(b)%mass, link => grid%model%links(b))
        if (moves(grid, b)) then
          call add_squares_of_piece(grid, b, square)
          cycle
        end if
        do k = 1, grid%border
          do j = 1, grid%integrals(b)%chord
            do i = 1, grid%integrals(b)%chord
              square(k) = square(k) + mass(i, j)*sum(grid%chord(:, i, k, b)*grid%chord(:, j, k, &
                b))/grid%samples
            end do
          end do
        end do
        square(grid%first(b):grid%first(b) + link%modes - 1) = link%square
        square(grid%first_along(b):grid%first_along(b) + link%axial_modes - 1) = link%axial_square
      end associate
    end do
    do b = 1, size(grid%pin_mass)
      do k = 1, grid%border
        square(k) = square(k) + grid%pin_mass(b)*sum(grid%pin(:, :, b, k)**2)/grid%samples
      end do
    end do
  end function own_squares

  !> Those of a piece whose length changes, from the mean of M over the turn.
  pure subroutine add_squares_of_piece(grid, b, square)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b
    real(wp), intent(inout) :: square(:)

    real(wp) :: y(grid%samples, grid%unknowns), q(grid%samples, grid%integrals(b)%chord + &
      grid%integrals(b)%own)
    integer :: k

    do k = 1, grid%unknowns
      if (k > grid%border .and. grid%owner(k) /= b) cycle
      y = 0.0_wp
      y(:, k) = 1.0_wp
      q = functions_of(grid, b, y)
      square(k) = square(k) + sum(q*times_mass(grid, b, q))/grid%samples
    end do
  end subroutine add_squares_of_piece

  !> Makes the slow coordinates and their matrices over the turn, on a coarse grid: both change
  !! slowly over the turn.
  !!
  !! Errors: the slow deformations do not determine the slow coordinates at some crank angle.
  subroutine new_slow_basis(coarse, coarse_plan, plan, number, damping, basis, error, followers)
    type(turn_grid_t), intent(in) :: coarse          !! few samples
    type(fourier_plan_t), intent(in) :: coarse_plan  !! for these
    type(fourier_plan_t), intent(in) :: plan         !! for the samples wanted
    integer, intent(in) :: number                    !! of slow coordinates
    type(damping_t), intent(in) :: damping           !! see `damping_of`
    type(slow_basis_t), intent(out) :: basis
    type(error_t), allocatable, intent(out) :: error !! why there are none
    logical, intent(in), optional :: followers       !! the fast deformations follow the slow
                                                     !! motion; absent: they are left out

    real(wp), allocatable :: shape(:, :, :)
    integer, allocatable :: order(:)
    integer :: i

    basis%number = number
    basis%square = fast_squares(coarse, number)
    order = ascending_order(-own_squares(coarse))
    call find_shapes(coarse, coarse_plan, order(:number), shape, error)
    if (allocated(error)) return
    call find_matrices(coarse, coarse_plan, shape, basis%sums)
    call derivatives(coarse_plan, basis%sums(:, :, of_g), basis%sums(:, :, of_slope))
    if (is_damped(damping)) call add_damping(coarse, coarse_plan, damping, shape, basis%sums)
    if (present(followers)) then
      if (followers) call add_what_follows
    end if
    allocate (basis%shape(plan%samples, coarse%unknowns, number))
    do i = 1, number
      call resample(coarse_plan, shape(:, :, i), plan, basis%shape(:, :, i))
    end do

  contains

    subroutine add_what_follows
      if (number < coarse%unknowns .and. .not. allocated(coarse%pieces)) call &
        follower_products(coarse, coarse_plan, shape, basis%products)
      allocate (basis%mass(plan%samples, number**2))
      call resample(coarse_plan, basis%sums(:, :, of_mass), plan, basis%mass)
    end subroutine add_what_follows

  end subroutine new_slow_basis

  !> Adds XᵀCX and XᵀCX'.
  subroutine add_damping(grid, plan, damping, shape, sums)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(damping_t), intent(in) :: damping
    real(wp), intent(in) :: shape(:, :, :)
    real(wp), intent(inout) :: sums(:, :, :)

    real(wp), allocatable :: w(:, :, :)
    integer :: i

    if (allocated(grid%pieces)) then
      call add_strain_products(grid, plan, damping, shape, sums)
      return
    end if
    if (.not. allocated(grid%weighted)) then
      call add_damped_products(plan, damping%c, shape, sums)
      return
    end if
    call add_damped_products(plan, damping%c(grid%border + 1:grid%unknowns), &
      shape(:, grid%border + 1:, :), sums)
    allocate (w(grid%samples, size(grid%weighted, 2), size(shape, 3)))
    do i = 1, size(shape, 3)
      w(:, :, i) = deformations_of(grid, shape(:, :, i))
    end do
    call add_damped_products(plan, damping%c(grid%unknowns + 1:), w, sums)
  end subroutine add_damping

  !> The same of strains that move through pieces with their material: of the roots of their shares.
  subroutine add_strain_products(grid, plan, damping, shape, sums)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(damping_t), intent(in) :: damping
    real(wp), intent(in) :: shape(:, :, :)
    real(wp), intent(inout) :: sums(:, :, :)

    real(wp) :: first(size(shape, 1), size(shape, 2))
    real(wp), allocatable :: w(:, :), w_rates(:, :), rates(:, :), strain(:, :, :), slope(:, :, :), &
      share(:, :)
    integer :: before, deformations, i, own, n

    own = grid%border + 1
    n = grid%unknowns
    do i = 1, size(shape, 3)
      call derivatives(plan, shape(:, :, i), first)
      call strain_rates(grid, plan, shape(:, :, i), first, w, w_rates, rates)
      deformations = size(w, 2)
      if (i == 1) then
        allocate (strain(size(shape, 1), deformations + n - grid%border, size(shape, 3)))
        allocate (slope, mold=strain)
      end if
      strain(:, :deformations, i) = w
      strain(:, deformations + 1:, i) = shape(:, own:, i)
      slope(:, :deformations, i) = w_rates
      slope(:, deformations + 1:, i) = rates(:, own:)
    end do
    before = merge(n, 0, allocated(grid%weighted))
    share = sqrt(shares_of(grid, damping, 1, size(damping%c)))
    share = reshape([share(:, before + 1:before + deformations), share(:, own:n)], &
      [size(strain, 1), size(strain, 2)])
    do i = 1, size(shape, 3)
      strain(:, :, i) = share*strain(:, :, i)
      slope(:, :, i) = share*slope(:, :, i)
    end do
    call add_damped_products(plan, [damping%c(before + 1:before + deformations), &
      damping%c(own:n)], strain, sums, slope)
  end subroutine add_strain_products

  !> Adds those of some motions with constant damping each.
  subroutine add_damped_products(plan, damping, shape, sums, rates)
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: damping(:)
    real(wp), intent(in) :: shape(:, :, :) !! (samples, motions, number)
    real(wp), intent(inout) :: sums(:, :, :)
    real(wp), intent(in), optional :: rates(:, :, :) !! of the motions; absent: their derivatives

    real(wp), allocatable :: damped(:, :, :), slope(:, :, :)
    integer :: i, j

    allocate (damped, slope, mold=shape)
    do j = 1, size(shape, 3)
      if (present(rates)) then
        slope(:, :, j) = rates(:, :, j)
      else
        call derivatives(plan, shape(:, :, j), slope(:, :, j))
      end if
      do i = 1, size(damping)
        damped(:, i, j) = damping(i)*shape(:, i, j)
        slope(:, i, j) = damping(i)*slope(:, i, j)
      end do
    end do
    call add_products(shape, damped, sums(:, :, of_rate))
    call add_products(shape, slope, sums(:, :, of_drift))
  end subroutine add_damped_products

  !> X from subspace iterations on the mass matrix, as many as the samples resolve.
  subroutine find_shapes(grid, plan, slow, shape, error)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan           !! for its samples
    integer, intent(in) :: slow(:)                     !! numbers of the slow deformations
    real(wp), allocatable, intent(out) :: shape(:, :, :) !! (samples, unknowns, number)
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: next(:, :, :)
    integer :: i, k

    allocate (shape(grid%samples, grid%unknowns, size(slow)), source=0.0_wp)
    do i = 1, size(slow)
      shape(:, slow(i), i) = 1.0_wp
    end do
    do k = 1, iterations
      allocate (next, mold=shape)
      do i = 1, size(slow)
        call mass_force(grid, shape(:, :, i), next(:, :, i))
      end do
      call normalise(slow, next, error)
      if (allocated(error)) exit
      if (k > 1 .and. .not. is_resolved(plan, next)) exit
      call move_alloc(next, shape)
    end do
    if (k > 1 .and. allocated(error)) deallocate (error)
  end subroutine find_shapes

  !> Whether the samples resolve X.
  function is_resolved(plan, shape) result(yes)
    type(fourier_plan_t), intent(in) :: plan !! for the samples
    real(wp), intent(in) :: shape(:, :, :)   !! (samples, unknowns, number)
    logical :: yes

    real(wp) :: coefficients(size(shape, 1), size(shape, 2))
    integer :: i, n

    n = size(shape, 1)
    yes = .true.
    do i = 1, size(shape, 3)
      call coefficients_of(plan, shape(:, :, i), coefficients)
      yes = yes .and. norm2(coefficients(n - n/4:, :)) <= unresolved*norm2(coefficients)
    end do
  end function is_resolved

  !> M, G, W and XᵀK_GX of the slow coordinates.
  subroutine find_matrices(grid, plan, shape, sums)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: shape(:, :, :)
    real(wp), allocatable, intent(out) :: sums(:, :, :) !! (samples, number², matrices), zero where
                                                        !! they are none of these

    real(wp), allocatable :: first(:, :, :), q(:, :, :)
    integer :: b, i, n, number

    n = grid%samples
    number = size(shape, 3)
    allocate (sums(n, number**2, matrices))
    sums = 0.0_wp
    do b = 1, size(grid%integrals)
      associate (integrals => grid%integrals(b))
        allocate (q(n, integrals%chord + integrals%own, number))
        allocate (first, mold=q)
        do i = 1, number
          q(:, :, i) = functions_of(grid, b, shape(:, :, i))
          call derivatives(plan, q(:, :, i), first(:, :, i))
          call add_convection(grid, b, q(:, :, i), first(:, :, i))
        end do
        call add_body(grid, b, q, first, sums)
        deallocate (q, first)
      end associate
    end do
    call add_pins(grid, plan, shape, sums)
    do b = 1, size(grid%integrals)
      call add_axial(grid, b, shape, sums)
    end do
    if (allocated(grid%second_order)) call add_second_order(grid, shape, sums)
  end subroutine find_matrices

  !> Adds what K_G has between border unknowns alone to XᵀK_GX.
  pure subroutine add_second_order(grid, shape, sums)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: shape(:, :, :)
    real(wp), intent(inout) :: sums(:, :, :)

    real(wp) :: pushed(size(shape, 1), grid%border, size(shape, 3))
    integer :: c, j, k

    do c = 1, size(sums_of_cases)
      if (case_of_sum(c) > grid%cases) cycle
      do j = 1, size(shape, 3)
        do k = 1, grid%border
          pushed(:, k, j) = products_of_rows(grid%second_order(:, k, :, case_of_sum(c)), &
            shape(:, :grid%border, j))
        end do
      end do
      call add_products(shape(:, :grid%border, :), pushed, sums(:, :, sums_of_cases(c)))
    end do
  end subroutine add_second_order

  !> Adds what the axial forces of a body contribute to XᵀK_GX.
  pure subroutine add_axial(grid, b, shape, sums)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b
    real(wp), intent(in) :: shape(:, :, :)
    real(wp), intent(inout) :: sums(:, :, :)

    real(wp) :: slope(size(shape, 1), size(grid%model%links(b)%geometric, 1), size(shape, 3))
    real(wp) :: pulled(size(slope, 1), size(slope, 2), size(slope, 3), size(sums_of_cases))
    real(wp) :: bent(size(slope, 1), size(slope, 2))
    integer :: c, i, j, k

    pulled = 0.0_wp
    do j = 1, size(shape, 3)
      slope(:, :, j) = slopes_of(grid, b, shape(:, :, j))
      do k = 1, size(grid%model%links(b)%geometric, 3)
        bent = matmul(slope(:, :, j), grid%model%links(b)%geometric(:, :, k))
        call scale_share(grid, b, bent)
        do c = 1, size(sums_of_cases)
          if (case_of_sum(c) > grid%cases) cycle
          do i = 1, size(bent, 2)
            pulled(:, i, j, c) = pulled(:, i, j, c) + grid%force(:, k, b, case_of_sum(c))*bent(:, i)
          end do
        end do
      end do
    end do
    do c = 1, size(sums_of_cases)
      if (case_of_sum(c) <= grid%cases) call add_products(slope, pulled(:, :, :, c), &
        sums(:, :, sums_of_cases(c)))
    end do
  end subroutine add_axial

  !> X that changes smoothly over the turn: of all of its space that whose slow rows are the unit
  !! matrix, then each column made perpendicular to those before and as long as 1. Where a slow row
  !! has hardly any part in the space, such as that of a piece of a link that is very short there,
  !! columns would else become long within few degrees.
  subroutine normalise(slow, shape, error)
    integer, intent(in) :: slow(:)
    real(wp), intent(inout) :: shape(:, :, :) !! (samples, unknowns, number)
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: some(:, :, :)
    integer :: first, k, last

    allocate (some(size(shape, 2), size(shape, 3), together))
    do first = 1, size(shape, 1), together
      last = min(first + together - 1, size(shape, 1))
      call gather(shape, first, last, some)
      do k = 1, last - first + 1
        call normalise_one(slow, some(:, :, k))
      end do
      call scatter(some, first, last, shape)
    end do
    if (.not. all(abs(shape) <= huge(1.0_wp))) call set_error(error, error_of_numerics, &
      "the slow vibrations cannot be told from the fast ones")
  end subroutine normalise

  !> The same at one crank angle.
  subroutine normalise_one(slow, x)
    integer, intent(in) :: slow(:)
    real(wp), intent(inout) :: x(:, :) !! (unknowns, number)

    real(wp) :: scaling(size(x, 2), size(x, 2)), turned(size(x, 2), size(x, 1)), least
    integer :: i

    call invert(x(slow, :), scaling)
    x = matmul(x, scaling)
    ! Columns of which little is left beside those before are perpendicular after a second time.
    do i = 1, 2
      ! Products of transposes that are not copies take twice the time.
      turned = transpose(x)
      least = huge(least)
      call find_perpendicular(matmul(turned, x), scaling, least)
      x = matmul(x, scaling)
      if (least > enough_left) exit
    end do
  end subroutine normalise_one

  !> Columns A so that those of X A are perpendicular and as long as 1, each of those of X up to its
  !! own: Gram and Schmidt's, from XᵀX.
  pure subroutine find_perpendicular(product, a, least)
    real(wp), intent(in) :: product(:, :)  !! XᵀX
    real(wp), intent(out) :: a(:, :)
    real(wp), intent(inout) :: least       !! share of the square of a column that is left, if less

    real(wp) :: image(size(a, 1), size(a, 1)), share
    integer :: i, j

    a = 0.0_wp
    image = product
    do i = 1, size(a, 1)
      a(i, i) = 1.0_wp
      do j = 1, i - 1
        share = dot_product(a(:j, j), image(:j, i))
        a(:j, i) = a(:j, i) - share*a(:j, j)
        image(:, i) = image(:, i) - share*image(:, j)
      end do
      share = dot_product(a(:i, i), image(:i, i))
      least = min(least, share/product(i, i))
      share = sqrt(share)
      a(:i, i) = a(:i, i)/share
      image(:, i) = image(:, i)/share
    end do
  end subroutine find_perpendicular

  !> Inverse of a small matrix.
  subroutine invert(matrix, inverse)
    real(wp), intent(in) :: matrix(:, :)
    real(wp), intent(inout) :: inverse(:, :)

    real(wp) :: factor(size(matrix, 1), size(matrix, 1)), right(size(matrix, 1), size(matrix, 1))
    integer :: pivot(size(matrix, 1)), i, n, info

    n = size(matrix, 1)
    factor = matrix
    right = 0.0_wp
    do i = 1, n
      right(i, i) = 1.0_wp
    end do
    call dgetrf(n, n, factor, n, pivot, info)
    call dgetrs("N", n, n, factor, n, pivot, right, n, info)
    inverse = right
  end subroutine invert

  !> Adds what a body contributes to M, G and W of the slow coordinates.
  pure subroutine add_body(grid, b, q, first, sums)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: b
    real(wp), intent(in) :: q(:, :, :), first(:, :, :) !! (samples, functions, number) Q, Q'
    real(wp), intent(inout) :: sums(:, :, :)

    !> Forces of the motion itself, of its velocity, and what the velocity of the frame adds
    real(wp), dimension(size(q, 1), size(q, 2), size(q, 3)) :: moved, pushed, swept
    real(wp), dimension(size(q, 1), size(q, 2)) :: turned, turned_first
    integer :: i, j

    associate (integrals => grid%integrals(b), h => grid%rate(:, b))
      do j = 1, size(q, 3)
        moved(:, :, j) = times_mass(grid, b, q(:, :, j))
        pushed(:, :, j) = times_mass(grid, b, first(:, :, j))
        turned = times_swap(grid, b, q(:, :, j))
        turned_first = times_swap(grid, b, first(:, :, j))
        swept(:, :, j) = moved(:, :, j)
        if (size(integrals%rotary) > 0) swept(:, :, j) = moved(:, :, j) - matmul(q(:, :, j), &
          integrals%rotary)
        do i = 1, size(q, 2)
          pushed(:, i, j) = pushed(:, i, j) - h*turned(:, i)
          swept(:, i, j) = h*turned_first(:, i) + h**2*swept(:, i, j)
        end do
      end do
    end associate
    call add_products(q, moved, sums(:, :, of_mass))
    call add_products(q, pushed, sums(:, :, of_g))
    call add_products(first, pushed, sums(:, :, of_w))
    call add_products(q, swept, sums(:, :, of_w))
  end subroutine add_body

  !> Adds what masses at pins contribute.
  subroutine add_pins(grid, plan, shape, sums)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: shape(:, :, :)
    real(wp), intent(inout) :: sums(:, :, :)

    real(wp) :: motion(size(shape, 1), 2, size(shape, 3)), first(size(shape, 1), 2, size(shape, 3))
    integer :: i, j, k, p

    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      motion = 0.0_wp
      do i = 1, size(shape, 3)
        do j = 1, grid%border
          do k = 1, 2
            motion(:, k, i) = motion(:, k, i) + grid%pin(:, k, p, j)*shape(:, j, i)
          end do
        end do
        call derivatives(plan, motion(:, :, i), first(:, :, i))
      end do
      motion = sqrt(grid%pin_mass(p))*motion
      first = sqrt(grid%pin_mass(p))*first
      call add_products(motion, motion, sums(:, :, of_mass))
      call add_products(motion, first, sums(:, :, of_g))
      call add_products(first, first, sums(:, :, of_w))
    end do
  end subroutine add_pins

  !> Steps of the collocation at a speed, as many as samples.
  !!
  !! Errors: a multiplier of the slow motion is 1 (resonance); it grows too much in a turn, and the
  !! monodromy matrix is not finished.
  subroutine new_slow_motion(plan, basis, speed, stages, motion, error)
    type(fourier_plan_t), intent(in) :: plan !! for its samples
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    integer, intent(in) :: stages !! of a step
    type(slow_motion_t), intent(out) :: motion
    type(error_t), allocatable, intent(out) :: error !! why it cannot be closed

    integer :: i, k, m, n, info

    n = plan%samples
    m = basis%number
    motion%number = m
    motion%steps = n
    motion%rule = new_collocation(stages)
    allocate (motion%transfer(2*m, 2*m, n), motion%inner(2*m, m*(stages - 1), n))
    call make_steps(basis, speed, motion)
    motion%monodromy = motion%transfer(:, :, 1)
    do k = 2, n
      motion%monodromy = matmul(motion%transfer(:, :, k), motion%monodromy)
      motion%grows = .not. maxval(abs(motion%monodromy)) <= merge(most_growth, near_overflow, &
        k == n)
      if (.not. motion%grows) cycle
      call set_error(error, error_of_numerics, "free vibrations seem to grow by a factor above "// &
        "10^"//to_string(nint(log10(most_growth)))//" in a turn: the linkage is unstable, or "// &
        "its slowest motions alone do not show how it vibrates")
      return
    end do
    motion%factor = -motion%monodromy
    do i = 1, 2*m
      motion%factor(i, i) = 1.0_wp + motion%factor(i, i)
    end do
    allocate (motion%pivot(2*m))
    call dgetrf(2*m, 2*m, motion%factor, 2*m, motion%pivot, info)
    if (info /= 0) call set_error(error, error_of_numerics, &
      "resonance: the slow motion has a multiplier of 1")
  end subroutine new_slow_motion

  !> All steps. Their matrices are functions of the crank angle, too: those of steps that are evenly
  !! spaced come from short transforms.
  subroutine make_steps(basis, speed, motion)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed
    type(slow_motion_t), intent(inout) :: motion !! with its rule

    type(fourier_plan_t) :: plan
    complex(wp), allocatable :: series(:, :, :, :), turned(:)
    real(wp), allocatable :: coefficients(:, :), values(:, :), forms(:, :, :, :)
    logical :: symmetric
    integer :: apart, e, first, i, j, k, n, together, trials

    trials = size(motion%rule%node) + 1
    symmetric = .not. any(abs(basis%sums(:, :, of_rate)) > 0.0_wp)
    call find_forms(basis, speed, symmetric, motion, series)
    n = 2*ubound(series, 1)
    apart = 1
    do i = 2, motion%steps/n
      if (modulo(motion%steps, 2*i) == 0) apart = i
    end do
    together = motion%steps/apart
    allocate (coefficients(together, size(series, 2)), values(together, size(series, 2)), &
      source=0.0_wp)
    allocate (forms(size(series, 2), trials, trials, together))
    call open_fourier(together, plan)
    do first = 1, apart
      turned = [(exp(cmplx(0.0_wp, two_pi*k*(first - 1)/motion%steps, wp)), k=0, n/2)]
      do j = 1, trials
        do i = 1, merge(j, trials, symmetric)
          do e = 1, size(series, 2)
            call take(turned*series(:, e, i, j), coefficients(:, e))
          end do
          call values_of(plan, coefficients, values)
          forms(:, i, j, :) = transpose(values)
        end do
      end do
      do k = 1, together
        call make_step(motion, first + (k - 1)*apart, symmetric, trials, forms(:, :, :, k))
      end do
    end do
    call close_fourier(plan)

  contains

    pure subroutine take(harmonic, coefficients)
      complex(wp), intent(in) :: harmonic(0:)
      real(wp), intent(inout) :: coefficients(:)

      coefficients(1) = real(harmonic(0))
      coefficients(2:n:2) = real(harmonic(1:))
      coefficients(3:n - 1:2) = aimag(harmonic(1:n/2 - 1))
      ! The highest harmonic is shared by +n/2 and −n/2.
      if (together > n) coefficients(n:n + 1) = 0.5_wp*[real(harmonic(n/2)), aimag(harmonic(n/2))]
    end subroutine take

  end subroutine make_steps

  !> Series of the matrices H of a step from any crank angle on, by pairs of trial functions of its
  !! polynomials. With forces f, `Σ H_ij Z_j + f_i` is 0 for inner amplitudes, less the momentum for
  !! the start, the momentum for the end. Trial functions are integrals of Legendre's polynomials
  !! for inner amplitudes, then those of the start and of the end.
  subroutine find_forms(basis, speed, symmetric, motion, series)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed
    logical, intent(in) :: symmetric             !! only H_ij with i ≤ j
    type(slow_motion_t), intent(inout) :: motion !! gets shares of loads and the scale of momenta
    complex(wp), allocatable, intent(out) :: series(:, :, :, :) !! (harmonics from 0, number², i, j)

    real(wp), dimension(size(motion%rule%node), size(motion%rule%node) + 1) :: value, slope
    real(wp) :: p(0:size(motion%rule%node)), h
    real(wp), allocatable :: total(:, :, :)
    !> M, G, Gᵀ − C, V; of the stages, and what pairs take of these matrices
    complex(wp), allocatable :: matrix(:, :, :), wave(:, :), weight(:, :)
    integer, allocatable :: turned(:)
    integer :: e, i, j, k, m, n, s

    m = basis%number
    s = size(motion%rule%node)
    n = min(size(basis%sums, 1), motion%steps)
    h = two_pi/motion%steps
    do i = 1, s
      associate (x => motion%rule%node(i))
        p = legendre_values(s, 2.0_wp*x - 1.0_wp)
        value(i, :) = [((p(j + 1) - p(j - 1))/(4*j + 2), j=1, s - 1), 1.0_wp - x, x]
        slope(i, :) = [(p(j), j=1, s - 1), -1.0_wp, 1.0_wp]/h
      end associate
    end do
    motion%share = h*spread(motion%rule%weight, 2, s + 1)*value
    call matrices_at_speed(basis, speed, n, total)
    motion%scale = sqrt(sum(abs(total(1, 1::m + 1, 1)))/m)/abs(speed)
    allocate (matrix(0:n/2, m**2, 4), series(0:n/2, m**2, s + 1, s + 1))
    matrix(0, :, :) = total(1, :, :)
    do k = 1, n/2 - 1
      matrix(k, :, :) = cmplx(total(2*k, :, :), total(2*k + 1, :, :), wp)
    end do
    matrix(n/2, :, :) = total(n, :, :)
    turned = [transpose(reshape([(e, e=1, m**2)], [m, m]))]
    matrix = matrix(:, :, [1, 2, 4, 3])
    matrix(:, :, 3) = matrix(:, turned, 2) - matrix(:, :, 3)
    wave = reshape([((exp(cmplx(0.0_wp, k*h*motion%rule%node(i), wp)), k=0, n/2), i=1, s)], &
      [n/2 + 1, s])
    do j = 1, s + 1
      do i = 1, merge(j, s + 1, symmetric)
        weight = matmul(wave, h*spread(motion%rule%weight, 2, 4)*reshape([slope(:, i)*slope(:, j), &
          slope(:, i)*value(:, j), value(:, i)*slope(:, j), value(:, i)*value(:, j)], [s, 4]))
        do e = 1, m**2
          series(:, e, i, j) = weight(:, 1)*matrix(:, e, 1) + weight(:, 2)*matrix(:, e, 2) + &
            weight(:, 3)*matrix(:, e, 3) + weight(:, 4)*matrix(:, e, 4)
        end do
      end do
    end do
  end subroutine find_forms

  !> Coefficients of M, G, W − K/ω² − XᵀCX'/ω and XᵀCX/ω.
  subroutine matrices_at_speed(basis, speed, samples, total)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed
    integer, intent(in) :: samples                       !! of the motion
    real(wp), allocatable, intent(out) :: total(:, :, :) !! (samples, number², 4)

    type(fourier_plan_t) :: plan
    real(wp) :: at_sample(basis%number, basis%number, 5), coefficients(size(basis%sums, 1), &
      size(basis%sums, 2))
    real(wp), allocatable :: values(:, :, :)
    integer :: c, k, m, n

    m = basis%number
    n = size(basis%sums, 1)
    allocate (values(n, m**2, 4), total(samples, m**2, 4))
    associate (sums => basis%sums)
      values(:, :, 1:2) = sums(:, :, [of_mass, of_g])
      values(:, :, 3) = sums(:, :, of_w) - sums(:, :, of_speed) - sums(:, :, of_loads)/speed**2 - &
        sums(:, :, of_drift)/speed
      values(:, 1::m + 1, 3) = values(:, 1::m + 1, 3) - 1.0_wp/speed**2
      values(:, :, 4) = sums(:, :, of_rate)/speed
      if (allocated(basis%products)) then
        do k = 1, n
          at_sample(:, :, :4) = reshape(values(k, :, :), [m, m, 4])
          at_sample(:, :, 5) = reshape(sums(k, :, of_slope), [m, m])
          call add_followers(basis%products(:, :, k), speed, at_sample(:, :, 5), &
            at_sample(:, :, 4), at_sample(:, :, 1), at_sample(:, :, 2), at_sample(:, :, 3))
          values(k, :, :3) = reshape(at_sample(:, :, :3), [m**2, 3])
        end do
      end if
    end associate
    call open_fourier(n, plan)
    do c = 1, 4
      call coefficients_of(plan, values(:, :, c), coefficients)
      total(:, :, c) = resampled(coefficients, samples)
    end do
    call close_fourier(plan)
  end subroutine matrices_at_speed

  !> Mass, stiffness and damping matrix of the linkage frozen at a sample of the coarse grid, under
  !! the axial forces of a speed.
  pure subroutine frozen_matrices(basis, speed, sample, mass, stiffness, damping, alone)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed               !! ω2 [rad/s]
    integer, intent(in) :: sample
    real(wp), intent(out) :: mass(:, :)         !! (number, number) [s²]
    real(wp), intent(out) :: stiffness(:, :)    !! (number, number)
    real(wp), intent(out), optional :: damping(:, :) !! (number, number) of the slow coordinates [s]
    logical, intent(in), optional :: alone      !! without followers; absent: with them

    logical :: follow
    integer :: i

    follow = allocated(basis%products)
    if (present(alone)) follow = follow .and. .not. alone
    associate (sums => basis%sums(sample, :, :), m => basis%number)
      if (present(damping)) damping = reshape(sums(:, of_rate), [m, m])
      mass = reshape(sums(:, of_mass), [m, m])
      stiffness = reshape(speed**2*sums(:, of_speed) + sums(:, of_loads), [m, m])
    end associate
    do i = 1, basis%number
      stiffness(i, i) = stiffness(i, i) + 1.0_wp
    end do
    if (follow) stiffness = stiffness - frozen_stiffness(basis%products(:, :, sample), speed, &
      mass, stiffness)
  end subroutine frozen_matrices

  !> One step: its inner amplitudes are eliminated, then it gives coordinates and momenta at its end
  !! from those at its start.
  pure subroutine make_step(motion, step, symmetric, trials, forms)
    type(slow_motion_t), intent(inout) :: motion
    integer, intent(in) :: step
    logical, intent(in) :: symmetric !! forms are there with i ≤ j
    integer, intent(in) :: trials    !! trial functions
    real(wp), intent(in) :: forms(motion%number, motion%number, trials, trials)

    real(wp) :: form(motion%number*trials, motion%number*trials)
    real(wp) :: inner(motion%number*(trials - 2), motion%number*trials)
    real(wp) :: ends(2*motion%number, 2*motion%number), after(motion%number, 3*motion%number)
    integer :: i, j, m, n

    m = motion%number
    n = m*(trials - 2)
    do j = 1, trials
      do i = 1, merge(j, trials, symmetric)
        form((i - 1)*m + 1:i*m, (j - 1)*m + 1:j*m) = forms(:, :, i, j)
        if (symmetric .and. i < j) form((j - 1)*m + 1:j*m, (i - 1)*m + 1:i*m) = &
          transpose(forms(:, :, i, j))
      end do
    end do
    inner = transpose(form(:, :n))
    call divide(n, m*trials, inner)
    associate (transfer => motion%transfer(:, :, step), pushed => motion%inner(:, :, step), &
      scale => motion%scale)
      pushed = transpose(inner(:, n + 1:))
      ends = form(n + 1:, n + 1:) - matmul(pushed, form(:n, n + 1:))
      after(:, :m) = -ends(:m, m + 1:)
      after(:, m + 1:2*m) = ends(:m, :m)
      after(:, 2*m + 1:) = 0.0_wp
      do i = 1, m
        after(i, 2*m + i) = scale
      end do
      call divide(m, 3*m, after)
      transfer(:m, :) = after(:, m + 1:)
      transfer(m + 1:, :) = matmul(ends(m + 1:, m + 1:), after(:, m + 1:))/scale
      transfer(m + 1:, :m) = transfer(m + 1:, :m) + ends(m + 1:, :m)/scale
    end associate
  end subroutine make_step

  !> Replaces B by `A⁻¹ B`, with exchanges of rows. Products of large parts take less time than
  !! column after column.
  pure subroutine divide(n, columns, a)
    integer, intent(in) :: n, columns
    real(wp), intent(inout) :: a(n, columns) !! A, then B

    integer, parameter :: together = 24
    real(wp) :: row(columns), left(n)
    integer :: first, j, k, last, p

    do first = 1, n, together
      last = min(first + together - 1, n)
      do k = first, last
        p = k - 1 + maxloc(abs(a(k:, k)), dim=1)
        if (p /= k) then
          row = a(k, :)
          a(k, :) = a(p, :)
          a(p, :) = row
        end if
        left(k + 1:) = a(k + 1:, k)/a(k, k)
        a(k + 1:, k) = left(k + 1:)
        do j = k + 1, last
          a(k + 1:, j) = a(k + 1:, j) - a(k, j)*left(k + 1:)
        end do
      end do
      do k = first, last - 1
        left(k + 1:last) = a(k + 1:last, k)
        do j = last + 1, columns
          a(k + 1:last, j) = a(k + 1:last, j) - a(k, j)*left(k + 1:last)
        end do
      end do
      if (last < n) a(last + 1:, last + 1:) = a(last + 1:, last + 1:) - &
        matmul(a(last + 1:, first:last), a(first:last, last + 1:))
    end do
    do first = together*((n - 1)/together) + 1, 1, -together
      last = min(first + together - 1, n)
      do k = last, first, -1
        left(first:k - 1) = a(first:k - 1, k)
        do j = n + 1, columns
          a(k, j) = a(k, j)/a(k, k)
          a(first:k - 1, j) = a(first:k - 1, j) - a(k, j)*left(first:k - 1)
        end do
      end do
      if (first > 1) a(:first - 1, n + 1:) = a(:first - 1, n + 1:) - &
        matmul(a(:first - 1, first:last), a(first:last, n + 1:))
    end do
  end subroutine divide

  !> The periodic slow motion under a load.
  subroutine solve_slow(plan, motion, load, z)
    type(fourier_plan_t), intent(in) :: plan
    type(slow_motion_t), intent(in) :: motion
    real(wp), intent(in) :: load(:, :) !! (samples, number) F per ω2²
    real(wp), intent(out) :: z(:, :)   !! (samples, number)

    real(wp), dimension(size(load, 1), size(load, 2)) :: coefficients, moved
    real(wp) :: force(size(load, 1), size(load, 2), size(motion%share, 2)), &
      push(2*motion%number, size(load, 1)), state(2*motion%number)
    integer :: i, k, m, n, info

    m = motion%number
    n = motion%steps
    call coefficients_of(plan, load, coefficients)
    force = 0.0_wp
    do i = 1, size(motion%rule%node)
      call values_of(plan, shifted(coefficients, motion%rule%node(i)*two_pi/n), moved)
      call add_stage(motion, i, moved, force)
    end do
    push = pushes(motion, force)
    state = 0.0_wp
    do k = 1, n
      state = stepped(k)
    end do
    call dgetrs("N", 2*m, 1, motion%factor, 2*m, motion%pivot, state, 2*m, info)
    do k = 1, n
      z(k, :) = state(:m)
      state = stepped(k)
    end do

  contains

    pure function stepped(k) result(next)
      integer, intent(in) :: k
      real(wp) :: next(2*m)

      next = matmul(motion%transfer(:, :, k), [state(:m), state(m + 1:) + push(:m, k)])
      next(m + 1:) = next(m + 1:) + push(m + 1:, k)
    end function stepped

  end subroutine solve_slow

  !> Adds what loads at a stage are as forces on the trial functions of the steps.
  pure subroutine add_stage(motion, stage, load, force)
    type(slow_motion_t), intent(in) :: motion
    integer, intent(in) :: stage
    real(wp), intent(in) :: load(:, :)        !! (steps, number)
    real(wp), intent(inout) :: force(:, :, :) !! (steps, number, functions)

    integer :: i

    do i = 1, size(force, 3)
      force(:, :, i) = force(:, :, i) + motion%share(stage, i)*load
    end do
  end subroutine add_stage

  !> What forces change of the momenta at the start and at the end of every step.
  pure function pushes(motion, force) result(push)
    type(slow_motion_t), intent(in) :: motion
    real(wp), intent(in) :: force(:, :, :) !! (steps, number, functions)
    real(wp) :: push(2*motion%number, size(force, 1))

    real(wp) :: turned(motion%number*size(force, 3), size(force, 1))
    integer :: k, n

    turned = transpose(reshape(force, [size(force, 1), size(turned, 1)]))
    n = size(motion%inner, 2)
    do k = 1, size(force, 1)
      push(:, k) = (turned(n + 1:, k) - matmul(motion%inner(:, :, k), turned(:n, k)))/motion%scale
    end do
  end function pushes

  !> Free motions, of each pair of conjugate ones that with positive turns.
  !!
  !! Errors: the multipliers do not converge.
  subroutine slow_modes(basis, motion, modes, error)
    type(slow_basis_t), intent(in) :: basis
    type(slow_motion_t), intent(in) :: motion !! of these coordinates
    type(slow_mode_t), allocatable, intent(out) :: modes(:)
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: a(2*motion%number, 2*motion%number), vectors(2*motion%number, 2*motion%number)
    real(wp) :: re(2*motion%number), im(2*motion%number), work(32*motion%number), none(1, 1)
    real(wp) :: mass(motion%number, motion%number)
    integer :: i, m, n, number, info

    m = motion%number
    n = 2*m
    mass = reshape(basis%sums(1, :, of_mass), [m, m])
    a = motion%monodromy
    call dgeev("N", "V", n, a, n, re, im, none, 1, vectors, n, work, size(work), info)
    if (info /= 0 .or. .not. all(hypot(re, im) <= huge(re))) then
      call set_error(error, error_of_numerics, "the multipliers of a turn do not converge")
      return
    end if
    allocate (modes(count(im >= 0.0_wp)))
    number = 0
    do i = 1, n
      if (im(i) < 0.0_wp) cycle
      number = number + 1
      associate (mode => modes(number))
        ! Strong damping leaves nothing of a vibration after a turn: zero has no logarithm.
        mode%exponent = log(cmplx(merge(tiny(re), re(i), hypot(re(i), im(i)) < tiny(re)), im(i), &
          wp))/two_pi
        mode%start = cmplx(vectors(:, i), 0.0_wp, wp)
        mode%is_complex = im(i) > 0.0_wp
        if (mode%is_complex) mode%start = cmplx(vectors(:, i), vectors(:, i + 1), wp)
        associate (z => mode%start(:m))
          ! Where nothing at all is left, vectors may be momenta without displacements.
          mode%frequency = 0.0_wp
          if (any(abs(z) > 0.0_wp)) mode%frequency = sqrt(real(dot_product(z, z))/ &
            real(dot_product(z, matmul(mass, z))))
        end associate
      end associate
    end do
  end subroutine slow_modes

  !> Adds frequencies of shapes over the turn, and actions `ω Im(zᴴp)` over the root of
  !! `∮zᴴz ∮zᴴM z`: without damping the first is the same at all angles.
  pure subroutine add_shape_frequencies(basis, motion, speed, modes)
    type(slow_basis_t), intent(in) :: basis        !! with its followers
    type(slow_motion_t), intent(in) :: motion      !! of these coordinates
    real(wp), intent(in) :: speed                  !! ω2 [rad/s]
    type(slow_mode_t), intent(inout) :: modes(:)

    !> Of all modes, real and imaginary parts: at a step, z there
    real(wp) :: state(2*motion%number, 2, size(modes)), z(motion%number, 2, size(modes))
    real(wp), dimension(motion%number, 2*size(modes)) :: product
    real(wp) :: form(2, size(modes))
    integer :: i, k, m

    m = motion%number
    do i = 1, size(modes)
      state(:, 1, i) = real(modes(i)%start)
      state(:, 2, i) = aimag(modes(i)%start)
    end do
    form = 0.0_wp
    do k = 1, motion%steps
      do i = 1, size(modes)
        z(:, :, i) = parts_of_product(exp(-modes(i)%exponent*two_pi*(k - 1)/motion%steps), &
          state(:m, 1, i), state(:m, 2, i))
      end do
      product = matmul(reshape(basis%mass(k, :), [m, m]), reshape(z, [m, 2*size(modes)]))
      do i = 1, size(modes)
        form(:, i) = form(:, i) + [sum(z(:, :, i)*product(:, 2*i - 1:2*i)), sum(z(:, :, i)**2)]
      end do
      state = reshape(matmul(motion%transfer(:, :, k), reshape(state, [2*m, 2*size(modes)])), &
        shape(state))
    end do
    form = form/motion%steps
    modes%shape_frequency = sqrt(form(2, :)/form(1, :))
    do i = 1, size(modes)
      modes(i)%action = speed*motion%scale*aimag(dot_product(modes(i)%start(:m), &
        modes(i)%start(m + 1:)))/sqrt(form(1, i)*form(2, i))
    end do
  end subroutine add_shape_frequencies

  !> z of a free motion over the turn. That of a mode that fades fast is lost in the rounding of
  !! slower ones.
  pure function slow_mode_shape(motion, mode) result(shape)
    type(slow_motion_t), intent(in) :: motion
    type(slow_mode_t), intent(in) :: mode
    complex(wp) :: shape(motion%steps, motion%number)

    real(wp) :: state(2*motion%number, 2)
    integer :: k

    state(:, 1) = real(mode%start)
    state(:, 2) = aimag(mode%start)
    do k = 1, motion%steps
      shape(k, :) = exp(-mode%exponent*two_pi*(k - 1)/motion%steps)* &
        cmplx(state(:motion%number, 1), state(:motion%number, 2), wp)
      state = matmul(motion%transfer(:, :, k), state)
    end do
  end function slow_mode_shape

  !> The periodic solution z of the slow equation with d/dθ2 + σ in place of d/dθ2, under a complex
  !! load.
  subroutine solve_slow_shifted(plan, motion, exponent, load, load_imaginary, z, z_imaginary)
    type(fourier_plan_t), intent(in) :: plan
    type(slow_motion_t), intent(in) :: motion
    complex(wp), intent(in) :: exponent !! σ, not one of a free motion
    real(wp), intent(in) :: load(:, :), load_imaginary(:, :) !! (samples, number) F per ω2²
    real(wp), intent(out) :: z(:, :), z_imaginary(:, :)      !! (samples, number)

    real(wp), dimension(size(load, 1), size(load, 2)) :: coefficients, coefficients_imaginary, &
      moved, moved_imaginary
    real(wp), dimension(size(load, 1), size(load, 2), size(motion%share, 2)) :: force, &
      force_imaginary
    real(wp), dimension(2*motion%number, 2) :: state, turned_back
    real(wp) :: push(2*motion%number, size(load, 1), 2), left(4*motion%number, 4*motion%number), &
      theta
    complex(wp) :: wave(size(load, 1)), turned
    integer :: pivot(4*motion%number), i, k, m, n, info

    m = motion%number
    n = motion%steps
    call coefficients_of(plan, load, coefficients)
    call coefficients_of(plan, load_imaginary, coefficients_imaginary)
    force = 0.0_wp
    force_imaginary = 0.0_wp
    do i = 1, size(motion%rule%node)
      theta = motion%rule%node(i)*two_pi/n
      call values_of(plan, shifted(coefficients, theta), moved)
      call values_of(plan, shifted(coefficients_imaginary, theta), moved_imaginary)
      wave = [(exp(exponent*(theta + two_pi*(k - 1)/n)), k=1, n)]
      associate (re => spread(real(wave), 2, m), im => spread(aimag(wave), 2, m))
        call add_stage(motion, i, re*moved - im*moved_imaginary, force)
        call add_stage(motion, i, im*moved + re*moved_imaginary, force_imaginary)
      end associate
    end do
    push(:, :, 1) = pushes(motion, force)
    push(:, :, 2) = pushes(motion, force_imaginary)
    state = 0.0_wp
    do k = 1, n
      state = stepped(k)
    end do
    ! (e^{2πσ} − monodromy) state = what the load leaves after a turn, in real numbers
    turned = exp(two_pi*exponent)
    left = 0.0_wp
    left(:2*m, :2*m) = -motion%monodromy
    left(2*m + 1:, 2*m + 1:) = -motion%monodromy
    do i = 1, 2*m
      left(i, i) = left(i, i) + real(turned)
      left(2*m + i, 2*m + i) = left(2*m + i, 2*m + i) + real(turned)
      left(i, 2*m + i) = -aimag(turned)
      left(2*m + i, i) = aimag(turned)
    end do
    call dgetrf(4*m, 4*m, left, 4*m, pivot, info)
    call dgetrs("N", 4*m, 1, left, 4*m, pivot, state, 4*m, info)
    do k = 1, n
      turned_back = parts_of_product(exp(-exponent*two_pi*(k - 1)/n), state(:, 1), state(:, 2))
      z(k, :) = turned_back(:m, 1)
      z_imaginary(k, :) = turned_back(:m, 2)
      state = stepped(k)
    end do

  contains

    pure function stepped(k) result(next)
      integer, intent(in) :: k
      real(wp) :: next(2*m, 2)

      next(:m, :) = state(:m, :)
      next(m + 1:, :) = state(m + 1:, :) + push(:m, k, :)
      next = matmul(motion%transfer(:, :, k), next)
      next(m + 1:, :) = next(m + 1:, :) + push(m + 1:, k, :)
    end function stepped

  end subroutine solve_slow_shifted

  !> Real and imaginary parts of a number times a complex vector.
  pure function parts_of_product(number, re, im) result(parts)
    complex(wp), intent(in) :: number
    real(wp), intent(in) :: re(:), im(:)
    real(wp) :: parts(size(re), 2)

    parts(:, 1) = real(number)*re - aimag(number)*im
    parts(:, 2) = aimag(number)*re + real(number)*im
  end function parts_of_product

end module slow_motions
