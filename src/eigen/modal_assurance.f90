!> Excerpts of modes, sufficient to recognise them at another position.
module modal_assurance
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_matrix, only: layout_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: mode_prints_t, new_mode_prints, likeness

  !> Components of the modes on the border and the first own modes of every link, which models of
  !! different orders have in common; zero where a link has fewer own modes.
  type :: mode_prints_t
    real(wp), allocatable :: vector(:, :)     !! (unknowns kept, modes) of y, scaled to yᵀMy = 1 in
                                              !! the kept components
    real(wp), allocatable :: mass_times(:, :) !! (unknowns kept, modes) of M y, in the same scale
  end type mode_prints_t

  !> Share of yᵀMy in the kept components below which a mode cannot be recognised.
  real(wp), parameter :: least_kept = 1.0e-3_wp

contains

  !> Takes the prints of the first modes. If too little of a mode is kept (links that buckle many
  !! times over) its print is zero: it resembles no other mode.
  pure function new_mode_prints(layout, found, modes, border) result(prints)
    type(layout_t), intent(in) :: layout        !! of the unknowns
    type(bordered_modes_t), intent(in) :: found !! at least these modes
    integer, intent(in) :: modes                !! how many
    real(wp), intent(in), optional :: border(:, :) !! (components, border) with orthonormal columns:
                                                !! what is kept of the border's unknowns; absent:
                                                !! these themselves
    type(mode_prints_t) :: prints

    real(wp) :: kept
    integer :: i, first, slot, components

    components = layout%border
    if (present(border)) components = size(border, 1)
    allocate (prints%vector(components + size(layout%size)*across_kept(modes) + &
      size(layout%group)*modes, modes))
    prints%vector = 0.0_wp
    prints%mass_times = prints%vector
    slot = 0
    if (present(border)) then
      prints%vector(:components, :) = matmul(border, found%vector(:layout%border, :modes))
      prints%mass_times(:components, :) = matmul(border, found%mass_times(:layout%border, :modes))
      slot = components
    else
      call keep(found, 1, layout%border, layout%border, slot, prints)
    end if
    do i = 1, size(layout%size)
      call keep(found, layout%first(i), min(layout%size(i), across_kept(modes)), &
        across_kept(modes), slot, prints)
    end do
    first = layout%unknowns - sum(layout%group) + 1
    do i = 1, size(layout%group)
      call keep(found, first, min(layout%group(i), modes), modes, slot, prints)
      first = first + layout%group(i)
    end do
    do i = 1, modes
      kept = dot_product(prints%vector(:, i), prints%mass_times(:, i))
      if (kept >= least_kept) then
        prints%vector(:, i) = prints%vector(:, i)/sqrt(kept)
        prints%mass_times(:, i) = prints%mass_times(:, i)/sqrt(kept)
      else
        prints%vector(:, i) = 0.0_wp
        prints%mass_times(:, i) = 0.0_wp
      end if
    end do
  end function new_mode_prints

  !> Number of transverse own modes of a link that are kept.
  pure function across_kept(modes) result(number)
    integer, intent(in) :: modes
    integer :: number

    number = modes + 2
  end function across_kept

  !> Copies some components of all modes and moves on by the number of slots reserved for them.
  pure subroutine keep(found, first, number, slots, slot, prints)
    type(bordered_modes_t), intent(in) :: found
    integer, intent(in) :: first, number !! components to copy
    integer, intent(in) :: slots         !! reserved for them
    integer, intent(inout) :: slot       !! the last one used
    type(mode_prints_t), intent(inout) :: prints

    integer :: modes

    modes = size(prints%vector, 2)
    prints%vector(slot + 1:slot + number, :) = found%vector(first:first + number - 1, :modes)
    prints%mass_times(slot + 1:slot + number, :) = found%mass_times(first:first + number - 1, &
      :modes)
    slot = slot + slots
  end subroutine keep

  !> Modal assurance criterion in the mass inner product between the modes of two positions, from 0
  !! to 1.
  !!
  !! `(aᵀM_b b)(bᵀM_a a)` for modes of unit mass: each position has its own mass matrix, and the
  !! product is 1 for equal shapes.
  pure function likeness(first, second) result(mac)
    type(mode_prints_t), intent(in) :: first  !! modes a of one position
    type(mode_prints_t), intent(in) :: second !! modes b of another
    real(wp) :: mac(size(first%vector, 2), size(second%vector, 2)) !! (modes of the first, modes of
                                                                   !! the second)

    mac = matmul(transpose(first%vector), second%mass_times)*matmul(transpose(first%mass_times), &
      second%vector)
    mac = max(0.0_wp, min(1.0_wp, mac))
  end function likeness

end module modal_assurance
