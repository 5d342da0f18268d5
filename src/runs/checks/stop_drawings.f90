!> Stops that the drawing presses: told before the run, for a sign or a limit is wrong more often
!! than a machine is drawn in its stop.
module stop_drawings
  use applied_load_types, only: deflection
  use constants, only: two_pi
  use coordinate_types, only: coordinate_t, is_angle, is_sum
  use coordinates, only: coordinate_value
  use diagnostics, only: add_warning, diagnostics_t
  use drawn_cranks, only: starting_cranks
  use kinds, only: wp
  use linkages, only: linkage_t, reference_point
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use pose_types, only: drawn_pose, pose_t
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
    real(wp), allocatable :: cranks(:)
    real(wp) :: depth
    type(unit_t) :: measure
    integer :: i

    if (size(model%stops) == 0) return
    associate (linkage => mechanism%linkage)
      if (.not. allocated(linkage%drawing%is_drawn)) return
      if (.not. all(linkage%drawing%is_drawn)) return
      pose = drawn_pose(linkage, reference_point(linkage))
      cranks = starting_cranks(model, linkage)
      pose%crank = cranks(1)
      do i = 1, size(model%stops)
        associate (load => linkage%loads(size(linkage%loads) - size(model%stops) + i), &
            nature => model%stops(i)%nature)
          depth = load%law%side*deflection(load, drawn_value(linkage, pose, load%along))
          if (depth <= rough*maxval(linkage%bodies%length)**nature%value(1)) cycle
          measure = coherent_unit(model%units, nature%value)
          call add_warning(diagnostics, model%stops(i)%name, "the drawing is "// &
            to_string(from_si(depth, measure), 3)//" "//measure%name//" inside the stop '"// &
            model%stops(i)%name%text//"'")
        end associate
      end do
    end associate
  end subroutine check_drawn_stops

  !> A coordinate in the drawing. One that a drive gives is drawn, too; the turns of an angle are
  !! those of the drive.
  pure recursive function drawn_value(linkage, pose, coordinate) result(value)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose !! of the drawing, with the coordinate of the first drive
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: value !! [m] or [rad]

    type(coordinate_t) :: as_drawn
    integer :: i

    if (coordinate%kind == is_sum) then
      value = 0.0_wp
      do i = 1, size(coordinate%term)
        value = value + coordinate%weight(i)*drawn_value(linkage, pose, &
          linkage%coordinates(coordinate%term(i)))
      end do
      return
    end if
    as_drawn = coordinate
    as_drawn%drive = 0
    value = coordinate_value(linkage, pose, as_drawn)
    if (coordinate%drive == 0 .or. coordinate%kind /= is_angle) return
    value = value + two_pi*anint((coordinate_value(linkage, pose, coordinate) - value)/two_pi)
  end function drawn_value

end module stop_drawings
