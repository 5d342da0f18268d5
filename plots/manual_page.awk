# The manual page of flexmech-plot, flexmech-import and flexmech-export, from its --help:
#   flexmech-plot --help | awk -v version="flexmech 1.2.3" -f manual_page.awk > flexmech-plot.1
# The help has a line `usage: …`, paragraphs, options indented by two blanks with what they are for behind two blanks, and
# a line `Exit status: …`.

BEGIN {
    purpose["flexmech-plot"] = "draws figures of what flexmech has computed"
    purpose["flexmech-import"] = "makes a deck of another program's file"
    purpose["flexmech-export"] = "writes the linkage of a deck as SVG or DXF"
}

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
    section("NAME")
    print escaped(name) " \\- " escaped(purpose[name])
    section("SYNOPSIS")
    sub(/^usage: [^ ]* */, "")
    print ".B " escaped(name)
    print escaped($0)
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
    if (open == "SYNOPSIS") section("DESCRIPTION")
    sub(/^ */, "")
    print escaped($0)
}

END {
    section("SEE ALSO")
    print ".BR flexmech (1)"
}
