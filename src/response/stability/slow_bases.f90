!> Slow coordinates of an elastic linkage: a few that follow the slow vibrations over the turn, each
!! with what the rest of the linkage does along with it.
!!
!! `y = X z` with X(θ) from subspace iterations on the mass matrix: the slow deformations (rotation
!! of the clamped end, the lowest own modes of the links) and the deformations that their inertia
!! causes, perpendicular to each other at every angle. The matrices of z do not depend on the speed.
module slow_bases
  use elastic_equations, only: deformations_of, functions_of, mass_force, slopes_of, strain_rates, &
    times_mass, times_swap
  use errors, only: error_of_numerics, error_t, set_error
  use fast_followers, only: add_followers, follower_products, frozen_stiffness
  use fourier_transform, only: close_fourier, coefficients_of, derivatives, fourier_plan_t, &
    open_fourier, resample, resampled
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs
  use load_cases, only: constant_case
  use piece_motions, only: add_convection, scale_share
  use row_products, only: add_products, gather, products_of_rows, scatter, together
  use sorting, only: ascending_order
  use strain_dampings, only: damping_t, is_damped, shares_of
  use turn_grids, only: moves, rate_case, turn_grid_t
  implicit none (type, external)
  private

  public :: slow_basis_t, new_slow_basis, slow_count, fast_squares, own_squares, has_damping, &
    matrices_at_speed, frozen_matrices, of_mass

  !> Subspace iterations at most: the error of the lowest frequencies falls by the square of the
  !! ratio of frequencies each time. Where deformations change places over the turn, slow ones
  !! becoming fast, each iteration makes them do so within fewer degrees: beyond the first, one
  !! whose highest quarter of the harmonics has more than this share of X is not made.
  integer, parameter :: iterations = 3
  real(wp), parameter :: unresolved = 5.0e-3_wp

  !> Of a column at least this share of its square is left beside those before, or it is made
  !! perpendicular again.
  real(wp), parameter :: enough_left = 1.0e-3_wp

  !> Deformations with no more than this share of the largest 1/ω² move no mass: a vibration of them
  !! is nothing but rounding in the steps of a slow motion.
  real(wp), parameter :: least_square = epsilon(1.0_wp)

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

contains

  !> Number of slow coordinates: deformations whose own frequency is below a limit, and one more; at
  !! least three, so that the slowest of all are found well, of those that move mass.
  pure function slow_count(grid, limit) result(number)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: limit !! [rad/s]
    integer :: number

    real(wp) :: square(grid%unknowns)

    square = own_squares(grid)
    number = min(max(3, count(square*limit**2 > 1.0_wp) + 1), max(1, count(square > &
      least_square*maxval(square))))
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

  !> Whether damping acts on the slow coordinates.
  pure logical function has_damping(basis)
    type(slow_basis_t), intent(in) :: basis

    has_damping = any(abs(basis%sums(:, :, of_rate)) > 0.0_wp)
  end function has_damping

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

end module slow_bases
