!> Numbers of the unknowns, rows and constraints of the border, the same at every position.
module border_unknowns
  use elastic_linkages, only: elastic_linkage_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: drive_of_slider
  implicit none (type, external)
  private

  public :: border_unknowns_t, border_row_t, new_border_unknowns
  public :: row_elongation, row_curve, row_spring

  !> What a row is.
  integer, parameter :: row_elongation = 1, row_curve = 2, row_spring = 3

  !> The meaning of a row of `graded_rows_t`.
  type :: border_row_t
    integer :: kind = 0   !! one of the row_… constants
    integer :: number = 0 !! of the part or spring
    integer :: curve = 0  !! number of the curve of a part
  end type border_row_t

  !> Numbers of unknowns, rows and constraints of a linkage, the same at every position.
  type :: border_unknowns_t
    integer :: unknowns = 0
    integer, allocatable :: point(:)         !! (points) number of the first of two; 0: fixed
    integer, allocatable :: rotation(:)      !! (rotations)
    type(border_row_t), allocatable :: rows(:)
    integer, allocatable :: elongation(:)    !! (parts) number of the row; 0: rigid
    integer, allocatable :: curve(:, :)      !! (2, parts) numbers of the rows; 0: none
    integer, allocatable :: spring(:)        !! (springs) number of the row
    integer :: constraints = 0
    integer, allocatable :: body_constraint(:) !! (parts) number of the one before the first of a
                                               !! rigid part
    integer, allocatable :: line_constraint(:) !! (sliders) across the line; 0: none
    integer, allocatable :: drive_constraint(:) !! (drives) along the line of a moving guide, or 0
    real(wp) :: size_of = 1.0_wp             !! by which rotations are multiplied [m]
  end type border_unknowns_t

contains

  !> Numbers everything.
  pure function new_border_unknowns(elastic, links) result(numbers)
    type(elastic_linkage_t), intent(in) :: elastic !! parts, points, rotations
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(border_unknowns_t) :: numbers

    integer :: i, k, n

    allocate (numbers%point(size(elastic%is_fixed)), numbers%rotation(elastic%rotations), &
      numbers%elongation(size(links)), numbers%curve(2, size(links)), &
      numbers%spring(size(elastic%springs)), numbers%body_constraint(size(links)), &
      numbers%line_constraint(size(elastic%linkage%sliders)), &
      numbers%drive_constraint(size(elastic%linkage%drives)))
    numbers%point = 0
    do i = 1, size(numbers%point)
      if (elastic%is_fixed(i)) cycle
      numbers%point(i) = numbers%unknowns + 1
      numbers%unknowns = numbers%unknowns + 2
    end do
    numbers%rotation = [(numbers%unknowns + i, i=1, elastic%rotations)]
    numbers%unknowns = numbers%unknowns + elastic%rotations
    numbers%elongation = 0
    numbers%curve = 0
    n = count(elastic%linkage%bodies%bends) + sum(links%curves) + size(elastic%springs)
    allocate (numbers%rows(n))
    n = 0
    do k = 1, size(links)
      if (.not. elastic%linkage%bodies(k)%bends) cycle
      n = n + 1
      numbers%elongation(k) = n
      numbers%rows(n) = border_row_t(row_elongation, k, 0)
      do i = 1, links(k)%curves
        n = n + 1
        numbers%curve(i, k) = n
        numbers%rows(n) = border_row_t(row_curve, k, i)
      end do
    end do
    ! Closed forms begin with the rotation of the clamped end.
    if (elastic%in_closed_form .and. links(1)%curves == 1) then
      numbers%elongation(1) = 2
      numbers%curve(1, 1) = 1
      numbers%rows(:2) = numbers%rows(2:1:-1)
    end if
    do i = 1, size(elastic%springs)
      n = n + 1
      numbers%spring(i) = n
      numbers%rows(n) = border_row_t(row_spring, i, 0)
    end do
    call number_constraints(elastic, numbers)
    numbers%size_of = maxval(elastic%linkage%bodies%length)
  end function new_border_unknowns

  pure subroutine number_constraints(elastic, numbers)
    type(elastic_linkage_t), intent(in) :: elastic
    type(border_unknowns_t), intent(inout) :: numbers

    integer :: i, n

    n = 0
    numbers%body_constraint = 0
    do i = 1, size(numbers%body_constraint)
      associate (part => elastic%linkage%bodies(i))
        numbers%body_constraint(i) = n
        if (.not. part%bends) n = n + 2*(1 + size(part%further))
      end associate
    end do
    numbers%line_constraint = 0
    do i = 1, size(numbers%line_constraint)
      associate (line => elastic%linkage%sliders(i))
        if (elastic%is_fixed(line%pin) .and. line%body == 0) cycle
        n = n + 1
        numbers%line_constraint(i) = n
      end associate
    end do
    numbers%drive_constraint = 0
    do i = 1, size(numbers%drive_constraint)
      associate (drive => elastic%linkage%drives(i))
        if (drive%kind /= drive_of_slider .or. drive%is_free) cycle
        if (elastic%linkage%sliders(drive%slider)%body == 0) cycle
        n = n + 1
        numbers%drive_constraint(i) = n
      end associate
    end do
    numbers%constraints = n
  end subroutine number_constraints

end module border_unknowns
