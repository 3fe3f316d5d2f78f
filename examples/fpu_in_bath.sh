#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The stiff chain in a bath, as in the paper: a method learned with the noise of its data, beside BAOAB along
# common noise, and by the memory of the stiff energy. langevin_fpu.sh is the same at length, with pictures.
set -eu

# [bath]
bath="--system fpu --friction 0.01 --sigma 0.05"
nysalt learn $bath --family nystrom --placement symmetric --step 0.033 --horizon 1 --output scheme.json | head -n 3
nysalt compare $bath --methods scheme.json,baoab,baoab_2x,s_aia2 --steps 0.033 --horizon 1 --trajectories 400
nysalt compare $bath --methods scheme.json,baoab,baoab_2x,s_aia2 --steps 0.033 --horizon 20 --trajectories 200 \
  --metric acf
# [/bath]

# Expected output:
# nystrom at step 0.033 for fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05): usable, with a
#   held-out loss 1.11 ± 0.0066 times smaller than that of bcss2, the best classical method of the same cost.
# b1=0.52604773838771002±1.6e-03, beta1=0.40773760081473737±8.2e-04
# s_aia2 is best: at 60.61 to 61.62 evaluations a unit of time its error is 1.022 ± 0.010 times smaller than
#   that of the next, scheme.json.
#
# fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05), 400 trajectories over 1; starts:
#   gibbs(temperature=0.125, from fpu_law(omega=50), burned in for 31.23 with friction 0.7865 and step 0.009933)
#
# path error of stiff_energy
#
# rank  method        step  evaluations/time             error  times the best  marks
# ----  -----------  -----  ----------------  ----------------  --------------  -----
# 1     s_aia2       0.033              60.6  3.44e-02 ± 1e-03               1
# 2     scheme.json  0.033              60.6  3.52e-02 ± 1e-03            1.02
# -     baoab        0.033              31.3  5.09e-01 ± 2e-02               -   null
# -     baoab_2x     0.033              61.6  6.15e-02 ± 2e-03               -   null
# null: no better than the null model, which stays as it was at the start and costs nothing
# No method is known to be better than another at 60.66 evaluations a unit of time: error bars do not separate
#   s_aia2 and scheme.json.
#
# fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05), 200 trajectories over 20; starts:
#   gibbs(temperature=0.125, from fpu_law(omega=50), burned in for 31.23 with friction 0.7865 and step 0.009933)
#
# acf error of stiff_energy
#
# rank  method        step  evaluations/time             error  times the best  marks
# ----  -----------  -----  ----------------  ----------------  --------------  -----
# 1     s_aia2       0.033              60.6  7.45e-04 ± 2e-03               1  floor
# 1     scheme.json  0.033              60.6  9.50e-04 ± 2e-03            1.28  floor
# -     baoab        0.033              30.4  2.69e-01 ± 2e-02               -   null
# -     baoab_2x     0.033              60.7  6.55e-03 ± 3e-03               -   null
# null: no better than the null model, which stays as it was at the start and costs nothing; floor: not above
#   the floor of sampling by two standard errors
