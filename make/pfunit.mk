# Unit tests with an installed pFUnit.
pfunit_mk := $(firstword $(wildcard $(PFUNIT_DIR)/include/PFUNIT.mk $(PFUNIT_DIR)/PFUNIT-*/include/PFUNIT.mk))
ifeq ($(pfunit_mk),)
$(error PFUNIT_DIR: there is no include/PFUNIT.mk below $(PFUNIT_DIR))
endif
include $(pfunit_mk)

pfunit_compile = $(compile) -ffree-line-length-none $(fast) -I$(build) $(PFUNIT_EXTRA_FFLAGS)

define newline


endef
space := $() $()
suites = $(subst $(space),$(newline),$(patsubst %,ADD_TEST_SUITE(%_suite),$(1)))
$(call remember,$(build)/pfunit/unit_tests.inc,$(call suites,$(tests)))
$(call remember,$(build)/pfunit/must_fail.inc,$(call suites,test_must_fail))
$(build)/pfunit/%.inc: ;

vpath test_must_fail.pf $(support)
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

# Keep what is made on the way. (A .SECONDARY: without names would keep everything, but make then walks every path through the
# dependencies of an empty build folder: a minute.)
.PRECIOUS: $(build)/pfunit/%.F90 $(build)/pfunit/%.inc
