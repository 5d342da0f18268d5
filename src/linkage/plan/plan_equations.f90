!> The equations of a plan, and which of them its groups have used.
module plan_equations
  use coordinate_types, only: is_across, is_angle
  use coordinates, only: slider_coordinate
  use linkages, only: demand_angle, demand_drive, demand_length, demand_line, demand_turn, &
    drive_of_angle, drive_of_coordinate, drive_of_length, drive_of_nothing, drive_of_slider, &
    equation_t, linkage_t
  use pose_types, only: pins_of_body, place_of_pin
  implicit none (type, external)
  private

  public :: pin_equation, length_equation, line_equation, turn_equation, drive_equation, &
    renew_equations, list_joint_equations, append_drive_equations, append_equation, is_used, &
    length_drive

contains

  !> What a pin of a body demands: its distance from the first one, or its direction from there.
  pure function pin_equation(linkage, kind, body, pin) result(equation)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: kind, body, pin
    type(equation_t) :: equation

    equation%kind = kind
    equation%body = body
    equation%pin = pin
    equation%place = place_of_pin(linkage%bodies(body), pin)
    associate (coordinate => equation%coordinate)
      coordinate%at(1)%body = body
      coordinate%at(2)%pin = pin
      if (kind == demand_length) return
      coordinate%kind = is_across
      coordinate%at(1)%direction = equation%place/norm2(equation%place)
    end associate
  end function pin_equation

  !> The distance of a pin of a body from its first one: its own, or that of its drive.
  pure function length_equation(linkage, body, pin) result(equation)
    type(linkage_t), intent(in) :: linkage !! bodies and drives
    integer, intent(in) :: body, pin       !! numbers, from 1
    type(equation_t) :: equation

    integer :: drive

    drive = length_drive(linkage, body)
    if (drive > 0) then
      equation = drive_equation(linkage, drive)
    else
      equation = pin_equation(linkage, demand_length, body, pin)
    end if
  end function length_equation

  pure function line_equation(linkage, slider) result(equation)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    type(equation_t) :: equation

    equation%kind = demand_line
    equation%number = slider
    equation%body = linkage%sliders(slider)%body
    equation%coordinate = slider_coordinate(linkage, slider)
    equation%coordinate%kind = is_across
  end function line_equation

  pure function turn_equation(linkage, turn) result(equation)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: turn
    type(equation_t) :: equation

    equation%kind = demand_turn
    equation%number = turn
    equation%body = linkage%turns(turn)%body
    associate (coordinate => equation%coordinate, it => linkage%turns(turn))
      coordinate%kind = is_angle
      coordinate%at%body = [it%against, it%body]
      coordinate%at(1)%direction = it%relative
    end associate
  end function turn_equation

  pure function drive_equation(linkage, drive) result(equation)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: drive
    type(equation_t) :: equation

    equation%kind = demand_drive
    equation%number = drive
    equation%body = linkage%drives(drive)%body
    associate (coordinate => equation%coordinate, it => linkage%drives(drive))
      select case (it%kind)
      case (drive_of_angle)
        coordinate%kind = is_angle
        coordinate%at%body = [it%against, it%body]
        if (it%against > 0) coordinate%at(1)%direction = linkage%bodies(it%against)%heading
        coordinate%at(2)%direction = linkage%bodies(it%body)%heading
      case (drive_of_slider)
        coordinate = slider_coordinate(linkage, it%slider)
      case (drive_of_length)
        equation%pin = linkage%bodies(it%body)%last_pin
        coordinate%at(1)%body = it%body
        coordinate%at(2)%pin = equation%pin
      case (drive_of_coordinate)
        coordinate = linkage%coordinates(it%coordinate)
      end select
    end associate
  end function drive_equation

  !> The same equations once bodies are measured from other pins.
  pure subroutine renew_equations(linkage, equations)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(inout) :: equations(:)

    type(equation_t) :: old
    integer :: i

    do i = 1, size(equations)
      old = equations(i)
      select case (old%kind)
      case (demand_length, demand_angle)
        equations(i) = pin_equation(linkage, old%kind, old%body, old%pin)
      case (demand_line)
        equations(i) = line_equation(linkage, old%number)
      case (demand_turn)
        equations(i) = turn_equation(linkage, old%number)
      case (demand_drive)
        equations(i) = drive_equation(linkage, old%number)
      end select
    end do
  end subroutine renew_equations

  !> What all bodies, sliders and turns demand; the drives are beside.
  pure subroutine list_joint_equations(linkage, equations)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), allocatable, intent(out) :: equations(:)

    integer, allocatable :: pins(:)
    integer :: i, k

    allocate (equations(0))
    do i = 1, size(linkage%bodies)
      pins = pins_of_body(linkage%bodies(i))
      do k = 2, size(pins)
        if (k > 2 .or. length_drive(linkage, i) == 0) call append_equation(equations, &
          pin_equation(linkage, demand_length, i, pins(k)))
        call append_equation(equations, pin_equation(linkage, demand_angle, i, pins(k)))
      end do
    end do
    do i = 1, size(linkage%sliders)
      call append_equation(equations, line_equation(linkage, i))
    end do
    do i = 1, size(linkage%turns)
      call append_equation(equations, turn_equation(linkage, i))
    end do
  end subroutine list_joint_equations

  !> Adds those of all drives.
  pure subroutine append_drive_equations(linkage, equations)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), allocatable, intent(inout) :: equations(:)

    integer :: k

    do k = 1, size(linkage%drives)
      if (linkage%drives(k)%kind /= drive_of_nothing) call append_equation(equations, &
        drive_equation(linkage, k))
    end do
  end subroutine append_drive_equations

  pure subroutine append_equation(list, equation)
    type(equation_t), allocatable, intent(inout) :: list(:)
    type(equation_t), intent(in) :: equation

    type(equation_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = equation
    call move_alloc(longer, list)
  end subroutine append_equation

  !> Whether a group has used what a body demands of a pin.
  pure function is_used(linkage, kind, body, pin)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: kind, body, pin
    logical :: is_used

    integer :: i

    is_used = .false.
    do i = 1, size(linkage%groups)
      if (.not. allocated(linkage%groups(i)%equations)) cycle
      associate (equations => linkage%groups(i)%equations)
        is_used = is_used .or. any(equations%kind == kind .and. equations%body == body .and. &
          equations%pin == pin)
      end associate
    end do
  end function is_used

  !> Number of the drive of the length of a body; 0 if it has none.
  pure function length_drive(linkage, body) result(number)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    integer :: number

    do number = 1, size(linkage%drives)
      if (linkage%drives(number)%kind == drive_of_length .and. &
        linkage%drives(number)%body == body) return
    end do
    number = 0
  end function length_drive

end module plan_equations
