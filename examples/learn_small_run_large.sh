#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A method is learned for a chain of 3 pairs, and steps one of 64 pairs after a trial run there.
set -eu

# [learn]
nysalt learn --system fpu --step 0.0888 --effort quick --trajectories 50 --output small.json >learned.txt
nysalt compare --system fpu --parameter pairs=64 --steps 0.0148 --equal-cost --metric state --horizon 5 --trajectories 16 \
  --methods small.json,verlet,pefrl,blanes_moan_s6,phase_fitted_mclachlan5
# [/learn]

# Another stiffness is another kind.
nysalt run --system fpu --parameter pairs=64,omega=51 --method small.json --step 0.0888 --horizon 8.88 || echo "exit code $?"

# Frequencies that grow with the number of atoms: this step is too long for thirteen, and the trial says so.
# [refused]
nysalt learn --system lennard_jones --parameter atoms=2 --family nystrom --step 0.08 --trajectories 30 --effort quick \
  --output pair.json >learned.txt
nysalt run --system lennard_jones --parameter atoms=13 --method pair.json --step 0.08 --horizon 6 || echo "exit code $?"
# [/refused]

# Expected output:
# small.json is best: at 67.77 evaluations a unit of time its error is 2.83 ± 0.05 times smaller than that of
#   the next, phase_fitted_mclachlan5.
#
# fpu_chain(pairs=64, omega=50), 16 trajectories over 5; starts: fpu_law(omega=50)
# steps are per force evaluation: equal steps, equal cost
#
# state error
#
# rank  method                     step  evaluations/time             error  times the best  marks
# ----  -----------------------  ------  ----------------  ----------------  --------------  -----
# 1     small.json               0.0148              67.8  2.13e-03 ± 4e-05               1
# 2     phase_fitted_mclachlan5  0.0148              67.6  6.04e-03 ± 2e-04            2.83
# 3     blanes_moan_s6           0.0148              67.8  1.27e+01 ± 2e-01        5.97e+03
# 4     verlet                   0.0148              67.8  1.99e+01 ± 2e-01         9.3e+03
# -     pefrl                    0.0148              67.6  2.62e+01 ± 1e-01               -  loses
# loses: the method loses trajectories in long runs at this step
# exit code 2
# exit code 2
