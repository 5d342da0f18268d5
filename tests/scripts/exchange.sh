#!/bin/sh
# flexmech-import and flexmech-export: files of other programs, the motion of their decks, what is wrong with files, drawings.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "flexmech-import and flexmech-export" "they make and read decks, which are the same in all builds"; exit ;;
esac
python3 -B tests/support/exchange_tests.py "$program" "$scratch"
