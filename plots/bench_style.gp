# What the figures of `make bench` share: every solver has one line in all of them. Loaded after style.gp.

text_mode = "enhanced"                              # powers of ten at their axes
solvers = "dsygv dsygvx band deformation sweep accuracy"
heading_of(k) = word("dsygv dsygvx band deformation sweep accuracy=", k + 0)
line_of(k) = int(word("7 3 4 5 2 1", k + 0))
width_of(k) = k + 0 == 6 ? 5 : 3
mark_of(k) = int(word("10 4 12 6 9 7", k + 0))

# The rows of a table that have these values in these columns.
where_is(name, wanted) = sprintf("$%d == %s", value("col_".name), "\"".wanted."\"")
rows_where(table, condition) = "< awk ".quoted("!/^#/ && ".condition)." ".quoted(table)
count_where(table, condition) = int(system("awk ".quoted("!/^#/ && ".condition." { n++ } END { print n + 0 }")." ".quoted(table)))

# The lines of a table's head that name machine and compiler.
machine_of(table) = system("sed -n 's/^# machine: //p; s/^# compiler: //p' ".quoted(table)." | paste -s -d ';' | sed 's/;/;  /'")
