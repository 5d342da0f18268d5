# Programs that time and test the program from outside.
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
