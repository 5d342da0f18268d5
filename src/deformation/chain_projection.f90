!> Projects modes of continuous links on the unknowns of a long mesh.
module chain_projection
  use deformation_chain, only: deformation_chain_t
  use deformation_shapes, only: deformation_shapes_t
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values
  use link_modes, only: link_modes_t
  implicit none (type, external)
  private

  public :: project_modes

contains

  !> Modes of a near model as start vectors for the modes of the mesh. The near model is continuous
  !! on some links and has the mesh itself on the others.
  !!
  !! The unknowns of a continuous link are Legendre coefficients along its elements, scaled to
  !! energy, degree by degree, curvature and shear strain alternating; those of the others are the
  !! unknowns of the mesh.
  pure subroutine project_modes(pencil, near, bending, strain, vectors)
    type(deformation_chain_t), intent(in) :: pencil !! of the long mesh
    type(link_modes_t), intent(in) :: near(:)       !! (links) of the near model
    real(wp), intent(in) :: bending(:, :, :)        !! (unknowns, modes, links) transverse unknowns
                                                    !! of the near model
    real(wp), intent(in) :: strain(:, :, :)         !! (unknowns, modes, links) its axial unknowns
    real(wp), intent(out) :: vectors(:, :)          !! (unknowns of the mesh, modes)

    integer :: b, i, kinds

    do b = 1, size(pencil%links)
      if (.not. pencil%links(b)%bends) cycle
      associate (link => pencil%links(b), number => pencil%links(b)%elements)
        if (near(b)%bending_shapes%by_degree) then
          kinds = merge(2, 1, link%sheared)
          do i = 1, kinds
            call project_on_pieces(near(b)%bending_shapes, bending(i::kinds, :, b), number, &
              link%bendings/kinds, vectors(link%first_bending + i:link%first_bending + &
              number*link%bendings:kinds, :))
          end do
          call project_on_pieces(near(b)%bending_shapes, strain(:, :, b), number, link%strains, &
            vectors(link%first_strain + 1:link%first_strain + number*link%strains, :))
        else
          vectors(link%first_bending + 1:link%first_bending + number*link%bendings, :) = &
            bending(:number*link%bendings, :, b)
          vectors(link%first_strain + 1:link%first_strain + number*link%strains, :) = &
            strain(:number*link%strains, :, b)
        end if
      end associate
    end do
  end subroutine project_modes

  !> Projects `Σ c_k P_k` of every piece of a link on the functions `√(2j+1) P_j` of each mesh
  !! element. Energies are preserved.
  pure subroutine project_on_pieces(pieces, whole, elements, unknowns, vectors)
    type(deformation_shapes_t), intent(in) :: pieces !! the elements of the continuous link
    real(wp), intent(in) :: whole(:, :)              !! (pieces × degrees, modes) c
    integer, intent(in) :: elements                  !! of the mesh
    integer, intent(in) :: unknowns                  !! per mesh element
    real(wp), intent(inout) :: vectors(:, :)         !! (unknowns × elements, modes)

    real(wp) :: x(unknowns + 1), w(unknowns + 1), here(0:unknowns - 1, unknowns + 1), &
      p(size(whole, 1)), place, value
    integer :: e, i, j, mode, first, piece, degrees

    call gauss_rule(x, w)
    do i = 1, size(x)
      here(:, i) = 0.5_wp*w(i)/sqrt(real(elements, wp))*legendre_values(unknowns - 1, x(i))
      here(:, i) = here(:, i)*[(sqrt(2*j + 1.0_wp), j=0, unknowns - 1)]
    end do
    vectors = 0.0_wp
    do e = 1, elements
      first = (e - 1)*unknowns
      do i = 1, size(x)
        place = (2*e - 1 + x(i))/elements - 1.0_wp
        piece = 1
        if (pieces%elements > 1) then
          place = 0.5_wp*(place + 1.0_wp)*pieces%elements
          piece = 1 + count(pieces%last(1:pieces%elements - 1) <= place)
          place = 2.0_wp*(place - pieces%middle(piece))/pieces%part(piece)
        end if
        degrees = size(whole(piece::pieces%elements, 1))
        p(:degrees) = legendre_values(degrees - 1, place)
        do mode = 1, size(whole, 2)
          value = sqrt(pieces%elements/pieces%part(piece))*dot_product(p(:degrees), &
            whole(piece::pieces%elements, mode))
          do j = 1, unknowns
            vectors(first + j, mode) = vectors(first + j, mode) + value*here(j - 1, i)
          end do
        end do
      end do
    end do
  end subroutine project_on_pieces

end module chain_projection
