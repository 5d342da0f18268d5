!> Modes of continuous links on a long mesh.
module mode_projection
  use deformation_chain, only: deformation_chain_t
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values
  implicit none (type, external)
  private

  public :: project_modes

contains

  !> Modes of a model that is continuous on some links, and has the mesh itself on others: starts for the modes of the mesh.
  pure subroutine project_modes(pencil, continuous, bending, strain, vectors)
    type(deformation_chain_t), intent(in) :: pencil
    logical, intent(in) :: continuous(:)       !! (links)
    real(wp), intent(in) :: bending(:, :, :)   !! (unknowns, modes, links) of a continuous link Legendre coefficients along it, scaled
                                               !! to energy, of curvature and shear strain in turn; else the unknowns of the mesh
    real(wp), intent(in) :: strain(:, :, :)
    real(wp), intent(out) :: vectors(:, :)     !! (unknowns, modes)

    integer :: b, i, kinds

    do b = 1, size(pencil%links)
      if (.not. pencil%links(b)%bends) cycle
      associate (link => pencil%links(b), number => pencil%links(b)%elements)
        if (continuous(b)) then
          kinds = merge(2, 1, link%sheared)
          do i = 1, kinds
            call project(bending(i::kinds, :, b), number, link%bendings/kinds, &
              vectors(link%first_bending + i:link%first_bending + number*link%bendings:kinds, :))
          end do
          call project(strain(:, :, b), number, link%strains, &
            vectors(link%first_strain + 1:link%first_strain + number*link%strains, :))
        else
          vectors(link%first_bending + 1:link%first_bending + number*link%bendings, :) = &
            bending(:number*link%bendings, :, b)
          vectors(link%first_strain + 1:link%first_strain + number*link%strains, :) = strain(:number*link%strains, :, b)
        end if
      end associate
    end do
  end subroutine project_modes

  !> Projects `Σ c_k P_k` of the whole link on the functions `√(2j+1) P_j` of each element, so that energies are kept.
  pure subroutine project(whole, elements, unknowns, vectors)
    real(wp), intent(in) :: whole(0:, :) !! (degrees, modes) c
    integer, intent(in) :: elements, unknowns
    real(wp), intent(inout) :: vectors(:, :)

    real(wp) :: x(unknowns + 1), w(unknowns + 1), here(0:unknowns - 1, unknowns + 1), p(0:size(whole, 1) - 1), value
    integer :: e, i, j, mode, first

    call gauss_rule(x, w)
    do i = 1, size(x)
      here(:, i) = 0.5_wp*w(i)/sqrt(real(elements, wp))*legendre_values(unknowns - 1, x(i))
      here(:, i) = here(:, i)*[(sqrt(2*j + 1.0_wp), j=0, unknowns - 1)]
    end do
    vectors = 0.0_wp
    do e = 1, elements
      first = (e - 1)*unknowns
      do i = 1, size(x)
        p = legendre_values(size(whole, 1) - 1, (2*e - 1 + x(i))/elements - 1.0_wp)
        do mode = 1, size(whole, 2)
          value = dot_product(p, whole(:, mode))
          do j = 1, unknowns
            vectors(first + j, mode) = vectors(first + j, mode) + value*here(j - 1, i)
          end do
        end do
      end do
    end do
  end subroutine project

end module mode_projection
