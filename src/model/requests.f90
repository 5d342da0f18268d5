!> CRANK, SPEED, REPORT and the choices: what is to be computed.
module requests
  use card_reader, only: check_form, read_choice, read_entry_count, read_entry_quantity
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use tokens, only: token_t
  use units, only: dimension_angle, dimension_angular_acceleration, dimension_rate, unit_system_t
  use value_lists, only: empty_list, read_entry_list, read_values, value_list_t
  implicit none (type, external)
  private

  public :: report_t, read_crank, read_speed, read_report, report_kinds, report_kind_count
  public :: report_kinematics, report_inertia, report_mesh, report_frequencies, report_shapes, report_branches

  !> One REPORT card.
  type :: report_t
    type(token_t) :: keyword
    integer :: kind = 0          !! one of the report_… numbers; 0: unknown
    type(value_list_t) :: crank  !! of `crank=` [deg]; empty: every position
    type(value_list_t) :: speed  !! of `speed=` [rad/s]; empty: every speed
    integer :: points = 21       !! of `points=`, along each link
  end type report_t

  character(len=*), parameter :: report_kinds = "kinematics inertia mesh frequencies shapes branches"
  integer, parameter :: report_kinematics = 1, report_inertia = 2, report_mesh = 3, report_frequencies = 4, report_shapes = 5, &
    report_branches = 6
  integer, parameter :: report_kind_count = 6

contains

  !> Reads `CRANK` angles [deg]: numbers and ranges `a to b step s`, perhaps with one unit at the end for all of them.
  pure subroutine read_crank(card, system, diagnostics, crank)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(out) :: crank

    logical :: fine

    call check_form(card, 1, huge(1), "", "CRANK a to b step s, or a list of angles", diagnostics, fine)
    call read_values(card%words, dimension_angle, system, "crank angle", diagnostics, crank)
  end subroutine read_crank

  !> Reads `SPEED` values [rad/s], listed like crank angles, and `alpha=` [rad/s²].
  pure subroutine read_speed(card, system, diagnostics, speed, acceleration)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(out) :: speed
    real(wp), intent(out) :: acceleration !! [rad/s²]

    logical :: fine

    call check_form(card, 1, huge(1), "alpha", "SPEED a list or range of speeds [rad/s|rpm] [alpha=]", diagnostics, fine)
    call read_values(card%words, dimension_rate, system, "speed", diagnostics, speed)
    call read_entry_quantity(card, "alpha", dimension_angular_acceleration, system, .false., diagnostics, acceleration, fine)
  end subroutine read_speed

  !> Reads `REPORT kind`, for shapes with `crank=`, `speed=` and `points=`.
  pure subroutine read_report(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(out) :: report

    logical :: fine
    integer :: points

    report%keyword = card%keyword
    report%crank = empty_list()
    report%speed = empty_list()
    if (size(card%words) > 0) call read_choice(card%words(1), report_kinds, diagnostics, report%kind)
    if (report%kind == report_shapes) then
      call check_form(card, 1, 1, "crank speed points", "REPORT shapes [crank=a,b,...] [speed=...] [points=]", diagnostics, fine)
      call read_entry_list(card, "crank", dimension_angle, system, diagnostics, report%crank)
      call read_entry_list(card, "speed", dimension_rate, system, diagnostics, report%speed)
      call read_entry_count(card, "points", 2, diagnostics, points, fine)
      if (fine) then
        report%points = points
      end if
    else if (report%kind > 0 .or. size(card%words) == 0) then
      call check_form(card, 1, 1, "", "REPORT kinematics|inertia|mesh|frequencies|shapes|branches", diagnostics, fine)
    end if
  end subroutine read_report

end module requests
