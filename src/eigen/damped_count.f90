!> How many roots s of `det(s² M + s C + K)` lie in a disc about zero: by the argument principle,
!! from the undamped modes below a limit and the moments of those above it.
!!
!! With the undamped modes y of eigenvalues λ, `C = B Bᵀ` and g = Bᵀy,
!! `det(s² M + s C + K) = det(s² M + K) det H` with `H = 1 + s Σ g gᵀ/(s² + λ)`, a matrix of as many
!! rows as there are dampers. det H has as many zeros more in the disc than det(s² M + K) as its
!! argument turns round zero on the circle. The undamped modes not known have λ of at least a limit
!! Λ > |s|². Their sum is
!! `Σ g gᵀ/(s² + λ) = Σ_p (σ − s²)^(p−1) μ_p + rest` with `μ_p = Σ g gᵀ/(λ + σ)^p` for p = 1 … P and
!! `‖rest‖ ≤ tr μ_P |σ − s²|^P/(Λ − |s|²)`.
module damped_count
  use constants, only: pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: damper_response_t, moment_count, count_in_disc

  integer, parameter :: moment_count = 4

  !> What the dampers are told by the modes, with √c in the rows of B.
  type :: damper_response_t
    real(wp), allocatable :: lambda(:)        !! (modes) known, among them all below `limit` [1/s²]
    real(wp), allocatable :: excitation(:, :) !! (dampers, modes) g of a mode with yᵀMy = 1 [1/√s]
    real(wp), allocatable :: moment(:, :, :)  !! (dampers, dampers, P) μ_p of all other modes
    real(wp), allocatable :: rounding(:, :)   !! (dampers, P) of the diagonals of the moments
    real(wp) :: shift = 0.0_wp                !! σ, such that all λ + σ are positive [1/s²]
    real(wp) :: limit = 0.0_wp                !! Λ [1/s²]
  end type damper_response_t

  !> Steps along half the circle at most.
  integer, parameter :: most_steps = 20000

  !> Shortest step, relative to the radius: a root or a pole is as near to the circle.
  real(wp), parameter :: least_step = 1.0e-9_wp

  !> Rounding of H, in units of the terms of its sum.
  real(wp), parameter :: loss = 100.0_wp*epsilon(1.0_wp)

contains

  !> Number of roots with |s| below a radius, every one as often as it counts; −1 where it cannot be
  !! proven: the limit is too near to the circle, or a root.
  !!
  !! From a point s₀ of the circle on, `H(s) H(s₀)⁻¹` differs from 1 by less than one half as far as
  !! a step goes, by a bound of the derivative of H and of the rest. So the argument of its
  !! determinant is known at the end of the step without doubt. Roots come in conjugate pairs: half
  !! of the circle is enough.
  pure function count_in_disc(response, radius) result(number)
    type(damper_response_t), intent(in) :: response !! of these dampers
    real(wp), intent(in) :: radius           !! [1/s]
    integer :: number

    real(wp) :: unit(size(response%excitation, 1))
    type(damper_response_t) :: scaled

    number = -1
    if (response%limit <= radius**2) return
    call scale_dampers(response, radius, scaled, unit)
    number = turns_of(scaled, unit, radius)
  end function count_in_disc

  !> Multiplies H from both sides by a diagonal matrix, so that strong dampers and weak ones have
  !! entries of about 1.
  pure subroutine scale_dampers(response, radius, scaled, unit)
    type(damper_response_t), intent(in) :: response
    real(wp), intent(in) :: radius
    type(damper_response_t), intent(out) :: scaled
    real(wp), intent(out) :: unit(:) !! (dampers) what 1 becomes

    real(wp) :: factor
    integer :: i

    scaled = response
    do i = 1, size(unit)
      unit(i) = 1.0_wp/(1.0_wp + radius*(abs(response%moment(i, i, 1)) + &
        sum(response%excitation(i, :)**2/(abs(response%lambda) + radius**2))))
      factor = sqrt(unit(i))
      scaled%excitation(i, :) = factor*response%excitation(i, :)
      scaled%moment(i, :, :) = factor*scaled%moment(i, :, :)
      scaled%moment(:, i, :) = factor*scaled%moment(:, i, :)
      scaled%rounding(i, :) = unit(i)*response%rounding(i, :)
    end do
  end subroutine scale_dampers

  !> `count_in_disc` of scaled dampers.
  pure function turns_of(response, unit, radius) result(number)
    type(damper_response_t), intent(in) :: response
    real(wp), intent(in) :: unit(:)
    real(wp), intent(in) :: radius
    integer :: number

    complex(wp), dimension(size(response%excitation, 1), size(response%excitation, 1)) :: h, inverse
    complex(wp) :: s, determinant, next
    real(wp) :: angle, step, turned, rest, lost, change, allowed, size_of
    integer :: i, turns
    logical :: is_last

    number = -1
    rest = radius*trace(response, moment_count)*(response%shift + radius**2)**moment_count/ &
      (response%limit - radius**2)
    do i = 1, moment_count
      rest = rest + radius*sum(response%rounding(:, i))*(response%shift + radius**2)**(i - 1)
    end do
    ! The arguments of the eigenvalues of a product within 1/2 of 1 are below π/6.
    allowed = 0.5_wp
    if (size(h, 1) > 5) allowed = min(0.5_wp, 3.0_wp/size(h, 1))
    angle = 0.0_wp
    turned = 0.0_wp
    step = 0.1_wp
    s = radius
    h = transfer_matrix(response, unit, s)
    call invert(h, inverse, determinant)
    do i = 1, most_steps
      if (.not. abs(determinant) > 0.0_wp) return
      size_of = norm2([abs(inverse)])
      lost = rest + loss*(1.0_wp + radius*terms(response, s))
      if (lost*size_of > 0.5_wp*allowed) return
      step = 2.0_wp*step
      do
        is_last = angle + step >= pi
        if (is_last) step = pi - angle
        change = change_bound(response, s, radius, radius*step)
        if (change >= 0.0_wp .and. (change + lost)*size_of <= allowed) exit
        if (step <= least_step) return
        step = 0.5_wp*step
      end do
      angle = angle + step
      s = radius*cmplx(cos(angle), sin(angle), wp)
      if (is_last) s = -radius
      h = transfer_matrix(response, unit, s)
      call invert(h, inverse, next)
      next = next/max(abs(next), tiny(radius))
      turned = turned + atan2(aimag(next*conjg(determinant)), real(next*conjg(determinant), wp))
      determinant = next
      if (is_last) exit
    end do
    if (.not. is_last) return
    turns = nint(turned/pi)
    if (abs(turned/pi - turns) > 1.0e-3_wp) return
    number = 2*count(abs(response%lambda) < radius**2) + turns
  end function turns_of

  !> H, but for what the limit of the rest allows.
  pure function transfer_matrix(response, unit, s) result(h)
    type(damper_response_t), intent(in) :: response
    real(wp), intent(in) :: unit(:)
    complex(wp), intent(in) :: s
    complex(wp), dimension(size(response%excitation, 1), size(response%excitation, 1)) :: h

    complex(wp) :: factor
    integer :: i, j

    h = 0.0_wp
    do i = moment_count, 1, -1
      h = response%moment(:, :, i) + (response%shift - s**2)*h
    end do
    do i = 1, size(response%lambda)
      factor = 1.0_wp/(s**2 + response%lambda(i))
      do j = 1, size(h, 2)
        h(:, j) = h(:, j) + factor*response%excitation(:, i)*response%excitation(j, i)
      end do
    end do
    h = s*h
    do j = 1, size(h, 2)
      h(j, j) = h(j, j) + unit(j)
    end do
  end function transfer_matrix

  !> Sum of the magnitudes of the terms of H of known modes, but for the factor s.
  pure function terms(response, s)
    type(damper_response_t), intent(in) :: response
    complex(wp), intent(in) :: s
    real(wp) :: terms

    integer :: i

    terms = 0.0_wp
    do i = 1, size(response%lambda)
      terms = terms + sum(response%excitation(:, i)**2)/abs(s**2 + response%lambda(i))
    end do
  end function terms

  !> A bound of the norm of the change of H on an arc of the circle: of the derivative
  !! `(λ − s²)/(s² + λ)²` of every known mode, and of the moments, times the length of the arc;
  !! negative where the arc may come to an undamped root.
  pure function change_bound(response, s, radius, length) result(bound)
    type(damper_response_t), intent(in) :: response
    complex(wp), intent(in) :: s   !! where it begins
    real(wp), intent(in) :: radius
    real(wp), intent(in) :: length
    real(wp) :: bound

    real(wp) :: distance, reach
    integer :: i

    bound = 0.0_wp
    do i = 1, size(response%lambda)
      distance = abs(s**2 + response%lambda(i)) - 2.0_wp*radius*length
      if (distance <= 0.0_wp) then
        bound = -1.0_wp
        return
      end if
      bound = bound + sum(response%excitation(:, i)**2)*((abs(response%lambda(i)) + &
        radius**2)/distance)/distance
    end do
    reach = response%shift + radius**2
    do i = 1, moment_count
      bound = bound + trace(response, i)*(reach**(i - 1) + &
        2.0_wp*(i - 1)*radius**2*reach**max(i - 2, 0))
    end do
    bound = bound*length
  end function change_bound

  !> A bound of the trace of a moment.
  pure function trace(response, p)
    type(damper_response_t), intent(in) :: response
    integer, intent(in) :: p !! its number
    real(wp) :: trace

    integer :: i

    trace = sum(response%rounding(:, p))
    do i = 1, size(response%moment, 1)
      trace = trace + max(response%moment(i, i, p), 0.0_wp)
    end do
  end function trace

  !> Inverse and determinant by Gauss and Jordan with row interchanges; the determinant has the
  !! magnitude 1, or is zero.
  pure subroutine invert(matrix, inverse, determinant)
    complex(wp), intent(in) :: matrix(:, :)
    complex(wp), intent(out) :: inverse(:, :)
    complex(wp), intent(out) :: determinant

    complex(wp) :: a(size(matrix, 1), 2*size(matrix, 1)), row(2*size(matrix, 1))
    integer :: i, k, n, pivot

    n = size(matrix, 1)
    a = 0.0_wp
    a(:, :n) = matrix
    do i = 1, n
      a(i, n + i) = 1.0_wp
    end do
    determinant = 1.0_wp
    do k = 1, n
      pivot = k - 1 + maxloc(abs(a(k:, k)), dim=1)
      if (.not. abs(a(pivot, k)) > 0.0_wp) then
        determinant = 0.0_wp
        inverse = 0.0_wp
        return
      end if
      if (pivot /= k) then
        row = a(k, :)
        a(k, :) = a(pivot, :)
        a(pivot, :) = row
        determinant = -determinant
      end if
      determinant = determinant*a(k, k)/abs(a(k, k))
      a(k, :) = a(k, :)/a(k, k)
      do i = 1, n
        if (i /= k) a(i, :) = a(i, :) - a(i, k)*a(k, :)
      end do
    end do
    inverse = a(:, n + 1:)
  end subroutine invert

end module damped_count
