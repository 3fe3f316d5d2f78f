#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Seven atoms in the plane, a hexagon that is struck: a system without a highest frequency. The learner takes
# the frequencies that its data meet. What is gained at equal cost is small in the state (1.15 +- 0.08), and in the
# energy Chin's method is twice as good; then the cluster runs for ten thousand steps, and its energy stays.
set -eu

# [cluster]
nysalt learn --system lennard_jones --family fg_chin --step 0.045 --horizon 0.9 --output cluster.json |
  sed -n '1,4p; /uncertainty/p; /stability/p'
nysalt compare --equal-cost --system lennard_jones --steps 0.015 --metric state,energy --horizon 2 --trajectories 48 \
  --methods cluster.json,chin4a,srkn6b,verlet
nysalt run --system lennard_jones --method cluster.json --step 0.045 --horizon 450 --trajectories 3 \
  --observables energy,kinetic_temperature --sample-every 2500 --output cluster.csv
# [/cluster]
awk -F , '$2 != "step" { printf "trajectory %d  t = %5.1f  H = %.2f\n", $1, $3, $4 }' cluster.csv

# Expected output:
# fg_chin at step 0.045 for lennard_jones(space=2, atoms=7)
#   b                     0.169112~  +- 8.63e-05
#   c                     0.013305~  +- 2.67e-05
#   usable                yes
#   uncertainty           adds 3.6e-09 to the loss on new data, 0.13 % of it; it rests on 6 trajectories, too few to rely on it: take more, or starts of less different energies
#   stability             estimated 0..26.35 along 125 states
# lennard_jones(space=2, atoms=7), 48 trajectories over 2
# starts: lennard_jones_law(temperature=0.1)
# steps are per force evaluation: equal steps, equal cost
#
# state error
#
# step sizes  reference                   its own error, at most  null model, at least  predictable until
# ----------  --------------------------  ----------------------  --------------------  -----------------
# 0.015       srkn11b with step 0.005                   1.64e-13              1.31e+00            the end
# 0.045       srkn11b with step 0.005625                2.83e-13              1.31e+00            the end
# 0.09        srkn11b with step 0.006                   4.18e-13              1.32e+00            the end
#
# method         step  evaluations/time  ns/time  median +     error  standard error  diverged  marks
# ------------  -----  ----------------  -------  --------  --------  --------------  --------  -----
# cluster.json  0.015              67.2~%  6.01e-04        1.34e-05      0/48
# chin4a        0.015              67.2~%  6.90e-04        4.33e-05      0/48
# srkn6b        0.015              67.2~%  1.03e-03        7.29e-05      0/48
# verlet        0.015              67.2~%  1.33e-02        3.92e-04      0/48
# null model        -               0.0        0         -  1.31e+00               -         -
#
# at equal cost   step     error  best of the others  its error  its error / learned  its ns / learned
# -------------  -----  --------  ------------------  ---------  -------------------  ----------------
# cluster.json   0.015  6.01e-04              chin4a   6.90e-04          1.15 ± 0.08~
#
# energy error
#
# method         step  evaluations/time  ns/time  median +     error  standard error  diverged  marks
# ------------  -----  ----------------  -------  --------  --------  --------------  --------  -----
# cluster.json  0.015              67.2~%  1.20e-05        9.90e-07      0/48
# chin4a        0.015              67.2~%  6.28e-06        5.88e-07      0/48
# srkn6b        0.015              67.2~%  3.52e-05        3.72e-06      0/48
# verlet        0.015              67.2~%  2.14e-04        1.24e-05      0/48
#
# at equal cost   step     error  best of the others  its error  its error / learned  its ns / learned
# -------------  -----  --------  ------------------  ---------  -------------------  ----------------
# cluster.json   0.015  1.20e-05              chin4a   6.28e-06          0.52 ± 0.07~
#
# peak memory: ~ MB
# 3 trajectories of 10000 steps, 30001 force evaluations each, ~ s
# Written: cluster.csv
# trajectory 0  t =   0.0  H = -12.09
# trajectory 0  t = 112.5  H = -12.09
# trajectory 0  t = 225.0  H = -12.09
# trajectory 0  t = 337.5  H = -12.09
# trajectory 0  t = 450.0  H = -12.09
# trajectory 1  t =   0.0  H = -11.59
# trajectory 1  t = 112.5  H = -11.59
# trajectory 1  t = 225.0  H = -11.59
# trajectory 1  t = 337.5  H = -11.59
# trajectory 1  t = 450.0  H = -11.59
# trajectory 2  t =   0.0  H = -12.07
# trajectory 2  t = 112.5  H = -12.07
# trajectory 2  t = 225.0  H = -12.07
# trajectory 2  t = 337.5  H = -12.07
# trajectory 2  t = 450.0  H = -12.07
