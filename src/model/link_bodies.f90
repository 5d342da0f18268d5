!> Links of a deck as rigid bodies. Values on the LINK card take precedence over those of section
!! and material.
module link_bodies
  use kinds, only: wp
  use link_cards, only: segment_count
  use link_shapes, only: find_link_shape
  use models, only: link_line_density, model_t
  use shear, only: link_rotary_inertia
  implicit none (type, external)
  private

  public :: link_center, link_inertia, uniform_center

contains

  !> Mass centre of a link, from the first pin of its card: along the link, and to the left of the
  !! direction to the second pin [m].
  pure function link_center(model, link) result(center)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: center(2)

    center = uniform_center(model, link)
    if (model%links(link)%has_center) center = model%links(link)%center
  end function link_center

  !> Mass centre of the uniform link, whatever its `center=`: of one with several segments that of
  !! all of them.
  pure function uniform_center(model, link) result(center)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: center(2)

    real(wp), allocatable :: middle(:, :), length(:)

    center = [0.5_wp*model%links(link)%length, 0.0_wp]
    call find_segments(model, link, middle, length)
    if (size(length) == 0) return
    center = matmul(middle, length)/sum(length)
  end function uniform_center

  !> Middles and lengths of the segments of a link with three pins or more whose shape is known;
  !! none of any other.
  pure subroutine find_segments(model, link, middle, length)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    real(wp), allocatable, intent(out) :: middle(:, :) !! (2, segments) in the axes of the link [m]
    real(wp), allocatable, intent(out) :: length(:)    !! (segments) [m]

    real(wp), allocatable :: places(:, :)
    integer :: i, segments, next
    logical :: known

    segments = 0
    if (allocated(model%links(link)%pins)) then
      if (size(model%links(link)%pins) > 2) then
        call find_link_shape(model, model%links(link), places, known)
        if (known) segments = segment_count(model%links(link))
      end if
    end if
    allocate (middle(2, segments), length(segments))
    do i = 1, segments
      next = mod(i, size(places, 2)) + 1
      middle(:, i) = 0.5_wp*(places(:, i) + places(:, next))
      length(i) = norm2(places(:, next) - places(:, i))
    end do
  end subroutine find_segments

  !> Moment of inertia of a link about its mass centre [kg m²]: that of its card, else `ρA L³/12` of
  !! material and section, plus `ρI L` with EFFECTS rotary; 0 without either. Of several segments
  !! their sum about the common mass centre, `ρA Σ L(L²/12 + d²) + ρI ΣL`. With a mass on the card
  !! it is that of the uniform link with this mass, whatever its material: `m L²/12`, and with
  !! EFFECTS rotary and a section `m (L²/12 + I/A)`.
  pure function link_inertia(model, link) result(inertia)
    type(model_t), intent(in) :: model !! whose links have their materials and sections
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: inertia

    real(wp) :: mass

    associate (this => model%links(link))
      if (this%has_inertia) then
        inertia = this%inertia
        return
      end if
      mass = link_line_density(model, link)*this%length
      inertia = link_line_density(model, link)*uniform_moment(model, link) + &
        link_rotary_inertia(model, link)*this%length
      if (.not. this%has_mass) return
      if (mass > 0.0_wp) then
        inertia = this%mass*(inertia/mass)
      else if (this%length > 0.0_wp) then
        inertia = this%mass*(uniform_moment(model, link)/this%length)
      end if
    end associate
  end function link_inertia

  !> Second moment of the way from pin to pin about its middle, or about that of all segments [m³].
  pure function uniform_moment(model, link) result(moment)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    real(wp) :: moment

    real(wp), allocatable :: middle(:, :), length(:)
    real(wp) :: center(2)
    integer :: i

    moment = model%links(link)%length**3/12.0_wp
    call find_segments(model, link, middle, length)
    if (size(length) == 0) return
    center = uniform_center(model, link)
    moment = 0.0_wp
    do i = 1, size(length)
      moment = moment + length(i)*(length(i)**2/12.0_wp + sum((middle(:, i) - center)**2))
    end do
  end function uniform_moment

end module link_bodies
