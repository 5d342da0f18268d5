# A motion from its start (figure.gp): angular velocities, torque of the motor, or behind its gear, and energies against time; positions too, unless all
# there is to see is that the drive turns.

headline = "Motion of the linkage under its motor and loads"
note = "work: done by the motor less that taken by the loads;  kinetic + potential − work is constant"
eval over("time", "time")

# Of a linkage that is no four-bar: position1, rate1 and so on, of coordinates that a remark names, with their units if some are angles
# and others lengths: `1 drive arm in deg and rad/s`.
coordinate_words(cut) = !of_cycle ? "" : system("sed -n 's/^# *coordinates: \\([^;]*\\).*/\\1/p' ".quoted(table)." | tr ',' '\n' | ".\
    "sed 's/^ *[0-9]* drive *//; ".cut."; s/.*/\"&\"/'")
coordinates = coordinate_words("s/ in [^ ]* and [^ ]*$//")
mixed = of_cycle && unit_rate1 eq "see_head"
units_of(kind) = kind eq "position" ? coordinate_words("s/.* in \\([^ ]*\\) and [^ ]*$/\\1/") : coordinate_words("s/.* and //")
own_unit(kind, k) = mixed ? word(units_of(kind), k) : value("unit_".kind."1")
fields_of(kind, unit, k) = k > words(coordinates) ? "" : (own_unit(kind, k) ne unit ? "" : sprintf(" field('%s%d')", kind, k)).\
    fields_of(kind, unit, k + 1)
titles_by(kind, unit, k) = k > words(coordinates) ? "" : (own_unit(kind, k) ne unit ? "" : " \"".short_name(coordinates, k)."\"").\
    titles_by(kind, unit, k + 1)

# Behind a gear the torque is not that of the motor, which has a panel of its own if the table has it.
geared = system("grep -c '^# *torque: of the motor.* behind its gear' ".quoted(table)) + 0
# A start from rest may need in its first instant many times what it needs later.
first_torque = exists("col_torque") ? system("awk ".quoted(sprintf("!/^#/ && NF { print $%d; exit }", col_torque))." ".quoted(table)) + 0.0 : 0
later = system("awk ".quoted(sprintf("!/^#/ && NF && n++ { if (n == 2 || $%d < a) a = $%d; if (n == 2 || $%d > b) b = $%d } END { print a + 0, b + 0 }", \
    col_torque, col_torque, col_torque, col_torque))." ".quoted(table))
later_low = word(later, 1) + 0.0
later_high = word(later, 2) + 0.0
later_range = larger(later_high, 0) - lesser(later_low, 0)
cut_high = later_range > 0 && first_torque > later_high + 2*later_range
cut_low = later_range > 0 && first_torque < later_low - 2*later_range
is_torque(panel) = curves_of[panel] eq fields("torque")
shown_high(panel) = cut_high && is_torque(panel) ? larger(later_high, 0) + 0.05*later_range : NaN
shown_low(panel) = cut_low && is_torque(panel) ? lesser(later_low, 0) - 0.05*later_range : NaN
if (cut_high || cut_low) {
    remark = sprintf("at the start: %.4g %s, beyond the axis", first_torque, typeset(!mixed ? unit_torque : \
        system("sed -n 's/^# *torque: of the motor on the first drive in \\([^;,]*\\)[;,].*/\\1/p' ".quoted(table)))).(remark eq "" ? "" : "; ".remark)
}
torque_panel(what, unit) = !geared ? panel_of("motor ".what, unit, fields("torque"), "motor") \
    : panel_of(what." behind gear", unit, fields("torque"), "'on the drive'") + (exists("unit_motor_torque") \
    ? panel_of(what." of the motor", mixed ? unit : unit_motor_torque, fields("motor_torque"), "'before its gear'") : 0)

if (of_cycle) {
    of_one = words(coordinates) == 1
    do for [kind in "position rate"] {
        done = ""
        turns_on = of_one && kind eq "position" && unit_position1 eq "deg" && high_position1 - low_position1 > 360
        do for [k=1:words(coordinates)] {
            unit_of_k = own_unit(kind, k)
            if (!turns_on && strstrt(done, " ".unit_of_k." ") == 0) {
                done = done." ".unit_of_k." "
                titles = titles_by(kind, unit_of_k, 1)
                title = kind eq "rate" ? "rate" : unit_of_k eq "deg" ? "angle" : "place"
                if (words(titles) == 1) {
                    title = kind ne "rate" && of_one && unit_of_k ne "deg" ? drive_quantity(unit_of_k) : title." of ".word(titles, 1)
                }
                added = panel_of(title, unit_of_k, fields_of(kind, unit_of_k, 1), titles)
            }
        }
    }
    unit_of_torque = !mixed ? unit_torque : \
        system("sed -n 's/^# *torque: of the motor on the first drive in \\([^;,]*\\)[;,].*/\\1/p' ".quoted(table))
    added = torque_panel(own_unit("position", 1) eq "deg" ? "torque" : "force", unit_of_torque)
} else {
    if (high_crank - low_crank <= 360) { added = panel_of("crank angle θ₂", unit_crank, fields("crank"), "crank") }
    added = panel_of("angular velocity", unit_omega2, fields("omega2 omega4"), "'crank ω₂' 'follower ω₄'")
    added = torque_panel("torque", unit_torque)
}
added = panel_of("energy", unit_kinetic, energy_curve("kinetic").energy_curve("potential").fields("work"), \
    energy_title("kinetic").energy_title("potential")." work")
