!> What the fast deformations of an elastic linkage do while its slow coordinates move: they follow
!! the forces `E(X z)` that the slow motion leaves in the equation, as at rest, `y_f = −Π E`, where
!! Π takes out the slow part.
!!
!! In Lagrange's function they add `½ Eᵀ Π E`. There z'' is replaced by what the slow equation
!! without them says of it, which changes terms of higher order only (a change of variables). The
!! result is a slow equation of the same form with exponents right to the square of the share of the
!! fast deformations.
module fast_followers
  use elastic_equations, only: elastic_terms_t, inertia_parts, unit_geometric_force
  use fourier_transform, only: fourier_plan_t
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs
  use load_cases, only: constant_case
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: follower_products, add_followers, frozen_stiffness

  !> Parts of `E(X z)/ω²`: of z'', of z', of z by inertia, by the axial forces per ω², and ω² times
  !! that by constant axial forces.
  integer, parameter :: parts = 5, first_of_z = 3

contains

  !> Products `eᵢᵀ Π eⱼ` of the parts of E at every sample.
  subroutine follower_products(grid, plan, shape, products)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan             !! for its samples
    real(wp), intent(in) :: shape(:, :, :)               !! (samples, unknowns, number) X, with XᵀX
                                                         !! = 1
    real(wp), allocatable, intent(out) :: products(:, :, :) !! (parts × number, parts × number,
                                                            !! samples)

    real(wp) :: e(size(shape, 2), parts*size(shape, 3), size(shape, 1))
    real(wp) :: force(size(shape, 1), size(shape, 2), 0:2)
    ! Products of transposes that are not copies take twice the time.
    real(wp), dimension(size(shape, 3), size(e, 1)) :: turned
    real(wp) :: x(size(e, 1), size(shape, 3)), left(size(e, 2), size(e, 1))
    integer :: i, k, m

    m = size(shape, 3)
    do i = 1, m
      call inertia_parts(grid, plan, elastic_terms_t(), shape(:, :, i), force)
      e(:, i, :) = transpose(force(:, :, 2))
      e(:, m + i, :) = transpose(force(:, :, 1))
      e(:, 2*m + i, :) = transpose(force(:, :, 0))
      force = 0.0_wp
      call unit_geometric_force(grid, 1, shape(:, :, i), force(:, :, 0))
      call unit_geometric_force(grid, constant_case, shape(:, :, i), force(:, :, 1))
      e(:, 3*m + i, :) = transpose(force(:, :, 0))
      e(:, 4*m + i, :) = transpose(force(:, :, 1))
    end do
    allocate (products(parts*m, parts*m, size(shape, 1)))
    do k = 1, size(shape, 1)
      x = shape(k, :, :)
      turned = transpose(x)
      e(:, :, k) = e(:, :, k) - matmul(x, matmul(turned, e(:, :, k)))
      left = transpose(e(:, :, k))
      products(:, :, k) = matmul(left, e(:, :, k))
    end do
  end subroutine follower_products

  !> Adds what the followers contribute to the matrices of `(M z' + G z)' = (Gᵀ − C) z' + V z` at a
  !! sample.
  pure subroutine add_followers(products, speed, slope, damping, mass, g, v)
    real(wp), intent(in) :: products(:, :)         !! (parts × number, parts × number) at the sample
    real(wp), intent(in) :: speed                  !! ω2 [rad/s]
    real(wp), intent(in) :: slope(:, :)            !! (number, number) G'
    real(wp), intent(in) :: damping(:, :)          !! (number, number) C
    real(wp), intent(inout) :: mass(:, :), g(:, :), v(:, :) !! (number, number) M, G, V

    real(wp), dimension(size(mass, 1), 2*size(mass, 1)) :: second
    real(wp) :: product(3*size(mass, 1), 3*size(mass, 1))
    real(wp) :: of_rest(3*size(mass, 1), 2*size(mass, 1)), added(2*size(mass, 1), 2*size(mass, 1))
    real(wp) :: factor(size(mass, 1), size(mass, 1))
    integer :: pivot(size(mass, 1)), m, info

    m = size(mass, 1)
    ! −z'' = M⁻¹ ((2G + C) z' + (G' − V) z)
    factor = mass
    second(:, :m) = 2.0_wp*g + damping
    second(:, m + 1:) = slope - v
    call dgetrf(m, m, factor, m, pivot, info)
    call dgetrs("N", m, 2*m, factor, m, pivot, second, m, info)
    product = summed(products, m, [0.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp/speed**2])
    of_rest = product(:, m + 1:) - matmul(product(:, :m), second)
    added = speed**2*(of_rest(m + 1:, :) - matmul(transpose(second), of_rest(:m, :)))
    mass = mass + added(:m, :m)
    g = g + added(:m, m + 1:)
    v = v + added(m + 1:, m + 1:)
  end subroutine add_followers

  !> What the followers take from the stiffness of the linkage frozen at a sample,
  !! `K z = λ M z` with z = x: the frequencies are those of `K − this`.
  pure function frozen_stiffness(products, speed, mass, stiffness) result(taken)
    real(wp), intent(in) :: products(:, :)  !! (parts × number, parts × number) at the sample
    real(wp), intent(in) :: speed           !! ω2 [rad/s]
    real(wp), intent(in) :: mass(:, :), stiffness(:, :) !! (number, number) M, K with axial forces
    real(wp) :: taken(size(mass, 1), size(mass, 1))

    real(wp) :: factor(size(mass, 1), size(mass, 1)), e(3*size(mass, 1), size(mass, 1))
    integer :: pivot(size(mass, 1)), i, m, info

    m = size(mass, 1)
    factor = mass
    e = 0.0_wp
    e(:m, :) = stiffness
    call dgetrf(m, m, factor, m, pivot, info)
    call dgetrs("N", m, m, factor, m, pivot, e(:m, :), m, info)
    e(:m, :) = -e(:m, :)
    do i = 1, m
      e(2*m + i, i) = 1.0_wp
    end do
    taken = matmul(transpose(e), matmul(summed(products, m, [0.0_wp, 0.0_wp, 0.0_wp, speed**2, &
      1.0_wp]), e))
  end function frozen_stiffness

  !> Products of z'', z' and of a weighted sum of the parts of z.
  pure function summed(products, m, weight) result(product)
    real(wp), intent(in) :: products(:, :)
    integer, intent(in) :: m
    real(wp), intent(in) :: weight(:) !! (parts)
    real(wp) :: product(3*m, 3*m)

    integer :: i, j

    product = 0.0_wp
    product(:2*m, :2*m) = products(:2*m, :2*m)
    do i = first_of_z, parts
      product(:2*m, 2*m + 1:) = product(:2*m, 2*m + 1:) + weight(i)*products(:2*m, (i - 1)*m + &
        1:i*m)
      do j = first_of_z, parts
        product(2*m + 1:, 2*m + 1:) = product(2*m + 1:, 2*m + 1:) + weight(i)*weight(j)* &
          products((i - 1)*m + 1:i*m, (j - 1)*m + 1:j*m)
      end do
    end do
    product(2*m + 1:, :2*m) = transpose(product(:2*m, 2*m + 1:))
  end function summed

end module fast_followers
