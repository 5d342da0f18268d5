!> Cards → parts of the model: links and what they are made of, what they carry, what loads them,
!! and the reports.
module part_reader
  use body_cards, only: read_mass, read_point
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use link_cards, only: read_link
  use linkage_cards, only: read_ground, read_mesh, read_pin_mass
  use load_cards, only: read_force, read_gravity, read_torque
  use materials, only: read_material
  use models, only: model_t
  use motor_cards, only: read_motor, read_resistance
  use report_cards, only: read_report
  use report_kinds, only: report_kind_t
  use sections, only: read_section
  use text, only: lower_case, same_word
  implicit none (type, external)
  private

  public :: read_parts

contains

  !> Reads the cards of which there may be many, and the loads.
  pure subroutine read_parts(cards, reports, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(report_kind_t), intent(in) :: reports(:) !! that there are
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model !! with its units

    allocate (model%materials(number_of(cards, "MATERIAL")), &
      model%sections(number_of(cards, "SECTION")), model%grounds(number_of(cards, "GROUND")), &
      model%links(number_of(cards, "LINK")), model%pin_masses(number_of(cards, "PINMASS")), &
      model%meshes(number_of(cards, "MESH")), model%reports(number_of(cards, "REPORT")))
    allocate (model%masses(number_of(cards, "MASS")), model%points(number_of(cards, "POINT")), &
      model%forces(number_of(cards, "FORCE")), model%torques(number_of(cards, "TORQUE")), &
      model%resistances(number_of(cards, "LOAD")))
    call read_linkage_parts(cards, reports, diagnostics, model)
    call read_body_parts(cards, diagnostics, model)
  end subroutine read_parts

  pure function number_of(cards, keyword) result(number)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: keyword
    integer :: number

    integer :: i

    number = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, keyword)) number = number + 1
    end do
  end function number_of

  !> The linkage, what it is made of, and the reports.
  pure subroutine read_linkage_parts(cards, reports, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(report_kind_t), intent(in) :: reports(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    integer :: i, material, section, ground, link, pin_mass, mesh, report

    material = 0
    section = 0
    ground = 0
    link = 0
    pin_mass = 0
    mesh = 0
    report = 0
    do i = 1, size(cards)
      select case (lower_case(cards(i)%keyword%text))
      case ("material")
        material = material + 1
        call read_material(cards(i), model%units, diagnostics, model%materials(material))
      case ("section")
        section = section + 1
        call read_section(cards(i), model%units, diagnostics, model%sections(section))
      case ("ground")
        ground = ground + 1
        call read_ground(cards(i), model%units, diagnostics, model%grounds(ground))
      case ("link")
        link = link + 1
        call read_link(cards(i), model%units, diagnostics, model%links(link))
      case ("pinmass")
        pin_mass = pin_mass + 1
        call read_pin_mass(cards(i), model%units, diagnostics, model%pin_masses(pin_mass))
      case ("mesh")
        mesh = mesh + 1
        call read_mesh(cards(i), model%units, diagnostics, model%meshes(mesh))
      case ("report")
        report = report + 1
        call read_report(cards(i), reports, model%units, diagnostics, model%reports(report))
      end select
    end do
  end subroutine read_linkage_parts

  !> What links carry, and what loads and drives them.
  pure subroutine read_body_parts(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    integer :: i, mass, point, force, torque, resistance

    mass = 0
    point = 0
    force = 0
    torque = 0
    resistance = 0
    do i = 1, size(cards)
      select case (lower_case(cards(i)%keyword%text))
      case ("mass")
        mass = mass + 1
        call read_mass(cards(i), model%units, diagnostics, model%masses(mass))
      case ("point")
        point = point + 1
        call read_point(cards(i), model%units, diagnostics, model%points(point))
      case ("gravity")
        model%gravity_word = cards(i)%keyword
        call read_gravity(cards(i), model%units, diagnostics, model%gravity)
      case ("force")
        force = force + 1
        call read_force(cards(i), model%units, diagnostics, model%forces(force))
      case ("torque")
        torque = torque + 1
        call read_torque(cards(i), model%units, diagnostics, model%torques(torque))
      case ("motor")
        call read_motor(cards(i), model%units, diagnostics, model%motor)
      case ("load")
        resistance = resistance + 1
        call read_resistance(cards(i), model%units, diagnostics, model%resistances(resistance))
      end select
    end do
  end subroutine read_body_parts

end module part_reader
