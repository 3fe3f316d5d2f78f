#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The posterior of a logistic regression on a table of one's own: 200 patients whose risk grows with age and
# dose, drawn by a small generator of random numbers. The chains agree, and the intervals hold what the table
# was made with (per deviation: 0.9 for age, 0.5 for dose).
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
nysalt sample --system logistic_regression --data patients.csv --variance 4 --diagonal-masses --output draws.csv
# [/sample]
