!> Counterweights on the two grounded links of a four-bar that cancel its shaking force, whatever
!! its motion.
!!
!! R. S. Berkof, G. G. Lowen: A new method for completely force balancing simple linkages. J. Eng.
!! Ind. 91 (1969) 21. Since the loop closes, the coupler's direction can be expressed by those of
!! the other links. If the coefficients of these in the first moment of the linkage vanish, its mass
!! centre stands still.
module counterweights
  use balanced_linkages, only: counterweight_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  implicit none (type, external)
  private

  public :: find_counterweights

contains

  !> The counterweights of crank and follower, about their ground pivots.
  !!
  !! Their first moments are `−[m2 z2 + m3 r2 (1 − z3/r3) + m_A r2]` and
  !! `−[m4 z4 + m3 r4 z3/r3 + m_B r4]`, where m z are the first moments of the links in complex
  !! coordinates: x from the ground pivot to the moving pin, for the coupler from A to B. Gravity,
  !! loads and the position of the ground do not matter.
  pure function find_counterweights(linkage, elements) result(weights)
    type(linkage_t), intent(in) :: linkage !! a plain four-bar: O2–A, A–B, B–O4
    integer, intent(in) :: elements(:)     !! (bodies) elements whose nodes carry the mass;
                                           !! 0: distributed mass
    type(counterweight_t) :: weights(2)

    real(wp), parameter :: rounding = 1.0e-14_wp
    type(rigid_body_t) :: rigid(3)
    real(wp) :: parts(2, 4), r2, r3, r4
    integer :: i

    rigid = rigid_bodies_of(linkage, elements)
    r2 = linkage%bodies(1)%length
    r3 = linkage%bodies(2)%length
    r4 = linkage%bodies(3)%length
    do i = 1, 2
      if (i == 1) then
        weights(i)%body = 1
        parts(:, 1) = rigid(1)%first_moment
        parts(:, 2) = [rigid(2)%mass*r2, 0.0_wp]
        parts(:, 3) = -rigid(2)%first_moment*(r2/r3)
        parts(:, 4) = [linkage%pin_mass(linkage%bodies(2)%first_pin)*r2, 0.0_wp]
      else
        weights(i)%body = 3
        ! The axes of the follower's body start at B and point to O4.
        parts(:, 1) = [rigid(3)%mass*r4, 0.0_wp]
        parts(:, 2) = -rigid(3)%first_moment
        parts(:, 3) = rigid(2)%first_moment*(r4/r3)
        parts(:, 4) = [linkage%pin_mass(linkage%bodies(2)%last_pin)*r4, 0.0_wp]
      end if
      associate (body => linkage%bodies(weights(i)%body))
        weights(i)%pin = merge(body%first_pin, body%last_pin, body%heading(1) > 0.0_wp)
        weights(i)%towards = merge(body%last_pin, body%first_pin, body%heading(1) > 0.0_wp)
      end associate
      weights(i)%first_moment = -sum(parts, dim=2)
      weights(i)%needed = norm2(weights(i)%first_moment) > rounding*sum(norm2(parts, dim=1))
    end do
  end function find_counterweights

end module counterweights
