# What takes minutes or hours: times, and random mechanisms against independent or finer computations.
.PHONY: documents bench bench-pictures stress stress-responses stress-stability accuracies linkages loads vibrations scaling references

bench: all
	$(stage) kind=release build/release/bench/bench
	build/release/bench/bench $(program) outputs/bench "$$BLAS"
	@sh plots/draw_bench.sh outputs/bench

# The pictures of docs/performance.md, from the last `make bench`.
bench-pictures:
	@test -f outputs/bench/ratios.dat || { echo "make: nothing was timed yet; say: make bench" >&2; exit 2; }
	cp outputs/bench/*.png docs/pictures/

# Numbers of the documents that runs of some seconds give. STRESS=yes: those of the last `make stress` instead.
documents: all
	@python3 -B tests/documents/documents.py $(program) --write $(if $(STRESS),--stress)

SPEEDS ?= 50
stress-stability: all
	$(stage) kind=release build/release/stress/stability
	build/release/stress/stability $(if $(filter file,$(origin CASES)),20,"$$CASES") "$$SPEEDS" $(shell nproc) "$$FIRST"

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
