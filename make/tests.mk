# Unit tests with the bundled support.
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

# Keep what is made on the way: a debugger wants the translated tests. (A .SECONDARY: without names would keep everything, but make then
# walks every path through the dependencies of an empty build folder: a minute.)
.PRECIOUS: $(build)/funit/%.F90 $(build)/pfunit/%.F90 $(build)/pfunit/%.inc
