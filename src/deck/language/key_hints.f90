!> What unknown keys of cards may mean: other names of a quantity, abbreviations, misspellings.
module key_hints
  use spelling, only: suggestion
  use text, only: has_word, lower_case, same_word, string_t, word_list
  implicit none (type, external)
  private

  public :: key_hint

  !> A quantity under its other names, in small letters, and the keys for it in the order of
  !! preference: that which the card has is meant.
  type :: other_name_t
    character(len=56) :: names = "" !! separated by single blanks
    character(len=32) :: keys = ""  !! separated by single blanks
  end type other_name_t

  type(other_name_t), parameter :: other_names(*) = [ &
    other_name_t("height h", "thickness depth"), &
    other_name_t("t s", "thickness wall"), &
    other_name_t("w b breadth", "width"), &
    other_name_t("d dia diam", "diameter depth"), &
    other_name_t("od do outside", "outer"), &
    other_name_t("id di inside bore", "inner"), &
    other_name_t("tw", "web"), &
    other_name_t("tf", "flange"), &
    other_name_t("area", "A"), &
    other_name_t("iz iy ix izz iyy moment second_moment", "I"), &
    other_name_t("k kappa shear", "shear_coefficient"), &
    other_name_t("axis bending", "plane"), &
    other_name_t("youngs young young's modulus emod youngs_modulus", "E"), &
    other_name_t("rho dens", "density"), &
    other_name_t("poisson poissons poisson's mu v", "nu"), &
    other_name_t("len l", "length"), &
    other_name_t("length l l0 rest rest_length", "free_length"), &
    other_name_t("angle theta phi rest_angle", "free_angle"), &
    other_name_t("k rate spring_rate spring_constant", "stiffness"), &
    other_name_t("preload pretension f f0", "force"), &
    other_name_t("mu mue friction f", "coefficient"), &
    other_name_t("r", "radius"), &
    other_name_t("clearance play", "gap"), &
    other_name_t("mat", "material"), &
    other_name_t("sec sect profile", "section"), &
    other_name_t("m weight", "mass"), &
    other_name_t("j moi i ig", "inertia"), &
    other_name_t("cg cog com centroid", "center"), &
    other_name_t("position pos distance x", "at along"), &
    other_name_t("along", "at"), &
    other_name_t("at", "along"), &
    other_name_t("y", "offset"), &
    other_name_t("n divisions", "elements"), &
    other_name_t("tolerance tol error", "accuracy"), &
    other_name_t("degree p", "order"), &
    other_name_t("acceleration alpha2", "alpha"), &
    other_name_t("angle theta theta2 start", "crank"), &
    other_name_t("omega omega2 rpm", "speed"), &
    other_name_t("time duration tend stop until", "end"), &
    other_name_t("dt increment", "step"), &
    other_name_t("c viscous", "damping time"), &
    other_name_t("tau", "time"), &
    other_name_t("zeta xi", "ratio"), &
    other_name_t("face edge", "side"), &
    other_name_t("no omit except", "without")]

contains

  !> ` (did you mean 'thickness'?)` if an unknown key is another name of one of the card's, or near
  !! to one; else an empty text.
  pure function key_hint(key, allowed) result(hint)
    character(len=*), intent(in) :: key       !! unknown, in any case of letters
    type(string_t), intent(in) :: allowed(:)  !! the keys of the card
    character(len=:), allocatable :: hint

    type(string_t), allocatable :: keys(:)
    integer :: i, k

    if (same_word(key, "radius") .or. same_word(key, "r")) then
      if (has_word(allowed, "diameter")) then
        hint = " (did you mean 'diameter', twice the radius?)"
        return
      end if
    end if
    do i = 1, size(other_names)
      if (index(" "//trim(other_names(i)%names)//" ", " "//lower_case(key)//" ") == 0) cycle
      keys = word_list(trim(other_names(i)%keys))
      do k = 1, size(keys)
        if (.not. has_word(allowed, keys(k)%text)) cycle
        hint = " (did you mean '"//keys(k)%text//"'?)"
        return
      end do
    end do
    hint = ""
    if (size(allowed) > 0) hint = suggestion(key, allowed)
  end function key_hint

end module key_hints
