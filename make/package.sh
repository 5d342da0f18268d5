#!/bin/sh
# Makes flexmech_VERSION-1_ARCHITECTURE.deb and flexmech-VERSION-linux-MACHINE.tar.gz: package.sh PROGRAM PORTABLE FOLDER. PORTABLE
# needs the C library alone; beside it is `archives`, the names of what it is linked with. The same sources, compiler and libraries
# give the same bytes: files have the date of the release, or of the last commit.

set -eu
program=$1
portable=$2
LC_ALL=C.UTF-8
TZ=UTC
export LC_ALL TZ
umask 022
mkdir -p "$3"
out=$(CDPATH='' cd -- "$3" && pwd)
stage=$(mktemp -d "$out/stage.XXXXXX")
trap 'rm -rf "$stage"' EXIT
trap 'exit 130' INT TERM HUP

version=$("$program" --version | sed 's/.* //')
# citation KEY: its value in CITATION.cff, the one place that has it.
citation() { sed -n "s/^$1: *//p" CITATION.cff; }
released=$(citation date-released)
: "${SOURCE_DATE_EPOCH:=$([ -z "$released" ] && git log -1 --format=%ct || date -d "${released:-today}" +%s)}"
export SOURCE_DATE_EPOCH
address=$(citation repository-code)

# install_into FOLDER PREFIX PROGRAM
install_into() {
    ${MAKE:-make} --no-print-directory -s install DESTDIR="$1" PREFIX="$2" program="$3"
    strip --remove-section=.comment --remove-section=.note "$1$2/bin/flexmech"
    find "$1" -name __pycache__ -prune -exec rm -r {} +
}

# packages_of FORMAT [ARCHIVE...]: of the packages that the linked archives are from, a line each.
packages_of() {
    format=$1
    shift
    for archive in "$@"; do dpkg-query -S "$archive"; done | sed 's/: .*//' | sort -u |
        while read -r name; do dpkg-query -W -f "$format\n" "$name"; done | sort -u
}

# add_licenses FOLDER ARCHIVE...: what is known of who wrote the linked libraries, and on what terms.
add_licenses() {
    folder=$1
    shift
    mkdir -p "$folder"
    packages_of '${Package}' "$@" | while read -r name; do cp "/usr/share/doc/$name/copyright" "$folder/$name"; done
}

# same_dates FOLDER: and what depends on the umask of who has the sources.
same_dates() {
    chmod -R u=rwX,go=rX "$1"
    find "$1" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
}

# ---------------------------------- the archive
needed=$(readelf -d "$portable" | sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p' | grep -vE '^(libc|libm|libmvec|ld-linux[-a-z0-9_]*)\.so' || :)
[ -z "$needed" ] || { echo "package: $portable needs" $needed "which other machines may not have" >&2; exit 1; }
archives=$(cat "${portable%/*}/archives")
least=$(readelf -V "$portable" | grep -o 'GLIBC_[0-9.]*' | sed 's/.*_//' | sort -Vu | tail -n 1)
name=flexmech-$version-linux-$(uname -m)
install_into "$stage/$name" / "$portable"
add_licenses "$stage/$name/share/doc/flexmech/linked" $archives
cp LICENSE "$stage/$name"
cat make/debian/copyright > "$stage/$name/share/doc/flexmech/copyright"
cp /usr/share/common-licenses/GPL-3 /usr/share/common-licenses/LGPL-2.1 "$stage/$name/share/doc/flexmech"
{
    cat << END_OF_TEXT
FLEXMECH $version for Linux on $(uname -m), to be used where it is unpacked: bin/flexmech my.deck. Add its folder bin to your PATH.

Documents and decks are in share/flexmech, the tutorial is share/flexmech/docs/tutorial.md.
bin/flexmech needs the GNU C library $least or newer, and nothing else: Debian 12 and Ubuntu 22.04 have 2.36 and 2.35.
bin/flexmech-plot needs gnuplot (Debian and Ubuntu: gnuplot-nox); -report, -import and -export need python3.
${address:+
Sources: $address
}
Linked with libraries of these source packages of Debian or Ubuntu; share/doc/flexmech has their licenses:
END_OF_TEXT
    packages_of '${source:Package} ${source:Version}' $archives
} > "$stage/$name/README"
same_dates "$stage/$name"
tar -C "$stage" --sort=name --owner=0 --group=0 --numeric-owner --format=gnu -cf - "$name" | gzip -9n > "$stage/archive"

# ---------------------------------- the Debian package
package=flexmech_$version-1_$(dpkg --print-architecture).deb
root=$stage/debian/flexmech
shared=$root/usr/share
documents=$shared/doc/flexmech
install_into "$root" /usr "$program"
archives=$(printf '%s\n' $archives | grep -v /gcc/)
add_licenses "$documents/linked" $archives
mv "$shared/zsh/site-functions" "$shared/zsh/vendor-completions"
# Where Debian has it: in the file copyright.
rm "$shared/flexmech/LICENSE"
ln -s ../../flexmech/docs ../../flexmech/inputs "$documents"
maintainer='The FLEXMECH authors <flexmech@flexmech.invalid>'
{
    cat make/debian/copyright
    sed 's/^$/./; s/^/ /' LICENSE
} > "$documents/copyright"
mv "$shared/flexmech/CHANGELOG.md" "$documents/changelog"
ln -s ../doc/flexmech/changelog.gz "$shared/flexmech/CHANGELOG.md.gz"
cat > "$documents/changelog.Debian" << END_OF_TEXT
flexmech ($version-1) unstable; urgency=medium

  * Made by make package; changelog.gz has what changed.

 -- $maintainer  $(date -R -d "@$SOURCE_DATE_EPOCH")
END_OF_TEXT
mkdir -p "$shared/lintian/overrides"
printf '# It is not uploaded to Debian.\nflexmech: initial-upload-closes-no-bugs\n' > "$shared/lintian/overrides/flexmech"
gzip -9n "$documents"/changelog* "$shared/man/man1"/*
mkdir "$root/DEBIAN"
echo 'Source: flexmech' > "$stage/debian/control"
depends=$(cd "$stage" && dpkg-shlibdeps -O debian/flexmech/usr/bin/flexmech | sed 's/^shlibs:Depends=//')
{
    cat << END_OF_TEXT
Package: flexmech
Version: $version-1
Architecture: $(dpkg --print-architecture)
Maintainer: $maintainer
Installed-Size: $(find "$root" -type f -printf '%s\n' | awk '{ sum += int(($1 + 1023)/1024) } END { print sum }')
Depends: $depends, python3:any
Recommends: gnuplot-nox | gnuplot
Built-Using: $(packages_of '${source:Package} (= ${source:Version})' $archives | paste -s -d , | sed 's/,/, /g')
Section: science
Priority: optional${address:+
Homepage: $address}
Description: $("$program" --man | sed -n '/^.SH NAME/{n; s/.* \\- //p; q;}')
END_OF_TEXT
    sed -n '/^abstract:/,/^[^ ]*:/{/^  /p;}' CITATION.cff | tr -s ' \n' ' ' | fold -s -w 76 | sed 's/^ *//; s/ *$//; s/^/ /'
    echo
} > "$root/DEBIAN/control"
(cd "$root" && find usr -type f | sort | xargs -d '\n' md5sum) > "$root/DEBIAN/md5sums"
same_dates "$root"
dpkg-deb --root-owner-group -Zxz --build "$root" "$stage/package.deb" > /dev/null

mv "$stage/archive" "$out/$name.tar.gz"
mv "$stage/package.deb" "$out/$package"
echo "$3/$name.tar.gz runs where it is unpacked: it needs the GNU C library $least or newer, for figures gnuplot"
echo "$3/$package: $depends"
