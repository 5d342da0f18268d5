!> Nodal matrices of any linkage of links that bend, as lean as they can be made: one element a part, pins shared by parts,
!! rotations shared where parts are welded, blocks eliminated; and their lowest eigenvalues from a library routine.
module nodal_parts
  use beam_element, only: element_mass, element_stiffness, element_unknowns, new_reference_element, reference_element_t
  use elastic_linkages, only: elastic_linkage_t
  use element_axes, only: turned_to_global
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use lapack, only: dsygvx
  use linkages, only: normal_to
  use part_poses, only: place_parts_of
  use pose_types, only: pose_t
  use structures, only: structure_t
  use terminal_work, only: line_direction
  use text, only: to_string
  implicit none (type, external)
  private

  public :: nodal_parts_t, new_nodal_parts, solve_nodal_parts, find_eigenvalues

  !> Parts with the numbers of their unknowns.
  type :: nodal_parts_t
    type(elastic_linkage_t) :: elastic
    type(reference_element_t) :: reference
    integer, allocatable :: unknown(:, :)  !! (unknowns of an element, parts) u1 v1 θ1, bubbles, u2 v2 θ2; 0: held
    integer, allocatable :: point(:, :)    !! (2, points) displacements; 0: held
    integer, allocatable :: rotation(:)    !! (rotations)
    integer :: unknowns = 0                !! before blocks are eliminated
    integer :: constraints = 0             !! number of blocks
  end type nodal_parts_t

contains

  !> Numbers points, then rotations, then what is inside the parts. Errors: a part is rigid or carries masses, or there are springs.
  subroutine new_nodal_parts(elastic, order, mesh, error)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: order          !! p of the element of every part
    type(nodal_parts_t), intent(out) :: mesh
    type(error_t), allocatable, intent(out) :: error

    integer :: i, k, n, inside

    do k = 1, size(elastic%body)
      if (.not. elastic%linkage%bodies(k)%bends .or. size(elastic%linkage%bodies(k)%lumps) > 0) call set_error(error, &
        error_of_numerics, "nodal matrices are made of bending parts without masses only")
    end do
    if (size(elastic%springs) + size(elastic%dampers) > 0) call set_error(error, error_of_numerics, &
      "nodal matrices are made without springs and dampers")
    if (allocated(error)) return
    mesh%elastic = elastic
    mesh%reference = new_reference_element(order)
    inside = element_unknowns(order) - 6
    allocate (mesh%point(2, size(elastic%is_fixed)), source=0)
    n = 0
    do i = 1, size(elastic%is_fixed)
      if (elastic%is_fixed(i)) cycle
      mesh%point(:, i) = [n + 1, n + 2]
      n = n + 2
    end do
    mesh%rotation = [(n + i, i=1, elastic%rotations)]
    n = n + elastic%rotations
    allocate (mesh%unknown(inside + 6, size(elastic%body)), source=0)
    do k = 1, size(elastic%body)
      associate (unknown => mesh%unknown(:, k), part => elastic%linkage%bodies(k))
        unknown(1:2) = mesh%point(:, part%first_pin)
        unknown(inside + 4:inside + 5) = mesh%point(:, part%last_pin)
        do i = 1, 2
          associate (turned => unknown(merge(3, inside + 6, i == 1)))
            if (elastic%rotation(i, k) > 0) turned = mesh%rotation(elastic%rotation(i, k))
            if (elastic%rotation(i, k) /= 0) cycle
            n = n + 1
            turned = n
          end associate
        end do
        unknown(4:inside + 3) = [(n + i, i=1, inside)]
        n = n + inside
      end associate
    end do
    mesh%unknowns = n
    do i = 1, size(elastic%linkage%sliders)
      if (is_cut(elastic, i)) mesh%constraints = mesh%constraints + 1
    end do
  end subroutine new_nodal_parts

  !> Whether a block constrains unknowns.
  pure function is_cut(elastic, slider)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: slider !! number
    logical :: is_cut

    associate (line => elastic%linkage%sliders(slider))
      is_cut = line%body > 0 .or. .not. elastic%is_fixed(line%pin)
    end associate
  end function is_cut

  !> The lowest eigenvalues at a pose, at rest. Errors: a block is at the end of its link; dsygvx fails.
  subroutine solve_nodal_parts(structure, pose, mesh, lambda, error)
    type(structure_t), intent(in) :: structure  !! that moves
    type(pose_t), intent(in) :: pose            !! of it
    type(nodal_parts_t), intent(inout) :: mesh  !! of its parts; lengths of cut parts become those of the pose
    real(wp), intent(out) :: lambda(:)          !! (modes) ω², ascending [1/s²]
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: stiffness(mesh%unknowns, mesh%unknowns), mass(mesh%unknowns, mesh%unknowns)
    type(pose_t) :: placed
    integer, allocatable :: kept(:)
    integer :: info

    lambda = 0.0_wp
    call place_parts_of(structure%linkage, pose, mesh%elastic, placed, error)
    if (allocated(error)) return
    call assemble(mesh, placed, stiffness, mass)
    call eliminate_blocks(mesh, placed, stiffness, mass, kept)
    ! That way round for the digits, as in `dense_eigensolver`.
    call find_eigenvalues(mass(kept, kept), stiffness(kept, kept), size(kept), size(lambda), .true., lambda, info)
    if (info /= 0) then
      call set_error(error, error_of_numerics, "dsygvx failed (info = "//to_string(info)//")")
      return
    end if
    lambda = 1.0_wp/lambda(size(lambda):1:-1)
  end subroutine solve_nodal_parts

  !> K and M before blocks are eliminated.
  pure subroutine assemble(mesh, placed, stiffness, mass)
    type(nodal_parts_t), intent(in) :: mesh
    type(pose_t), intent(in) :: placed !! of points and parts
    real(wp), intent(out) :: stiffness(:, :), mass(:, :)

    integer :: i, k

    stiffness = 0.0_wp
    mass = 0.0_wp
    associate (elastic => mesh%elastic)
      do k = 1, size(elastic%body)
        associate (part => elastic%linkage%bodies(k), beam => elastic%beams(k), direction => placed%direction(:, k))
          call add_element(mesh%unknown(:, k), turned_to_global(element_stiffness(mesh%reference, beam%axial_stiffness, &
            beam%bending_stiffness, part%length), direction), stiffness)
          call add_element(mesh%unknown(:, k), turned_to_global(element_mass(mesh%reference, part%line_density, part%length), &
            direction), mass)
        end associate
      end do
      do i = 1, size(elastic%linkage%pin_mass)
        do k = 1, 2
          associate (n => mesh%point(k, i))
            if (n > 0) mass(n, n) = mass(n, n) + elastic%linkage%pin_mass(i)
          end associate
        end do
      end do
      do i = 1, size(elastic%carried)
        ! Those of blocks; the decks have no masses on links under blocks.
        if (elastic%carried(i)%rotation <= 0) cycle
        associate (n => mesh%rotation(elastic%carried(i)%rotation))
          mass(n, n) = mass(n, n) + elastic%carried(i)%inertia
        end associate
      end do
    end associate
  end subroutine assemble

  pure subroutine add_element(unknown, element, matrix)
    integer, intent(in) :: unknown(:)
    real(wp), intent(in) :: element(:, :)
    real(wp), intent(inout) :: matrix(:, :)

    integer :: i, j

    do j = 1, size(unknown)
      if (unknown(j) == 0) cycle
      do i = 1, size(unknown)
        if (unknown(i) > 0) matrix(unknown(i), unknown(j)) = matrix(unknown(i), unknown(j)) + element(i, j)
      end do
    end do
  end subroutine add_element

  !> Eliminates from both matrices, for every block, the unknown that weighs most in `n·(U_P − U_Q) = 0`.
  pure subroutine eliminate_blocks(mesh, placed, stiffness, mass, kept)
    type(nodal_parts_t), intent(in) :: mesh
    type(pose_t), intent(in) :: placed
    real(wp), intent(inout) :: stiffness(:, :), mass(:, :)
    integer, allocatable, intent(out) :: kept(:) !! unknowns that are left

    real(wp) :: row(mesh%unknowns, mesh%constraints), factor
    logical :: is_kept(mesh%unknowns)
    integer :: i, j, k, n, pivot

    row = 0.0_wp
    n = 0
    do i = 1, size(mesh%elastic%linkage%sliders)
      if (.not. is_cut(mesh%elastic, i)) cycle
      n = n + 1
      associate (normal => normal_to(line_direction(mesh%elastic, placed, i)), line => mesh%elastic%linkage%sliders(i))
        do k = 1, 2
          if (mesh%point(k, line%pin) > 0) row(mesh%point(k, line%pin), n) = normal(k)
          if (line%body > 0) row(mesh%point(k, mesh%elastic%contact(i)), n) = -normal(k)
        end do
      end associate
    end do
    is_kept = .true.
    do n = 1, mesh%constraints
      pivot = maxloc(abs(row(:, n)), dim=1)
      is_kept(pivot) = .false.
      do j = 1, mesh%unknowns
        if (j == pivot .or. abs(row(j, n)) <= 0.0_wp) cycle
        factor = -row(j, n)/row(pivot, n)
        stiffness(:, j) = stiffness(:, j) + factor*stiffness(:, pivot)
        stiffness(j, :) = stiffness(j, :) + factor*stiffness(pivot, :)
        mass(:, j) = mass(:, j) + factor*mass(:, pivot)
        mass(j, :) = mass(j, :) + factor*mass(pivot, :)
        row(j, n + 1:) = row(j, n + 1:) + factor*row(pivot, n + 1:)
      end do
      row(pivot, n + 1:) = 0.0_wp
    end do
    kept = pack([(i, i=1, mesh%unknowns)], is_kept)
  end subroutine eliminate_blocks

  !> Some eigenvalues of `A x = λ B x`, in ascending order: the highest or the lowest ones.
  subroutine find_eigenvalues(a, b, n, wanted, highest, lambda, info)
    real(wp), intent(in) :: a(:, :), b(:, :)
    integer, intent(in) :: n, wanted
    logical, intent(in) :: highest
    real(wp), intent(out) :: lambda(:)
    integer, intent(out) :: info !! of dsygvx; not 0: it failed

    real(wp) :: left(n, n), right(n, n), w(n), z(1, 1), query(1)
    real(wp), allocatable :: work(:)
    integer :: iwork(5*n), ifail(n), found, first

    left = a
    right = b
    w = 0.0_wp
    query = 0.0_wp
    lambda = 0.0_wp
    first = merge(n - wanted + 1, 1, highest)
    call dsygvx(1, "N", "I", "L", n, left, n, right, n, 0.0_wp, 0.0_wp, first, first + wanted - 1, 2.0_wp*tiny(1.0_wp), found, &
      w, z, n, query, -1, iwork, ifail, info)
    allocate (work(max(1, nint(query(1)))))
    work = 0.0_wp
    call dsygvx(1, "N", "I", "L", n, left, n, right, n, 0.0_wp, 0.0_wp, first, first + wanted - 1, 2.0_wp*tiny(1.0_wp), found, &
      w, z, n, work, size(work), iwork, ifail, info)
    if (info == 0) lambda = w(:wanted)
  end subroutine find_eigenvalues

end module nodal_parts
