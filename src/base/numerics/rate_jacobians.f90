!> How rates change with the state, by differences, and how fast the fastest change is.
module rate_jacobians
  use kinds, only: long, wp
  use rate_systems, only: rate_system_t
  implicit none (type, external)
  private

  public :: find_jacobian, spectral_radius

contains

  !> The Jacobian `∂f/∂y`, by differences whose rounding and truncation are about equal.
  subroutine find_jacobian(system, time, state, rates, scale, jacobian, found, evaluations)
    class(rate_system_t), intent(inout) :: system    !! f
    real(wp), intent(in) :: time                     !! t
    real(wp), intent(in) :: state(:)                 !! (unknowns) y
    real(wp), intent(in) :: rates(:)                 !! (unknowns) f(t, y)
    real(wp), intent(in) :: scale(:)                 !! (unknowns) values small against it are
                                                     !! taken for 0
    real(wp), intent(out) :: jacobian(:, :)          !! (unknowns, unknowns); defined only if found
    logical, intent(out) :: found                    !! rates exist on one side of y at least
    integer(long), intent(inout) :: evaluations      !! of rates; raised

    real(wp) :: moved(size(state)), rates_there(size(state)), change
    integer :: k, side

    do k = 1, size(state)
      do side = 1, -1, -2
        change = side*sqrt(epsilon(1.0_wp))*max(abs(state(k)), scale(k))
        moved = state
        moved(k) = state(k) + change
        evaluations = evaluations + 1_long
        call system%find_rates(time, moved, rates_there, found)
        if (found) exit
      end do
      if (.not. found) return
      ! The change as it has been rounded.
      jacobian(:, k) = (rates_there - rates)/(moved(k) - state(k))
    end do
  end subroutine find_jacobian

  !> The largest modulus of the eigenvalues of a matrix, to some percent: Gelfand's formula
  !! `|A^m|^(1/m)` with m = 1024. Units of the unknowns do not matter.
  pure function spectral_radius(matrix) result(radius)
    real(wp), intent(in) :: matrix(:, :) !! (n, n)
    real(wp) :: radius                   !! in the unit of the eigenvalues

    integer, parameter :: squarings = 10
    real(wp) :: power(size(matrix, 1), size(matrix, 2)), size_of_power, logarithm
    integer :: i

    power = matrix
    logarithm = 0.0_wp
    radius = 0.0_wp
    do i = 0, squarings
      if (i > 0) power = matmul(power, power)
      size_of_power = maxval(abs(power))
      if (.not. size_of_power > 0.0_wp) return
      power = power/size_of_power
      logarithm = logarithm + log(size_of_power)/2.0_wp**i
    end do
    radius = exp(logarithm)
  end function spectral_radius

end module rate_jacobians
