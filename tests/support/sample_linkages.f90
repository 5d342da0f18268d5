!> Decks of linkages of every kind of group, and the linkages that they give.
module sample_linkages
  use computed_decks, only: read_text
  use kinds, only: wp
  use linkage_builder, only: assemble_linkage, assembly_t
  use linkages, only: linkage_t
  use models, only: model_t
  use name_index, only: find_name, new_name_index
  implicit none (type, external)
  private

  public :: assemble, linkage_of, body_named, pin_named, sample_names, deck_named, sample_crank

  character(len=*), parameter :: nl = achar(10)

  !> What every deck here begins with, so that all numbers are in SI, and what it ends with.
  character(len=*), parameter, public :: head = "UNITS m kg s"//nl
  character(len=*), parameter :: tail = "CRANK 0"//nl//"REPORT kinematics"//nl

  !> RRP: a crank, a rod and a piston in a bore that does not pass the crank's pivot.
  character(len=*), parameter, public :: engine = head//"GROUND O 0.5 -0.25"//nl// &
    "GUIDE bore 0.52 0 angle=90"//nl//"LINK crank O A length=0.1"//nl//"LINK rod A B length=0.3"//nl// &
    "SLIDER B bore"//nl//"DRIVE crank"//nl//"BRANCH B forward"//nl

  !> RPR and RRP: a block of the crank on a lever, a rod and a ram.
  character(len=*), parameter, public :: quick_return = head//"GROUND O2 0 0"//nl// &
    "GROUND O4 0 -0.15"//nl//"GUIDE bed 0 0.14 angle=0"//nl//"LINK crank O2 A length=0.06"//nl// &
    "LINK lever O4 C length=0.32"//nl//"LINK rod C D length=0.12"//nl//"SLIDER A lever"//nl// &
    "SLIDER D bed"//nl//"DRIVE crank"//nl//"BRANCH D forward"//nl

  !> PPR: a yoke that does not turn, across which a block of the crank slides.
  character(len=*), parameter, public :: scotch_yoke = head//"GROUND O 0 0"//nl// &
    "GUIDE bed 0 -0.5 angle=0"//nl//"PIN D 0.1 -0.5"//nl//"PIN E 0.15 0.5"//nl// &
    "LINK crank O A length=0.1"//nl//"LINK yoke D E"//nl//"SLIDER D bed yoke"//nl// &
    "SLIDER A yoke"//nl//"DRIVE crank"//nl

  !> PRP: a block on a lever and on a guide at once, with a rod and a second lever behind it.
  character(len=*), parameter, public :: two_lines = head//"GROUND O 0 0"//nl//"GROUND Q 1 0.8"//nl// &
    "GUIDE bed 0 0.3 angle=10"//nl//"LINK lever O A length=3"//nl//"LINK rod B C length=0.9"//nl// &
    "LINK rocker Q C length=0.7"//nl//"SLIDER B bed"//nl//"SLIDER B lever"//nl//"DRIVE lever"//nl// &
    "BRANCH C right B Q"//nl

  !> Theo Jansen's leg, by the drawing of Pyslvs' tests.
  character(len=*), parameter, public :: jansen = head//"GROUND O 0 0"//nl//"GROUND P2 -38 -7.8"//nl// &
    "PIN P1 9.61 11.52"//nl//"PIN P3 -35.24 33.61"//nl//"PIN P4 -77.75 -2.54"//nl// &
    "PIN P5 -20.1 -42.79"//nl//"PIN P6 -56.05 -35.42"//nl//"PIN P7 -22.22 -91.74"//nl// &
    "LINK crank O P1"//nl//"LINK a P3 P1"//nl//"LINK b P3 P2"//nl//"LINK c P4 P2"//nl// &
    "LINK d P4 P3"//nl//"LINK e P5 P1"//nl//"LINK f P5 P2"//nl//"LINK g P6 P4"//nl// &
    "LINK h P6 P5"//nl//"LINK i P7 P5"//nl//"LINK j P7 P6"//nl//"DRIVE crank"//nl

  !> A plate on three legs, of which the crank carries one; C is far from the way from B to D.
  character(len=*), parameter, public :: triad_legs = "GROUND G 3 -0.5"//nl//"GROUND H 5 0.5"//nl// &
    "PIN A -1 2.7"//nl//"PIN B 1.5 2"//nl//"PIN C 3 2.5"//nl//"PIN D 4.5 2.2"//nl// &
    "LINK first A B"//nl//"LINK plate B C D"//nl//"LINK second G C"//nl//"LINK third D H"//nl
  character(len=*), parameter, public :: triad = head//"GROUND O -1.4 2.7"//nl//triad_legs// &
    "LINK crank O A"//nl//"DRIVE crank"//nl

  !> The same with a crank that is too long to turn.
  character(len=*), parameter, public :: short_triad = head//"GROUND O -4 2.5"//nl//triad_legs// &
    "LINK crank O A"//nl//"DRIVE crank"//nl

  !> A plate on a crank, on a second one at half its speed, and on a leg: it closes after two turns.
  character(len=*), parameter, public :: geared_triad = head//"GROUND O -1.3 2.7"//nl//"GROUND G 3 -0.5"//nl// &
    "GROUND H 5 0.5"//nl//"PIN A -1 2.7"//nl//"PIN B 1.5 2"//nl//"PIN C 3 2.5"//nl//"PIN D 4.5 2.2"//nl// &
    "PIN E 5.2 0.5"//nl//"LINK crank O A"//nl//"LINK first A B"//nl//"LINK plate B C D"//nl// &
    "LINK second G C"//nl//"LINK third D E"//nl//"LINK wheel H E"//nl//"DRIVE crank"//nl// &
    "DRIVE wheel ratio=0.5"//nl

  !> Two gears and a dyad between them: five bars with two drives.
  character(len=*), parameter, public :: five_bar = head//"GROUND O 0 0"//nl//"GROUND Q 1 0.2"//nl// &
    "LINK crank O A length=0.3"//nl//"LINK left A B length=0.8"//nl//"LINK right B C length=0.9"//nl// &
    "LINK wheel Q C length=0.25"//nl//"DRIVE crank"//nl//"DRIVE wheel ratio=-0.5 phase=40"//nl// &
    "BRANCH B left A C"//nl

  !> A parallelogram with a third crank in its middle.
  character(len=*), parameter, public :: parallelogram = head//"GROUND O 0 0"//nl//"GROUND P 1 0"//nl// &
    "GROUND Q 2 0"//nl//"LINK crank O A length=0.5"//nl//"LINK beam A B C lengths=1,1 turns=0"//nl// &
    "LINK other Q C length=0.5"//nl//"LINK third P B length=0.5"//nl//"DRIVE crank"//nl// &
    "BRANCH C left A Q"//nl

  !> A boom on a ram: the length of the ram is driven.
  character(len=*), parameter, public :: boom = head//"GROUND O 0 0"//nl//"GROUND Q 1 -0.5"//nl// &
    "LINK boom O A B lengths=1.2,1.5 turns=20"//nl//"LINK ram Q A"//nl//"DRIVE ram length"//nl// &
    "PIN A 0.9 0.8"//nl

  !> A ram on a guide: RRP with a driven length.
  character(len=*), parameter, public :: jack = head//"GROUND Q 0.2 -0.1"//nl//"GUIDE bed 0 0.3 angle=-10"//nl// &
    "LINK ram Q A"//nl//"SLIDER A bed"//nl//"DRIVE ram length"//nl//"BRANCH A forward"//nl

  !> A ram between two links of a four-bar, of which no other is driven: with coupler and follower it forms a triangle.
  character(len=*), parameter, public :: levers = head//"GROUND O 0 0"//nl//"GROUND Q 2 0"//nl//"PIN A 1.1875 1.6093"//nl// &
    "PIN B 2.49275 0.87017"//nl//"PIN T 2.1971 0.34807"//nl//"LINK left O A length=2"//nl//"LINK coupler A B length=1.5"//nl// &
    "LINK right B T Q lengths=0.6,0.4 turns=0"//nl//"LINK ram A T"//nl//"DRIVE ram length"//nl

  character(len=*), parameter :: sample_names(12) = [character(len=14) :: "engine", "quick_return", &
    "scotch_yoke", "two_lines", "jansen", "triad", "geared_triad", "five_bar", "parallelogram", "boom", &
    "jack", "levers"]

contains

  !> A deck by its name, without its last cards.
  pure function deck_named(name) result(text)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: text

    text = ""
    select case (name)
    case ("engine")
      text = engine
    case ("quick_return")
      text = quick_return
    case ("scotch_yoke")
      text = scotch_yoke
    case ("two_lines")
      text = two_lines
    case ("jansen")
      text = jansen
    case ("triad")
      text = triad
    case ("short_triad")
      text = short_triad
    case ("geared_triad")
      text = geared_triad
    case ("five_bar")
      text = five_bar
    case ("parallelogram")
      text = parallelogram
    case ("boom")
      text = boom
    case ("jack")
      text = jack
    case ("levers")
      text = levers
    end select
  end function deck_named

  !> The k-th of 24 coordinates of the first drive that a linkage reaches, away from dead points.
  pure function sample_crank(name, k) result(crank)
    character(len=*), intent(in) :: name
    integer, intent(in) :: k !! 1 to 24
    real(wp) :: crank        !! [deg] or [m]

    crank = 15.0_wp*real(k, wp) - 8.0_wp
    if (name == "two_lines") crank = 20.0_wp + 5.0_wp*real(k, wp)
    if (name == "parallelogram") crank = 10.0_wp + 6.5_wp*real(k, wp)
    if (name == "boom") crank = 0.1_wp + 0.09_wp*real(k, wp)
    if (name == "jack") crank = 0.5_wp + 0.09_wp*real(k, wp)
    if (name == "levers") crank = 0.95_wp + 0.045_wp*real(k, wp)
    if (name == "short_triad") crank = -29.0_wp + 2.3_wp*real(k, wp)
  end function sample_crank

  !> The assembly of a deck without its last cards.
  subroutine assemble(text, assembly, complaint)
    character(len=*), intent(in) :: text
    type(assembly_t), intent(out) :: assembly
    character(len=:), allocatable, intent(out) :: complaint !! why the deck cannot be read; else empty

    type(model_t) :: model

    call read_text(text//tail, model, complaint)
    if (len(complaint) == 0) call assemble_linkage(model, assembly)
  end subroutine assemble

  !> A linkage that has a plan; else one without bodies.
  function linkage_of(text) result(linkage)
    character(len=*), intent(in) :: text
    type(linkage_t) :: linkage

    type(assembly_t) :: assembly
    character(len=:), allocatable :: complaint

    call assemble(text, assembly, complaint)
    if (len(complaint) > 0 .or. allocated(assembly%problem) .or. allocated(assembly%error)) then
      allocate (linkage%bodies(0))
    else
      linkage = assembly%linkage
    end if
  end function linkage_of

  !> Number of the body of a link.
  function body_named(text, assembly, name) result(body)
    character(len=*), intent(in) :: text
    type(assembly_t), intent(in) :: assembly !! of this deck
    character(len=*), intent(in) :: name     !! as on its LINK card
    integer :: body

    type(model_t) :: model
    character(len=:), allocatable :: complaint
    integer :: i

    body = 0
    call read_text(text//tail, model, complaint)
    do i = 1, size(assembly%link)
      if (model%links(assembly%link(i))%name%text == name) body = i
    end do
  end function body_named

  !> Number of a pin.
  pure function pin_named(assembly, name) result(pin)
    type(assembly_t), intent(in) :: assembly
    character(len=*), intent(in) :: name
    integer :: pin

    pin = find_name(new_name_index(assembly%pins), name)
  end function pin_named

end module sample_linkages
