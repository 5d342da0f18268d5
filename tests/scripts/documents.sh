#!/bin/sh
# The check of the documents itself: it finds a wrong digit. The documents are checked by tests/documents/documents.py.
. tests/scripts/functions.sh

self_check() {
  python3 -B tests/documents/self_check.py >"$scratch/self_check" 2>&1 || { tail -n 1 "$scratch/self_check"; return 1; }
}

check "a stale number is found and recomputed" self_check
