# How large figures of mode shapes draw displacements: a share of the longest link, and of a linkage that is no four-bar, whose links
# may be polylines, of the larger side of what is drawn at rest. Loaded after `eval answer(table, "facts")`.

placed = exists("is_placed")        # by the program (draw_figures.sh hands it over)
share = of_cycle ? 0.12 : 0.15
compared = of_cycle ? "the larger side of the linkage" : "the longest link"
at_rest(crank) = answer(table, "reach ".crank." 0")
side_of(corners) = larger(word(corners, 3) - word(corners, 1), word(corners, 4) - word(corners, 2))
side_of_modes(crank) = of_cycle ? side_of(at_rest(crank)) : high_s          # crank: one, or `all`
