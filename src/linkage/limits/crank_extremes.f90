!> The least and the greatest value, over a range of the first drive, of quantities of a linkage.
module crank_extremes
  use bridges, only: node_weights
  use crank_limits, only: crank_range_t
  use errors, only: error_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use limited_quantities, only: is_a_sum, is_turning, measure, most_terms, place_of_slider, &
    quantity_t, total, unwrapped, value_of_coordinate
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_links
  implicit none (type, external)
  private

  public :: extremes_t, find_extremes

  !> Least and greatest value of a quantity, with the coordinates of the first drive there.
  type :: extremes_t
    real(wp) :: least = 0.0_wp, greatest = 0.0_wp !! [deg] or [m]
    real(wp) :: at_least = 0.0_wp, at_greatest = 0.0_wp
    real(wp) :: turned = 0.0_wp !! net change over a period [deg]; 0 if it returns
    integer :: reversals = 0    !! sign changes of its rate
  end type extremes_t

  !> What is known of a quantity on the way through a range.
  type :: walk_t
    logical :: has_last = .false. !! of the values behind
    real(wp) :: first_rate = 0.0_wp
    real(wp) :: c = 0.0_wp, rate = 0.0_wp
  end type walk_t

  integer, parameter :: most_halvings = 80

  !> What changes less than by rounding is constant: angles [deg], places as a share of the links.
  real(wp), parameter :: constant_angle = 1.0e-9_wp, constant_place = 1.0e-11_wp

contains

  !> Least and greatest values of quantities over a range. Of a constant they are the same.
  pure subroutine find_extremes(linkage, range, quantities, extremes)
    type(linkage_t), intent(in) :: linkage          !! of any kind, with its path
    type(crank_range_t), intent(in) :: range        !! one of `find_ranges`
    type(quantity_t), intent(in) :: quantities(:)   !! which
    type(extremes_t), intent(out) :: extremes(:)    !! (quantities) over the range

    type(walk_t) :: walks(size(quantities))
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients
    real(wp), dimension(most_terms(linkage, quantities), size(quantities)) :: value, first, last
    real(wp) :: rate(size(quantities)), c
    logical :: is_fine
    integer :: i, q

    do i = 0, range%samples
      c = range%from + (range%to - range%from)*i/range%samples
      call place(linkage, c, pose, coefficients, is_fine)
      if (.not. is_fine .and. .not. (i == 0 .or. i == range%samples)) cycle
      do q = 1, size(quantities)
        call measure(linkage, quantities(q), pose, coefficients, value(:, q), rate(q))
      end do
      if (.not. is_fine) call look_ahead(linkage, quantities, range, i == 0, value)
      do q = 1, size(quantities)
        if (.not. walks(q)%has_last) then
          first(:, q) = value(:, q)
          last(:, q) = value(:, q)
        end if
        call go_on(linkage, quantities(q), c, value(:, q), rate(q), is_fine, last(:, q), walks(q), &
          extremes(q))
      end do
    end do
    do q = 1, size(quantities)
      call finish(linkage, range, quantities(q), first(:, q), last(:, q), walks(q), extremes(q))
    end do
  end subroutine find_extremes

  !> Takes the next sample of a quantity, and what is extreme between it and the last one.
  pure subroutine go_on(linkage, quantity, c, value, rate, is_fine, last, walk, extremes)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: c, value(:), rate !! (terms) its value
    logical, intent(in) :: is_fine            !! there is a rate
    real(wp), intent(inout) :: last(:)        !! (terms) of the last sample
    type(walk_t), intent(inout) :: walk
    type(extremes_t), intent(inout) :: extremes

    real(wp), dimension(size(value)) :: here, middle_value, tried
    real(wp) :: low, high, low_rate, middle, middle_rate
    logical :: is_middle_fine
    integer :: k

    here = value
    if (walk%has_last) then
      here = unwrapped(linkage, quantity, value, last)
    else
      extremes%least = total(linkage, quantity, value)
      extremes%greatest = extremes%least
      extremes%at_least = c
      extremes%at_greatest = c
    end if
    call take(extremes, c, total(linkage, quantity, here))
    if (walk%has_last .and. is_fine .and. rate*walk%rate < 0.0_wp) then
      extremes%reversals = extremes%reversals + 1
      low = walk%c
      high = c
      low_rate = walk%rate
      middle = c
      middle_value = value
      do k = 1, most_halvings
        middle = 0.5_wp*(low + high)
        if (abs(high - low) <= 2.0_wp*spacing(abs(middle))) exit
        call evaluate(linkage, quantity, middle, tried, middle_rate, is_middle_fine)
        if (.not. is_middle_fine) exit
        middle_value = tried
        if (middle_rate*low_rate > 0.0_wp) then
          low = middle
        else
          high = middle
        end if
      end do
      call take(extremes, middle, total(linkage, quantity, unwrapped(linkage, quantity, &
        middle_value, last)))
    end if
    last = here
    ! A rate of zero has no sign to compare with: the next one is compared with the last that has.
    if (walk%has_last .and. is_fine .and. abs(rate) <= 0.0_wp) return
    walk%has_last = .true.
    walk%c = c
    walk%rate = merge(rate, 0.0_wp, is_fine)
    if (.not. abs(walk%first_rate) > 0.0_wp) walk%first_rate = walk%rate
  end subroutine go_on

  !> What is known at the end of a range.
  pure subroutine finish(linkage, range, quantity, first, last, walk, extremes)
    type(linkage_t), intent(in) :: linkage
    type(crank_range_t), intent(in) :: range
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: first(:), last(:) !! (terms) at its ends
    type(walk_t), intent(in) :: walk
    type(extremes_t), intent(inout) :: extremes

    real(wp) :: constant

    ! It may turn back where a turn begins.
    if (range%turns .and. walk%first_rate*walk%rate < 0.0_wp) extremes%reversals = &
      extremes%reversals + 1
    if (range%turns .and. is_turning(linkage, quantity)) extremes%turned = total(linkage, &
      quantity, 360.0_wp*anint((last - first)/360.0_wp))
    constant = constant_angle
    if (quantity%kind == place_of_slider .or. (quantity%kind == value_of_coordinate .and. .not. &
      is_turning(linkage, quantity))) constant = constant_place*maxval(linkage%bodies%length)
    if (is_a_sum(linkage, quantity)) constant = constant*sum(abs(linkage%coordinates( &
      quantity%number)%weight))
    if (extremes%greatest - extremes%least > constant) return
    extremes%greatest = extremes%least
    extremes%at_greatest = extremes%at_least
    extremes%reversals = 0
  end subroutine finish

  !> Quantities at an end of a range where there is no rate: those to which places inside lead.
  !! There solving loses half the digits, and where the pins that carry a dyad meet its direction is
  !! rounding; but all is smooth in the root of the distance from a limit. What does not depend on
  !! the dyad is exact as placed: within the error of the other value it is kept.
  pure subroutine look_ahead(linkage, quantities, range, is_first, value)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantities(:)
    type(crank_range_t), intent(in) :: range
    logical, intent(in) :: is_first          !! the end is the lower one
    real(wp), intent(inout) :: value(:, :)   !! (terms, quantities) as placed there

    integer, parameter :: nodes = 8
    !> Roots of the distance of the nearest place, as shares of the range: nearer places are
    !! rounded more, with others the polynomial is less exact.
    real(wp), parameter :: nearest(*) = [0.005_wp, 0.01_wp, 0.02_wp, 0.04_wp]
    !> Differences that are none: in estimates of an error, as a share of a value.
    real(wp), parameter :: doubt = 4.0_wp, rounding = 1.0e-13_wp
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients
    real(wp), dimension(size(value, 1), nodes, size(value, 2)) :: near
    real(wp), dimension(size(value, 1), size(value, 2)) :: least, ahead
    real(wp) :: root(nodes), weight(nodes, 0:2), fewer(nodes - 1, 0:2), found, error, rate, way
    logical :: is_fine
    integer :: i, k, q, t

    least = huge(1.0_wp)
    ahead = value
    do i = 1, size(nearest)
      root = [(nearest(i)*k, k=1, nodes)]
      do k = 1, nodes
        way = (range%to - range%from)*root(k)**2
        call place(linkage, merge(range%from + way, range%to - way, is_first), pose, coefficients, &
          is_fine)
        if (.not. is_fine) exit
        do q = 1, size(quantities)
          call measure(linkage, quantities(q), pose, coefficients, near(:, k, q), rate)
          near(:, k, q) = unwrapped(linkage, quantities(q), near(:, k, q), near(:, 1, q))
        end do
      end do
      if (.not. is_fine) cycle
      weight = node_weights(root, 0.0_wp)
      fewer = node_weights(root(:nodes - 1), 0.0_wp)
      do q = 1, size(quantities)
        do t = 1, size(value, 1)
          found = dot_product(weight(:, 0), near(t, :, q))
          error = abs(found - dot_product(fewer(:, 0), near(t, :nodes - 1, q)))
          if (error >= least(t, q)) cycle
          least(t, q) = error
          ahead(t, q) = found
        end do
      end do
    end do
    where (abs(ahead - value) > doubt*least + rounding*abs(value)) value = ahead
  end subroutine look_ahead

  pure subroutine take(extremes, c, value)
    type(extremes_t), intent(inout) :: extremes
    real(wp), intent(in) :: c, value

    if (value < extremes%least) then
      extremes%least = value
      extremes%at_least = c
    end if
    if (value > extremes%greatest) then
      extremes%greatest = value
      extremes%at_greatest = c
    end if
  end subroutine take

  !> A quantity and its rate, up to a positive factor, at a coordinate. Not fine near dead points,
  !! where there is no rate, and out of reach, where there is no value.
  pure subroutine evaluate(linkage, quantity, c, value, rate, is_fine)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: c
    real(wp), intent(out) :: value(:), rate !! (terms) its value
    logical, intent(out) :: is_fine

    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients

    call place(linkage, c, pose, coefficients, is_fine)
    call measure(linkage, quantity, pose, coefficients, value, rate)
  end subroutine evaluate

  !> A pose and its coefficients; without these near dead points, and without both out of reach.
  pure subroutine place(linkage, c, pose, coefficients, is_fine)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: c
    type(pose_t), intent(out) :: pose
    type(kinematic_coefficients_t), intent(out) :: coefficients
    logical, intent(out) :: is_fine !! neither of the two

    type(error_t), allocatable :: error

    call place_links(linkage, c, pose, error)
    is_fine = .not. allocated(error)
    if (.not. is_fine) then
      if (allocated(pose%pin)) deallocate (pose%pin)
      return
    end if
    is_fine = all(abs(pose%sine) > dead_point_sine) .or. allocated(pose%coefficients)
    if (is_fine) then
      coefficients = find_kinematic_coefficients(linkage, pose)
    else
      ! The rates are of no use, but they are asked for.
      allocate (coefficients%turn(size(linkage%bodies)), &
        coefficients%pin(2, size(linkage%is_ground)), source=0.0_wp)
    end if
  end subroutine place

end module crank_extremes
