# Growth of free vibrations in a turn against the speed of the crank: exponents at single speeds, and whole intervals.
# An interval is drawn as the half ellipse through its edges and its largest growth, which growth follows nearly.

intervals = other_table("intervals.dat")
read = table eq "" ? intervals : table
has_points = table ne ""
has_intervals = intervals ne "" && answer(intervals, "distinct from") ne "" ? 1 : 0
eval answer(read, "facts")
unit_of_speed = has_points ? unit_speed : unit_from
speed_a = has_points ? low_speed : low_from
speed_b = has_points ? high_speed : high_to
high_growth_all = has_points ? larger(high_growth, 0) : 0
if (has_intervals) {
    rows = system("awk ".quoted("!/^#/ && NF { print $1, $2, $3, $4, $5, $7 }")." ".quoted(intervals))
    number = words(rows)/6
    do for [k=1:number] { high_growth_all = larger(high_growth_all, word(rows, 6*k - 1) + 0.0) }
    do for [k=1:number] { speed_a = lesser(speed_a, word(rows, 6*k - 5) + 0.0); speed_b = larger(speed_b, word(rows, 6*k - 4) + 0.0) }
} else { rows = ""; number = 0 }
if (high_growth_all <= 0) { high_growth_all = 0.01 }
headline = numbered(figure, "Growth of free vibrations in a turn of the crank")
note = has_intervals ? "filled: intervals of instability, from edge to edge, as high as their largest growth, with their modes; marks: single speeds" \
    : high_growth > 1e-9 ? "" : "no vibration grows at any of these speeds"
kinds = "flip fold combination"
names = "\"flip (ρ = −1)\" \"fold (ρ = 1)\" combination"
fill(k) = word("#0060A8 #C04000 #007A5A", k)
seen(k) = (sum [j=1:number] (word(rows, 6*j - 3) eq word(kinds, k) ? 1 : 0)) > 0 ? 1 : 0
modes = has_points ? int(high_mode) : 0
name_of(k) = sprintf("mode %d", k)
shown_kinds = seen(1) + seen(2) + seen(3)
longest = larger(widest(names, 20), text_width(name_of(10), 20))
eval page_of_one(shown_kinds + modes, longest, "growth in a turn", "-", 0, high_growth_all)
eval abscissa(speed_a, speed_b)
set xlabel abscissa_title("crank speed ω₂", unit_of_speed, speed_a, speed_b)
set parametric
set trange [0:pi]
set samples 121
set style fill transparent solid 0.45 border
middle(j) = 0.5*(word(rows, 6*j - 5) + word(rows, 6*j - 4))
# No needle is thinner than can be seen.
pixel_of_speed = (abscissa_high(speed_a, speed_b) - abscissa_low(speed_a, speed_b))/plot_width
half(j) = larger(1.5*pixel_of_speed, 0.5*abs(word(rows, 6*j - 4) - word(rows, 6*j - 5)))
peak(j) = word(rows, 6*j - 1) + 0.0
kind_of(j) = word(rows, 6*j - 3) eq "flip" ? 1 : word(rows, 6*j - 3) eq "fold" ? 2 : 3
# Of a plot without a curve gnuplot 5.4 evaluates what is behind its loop all the same.
set table $ARCS
if (number > 0) { plot for [j=1:number] middle(j) + half(j)*cos(t), peak(j)*sin(t) } else { plot NaN, NaN }
unset table
unset parametric
# Modes that meet stand at the intervals, clear of these and of each other.
high_drawn = value_top(0, high_growth_all)
place_of(speed) = plot_left + (speed - abscissa_low(speed_a, speed_b))/pixel_of_speed
height_of(growth) = lower + plot_height*growth/high_drawn
load plots."drawing.gp"
set print places
print sprintf("page %g %g %g %g", plot_left + 4, plot_left + plot_width - 4, lower + 4, lower + plot_height - 4)
do for [j=1:number] {
    do for [way=0:20] { print sprintf("%s %.6g %.6g", "curve", place_of(middle(j) + half(j)*cos(pi*way/20)), height_of(peak(j)*sin(pi*way/20))) }
    print "curve"
}
do for [j=1:number] {
    text = word(rows, 6*j - 2)
    if (peak(j) > 0.01*high_growth_all) {
        print sprintf("label %.6g %.6g 5 %.4g %.4g 90 %s", place_of(middle(j)), height_of(peak(j)), text_width(text, 15), text_height(15), text)
    }
}
unset print
load labels_as("numbers")
do for [j=1:|$numbers|] {
    row = $numbers[j]
    set label 1000 + j word(row, 6) at screen across(word(row, 1) + 0.0), up(word(row, 2) + 0.0) center font ",15" front
    if (word(row, 5) eq "1") {
        eval sprintf("set arrow %d from screen %.6f, %.6f to screen %.6f, %.6f nohead lw 1 lc rgb '#808080'", 1000 + j, \
            across(word(row, 7) + 0.0), up(word(row, 8) + 0.0), across(word(row, 3) + 0.0), up(word(row, 4) + 0.0))
    }
}
of_mode(k) = has_points ? rows_if(table, is_at("mode", sprintf("%d", k))) : "< echo NaN"
mark(k) = int(word("7 9 5 13 11 15 6 8", 1 + (k - 1)%8))
col_growth = exists("col_growth") ? col_growth : 1
col_speed = exists("col_speed") ? col_speed : 1
plot for [j=1:number] $ARCS index j - 1 using 1:2 with filledcurves y1=0 lw 1.5 fc rgb fill(kind_of(j)) notitle, \
    for [k=1:modes] of_mode(k) using (column(col_speed)):(column(col_growth) > 1e-9 ? column(col_growth) : NaN) \
        with points pt mark(k) ps 1.0 lc rgb "#303030" notitle, \
    for [k=1:3] for [j=1:seen(k)] keyentry with boxes fs transparent solid 0.45 border fc rgb fill(k) title word(names, k), \
    for [k=1:modes] keyentry with points pt mark(k) ps 1.4 lc rgb "#303030" title name_of(k)
