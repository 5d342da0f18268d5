!> Links with masses of their own, and masses fixed to links, in words for the log.
module body_lines
  use kinds, only: wp
  use link_bodies, only: link_center, link_inertia
  use models, only: link_mass, model_t
  use text, only: to_string
  use units, only: coherent_unit, dimension_inertia, dimension_length, dimension_mass, from_si, &
    unit_t
  implicit none (type, external)
  private

  public :: body_line, mass_line, place_words

contains

  !> `body of link coupler: mass 0.5 kg (given), …`: a link with a mass of its own, and the source
  !! of each value.
  pure function body_line(model, link) result(line)
    type(model_t), intent(in) :: model !! in SI
    integer, intent(in) :: link        !! number in the model's list
    character(len=:), allocatable :: line

    type(unit_t) :: length, mass, inertia

    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    inertia = coherent_unit(model%units, dimension_inertia)
    associate (this => model%links(link))
      line = "body of link "//this%name%text//": mass "// &
        to_string(from_si(link_mass(model, link), mass), 12)//" "//mass%name// &
        source(this%has_mass, "of the section")//", mass centre at "// &
        place_words(link_center(model, link), length)//" from "//this%pins(1)%text// &
        source(this%has_center, "middle")//", moment of inertia "// &
        to_string(from_si(link_inertia(model, link), inertia), 12)//" "//inertia%name// &
        source(this%has_inertia, trim(merge("uniform link of this mass", &
        "of the section           ", this%has_mass)))
    end associate
  end function body_line

  !> `mass on link coupler: 0.1 kg at 30 mm along, 5 mm to the left from A`
  pure function mass_line(model, number) result(line)
    type(model_t), intent(in) :: model !! in SI
    integer, intent(in) :: number      !! of the MASS card
    character(len=:), allocatable :: line

    type(unit_t) :: mass

    mass = coherent_unit(model%units, dimension_mass)
    associate (this => model%masses(number))
      line = "mass on link "//this%link_name%text//": "//to_string(from_si(this%mass, mass), 12)// &
        " "//mass%name//" at "//place_words(this%place, coherent_unit(model%units, &
        dimension_length))//" from "//model%links(this%link)%pins(1)%text
    end associate
  end function mass_line

  !> ` (given)`, or another source of the value
  pure function source(given, otherwise) result(words)
    logical, intent(in) :: given
    character(len=*), intent(in) :: otherwise
    character(len=:), allocatable :: words

    words = " ("//otherwise//")"
    if (given) words = " (given)"
  end function source

  !> `30 mm along, 5 mm to the left`
  pure function place_words(place, length) result(words)
    real(wp), intent(in) :: place(2)   !! along the link and to its left [m]
    type(unit_t), intent(in) :: length !! unit of the words
    character(len=:), allocatable :: words

    words = to_string(from_si(place(1), length), 12)//" "//length%name//" along"
    if (place(2) > 0.0_wp) words = words//", "//to_string(from_si(place(2), length), 12)//" "// &
      length%name//" to the left"
    if (place(2) < 0.0_wp) words = words//", "//to_string(from_si(-place(2), length), 12)//" "// &
      length%name//" to the right"
  end function place_words

end module body_lines
