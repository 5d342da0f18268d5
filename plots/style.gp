# What all figures share: terminal, page, lines, and how a table is asked for its title and units.
# A script loads this file first; the last call of a script is `eval close`.

reset
set encoding utf8
style_name = "style.gp"
plots = ARG0[1 : strlen(ARG0) - strlen(style_name)]

# ---- Terminal -------------------------------------------------------------------------------------------------
# What draw_figures.sh hands over, each with a default: figure_format (png, svg or pdf), figure_titles (0: no heading and no
# notes), and figure_width, figure_height and figure_unit (px or mm), the size of every figure.
# Of the terminals of that format the first that this gnuplot was built with. To try another:
#   gnuplot -e "terminals='svg'" -c script.gp …

if (!exists("terminals")) terminals = GPVAL_TERMINALS
has(name) = strstrt(" ".terminals." ", " ".name." ") > 0
given_format = exists("figure_format") ? figure_format : ""
terminal_name = given_format eq "svg" ? (has("svg") ? "svg" : "") : given_format eq "pdf" ? (has("pdfcairo") ? "pdfcairo" : "") \
    : has("pngcairo") ? "pngcairo" : has("png") ? "png" : given_format eq "png" ? "" \
    : has("svg") ? "svg" : has("pdfcairo") ? "pdfcairo" : ""
extension = terminal_name eq "svg" ? ".svg" : terminal_name eq "pdfcairo" ? ".pdf" : ".png"
if (terminal_name eq "") {
    print given_format eq "" ? "this gnuplot has none of the terminals pngcairo, png, svg, pdfcairo: no figure can be drawn" \
        : "this gnuplot has no terminal that writes ".given_format.": no figure can be drawn"
    exit status 1
}
if (given_format eq "" && terminal_name ne "pngcairo" && !exists("fallback_told")) {
    print "this gnuplot has no terminal pngcairo: drawing with ".terminal_name.", files end in ".extension
}
fallback_told = 1

# Pages are planned in pixels of 1/96 inch, and text in points of 4/3 pixels. A page of a given size is planned in its
# proportions, with empty strips where that cannot be, and then made smaller or larger; `sheet` is the page with those strips.
# Without a size a PDF has 9 pixels of the plan to the millimetre, which makes a page 178 mm wide. A PNG of millimetres has
# 300 pixels to the inch. Pictures of an animation are pages made smaller.
titled = !exists("figure_titles") || figure_titles
size_wanted = exists("figure_width") && figure_width > 0
in_mm = size_wanted && figure_unit eq "mm"
# One page may have several figures, in cells: draw_figures.sh hands over their number, cells, calls for each of them twice, of which the
# first (cell_pass) finds how large the largest is, and says which it is (cell).
if (!exists("cells")) { cells = 1; cell = 1; cell_pass = 2 }
if (cell == 1 && cell_pass == 1) { cell_width = 0.0; cell_height = 0.0 }
in_cells = cells > 1
sized = size_wanted && !in_cells
cell_columns = in_cells ? cells > 9 ? 4 : cells > 4 ? 3 : 2 : 1
cell_rows = int(ceil(cells/(1.0*cell_columns)))
inches(length) = length/(in_mm ? 25.4 : 96.0)
page_scale = 1
common_width = 1600.0                              # of pages without a size: letters are alike beside each other
smaller(scale) = sprintf("page_scale = %g; sized = 0; size_wanted = 0; top_cut = 0; terminal_name = 'pngcairo'; extension = ''", scale)
font_name = "Sans"
text_mode = "noenhanced"                            # a name is what is written, whatever _, ^ or { mean to gnuplot
top_cut = titled ? 0 : 92                          # pixels of the head that a page without titles has not

plan_scale(w, h) = figure_width/(1.0*w) < figure_height/(1.0*h) ? figure_width/(1.0*w) : figure_height/(1.0*h)
sheet_w(w, h) = sized ? figure_width/plan_scale(w, h) : page_scale == 1 && w < common_width ? common_width : w
sheet_h(w, h) = sized ? figure_height/plan_scale(w, h) : h
pdf_inches(w, sheet) = size_wanted ? inches(figure_width)*w/sheet : in_cells ? 7.0*w/sheet : w/228.6
raster_scale(w) = !size_wanted && in_cells ? 0.5 : size_wanted ? (in_mm ? 300*inches(figure_width) : figure_width)/(1.0*w) : page_scale
terminal_options(w, h) = terminal_name eq "pdfcairo" \
    ? sprintf(text_mode." size %.6gin,%.6gin font '".font_name.",20' fontscale %.6g linewidth %.6g pointscale %.6g", \
        pdf_inches(w, w), pdf_inches(h, w), 72*pdf_inches(w, w)/w, 144*pdf_inches(w, w)/w, 72*pdf_inches(w, w)/w) \
    : terminal_name eq "pngcairo" \
    ? sprintf(text_mode." size %d,%d font '".font_name.",20' fontscale %.6g linewidth %.6g pointscale %.6g background rgb 'white'", \
        w*raster_scale(w) + 0.01, h*raster_scale(w) + 0.01, raster_scale(w), raster_scale(w), raster_scale(w)) \
    : terminal_name eq "svg" \
    ? sprintf(text_mode." size %d,%d font '".font_name.",20' fontscale 1.3333 dashed background rgb 'white'", w + 0.5, h + 0.5) \
    : sprintf(text_mode." size %d,%d font '".font_name.",20' fontscale %.6g linewidth %.6g", \
        w*raster_scale(w) + 0.01, h*raster_scale(w) + 0.01, raster_scale(w), raster_scale(w))
open_page(w, h) = open_sheet(floor(w), floor(h) - top_cut)
open_sheet(w, h) = sprintf("page_width = %d; page_height = %d; sheet_width = %.9g; sheet_height = %.9g; ", \
    w, h, sheet_w(w, h), sheet_h(w, h)).(in_cells ? open_cell(sheet_w(w, h), sheet_h(w, h)) : open_output(sheet_w(w, h), sheet_h(w, h)))
open_output(w, h) = sprintf("set terminal %s %s; set output out.extension", terminal_name, terminal_options(w, h))
# All cells, in the proportions of a size that is given.
cells_width = "cell_columns*cell_width"
cells_height = "cell_rows*cell_height"
proportion = size_wanted ? figure_width/(1.0*figure_height) : 0.0
wide_enough(w, h) = larger(w, h*proportion)
high_enough(w, h) = proportion > 0 ? larger(h, w/proportion) : h
open_cell(w, h) = cell_pass == 1 ? sprintf("cell_width = larger(cell_width, %.9g); cell_height = larger(cell_height, %.9g); ", w, h).\
        sprintf("set terminal %s %s; set output '/dev/null'", terminal_name, terminal_options(w, h)) \
    : (cell > 1 ? "" : open_output(wide_enough(@cells_width, @cells_height), high_enough(@cells_width, @cells_height))."; set multiplot; ").\
        "sheet_width = cell_width; sheet_height = cell_height"
begin_panels = in_cells ? "" : "set multiplot"
end_panels = in_cells ? "" : "unset multiplot"

# An SVG needs some work when it is done.
in_markup(text) = text eq "" ? "" : (text[1:1] eq "&" ? "&amp;" : text[1:1] eq "<" ? "&lt;" : text[1:1] eq ">" ? "&gt;" : text[1:1]).in_markup(text[2:*])
of_size(length) = size_wanted ? sprintf("%g%s", length, in_mm ? "mm" : "") : ""
finish_svg(file) = system("title=".quoted(in_markup(titled && exists("headline") ? headline : "")).sprintf(" awk -v width='%s' -v height='%s' -f ", \
    of_size(size_wanted ? figure_width : 0), of_size(size_wanted ? figure_height : 0)).quoted(plots."svg.awk")." < ".quoted(file)." > ".quoted(file."~").\
    " && mv ".quoted(file."~")." ".quoted(file))
close_output = "unset output; if (terminal_name eq 'svg') { said = finish_svg(out.extension) }; reset"
close = !in_cells ? close_output : cell_pass == 1 || cell < cells ? "reset" : "unset multiplot; ".close_output."; cells = 1"

# Screen coordinates of pixels from the left, lower and upper edges of the page, of its cell.
cell_left = in_cells ? ((cell - 1)%cell_columns)*1.0 : 0.0
cell_low = in_cells ? cell_rows - 1.0 - (cell - 1)/cell_columns : 0.0
screen_width(w) = in_cells ? wide_enough(@cells_width, @cells_height) : w
screen_height(h) = in_cells ? high_enough(@cells_width, @cells_height) : h
across(pixels) = (pixels + 0.5*(sheet_width - page_width) + cell_left*sheet_width)/screen_width(sheet_width)
up(pixels) = (pixels + 0.5*(sheet_height - page_height) + cell_low*sheet_height + screen_height(sheet_height) - cell_rows*sheet_height) \
    /screen_height(sheet_height)
down(pixels) = up(page_height + top_cut - pixels)

# ---- Lines: told apart without colour by dashes and marks ------------------------------------------------------

# The second eight are the same with filled marks.
ink_of(k) = word("#000000 #0060A8 #C04000 #007A5A #7A3E9D #6B6B6B #B8860B #A01850", 1 + (k - 1)%8)
do for [k=1:16] {
    eval sprintf("set linetype %d lw 3 lc rgb '%s' dt %s pt %s ps %s", k, ink_of(k), \
        word("solid (16,7) (4,5) (18,6,4,6) (26,6) (10,5,3,5,3,5) (8,8) (2,4)", 1 + (k - 1)%8), \
        word("6 8 4 12 10 2 1 3 7 9 5 13 11 15 14 2", k), word("1.8 2.0 1.7 2.0 2.0 1.7 1.8 1.8", k > 8 ? 3 : k))
}
set linetype cycle 16

ink = 0x000000
faint = 0x9A9A9A
force_ink = 0x0060A8

zero_line = "set xzeroaxis lt 1 lw 2 dt solid"
set border lw 1.5
set grid lt 1 lw 1 lc rgb "#D0D0D0" dt solid
set key noenhanced
set tics out nomirror
set xtics format "%h"
set ytics format "%h"
set minussign

# ---- Tables ---------------------------------------------------------------------------------------------------

quoted(text) = strstrt(text, "'") == 0 ? "'".text."'" : \
    "'".text[1 : strstrt(text, "'") - 1]."'\\'".quoted(text[strstrt(text, "'") + 1 : *])
ask(table, want) = "awk -v want=".quoted(want)." -f ".quoted(plots."quoted.awk")." -f ".quoted(plots."tables.awk")." < ".quoted(table)
answer(table, want) = system(ask(table, want))
keep(block, table, want) = "< awk -v datablock=".block.ask(table, want)[4 : *]     # to be loaded: the answer as $block
same(a, b) = abs(a - b) <= 1e-9 * (1 + abs(b))
argument(k) = exists("ARG".k) ? value("ARG".k) : ""     # of the script; one not given is empty
field(name) = column(value("col_".name))            # this row's value in a column, after `eval answer(table, "facts")`
unit(name) = " [".typeset(value("unit_".name))."]"
typeset(text) = text eq "" ? "" : symbol_of(text[1:1]).typeset(text[2:*])      # kg.mm2/s2 becomes kg·mm²/s²
symbol_of(letter) = letter eq "." || letter eq "*" ? "·" : letter eq "2" ? "²" : letter eq "3" ? "³" : letter eq "4" ? "⁴" : letter
# Some rows of a table as a file to plot, with an empty line where rows have failed: rows_if(table, is_named("point", "p")).
rows_if(table, condition) = "< awk ".quoted("NF == 0 || /^# *failed / { print \"\" } !/^#/ && ".condition)." ".quoted(table)
is_named(column, name) = sprintf("$%d \"\" == \"%s\"", value("col_".column), name)
is_at(column, number) = sprintf("($%d - %s)^2 <= 1e-18*(1 + $%d^2)", value("col_".column), number, value("col_".column))
is_numbered(name, word) = strlen(name) > strlen(word) && name[1 : strlen(word)] eq word \
    && strstrt("123456789", name[strlen(word) + 1 : strlen(word) + 1]) > 0              # f1, f12
repeated(k, text) = k < 1 ? "" : repeated(k - 1, text)." ".text
words_of(command) = system(command." | sed 's/.*/\"&\"/'")               # every line of an answer a word, whatever is in it
words_in(table, want) = words_of(ask(table, want))
names_in(table, name) = words_in(table, "distinct ".name)
# Points that are displaced at all; of pins, which stand in a table as ends of links, the first such end, and what is before its colon.
displaced_points(table) = words_of(ask(table, "moving point ux uy")." | grep -v :")
displaced_pins(table) = words_of(ask(table, "moving point ux uy")." | grep : | awk -F: '!met[$1]++'")
pin_of(name) = name[1 : strstrt(name, ":") - 1]
is_by_cards(table) = system("grep -c '^# rms over a turn' ".quoted(table)) + 0      # balanced by BALANCE cards

# ---- Words ----------------------------------------------------------------------------------------------------

ordinal(n) = n <= 10 ? word("first second third fourth fifth sixth seventh eighth ninth tenth", n) : sprintf("%dth", n)
capital(text) = substr("ABCDEFGHIJKLMNOPQRSTUVWXYZ", strstrt("abcdefghijklmnopqrstuvwxyz", text[1:1]), \
    strstrt("abcdefghijklmnopqrstuvwxyz", text[1:1])).text[2:*]
at_crank(crank) = of_cycle ? drive_subject.sprintf(" at %.10g", crank).(unit_crank eq "deg" ? "°" : " ".unit_crank) : sprintf("θ₂ = %.10g°", crank)
at_speed(speed, unit) = stands ? "at rest" : by_law ? (law_name eq "" ? "by its law" : "by law".(strstrt(law_name, ",") ? "s " : " ").law_name) : of_cycle ? drive_subject.sprintf(" at %.6g %s", speed, typeset(unit)) : sprintf("ω₂ = %.6g %s", speed, typeset(unit))
at_place(crank, speed, unit) = stands ? "at rest" : of_cycle && !by_law ? at_crank(crank).sprintf(" and %.6g %s", speed, typeset(unit)) \
    : (of_cycle ? "" : "at ").at_crank(crank).", ".at_speed(speed, unit)

# Of a drive with a law (law_name, which draw_figures.sh hands over) tables are over time.
by_law = exists("law_name")
up_to = by_law ? "" : "up to "
against = by_law ? "against time" : "against crank angle"

# Of a linkage that is no four-bar (is_cycle, which draw_figures.sh hands over) axes and titles name what the first DRIVE moves.
of_cycle = exists("is_cycle")
stands = exists("is_structure")     # no crank and no speed: it has one position, and is at rest
driven = of_cycle ? system("sed -n 's/^DRIVE *//p' echo.deck 2> /dev/null | sed '1s/ *!.*//; 1s/ *law=[^ ]*//; 1q'") : ""
driven_word(k) = words(driven) >= k ? word(driven, k) : ""
drive_subject = driven eq "" ? "crank" : driven_word(1)
drive_quantity(unit) = driven_word(2) eq "against" ? "angle of ".drive_subject." against ".driven_word(3) \
    : unit eq "deg" ? (drive_subject eq "crank" ? "crank angle" : "angle of ".drive_subject) \
    : driven_word(2) eq "length" ? "length of ".drive_subject : "place of ".drive_subject." along ".driven_word(2)
crank_title(unit) = by_law ? "time [".unit."]" : (of_cycle ? drive_quantity(unit) : "crank angle θ₂")." [".typeset(unit)."]"
against_position(unit) = "against ".(of_cycle ? drive_quantity(unit) : "crank angle")
speed_name = of_cycle && drive_subject ne "crank" ? "speed of ".drive_subject : of_cycle ? "crank speed" : "crank speed ω₂"
# O2 as the deck calls it, by the note "2: link arm; O2: pin O": tables of four-bars have names of their own for pins.
behind(text, mark) = substr(text, strstrt(text, mark) + strlen(mark), strlen(text))
until(text, mark) = strstrt(text, mark) == 0 ? text : text[1 : strstrt(text, mark) - 1]
pin_named(pin) = strstrt(link_note, pin.": pin ") == 0 ? pin : inside(until(behind(link_note, pin.": pin "), ";"), 14)
numbered(figure, text) = figure eq "" ? text : "Figure ".figure.".  ".text
divergence = "below zero: −√(−ω²)/2π of a mode that has diverged (static instability)"
cut(text, n) = strlen(text) <= n ? text : text[1 : n - 1]."…"
nice(x) = (power = 10.0**floor(log10(x)), x/power > 5 ? 10*power : x/power > 2 ? 5*power : x/power > 1 ? 2*power : power)
larger(a, b) = a > b ? a : b
lesser(a, b) = a < b ? a : b

# The width of a text: advances of DejaVu Sans, which is as wide as such fonts are, in ems, rounded up; a letter that is not
# here has a whole em.
ems_of(letter) = strstrt("ijl'", letter) ? 0.28 : strstrt("|.,:; I/\\·", letter) ? 0.34 : strstrt("()[]-ftr!°²³⁴₂₃₄", letter) ? 0.43 \
    : strstrt("abcdeghknopqsuvxyz0123456789*?_\"$θμα", letter) ? 0.65 : strstrt("ABCEFJKLPRSTVXYZ", letter) ? 0.71 \
    : strstrt("DGHNOQU+=<>~w&ω−×", letter) ? 0.84 : 1.0
ems(text) = strlen(text) == 0 ? 0 : strlen(text) == 1 ? ems_of(text) \
    : ems(text[1 : strlen(text)/2]) + ems(text[strlen(text)/2 + 1 : *])
text_width(text, size) = ems(text)*size*4/3.0                              # in pixels, of a size in points
widest(list, size) = (widest_one = 0.0, sum [k_of=1:words(list)] \
    (widest_one = larger(widest_one, text_width(word(list, k_of), size)), 0), widest_one)

# A text in the size at which it has room, the least at worst, and if that is too large still, cut.
fit_size(text, room, size, least) = text_width(text, size) <= room ? size \
    : larger(least, floor(size*room/text_width(text, size)))
fitted(text, room, size) = text_width(text, size) <= room ? text : text[1 : cut_place(text, room, size, 0, strlen(text))]."…"
cut_place(text, room, size, low, high) = high - low <= 1 ? low \
    : text_width(text[1 : (low + high)/2]."…", size) <= room ? cut_place(text, room, size, (low + high)/2, high) \
    : cut_place(text, room, size, low, (low + high)/2)
point_size(size) = sprintf(",%g", size)

# In two lines, broken at the blank that is nearest to the middle.
blank_near(text, middle, away) = away >= strlen(text)/2 || away > 100 ? 0 : text[middle - away : middle - away] eq " " ? middle - away \
    : text[middle + away : middle + away] eq " " ? middle + away : blank_near(text, middle, away + 1)
broken_at(text, place) = place < 1 ? text : text[1 : place - 1]."\n".text[place + 1 : *]
broken(text) = broken_at(text, blank_near(text, strlen(text)/2, 0))
in_two(text, room, size) = text_width(text, size) <= room ? text : broken(fitted(text, 1.8*room, size))

# A name of a legend that is too long keeps its beginning and its end, and gets its number where that leaves it like another.
name_length = 30
inside(text, n) = strlen(text) <= n ? text : text[1 : n - n/3 - 1]."…".text[strlen(text) - n/3 + 1 : *]
alike(list, k, n) = sum [k_of=1:words(list)] (k_of != k && inside(word(list, k_of), n) eq inside(word(list, k), n) ? 1 : 0)
short_name(list, k) = alike(list, k, name_length) == 0 ? inside(word(list, k), name_length) \
    : sprintf("%d: %s", k, inside(word(list, k), name_length - 5))
short_names(list, k) = k > words(list) ? "" : " \"".short_name(list, k)."\"".short_names(list, k + 1)

# Title, deck and notes at the foot: the script sets headline, deck_title, note and remark (empty: none).
lines_of_notes(note, remark) = titled ? (note ne "") + (remark ne "") : 0
foot(lines) = lines > 0 ? 134 + 31*lines : 118     # pixels below the lowest axis
heading_room = "(page_width - 50)"
label_of(tag, text, room, size, least, place) = sprintf("text_size = fit_size(%s, %s, %d, %d); ", text, room, size, least).\
    sprintf("set label %d fitted(%s, %s, text_size) at screen across(0.5*page_width), %s center noenhanced font point_size(text_size)", \
        tag, text, room, place)
heading = !titled ? "" : label_of(901, "headline", heading_room, 23, 14, "down(38)")."; ".\
    "text_size = fit_size(deck_title, page_width - 50, 18, 14); ".\
    "set label 902 in_two(deck_title, page_width - 50, text_size) at screen across(0.5*page_width), down(82) ".\
    "center noenhanced font point_size(text_size) tc rgb '#505050'; ".\
    label_of(903, "note", heading_room, 17, 11, "up(remark eq '' ? 30 : 61)")." tc rgb '#303030'; ".\
    label_of(904, "remark", heading_room, 17, 11, "up(30)")." tc rgb '#303030'"

# ---- Axes -----------------------------------------------------------------------------------------------------
# An axis has ticks of one form: all with as many decimals, and of large or small values a power of a thousand in its title,
# as a prefix where the unit takes one. Lengths are in pixels; a value axis is for values between low and high.

from_zero = 1                                       # values far from zero only have an axis without it
constant(low, high) = high - low <= 1e-9*larger(abs(low), abs(high))
value_bottom(low, high) = constant(low, high) ? (low == 0 ? -1.0 : low > 0 ? 0.0 : 1.25*low) \
    : low >= 0 && (low < 0.2*high && from_zero || low < 0.06*(high - low)) ? 0.0 : low - 0.06*(high - low)
value_top(low, high) = constant(low, high) ? (low == 0 ? 1.0 : low > 0 ? 1.25*low : 0.0) \
    : high <= 0 && (high > 0.2*low && from_zero || high > -0.06*(high - low)) ? 0.0 : high + 0.06*(high - low)
power_of(bottom, top) = (largest = larger(abs(bottom), abs(top)), largest >= 0.01 && largest < 10000 ? 0 \
    : int(3*floor(log10(largest)/3 + 1e-9)))
decimals_of(step, power) = larger(0, int(ceil(-log10(step/10.0**power) - 1e-6)))
tick_text(value, step, power) = minus(sprintf(sprintf("%%.%df", decimals_of(step, power)), value/10.0**power))
minus(text) = text[1:1] eq "-" ? "−".text[2:*] : text
bare = 0                                            # ticks without their text
ticks(k, last, step, power) = k > last ? "" : sprintf("%s'%s' %.15g", k > ticks_first ? ", " : "", \
    bare ? "" : tick_text(k*step, step, power), k*step).ticks(k + 1, last, step, power)
ticks_between(bottom, top, step, power) = (ticks_first = int(ceil(bottom/step - 1e-6)), \
    ticks(ticks_first, int(floor(top/step + 1e-6)), step, power))
tick_width(bottom, top, step, power) = larger(text_width(tick_text(step*ceil(bottom/step - 1e-6), step, power), 20), \
    text_width(tick_text(step*floor(top/step + 1e-6), step, power), 20))

value_step(low, high, length) = nice((value_top(low, high) - value_bottom(low, high))/larger(2, lesser(10, length/48.0)))
value_power(low, high) = power_of(value_bottom(low, high), value_top(low, high))
value_width(low, high, length) = tick_width(value_bottom(low, high), value_top(low, high), value_step(low, high, length), \
    value_power(low, high))
value_axis(low, high, length) = sprintf("set yrange [%.15g:%.15g]; set ytics (%s); ", value_bottom(low, high), value_top(low, high), \
    ticks_between(value_bottom(low, high), value_top(low, high), value_step(low, high, length), value_power(low, high))).\
    (low < 0 && high > 0 ? zero_line : "unset xzeroaxis")

# A logarithmic axis, for values above zero: ticks at powers of ten and between them, with 2 and 5 where decades are few.
log_bottom(low) = low/1.3
log_top(high) = high*1.3
decades(low, high) = log10(log_top(high)/log_bottom(low))
log_plain(low, high) = log_bottom(low) >= 1e-4 && log_top(high) <= 1e5
log_text(digit, power, plain) = plain ? sprintf("%.12g", digit*10.0**power) \
    : (digit > 1 ? sprintf("%d·", digit) : "")."10".raised(minus(sprintf("%d", power)))
log_step(low, high, length) = int(ceil(decades(low, high)/larger(1, length/40.0)))       # decades from text to text
log_shown(digit, power, few, step) = digit == 1 ? power%step == 0 : few && (digit == 2 || digit == 5)
log_tick(digit, power, few, step, plain) = sprintf("'%s' %.15g %d", log_shown(digit, power, few, step) ? log_text(digit, power, plain) : "", \
    digit*10.0**power, !log_shown(digit, power, few, step) && digit > 1)
log_list(k, last, few, step, plain) = k > last ? "" : (k%9 == 0 || step == 1 ? (k > 0 ? ", " : "").\
    log_tick(1 + k%9, log_first + k/9, few, step, plain) : "").log_list(k + 1, last, few, step, plain)
log_ticks(low, high, length) = (log_first = int(floor(log10(log_bottom(low)))), \
    log_list(0, 9*int(ceil(log10(log_top(high))) - log_first), decades(low, high) < 2.6 && length > 150, \
        log_step(low, high, length), log_plain(low, high)))
log_axis(low, high, length) = sprintf("set logscale y; set yrange [%.15g:%.15g]; set ytics (%s); ", log_bottom(low), log_top(high), \
    log_ticks(low, high, length))."unset xzeroaxis"
log_width(low, high) = larger(text_width("0.01", 20), larger( \
    text_width(log_text(1, int(ceil(log10(log_bottom(low)))), log_plain(low, high)), 20), \
    text_width(log_text(5, int(floor(log10(log_top(high)))), log_plain(low, high)), 20)))

# [kN], [µm/s], [10³ kg·mm²/s²]
takes_prefix(unit, power) = strstrt(" N N.m J W Pa Hz V A ", " ".unit." ") > 0 && abs(power) <= 12 || unit eq "s" && power < 0 && power >= -12
prefix(power) = power == 0 ? "" : word("p n µ m - k M G T", 5 + power/3)
power_text(power) = power == 0 ? "" : "10".raised(minus(sprintf("%d", power)))." "
raised(text) = text eq "" ? "" : (text[1:1] eq "−" ? "⁻" : word("⁰ ¹ ² ³ ⁴ ⁵ ⁶ ⁷ ⁸ ⁹", 1 + text[1:1])).raised(text[2:*])
lowered(text) = text eq "" ? "" : word("₀ ₁ ₂ ₃ ₄ ₅ ₆ ₇ ₈ ₉", 1 + text[1:1]).lowered(text[2:*])
unit_and_power(unit, power) = takes_prefix(unit, power) ? prefix(power).typeset(unit) \
    : unit eq "-" || unit eq "" ? substr(power_text(power), 1, strlen(power_text(power)) - 1) : power_text(power).typeset(unit)
bracketed(text) = text eq "" ? "" : " [".text."]"
value_title(name, unit, low, high) = name.bracketed(unit_and_power(unit, value_power(low, high)))

# The title of a value axis stands at the left edge of the page, however wide the ticks; two lines if one is too long.
title_lines(text, length) = text_width(text, 20) > length + 24 ? 2 : 1
title_most = 20                                     # points of all titles of a page: as few as the longest needs
title_size(text, length) = title_lines(text, length) == 1 ? 20 : fit_size(wider_part(broken(text), "\n"), length + 24, 20, 9)
wider_part(text, apart) = strstrt(text, apart) == 0 ? text : (strstrt(text, apart) > strlen(text)/2 ? text[1 : strstrt(text, apart) - 1] \
    : text[strstrt(text, apart) + 1 : *])
planned_lines(text, length) = title_lines(text, sized ? 0.6*length : length)       # a given size may leave panels less height
title_text(text, length) = title_lines(text, length) == 1 ? text : broken(text)
axis_title(text, base, length) = sprintf("title_font = %d; ", lesser(title_most, title_size(text, length))).\
    "unset ylabel; set label 905 ".quoted_twice(title_text(text, length)).\
    sprintf(" at screen across(%g), up(%g) center rotate by 90 noenhanced font point_size(title_font)", \
        14 + 17*title_lines(text, length), base + 0.5*length)
quoted_twice(text) = "\"".escaped(text)."\""
escaped(text) = text eq "" ? "" : (text[1:1] eq "\n" ? "\\n" : strstrt("\\\"\140@", text[1:1]) > 0 ? octal(text[1:1]) : text[1:1])\
    .escaped(text[2:*])
octal(letter) = "\\".word("134 042 140 100", strstrt("\\\"\140@", letter))

# Of the panels of panels.gp: whether one has a logarithmic axis, what its axis takes in besides the curves, what is done before it is
# drawn, and parts of its plot command below and above the curves, a comma behind each, with their entries of the legend, a comma before each.
is_logarithmic(panel) = 0
shown_low(panel) = NaN                              # where its axis ends whatever its curves do
shown_high(panel) = NaN
also_shown(panel) = NaN
also_reached(panel) = NaN                           # likewise, of a greatest value where the other is a least one
before_panel(panel) = ""
parts_below(panel) = ""
parts_above(panel) = ""
keys_of(panel) = ""
key_longest = 0                                     # the width of their words, where it is not that of titles
# Of all: where curve k is marked, the rows of which there are as many at least, the height of one of so many, the line of a curve, whether panels of nothing but zeros are kept; whether marks are shifted from curve to
# curve, and lie, like the dots, above all lines; their legends: the least number of entries that make one, or one beside all panels, which have
# the same curves, with a title; how many entries make the page wider.
marks_of(k) = sprintf("source_of(%d) every %d::%d using (%s):(%s ? %s : NaN)", \
    k, mark_step(drawn_rows), marks_shifted*mark_first(k, n, drawn_rows), x, picked, word(curves_of[panel], k))
has_curves = 1                                      # they are drawn with line, dots and marks
least_rows = 0
height_of(n) = n == 1 ? 700 : n == 2 ? 400 : 330
share_of(panel) = 1.0                               # of the height
planned_height(panel) = full_height                 # about, for the room that ticks and titles take
tick_room_of(panel) = is_logarithmic(panel) && low_of[panel] > 0 ? log_width(low_of[panel], high_of[panel]) \
    : value_width(low_of[panel], high_of[panel], planned_height(panel))
panel_gap = 35
pen_of(k) = 1 + (k - 1)%16
zeros_kept = 0
marks_shifted = 1
in_layers = 0
least_entries = 2
legend_once = 0
when_planned = ""                                   # done when it is known which panels are drawn: is_drawn(panel)
legend_title = ""
line_of(panel) = "lines"
legend_entries = 1

# Measured points that draw_figures.sh hands over: overlays, their number, and of each overlay_1, a file, its names and units overlay_x_1,
# overlay_x_unit_1, overlay_y_1, overlay_y_unit_1, and overlay_title_1. They lie where a column or the title of an axis has the name, and the unit is the same.
# A figure that draws one says so in the file `overlaid`.
if (!exists("overlays")) { overlays = 0 }
of_overlay(what, k) = value(sprintf("overlay_%s%d", what, k))
fits_axis(what, k, names, unit) = strstrt(names, "|".of_overlay(what."_", k)."|") > 0 \
    && (of_overlay(what."_unit_", k) eq "" || of_overlay(what."_unit_", k) eq unit)
is_overlaid(k, xs, x_unit, ys, y_unit) = fits_axis("x", k, xs, x_unit) && fits_axis("y", k, ys, y_unit)
measured_look(k) = sprintf("points pt %d ps 1.6 lw 2.5 lc rgb '#D00000'", int(word("2 1 3 8", 1 + (k - 1)%4)))
measured(k, xs, x_unit, ys, y_unit) = k > overlays ? "" : (!is_overlaid(k, xs, x_unit, ys, y_unit) ? "" : (said = system("echo ".k." >> ".quoted(overlaid)), \
    sprintf(", overlay_%d using 1:2 with %s title overlay_title_%d", k, measured_look(k), k))).measured(k + 1, xs, x_unit, ys, y_unit)
measured_width(k, size) = k > overlays ? 0 : larger(text_width(of_overlay("title_", k), size), measured_width(k + 1, size))

# ---- Curves against the crank angle ---------------------------------------------------------------------------
# The legend stands in columns of its own at the right, so it never meets a curve; what is beyond three columns is counted.
# The page is as wide as its ticks and the words of its legend make it.

legend_rows = 14
listed(n) = n > 3*legend_rows ? 3*legend_rows - 1 : n
columns_of(entries) = entries > 2*legend_rows ? 3 : entries > legend_rows ? 2 : 1
unlisted(n) = n > listed(n) ? sprintf("… +%d", n - listed(n)) : ""

# The plan of a page h high, with ticks and words of the legend so wide and titles of so many lines. A page of a given size
# keeps its letters at 7 points, if the plot keeps 420 pixels, and three quarters of its height.
left_room(ticks, lines) = larger(130, 60 + 34*lines + ticks)
legend_width(entries, longest) = entries == 0 ? 15 : columns_of(entries)*larger(230, 130 + longest) - 15
plan_width(fixed, h) = !sized ? larger(common_width, fixed + 900) : larger(larger(lesser(fixed + 1160, 96*inches(figure_width)/0.35), fixed + 420), \
    0.75*h*figure_width/figure_height)
legend_plan(h, left, legend) = sprintf("plot_left = %d; plot_width = %d; ", left, plan_width(left + legend + 15, h) - left - legend - 15).\
    (sized ? open_page(plan_width(left + legend + 15, h), top_cut + plan_width(left + legend + 15, h)*figure_height/(1.0*figure_width)) \
    : open_page(plan_width(left + legend + 15, h), h)).\
    "; set lmargin at screen across(plot_left); set rmargin at screen across(plot_left + plot_width); key_left = plot_left + plot_width + 15; ".\
    "set key at screen across(key_left), down(125) left top Left reverse vertical samplen 3.2 spacing 1.35 maxrows ".legend_rows
legend_page(h, entries, longest, ticks, lines) = legend_plan(h, left_room(ticks, lines), legend_width(entries, longest))
panel_room = "(page_height + top_cut - 125)"       # pixels below the heading

# A page of one panel: entries of the legend and the width of the widest, the title of the value axis and its unit.
page_of_one(entries, longest, name, unit, low, high) = "lower = foot(lines_of_notes(note, remark)); ".\
    legend_page(1000, entries, longest, value_width(low, high, 700), planned_lines(value_title(name, unit, low, high), 700)).\
    "; eval heading; plot_height = @panel_room - lower; set tmargin at screen down(125); set bmargin at screen up(lower)".\
    sprintf("; eval value_axis(%.15g, %.15g, plot_height); eval axis_title(%s, lower, plot_height)", low, high, \
        quoted_twice(value_title(name, unit, low, high)))
crank_step(lowest, highest) = highest - lowest > 1800 ? 360*ceil((highest - lowest)/3240.0) : highest - lowest > 1000 ? 180 : highest - lowest > 750 ? 120 : highest - lowest > 400 ? (plot_width < 800 ? 120 : 60) : highest - lowest > 150 ? (plot_width < 800 ? 60 : 30) : 15
crank_axis(lowest, highest) = (unit_crank ne "deg" ? abscissa(lowest, highest) : lowest == highest \
    ? sprintf("set xrange [%g:%g]; set xtics 10; set mxtics 2", lowest - 30, highest + 30) \
    : highest - lowest > 150 \
    ? sprintf("set xrange [%d:%d]; set xtics %d; set mxtics 3", 30*floor(lowest/30.0), 30*ceil(highest/30.0), \
        crank_step(lowest, highest)) \
    : sprintf("set xrange [%.12g:%.12g]; set xtics %s; set mxtics 3", lowest, highest, highest - lowest > 60 ? "15" : "auto")).\
    "; set xlabel crank_title(unit_crank) noenhanced"

# An abscissa between low and high.
abscissa_high(low, high) = high > low ? 1.0*high : low + larger(1, 0.1*abs(low))
abscissa_low(low, high) = high > low ? 1.0*low : low - larger(1, 0.1*abs(low))
abscissa_fine(low, high) = nice((abscissa_high(low, high) - abscissa_low(low, high))/9.0)
abscissa_count(low, high) = larger(2, lesser(9, plot_width/(45 + tick_width(abscissa_low(low, high), abscissa_high(low, high), \
    abscissa_fine(low, high), power_of(abscissa_low(low, high), abscissa_high(low, high))))))
abscissa_step(low, high) = nice((abscissa_high(low, high) - abscissa_low(low, high))/abscissa_count(low, high))
abscissa(low, high) = abscissa_between(abscissa_low(low, high), abscissa_high(low, high), abscissa_step(low, high))
abscissa_between(low, high, step) = sprintf("set xrange [%.15g:%.15g]; set xtics (%s)", low, high, \
    ticks_between(low, high, step, power_of(low, high)))
degree_step(range) = range < 14 ? nice(range/8) : range < 40 ? 5 : range < 130 ? 15 : range < 250 ? 30 : range < 400 ? 45 : range < 800 ? 90 : 180*ceil(range/1440)
abscissa_title(name, unit, low, high) = name.bracketed(unit_and_power(unit, power_of(abscissa_low(low, high), abscissa_high(low, high))))

# A curve is a line, a dot at every computed position, and marks on some of these, shifted from curve to curve so that curves
# lying on one another can still be told apart. Where positions are few, the line is thin and the dots are thick: what was
# computed is the dots.
few(n) = n <= 60
line_width(n) = few(n) ? 1.5 : 3
dot_size(n) = n <= 24 ? 0.1 : few(n) ? 0.7 : n <= 150 ? 0.4 : 0.1
mark_step(n) = n > 24 ? n/12 : 1
mark_first(curve, curves, n) = n > 24 ? ((curve - 1)*mark_step(n))/curves : 0

# A style of the user's own, last of all.
if (exists("figure_style")) { load figure_style }
