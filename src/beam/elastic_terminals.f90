!> Terminals of a linkage in parts: where pulls, blocks, drives and turns hold it. They are found
!! once, whatever the position.
module elastic_terminals
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: elastic_terminal_t, is_same, fixed_rotation

  !> Of an end that cannot turn.
  integer, parameter :: fixed_rotation = -1

  !> A place on a point, or on a rigid link, and what turns it.
  type :: elastic_terminal_t
    integer :: point = 0           !! number of the point that moves it; 0: the ground, or a place
                                   !! between the points of a link that bends
    integer :: part = 0            !! number of the first part of its link; 0: the ground, or a pin
                                   !! by itself, which does not turn
    logical :: is_rigid = .false.  !! its link, whose first point is `point`
    integer :: rotation = 0        !! number of what turns it; 0: a hinged end, a `fixed_rotation`
    real(wp) :: place(2) = 0.0_wp  !! from the point, in the axes of a rigid link, else in global
                                   !! axes [m]
    integer :: block = 0           !! pin whose place it is, on a rigid guide; 0: `place`
  end type elastic_terminal_t

contains

  !> Whether two terminals are the same end of a link, or on the same rigid link.
  pure function is_same(one, other)
    type(elastic_terminal_t), intent(in) :: one, other
    logical :: is_same

    is_same = one%part == other%part .and. one%point == other%point
  end function is_same

end module elastic_terminals
