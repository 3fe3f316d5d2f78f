#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# A long run that is killed, and goes on: to the same bytes as one that never was, noise included.
set -eu
rm -f uncut.csv cut.csv cut.csv.part cut.checkpoint  # of an earlier time

run="nysalt run --system fpu --friction 0.01 --sigma 0.05 --method baoab --step 0.01 --horizon 4000 --trajectories 8"
run="$run --sample-every 4000"
$run --output uncut.csv

# [checkpoint]
$run --output cut.csv --checkpoint cut.checkpoint --every 10000 >/dev/null &
while [ ! -e cut.checkpoint ]; do sleep 0.01; done
kill -KILL $!
# [/checkpoint]
wait $! 2>/dev/null || true
# [resume]
$run --output cut.csv --checkpoint cut.checkpoint --every 10000 --resume
# [/resume]
cmp uncut.csv cut.csv && echo "The same bytes: $(wc -l <cut.csv) lines"

# A checkpoint is of one run: with another seed it is refused, in one line and with the exit code 2.
rm cut.csv
$run --seed 2 --output cut.csv --checkpoint cut.checkpoint --every 10000 --resume 2>&1 || echo "exit code $?"

# Expected output:
# 8 trajectories of 400000 steps, 400001 force evaluations each, ~ s
# Written: uncut.csv
# 8 trajectories of 400000 steps, 400001 force evaluations each, ~ s
# Written: cut.csv
# The same bytes: 810 lines
# nysalt: cut.checkpoint must be a checkpoint of this run, got that of another run (seed); ask for the same, or name another --checkpoint
# exit code 2
