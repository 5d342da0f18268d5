!> Sections of plane walls: hollow rectangles (boxes), I sections and channels.
!!
!! The walls are rectangles parallel or normal to the plane of motion; fillets are left out. Shear
!! coefficients are those of thin walls: G. R. Cowper, The shear coefficient in Timoshenko's beam
!! theory, J. Appl. Mech. 33 (1966) 335; see docs/theory.md, Rotary inertia and shear.
module walled_sections
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: walled_section_t, new_box, new_i_section, new_channel, plane_of_web, plane_of_flanges
  public :: box_shear_coefficient, i_shear_coefficient, channel_shear_coefficient, &
    flange_shear_coefficient, lying_channel_shear_coefficient

  !> Which walls lie in the plane of motion; in the order of the words after `plane=`.
  integer, parameter :: plane_of_web = 1, plane_of_flanges = 2

  type :: walled_section_t
    real(wp) :: area = 0.0_wp          !! [m²]
    real(wp) :: second_moment = 0.0_wp !! about the centroidal axis normal to the plane [m⁴]
    real(wp) :: depth = 0.0_wp         !! in the plane [m]
    real(wp) :: centroid = 0.0_wp      !! its distance from the edge of the section in the plane; of
                                       !! a channel by its flanges, from the back of its web [m]
    real(wp) :: flange_share = 0.0_wp  !! area of both flanges over that of the webs, on the middle
                                       !! lines of the walls: Cowper's m [-]
    real(wp) :: flange_ratio = 0.0_wp  !! width over depth on the middle lines: Cowper's n [-]
  end type walled_section_t

  !> A wall: a rectangle.
  type :: wall_t
    real(wp) :: along = 0.0_wp  !! its side in the plane of motion [m]
    real(wp) :: across = 0.0_wp !! its side normal to the plane [m]
    real(wp) :: place = 0.0_wp  !! of its centre in the plane, from the edge of the section [m]
  end type wall_t

contains

  !> A rectangular tube; the side `thickness` lies in the plane of motion.
  pure function new_box(thickness, width, wall) result(section)
    real(wp), intent(in) :: thickness !! outer side in the plane of motion [m]
    real(wp), intent(in) :: width     !! outer side normal to it [m]
    real(wp), intent(in) :: wall      !! thickness of all walls, less than half of either side [m]
    type(walled_section_t) :: section

    type(wall_t) :: walls(3)

    walls(1) = wall_t(wall, width, wall/2.0_wp)
    walls(2) = wall_t(wall, width, thickness - wall/2.0_wp)
    walls(3) = wall_t(thickness - 2.0_wp*wall, 2.0_wp*wall, thickness/2.0_wp)
    section = section_of(walls, thickness)
    section%flange_ratio = (width - wall)/(thickness - wall)
    section%flange_share = section%flange_ratio
  end function new_box

  !> An I section.
  pure function new_i_section(depth, width, web, flange, plane) result(section)
    real(wp), intent(in) :: depth  !! over both flanges [m]
    real(wp), intent(in) :: width  !! of the flanges, above `web` [m]
    real(wp), intent(in) :: web    !! its thickness [m]
    real(wp), intent(in) :: flange !! its thickness, less than half of the depth [m]
    integer, intent(in) :: plane   !! plane_of_web or plane_of_flanges
    type(walled_section_t) :: section

    section = flanged_section(depth, width, web, flange, plane, width/2.0_wp, width)
  end function new_i_section

  !> A channel.
  pure function new_channel(depth, width, web, flange, plane) result(section)
    real(wp), intent(in) :: depth  !! over both flanges [m]
    real(wp), intent(in) :: width  !! from the back of the web to the edges of the flanges, above
                                   !! `web` [m]
    real(wp), intent(in) :: web    !! its thickness [m]
    real(wp), intent(in) :: flange !! its thickness, less than half of the depth [m]
    integer, intent(in) :: plane   !! plane_of_web or plane_of_flanges
    type(walled_section_t) :: section

    section = flanged_section(depth, width, web, flange, plane, web/2.0_wp, width - web/2.0_wp)
  end function new_channel

  !> Two flanges and a web between them.
  pure function flanged_section(depth, width, web, flange, plane, web_place, middle_width) &
    result(section)
    real(wp), intent(in) :: depth, width, web, flange !! as for the I section [m]
    integer, intent(in) :: plane                      !! plane_of_web or plane_of_flanges
    real(wp), intent(in) :: web_place                 !! middle of the web, along the flanges [m]
    real(wp), intent(in) :: middle_width              !! of a flange, on the middle lines [m]
    type(walled_section_t) :: section

    type(wall_t) :: walls(3)

    if (plane == plane_of_web) then
      walls(1) = wall_t(flange, width, flange/2.0_wp)
      walls(2) = wall_t(flange, width, depth - flange/2.0_wp)
      walls(3) = wall_t(depth - 2.0_wp*flange, web, depth/2.0_wp)
      section = section_of(walls, depth)
    else
      walls(1:2) = wall_t(width, flange, width/2.0_wp)
      walls(3) = wall_t(web, depth - 2.0_wp*flange, web_place)
      section = section_of(walls, width)
    end if
    section%flange_ratio = middle_width/(depth - flange)
    section%flange_share = 2.0_wp*section%flange_ratio*flange/web
  end function flanged_section

  !> Area, centroid and second moment of walls: a sum of positive terms, so that thin walls cost no
  !! digits.
  pure function section_of(walls, depth) result(section)
    type(wall_t), intent(in) :: walls(:)
    real(wp), intent(in) :: depth
    type(walled_section_t) :: section

    section%depth = depth
    section%area = sum(walls%along*walls%across)
    if (section%area <= 0.0_wp) return
    section%centroid = sum(walls%along*walls%across*walls%place)/section%area
    section%second_moment = sum(walls%along*walls%across*(walls%along**2/12.0_wp + &
      (walls%place - section%centroid)**2))
  end function section_of

  !> Thin-walled box, all walls of one thickness: Cowper (1966).
  elemental function box_shear_coefficient(m, n, nu) result(k)
    real(wp), intent(in) :: m, n !! `flange_share`, `flange_ratio`
    real(wp), intent(in) :: nu   !! Poisson's ratio
    real(wp) :: k

    k = 10.0_wp*(1.0_wp + nu)*(1.0_wp + 3.0_wp*m)**2/(web_terms(m, nu) + &
      10.0_wp*n**2*((3.0_wp + nu)*m + 3.0_wp*m**2))
  end function box_shear_coefficient

  !> Thin-walled I section bent in the plane of its web: Cowper (1966).
  elemental function i_shear_coefficient(m, n, nu) result(k)
    real(wp), intent(in) :: m, n !! `flange_share`, `flange_ratio`
    real(wp), intent(in) :: nu   !! Poisson's ratio
    real(wp) :: k

    k = 10.0_wp*(1.0_wp + nu)*(1.0_wp + 3.0_wp*m)**2/(web_terms(m, nu) + &
      30.0_wp*n**2*(m + m**2) + 5.0_wp*nu*n**2*(8.0_wp*m + 9.0_wp*m**2))
  end function i_shear_coefficient

  !> Thin-walled channel bent in the plane of its web by forces through its shear centre: Cowper's
  !! integral, evaluated for this section.
  elemental function channel_shear_coefficient(m, n, nu) result(k)
    real(wp), intent(in) :: m, n !! `flange_share`, `flange_ratio`
    real(wp), intent(in) :: nu   !! Poisson's ratio
    real(wp) :: k

    k = 10.0_wp*(1.0_wp + nu)*(1.0_wp + 3.0_wp*m)**2/(web_terms(m, nu) + &
      120.0_wp*n**2*(m + m**2) + 10.0_wp*nu*n**2*m*(16.0_wp + 28.0_wp*m + 9.0_wp*m**2)/ &
      (1.0_wp + m))
  end function channel_shear_coefficient

  !> What the web and the bending of the flanges add to the denominators; for m = 0, that of a
  !! rectangle.
  elemental function web_terms(m, nu) result(terms)
    real(wp), intent(in) :: m, nu
    real(wp) :: terms

    terms = 12.0_wp + m*(72.0_wp + m*(150.0_wp + m*90.0_wp)) + &
      nu*(11.0_wp + m*(66.0_wp + m*(135.0_wp + m*90.0_wp)))
  end function web_terms

  !> Thin-walled I section bent in the plane of its flanges: of ν = 0. With ν Cowper's coefficient
  !! depends on the anticlastic bending of the web, and is negative where flanges are narrow.
  elemental function flange_shear_coefficient(m) result(k)
    real(wp), intent(in) :: m !! `flange_share`
    real(wp) :: k

    k = 5.0_wp/6.0_wp*m/(1.0_wp + m)
  end function flange_shear_coefficient

  !> Thin-walled channel bent in the plane of its flanges: of ν = 0, as for the I section.
  elemental function lying_channel_shear_coefficient(m, n) result(k)
    real(wp), intent(in) :: m, n !! `flange_share`, `flange_ratio`
    real(wp) :: k

    k = 10.0_wp*m*n**2*(4.0_wp + m)**2/(n**2*(192.0_wp + m*(276.0_wp + m*(96.0_wp + &
      m*12.0_wp))) + 30.0_wp*m*(1.0_wp + m))
  end function lying_channel_shear_coefficient

end module walled_sections
