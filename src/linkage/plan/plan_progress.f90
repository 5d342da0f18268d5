! src/linkage/plan/ - in which order a linkage is placed: groups, from ground pivots and drives on.
! In: a `linkage_t` with its drawing, a `side_t` for each card about a pin. Out: groups and
! redundant equations, or a `plan_problem_t`. Begin with `plan_linkage` in `assembly_plan.f90`:
! closed forms first, then `take_rest` in `plan_iterations.f90`. Among assemblies `choose_assembly`
! in `chosen_assemblies.f90` decides.
! Not here: placing the groups (`src/linkage/groups`), problems in words (`src/runs/checks`).

!> What a plan has placed so far, what follows from that, and the groups that it adds.
module plan_progress
  use linkages, only: demand_angle, demand_length, drive_of_nothing, group_t, group_carried, &
    linkage_t
  use plan_equations, only: append_equation, is_used, pin_equation
  use pose_types, only: pins_of_body
  implicit none (type, external)
  private

  public :: progress_t, new_progress, append_group, carry_rest, known_pin, line_is_known, turned_by

  !> What is placed so far.
  type :: progress_t
    logical, allocatable :: pin(:)      !! (pins) placed
    logical, allocatable :: body(:)     !! (bodies) turned and placed
    logical, allocatable :: slider(:)   !! (sliders) used
    logical, allocatable :: turn(:)     !! (turns) used
    logical, allocatable :: drive(:)    !! (drives) used
    integer, allocatable :: order(:)    !! numbers of the bodies as they are placed
  end type progress_t

contains

  !> Nothing but the ground pivots.
  pure function new_progress(linkage) result(done)
    type(linkage_t), intent(in) :: linkage !! its parts
    type(progress_t) :: done

    done%pin = linkage%is_ground
    allocate (done%body(size(linkage%bodies)), done%slider(size(linkage%sliders)), &
      done%turn(size(linkage%turns)), done%drive(size(linkage%drives)))
    done%body = .false.
    done%slider = .false.
    done%turn = .false.
    done%drive = linkage%drives%kind == drive_of_nothing
    allocate (done%order(0))
  end function new_progress

  !> Adds a group to those of a linkage.
  pure subroutine append_group(linkage, group)
    type(linkage_t), intent(inout) :: linkage
    type(group_t), intent(in) :: group

    type(group_t), allocatable :: longer(:)
    integer :: i

    allocate (longer(size(linkage%groups) + 1))
    do i = 1, size(linkage%groups)
      longer(i) = linkage%groups(i)
    end do
    longer(size(longer)) = group
    call move_alloc(longer, linkage%groups)
  end subroutine append_group

  !> Places the pins of a body that are not placed yet; those that are, and whose equations are not
  !! used, are redundant.
  pure subroutine carry_rest(linkage, body, used, done)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: body
    integer, intent(in) :: used(:) !! pins that place the body, beside its first
    type(progress_t), intent(inout) :: done

    type(group_t) :: group
    integer, allocatable :: pins(:)
    integer :: i

    pins = pins_of_body(linkage%bodies(body))
    do i = 2, size(pins)
      if (.not. done%pin(pins(i)) .or. any(used == pins(i))) cycle
      if (.not. is_used(linkage, demand_length, body, pins(i))) call append_equation( &
        linkage%redundancies, pin_equation(linkage, demand_length, body, pins(i)))
      if (.not. is_used(linkage, demand_angle, body, pins(i))) call append_equation( &
        linkage%redundancies, pin_equation(linkage, demand_angle, body, pins(i)))
    end do
    pins = pack(pins, .not. done%pin(pins))
    if (size(pins) == 0) return
    group%kind = group_carried
    group%base(1) = linkage%bodies(body)%first_pin
    group%body(1) = body
    group%pins = pins
    allocate (group%bodies(0), group%loaded(0), group%equations(0))
    done%pin(pins) = .true.
    call append_group(linkage, group)
  end subroutine carry_rest

  !> A pin of a body that is placed, ground pivots first; 0 if none is.
  pure function known_pin(linkage, body, done) result(pin)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    type(progress_t), intent(in) :: done
    integer :: pin

    integer, allocatable :: pins(:)
    integer :: i

    pins = pins_of_body(linkage%bodies(body))
    pin = 0
    do i = size(pins), 1, -1
      if (done%pin(pins(i))) pin = pins(i)
    end do
  end function known_pin

  !> Whether the line of a slider is placed.
  pure function line_is_known(linkage, slider, done) result(is)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    type(progress_t), intent(in) :: done
    logical :: is

    is = .true.
    if (linkage%sliders(slider)%body > 0) is = done%body(linkage%sliders(slider)%body)
  end function line_is_known

  !> The body of a turn whose angle follows from what is placed; 0 if none does.
  pure function turned_by(linkage, turn, done) result(body)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: turn
    type(progress_t), intent(in) :: done
    integer :: body

    logical :: is_known(2)

    associate (it => linkage%turns(turn))
      is_known = [done%body(it%body), .true.]
      if (it%against > 0) is_known(2) = done%body(it%against)
      body = 0
      if (is_known(2) .and. .not. is_known(1)) body = it%body
      if (is_known(1) .and. .not. is_known(2)) body = it%against
    end associate
  end function turned_by

end module plan_progress
