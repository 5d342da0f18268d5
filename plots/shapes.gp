# The linkage of echo.deck as bodies, over the positions of a table: after style.gp and driven.gp, and with `eval answer(table, "facts")`,
#   call "shapes.gp" COUNT SHARE
# places it at COUNT positions and one more, from the first of the table to its last or over a cycle (see shapes.awk), in the folder
# out.".shapes", to be drawn with the parts of shape_parts.gp. Of several ranges it is that in which the linkage is.

pose_low = 1.0*low_crank
pose_high = turning ? pose_low + cycle : 1.0*high_crank
if (exists("home_low")) {
    # At its very ends the drive is stuck.
    home_edge = 0.001*(home_high - home_low)
    pose_low = goes_round || home_low > pose_low ? home_low + home_edge : pose_low
    pose_high = goes_round || home_high < pose_high ? home_high - home_edge : pose_high
}
shapes = out.".shapes"
load "< sh ".quoted(plots."places.sh")." range ".quoted(shapes).sprintf(" %.17g %.17g %d %.6g", pose_low, pose_high, ARG1 + 0, ARG2 + 0)

load plots."shape_parts.gp"
