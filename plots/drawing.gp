# Drawings of mechanisms: what their scripts share. Loaded after style.gp.

text_height(size) = 1.55*size                       # of a line, in pixels

# A number in at most four digits, and with its unit: 12.5 kN, 300·10³ lbf.
brief(value) = value == 0 ? "0" : abs(value) < 1e6 && abs(value) >= 1e-3 ? (digits = 3 - int(floor(log10(abs(value)) + 1e-9)), \
    minus(digits <= 0 ? sprintf("%.0f", floor(value*10.0**digits + 0.5)/10.0**digits) : \
    plain(sprintf(sprintf("%%.%df", digits), value)))) : sprintf("%.3g", value)
plain(text) = strstrt(text, ".") == 0 ? text : text[strlen(text):*] eq "." ? text[1:strlen(text) - 1] \
    : text[strlen(text):*] eq "0" ? plain(text[1:strlen(text) - 1]) : text
five_digits(value) = abs(value) >= 1e-4 && abs(value) < 10000 ? minus(sprintf("%#.5g", value)) : minus(sprintf("%.5g", value))
amount_power(value, unit) = takes_prefix(unit, power_of(value, value)) || abs(value) >= 1e6 || abs(value) < 1e-3 \
    ? power_of(value, value) : 0
amount_in(value, power) = brief(value/10.0**power)
amount_unit(unit, power) = (power == 0 || takes_prefix(unit, power) ? " " : "·").unit_and_power(unit, power)
amount(value, unit) = amount_in(value, amount_power(value, unit)).amount_unit(unit, amount_power(value, unit))

# Labels that keep clear of curves and of each other. Lines for labels.awk are printed to the file `places`, in the pixels of the
# page; `load labels_as("block")` makes the block.
places = out.".labels"
labels_as(block) = "< awk -v datablock=".block." -f ".quoted(plots."labels.awk")." ".quoted(places)

# Of tiles (tiles.gp): the largest and the least width, lines below each, pixels to the left of all and above their columns.
tile_limit = 400.0
tile_least = 200
caption_lines = 1
lead_room = 0
head_of_columns = 0

# Pixels to a unit of the axes, of a drawing alone on its page.
drawing_scale(x0, x1, y0, y1) = lesser(1330/(x1 - x0), 830/(y1 - y0))

# ---- Chains of nodes ------------------------------------------------------------------------------------------

# Extent, both ends, the angle of the first link and the shortest element of the chain of links; the script sets nodes, the name of the block.
measure = "stats nodes using 2:3 name 'all' nooutput; ".\
    "x_min = all_min_x; x_max = all_max_x; y_min = all_min_y; y_max = all_max_y; ".\
    "span = larger(x_max - x_min, y_max - y_min); begun = 0; nearest = span; ".\
    "stats nodes using (begun == 0 ? (first_x = $2, first_y = $3, ".\
    "first_angle = arg($4 + {0, 1}*$5)*180/pi, begun = 1) : 0, last_x = $2, last_y = $3, ".\
    "nearest = $9 > 0 && $9 < nearest ? $9 : nearest, 0) nooutput"

# Of those nodes: pins (where a link begins, but for the clamped root of the first, and the end of the last).
is_pin(value) = ($6 == 0 && ($2 != first_x || $3 != first_y)) || ($2 == last_x && $3 == last_y) ? value : NaN

# Places for their numbers. Where a number needs more room (a share of the span) than there is, every nth is shown.
crowded(share) = ceil(share*span/nearest)
every_nth(share) = $9 > 0 ? ceil(share*span/$9) : 1
shown(share, value) = $6 == 0 || $6 == $7 || (int($6) % every_nth(share) == 0 && $7 - $6 >= every_nth(share)) ? value : NaN
row_shown(row, share) = word(row, 6) == 0 || word(row, 6) == word(row, 7) || (word(row, 9) > 0 \
    && int(word(row, 6))%int(ceil(share*span/word(row, 9))) == 0 && word(row, 7) - word(row, 6) >= ceil(share*span/word(row, 9)))
beside_x(room) = $2 + $10*room
beside_y(room) = $3 + $11*room
