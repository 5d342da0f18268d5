!> The parts of structures that tests put together by hand.
module divided_structures
  use elastic_linkages, only: new_elastic_linkage
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: divide

contains

  !> Gives a structure its parts. Those that bend have the masses of their links.
  subroutine divide(structure)
    class(structure_t), intent(inout) :: structure !! linkage and beams

    associate (bodies => structure%linkage%bodies)
      where (bodies%bends)
        structure%beams%line_density = bodies%line_density
        structure%beams%rotary_inertia = bodies%rotary_inertia
      end where
    end associate
    structure%elastic = new_elastic_linkage(structure%linkage, structure%beams)
  end subroutine divide

end module divided_structures
