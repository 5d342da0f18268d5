# What the first drive of a linkage that is no four-bar moves, for its drawings. After style.gp and `eval answer(table, "facts")`:
#   call "driven.gp"
# Sets is_angle, at_drive(position), cycle, and turning, whether the positions go over it as a whole.

is_angle = unit_crank eq "deg"
drive_at = exists("laws_in_time") ? "at" : drive_subject." at"
at_drive(position) = drive_at.sprintf(" %s%s", minus(sprintf("%.4g", position)), is_angle ? "°" : " ".unit_crank)
positions = words(answer(table, "distinct crank"))
if (!exists("cycle")) { cycle = 360 }
goes_round = is_angle && positions > 2 && (high_crank - low_crank)*positions/(positions - 1.0) >= cycle - 1e-6
turning = goes_round && !exists("home_low")
