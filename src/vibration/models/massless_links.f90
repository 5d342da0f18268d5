!> Links that bend without mass of their own: a linkage whose masses are at pins and points has as
!! many frequencies as these have freedoms.
module massless_links
  use bordered_matrix, only: all_unknowns, dense_form, layout_t
  use errors, only: error_of_numerics, outcome_t, set_error
  use kinds, only: wp
  use linkages, only: body_t
  use position_equations, only: position_equations_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: refuse_missing_modes, mass_freedoms

  !> A pivot of M that is as small a share of the largest one is rounding: such a mode would be a
  !! million times as fast as the slowest.
  real(wp), parameter :: least_share = 1.0e-13_wp

contains

  !> Where links that bend have no mass, refuses more modes than the masses have freedoms.
  !!
  !! Errors, at every speed without one: fewer modes than wanted.
  pure subroutine refuse_missing_modes(bodies, equations, layout, modes, outcome)
    type(body_t), intent(in) :: bodies(:) !! the links of the model
    type(position_equations_t), intent(in) :: equations !! of this position, with M
    type(layout_t), intent(in) :: layout          !! of M
    integer, intent(in) :: modes                  !! wanted
    type(outcome_t), intent(inout) :: outcome(:)  !! (speeds)

    integer :: found, k

    if (.not. any(bodies%bends .and. bodies%line_density <= 0.0_wp)) return
    found = mass_freedoms(dense_form(layout, equations%pencil%mass, all_unknowns(layout)))
    if (found >= modes) return
    do k = 1, size(outcome)
      if (.not. allocated(outcome(k)%error)) call set_error(outcome(k)%error, error_of_numerics, &
        "links without mass have as many modes as the masses on them have freedoms, here "// &
        to_string(found)//"; expected MODES "//to_string(max(1, found)))
    end do
  end subroutine refuse_missing_modes

  !> The rank of M, by Cholesky's factorization with the largest pivot first.
  pure function mass_freedoms(mass) result(rank)
    real(wp), intent(in) :: mass(:, :) !! symmetric, not negative [s²]
    integer :: rank

    real(wp) :: rest(size(mass, 1), size(mass, 1)), column(size(mass, 1)), largest
    integer :: i, j

    rest = mass
    largest = 0.0_wp
    do rank = 0, size(mass, 1) - 1
      j = maxloc([(rest(i, i), i=1, size(mass, 1))], dim=1)
      largest = max(largest, rest(j, j))
      if (rest(j, j) <= least_share*largest) return
      column = rest(:, j)/sqrt(rest(j, j))
      do i = 1, size(mass, 1)
        rest(:, i) = rest(:, i) - column*column(i)
      end do
    end do
  end function mass_freedoms

end module massless_links
