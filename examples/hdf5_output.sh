#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# An ensemble into a file that other programs read: HDF5, or NumPy's own format. The ending of the name says
# which; read_run.py reads both, and finds the same numbers.
set -eu
here=$(dirname "$0")

# [run]
run="nysalt run --system fpu --method verlet --step 0.01 --horizon 10 --trajectories 40 --observables energy,q1 --sample-every 10"
$run --output out.h5
$run --output out.npy
"${PYTHON:-python3}" "$here/read_run.py"
# [/run]

# Expected output:
# 40 trajectories of 1000 steps, 1001 force evaluations each, ~ s
# Written: out.h5
# 40 trajectories of 1000 steps, 1001 force evaluations each, ~ s
# Written: out.npy
# verlet, step 0.01, omega 50.0, seed 1
# mean energy 6.450 and q1 0.476 at t = 10.00
