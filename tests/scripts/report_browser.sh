#!/bin/sh
# Pages of flexmech-report in a browser, where there is one, as wide as a telephone and as a desk: nothing is cut off and no block lies on another.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "pages in chromium" "they are made from tables, which are the same in all builds"; exit ;;
esac
command -v chromium >/dev/null || { skip "pages in chromium" "there is no chromium"; exit; }

laid_out() {
  run 0 --quiet --out "$scratch" inputs/response.deck inputs/excavator.deck inputs/jansen.deck inputs/mechanism1.deck inputs/varied.deck || return 1
  for deck in response excavator jansen mechanism1 varied; do
    plots/flexmech-report "$scratch/$deck" >"$scratch/stdout" || return 1
  done
  for width in 400 1400; do
    python3 -B tests/support/report_pages.py browse "$scratch"/*/report.html $width || return 1
  done
}

check "pages in chromium" laid_out
