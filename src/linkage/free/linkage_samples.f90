!> A linkage in motion at an instant.
module linkage_samples
  use applied_loads, only: applied_potential
  use body_points, only: find_point_coefficients, point_coefficients_t
  use constants, only: degree
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkage_rates, only: find_state, moving_linkage_t, rate_of_drive
  use linkages, only: drives_angle
  use pose_types, only: pose_t
  use rigid_bodies, only: central_inertia, mass_centre
  implicit none (type, external)
  private

  public :: linkage_sample_t, sample_state

  type :: linkage_sample_t
    real(wp) :: time = 0.0_wp            !! [s]
    real(wp), allocatable :: position(:) !! (free drives) with all whole turns [deg] or [m]
    real(wp), allocatable :: rate(:)     !! (free drives) [rad/s] or [m/s]
    real(wp), allocatable :: pin(:, :)   !! (2, pins) in global axes [m]
    real(wp) :: torque = 0.0_wp          !! of the drive [N m] or [N]
    real(wp) :: kinetic = 0.0_wp         !! [J]
    real(wp) :: potential = 0.0_wp       !! of gravity and constant forces, 0 at the global origin,
                                         !! and of springs, 0 unloaded [J]
    real(wp) :: work = 0.0_wp            !! of the drive and of all other loads since the start [J]
    real(wp) :: energy_error = 0.0_wp    !! kinetic + potential − work, less its value at the start
                                         !! [J]
  end type linkage_sample_t

contains

  !> Rates, pins, torque and energies of a state.
  subroutine sample_state(system, time, state, position, sample)
    type(moving_linkage_t), intent(in) :: system
    real(wp), intent(in) :: time        !! [s]
    real(wp), intent(in) :: state(:)    !! coordinates, rates, work
    real(wp), intent(in) :: position(:) !! (free drives) with all whole turns [deg] or [m]
    type(linkage_sample_t), intent(out) :: sample !! without its error

    type(pose_t) :: pose
    type(kinematic_coefficients_t), allocatable :: per(:)
    type(kinematic_coefficients_t) :: now
    type(point_coefficients_t) :: point
    real(wp) :: unit
    logical :: found
    integer :: b, k, p

    associate (linkage => system%whole%linkage, origin => system%whole%origin)
      call find_state(system, state, pose, per, now, found)
      sample%time = time
      sample%position = position
      sample%rate = [(rate_of_drive(system, pose, now, system%free(k)), k=1, size(system%free))]
      unit = merge(degree, 1.0_wp, linkage%drives(1)%kind == drives_angle)
      sample%torque = system%drive%torque(time, unit*position(1), sample%rate(1))
      sample%work = state(size(state))
      do b = 1, size(system%rigid)
        associate (rigid => system%rigid(b))
          point = find_point_coefficients(linkage, pose, now, b, mass_centre(rigid))
          sample%kinetic = sample%kinetic + 0.5_wp*(rigid%mass*sum(point%rate**2) + &
            central_inertia(rigid)*now%turn(b)**2)
          sample%potential = sample%potential - rigid%mass*dot_product(linkage%gravity, &
            point%place + origin)
        end associate
      end do
      sample%pin = pose%pin + spread(origin, 2, size(pose%pin, 2))
      do p = 1, size(linkage%is_ground)
        sample%kinetic = sample%kinetic + 0.5_wp*linkage%pin_mass(p)*sum(now%pin(:, p)**2)
        sample%potential = sample%potential - dot_product(linkage%pin_mass(p)*linkage%gravity + &
          linkage%pin_force(:, p), sample%pin(:, p))
      end do
      if (size(linkage%loads) > 0) sample%potential = sample%potential + applied_potential( &
        linkage, pose, origin)
    end associate
  end subroutine sample_state

end module linkage_samples
