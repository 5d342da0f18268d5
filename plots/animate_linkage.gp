# The linkage as it moves, with the paths of its points: a turn of the crank, or to and fro where it cannot turn.
# Without points.dat, the middle of the coupler draws its path.

eval smaller(0.65)

low = exists("home_low") && home_low > low_crank ? home_low : low_crank
high = exists("home_low") && home_high < high_crank ? home_high : high_crank
call plots."linkage.gp" other
eval pose_at("lowest", low)
eval middle_of_coupler

# Evenly in the crank's angle, or slower towards both ends of its way.
turning = turns_fully && high - low >= 240
pictures = turning ? 72 : 60
crank_of(k) = turning ? low + 360.0*k/pictures : 0.5*(low + high) - 0.5*(high - low)*cos(2*pi*k/pictures)
set print angles
do for [k=0:2*pictures - 1] { print sprintf("%.17g", crank_of(k)) }
unset print
load poses_as("poses")

note = ""
caption(n) = "θ₂ = ".sprintf("%d°", floor(word($poses[n], 1)) % 360)
tail = 24
call plots."animate_poses.gp" 4 pictures 1
