!> What all studies of elastic linkages in motion ask of a model.
module elastic_requests
  use elastic_equations, only: elastic_terms_t
  use kinds, only: wp
  use models, only: model_t
  use response_builder, only: body_damping_t, damping_by_ratio, damping_by_time, dampings_of
  use response_types, only: damping_ratio, damping_time, link_damping_t, no_damping
  implicit none (type, external)
  private

  public :: terms_of, link_dampings_of

contains

  !> The terms of the equations of motion that are not left out.
  pure function terms_of(model) result(terms)
    type(model_t), intent(in) :: model
    type(elastic_terms_t) :: terms

    terms%coriolis = .not. model%without%coriolis
    terms%centripetal = .not. model%without%centripetal
    terms%axial = .not. model%without%axial
    terms%quadratic = .not. model%without%quadratic
  end function terms_of

  !> Damping of every body.
  pure function link_dampings_of(model, links) result(found)
    type(model_t), intent(in) :: model
    integer, intent(in) :: links(:) !! (bodies) numbers of their links in the model
    type(link_damping_t) :: found(size(links))

    type(body_damping_t) :: dampings(size(links))
    integer :: b

    dampings = dampings_of(model, links)
    do b = 1, size(dampings)
      select case (dampings(b)%kind)
      case (damping_by_time)
        found(b) = link_damping_t(damping_time, dampings(b)%value)
      case (damping_by_ratio)
        found(b) = link_damping_t(damping_ratio, dampings(b)%value)
      case default
        found(b) = link_damping_t(no_damping, 0.0_wp)
      end select
    end do
  end function link_dampings_of

end module elastic_requests
