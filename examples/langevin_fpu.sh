#!/bin/sh
# The FPU chain in a bath, as in Li, Lu, Tao, Ye 2023: what is learned beside BAOAB, along paths and in distribution.
# usage: langevin_fpu.sh PROGRAM FOLDER
set -eu
nysalt=$1
folder=$2
mkdir -p "$folder"
system="--system fpu --friction 0.01 --sigma 0.05"
learning="--learn-trajectories 512 --learn-horizon 1"

echo "== Learn a scheme for the step 0.019, with half of the bath before it and half behind"
"$nysalt" learn $system --family nystrom --trajectories 512 --horizon 1 --step 0.019 --output "$folder/scheme.json"

echo
echo "== Errors along paths; all see the same noise"
rm -f "$folder"/*/report.work  # of a run that was stopped
"$nysalt" compare $system $learning --horizon 1 --trajectories 1000 \
  --steps 0.0025,0.005,0.01,0.019,0.033,0.036 \
  --methods learned:nystrom@symmetric,learned:nystrom@end,baoab,baoab_2x,mclachlan2,s_aia2 --output "$folder/path"

echo
echo "== The distribution of the stiff energy, and its autocovariance; the floor is the error that is due to sampling"
"$nysalt" compare $system $learning --metric distribution,acf --horizon 40 --steps 0.019,0.033 \
  --methods baoab,baoab_2x,s_aia2,learned:nystrom@end,learned:nystrom@symmetric \
  --trajectories 4000 --range 0,1 --output "$folder/law"

echo
echo "In $folder/path and $folder/law: report.html, rows.csv"
