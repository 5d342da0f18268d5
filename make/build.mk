# The program, of one kind: release, debug, quad or sanitize.
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
# What finds the digits of numbers: from version 11 of libstdc++ on.
libraries += $(integration) $(or $(call archive,libstdc++.a),-lstdc++)
# Quadruple precision: the same sources, but for the modules that tests/quad/ has instead, among them the part of LAPACK in use.
ifeq ($(kind),quad)
libraries := $(integration)
instead   := $(wildcard tests/quad/*.f90)
endif

# Sources lie in folders and in folders of these. File = module, so the objects of all can lie in one folder.
found   := $(filter-out %/ranks_mpi.f90,$(wildcard src/*.f90 src/*/*.f90 src/*/*/*.f90))
sources := $(filter-out $(addprefix %/,$(notdir $(instead))),$(found)) $(instead)
modules := $(patsubst %.f90,$(build)/%.o,$(filter-out main.f90,$(notdir $(sources)))) $(if $(instead),,$(build)/shortest_digits.o)
# What only tests use; modules of the quadruple build that the others do not have are among them.
test_sources := $(filter-out $(addprefix %/,$(notdir $(sources)) funit.f90),$(wildcard tests/quad/*.f90 $(support)/*.f90))
test_modules := $(patsubst %.f90,$(build)/%.o,$(notdir $(test_sources)))
# Of two files of one name the first is meant.
vpath %.f90 $(sort $(dir $(instead))) $(sort $(dir $(sources))) tests/quad $(support)

# Found anew at every call (it takes milliseconds), so that dependencies are never older than the sources.
$(shell mkdir -p $(build) && makedepf90 -b '$$(build)' $(sources) > $(build)/dependencies.mk)
include $(build)/dependencies.mk

# A .mod whose source was removed or renamed would hide a missing module.
stale := $(filter-out $(modules:.o=.mod) $(test_modules:.o=.mod),$(wildcard $(build)/*.mod))
ifneq ($(stale),)
$(shell rm -f $(stale))
endif

# What reads, checks and keeps, but computes nothing: half of the compilation at -O3, most of it copies of results.
told := $(patsubst %.f90,$(build)/%.o,$(notdir $(filter src/model/cards/% src/model/requests/% src/model/checks/% %/model_reader.f90 src/reports/% src/runs/% src/command/% \
                                                        %/study_results.f90,$(sources))))
$(told): private FFLAGS := $(subst -O3,-O1,$(flags_$(kind)))

# remember FILE,TEXT: write the file only when the text is new, so that what depends on it is made again just then.
# The rules without commands say that the files are there: make may have listed the folder before they were.
remember = $(if $(subst x$(file <$(1)),,x$(2)),$(file >$(1),$(2)))
compile_c++ = $(CXX) -std=c++17 -O2 -fno-exceptions -fno-rtti
$(call remember,$(build)/command,$(compile) $(options) $(libraries) $(told) $(compile_c++))
$(build)/command: ;

$(build)/%.o: %.f90 $(build)/command
	@echo "$(FC) ($(kind)) $<"
	$(compile) $(options) -c $< -o $@

# The one file that is not Fortran.
$(build)/shortest_digits.o: src/base/words/shortest_digits.cpp $(build)/command
	@echo "$(CXX) ($(kind)) $<"
	$(compile_c++) -c $< -o $@

$(build)/flexmech: $(modules) $(build)/main.o
	@echo "link $@"
	$(compile) $^ $(libraries) -o $@

# For other machines: of libraries it needs that of C alone. Each one stands before those that it needs. What memory_refusals.f90 has
# in place of procedures of libgfortran comes first, and is taken (muldefs).
runtime := $(foreach name,libgfortran.a libquadmath.a libgomp.a,$(call archive,$(name)))
$(portable): $(modules) $(build)/main.o
	@echo "link $@"
	mkdir -p $(@D)
	$(FC) $(FFLAGS) -static-libgfortran -static-libgcc -Wl,--as-needed,-z,muldefs $^ $(libraries) $(runtime) -lm -o $@
	printf '%s\n' $(realpath $(filter %.a,$(libraries) $(runtime))) > $(@D)/archives

# ---------------------------------- the program for several processes: the same objects, but for the one that knows of MPI
$(of_mpi): $(filter-out %/ranks_alone.o,$(modules)) $(build)/main.o build/mpi/ranks_mpi.o
	@echo "link $@"
	mpifort -fopenmp $(FFLAGS) $^ $(libraries) -o $@

build/mpi/ranks_mpi.o: src/base/system/ranks_mpi.f90 $(build)/ranks.o $(build)/command
	@echo "mpifort ($(kind)) $<"
	mkdir -p $(@D)
	mpifort -std=f2018 -fimplicit-none -fopenmp $(FFLAGS) $(options) -c $< -o $@
