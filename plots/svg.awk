# What the terminal svg leaves to be done: marks of the size that other terminals give them, and with outlines of some width;
# fonts that there are everywhere, as wide as planned; the size of the picture, if one is given (width, height, each with unit).

BEGIN {
    shrink = 0.403
    title = ENVIRON["title"]
    gsub(/[\\&]/, "\\\\&", title)
}

/<svg/ { head = 1 }

# The headline as the title, which browsers show.
title && /<title>Gnuplot<\/title>/ { sub(/>Gnuplot</, ">" title "<") }

{ sub(/<title>gnuplot_plot_[0-9a-z]*<\/title>/, "") }

head && width && /width="[^"]*" height="[^"]*"/ {
    sub(/width="[^"]*" height="[^"]*"/, "width=\"" width "\" height=\"" height "\"")
    head = 0
}

{
    gsub(/font-family="Sans"/, "font-family=\"DejaVu Sans, Verdana, sans-serif\"")
    if (/id='gpPt/) sub(/stroke-width='0.133'/, "stroke-width='0.4'")
    rest = $0
    line = ""
    while (/<use/ && match(rest, /scale\([0-9.]+\)/)) {
        line = line substr(rest, 1, RSTART - 1) sprintf("scale(%.2f)", shrink * substr(rest, RSTART + 6, RLENGTH - 7))
        rest = substr(rest, RSTART + RLENGTH)
    }
    print line rest
}
