!> The change points of a four-bar: all its links lie in one line, and two smooth branches of the
!! loop-closure curve cross. Along one of them, through the point, every function is smooth.
!!
!! With the links along σ_k e, e being the direction of the ground, the changes of their angles
!! φ_k = x ψ_k(x) from there, and w = (σ2 r2, σ3 r3, −σ4 r4), the loop is closed where
!! `Σ w_k sin φ_k = 0` and `Σ w_k (1 − cos φ_k) = 0`. Divided by x and x², both are regular in ψ
!! at x = 0, where `Σ w_k ψ_k = 0` and `Σ w_k ψ_k² = 0` have two solutions: the tangents.
module curve_crossings
  use constants, only: pi, two_pi
  use dense_factor, only: dense_factor_t, factorize, solve
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: crossing_branch_t, crossing_branches, place_on_branch, find_on_branch

  !> One of the branches that cross at a change point.
  type :: crossing_branch_t
    real(wp) :: angle(3) = 0.0_wp   !! θ2, θ3, θ4 at the change point [rad]
    real(wp) :: weight(3) = 0.0_wp  !! w [m]
    real(wp) :: tangent(3) = 0.0_wp !! ψ at x = 0, a unit vector
  end type crossing_branch_t

  !> Lengths add up to this share of their sum, or there is no change point: others come nearer to
  !! one line than an angle of some 1e-6.
  real(wp), parameter :: length_share = 1.0e-12_wp

contains

  !> All branches through all change points, two for each.
  pure function crossing_branches(length, ground) result(branches)
    real(wp), intent(in) :: length(3) !! of crank, coupler, follower: r2, r3, r4 [m]
    real(wp), intent(in) :: ground(2) !! O2 → O4 [m]
    type(crossing_branch_t), allocatable :: branches(:)

    type(crossing_branch_t) :: branch
    real(wp) :: tangents(3, 2)
    logical :: crosses
    integer :: i, k, turned(3)

    allocate (branches(0))
    do i = 0, 7
      turned = [ibits(i, 0, 1), ibits(i, 1, 1), ibits(i, 2, 1)]
      branch%weight = (1 - 2*turned)*length*[1.0_wp, 1.0_wp, -1.0_wp]
      if (abs(sum(branch%weight) - norm2(ground)) > length_share*(sum(length) + norm2(ground))) &
        cycle
      call find_tangents(branch%weight, tangents, crosses)
      if (.not. crosses) cycle
      branch%angle = atan2(ground(2), ground(1)) + pi*turned
      do k = 1, 2
        branch%tangent = tangents(:, k)
        branches = [branches, branch]
      end do
    end do
  end function crossing_branches

  !> The directions in the plane `w·t = 0` for which the form `Σ w_k t_k²` vanishes.
  pure subroutine find_tangents(weight, tangents, crosses)
    real(wp), intent(in) :: weight(3)
    real(wp), intent(out) :: tangents(3, 2)
    logical, intent(out) :: crosses !! false: the point is alone, no branch goes through it

    real(wp) :: across(3, 2), form(3), radius, middle, half, angle
    integer :: k, least

    least = minloc(abs(weight), dim=1)
    across = 0.0_wp
    across(:, 1) = [merge(1.0_wp, 0.0_wp, [(k, k=1, 3)] == least)]
    across(:, 1) = across(:, 1) - weight*weight(least)/sum(weight**2)
    across(:, 1) = across(:, 1)/norm2(across(:, 1))
    across(:, 2) = [weight(2)*across(3, 1) - weight(3)*across(2, 1), &
      weight(3)*across(1, 1) - weight(1)*across(3, 1), &
      weight(1)*across(2, 1) - weight(2)*across(1, 1)]/norm2(weight)
    form = [sum(weight*across(:, 1)**2), sum(weight*across(:, 1)*across(:, 2)), &
      sum(weight*across(:, 2)**2)]
    radius = hypot(0.5_wp*(form(1) - form(3)), form(2))
    crosses = 0.5_wp*abs(form(1) + form(3)) < radius
    tangents = 0.0_wp
    if (.not. crosses) return
    middle = atan2(form(2), 0.5_wp*(form(1) - form(3)))
    half = acos(-0.5_wp*(form(1) + form(3))/radius)
    do k = 1, 2
      angle = 0.5_wp*(middle + merge(half, -half, k == 1))
      tangents(:, k) = cos(angle)*across(:, 1) + sin(angle)*across(:, 2)
    end do
  end subroutine find_tangents

  !> Changes of the angles from a change point, within half a turn, and the place x along a branch.
  pure subroutine place_on_branch(branch, angle, change, place)
    type(crossing_branch_t), intent(in) :: branch
    real(wp), intent(in) :: angle(3)   !! θ2, θ3, θ4 [rad]
    real(wp), intent(out) :: change(3) !! φ [rad]
    real(wp), intent(out) :: place     !! x [rad]

    change = angle - branch%angle
    change = change - two_pi*anint(change/two_pi)
    place = dot_product(branch%tangent, change)
  end subroutine place_on_branch

  !> The point of a branch at a place x, by Newton's method, with its derivatives.
  pure subroutine find_on_branch(branch, place, change, slope, bend, found)
    type(crossing_branch_t), intent(in) :: branch
    real(wp), intent(in) :: place      !! x [rad]
    real(wp), intent(out) :: change(3) !! φ = x ψ [rad]
    real(wp), intent(out) :: slope(3)  !! dφ/dx
    real(wp), intent(out) :: bend(3)   !! d²φ/dx² [1/rad]
    logical, intent(out) :: found      !! false: x is too far from the change point

    integer, parameter :: most_iterations = 20
    real(wp), parameter :: last_change = 1.0e-9_wp
    type(dense_factor_t) :: factor
    real(wp) :: psi(3), rate(3), step(3), right(3), s(0:2, 3), c(0:2, 3)
    integer :: i
    logical :: is_last

    found = .false.
    change = 0.0_wp
    slope = 0.0_wp
    bend = 0.0_wp
    psi = branch%tangent
    is_last = .false.
    associate (w => branch%weight, x => place)
      do i = 1, most_iterations
        if (.not. maxval(abs(x*psi)) < pi) return
        call find_quotients(x*psi, s, c)
        ! The gradients of both equations by ψ are w cos φ and w ψ S(φ).
        call factorize(transpose(reshape([w*cos(x*psi), w*psi*s(0, :), branch%tangent], [3, 3])), &
          factor)
        if (.not. abs(factor%determinant) > 0.0_wp) return
        if (is_last) exit
        right = -[sum(w*psi*s(0, :)), sum(w*psi**2*c(0, :)), &
          dot_product(branch%tangent, psi) - 1.0_wp]
        step = solve(factor, right)
        psi = psi + step
        ! The next correction would be of the order of the square of this one: rounding.
        is_last = maxval(abs(step)) < last_change
      end do
      if (.not. is_last) return
      rate = solve(factor, -[sum(w*psi**2*s(1, :)), sum(w*psi**3*c(1, :)), 0.0_wp])
      right = -[sum(w*(psi**3*s(2, :) - 2.0_wp*psi*sin(x*psi)*rate - x*sin(x*psi)*rate**2)), &
        sum(w*(psi**4*c(2, :) + 2.0_wp*psi**2*s(1, :)*rate + cos(x*psi)*rate**2)), 0.0_wp]
      change = x*psi
      slope = psi + x*rate
      bend = 2.0_wp*rate + x*solve(factor, right)
    end associate
    found = .true.
  end subroutine find_on_branch

  !> `S(z) = sin z/z` and `C(z) = (1 − cos z)/z²` with two derivatives, by their series.
  pure subroutine find_quotients(z, s, c)
    real(wp), intent(in) :: z(3)         !! below π
    real(wp), intent(out) :: s(0:2, 3)   !! (derivatives, values)
    real(wp), intent(out) :: c(0:2, 3)

    !> Terms of the series until they are rounding.
    integer, parameter :: terms = 18
    real(wp) :: of_s, of_c
    integer :: d, j

    s = 0.0_wp
    c = 0.0_wp
    of_s = 1.0_wp
    of_c = 0.5_wp
    do j = 0, terms
      do d = 0, 2
        s(d, :) = s(d, :) + term(2*j, d, of_s, z)
        c(d, :) = c(d, :) + term(2*j, d, of_c, z)
      end do
      of_s = -of_s/((2*j + 2)*(2*j + 3))
      of_c = -of_c/((2*j + 3)*(2*j + 4))
    end do
  end subroutine find_quotients

  !> A derivative of a power.
  elemental function term(power, derivative, first, z) result(value)
    integer, intent(in) :: power      !! of z
    integer, intent(in) :: derivative !! number
    real(wp), intent(in) :: first     !! coefficient
    real(wp), intent(in) :: z
    real(wp) :: value

    integer :: k

    value = 0.0_wp
    if (power < derivative) return
    value = first*z**(power - derivative)
    do k = 0, derivative - 1
      value = value*(power - k)
    end do
  end function term

end module curve_crossings
