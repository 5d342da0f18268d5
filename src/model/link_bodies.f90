!> What the links of a deck are as rigid bodies: their own card goes before section and material.
module link_bodies
  use kinds, only: wp
  use models, only: link_line_density, model_t
  use shear, only: link_rotary_inertia
  implicit none (type, external)
  private

  public :: link_center, link_inertia

contains

  !> Mass centre of a link, from the first pin of its card: along the link, and to the left of the
  !! way to the second pin [m].
  pure function link_center(model, link) result(center)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    real(wp) :: center(2)

    center = [0.5_wp*model%links(link)%length, 0.0_wp]
    if (model%links(link)%has_center) center = model%links(link)%center
  end function link_center

  !> Moment of inertia of a link about its mass centre; of material and section `ρA L³/12`, with
  !! rotary inertia `ρI L` more; 0 without these [kg m²].
  pure function link_inertia(model, link) result(inertia)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    real(wp) :: inertia

    associate (this => model%links(link))
      if (this%has_inertia) then
        inertia = this%inertia
      else
        inertia = link_line_density(model, link)*this%length**3/12.0_wp + &
          link_rotary_inertia(model, link)*this%length
      end if
    end associate
  end function link_inertia

end module link_bodies
