!> A long list of positions in blocks that are computed and written one after another, so that
!! memory does not grow with the rows of tables.
module position_blocks
  use kinds, only: wp
  use linkage_paths, only: period_of
  use linkages, only: linkage_t
  use load_tables, only: load_period
  use models, only: has_law, model_t
  use position_study, only: place_positions
  use positions, only: find_first_alike, list_block, list_positions, positions_t
  implicit none (type, external)
  private

  public :: position_blocks_t, divide_positions, choose_block

  !> A list of positions and its blocks.
  type :: position_blocks_t
    integer :: count = 0                  !! of blocks
    integer :: kept = 0                   !! positions of a block
    type(model_t) :: model                !! with all positions
    integer, allocatable :: first_alike(:) !! (positions) as of `find_first_alike`
    type(positions_t) :: sample           !! some of the positions, spread over the list
  end type position_blocks_t

  !> Positions of the sample. Orders are chosen at six of them, evenly spaced, which are then those
  !! of the whole list.
  integer, parameter :: sample_size = 1001

contains

  !> Divides the positions of a model, if they come in blocks.
  subroutine divide_positions(model, kept, linkage, threads, blocks)
    type(model_t), intent(in) :: model     !! of a variant
    integer, intent(in) :: kept            !! positions of a block; all, if there is one only
    type(linkage_t), intent(in) :: linkage !! of the model
    integer, intent(in) :: threads         !! number to use
    type(position_blocks_t), allocatable, intent(out) :: blocks !! not allocated: all are one block

    integer, allocatable :: numbers(:), different(:), chosen(:)
    real(wp) :: period
    integer :: i

    associate (crank => model%crank%value)
      if (kept == size(crank)) return
      allocate (blocks)
      blocks%kept = kept
      blocks%count = (size(crank) + kept - 1)/kept
      blocks%model = model
      period = load_period(linkage, period_of(linkage))
      blocks%first_alike = find_first_alike(crank, period, has_law(model))
      numbers = [(i, i=1, size(crank))]
      different = pack(numbers, blocks%first_alike == numbers)
      chosen = [(1 + int((i*(size(different) - 1.0_wp))/(sample_size - 1)), i=0, sample_size - 1)]
      call list_positions(crank(different(chosen)), blocks%sample, period)
      call place_positions(linkage, threads, blocks%sample)
    end associate
  end subroutine divide_positions

  !> Leaves a model the positions of a block.
  subroutine choose_block(blocks, number, model, positions)
    type(position_blocks_t), intent(in) :: blocks
    integer, intent(in) :: number                !! of the block, from 1
    type(model_t), intent(inout) :: model        !! the one that was divided, with any block
    type(positions_t), intent(out) :: positions  !! listed, without poses

    integer :: before, last

    associate (whole => blocks%model)
      before = (number - 1)*blocks%kept
      last = min(before + blocks%kept, size(whole%crank%value))
      model%crank%value = whole%crank%value(before + 1:last)
      if (has_law(whole)) then
        model%time%value = whole%time%value(before + 1:last)
        model%law_rates = whole%law_rates(:, before + 1:last)
      end if
      if (allocated(whole%law_places)) model%law_places = whole%law_places(before + 1:last)
      positions%period = blocks%sample%period
      call list_block(whole%crank%value, blocks%first_alike, before, last, positions, &
        whole%time%value)
    end associate
  end subroutine choose_block

end module position_blocks
