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

# Of a linkage that is no four-bar: position1, rate1 and so on, of coordinates that a remark names.
coordinates = !of_cycle ? "" : system("sed -n 's/^# *coordinates: \\([^;]*\\).*/\\1/p' ".quoted(table)." | tr ',' '\n' | ".\
    "sed 's/^ *[0-9]* drive *//; s/^ *[0-9]* *//; s/.*/\"&\"/'")
rates_from(k) = k > words(coordinates) || !exists(sprintf("col_rate%d", k)) ? "" : sprintf(" field('rate%d')", k).rates_from(k + 1)
panels = 3
array axis_of[3] = [!of_cycle ? "angular velocity" : words(coordinates) == 1 ? "rate of ".word(coordinates, 1) : "rate", "motor torque", "energy"]
array unit_of[3] = [of_cycle ? unit_rate1 : unit_omega2, unit_torque, unit_kinetic]
array curves_of[3] = [of_cycle ? rates_from(1) : "field('omega2') field('omega4')", "field('torque')", \
    "field('kinetic') field('potential') field('work')"]
array titles_of[3] = [of_cycle ? short_names(coordinates, 1) : "'crank ω₂' 'follower ω₄'", "motor", "kinetic potential work"]
call plots."panels.gp"
eval close
