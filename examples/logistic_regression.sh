#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The posterior of a logistic regression on a table of one's own: 200 patients whose risk grows with age and
# dose, drawn by a small generator of random numbers. The table was made with the coefficients 0.9 for age and
# 0.5 for dose, each for one deviation of the predictor; the posterior has them within 1.3 deviations.
set -eu

# [table]
awk 'function uniform() { state = (state * 16807) % 2147483647; return state / 2147483647 }
  BEGIN {
    state = 1
    print "age,dose,died"
    for (i = 0; i < 200; ++i) {
      age = 40 + 40 * uniform(); dose = 2 * uniform()
      risk = 0.9 * (age - 60) / 11.55 + 0.5 * (dose - 1) / 0.577
      print age "," dose "," (uniform() < 1 / (1 + exp(-risk)))
    }
  }' >patients.csv
# [/table]
# [sample]
nysalt sample --system logistic_regression --parameter data=patients.csv,variance=4 --diagonal-masses --output draws.csv
# [/sample]

# Expected output:
# bcss3 on logistic_regression(rows=200, coefficients=3, variance=4, fingerprint=8a32a2bba8c2a656): exp(-V/kT), kT = 1, 4 chains of 1000 draws after 1000
# step 1.571, tuned to an acceptance of 0.9, trajectories of mean length 1.571, in the unit of time of the masses
# acceptance 0.994 +- 0.0002, (H' - H)/kT 1.82e-02 root mean square, 0 of 4000 trajectories diverged
# 4.7 evaluations a draw, 26449 for the burn-in of a chain
#
# scalar          mean  standard error  deviation  effective draws  per 1000 evaluations      R
# ---------  ---------  --------------  ---------  ---------------  --------------------  -----
# potential     115.05         2.7e-02      1.226             2101                   111  1.002
# q1         -0.083132         1.8e-03     0.1595             8033                   424  1.000
# q2            1.1341         2.4e-03     0.1824             5994                   316  1.000
# q3           0.32083         2.0e-03      0.163             6771                   358  1.000
# R is below 1.01 for all: the chains agree
# Written: draws.csv
