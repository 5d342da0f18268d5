# What the first drive of a linkage that is no four-bar moves, and its name on axes and in titles. After style.gp and `eval
# answer(table, "facts")`:   call "driven.gp"
# Sets drive_title, of an axis, at_drive(position), at_rate(speed), and turning, whether the positions go over whole turns.

driven = system("sed -n 's/^DRIVE *//p' echo.deck 2> /dev/null | sed '1s/ *!.*//; 1q'")
driven_word(k) = words(driven) >= k ? word(driven, k) : ""
is_angle = unit_crank eq "deg"
drive_subject = driven eq "" ? "crank" : driven_word(1)
drive_quantity = driven_word(2) eq "against" ? "angle of ".drive_subject." against ".driven_word(3) \
    : is_angle ? (drive_subject eq "crank" ? "crank angle" : "angle of ".drive_subject) \
    : driven_word(2) eq "length" ? "length of ".drive_subject : "place of ".drive_subject." along ".driven_word(2)
drive_title = drive_quantity.bracketed(typeset(unit_crank))
at_drive(position) = drive_subject.sprintf(" at %s%s", minus(sprintf("%.4g", position)), is_angle ? "°" : " ".unit_crank)
at_rate(speed) = drive_subject.sprintf(" at %s %s", minus(sprintf("%.6g", speed)), typeset(unit_speed))
positions = words(answer(table, "distinct crank"))
turning = is_angle && positions > 2 && (high_crank - low_crank)*positions/(positions - 1.0) >= 360 - 1e-6
drive_axis = "eval is_angle && high_crank > low_crank ? crank_axis(low_crank, high_crank) : abscissa(low_crank, high_crank); ".\
    "set xlabel drive_title noenhanced"
