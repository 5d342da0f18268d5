!> How much the next polynomial orders would lower an eigenvalue, piece by piece of every link.
!!
!! With r the residual of a mode in the equations of the unknowns of these orders, and C their
!! matrix `K + K_G − λ M`, the eigenvalue falls by `rᵀ C⁻¹ r` as long as that is little. The
!! unknowns of one piece are not coupled with those of another. What they do, `C⁻¹ r`, acts back on
!! the unknowns in use, which yield; where links are pressed or pulled hard, that adds as much
!! again.
module order_changes
  use bordered_matrix, only: layout_t
  use kinds, only: wp
  use link_modes, only: link_modes_t, rigid
  use next_orders, only: next_orders_t, smooth_functions
  use pin_displacements, only: chords_t
  use reduced_assembly, only: first_axial
  implicit none (type, external)
  private

  public :: order_change_t, part_count, part_of, find_order_changes

  !> The change of an eigenvalue by the next orders in one part: a piece, along or across.
  type :: order_change_t
    real(wp) :: near = 0.0_wp   !! by the first half of these orders [1/s²]
    real(wp) :: all = 0.0_wp    !! by all of them [1/s²]
    real(wp) :: echo = 0.0_wp   !! what is added, to first order, because the unknowns in use yield
                                !! to the new ones [1/s²]
    logical :: definite = .true. !! C is positive definite; if not, the orders are far too low, and
                                 !! the changes are magnitudes only
  end type order_change_t

  !> Unknowns in use whose own eigenvalue is near that of the mode take part in the mode itself: no
  !! unknown is taken to be softer than this.
  real(wp), parameter :: least_stiffness = 0.25_wp

  !> The same for the new unknowns.
  real(wp), parameter :: least_pivot = 0.1_wp

contains

  !> Number of parts of all links: every piece across, then every piece along, link by link.
  pure function part_count(links) result(count)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    integer :: count

    count = sum(links%next%pieces + links%axial_next%pieces)
  end function part_count

  !> Number of a part.
  pure function part_of(links, body, piece, along) result(part)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    integer, intent(in) :: body, piece         !! numbers
    logical, intent(in) :: along               !! the axial displacement
    integer :: part

    part = sum(links(:body - 1)%next%pieces + links(:body - 1)%axial_next%pieces) + piece
    if (along) part = part + links(body)%next%pieces
  end function part_of

  !> The changes of some eigenvalues by the next orders.
  pure subroutine find_order_changes(links, layout, chords, border_mass, force, vectors, lambda, &
      change)
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(layout_t), intent(in) :: layout       !! of these links
    type(chords_t), intent(in) :: chords       !! of this position
    real(wp), intent(in) :: border_mass(:, :)  !! (border, border) M between the border's unknowns
                                               !! [s²]
    real(wp), intent(in) :: force(:, :)        !! (force functions, bodies) at this speed; no
                                               !! functions: static [N]
    real(wp), intent(in) :: vectors(:, :)      !! (unknowns, modes) with yᵀMy = 1
    real(wp), intent(in) :: lambda(:)          !! (modes) their eigenvalues [1/s²]
    type(order_change_t), intent(out) :: change(:, :) !! (parts, modes)

    real(wp), parameter :: no_stiffness(0, 0, 0) = 0.0_wp
    integer :: b, across, along

    across = 0
    do b = 1, size(links)
      associate (link => links(b))
        along = across + link%next%pieces
        if (link%next%pieces > 0) call find_changes_of_link(link%next, layout%first(b), &
          chords%across(:2 + link%curves, :, b), force(:, b), link%square, link%geometric, &
          change(across + 1:along, :))
        across = along + link%axial_next%pieces
        if (link%axial_next%pieces > 0 .and. link%coupled) then
          call find_changes_of_link(link%axial_next, layout%first(b), chords%along(:, :, b), &
            force(:0, b), link%square, link%geometric, change(along + 1:across, :))
        else if (link%axial_next%pieces > 0) then
          call find_changes_of_link(link%axial_next, first_axial(layout, links, b), &
            chords%along(:, :, b), force(:0, b), link%axial_square, no_stiffness, &
            change(along + 1:across, :))
        end if
      end associate
    end do

  contains

    !> The changes by the next orders of all pieces of a link in one direction: across, with the
    !! geometric stiffness of its axial forces, or along, without.
    pure subroutine find_changes_of_link(next, first, moved, acting, own_mass, own_geometric, found)
      type(next_orders_t), intent(in) :: next
      integer, intent(in) :: first              !! number of the first own mode
      real(wp), intent(in), contiguous :: moved(:, :) !! (functions, border) what the border does to
                                                      !! it
      real(wp), intent(in) :: acting(:)         !! 1, ξ, ξ², jumps; none: static, or along [N]
      real(wp), intent(in), contiguous :: own_mass(:) !! (own modes) [s²]
      real(wp), intent(in) :: own_geometric(:, :, :) !! (1 + curves + own modes, the same, force
                                                     !! functions) `∫ b v' v'`
      type(order_change_t), intent(inout) :: found(:, :) !! (pieces, modes) at first none

      real(wp) :: residual(next%number), matrix(next%number, next%number), ends(size(moved, 1)), &
        slopes(rigid + size(moved, 1) - 2 + size(own_mass), merge(next%number, 0, &
        size(acting) > 0)), square(next%number, next%number), turn, slope_reach, ends_norm
      real(wp), allocatable :: stiffness(:)
      integer :: e, i, k, low, high, own_row

      own_row = rigid + size(moved, 1) - 2
      ends_norm = norm2(moved)
      square = 0.0_wp
      slope_reach = 0.0_wp
      do e = 1, next%pieces
        low = (e - 1)*next%number + 1
        high = e*next%number
        if (size(acting) > 0) call weigh(next, e, acting, low, high, slopes, square, slope_reach)
        do i = 1, size(lambda)
          associate (border => vectors(:size(moved, 2), i), own => vectors(first:first + &
            size(own_mass) - 1, i))
            do k = 1, size(moved, 1)
              ends(k) = dot_product(moved(k, :), border)
            end do
            do k = 1, next%number
              residual(k) = -lambda(i)*(dot_product(ends, next%participation(:, low &
                + k - 1)) + dot_product(own, next%mass(:, low + k - 1)))
            end do
            if (size(acting) > 0) then
              turn = dot_product(chords%turn(:, b), border)
              do k = 1, next%number
                residual(k) = residual(k) + turn*slopes(rigid, k) + &
                  dot_product(ends(3:), slopes(rigid + 1:own_row, k)) + &
                  dot_product(own, slopes(own_row + 1:, k))
              end do
            end if
          end associate
          if (is_nothing(residual, lambda(i))) cycle
          matrix = square - lambda(i)*next%mass_square(:, :, e)
          call eliminate(matrix, residual, least_pivot, found(e, i))
          if (is_silent(next, e, lambda(i), slope_reach, ends_norm)) cycle
          if (.not. allocated(stiffness)) stiffness = own_stiffness(own_geometric, &
            force(:, b), size(own_mass))
          call add_echo(next%mass(:, low:high), slopes, own_mass, stiffness, lambda(i), residual, &
            found(e, i)%echo)
          call add_border_echo(moved, next%participation(:, low:high), border_mass, layout%free, &
            lambda(i), residual, found(e, i)%echo)
        end do
      end do
    end subroutine find_changes_of_link

  end subroutine find_order_changes

  !> The geometric stiffness of a piece's unknowns at the present axial forces, with the own modes
  !! and with each other.
  pure subroutine weigh(next, piece, force, low, high, slopes, square, norm)
    type(next_orders_t), intent(in) :: next
    integer, intent(in) :: piece
    real(wp), intent(in) :: force(:) !! 1, ξ, ξ², jumps [N]
    integer, intent(in) :: low, high !! numbers of its unknowns
    real(wp), intent(out) :: slopes(:, :)
    real(wp), intent(out) :: square(:, :)
    real(wp), intent(out) :: norm    !! bound of the norm of `slopes`

    real(wp) :: smooth(smooth_functions)
    integer :: j

    smooth = force(:smooth_functions)
    do j = 1, size(next%reached, 2)
      if (next%reached(piece, j)) smooth(1) = smooth(1) + force(smooth_functions + j)
    end do
    norm = dot_product(abs(smooth), next%geometric_norm(:, piece))
    slopes = smooth(1)*next%geometric(:, low:high, 1)
    square = smooth(1)*next%geometric_square(:, :, piece, 1)
    do j = 2, smooth_functions
      slopes = slopes + smooth(j)*next%geometric(:, low:high, j)
      square = square + smooth(j)*next%geometric_square(:, :, piece, j)
    end do
  end subroutine weigh

  !> Diagonal of `K + K_G` of the own modes of a link.
  pure function own_stiffness(geometric, force, modes) result(stiffness)
    real(wp), intent(in) :: geometric(:, :, :) !! (1 + curves + modes, the same, force functions)
    real(wp), intent(in) :: force(:)           !! [N]
    integer, intent(in) :: modes
    real(wp) :: stiffness(modes)

    integer :: j, k, before

    stiffness = 1.0_wp
    before = size(geometric, 1) - modes
    do j = 1, min(size(force), size(geometric, 3))
      do k = 1, modes
        stiffness(k) = stiffness(k) + force(j)*geometric(before + k, before + k, j)
      end do
    end do
  end function own_stiffness

  !> `rᵀ C⁻¹ r`, of the first half of the unknowns, and of all; and `C⁻¹ r`.
  pure subroutine eliminate(matrix, residual, least_pivot, change)
    real(wp), intent(inout) :: matrix(:, :)  !! C less the unit matrix; destroyed
    real(wp), intent(inout) :: residual(:)   !! r; becomes C⁻¹ r
    real(wp), intent(in) :: least_pivot      !! smaller ones are not trusted: the eigenvalue is
                                             !! near, or above, those of these unknowns alone
    type(order_change_t), intent(out) :: change

    real(wp) :: pivot(size(residual)), factor
    integer :: i, j, k, n

    n = size(residual)
    do k = 1, n
      pivot(k) = 1.0_wp + matrix(k, k)
      if (pivot(k) < least_pivot) then
        change%definite = .false.
        pivot(k) = max(abs(pivot(k)), least_pivot)
      end if
      change%all = change%all + residual(k)**2/pivot(k)
      if (2*k <= n) change%near = change%all
      do j = k + 1, n
        factor = matrix(j, k)/pivot(k)
        residual(j) = residual(j) - factor*residual(k)
        do i = j, n
          matrix(i, j) = matrix(i, j) - factor*matrix(i, k)
        end do
      end do
    end do
    do k = n, 1, -1
      do i = k + 1, n
        residual(k) = residual(k) - matrix(i, k)*residual(i)
      end do
      residual(k) = residual(k)/pivot(k)
    end do
  end subroutine eliminate

  !> Whether the new unknowns change less than the last digit of the eigenvalue, by far.
  pure function is_nothing(residual, lambda) result(nothing)
    real(wp), intent(in) :: residual(:)
    real(wp), intent(in) :: lambda
    logical :: nothing

    nothing = dot_product(residual, residual) <= 1.0e-3_wp*least_pivot*epsilon(lambda)*abs(lambda)
  end function is_nothing

  !> Whether the unknowns in use can add next to nothing by yielding, however they are moved.
  pure function is_silent(next, piece, lambda, slope_reach, ends_norm) result(silent)
    type(next_orders_t), intent(in) :: next
    integer, intent(in) :: piece
    real(wp), intent(in) :: lambda
    real(wp), intent(in) :: slope_reach !! norm of the geometric stiffness with the own modes
    real(wp), intent(in) :: ends_norm   !! of what the border does to the link
    logical :: silent

    !> Share of the change that the margin of an estimate covers.
    real(wp), parameter :: little = 0.02_wp

    silent = (abs(lambda)*next%mass_norm(piece) + slope_reach)**2 + &
      (lambda*next%participation_norm(piece)*ends_norm)**2 <= little*least_stiffness
  end function is_silent

  !> What the own modes of the link add by yielding, each by itself.
  pure subroutine add_echo(mass, slopes, square, stiffness, lambda, response, echo)
    real(wp), intent(in) :: mass(:, :)   !! (modes, unknowns) of a piece
    real(wp), intent(in) :: slopes(:, :) !! (1 + curves + modes, unknowns) its geometric stiffness;
                                         !! no columns: none
    real(wp), intent(in) :: square(:)    !! (modes) own inertia
    real(wp), intent(in) :: stiffness(:) !! (modes) diagonal of K + K_G
    real(wp), intent(in) :: lambda
    real(wp), intent(in) :: response(:)  !! (unknowns)
    real(wp), intent(inout) :: echo

    real(wp) :: acting
    integer :: i, k, before

    before = size(slopes, 1) - size(square)
    do k = 1, size(square)
      acting = 0.0_wp
      do i = 1, size(response)
        acting = acting - lambda*mass(k, i)*response(i)
      end do
      if (size(slopes) > 0) then
        do i = 1, size(response)
          acting = acting + slopes(before + k, i)*response(i)
        end do
      end if
      echo = echo + acting**2/max(abs(stiffness(k) - lambda*square(k)), least_stiffness)
    end do
  end subroutine add_echo

  !> What the border adds by yielding to the inertia of the new unknowns.
  pure subroutine add_border_echo(ends, participation, border_mass, free, lambda, response, echo)
    real(wp), intent(in) :: ends(:, :)          !! (functions, border) what the border does to the
                                                !! link
    real(wp), intent(in) :: participation(:, :) !! (functions, unknowns)
    real(wp), intent(in) :: border_mass(:, :)
    integer, intent(in) :: free
    real(wp), intent(in) :: lambda
    real(wp), intent(in) :: response(:)
    real(wp), intent(inout) :: echo

    real(wp) :: acting(size(participation, 1)), residual(size(border_mass, 1)), &
      matrix(size(border_mass, 1), size(border_mass, 1))
    type(order_change_t) :: yielding
    integer :: i

    acting = 0.0_wp
    do i = 1, size(response)
      acting = acting - lambda*participation(:, i)*response(i)
    end do
    do i = 1, size(residual)
      residual(i) = dot_product(acting, ends(:, i))
    end do
    matrix = -lambda*border_mass
    do i = size(residual) - free + 1, size(residual)
      call take_free(matrix, residual, i)
    end do
    call eliminate(matrix, residual, least_stiffness, yielding)
    echo = echo + yielding%all
  end subroutine add_border_echo

  !> Gives a free motion, whose unit is arbitrary, the inertia 1, and takes away the stiffness 1
  !! that `eliminate` adds.
  pure subroutine take_free(matrix, residual, k)
    real(wp), intent(inout) :: matrix(:, :), residual(:)
    integer, intent(in) :: k !! its number

    real(wp) :: factor

    factor = 0.0_wp
    if (abs(matrix(k, k)) > tiny(factor)) factor = 1.0_wp/sqrt(abs(matrix(k, k)))
    matrix(:, k) = factor*matrix(:, k)
    matrix(k, :) = factor*matrix(k, :)
    residual(k) = factor*residual(k)
    if (factor > 0.0_wp) matrix(k, k) = matrix(k, k) - 1.0_wp
  end subroutine take_free

end module order_changes
