!> The lowest roots s of `(s² M + s C + K) y = 0` for bordered matrices with dampers between
!! unknowns of the border, each with an error bound, and a proof that none is missing.
!!
!! Starts come from the equations of a few shapes: the lowest undamped modes, and what forces at the
!! dampers do statically. They hold the roots of every damping, however strong, real ones too, and
!! need not be followed from those without dampers. Each is improved by inverse iteration in complex
!! numbers. What is found is counted: `damped_count` tells how many roots there are in a disc.
module damped_eigensolver
  use bordered_eigensolver, only: bordered_modes_t, find_bordered_modes, start_t
  use bordered_pencil, only: bordered_pencil_t
  use damped_count, only: count_in_disc, damper_response_t
  use damped_roots, only: bound_errors, damped_modes_t, new_root_list, root_list_t, same_root
  use damped_shapes, only: build_shapes, solve_reduced
  use damped_solver, only: damped_system_t
  use errors, only: error_of_numerics, error_t, set_error
  use free_motions, only: balanced_pencil, balancing_factors
  use kinds, only: wp
  use sorting, only: ascending_order
  use text, only: to_string
  implicit none (type, external)
  private

  public :: damped_modes_t, find_damped_modes, first_guards

  !> Undamped modes beyond those requested with which the first attempt is made, and by how many
  !! times this number is raised from attempt to attempt.
  integer, parameter :: first_guards = 4, most_attempts = 6

  !> The disc about all roots found ends at so many times the last.
  real(wp), parameter :: last_gap = 2.0_wp

contains

  !> Finds the lowest roots, by |s|.
  !!
  !! Errors: negative constants; fewer roots than wanted; the undamped modes fail; no attempt leads
  !! to as many roots as are counted.
  subroutine find_damped_modes(pencil, rows, constant, wanted, undamped, complete, found, error)
    type(bordered_pencil_t), intent(in) :: pencil  !! G and M; free motions in any unit
    real(wp), intent(in) :: rows(:, :)             !! (border, dampers) velocity of each damper for
                                                   !! unit velocities of the border
    real(wp), intent(in) :: constant(:)            !! (dampers) c, in units in which `C = Σ c b bᵀ`
                                                   !! has that of √(M K) [s]
    integer, intent(in) :: wanted                  !! number of roots with Im s ≥ 0
    type(bordered_modes_t), intent(in) :: undamped !! lowest modes without dampers
    integer, intent(in) :: complete                !! as many of them miss none
    type(damped_modes_t), intent(out) :: found     !! the roots wanted, perhaps more
    type(error_t), allocatable, intent(out) :: error !! allocated on failure

    type(damped_system_t) :: system
    type(bordered_modes_t) :: modes
    real(wp) :: factor(pencil%layout%free), dampers(size(rows, 1), size(rows, 2))
    integer :: i, stiff

    if (any(constant < 0.0_wp)) then
      call set_error(error, error_of_numerics, "the constant of a damper is negative")
      return
    end if
    if (wanted > pencil%layout%unknowns) then
      call set_error(error, error_of_numerics, to_string(wanted)// &
        " modes are asked for, and there are only "//to_string(pencil%layout%unknowns)//" unknowns")
      return
    end if
    stiff = pencil%layout%border - pencil%layout%free
    factor = balancing_factors(pencil)
    system%pencil = balanced_pencil(pencil, factor)
    modes = undamped
    do i = 1, size(rows, 2)
      dampers(:, i) = sqrt(constant(i))*rows(:, i)
    end do
    do i = 1, size(factor)
      dampers(stiff + i, :) = factor(i)*dampers(stiff + i, :)
      modes%vector(stiff + i, :) = modes%vector(stiff + i, :)/factor(i)
      modes%mass_times(stiff + i, :) = modes%mass_times(stiff + i, :)*factor(i)
    end do
    system%dampers = independent_columns(dampers)
    call search(system, wanted, modes, complete, found, error)
    if (allocated(error)) return
    do i = 1, size(factor)
      found%vector(stiff + i, :) = factor(i)*found%vector(stiff + i, :)
    end do
  end subroutine find_damped_modes

  !> The search of `find_damped_modes`, with more undamped modes from attempt to attempt.
  subroutine search(system, wanted, undamped, complete, found, error)
    type(damped_system_t), intent(in) :: system
    integer, intent(in) :: wanted
    type(bordered_modes_t), intent(inout) :: undamped
    integer, intent(in) :: complete
    type(damped_modes_t), intent(inout) :: found
    type(error_t), allocatable, intent(out) :: error

    type(start_t) :: start
    real(wp), allocatable :: shapes(:, :)
    type(root_list_t) :: list
    type(damper_response_t) :: response
    integer :: attempt, guards, known, number, proven

    guards = first_guards + size(system%dampers, 2)
    known = complete
    do attempt = 1, most_attempts
      number = min(wanted + guards, system%pencil%layout%unknowns)
      if (known < number) then
        start = start_t(0, undamped%lambda, undamped%mass_times)
        if (size(undamped%lambda) >= number) start%modes = size(undamped%lambda)
        call find_bordered_modes(system%pencil, number, .true., start, undamped, error)
        found%searches = found%searches + 1
        if (allocated(error)) return
        known = number
      end if
      call build_shapes(system, undamped, known, shapes, response)
      call find_roots(system, shapes, wanted, undamped, response%shift, list)
      call list%sort_into(found)
      call count_roots(response, wanted, found, proven)
      if (proven > 0) then
        call bound_errors(system, list%zeros, proven, 2.0_wp*max(0.0_wp, -undamped%lambda(1)), &
          found)
        call omit_roots(found, proven)
        return
      end if
      if (known == system%pencil%layout%unknowns) exit
      guards = 2*guards
    end do
    call set_error(error, error_of_numerics, &
      "it could not be proven that no damped mode is missing")
  end subroutine search

  !> The roots of the reduced equations, improved from the lowest on: some more than wanted.
  subroutine find_roots(system, shapes, wanted, undamped, scale, list)
    type(damped_system_t), intent(in) :: system
    real(wp), intent(in) :: shapes(:, :) !! (unknowns, shapes)
    integer, intent(in) :: wanted
    type(bordered_modes_t), intent(in) :: undamped
    real(wp), intent(in) :: scale        !! of |s|² of modes that deform [1/s²]
    type(root_list_t), intent(out) :: list

    complex(wp), allocatable :: s(:), vector(:, :)
    integer, allocatable :: order(:)
    integer :: i

    call solve_reduced(system, shapes, undamped%zeros, s, vector)
    list = new_root_list(system%pencil%layout%unknowns, size(s) + 2*system%pencil%layout%free, &
      scale)
    call list%place_zeros(system%dampers, undamped)
    order = ascending_order(abs(s))
    do i = 1, size(order)
      if (list%number >= wanted + size(system%dampers, 2) + 3) exit
      call list%improve_start(system, s(order(i)), vector(:, order(i)))
    end do
  end subroutine find_roots

  !> Counts the roots in discs that hold those wanted, until one holds as many as are found there.
  subroutine count_roots(response, wanted, found, proven)
    type(damper_response_t), intent(in) :: response
    integer, intent(in) :: wanted
    type(damped_modes_t), intent(inout) :: found !! gets the radius of the disc
    integer, intent(out) :: proven               !! roots in the disc; 0: nothing is proven

    real(wp) :: size_of(size(found%s)), next
    integer :: i

    proven = 0
    size_of = abs(found%s)
    do i = wanted, size(size_of)
      ! The disc ends as far as can be from roots and undamped modes.
      next = last_gap*size_of(i)
      if (i < size(size_of)) next = size_of(i + 1)
      if (next <= (1.0_wp + same_root)*size_of(i)) cycle
      found%radius = widest_gap(size_of(i), next, response)
      if (found%radius**2 >= response%limit) exit
      found%counts = found%counts + 1
      if (count_in_disc(response, found%radius) /= i + count(found%swings(:i))) cycle
      proven = i
      exit
    end do
  end subroutine count_roots

  !> Omits the roots beyond the first ones.
  pure subroutine omit_roots(found, kept)
    type(damped_modes_t), intent(inout) :: found
    integer, intent(in) :: kept

    ! No real root has an imaginary part of −0.
    found%s = cmplx(real(found%s(:kept), wp), abs(aimag(found%s(:kept))), wp)
    found%vector = found%vector(:, :kept)
    found%error = found%error(:kept)
    found%swings = found%swings(:kept)
  end subroutine omit_roots

  !> A basis of the column space of dampers such that B Bᵀ stays: as it is where the columns are
  !! independent; where some are combinations of others, fewer columns.
  pure function independent_columns(dampers) result(columns)
    real(wp), intent(in) :: dampers(:, :) !! (border, dampers)
    real(wp), allocatable :: columns(:, :)

    real(wp), parameter :: dependent = 1.0e-12_wp
    real(wp) :: basis(size(dampers, 1), size(dampers, 2)), along(size(dampers, 2), &
      size(dampers, 2)), rest(size(dampers, 1))
    real(wp), allocatable :: square(:, :)
    integer :: i, j, n, pass, order(size(dampers, 2))
    logical :: silent

    n = 0
    along = 0.0_wp
    silent = .false.
    order = ascending_order(-norm2(dampers, dim=1))
    do i = 1, size(order)
      rest = dampers(:, order(i))
      do pass = 1, 2
        do j = 1, n
          along(j, order(i)) = along(j, order(i)) + dot_product(basis(:, j), rest)
          rest = rest - dot_product(basis(:, j), rest)*basis(:, j)
        end do
      end do
      if (norm2(rest) <= dependent*norm2(dampers(:, order(i)))) then
        silent = .true.
        cycle
      end if
      n = n + 1
      along(n, order(i)) = norm2(rest)
      basis(:, n) = rest/norm2(rest)
    end do
    if (.not. silent) then
      columns = dampers
      return
    end if
    ! B = Q R, and R Rᵀ = L Lᵀ has few rows.
    square = matmul(along(:n, :), transpose(along(:n, :)))
    do j = 1, n
      square(j, j) = sqrt(square(j, j) - sum(square(j, :j - 1)**2))
      do i = j + 1, n
        square(i, j) = (square(i, j) - sum(square(i, :j - 1)*square(j, :j - 1)))/square(j, j)
      end do
      square(j, j + 1:) = 0.0_wp
    end do
    columns = matmul(basis(:, :n), square)
  end function independent_columns

  !> The radius in an interval that is the farthest, by factors, from its ends and all undamped
  !! modes.
  pure function widest_gap(low, high, response) result(radius)
    real(wp), intent(in) :: low, high !! [1/s]
    type(damper_response_t), intent(in) :: response
    real(wp) :: radius

    real(wp) :: mark(size(response%lambda) + 2), widest
    integer :: i, n

    n = 1
    mark(1) = max(low, 1.0e-3_wp*high)
    do i = 1, size(response%lambda)
      associate (own => sqrt(abs(response%lambda(i))))
        if (own <= mark(1) .or. own >= high) cycle
        n = n + 1
        mark(n) = own
      end associate
    end do
    n = n + 1
    mark(n) = high
    mark(:n) = mark(ascending_order(mark(:n)))
    widest = 0.0_wp
    radius = high
    do i = 1, n - 1
      if (mark(i + 1)/mark(i) <= widest) cycle
      widest = mark(i + 1)/mark(i)
      radius = sqrt(mark(i)*mark(i + 1))
    end do
  end function widest_gap

end module damped_eigensolver
