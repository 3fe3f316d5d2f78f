#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A comparison with all that its numbers are seen against. With --output it is also a page, report.html.
set -eu

# [report]
nysalt compare --equal-cost --system fpu --steps 0.015 --horizon 20 --trajectories 48 --metric path,state \
  --learn-horizon 1 --methods learned:fg_chin,learned:nystrom,srkn6b,s_aia2,verlet --output report
# [/report]

# Expected output:
# fpu_chain(pairs=3, omega=50), 48 trajectories over 20
# starts: fpu_law(omega=50)
# steps are per force evaluation: equal steps, equal cost
#
# path error of stiff_energy
#
# step sizes     reference                           its own error, at most  null model, at least  predictable until
# -------------  ----------------------------------  ----------------------  --------------------  -----------------
# 0.015 to 0.03  srkn11b with step 0.00375                         1.65e-11              9.22e-03            the end
# 0.045          srkn11b with step 0.00409090909091                2.78e-11              9.23e-03            the end
# 0.09           srkn11b with step 0.00391304347826                2.13e-11              9.24e-03            the end
#
# method            step  evaluations/time  ns/time  median +     error  standard error  diverged  marks
# ---------------  -----  ----------------  -------  --------  --------  --------------  --------  -----
# learned:fg_chin  0.015              66.7~%  8.46e-05        3.20e-06      0/48
# learned:nystrom  0.015              66.7~%  1.10e-02        6.30e-04      0/48   null
# srkn6b           0.015              66.7~%  2.79e-01        1.87e-02      0/48   null
# s_aia2           0.015              66.7~%  9.06e-03        7.15e-04      0/48
# verlet           0.015              66.7~%  5.47e-02        1.75e-03      0/48   null
# null model           -               0.0        0         -  9.22e-03               -         -
# `null`: no better than the null model, which stays as it was at the start and costs nothing; not ranked
#
# at equal cost     step     error  best of the others  its error  its error / learned  its ns / learned
# ---------------  -----  --------  ------------------  ---------  -------------------  ----------------
# learned:fg_chin  0.015  8.46e-05              s_aia2   9.06e-03              107 ± 9~
#
# state error
#
# step sizes     reference                           its own error, at most  null model, at least  predictable until
# -------------  ----------------------------------  ----------------------  --------------------  -----------------
# 0.015 to 0.03  srkn11b with step 0.00375                         6.21e-09              5.40e+00            the end
# 0.045          srkn11b with step 0.00409090909091                1.05e-08              5.41e+00            the end
# 0.09           srkn11b with step 0.00391304347826                8.04e-09              5.41e+00            the end
#
# method            step  evaluations/time  ns/time  median +     error  standard error  diverged  marks
# ---------------  -----  ----------------  -------  --------  --------  --------------  --------  -----
# learned:fg_chin  0.015              66.7~%  8.47e-03        4.22e-04      0/48
# learned:nystrom  0.015              66.7~%  4.19e+00        1.48e-01      0/48
# srkn6b           0.015              66.7~%  4.20e+00        1.27e-01      0/48
# s_aia2           0.015              66.7~%  4.23e+00        1.49e-01      0/48
# verlet           0.015              66.7~%  4.16e+00        1.43e-01      0/48
# null model           -               0.0        0         -  5.40e+00               -         -
#
# at equal cost     step     error  best of the others  its error  its error / learned  its ns / learned
# ---------------  -----  --------  ------------------  ---------  -------------------  ----------------
# learned:fg_chin  0.015  8.47e-03              verlet   4.16e+00             491 ± 30~
# learned:nystrom  0.015  4.19e+00              verlet   4.16e+00          0.99 ± 0.05~
#
# peak memory: ~ MB
# Written: report
