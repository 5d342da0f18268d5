!> Pins and POINTs without a PIN card whose places in the drawing follow from two others of their
!! link.
module followed_places
  use card_lists, only: append_card
  use joint_cards, only: drawn_pin_t
  use kinds, only: wp
  use link_checks, only: is_ram
  use link_shapes, only: find_drawn_place, find_link_shape
  use models, only: model_t
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: find_followed_places

contains

  !> Draws what follows from PIN and GROUND cards and the shapes of links, link after link until
  !! nothing more does.
  pure subroutine find_followed_places(model)
    type(model_t), intent(inout) :: model !! links of its points are known; `followed` is set

    integer :: i, before

    if (allocated(model%followed)) deallocate (model%followed)
    allocate (model%followed(0))
    do
      before = size(model%followed)
      do i = 1, size(model%links)
        call draw_link(model, i)
      end do
      if (size(model%followed) == before) return
    end do
  end subroutine find_followed_places

  !> Draws the other pins and POINTs of a link of known shape that has two in the drawing; of a ram
  !! these are its ends.
  pure subroutine draw_link(model, number)
    type(model_t), intent(inout) :: model
    integer, intent(in) :: number !! of the link

    type(drawn_pin_t) :: pin
    type(token_t), allocatable :: names(:)
    real(wp), allocatable :: shape(:, :), places(:, :), drawn(:, :)
    logical, allocatable :: is_drawn(:)
    real(wp) :: own(2), turn(2), arm(2)
    integer :: i, n, first, second
    logical :: is_known

    call find_link_shape(model, model%links(number), shape, is_known)
    if (.not. is_known) return
    n = size(shape, 2)
    allocate (names(n + count(model%points%link == number)))
    allocate (places(2, size(names)), drawn(2, size(names)), is_drawn(size(names)))
    names(:n) = model%links(number)%pins
    places(:, :n) = shape
    ! A constructor would leak the names (gfortran 12).
    do i = 1, size(model%points)
      if (model%points(i)%link /= number) cycle
      n = n + 1
      names(n) = model%points(i)%name
      places(:, n) = model%points(i)%place
    end do
    do i = 1, size(names)
      call find_drawn_place(model, names(i)%text, drawn(:, i), is_drawn(i))
    end do
    first = findloc(is_drawn, .true., dim=1)
    if (first == 0 .or. all(is_drawn)) return
    second = first + findloc(is_drawn(first + 1:), .true., dim=1)
    if (is_ram(model, model%links(number)) .and. .not. all(is_drawn(:2))) return
    own = places(:, second) - places(:, first)
    arm = drawn(:, second) - drawn(:, first)
    if (.not. (norm2(own) > 0.0_wp .and. norm2(arm) > 0.0_wp)) return
    own = own/norm2(own)
    arm = arm/norm2(arm)
    ! From the axes of the link to global ones.
    turn = [arm(1)*own(1) + arm(2)*own(2), arm(2)*own(1) - arm(1)*own(2)]
    do i = 1, size(names)
      if (is_drawn(i)) cycle
      arm = places(:, i) - places(:, first)
      pin%pin = names(i)
      pin%position = drawn(:, first) + [turn(1)*arm(1) - turn(2)*arm(2), turn(2)*arm(1) + &
        turn(1)*arm(2)]
      call append_card(model%followed, pin)
    end do
  end subroutine draw_link

end module followed_places
