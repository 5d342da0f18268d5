# Measured points for figures: awk -v at=X -v over=Y -f overlay.awk FILE. The file has a line a point, commas, semicolons, tabs or blanks between
# numbers, a line of headings before them, such as `crank [deg],torque [N.m]`, and comments behind #; X and Y are columns by number or
# by heading, with or without its unit. The answer is, on one line, name and unit of both, a | between, then the points. What is wrong
# is told behind an exclamation mark.

/^[ \t]*#/ || !/[^ \t\r,;]/ { next }

!apart {
    sub(/^\357\273\277/, "")
    apart = /,/ ? "," : /;/ ? ";" : /\t/ ? "\t" : " "
}

{
    sub(/\r$/, "")
    n = split($0, value, apart)
    for (i = 1; i <= n; i++) { gsub(/^[ \t"]+|[ \t"]+$/, "", value[i]) }
}

!headed {
    headed = 1
    for (i = 1; i <= n; i++) if (!is_number(value[i])) has_names = 1
    for (i = 1; i <= n && has_names; i++) {
        name[i] = value[i]
        unit[i] = ""
        if (match(name[i], / *\[[^]]*\]$/)) {
            unit[i] = substr(name[i], RSTART, RLENGTH)
            gsub(/[][ ]/, "", unit[i])
            name[i] = substr(name[i], 1, RSTART - 1)
        }
        headings = headings (i > 1 ? ", " : "") value[i]
    }
    if (!has_names) wrong("no headings in its first line; expected names and units, such as crank [deg],torque [N.m]")
    columns = n
    x = place(at)
    y = place(over)
    print name[x] "|" unit[x] "|" name[y] "|" unit[y]
    next
}

{
    if (!is_number(value[x]) || !is_number(value[y])) wrong("line " NR ": " value[x] ", " value[y] ": expected numbers")
    print value[x] + 0, value[y] + 0
    points++
}

END { if (!failed && !points) wrong("no points") }

function place(column,    i) {
    if (column ~ /^[0-9]+$/ && column >= 1 && column <= columns) return column + 0
    for (i = 1; i <= columns; i++) if (column == name[i] || column == name[i] " [" unit[i] "]") return i
    wrong("no column " column "; expected a number from 1 to " columns " or one of: " headings)
}

function is_number(text) { return text ~ /^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$/ }

function wrong(what) {
    failed = 1
    print "!" what
    exit 1
}
