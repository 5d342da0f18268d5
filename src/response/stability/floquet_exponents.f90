!> Floquet exponents of an elastic linkage: `y = e^{σ θ} z(θ)` with z periodic solves the equation
!! of motion without load, `L(σ) z = (L0 + σ L1 + σ² L2) z = 0`.
!!
!! The slow motion gives first approximations. L is projected on a growing space of motions: of the
!! modes of the slow motion that are near, and of what the approximate inverse P makes of residuals
!! (Davidson's method). Where that does not end soon, the motion is that of the space for which
!! `P L(σ) z` is small (harmonic Ritz vectors; Morgan, Linear Algebra Appl. 154 (1991) 289):
!! exponents of modes of high frequency, known but for whole turns, lie densely everywhere, and
!! motions found by projection mix with them.
!!
!! Without damping `L(−σ̄)ᴴ = L(σ)`: values of stable modes are as good as the square of their
!! motions, from `zᴴL(σ) z = 0`, and so are those of unstable ones from their motion and that of
!! their partner at −σ̄.
module floquet_exponents
  use constants, only: two_pi
  use elastic_equations, only: add_damping_parts, equation_parts
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use periodic_solver, only: add_slow, complete_solution, slow_part
  use quadratic_pencil, only: find_pencil_modes
  use slow_bases, only: slow_basis_t
  use slow_motions, only: slow_mode_shape, slow_mode_t, slow_modes, slow_motion_t, &
    solve_slow_shifted
  use strain_dampings, only: is_damped
  implicit none (type, external)
  private

  public :: floquet_mode_t, find_floquet_modes, find_nearest_mode, floquet_pair_t, &
    find_floquet_pair

  !> The shift from the first approximation at which equations are solved: near enough to converge
  !! in a few rounds, far enough to leave them regular.
  real(wp), parameter :: shift = 1.0e-2_wp

  !> Modes of the slow motion whose exponents are no farther from each other than this are found
  !! together.
  real(wp), parameter :: together = 0.03_wp

  !> Most vectors of the space, and most that are near to begin with. When it is full it is begun
  !! anew with the mode, its partner and those near.
  integer, parameter :: most_vectors = 20, most_near = 8, most_rounds = 50

  !> Rounds of projection, without and with damping, before harmonic vectors are taken.
  integer, parameter :: rounds_of_projection(2) = [7, 12]

  !> Where only the nearness of resonance is asked for, the exponent changes by no more than this in
  !! the last round.
  real(wp), parameter :: rough_change = 1.0e-9_wp

  !> No exponent differs more than this from its first approximation.
  real(wp), parameter :: farthest = 0.02_wp

  !> Results that are better than those before by less than this are not kept, and so many rounds
  !! without a better one are the last.
  real(wp), parameter :: better_by = 0.7_wp
  integer, parameter :: most_idle = 25

  !> No smaller change of the square of a difference of exponents can be asked for.
  real(wp), parameter :: least_square_change = 1.0e-14_wp

  !> Two motions are nearly one if 1 less their product is less than this.
  real(wp), parameter :: nearly_one = 1.0e-4_wp

  !> A vector of which less is left in a space is in it.
  real(wp), parameter :: within = 1.0e-10_wp

  !> Modes with fewer samples a period are not resolved; exponents of the slow motion are right to
  !! about this much.
  real(wp), parameter :: resolved_samples = 6.0_wp, of_slow_motion = 1.0e-3_wp

  !> Growth of the slow motion above this is looked for in the whole equation.
  real(wp), parameter :: least_growth = 1.0e-6_wp

  !> Real parts above this are off the circle.
  real(wp), parameter :: off_circle = 1.0e-12_wp

  !> A mode of free motion.
  type :: floquet_mode_t
    complex(wp) :: exponent = (0.0_wp, 0.0_wp)  !! σ, per radian of the crank; its imaginary part is
                                                !! vibrations per turn, between 0 and 1/2
    real(wp) :: change = 0.0_wp                 !! of the exponent in the last rounds, or the error
                                                !! that its motion allows
    integer :: applications = 0                 !! of the equation, to complex motions
    real(wp) :: frequency = 0.0_wp              !! of its shape over the turn,
                                                !! `√(∮ zᴴz / ∮ zᴴM z)` [rad/s]
    real(wp), allocatable :: motion(:, :)       !! (samples, real and imaginary parts) z
    real(wp) :: action = 0.0_wp                 !! `Im ∮ zᴴ(L1 + 2σ L2) z`, about 1 or −1 by the
                                                !! Krein signature, 0 at collisions
  end type floquet_mode_t

  !> Two modes whose multipliers are near each other, or one mode and its conjugate. That of the
  !! exponents which the slow motion gives for the second is meant whose conjugate, if wanted, has
  !! so many turns more.
  type :: floquet_pair_t
    integer :: mode(2) = 0           !! numbers among the modes of the slow motion
    logical :: conjugate = .false.   !! the second is the conjugate of that mode
    integer :: waves = 0             !! turns that the second has more
    complex(wp) :: exponent(2) = 0.0_wp !! found, on sheets where they are near each other
    real(wp) :: tolerance = 0.0_wp   !! of the last change of the square of their difference
    real(wp) :: change = 0.0_wp      !! of that
    integer :: applications = 0      !! of the equation, to complex motions
    !> (samples, real and imaginary parts, vectors) both modes, to begin with at a speed near by
    real(wp), allocatable :: known(:, :, :)
  end type floquet_pair_t

  !> Vectors, orthonormal, with what the equation and the approximate inverse make of them.
  type :: space_t
    integer :: number = 0
    real(wp), allocatable :: vector(:, :, :)    !! (samples, real and imaginary parts, vectors)
    real(wp), allocatable :: parts(:, :, :, :)  !! (…, 0:2, vectors) L0 v, L1 v, L2 v
    complex(wp), allocatable :: form(:, :, :)   !! (vectors, vectors, 0:2) vᴴ L v
    logical :: is_harmonic = .false.            !! it also has:
    real(wp), allocatable :: solved(:, :, :, :) !! (…, 0:3, vectors) P L0 v, P L1 v, P L2 v, and
                                                !! P L(σ0) v at the shift σ0
    complex(wp), allocatable :: harmonic(:, :, :) !! (vectors, vectors, 0:2) (P L(σ0) v)ᴴ P L v
    complex(wp), allocatable :: near(:, :)      !! (vectors, modes near) these in the vectors
  end type space_t

contains

  !> Modes of the whole equation that belong to modes of the slow motion. They are found sooner if
  !! they are known from other orders or samples.
  subroutine find_floquet_modes(equation, tolerance, slow, wanted, modes, known)
    type(equation_at_speed_t), intent(in) :: equation !! its motion with as many steps as samples
    real(wp), intent(in) :: tolerance          !! of the last change of an exponent; where it is not
                                               !! reached, `change` says so
    type(slow_mode_t), intent(in) :: slow(:)   !! all modes of the slow motion
    integer, intent(in) :: wanted(:)           !! numbers of those that are wanted
    type(floquet_mode_t), intent(out) :: modes(:) !! (as many)
    type(floquet_mode_t), intent(in), optional :: known(:) !! the same, with exponents and motions

    integer :: i

    do i = 1, size(wanted)
      if (present(known)) then
        call refine(equation, tolerance, slow, wanted(i), modes(i), known=known(i))
      else
        call refine(equation, tolerance, slow, wanted(i), modes(i))
      end if
    end do
  end subroutine find_floquet_modes

  !> Two modes of the whole equation together: where multipliers meet, the square of the difference
  !! of their exponents is found as well as elsewhere, each by itself is not.
  subroutine find_floquet_pair(equation, slow, pair)
    type(equation_at_speed_t), intent(in) :: equation !! its motion with as many steps as samples
    type(slow_mode_t), intent(in) :: slow(:)   !! all modes of the slow motion
    type(floquet_pair_t), intent(inout) :: pair !! gets its exponents

    type(floquet_mode_t) :: mode

    call refine(equation, 0.0_wp, slow, pair%mode(1), mode, pair)
    pair%applications = mode%applications
  end subroutine find_floquet_pair

  !> The mode whose multiplier is nearest to 1, which says how near the linkage is to resonance, and
  !! the largest growth of any. Only modes count whose vibrations the samples resolve.
  !!
  !! Errors: the multipliers of the slow motion do not converge.
  subroutine find_nearest_mode(equation, near, mode, growth, error)
    type(equation_at_speed_t), intent(in) :: equation !! its motion with as many steps as samples
    real(wp), intent(in) :: near               !! nearer multipliers are found from the whole
                                               !! equation
    type(floquet_mode_t), intent(out) :: mode  !! with all applications
    real(wp), intent(out) :: growth            !! largest ln|multiplier|; 0 or less where none is
                                               !! certain to grow
    type(error_t), allocatable, intent(out) :: error

    type(slow_mode_t), allocatable :: slow(:)
    type(floquet_mode_t) :: grown
    logical, allocatable :: resolved(:)
    integer :: nearest, growing

    growth = 0.0_wp
    call slow_modes(equation%basis, equation%motion, slow, error)
    if (allocated(error)) return
    resolved = slow%frequency <= abs(equation%speed)*equation%motion%steps/resolved_samples
    if (.not. any(resolved)) resolved = slow%frequency <= minval(slow%frequency)
    nearest = minloc(abs(1.0_wp - exp(two_pi*slow%exponent)), dim=1, mask=resolved)
    call take(nearest, abs(1.0_wp - exp(two_pi*slow(nearest)%exponent)) < near, mode)
    growing = maxloc(real(slow%exponent, wp), dim=1, mask=resolved)
    call take(growing, two_pi*real(slow(growing)%exponent) > least_growth, grown)
    ! Growth that is found in the slow motion only may come from its steps.
    growth = two_pi*real(grown%exponent)
    if (grown%change > 0.1_wp*growth) growth = min(growth, 0.0_wp)
    mode%applications = mode%applications + grown%applications

  contains

    !> A mode of the slow motion, or of the whole equation.
    subroutine take(number, whole, mode)
      integer, intent(in) :: number
      logical, intent(in) :: whole
      type(floquet_mode_t), intent(out) :: mode

      mode%exponent = slow(number)%exponent
      mode%frequency = slow(number)%frequency
      mode%change = of_slow_motion
      if (.not. whole) return
      call refine(equation, rough_change, slow, number, mode)
      ! Iterations that lead elsewhere say nothing.
      if (abs(mode%exponent - slow(number)%exponent) <= farthest .and. &
        mode%change <= farthest) return
      mode%exponent = slow(number)%exponent
      mode%change = farthest
    end subroutine take

  end subroutine find_nearest_mode

  !> A slow mode in all unknowns: real parts, then imaginary parts; or its conjugate.
  pure function expanded(basis, motion, mode, conjugate, waves) result(z)
    type(slow_basis_t), intent(in) :: basis
    type(slow_motion_t), intent(in) :: motion
    type(slow_mode_t), intent(in) :: mode
    logical, intent(in) :: conjugate
    integer, intent(in) :: waves !! per turn that the exponent has more
    real(wp) :: z(size(basis%shape, 1), 2*size(basis%shape, 2))

    complex(wp) :: shape(motion%steps, motion%number)
    integer :: k, n

    n = size(basis%shape, 2)
    z = 0.0_wp
    shape = slow_mode_shape(motion, mode)
    if (conjugate) shape = conjg(shape)
    if (waves /= 0) then
      do k = 1, motion%steps
        shape(k, :) = exp(cmplx(0.0_wp, -waves*two_pi*(k - 1)/motion%steps, wp))*shape(k, :)
      end do
    end if
    call add_slow(basis, real(shape, wp), z(:, :n))
    call add_slow(basis, aimag(shape), z(:, n + 1:))
    z = z/norm2(z)
  end function expanded

  !> A mode of the whole equation, or two together.
  subroutine refine(equation, tolerance, slow, wanted, mode, pair, known)
    type(equation_at_speed_t), intent(in) :: equation
    real(wp), intent(in) :: tolerance          !! of the last change
    type(slow_mode_t), intent(in) :: slow(:)
    integer, intent(in) :: wanted              !! its number
    type(floquet_mode_t), intent(out) :: mode
    type(floquet_pair_t), intent(inout), optional :: pair !! that mode and another
    type(floquet_mode_t), intent(in), optional :: known   !! about that mode

    type(space_t) :: space
    complex(wp), allocatable :: values(:), vectors(:, :), weights(:), partner_weights(:)
    complex(wp), allocatable :: best(:) !! weights of the mode, as far as it is not described
    complex(wp) :: fixed, expected, followed, followed_partner, second
    complex(wp) :: square, square_before
    real(wp), dimension(equation%grid%samples, 2*equation%grid%unknowns) :: residual, correction
    real(wp) :: error
    complex(wp) :: here
    integer :: idle, number, p, partner, round
    logical :: damped, grew

    damped = is_damped(equation%damping)
    mode%exponent = slow(wanted)%exponent
    mode%change = huge(1.0_wp)
    if (present(pair)) pair%change = huge(1.0_wp)
    fixed = mode%exponent + shift
    expected = mode%exponent
    if (present(known)) then
      expected = known%exponent
      if (known%change < shift) fixed = expected + shift
    end if
    square = 0.0_wp
    idle = 0
    call start
    do round = 1, most_rounds
      if (space%is_harmonic) then
        call find_pencil_modes(space%harmonic(:space%number, :space%number, :), fixed, values, &
          vectors)
      else
        call find_pencil_modes(space%form(:space%number, :space%number, :), fixed, values, vectors)
      end if
      if (size(values) == 0) exit
      number = minloc(distance(values, vectors, expected), dim=1)
      followed = values(number)
      partner = number
      if (.not. damped .and. abs(real(followed)) > off_circle) &
        partner = minloc(abs(values + conjg(followed)), dim=1)
      if (damped) partner = maxloc(abs(matmul(conjg(matmul(slope_of_form(followed), &
        vectors(:, number))), vectors)), dim=1, mask=abs(aimag(values - followed)) < together)
      if (present(pair)) partner = minloc(distance(values, vectors, second), dim=1, &
        mask=[(p /= number, p=1, size(values))])
      if (partner == 0) exit
      followed_partner = values(partner)
      weights = vectors(:, number)
      partner_weights = vectors(:, partner)
      here = followed
      if (present(pair)) pair%exponent = [followed, followed_partner]
      if (space%is_harmonic .and. .not. (damped .and. present(pair))) call take_value_of_form
      ! A mode may take half a minute.
      if (was_interrupted()) exit
      if (present(pair)) then
        square_before = square
        square = (pair%exponent(1) - pair%exponent(2))**2
        pair%change = abs(square - square_before)
        if (round > 1 .and. pair%change <= max(pair%tolerance, least_square_change)) exit
      end if
      call find_residual(here, weights, residual)
      call approximate(residual, correction)
      ! A pair has no use for what one motion allows to be wrong.
      if (.not. present(pair)) then
        error = doubt()
        idle = idle + 1
        if (error < better_by*mode%change .or. error <= tolerance) then
          mode%exponent = here
          mode%change = error
          idle = 0
          best = weights
        end if
        if (error <= tolerance .or. idle == most_idle) exit
      end if
      if (round == rounds_of_projection(merge(2, 1, damped))) then
        call describe
        call gather(weights, partner_weights)
        if (.not. present(pair) .and. mode%change < shift) fixed = mode%exponent + shift
        call make_harmonic
      end if
      if (space%number > most_vectors - 2) then
        call describe
        call gather(weights, partner_weights)
      end if
      grew = .false.
      if (partner /= number) then
        call add_vector(correction, grew)
        call find_residual(followed_partner, partner_weights, residual)
        call approximate(residual, correction)
      end if
      call add_vector(correction, grew)
      if (.not. grew) exit
    end do
    call describe
    if (present(pair) .and. allocated(weights)) call remember

  contains

    !> The space of the slow modes that are near, each on the sheet that is nearest.
    subroutine start
      complex(wp) :: there
      integer :: i, waves, kind
      logical :: added

      allocate (space%vector(equation%grid%samples, 2*equation%grid%unknowns, most_vectors), &
        space%parts(equation%grid%samples, 2*equation%grid%unknowns, 0:2, most_vectors), &
        space%form(most_vectors, most_vectors, 0:2))
      added = .false.
      if (present(pair)) then
        second = slow(pair%mode(2))%exponent
        if (pair%conjugate) second = conjg(second)
        second = second + cmplx(0.0_wp, pair%waves, wp)
        if (allocated(pair%known)) then
          do i = 1, size(pair%known, 3)
            call add_vector(pair%known(:, :, i), added)
          end do
        end if
      end if
      if (present(known)) call add_vector(known%motion, added)
      if (space%number < 2 .and. .not. present(known)) call add_vector(expanded(equation%basis, &
        equation%motion, slow(wanted), .false., 0), added)
      if (present(pair) .and. space%number < 2) call add_vector(expanded(equation%basis, &
        equation%motion, slow(pair%mode(2)), pair%conjugate, pair%waves), added)
      do i = 1, size(slow)
        do kind = 1, 2
          if (kind == 2 .and. .not. slow(i)%is_complex) cycle
          there = merge(conjg(slow(i)%exponent), slow(i)%exponent, kind == 2)
          waves = nint(aimag(mode%exponent - there))
          if (i == wanted .and. kind == 1) cycle
          if (is_second(i, kind, waves)) cycle
          if (abs(there + cmplx(0.0_wp, waves, wp) - mode%exponent) > together) cycle
          if (space%number == most_near) exit
          call add_vector(expanded(equation%basis, equation%motion, slow(i), kind == 2, waves), &
            added)
        end do
      end do
      space%near = unit_matrix(space%number)
    end subroutine start

    !> Whether a mode of the slow motion is the second of the pair.
    pure function is_second(i, kind, waves) result(is)
      integer, intent(in) :: i, kind, waves
      logical :: is

      is = .false.
      if (present(pair)) is = i == pair%mode(2) .and. (kind == 2 .eqv. pair%conjugate) .and. &
        waves == pair%waves
    end function is_second

    !> How far modes are from the one that is meant, or one of a pair: by exponents, and by the
    !! part of their motions that is of those with which the space began. Values of the projection
    !! that are of no mode have no such part, and where several modes meet all have some.
    pure function distance(values, vectors, expected)
      complex(wp), intent(in) :: values(:), vectors(:, :), expected
      real(wp) :: distance(size(values))

      integer :: k, meant, n

      meant = merge(2, 1, present(pair))
      n = size(space%near, 1)
      do k = 1, size(values)
        distance(k) = abs((values(k) - expected)/shift)**2 + (1.0_wp - &
          sum(abs(matmul(conjg(transpose(space%near(:, :meant))), vectors(:n, k)))**2))**2
      end do
    end function distance

    !> The value that `vᴴL(σ) v` gives, with that of the partner.
    subroutine take_value_of_form
      complex(wp), allocatable :: roots(:), ignored(:, :)
      complex(wp) :: q(size(weights), 2), small(2, 2, 0:2)
      real(wp) :: length
      integer :: n, p

      n = size(weights)
      q(:, 1) = weights/sqrt(sum(abs(weights)**2))
      q(:, 2) = partner_weights - dot_product(q(:, 1), partner_weights)*q(:, 1)
      length = sqrt(sum(abs(q(:, 2))**2))
      if (length > within) q(:, 2) = q(:, 2)/length
      do p = 0, 2
        small(:, :, p) = matmul(conjg(transpose(q)), matmul(space%form(:n, :n, p), q))
      end do
      p = merge(2, 1, length > within .and. partner /= number)
      call find_pencil_modes(small(:p, :p, :), fixed, roots, ignored)
      if (size(roots) == 0) return
      n = minloc(abs(roots - followed), dim=1)
      here = roots(n)
      if (.not. present(pair) .or. size(roots) == 1) return
      p = minloc(abs(roots - followed_partner), dim=1, mask=[(p /= n, p=1, size(roots))])
      pair%exponent = roots([n, p])
    end subroutine take_value_of_form

    !> Keeps both modes for a speed near by, unless they are nearly one: nothing is left of the
    !! plane in which they are then.
    subroutine remember
      if (allocated(pair%known)) deallocate (pair%known)
      if (1.0_wp - abs(dot_product(weights, partner_weights))/(norm2(abs(weights))* &
        norm2(abs(partner_weights))) < nearly_one) return
      allocate (pair%known(equation%grid%samples, 2*equation%grid%unknowns, 2))
      pair%known(:, :, 1) = motion_of(weights)
      pair%known(:, :, 2) = motion_of(partner_weights)
    end subroutine remember

    !> Begins the space anew with the mode, its partner and the modes near.
    subroutine gather(weights, partner_weights)
      complex(wp), allocatable, intent(inout) :: weights(:), partner_weights(:)

      complex(wp) :: q(space%number, size(space%near, 2) + 2)
      real(wp), allocatable :: vector(:, :, :), parts(:, :, :, :), solved(:, :, :, :)
      complex(wp), allocatable :: near(:, :)
      real(wp) :: length
      integer :: c, i, k, n, p, time

      n = space%number
      allocate (near(n, size(space%near, 2)))
      near = 0.0_wp
      near(:size(space%near, 1), :) = space%near
      k = 0
      do c = 1, size(q, 2)
        k = k + 1
        if (c == 1) q(:, k) = weights
        if (c == 2) q(:, k) = partner_weights
        if (c > 2) q(:, k) = near(:, c - 2)
        do time = 1, 2
          do i = 1, k - 1
            q(:, k) = q(:, k) - dot_product(q(:, i), q(:, k))*q(:, i)
          end do
          length = sqrt(sum(abs(q(:, k))**2))
          if (length < within) exit
          q(:, k) = q(:, k)/length
        end do
        if (length < within) k = k - 1
      end do
      associate (samples => equation%grid%samples, unknowns => equation%grid%unknowns)
        allocate (vector(samples, 2*unknowns, k), parts(samples, 2*unknowns, 0:2, k), &
          solved(samples, 2*unknowns, 0:3, merge(k, 0, space%is_harmonic)))
      end associate
      vector = 0.0_wp
      parts = 0.0_wp
      solved = 0.0_wp
      do c = 1, k
        do i = 1, n
          call add_times(q(i, c), space%vector(:, :, i), vector(:, :, c))
          do p = 0, 2
            call add_times(q(i, c), space%parts(:, :, p, i), parts(:, :, p, c))
          end do
          if (.not. space%is_harmonic) cycle
          do p = 0, 3
            call add_times(q(i, c), space%solved(:, :, p, i), solved(:, :, p, c))
          end do
        end do
      end do
      space%vector(:, :, :k) = vector
      space%parts(:, :, :, :k) = parts
      if (space%is_harmonic) space%solved(:, :, :, :k) = solved
      associate (left => conjg(transpose(q(:, :k))))
        do p = 0, 2
          space%form(:k, :k, p) = matmul(left, matmul(space%form(:n, :n, p), q(:, :k)))
          if (space%is_harmonic) space%harmonic(:k, :k, p) = matmul(left, &
            matmul(space%harmonic(:n, :n, p), q(:, :k)))
        end do
        space%near = matmul(left, near)
        weights = matmul(left, weights)
        partner_weights = matmul(left, partner_weights)
      end associate
      space%number = k
    end subroutine gather

    !> From now on vectors of the space are chosen by what is left of them.
    subroutine make_harmonic
      integer :: k

      allocate (space%solved(equation%grid%samples, 2*equation%grid%unknowns, 0:3, most_vectors), &
        space%harmonic(most_vectors, most_vectors, 0:2))
      space%is_harmonic = .true.
      do k = 1, space%number
        call add_solved(k)
      end do
    end subroutine make_harmonic

    !> What the approximate inverse makes of a vector, and its products with those before.
    subroutine add_solved(k)
      integer, intent(in) :: k

      integer :: i, p

      do p = 0, 2
        call approximate(space%parts(:, :, p, k), space%solved(:, :, p, k))
      end do
      space%solved(:, :, 3, k) = space%solved(:, :, 0, k) + times(fixed, &
        space%solved(:, :, 1, k) + times(fixed, space%solved(:, :, 2, k)))
      do p = 0, 2
        do i = 1, k
          space%harmonic(i, k, p) = product_of(space%solved(:, :, 3, i), space%solved(:, :, p, k))
          if (i < k) space%harmonic(k, i, p) = product_of(space%solved(:, :, 3, k), &
            space%solved(:, :, p, i))
        end do
      end do
    end subroutine add_solved

    !> How wrong the exponent may be by the residual r of its motion, which lacks e, about the
    !! correction. With w, the motion of the adjoint equation, and v, that of the partner, which is
    !! about w, the error is `wᴴr/(wᴴL'(σ) z)`, and since `vᴴr = 0` and r is `−L(σ) e` to first
    !! order, `wᴴr = (L(σ)ᴴv)ᴴe`. Products of all samples count with their absolute values. Where
    !! multipliers meet the error is the root of a quadratic equation.
    function doubt()
      real(wp) :: doubt

      real(wp) :: motion(equation%grid%samples, 2*equation%grid%unknowns), product, slope, bend

      motion = motion_of(weights)
      product = sum_of_absolute_products(adjoint_residual(), correction - times( &
        product_of(motion, correction), motion))
      slope = abs(dot_product(partner_weights, matmul(slope_of_form(here), weights)))
      bend = abs(dot_product(partner_weights, matmul(space%form(:space%number, :space%number, 2), &
        weights)))
      if (slope**2 > 4.0_wp*bend*product) then
        doubt = 2.0_wp*product/(slope + sqrt(slope**2 - 4.0_wp*bend*product))
      else
        doubt = sqrt(product/max(bend, tiny(1.0_wp)))
      end if
    end function doubt

    !> A vector of the space.
    function motion_of(weights) result(z)
      complex(wp), intent(in) :: weights(:) !! of its vectors
      real(wp) :: z(equation%grid%samples, 2*equation%grid%unknowns)

      integer :: i

      z = 0.0_wp
      do i = 1, size(weights)
        call add_times(weights(i), space%vector(:, :, i), z)
      end do
    end function motion_of

    !> `L(σ)ᴴ v` of the partner's motion v: L at −σ̄, with damping that drives.
    function adjoint_residual() result(left)
      real(wp) :: left(equation%grid%samples, 2*equation%grid%unknowns)

      real(wp) :: v(equation%grid%samples, 2*equation%grid%unknowns), &
        parts(equation%grid%samples, 2*equation%grid%unknowns, 0:1)
      integer :: n

      ! On the circle it is that of the mode itself.
      left = residual
      if (partner == number .and. .not. damped .and. abs(real(here)) <= off_circle) return
      call find_residual(-conjg(here), partner_weights, left)
      if (.not. damped) return
      n = equation%grid%unknowns
      v = motion_of(partner_weights)
      parts = 0.0_wp
      call add_damping_parts(equation%grid, equation%plan, equation%speed, equation%damping, &
        v(:, :n), parts(:, :n, :))
      call add_damping_parts(equation%grid, equation%plan, equation%speed, equation%damping, &
        v(:, n + 1:), parts(:, n + 1:, :))
      left = left - 2.0_wp*(parts(:, :, 0) - times(conjg(here), parts(:, :, 1)))
    end function adjoint_residual

    !> `vᴴL'(σ) v`.
    pure function slope_of_form(exponent) result(slope)
      complex(wp), intent(in) :: exponent
      complex(wp) :: slope(space%number, space%number)

      slope = space%form(:space%number, :space%number, 1) + 2.0_wp*exponent*space%form( &
        :space%number, :space%number, 2)
    end function slope_of_form

    !> Adds a vector to the space, unless it is in it.
    subroutine add_vector(new, added)
      real(wp), intent(in) :: new(:, :)
      logical, intent(inout) :: added

      real(wp) :: v(size(new, 1), size(new, 2)), length
      integer :: i, k, n, p, time

      if (space%number == most_vectors) return
      v = new
      length = norm2(v)
      if (.not. (length > 0.0_wp .and. length <= huge(1.0_wp))) return
      v = v/length
      do time = 1, 2
        do i = 1, space%number
          call add_times(-product_of(space%vector(:, :, i), v), space%vector(:, :, i), v)
        end do
        length = norm2(v)
        if (length < within) return
        v = v/length
      end do
      k = space%number + 1
      n = size(v, 2)/2
      space%vector(:, :, k) = v
      call equation_parts(equation%grid, equation%plan, equation%speed, equation%damping, &
        equation%terms, v(:, :n), space%parts(:, :n, :, k))
      call equation_parts(equation%grid, equation%plan, equation%speed, equation%damping, &
        equation%terms, v(:, n + 1:), space%parts(:, n + 1:, :, k))
      mode%applications = mode%applications + 1
      do p = 0, 2
        do i = 1, k
          space%form(i, k, p) = product_of(space%vector(:, :, i), space%parts(:, :, p, k))
          if (damped) then
            space%form(k, i, p) = product_of(v, space%parts(:, :, p, i))
          else
            ! L0 and L2 are Hermitian, L1 is not but for its sign.
            space%form(k, i, p) = merge(-1, 1, p == 1)*conjg(space%form(i, k, p))
          end if
        end do
      end do
      if (space%is_harmonic) call add_solved(k)
      space%number = k
      added = .true.
    end subroutine add_vector

    !> An approximate solution of the equation at the fixed shift.
    subroutine approximate(load, y)
      real(wp), intent(in) :: load(:, :)
      real(wp), intent(out) :: y(:, :)

      real(wp), dimension(equation%grid%samples, equation%basis%number) :: part, part_imaginary, &
        z, z_imaginary
      integer :: n

      n = equation%grid%unknowns
      call slow_part(equation%basis, load(:, :n), part)
      call slow_part(equation%basis, load(:, n + 1:), part_imaginary)
      call solve_slow_shifted(equation%plan, equation%motion, fixed, part/equation%speed**2, &
        part_imaginary/equation%speed**2, z, z_imaginary)
      call complete_solution(equation, load(:, :n), part, z, y(:, :n))
      call complete_solution(equation, load(:, n + 1:), part_imaginary, z_imaginary, y(:, n + 1:))
    end subroutine approximate

    !> What a vector of the space leaves in the equation.
    subroutine find_residual(exponent, weights, residual)
      complex(wp), intent(in) :: exponent
      complex(wp), intent(in) :: weights(:) !! of the vectors
      real(wp), intent(out) :: residual(:, :)

      integer :: i, p

      residual = 0.0_wp
      do i = 1, size(weights)
        do p = 0, 2
          call add_times(weights(i)*exponent**p, space%parts(:, :, p, i), residual)
        end do
      end do
    end subroutine find_residual

    !> Motion, frequency and action of the mode, before the space in which it is changes.
    subroutine describe
      real(wp), dimension(equation%grid%samples, 2*equation%grid%unknowns) :: z, first, second
      complex(wp) :: kinetic
      integer :: i

      if (.not. allocated(best)) return
      z = motion_of(best)
      first = 0.0_wp
      second = 0.0_wp
      do i = 1, size(best)
        call add_times(best(i), space%parts(:, :, 1, i), first)
        call add_times(best(i), space%parts(:, :, 2, i), second)
      end do
      mode%motion = z
      kinetic = product_of(z, second)
      mode%frequency = abs(equation%speed)*norm2(z)/sqrt(max(real(kinetic), tiny(1.0_wp)))
      mode%action = aimag(product_of(z, first) + 2.0_wp*mode%exponent*kinetic)/ &
        (2.0_wp*norm2(z)*sqrt(max(real(kinetic), tiny(1.0_wp))))
      deallocate (best)
    end subroutine describe

  end subroutine refine

  !> The unit matrix.
  pure function unit_matrix(n) result(matrix)
    integer, intent(in) :: n
    complex(wp) :: matrix(n, n)

    integer :: i

    matrix = 0.0_wp
    do i = 1, n
      matrix(i, i) = 1.0_wp
    end do
  end function unit_matrix

  !> `zᴴ f`.
  pure function product_of(z, f) result(product)
    real(wp), intent(in) :: z(:, :), f(:, :)
    complex(wp) :: product

    real(wp), dimension(size(z, 1)) :: re, im
    integer :: j, n

    n = size(z, 2)/2
    re = 0.0_wp
    im = 0.0_wp
    ! Two columns at once: the sums are in memory, and go there and back once.
    do j = 1, n - 1, 2
      re = re + z(:, j)*f(:, j) + z(:, n + j)*f(:, n + j) + z(:, j + 1)*f(:, j + 1) + &
        z(:, n + j + 1)*f(:, n + j + 1)
      im = im + z(:, j)*f(:, n + j) - z(:, n + j)*f(:, j) + z(:, j + 1)*f(:, n + j + 1) - &
        z(:, n + j + 1)*f(:, j + 1)
    end do
    if (modulo(n, 2) == 1) then
      re = re + z(:, n)*f(:, n) + z(:, 2*n)*f(:, 2*n)
      im = im + z(:, n)*f(:, 2*n) - z(:, 2*n)*f(:, n)
    end if
    product = cmplx(sum(re), sum(im), wp)
  end function product_of

  !> `Σ |z| |f|`.
  pure function sum_of_absolute_products(z, f) result(product)
    real(wp), intent(in) :: z(:, :), f(:, :)
    real(wp) :: product

    integer :: n

    n = size(z, 2)/2
    product = sum(sqrt((z(:, :n)**2 + z(:, n + 1:)**2)*(f(:, :n)**2 + f(:, n + 1:)**2)))
  end function sum_of_absolute_products

  !> `c f`.
  pure function times(c, f) result(product)
    complex(wp), intent(in) :: c
    real(wp), intent(in) :: f(:, :) !! (samples, real and imaginary parts)
    real(wp) :: product(size(f, 1), size(f, 2))

    integer :: n

    n = size(f, 2)/2
    product(:, :n) = real(c)*f(:, :n) - aimag(c)*f(:, n + 1:)
    product(:, n + 1:) = real(c)*f(:, n + 1:) + aimag(c)*f(:, :n)
  end function times

  !> Adds `c f`.
  pure subroutine add_times(c, f, total)
    complex(wp), intent(in) :: c
    real(wp), intent(in) :: f(:, :)        !! (samples, real and imaginary parts)
    real(wp), intent(inout) :: total(:, :)

    integer :: j, n

    n = size(f, 2)/2
    do j = 1, n
      total(:, j) = total(:, j) + real(c)*f(:, j) - aimag(c)*f(:, n + j)
      total(:, n + j) = total(:, n + j) + real(c)*f(:, n + j) + aimag(c)*f(:, j)
    end do
  end subroutine add_times

end module floquet_exponents
