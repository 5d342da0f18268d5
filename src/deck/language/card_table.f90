! src/deck/language/ - the language of decks: forms and keys of cards, reports, lists, SET and VARY.
! In: cards. Out: the cards of each variant, with values for every $name; words of cards as values
! in SI. Begin with `card_kinds` here, `read_deck_cards` in `variants.f90`, `read_quantity` in
! `card_reader.f90`. A report is a `report_kind_t` (`report_kinds.f90`).
! Not here: the readers of single cards (`src/model/cards`, `src/model/requests`), the list of
! reports (`src/reports/report_table.f90`).

!> The table of cards: form, default and purpose of each.
!!
!! A new card needs a record here, a file in `model/cards` that reads it, and a case in
!! `model_reader`. Messages, `echo.deck`, `flexmech --help-cards`, the fuzzer and the check of
!! docs/cards.md use this table.
module card_table
  use text, only: append_string, joined, same_word, string_t
  implicit none (type, external)
  private

  public :: card_kind_t, card_kinds, many, card_names, card_kind_number, kind_of_card, keys_in, &
    keys_of, pattern_of

  !> A card, or one of its forms.
  type :: card_kind_t
    character(len=8) :: keyword = ""   !! in capitals
    character(len=9) :: form = ""      !! the second word, if the form depends on it
    logical :: is_single = .false.     !! a deck has at most one
    logical :: is_list = .false.       !! commas may stand between its words
    integer :: least = 0, most = 0     !! words besides the keyword
    character(len=160) :: pattern = "" !! correct form of the card; its keys end with `=`
    character(len=96) :: keys = ""     !! separated by blanks, if the pattern does not name them all
    character(len=112) :: choices = "" !! allowed words, separated by blanks
    character(len=20) :: entry = ""    !! default entries, `key=value`, with blanks between them
    character(len=16) :: default = ""  !! words of the card in a deck without it
    character(len=88) :: help = ""     !! in one line
  end type card_kind_t

  !> For `most`: any number of words.
  integer, parameter :: many = huge(1)

  !> The forms of a card are neighbours, the record without a form first.
  type(card_kind_t), parameter :: card_kinds(*) = [ &
    card_kind_t("TITLE", is_single=.true., pattern="TITLE text", &
      help="the title of tables and figures"), &
    card_kind_t("UNITS", is_single=.true., least=3, most=3, &
      pattern="UNITS length mass time [force=] [torque=] [energy=] [speed=] [digits=] "// &
      "[format=]", choices="four_bar linkage", help="the units of bare numbers; required. The "// &
      "keys set those of results"), &
    card_kind_t("INCLUDE", least=1, most=1, pattern="INCLUDE file", &
      help="the cards of another file"), &
    card_kind_t("SET", least=2, most=many, pattern="SET name value", &
      help="a value for $name, or arithmetic: $track - 2*40mm*sin(10deg)"), &
    card_kind_t("TABLE", least=2, most=many, pattern="TABLE name unit unit ... number number ...", &
      help="columns of numbers by name: their units, then row by row; or a file, table=name"), &
    card_kind_t("VARY", is_list=.true., least=1, most=many, &
      pattern="VARY name a to b step s, VARY name and a list of values, or VARY name ... table=", &
      help="values for $name, one after the other: the variants of the deck"), &
    card_kind_t("MATERIAL", least=1, most=1, pattern="MATERIAL name E= density= [nu=]", &
      help="what links are made of; EFFECTS shear needs nu"), &
    card_kind_t("SECTION", least=2, most=2, &
      pattern="SECTION name rectangle|circle|tube|box|I|channel|general ...", &
      keys="thickness width diameter outer inner wall depth web flange plane A I "// &
      "shear_coefficient", choices="rectangle circle tube box I channel general", &
      help="the cross-section of links"), &
    card_kind_t("SECTION", "rectangle", least=2, most=2, &
      pattern="SECTION name rectangle thickness= width= [shear_coefficient=]", &
      help="the thickness lies in the plane of motion"), &
    card_kind_t("SECTION", "circle", least=2, most=2, &
      pattern="SECTION name circle diameter= [shear_coefficient=]", help="a round bar"), &
    card_kind_t("SECTION", "tube", least=2, most=2, &
      pattern="SECTION name tube outer= inner= [shear_coefficient=]", help="by its diameters"), &
    card_kind_t("SECTION", "box", least=2, most=2, &
      pattern="SECTION name box thickness= width= wall= [shear_coefficient=]", &
      help="a rectangular tube by its outer sides; the thickness lies in the plane of motion"), &
    card_kind_t("SECTION", "I", least=2, most=2, pattern= &
      "SECTION name I depth= width= web= flange= plane=web|flanges [shear_coefficient=]", &
      choices="web flanges", help= &
      "web and flange are their thicknesses; plane is what lies in the plane of motion"), &
    card_kind_t("SECTION", "channel", least=2, most=2, pattern= &
      "SECTION name channel depth= width= web= flange= plane=web|flanges [shear_coefficient=]", &
      choices="web flanges", help= &
      "like the I section; plane=web assumes forces through its shear centre"), &
    card_kind_t("SECTION", "general", least=2, most=2, &
      pattern="SECTION name general A= I= [depth=] [shear_coefficient=]", &
      help="I about the axis normal to the plane; strains and a warning need the depth"), &
    card_kind_t("GROUND", least=3, most=3, pattern="GROUND name x y", help="a fixed pivot"), &
    card_kind_t("PIN", least=3, most=3, pattern="PIN name x y", &
      help="where a moving pin is in the drawing: for lengths, branches and welds"), &
    card_kind_t("LINK", least=3, most=many, &
      pattern="LINK name pin pin ... [rigid] [length= | lengths= turns=] [material= section=] "// &
      "[mass= inertia= center=along,offset]", choices="rigid", &
      help="a uniform link, straight from pin to pin, or a rigid body of any shape"), &
    card_kind_t("WELD", least=3, most=many, pattern="WELD pin link link ...", &
      help="these links turn together at a pin"), &
    card_kind_t("CLAMP", least=1, most=many, pattern="CLAMP pin [link ...]", &
      help="these links cannot turn at a GROUND pin; without names none there can"), &
    card_kind_t("GUIDE", least=3, most=3, pattern="GUIDE name x y angle=", &
      help="a fixed straight guide through a point"), &
    card_kind_t("SLIDER", least=2, most=3, pattern="SLIDER pin guide [link] [mass= inertia=]", &
      help="a block at a pin slides along a GUIDE or LINK; the third word: a link fixed to it"), &
    card_kind_t("DRIVE", least=1, most=4, &
      pattern="DRIVE link [against link], pin guide, link length or measure, with [free] "// &
      "[law=] [at= speed=] [ratio= phase=] [change_points=through|stop|branch]", &
      choices="against length free", &
      help="whose angle, place or length is given; required; further ones: at= or ratio="), &
    card_kind_t("BRANCH", least=1, most=4, &
      pattern="BRANCH open|crossed, BRANCH pin left|right pin pin, or BRANCH pin "// &
      "forward|backward", choices="open crossed left right forward backward", default="open", &
      help="of a four-bar: open is B to the left of the line from A to O4; or the side of a pin"), &
    card_kind_t("PINMASS", least=2, most=2, pattern="PINMASS pin mass", &
      help="a mass at a moving pin"), &
    card_kind_t("MESH", least=1, most=many, &
      pattern="MESH link ... elements= [order=3], or MESH link ... accuracy=, with * for all "// &
      "other links", entry="order=3", default="* accuracy=1e-8", &
      help="how links are divided, or how accurate frequencies are to be"), &
    card_kind_t("MASS", least=2, most=2, pattern="MASS link at= [offset= inertia=] mass", &
      entry="offset=0 inertia=0", help="a mass fixed to a link"), &
    card_kind_t("POINT", least=2, most=2, pattern="POINT name link along= [offset=]", &
      entry="offset=0", help="a point of a link, for REPORT points or as a pin of others"), &
    card_kind_t("GAUGE", least=2, most=2, pattern="GAUGE name link at= [side=left|right]", &
      choices="left right", entry="side=right", help="a strain gauge, for REPORT strains"), &
    card_kind_t("DAMPING", least=1, most=many, &
      pattern="DAMPING link ... time=, or DAMPING link ... ratio=, with * for all other links", &
      help="the damping of links that bend, in their elastic response"), &
    card_kind_t("GRAVITY", is_single=.true., least=2, most=2, pattern="GRAVITY gx gy", &
      help="acceleration of gravity in global axes"), &
    card_kind_t("FORCE", least=3, most=3, pattern="FORCE pin fx fy, or FORCE link fx fy at= "// &
      "[offset=] [axes=], with [table= over=] [during= smooth=]", &
      help="a force on a moving pin, or at a place of a link"), &
    card_kind_t("TORQUE", least=1, most=2, pattern="TORQUE link torque, or TORQUE link table= "// &
      "[over=], with [during= smooth=]", &
      help="a torque on a link"), &
    card_kind_t("MOTOR", is_single=.true., pattern="MOTOR torque=, MOTOR stall= noload=, or "// &
      "MOTOR table= [line=], with [ratio= rotor= efficiency= smooth=]", &
      help="what turns the driven link in REPORT motion, and its gear"), &
    card_kind_t("LOAD", least=1, most=1, pattern="LOAD link [torque=] [damping=] "// &
      "[resisting= smooth=], or LOAD pin [damping=] [resisting= smooth=]", &
      help="what resists the motion of a link or a pin"), &
    card_kind_t("SPRING", least=3, most=4, pattern="SPRING name end end stiffness= "// &
      "[free_length= | force=], or SPRING name pin link [link] stiffness= [free_angle= | "// &
      "torque=], with [only= gap= damping= contact=]", &
      keys="stiffness free_length force free_angle torque only gap damping contact", &
      help="a spring between two pins or points, or a torsional one at a pin of links"), &
    card_kind_t("DAMPER", least=3, most=4, pattern="DAMPER name end end damping=, or "// &
      "DAMPER name pin link [link] damping=", keys="damping", &
      help="a viscous damper between two pins or points, or at a pin of links"), &
    card_kind_t("STOP", least=2, most=3, pattern="STOP name measure limit= stiffness= "// &
      "[damping=] [contact=] [below]", keys="limit stiffness damping contact", choices="below", &
      help="what pushes a MEASURE, spring, ram or block back beyond a limit"), &
    card_kind_t("MEASURE", least=3, most=many, &
      pattern="MEASURE name distance|angle|along|across|travel|sum ...", &
      choices="distance angle along across travel sum", &
      help="a distance, an angle or a place by name, for REPORT coordinates and linkage"), &
    card_kind_t("MEASURE", "distance", least=4, most=4, pattern="MEASURE name distance pin pin", &
      help="between two pins or points"), &
    card_kind_t("MEASURE", "angle", least=3, most=5, &
      pattern="MEASURE name angle link [against link]", choices="against", &
      help="of a link, from the x axis or from another link"), &
    card_kind_t("MEASURE", "along", least=4, most=4, &
      pattern="MEASURE name along pin guide|link", help="the place of a pin along a line"), &
    card_kind_t("MEASURE", "across", least=4, most=4, &
      pattern="MEASURE name across pin guide|link", help="of a pin, to the left of a line"), &
    card_kind_t("MEASURE", "travel", least=5, most=5, pattern="MEASURE name travel pin dx dy", &
      help="the place of a pin in a fixed direction, from the origin"), &
    card_kind_t("MEASURE", "sum", least=4, most=many, &
      pattern="MEASURE name sum weight name [weight name ...]", &
      help="of others, of springs, rams and sliders, each with its weight"), &
    card_kind_t("ACTUATE", least=1, most=many, pattern="ACTUATE name [name ...]", &
      help="coordinates along which efforts act, in place of those of the drives"), &
    card_kind_t("FRICTION", least=1, most=3, pattern="FRICTION pin [link [link]] radius= "// &
      "coefficient= [viscous= smooth=], or FRICTION pin guide with [length=] for radius=", &
      keys="radius coefficient viscous smooth length", &
      help="friction at a pin, or of a block along its guide"), &
    card_kind_t("BALANCE", is_single=.true., most=many, &
      pattern="BALANCE [link ...] minimise=force,moment,torque [weights=] [radius=] "// &
      "[density= thickness= | inertia=]", choices="force moment torque", help= &
      "counterweights of REPORT balance that minimise what shakes and drives the linkage"), &
    card_kind_t("BALANCE", "shaft", least=1, most=1, &
      pattern="BALANCE shaft order= [at=x,y] [radius=] [density= thickness= | inertia=]", &
      help="shafts that cancel a harmonic of the shaking force, with and against the crank"), &
    card_kind_t("CRANK", is_single=.true., is_list=.true., least=1, most=many, &
      pattern="CRANK a to b step s, or a list of angles", help="the positions"), &
    card_kind_t("SPEED", is_single=.true., is_list=.true., least=1, most=many, &
      pattern="SPEED a list or range of speeds [rad/s|rpm] [alpha=] [ramp=]", default="0", &
      help="of the crank; alpha: acceleration at all of them; ramp: time up to them from rest"), &
    card_kind_t("LAW", least=1, most=2, &
      pattern="LAW name kind to= start= stop= [from=], or LAW name table= "// &
      "[ends=free|rest|periodic], or LAW name formula= [period=]", &
      choices="ramp parabolic harmonic cycloidal modified_sine modified_trapezoid "// &
      "polynomial_345 polynomial_4567", &
      help="the motion of a drive: a segment of it, a table of positions, or a formula in t"), &
    card_kind_t("TIME", is_single=.true., is_list=.true., least=1, most=many, &
      pattern="TIME a to b step s, or a list of instants", &
      help="the instants of tables, in place of CRANK and SPEED, if the drive has a law"), &
    card_kind_t("INERTIA", is_single=.true., least=1, most=1, &
      pattern="INERTIA lumped|distributed", choices="lumped distributed", default="distributed", &
      help="where inertia loads act: at the nodes of the mesh, or along the links"), &
    card_kind_t("EFFECTS", is_single=.true., least=1, most=4, &
      pattern="EFFECTS [static|axial] [rotary] [shear]", choices="static axial rotary shear", &
      default="static|axial", &
      help="what frequencies account for; axial if the linkage moves or is loaded"), &
    card_kind_t("EFFECTS", "response", is_single=.true., least=1, most=1, &
      pattern="EFFECTS response without=coriolis,centripetal,tangential,axial,quadratic", &
      choices="coriolis centripetal tangential axial quadratic", &
      help="terms to be left out of the elastic response, one or several of them"), &
    card_kind_t("SOLVER", is_single=.true., least=1, most=1, &
      pattern="SOLVER auto|deformation|dense|band", choices="auto deformation dense band", &
      default="auto", help="how frequencies are found; auto is deformation"), &
    card_kind_t("MODES", is_single=.true., least=1, most=1, pattern="MODES number", default="3", &
      help="how many of the lowest frequencies"), &
    card_kind_t("REPORT", least=1, most=1, pattern="REPORT name ...", &
      help="a table to be written; at least one is required")]

contains

  !> The keywords of all cards, each once.
  pure function card_names() result(names)
    type(string_t), allocatable :: names(:)

    integer :: i

    allocate (names(0))
    do i = 1, size(card_kinds)
      if (card_kinds(i)%form == "") call append_string(names, trim(card_kinds(i)%keyword))
    end do
  end function card_names

  !> Number of a card's form in the table; 0 if it does not exist.
  pure function card_kind_number(keyword, form) result(number)
    character(len=*), intent(in) :: keyword        !! in any case of letters
    character(len=*), intent(in), optional :: form !! absent: the record without a form
    integer :: number

    character(len=len(card_kinds%form)) :: wanted

    wanted = ""
    if (present(form)) wanted = form
    do number = 1, size(card_kinds)
      if (card_kinds(number)%form /= wanted) cycle
      if (same_word(trim(card_kinds(number)%keyword), keyword)) return
    end do
    number = 0
  end function card_kind_number

  !> A card's record in the table.
  pure function kind_of_card(keyword, form) result(kind)
    character(len=*), intent(in) :: keyword        !! of an existing card
    character(len=*), intent(in), optional :: form !! absent: the record without a form
    type(card_kind_t) :: kind

    kind = card_kinds(card_kind_number(keyword, form))
  end function kind_of_card

  !> The correct form of a card.
  pure function pattern_of(keyword) result(pattern)
    character(len=*), intent(in) :: keyword !! of an existing card
    character(len=:), allocatable :: pattern

    pattern = trim(card_kinds(card_kind_number(keyword))%pattern)
  end function pattern_of

  !> The keys of a card, separated by blanks.
  pure function keys_of(kind) result(keys)
    type(card_kind_t), intent(in) :: kind !! its record
    character(len=:), allocatable :: keys

    keys = trim(kind%keys)
    if (len(keys) == 0) keys = keys_in(trim(kind%pattern))
  end function keys_of

  !> The words before the equals signs of a pattern, separated by blanks.
  pure function keys_in(pattern) result(keys)
    character(len=*), intent(in) :: pattern !! correct form of a card
    character(len=:), allocatable :: keys

    type(string_t), allocatable :: list(:)
    integer :: i, first

    allocate (list(0))
    do i = 1, len(pattern)
      if (pattern(i:i) /= "=") cycle
      first = scan(pattern(:i - 1), " [,", back=.true.) + 1
      call append_string(list, pattern(first:i - 1))
    end do
    keys = joined(list, " ")
  end function keys_in

end module card_table
