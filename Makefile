# FLEXMECH. `make help` lists what can be asked for.
#
# It runs in two stages. The targets a person types, here and in make/figures.mk, check.mk, studies.mk, install.mk and package.mk, first see
# that the tools are there (`setup`), then call this file again with kind=release or kind=debug. Only that second call looks at
# sources, compilers and archives, in make/build.mk, programs.mk, tests.mk and pfunit.mk: on a fresh machine there is no gfortran
# yet when the first one is read.

# What is typed at make is a text: not expanded here, and in commands only as "$$NAME", where the shell does not read it either.
$(foreach name,$(.VARIABLES),$(if $(findstring command,$(origin $(name))),$(eval override $(name) := $$(value $(name)))$(eval export $(name))))

ifeq ($(origin FC),default)
FC = gfortran
endif
export FC CXX
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
portable = build/portable/flexmech
support = tests/support
# The second stage uses every processor unless the caller has said how many. V=1 shows the commands in full.
stage   = +@$(MAKE) --no-print-directory $(if $(V),,-s) $(if $(findstring -j,$(MAKEFLAGS)),,-j$(shell nproc))
# The unit tests, run by the bundled support or by an installed pFUnit.
unit_tests = $(if $(PFUNIT_DIR),pfunit,funit)/unit_tests

ifndef kind
.PHONY: all debug quad setup clean help
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

clean:
	rm -rf build outputs

help:
	@cat make/help.txt

include make/figures.mk make/check.mk make/studies.mk make/install.mk make/package.mk
else
include make/build.mk make/programs.mk make/tests.mk $(if $(PFUNIT_DIR),make/pfunit.mk)
endif
