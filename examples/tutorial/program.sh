#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The tutorial with the program: learn for the stiff chain, check that it is stable, compare, run.
set -eu

# [learn]
nysalt learn --system fpu --family fg_chin --step 0.045 --output scheme.json
# [/learn]
# [stability]
nysalt stability --method scheme.json --system fpu --step 0.045
# [/stability]
# [compare]
nysalt compare --equal-cost --system fpu --steps 0.005,0.015 --metric state --horizon 10 --trajectories 48 \
  --methods learned:fg_chin,phase_fitted_mclachlan5,srkn6b,chin4a,pefrl,verlet --output report
# [/compare]
# [run]
nysalt run --system fpu --method scheme.json --step 0.045 --horizon 500 --observables stiff_energy,energy \
  --sample-every 100 --output energies.csv --plot
# [/run]

# Expected output:
# fg_chin at step 0.045 for fpu_chain(pairs=3, omega=50): usable, with a held-out loss 13 ± 0.67 times smaller
#   than that of phase_fitted, the best classical method of the same cost.
# b=0.18258749533645133±6.8e-06, c=0.011635454258910922±5.0e-07
# held-out loss 4.950e-06 (trajectory), 8.045e+00 at the start of the search
# one-step error 8.34e-04; at the end of held-out trajectories 3.83e-03
# judgement: good
# learned from 100 trajectories in ~ s and 2.09e+08 force evaluations
# Written: scheme.json
# scheme.json at step 0.045 for fpu_chain(pairs=3, omega=50): good
#
# range                              from             to  margin
# ------------------------  -------------  -------------  ------
# stable z = h omega                    0     3.14279661       -
# stable z = h omega          3.309630287    4.171642181       -
# frequencies at this step              0     5.82590126  91.7 %
# frequencies at this step             50    50.33826701  27.9 %
# linearly stable steps                 0  0.06243354802       -
# linearly stable steps     0.06619260574   0.0828721851       -
#
# scheme.json is stable up to z = h omega = 3.14279661, 1.04759887 for each evaluation
# trial: 128 trajectories of 20000 steps, none lost (at most 2.3 %); energy errs by 1.37e-03 of the kinetic
#   energy (median), 3.33e-03 (95 %), 5.07e-03 (largest)
# highest frequency along the motion 50.3383, z = 2.26522 (declared bands [0, 5.94242] [49, 51.345])
# linear margin 27.9 %
# by the linear criterion steps up to 0.0295 have a margin of 30 % to the first end, and turn by less than a
#   quarter
# safe step 0.0295: trials lost nothing there, at 0.036875, 25 % more, and at shorter steps
# Who is best depends on the cost: phase_fitted_mclachlan5 at 66.77, learned:fg_chin at 200.1 evaluations a unit
#   of time.
#
# fpu_chain(pairs=3, omega=50), 48 trajectories over 10; starts: fpu_law(omega=50)
# steps are per force evaluation: equal steps, equal cost
#
# state error
#
# rank  method                    step  evaluations/time      median error  times the best     marks
# ----  -----------------------  -----  ----------------  ----------------  --------------  --------
# 1     learned:fg_chin          0.005             200.1  3.68e-05 ± 3e-06               1      tail
# 1     phase_fitted_mclachlan5  0.015              66.7  2.40e-03 ± 1e-04               1      tail
# 2     learned:fg_chin          0.015              66.8  3.44e-03 ± 2e-04            1.44      tail
# 2     phase_fitted_mclachlan5  0.005             200.0  5.82e-05 ± 3e-06            1.58      tail
# 3     pefrl                    0.005             200.0  5.02e-02 ± 2e-03        1.37e+03
# 4     verlet                   0.015              66.8  4.01e+00 ± 2e-01        1.67e+03
# 5     chin4a                   0.005             200.1  6.22e-02 ± 3e-03        1.69e+03
# 6     srkn6b                   0.015              66.8  4.11e+00 ± 1e-01        1.72e+03      edge
# 6     chin4a                   0.015              66.8  4.42e+00 ± 2e-01        1.84e+03
# 6     srkn6b                   0.005             200.1  9.99e-02 ± 4e-03        2.72e+03
# 6     verlet                   0.005             200.1  2.06e+00 ± 9e-02         5.6e+04
# -     pefrl                    0.015              66.7                 -               -  no value
# tail: few trajectories decide the mean; edge: the method at this step is near an edge
#
# learned for state, by the loss trajectory
# Written: report
# 1 trajectories of 11111 steps, 33334 force evaluations each, ~ s
# Written: energies.csv
