!> The table of reports: names, columns, needs, and the procedures that compute and write each.
!!
!! A new report is a record in `reports`, a case in `find_study` for each study of its own, a
!! component of `study_results_t` for the result, and a case each for its notes and its rows.
!!
!! Rows are made in items: a position at a speed, or all rows of a small table. Items may be made
!! on several threads at a time; therefore nothing that `add_item_rows` calls has a result of
!! deferred length, for which gfortran 12 has one place for all threads.
module report_table
  use balance_report, only: add_balance, add_harmonics, add_hung_balance, append_balanced_notes, &
    append_harmonics_notes, append_hung_notes, balance_notes, harmonics_notes, harmonics_words
  use balance_requests, only: balance_request_of
  use balance_study, only: balance_request_t, find_balance, find_hung_balance, has_balanced
  use bearings_report, only: add_bearings, bearings_notes
  use campbell_report, only: add_campbell, add_critical, campbell_notes, campbell_words, &
    critical_notes
  use drive_motions, only: place_columns, table_place
  use drive_positions, only: shown_crank
  use drive_report, only: add_drive, drive_notes
  use equilibrium_report, only: add_equilibria, add_potential, equilibrium_notes, &
    equilibrium_words, potential_notes
  use equilibrium_study, only: find_equilibria
  use errors, only: error_t
  use frame_report, only: add_frame, frame_notes
  use frequency_report, only: add_frequencies, add_shapes, drawn_rows, frequency_notes, shape_notes
  use friction_report, only: add_friction, add_holding, friction_notes, &
    holding_notes, holding_words
  use friction_study, only: find_joint_friction
  use friction_words, only: lock_words
  use geometry_report, only: add_geometry, geometry_notes, geometry_words
  use geometry_study, only: find_geometry
  use harmonics_study, only: find_harmonics, highest_harmonic
  use inertia_report, only: add_inertia, has_moments, inertia_notes, inertia_owners
  use inertia_study, only: find_inertia_loads
  use intervals_report, only: add_intervals, interval_words, intervals_notes
  use joint_study, only: find_joints
  use joints_report, only: add_drives, add_joints, add_shaking, drive_columns, &
    drive_names, drives_notes, joint_owners, joints_notes
  use kinds, only: wp
  use limits_report, only: add_limits
  use limits_study, only: find_limits
  use limits_words, only: limits_names, limits_notes
  use kinematics_report, only: add_kinematics, kinematics_notes
  use kinematics_study, only: find_kinematics
  use lagrange_report, only: add_lagrange, lagrange_notes
  use lagrange_study, only: find_lagrange_terms
  use linkage_motion_report, only: add_linkage_motion, linkage_motion_columns, &
    linkage_motion_count, linkage_motion_notes
  use linkage_report, only: add_linkage, linkage_remarks, linkage_words
  use linkage_study, only: find_linkage
  use links_report, only: add_links, add_pins, links_notes, pin_names, pins_notes
  use locked_rows, only: is_locked_at, lock_at
  use loci_report, only: add_loci, loci_notes, locus_words
  use mesh_report, only: add_mesh, mesh_notes
  use models, only: balances, drives_length, has_law, is_damped, is_four_bar, model_t, &
    report_number
  use motion_forces_report, only: add_motion_forces, motion_forces_notes
  use motion_pins_report, only: add_motion_pins, motion_pins_notes
  use motion_report, only: add_motion, motion_columns, motion_columns_of, motion_notes, motion_words
  use peaks_report, only: add_peaks, peaks_notes
  use points_report, only: add_points, point_names, points_notes
  use points_study, only: find_points
  use position_loads, only: elastic_division_t, fail_everywhere, find_division, take_failures
  use reactions_report, only: add_reactions, reactions_notes
  use reactions_study, only: find_reactions
  use report_kinds, only: column_kind_t, columns_of, four_bars, key_count, other_linkages, &
    report_kind_t, table_kind_t
  use response_notes, only: add_failed_speed, has_response
  use response_report, only: add_response, response_notes_of, response_point_names
  use sizing_report, only: add_sizing, sizing_names, sizing_notes
  use sizing_requests, only: sizing_request_of
  use sizing_study, only: find_sizing
  use stability_report, only: add_stability, stability_notes, stability_words
  use strains_report, only: add_strains, gauge_names, strains_notes
  use summary_report, only: add_summary, add_summary_columns, summary_notes
  use table_columns, only: choose_columns, name_list_t, new_table_layout, table_factor, &
    table_layout_t
  use table_rows, only: add_failed_row, add_gap, rows_t
  use text, only: string_t
  use tokens, only: token_texts
  use transient_report, only: add_transient, gauge_history_notes, transient_notes
  use units, only: from_si
  use validity_report, only: add_validity, validity_notes
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: table_plan_t, reports, study_names, find_study, plan_table, table_notes, &
    add_item_rows, &
    table_in_units

  !> A table as it is to be written.
  type :: table_plan_t
    character(len=:), allocatable :: name
    type(table_layout_t) :: layout
    integer :: items = 0                          !! pieces in which its rows are found
    integer, private :: positions = 0, speeds = 0 !! of a table with items for each
    integer, allocatable, private :: drawn(:, :)  !! (position and speed, items) of shapes
  end type table_plan_t

  !> All studies in the order in which they are made: some use the results of others. The last
  !! are made by `variant_runs`, some of them block by block or step by step.
  character(len=*), parameter :: study_names(22) = [character(len=12) :: "kinematics", "geometry", &
    "inertia", "points", "reactions", "joints", "friction", "lagrange", "balance", "harmonics", &
    "linkage", "limits", "sizing", "equilibrium", "response", &
    "stability", "intervals", "campbell", "transient", "motion", "frequencies", "loci"]

  !> Tables of the elastic response with rows for every position.
  character(len=*), parameter :: response_tables(4) = [character(len=8) :: "response", "strains", &
    "drive", "torque"]

  !> Tables of linkages that are no four-bars, with rows of their own for every position.
  character(len=*), parameter :: general_tables(5) = [character(len=10) :: "kinematics", &
    "reactions", "drive", "shaking", "balance"]

  !> Where a report has one table only.
  type(table_kind_t), parameter :: no_table = table_kind_t()

  !> Beside `motion.dat` where the card asks for it.
  type(table_kind_t), parameter :: motion_pins = table_kind_t("motion_pins", &
    "time:time pin:name x,y:length")

  !> Of linkages that are no four-bars, where the card asks for forces.
  type(table_kind_t), parameter :: motion_forces = table_kind_t("motion_forces", &
    "time:time pin,link:name fx,fy:force moment:moment")

  !> A record has name, pattern and default of its card, one line of help, studies, what it needs,
  !! tables with their columns.
  type(report_kind_t), parameter :: reports(*) = [ &
    report_kind_t(name="kinematics", help="how the links move", &
      pattern="REPORT kinematics [columns=]", &
      studies="kinematics", positions=.true., reserved=.true., linkages=four_bars, numbers=11, &
      tables=[ &
      table_kind_t("kinematics", "speed:speed crank,theta3,theta4:deg omega3,omega4:rate "// &
      "alpha3,alpha4:rad/s2 Ax,Ay,Bx,By:length transmission_angle:deg"), no_table, no_table]), &
    report_kind_t(name="kinematics", help="of other linkages: how the links move", &
      pattern="REPORT kinematics [columns=]", &
      studies="kinematics", positions=.true., reserved=.true., linkages=other_linkages, tables=[ &
      table_kind_t("kinematics", "speed:speed crank:deg link:name theta:deg omega:rate "// &
      "alpha:rad/s2"), no_table, no_table]), &
    report_kind_t(name="pins", help="paths, velocities and accelerations of the pins", &
      pattern="REPORT pins [columns=]", &
      studies="kinematics", positions=.true., tables=[ &
      table_kind_t("pins", "speed:speed crank:deg pin:name x,y:length vx,vy:velocity "// &
      "ax,ay:acceleration"), no_table, no_table]), &
    report_kind_t(name="inertia", help="masses, their accelerations and inertia forces", &
      studies="inertia", positions=.true., masses=.true., reserved=.true., numbers=46, &
      linkages=four_bars, tables=[ &
      table_kind_t("inertia", "speed:speed crank:deg mass:# link:name x,y:length "// &
      "ax,ay:acceleration Fx,Fy:force m:mass moment?:moment"), no_table, no_table]), &
    report_kind_t(name="inertia", help="of other linkages: masses and their inertia forces", &
      studies="inertia", positions=.true., masses=.true., reserved=.true., &
      linkages=other_linkages, tables=[ &
      table_kind_t("inertia", "speed:speed crank:deg mass:# link:name x,y:length "// &
      "ax,ay:acceleration Fx,Fy:force m:mass moment:moment"), no_table, no_table]), &
    report_kind_t(name="mesh", help="the finite element model", &
      positions=.true., beams=.true., reserved=.true., linkages=four_bars, tables=[ &
      table_kind_t("mesh", "crank:deg link:name element,node_a,node_b:# xa,ya,xb,yb:length "// &
      "mass_a,mass_b:mass"), no_table, no_table]), &
    report_kind_t(name="frequencies", help="natural frequencies with estimated errors", &
      pattern="REPORT frequencies [columns=]", &
      studies="frequencies", positions=.true., beams=.true., frequencies=.true., &
      reserved=.true., tables=[ &
      table_kind_t("frequencies", "speed:speed crank:deg f*:Hz error*:-"), no_table, no_table]), &
    report_kind_t(name="shapes", help="mode shapes along the links", &
      pattern="REPORT shapes [crank=a,b,...] [speed=...] [points=]", default="points=21", &
      studies="frequencies", positions=.true., beams=.true., frequencies=.true., &
      reserved=.true., tables=[ &
      table_kind_t("shapes", "speed:speed crank:deg mode:# frequency:Hz link:name "// &
      "s,x,y:length ux,uy:mass^-1/2 rotation:rotation"), no_table, no_table]), &
    report_kind_t(name="branches", help="frequencies followed by their shapes", &
      studies="frequencies loci", positions=.true., beams=.true., frequencies=.true., &
      reserved=.true., tables=[ &
      table_kind_t("branches", "speed:speed crank:deg branch,mode:# frequency:Hz mac:- "// &
      "event:name"), no_table, no_table]), &
    report_kind_t(name="reactions", help="forces in the pins, torque, shaking force and moment", &
      pattern="REPORT reactions [columns=]", &
      studies="reactions", positions=.true., masses=.true., linkages=four_bars, numbers=48, &
      tables=[ &
      table_kind_t("reactions", "speed:speed crank:deg "// &
      "O2x,O2y,A2x,A2y,A3x,A3y,B3x,B3y,B4x,B4y,O4x,O4y:force torque:moment "// &
      "shaking_x,shaking_y:force shaking_moment:moment"), no_table, no_table]), &
    report_kind_t(name="reactions", help="of other linkages: forces and moments in all joints", &
      pattern="REPORT reactions [columns=]", &
      studies="joints", positions=.true., masses=.true., linkages=other_linkages, tables=[ &
      table_kind_t("reactions", "speed:speed crank:deg pin,link:name fx,fy:force "// &
      "moment:moment"), no_table, no_table]), &
    report_kind_t(name="bearings", help="forces in the joints, in the axes of the links too", &
      pattern="REPORT bearings [columns=]", &
      studies="joints", positions=.true., masses=.true., numbers=82, tables=[ &
      table_kind_t("bearings", "speed:speed crank:deg pin,link:name "// &
      "fx,fy,axial,transverse,magnitude:force angle:deg"), no_table, no_table]), &
    report_kind_t(name="frame", help="shaking force, and force and moment on the frame", &
      pattern="REPORT frame [about=x,y|pin] [columns=]", studies="joints", positions=.true., &
      masses=.true., numbers=82, tables=[ &
      table_kind_t("frame", "speed:speed crank:deg shaking_x,shaking_y:force "// &
      "shaking_moment:moment frame_x,frame_y:force frame_moment:moment"), no_table, no_table]), &
    report_kind_t(name="friction", help="joints that rub: forces, losses, self-locking", &
      studies="friction", positions=.true., masses=.true., numbers=82, tables=[ &
      table_kind_t("friction", "speed:speed crank:deg pin,link:name force:force "// &
      "sliding:velocity friction:force moment:moment lost:power"), &
      table_kind_t("holding", "crank:deg forward,backward:moment verdict:name"), no_table]), &
    report_kind_t(name="sizing", help="peaks and means of drives and bearings, the flywheel", &
      pattern="REPORT sizing [fluctuation=]", studies="sizing", masses=.true., tables=[ &
      table_kind_t("sizing", "speed:speed part,pin,quantity:name value:see_unit unit:name "// &
      "crank:deg error:-"), no_table, no_table]), &
    report_kind_t(name="points", help="paths, velocities and accelerations of points", &
      pattern="REPORT points [columns=]", &
      studies="points", positions=.true., tables=[ &
      table_kind_t("points", "speed:speed crank:deg point:name x,y:length vx,vy:velocity "// &
      "ax,ay:acceleration"), no_table, no_table]), &
    report_kind_t(name="lagrange", help="the torque from energies", &
      pattern="REPORT lagrange [columns=]", &
      studies="lagrange", positions=.true., masses=.true., numbers=5, tables=[ &
      table_kind_t("lagrange", "speed:speed crank:deg M,dM:inertia "// &
      "V,gravity,load,torque:moment kinetic,potential:energy"), no_table, no_table]), &
    report_kind_t(name="equilibrium", help="where the linkage rests without its drive", &
      studies="equilibrium", masses=.true., tables=[ &
      table_kind_t("equilibrium", "crank:deg verdict:name potential:energy "// &
      "stiffness:turning_stiffness frequency:Hz error:-"), &
      table_kind_t("potential", "crank:deg torque:moment potential:energy"), no_table]), &
    report_kind_t(name="linkage", help="class, limits and special positions", &
      studies="linkage", linkages=four_bars, tables=[ &
      table_kind_t("linkage", "branch,event:name crank,theta3,theta4,transmission_angle:deg"), &
      no_table, no_table]), &
    report_kind_t(name="linkage", help="of other linkages: ranges, swings, strokes, time ratios", &
      studies="limits", linkages=other_linkages, tables=[ &
      table_kind_t("linkage", "part,quantity:name crank:deg value:see_unit unit:name"), &
      no_table, no_table]), &
    report_kind_t(name="balance", help="shaking force, counterweights, harmonics", &
      studies="reactions balance harmonics", positions=.true., masses=.true., numbers=98, &
      linkages=four_bars, tables=[ &
      table_kind_t("balance", "speed:speed crank:deg xG,yG:length shaking_x,shaking_y:force "// &
      "shaking_moment,torque:moment balanced_x,balanced_y:force "// &
      "balanced_moment,balanced_torque:moment"), &
      table_kind_t("harmonics", "speed:speed linkage,quantity:name largest,rms,mean:- h*:- "// &
      "phase*:deg"), no_table]), &
    report_kind_t(name="balance", help="of other linkages: shaking force, counterweights", &
      studies="joints balance harmonics", positions=.true., masses=.true., &
      linkages=other_linkages, tables=[ &
      table_kind_t("balance", "speed:speed crank:deg xG,yG:length shaking_x,shaking_y:force "// &
      "shaking_moment,torque:moment balanced_x?,balanced_y?:force "// &
      "balanced_moment?,balanced_torque?:moment"), &
      table_kind_t("harmonics", "speed:speed linkage,quantity:name largest,rms,mean:- h*:- "// &
      "phase*:deg"), no_table]), &
    report_kind_t(name="geometry", help="where pins, links and points are, for drawings", &
      pattern="REPORT geometry crank=a,b,...", offered=.false., studies="geometry", tables=[ &
      table_kind_t("geometry", "crank:deg link,part,place:name x,y:length"), no_table, no_table]), &
    report_kind_t(name="response", help="how far pins and points are from where rigid links are", &
      pattern="REPORT response [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", positions=.true., response=.true., tables=[ &
      table_kind_t("response", "speed:speed crank:deg point:name ux,uy:length rotation:deg "// &
      "error:-"), no_table, no_table]), &
    report_kind_t(name="strains", help="strains, forces and stresses at gauges", &
      pattern="REPORT strains [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", positions=.true., response=.true., tables=[ &
      table_kind_t("strains", "speed:speed crank:deg gauge:name axial_strain,bending_strain:- "// &
      "moment:moment axial_force,shear_force:force stress:stress error:-"), no_table, no_table]), &
    report_kind_t(name="peaks", help="largest strain, stress and deflection of every link", &
      pattern="REPORT peaks [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", response=.true., tables=[ &
      table_kind_t("peaks", "speed:speed link:name strain:- strain_at:length "// &
      "strain_crank:deg stress:stress stress_at:length stress_crank:deg "// &
      "deflection,deflection_at:length deflection_crank:deg power:power error:-"), no_table, &
      no_table]), &
    report_kind_t(name="drive", help="the driving torque with its parts, and the power", &
      pattern="REPORT drive [accuracy=]", default="accuracy=1e-6", studies="response", &
      positions=.true., response=.true., linkages=four_bars, tables=[ &
      table_kind_t("drive", "speed:speed crank:deg rigid,linear,quadratic,total:moment "// &
      "power:power error:-"), no_table, no_table]), &
    report_kind_t(name="drive", help="of other linkages: the drives, shaking force and moment", &
      studies="joints", positions=.true., masses=.true., linkages=other_linkages, tables=[ &
      table_kind_t("drive", "speed:speed crank:deg drive:name position:deg rate:rate "// &
      "force:moment"), &
      table_kind_t("shaking", "speed:speed crank:deg shaking_x,shaking_y:force "// &
      "shaking_moment:moment"), no_table]), &
    report_kind_t(name="torque", help="the torque of the elastic linkage, with its parts", &
      pattern="REPORT torque [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", positions=.true., response=.true., tables=[ &
      table_kind_t("torque", "speed:speed crank:deg rigid,linear,quadratic,total:moment "// &
      "power:power error:-"), no_table, no_table]), &
    report_kind_t(name="validity", help="whether the equations of the response hold", &
      pattern="REPORT validity [accuracy=]", default="accuracy=1e-6", studies="response", &
      response=.true., tables=[ &
      table_kind_t("validity", "speed:speed link:name deflection,load,quadratic:- "// &
      "out_of_plane:Hz distance,error:-"), no_table, no_table]), &
    report_kind_t(name="stability", help="whether vibrations of the running linkage grow", &
      pattern="REPORT stability [accuracy=]", default="accuracy=1e-6", studies="stability", &
      response=.true., tables=[ &
      table_kind_t("stability", "speed:speed mode:# turns,growth:- frequency:Hz signature:# "// &
      "error:- verdict:name"), no_table, no_table]), &
    report_kind_t(name="intervals", help="all speeds at which vibrations grow", &
      pattern="REPORT intervals [growth=] [accuracy=]", default="growth=1e-4 accuracy=1e-5", &
      studies="intervals", response=.true., tables=[ &
      table_kind_t("intervals", "from,to:speed kind,modes:name largest_growth,growth_error:- "// &
      "at,error:speed"), no_table, no_table]), &
    report_kind_t(name="campbell", help="frequencies against the speed, and critical speeds", &
      pattern="REPORT campbell [accuracy=]", default="accuracy=1e-6", studies="campbell", &
      response=.true., tables=[ &
      table_kind_t("campbell", "speed:speed mode:# least,mean,greatest:Hz band_error:- "// &
      "floquet:Hz growth,error:- verdict:name"), &
      table_kind_t("critical", "speed:rate speed_error:- line,mode:# frequency:Hz "// &
      "excitation:length amplitude?:length growth,error:-"), no_table]), &
    report_kind_t(name="transient", help="the elastic motion in time from a state", &
      pattern="REPORT transient turns= [crank=0] [start=rest|steady] "// &
      "[perturb=mode,amplitude[,velocity]] [instants=] [accuracy=]", &
      default="crank=0 start=rest instants=72 accuracy=1e-3", &
      studies="transient", response=.true., tables=[ &
      table_kind_t("transient", "speed:speed time:time crank:deg point:name ux,uy:length "// &
      "rotation:deg error:-"), &
      table_kind_t("gauges", "speed:speed time:time crank:deg gauge:name "// &
      "axial_strain,bending_strain:- moment:moment axial_force:force stress:stress error:-"), &
      no_table]), &
    report_kind_t(name="motion", help="the motion under motor and loads", &
      pattern="REPORT motion crank= [speed=0] end= step= "// &
      "[columns=accelerations,forces,power] [pins=no|yes] [change_points=stop|through]", &
      default="speed=0 pins=no", studies="motion", masses=.true., &
      linkages=four_bars, tables=[ &
      table_kind_t("motion", motion_columns), motion_pins, no_table]), &
    report_kind_t(name="motion", help="of other linkages: the motion under motor and loads", &
      pattern="REPORT motion crank= [speed=0] end= step= "// &
      "[columns=accelerations,forces,power] [pins=no|yes] [change_points=stop|through]", &
      default="speed=0 pins=no", studies="motion", masses=.true., &
      linkages=other_linkages, tables=[ &
      table_kind_t("motion", "time:time position*:deg rate*:rate torque:moment "// &
      "kinetic,potential,work,energy_error:energy acceleration*:rad/s2 "// &
      "motor_power,gear_loss,load_power:power"), motion_pins, motion_forces]), &
    report_kind_t(name="summary", help="a row a variant: least, mean and greatest values", &
      pattern="REPORT summary of=f1,torque,... [accuracy=]", positions=.true., tables=[ &
      table_kind_t("summary", "rows,failed:#", .false.), no_table, no_table])]

contains

  !> Makes a study that is made in one piece. The studies whose results it uses are made before.
  subroutine find_study(study, threads, variant)
    character(len=*), intent(in) :: study !! name
    integer, intent(in) :: threads       !! on which it is computed
    type(variant_results_t), intent(inout) :: variant !! that gets the result

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    type(balance_request_t), allocatable :: request !! absent: to cancel the shaking force
    type(elastic_division_t), allocatable :: division !! absent: statics tells the forces
    type(error_t), allocatable :: failure
    integer :: i

    associate (linkage => variant%mechanism%linkage, elements => variant%mechanism%load_elements, &
        model => variant%model, points => variant%mechanism%points, found => variant%found)
      if (has_law(model)) then
        ! There is a state for every instant.
        speeds = model%law_rates(1:1, :)
        accelerations = model%law_rates(2:2, :)
      else if (allocated(found%positions%states)) then
        speeds = spread(model%speed%value, 2, size(found%positions%states))
        allocate (accelerations, mold=speeds)
        accelerations = model%acceleration
      end if
      if (study == "sizing") then
        call find_division(variant%mechanism%structure_t, division, found%sizing%error)
        if (allocated(found%sizing%error)) return
      else if (any(study == [character(len=8) :: "joints", "friction", "lagrange"])) then
        call find_division(variant%mechanism%structure_t, division, failure, &
          found%positions%states%crank)
        if (allocated(failure)) then
          call fail_everywhere(failure, found%positions)
          return
        end if
      end if
      select case (study)
      case ("kinematics")
        if (variant%mechanism%is_four_bar) call find_kinematics(linkage, found%positions, threads, &
          found%kinematics)
      case ("inertia")
        call find_inertia_loads(linkage, elements, found%positions, threads, found%inertia)
      case ("points")
        call find_points(linkage, points%body, &
          reshape([(points(i)%place, i=1, size(points))], [2, size(points)]), found%positions, &
          threads, found%points)
      case ("geometry")
        call find_geometry(linkage, points%body, &
          reshape([(points(i)%place, i=1, size(points))], [2, size(points)]), &
          model%reports(report_number(model, "geometry"))%crank%value, threads, found%geometry)
      case ("reactions")
        call find_reactions(linkage, elements, found%positions, threads, found%reactions, &
          speeds, accelerations)
      case ("joints")
        call find_joints(linkage, elements, found%positions, threads, found%joints, &
          speeds, accelerations, division)
        call take_failures(found%joints%outcome, found%positions)
      case ("friction")
        call find_joint_friction(linkage, elements, found%positions, threads, speeds, &
          accelerations, found%friction, division)
        call take_failures(found%friction%outcome, found%positions)
      case ("lagrange")
        call find_lagrange_terms(linkage, elements, found%positions, threads, found%lagrange, &
          speeds, accelerations, division)
        call take_failures(found%lagrange%outcome, found%positions)
      case ("balance")
        if (balances(model)) allocate (request, source=balance_request_of(model, &
          variant%mechanism))
        if (variant%mechanism%is_four_bar) then
          call find_balance(linkage, elements, found%positions, threads, found%balance, request, &
            speeds, accelerations)
        else
          call find_hung_balance(linkage, elements, found%positions, threads, found%balance, &
            request, speeds, accelerations)
        end if
      case ("harmonics")
        if (allocated(found%balance%partial)) then
          call find_harmonics(linkage, elements, model%speed%value, model%acceleration, threads, &
            found%harmonics, found%balance%partial%linkage)
        else
          call find_harmonics(linkage, elements, model%speed%value, model%acceleration, threads, &
            found%harmonics)
        end if
      case ("linkage")
        call find_linkage(linkage, found%linkage)
      case ("sizing")
        call find_sizing(linkage, elements, sizing_request_of(model), threads, found%sizing, &
          division)
      case ("limits")
        call find_limits(linkage, positions_of_deck(model), found%limits)
      case ("equilibrium")
        call find_equilibria(linkage, elements, positions_of_deck(model), found%equilibria)
      end select
    end associate
  end subroutine find_study

  !> Positions of the first drive that the deck names: on CRANK, or at the start of a motion.
  pure function positions_of_deck(model) result(positions)
    type(model_t), intent(in) :: model
    real(wp), allocatable :: positions(:) !! [deg] or [m]

    integer :: number

    positions = model%crank%value
    number = report_number(model, "motion")
    if (number > 0) positions = [positions, model%reports(number)%start_angle]
  end function positions_of_deck

  !> Columns and items of a table.
  subroutine plan_table(table, variant, plan)
    type(table_kind_t), intent(in) :: table         !! of a requested report
    type(variant_results_t), intent(in) :: variant  !! with its results
    type(table_plan_t), intent(out) :: plan         !! for `add_item_rows`

    type(name_list_t) :: names(4)
    integer :: count
    logical :: optional

    plan%name = trim(table%name)
    names(1)%column = ""
    names(2)%column = ""
    names(3)%column = ""
    names(4)%column = ""
    count = 0
    optional = .false.
    plan%speeds = size(variant%model%speed%value)
    plan%positions = size(variant%found%positions%crank)
    plan%items = plan%positions*plan%speeds
    select case (plan%name)
    case ("kinematics")
      names(1) = link_names(variant)
    case ("pins")
      names(1) = pin_names(variant)
    case ("drive")
      names(1) = drive_names(variant)
    case ("inertia")
      names(1) = inertia_owners(variant)
      optional = has_moments(variant)
    case ("mesh")
      names(1) = link_names(variant)
      plan%items = plan%positions
    case ("frequencies")
      count = variant%model%modes
      plan%speeds = size(variant%found%sweep%request%speed)
      plan%items = plan%positions*plan%speeds
    case ("shapes")
      names(1) = link_names(variant)
      plan%drawn = drawn_rows(variant)
      plan%items = size(plan%drawn, 2)
    case ("branches")
      names(1) = locus_words()
      plan%items = 1
    case ("points")
      names(1) = point_names(variant)
    case ("reactions", "bearings")
      names(1) = pin_names(variant)
      names(2) = joint_owners(variant)
    case ("friction")
      names(1) = pin_names(variant)
      names(2) = joint_owners(variant)
    case ("holding")
      names(1) = holding_words()
      plan%items = plan%positions
    case ("geometry")
      names(:3) = geometry_words(variant)
      plan%items = size(variant%found%geometry%crank)
    case ("linkage")
      names(:2) = linkage_words()
      if (.not. variant%mechanism%is_four_bar) names(:3) = limits_names(variant)
      plan%items = 1
    case ("sizing")
      names = sizing_names(variant)
      plan%items = 1
    case ("equilibrium")
      names(1) = equilibrium_words()
      plan%items = 1
    case ("potential")
      plan%items = 1
    case ("balance")
      if (.not. variant%mechanism%is_four_bar) optional = has_balanced(variant%found%balance)
    case ("harmonics")
      names(:2) = harmonics_words()
      count = highest_harmonic
      plan%items = 1
    case ("motion")
      names(1) = motion_words()
      count = linkage_motion_count(variant%model)
      plan%items = 1
    case ("motion_pins")
      names(1) = pin_names(variant)
      plan%items = 1
    case ("motion_forces")
      names(1) = pin_names(variant)
      names(2) = joint_owners(variant)
      plan%items = 1
    case ("transient")
      names(1) = response_point_names(variant)
      plan%items = plan%speeds
    case ("gauges")
      names(1) = gauge_names(variant)
      plan%items = plan%speeds
    case ("response")
      names(1) = response_point_names(variant)
    case ("strains")
      names(1) = gauge_names(variant)
    case ("peaks", "validity")
      names(1) = link_names(variant)
      plan%items = plan%speeds
    case ("campbell")
      names(1) = campbell_words()
      plan%items = plan%speeds
    case ("critical")
      optional = variant%found%campbell%damped
      plan%items = 1
    case ("stability")
      names(1) = stability_words()
      plan%items = plan%speeds
    case ("intervals")
      names(:2) = interval_words()
      plan%items = 1
    case ("summary")
      plan%items = 1
    end select
    call new_table_layout(table, variant%model%outputs, count, optional, names, plan%layout)
    if (plan%name == "summary") call add_summary_columns(variant%model, plan%layout)
    call choose_if_asked(table, variant%model, plan%layout)
  end subroutine plan_table

  !> Leaves a table the columns that its report asks for.
  subroutine choose_if_asked(table, model, layout)
    type(table_kind_t), intent(in) :: table
    type(model_t), intent(in) :: model
    type(table_layout_t), intent(inout) :: layout

    type(column_kind_t), allocatable :: columns(:)
    integer :: number

    ! The first table of a report has its name.
    number = report_number(model, trim(table%name))
    if (number == 0) return
    if (.not. allocated(model%reports(number)%columns)) return
    call columns_of(table, columns)
    call choose_columns(layout, key_count(columns), token_texts(model%reports(number)%columns))
  end subroutine choose_if_asked

  !> The names in a column `link`.
  pure function link_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant
    type(name_list_t) :: list

    list%column = "link"
    list%names = variant%mechanism%names
  end function link_names

  !> The remarks at the head of a table.
  subroutine table_notes(table, variant, notes)
    character(len=*), intent(in) :: table                !! name
    type(variant_results_t), intent(in) :: variant       !! with its results
    type(string_t), allocatable, intent(out) :: notes(:) !! a line each

    if (.not. variant%mechanism%is_four_bar) then
      select case (table)
      case ("kinematics")
        call links_notes(variant, notes)
        return
      case ("reactions")
        call joints_notes(variant, notes)
        return
      case ("motion")
        call linkage_motion_notes(variant, notes)
        return
      case ("linkage")
        call limits_notes(variant, notes)
        return
      case ("drive", "shaking", "balance", "harmonics")
        call drives_notes(variant, notes)
        if (table == "balance") call append_hung_notes(variant, notes)
        if (table /= "harmonics") return
        call append_balanced_notes(variant, notes)
        call append_harmonics_notes(variant, notes)
        return
      end select
    end if
    select case (table)
    case ("kinematics")
      call kinematics_notes(variant, notes)
    case ("pins")
      call pins_notes(variant, notes)
    case ("inertia")
      call inertia_notes(variant, notes)
    case ("mesh")
      call mesh_notes(variant, notes)
    case ("frequencies")
      call frequency_notes(variant, notes)
    case ("shapes")
      call shape_notes(variant, notes)
    case ("branches")
      call loci_notes(variant, notes)
    case ("reactions")
      call reactions_notes(variant, notes)
    case ("bearings")
      call bearings_notes(variant, notes)
    case ("friction")
      call friction_notes(variant, notes)
    case ("holding")
      call holding_notes(variant, notes)
    case ("sizing")
      call sizing_notes(variant, notes)
    case ("frame")
      call frame_notes(variant, notes)
    case ("points")
      call points_notes(variant, notes)
    case ("lagrange")
      call lagrange_notes(variant, notes)
    case ("geometry")
      call geometry_notes(variant, notes)
    case ("linkage")
      call linkage_remarks(variant, notes)
    case ("equilibrium")
      call equilibrium_notes(variant, notes)
    case ("potential")
      call potential_notes(variant, notes)
    case ("balance")
      call balance_notes(variant, notes)
    case ("harmonics")
      call harmonics_notes(variant, notes)
    case ("motion")
      call motion_notes(variant, notes)
    case ("motion_pins")
      call motion_pins_notes(notes)
    case ("motion_forces")
      call motion_forces_notes(variant, notes)
    case ("transient")
      call transient_notes(variant, notes)
    case ("gauges")
      call gauge_history_notes(variant, notes)
    case ("response")
      call response_notes_of(variant, notes)
    case ("strains")
      call strains_notes(variant, notes)
    case ("peaks")
      call peaks_notes(variant, notes)
    case ("drive")
      call drive_notes(variant, notes)
    case ("torque")
      call drive_notes(variant, notes)
    case ("validity")
      call validity_notes(variant, notes)
    case ("stability")
      call stability_notes(variant, notes)
    case ("intervals")
      call intervals_notes(variant, notes)
    case ("campbell")
      call campbell_notes(variant, notes)
    case ("critical")
      call critical_notes(variant, notes)
    case ("summary")
      call summary_notes(variant, notes)
    end select
  end subroutine table_notes

  !> The rows of an item.
  subroutine add_item_rows(plan, variant, number, rows)
    type(table_plan_t), intent(in) :: plan         !! by `plan_table`
    type(variant_results_t), intent(in) :: variant !! with its results
    integer, intent(in) :: number                  !! of the item, from 1
    type(rows_t), intent(inout) :: rows            !! to which they are added

    integer :: position, speed

    select case (plan%name)
    case ("geometry")
      call add_geometry(variant, plan%layout, number, rows)
    case ("linkage")
      if (variant%mechanism%is_four_bar) then
        call add_linkage(variant, plan%layout, rows)
      else
        call add_limits(variant, plan%layout, rows)
      end if
    case ("equilibrium")
      call add_equilibria(variant, plan%layout, rows)
    case ("potential")
      call add_potential(variant, plan%layout, rows)
    case ("harmonics")
      call add_harmonics(variant, plan%layout, rows)
    case ("motion")
      if (variant%mechanism%is_four_bar) then
        call add_motion(variant, plan%layout, rows)
      else
        call add_linkage_motion(variant, plan%layout, rows)
      end if
    case ("motion_pins")
      call add_motion_pins(variant, plan%layout, rows)
    case ("motion_forces")
      call add_motion_forces(variant, plan%layout, rows)
    case ("transient", "gauges")
      if (number > 1) call add_gap(rows, 2)
      call add_transient(plan%name, variant, plan%layout, number, rows)
    case ("branches")
      call add_loci(variant, plan%layout, rows)
    case ("sizing")
      call add_sizing(variant, plan%layout, rows)
    case ("peaks", "validity")
      call add_speed(plan%name, variant, plan%layout, number, rows)
    case ("stability")
      call add_stability(variant, plan%layout, number, rows)
    case ("intervals")
      call add_intervals(variant, plan%layout, rows)
    case ("campbell")
      call add_campbell(variant, plan%layout, number, rows)
    case ("critical")
      call add_critical(variant, plan%layout, rows)
    case ("summary")
      call add_summary(variant, plan%layout, rows)
    case ("shapes")
      if (number > 1) call add_gap(rows, 2)
      call add_shapes(variant, plan%layout, plan%drawn(1, number), plan%drawn(2, number), rows)
    case default
      ! One block per speed; within it, position after position.
      position = 1 + mod(number - 1, plan%positions)
      speed = 1 + (number - 1)/plan%positions
      if (position == 1 .and. speed > 1) call add_gap(rows, 2)
      call add_position(plan%name, variant, plan%layout, position, speed, rows)
    end select
  end subroutine add_item_rows

  !> The rows of a speed of the elastic response, or its failure.
  subroutine add_speed(table, variant, layout, speed, rows)
    character(len=*), intent(in) :: table
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed !! number
    type(rows_t), intent(inout) :: rows

    if (.not. has_response(variant, speed)) then
      call add_failed_speed(variant, speed, rows)
    else if (table == "peaks") then
      call add_peaks(variant, layout, speed, rows)
    else
      call add_validity(variant, layout, speed, rows)
    end if
  end subroutine add_speed

  !> The rows of a position and speed of the elastic response. A failed speed has one row, instead
  !! of the first position.
  subroutine add_response_position(table, variant, layout, position, speed, rows)
    character(len=*), intent(in) :: table
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    if (.not. has_response(variant, speed)) then
      if (position == 1) call add_failed_speed(variant, speed, rows)
      return
    end if
    select case (table)
    case ("response")
      call add_response(variant, layout, position, speed, rows)
    case ("strains")
      call add_strains(variant, layout, position, speed, rows)
    case ("drive", "torque")
      call add_drive(variant, layout, position, speed, rows)
    end select
  end subroutine add_response_position

  !> The rows of a position and speed; those of a mesh have no speed.
  subroutine add_position(table, variant, layout, position, speed, rows)
    character(len=*), intent(in) :: table
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    real(wp) :: place(place_columns(variant%model))

    associate (positions => variant%found%positions)
      associate (state => positions%states(positions%state(position)), &
          crank => positions%crank(position))
        if (is_of_response(table, variant%mechanism%is_four_bar)) then
          call add_response_position(table, variant, layout, position, speed, rows)
        else if (table == "frequencies") then
          call add_frequencies(variant, layout, position, speed, rows)
        else if (allocated(state%error) .and. table == "mesh") then
          call add_failed_row(rows, [crank], state%error%text)
        else if (allocated(state%error) .and. table == "holding") then
          call add_failed_row(rows, [shown_crank(variant, crank)], state%error%text)
        else if (allocated(state%error)) then
          place = table_place(variant%model, speed, position)
          place(size(place)) = shown_crank(variant, crank)
          if (has_law(variant%model)) place(1) = from_si(place(1), table_factor("time", &
            variant%model%outputs))
          call add_failed_row(rows, place, state%error%text)
        else if (is_locked_at(variant, table, position, speed)) then
          call add_locked_row(variant, table, position, speed, rows)
        else if (.not. variant%mechanism%is_four_bar .and. any(table == general_tables)) then
          call add_general(table, variant, layout, position, speed, rows)
        else
          select case (table)
          case ("kinematics")
            call add_kinematics(variant, layout, position, speed, rows)
          case ("pins")
            call add_pins(variant, layout, position, speed, rows)
          case ("inertia")
            call add_inertia(variant, layout, position, speed, rows)
          case ("mesh")
            call add_mesh(variant, layout, position, rows)
          case ("reactions")
            call add_reactions(variant, layout, position, speed, rows)
          case ("bearings")
            call add_bearings(variant, layout, position, speed, rows)
          case ("friction")
            call add_friction(variant, layout, position, speed, rows)
          case ("holding")
            call add_holding(variant, layout, position, rows)
          case ("frame")
            call add_frame(variant, layout, position, speed, rows)
          case ("points")
            call add_points(variant, layout, position, speed, rows)
          case ("lagrange")
            call add_lagrange(variant, layout, position, speed, rows)
          case ("balance")
            call add_balance(variant, layout, position, speed, rows)
          end select
        end if
      end associate
    end associate
  end subroutine add_position

  !> Whether a table has a row of the elastic response for every position: `drive` is one of rigid
  !! links but for four-bars.
  pure function is_of_response(table, is_four_bar) result(is)
    character(len=*), intent(in) :: table
    logical, intent(in) :: is_four_bar
    logical :: is

    is = any(table == response_tables) .and. (is_four_bar .or. table /= "drive")
  end function is_of_response

  !> Appends a failed row where friction locks the linkage.
  subroutine add_locked_row(variant, table, position, speed, rows)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: table
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    real(wp) :: place(place_columns(variant%model))
    character(len=:), allocatable :: words

    place = table_place(variant%model, speed, position)
    place(size(place)) = shown_crank(variant, variant%found%positions%crank(position))
    if (has_law(variant%model)) place(1) = from_si(place(1), table_factor("time", &
      variant%model%outputs))
    ! One thread at a time makes texts.
    !$omp critical (one_at_a_time)
    words = lock_words(variant%model, variant%mechanism, lock_at(variant, table, position, speed))
    !$omp end critical (one_at_a_time)
    call add_failed_row(rows, place, words)
  end subroutine add_locked_row

  !> The rows of a position and speed of a linkage that is no four-bar.
  subroutine add_general(table, variant, layout, position, speed, rows)
    character(len=*), intent(in) :: table
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: position, speed !! numbers
    type(rows_t), intent(inout) :: rows

    select case (table)
    case ("kinematics")
      call add_links(variant, layout, position, speed, rows)
    case ("reactions")
      call add_joints(variant, layout, position, speed, rows)
    case ("drive")
      call add_drives(variant, layout, position, speed, rows)
    case ("shaking")
      call add_shaking(variant, layout, position, speed, rows)
    case ("balance")
      call add_hung_balance(variant, layout, position, speed, rows)
    end select
  end subroutine add_general

  !> A table in the units of the first drive: positions of a slider or a ram are lengths. Of a
  !! drive with a law it has the time in its first column.
  pure function table_in_units(table, model) result(fitted)
    type(table_kind_t), intent(in) :: table !! of a report that the model asks for
    type(model_t), intent(in) :: model      !! with its drives
    type(table_kind_t) :: fitted

    fitted = table
    if (table%name == "frequencies" .and. is_damped(model)) fitted%columns = &
      trim(fitted%columns)//" zeta*:-"
    if (table%name == "drive" .and. .not. is_four_bar(model)) fitted%columns = drive_columns(model)
    if (table%name == "motion") then
      fitted%columns = linkage_motion_columns(model)
      if (is_four_bar(model)) fitted%columns = motion_columns_of(model)
    end if
    if (drives_length(model)) call use_lengths(model, fitted)
    ! Tables of positions, not those of speeds.
    if (has_law(model) .and. index(fitted%columns, "speed:") == 1 .and. &
      index(fitted%columns, " time:") == 0 .and. max(index(fitted%columns, " crank:"), &
      index(fitted%columns, " crank,")) > 0) fitted%columns = &
      "time:time "//trim(fitted%columns)
  end function table_in_units

  !> Makes the columns of a table those of a slider or a ram.
  pure subroutine use_lengths(model, fitted)
    type(model_t), intent(in) :: model
    type(table_kind_t), intent(inout) :: fitted

    integer :: at

    ! What turns a crank is a force on a slider, and its inertia a mass.
    if (fitted%name == "holding") fitted%columns = "crank:deg forward,backward:force verdict:name"
    if (fitted%name == "lagrange") fitted%columns = "speed:speed crank:deg M:mass "// &
      "dM:mass_per_length V,gravity,load,torque:force kinetic,potential:energy"
    if (fitted%name == "balance") fitted%columns = "speed:speed crank:deg xG,yG:length "// &
      "shaking_x,shaking_y:force shaking_moment:moment torque:force "// &
      "balanced_x?,balanced_y?:force balanced_moment?:moment balanced_torque?:force"
    if (fitted%name == "potential") fitted%columns = "crank:deg torque:force potential:energy"
    at = index(fitted%columns, "turning_stiffness")
    if (at > 0) fitted%columns = fitted%columns(:at - 1)//"line_stiffness"// &
      trim(fitted%columns(at + 17:))
    at = index(fitted%columns, "crank:deg")
    if (at > 0) fitted%columns = fitted%columns(:at - 1)//"crank:length"// &
      trim(fitted%columns(at + 9:))
    at = index(fitted%columns, "speed:speed")
    if (at > 0) fitted%columns = fitted%columns(:at - 1)//"speed:"//model%speed_unit%name// &
      trim(fitted%columns(at + 11:))
  end subroutine use_lengths

end module report_table
