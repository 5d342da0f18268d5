!> Stops that the drawing presses: told before the run, for a sign or a limit is wrong more often
!! than a machine is drawn in its stop.
module stop_drawings
  use applied_load_types, only: is_torsional
  use coordinates, only: coordinate_value
  use diagnostics, only: add_warning, diagnostics_t
  use kinds, only: wp
  use linkages, only: reference_point
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use natures, only: angle_nature
  use pose_types, only: drawn_pose, pose_t
  use pulls, only: deflection
  use text, only: to_string
  use units, only: coherent_unit, from_si, unit_t
  implicit none (type, external)
  private

  public :: check_drawn_stops

  !> A drawing is rough: less than this share of the longest link, or of a radian, is nothing.
  real(wp), parameter :: rough = 1.0e-2_wp

contains

  !> A warning for every stop that a whole drawing is inside, with the depth.
  pure subroutine check_drawn_stops(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which the warnings are added

    type(pose_t) :: pose
    real(wp) :: depth
    type(unit_t) :: measure
    integer :: i

    if (size(model%stops) == 0) return
    associate (linkage => mechanism%linkage)
      if (.not. allocated(linkage%drawing%is_drawn)) return
      if (.not. all(linkage%drawing%is_drawn)) return
      pose = drawn_pose(linkage, reference_point(linkage))
      do i = 1, size(model%stops)
        associate (load => linkage%loads(size(linkage%loads) - size(model%stops) + i), &
            nature => model%stops(i)%nature)
          ! Of a drawing nobody knows where drives are.
          if (load%along%drive > 0) cycle
          depth = load%side*deflection(load, coordinate_value(linkage, pose, load%along))
          if (depth <= rough*maxval(linkage%bodies%length)**nature%value(1)) cycle
          if (nature%noun == angle_nature%noun .and. .not. is_torsional(load)) cycle
          measure = coherent_unit(model%units, nature%value)
          call add_warning(diagnostics, model%stops(i)%name, "the drawing is "// &
            to_string(from_si(depth, measure), 3)//" "//measure%name//" inside the stop '"// &
            model%stops(i)%name%text//"'")
        end associate
      end do
    end associate
  end subroutine check_drawn_stops

end module stop_drawings
