! src/studies/ - from a request to a result, a file for each study; no deck, no table.
! In: a linkage or a structure, positions, a request. Out: a component of `study_results_t`. Begin
! with `find_all_positions` in `position_study.f90`; then a study, such as `find_joints` in
! `src/studies/rigid/joint_study.f90`. Others: `src/studies/balance`, `src/studies/elastic`.
! Not here: which studies a run makes (`src/runs/studies`), the methods (`src/linkage`,
! `src/vibration`, `src/response`).

!> Results of all studies of one variant; parts that no report needs are empty.
module study_results
  use balance_study, only: balance_result_t
  use body_points, only: point_coefficients_t
  use campbell_types, only: campbell_t
  use equilibrium_study, only: equilibria_t
  use friction_study, only: friction_result_t
  use geometry_study, only: geometry_result_t
  use harmonics_study, only: harmonics_result_t
  use home_ranges, only: home_range_t
  use inertia_study, only: inertia_result_t
  use joint_study, only: joints_result_t
  use kinematics_study, only: transmission_range_t
  use lagrange_study, only: lagrange_result_t
  use limits_study, only: branches_t, limits_result_t
  use motion_study, only: motion_result_t
  use linkage_study, only: linkage_class_t
  use loci_study, only: loci_t
  use positions, only: positions_t
  use response_types, only: response_t
  use stability_types, only: intervals_t, stability_t
  use sizing_study, only: sizing_result_t
  use sweep_extremes, only: sweep_extremes_t
  use sweeps, only: sweep_t
  use transient_types, only: transient_t
  implicit none (type, external)
  private

  public :: study_results_t

  type :: study_results_t
    type(positions_t) :: positions
    type(linkage_class_t) :: class
    type(home_range_t) :: home
    type(transmission_range_t) :: transmission              !! of a four-bar
    type(geometry_result_t) :: geometry
    type(geometry_result_t) :: motion_places                !! at the instants of a motion
    type(inertia_result_t) :: inertia
    type(point_coefficients_t), allocatable :: points(:, :) !! (points, states)
    type(joints_result_t) :: joints
    type(friction_result_t) :: friction
    type(lagrange_result_t) :: lagrange
    type(balance_result_t) :: balance
    type(harmonics_result_t) :: harmonics
    type(limits_result_t) :: limits
    type(branches_t) :: branches                            !! of a four-bar
    type(equilibria_t) :: equilibria
    type(sizing_result_t) :: sizing
    type(motion_result_t) :: motion
    type(sweep_t) :: sweep
    type(sweep_extremes_t) :: extremes                      !! of the sweep
    type(loci_t) :: loci
    type(response_t) :: response
    type(stability_t) :: stability
    type(intervals_t) :: intervals
    type(campbell_t) :: campbell
    type(transient_t) :: transient
  end type study_results_t

end module study_results
