# The linkage that kinematics.dat belongs to, at any position, and the points of points.dat on its links. After style.gp:
#   call "linkage.gp" kinematics.dat [points.dat]
# Sets the pivots O2 and O4, the lengths r2, r3, r4 of crank, coupler and follower, the points and what is drawn of them.
# Angles are in radians; planes are complex.

eval answer(ARG1, "linkage")
if (!exists("r4")) {
    print ARG1.": one position does not tell where the ground pivots are; a CRANK card with more of them is needed"
    exit status 1
}
I = {0, 1}
O2_x = real(O2); O2_y = imag(O2)
O4_x = real(O4); O4_y = imag(O4)
turned(angle) = exp(I*angle)
radians = pi/180

# B is where the circles about A and O4 meet: side 1 left of the line from A to O4, -1 right of it.
pin_A(t2) = O2 + r2*turned(t2)
reach(t2) = abs(O4 - pin_A(t2))
along(t2) = (reach(t2)**2 + r3**2 - r4**2)/(2*reach(t2))
beside(t2) = (square = r3**2 - along(t2)**2, square > 0 ? sqrt(square) : 0)
pin_B(t2) = pin_A(t2) + (O4 - pin_A(t2))/reach(t2)*(along(t2) + I*side*beside(t2))
angle_3(t2) = arg(pin_B(t2) - pin_A(t2))
angle_4(t2) = arg(pin_B(t2) - O4)

# The crank turns fully if A is never too far from O4 nor too near to it.
slack = 1e-9*(r3 + r4)
turns_fully = abs(O4 - O2) + r2 <= r3 + r4 + slack && abs(abs(O4 - O2) - r2) >= abs(r3 - r4) - slack

# ---- Points: each belongs to the link on which its place does not change ---------------------------------------

point_names = ARG2 eq "" ? "" : answer(ARG2, "distinct point")
points = words(point_names)
array point_link[points + 1]
array point_place[points + 1]                       # from the link's first pin, along it and to the left of it
origin(link, t2) = link == 2 ? O2 : link == 3 ? pin_A(t2) : O4
heading_of(link, t2) = link == 2 ? t2 : link == 3 ? angle_3(t2) : angle_4(t2)
place(link, t2, z) = (z - origin(link, t2))/turned(heading_of(link, t2))
if (points > 0) {
    eval answer(ARG2, "facts")
    row_place(link) = place(link, radians*field("crank"), field("x") + I*field("y"))
    do for [p=1:points] {
        spread = 1e300
        of_point(value) = strcol(col_point) eq word(point_names, p) ? value : NaN
        do for [link=2:4] {
            stats ARG2 using (of_point(real(row_place(link)))):(imag(row_place(link))) name "place" nooutput
            if (place_stddev_x + place_stddev_y < spread) {
                spread = place_stddev_x + place_stddev_y
                point_link[p] = link
                point_place[p] = place_mean_x + I*place_mean_y
            }
        }
    }
}

# ---- Poses ------------------------------------------------------------------------------------------------------
# A row of a block of poses: 1 angle of the crank [degrees], 2 3 pin A, 4 5 pin B, then x and y of every point.

xy(z) = sprintf(" %.7g %.7g", real(z), imag(z))
points_of_pose(p, A, t2, t3, t4) = p > points ? "" : xy(point_link[p] == 2 ? O2 + point_place[p]*turned(t2) \
    : point_link[p] == 3 ? A + point_place[p]*turned(t3) : O4 + point_place[p]*turned(t4)).points_of_pose(p + 1, A, t2, t3, t4)
pose(t2, t3, t4) = sprintf("%.10g", t2/radians).xy(pin_A(t2)).xy(pin_A(t2) + r3*turned(t3)).\
    points_of_pose(1, pin_A(t2), t2, t3, t4)
pose_at(t2) = pose(t2, angle_3(t2), angle_4(t2))
column_of(p) = 4 + 2*p                              # of the x of a point; its y is in the next

# The extent of a block of poses, with the pivots: x_min, x_max, y_min, y_max and span.
extent = "x_min = real(O2); x_max = x_min; y_min = imag(O2); y_max = y_min; ".\
    "include(x, y) = (x_min = x < x_min ? x : x_min, x_max = x > x_max ? x : x_max, ".\
    "y_min = y < y_min ? y : y_min, y_max = y > y_max ? y : y_max, 0); extent_corner = include(real(O4), imag(O4)); ".\
    "do for [k=2:(4 + 2*points):2] { stats poses using (include(column(k), column(k + 1))) nooutput }; ".\
    "span = x_max - x_min > y_max - y_min ? x_max - x_min : y_max - y_min"

# Where there are no points, the middle of the coupler is one.
middle_of_coupler = "if (points == 0) { points = 1; array point_link[1]; array point_place[1]; point_link[1] = 3; point_place[1] = r3/2 }"
