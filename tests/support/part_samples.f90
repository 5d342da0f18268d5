!> Linkages as they vibrate: decks taken to their parts, and to the forces in them at a position.
module part_samples
  use computed_decks, only: read_text
  use deformation_model, only: deformation_model_t
  use elastic_reactions, only: new_elastic_model
  use errors, only: error_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use load_cases, only: find_unit_loads
  use mechanisms, only: mechanism_t, new_mechanism
  use models, only: model_t
  use part_displacements, only: find_part_chords
  use part_forces, only: find_part_forces
  use part_poses, only: find_part_loads
  use pin_displacements, only: chords_t
  use poses, only: find_pose, pose_t
  use position_assembly, only: assembled_t, new_assembled, place_parts
  implicit none (type, external)
  private

  public :: part_sample_t, find_sample, part_deck

  !> A linkage at a position.
  type :: part_sample_t
    type(mechanism_t) :: mechanism
    type(deformation_model_t) :: model        !! of the parts, with their layout
    type(pose_t) :: pose                      !! of the linkage that moves
    type(kinematic_coefficients_t) :: coefficients
    type(assembled_t) :: here                 !! its parts, their loads and forces
    type(chords_t) :: chords
  end type part_sample_t

  character(len=*), parameter :: nl = achar(10), strip = " material=steel section=strip"//nl, &
    bar = " material=steel section=bar"//nl

  character(len=*), parameter :: head = "UNITS mm kg s"//nl// &
    "MATERIAL steel E=200GPa density=7800kg/m3"//nl// &
    "SECTION strip rectangle thickness=1.6 width=25.4"//nl// &
    "SECTION bar rectangle thickness=4.24 width=25.4"//nl

  !> What every deck here ends with.
  character(len=*), parameter :: tail = "MESH * accuracy=1e-12"//nl//"CRANK 60"//nl// &
    "EFFECTS static"//nl//"MODES 5"//nl//"REPORT frequencies"//nl

  character(len=*), parameter :: four_bar = "GROUND O2 0 0"//nl//"GROUND O4 254 0"//nl// &
    "LINK crank O2 A length=100"//strip//"LINK coupler A B length=279.4"//strip// &
    "LINK follower O4 B length=266.7"//strip//"DRIVE crank"//nl//"BRANCH B left A O4"//nl

  character(len=*), parameter :: engine = "GROUND O2 0 0"//nl//"GUIDE bore 0 -20 angle=0"//nl// &
    "LINK crank O2 A length=100"//bar//"LINK rod A B length=280"//strip//"SLIDER B bore mass=0.05"//nl// &
    "DRIVE crank"//nl//"BRANCH B forward"//nl

  character(len=*), parameter :: quick_return = "GROUND O2 0 0"//nl//"GROUND O4 0 -150"//nl// &
    "GUIDE bed 0 140 angle=0"//nl//"LINK crank O2 A length=60"//bar//"LINK lever O4 C length=320"//bar// &
    "LINK rod C D length=120"//strip//"SLIDER A lever mass=0.03 inertia=10"//nl// &
    "SLIDER D bed mass=0.2"//nl//"DRIVE crank"//nl//"BRANCH D forward"//nl

  !> A lever of three pins on one line under two blocks: at 75 deg that of the crank is beyond the middle pin, that on the ground guide
  !! between this and the pivot.
  character(len=*), parameter :: two_blocks = "GROUND O2 0 0"//nl//"GROUND O4 0 -150"//nl//"GROUND O6 190 -60"//nl// &
    "GUIDE low 0 -100 angle=0"//nl//"GUIDE post 90 -100 angle=90"//nl//"POINT P lever along=160"//nl// &
    "PIN A 55 22"//nl//"PIN P 30 10"//nl//"PIN R 150 40"//nl//"PIN C 90 160"//nl//"PIN E 20 -100"//nl//"PIN F 90 5"//nl// &
    "LINK crank O2 A length=60"//bar//"LINK lever O4 C length=320"//bar//"LINK rod P R length=120"//strip// &
    "LINK rocker O6 R length=110"//strip//"LINK push E F length=130"//strip//"SLIDER A lever mass=0.03 inertia=10"//nl// &
    "SLIDER E low mass=0.1"//nl//"SLIDER E lever inertia=4"//nl//"SLIDER F post mass=0.1"//nl//"DRIVE crank"//nl// &
    "BRANCH R left P O6"//nl//"BRANCH F forward"//nl

  character(len=*), parameter :: scotch_yoke = "GROUND O2 0 0"//nl//"GUIDE way 0 80 angle=0"//nl// &
    "PIN A 60 0"//nl//"PIN B 60 -80"//nl//"PIN T 60 80"//nl//"PIN C 120 80"//nl//"PIN W 310 80"//nl// &
    "LINK crank O2 A length=60"//bar//"LINK yoke B T C W lengths=160,60,190 turns=-90,0"//bar// &
    "SLIDER A yoke mass=0.02"//nl//"SLIDER C way yoke"//nl//"PINMASS W 0.3"//nl//"DRIVE crank"//nl

  character(len=*), parameter :: elbow = "GROUND O2 0 0"//nl//"GROUND O4 254 0"//nl// &
    "LINK crank O2 A length=100"//strip//"LINK coupler A B C lengths=279.4,102 turns=78.4"//strip// &
    "PINMASS C 0.1"//nl//"LINK follower O4 B length=266.7"//strip//"DRIVE crank"//nl// &
    "BRANCH B left A O4"//nl

  character(len=*), parameter :: watt = "GROUND O2 0 0"//nl//"GROUND O4 254 0"//nl// &
    "LINK crank O2 A length=100"//strip//"LINK coupler A B C lengths=279.4,121.755 turns=80.26"//strip// &
    "LINK follower O4 B D lengths=266.7,124.534 turns=-74.49"//strip//"LINK left C E length=160"//strip// &
    "LINK right D E length=200"//strip//"DRIVE crank"//nl//"BRANCH B left A O4"//nl//"BRANCH E left C D"//nl

  character(len=*), parameter :: telescope = "GROUND O2 0 0"//nl//"GROUND O4 200 0"//nl//"PIN A 80 0"//nl// &
    "PIN E 430 0"//nl//"PIN P 140 0"//nl//"LINK crank O2 A length=80"//bar//"LINK rod A E length=350"//strip// &
    "LINK rocker O4 P length=60"//bar//"SLIDER P rod rocker mass=0.04 inertia=12"//nl//"DRIVE crank"//nl

  !> The same with a rigid rocker: its block is held by the rod alone.
  character(len=*), parameter :: rigid_rocker = "GROUND O2 0 0"//nl//"GROUND O4 200 0"//nl//"PIN A 80 0"//nl// &
    "PIN E 430 0"//nl//"PIN P 140 0"//nl//"LINK crank O2 A length=80"//bar//"LINK rod A E length=350"//strip// &
    "LINK rocker O4 P rigid length=60"//bar//"SLIDER P rod rocker mass=0.04 inertia=12"//nl//"DRIVE crank"//nl

  !> A rigid yoke that does not turn, on a guide; the crank bends.
  character(len=*), parameter :: rigid_yoke = "GROUND O 0 0"//nl//"GUIDE bed 0 -500 angle=0"//nl//"PIN D 100 -500"//nl// &
    "PIN E 150 500"//nl//"LINK crank O A length=100"//bar//"LINK yoke D E rigid"//bar//"SLIDER D bed yoke mass=0.1"//nl// &
    "SLIDER A yoke mass=0.02 inertia=15"//nl//"DRIVE crank"//nl

  !> A four-bar with a rigid coupler of three pins, which carries a dyad.
  character(len=*), parameter :: rigid_coupler = "GROUND O2 0 0"//nl//"GROUND O4 254 0"//nl//"GROUND O6 420 60"//nl// &
    "LINK crank O2 A length=100"//strip//"LINK coupler A B C rigid lengths=279.4,121.755 turns=80.26"//strip// &
    "LINK follower O4 B length=266.7"//strip//"LINK left C E length=260"//strip//"LINK right O6 E length=300"//strip// &
    "DRIVE crank"//nl//"BRANCH B left A O4"//nl//"BRANCH E left C O6"//nl

  character(len=*), parameter :: parallelogram = "GROUND OA 0 0"//nl//"GROUND OC 130 0"//nl//"GROUND OB 250 0"//nl// &
    "PIN A 0 100"//nl//"PIN C 130 100"//nl//"PIN B 250 100"//nl//"LINK crank OA A length=100"//strip// &
    "LINK second OB B length=100"//strip//"LINK third OC C length=100"//strip// &
    "LINK coupler A C B lengths=130,120 turns=0"//strip

  character(len=*), parameter :: springs = "GROUND O2 0 0"//nl//"GROUND O4 254 0"//nl// &
    "LINK crank O2 A length=100"//strip//"LINK coupler A B length=279.4"//strip// &
    "LINK follower O4 B length=266.7"//strip//"SPRING coil B coupler follower stiffness=1N*m/rad free_angle=60"//nl// &
    "SPRING main A O4 stiffness=2000N/m free_length=200"//nl//"DRIVE crank"//nl//"BRANCH open"//nl

  character(len=*), parameter :: arm_free = "GROUND O 0 0"//nl//"LINK upper O A length=500"//bar// &
    "LINK lower A B length=400"//bar//"PINMASS A 0.3"//nl//"PINMASS B 0.2"//nl//"DRIVE upper free"//nl// &
    "DRIVE lower against upper ratio=0.5 phase=20 free"//nl

contains

  !> A deck by its name, ready to be read.
  pure function part_deck(name, more) result(text)
    character(len=*), intent(in) :: name
    character(len=*), intent(in), optional :: more !! further cards
    character(len=:), allocatable :: text

    select case (name)
    case ("four_bar")
      text = four_bar
    case ("engine")
      text = engine
    case ("quick_return")
      text = quick_return
    case ("two_blocks")
      text = two_blocks
    case ("scotch_yoke")
      text = scotch_yoke
    case ("elbow")
      text = elbow
    case ("watt")
      text = watt
    case ("telescope")
      text = telescope
    case ("rigid_rocker")
      text = rigid_rocker
    case ("rigid_yoke")
      text = rigid_yoke
    case ("rigid_coupler")
      text = rigid_coupler
    case ("parallelogram")
      text = parallelogram//"DRIVE crank"//nl
    case ("parallelogram_free")
      text = parallelogram//"DRIVE crank free"//nl
    case ("springs")
      text = springs
    case ("arm_free")
      text = arm_free
    case default
      text = ""
    end select
    text = head//text
    if (present(more)) text = text//more
    text = text//tail
  end function part_deck

  !> Parts and forces of a linkage at a position, of a four-bar as well, whose pins would move in
  !! closed form.
  subroutine find_sample(text, crank, sample, complaint)
    character(len=*), intent(in) :: text   !! of a whole deck
    real(wp), intent(in) :: crank          !! of the first drive [deg] or [m]
    type(part_sample_t), intent(out) :: sample
    character(len=:), allocatable, intent(out) :: complaint !! empty if nothing went wrong

    type(model_t) :: model
    type(error_t), allocatable :: error

    call read_text(text, model, complaint)
    if (len(complaint) > 0) return
    sample%mechanism = new_mechanism(model)
    associate (mechanism => sample%mechanism, here => sample%here)
      mechanism%elastic%in_closed_form = .false.
      call new_elastic_model(mechanism, sample%model, error, [crank])
      if (.not. allocated(error)) call find_pose(mechanism%linkage, crank, sample%pose, error)
      if (.not. allocated(error)) then
        here = new_assembled(mechanism, sample%model)
        call place_parts(mechanism, sample%model, sample%pose, here, error)
      end if
      if (.not. allocated(error)) call find_part_chords(here%elastic_position_t, .true., here%border, sample%chords, error)
      if (allocated(error)) then
        complaint = error%text
        return
      end if
      sample%coefficients = find_kinematic_coefficients(mechanism%linkage, sample%pose)
      here%loads = find_unit_loads(mechanism%linkage, sample%pose, sample%coefficients)
      call find_part_loads(mechanism%linkage, sample%pose, here%loads, here%elastic_position_t, &
        here%loaded%loads)
      call find_part_forces(here%elastic_position_t, here%border, sample%chords, here%loaded)
    end associate
  end subroutine find_sample

end module part_samples
