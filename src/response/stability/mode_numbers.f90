!> Numbers of the vibrations of a turning linkage: by the frequencies of their shapes over the turn,
!! as the modes of a linkage at rest are numbered by theirs.
!!
!! A number belongs to a degree of freedom: to a pair of conjugate multipliers, or to two real ones.
module mode_numbers
  use constants, only: two_pi
  use kinds, only: wp
  use slow_motions, only: slow_mode_t
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: numbers_of, growing_mode, most_spread

  !> Multipliers that are smaller than the largest by more than e to this are lost in its rounding.
  real(wp), parameter :: most_spread = 28.0_wp

contains

  !> Number of the vibration to which every mode belongs; 0 of those lost in rounding.
  pure function numbers_of(modes) result(number)
    type(slow_mode_t), intent(in) :: modes(:) !! all of a slow motion, with their shape frequencies
    integer :: number(size(modes))

    integer, allocatable :: order(:)
    integer :: i, k, last
    logical :: waits(2)
    integer :: first(2), side
    real(wp) :: least

    order = ascending_order(modes%shape_frequency)
    least = maxval(real(modes%exponent, wp)) - most_spread/two_pi
    number = 0
    last = 0
    waits = .false.
    first = 0
    do i = 1, size(modes)
      k = order(i)
      if (real(modes(k)%exponent) < least) cycle
      if (.not. modes(k)%is_complex) then
        ! Real multipliers of one sign, two by two.
        side = merge(2, 1, aimag(modes(k)%exponent) > 0.25_wp)
        waits(side) = .not. waits(side)
        if (.not. waits(side)) then
          number(k) = number(first(side))
          cycle
        end if
        first(side) = k
      end if
      last = last + 1
      number(k) = last
    end do
  end function numbers_of

  !> The mode of a number that grows most, or fades least; 0: none has it.
  pure function growing_mode(modes, number, wanted) result(mode)
    type(slow_mode_t), intent(in) :: modes(:)
    integer, intent(in) :: number(:) !! of every mode
    integer, intent(in) :: wanted
    integer :: mode

    mode = maxloc(real(modes%exponent, wp), dim=1, mask=number == wanted)
  end function growing_mode

end module mode_numbers
