# What figures against a varied parameter share: what it is, by echo.deck beside the table, as `meant`; the other parameters, which are those
# of the first row, as `fixed`, each behind a comma; and the abscissa. A name may be one that no variable can have.

unit_named(name) = (its_unit = answer(table, "unit ".name), its_unit eq "-" ? "" : typeset(its_unit))
first_value(name) = sprintf("%s = %.10g", inside(name, 30), word(answer(table, "distinct ".name), 1) + 0).\
    (unit_named(name) eq "" ? "" : " ".unit_named(name))
fixed = ""
place = 0
do for [name in answer(table, "varied")] {
    place = place + 1
    if (name eq other) { x = sprintf("column(%d)", place) } else { fixed = fixed.", ".first_value(name) }
}
echo = system("dirname ".quoted(table))."/echo.deck"
meaning = system("[ ! -f ".quoted(echo)." ] || awk -v name=".quoted(other)." -f ".quoted(plots."meaning.awk")." < ".quoted(echo))
meant = meaning eq "" ? inside(other, 50) : "the ".inside(meaning, 50)

# A single value has a band without width: its ends are drawn as points.
extent = answer(table, "range ".other)
low_place = word(extent, 1) + 0.0
high_place = word(extent, 2) + 0.0
if (high_place == low_place) { margin = low_place == 0 ? 1 : 0.01*abs(low_place); low_place = low_place - margin; high_place = high_place + margin }
x_title = "x_axis_title = abscissa_title(meaning eq '' ? other : meaning.', '.other, answer(table, 'unit '.other), low_place, high_place)"
x_axis = "eval abscissa(low_place, high_place); ".x_title."; set xlabel fitted(x_axis_title, plot_width + 100, 16) noenhanced ".\
    "font point_size(fit_size(x_axis_title, plot_width + 100, 20, 16))"
set style fill transparent solid 0.25 noborder
