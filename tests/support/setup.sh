#!/bin/sh
# Installs the tools that are missing, through apt-get. Does nothing, and says nothing, when all of them are there.

compiler=${FC:-gfortran}
missing=""

# need_command COMMAND PACKAGE
need_command() {
  command -v "$1" > /dev/null || missing="$missing $2"
}

# need_library PACKAGE FILE...: the compiler must find one of the files (it repeats the bare name of one it does not find)
need_library() {
  package=$1
  shift
  for file in "$@"; do
    case $("$compiler" -print-file-name="$file" 2> /dev/null) in
      /*) return ;;
    esac
  done
  missing="$missing $package"
}

need_command "$compiler" gfortran
need_command "${CXX:-g++}" g++ # for its library: it finds the digits of numbers
need_command makedepf90 makedepf90
need_command gnuplot gnuplot-nox # its libraries bring a font along, so text appears in the figures
need_command numdiff numdiff
need_library libarpack2-dev libarpack.a
need_library libgsl-dev libgsl.a
if test "$MPI" = yes; then
  need_command mpifort libopenmpi-dev
  need_command mpirun openmpi-bin
fi
if test -n "$PACKAGE"; then
  need_command dpkg-shlibdeps dpkg-dev
fi
if test -n "$LINTIAN"; then
  need_command lintian lintian
fi
if test -n "$SANITIZERS"; then
  need_library "libgcc-$("$compiler" -dumpversion 2> /dev/null | sed 's/\..*//')-dev" libasan.so libasan.a
  need_library "libgcc-$("$compiler" -dumpversion 2> /dev/null | sed 's/\..*//')-dev" libubsan.so libubsan.a
fi
if test "$BLAS" = openblas; then
  need_library libopenblas-dev libopenblas.so libopenblas.a
else
  need_library liblapack-dev lapack/liblapack.a liblapack.a
  need_library libblas-dev blas/libblas.a libblas.a
fi

test -n "$missing" || exit 0

if ! command -v apt-get > /dev/null; then
  echo "setup: missing:$missing" >&2
  echo "setup: there is no apt-get here; please install them (Debian's names of the packages are given) and try again" >&2
  exit 1
fi

as_root=""
if test "$(id -u)" -ne 0; then
  if ! command -v sudo > /dev/null; then
    echo "setup: missing:$missing" >&2
    echo "setup: installing them takes root or sudo, and there is neither; please run as root: apt-get install$missing" >&2
    exit 1
  fi
  as_root=sudo
fi

echo "setup: installing$missing"
# env, not export: sudo drops the environment. Input from nowhere: a question would wait for ever.
apt() { $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq "$@" < /dev/null > /dev/null; }
apt update || echo "setup: apt-get update failed; going on with what it knew before" >&2
apt install -y --no-install-recommends $missing || {
  echo "setup: could not install$missing" >&2
  exit 1
}
