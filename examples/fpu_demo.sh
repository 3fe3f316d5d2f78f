#!/bin/sh
# The demonstration: learn an integrator for the FPU chain, and show its speed against its error.
# usage: fpu_demo.sh PROGRAM FOLDER
set -eu
nysalt=$1
folder=$2
mkdir -p "$folder"

echo "== Learn a scheme for the step 0.02"
"$nysalt" learn --system fpu --family nystrom --step 0.02 --loss state:1 --output "$folder/scheme.json"  # for energies

rm -f "$folder/report.work"  # of a demonstration that was stopped
echo
echo "== Compare with classical methods at equal cost; steps are per force evaluation"
"$nysalt" compare --system fpu --equal-cost --steps 0.00125,0.0025,0.005,0.0075,0.01,0.015,0.02 \
  --methods learned:nystrom,learned:bab6,learned:fg4,verlet,mclachlan2,s_aia2,bcss3,pefrl,blanes_moan_s6,srkn6b,phase_fitted_mclachlan5,phase_fitted_chin4a \
  --output "$folder"

echo
echo "== Follow the energies of the stiff springs over a long time: accurate, Verlet, learned"
energies=stiff_energy,stiff_energy_1,stiff_energy_2,stiff_energy_3
follow() { # NAME METHOD STEP SAMPLE_EVERY
  "$nysalt" run --system fpu --method "$2" --step "$3" --horizon 500 --observables $energies \
    --sample-every "$4" --output "$folder/$1.csv" --plot
}
follow accurate srkn11b 0.01 20
follow verlet verlet 0.02 10
follow learned "$folder/scheme.json" 0.02 10

echo
echo "The report: $folder/report.html, rows.csv; pictures of the energies, accurate, verlet and learned, in $folder."
