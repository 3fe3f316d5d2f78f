#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Which method for my system? `recommend` learns some families, races them with the classical methods on
# trajectories that nobody has seen, and says who wins by how much, or that nobody does.
set -eu

# [recommend]
nysalt recommend --system henon_heiles --budget 5 --horizon 20 --families bab6,fg_chin --output best.json
nysalt run --system henon_heiles --method best.json --step 1.2 --horizon 1200 --observables energy --sample-every 500 \
  --output energy.csv
# [/recommend]
awk -F , '$2 != "step" { printf "t = %4d  H = %.4f\n", $3, $4 }' energy.csv

# Not every family wins: `fg_chin`, on the pendulum, does no better than the best classical method.
nysalt recommend --system pendulum --budget 4 --horizon 20 --trajectories 50 --families fg_chin | tail -n 1

# Expected output:
# henon_heiles(), 100 fresh trajectories over 20, state error, 5 evaluations per unit time
# starts: normal_around(0.1, 0.1)
#
# method            order  step  evaluations/time  ns/time     error  standard error  diverged
# ----------------  -----  ----  ----------------  -------  --------  --------------  --------
# learned:bab6          2   1.2               5.1~1.24e-05         1.8e-06     0/100
# learned:fg_chin       2   0.6               5.1~5.73e-05         1.6e-06     0/100
# chin4a                4   0.6               5.1~9.87e-05         6.2e-06     0/100
# blanes_moan_s6        4   1.2               5.1~1.14e-04         1.0e-05     0/100
# srkn6b                4   1.2               5.1~1.20e-04         6.7e-06     0/100
# srkn11b               6   2.2               5.1~1.48e-04         2.0e-05     0/100
# mclachlan_atela4      4   0.8               5.0~1.49e-04         8.8e-06     0/100
# mclachlan5            4     1               5.0~1.51e-04         2.0e-05     0/100
# pefrl                 4   0.8               5.0~1.66e-04         1.5e-05     0/100
# srkn14a               6   2.8               5.0~2.87e-04         3.2e-05     0/100
# impulse               2   0.2               5.0~6.57e-04         1.1e-04     0/100
# takahashi_imada       2   0.4               5.0~2.27e-03         1.8e-04     0/100
# verlet_aba            2   0.2               5.0~3.98e-03         1.4e-04     0/100
# verlet                2   0.2               5.0~4.08e-03         1.5e-04     0/100
# bcss2                 2   0.4               5.0~4.25e-03         1.4e-04     0/100
# bcss3                 2   0.6               5.1~4.51e-03         1.5e-04     0/100
# mclachlan2            2   0.4               5.0~4.60e-03         1.6e-04     0/100
# s_aia2                2   0.4               5.0~4.61e-03         1.6e-04     0/100
# forest_ruth           4   0.6               5.0~2.75e-02         1.5e-03     0/100
#
# Take learned:bab6 at step 1.2: its error is 8 times smaller than that of chin4a, the best classical method (by 8.63e-05 +- 4.7e-06).
# Written: best.json
# 1 trajectories of 1000 steps, 6001 force evaluations each, ~ s
# Written: energy.csv
# t =    0  H = 0.0088
# t =  600  H = 0.0088
# t = 1200  H = 0.0088
# A tie: learned:fg_chin and chin4a differ by 8.5e-05 +- 8.1e-05 only. The latter needs no learning: --method chin4a --step 0.75.
