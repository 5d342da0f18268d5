# What a parameter of a deck is, from its echo.deck on standard input: name=L gives "length of link crank" where the deck says
# LINK crank … length=$L and L nowhere else, and an empty line where it is used in several places or in some other way.

BEGIN {
    what["thickness"] = what["width"] = what["density"] = what["length"] = ""
    what["E"] = "Young's modulus"
    what["G"] = "shear modulus"
    what["A"] = "area"
    what["I"] = "second moment of area"
}

/^ *!/ { next }

$1 == "VARY" || $1 == "TITLE" { next }

{
    sub(/ !.*/, "")
    for (i = 2; i <= NF; i++) {
        if (!index($i, "$")) continue
        value = $i
        sub(/^[^=]*=/, "", value)
        if (!uses_name(value)) continue
        uses++
        key = substr($i, 1, index($i, "=") - 1)
        place = $1 == "LINK" ? "link" : $1 == "SECTION" ? "section" : $1 == "MATERIAL" ? "material" : ""
        meaning = tolower(value) == "$" tolower(name) && key in what && place != "" ? (what[key] == "" ? key : what[key]) " of " place " " $2 : ""
    }
}

END { print uses == 1 ? meaning : "" }

# Names are made of letters, digits and _ - . \047, without regard to case.
function uses_name(text,    place, next_one) {
    text = tolower(text)
    while (place = index(text, "$" tolower(name))) {
        text = substr(text, place + length(name) + 1)
        next_one = substr(text, 1, 1)
        if (next_one !~ /[a-z0-9_.\047-]/) return 1
    }
    return 0
}
