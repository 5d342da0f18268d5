!> Slow motions at many speeds that are near each other: transfers over a step are smooth functions
!! of the speed, and interpolated from those at Chebyshev's nodes.
!!
!! Multipliers turn fast as the speed changes, a single step little: its transfer has no more than
!! the phase of one step. Where interpolation is not as good as collocation there is no table.
module motion_tables
  use chebyshev_series, only: chebyshev_nodes
  use errors, only: error_t
  use fourier_transform, only: fourier_plan_t
  use kinds, only: wp
  use slow_bases, only: slow_basis_t
  use slow_motions, only: find_monodromy, new_slow_motion, slow_motion_t
  implicit none (type, external)
  private

  public :: motion_table_t, new_motion_table, is_in_table, motion_of_table, table_width, &
    least_speeds

  !> Width of a table in terms of the speed, and its nodes: for steps in which the fastest slow
  !! coordinate turns by two circles, interpolation is right to a tenth of what is asked for.
  real(wp), parameter :: table_width = 0.08_wp
  integer, parameter :: nodes = 8

  !> For no fewer speeds a table takes less time than it saves.
  integer, parameter :: least_speeds = 2*nodes

  !> Transfers are right to this share of the largest number in them.
  real(wp), parameter :: accuracy = 1.0e-8_wp

  !> Slow motions of a range of speeds.
  type :: motion_table_t
    logical :: is_good = .false.
    real(wp) :: from = 0.0_wp, to = 0.0_wp     !! speeds, ω2 [rad/s]
    type(slow_motion_t) :: motion(nodes)       !! at the nodes, transfers and scales only
  end type motion_table_t

contains

  !> Makes a table of a range of speeds, if transfers can be interpolated there.
  subroutine new_motion_table(plan, basis, from, to, stages, table)
    type(fourier_plan_t), intent(in) :: plan !! for the samples
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: from, to         !! ω2 [rad/s]
    integer, intent(in) :: stages            !! of a step
    type(motion_table_t), intent(out) :: table

    type(slow_motion_t) :: interpolated, itself
    type(error_t), allocatable :: error
    real(wp) :: place(nodes)
    integer :: k

    table%from = from
    table%to = to
    place = chebyshev_nodes(nodes)
    do k = 1, nodes
      call new_slow_motion(plan, basis, from + 0.5_wp*(place(k) + 1.0_wp)*(to - from), stages, &
        table%motion(k), error)
      if (allocated(error)) return
      deallocate (table%motion(k)%inner)
    end do
    ! Between nodes it is worst at the ends.
    call new_slow_motion(plan, basis, to, stages, itself, error)
    if (allocated(error)) return
    call motion_of_table(table, to, interpolated, error)
    if (allocated(error)) return
    table%is_good = maxval(abs(interpolated%transfer - itself%transfer)) <= accuracy* &
      maxval(abs(itself%transfer))
  end subroutine new_motion_table

  !> Whether a speed is in the range of a table that is good, and the table for so many samples.
  pure logical function is_in_table(table, samples, speed)
    type(motion_table_t), intent(in) :: table
    integer, intent(in) :: samples
    real(wp), intent(in) :: speed !! ω2 [rad/s]

    is_in_table = table%is_good .and. samples == table%motion(1)%steps .and. speed >= table%from &
      .and. speed <= table%to
  end function is_in_table

  !> Steps at a speed, for free motions only.
  !!
  !! Errors: it grows too much in a turn.
  subroutine motion_of_table(table, speed, motion, error)
    type(motion_table_t), intent(in) :: table
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    type(slow_motion_t), intent(out) :: motion
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: share(nodes)
    integer :: i, k

    share = shares_at(2.0_wp*(speed - table%from)/(table%to - table%from) - 1.0_wp)
    motion%number = table%motion(1)%number
    motion%steps = table%motion(1)%steps
    motion%scale = dot_product(share, table%motion%scale)
    allocate (motion%transfer, mold=table%motion(1)%transfer)
    do i = 1, motion%steps
      motion%transfer(:, :, i) = share(1)*table%motion(1)%transfer(:, :, i)
      do k = 2, nodes
        motion%transfer(:, :, i) = motion%transfer(:, :, i) + share(k)* &
          table%motion(k)%transfer(:, :, i)
      end do
    end do
    call find_monodromy(motion, error)
  end subroutine motion_of_table

  !> Lagrange's polynomials of the nodes.
  pure function shares_at(x) result(share)
    real(wp), intent(in) :: x
    real(wp) :: share(nodes)

    real(wp) :: place(nodes)
    integer :: i, k

    place = chebyshev_nodes(nodes)
    do k = 1, nodes
      share(k) = product([((x - place(i))/(place(k) - place(i)), i=1, k - 1), &
        ((x - place(i))/(place(k) - place(i)), i=k + 1, nodes)])
    end do
  end function shares_at

end module motion_tables
