# Unit tests with the bundled support.
test_files := $(wildcard tests/unit/*.pf tests/unit/*/*.pf tests/unit/*/*/*.pf)
tests      := $(basename $(notdir $(test_files)))
vpath test_%.pf $(sort $(dir $(test_files)))

# Translated lines are long, and nobody waits for fast tests, only for their compilation.
fast = -O0
test_options = -ffree-line-length-none $(fast) $(warnings_$(kind)) -J$(build)/funit -I$(build)

$(shell mkdir -p $(build)/funit $(build)/pfunit && \
  awk -v known=' $(notdir $(basename $(modules) $(test_modules))) ' -f make/uses.awk $(test_files) $(test_sources) > $(build)/uses.mk)
include $(build)/uses.mk

$(test_modules): $(build)/%.o: %.f90 $(build)/command
	@echo "$(FC) ($(kind)) $<"
	$(compile) $(fast) $(options) -c $< -o $@

# Translated at once, not by a python a file; only what has changed is written. The tests of the tests, which must fail, have a program of
# their own.
ifneq ($(findstring /funit/,$(MAKECMDGOALS)),)
translated := $(shell for tests in "unit_tests $(test_files)" "must_fail $(support)/test_must_fail.pf"; do \
                python3 -B $(support)/translate_tests.py $(build)/funit $$tests || exit; done)
$(if $(filter-out 0,$(.SHELLSTATUS)),$(error the tests were not translated))
endif

# It is timed, too.
$(build)/nodal_chains.o: private fast =

$(build)/funit/funit.o: $(support)/funit.f90 $(build)/command
	$(compile) $(test_options) -c $< -o $@

$(build)/funit/test_%.o: $(build)/funit/test_%.F90 $(build)/funit/funit.o $(build)/command
	@echo "$(FC) ($(kind)) test_$*"
	$(compile) $(test_options) -c $< -o $@

$(build)/funit/unit_tests: $(build)/funit/unit_tests.f90 $(tests:%=$(build)/funit/%.o) $(build)/funit/funit.o $(modules) $(test_modules) \
                           | $(build)/funit/must_fail
	@echo "link $@"
	$(compile) $(test_options) $^ $(libraries) -o $@

$(build)/funit/must_fail: $(build)/funit/must_fail.f90 $(build)/funit/test_must_fail.o $(build)/funit/funit.o
	$(compile) $(test_options) $^ -o $@
