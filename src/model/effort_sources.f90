!> What gives the efforts that move a linkage: the coordinates of ACTUATE cards, or the drives.
module effort_sources
  use models, only: model_t
  use named_coordinates, only: find_named_coordinates, named_coordinate_t
  use natures, only: angle_nature, nature_t
  implicit none (type, external)
  private

  public :: effort_source_t, find_effort_sources

  type :: effort_source_t
    character(len=:), allocatable :: name
    type(nature_t) :: nature = angle_nature
  end type effort_source_t

contains

  !> All of them, in the order of the deck.
  pure subroutine find_effort_sources(model, sources)
    type(model_t), intent(in) :: model !! as read
    type(effort_source_t), allocatable, intent(out) :: sources(:) !! (drives)

    type(named_coordinate_t), allocatable :: named(:)
    integer :: i

    if (size(model%actuators) == 0) then
      allocate (sources(size(model%drives)))
      do i = 1, size(sources)
        sources(i)%name = model%drives(i)%subject%text
        sources(i)%nature = model%drives(i)%nature
      end do
      return
    end if
    call find_named_coordinates(model, named)
    allocate (sources(size(model%actuators)))
    do i = 1, size(sources)
      associate (it => model%actuators(i))
        sources(i)%name = it%name%text
        if (it%coordinate > 0) sources(i)%nature = named(it%coordinate)%nature
      end associate
    end do
  end subroutine find_effort_sources

end module effort_sources
