#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A comparison with all that its numbers are seen against. With --output it is also a page, report.html.
set -eu

# [report]
nysalt compare --equal-cost --system fpu --steps 0.015 --horizon 20 --trajectories 48 --metric path,state \
  --learn-horizon 1 --methods learned:fg_chin,learned:nystrom,phase_fitted_mclachlan5,srkn6b,s_aia2,verlet --output report
# [/report]

# Expected output:
# fpu_chain(pairs=3, omega=50), 48 trajectories over 20
# starts: fpu_law(omega=50)
# steps are per force evaluation: equal steps, equal cost
#
# path error of stiff_energy
#
# learned:fg_chin is best: at 66.72 evaluations a unit of time its error is 12 ± 2 times smaller than that of the next, phase_fitted_mclachlan5.
#
# step sizes     reference                           its own error, at most  null model, at least  predictable until
# -------------  ----------------------------------  ----------------------  --------------------  -----------------
# 0.015 to 0.03  srkn11b with step 0.00375                         1.60e-11              8.06e-03            the end
# 0.045          srkn11b with step 0.00409090909091                2.70e-11              8.06e-03            the end
# 0.075          srkn11b with step 0.00394736842105                2.19e-11              8.05e-03            the end
# 0.09           srkn11b with step 0.00391304347826                2.07e-11              8.05e-03            the end
#
# method                    step  evaluations/time  ns/time  median +     error  standard error  median error           5 % to 95 %  diverged       verdict           marks
# -----------------------  -----  ----------------  -------  --------  --------  --------------  ------------  --------------------  --------  ------------  --------------
# learned:fg_chin          0.015              66.7~8.09e-05~0/48          good            tail
# learned:nystrom          0.015              66.7~9.50e-03~0/48          good    null formula
# phase_fitted_mclachlan5  0.015              66.7~9.36e-04~0/48          good
# srkn6b                   0.015              66.7~2.20e-01~0/48  near an edge  null tail edge
# s_aia2                   0.015              66.7~8.07e-03~0/48          good            null
# verlet                   0.015              66.7~5.01e-02~0/48          good       null tail
# null model                   -               0.0        0         -  8.05e-03               -             -                     -         -             -
# `null`: no better than the null model, which stays as it was at the start and costs nothing; not ranked
# `tail`: few trajectories decide the mean: it and its standard error say little; ranked by the median, as are all rows here
# `formula`: learned, but nothing was gained: a classical method of the same cost, named with the fit, has as small a loss
# `edge`: the method at this step is near an edge: the judgement in the data says which
#
# at equal cost     step  median error       best of the others  its median error  its error / learned  its ns / learned
# ---------------  -----  ------------  -----------------------  ----------------  -------------------  ----------------
# learned:fg_chin  0.015      6.37e-05  phase_fitted_mclachlan5          7.95e-04               12 ± 2~
#
# state error
#
# phase_fitted_mclachlan5 is best: at 66.72 evaluations a unit of time its error is 3.4 ± 0.3 times smaller than that of the next, learned:fg_chin.
#
# step sizes     reference                           its own error, at most  null model, at least  predictable until
# -------------  ----------------------------------  ----------------------  --------------------  -----------------
# 0.015 to 0.03  srkn11b with step 0.00375                         6.21e-09              5.40e+00            the end
# 0.045          srkn11b with step 0.00409090909091                1.05e-08              5.40e+00            the end
# 0.075          srkn11b with step 0.00394736842105                8.45e-09              5.40e+00            the end
# 0.09           srkn11b with step 0.00391304347826                8.02e-09              5.40e+00            the end
#
# method                    step  evaluations/time  ns/time  median +     error  standard error  median error           5 % to 95 %  diverged       verdict    marks
# -----------------------  -----  ----------------  -------  --------  --------  --------------  ------------  --------------------  --------  ------------  -------
# learned:fg_chin          0.015              66.7~9.62e-03~0/48          good     tail
# learned:nystrom          0.015              66.7~4.18e+00~0/48          good  formula
# phase_fitted_mclachlan5  0.015              66.7~2.84e-03~0/48          good     tail
# srkn6b                   0.015              66.7~4.19e+00~0/48  near an edge     edge
# s_aia2                   0.015              66.7~4.23e+00~0/48          good
# verlet                   0.015              66.7~4.16e+00~0/48          good
# null model                   -               0.0        0         -  5.40e+00               -             -                     -         -             -
# `tail`: few trajectories decide the mean: it and its standard error say little; ranked by the median, as are all rows here
# `formula`: learned, but nothing was gained: a classical method of the same cost, named with the fit, has as small a loss
# `edge`: the method at this step is near an edge: the judgement in the data says which
#
# at equal cost     step  median error       best of the others  its median error  its error / learned  its ns / learned
# ---------------  -----  ------------  -----------------------  ----------------  -------------------  ----------------
# learned:fg_chin  0.015      8.92e-03  phase_fitted_mclachlan5          2.63e-03          0.29 ± 0.02~
# learned:nystrom  0.015      4.03e+00  phase_fitted_mclachlan5          2.63e-03    0.00065 ± 0.00004~
#
# fitted to the frequency 50, declared: phase_fitted_mclachlan5
# fitted to the frequency 50.3383, declared: s_aia2
#
# learned for state, by the loss trajectory
#
# peak memory: ~ MB
# Written: report
