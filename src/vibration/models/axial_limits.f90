!> Axial forces at which a link has no lowest frequency, or none that polynomials represent.
!!
!! The energy of shear and axial force is `½∫ kGA γ² + N (θ + γ)² dx`. Where the tension N is below
!! −kGA, ever shorter waves of γ lower it without bending the link or moving its mass: eigenvalues
!! of higher and higher orders go to −∞, and none of them is that of the beam. Any link that is
!! pressed with thousands of times Euler's load buckles in waves too short for the highest order.
module axial_limits
  use axial_forces, only: total_force
  use body_lumps, only: lump_count, lump_places
  use constants, only: pi
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, outcome_t, set_error
  use kinds, only: wp
  use linkages, only: body_t, linkage_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: least_axial_force, crushed_link, refuse_crushed

  !> Largest compression in units of Euler's load of the link, π² EI/L²: some sixty half-waves.
  real(wp), parameter :: most_euler_loads = 4000.0_wp

contains

  !> Fails every speed at which a link has no lowest frequency, or buckles too many times over.
  !!
  !! Errors, speed by speed in `outcome`: the compression of a link exceeds its shear stiffness, or
  !! the largest number of Euler loads; the error has the number of the link.
  pure subroutine refuse_crushed(linkage, model, unit_force, factor, outcome)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_model_t), intent(in) :: model !! its links' own deformations
    real(wp), intent(in) :: unit_force(:, :, :)    !! (1, ξ, ξ², jumps; bodies; cases) axial forces
                                                   !! of the unit loads [N]
    real(wp), intent(in) :: factor(:, :)           !! (cases, speeds) of the unit loads: ω2², α2, 1
    type(outcome_t), intent(inout) :: outcome(:)   !! (speeds) an error already present is kept

    real(wp) :: force(size(unit_force, 1), size(unit_force, 2))
    integer :: b, k

    do k = 1, size(outcome)
      if (allocated(outcome(k)%error)) cycle
      force = total_force(unit_force, factor(:, k))
      call refuse_folded(linkage, model, force, outcome(k))
      b = crushed_link(linkage, model, force)
      if (b == 0) cycle
      call set_error(outcome(k)%error, error_of_numerics, "the compression, "// &
        to_string(-least_axial_force(linkage%bodies(b), force(:, b)), 4)// &
        " N, exceeds the shear stiffness kGA, "// &
        to_string(model%links(b)%bending_shapes%shear_stiffness, 4)// &
        " N: no lowest frequency exists", body=b)
    end do
  end subroutine refuse_crushed

  !> Fails a speed at which a link is pressed with too many times its Euler load.
  pure subroutine refuse_folded(linkage, model, force, outcome)
    type(linkage_t), intent(in) :: linkage
    type(deformation_model_t), intent(in) :: model
    real(wp), intent(in) :: force(:, :) !! as in `crushed_link`
    type(outcome_t), intent(inout) :: outcome

    real(wp) :: euler, pressed
    integer :: b

    if (size(force, 1) == 0) return
    do b = 1, size(model%links)
      if (.not. model%links(b)%bends) cycle
      euler = pi**2*model%links(b)%bending_stiffness/model%links(b)%length**2
      pressed = -least_axial_force(linkage%bodies(b), force(:, b))
      if (pressed <= most_euler_loads*euler) cycle
      call set_error(outcome%error, error_of_numerics, "the compression, "// &
        to_string(pressed, 4)//" N, is "//to_string(pressed/euler, 3)// &
        " times Euler's load: above "//to_string(most_euler_loads, 4)// &
        " no frequencies are computed", body=b)
      return
    end do
  end subroutine refuse_folded

  !> Number of the first link whose axial force is anywhere below −kGA; 0: none.
  pure function crushed_link(linkage, model, force) result(body)
    type(linkage_t), intent(in) :: linkage         !! of the structure
    type(deformation_model_t), intent(in) :: model !! its links' own deformations
    real(wp), intent(in) :: force(:, :)            !! (1, ξ, ξ², jumps; bodies) axial forces [N]; no
                                                   !! functions: no loads
    integer :: body

    if (size(force, 1) > 0) then
      do body = 1, size(model%links)
        if (.not. model%links(body)%bends) cycle
        associate (limit => model%links(body)%bending_shapes%shear_stiffness)
          if (limit <= 0.0_wp) cycle
          if (least_axial_force(linkage%bodies(body), force(:, body)) < -limit) return
        end associate
      end do
    end if
    body = 0
  end function crushed_link

  !> Least axial force anywhere in a link that bends: at one of its ends, beside one of its masses,
  !! or where the parabola between them is lowest.
  pure function least_axial_force(body, force) result(least)
    type(body_t), intent(in) :: body !! its masses
    real(wp), intent(in) :: force(:) !! of 1, ξ, ξ², then the jump from the first pin up to each
                                     !! mass [N]
    real(wp) :: least                !! tension positive [N]

    real(wp) :: masses(lump_count(body)), places(size(masses) + 3), lowest
    integer :: i

    lowest = 0.0_wp
    if (force(3) > 0.0_wp) lowest = min(1.0_wp, max(0.0_wp, -0.5_wp*force(2)/force(3)))
    masses = lump_places(body)
    places = [0.0_wp, masses, 1.0_wp, lowest]
    least = huge(least)
    do i = 1, size(places)
      if (places(i) > 0.0_wp) least = min(least, force_at(masses, force, places(i), .true.))
      if (places(i) < 1.0_wp) least = min(least, force_at(masses, force, places(i), .false.))
    end do
  end function least_axial_force

  !> Axial force beside a place, on the side of the first pin or of the last [N].
  pure function force_at(masses, force, xi, before) result(value)
    real(wp), intent(in) :: masses(:) !! places of the masses, from 0 to 1 along the link
    real(wp), intent(in) :: force(:)
    real(wp), intent(in) :: xi        !! from 0 to 1 along the link
    logical, intent(in) :: before     !! on the side of the first pin
    real(wp) :: value

    integer :: i

    value = force(1) + xi*(force(2) + xi*force(3))
    do i = 1, size(masses)
      if (masses(i) > xi .or. (before .and. masses(i) >= xi)) value = value + force(3 + i)
    end do
  end function force_at

end module axial_limits
