# Programs that time the program and test parts of it: a source with `program`, and the modules beside it.
program_sources := $(wildcard tests/bench/*.f90 tests/stress/*/*.f90 tests/scaling/*.f90)
program_mains   := $(shell grep -lE '^ *program ' $(program_sources))
vpath %.f90 $(sort $(dir $(program_sources)))

$(shell mkdir -p $(build)/programs && makedepf90 -b '$$(build)/programs' $(program_sources) > $(build)/programs/dependencies.mk)
include $(build)/programs/dependencies.mk

# Linkages that are put together by hand.
by_hand = $(addprefix $(build)/,four_bars.o divided_structures.o)

$(build)/programs/%.o: %.f90 $(build)/command $(modules) $(by_hand)
	@echo "$(FC) ($(kind)) $<"
	$(compile) -ffree-line-length-132 $(warnings_$(kind)) -J$(@D) -I$(build) -c $< -o $@

# from NAME,FOLDER...: the program NAME and the modules of the folders.
from = $(patsubst %.f90,$(build)/programs/%.o,$(1).f90 $(notdir $(filter-out $(program_mains),$(wildcard $(addsuffix /*.f90,$(2))))))
chains = $(addprefix $(build)/,chain_decks.o nodal_chains.o computed_decks.o)
$(build)/programs/bench_scale.o: $(chains)
$(build)/bench/bench:       $(call from,bench,tests/bench) $(chains)
$(build)/stress/responses:  $(call from,stress_responses,tests/stress/responses)
$(build)/stress/stability:  $(call from,stress_stability,tests/stress/responses)
$(build)/stress/read_words: $(call from,read_words)
build/scaling/record_tasks: $(call from,record_tasks,tests/scaling)
$(build)/bench/bench $(build)/stress/responses $(build)/stress/stability $(build)/stress/read_words build/scaling/record_tasks: $(modules) $(by_hand)
	@echo "link $@"
	mkdir -p $(@D)
	$(compile) $^ $(libraries) -o $@

# On many ranks.
build/scaling/sleeping_ranks: $(call from,sleeping_ranks,tests/scaling) $(filter-out %/ranks_alone.o,$(modules)) build/mpi/ranks_mpi.o
	@echo "link $@"
	mkdir -p $(@D)
	mpifort $(wordlist 2,99,$(compile)) $^ $(libraries) -o $@
