!> Bands of the frequencies that a linkage has when frozen at the positions of a turn, under the
!! axial forces of its speed: least, mean and greatest frequency of every mode.
!!
!! Modes are those of the frozen linkage, in ascending order at every position. Its matrices change
!! smoothly with the position and are resampled densely; frequencies do not where two are near each
!! other. Errors are differences from another approximation of the linkage, at half as many
!! positions.
module frozen_bands
  use campbell_types, only: band_t
  use errors, only: error_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier, resample
  use frozen_modes, only: find_frozen_frequencies
  use kinds, only: wp
  use slow_bases, only: slow_basis_t
  implicit none (type, external)
  private

  public :: find_bands, new_dense_basis

  !> Positions of a turn, half as many in the rough approximation.
  integer, parameter :: positions = 384

  !> Estimated errors are changes times this; none is stated below rounding.
  real(wp), parameter :: safety = 2.0_wp, rounding = 1.0e-12_wp

contains

  !> The linkage at as many positions as bands need: with two samples for each.
  subroutine new_dense_basis(basis, rough, dense)
    type(slow_basis_t), intent(in) :: basis  !! with followers
    logical, intent(in) :: rough             !! at half as many
    type(slow_basis_t), intent(out) :: dense !! of frozen matrices only

    type(fourier_plan_t) :: plan, dense_plan
    real(wp), allocatable :: flat(:, :), dense_flat(:, :)
    integer :: i, n, samples

    samples = merge(1, 2, rough)*positions
    n = size(basis%sums, 1)
    dense%number = basis%number
    allocate (dense%sums(samples, size(basis%sums, 2), size(basis%sums, 3)))
    call open_fourier(n, plan)
    call open_fourier(samples, dense_plan)
    do i = 1, size(basis%sums, 3)
      call resample(plan, basis%sums(:, :, i), dense_plan, dense%sums(:, :, i))
    end do
    if (allocated(basis%products)) then
      allocate (flat(n, size(basis%products(:, :, 1))), dense_flat(samples, size(basis%products(:, &
        :, 1))), dense%products(size(basis%products, 1), size(basis%products, 2), samples))
      flat = transpose(reshape(basis%products, [size(flat, 2), n]))
      call resample(plan, flat, dense_plan, dense_flat)
      dense%products = reshape(transpose(dense_flat), shape(dense%products))
    end if
    call close_fourier(dense_plan)
    call close_fourier(plan)
  end subroutine new_dense_basis

  !> The bands of the slowest modes at a speed.
  !!
  !! Errors: a link buckles in some position under the forces of the motion.
  subroutine find_bands(rough, fine, speed, modes, band, error)
    type(slow_basis_t), intent(in) :: rough, fine    !! by `new_dense_basis`, of other orders
    real(wp), intent(in) :: speed                    !! |ω2| [rad/s]
    integer, intent(in) :: modes                     !! as many at most as slow coordinates
    type(band_t), allocatable, intent(out) :: band(:) !! (modes)
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(band_t) :: other(modes)

    allocate (band(modes))
    call find_on(rough, other)
    if (.not. allocated(error)) call find_on(fine, band)
    if (allocated(error)) return
    band%error = max(rounding, safety*change(other, band))

  contains

    subroutine find_on(basis, found)
      type(slow_basis_t), intent(in) :: basis
      type(band_t), intent(out) :: found(:)

      real(wp), dimension(modes, size(basis%sums, 1)/2) :: frequency, fading
      integer :: i

      call find_frozen_frequencies(basis, speed, frequency, fading, error)
      if (allocated(error)) return
      do i = 1, modes
        found(i)%mean = sum(frequency(i, :))/size(frequency, 2)
        found(i)%greatest = peak_of(frequency(i, :))
        found(i)%least = -peak_of(-frequency(i, :))
      end do
    end subroutine find_on

  end subroutine find_bands

  !> The largest relative change of a band.
  elemental function change(one, other) result(largest)
    type(band_t), intent(in) :: one, other
    real(wp) :: largest

    largest = max(abs(one%least - other%least)/other%least, abs(one%mean - other%mean)/other%mean, &
      abs(one%greatest - other%greatest)/other%greatest)
  end function change

  !> The largest value of a periodic function, by the parabola through the largest sample and its
  !! neighbours.
  pure function peak_of(values) result(peak)
    real(wp), intent(in) :: values(:) !! evenly spaced
    real(wp) :: peak

    real(wp) :: before, after, bend
    integer :: k, n

    n = size(values)
    k = maxloc(values, dim=1)
    before = values(modulo(k - 2, n) + 1)
    after = values(modulo(k, n) + 1)
    bend = before + after - 2.0_wp*values(k)
    peak = values(k)
    if (bend < 0.0_wp) peak = peak - (after - before)**2/(8.0_wp*bend)
  end function peak_of

end module frozen_bands
