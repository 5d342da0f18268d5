!> Sums of the magnitudes of the loads of a position: their rounding is a share of these.
module load_sizes
  use bordered_eigensolver, only: bordered_modes_t
  use elastic_linkages, only: elastic_linkage_t, spring_t
  use kinds, only: wp
  use load_cases, only: case_count, constant_case
  use matrix_rounding, only: force_sizes
  use position_assembly, only: assembled_t
  implicit none (type, external)
  private

  public :: axial_sizes, second_order_work

contains

  !> Magnitudes of the forces of which the axial force of each link or part is made [N].
  !!
  !! A force across a part leaves next to nothing along it, and stiff springs between soft links
  !! lose most of their tension as these yield: the rounding is that of the loads, anywhere in the
  !! linkage.
  pure function axial_sizes(here, factor) result(size_of)
    type(assembled_t), intent(in) :: here          !! a position with its loads
    real(wp), intent(in) :: factor(case_count)     !! of the unit loads: ω2², α2, 1
    real(wp) :: size_of(size(here%unit_force, 2))

    size_of = force_sizes(here%unit_force, factor)
    if (size(here%unit_force) == 0 .or. here%elastic%in_closed_form) return
    size_of = size_of + largest_load(here, factor) + abs(factor(constant_case))*( &
      pulls(here, here%elastic%springs, here%loaded%loads%pull) + &
      pulls(here, here%elastic%tensions, here%loaded%loads%tension))
  end function axial_sizes

  !> What springs pull; of those that turn, their torques over the shortest span [N].
  pure function pulls(here, springs, pull) result(total)
    type(assembled_t), intent(in) :: here
    type(spring_t), intent(in) :: springs(:)
    real(wp), intent(in) :: pull(:) !! (springs) [N] or [N m]
    real(wp) :: total

    total = sum(abs(pull), mask=.not. springs%turns) + sum(abs(pull), mask=springs%turns)/ &
      shortest_span(here%elastic)
  end function pulls

  !> The shortest length of parts between pins and blocks, which bear torques by pairs of forces;
  !! cuts at masses and at places of forces bear none [m].
  pure function shortest_span(elastic) result(shortest)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    real(wp) :: shortest

    real(wp) :: span
    integer :: k

    shortest = huge(shortest)
    span = 0.0_wp
    do k = 1, size(elastic%linkage%bodies)
      associate (part => elastic%linkage%bodies(k))
        span = span + part%length
        if (part%last_pin > size(elastic%linkage%pin_mass) - elastic%places) cycle
        shortest = min(shortest, span)
        span = 0.0_wp
      end associate
    end do
  end function shortest_span

  !> The largest of all forces on points, and of inertia forces of points and parts [N].
  pure function largest_load(here, factor) result(largest)
    type(assembled_t), intent(in) :: here
    real(wp), intent(in) :: factor(case_count)
    real(wp) :: largest

    real(wp) :: mass
    integer :: i, k

    largest = 0.0_wp
    do i = 1, case_count
      if (.not. here%loaded%loads%unit%occurs(i)) cycle
      associate (case => here%loaded%loads%unit%of_case(i), linkage => here%elastic%linkage)
        do k = 1, size(linkage%pin_mass)
          largest = max(largest, abs(factor(i))*(norm2(case%pin_force(:, k)) + &
            linkage%pin_mass(k)*norm2(case%field%at_pin(:, k))))
        end do
        do k = 1, size(linkage%bodies)
          mass = linkage%bodies(k)%line_density*linkage%bodies(k)%length + &
            sum(linkage%bodies(k)%lumps%mass)
          largest = max(largest, abs(factor(i))*mass*(norm2(case%field%at_first(:, k)) + &
            linkage%bodies(k)%length*norm2(case%field%slope(:, k))))
          if (allocated(case%body_force)) largest = max(largest, &
            abs(factor(i))*norm2(case%body_force(:, k)))
        end do
        do k = 1, size(here%loaded%loads%carried, 2)
          largest = max(largest, abs(factor(i))*norm2(here%loaded%loads%carried(:2, k, i)))
        end do
      end associate
    end do
  end function largest_load

  !> Bound of what blocks on guides and springs under tension do in modes of unit mass, whatever
  !! cancels, twice [1/s²].
  pure function second_order_work(here, factor, found, modes) result(work)
    type(assembled_t), intent(in) :: here          !! a position with its loads, with a border
    real(wp), intent(in) :: factor(case_count)     !! of the unit loads: ω2², α2, 1
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    integer, intent(in) :: modes                   !! number, lowest first
    real(wp) :: work(modes)

    real(wp), allocatable :: sizes(:, :)
    integer :: i, n

    work = 0.0_wp
    if (size(here%unit_force) == 0) return
    n = size(here%loaded%forces%second_order, 1)
    allocate (sizes(n, n), source=0.0_wp)
    do i = 1, case_count
      sizes = sizes + abs(factor(i)*here%loaded%forces%second_order(:, :, i))
    end do
    do i = 1, modes
      associate (size_of => abs(found%vector(:n, i)))
        work(i) = dot_product(size_of, matmul(sizes, size_of))
      end associate
    end do
  end function second_order_work

end module load_sizes
