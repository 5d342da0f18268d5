!> Starts for the roots of `(s² M + s C + K) y = 0`: the roots of the equations of a few shapes.
module damped_shapes
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_matrix, only: bordered_times_vector
  use bordered_pencil, only: bordered_pencil_t, stiffness_times_vector
  use bordered_solver, only: solve_shifted
  use damped_count, only: damper_response_t, moment_count
  use damped_solver, only: damped_system_t
  use kinds, only: wp
  use lapack, only: dgeev, dgetrf, dgetrs
  implicit none (type, external)
  private

  public :: build_shapes, solve_reduced

  !> Shapes that are nearly combinations of others are left out.
  real(wp), parameter :: independent = 1.0e-7_wp

contains

  !> Shapes for the reduced equations, orthonormal in M: undamped modes, what forces at the dampers
  !! do statically, and what the inertia of that does; and what the dampers are told by all modes.
  subroutine build_shapes(system, undamped, known, shapes, response)
    type(damped_system_t), intent(in) :: system
    type(bordered_modes_t), intent(in) :: undamped
    integer, intent(in) :: known                    !! undamped modes that miss none
    real(wp), allocatable, intent(out) :: shapes(:, :) !! (unknowns, shapes)
    type(damper_response_t), intent(out) :: response !! for the count of roots in a disc

    real(wp), dimension(system%pencil%layout%unknowns, size(system%dampers, 2)) :: first, second
    integer :: j, modes, number

    associate (pencil => system%pencil, dampers => system%dampers)
      response%lambda = undamped%lambda
      response%limit = undamped%lambda(known)
      if (known == pencil%layout%unknowns) response%limit = huge(1.0_wp)
      response%shift = 2.0_wp*max(0.0_wp, -undamped%lambda(1)) + &
        1.0e-2_wp*maxval(abs(undamped%lambda(:known)))
      modes = size(undamped%lambda)
      allocate (response%excitation(size(dampers, 2), modes))
      do j = 1, modes
        response%excitation(:, j) = matmul(undamped%vector(:size(dampers, 1), j), dampers)
      end do
      call find_moments(system, known == pencil%layout%unknowns, response, first, second)
      allocate (shapes(pencil%layout%unknowns, modes + 2*size(dampers, 2)))
      shapes(:, :modes) = undamped%vector
      number = modes
      do j = 1, size(dampers, 2)
        call add_shape(pencil, first(:, j), shapes, number)
        call add_shape(pencil, second(:, j), shapes, number)
      end do
    end associate
    shapes = shapes(:, :number)
  end subroutine build_shapes

  !> What forces at the dampers do statically, what the inertia of that does, and of these the
  !! moments of all modes that are not known.
  subroutine find_moments(system, all_known, response, first, second)
    type(damped_system_t), intent(in) :: system
    logical, intent(in) :: all_known            !! there are no other modes
    type(damper_response_t), intent(inout) :: response !! with its modes and shift
    real(wp), intent(out) :: first(:, :)        !! (unknowns, dampers) displacements by forces
    real(wp), intent(out) :: second(:, :)       !! (unknowns, dampers) by the inertia of these

    real(wp), dimension(size(first, 1), size(first, 2)) :: mass_first, mass_second
    real(wp) :: force(size(first, 1)), inverse
    integer :: d, i, j

    d = size(first, 2)
    allocate (response%moment(d, d, moment_count), response%rounding(d, moment_count))
    associate (pencil => system%pencil, dampers => system%dampers)
      do i = 1, d
        force = 0.0_wp
        force(:pencil%layout%border) = dampers(:, i)
        call solve_shifted(pencil, -response%shift, force, first(:, i))
        call bordered_times_vector(pencil%layout, pencil%mass, first(:, i), mass_first(:, i))
        call solve_shifted(pencil, -response%shift, mass_first(:, i), second(:, i))
        call bordered_times_vector(pencil%layout, pencil%mass, second(:, i), mass_second(:, i))
      end do
      response%moment(:, :, 1) = matmul(transpose(dampers), first(:size(dampers, 1), :))
    end associate
    response%moment(:, :, 2) = matmul(transpose(first), mass_first)
    response%moment(:, :, 3) = matmul(transpose(first), mass_second)
    response%moment(:, :, 4) = matmul(transpose(second), mass_second)
    do i = 1, moment_count
      associate (moment => response%moment(:, :, i))
        response%rounding(:, i) = 64.0_wp*epsilon(1.0_wp)*[(abs(moment(j, j)), j=1, d)]
        do j = 1, size(response%lambda)
          inverse = 1.0_wp/(response%lambda(j) + response%shift)
          moment = moment - inverse**i*matmul(reshape(response%excitation(:, j), [d, 1]), &
            reshape(response%excitation(:, j), [1, d]))
        end do
      end associate
    end do
    if (.not. all_known) return
    response%moment = 0.0_wp
    response%rounding = 0.0_wp
  end subroutine find_moments

  !> Adds the component of a shape that is orthogonal to the others in M, if anything is left of it.
  subroutine add_shape(pencil, shape, shapes, number)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: shape(:)
    real(wp), intent(inout) :: shapes(:, :) !! (unknowns, room)
    integer, intent(inout) :: number        !! of those that are there

    real(wp), dimension(size(shape)) :: rest, product
    real(wp) :: before
    integer :: k, pass

    rest = shape
    call bordered_times_vector(pencil%layout, pencil%mass, rest, product)
    before = dot_product(rest, product)
    if (.not. before > 0.0_wp) return
    do pass = 1, 2
      do k = 1, number
        rest = rest - dot_product(product, shapes(:, k))*shapes(:, k)
        call bordered_times_vector(pencil%layout, pencil%mass, rest, product)
      end do
    end do
    if (.not. dot_product(rest, product) > independent**2*before) return
    number = number + 1
    shapes(:, number) = rest/sqrt(dot_product(rest, product))
  end subroutine add_shape

  !> All roots of the reduced equations, with s = σ0 + 1/μ: those near a positive σ0 do not suffer
  !! from others that are far away. Where LAPACK fails, none.
  !!
  !! Of a free motion at rest the velocity is the unknown, so that its position has no root: those
  !! at zero would be multiple and spoil small ones.
  subroutine solve_reduced(system, shapes, zeros, s, vector)
    type(damped_system_t), intent(in) :: system
    real(wp), intent(in) :: shapes(:, :)              !! (unknowns, shapes)
    integer, intent(in) :: zeros                      !! the first shapes: free motions at rest
    complex(wp), allocatable, intent(out) :: s(:)     !! (roots) with Im s ≥ 0
    complex(wp), allocatable, intent(out) :: vector(:, :) !! (unknowns, roots)

    real(wp), dimension(size(shapes, 2), size(shapes, 2)) :: mass, damping, stiffness, factor
    real(wp) :: told(size(system%dampers, 2), size(shapes, 2)), product(size(shapes, 1))
    real(wp) :: right(size(shapes, 2), 2*size(shapes, 2)), whole(2*size(shapes, 2), &
      2*size(shapes, 2)), shape(2*size(shapes, 2), 2*size(shapes, 2))
    real(wp) :: re(2*size(shapes, 2)), im(2*size(shapes, 2)), work(32*size(shapes, 2)), none(1, 1)
    real(wp) :: near
    complex(wp) :: mu, weights(size(shapes, 2))
    integer :: pivot(size(shapes, 2)), i, n, number, info

    n = size(shapes, 2)
    told = matmul(transpose(system%dampers), shapes(:size(system%dampers, 1), :))
    damping = matmul(transpose(told), told)
    do i = 1, n
      call stiffness_times_vector(system%pencil, shapes(:, i), product)
      stiffness(:, i) = matmul(product, shapes)
      call bordered_times_vector(system%pencil%layout, system%pencil%mass, shapes(:, i), product)
      mass(:, i) = matmul(product, shapes)
    end do
    near = sqrt(2.0_wp*max(0.0_wp, -minval([(stiffness(i, i), i=1, n)])) + &
      0.1_wp*minval([(abs(stiffness(i, i)), i=1, n)], mask=[(abs(stiffness(i, i)) > &
      1.0e-6_wp*maxval(abs(stiffness)), i=1, n)]))
    stiffness(:, :zeros) = damping(:, :zeros)
    damping(:, :zeros) = mass(:, :zeros)
    mass(:, :zeros) = 0.0_wp
    factor = stiffness + near*(damping + near*mass)
    right(:, :n) = -mass
    right(:, n + 1:) = -(damping + 2.0_wp*near*mass)
    call dgetrf(n, n, factor, n, pivot, info)
    if (info == 0) then
      call dgetrs("N", n, 2*n, factor, n, pivot, right, n, info)
      whole = 0.0_wp
      do i = 1, n
        whole(i, n + i) = 1.0_wp
      end do
      whole(n + 1:, :) = right
      call dgeev("N", "V", 2*n, whole, 2*n, re, im, none, 1, shape, 2*n, work, size(work), info)
    end if
    number = 0
    allocate (s(2*n), vector(size(shapes, 1), 2*n))
    if (info == 0) then
      do i = 1, 2*n
        ! 1/μ turns the sign of the imaginary part: of a pair μ the second gives Im s > 0.
        if (im(i) > 0.0_wp) cycle
        mu = cmplx(re(i), im(i), wp)
        if (abs(mu) <= tiny(near)) cycle
        number = number + 1
        s(number) = near + 1.0_wp/mu
        weights = shape(:n, i)
        if (im(i) < 0.0_wp) weights = cmplx(shape(:n, i - 1), -shape(:n, i), wp)
        if (zeros > 0) weights(zeros + 1:) = s(number)*weights(zeros + 1:)
        vector(:, number) = cmplx(matmul(shapes, real(weights, wp)), matmul(shapes, &
          aimag(weights)), wp)
      end do
    end if
    s = s(:number)
    vector = vector(:, :number)
  end subroutine solve_reduced

end module damped_shapes
