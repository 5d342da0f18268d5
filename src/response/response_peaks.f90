!> Largest strain, stress and deflection of every link over the turn and along the link.
!!
!! They are looked for at all samples and many places, then between them.
module response_peaks
  use constants, only: degree, two_pi
  use elastic_equations, only: functions_of
  use fourier_transform, only: coefficients_of, fourier_plan_t, value_at
  use kinds, only: wp
  use link_rows, only: displacement_rows, strain_rows, strain_rows_t
  use response_series, only: displacements_along, strains_along
  use response_types, only: peak_t, response_request_t, speed_response_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: find_peaks, sampled_deflections

  !> Places along a link for a quick look at its deflection.
  real(wp), parameter :: quick_places(5) = [0.0_wp, 0.25_wp, 0.5_wp, 0.75_wp, 1.0_wp]

  !> Intervals between the places looked at, for each piece of a link.
  integer, parameter :: intervals = 32

  !> Rounds of the search between samples, and how its steps shrink.
  integer, parameter :: rounds = 10
  real(wp), parameter :: narrowing = 0.4_wp

contains

  !> The largest deflection of every link at a few places and the samples of the turn; zeros of rigid
  !! ones [m].
  pure function sampled_deflections(grid, y) result(deflection)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns) [√J]
    real(wp) :: deflection(size(grid%integrals))

    real(wp) :: moved(size(y, 1), 2, size(quick_places))
    integer :: b

    deflection = 0.0_wp
    do b = 1, size(deflection)
      if (.not. grid%model%links(b)%bends) cycle
      call displacements_along(grid, b, quick_places, y, moved)
      deflection(b) = sqrt(maxval(sum(moved**2, dim=2)))
    end do
  end function sampled_deflections

  !> Finds the largest values of all links; zeros of rigid ones.
  subroutine find_peaks(grid, plan, request, y, found)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan       !! for its samples
    type(response_request_t), intent(in) :: request !! sections
    real(wp), intent(in) :: y(:, :)                !! (samples, unknowns) [√J]
    type(speed_response_t), intent(inout) :: found !! its largest strains, stresses, deflections

    real(wp), allocatable :: axial(:, :), curvature(:, :), moved(:, :, :), xi(:), q(:, :), &
      coefficients(:, :), elongation(:, :)
    integer :: b, i, n

    n = size(grid%integrals)
    allocate (found%largest_strain(n), found%largest_stress(n), found%largest_deflection(n))
    do b = 1, n
      associate (link => grid%model%links(b))
        if (.not. link%bends) cycle
        xi = [(real(i, wp)/(intervals*link%bending_shapes%elements), i=0, &
          intervals*link%bending_shapes%elements)]
        allocate (axial(grid%samples, size(xi)), curvature(grid%samples, size(xi)), &
          moved(grid%samples, 2, size(xi)))
        call strains_along(grid, b, xi, y, axial, curvature)
        call displacements_along(grid, b, xi, y, moved)
        q = functions_of(grid, b, y)
        allocate (coefficients(grid%samples, size(q, 2)), elongation(grid%samples, 1))
        call coefficients_of(plan, q, coefficients)
        call coefficients_of(plan, y(:, grid%elongation(b):grid%elongation(b)), elongation)
        call search(abs(axial) + request%section(b)%outer*abs(curvature), xi, .true., &
          found%largest_strain(b))
        call search(sum(moved**2, dim=2), xi, .false., found%largest_deflection(b))
        found%largest_deflection(b)%value = sqrt(found%largest_deflection(b)%value)
        found%largest_stress(b) = found%largest_strain(b)
        found%largest_stress(b)%value = request%section(b)%modulus*found%largest_strain(b)%value
        deallocate (axial, curvature, moved, coefficients, elongation)
      end associate
    end do

  contains

    !> The largest of sampled values, then by parabolas over the turn and along the link in turns,
    !! through points that move closer: the largest value met counts.
    subroutine search(values, xi, of_strain, peak)
      real(wp), intent(in) :: values(:, :) !! (samples, places)
      real(wp), intent(in) :: xi(:)
      logical, intent(in) :: of_strain     !! else of squared deflection
      type(peak_t), intent(out) :: peak

      real(wp) :: best(2), width(2), step(2), f(3), bend, here
      integer :: at(2), i, k

      at = maxloc(values)
      best = [two_pi*(at(1) - 1)/size(values, 1), xi(at(2))]
      width = [two_pi/size(values, 1), xi(2) - xi(1)]
      peak%value = values(at(1), at(2))
      do k = 1, rounds
        do i = 1, 2
          step = 0.0_wp
          step(i) = width(i)
          associate (middle => best + 0.0_wp)
            f(2) = value_at_place(of_strain, middle(1), middle(2))
            call try_place(middle - step, of_strain, best, peak%value, f(1))
            call try_place(middle + step, of_strain, best, peak%value, f(3))
            bend = f(1) + f(3) - 2.0_wp*f(2)
            if (bend < 0.0_wp) call try_place(middle + 0.5_wp*(f(1) - f(3))/bend*step, of_strain, &
              best, peak%value, here)
          end associate
        end do
        width = narrowing*width
      end do
      peak%xi = best(2)
      peak%crank = modulo(best(1)/degree, 360.0_wp)
    end subroutine search

    !> The value at a crank angle and place, which is kept if it is the largest so far.
    subroutine try_place(at, of_strain, best, largest, here)
      real(wp), intent(in) :: at(2) !! crank angle, place
      logical, intent(in) :: of_strain
      real(wp), intent(inout) :: best(2), largest
      real(wp), intent(out) :: here

      here = 0.0_wp
      if (at(2) < 0.0_wp .or. at(2) > 1.0_wp) return
      here = value_at_place(of_strain, at(1), at(2))
      if (here <= largest) return
      largest = here
      best = at
    end subroutine try_place

    !> Strain of the outermost fibre, or squared deflection.
    function value_at_place(of_strain, theta, place) result(value)
      logical, intent(in) :: of_strain
      real(wp), intent(in) :: theta, place
      real(wp) :: value

      type(strain_rows_t) :: rows
      real(wp) :: here(size(coefficients, 2)), stretched(1)
      integer :: chord

      here = value_at(coefficients, theta)
      chord = grid%integrals(b)%chord
      if (of_strain) then
        rows = strain_rows(grid%model%links(b), place)
        stretched = value_at(elongation, theta)
        value = abs(stretched(1)*rows%elongation + dot_product(here(chord + 1:), rows%axial)) + &
          request%section(b)%outer*abs(dot_product(here(chord + 1:), rows%curvature(1:)) + &
          rows%curvature(0)*here(3))
      else
        associate (displacement => displacement_rows(grid%model%links(b), &
          [place*grid%model%links(b)%length, 0.0_wp]))
          value = sum(matmul(displacement(:2, :), here)**2)
        end associate
      end if
    end function value_at_place

  end subroutine find_peaks

end module response_peaks
