!> Displacements of points and parts caused by the border unknowns, for any linkage.
!!
!! The border unknowns z make twice the elastic energy of the border `|z|²`; free motions follow
!! them. Everything is linear in the displacements p of points and rotations, so one procedure
!! serves the basis of p and what violates a constraint, which gives the forces in it.
module part_displacements
  use border_rows, only: find_border_rows
  use dense_factor, only: dense_factor_t, factorize, solve
  use drive_rates, only: drive_rates_of
  use elastic_linkages, only: is_piece
  use elastic_positions, only: elastic_position_t
  use errors, only: error_of_dead_point, error_t, set_error
  use graded_rows, only: find_row_basis, graded_rows_t, row_basis_t
  use kinds, only: wp
  use linkages, only: normal_to
  use pin_displacements, only: chords_t, find_chords
  use poses, only: dead_point_sine, refuse_change_point
  use text, only: to_string
  implicit none (type, external)
  private

  public :: border_t, find_part_chords, chords_of, border_size

  !> Rows and basis of the border, from position to position.
  type :: border_t
    type(graded_rows_t) :: rows
    type(row_basis_t) :: basis
    logical :: is_new = .true.    !! pivot rows differ from those of the last position
    integer, allocatable :: primary(:) !! pivot rows of the last position
  end type border_t

contains

  !> Number of border unknowns with the free motions, and that of these, at a position.
  pure subroutine border_size(at, border_unknowns, free)
    type(elastic_position_t), intent(in) :: at
    integer, intent(out) :: border_unknowns, free

    type(graded_rows_t) :: rows
    type(row_basis_t) :: basis

    call find_border_rows(at, rows)
    call find_row_basis(rows, basis)
    border_unknowns = size(basis%unknown, 2)
    free = basis%free
  end subroutine border_size

  !> The basis at a position, and what its unknowns do to points and parts: in closed form, or from
  !! rows.
  !!
  !! Errors: a change point at which no redundant links hold the linkage; more or fewer free motions
  !! than it has elsewhere: a dead point.
  pure subroutine find_part_chords(at, with_forces, border, chords, error)
    type(elastic_position_t), intent(in) :: at     !! of it, with parts that are placed
    logical, intent(in) :: with_forces             !! constraints, too
    type(border_t), intent(inout) :: border        !! of this linkage
    type(chords_t), intent(out) :: chords          !! of this position
    type(error_t), allocatable, intent(out) :: error

    if (at%elastic%in_closed_form) then
      chords = find_chords(at%elastic%linkage, at%model%links, at%pose)
      border%is_new = .false.
      return
    end if
    call find_border_rows(at, border%rows)
    call find_row_basis(border%rows, border%basis, border%primary, with_forces)
    associate (unknowns => at%model%layout%border, free => at%model%layout%free)
      if (border%basis%free /= free .or. border%basis%least_pivot < dead_point_sine) then
        call refuse_change_point(at%pose, error)
        if (allocated(error)) return
      end if
      if (size(border%basis%unknown, 2) /= unknowns .or. border%basis%free /= free) then
        call set_error(error, error_of_dead_point, "dead point: the linkage has "// &
          to_string(border%basis%free)//" free motions here, elsewhere "//to_string(free))
        return
      end if
      border%is_new = size(border%primary) /= size(border%basis%primary)
      if (.not. border%is_new) border%is_new = any(border%primary /= border%basis%primary)
      border%primary = border%basis%primary
      chords = chords_of(at, border%basis%unknown, border%basis%weighted)
      allocate (chords%weighted(size(border%rows%weight), unknowns), source=0.0_wp)
      chords%weighted(:, :unknowns - free) = border%basis%weighted
      chords%free = free
      if (free > 0) call count_by_drives(at, border, chords)
    end associate
  end subroutine find_part_chords

  !> Counts free motions by the drives that are free: the unknowns then mean the same everywhere.
  pure subroutine count_by_drives(at, border, chords)
    type(elastic_position_t), intent(in) :: at
    type(border_t), intent(inout) :: border
    type(chords_t), intent(inout) :: chords

    type(dense_factor_t) :: factor
    type(chords_t) :: others
    real(wp), allocatable :: rate(:, :), motion(:, :)
    real(wp) :: unit(chords%free)
    integer :: i, n

    rate = drive_rates_of(at, chords)
    if (size(rate, 1) /= chords%free) return
    n = size(chords%turn, 1) - chords%free
    call factorize(rate(:, n + 1:), factor)
    if (.not. abs(factor%determinant) > 0.0_wp) return
    motion = border%basis%unknown(:, n + 1:)
    do i = 1, chords%free
      unit = 0.0_wp
      unit(i) = 1.0_wp
      border%basis%unknown(:, n + i) = matmul(motion, solve(factor, unit))
    end do
    others = chords_of(at, border%basis%unknown(:, n + 1:), border%basis%weighted(:, :0))
    chords%pin(:, :, n + 1:) = others%pin
    chords%across(:, n + 1:, :) = others%across
    chords%along(:, n + 1:, :) = others%along
    chords%turn(n + 1:, :) = others%turn
    chords%rotation(:, n + 1:) = others%rotation
  end subroutine count_by_drives

  !> What some displacements p do to points and parts.
  pure function chords_of(at, unknown, weighted) result(chords)
    type(elastic_position_t), intent(in) :: at
    real(wp), intent(in) :: unknown(:, :)          !! (unknowns, displacements) p
    real(wp), intent(in) :: weighted(:, :)         !! (rows, displacements) y; those beyond its
                                                   !! columns have none
    type(chords_t) :: chords

    real(wp) :: axis(2), normal(2)
    integer :: i, j, k, n, last

    n = size(unknown, 2)
    allocate (chords%pin(2, size(at%numbers%point), n), chords%across(2 + &
      maxval(at%model%links%curves), n, size(at%model%links)), chords%along(2, n, &
      size(at%model%links)), chords%turn(n, size(at%model%links)), &
      chords%rotation(at%elastic%rotations, n))
    do j = 1, n
      do i = 1, size(at%numbers%point)
        chords%pin(:, i, j) = 0.0_wp
        associate (first => at%numbers%point(i))
          if (first > 0) chords%pin(:, i, j) = unknown(first:first + 1, j)
        end associate
      end do
      do i = 1, at%elastic%rotations
        chords%rotation(i, j) = unknown(at%numbers%rotation(i), j)/at%numbers%size_of
      end do
    end do
    chords%across = 0.0_wp
    last = size(weighted, 2)
    do k = 1, size(at%model%links)
      associate (part => at%elastic%linkage%bodies(k))
        axis = at%pose%direction(:, k)
        normal = normal_to(axis)
        do j = 1, n
          chords%across(1, j, k) = dot_product(normal, chords%pin(:, part%first_pin, j))
          chords%across(2, j, k) = dot_product(normal, chords%pin(:, part%last_pin, j))
          chords%along(1, j, k) = dot_product(axis, chords%pin(:, part%first_pin, j))
          chords%along(2, j, k) = dot_product(axis, chords%pin(:, part%last_pin, j))
        end do
        do i = 1, at%model%links(k)%curves
          chords%across(2 + i, :last, k) = weighted(at%numbers%curve(i, k), :)
        end do
        if (part%bends .and. is_piece(at%elastic, k)) then
          chords%turn(:, k) = turn_of_piece(at, k, chords)
        else if (part%bends) then
          chords%turn(:, k) = (chords%across(2, :, k) - chords%across(1, :, k))/part%length
        else if (at%elastic%rotation(1, k) > 0) then
          chords%turn(:, k) = chords%rotation(at%elastic%rotation(1, k), :)
        else
          chords%turn(:, k) = 0.0_wp
        end if
      end associate
    end do
  end function chords_of

  !> Rotation of the chord of a piece of a cut way, from that of a held end: where a piece is short
  !! its ends move by the same amount, and their difference would be round-off.
  pure function turn_of_piece(at, part, chords) result(turn)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: part                    !! number of the piece: at least one end is held
    type(chords_t), intent(in) :: chords           !! with rotations and curves
    real(wp) :: turn(size(chords%turn, 1))

    integer :: e

    associate (link => at%model%links(part), rotation => at%elastic%rotation(:, part))
      turn = -link%curve_rotation(1)*chords%across(3, :, part)
      do e = 1, 2
        if (rotation(e) > 0) turn = turn + chords%rotation(rotation(e), :)
      end do
      if (link%curves == 2) turn = 0.5_wp*turn
    end associate
  end function turn_of_piece

end module part_displacements
