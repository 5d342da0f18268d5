# The Campbell diagram: frequencies against the speed of the crank, the lines n × speed, critical speeds on them.
# Bands are those of the linkage frozen at the positions of a turn, with their means; dots are Floquet frequencies of the running
# linkage. Speeds at which these grow are hatched: whole intervals if they are known.

critical = other_table("critical.dat")
intervals = other_table("intervals.dat")

# Hertz to a unit of speed.
hertz_of(unit) = unit eq "rpm" ? 1/60.0 : unit eq "deg/s" ? 1/360.0 : unit eq "Hz" || unit eq "rev/s" ? 1.0 : 1/(2*pi)

modes = int(high_mode)
factor = hertz_of(unit_speed)
greatest = larger(high_greatest, high_floquet)
top = 1.05*greatest
speed_low = low_speed < 0 ? -high_speed : low_speed
speed_high = low_speed < 0 ? -low_speed : high_speed
slowest = larger(speed_low, 1e-3*speed_high)
lines = int(lesser(60, floor(greatest/(factor*slowest))))
headline = numbered(figure, "Campbell diagram: frequencies against the speed of the crank")
has_critical = critical ne "" && answer(critical, "distinct line") ne "" ? 1 : 0
note = "bands: frozen linkage over a turn, lines: means, marks: Floquet frequencies"
if (has_critical) { remark = "circles: critical speeds, larger where a turn excites more (decades)".(remark eq "" ? "" : "; ".remark) }
# Speeds at which vibrations grow by themselves, two words each: intervals, or half way to the neighbours of a speed of the table.
sizes = "s = $1 < 0 ? -$1 : $1 + 0"
grown = intervals ne "" ? system("awk ".quoted("!/^#/ && NF { a = $1 < 0 ? -$1 : $1; b = $2 < 0 ? -$2 : $2; print a + 0, b + 0 }")." ".\
        quoted(intervals)) \
    : system("awk ".quoted("!/^#/ && NF { ".sizes."; bad[s] += $".sprintf("%d", col_verdict)." ~ /^unstable/ } ".\
        "END { for (s in bad) print s, bad[s] }")." ".quoted(table)." | sort -g | awk ".quoted("{ s[NR] = $1; bad[NR] = $2 } ".\
        "END { for (i = 1; i <= NR; i++) if (bad[i]) print (i > 1 ? (s[i - 1] + s[i])/2 : s[i]), (i < NR ? (s[i] + s[i + 1])/2 : s[i]) }"))
unstable = words(grown)/2

# The table of critical speeds: places of its columns, and its rows.
place(name) = int(system("sed -n ".quoted("/^# *speed /{s/^# *//p;q}")." ".quoted(critical)." | tr -s ' ' '\\n' | grep -n -x ".name." | cut -d: -f1"))
if (has_critical) {
    c_speed = place("speed"); c_frequency = place("frequency"); c_excitation = place("excitation")
    least_excited = word(answer(critical, "positive excitation"), 1) + 0.0
    marks = "< awk ".quoted("!/^#/ && NF")." ".quoted(critical)
} else {
    c_speed = 1; c_frequency = 1; c_excitation = 1
    least_excited = 1.0
    marks = "< echo NaN"
}
size_of(x) = 1.4 + 1.3*log10(x/least_excited)

name_of(k) = sprintf("mode %d", k)
of_unstable = "unstable speeds"
longest = larger(text_width(of_unstable, 20), text_width(name_of(modes), 20))
entries = modes + 1 + (has_critical > 0) + (unstable > 0)
eval page_of_one(entries, longest, "frequency", "Hz", 0, greatest)
set yrange [0:top]
eval sprintf("set ytics (%s)", ticks_between(0, top, value_step(0, greatest, plot_height), 0))
# Room for the numbers of multiples beside the plot and above it.
plot_width = plot_width - 62
plot_height = plot_height - 22
set rmargin at screen across(plot_left + plot_width)
set tmargin at screen down(147)
eval abscissa_between(speed_low, speed_high, abscissa_step(speed_low, speed_high))
set xlabel abscissa_title("crank speed ω₂", unit_speed, speed_low, speed_high)
unset grid

measured_frequencies = measured(1, "|speed|", unit_speed, "|frequency|mean|floquet|", "Hz")
tint(k) = word("#B9B9B9 #A9C7E4 #F0C3A5 #A5D6C6 #D3BDE0 #CFCFCF #E6D3A0 #E3B0C4", 1 + (k - 1)%8)
mark(k) = int(word("7 9 5 13 11 15 6 8", 1 + (k - 1)%8))

# Multiples of the speed, each with its number where it leaves the diagram.
x_pixels = plot_width/(speed_high - speed_low)
y_pixels = plot_height/top
last_right = -1e9
last_top = 1e9
do for [n=1:lines] {
    at_right = n*factor*speed_high
    leaves = at_right <= top ? speed_high : top/(n*factor)
    eval sprintf("set arrow %d from first %.12g, %.12g to first %.12g, %.12g nohead back lw 1.2 lc rgb '#8C8C8C' dt (9,5)", \
        100 + n, speed_low, n*factor*speed_low, leaves, n*factor*leaves)
    if (at_right <= top) {
        if ((at_right - last_right)*y_pixels < 24) { continue }
        last_right = at_right
        eval sprintf("set label %d '%d×' at first %.12g, %.12g left offset 0.6, 0 noenhanced font ',17' tc rgb '#505050'", \
            100 + n, n, speed_high, at_right)
    } else {
        if ((last_top - leaves)*x_pixels < 62 || (leaves - speed_low)*x_pixels < 10) { continue }
        last_top = leaves
        eval sprintf("set label %d '%d×' at first %.12g, %.12g center offset 0, 0.7 noenhanced font ',17' tc rgb '#505050'", \
            100 + n, n, leaves, top)
    }
}

do for [k=1:unstable] {
    eval sprintf("set object %d rectangle from first %.12g, %.12g to first %.12g, %.12g behind fs transparent pattern 4 noborder fc rgb '#B06080'", \
        500 + k, larger(speed_low, word(grown, 2*k - 1) + 0.0), 0, lesser(speed_high, word(grown, 2*k) + 0.0), top)
}
of_mode(k) = rows_if(table, is_at("mode", sprintf("%d", k)))." | sort -g"
plot for [k=1:modes] of_mode(k) using (abs(field("speed"))):(field("least")):(field("greatest")) \
        with filledcurves fs transparent solid 0.5 noborder fc rgb tint(k) notitle, \
    for [k=1:modes] of_mode(k) using (abs(field("speed"))):(field("mean")) with lines lw 2.5 lc rgb ink_of(k) dt solid notitle, \
    for [k=1:modes] of_mode(k) using (abs(field("speed"))):(field("floquet")) with points pt mark(k) ps 1.1 lc rgb ink_of(k) notitle, \
    marks using (abs(column(c_speed))):(column(c_frequency)):(size_of(column(c_excitation))) \
        with points pt 6 lw 2.5 ps variable lc rgb "#C00000" notitle, \
    for [k=1:modes] keyentry with linespoints lw 2.5 pt mark(k) ps 1.4 lc rgb ink_of(k) dt solid title name_of(k), \
    for [k=1:1] keyentry with lines lw 1.2 lc rgb "#8C8C8C" dt (9,5) title "n × speed", \
    for [k=1:has_critical] keyentry with points pt 6 lw 2.5 ps 2 lc rgb "#C00000" title "critical speed", \
    for [k=1:unstable > 0] keyentry with boxes fs transparent pattern 4 fc rgb "#B06080" title of_unstable @measured_frequencies
