# A function for scripts that write what gnuplot reads, with -f quoted.awk before their own.

# A text as gnuplot reads it: within apostrophes, or, where it has one itself (gnuplot 5.4 misreads two of them) or several lines, within
# quotation marks with what means something there by its octal number.
function quoted(text) {
    if (text !~ /[\047\n]/) return "\047" text "\047"
    gsub(/\\/, "\\\\134", text)
    gsub(/"/, "\\\\042", text)
    gsub(/`/, "\\\\140", text)
    gsub(/\n/, "\\\\012", text)
    gsub(/@/, "\\\\100", text)
    return "\"" text "\""
}
