# A family of the stress test: true and estimated errors of every way of solving it, against the parameter.
#   gnuplot -c stress.gp TABLE OUT LABEL HEADLINE [FIGURE [REMARK]]
# A column of points belongs to one case: several positions, speeds and modes. What a family varies beside its parameter has a
# panel each, and ways of solving it have marks of their own. A true error of zero lies on the lower edge. Cases that are only
# numbered are drawn by their two errors.

load ARG0[1 : strlen(ARG0) - strlen("stress.gp")]."style.gp"
text_mode = "enhanced"                              # powers of ten at its axes
table = ARG1; out = ARG2; axis = ARG3; headline = ARG4; figure = argument(5); remark = argument(6)

deck_title = ""
variants = system("awk '!/^#/ && $10 == \"bounded\" && !seen[$2]++ { print $2 }' ".quoted(table))

# A variant is a way of solving, or a case, or both, joined by a hyphen: its panel is the case, its mark the way.
ways = "accuracy auto loose deformation dense band lumped long 20modes"
is_way(name) = strstrt(" ".ways." ", " ".name." ") > 0
hyphen(name) = strstrt(name, "-")
before(name) = hyphen(name) > 0 ? name[1 : hyphen(name) - 1] : name
after(name) = hyphen(name) > 0 ? name[hyphen(name) + 1 : *] : ""
way_of(name) = is_way(before(name)) ? before(name) : after(name) ne "" ? after(name) : "-"
case_of(name) = is_way(before(name)) ? (after(name) eq "" ? "-" : after(name)) : before(name)

text_of(name) = name eq "accuracy" || name eq "auto" ? "accuracy=" : name eq "loose" ? "accuracy=1e-4" \
    : name eq "-" ? "" : name eq "rest" ? "at rest" : name eq "load" ? "at one speed" : name eq "step" ? "speed in step" \
    : name eq "long" ? "many elements" : name eq "strip" ? "one thickness" : name eq "1" ? "1 element per link" \
    : name eq "4" ? "4 elements per link" : name eq "I" ? "unequal stiffness" : spaced(name)
spaced(name) = strstrt(name, "modes") > 1 ? name[1 : strstrt(name, "modes") - 1]." modes" : strstrt(name, "+") == 0 ? name \
    : name[1 : strstrt(name, "+") - 1].", ".name[strstrt(name, "+") + 1 : *]
add_once(list, name) = strstrt(" ".list." ", " ".name." ") > 0 ? list : list." ".name

cases = ""
marks = ""
do for [name in variants] { cases = add_once(cases, case_of(name)); marks = add_once(marks, way_of(name)) }
if (words(cases) > 8) { cases = "(all)" }           # one panel
numbered_cases = strstrt(axis, "number") == 1
panels = numbered_cases ? 1 : words(cases)
n = words(marks)
case_text(k) = word(cases, k) eq "(all)" ? "" : text_of(word(cases, k))
mark_text(k) = word(marks, k) eq "-" ? "in proportion" : text_of(word(marks, k))
bounded(k, c) = strcol(10) eq "bounded" && (word(cases, c) eq "(all)" || case_of(strcol(2)) eq word(cases, c)) \
    && way_of(strcol(2)) eq word(marks, k)
hollow(k) = word("6 8 4 12 10", (k - 1) % 5 + 1) + 0
filled(k) = hollow(k) + 1

bottom = 1e-17
at_least(error) = error > bottom ? error : bottom
top = bottom
stats table using (strcol(10) eq "bounded" ? (top = larger(top, larger(column(6), column(7))), column(1)) : NaN) name "parameter" nooutput
top = 10.0**ceil(log10(top) + 0.3)
longest = 0
do for [k=1:n] { longest = larger(longest, text_width(mark_text(k), 20)) }
do for [k=1:words(cases)] { longest = larger(longest, text_width(case_text(k), 20) - 100) }

if (numbered_cases) {
    note = "above the line the estimate is on the safe side"
    lower = foot(lines_of_notes(note, remark))
    eval legend_page(1250, n, longest, 80, 1)
    eval heading
    set logscale xy
    set format x "10^{%T}"
    set format y "10^{%T}"
    set xrange [bottom:top]
    set yrange [bottom:top]
    set xtics 100
    set ytics 100
    set mxtics 1
    set mytics 1
    set tmargin at screen down(125)
    set bmargin at screen up(lower)
    set xlabel "true relative error, against quadruple precision"
    eval axis_title("estimated relative error", lower, @panel_room - lower)
    set arrow 1 from bottom, bottom to top, top nohead lw 2 lc rgb faint
    plot for [k=1:n] table using (bounded(k, 1) ? at_least(column(6)) : NaN):(at_least(column(7))) \
            with points lt k pt hollow(k) ps 1.2 lw 1.5 notitle, \
        for [k=1:n] keyentry with points lt k pt hollow(k) ps 1.5 lw 2 title mark_text(k)
} else {
    note = "filled: true error, against quadruple precision; hollow: estimated error"
    lower = foot(lines_of_notes(note, remark))
    full_height = panels == 1 ? 740 : panels == 2 ? 430 : panels < 5 ? 280 : 37*larger(4, n) + 70
    gap = 35
    eval legend_page(125 + lower + panels*(full_height + gap) - gap, n, longest, 80, 1)
    panel_height = (@panel_room - lower + gap)/panels - gap
    eval heading
    set logscale y
    # A few decades at least take a logarithmic axis, on which zero has the place of the decade before the least.
    least = 1e300; greatest = 0; zeros = 0
    stats table using (strcol(10) ne "bounded" ? NaN : (value = abs(column(1)), zeros = zeros || value == 0, \
        least = value > 0 ? lesser(least, value) : least, greatest = larger(greatest, value), value)) name "parameter" nooutput
    linear = greatest/least < 20
    if (zeros) { least = least/10 }
    spread = linear ? lesser(0.25, 0.02*(greatest - least)) : (greatest/least)**0.005
    place(value, k) = linear ? value + spread*(k - 0.5*(n + 1)) : (value == 0 ? least : abs(value))*spread**(k - 0.5*(n + 1))
    if (linear) {
        set xrange [least - 0.04*(greatest - least):greatest + 0.04*(greatest - least)]
    } else {
        set logscale x
        set xrange [least/spread**8:greatest*spread**8]
        set xtics 10.0**ceil(log10(greatest/least)/10)
        set mxtics 10
    }
    set yrange [bottom:top]
    set ytics 10.0**ceil(log10(top/bottom)/(panel_height/60.0))
    set mytics 1
    set multiplot
    do for [panel=1:panels] {
        base = lower + (panels - panel)*(panel_height + gap)
        set bmargin at screen up(base)
        set tmargin at screen up(base + panel_height)
        set key at screen across(key_left), up(base + panel_height)
        if (panel > 1) { do for [label=901:904] { unset label label }; unset key }
        if (panel == panels) { set format x (linear ? "%h" : "10^{%T}"); if (zeros) { set xtics add ("0" least) }; set xlabel axis noenhanced } else { set format x "" }
        set format y "10^{%T}"
        eval axis_title("relative error", base, panel_height)
        set label 906 case_text(panel) at screen across(key_left + 12), up(base + 22) left noenhanced
        plot for [k=1:n] table using (bounded(k, panel) ? place(column(1), k) : NaN):(at_least(column(7))) \
                with points lt k pt hollow(k) ps 1.4 lw 1.5 notitle, \
            for [k=1:n] table using (bounded(k, panel) ? place(column(1), k) : NaN):(at_least(column(6))) \
                with points lt k pt filled(k) ps 0.8 notitle, \
            for [k=1:n] keyentry with points lt k pt filled(k) ps 1.3 title mark_text(k)
    }
    unset multiplot
}
eval close
