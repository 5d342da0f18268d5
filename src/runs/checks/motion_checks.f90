!> Checks of REPORT motion that need mechanics: initial crank angle, moving masses.
module motion_checks
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_reach
  use four_bar_limits, only: can_reach, reach_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use mechanisms, only: mechanism_t
  use models, only: model_t, report_number
  use reach_checks, only: interval_words, reachable_intervals
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: check_motion

contains

  !> Whether REPORT motion can start, if the deck has it.
  !!
  !! Errors: the linkage does not close at the initial crank angle; nothing that moves has a mass.
  subroutine check_motion(model, mechanism, reach, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(reach_t), intent(in) :: reach                !! crank angles at which the linkage closes
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors are appended

    integer :: number

    number = report_number(model, "motion")
    if (number == 0) return
    associate (report => model%reports(number))
      if (.not. can_reach(reach, report%start_angle)) then
        call add_error(diagnostics, report%start_angle_word, "the initial crank angle "// &
          to_string(report%start_angle, 10)//" deg is out of reach; the linkage closes "// &
          interval_words(model, reachable_intervals(mechanism, [report%start_angle], &
          [report%start_angle])), kind=error_of_reach)
      end if
      if (has_moving_mass(mechanism%linkage, mechanism%load_elements) .or. &
        model%motor%rotor > 0.0_wp) return
      call add_error(diagnostics, report%keyword, &
        "nothing that moves has a mass: forces do not determine its motion")
    end associate
  end subroutine check_motion

  !> Whether any body or pin has kinetic energy when the linkage moves. A body on a ground pivot
  !! moves by turning about it.
  pure function has_moving_mass(linkage, elements) result(has)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:) !! (bodies) on whose nodes their masses sit; 0: distributed
    logical :: has

    ! Bound of the rounding, relative to the moment of inertia, that a mass at its ground pivot
    ! leaves: moments of inertia about the two pins are subtracted from each other.
    real(wp), parameter :: rounding = 4.0_wp*epsilon(1.0_wp)
    type(rigid_body_t) :: rigid(size(linkage%bodies))
    real(wp) :: about
    integer :: b

    has = any(linkage%pin_mass > 0.0_wp .and. .not. linkage%is_ground)
    rigid = rigid_bodies_of(linkage, elements)
    do b = 1, size(rigid)
      associate (body => linkage%bodies(b), it => rigid(b))
        about = it%inertia
        if (linkage%is_ground(body%last_pin)) about = about + body%length*(it%mass*body%length - &
          2.0_wp*it%first_moment(1))
        has = has .or. about > rounding*it%inertia
        if (.not. (linkage%is_ground(body%first_pin) .or. linkage%is_ground(body%last_pin))) has = &
          has .or. it%mass > 0.0_wp
      end associate
    end do
  end function has_moving_mass

end module motion_checks
