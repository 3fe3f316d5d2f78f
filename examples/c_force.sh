#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A force in C, in a shared object, as a system of the program: learned for, and compared at equal cost.
set -e
here=$(dirname "$0")
# [build]
cc -O3 -shared -fPIC -I "$here/../include" "$here/c_force/morse_system.c" "$here/c_force/morse_chain.c" -lm -o morse.so
nysalt learn --system ./morse.so --family aba4 --step 0.2 --horizon 4 --trajectories 20 --output scheme.json >learned.txt
nysalt compare --system ./morse.so --methods verlet,srkn6b,scheme.json --steps 0.05 --equal-cost --horizon 4 \
  --trajectories 32 >compared.txt
# [/build]
head -n 2 learned.txt

# Expected output:
# aba4 at step 0.2 for morse_chain(depth=10, width=1): usable, with a held-out loss 1.59 ± 0.22 times smaller
#   than that of phase_fitted, the best classical method of the same cost.
