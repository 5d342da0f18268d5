nice make --no-print-directory -s -j2 kind=${1:-release} build/${1:-release}/funit/unit_tests 2>&1 | grep -v "^gfortran\|^link"
