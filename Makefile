# FLEXMECH. `make help` lists what can be asked for.
#
# This file runs in two stages. The targets a person types first see that the tools are there (`setup`), then call
# this file again with kind=release or kind=debug. Only that second call looks at sources, compilers and archives:
# on a fresh machine there is no gfortran yet when the first one is read.

# What is typed at make is a text: not expanded here, and in commands only as "$$NAME", where the shell does not read it either.
$(foreach name,$(.VARIABLES),$(if $(findstring command,$(origin $(name))),$(eval override $(name) := $$(value $(name)))$(eval export $(name))))

ifeq ($(origin FC),default)
FC = gfortran
endif
export FC
BLAS   ?= reference
export BLAS
# MPI=yes: the program for several processes, too. Its compiler is a wrapper around FC.
export MPI
export OMPI_FC  = $(FC)
export MPICH_FC = $(FC)
PREFIX ?= /usr/local
export PREFIX SPEEDS FUZZ SEED CASES FIRST FREQUENCIES LINKAGES LOADS VIBRATIONS

program = build/release/flexmech
of_mpi  = build/mpi/flexmech
support = tests/support
# The second stage uses every processor unless the caller has said how many. V=1 shows the commands in full.
stage   = +@$(MAKE) --no-print-directory $(if $(V),,-s) $(if $(findstring -j,$(MAKEFLAGS)),,-j$(shell nproc))
# The unit tests, run by the bundled support or by an installed pFUnit.
unit_tests = $(if $(PFUNIT_DIR),pfunit,funit)/unit_tests

ifndef kind
# ---------------------------------------------------------------------------------------------- what a person types
.PHONY: all debug quad thesis run figures animate check documents bench bench-pictures stress stress-responses stress-stability accuracies linkages loads vibrations references fuzz memory scaling check-all golden \
        install setup clean help

# Somebody's environment may have another meaning of it.
$(if $(findstring override,$(origin MPI)),$(if $(filter-out yes no,$(MPI)),$(error MPI=$(MPI): yes or no)))

all: setup
	$(stage) kind=release $(program) $(if $(filter yes,$(MPI)),$(of_mpi))

debug: setup
	$(stage) kind=debug build/debug/flexmech

quad: setup
	$(stage) kind=quad build/quad/flexmech

# Installs what is missing; silent and instant when everything is there.
setup:
	@sh $(support)/setup.sh

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

# FORMAT=svg, SIZE=1200x800, TITLES=no, ERRORS=yes: what flexmech-plot has options for.
yes_or_no = @case $$$(1) in ''|yes|no) ;; *) printf 'make: $(1)=%s: yes or no\n' "$$$(1)" >&2; exit 2 ;; esac
figure_options = $${FORMAT:+--format "$$FORMAT"} $${SIZE:+--size "$$SIZE"} $$([ "$$TITLES" != no ] || echo --no-titles) \
                 $$([ "$$ERRORS" != yes ] || echo --errors)
draw = FLEXMECH_PLOT=make sh plots/draw_figures.sh
# What the program has written of the deck: its name without folder and ending.
draw_deck = @name=$${DECK\#\#*/}; stem=$${name%.*}; $(draw) $(1) -- "outputs/$${stem:-$$name}"

figures: all
	$(need_deck)
	$(call yes_or_no,TITLES)
	$(call yes_or_no,ERRORS)
	@$(draw) $(figure_options) --help > /dev/null
	@# Exit status 1: some rows could not be computed. The figures show where.
	$(program) -- "$$DECK" || test $$? -eq 1
	$(call draw_deck,$(figure_options))

animate: all
	$(need_deck)
	$(program) -- "$$DECK" || test $$? -eq 1
	$(call draw_deck,--animate)

check: setup
	@rm -f build/check.count
	$(stage) kind=release $(program) build/release/bench/bench $(if $(shell command -v mpifort),$(of_mpi))
	$(stage) kind=debug build/debug/flexmech build/debug/$(unit_tests)
	@python3 -B $(support)/check.py $(unit_tests)

# What `make check` leaves out, and all slow families; ONLY="fuzz threads" for some. The table is in check_all.py.
check-all: all debug
	@SANITIZERS=yes sh $(support)/setup.sh
	$(stage) kind=sanitize build/sanitize/flexmech
	$(stage) kind=debug build/debug/bench/bench
	$(stage) kind=release build/release/$(unit_tests) build/release/bench/bench build/release/stress/responses build/release/stress/stability \
	    build/release/stress/read_words
	@set -f; python3 -B $(support)/check_all.py $(unit_tests) $$ONLY

# Numbers of the documents that runs of some seconds give. STRESS=yes: those of the last `make stress` instead.
documents: all
	@python3 -B tests/documents/documents.py $(program) --write $(if $(STRESS),--stress)

bench: all
	$(stage) kind=release build/release/bench/bench
	build/release/bench/bench $(program) outputs/bench "$$BLAS"
	@sh plots/draw_bench.sh outputs/bench

# The pictures of docs/performance.md, from the last `make bench`.
bench-pictures:
	@test -f outputs/bench/ratios.dat || { echo "make: nothing was timed yet; say: make bench" >&2; exit 2; }
	cp outputs/bench/*.png docs/pictures/

SPEEDS ?= 50
stress-stability: all
	$(stage) kind=release build/release/stress/stability
	build/release/stress/stability $(if $(filter file,$(origin CASES)),20,"$$CASES") "$$SPEEDS" $(shell nproc) "$$FIRST"

# The same SEED makes the same decks.
FUZZ ?= 10000
SEED ?= 1
fuzz: debug
	@python3 -B $(support)/fuzz.py "$$FUZZ" "$$SEED"

memory:
	@SANITIZERS=yes sh $(support)/setup.sh
	$(stage) kind=sanitize build/sanitize/flexmech
	@python3 -B $(support)/check_memory.py

stress: all
	@python3 -B tests/stress/run_stress.py $(program)
	@python3 -B tests/documents/documents.py $(program) --stress

# Random mechanisms with elastic response: CASES from FIRST on; the same number is the same mechanism.
CASES ?= 2100
FIRST ?= 1
stress-responses: all
	$(stage) kind=release build/release/stress/responses
	@mkdir -p outputs/stress
	build/release/stress/responses "$$CASES" $(shell nproc) outputs/stress/responses.dat "$$FIRST"

# The same SEED makes the same decks.
FREQUENCIES ?= 100000
accuracies: all
	@python3 -B tests/stress/compare_accuracies.py $(program) --frequencies "$$FREQUENCIES" --seed "$$SEED"

# Decks with known values, and random linkages against an independent solver: linkage SEED and those after it.
LINKAGES ?= 300
linkages: all
	@python3 -B tests/linkages/anchors.py --program $(program)
	@python3 -B tests/linkages/random_linkages.py "$$SEED" "$$LINKAGES" --program $(program)
	@python3 -B tests/linkages/random_motions.py "$$SEED" "$$LINKAGES" --program $(program)

# Random linkages with loads, springs, dampers and friction, in tables and in motion, likewise.
LOADS ?= 1000
loads: all
	@python3 -B tests/linkages/random_loads.py "$$SEED" "$$LOADS" --program $(program)
	@python3 -B tests/linkages/random_load_motions.py "$$SEED" "$$LOADS" --program $(program)

# Decks with exact frequencies, and random linkages that vibrate against counts of eigenvalues, likewise.
VIBRATIONS ?= 1000
vibrations: all
	@python3 -B tests/linkages/exact_frequencies.py --program $(program)
	@python3 -B tests/linkages/random_vibrations.py "$$SEED" "$$VIBRATIONS" --program $(program)
	@python3 -B tests/linkages/random_vibrations.py "$$SEED" $$(expr "$$VIBRATIONS" / 20 + 1) --kind many --program $(program)
	@python3 -B tests/linkages/random_vibrations.py "$$SEED" $$(expr "$$VIBRATIONS" / 5 + 1) --kind slotted --program $(program)

# Times of tasks, ranks here, and a farm of sleeping ranks against its model: docs/scaling.md.
scaling:
	@MPI=yes sh $(support)/setup.sh
	$(stage) kind=release $(program) $(of_mpi) build/scaling/record_tasks build/scaling/sleeping_ranks
	@python3 -B tests/scaling/measure.py

# Quadruple precision for every case of `make stress`: some minutes.
references: all quad
	@python3 -B tests/stress/make_references.py $(program) build/quad/flexmech

golden: all
	$(need_case)
	@rm -rf "build/golden/$$CASE"
	@# Exit status 1: some rows could not be computed, which may be what the case is there to show.
	$(program) --out build/golden "inputs/$$CASE.deck" || test $$? -eq 1
	@rm -rf "tests/golden/$$CASE" && mkdir -p "tests/golden/$$CASE"
	cp "build/golden/$$CASE"/*.dat "tests/golden/$$CASE/"

there = $$DESTDIR$$PREFIX
share = $(there)/share
# Not `all`: `sudo make install` after `make` must not write into build/ as root.
install:
	@test -x $(program) || { echo "make: nothing is built yet; say: make" >&2; exit 2; }
	install -d -- "$(there)/bin" "$(share)/flexmech" "$(share)/man/man1" \
	    "$(share)/bash-completion/completions" "$(share)/zsh/site-functions" "$(share)/fish/vendor_completions.d"
	install -m 755 -- $(program) "$(there)/bin/flexmech"
	cp -R -- plots library "$(share)/flexmech/"
	install -m 755 -- plots/flexmech-plot "$(there)/bin/flexmech-plot"
	$(program) --man > "$(share)/man/man1/flexmech.1"
	$(program) --completion bash > "$(share)/bash-completion/completions/flexmech"
	$(program) --completion zsh > "$(share)/zsh/site-functions/_flexmech"
	$(program) --completion fish > "$(share)/fish/vendor_completions.d/flexmech.fish"
	sh plots/flexmech-plot --help | awk -v version="$$($(program) --version)" -f plots/manual_page.awk > "$(share)/man/man1/flexmech-plot.1"
	sh plots/flexmech-plot --help | awk -f plots/completion.awk > "$(share)/bash-completion/completions/flexmech-plot"

clean:
	rm -rf build outputs

help:
	@echo "make                    build build/release/flexmech (installs missing tools first, as all targets that build)"
	@echo "make MPI=yes            build build/mpi/flexmech too, for mpirun (docs/scaling.md)"
	@echo "make debug              build build/debug/flexmech, with every check the compiler has"
	@echo "make thesis             run both mechanisms of the thesis and draw their figures, in outputs/"
	@echo "make run DECK=FILE      run one deck"
	@echo "make figures DECK=FILE  run one deck and draw what its tables allow; FORMAT=svg or pdf, SIZE=1200x800 or 160x100mm,"
	@echo "                        TITLES=no for bare figures, ERRORS=yes for the estimated errors of the frequencies too"
	@echo "make animate DECK=FILE  run one deck and animate its motion and its modes"
	@echo "make check              all tests: scripts in the release build, unit tests in the debug build, tables in both"
	@echo "make check PFUNIT_DIR=D the same, with the unit tests run by the pFUnit 4 installed in the folder D"
	@echo "make check-all          each in the other build, and the slow families of tests below, reduced; ONLY=\"fuzz threads\" for some"
	@echo "make documents          recompute the numbers of README.md and docs/ that take a few seconds"
	@echo "make bench              time every solver, tables and figures in outputs/bench/ (six minutes)"
	@echo "make bench-pictures     copy these figures to docs/pictures/"
	@echo "make fuzz               10,000 random decks under the debug build; FUZZ=500 SEED=7 for fewer or other ones"
	@echo "make memory             every deck of inputs/ under the sanitizers of addresses, leaks and undefined behaviour"
	@echo "make stress             estimated errors against true ones in extreme cases, with figures, in outputs/stress/"
	@echo "make stress-responses   the same of the elastic response of random mechanisms; CASES=210 FIRST=1 for fewer or others"
	@echo "make stress-stability   verdicts on random mechanisms with several numbers of samples; CASES=20 SPEEDS=50 FIRST=1"
	@echo "make accuracies         random decks at several accuracies, each against the finest; FREQUENCIES=5000 SEED=7"
	@echo "make linkages           known linkages, 300 random ones against an independent solver, and in motion; LINKAGES=5000 SEED=7"
	@echo "make loads              1,000 random linkages with loads, springs and friction against it, and in motion; LOADS=100 SEED=7"
	@echo "make vibrations         known frequencies of linkages, and those of 1,000 random ones; VIBRATIONS=100 SEED=7"
	@echo "make scaling            times of variants on several ranks, and a model of a farm (docs/scaling.md)"
	@echo "make references         regenerate the quadruple-precision values of make stress (hours)"
	@echo "make quad               build build/quad/flexmech, the program in quadruple precision (slow)"
	@echo "make golden CASE=NAME   regenerate tests/golden/NAME/ from inputs/NAME.deck"
	@echo "make install PREFIX=DIR copy flexmech and flexmech-plot to DIR/bin, plots, library, manual page and completions to DIR/share"
	@echo "                        (DESTDIR is honoured)"
	@echo "make setup              only install missing tools"
	@echo "make clean              remove build/ and outputs/"
	@echo "BLAS=openblas           link OpenBLAS instead of the reference LAPACK and BLAS"

else
# -------------------------------------------------------------------------------------- the build itself, of one kind
build = build/$(kind)

# No -ffast-math and no -march=native: the same deck must give the same bytes on every machine of a kind. Arrays are on
# the heap, not on the stack (no -fstack-arrays), and memory that the system refuses is no null pointer (-fcheck=mem).
flags_release    = -O3 -fcheck=mem
flags_quad       = -O2
flags_debug      = -Og -g -fbacktrace -fcheck=all -fcheck=no-array-temps -ffpe-trap=invalid,zero,overflow -finit-real=snan -finit-derived
# For `make memory`: addresses, leaks and undefined behaviour. One byte off in any module stops the program.
flags_sanitize   = -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined,leak -fno-sanitize-recover=all
warnings_release =
warnings_quad    =
# Array temporaries are no mistake, and a note of each would stand between the program's own messages (no-array-temps).
# gfortran 12 suspects every allocatable that a function returns (no-uninitialized); the debug build fills what nobody
# has set with NaN that traps, which finds the real ones.
warnings_debug   = -Wall -Wextra -Wno-uninitialized -Wno-maybe-uninitialized -Werror=implicit-interface
FFLAGS  = $(flags_$(kind))
compile = $(FC) -std=f2018 -fimplicit-none -fopenmp $(FFLAGS)
options = -ffree-line-length-132 $(warnings_$(kind)) -J$(build)

# The reference libraries, linked statically: faster to start, and results that do not change with the number of
# threads or the processor. Debian keeps the reference archives in folders of their own.
archive = $(firstword $(filter /%,$(foreach name,$(1),$(shell $(FC) -print-file-name=$(name)))))
ifeq ($(BLAS),openblas)
libraries := $(call archive,libarpack.a) -lopenblas
else
libraries := $(call archive,libarpack.a) $(call archive,lapack/liblapack.a liblapack.a) $(call archive,blas/libblas.a libblas.a)
endif
integration := $(call archive,libgsl.a) -lm
libraries += $(integration)
# Quadruple precision: the same sources, but for the modules that tests/quad/ has instead, among them the part of LAPACK in use.
ifeq ($(kind),quad)
libraries := $(integration)
instead   := $(wildcard tests/quad/*.f90)
endif

# Sources lie in folders and in folders of these. File = module, so the objects of all can lie in one folder.
found   := $(filter-out %/ranks_mpi.f90,$(wildcard src/*.f90 src/*/*.f90 src/*/*/*.f90))
sources := $(filter-out $(addprefix %/,$(notdir $(instead))),$(found)) $(instead)
modules := $(patsubst %.f90,$(build)/%.o,$(filter-out main.f90,$(notdir $(sources))))
# What only tests use; the first is one of the modules of the quadruple build.
test_modules := $(filter-out $(modules),$(build)/symmetric_eigensolver.o) $(build)/computed_decks.o $(build)/total_reactions.o $(build)/response_cases.o $(build)/sample_linkages.o $(build)/part_samples.o
# Of two files of one name the first is meant.
vpath %.f90 $(sort $(dir $(instead))) $(sort $(dir $(sources))) tests/quad $(support)

# Found anew at every call (it takes milliseconds), so that dependencies are never older than the sources.
$(shell mkdir -p $(build)/funit $(build)/pfunit && makedepf90 -b '$$(build)' $(sources) > $(build)/dependencies.mk)
include $(build)/dependencies.mk

# A .mod whose source was removed or renamed would hide a missing module.
stale := $(filter-out $(modules:.o=.mod) $(test_modules:.o=.mod),$(wildcard $(build)/*.mod))
ifneq ($(stale),)
$(shell rm -f $(stale))
endif

# remember FILE,TEXT: write the file only when the text is new, so that what depends on it is made again just then.
# The rules without commands say that the files are there: make may have listed the folder before they were.
remember = $(if $(subst x$(file <$(1)),,x$(2)),$(file >$(1),$(2)))
$(call remember,$(build)/command,$(compile) $(options) $(libraries))
$(build)/command: ;

$(build)/%.o: %.f90 $(build)/command
	@echo "$(FC) ($(kind)) $<"
	$(compile) $(options) -c $< -o $@

$(test_modules): $(build)/kinds.o

$(build)/flexmech: $(modules) $(build)/main.o
	@echo "link $@"
	$(compile) $^ $(libraries) -o $@

# ---------------------------------- the program for several processes: the same objects, but for the one that knows of MPI
$(of_mpi): $(filter-out %/ranks_alone.o,$(modules)) $(build)/main.o build/mpi/ranks_mpi.o
	@echo "link $@"
	mpifort -fopenmp $(FFLAGS) $^ $(libraries) -o $@

build/mpi/ranks_mpi.o: src/base/ranks_mpi.f90 $(build)/ranks.o $(build)/command
	@echo "mpifort ($(kind)) $<"
	mkdir -p $(@D)
	mpifort -std=f2018 -fimplicit-none -fopenmp $(FFLAGS) $(options) -c $< -o $@

# ------------------------------------------------------------- the program that times solvers; sources in the order of use
bench_sources = $(patsubst %,tests/bench/%.f90,bench_cases exact_values nodal_runs nodal_parts bench_models bench_runs bench_corners bench_linkages bench_plans \
                                               machine bench_tables bench_ratios response_runs whole_turn bench_response bench)

$(build)/bench/bench: $(bench_sources) $(modules)
	@echo "link $@"
	mkdir -p $(@D)
	$(compile) -ffree-line-length-132 $(warnings_$(kind)) -J$(@D) -I$(build) $^ $(libraries) -o $@

# --------------------------------------------------------------------- the program that tests estimated errors of responses
stress_sources = $(patsubst %,tests/stress/responses/%.f90,random_numbers random_mechanisms stress_responses)

$(build)/stress/responses: $(stress_sources) $(modules)
	@echo "link $@"
	mkdir -p $(@D)
	$(compile) -ffree-line-length-132 $(warnings_$(kind)) -J$(@D) -I$(build) $^ $(libraries) -o $@

# ------------------------------------------------------------------------------ the program that tests verdicts on stability
verdict_sources = tests/stress/responses/random_numbers.f90 tests/stress/responses/random_mechanisms.f90 \
                  tests/stress/stability/stress_stability.f90

$(build)/stress/stability: $(verdict_sources) $(modules)
	@echo "link $@"
	mkdir -p $(@D)
	$(compile) -ffree-line-length-132 $(warnings_$(kind)) -J$(@D) -I$(build) $^ $(libraries) -o $@

# ------------------------------------------------------------------------------- the program that tests the reader of numbers
$(build)/stress/read_words: tests/stress/numbers/read_words.f90 $(modules)
	@echo "link $@"
	mkdir -p $(@D)
	$(compile) -ffree-line-length-132 $(warnings_$(kind)) -J$(@D) -I$(build) $^ $(libraries) -o $@

# ------------------------------------------------------------- programs that record tasks, and repeat them asleep on many ranks
recorded = $(patsubst %,tests/scaling/%.f90,$(1))
scaling  = $(compile) -ffree-line-length-132 -Jbuild/scaling -I$(build)

build/scaling/record_tasks: $(call recorded,recorded_jobs record_tasks) $(modules)
	@echo "link $@"
	mkdir -p $(@D)
	$(scaling) $^ $(libraries) -o $@

build/scaling/sleeping_ranks: $(call recorded,sleeping_jobs sleeping_ranks) $(filter-out %/ranks_alone.o,$(modules)) build/mpi/ranks_mpi.o
	@echo "link $@"
	mkdir -p $(@D)
	mpifort $(wordlist 2,99,$(scaling)) $^ $(libraries) -o $@

# ------------------------------------------------------------------------------ unit tests with the bundled support
test_files := $(wildcard tests/unit/*.pf tests/unit/*/*.pf tests/unit/*/*/*.pf)
tests      := $(basename $(notdir $(test_files)))
vpath test_%.pf $(sort $(dir $(test_files)))
$(call remember,$(build)/tests,$(tests))
$(build)/tests: ;

# Translated lines are long, and nobody waits for fast tests, only for their compilation.
fast_release = -O0
fast_debug   = -O0
test_options = -ffree-line-length-none $(fast_$(kind)) $(warnings_$(kind)) -J$(build)/funit -I$(build)

# The tests of the tests, which must fail, lie elsewhere.
vpath test_must_fail.pf $(support)
$(build)/funit/%.F90: %.pf $(support)/translate_tests.py
	python3 -B $(support)/translate_tests.py $< $@

$(build)/funit/driver.f90: $(build)/tests $(support)/translate_tests.py
	python3 -B $(support)/translate_tests.py --driver $@ $(tests)

$(build)/funit/driver_must_fail.f90: $(support)/translate_tests.py
	python3 -B $(support)/translate_tests.py --driver $@ test_must_fail

$(build)/funit/funit.o: $(support)/funit.f90 $(build)/command
	$(compile) $(test_options) -c $< -o $@

# makedepf90 does not read .pf, but what a test uses stands at the head of its lines.
used = $(shell sed -n 's/^ *use  *\([a-z0-9_]*\).*/\1/p' $(1))
uses = $(filter $(modules) $(test_modules),$(patsubst %,$(build)/%.o,$(call used,$(1))))
objects = $(foreach way,funit pfunit,$(build)/$(way)/$(basename $(notdir $(1))).o)
$(foreach file,$(test_files),$(eval $(call objects,$(file)): $(call uses,$(file))))
$(foreach part,computed_decks total_reactions response_cases sample_linkages part_samples,$(eval $(build)/$(part).o: $(call uses,$(support)/$(part).f90)))

$(build)/funit/test_%.o: $(build)/funit/test_%.F90 $(build)/funit/funit.o $(build)/command
	@echo "$(FC) ($(kind)) test_$*"
	$(compile) $(test_options) -c $< -o $@

$(build)/funit/unit_tests: $(build)/funit/driver.f90 $(tests:%=$(build)/funit/%.o) $(build)/funit/funit.o $(modules) $(test_modules) \
                           | $(build)/funit/must_fail
	@echo "link $@"
	$(compile) $(test_options) $^ $(libraries) -o $@

$(build)/funit/must_fail: $(build)/funit/driver_must_fail.f90 $(build)/funit/test_must_fail.o $(build)/funit/funit.o
	$(compile) $(test_options) $^ -o $@

# ------------------------------------------------------------------------------- unit tests with an installed pFUnit
ifneq ($(PFUNIT_DIR),)
pfunit_mk := $(firstword $(wildcard $(PFUNIT_DIR)/include/PFUNIT.mk $(PFUNIT_DIR)/PFUNIT-*/include/PFUNIT.mk))
ifeq ($(pfunit_mk),)
$(error PFUNIT_DIR: there is no include/PFUNIT.mk below $(PFUNIT_DIR))
endif
include $(pfunit_mk)

pfunit_compile = $(compile) -ffree-line-length-none $(fast_$(kind)) -I$(build) $(PFUNIT_EXTRA_FFLAGS)

define newline


endef
space := $() $()
suites = $(subst $(space),$(newline),$(patsubst %,ADD_TEST_SUITE(%_suite),$(1)))
$(call remember,$(build)/pfunit/unit_tests.inc,$(call suites,$(tests)))
$(call remember,$(build)/pfunit/must_fail.inc,$(call suites,test_must_fail))
$(build)/pfunit/%.inc: ;

# The preprocessor of pFUnit wants the file in the current folder.
$(build)/pfunit/%.F90: %.pf
	cp $< $(@D)/
	cd $(@D) && python3 $(PFUNIT_BIN_DIR)/funitproc -quiet $(<F) $(@F)

$(build)/pfunit/test_%.o: $(build)/pfunit/test_%.F90 $(build)/command
	@echo "$(FC) ($(kind), pFUnit) test_$*"
	$(pfunit_compile) -J$(build)/pfunit -c $< -o $@

# A folder a driver for its module, for both drivers have one of the same name.
$(build)/pfunit/%_driver.o: $(PFUNIT_INCLUDE_DIR)/driver.F90 $(build)/pfunit/%.inc
	mkdir -p $(build)/pfunit/$*_modules
	$(pfunit_compile) -J$(build)/pfunit/$*_modules -D_TEST_SUITES='"$(build)/pfunit/$*.inc"' -c $< -o $@

$(build)/pfunit/unit_tests: $(build)/pfunit/unit_tests_driver.o $(tests:%=$(build)/pfunit/%.o) $(modules) $(test_modules) \
                            | $(build)/pfunit/must_fail
	@echo "link $@"
	$(pfunit_compile) $^ $(PFUNIT_LIBRARIES) $(libraries) -o $@

$(build)/pfunit/must_fail: $(build)/pfunit/must_fail_driver.o $(build)/pfunit/test_must_fail.o
	$(pfunit_compile) $^ $(PFUNIT_LIBRARIES) -o $@
endif

# Keep what is made on the way: a debugger wants the translated tests. (A .SECONDARY: without names would keep everything, but make then
# walks every path through the dependencies of an empty build folder: a minute.)
.PRECIOUS: $(build)/funit/%.F90 $(build)/pfunit/%.F90 $(build)/pfunit/%.inc
endif
