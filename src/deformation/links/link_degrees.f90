!> Polynomial degrees of the displacements in the pieces of a link.
module link_degrees
  implicit none (type, external)
  private

  public :: link_degrees_t, uniform_degrees, same_degrees

  type :: link_degrees_t
    integer, allocatable :: across(:) !! (pieces) of the transverse displacement, at least 3
    integer, allocatable :: along(:)  !! (pieces) of the axial one, at least 1
  end type link_degrees_t

contains

  !> The same degrees in every piece.
  pure function uniform_degrees(pieces, across, along) result(degrees)
    integer, intent(in) :: pieces        !! how many
    integer, intent(in) :: across, along !! degrees
    type(link_degrees_t) :: degrees

    allocate (degrees%across(pieces), degrees%along(pieces))
    degrees%across = across
    degrees%along = along
  end function uniform_degrees

  !> Whether two links have the same degrees everywhere.
  pure function same_degrees(a, b) result(same)
    type(link_degrees_t), intent(in) :: a, b !! both set
    logical :: same

    same = size(a%across) == size(b%across) .and. size(a%along) == size(b%along)
    if (same) same = all(a%across == b%across) .and. all(a%along == b%along)
  end function same_degrees

end module link_degrees
