#!/bin/sh
# A part of `make stress`: some cases of most families against their references in quadruple precision.
. tests/scripts/functions.sh

# family NAME N: one case in N
family() {
  python3 -B tests/stress/run_stress.py "$program" --out "$scratch/stress" --no-figures --every "$2" "$1"
}

check "stress: orders" family orders 9
check "stress: accuracy" family accuracy 5
check "stress: thickness" family thickness 7
check "stress: stiffness" family stiffness 5
check "stress: lengths" family lengths 11
check "stress: dead points" family dead_points 13
check "stress: divergence" family divergence 11
check "stress: near-equal frequencies" family near_equal 17
check "stress: units" family units 13
check "stress: random linkages" family random 29
