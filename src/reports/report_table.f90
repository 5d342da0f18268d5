!> The list of reports, in the order of messages, help and tables.
!!
!! A new report is a file of its own (`report_types`) and a line of `list_reports`.
module report_table
  use balance_report, only: describe_balance, describe_hung_balance
  use bearings_report, only: describe_bearings
  use campbell_report, only: describe_campbell
  use coordinates_report, only: describe_coordinates
  use drive_report, only: describe_drive, describe_torque
  use equilibrium_report, only: describe_equilibrium
  use frame_report, only: describe_frame
  use frequency_report, only: describe_frequencies, describe_shapes
  use friction_report, only: describe_friction
  use geometry_report, only: describe_geometry
  use inertia_report, only: describe_inertia, describe_other_inertia
  use intervals_report, only: describe_intervals
  use joints_report, only: describe_drives, describe_drives_as_drive, describe_joints
  use kinematics_report, only: describe_kinematics, describe_links
  use lagrange_report, only: describe_lagrange
  use limits_report, only: describe_limits
  use linkage_report, only: describe_linkage
  use loci_report, only: describe_branches
  use mesh_report, only: describe_mesh
  use models, only: model_t, report_number
  use motion_report, only: describe_linkage_motion, describe_motion
  use peaks_report, only: describe_peaks
  use pins_report, only: describe_pins
  use points_report, only: describe_points
  use reactions_report, only: describe_reactions
  use report_kinds, only: report_kind_t
  use report_types, only: any_table_t, report_record_t
  use response_report, only: describe_response
  use sizing_report, only: describe_sizing
  use stability_report, only: describe_stability
  use strains_report, only: describe_strains
  use summary_report, only: describe_summary
  use transient_report, only: describe_transient
  use validity_report, only: describe_validity
  implicit none (type, external)
  private

  public :: list_reports, reports, tables_of, tables_of_report

  !> Room for reports.
  integer, parameter :: most_reports = 64

contains

  !> All reports.
  subroutine list_reports(list)
    type(report_record_t), allocatable, intent(out) :: list(:)

    type(report_record_t) :: room(most_reports)
    integer :: count

    count = 0
    call add(describe_kinematics)
    call add(describe_links)
    call add(describe_pins)
    call add(describe_inertia)
    call add(describe_other_inertia)
    call add(describe_mesh)
    call add(describe_frequencies)
    call add(describe_shapes)
    call add(describe_branches)
    call add(describe_reactions)
    call add(describe_joints)
    call add(describe_bearings)
    call add(describe_frame)
    call add(describe_friction)
    call add(describe_sizing)
    call add(describe_points)
    call add(describe_coordinates)
    call add(describe_lagrange)
    call add(describe_equilibrium)
    call add(describe_linkage)
    call add(describe_limits)
    call add(describe_balance)
    call add(describe_hung_balance)
    call add(describe_geometry)
    call add(describe_response)
    call add(describe_strains)
    call add(describe_peaks)
    call add(describe_drive)
    call add(describe_drives_as_drive)
    call add(describe_drives)
    call add(describe_torque)
    call add(describe_validity)
    call add(describe_stability)
    call add(describe_intervals)
    call add(describe_campbell)
    call add(describe_transient)
    call add(describe_motion)
    call add(describe_linkage_motion)
    call add(describe_summary)
    list = room(:count)

  contains

    subroutine add(describe)
      interface
        subroutine describe(report)
          import :: report_record_t
          type(report_record_t), intent(out) :: report
        end subroutine describe
      end interface

      count = count + 1
      call describe(room(count))
    end subroutine add

  end subroutine list_reports

  !> The records of all reports, which the reader of decks takes.
  function reports() result(kinds)
    type(report_kind_t), allocatable :: kinds(:)

    type(report_record_t), allocatable :: list(:)

    call list_reports(list)
    kinds = list%kind
  end function reports

  !> The tables that a model requests, with the columns that its deck has: the first table of every
  !! report, in the order of all reports, then the second ones.
  subroutine tables_of(model, tables)
    type(model_t), intent(in) :: model !! of the first variant
    type(any_table_t), allocatable, intent(out) :: tables(:)

    type(report_record_t), allocatable :: list(:)
    integer :: i, t, number

    call list_reports(list)
    allocate (tables(0))
    do t = 1, maxval([(size(list(i)%tables), i=1, size(list))])
      do i = 1, size(list)
        number = report_number(model, list(i)%kind%name)
        if (number == 0 .or. t > size(list(i)%tables)) cycle
        associate (kind => model%reports(number)%kind)
          ! A card may do without some of the tables.
          if (kind%tables(t)%name == "" .or. kind%linkages /= list(i)%kind%linkages) cycle
        end associate
        tables = [tables, list(i)%tables(t)]
        associate (table => tables(size(tables))%table)
          call table%fit(model, table%columns)
        end associate
      end do
    end do
  end subroutine tables_of

  !> The tables of a report, with the columns that a deck has.
  subroutine tables_of_report(kind, model, tables)
    type(report_kind_t), intent(in) :: kind !! of a report that the model asks for
    type(model_t), intent(in) :: model      !! with its drives
    type(any_table_t), allocatable, intent(out) :: tables(:)

    type(report_record_t), allocatable :: list(:)
    integer :: i, t

    call list_reports(list)
    do i = 1, size(list)
      if (list(i)%kind%name /= kind%name .or. list(i)%kind%linkages /= kind%linkages) cycle
      tables = list(i)%tables
      do t = 1, size(tables)
        associate (table => tables(t)%table)
          call table%fit(model, table%columns)
        end associate
      end do
    end do
  end subroutine tables_of_report

end module report_table
