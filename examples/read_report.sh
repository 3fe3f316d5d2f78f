#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A comparison with all that its numbers are seen against. With --output it is also a page, report.html.
set -eu

# [report]
nysalt compare --equal-cost --system fpu --steps 0.015 --horizon 20 --trajectories 48 --metric path,state \
  --learn-horizon 1 --methods learned:fg_chin,learned:nystrom,phase_fitted_mclachlan5,srkn6b,s_aia2,verlet --output report
# [/report]

# Expected output:
# path error of stiff_energy: learned:fg_chin is best: at 66.72 evaluations a unit of time its error is 12 ± 2
#   times smaller than that of the next, phase_fitted_mclachlan5.
# state error: phase_fitted_mclachlan5 is best: at 66.72 evaluations a unit of time its error is 3.4 ± 0.3 times
#   smaller than that of the next, learned:fg_chin.
#
# fpu_chain(pairs=3, omega=50), 48 trajectories over 20; starts: fpu_law(omega=50)
# steps are per force evaluation: equal steps, equal cost
#
# path error of stiff_energy
#
# rank  method                    step  evaluations/time      median error  times the best           marks
# ----  -----------------------  -----  ----------------  ----------------  --------------  --------------
# 1     learned:fg_chin          0.015              66.7  6.37e-05 ± 8e-06               1            tail
# 2     phase_fitted_mclachlan5  0.015              66.7  7.95e-04 ± 1e-04            12.5
# -     learned:nystrom          0.015              66.7  8.24e-03 ± 9e-04               -    null formula
# -     srkn6b                   0.015              66.7  2.03e-01 ± 3e-03               -  null tail edge
# -     s_aia2                   0.015              66.7  7.29e-03 ± 1e-03               -            null
# -     verlet                   0.015              66.7  3.87e-02 ± 4e-03               -       null tail
# null: no better than the null model, which stays as it was at the start and costs nothing; tail: few
#   trajectories decide the mean; formula: learned, but nothing was gained; edge: the method at this step is
#   near an edge
#
# state error
#
# rank  method                    step  evaluations/time      median error  times the best    marks
# ----  -----------------------  -----  ----------------  ----------------  --------------  -------
# 1     phase_fitted_mclachlan5  0.015              66.7  2.63e-03 ± 1e-04               1     tail
# 2     learned:fg_chin          0.015              66.7  8.92e-03 ± 6e-04            3.39     tail
# 3     verlet                   0.015              66.7  4.01e+00 ± 2e-01        1.52e+03
# 4     learned:nystrom          0.015              66.7  4.03e+00 ± 2e-01        1.53e+03  formula
# 5     srkn6b                   0.015              66.7  4.06e+00 ± 1e-01        1.55e+03     edge
# 6     s_aia2                   0.015              66.7  4.07e+00 ± 2e-01        1.55e+03
# tail: few trajectories decide the mean; formula: learned, but nothing was gained; edge: the method at this
#   step is near an edge
#
# learned for state, by the loss trajectory
# Written: report
