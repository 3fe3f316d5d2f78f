#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A long run that is killed, and goes on: to the same bytes as one that never was, noise included.
set -eu
rm -f uncut.csv cut.csv cut.csv.part cut.csv.work  # of an earlier time

run="nysalt run --system fpu --friction 0.01 --sigma 0.05 --method baoab --step 0.01 --horizon 4000 --trajectories 8"
run="$run --sample-every 4000"
$run --output uncut.csv

# [stopped]
$run --output cut.csv --every 10000 >/dev/null &
while ! grep -aqs '"state"' cut.csv.work; do sleep 0.01; done
kill -KILL $!
# [/stopped]
wait $! 2>/dev/null || true

# A work file is of one question: with another seed it is refused, in one line and with the exit code 2.
$run --seed 2 --output cut.csv --every 10000 --resume 2>&1 || echo "exit code $?"
# [resume]
$run --output cut.csv --every 10000 --resume
# [/resume]
cmp uncut.csv cut.csv && echo "The same bytes: $(wc -l <cut.csv) lines"

# Expected output:
# 8 trajectories of 400000 steps, 400001 force evaluations each, ~ s
# Written: uncut.csv
# nysalt: cannot resume from cut.csv.work: the file is of another question (seed); ask the same, or remove the file to begin anew
# exit code 2
# 8 trajectories of 400000 steps, 400001 force evaluations each, ~ s
# Written: cut.csv
# The same bytes: 810 lines
