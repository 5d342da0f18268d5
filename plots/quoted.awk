# A function for scripts that write what gnuplot reads, with -f quoted.awk before their own.

# A text as gnuplot reads it: within apostrophes, or, where it has one itself (gnuplot 5.4 misreads two of them), within quotation marks
# with what means something there by its octal number.
function quoted(text) {
    if (text !~ /\047/) return "\047" text "\047"
    gsub(/\\/, "\\\\134", text)
    gsub(/"/, "\\\\042", text)
    gsub(/`/, "\\\\140", text)
    gsub(/@/, "\\\\100", text)
    return "\"" text "\""
}
