!> The equations of a plan, and which of them its groups have used.
module plan_equations
  use linkages, only: demand_drive, demand_length, demand_line, demand_turn, drive_of_length, &
    equation_t, linkage_t
  use pose_types, only: place_of_pin
  implicit none (type, external)
  private

  public :: pin_equation, length_equation, line_equation, turn_equation, drive_equation, &
    append_equation, is_used, length_drive

contains

  pure function pin_equation(linkage, kind, body, pin) result(equation)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: kind, body, pin
    type(equation_t) :: equation

    equation%kind = kind
    equation%body = body
    equation%pin = pin
    equation%place = place_of_pin(linkage%bodies(body), pin)
  end function pin_equation

  !> The distance of a pin of a body from its first one: its own, or that of its drive.
  pure function length_equation(linkage, body, pin) result(equation)
    type(linkage_t), intent(in) :: linkage !! bodies and drives
    integer, intent(in) :: body, pin       !! numbers, from 1
    type(equation_t) :: equation

    integer :: drive

    drive = length_drive(linkage, body)
    if (drive > 0) then
      equation = drive_equation(drive)
    else
      equation = pin_equation(linkage, demand_length, body, pin)
    end if
  end function length_equation

  pure function line_equation(slider) result(equation)
    integer, intent(in) :: slider
    type(equation_t) :: equation

    equation%kind = demand_line
    equation%number = slider
  end function line_equation

  pure function turn_equation(turn) result(equation)
    integer, intent(in) :: turn
    type(equation_t) :: equation

    equation%kind = demand_turn
    equation%number = turn
  end function turn_equation

  pure function drive_equation(drive) result(equation)
    integer, intent(in) :: drive
    type(equation_t) :: equation

    equation%kind = demand_drive
    equation%number = drive
  end function drive_equation

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
