#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Which method for my system? `recommend` learns some families, races them with the classical methods on
# trajectories that were not learned from, and says which wins by how much, or that none does.
set -eu

# [recommend]
nysalt recommend --system henon_heiles --budget 5 --horizon 20 --families bab6,fg_chin --output best.json
nysalt run --system henon_heiles --method best.json --step 1.2 --horizon 1200 --observables energy --sample-every 500 \
  --output energy.csv
# [/recommend]
awk -F , 'NR > 2 { printf "t = %4d  H = %.4f\n", $3, $4 }' energy.csv

# Not every family wins: `fg_chin`, on the pendulum, does no better than the best classical method.
nysalt recommend --system pendulum --budget 4 --horizon 20 --trajectories 50 --families fg_chin | tail -n 1

# Expected output:
# henon_heiles(), 100 fresh trajectories over 20, state error, 5 evaluations per unit time
# starts: normal_around(0.1, 0.1)
# learned for state, by the loss trajectory
#
# method                     order    step  evaluations/time  ns/time     error  standard error  95 % err below  diverged
# -------------------------  -----  ------  ----------------  -------  --------  --------------  --------------  --------
# learned:bab6                   2     1.2               5.0~4.73e-06            tail        9.02e-06     0/100
# learned:fg_chin                2     0.6               5.0~3.03e-05            tail        5.05e-05     0/100
# phase_fitted_omelyan5v         4       1               5.0~2.71e-05            tail        5.30e-05     0/100
# phase_fitted_omelyan_fg4       4     0.8               5.0~3.15e-05            tail        5.84e-05     0/100
# phase_fitted_chin4a            4     0.6               5.0~3.18e-05            tail        6.65e-05     0/100
# phase_fitted_srkn6b            4     1.2               5.0~3.89e-05            tail        7.65e-05     0/100
# phase_fitted_mclachlan5        4       1               5.0~6.53e-05            tail        1.27e-04     0/100
# phase_fitted_pefrl             4     0.8               5.0~6.88e-05            tail        1.30e-04     0/100
# chin4a                         4     0.6               5.0~9.75e-05            tail        1.82e-04     0/100
# omelyan5v                      4       1               5.0~1.13e-04            tail        1.90e-04     0/100
# blanes_moan_s6                 4     1.2               5.0~1.13e-04            tail        1.91e-04     0/100
# omelyan_fg4                    4     0.8               5.0~1.14e-04            tail        1.98e-04     0/100
# srkn6b                         4     1.2               5.0~1.19e-04            tail        2.10e-04     0/100
# mclachlan5                     4       1               5.0~1.48e-04            tail        2.37e-04     0/100
# takahashi_imada_processed      4  0.4255               5.0~1.38e-04            tail        2.45e-04     0/100
# srkn11b                        6     2.2               5.0~1.38e-04            tail        2.58e-04     0/100
# mclachlan_atela4               4     0.8               5.0~1.45e-04            tail        2.59e-04     0/100
# pefrl                          4     0.8               5.0~1.63e-04            tail        2.67e-04     0/100
# omelyan5p                      4       1               5.0~2.53e-04            tail        4.48e-04     0/100
# srkn14a                        6     2.8               5.0~2.75e-04            tail        4.86e-04     0/100
# phase_fitted_vefrl             4     0.8               5.0~2.47e-04            tail        5.11e-04     0/100
# fg4_processed                  6  0.9302               5.0~3.87e-04            tail        7.69e-04     0/100
# blanes_moan_s10                6       2               5.0~5.88e-04            tail        1.05e-03     0/100
# impulse                        2     0.2               5.0~6.52e-04            tail        1.23e-03     0/100
# vefrl                          4     0.8               5.0~1.10e-03            tail        1.87e-03     0/100
# takahashi_imada                2     0.4               5.0~2.25e-03            tail        3.59e-03     0/100
# verlet                         2     0.2               5.0~4.05e-03            tail        6.12e-03     0/100
# verlet_aba                     2     0.2               5.0~3.95e-03         1.4e-04        6.22e-03     0/100
# bcss2                          2     0.4               5.0~4.19e-03         1.4e-04        6.35e-03     0/100
# bcss2v                         2     0.4               5.0~4.23e-03         1.5e-04        6.41e-03     0/100
# bcss3                          2     0.6               5.0~4.45e-03         1.5e-04        6.74e-03     0/100
# mclachlan2                     2     0.4               5.0~4.54e-03         1.5e-04        6.74e-03     0/100
# s_aia2                         2     0.4               5.0~4.54e-03         1.5e-04        6.74e-03     0/100
# mclachlan2v                    2     0.4               5.0~4.54e-03         1.5e-04        6.75e-03     0/100
# s_aia3                         2     0.6               5.0~4.63e-03         1.6e-04        6.89e-03     0/100
# predescu3                      2     0.6               5.0~4.66e-03         1.6e-04        6.91e-03     0/100
# bcss4                          2     0.8               5.0~4.76e-03         1.6e-04        7.10e-03     0/100
# forest_ruth                    4     0.6               5.0~2.72e-02            tail        4.61e-02     0/100
# tail: this mean rests on few trajectories; ranked by what 95 of 100 trajectories err less than
#
# Take learned:bab6 at step 1.2: its error is 6.07 times smaller (95 %: 4.43 to 7.81) than that of phase_fitted_omelyan5v, the best classical method, at ~
# Written: best.json
# 1 trajectories of 1000 steps, 6001 force evaluations each, ~ s
# Written: energy.csv
# t =    0  H = 0.0088
# t =  600  H = 0.0088
# t = 1200  H = 0.0088
# A tie: learned:fg_chin and chin4a do not differ significantly (the ratio of their errors is 0.897, 95 %: 0.762 to 1.88). The latter needs no learning: --method chin4a --step 0.75. ~
