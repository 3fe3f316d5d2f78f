#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Seven atoms in the plane, a hexagon that is struck: a system without a highest frequency. The learner takes
# the frequencies that its data meet. At equal cost the median error of the state is 2.6 +- 0.2 times smaller than
# that of Chin's method; in the energy error bars do not separate the two. Then the cluster runs for ten thousand
# steps, and its energy stays.
set -eu

# [cluster]
nysalt learn --system lennard_jones --family fg_chin --step 0.045 --horizon 0.9 --output cluster.json |
  sed -n '1,4p; /uncertainty/p; /stability/p'
nysalt compare --equal-cost --system lennard_jones --steps 0.015 --metric state,energy --horizon 2 --trajectories 48 \
  --methods cluster.json,chin4a,srkn6b,verlet
nysalt run --system lennard_jones --method cluster.json --step 0.045 --horizon 450 --trajectories 3 \
  --observables energy,kinetic_temperature --sample-every 2500 --output cluster.csv
# [/cluster]
awk -F , 'NR > 2 { printf "trajectory %d  t = %5.1f  H = %.2f\n", $1, $3, $4 }' cluster.csv

# Expected output:
# fg_chin at step 0.045 for lennard_jones(space=2, atoms=7)
#   b                     0.16780990611397137  +- not known
#   c                     0.013566333523868417  +- not known
#   usable                yes
#   uncertainty           adds 5.2e-08 to the loss on new data, 0.7 % of it; it rests on 6 trajectories, too few to rely on it: take more, or starts of less different energies
#   stability             estimated 0..26.98 along 704 states, 0..21.11 in nine tenths of them
# lennard_jones(space=2, atoms=7), 48 trajectories over 2
# starts: lennard_jones_law(temperature=0.1)
# steps are per force evaluation: equal steps, equal cost
#
# state error
#
# cluster.json is best: at 67.17 evaluations a unit of time its error is 2.6 ± 0.2 times smaller than that of the next, chin4a.
#
# step sizes  reference                   its own error, at most  null model, at least  predictable until
# ----------  --------------------------  ----------------------  --------------------  -----------------
# 0.015       srkn11b with step 0.005                   1.64e-13              1.30e+00            the end
# 0.045       srkn11b with step 0.005625                2.82e-13              1.30e+00            the end
# 0.09        srkn11b with step 0.006                   4.09e-13              1.30e+00            the end
#
# method         step  evaluations/time  ns/time  median +     error  standard error  median error           5 % to 95 %  diverged  verdict  marks
# ------------  -----  ----------------  -------  --------  --------  --------------  ------------  --------------------  --------  -------  -----
# cluster.json  0.015              67.2~2.50e-04~0/48     good   tail
# chin4a        0.015              67.2~6.85e-04~0/48     good   tail
# srkn6b        0.015              67.2~1.01e-03~0/48     good   tail
# verlet        0.015              67.2~1.32e-02~0/48     good
# null model        -               0.0        0         -  1.30e+00               -             -                     -         -        -
# `tail`: few trajectories decide the mean: it and its standard error say little; ranked by the median, as are all rows here
#
# at equal cost   step  median error  best of the others  its median error  its error / learned  its ns / learned
# -------------  -----  ------------  ------------------  ----------------  -------------------  ----------------
# cluster.json   0.015      2.24e-04              chin4a          5.80e-04            2.6 ± 0.2~
#
# energy error
#
# The best are cluster.json and chin4a at 67.17 force evaluations per unit time: error bars do not separate them.
#
# method         step  evaluations/time  ns/time  median +     error  standard error  median error           5 % to 95 %  diverged  verdict  marks
# ------------  -----  ----------------  -------  --------  --------  --------------  ------------  --------------------  --------  -------  -----
# cluster.json  0.015              67.2~6.35e-06~0/48     good   tail
# chin4a        0.015              67.2~6.17e-06~0/48     good   tail
# srkn6b        0.015              67.2~3.41e-05~0/48     good   tail
# verlet        0.015              67.2~2.11e-04~0/48     good
# `tail`: few trajectories decide the mean: it and its standard error say little; ranked by the median, as are all rows here
#
# at equal cost   step  median error  best of the others  its median error  its error / learned  its ns / learned
# -------------  -----  ------------  ------------------  ----------------  -------------------  ----------------
# cluster.json   0.015      4.32e-06              chin4a          4.76e-06            1.1 ± 0.2~
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
