!> Magnitudes of the loads of a position, whatever they cancel: their rounding is that of these.
module load_sizes
  use bordered_eigensolver, only: bordered_modes_t
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
  !! Stiff springs between soft links lose most of their tension as these yield: what is left is
  !! the difference of two pulls, anywhere in the linkage.
  pure function axial_sizes(here, factor) result(size_of)
    type(assembled_t), intent(in) :: here          !! a position with its loads
    real(wp), intent(in) :: factor(case_count)     !! of the unit loads: ω2², α2, 1
    real(wp) :: size_of(size(here%unit_force, 2))

    real(wp) :: pull
    integer :: i

    size_of = force_sizes(here%unit_force, factor)
    if (size(here%unit_force) == 0 .or. .not. allocated(here%part_loads%pull)) return
    do i = 1, size(here%part_loads%pull)
      pull = abs(factor(constant_case)*here%part_loads%pull(i))
      if (here%elastic%springs(i)%turns) pull = pull/minval(here%elastic%linkage%bodies%length)
      size_of = size_of + pull
    end do
  end function axial_sizes

  !> Bound of what blocks on guides and springs under tension do in modes of unit mass, whatever
  !! cancels, twice [1/s²].
  pure function second_order_work(here, factor, found, modes) result(work)
    type(assembled_t), intent(in) :: here          !! a position with its loads
    real(wp), intent(in) :: factor(case_count)     !! of the unit loads: ω2², α2, 1
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    integer, intent(in) :: modes                   !! number, lowest first
    real(wp) :: work(modes)

    real(wp), allocatable :: sizes(:, :)
    integer :: i, n

    work = 0.0_wp
    if (.not. allocated(here%part_forces%second_order) .or. size(here%unit_force) == 0) return
    n = size(here%part_forces%second_order, 1)
    allocate (sizes(n, n), source=0.0_wp)
    do i = 1, case_count
      sizes = sizes + abs(factor(i)*here%part_forces%second_order(:, :, i))
    end do
    do i = 1, modes
      associate (size_of => abs(found%vector(:n, i)))
        work(i) = dot_product(size_of, matmul(sizes, size_of))
      end associate
    end do
  end function second_order_work

end module load_sizes
