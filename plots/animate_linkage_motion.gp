# The motion of motion.dat of a linkage that is no four-bar, in real time, or slowed down if it lasts less than a second or two; of
# a long one, the first six seconds.

eval smaller(0.65)

call plots."motion_pictures.gp"

# Positions between the pictures make paths smooth: every so many rows, some of them to a picture.
fine = lesser(every_row, 4)
stride = every_row/fine
shapes = out.".shapes"
load "< sh ".quoted(plots."places.sh")." motion ".quoted(shapes).sprintf(" %d %d 0.018", stride, fine*(pictures - 1) + 1)
load plots."shape_parts.gp"
array rates[poses]
keep_rate(n) = n > poses ? NaN : (rates[n] = field("rate1"), n)
stats table every stride using (keep_rate(int(column(0)) + 1)) nooutput

pose_of(picture) = 1 + fine*(picture - 1)
decimals = larger(0, int(ceil(-log10(0.99*every_row*time_step))))
caption(n) = sprintf(sprintf("t = %%.%df %s", decimals, unit_time), pose_crank[n]).(exists("col_rate2") ? "" \
    : sprintf(",  %s at %s %s", drive_subject, minus(sprintf("%.1f", rates[n])), typeset(unit_rate1)))
note = slower == 1 ? "" : sprintf("slowed down %g times", slower)
tail = 3*fine
tail_shown(picture) = 1
call plots."animate_shapes.gp"
