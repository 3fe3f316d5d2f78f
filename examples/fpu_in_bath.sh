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
# nystrom at step 0.033 for fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05)
#   b1                    0.52604773838771002  +- 1.65e-03
#   beta1                 0.40773760081473737  +- 8.17e-04
# fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05), 400 trajectories over 1
# starts: gibbs(temperature=0.125, from fpu_law(omega=50), burned in for 31.23 with friction 0.7865 and step 0.009933)
#
# path error of stiff_energy
#
# s_aia2 is best: at 60.61 to 61.62 evaluations a unit of time its error is 1.022 ± 0.010 times smaller than that of the next, scheme.json.
#
# step sizes  reference               its own error, at most  null model, at least  predictable until
# ----------  ----------------------  ----------------------  --------------------  -----------------
# 0.033       baoab with step 0.0001                5.79e-05              4.16e-02            the end
#
# method        step  evaluations/time  ns/time  median +     error  standard error  median error           5 % to 95 %  diverged  verdict  marks
# -----------  -----  ----------------  -------  --------  --------  --------------  ------------  --------------------  --------  -------  -----
# scheme.json  0.033              60.6~3.52e-02~0/400     good
# baoab        0.033              31.3~5.09e-01~0/400     good   null
# baoab_2x     0.033              61.6~6.15e-02~0/400     good   null
# s_aia2       0.033              60.6~3.44e-02~0/400     good
# null model       -               0.0        0         -  4.16e-02               -             -                     -         -        -
# `null`: no better than the null model, which stays as it was at the start and costs nothing; not ranked
#
# at equal cost   step     error  best of the others  its error  its error / learned  its ns / learned
# -------------  -----  --------  ------------------  ---------  -------------------  ----------------
# scheme.json    0.033  3.52e-02              s_aia2   3.44e-02        0.978 ± 0.009~
#
# fitted to the frequency 50.3383, declared: s_aia2
#
# peak memory: ~ MB
# fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05), 200 trajectories over 20
# starts: gibbs(temperature=0.125, from fpu_law(omega=50), burned in for 31.23 with friction 0.7865 and step 0.009933)
#
# acf error of stiff_energy
#
# No method is known to be better than another at 60.66 force evaluations per unit time: error bars do not separate s_aia2 and scheme.json.
#
# step sizes  reference              its finer self, at most  null model, at least  floor of sampling
# ----------  ---------------------  -----------------------  --------------------  -----------------
# 0.033       baoab with step 0.001                 9.31e-04              5.93e-03           7.37e-04
#
# method              step  evaluations/time  ns/time  median +     error  standard error  diverged  verdict  marks
# -----------------  -----  ----------------  -------  --------  --------  --------------  --------  -------  -----
# scheme.json        0.033              60.6~9.50e-04~0/200     good  floor
# baoab              0.033              30.4~2.69e-01~0/200     good   null
# baoab_2x           0.033              60.7~6.55e-03~0/200     good   null
# s_aia2             0.033              60.6~7.45e-04~0/200     good  floor
# null model             -               0.0        0         -  5.93e-03               -         -        -
# floor of sampling      -               0.0        0         -  7.37e-04               -         -        -
# `null`: no better than the null model, which stays as it was at the start and costs nothing; not ranked
# `floor`: not above the floor of sampling by two standard errors: nothing is seen of the method
#
# at equal cost   step     error  best of the others  its error  its error / learned  its ns / learned
# -------------  -----  --------  ------------------  ---------  -------------------  ----------------
# scheme.json    0.033  9.50e-04              s_aia2   7.45e-04                1 ± 2~
#
# fitted to the frequency 50.3383, declared: s_aia2
#
# peak memory: ~ MB
