!> How the effect of the border unknowns on the chords changes as the crank turns: derivatives of
!! `find_chords` along the motion, exact at any position away from dead points.
module chord_slopes
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use link_modes, only: link_modes_t
  use linkages, only: cross, group_t, linkage_t, normal_to
  use pin_displacements, only: border_numbers, chords_t
  use poses, only: arm_to_middle, pose_t
  implicit none (type, external)
  private

  public :: find_chord_slopes

contains

  !> d/dθ2 of all effects. Axes turn with their bodies: `e' = h n`, `n' = −h e`.
  pure function find_chord_slopes(linkage, links, pose, coefficients, chords) result(slopes)
    type(linkage_t), intent(in) :: linkage     !! bodies and dyads
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(pose_t), intent(in) :: pose           !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! at this pose
    type(chords_t), intent(in) :: chords       !! at this pose
    type(chords_t) :: slopes                   !! per radian

    integer :: number(0:size(links)), b, i, j, border

    number = border_numbers(linkage)
    border = size(chords%turn, 1)
    allocate (slopes%pin, mold=chords%pin)
    slopes%pin = 0.0_wp
    associate (driven => linkage%bodies(1), e => pose%direction(:, 1))
      if (driven%bends) then
        slopes%pin(:, driven%last_pin, number(0)) = links(1)%curve_rotation(1)*driven%length*e
        slopes%pin(:, driven%last_pin, number(1)) = links(1)%elongation*normal_to(e)
      end if
    end associate
    do i = 1, size(linkage%groups)
      call move_dyad(linkage, links, linkage%groups(i), pose, coefficients, number, chords, slopes)
    end do
    allocate (slopes%across, mold=chords%across)
    allocate (slopes%along, mold=chords%along)
    allocate (slopes%turn, mold=chords%turn)
    do b = 1, size(links)
      associate (body => linkage%bodies(b), e => pose%direction(:, b), h => coefficients%turn(b))
        do j = 1, border
          slopes%across(1, j, b) = -h*chords%along(1, j, b) + dot_product(normal_to(e), &
            slopes%pin(:, body%first_pin, j))
          slopes%across(2, j, b) = -h*chords%along(2, j, b) + dot_product(normal_to(e), &
            slopes%pin(:, body%last_pin, j))
          slopes%across(3:, j, b) = 0.0_wp
          slopes%along(1, j, b) = h*chords%across(1, j, b) + dot_product(e, &
            slopes%pin(:, body%first_pin, j))
          slopes%along(2, j, b) = h*chords%across(2, j, b) + dot_product(e, &
            slopes%pin(:, body%last_pin, j))
        end do
        slopes%turn(:, b) = (slopes%across(2, :, b) - slopes%across(1, :, b))/body%length
      end associate
    end do
  end function find_chord_slopes

  !> The middle pin of a dyad: with `U = (q n1 − p n2)/s`, `s = sin(θ4 − θ3)`, `p = e1·U1 + δ1` and
  !! so on, `U' = (q' n1 − q h1 e1 − p' n2 + p h2 e2 − s' U)/s`.
  pure subroutine move_dyad(linkage, links, dyad, pose, coefficients, number, chords, slopes)
    type(linkage_t), intent(in) :: linkage
    type(link_modes_t), intent(in) :: links(:)
    type(group_t), intent(in) :: dyad
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    integer, intent(in) :: number(0:) !! of the border unknowns
    type(chords_t), intent(in) :: chords
    type(chords_t), intent(inout) :: slopes

    real(wp) :: e(2, 2), h(2), side(2), side_slope(2), sine, sine_slope
    integer :: j, k

    do k = 1, 2
      e(:, k) = arm_to_middle(linkage, dyad, pose, k)
    end do
    h = coefficients%turn(dyad%body)
    sine = cross(e(:, 1), e(:, 2))
    sine_slope = dot_product(e(:, 1), e(:, 2))*(h(2) - h(1))
    do j = 1, size(chords%turn, 1)
      do k = 1, 2
        associate (base => chords%pin(:, dyad%base(k), j), &
          base_slope => slopes%pin(:, dyad%base(k), j))
          side(k) = dot_product(e(:, k), base)
          if (j == number(dyad%body(k))) side(k) = side(k) + links(dyad%body(k))%elongation
          side_slope(k) = h(k)*dot_product(normal_to(e(:, k)), base) + dot_product(e(:, k), &
            base_slope)
        end associate
      end do
      slopes%pin(:, dyad%middle, j) = (side_slope(2)*normal_to(e(:, 1)) - side(2)*h(1)*e(:, 1) - &
        side_slope(1)*normal_to(e(:, 2)) + side(1)*h(2)*e(:, 2) - &
        sine_slope*chords%pin(:, dyad%middle, j))/sine
    end do
  end subroutine move_dyad

end module chord_slopes
