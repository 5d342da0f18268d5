!> The terms of Lagrange's equation at every position.
module lagrange_study
  use kinds, only: wp
  use lagrange, only: demanded_torque, find_lagrange, kinetic_energy, lagrange_t, velocity_term
  use linkages, only: linkage_t
  use positions, only: positions_t
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  implicit none (type, external)
  private

  public :: find_lagrange_terms, lagrange_at_speed

  !> Number of values of `lagrange_at_speed`.
  integer, parameter :: lagrange_values = 8

contains

  !> Generalised inertia M, M' = dM/dθ2, generalised loads and potential at all positions, once for
  !! all speeds: Ulker 2010 (2.50) to (2.64).
  subroutine find_lagrange_terms(linkage, elements, positions, threads, terms)
    type(linkage_t), intent(in) :: linkage     !! with masses
    integer, intent(in) :: elements(:)         !! (bodies) on whose nodes the masses are lumped; 0:
                                               !! distributed
    type(positions_t), intent(in) :: positions !! of the run
    integer, intent(in) :: threads             !! number of OpenMP threads
    type(lagrange_t), allocatable, intent(out) :: terms(:) !! (states) zeros where there is no pose

    type(rigid_body_t) :: rigid(size(linkage%bodies))
    integer :: i

    rigid = rigid_bodies_of(linkage, elements)
    allocate (terms(size(positions%states)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(terms)
      associate (state => positions%states(i))
        if (.not. allocated(state%error)) terms(i) = &
          find_lagrange(linkage, rigid, state%pose, state%coefficients)
      end associate
    end do
    !$omp end parallel do
  end subroutine find_lagrange_terms

  !> Values at a speed: M, M' [kg m²], `½ M' ω2²`, gravity, load, torque, kinetic energy, potential
  !! [N m].
  pure function lagrange_at_speed(terms, speed, acceleration) result(values)
    type(lagrange_t), intent(in) :: terms !! at a position
    real(wp), intent(in) :: speed         !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration  !! α2 [rad/s²]
    real(wp) :: values(lagrange_values)

    values = [terms%inertia, terms%inertia_slope, velocity_term(terms, speed), terms%gravity, &
      terms%load, demanded_torque(terms, speed, acceleration), kinetic_energy(terms, speed), &
      terms%potential]
  end function lagrange_at_speed

end module lagrange_study
