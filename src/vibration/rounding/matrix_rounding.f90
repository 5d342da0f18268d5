!> Effect of the rounding of M and K_G on the eigenvalues at a position.
!!
!! The entries of both are integrals of products of own modes, and own modes are sums of polynomials
!! in which much may cancel: a heavy mass along a link stands still in all modes but one, and high
!! modes of a stout link are made of large terms. In K_G under large loads terms cancel, too.
module matrix_rounding
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t
  use eigenvalue_gaps, only: relative_error
  use kinds, only: wp
  use link_modes, only: rigid
  use pin_displacements, only: body_displacement, chords_t
  use reduced_assembly, only: first_axial
  implicit none (type, external)
  private

  public :: find_matrix_errors, force_sizes

  !> Rounding error of an entry, in units of ε times the terms that it is made of; measured against
  !! quadruple precision.
  real(wp), parameter :: multiple = 2.0_wp

  !> The same in the mass matrix of a link with masses, as a multiple. Only the diagonal of its own
  !! modes is kept: entries beside it are rounding, which shows where one own mode moves a million
  !! times the mass of the others. Measured: 2.3 times.
  real(wp), parameter :: multiple_of_lumps = 4.0_wp

contains

  !> Sum of the magnitudes of all forces of which the axial force of a link is made, whatever they
  !! cancel [N].
  pure function force_sizes(unit_force, factor) result(size_of)
    real(wp), intent(in) :: unit_force(:, :, :) !! (force functions, bodies, cases) [N]
    real(wp), intent(in) :: factor(:)           !! (cases) of the unit loads: ω2², α2, 1
    real(wp) :: size_of(size(unit_force, 2))

    integer :: b, i

    size_of = 0.0_wp
    do i = 1, size(factor)
      do b = 1, size(size_of)
        size_of(b) = size_of(b) + abs(factor(i))*sum(abs(unit_force(:, b, i)))
      end do
    end do
  end function force_sizes

  !> Estimated relative error of every eigenvalue due to the rounding of the integrals in M and K_G.
  !!
  !! By the Cauchy–Schwarz inequality an entry between two shapes f and g is at most ‖f‖ ‖g‖, and
  !! its rounding ε ‖f‖ times the norm of the magnitudes of which g is made.
  pure subroutine find_matrix_errors(model, chords, force_size, found, modes, error, load_work)
    type(deformation_model_t), intent(in) :: model !! of the links
    type(chords_t), intent(in) :: chords           !! at this position
    real(wp), intent(in) :: force_size(:)          !! (bodies) of `force_sizes` [N]
    type(bordered_modes_t), intent(in) :: found    !! modes at this position and speed
    integer, intent(in) :: modes                   !! number, lowest first
    real(wp), intent(out) :: error(:)              !! (modes) relative, of eigenvalues
    real(wp), intent(out) :: load_work(:)          !! (modes) bound of `∫ N v'² dx` for yᵀMy = 1
                                                   !! with the largest force of all links in each:
                                                   !! forces pass from link to link, and their
                                                   !! errors, too [1/s²]

    real(wp) :: mass_error, slope_error, slopes
    integer :: b, i

    do i = 1, modes
      mass_error = 0.0_wp
      slope_error = 0.0_wp
      slopes = 0.0_wp
      do b = 1, size(model%links)
        call add_link(model, chords, found%vector(:, i), b, force_size(b), mass_error, &
          slope_error, slopes)
      end do
      error(i) = multiple*epsilon(1.0_wp)*(mass_error + relative_error(slope_error, &
        found%lambda(i)))
      ! Whatever their mass, free motions at rest have the eigenvalue zero.
      if (i <= found%zeros) error(i) = 0.0_wp
      load_work(i) = maxval(force_size)*slopes
    end do
  end subroutine find_matrix_errors

  !> Adds the terms of one link.
  pure subroutine add_link(model, chords, vector, b, force_size, mass_error, slope_error, slopes)
    type(deformation_model_t), intent(in) :: model
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: vector(:)
    integer, intent(in) :: b
    real(wp), intent(in) :: force_size
    real(wp), intent(inout) :: mass_error, slope_error
    real(wp), intent(inout) :: slopes !! bound of `∫ v'² dx`

    real(wp) :: ends(max(3, size(chords%across, 1))), turn, norm, terms, along
    integer :: i, first, own

    associate (link => model%links(b), border => vector(:model%layout%border))
      if (.not. link%bends) then
        ends(:3) = abs(matmul(body_displacement(chords, b), border))
        mass_error = mass_error + dot_product(ends(:3), matmul(abs(link%rigid_mass), ends(:3)))
        turn = link%length*dot_product(chords%turn(:, b), border)**2
        slope_error = slope_error + force_size*turn
        slopes = slopes + turn
        return
      end if
      do i = 1, 2 + link%curves
        ends(i) = abs(dot_product(chords%across(i, :, b), border))
      end do
      turn = abs(dot_product(chords%turn(:, b), border))
      norm = sqrt(link%linear(1, 1))*ends(1) + sqrt(link%linear(2, 2))*ends(2)
      terms = norm
      do i = 1, link%curves
        terms = terms + link%terms(i - link%curves)*ends(2 + i)
        norm = norm + sqrt(link%linear(2 + i, 2 + i))*ends(2 + i)
      end do
      first = model%layout%first(b) - 1
      do i = 1, link%modes
        norm = norm + sqrt(link%square(i))*abs(vector(first + i))
        terms = terms + link%terms(i)*abs(vector(first + i))
      end do
      along = 0.0_wp
      do i = 1, 2
        along = along + sqrt(link%axial_linear(i, i))*abs(dot_product(chords%along(i, :, b), &
          border))
      end do
      if (link%coupled) then
        norm = norm + along
        terms = terms + along
      end if
      if (link%bending_shapes%lumps > 0) terms = multiple_of_lumps*terms
      mass_error = mass_error + norm*terms
      if (force_size > 0.0_wp) then
        norm = link%slope_norm(rigid)*turn
        terms = link%slope_terms(rigid)*turn
        do i = 1, link%curves
          norm = norm + link%slope_norm(rigid + i)*ends(2 + i)
          terms = terms + link%slope_terms(rigid + i)*ends(2 + i)
        end do
        own = rigid + link%curves
        do i = 1, link%modes
          norm = norm + link%slope_norm(own + i)*abs(vector(first + i))
          terms = terms + link%slope_terms(own + i)*abs(vector(first + i))
        end do
        slope_error = slope_error + force_size*norm*terms
        slopes = slopes + norm**2
      end if
      if (link%coupled) return
      norm = along
      terms = norm
      first = first_axial(model%layout, model%links, b) - 1
      do i = 1, link%axial_modes
        norm = norm + sqrt(link%axial_square(i))*abs(vector(first + i))
        terms = terms + link%axial_terms(i)*abs(vector(first + i))
      end do
      mass_error = mass_error + norm*terms
    end associate
  end subroutine add_link

end module matrix_rounding
