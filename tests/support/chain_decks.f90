!> Decks of chains of four-bars: the follower of a stage, with a third pin, drives the coupler of the
!! next one. A chain of n stages has 2n + 1 links and n loops.
module chain_decks
  use kinds, only: wp
  use text, only: to_string
  implicit none (type, external)
  private

  public :: chain_deck
  public :: crank_length, coupler_length, follower_length, drive_length, ground_step
  public :: modulus, density, thickness, width

  !> Lengths of links [mm]; the next coupler is at `drive_length` of a follower; distance of grounds.
  real(wp), parameter :: crank_length = 60.0_wp, coupler_length = 260.0_wp, &
    follower_length = 150.0_wp, drive_length = 100.0_wp, ground_step = 254.0_wp

  !> Young's modulus [MPa], density [t/mm³] and cross-section [mm] of all links.
  real(wp), parameter :: modulus = 200.0e3_wp, density = 7.8e-9_wp, &
    thickness = 1.6_wp, width = 25.4_wp

  character(len=*), parameter :: nl = achar(10)

contains

  !> The deck of a chain of steel strips, without END.
  function chain_deck(stages, more) result(deck)
    integer, intent(in) :: stages        !! n
    character(len=*), intent(in) :: more !! further cards: positions, mesh, what is asked for
    character(len=:), allocatable :: deck

    character(len=*), parameter :: strip = " material=steel section=strip"//nl
    character(len=:), allocatable :: this, next
    integer :: i

    deck = "UNITS mm tonne s"//nl//"MATERIAL steel E="//to_string(modulus)//" density="// &
      to_string(density)//nl//"SECTION strip rectangle thickness="//to_string(thickness)//" width="// &
      to_string(width)//nl
    do i = 0, stages
      deck = deck//"GROUND G"//to_string(i)//" "//to_string(i*ground_step)//" 0"//nl
    end do
    deck = deck//"LINK crank G0 A0 length="//to_string(crank_length)//strip
    do i = 0, stages - 1
      this = to_string(i)
      next = to_string(i + 1)
      deck = deck//"LINK c"//this//" A"//this//" B"//this//" length="//to_string(coupler_length)//strip
      if (i < stages - 1) then
        deck = deck//"LINK f"//this//" G"//next//" A"//next//" B"//this//" lengths="// &
          to_string(drive_length)//","//to_string(follower_length - drive_length)//" turns=0"//strip
      else
        deck = deck//"LINK f"//this//" G"//next//" B"//this//" length="//to_string(follower_length)//strip
      end if
    end do
    deck = deck//"DRIVE crank"//nl
    do i = 0, stages - 1
      deck = deck//"BRANCH B"//to_string(i)//" left A"//to_string(i)//" G"//to_string(i + 1)//nl
    end do
    deck = deck//"INERTIA distributed"//nl//more
  end function chain_deck

end module chain_decks
