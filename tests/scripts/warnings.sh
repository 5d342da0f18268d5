#!/bin/sh
# Warnings stand on standard error and in the log; --quiet takes them from standard error only.
. tests/scripts/functions.sh

# warned NAME TEXT: of the deck on standard input
warned() {
  deck=$scratch/$1.deck
  cat >"$deck"
  run 0 --out "$scratch/out" "$deck" && says "warning: $2" || return 1
  grep -qF -e "$2" "$scratch/out/$1/run.log" || { echo "the log does not tell"; return 1; }
  run 0 --quiet --out "$scratch/out" "$deck" && silent || return 1
  grep -qF -e "$2" "$scratch/out/$1/run.log" || { echo "the log does not tell when quiet"; return 1; }
}

stocky() {
  beam_deck "CRANK 0" "REPORT frequencies" | sed 's/thickness=1.6/thickness=20/' |
    warned stocky "link 'crank' is only 5 times as long as thick"
}

# Thick beams are what rotary inertia and shear are for; one of them alone does not do.
stocky_as_thick_beams() {
  beam_deck "CRANK 0" "REPORT frequencies" | sed 's/thickness=1.6/thickness=20/; s/7.8e-9/7.8e-9 nu=0.3/' >"$scratch/thick.deck"
  echo "EFFECTS shear" | cat "$scratch/thick.deck" - | warned thick_shear "link 'crank' is only 5 times as long as thick" || return 1
  echo "EFFECTS shear rotary" >>"$scratch/thick.deck"
  run 0 --out "$scratch/out" "$scratch/thick.deck" && silent
}

wave_speed() {
  beam_deck "CRANK 0" "REPORT frequencies" | sed 's/7.8e-9/7800/' | warned wave_speed "sound would travel through 'steel' at"
}

# What makes the frequencies meaningless comes first, on the screen, in the log and before the line of success.
meaningless() {
  beam_deck "CRANK 0" "PINMASS O2 1kg" "REPORT frequencies" | sed 's/7.8e-9/7800/' >"$scratch/nonsense.deck"
  run 0 --out "$scratch/out" "$scratch/nonsense.deck" && says "frequencies computed with it mean nothing" || return 1
  grep ' warning: ' "$scratch/stderr" | head -n 1 | grep -q "through 'steel'" || { echo "not the first on the screen"; return 1; }
  grep '^warning: ' "$scratch/out/nonsense/run.log" | head -n 1 | grep -q "through 'steel'" || { echo "not the first in the log"; return 1; }
  head -n 1 "$scratch/stdout" | grep -q "^nonsense: WARNING: sound would travel through 'steel'" || { echo "no WARNING"; return 1; }
  run 0 --quiet --out "$scratch/out" "$scratch/nonsense.deck" && silent && [ ! -s "$scratch/stdout" ]
}

# Links so thin that the loads of their motion bend them by more than their length.
meaningless_deflection() {
  beam_deck "CRANK 0" "SPEED 400 rad/s" "REPORT frequencies" | sed 's/thickness=1.6/thickness=0.1/' >"$scratch/bent.deck"
  run 0 --out "$scratch/out" "$scratch/bent.deck" && says "no link bends so far, and frequencies under these loads mean nothing" || return 1
  grep ' warning: ' "$scratch/stderr" | head -n 1 | grep -q "mean nothing" || { echo "not the first"; return 1; }
  head -n 1 "$scratch/stdout" | grep -q "^bent: WARNING: the inertia loads at speed 400 rad/s"
}

deflection() {
  beam_deck "CRANK 0 to 350 step 10" "SPEED 0 40" "REPORT frequencies" |
    warned deflection "the inertia loads at speed 40 rad/s, crank 10 deg deflect link 'crank' by 6.28 % of its length"
}

static_speeds() {
  beam_deck "CRANK 0" "SPEED 0 20 40" "EFFECTS static" "REPORT frequencies" |
    warned static "static frequencies do not depend on the speed" || return 1
  [ "$(grep -vc -e '^#' -e '^$' "$scratch/out/static/frequencies.dat")" -eq 1 ] || { echo "more than one block"; return 1; }
}

mass_at_ground() {
  { beam_deck "CRANK 0" "REPORT frequencies" "PINMASS o4 1kg"; } | warned ground "a mass at the ground pivot 'o4' has no effect" || return 1
  beam_deck "CRANK 0" "REPORT frequencies" >"$scratch/without.deck"
  run 0 --out "$scratch/out" "$scratch/without.deck" && same_tables "$scratch/out/without" "$scratch/out/ground"
}

# Cards that serve the elastic response, without one of its reports; cards that it does not use.
idle_response() {
  beam_deck "CRANK 0" "DAMPING * time=1e-4" "GAUGE g crank at=5" "EFFECTS response without=axial" "REPORT frequencies" >"$scratch/idle.deck"
  for text in "DAMPING is used by REPORT response" "GAUGE is used by REPORT strains and transient only" "EFFECTS response is used by REPORT response"; do
    warned idle_again "$text" <"$scratch/idle.deck" || return 1
  done
  beam_deck "CRANK 0" "SPEED 20" "REPORT peaks" >"$scratch/other.deck"
  warned other_lumped "INERTIA lumped does not apply to REPORT peaks" <"$scratch/other.deck" &&
    warned other_mesh "'elements=' does not apply to REPORT peaks" <"$scratch/other.deck"
}

# A rough drawing is a remark in the log, one that is off by more than a tenth a warning; of variants one, with the worst.
drawing() {
  printf '%s\n' "UNITS mm kg s" "GROUND O 0 0" "GROUND Q 254 0" "LINK crank O A length=100" "LINK rod A B length=280" \
    "LINK arm Q B length=267" "PIN A 0 100" "PIN B 250 230" "DRIVE crank" "CRANK 0" "REPORT kinematics" >"$scratch/rough.deck"
  warned drawn "the drawing has 230.035 mm for 'arm' from Q to B; its length of 267 mm counts" <"$scratch/rough.deck" || return 1
  grep -q "^drawing: the drawing has 281.78 mm for 'rod' from A to B; its length of 280 mm counts" "$scratch/out/drawn/run.log" ||
    { echo "the log has no remark"; return 1; }
  { sed 's/length=100/length=$L/' "$scratch/rough.deck"; echo "VARY L 80 90 95 105 115"; } |
    warned varied "in 3 of 5 variants, the worst with L=80: the drawing has 100 mm for 'crank' from O to A"
}

divergence() {
  beam_deck "CRANK 0 to 350 step 10" "SPEED 0 200" "REPORT frequencies" |
    warned divergence "static divergence at speed 200 rad/s, crank" || return 1
  grep -v '^#' "$scratch/out/divergence/frequencies.dat" | grep -q ' -[0-9]' || { echo "no negative frequency"; return 1; }
}

# A LOAD that is damping only serves REPORT motion; the response of the same deck does without.
damping_load() {
  beam_deck "CRANK 0" "LOAD follower damping=0.1" "SPEED 10" "REPORT reactions" "REPORT torque" |
    sed 's/^MESH .*/MESH * accuracy=1e-6/; s/INERTIA  lumped/INERTIA distributed/' |
    warned damping_load "REPORT torque takes no notice of this LOAD, which is damping only; a DAMPER would act in it"
}

check "a stocky link" stocky
check "no stocky link with rotary inertia and shear" stocky_as_thick_beams
check "a wave speed that no solid has" wave_speed
check "a deflection above 1 %" deflection
check "units that make the frequencies meaningless" meaningless
check "loads that make the frequencies meaningless" meaningless_deflection
check "static frequencies and speeds" static_speeds
check "a mass at a ground pivot" mass_at_ground
check "static divergence" divergence
check "a drawing that contradicts a length" drawing
check "cards of the elastic response" idle_response
check "damping of a LOAD beside the elastic response" damping_load
