# The tests, and what they compare with.
.PHONY: check check-all fuzz memory golden

# One compilation of the sources, of the program as users have it: the debug build would take as long as everything else.
check: setup
	@rm -f build/check.count
	$(stage) kind=release $(program) build/release/$(unit_tests) $(if $(shell command -v mpifort),$(of_mpi))
	@python3 -B $(support)/check.py $(unit_tests)

# What `make check` leaves out, and all slow families; ONLY="fuzz threads" for some. The table is in check_all.py.
check-all: all debug
	@PACKAGE=yes LINTIAN=yes SANITIZERS=yes sh $(support)/setup.sh
	$(stage) kind=sanitize build/sanitize/flexmech
	$(stage) kind=debug build/debug/bench/bench build/debug/$(unit_tests)
	$(stage) kind=release $(portable) build/release/$(unit_tests) build/release/bench/bench build/release/stress/responses build/release/stress/stability \
	    build/release/stress/read_words $(if $(shell command -v mpifort),$(of_mpi))
	@set -f; python3 -B $(support)/check_all.py $(unit_tests) $$ONLY

# The same SEED makes the same decks.
FUZZ ?= 10000
SEED ?= 1
fuzz: debug
	@python3 -B $(support)/fuzz.py "$$FUZZ" "$$SEED"

memory:
	@SANITIZERS=yes sh $(support)/setup.sh
	$(stage) kind=sanitize build/sanitize/flexmech
	@python3 -B $(support)/check_memory.py

golden: all
	$(need_case)
	@rm -rf "build/golden/$$CASE"
	@# Exit status 1: some rows could not be computed, which may be what the case is there to show.
	$(program) --out build/golden "inputs/$$CASE.deck" || test $$? -eq 1
	@rm -rf "tests/golden/$$CASE" && mkdir -p "tests/golden/$$CASE"
	cp "build/golden/$$CASE"/*.dat "tests/golden/$$CASE/"
