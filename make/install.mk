# Program, commands, plots, documents, decks, library, manual pages and completions below DESTDIR/PREFIX.
.PHONY: install

there = $$DESTDIR$$PREFIX
share = $(there)/share
# Not `all`: `sudo make install` after `make` must not write into build/ as root.
install:
	@test -x $(program) || { echo "make: nothing is built yet; say: make" >&2; exit 2; }
	install -d -- "$(there)/bin" "$(share)/flexmech" "$(share)/man/man1" \
	    "$(share)/bash-completion/completions" "$(share)/zsh/site-functions" "$(share)/fish/vendor_completions.d"
	install -m 755 -- $(program) "$(there)/bin/flexmech"
	cp -R -- plots library docs inputs README.md CHANGELOG.md CITATION.cff LICENSE "$(share)/flexmech/"
	install -d -- "$(share)/flexmech/exchange/flexmech_files"
	install -m 644 -- exchange/flexmech_files/*.py "$(share)/flexmech/exchange/flexmech_files"
	install -m 755 -- plots/flexmech-plot plots/flexmech-report exchange/flexmech-import exchange/flexmech-export "$(there)/bin"
	$(program) --man > "$(share)/man/man1/flexmech.1"
	$(program) --completion bash > "$(share)/bash-completion/completions/flexmech"
	$(program) --completion zsh > "$(share)/zsh/site-functions/_flexmech"
	$(program) --completion fish > "$(share)/fish/vendor_completions.d/flexmech.fish"
	for command in plots/flexmech-plot plots/flexmech-report exchange/flexmech-import exchange/flexmech-export; do \
	    name=$${command##*/}; help=$$("$$command" --help) || exit; \
	    printf '%s\n' "$$help" | awk -v version="$$($(program) --version)" -f plots/manual_page.awk > "$(share)/man/man1/$$name.1" && \
	    printf '%s\n' "$$help" | awk -f plots/completion.awk > "$(share)/bash-completion/completions/$$name" || exit; \
	done
