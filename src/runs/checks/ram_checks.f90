!> Checks of the masses of rams: links whose length a DRIVE gives.
!!
!! The mass of a ram goes with one of its pins, the one that is placed before it. Its card has to
!! count from this pin, or else the mass would be elsewhere at every length.
module ram_checks
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use linkages, only: drive_of_length
  use mechanisms, only: mechanism_t
  use models, only: model_t
  implicit none (type, external)
  private

  public :: check_rams

contains

  !> Whether the masses of all rams are known, and where they are.
  pure subroutine check_rams(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors are added

    integer :: i

    do i = 1, size(mechanism%linkage%drives)
      if (mechanism%linkage%drives(i)%kind /= drive_of_length) cycle
      call check_ram(model, mechanism, mechanism%linkage%drives(i)%body, diagnostics)
    end do
  end subroutine check_rams

  pure subroutine check_ram(model, mechanism, b, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: b !! number of the body
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: first, last

    associate (link => model%links(mechanism%links(b)), body => mechanism%linkage%bodies(b))
      first = mechanism%pin_names(body%first_pin)%text
      last = mechanism%pin_names(body%last_pin)%text
      if (.not. link%length > 0.0_wp) then
        if (link%has_mass .and. link%mass > 0.0_wp .and. .not. (link%has_inertia .and. &
          link%has_center)) then
          call add_error(diagnostics, link%body_word, "link '"//link%name%text//"' has a mass, "// &
            "and no length of its own; expected 'inertia=', and 'center=' as counted from '"// &
            first//"'")
          return
        else if (.not. link%has_mass .and. link%material > 0 .and. link%section > 0) then
          call add_error(diagnostics, link%name, "link '"//link%name%text//"' has material and "// &
            "section, and no length of its own; expected 'mass=', 'inertia=' and 'center=' "// &
            "instead, or PIN cards of its pins")
          return
        end if
      end if
      if (body%card_axis(1) > 0.0_wp .or. .not. sum(body%lumps%mass) + body%line_density > &
        0.0_wp) return
      call add_error(diagnostics, link%pins(1), "the mass of link '"//link%name%text// &
        "' goes with '"//first//"', which is placed before it, and is counted from '"//last// &
        "'; expected 'LINK "//link%name%text//" "//first//" "//last//"' with 'center=' as "// &
        "counted from '"//first//"', or 'mass=0' and PINMASS "//last)
    end associate
  end subroutine check_ram

end module ram_checks
