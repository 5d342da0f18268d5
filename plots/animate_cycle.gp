# A linkage that is no four-bar as it moves: a cycle, or to and fro, with the paths of its pins and points.
# TABLE has the columns speed and crank; the positions are between its first and its last.

eval smaller(0.65)

call plots."driven.gp"
pictures = turning ? 72*int(lesser(4, larger(1, cycle/360))) : 60
call plots."shapes.gp" (turning ? 3*pictures : 240) 0.018

# Evenly over a cycle or in time, or slower towards both ends of the way.
in_time = exists("laws_in_time")
pose_of(picture) = turning ? 1 + 3*(picture - 1) : in_time ? 1 + 4*(picture - 1) : 1 + int(120.5 - 120*cos(2*pi*(picture - 1)/pictures))
caption(n) = drive_at." ".(turning ? sprintf("%d°", int(floor(pose_crank[n] + 0.5) + 10*cycle)%int(cycle)) \
    : minus(sprintf("%.4g", pose_crank[n])).(is_angle ? "°" : " ".unit_crank))
tail = 24
tail_shown(picture) = turning || in_time || picture <= pictures/2
note = ""
delay = 4
call plots."animate_shapes.gp"
