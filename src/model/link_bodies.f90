!> Links of a deck as rigid bodies. Values on the LINK card take precedence over those of section
!! and material.
module link_bodies
  use kinds, only: wp
  use models, only: link_line_density, model_t
  use shear, only: link_rotary_inertia
  implicit none (type, external)
  private

  public :: link_center, link_inertia

contains

  !> Mass centre of a link, from the first pin of its card: along the link, and to the left of the
  !! direction to the second pin [m].
  pure function link_center(model, link) result(center)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: center(2)

    center = [0.5_wp*model%links(link)%length, 0.0_wp]
    if (model%links(link)%has_center) center = model%links(link)%center
  end function link_center

  !> Moment of inertia of a link about its mass centre [kg m²]: that of its card, else `ρA L³/12` of
  !! material and section, plus `ρI L` with EFFECTS rotary; 0 without either.
  pure function link_inertia(model, link) result(inertia)
    type(model_t), intent(in) :: model !! whose links have their materials and sections
    integer, intent(in) :: link        !! number in the model, from 1
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
