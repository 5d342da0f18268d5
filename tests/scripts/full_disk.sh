#!/bin/sh
# A full disk: a clear message, no half table, and the earlier results untouched. The disk is a small tmpfs.
# Large tables are of the motion alone: on a busy machine a search for frequencies may take long enough to leave resume.part.
. tests/scripts/functions.sh

disk=$scratch/disk
mkdir "$disk"
if ! mount -t tmpfs -o size=128k tmpfs "$disk" 2>/dev/null; then
  skip "a full disk" "no file system can be mounted here"
  exit
fi
trap 'umount "$disk"' EXIT

deck=$scratch/beam.deck
full="the file could not be written completely: No space left on device"

earlier_results() {
  beam_deck "CRANK 0" "REPORT frequencies" >"$deck"
  run 0 --out "$disk" "$deck" && cp -r "$disk" "$scratch/before" || return 1
  beam_deck "CRANK 0 to 360 step 0.5" "REPORT kinematics" >"$deck"
  run 2 --out "$disk" "$deck" && says "$full" && same "$disk" "$scratch/before"
}

new_folder() {
  cp "$deck" "$scratch/new.deck"
  run 2 --out "$disk/deep" "$scratch/new.deck" && says "$full" && absent "$disk/deep"
}

# Plain tables alone would have room.
with_csv() {
  beam_deck "CRANK 0 to 360 step 1.5" "REPORT kinematics" >"$deck"
  run 0 --out "$disk/plain" "$deck" && rm -r "$disk/plain" || return 1
  run 2 --out "$disk" --format csv "$deck" && says "$full" && same "$disk" "$scratch/before"
}

# The last byte counts: fill the disk but for less than the log and the echo need.
no_room_at_all() {
  beam_deck "CRANK 0" "REPORT frequencies" "REPORT kinematics" >"$deck"
  head -c 200000 /dev/zero >"$disk/fill" 2>/dev/null
  run 2 --out "$disk" "$deck" && says "error:" && rm "$disk/fill" && same "$disk" "$scratch/before"
}

check "a disk that fills up leaves the earlier results" earlier_results
check "a disk that fills up leaves no new folder" new_folder
check "a disk with no room for CSV" with_csv
check "a full disk" no_room_at_all
