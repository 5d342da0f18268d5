!> Shear stiffness and rotary inertia of links, and whether a deck with EFFECTS shear has all data
!! for it.
!!
!! The shear stiffness is kGA with G = E/(2(1 + ν)). The shear coefficient k is the deck's own, or
!! that of G. R. Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33 (1966)
!! 335; that of thin walls for boxes, I sections and channels.
module shear
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use models, only: model_t, needs_frequencies, needs_response
  use sections, only: section_t, shape_box, shape_channel, shape_circle, shape_general, shape_i, &
    shape_rectangle, shape_tube
  use walled_sections, only: box_shear_coefficient, channel_shear_coefficient, &
    flange_shear_coefficient, i_shear_coefficient, lying_channel_shear_coefficient, plane_of_web
  implicit none (type, external)
  private

  public :: shear_coefficient, link_shear_stiffness, link_rotary_inertia, check_shear

contains

  !> Shear coefficient k of a section (Cowper 1966).
  elemental function shear_coefficient(section, nu) result(k)
    type(section_t), intent(in) :: section !! as read
    real(wp), intent(in) :: nu             !! Poisson's ratio of its material, above −1
    real(wp) :: k                          !! 0 for a general section without one of its own

    real(wp) :: m_squared

    k = section%shear_coefficient
    if (k > 0.0_wp) return
    select case (section%shape)
    case (shape_rectangle)
      k = 10.0_wp*(1.0_wp + nu)/(12.0_wp + 11.0_wp*nu)
    case (shape_circle)
      k = 6.0_wp*(1.0_wp + nu)/(7.0_wp + 6.0_wp*nu)
    case (shape_tube)
      m_squared = section%inner_share**2
      k = 6.0_wp*(1.0_wp + nu)*(1.0_wp + m_squared)**2/ &
        ((7.0_wp + 6.0_wp*nu)*(1.0_wp + m_squared)**2 + (20.0_wp + 12.0_wp*nu)*m_squared)
    case (shape_box)
      k = box_shear_coefficient(section%walls%flange_share, section%walls%flange_ratio, nu)
    case (shape_i)
      if (section%plane == plane_of_web) then
        k = i_shear_coefficient(section%walls%flange_share, section%walls%flange_ratio, nu)
      else
        k = flange_shear_coefficient(section%walls%flange_share)
      end if
    case (shape_channel)
      if (section%plane == plane_of_web) then
        k = channel_shear_coefficient(section%walls%flange_share, section%walls%flange_ratio, nu)
      else
        k = lying_channel_shear_coefficient(section%walls%flange_share, section%walls%flange_ratio)
      end if
    end select
  end function shear_coefficient

  !> kGA of a link of the deck [N]; 0 if the deck does not request shear or the link does not bend.
  pure function link_shear_stiffness(model, link) result(stiffness)
    type(model_t), intent(in) :: model !! whose links have their materials and sections
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: stiffness

    stiffness = 0.0_wp
    associate (this => model%links(link))
      if (.not. model%shear .or. this%rigid .or. this%material == 0 .or. this%section == 0) return
      associate (material => model%materials(this%material), &
        section => model%sections(this%section))
        if (.not. material%has_ratio) return
        stiffness = shear_coefficient(section, material%poissons_ratio)*material%youngs_modulus/ &
          (2.0_wp*(1.0_wp + material%poissons_ratio))*section%area
      end associate
    end associate
  end function link_shear_stiffness

  !> ρI of a link of the deck [kg m]; 0 if the deck does not request rotary inertia or the link has
  !! no material or section.
  pure function link_rotary_inertia(model, link) result(inertia)
    type(model_t), intent(in) :: model !! whose links have their materials and sections
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: inertia

    inertia = 0.0_wp
    associate (this => model%links(link))
      if (.not. model%rotary .or. this%material == 0 .or. this%section == 0) return
      inertia = model%materials(this%material)%density*model%sections(this%section)%second_moment
    end associate
  end function link_rotary_inertia

  !> Checks the data for shear. Errors: a material in use without Poisson's ratio, a general section
  !! in use without shear coefficient. Rigid links need neither.
  pure subroutine check_shear(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose links have their materials and
                                                      !! sections

    integer :: i

    if (.not. model%shear) return
    if (.not. needs_frequencies(model) .and. .not. needs_response(model)) return
    do i = 1, size(model%materials)
      associate (material => model%materials(i))
        if (material%has_ratio .or. .not. any(model%links%material == i .and. &
          .not. model%links%rigid)) cycle
        call add_error(diagnostics, material%name, "material '"//material%name%text// &
          "' has no 'nu=', and the shear modulus E/(2(1 + nu)) needs it", model%shear_word, &
          "shear is asked for here")
      end associate
    end do
    do i = 1, size(model%sections)
      associate (section => model%sections(i))
        if (section%shape /= shape_general .or. section%shear_word%line > 0) cycle
        if (.not. any(model%links%section == i .and. .not. model%links%rigid)) cycle
        call add_error(diagnostics, section%name, "section '"//section%name%text// &
          "' is general, and its shear coefficient "// &
          "cannot be derived: expected 'shear_coefficient='", model%shear_word, &
          "shear is asked for here")
      end associate
    end do
  end subroutine check_shear

end module shear
