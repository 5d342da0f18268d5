# The largest strain of every link over a turn against the speed, on a logarithmic axis, with the critical speeds above it.
# A speed is critical where a multiple of it, a harmonic, is the mean frequency of a mode over the turn: for the modes of
# frequencies.dat, three at most.

links = names_in(table, "link")
n = words(links)
shown_links = short_names(links, 1)
positive = answer(table, "positive strain")
low = positive eq "" ? 1 : 1e6*(word(positive, 1) + 0.0)
high = positive eq "" ? 1 : 1e6*(word(positive, 2) + 0.0)
speeds = words(answer(table, "distinct speed"))

modes = 0
load keep("critical", other eq "" ? "/dev/null" : other, sprintf("critical %.12g %.12g", low_speed, high_speed))
do for [k=1:|$critical|] { modes = lesser(3, larger(modes, word($critical[k], 1) + 0)) }
headline = numbered(figure, "Largest strain over a turn against the speed of the crank")
note = modes == 0 ? "" : "lines with n ≤ 20: speeds ω₂ = 2π f / n, where harmonic n has the mean frequency f of a mode; resonances lie near them"

lower = foot(lines_of_notes(note, remark))
strip = 34
strips = 125 + strip*modes
strip_title(mode) = sprintf("harmonics of mode %d", mode)
strip_title(mode) = sprintf("n of mode %d", mode)
longest = larger(widest(shown_links, 20), modes > 0 ? text_width(strip_title(modes), 20) : 0)
title = value_title("largest strain", "", 1, 1)." [µε]"
eval legend_page(1000 + strip*modes, n + modes, longest, log_width(low, high), 1)
plot_height = @panel_room - lower - strip*modes
eval heading
set tmargin at screen down(strips)
set bmargin at screen up(lower)
set key at screen across(key_left), down(strips)
eval log_axis(low, high, plot_height)
eval axis_title(title, lower, plot_height)
eval abscissa(low_speed, high_speed)
set xlabel abscissa_title("crank speed ω₂", unit_speed, low_speed, high_speed)

# Lines of a mode have its ink, paler than that of curves; from the highest speed down, the lowest harmonic, they stand as long as there is room.
ink_at(mode) = word("#B07AA1 #59A14F #4E79A7", mode)
dashes(mode) = word("solid (12,6) (3,5)", mode)
speed_pixels = plot_width/(abscissa_high(low_speed, high_speed) - abscissa_low(low_speed, high_speed))
place_of(speed) = plot_left + speed_pixels*(speed - abscissa_low(low_speed, high_speed))
strip_y(mode) = 125 + strip*(mode - 0.5)
last_mode = 0
do for [k=1:|$critical|] {
    mode = word($critical[k], 1) + 0
    harmonic = word($critical[k], 2)
    at_place = place_of(word($critical[k], 3) + 0)
    if (mode != last_mode) { free_until = 1e9 }
    last_mode = mode
    room = 0.5*text_width(harmonic, 17) + 7
    if (mode > 3 || at_place + room > free_until || at_place < plot_left) { continue }
    free_until = at_place - room
    set label 1000 + k harmonic at screen across(at_place), down(strip_y(mode)) center font ",17" tc rgb ink_at(mode)
    eval sprintf("set arrow %d from screen %.6f, %.6f to screen %.6f, %.6f nohead lw 1.5 lc rgb '%s' dt %s back", \
        1000 + k, across(at_place), down(strip_y(mode) + 14), across(at_place), up(lower), ink_at(mode), dashes(mode))
}
of_link(k) = rows_if(table, is_named("link", word(links, k)))
lines_told(mode) = mode > modes ? "" : sprintf(", keyentry with lines lw 1.5 lc rgb '%s' dt %s title strip_title(%d)", ink_at(mode), dashes(mode), mode).\
    lines_told(mode + 1)
of_strain = "using (field('speed')):(1e6*field('strain'))"
eval "plot for [k=1:n] of_link(k) @of_strain with lines lt k lw line_width(speeds) notitle, ".\
    "for [k=1:n] of_link(k) @of_strain with points lt k pt 7 ps dot_size(speeds) notitle, ".\
    "for [k=1:n] of_link(k) every mark_step(speeds)::mark_first(k, n, speeds) @of_strain with points lt k notitle, ".\
    "for [k=1:n] keyentry with linespoints lt k title word(shown_links, k)".lines_told(1).measured(1, "|speed|", unit_speed, "|strain|largest strain|", "-").\
    measured(1, "|speed|", unit_speed, "|largest strain|", "µε")
