# Natural frequencies against a varied parameter: for every mode a band between the least and the greatest over the positions.
# Other parameters and the speed are those of the first row. What the parameter is, is in echo.deck beside the table.

numbers = ""                                        # of the modes that the table has
names = ""
do for [name in columns] { if (is_numbered(name, "f")) { numbers = numbers." ".name[2:*]; names = names." ".name } }
modes = words(numbers)
mode(k) = int(word(numbers, k))
range = answer(table, "range".names)
lowest = word(range, 1) + 0.0
highest = word(range, 2) + 0.0
# A name may be one that no variable can have.
unit_named(name) = (its_unit = answer(table, "unit ".name), its_unit eq "-" ? "" : typeset(its_unit))
with_unit(text, name) = unit_named(name) eq "" ? text : text." ".unit_named(name)
fixed = at_speed(word(answer(table, "distinct speed"), 1) + 0, unit_speed)
do for [name in answer(table, "varied")] {
    if (name ne other) { fixed = fixed.", ".with_unit(sprintf("%s = %.10g", inside(name, 30), word(answer(table, "distinct ".name), 1) + 0), name) }
}
echo = system("dirname ".quoted(table))."/echo.deck"
meaning = system("[ ! -f ".quoted(echo)." ] || awk -v name=".quoted(other)." -f ".quoted(plots."meaning.awk")." < ".quoted(echo))
load keep("bands", table, "band ".other)
values = |$bands|

headline = numbered(figure, "Natural frequencies against ".(meaning eq "" ? inside(other, 50) : "the ".inside(meaning, 50)))
note = "bands: least to greatest over the computed crank angles;  ".fixed
if (lowest < 0 && remark eq "") { remark = divergence }

eval page_of_one(modes, text_width(sprintf("mode %d", mode(modes)), 20), "natural frequency", value("unit_f".mode(1)), lowest, highest)
set style fill transparent solid 0.25 noborder
extent = answer(table, "range ".other)
low = word(extent, 1) + 0.0
high = word(extent, 2) + 0.0
eval abscissa(low, high)
# A single value has a band without width: its ends are drawn as points.
if (high == low) { eval abscissa(low - (low == 0 ? 1 : 0.01*abs(low)), low + (low == 0 ? 1 : 0.01*abs(low))) }
x_title = abscissa_title(meaning eq "" ? other : meaning.", ".other, answer(table, "unit ".other), low, high)
set xlabel fitted(x_title, plot_width + 100, 16) noenhanced font point_size(fit_size(x_title, plot_width + 100, 20, 16))

plot for [k=1:modes] $bands using 1:(column(2*k)):(column(2*k + 1)) with filledcurves lt mode(k) notitle, \
    for [k=1:modes] $bands using 1:(column(2*k)) with lines lt mode(k) lw line_width(values) notitle, \
    for [k=1:modes] $bands using 1:(column(2*k + 1)) with lines lt mode(k) lw line_width(values) notitle, \
    for [k=1:modes] $bands using 1:(column(2*k)) with points lt mode(k) pt 7 ps dot_size(values) notitle, \
    for [k=1:modes] $bands using 1:(column(2*k + 1)) with points lt mode(k) pt 7 ps dot_size(values) notitle, \
    for [k=1:listed(modes)] keyentry with lines lt mode(k) title sprintf("mode %d", mode(k)), \
    keyentry title unlisted(modes)
