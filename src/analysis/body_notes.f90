!> Links with masses of their own, masses fixed to links and constant loads, as the log tells them.
module body_notes
  use attached_parts, only: is_solid
  use kinds, only: wp
  use link_cards, only: has_own_mass
  use load_notes, only: gravity_words, outside_loads
  use mechanisms, only: mechanism_t
  use load_cases, only: has_constant_loads
  use models, only: model_t
  use text, only: append_string, string_t, to_string
  use units, only: coherent_unit, dimension_inertia, dimension_length, dimension_mass, from_si, unit_t
  implicit none (type, external)
  private

  public :: body_notes_of

contains

  !> A line a link with a mass of its own, a mass fixed to a link, and for gravity and the loads from outside if there are any.
  pure function body_notes_of(model, mechanism) result(notes)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(string_t), allocatable :: notes(:)

    type(unit_t) :: length, mass
    integer :: b, i

    allocate (notes(0))
    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    do b = 1, size(mechanism%names)
      if (has_own_mass(model%links(model%loop(b)))) call append_string(notes, own_mass(model, mechanism, b))
    end do
    do i = 1, size(model%masses)
      associate (this => model%masses(i), link => model%links(model%masses(i)%link))
        call append_string(notes, "mass on link "//link%name%text//": "//to_string(from_si(this%mass, mass), 12)//" "// &
          mass%name//" at "//place_words(this%place, length)//" from "//link%pin(1)%text)
      end associate
    end do
    if (.not. has_constant_loads(mechanism%linkage)) return
    call append_string(notes, gravity_words(model, mechanism))
    call append_string(notes, outside_loads(model, mechanism))
  end function body_notes_of

  !> What the body of a link is, and what of it the card gives.
  pure function own_mass(model, mechanism, body) result(line)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: body
    character(len=:), allocatable :: line

    type(unit_t) :: length, mass, inertia
    character(len=:), allocatable :: otherwise
    real(wp) :: place(2)

    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    inertia = coherent_unit(model%units, dimension_inertia)
    associate (link => model%links(model%loop(body)), lump => mechanism%linkage%bodies(body)%lumps(1))
      otherwise = "none given"
      if (is_solid(link)) otherwise = "of the section"
      place = [0.5_wp*link%length, 0.0_wp]
      if (link%has_center) place = link%center
      line = "body of link "//link%name%text//": mass "//to_string(from_si(lump%mass, mass), 12)//" "//mass%name// &
        source(link%has_mass, otherwise)//", mass centre at "//place_words(place, length)//" from "//link%pin(1)%text// &
        source(link%has_center, "middle")//", moment of inertia "//to_string(from_si(lump%inertia, inertia), 12)//" "// &
        inertia%name//source(link%has_inertia, otherwise)
    end associate
  end function own_mass

  !> ` (given)`, or where else a value comes from
  pure function source(given, otherwise) result(words)
    logical, intent(in) :: given
    character(len=*), intent(in) :: otherwise
    character(len=:), allocatable :: words

    words = " ("//otherwise//")"
    if (given) words = " (given)"
  end function source

  !> `30 mm along, 5 mm to the left`
  pure function place_words(place, length) result(words)
    real(wp), intent(in) :: place(2) !! [m]
    type(unit_t), intent(in) :: length
    character(len=:), allocatable :: words

    words = to_string(from_si(place(1), length), 12)//" "//length%name//" along"
    if (place(2) > 0.0_wp) words = words//", "//to_string(from_si(place(2), length), 12)//" "//length%name//" to the left"
    if (place(2) < 0.0_wp) words = words//", "//to_string(from_si(-place(2), length), 12)//" "//length%name//" to the right"
  end function place_words

end module body_notes
