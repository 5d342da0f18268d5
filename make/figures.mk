# Runs of decks, and their figures.
.PHONY: thesis run figures animate report

thesis: all
	$(program) inputs/mechanism1.deck inputs/mechanism2.deck
	@sh plots/draw_figures.sh outputs/mechanism1
	@sh plots/draw_figures.sh outputs/mechanism2

# need NAME,FILE,COMPLAINT,EXAMPLE: go no further without the file that the variable tells
need = @test -f "$(2)" || { why=$${$(1):+there is no $(3)}; printf 'make: %s; say: make $@ $(1)=$(4)\n' "$${why:-$(1) is missing}" >&2; exit 2; }
need_deck = $(call need,DECK,$$DECK,file $$DECK,inputs/mechanism1.deck)
need_case = $(call need,CASE,inputs/$$CASE.deck,inputs/$$CASE.deck,mechanism1)

run: all
	$(need_deck)
	$(program) -- "$$DECK"

# FORMAT=svg, SIZE=1200x800, ONLY=campbell, STYLE=FILE, OVERLAY=FILE:X:Y, TITLES=no, ERRORS=yes: what flexmech-plot has options for.
yes_or_no = @case $$$(1) in ''|yes|no) ;; *) printf 'make: $(1)=%s: yes or no\n' "$$$(1)" >&2; exit 2 ;; esac
figure_options = $${FORMAT:+--format "$$FORMAT"} $${SIZE:+--size "$$SIZE"} $$([ "$$TITLES" != no ] || echo --no-titles) \
                 $${ONLY:+--only "$$ONLY"} $${STYLE:+--style "$$STYLE"} $${OVERLAY:+--overlay "$$OVERLAY"} \
                 $$([ "$$ERRORS" != yes ] || echo --errors)
draw = FLEXMECH_PLOT=make sh plots/draw_figures.sh
# What the program has written of the deck: its name without folder and ending.
of_deck = @name=$${DECK\#\#*/}; stem=$${name%.*}; $(1) -- "outputs/$${stem:-$$name}"

figures: all
	$(need_deck)
	$(call yes_or_no,TITLES)
	$(call yes_or_no,ERRORS)
	@$(draw) $(figure_options) --help > /dev/null
	@# Exit status 1: some rows could not be computed. The figures show where.
	$(program) -- "$$DECK" || test $$? -eq 1
	$(call of_deck,$(draw) $(figure_options))

animate: all
	$(need_deck)
	$(program) -- "$$DECK" || test $$? -eq 1
	$(call of_deck,$(draw) --animate)

report: all
	$(need_deck)
	$(program) -- "$$DECK" || test $$? -eq 1
	$(call of_deck,plots/flexmech-report)
