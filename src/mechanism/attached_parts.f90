!> Model → masses and points on the bodies of the linkage, and external loads. Places are turned
!! from the axes of the LINK card into those of the body.
module attached_parts
  use kinds, only: wp
  use link_bodies, only: link_center, link_inertia
  use link_cards, only: has_own_mass
  use linkages, only: linkage_t, lump_t
  use models, only: link_mass, model_t
  use text, only: same_word
  implicit none (type, external)
  private

  public :: body_point_t, attach_masses, apply_loads, points_of, place_on_body, body_of, &
    runs_against

  !> A point fixed to a body.
  type :: body_point_t
    character(len=:), allocatable :: name
    integer :: body = 0           !! number in the linkage, from 1
    real(wp) :: place(2) = 0.0_wp !! from the first pin, in the axes of the body [m]
  end type body_point_t

contains

  !> Gives every body its lumps: one for a link with a mass of its own, and one for each MASS card
  !! on it.
  pure subroutine attach_masses(model, linkage)
    type(model_t), intent(in) :: model        !! without errors
    type(linkage_t), intent(inout) :: linkage !! the lumps of its bodies are replaced

    integer :: i, k, filled

    do i = 1, size(model%loop)
      associate (link => model%links(model%loop(i)), body => linkage%bodies(i))
        deallocate (body%lumps)
        allocate (body%lumps(merge(1, 0, has_own_mass(link)) + &
          count(model%masses%link == model%loop(i))))
        filled = 0
        if (has_own_mass(link)) then
          filled = 1
          body%lumps(1) = own_lump(model, i)
        end if
        do k = 1, size(model%masses)
          if (model%masses(k)%link /= model%loop(i)) cycle
          filled = filled + 1
          body%lumps(filled)%mass = model%masses(k)%mass
          body%lumps(filled)%place = place_on_body(model, i, model%masses(k)%place)
          body%lumps(filled)%inertia = model%masses(k)%inertia
        end do
      end associate
    end do
  end subroutine attach_masses

  !> The lump of a link with a mass of its own: mass, mass centre, moment of inertia.
  pure function own_lump(model, body) result(lump)
    type(model_t), intent(in) :: model
    integer, intent(in) :: body
    type(lump_t) :: lump

    lump%mass = link_mass(model, model%loop(body))
    lump%place = place_on_body(model, body, link_center(model, model%loop(body)))
    lump%inertia = link_inertia(model, model%loop(body))
  end function own_lump

  !> A place on a link in the axes of its body. The first pin of the body may be the second pin of
  !! the LINK card.
  pure function place_on_body(model, body, place) result(turned)
    type(model_t), intent(in) :: model !! without errors
    integer, intent(in) :: body        !! number in the linkage, from 1
    real(wp), intent(in) :: place(2)   !! from the first pin of the card: along the link, and to its
                                       !! left [m]
    real(wp) :: turned(2)              !! from the first pin of the body, in its axes [m]

    associate (link => model%links(model%loop(body)))
      turned = place
      if (runs_against(model, body)) turned = [link%length - place(1), -place(2)]
    end associate
  end function place_on_body

  !> Whether a body runs from the second pin of its LINK card to the first.
  pure function runs_against(model, body) result(against)
    type(model_t), intent(in) :: model !! without errors
    integer, intent(in) :: body        !! number in the linkage, from 1
    logical :: against

    against = .not. same_word(model%links(model%loop(body))%pins(1)%text, &
      model%loop_pins(body)%text)
  end function runs_against

  !> Sets gravity, forces on pins and torques on links.
  pure subroutine apply_loads(model, linkage)
    type(model_t), intent(in) :: model        !! without errors
    type(linkage_t), intent(inout) :: linkage !! its external loads are set

    integer :: i, k

    linkage%gravity = model%gravity
    do i = 1, size(model%forces)
      do k = 1, size(model%loop_pins)
        if (same_word(model%forces(i)%pin%text, model%loop_pins(k)%text)) linkage%pin_force(:, &
          k) = model%forces(i)%force
      end do
    end do
    do i = 1, size(model%torques)
      linkage%couple(body_of(model, model%torques(i)%link)) = model%torques(i)%torque
    end do
  end subroutine apply_loads

  !> The points whose paths are requested, in the order of the deck.
  pure function points_of(model) result(points)
    type(model_t), intent(in) :: model           !! without errors
    type(body_point_t), allocatable :: points(:) !! (points)

    integer :: i

    allocate (points(size(model%points)))
    do i = 1, size(points)
      points(i)%name = model%points(i)%name%text
      points(i)%body = body_of(model, model%points(i)%link)
      points(i)%place = place_on_body(model, points(i)%body, model%points(i)%place)
    end do
  end function points_of

  !> Number of the body that stands for a link of the deck; 0 if none.
  pure function body_of(model, link) result(body)
    type(model_t), intent(in) :: model !! with its loop
    integer, intent(in) :: link        !! number in the model, from 1
    integer :: body

    body = findloc(model%loop, link, dim=1)
  end function body_of

end module attached_parts
