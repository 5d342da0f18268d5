!> The modes of a long mesh at one position and speed. A near model gives the start vectors and
!! proves that no mode is missing.
!!
!! The near model has a continuous link in place of every long one and the deck's mesh on the other
!! links. A continuous link can bend in every way that a mesh can, and in more ways: the near model
!! therefore has at least as many modes below a limit as the mesh. Its polynomials of finite order
!! represent the continuous link only approximately, but their error is far below the margin of the
!! count.
module chain_solver
  use bordered_eigensolver, only: bordered_modes_t, find_bordered_modes, new_start
  use bordered_pencil, only: bordered_pencil_t
  use chain_projection, only: project_modes
  use completeness_proof, only: count_limit, is_complete
  use deformation_chain, only: deformation_chain_t
  use deformation_model, only: deformation_model_t
  use deformation_shapes, only: deformation_shapes_t
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use ledger, only: ledger_t
  use reduced_assembly, only: first_axial
  use subspace_eigensolver, only: find_subspace_modes, subspace_modes_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: find_chain_modes

  !> Extra modes beyond those wanted, tried in turn. They are needed where the next mode is so near
  !! that the near model counts it as well.
  integer, parameter :: guards(3) = [0, 2, 6]

contains

  !> Finds the lowest modes of a long mesh from those of the near model and proves that none is
  !! missing. Without a proof it tries again with more modes.
  !!
  !! Errors: no convergence, or no proof even with the largest number of extra modes.
  subroutine find_chain_modes(near, own, least, start, wanted, accurate_vectors, chain, counts, &
      found, error)
    type(deformation_model_t), intent(in) :: near  !! continuous links in place of the long ones
    type(bordered_pencil_t), intent(in) :: own     !! matrices of the near model at this position
                                                   !! and speed
    type(bordered_pencil_t), intent(in) :: least   !! the same, with axial forces nowhere above
                                                   !! those of the mesh; used for the proof
    type(bordered_modes_t), intent(in) :: start    !! modes of `own`, at least `wanted`
    integer, intent(in) :: wanted                  !! number of modes
    logical, intent(in) :: accurate_vectors        !! eigenvectors also to full precision
    type(deformation_chain_t), intent(in) :: chain !! the long mesh at this position and speed
    type(ledger_t), intent(inout) :: counts        !! of the work done
    type(subspace_modes_t), intent(out) :: found   !! lowest modes of the mesh; may include extra
                                                   !! ones
    type(error_t), allocatable, intent(out) :: error !! why the modes are not usable

    type(bordered_modes_t) :: modes
    real(wp), allocatable :: vectors(:, :)
    integer :: i, products
    logical :: proven

    modes = start
    products = 0
    do i = 1, size(guards)
      if (wanted + guards(i) > near%layout%unknowns) exit
      if (i > 1) then
        call find_bordered_modes(own, wanted + guards(i), accurate_vectors, new_start(), modes, &
          error)
        counts%factorizations = counts%factorizations + modes%factorizations
        counts%reduced_solutions = counts%reduced_solutions + modes%reduced_solutions
        counts%full_solutions = counts%full_solutions + modes%full_solutions
        if (allocated(error)) return
        counts%proofs = counts%proofs + 1
      end if
      allocate (vectors(chain%unknowns, size(modes%lambda)))
      call find_starts(near, modes, chain, vectors)
      call find_subspace_modes(chain, vectors, accurate_vectors, found, error)
      counts%operator_products = counts%operator_products + found%products
      products = products + found%products
      found%products = products
      if (allocated(error)) then
        ! With more vectors the next mode is farther away, and the last one wanted converges.
        if (i == size(guards) .or. wanted + guards(min(i + 1, size(guards))) > &
          near%layout%unknowns) return
        deallocate (error, vectors)
        cycle
      end if
      call is_complete(least, count_limit(found%lambda(wanted + guards(i))), &
        modes%lambda(:wanted + guards(i)), modes%mass_times(:, :wanted + guards(i)), proven)
      counts%factorizations = counts%factorizations + 1
      if (proven) then
        counts%proofs = counts%proofs + 1
        return
      end if
      deallocate (vectors)
    end do
    call set_error(error, error_of_numerics, &
      "it could not be proven that no mode is missing among the "//to_string(wanted)// &
      " of the long mesh")
  end subroutine find_chain_modes

  !> Start vectors: the modes of the near model, projected on the unknowns of the mesh.
  pure subroutine find_starts(near, modes, chain, vectors)
    type(deformation_model_t), intent(in) :: near
    type(bordered_modes_t), intent(in) :: modes
    type(deformation_chain_t), intent(in) :: chain
    real(wp), intent(out) :: vectors(:, :) !! (unknowns of the mesh, modes)

    real(wp), allocatable :: bending(:, :, :), strain(:, :, :), own(:), own_strain(:)
    integer :: b, i, first, longest

    longest = 1
    do b = 1, size(near%links)
      if (.not. near%links(b)%bends) cycle
      associate (link => near%links(b))
        longest = max(longest, link%bending_shapes%unknowns, link%axial_shapes%unknowns + 1, &
          2*size(link%bending_shapes%column), size(link%axial_shapes%column))
      end associate
    end do
    allocate (bending(longest, size(vectors, 2), size(near%links)))
    allocate (strain, mold=bending)
    bending = 0.0_wp
    strain = 0.0_wp
    do b = 1, size(near%links)
      if (.not. near%links(b)%bends) cycle
      do i = 1, size(vectors, 2)
        associate (link => near%links(b), mode => modes%vector(:, i))
          first = near%layout%first(b)
          own = matmul(link%bending(:, 1:), mode(first:first + link%modes - 1))
          if (link%curves > 0) own = own + mode(1)*link%bending(:, 0)
          if (.not. link%coupled) first = first_axial(near%layout, near%links, b)
          own_strain = matmul(link%axial, mode(first:first + size(link%axial, 2) - 1))
          own_strain = element_strains(link%axial_shapes, mode(chain%number(b)), own_strain)
          if (link%bending_shapes%by_degree) then
            own = legendre_coefficients(link%bending_shapes, own, &
              merge(2, 1, link%bending_shapes%shear_stiffness > 0.0_wp), 0)
            own_strain = legendre_coefficients(link%axial_shapes, own_strain, 1, 1)
          end if
          bending(:size(own), i, b) = own
          strain(:size(own_strain), i, b) = own_strain
        end associate
      end do
    end do
    call project_modes(chain, near%links, bending, strain, vectors)
  end subroutine find_starts

  !> Unknowns of a continuous link as coefficients of Legendre polynomials, degree by degree and
  !! within a degree element by element, with zeros where an element has no such degree.
  pure function legendre_coefficients(shapes, own, kinds, numbered) result(coefficients)
    type(deformation_shapes_t), intent(in) :: shapes !! with unknowns ordered by degree
    real(wp), intent(in) :: own(:) !! (unknowns in use); axial: with the uniform strains of all
                                   !! elements first
    integer, intent(in) :: kinds    !! unknowns of a degree in an element, one after another
    integer, intent(in) :: numbered !! lowest degree whose unknowns have a number in the shapes;
                                    !! of the degrees below every element has its own, in order
    real(wp), allocatable :: coefficients(:)

    integer :: e, i, j, from

    allocate (coefficients(kinds*size(shapes%column)))
    coefficients = 0.0_wp
    do j = 0, ubound(shapes%column, 1)
      do e = 1, shapes%elements
        from = shapes%column(j, e) + numbered
        if (j < numbered) from = e
        if (from == numbered .or. from > size(own)) cycle
        do i = 0, kinds - 1
          coefficients(kinds*(j*shapes%elements + e - 1) + 1 + i) = sqrt(2*j + 1.0_wp)*own(from + i)
        end do
      end do
    end do
  end function legendre_coefficients

  !> Axial strains of all elements, scaled to energy, from the elongation of the link and the
  !! unknowns of `axial_shapes`.
  !!
  !! The order is that of `axial_shapes`, except for the uniform strains. By degree, those of all
  !! elements come first; by element, each stands at the head of its own element.
  pure function element_strains(shapes, elongation, own) result(strain)
    type(deformation_shapes_t), intent(in) :: shapes
    real(wp), intent(in) :: elongation !! unknown of the border [√J]
    real(wp), intent(in) :: own(:)     !! unknowns of `axial_shapes` [√J]
    real(wp) :: strain(size(own) + 1)

    real(wp) :: uniform(shapes%elements)
    integer :: e, elements, more

    elements = shapes%elements
    uniform = elongation/sqrt(elements/shapes%part)
    associate (last => shapes%last, part => shapes%part)
      do e = 1, elements - 1
        uniform(:e) = uniform(:e) + own(e)/sqrt(last(e)*last(e + 1)/part(e + 1)/part(:e))
        uniform(e + 1) = uniform(e + 1) - last(e)*own(e)/sqrt(last(e)*last(e + 1))
      end do
    end associate
    if (shapes%by_degree) then
      strain = [uniform, own(elements:)]
      return
    end if
    more = (size(own) + 1)/elements - 1
    do e = 1, elements
      strain((e - 1)*(more + 1) + 1) = uniform(e)
      strain((e - 1)*(more + 1) + 2:e*(more + 1)) = own(elements + (e - 1)*more:elements - 1 + &
        e*more)
    end do
  end function element_strains

end module chain_solver
