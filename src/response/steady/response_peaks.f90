!> Largest strain, stress and deflection of every link over the turn and along the link.
!!
!! They are looked for at all samples and many places, then between them.
module response_peaks
  use constants, only: degree, two_pi
  use elastic_equations, only: elongation_of, functions_of, strained_functions
  use fourier_transform, only: close_fourier, coefficients_of, fourier_plan_t, open_fourier, &
    resampled, value_at, values_of
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_rows, only: displacement_rows, strain_rows, strain_rows_t
  use response_types, only: peak_t, response_request_t, speed_response_t
  use turn_grids, only: moves, sense_of, turn_grid_t
  implicit none (type, external)
  private

  public :: find_peaks, sampled_deflections

  !> Places along a link for a quick look at its deflection.
  real(wp), parameter :: quick_places(5) = [0.0_wp, 0.25_wp, 0.5_wp, 0.75_wp, 1.0_wp]

  !> Intervals between the places looked at, for each piece of a link.
  integer, parameter :: intervals = 32

  !> So many times as many crank angles are looked at as there are samples, and all maxima among
  !! them that are as high as this beside the highest.
  integer, parameter :: denser = 4
  real(wp), parameter :: may_hide = 0.95_wp

  !> Places on either side of an end of a piece are this far from it, so that rounding does not move
  !! them to the other.
  real(wp), parameter :: aside = 8.0_wp*epsilon(1.0_wp)

  !> What is less than this share of the largest value is rounding, and so may be many times what
  !! the last change by iterations is.
  real(wp), parameter :: of_rounding = 1.0e-12_wp, many = 10.0_wp

  !> Rounds of the search between samples, and how its steps shrink.
  integer, parameter :: rounds = 10
  real(wp), parameter :: narrowing = 0.4_wp

contains

  !> The largest deflection of every link at a few places and the samples of the turn; zeros of
  !! rigid ones [m].
  pure function sampled_deflections(grid, y) result(deflection)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns) [√J]
    real(wp) :: deflection(size(grid%integrals))

    real(wp), allocatable :: q(:, :)
    integer :: b, i

    deflection = 0.0_wp
    do b = 1, size(deflection)
      associate (link => grid%model%links(b))
        if (.not. link%bends) cycle
        q = functions_of(grid, b, y)
        do i = 1, size(quick_places)
          associate (rows => displacement_rows(link, [quick_places(i)*link%length, 0.0_wp]))
            deflection(b) = max(deflection(b), sqrt(maxval(sum(matmul(q, transpose(rows(:2, &
              :)))**2, dim=2))))
          end associate
        end do
      end associate
    end do
  end function sampled_deflections

  !> Places where to look for a maximum: evenly in every piece of a link, and on both sides of the
  !! ends of pieces, where strains have kinks or jumps.
  pure function places_along(ends) result(xi)
    real(wp), intent(in) :: ends(0:) !! of the pieces, from 0 to 1
    real(wp) :: xi((intervals + 1)*(size(ends) - 1))

    integer :: e, first, i

    first = 0
    do e = 1, size(ends) - 1
      xi(first + 1:first + intervals + 1) = [(ends(e - 1) + (ends(e) - ends(e - 1))*i/intervals, &
        i=0, intervals)]
      if (e > 1) xi(first + 1) = xi(first + 1) + aside
      first = first + intervals + 1
      if (e < size(ends) - 1) xi(first) = xi(first) - aside
    end do
    xi(size(xi)) = 1.0_wp
  end function places_along

  !> Numbers, among those of `places_along`, of both ends of the piece of a place.
  pure function piece_of(number) result(ends)
    integer, intent(in) :: number
    integer :: ends(2)

    ends(1) = ((number - 1)/(intervals + 1))*(intervals + 1) + 1
    ends(2) = ends(1) + intervals
  end function piece_of

  !> Finds the largest values of all links; zeros of rigid ones. What changes over the turn by no
  !! more than iterations and rounding left is a constant, which has no crank angle.
  subroutine find_peaks(grid, plan, request, y, found, last_change, only_strains)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan       !! for its samples
    type(response_request_t), intent(in) :: request !! sections
    real(wp), intent(in) :: y(:, :)                !! (samples, unknowns) [√J]
    type(speed_response_t), intent(inout) :: found !! its largest strains, stresses, deflections
    real(wp), intent(in), optional :: last_change(:, :) !! of y by the iterations; absent: 0
    logical, intent(in), optional :: only_strains  !! no deflections; absent: false

    type(fourier_plan_t) :: dense
    real(wp), allocatable :: values(:, :), xi(:), coefficients(:, :), q(:, :), rows(:, :, :), &
      waves(:)
    real(wp) :: left(size(grid%integrals)), unsure, at_rows, at_waves
    integer :: b, n

    n = size(grid%integrals)
    left = 0.0_wp
    if (present(last_change)) left = many*sampled_deflections(grid, last_change)
    allocate (found%largest_strain(n), found%largest_stress(n), found%largest_deflection(n))
    call open_fourier(denser*grid%samples, dense)
    do b = 1, n
      associate (link => grid%model%links(b))
        if (.not. link%bends) cycle
        xi = places_along(link%bending_shapes%last/link%bending_shapes%elements)
        allocate (coefficients(grid%samples, grid%integrals(b)%chord + grid%integrals(b)%own + 1))
        allocate (q(dense%samples, size(coefficients, 2)))
        call take(strained(y))
        call look_along(.true.)
        unsure = of_rounding*maxval(values)
        if (present(last_change)) unsure = max(unsure, many*maxval(values_along(strained( &
          last_change), quick_places, .true.)))
        call search(.true., found%largest_strain(b))
        call place_on_link(found%largest_strain(b))
        found%largest_stress(b) = found%largest_strain(b)
        found%largest_stress(b)%value = request%section(b)%modulus*found%largest_strain(b)%value
        if (.not. present(only_strains)) call look_at_deflections
        deallocate (values, coefficients, q)
      end associate
    end do
    call close_fourier(dense)

  contains

    !> Amplitudes for the strains of a link, and behind them its elongation.
    function strained(y) result(amplitudes)
      real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
      real(wp) :: amplitudes(size(y, 1), size(coefficients, 2))

      amplitudes(:, :size(amplitudes, 2) - 1) = strained_functions(grid, b, y)
      amplitudes(:, size(amplitudes, 2)) = elongation_of(grid, b, y)
    end function strained

    !> Amplitudes at many crank angles.
    subroutine take(amplitudes)
      real(wp), intent(in) :: amplitudes(:, :) !! (samples, functions)

      call coefficients_of(plan, amplitudes, coefficients(:, :size(amplitudes, 2)))
      call values_of(dense, resampled(coefficients, dense%samples), q)
    end subroutine take

    !> Values at all places.
    subroutine look_along(of_strain)
      logical, intent(in) :: of_strain

      values = values_along(q, xi, of_strain)
      at_waves = huge(at_waves)
      at_rows = huge(at_rows)
    end subroutine look_along

    !> Strain of the outermost fibre at some places, or squared deflection.
    function values_along(amplitudes, places, of_strain) result(along)
      real(wp), intent(in) :: amplitudes(:, :) !! (samples, functions)
      real(wp), intent(in) :: places(:)
      logical, intent(in) :: of_strain
      real(wp) :: along(size(amplitudes, 1), size(places))

      real(wp) :: part(size(along, 1), size(along, 2), 2)
      integer, allocatable :: used(:)
      integer :: i, k

      if (allocated(rows)) deallocate (rows)
      allocate (rows(size(amplitudes, 2), 2, size(places)))
      do i = 1, size(places)
        rows(:, :, i) = rows_at(places(i), of_strain)
      end do
      do k = 1, 2
        used = pack([(i, i=1, size(rows, 1))], any(abs(rows(:, k, :)) > 0.0_wp, dim=2))
        part(:, :, k) = matmul(amplitudes(:, used), rows(used, k, :))
      end do
      along = joined(part(:, :, 1), part(:, :, 2), of_strain)
    end function values_along

    !> What amplitudes count at a place for the strain of the axis and that by bending, or for the
    !! displacements along the link and across it.
    function rows_at(place, of_strain) result(at)
      real(wp), intent(in) :: place
      logical, intent(in) :: of_strain
      real(wp) :: at(size(coefficients, 2), 2)

      type(strain_rows_t) :: strain
      integer :: chord, last

      at = 0.0_wp
      last = size(at, 1)
      associate (link => grid%model%links(b))
        if (of_strain) then
          chord = grid%integrals(b)%chord
          strain = strain_rows(link, place)
          at(last, 1) = strain%elongation
          at(chord + 1:last - 1, 1) = strain%axial
          at(3:chord - 2, 2) = request%section(b)%outer*strain%curvature(:0)
          at(chord + 1:last - 1, 2) = request%section(b)%outer*strain%curvature(1:)
        else
          associate (displacement => displacement_rows(link, [place*link%length, 0.0_wp]))
            at(:last - 1, :) = transpose(displacement(:2, :))
          end associate
        end if
      end associate
    end function rows_at

    !> The largest deflection of a link.
    subroutine look_at_deflections
      if (moves(grid, b)) call take(functions_of(grid, b, y))
      call look_along(.false.)
      associate (largest => sqrt(maxval(values)))
        unsure = largest*max(of_rounding*largest, 2.0_wp*left(b))
      end associate
      call search(.false., found%largest_deflection(b))
      found%largest_deflection(b)%value = sqrt(found%largest_deflection(b)%value)
      call place_on_link(found%largest_deflection(b))
    end subroutine look_at_deflections

    !> The share of the way along a link or, of a piece, along all pieces of its way.
    subroutine place_on_link(peak)
      type(peak_t), intent(inout) :: peak

      real(wp) :: ratio(grid%samples, b), here(b)

      peak%share = peak%xi
      if (.not. moves(grid, b)) return
      call coefficients_of(plan, grid%ratio(:, :b), ratio)
      here = value_at(ratio, sense_of(grid)*peak%crank*degree)
      peak%share = peak%xi*here(b) + sum(here(:b - 1), mask=grid%pieces(:b - 1)%way == &
        grid%pieces(b)%way)
    end subroutine place_on_link

    !> The largest value: of all sampled maxima in a piece that may hide it, the largest between
    !! samples.
    subroutine search(of_strain, peak)
      logical, intent(in) :: of_strain !! else of squared deflection
      type(peak_t), intent(out) :: peak

      type(peak_t) :: other
      real(wp) :: least
      integer :: ends(2), low, high, before, after, first, last, highest(2), i, k

      highest = maxloc(values)
      least = may_hide*values(highest(1), highest(2))
      call climb_from(highest(1), highest(2), of_strain, peak)
      peak%is_constant = is_constant(highest(2))
      do i = 1, size(values, 2)
        if (was_interrupted()) exit
        ends = piece_of(i)
        low = max(ends(1), i - 1)
        high = min(ends(2), i + 1)
        first = 1
        last = size(values, 1)
        if (is_constant(i)) then
          first = maxloc(values(:, i), dim=1)
          last = first
        end if
        do k = first, last
          if (values(k, i) < least) cycle
          before = modulo(k - 2, size(values, 1)) + 1
          after = modulo(k, size(values, 1)) + 1
          associate (around => values([before, k, after], low:high))
            if (any(around > values(k, i))) cycle
            ! A parabola rises by less than that above its samples: nothing but rounding is won.
            if (2.0_wp*values(k, i) - minval(around) <= peak%value + unsure) cycle
          end associate
          call climb_from(k, i, of_strain, other)
          if (other%value <= peak%value) cycle
          other%is_constant = peak%is_constant
          peak = other
        end do
      end do
    end subroutine search

    !> Whether values at a place change over the turn by nothing but rounding.
    pure function is_constant(place) result(yes)
      integer, intent(in) :: place !! its number
      logical :: yes

      yes = maxval(values(:, place)) - minval(values(:, place)) <= unsure
    end function is_constant

    !> The maximum between samples near a sampled one.
    subroutine climb_from(sample, place, of_strain, peak)
      integer, intent(in) :: sample, place !! their numbers
      logical, intent(in) :: of_strain
      type(peak_t), intent(out) :: peak

      integer :: ends(2)

      ends = piece_of(place)
      call climb(values(sample, place), [two_pi*(sample - 1)/size(values, 1), xi(place)], &
        [two_pi/size(values, 1), (xi(ends(2)) - xi(ends(1)))/intervals], xi(ends), of_strain, peak)
    end subroutine climb_from

    !> From a sampled maximum by parabolas over the turn, along the link and in the direction in
    !! which these have led, through points that move closer: the largest value met counts.
    subroutine climb(value, place, wide, ends, of_strain, peak)
      real(wp), intent(in) :: value, place(2) !! sampled; crank angle and place
      real(wp), intent(in) :: wide(2)         !! between samples
      real(wp), intent(in) :: ends(2)         !! of the piece of the link
      logical, intent(in) :: of_strain
      type(peak_t), intent(out) :: peak

      real(wp) :: best(2), before(2), middle(2), width(2), step(2), f(3), bend, here
      integer :: i, k

      best = place
      width = wide
      peak%value = value
      do k = 1, rounds
        before = best
        do i = 1, 3
          select case (i)
          case (1)
            step = [width(1), 0.0_wp]
          case (2)
            step = [0.0_wp, width(2)]
          case default
            ! That in which the first two have led.
            step = best - before
          end select
          if (all(abs(step) <= 0.0_wp)) cycle
          middle = best
          f(2) = peak%value
          call try_place(middle - step, ends, of_strain, best, peak%value, f(1))
          call try_place(middle + step, ends, of_strain, best, peak%value, f(3))
          bend = f(1) + f(3) - 2.0_wp*f(2)
          if (bend < 0.0_wp) call try_place(middle + 0.5_wp*(f(1) - f(3))/bend*step, ends, &
            of_strain, best, peak%value, here)
        end do
        width = narrowing*width
      end do
      peak%xi = best(2)
      peak%crank = modulo(sense_of(grid)*best(1)/degree, 360.0_wp)
    end subroutine climb

    !> The value at a crank angle and place of a piece, which is kept if it is the largest so far;
    !! that at the end of the piece for a place beyond.
    subroutine try_place(wanted, ends, of_strain, best, largest, here)
      real(wp), intent(in) :: wanted(2) !! crank angle, place
      real(wp), intent(in) :: ends(2)   !! of the piece
      logical, intent(in) :: of_strain
      real(wp), intent(inout) :: best(2), largest
      real(wp), intent(out) :: here

      real(wp) :: at(2)

      at = [wanted(1), min(max(wanted(2), ends(1)), ends(2))]
      here = value_at_place(of_strain, at(1), at(2))
      if (here <= largest) return
      largest = here
      best = at
    end subroutine try_place

    !> Strain of the outermost fibre, or squared deflection. Of two tries in a row one changes the
    !! crank angle or the place alone.
    function value_at_place(of_strain, theta, place) result(value)
      logical, intent(in) :: of_strain
      real(wp), intent(in) :: theta, place
      real(wp) :: value

      real(wp) :: parts(2)

      if (abs(theta - at_waves) > 0.0_wp) waves = value_at(coefficients, theta)
      if (abs(place - at_rows) > 0.0_wp) rows(:, :, 1) = rows_at(place, of_strain)
      at_waves = theta
      at_rows = place
      parts = matmul(waves, rows(:, :, 1))
      value = joined(parts(1), parts(2), of_strain)
    end function value_at_place

  end subroutine find_peaks

  !> Strain of the outermost fibre from those of the axis and of bending, or squared deflection from
  !! displacements along the link and across it.
  elemental function joined(along, across, of_strain) result(value)
    real(wp), intent(in) :: along, across
    logical, intent(in) :: of_strain
    real(wp) :: value

    if (of_strain) then
      value = abs(along) + abs(across)
    else
      value = along**2 + across**2
    end if
  end function joined

end module response_peaks
