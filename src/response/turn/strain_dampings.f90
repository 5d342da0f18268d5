!> Damping of the strains of links: of every unknown and of every deformation of a part. That of own
!! modes changes with them, as a piece grows under a block.
module strain_dampings
  use kinds, only: wp
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: damping_t, is_damped, grown, lengths_of, mean_damping, share_at, shares_of

  !> Damping of the unknowns; where there are more deformations of parts than border unknowns, of
  !! these the mean, behind all unknowns that of every deformation and of dampers.
  type :: damping_t
    real(wp), allocatable :: c(:)     !! [s], of dampers [N s/m] or [N m s/rad]; of a piece at the
                                      !! length of the tables
    integer, allocatable :: power(:)  !! of the length of the piece, by which it grows; not
                                      !! allocated: 0
  end type damping_t

contains

  pure function is_damped(damping) result(yes)
    type(damping_t), intent(in) :: damping
    logical :: yes

    yes = any(damping%c > 0.0_wp)
  end function is_damped

  !> What some dampings are at lengths of their pieces, beside those of the tables.
  pure function share_at(damping, numbers, length) result(share)
    type(damping_t), intent(in) :: damping
    integer, intent(in) :: numbers(:) !! among the dampings
    real(wp), intent(in) :: length(:) !! by that of the tables
    real(wp) :: share(size(numbers))

    share = 1.0_wp
    if (allocated(damping%power)) share = length**damping%power(numbers)
  end function share_at

  !> Rates as a damping counts them at the lengths of its piece, over the samples.
  pure function grown(grid, damping, number, rate)
    type(turn_grid_t), intent(in) :: grid
    type(damping_t), intent(in) :: damping
    integer, intent(in) :: number       !! of the damping
    real(wp), intent(in) :: rate(:)     !! (samples)
    real(wp) :: grown(size(rate))

    grown = rate
    if (.not. allocated(damping%power)) return
    if (damping%power(number) > 0) grown = lengths_of(grid, number)**damping%power(number)*rate
  end function grown

  !> What dampings one after another are beside those of the tables, over the samples.
  pure function shares_of(grid, damping, first, last) result(share)
    type(turn_grid_t), intent(in) :: grid
    type(damping_t), intent(in) :: damping
    integer, intent(in) :: first, last
    real(wp) :: share(grid%samples, first:last)

    integer :: i

    share = 1.0_wp
    do i = first, last
      share(:, i) = grown(grid, damping, i, share(:, i))
    end do
  end function shares_of

  !> Length of the piece that a damping belongs to, by that of the tables.
  pure function lengths_of(grid, number) result(length)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: number      !! of the damping
    real(wp) :: length(grid%samples)

    integer :: body

    if (number <= grid%unknowns) then
      body = grid%owner(number)
    else
      body = grid%deformed(number - grid%unknowns)
    end if
    length = 1.0_wp
    if (body > 0 .and. allocated(grid%ratio)) length = grid%ratio(:, body)
  end function lengths_of

  !> Its mean over the samples, of every unknown [s].
  pure function mean_damping(grid, damping) result(c)
    type(turn_grid_t), intent(in) :: grid
    type(damping_t), intent(in) :: damping
    real(wp) :: c(grid%unknowns)

    c = damping%c(:grid%unknowns)
    if (allocated(damping%power)) c = c*sum(shares_of(grid, damping, 1, grid%unknowns), &
      dim=1)/grid%samples
  end function mean_damping

end module strain_dampings
