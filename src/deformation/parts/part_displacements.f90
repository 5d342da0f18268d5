!> Displacements of points and parts caused by the border unknowns, for any linkage.
!!
!! The border unknowns z make twice the elastic energy of the border `|z|²`; free motions follow
!! them. Everything is linear in the displacements p of points and rotations, so one procedure
!! serves the basis of p and what violates a constraint, which gives the forces in it.
module part_displacements
  use border_rows, only: border_unknowns_t, find_border_rows, new_border_unknowns
  use dense_factor, only: dense_factor_t, factorize, solve
  use drive_rates, only: find_drive_rates
  use elastic_linkages, only: elastic_linkage_t, is_piece
  use errors, only: error_of_dead_point, error_t, set_error
  use graded_rows, only: find_row_basis, graded_rows_t, row_basis_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: linkage_t, normal_to
  use pin_displacements, only: chords_t, find_chords
  use poses, only: dead_point_sine, pose_t, refuse_change_point
  use text, only: to_string
  implicit none (type, external)
  private

  public :: border_t, new_border, find_part_chords, chords_of, border_size

  !> Rows and basis of the border, from position to position.
  type :: border_t
    type(border_unknowns_t) :: numbers
    type(graded_rows_t) :: rows
    type(row_basis_t) :: basis
    logical :: is_new = .true.    !! pivot rows differ from those of the last position
    integer, allocatable :: primary(:) !! pivot rows of the last position
  end type border_t

contains

  !> A border without a basis yet.
  pure function new_border(elastic, links) result(border)
    type(elastic_linkage_t), intent(in) :: elastic !! parts, points, rotations
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(border_t) :: border

    border%numbers = new_border_unknowns(elastic, links)
    allocate (border%primary(0))
  end function new_border

  !> Number of border unknowns with the free motions, and that of these, at a position.
  pure subroutine border_size(border, elastic, links, pose, border_unknowns, free)
    type(border_t), intent(in) :: border           !! of this linkage
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts) of these lengths
    type(pose_t), intent(in) :: pose               !! of points and parts
    integer, intent(out) :: border_unknowns, free

    type(graded_rows_t) :: rows
    type(row_basis_t) :: basis

    call find_border_rows(elastic, links, border%numbers, pose, rows)
    call find_row_basis(rows, basis)
    border_unknowns = size(basis%unknown, 2)
    free = basis%free
  end subroutine border_size

  !> The basis at a position, and what its unknowns do to points and parts: in closed form, or from
  !! rows.
  !!
  !! Errors: a change point at which no redundant links hold the linkage; more or fewer free motions
  !! than it has elsewhere: a dead point.
  pure subroutine find_part_chords(linkage, elastic, links, pose, unknowns, free, with_forces, &
    border, chords, error)
    type(linkage_t), intent(in) :: linkage         !! that moves: its drives
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts) of these lengths
    type(pose_t), intent(in) :: pose               !! of points and parts
    integer, intent(in) :: unknowns                !! border unknowns with the free motions
    integer, intent(in) :: free                    !! free motions
    logical, intent(in) :: with_forces             !! constraints, too
    type(border_t), intent(inout) :: border        !! of this linkage
    type(chords_t), intent(out) :: chords          !! of this position
    type(error_t), allocatable, intent(out) :: error

    if (elastic%in_closed_form) then
      chords = find_chords(linkage, links, pose)
      border%is_new = .false.
      return
    end if
    call find_border_rows(elastic, links, border%numbers, pose, border%rows)
    call find_row_basis(border%rows, border%basis, border%primary, with_forces)
    if (border%basis%free /= free .or. border%basis%least_pivot < dead_point_sine) then
      call refuse_change_point(pose, error)
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
    chords = chords_of(elastic, links, pose, border%numbers, border%basis%unknown, &
      border%basis%weighted)
    allocate (chords%weighted(size(border%rows%weight), unknowns), source=0.0_wp)
    chords%weighted(:, :unknowns - free) = border%basis%weighted
    chords%free = free
    if (free > 0) call count_by_drives(linkage, elastic, links, pose, border, chords)
  end subroutine find_part_chords

  !> Counts free motions by the drives that are free: the unknowns then mean the same everywhere.
  pure subroutine count_by_drives(linkage, elastic, links, pose, border, chords)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(link_modes_t), intent(in) :: links(:)
    type(pose_t), intent(in) :: pose
    type(border_t), intent(inout) :: border
    type(chords_t), intent(inout) :: chords

    type(dense_factor_t) :: factor
    type(chords_t) :: others
    real(wp), allocatable :: rate(:, :), motion(:, :)
    real(wp) :: unit(chords%free)
    integer :: i, n

    call find_drive_rates(linkage, elastic, links, pose, chords, rate)
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
    others = chords_of(elastic, links, pose, border%numbers, border%basis%unknown(:, n + 1:), &
      border%basis%weighted(:, :0))
    chords%pin(:, :, n + 1:) = others%pin
    chords%across(:, n + 1:, :) = others%across
    chords%along(:, n + 1:, :) = others%along
    chords%turn(n + 1:, :) = others%turn
    chords%rotation(:, n + 1:) = others%rotation
  end subroutine count_by_drives

  !> What some displacements p do to points and parts.
  pure function chords_of(elastic, links, pose, numbers, unknown, weighted) result(chords)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(border_unknowns_t), intent(in) :: numbers !! of points and rotations
    real(wp), intent(in) :: unknown(:, :)          !! (unknowns, displacements) p
    real(wp), intent(in) :: weighted(:, :)         !! (rows, displacements) y; those beyond its
                                                   !! columns have none
    type(chords_t) :: chords

    real(wp) :: axis(2), normal(2)
    integer :: i, j, k, n, last

    n = size(unknown, 2)
    allocate (chords%pin(2, size(numbers%point), n), chords%across(2 + maxval(links%curves), n, &
      size(links)), chords%along(2, n, size(links)), chords%turn(n, size(links)), &
      chords%rotation(elastic%rotations, n))
    do j = 1, n
      do i = 1, size(numbers%point)
        chords%pin(:, i, j) = 0.0_wp
        if (numbers%point(i) > 0) chords%pin(:, i, j) = unknown(numbers%point(i):numbers%point(i) &
          + 1, j)
      end do
      do i = 1, elastic%rotations
        chords%rotation(i, j) = unknown(numbers%rotation(i), j)/numbers%size_of
      end do
    end do
    chords%across = 0.0_wp
    last = size(weighted, 2)
    do k = 1, size(links)
      associate (part => elastic%linkage%bodies(k))
        axis = pose%direction(:, k)
        normal = normal_to(axis)
        do j = 1, n
          chords%across(1, j, k) = dot_product(normal, chords%pin(:, part%first_pin, j))
          chords%across(2, j, k) = dot_product(normal, chords%pin(:, part%last_pin, j))
          chords%along(1, j, k) = dot_product(axis, chords%pin(:, part%first_pin, j))
          chords%along(2, j, k) = dot_product(axis, chords%pin(:, part%last_pin, j))
        end do
        do i = 1, links(k)%curves
          chords%across(2 + i, :last, k) = weighted(numbers%curve(i, k), :)
        end do
        if (part%bends .and. is_piece(elastic, k)) then
          chords%turn(:, k) = turn_of_piece(elastic, links(k), k, chords)
        else if (part%bends) then
          chords%turn(:, k) = (chords%across(2, :, k) - chords%across(1, :, k))/part%length
        else if (elastic%rotation(1, k) > 0) then
          chords%turn(:, k) = chords%rotation(elastic%rotation(1, k), :)
        else
          chords%turn(:, k) = 0.0_wp
        end if
      end associate
    end do
  end function chords_of

  !> Rotation of the chord of a piece of a cut way, from that of a held end: where a piece is short
  !! its ends move by the same amount, and their difference would be round-off.
  pure function turn_of_piece(elastic, link, part, chords) result(turn)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: link         !! of the piece: at least one end is held
    integer, intent(in) :: part                    !! its number
    type(chords_t), intent(in) :: chords           !! with rotations and curves
    real(wp) :: turn(size(chords%turn, 1))

    integer :: e

    turn = -link%curve_rotation(1)*chords%across(3, :, part)
    do e = 1, 2
      if (elastic%rotation(e, part) > 0) turn = turn + chords%rotation(elastic%rotation(e, part), :)
    end do
    if (link%curves == 2) turn = 0.5_wp*turn
  end function turn_of_piece

end module part_displacements
