!> The beam element of the thesis: cubic across the link, linear along it.
!!
!! Unknowns {u1 v1 θ1 u2 v2 θ2} (2.72): along and across the element and the rotation, at either node.
module beam_element
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: element_mass, element_stiffness, element_geometric_stiffness, element_load, turned_to_global, to_local, interpolate

contains

  !> Consistent mass matrix, Ulker 2010 (2.78).
  pure function element_mass(line_density, length) result(mass)
    real(wp), intent(in) :: line_density !! ρA [kg/m]
    real(wp), intent(in) :: length       !! [m]
    real(wp) :: mass(6, 6)               !! [kg, kg m, kg m²]

    mass = 0.0_wp
    mass([1, 4], [1, 4]) = reshape([2.0_wp, 1.0_wp, 1.0_wp, 2.0_wp]/6.0_wp, [2, 2])
    mass([2, 3, 5, 6], [2, 3, 5, 6]) = reshape([ &
      156.0_wp, 22.0_wp, 54.0_wp, -13.0_wp, &
      22.0_wp, 4.0_wp, 13.0_wp, -3.0_wp, &
      54.0_wp, 13.0_wp, 156.0_wp, -22.0_wp, &
      -13.0_wp, -3.0_wp, -22.0_wp, 4.0_wp]/420.0_wp, [4, 4])
    mass = line_density*length*with_lengths(mass, length)
  end function element_mass

  !> Stiffness matrix, Ulker 2010 (2.79) with entry (3, 6) = +2EI/L.
  pure function element_stiffness(axial, bending, length) result(stiffness)
    real(wp), intent(in) :: axial        !! EA [N]
    real(wp), intent(in) :: bending      !! EI [N m²]
    real(wp), intent(in) :: length       !! [m]
    real(wp) :: stiffness(6, 6)          !! [N/m, N, N m]

    stiffness = 0.0_wp
    stiffness([1, 4], [1, 4]) = axial/length*reshape([1.0_wp, -1.0_wp, -1.0_wp, 1.0_wp], [2, 2])
    stiffness([2, 3, 5, 6], [2, 3, 5, 6]) = bending/length**3*reshape([ &
      12.0_wp, 6.0_wp, -12.0_wp, 6.0_wp, &
      6.0_wp, 4.0_wp, -6.0_wp, 2.0_wp, &
      -12.0_wp, -6.0_wp, 12.0_wp, -6.0_wp, &
      6.0_wp, 2.0_wp, -6.0_wp, 4.0_wp], [4, 4])
    stiffness = with_lengths(stiffness, length)
  end function element_stiffness

  !> Geometric stiffness `∫ N v'² dx` of an axial force `N(ξ) = n0 + n1 ξ + n2 ξ²`, ξ from 0 to 1 along the element.
  !!
  !! For n1 = n2 = 0 this is (2.84) of Ulker (2010); the other two are the same integrals with ξ and ξ².
  pure function element_geometric_stiffness(force, length) result(stiffness)
    real(wp), intent(in) :: force(0:2) !! n0, n1, n2, tension positive [N]
    real(wp), intent(in) :: length     !! [m]
    real(wp) :: stiffness(6, 6)        !! [N/m, N, N m]

    real(wp), parameter :: constant(4, 4) = reshape([ &
      36.0_wp, 3.0_wp, -36.0_wp, 3.0_wp, &
      3.0_wp, 4.0_wp, -3.0_wp, -1.0_wp, &
      -36.0_wp, -3.0_wp, 36.0_wp, -3.0_wp, &
      3.0_wp, -1.0_wp, -3.0_wp, 4.0_wp]/30.0_wp, [4, 4])
    real(wp), parameter :: linear(4, 4) = reshape([ &
      36.0_wp, 6.0_wp, -36.0_wp, 0.0_wp, &
      6.0_wp, 2.0_wp, -6.0_wp, -1.0_wp, &
      -36.0_wp, -6.0_wp, 36.0_wp, 0.0_wp, &
      0.0_wp, -1.0_wp, 0.0_wp, 6.0_wp]/60.0_wp, [4, 4])
    real(wp), parameter :: quadratic(4, 4) = reshape([ &
      72.0_wp, 15.0_wp, -72.0_wp, -6.0_wp, &
      15.0_wp, 4.0_wp, -15.0_wp, -3.0_wp, &
      -72.0_wp, -15.0_wp, 72.0_wp, 6.0_wp, &
      -6.0_wp, -3.0_wp, 6.0_wp, 18.0_wp]/210.0_wp, [4, 4])

    stiffness = 0.0_wp
    stiffness([2, 3, 5, 6], [2, 3, 5, 6]) = (force(0)*constant + force(1)*linear + force(2)*quadratic)/length
    stiffness = with_lengths(stiffness, length)
  end function element_geometric_stiffness

  !> Consistent load of forces per length that vary linearly, `f(ξ) = f1 + (f2 − f1) ξ`, in the element's own axes.
  pure function element_load(force_first, force_last, length) result(load)
    real(wp), intent(in) :: force_first(2) !! along and across at the first node [N/m]
    real(wp), intent(in) :: force_last(2)  !! at the last node [N/m]
    real(wp), intent(in) :: length         !! [m]
    real(wp) :: load(6)                    !! [N, N m]

    load([1, 4]) = length/6.0_wp*[2.0_wp*force_first(1) + force_last(1), force_first(1) + 2.0_wp*force_last(1)]
    load([2, 5]) = length/20.0_wp*[7.0_wp*force_first(2) + 3.0_wp*force_last(2), 3.0_wp*force_first(2) + 7.0_wp*force_last(2)]
    load(3) = length**2/60.0_wp*(3.0_wp*force_first(2) + 2.0_wp*force_last(2))
    load(6) = -length**2/60.0_wp*(2.0_wp*force_first(2) + 3.0_wp*force_last(2))
  end function element_load

  !> Gives rotations, written as L θ in the tables above, their length.
  pure function with_lengths(matrix, length) result(scaled)
    real(wp), intent(in) :: matrix(6, 6)
    real(wp), intent(in) :: length
    real(wp) :: scaled(6, 6)

    scaled = matrix
    scaled([3, 6], :) = scaled([3, 6], :)*length
    scaled(:, [3, 6]) = scaled(:, [3, 6])*length
  end function with_lengths

  !> An element matrix in the global axes: `Tᵀ A T`, T made of the transpose of (2.75) at either node.
  pure function turned_to_global(matrix, direction) result(turned)
    real(wp), intent(in) :: matrix(6, 6)
    real(wp), intent(in) :: direction(2) !! unit vector along the element
    real(wp) :: turned(6, 6)

    real(wp) :: t(6, 6)

    t = rotation(direction)
    turned = matmul(transpose(t), matmul(matrix, t))
  end function turned_to_global

  !> Displacements in global axes, seen in the element's own.
  pure function to_local(displacement, direction) result(local)
    real(wp), intent(in) :: displacement(6)
    real(wp), intent(in) :: direction(2)
    real(wp) :: local(6)

    local = matmul(rotation(direction), displacement)
  end function to_local

  pure function rotation(direction) result(t)
    real(wp), intent(in) :: direction(2)
    real(wp) :: t(6, 6)

    t = 0.0_wp
    t([1, 2], [1, 2]) = reshape([direction(1), -direction(2), direction(2), direction(1)], [2, 2])
    t([4, 5], [4, 5]) = t([1, 2], [1, 2])
    t(3, 3) = 1.0_wp
    t(6, 6) = 1.0_wp
  end function rotation

  !> Displacement inside the element: along it, across it, and the rotation v'. Equation (2.71).
  pure function interpolate(local, length, xi) result(displacement)
    real(wp), intent(in) :: local(6) !! in the element's own axes
    real(wp), intent(in) :: length   !! [m]
    real(wp), intent(in) :: xi       !! from 0 to 1 along the element
    real(wp) :: displacement(3)

    real(wp) :: shape(4), slope(4)

    shape = [(1.0_wp - xi)**2*(1.0_wp + 2.0_wp*xi), length*xi*(1.0_wp - xi)**2, &
      xi**2*(3.0_wp - 2.0_wp*xi), length*xi**2*(xi - 1.0_wp)]
    slope = [-6.0_wp*xi*(1.0_wp - xi)/length, (1.0_wp - xi)*(1.0_wp - 3.0_wp*xi), 6.0_wp*xi*(1.0_wp - xi)/length, &
      xi*(3.0_wp*xi - 2.0_wp)]
    displacement(1) = (1.0_wp - xi)*local(1) + xi*local(4)
    displacement(2) = dot_product(shape, local([2, 3, 5, 6]))
    displacement(3) = dot_product(slope, local([2, 3, 5, 6]))
  end function interpolate

end module beam_element
