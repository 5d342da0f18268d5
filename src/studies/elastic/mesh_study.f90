!> Places of the elements of a mesh at a position.
module mesh_study
  use beam_mesh, only: element_length
  use kinds, only: wp
  use positions, only: state_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: mesh_element_t, elements_at

  type :: mesh_element_t
    integer :: body = 0                 !! number
    integer :: number = 0               !! round the loop, from 1
    integer :: nodes(2) = 0             !! numbers
    real(wp) :: ends(2, 2) = 0.0_wp     !! (x and y, ends) in global axes [m]
    real(wp) :: half_mass = 0.0_wp      !! contributed to either node [kg]
  end type mesh_element_t

contains

  !> All elements at a position, body after body; a rigid link has none.
  pure subroutine elements_at(structure, state, list)
    type(structure_t), intent(in) :: structure !! with a mesh
    type(state_t), intent(in) :: state         !! with a pose
    type(mesh_element_t), allocatable, intent(out) :: list(:) !! (elements) round the loop

    real(wp) :: length
    integer :: b, i, n

    associate (mesh => structure%mesh, bodies => structure%linkage%bodies)
      allocate (list(sum(mesh%elements, mask=bodies%bends)))
      n = 0
      do b = 1, size(bodies)
        if (.not. bodies(b)%bends) cycle
        length = element_length(mesh, structure%linkage, b)
        do i = 1, mesh%elements(b)
          n = n + 1
          list(n)%body = b
          list(n)%number = mesh%first_element(b) + i - 1
          list(n)%nodes = mesh%first_node(b) + i - [1, 0]
          list(n)%half_mass = 0.5_wp*bodies(b)%line_density*length
          associate (start => state%pose%pin(:, bodies(b)%first_pin), &
              axis => state%pose%direction(:, b))
            list(n)%ends(:, 1) = start + (i - 1)*length*axis
            list(n)%ends(:, 2) = start + i*length*axis
          end associate
        end do
      end do
    end associate
  end subroutine elements_at

end module mesh_study
