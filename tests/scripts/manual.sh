#!/bin/sh
# The manual page and the completion of shells, and where `make install` puts them.
. tests/scripts/functions.sh
LC_ALL=C.UTF-8
export LC_ALL

# options: those of --help, one a line
options() {
  "$program" --help | sed -n 's/^  \(--[a-z-]*\).*/\1/p'
}

page() {
  run 0 --man && silent && mv "$scratch/stdout" "$scratch/flexmech.1"
}

has_options() {
  page || return 1
  [ "$(options | wc -l)" -gt 10 ] || { echo "--help has no options"; return 1; }
  for option in $(options); do
    grep -q -e "^.fB$(echo "$option" | sed 's/-/\\\\-/g')\\( [A-Z=/]*\\)\\{0,1\\}.fR\$" "$scratch/flexmech.1" || { echo "$option is missing"; return 1; }
  done
}

# rendered PAGE WORDS... -- COMMAND...: without a warning, with these words as they are typed
rendered() {
  source=$1
  shift
  : >"$scratch/words"
  while [ "$1" != -- ]; do
    printf '%s\n' "$1" >>"$scratch/words"
    shift
  done
  shift
  "$@" "$source" >"$scratch/rendered" 2>"$scratch/warnings" || { cat "$scratch/warnings"; return 1; }
  [ ! -s "$scratch/warnings" ] || { head -n 3 "$scratch/warnings"; return 1; }
  sed 's/.\x08//g; s/\x1b\[[0-9;]*m//g' "$scratch/rendered" >"$scratch/plain"
  while read -r words; do
    grep -qF -e "$words" "$scratch/plain" || { echo "'$words' is not on the page"; return 1; }
  done <"$scratch/words"
}

renders() {
  rendered "$scratch/flexmech.1" NAME "flexmech - dynamics" --threads --help-cards "REPORT motion" "EXIT STATUS" -- "$@"
}

# The page of flexmech-plot, made as `make install` makes it.
renders_plot() {
  sh plots/flexmech-plot --help | awk -v version="flexmech 1.2.3" -f plots/manual_page.awk >"$scratch/flexmech-plot.1"
  rendered "$scratch/flexmech-plot.1" NAME "flexmech-plot - draws" "flexmech 1.2.3" $(plot_options) "EXIT STATUS" -- "$@"
}

plot_options() {
  sh plots/flexmech-plot --help | sed -n 's/^  \(--.*\)/ \1/p' | grep -o ' --[a-z-]*'
}

# complete WORD...: what bash offers for the last word, one a line, sorted; by the completion in $file
complete() {
  (cd "$scratch/folder" && bash -c '
    compopt() { :; }
    complete() { function=$2; }
    source "$1"
    shift
    COMP_WORDS=(command "$@")
    COMP_CWORD=$#
    $function
    printf "%s\n" "${COMPREPLY[@]}"' - "$file" "$@" | LC_ALL=C sort)
}

# offers EXPECTED WORD...
offers() {
  expected=$1
  shift
  found=$(complete "$@" | tr '\n' ' ' | sed 's/ $//')
  [ "$found" = "$expected" ] || { echo "for '$*' bash offers '$found', not '$expected'"; return 1; }
}

bash_completes() {
  file=$scratch/flexmech.bash
  run 0 --completion bash && silent && mv "$scratch/stdout" "$file" || return 1
  bash -n "$scratch/flexmech.bash" || return 1
  mkdir -p "$scratch/folder/deep"
  touch "$scratch/folder/one.deck" "$scratch/folder/a two.deck" "$scratch/folder/notes.txt"
  offers "$(options | LC_ALL=C sort | tr '\n' ' ' | sed 's/ $//')" -- || return 1
  offers "--check" --ch && offers "--help --help-cards" --he && offers "a two.deck deep one.deck" "" &&
    offers "one.deck" --check o && offers "csv csv-only plain" --format "" && offers "csv csv-only" --format = c && offers "csv csv-only plain" --format = &&
    offers "deep" --out "" && offers "" --threads "" && offers "" --set "" && offers "bash fish zsh" --completion ""
}

bash_completes_plot() {
  file=$scratch/flexmech-plot.bash
  sh plots/flexmech-plot --help | awk -f plots/completion.awk >"$file"
  bash -n "$file" || return 1
  mkdir -p "$scratch/folder/deep"
  offers "$(plot_options | LC_ALL=C sort | tr -d ' ' | tr '\n' ' ' | sed 's/ $//')" -- && offers "--format" --fo &&
    offers "pdf png svg" --format "" && offers "" --size "" && offers "deep" "" && offers "png" --format = pn && offers "pdf png svg" --format =
}

# other_shell SHELL: takes its file
other_shell() {
  run 0 --completion "$1" && silent || return 1
  "$1" -n "$scratch/stdout"
}

refuses() {
  run 2 --completion ksh && says "unknown shell 'ksh'" && run 2 --completion && says "option --completion needs a value"
}

# The release build is what is installed, whichever is tested.
install_puts_them() {
  PREFIX=/opt/flexmech DESTDIR="$scratch/root" make install >"$scratch/log" 2>&1 || { tail -n 3 "$scratch/log"; return 1; }
  share=$scratch/root/opt/flexmech/share
  for shell in bash zsh fish; do
    build/release/flexmech --completion $shell >"$scratch/flexmech.$shell"
  done
  build/release/flexmech --man | cmp - "$share/man/man1/flexmech.1" &&
    cmp "$scratch/flexmech.bash" "$share/bash-completion/completions/flexmech" &&
    cmp "$scratch/flexmech.zsh" "$share/zsh/site-functions/_flexmech" &&
    cmp "$scratch/flexmech.fish" "$share/fish/vendor_completions.d/flexmech.fish" &&
    grep -q "^.TH FLEXMECH-PLOT 1 .*$(build/release/flexmech --version)" "$share/man/man1/flexmech-plot.1" &&
    grep -q "^complete -F _flexmech_plot flexmech-plot" "$share/bash-completion/completions/flexmech-plot" &&
    grep -q "^.TH FLEXMECH-IMPORT 1 .*$(build/release/flexmech --version)" "$share/man/man1/flexmech-import.1" &&
    grep -q "makes a deck of a linkage that was drawn in another program" "$share/man/man1/flexmech-import.1" &&
    grep -q "^complete -F _flexmech_export flexmech-export" "$share/bash-completion/completions/flexmech-export"
}

# The commands of other programs' files, from where they are installed.
installed_exchange() {
  (cd "$scratch" && PATH=/usr/bin:/bin root/opt/flexmech/bin/flexmech-import "$1" && \
    root/opt/flexmech/bin/flexmech-export dxf --at 30 "$2") >"$scratch/stdout" 2>"$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
  silent && grep -q "^DRIVE    L0$" "$scratch/stdout" && grep -q "^CIRCLE$" "$scratch/stdout" || return 1
  ln -s root/opt/flexmech/bin/flexmech-import "$scratch/link"
  [ "$("$scratch/link" --version)" = "flexmech-import $(build/release/flexmech --version | sed 's/flexmech //')" ] || { "$scratch/link" --version; return 1; }
  cp "$scratch/root/opt/flexmech/bin/flexmech-import" "$scratch/alone"
  "$scratch/alone" "$1" 2>"$scratch/stderr"
  [ $? -eq 1 ] && says "make install"
}

check "every option has its entry on the manual page" has_options
for formatter in "groff -man -Tutf8 -ww" "man -l --warnings=w"; do
  name=${formatter%% *}
  printf '.TH A 1\n.SH NAME\na \\- b\n' >"$scratch/small.1"
  if command -v "$name" >/dev/null && $formatter "$scratch/small.1" 2>/dev/null | grep -q 'a - b'; then
    check "the manual page by $name" renders $formatter
    check "the manual page of flexmech-plot by $name" renders_plot $formatter
  else
    skip "the manual page by $name" "$name is not there, or formats nothing"
  fi
done
if command -v bash >/dev/null; then
  check "bash completes options, values and decks" bash_completes
  check "bash completes the options of flexmech-plot" bash_completes_plot
else
  skip "bash completes options, values and decks" "there is no bash"
fi
for shell in zsh fish; do
  if command -v $shell >/dev/null; then
    check "the completion of $shell" other_shell $shell
  else
    skip "the completion of $shell" "there is no $shell"
  fi
done
check "completion of an unknown shell" refuses
check "make install installs manual page and completions" install_puts_them
check "flexmech-import and flexmech-export, installed" installed_exchange "$(pwd)/tests/exchange/planet.linkage2" "$(pwd)/inputs/quick_return.deck"
