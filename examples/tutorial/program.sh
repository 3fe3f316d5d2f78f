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
# fg_chin at step 0.045 for fpu_chain(pairs=3, omega=50)
#   b                     0.18258749533645133  +- 6.81e-06
#   c                     0.011635454258910922  +- 5.05e-07
#   usable                yes
#   loss                  6.276150e-06 (trajectory over 200 steps) on 20000 pairs of 100 trajectories
#   held-out loss         4.950045e-06 on 20000 pairs; at the start 8.045218e+00
#   per coordinate        0.000642 root mean square on held-out data, compared to 0.819 at the start
#   best classical        phase_fitted of the same cost, held-out loss 6.453583e-05 (13 times this, +- 0.67)
#   uncertainty           adds 1.4e-08 to the loss on new data, 0.22 % of it; it rests on 27 trajectories
#   search                26 starts; this is from 'one step'
#   stability             declared bands [0, 5.94242] [49, 51.345]
#   judgement             good
#   trial                 128 trajectories of 20000 steps, none lost (at most 2.3 %); energy errs by 1.37e-03 of the kinetic energy (median), 3.33e-03 (95 %), 5.07e-03 (largest)
#   phase-fitted          the frequency 50, declared
#   one-step error        8.344e-04, the reference's own 2.385e-13
#   trajectory error      3.830e-03 at the end of held-out trajectories
#   coordinates           energy
#   condition             5.5e+05
#   iterations            8
#   reference             srkn11b with step 0.0001
#   starts                fpu_law(omega=50), seed 1, held out 2251799813685249
#   force derivatives     automatic differentiation
#   cost                  209408132 force evaluations; data ~ s, fit ~ s
#   for                   state
# Written: scheme.json
# scheme.json: BAGAB, order 2, 3 evaluations a step
# stable up to z = h omega = 3.14279661, 1.04759887 for each evaluation
#   window 0 .. 3.14279661
#   window 3.309630287 .. 4.171642181
#   good
#   trial: 128 trajectories of 20000 steps, none lost (at most 2.3 %); energy errs by 1.37e-03 of the kinetic energy (median), 3.33e-03 (95 %), 5.07e-03 (largest)
#   highest frequency along the motion 50.3383, z = 2.26522 (declared bands [0, 5.94242] [49, 51.345])
#   linear margin 27.9 %
#   frequencies 0 .. 5.8259 of fpu_chain(pairs=3, omega=50) at step 0.045: margin 91.7 %
#   frequencies 50 .. 50.3383 of fpu_chain(pairs=3, omega=50) at step 0.045: margin 27.9 %
#   linearly stable steps 0 .. 0.0624335
#   linearly stable steps 0.0661926 .. 0.0828722
#   by the linear criterion steps up to 0.0295 have a margin of 30 % to the first end, and turn by less than a quarter
#   safe step 0.0295: trials lost nothing there, at 0.036875, 25 % more, and at shorter steps
# fpu_chain(pairs=3, omega=50), 48 trajectories over 10
# starts: fpu_law(omega=50)
# steps are per force evaluation: equal steps, equal cost
#
# state error
#
# Who is best depends on the cost: phase_fitted_mclachlan5 at 66.77, learned:fg_chin at 200.1 force evaluations per unit time.
#
# step sizes  reference                           its own error, at most  null model, at least  predictable until
# ----------  ----------------------------------  ----------------------  --------------------  -----------------
# 0.005       srkn11b with step 0.005                           1.74e-08              5.17e+00            the end
# 0.015       srkn11b with step 0.00375                         3.10e-09              5.17e+00            the end
# 0.02        srkn11b with step 0.004                           4.57e-09              5.17e+00            the end
# 0.025       srkn11b with step 0.00416666666667                5.84e-09              5.17e+00            the end
# 0.03        srkn11b with step 0.00375                         3.10e-09              5.17e+00            the end
# 0.045       srkn11b with step 0.00409090909091                5.23e-09              5.17e+00            the end
# 0.06        srkn11b with step 0.004                           4.57e-09              5.17e+00            the end
# 0.075       srkn11b with step 0.00394736842105                4.22e-09              5.17e+00            the end
# 0.09        srkn11b with step 0.00391304347826                4.01e-09              5.17e+00            the end
#
# method                    step  evaluations/time  ns/time  median +     error  standard error  median error           5 % to 95 %  diverged       verdict  marks
# -----------------------  -----  ----------------  -------  --------  --------  --------------  ------------  --------------------  --------  ------------  -----
# learned:fg_chin          0.005             200.1~4.86e-05~0/48          good   tail
# phase_fitted_mclachlan5  0.005             200.0~6.57e-05~0/48          good   tail
# srkn6b                   0.005             200.1~1.04e-01~0/48          good
# chin4a                   0.005             200.1~6.46e-02~0/48          good
# pefrl                    0.005             200.0~5.22e-02~0/48          good
# verlet                   0.005             200.1~2.14e+00~0/48          good
# learned:fg_chin          0.015              66.8~4.23e-03~0/48          good   tail
# phase_fitted_mclachlan5  0.015              66.7~2.66e-03~0/48          good   tail
# srkn6b                   0.015              66.8~4.24e+00~0/48  near an edge   edge
# chin4a                   0.015              66.8~4.59e+00~0/48          good
# pefrl                    0.015              66.7~-~48/48      unstable
# verlet                   0.015              66.8~4.16e+00~0/48          good
# null model                   -               0.0        0         -  5.17e+00               -             -                     -         -             -
# `tail`: few trajectories decide the mean: it and its standard error say little; ranked by the median, as are all rows here
# `edge`: the method at this step is near an edge: the judgement in the data says which
# pefrl at step 0.015: every trajectory diverged, the first of them at step 41
#
# at equal cost     step  median error       best of the others  its median error  its error / learned  its ns / learned
# ---------------  -----  ------------  -----------------------  ----------------  -------------------  ----------------
# learned:fg_chin  0.005      3.68e-05  phase_fitted_mclachlan5          5.82e-05            1.6 ± 0.2~
# learned:fg_chin  0.015      3.44e-03  phase_fitted_mclachlan5          2.40e-03          0.70 ± 0.06~
#
# fitted to the frequency 50, declared: phase_fitted_mclachlan5
#
# learned for state, by the loss trajectory
#
# peak memory: ~ MB
# Written: report
# 1 trajectories of 11111 steps, 33334 force evaluations each, ~ s
# Written: energies.csv
