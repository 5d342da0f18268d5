# A motion from its start: angular velocities, torque of the motor and energies against time.
#   gnuplot -c motion.gp motion.dat OUT [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("motion.gp")]."style.gp"
table = ARG1; out = ARG2; figure = argument(3); remark = argument(4)

eval answer(table, "facts")
headline = numbered(figure, "Motion of the linkage under its motor and loads")
note = "work: done by the motor less that taken by the loads;  kinetic + potential − work is constant"
source_of(k) = table
picked = "1"
x = "field('time')"
x_axis = "eval abscissa(low_time, high_time); set xlabel abscissa_title('time', unit_time, low_time, high_time)"
panels = 3
array axis_of[3] = ["angular velocity", "motor torque", "energy"]
array unit_of[3] = [unit_omega2, unit_torque, unit_kinetic]
array curves_of[3] = ["field('omega2') field('omega4')", "field('torque')", "field('kinetic') field('potential') field('work')"]
array titles_of[3] = ["'crank ω₂' 'follower ω₄'", "motor", "kinetic potential work"]
call plots."panels.gp"
eval close
