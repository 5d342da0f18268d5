#!/bin/sh
# What `make package` makes: a Debian package without faults, an archive that runs where it is unpacked, and the same bytes again.
. tests/scripts/functions.sh

case $program in
  */release/*) ;;
  *)
    skip "packages" "they are of the release build"
    exit ;;
esac
portable=build/portable/flexmech
out="$scratch/a folder"
version=$("$program" --version | sed 's/.* //')
deb=flexmech_$version-1_$(dpkg --print-architecture).deb
archive=flexmech-$version-linux-$(uname -m).tar.gz
there="$scratch/un packed/${archive%.tar.gz}"
released=$(sed -n 's/^date-released: //p' CITATION.cff)

# pack PORTABLE FOLDER
pack() {
  sh make/package.sh "$program" "$1" "$2" >"$scratch/stdout" 2>"$scratch/stderr"
}

names_say_what_is_in() {
  pack $portable "$out" || { cat "$scratch/stderr"; return 1; }
  silent || return 1
  [ "$(ls "$out")" = "$(printf '%s\n' "$archive" "$deb" | LC_ALL=C.UTF-8 sort)" ] || { echo "there is:" $(ls "$out"); return 1; }
}

# Whoever makes them, whenever.
same_bytes_again() {
  (umask 077 && TZ=Asia/Tokyo LC_ALL=C SOURCE_DATE_EPOCH= pack $portable "$scratch/again") && same "$out" "$scratch/again"
}

# That of the release; between releases that of the last commit.
has_one_date() {
  date=${released:-$(TZ=UTC git log -1 --date=format-local:%Y-%m-%d --format=%cd)}
  { tar --utc -tvzf "$out/$archive" && TZ=UTC dpkg-deb -c "$out/$deb"; } | awk -v date="$date" '$4 != date { print; wrong = 1 } END { exit wrong || NR < 500 }'
}

needs_nothing_else() {
  mkdir -p "$scratch/shared" && cp "$program" "$scratch/shared/flexmech" && ! pack "$scratch/shared/flexmech" "$scratch/shared/out" &&
    says "flexmech needs libgfortran.so" && absent "$scratch/shared/out"/*.gz
}

without_faults() {
  lintian --fail-on warning,error "$out/$deb" >"$scratch/stdout" 2>/dev/null || { cat "$scratch/stdout"; return 1; }
}

# field NAME
field() { dpkg-deb -f "$out/$deb" "$1"; }

says_what_it_needs() {
  [ "$(field Version)" = "$version-1" ] && field Depends | grep -q 'libc6 (>= .*libgfortran5 (>= ' && field Recommends | grep -q gnuplot &&
    field Built-Using | grep -q 'gsl (= .*lapack (= ' && field Description | grep -q 'planar linkages' || field
}

belongs_to_root() {
  dpkg-deb -c "$out/$deb" >"$scratch/listed" || return 1
  awk '$2 != "root/root" || $1 !~ /^(-rw-r--r--|-rwxr-xr-x|drwxr-xr-x|lrwxrwxrwx)$/ { print; wrong = 1 } END { exit wrong }' "$scratch/listed" &&
    dpkg-deb -x "$out/$deb" "$scratch/root" && (cd "$scratch/root" && dpkg-deb --ctrl-tarfile "$out/$deb" | tar -xO ./md5sums | md5sum --quiet -c -)
}

installed_package() {
  root=$scratch/root/usr
  for command in flexmech flexmech-plot flexmech-report flexmech-import flexmech-export; do
    [ "$(env -i PATH=/usr/bin:/bin "$root/bin/$command" --version)" = "$command $version" ] &&
      gzip -dc "$root/share/man/man1/$command.1.gz" | grep -q "^\.TH $(echo $command | tr a-z A-Z) 1 " || { echo "no $command"; return 1; }
  done
  gzip -dc "$root/share/doc/flexmech/changelog.gz" | cmp - CHANGELOG.md && [ -f "$root/share/doc/flexmech/inputs/jansen.deck" ] &&
    [ -f "$root/share/doc/flexmech/docs/tutorial.md" ]
}

unpacked() {
  mkdir -p "$scratch/un packed" && tar -C "$scratch/un packed" -xzf "$out/$archive" || return 1
  beam_deck "CRANK 0 to 360 step 30" "REPORT frequencies" "REPORT kinematics" | sed 's|^MATERIAL.*|INCLUDE library/materials.inc|' >"$scratch/beam.deck"
  run 0 --quiet --out "$scratch/by_program" "$scratch/beam.deck" || return 1
  (cd "$scratch" && env -i "$there/bin/flexmech" --quiet --out "$scratch/by_archive" beam.deck) >"$scratch/stdout" 2>"$scratch/stderr" ||
    { cat "$scratch/stderr"; return 1; }
  silent && same_tables "$scratch/by_program" "$scratch/by_archive"
}

# Two procedures of one name are linked: ours speaks, where there is room for the program and not for what it needs to begin with.
refuses_memory_in_its_words() {
  motion_deck >"$scratch/motion.deck"
  for limit in $(seq 16000 400 40000); do
    (ulimit -v "$limit" && "$there/bin/flexmech" --quiet --out "$scratch/none" "$scratch/motion.deck") >/dev/null 2>"$scratch/stderr" && break
    says "the system refuses more memory" >/dev/null && return
  done
  says "the system refuses more memory"
}

# A folder with the commands of this machine but for the compiler, python3 and gnuplot.
draws_with_gnuplot_alone() {
  mkdir -p "$scratch/bin" && ln -s /bin/* /usr/bin/* "$scratch/bin" 2>/dev/null
  rm -f "$scratch/bin"/gnuplot* "$scratch/bin"/*gfortran* "$scratch/bin"/*gcc* "$scratch/bin"/python*
  env -i PATH="$scratch/bin" "$there/bin/flexmech-plot" "$scratch/by_archive/beam" 2>"$scratch/stderr" && return 1
  says "gnuplot is not installed; only figures and animations need it" || return 1
  ln -s "$(command -v gnuplot)" "$scratch/bin"
  env -i PATH="$scratch/bin" "$there/bin/flexmech-plot" --only frequencies "$scratch/by_archive/beam" >"$scratch/stdout" 2>"$scratch/stderr" && silent &&
    [ -s "$scratch/by_archive/beam/figures/frequencies.png" ]
}

licences_are_there() {
  for name in LICENSE README share/doc/flexmech/GPL-3 share/doc/flexmech/linked/libgsl-dev bin/flexmech-report share/man/man1/flexmech.1; do
    [ -s "$there/$name" ] || { echo "no $name"; return 1; }
  done
  grep -q "GNU C library 2\.[0-9]* or newer" "$there/README" && grep -q "^gsl [0-9]" "$there/README"
}

check "names have version and machine" names_say_what_is_in
check "the same bytes again" same_bytes_again
check "all files are of one date" has_one_date
check "a program with further libraries is no archive" needs_nothing_else
if command -v lintian >/dev/null; then
  check "lintian has nothing to say" without_faults
else
  skip "lintian has nothing to say" "there is no lintian (make check-all installs it)"
fi
check "the package says what it needs" says_what_it_needs
check "its files are root's, and what md5sums says" belongs_to_root
check "its commands, pages and documents" installed_package
check "the archive runs where it is unpacked, in an empty environment" unpacked
check "it refuses memory in the program's words" refuses_memory_in_its_words
check "figures need gnuplot, and nothing else that is not there" draws_with_gnuplot_alone
check "licences and what it needs" licences_are_there
