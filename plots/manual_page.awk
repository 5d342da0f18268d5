# The manual page of flexmech-plot, flexmech-report, flexmech-import and flexmech-export, from its --help:
#   flexmech-plot --help | awk -v version="flexmech 1.2.3" -f manual_page.awk > flexmech-plot.1
# The help has a line `usage: …`, paragraphs, of which the first begins with what the command does and a comma or colon, options
# indented by two blanks with what they are for behind two blanks, and a line `Exit status: …`.

# Hyphens as they are typed, and no dot or quote that man would take for a macro.
function escaped(words) {
    gsub(/\\/, "\\e", words)
    gsub(/-/, "\\-", words)
    return words ~ /^[.']/ ? "\\&" words : words
}

function section(title) {
    print ".SH " title
    open = title
}

/^usage: / {
    name = $2
    printf ".TH %s 1 \"\" \"%s\" \"User Commands\"\n", toupper(name), version
    sub(/^usage: [^ ]* */, "")
    synopsis = $0
    next
}

/^  -/ {
    if (open != "OPTIONS") section("OPTIONS")
    line = substr($0, 3)
    gap = index(line, "  ")
    term = gap ? substr(line, 1, gap - 1) : line
    meaning = gap ? substr(line, gap) : "These words, or the version."
    sub(/^ */, "", meaning)
    print ".TP\n\\fB" escaped(term) "\\fR\n" escaped(meaning)
    next
}

/^Exit status: / {
    section("EXIT STATUS")
    sub(/^Exit status: /, "")
    print escaped($0)
    next
}

/^$/ { next }

{
    if (!open) {
        section("NAME")
        what = tolower(substr($0, 1, 1)) substr($0, 2)
        sub(/[,:].*/, "", what)
        print escaped(name) " \\- " escaped(what)
        section("SYNOPSIS")
        print ".B " escaped(name)
        print escaped(synopsis)
        section("DESCRIPTION")
    }
    sub(/^ */, "")
    print escaped($0)
}

END {
    section("SEE ALSO")
    print ".BR flexmech (1)"
}
