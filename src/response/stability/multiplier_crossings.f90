!> Speeds at which a multiplier of a vibration passes 1, as slow motions have them: there a Floquet
!! frequency is a multiple of the speed of the crank.
!!
!! Angles of multipliers are found at speeds so near each other that the fastest turns by a small
!! part of the circle; where one is not found where it is expected, speeds between are added, and
!! before the first where multipliers have met at 1 there, for crossings by which they met.
!! Between speeds at which an angle has different signs it is solved for.
module multiplier_crossings
  use campbell_types, only: gap_t
  use errors, only: error_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use multiplier_angles, only: angle_t, angles_t, find_angles, match_angles, nearest_to_one, &
    wrapped
  use refinements, only: sample_numbers
  use response_levels, only: level_slot_t, need_basis, need_level
  use stability_types, only: stability_request_t
  use structures, only: structure_t
  use turn_spectra, only: first_order, first_samples, slow_number
  implicit none (type, external)
  private

  public :: crossing_t, find_crossings, most_line, beside

  !> Multiples of the speed that are looked for; vibrations that are faster beside it are not
  !! excited.
  integer, parameter :: most_line = 40

  !> Turns between two speeds, at most, and by how much an angle may be off. Speeds between are
  !! added so many times.
  real(wp), parameter :: step = 0.1_wp, most_mismatch = 0.06_wp
  integer, parameter :: most_refinements = 6

  !> Vibrations that are followed beside those wanted: numbers pass from one to another.
  integer, parameter :: beside = 1

  !> Points on either side of a crossing whose numbers of modes count.
  integer, parameter :: around = 4

  !> Accuracy for which samples are chosen: slow motions are right to about this much.
  real(wp), parameter :: of_slow_motion = 1.0e-3_wp

  !> Angles are solved for to this many turns, in so many steps at most.
  real(wp), parameter :: solved_to = 1.0e-7_wp
  integer, parameter :: most_steps = 20

  !> Angles above this are on the other side of the circle.
  real(wp), parameter :: near_one = 0.3_wp

  !> A multiplier that passes 1.
  type :: crossing_t
    real(wp) :: speed = 0.0_wp   !! |ω2| [rad/s]
    real(wp) :: slope = 0.0_wp   !! d turns/dω2 [s]
    type(angle_t) :: angle       !! there
    integer :: mode = 0          !! that of the angle at most speeds around: shapes are others where
                                 !! multipliers have met or are near others
    integer, private :: level = 0             !! number, of the slow motion
    real(wp), private :: ends(2, 2) = 0.0_wp  !! speeds and turns before and after
  end type crossing_t

contains

  !> All crossings of the vibrations wanted between the least and the greatest speed of a request,
  !! in ascending order of the speed; none if the run is interrupted.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine find_crossings(structure, request, frequency, threads, store, levels, crossing, gap, &
    error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds of one sign, modes, damping
    real(wp), intent(in) :: frequency(2)             !! of the lowest and the highest mode [rad/s]
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(level_slot_t), allocatable, intent(inout) :: levels(:) !! made so far
    type(crossing_t), allocatable, intent(out) :: crossing(:)
    type(gap_t), allocatable, intent(out) :: gap(:)  !! speeds between which angles are not certain
    type(error_t), allocatable, intent(out) :: error !! why there is nothing

    type(angles_t), allocatable :: point(:), between(:)
    integer, allocatable :: level(:), bad(:)
    integer, allocatable :: partner(:, :) !! (angles, points but the last) at the next point
    integer :: i, k, first !! point of those asked for

    first = 1
    allocate (crossing(0), gap(0))
    point = first_points([minval(abs(request%speed)), maxval(abs(request%speed))], frequency)
    call find_all(point)
    do i = 1, most_refinements
      if (allocated(error) .or. was_interrupted()) return
      if (.not. any(point(1)%angle%is_real .and. abs(point(1)%angle%turns) < near_one)) exit
      between = point(:1)
      between%speed = point(1)%speed*exp(-step)
      call find_all(between)
      if (allocated(error) .or. was_interrupted()) return
      call insert([0], between, point)
      first = first + 1
    end do
    do i = 1, most_refinements
      if (allocated(error) .or. was_interrupted()) return
      bad = pack([(k, k=1, size(point) - 1)], is_bad(point))
      if (size(bad) == 0) exit
      first = first + count(bad < first)
      if (allocated(between)) deallocate (between)
      allocate (between(size(bad)))
      between%speed = sqrt(point(bad)%speed*point(bad + 1)%speed)
      call find_all(between)
      if (allocated(error) .or. was_interrupted()) return
      call insert(bad, between, point)
    end do
    bad = pack([(k, k=1, size(point) - 1)], is_bad(point))
    do i = 1, size(bad)
      gap = [gap, gap_t([point(bad(i))%speed, point(bad(i) + 1)%speed])]
    end do
    call bracket
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(crossing)
      if (.not. was_interrupted()) call solve(crossing(i))
    end do
    !$omp end parallel do
    crossing = pack(crossing, crossing%speed > 0.0_wp .and. crossing%mode <= request%modes)

  contains

    !> The angles at some speeds.
    subroutine find_all(points)
      type(angles_t), intent(inout) :: points(:)

      type(angles_t) :: found
      integer :: j

      if (allocated(level)) deallocate (level)
      allocate (level(size(points)))
      do j = 1, size(points)
        call find_level(points(j)%speed, level(j))
        if (allocated(error) .or. was_interrupted()) return
      end do
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(j, found)
      do j = 1, size(points)
        if (was_interrupted()) cycle
        call find_on(level(j), points(j)%speed, found)
        points(j) = found
      end do
      !$omp end parallel do
    end subroutine find_all

    subroutine find_on(number, speed, found)
      integer, intent(in) :: number !! of the level
      real(wp), intent(in) :: speed
      type(angles_t), intent(out) :: found

      associate (on => levels(number)%level)
        call find_angles(on, slow_number(on%grid, request%modes), speed, request%modes + beside, &
          found)
      end associate
    end subroutine find_on

    !> Finds or makes the level of a speed.
    subroutine find_level(speed, number)
      real(wp), intent(in) :: speed
      integer, intent(out) :: number

      integer :: order, at

      order = first_order(of_slow_motion)
      call need_level(structure, order, sample_numbers(1), request%speed(1) < 0.0_wp, store, &
        levels, number, error)
      if (allocated(error)) return
      at = first_samples(levels(number)%level%grid, request%modes, speed, of_slow_motion)
      if (at == 0) at = size(sample_numbers)
      call need_level(structure, order, sample_numbers(at), request%speed(1) < 0.0_wp, store, &
        levels, number, error)
      if (allocated(error)) return
      associate (on => levels(number)%level)
        call need_basis(slow_number(on%grid, request%modes), request%damping, on, error, .true.)
      end associate
    end subroutine find_level

    !> Whether some angle is not where it is expected, between neighbours.
    pure function is_bad(points) result(bad)
      type(angles_t), intent(in) :: points(:)
      logical :: bad(size(points) - 1)

      integer :: partner(request%modes + beside), j
      real(wp) :: mismatch

      do j = 1, size(bad)
        call match_angles(points(j), points(j + 1), modes_of(points(j)), &
          partner(:size(points(j)%angle)), mismatch)
        bad(j) = mismatch > most_mismatch
      end do
    end function is_bad

    !> Number of angles wanted; all that there are if the linkage has fewer.
    pure function modes_of(points) result(number)
      type(angles_t), intent(in) :: points
      integer :: number

      number = max(1, min(request%modes, size(points%angle)))
    end function modes_of

    !> Neighbours between which an angle changes its sign.
    subroutine bracket
      type(crossing_t) :: new
      integer :: j, m
      real(wp) :: mismatch, change

      allocate (partner(request%modes + beside, size(point) - 1))
      partner = 0
      do j = 1, size(point) - 1
        call match_angles(point(j), point(j + 1), modes_of(point(j)), &
          partner(:size(point(j)%angle), j), mismatch)
      end do
      do j = 1, size(point) - 1
        associate (here => point(j), there => point(j + 1))
          do m = 1, size(here%angle)
            if (partner(m, j) == 0) cycle
            associate (one => here%angle(m), other => there%angle(partner(m, j)))
              if (min(one%rate, other%rate) > most_line + 1.0_wp) cycle
              change = wrapped(other%turns - one%turns)
              if (abs(one%turns) > near_one .or. ((one%turns > 0.0_wp) .eqv. (one%turns + change &
                > 0.0_wp))) cycle
              if (j < first .and. .not. is_real_from(j + 1, partner(m, j))) cycle
              new%ends(:, 1) = [here%speed, one%turns]
              new%ends(:, 2) = [there%speed, one%turns + change]
              new%slope = change/(there%speed - here%speed)
              new%angle = one
              new%mode = usual_mode(j, m)
              ! Numbers may be exchanged next to it.
              if (new%mode > request%modes) new%mode = min(one%mode, other%mode)
              call find_level(here%speed, new%level)
              if (allocated(error)) return
              crossing = [crossing, new]
            end associate
          end do
        end associate
      end do
    end subroutine bracket

    !> Whether an angle before the points asked for stays real at 1 up to the first of them.
    pure logical function is_real_from(start, number)
      integer, intent(in) :: start  !! number of a point
      integer, intent(in) :: number !! of the angle there

      integer :: at, j

      at = number
      do j = start, first
        is_real_from = at > 0
        if (is_real_from) is_real_from = point(j)%angle(at)%is_real .and. &
          abs(point(j)%angle(at)%turns) < near_one
        if (.not. is_real_from) return
        if (j < first) at = partner(at, j)
      end do
    end function is_real_from

    !> The mode that an angle between two points has at most points around.
    pure function usual_mode(before, number) result(mode)
      integer, intent(in) :: before !! number of the point before
      integer, intent(in) :: number !! of the angle there
      integer :: mode

      integer :: times(request%modes + beside), at, j

      times = 0
      at = number
      do j = before, max(1, before - around), -1
        times(point(j)%angle(at)%mode) = times(point(j)%angle(at)%mode) + 1
        if (j > 1) at = findloc(partner(:, j - 1), at, dim=1)
        if (at == 0) exit
      end do
      at = number
      do j = before, min(size(partner, 2), before + around)
        at = partner(at, j)
        if (at == 0) exit
        times(point(j + 1)%angle(at)%mode) = times(point(j + 1)%angle(at)%mode) + 1
      end do
      mode = maxloc(times, dim=1)
    end function usual_mode

    !> Solves for the speed at which the angle is 0, by the Illinois method.
    subroutine solve(at)
      type(crossing_t), intent(inout) :: at

      type(angles_t) :: found
      integer :: j, m, side

      side = 0
      do j = 1, most_steps
        associate (a => at%ends(:, 1), b => at%ends(:, 2))
          at%speed = b(1) - b(2)*(b(1) - a(1))/(b(2) - a(2))
          call find_on(at%level, at%speed, found)
          if (size(found%angle) == 0) exit
          m = nearest_to_one(found%angle, at%angle%rate)
          at%angle = found%angle(m)
          if (abs(at%angle%turns) <= solved_to) exit
          if ((at%angle%turns > 0.0_wp) .eqv. (a(2) > 0.0_wp)) then
            a = [at%speed, at%angle%turns]
            if (side == 1) b(2) = 0.5_wp*b(2)
            side = 1
          else
            b = [at%speed, at%angle%turns]
            if (side == 2) a(2) = 0.5_wp*a(2)
            side = 2
          end if
        end associate
      end do
      ! A jump, not a crossing.
      if (size(found%angle) == 0 .or. abs(at%angle%turns) > of_slow_motion) at%speed = 0.0_wp
    end subroutine solve

  end subroutine find_crossings

  !> Speeds in steps in which the fastest vibration turns by a part of the circle, from that on at
  !! which the slowest is not too fast.
  pure function first_points(range, frequency) result(point)
    real(wp), intent(in) :: range(2)     !! of speeds [rad/s]
    real(wp), intent(in) :: frequency(2) !! of the slowest and the fastest vibration [rad/s]
    type(angles_t), allocatable :: point(:)

    real(wp) :: speed
    integer :: i, n

    do i = 1, 2
      if (i == 2) allocate (point(n))
      n = 0
      speed = min(range(2), max(range(1), frequency(1)/(most_line + 2)))
      do
        n = n + 1
        if (i == 2) point(n)%speed = speed
        if (speed >= range(2)) exit
        speed = min(range(2), speed*exp(step/max(1.0_wp, min(frequency(2)/speed, real(most_line, &
          wp)))))
      end do
    end do
  end function first_points

  !> Puts points between others, each after one of given numbers.
  pure subroutine insert(after, between, point)
    integer, intent(in) :: after(:) !! ascending; 0: before all
    type(angles_t), intent(in) :: between(:)
    type(angles_t), allocatable, intent(inout) :: point(:)

    type(angles_t) :: all(size(point) + size(between))
    integer :: i, j, k

    j = 0
    k = 0
    do i = 0, size(point)
      if (i > 0) then
        k = k + 1
        all(k) = point(i)
      end if
      if (.not. any(after == i)) cycle
      j = j + 1
      k = k + 1
      all(k) = between(j)
    end do
    point = all
  end subroutine insert

end module multiplier_crossings
