#!/bin/sh
# The FPU chain in a bath, as in Li, Lu, Tao, Ye 2023: what is learned beside BAOAB, along paths and in law.
# usage: langevin_fpu.sh PROGRAM FOLDER
set -eu
nysalt=$1
folder=$2
mkdir -p "$folder"
system="--system fpu --friction 0.01 --sigma 0.05"
learning="--learn-trajectories 512 --learn-horizon 1"

echo "== Learn a scheme for the step 0.019, with half of the bath before it and half behind"
"$nysalt" learn $system --trajectories 512 --horizon 1 --step 0.019 --output "$folder/scheme.json"

echo
echo "== Errors along paths; all see the same noise"
"$nysalt" compare $system $learning --horizon 1 --trajectories 1000 \
  --steps 0.0025,0.005,0.01,0.019,0.033,0.036 \
  --methods learned:nystrom@symmetric,learned:nystrom@end,baoab,baoab_2x,mclachlan2,s_aia2 --output "$folder/path"

statistics() { # METRIC OPTION...
  "$nysalt" compare $system $learning --metric "$@" --horizon 40 --steps 0.019,0.033 \
    --methods baoab,baoab_2x,s_aia2,learned:nystrom@end,learned:nystrom@symmetric --output "$folder/$1"
}
echo
echo "== The law of the stiff energy; the floor is what sampling alone makes of an error"
statistics distribution --trajectories 4000 --range 0,1

echo
echo "== Its autocovariance"
statistics acf --trajectories 2000

echo
echo "In $folder/path, distribution and acf: table.md, rows.csv, and the pictures (.svg and .png)"
echo "error_against_evaluations, error_against_seconds, distribution_at_*, acf_at_*."
