!> Checks of a motion that need mechanics: where it starts, and whether there is anything to move.
module motion_checks
  use diagnostics, only: add_error, diagnostics_t
  use four_bar_limits, only: can_reach, reach_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t, report_number
  use requests, only: report_motion
  use rigid_bodies, only: central_inertia, mass_centre, rigid_body_t, rigid_bodies_of
  use text, only: to_string
  implicit none (type, external)
  private

  public :: check_motion

contains

  !> Whether REPORT motion, if it is asked for, can start.
  subroutine check_motion(model, mechanism, reach, reachable, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(reach_t), intent(in) :: reach
    character(len=*), intent(in) :: reachable !! the angles at which the linkage closes, in words
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: number

    number = report_number(model, report_motion)
    if (number == 0) return
    associate (report => model%reports(number))
      if (.not. can_reach(reach, report%start_angle)) then
        call add_error(diagnostics, report%start_angle_word, "the initial crank angle "//to_string(report%start_angle, 10)// &
          " deg is out of reach; the linkage closes "//reachable)
      end if
      if (has_moving_mass(mechanism)) return
      call add_error(diagnostics, report%keyword, "nothing that moves has a mass: no force would tell how it moves")
    end associate
  end subroutine check_motion

  !> Whether any body or pin takes kinetic energy when it moves: a body that is hung on the ground, when it turns about its pivot.
  pure function has_moving_mass(mechanism) result(has)
    type(mechanism_t), intent(in) :: mechanism
    logical :: has

    type(rigid_body_t) :: rigid(size(mechanism%linkage%bodies))
    real(wp) :: moving
    integer :: b

    associate (linkage => mechanism%linkage)
      moving = sum(linkage%pin_mass, mask=.not. linkage%is_ground)
      rigid = rigid_bodies_of(linkage, mechanism%load_elements)
      do b = 1, size(rigid)
        associate (body => linkage%bodies(b))
          if (linkage%is_ground(body%first_pin)) then
            moving = moving + rigid(b)%inertia
          else if (linkage%is_ground(body%last_pin)) then
            moving = moving + central_inertia(rigid(b)) + rigid(b)%mass*sum((mass_centre(rigid(b)) - [body%length, 0.0_wp])**2)
          else
            moving = moving + rigid(b)%mass + rigid(b)%inertia
          end if
        end associate
      end do
    end associate
    has = moving > 0.0_wp
  end function has_moving_mass

end module motion_checks
