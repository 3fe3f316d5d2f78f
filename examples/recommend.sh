#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Which method for my system? `recommend` learns some families, races them with the classical methods on
# trajectories that were not learned from, and says which wins by how much, or that none does.
set -eu

# [recommend]
nysalt recommend --system henon_heiles --budget 5 --horizon 20 --families bab6,fg_chin --output best.json >advice.txt
nysalt run --system henon_heiles --method best.json --step 1.2 --horizon 1200 --observables energy --sample-every 500 \
  --output energy.csv
# [/recommend]
head -n 1 advice.txt
sed -n '/^rank/,$p' advice.txt
awk -F , 'NR > 2 { printf "t = %4d  H = %.4f\n", $3, $4 }' energy.csv

# Not every family wins: `fg_chin`, on the pendulum, does no better than the best classical method.
nysalt recommend --system pendulum --budget 4 --horizon 20 --trajectories 50 --families fg_chin | head -n 1

# Expected output:
# 1 trajectories of 1000 steps, 6001 force evaluations each, ~ s
# Written: energy.csv
# Take learned:bab6 at step 1.2: its error is 6.07 times smaller (95 %: 4.43 to 7.81) than that of
# rank  method                    step  evaluations/time  ns/time  95 % err below  ratio                marks
# ----  ------------------------  ----  ----------------  -------  --------------  -----  -------------------
# 1     learned:bab6               1.2               5.0~        9.02e-06      1         learned tail
# 2     phase_fitted_omelyan5v       1               5.0~        5.30e-05   5.88                 tail
# -     learned:fg_chin            0.6               5.0~        7.61e-05   8.43  learned tail behind
# -     phase_fitted_omelyan_fg4   0.8               5.0~        7.82e-05   8.68          tail behind
# -     phase_fitted_chin4a        0.6               5.0~        9.14e-05   10.1          tail behind
# -     phase_fitted_srkn6b        1.2               5.0~        9.27e-05   10.3          tail behind
# -     phase_fitted_pefrl         0.8               5.0~        1.30e-04   14.4          tail behind
# -     phase_fitted_mclachlan5      1               5.0~        1.33e-04   14.8          tail behind
# -     srkn6b                     1.2               5.0~        2.15e-04   23.9          tail behind
# -     omelyan5v                    1               5.0~        2.27e-04   25.2          tail behind
# -     omelyan_fg4                0.8               5.0~        2.29e-04   25.3          tail behind
# -     chin4a                     0.6               5.0~        2.31e-04   25.6          tail behind
# and 26 more, in the details
# tail: the mean error rests on few trajectories; ranked by what 95 of 100 trajectories err less than
# behind: left behind, judged on fewer than 100 trajectories, on which the error was larger than the least by
#   more than chance
# Written: best.json
# t =    0  H = 0.0088
# t =  600  H = 0.0088
# t = 1200  H = 0.0088
# A tie: learned:fg_chin and chin4a do not differ significantly (the ratio of their errors is 0.897, 95 %: 0.762
