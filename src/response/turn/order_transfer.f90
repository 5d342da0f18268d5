!> A periodic motion in the unknowns of one model, expressed in those of a model of higher orders
!! and with more samples over the turn.
module order_transfer
  use deformation_shapes, only: deformation_shapes_t
  use fourier_transform, only: fourier_plan_t, resample
  use kinds, only: wp
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: transferred, transferred_halves

contains

  !> The same motion on another grid.
  subroutine transferred(from, from_plan, to, to_plan, y, other)
    type(turn_grid_t), intent(in) :: from           !! grid of the motion
    type(fourier_plan_t), intent(in) :: from_plan   !! for its samples
    type(turn_grid_t), intent(in) :: to             !! same linkage, orders at least as high
    type(fourier_plan_t), intent(in) :: to_plan     !! for its samples
    real(wp), intent(in) :: y(:, :)                 !! (samples, unknowns) [√J]
    real(wp), allocatable, intent(out) :: other(:, :) !! (samples, unknowns) on the other grid

    real(wp) :: moved(to%samples, from%unknowns)
    integer :: b

    call resample(from_plan, y, to_plan, moved)
    allocate (other(to%samples, to%unknowns))
    other = 0.0_wp
    other(:, :to%border) = moved(:, :from%border)
    if (allocated(to%rotation)) other(:, :to%border) = matmul(matmul(moved(:, :from%border), &
      transpose(from%rotation)), to%rotation)
    do b = 1, size(from%integrals)
      associate (link => from%model%links(b), target => to%model%links(b), first => from%first(b), &
        to_first => to%first(b))
        if (.not. link%bends) cycle
        associate (own => moved(:, first:first + link%modes - 1), &
          to_own => other(:, to_first:to_first + target%modes - 1))
          to_own = changed(own, link%bending(:, 1:), target%bending(:, 1:), &
            renumbered(link%bending_shapes, target%bending_shapes, size(link%bending, 1), .true.))
          if (link%coupled) to_own = to_own + changed(own, link%axial, target%axial, &
            renumbered(link%axial_shapes, target%axial_shapes, size(link%axial, 1), .false.))
        end associate
        if (link%coupled) cycle
        other(:, to%first_along(b):to%first_along(b) + target%axial_modes - 1) = &
          changed(moved(:, from%first_along(b):from%first_along(b) + link%axial_modes - 1), &
          link%axial, target%axial, renumbered(link%axial_shapes, target%axial_shapes, &
          size(link%axial, 1), .false.))
      end associate
    end do
  end subroutine transferred

  !> Likewise for a complex motion, whose real and imaginary parts stand side by side.
  subroutine transferred_halves(from, from_plan, to, to_plan, y, other)
    type(turn_grid_t), intent(in) :: from             !! grid of the motion
    type(fourier_plan_t), intent(in) :: from_plan     !! for its samples
    type(turn_grid_t), intent(in) :: to               !! same linkage, orders at least as high
    type(fourier_plan_t), intent(in) :: to_plan       !! for its samples
    real(wp), intent(in) :: y(:, :)                   !! (samples, 2 unknowns) [√J]
    real(wp), allocatable, intent(out) :: other(:, :) !! (samples, 2 unknowns) on the other grid

    real(wp), allocatable :: half(:, :)
    integer :: i

    allocate (other(to%samples, 2*to%unknowns))
    do i = 0, 1
      call transferred(from, from_plan, to, to_plan, y(:, i*from%unknowns + 1:(i + 1)* &
        from%unknowns), half)
      other(:, i*to%unknowns + 1:(i + 1)*to%unknowns) = half
    end do
  end subroutine transferred_halves

  !> Own modes of the other model from those of this one, through the strains of both.
  pure function changed(own, modes, to_modes, number) result(to_own)
    real(wp), intent(in) :: own(:, :)                 !! (samples, modes)
    real(wp), intent(in) :: modes(:, :), to_modes(:, :) !! (strains, modes)
    integer, intent(in) :: number(:)                  !! of every strain in the other model
    real(wp) :: to_own(size(own, 1), size(to_modes, 2))

    to_own = matmul(matmul(own, transpose(modes)), to_modes(number, :))
  end function changed

  !> Numbers of the strains of one link in the shapes of another order.
  pure function renumbered(shapes, target, kept, bending) result(number)
    type(deformation_shapes_t), intent(in) :: shapes, target
    integer, intent(in) :: kept     !! unknowns in use
    logical, intent(in) :: bending  !! else axial
    integer :: number(kept)

    integer :: e, i, j

    number = [(i, i=1, kept)]
    do e = 1, shapes%elements
      do j = lbound(shapes%column, 1), ubound(shapes%column, 1)
        i = shapes%column(j, e)
        if (i == 0 .or. i > kept) cycle
        number(i) = target%column(j, e)
        if (bending .and. shapes%shear_stiffness > 0.0_wp) number(i + 1) = target%column(j, e) + 1
      end do
    end do
  end function renumbered

end module order_transfer
