#!/bin/sh
# Beyond the paper: all families against all classical methods at equal cost, by several metrics.
# usage: beyond.sh PROGRAM FOLDER
# What was finished in FOLDER before is not done again; remove it to begin anew.
set -eu
nysalt=$1
folder=$2
mkdir -p "$folder"

explicit=learned:nystrom,learned:aba4,learned:aba5,learned:aba6,learned:bab4,learned:bab6,learned:aba3_free
explicit=$explicit,learned:aba4_free,learned:aba6_free,learned:bab6_free,learned:fg_chin,learned:fg4,learned:bab3,learned:bab5
processed=learned:fg4+p3,learned:fg4+p5,learned:fg_chin+p3,takahashi_imada_processed,fg4_processed
rotating=learned:r_aba2,learned:r_aba4,learned:r_aba6,learned:r_fg4
classical=verlet,verlet_aba,mclachlan2,bcss2,bcss3,forest_ruth,pefrl,mclachlan_atela4,mclachlan5,blanes_moan_s6
classical=$classical,srkn6b,srkn11b,srkn14a,takahashi_imada,chin4a
classical=$classical,bcss4,predescu3,vefrl,omelyan5v,omelyan5p,omelyan_fg4
# Their coefficients follow from the highest frequency, which not all systems declare.
fitted=s_aia2,phase_fitted_chin4a,phase_fitted_omelyan_fg4,phase_fitted_pefrl,phase_fitted_vefrl
fitted=$fitted,phase_fitted_mclachlan5,phase_fitted_omelyan5v,phase_fitted_srkn6b
page=$folder/beyond.md
chapters=$folder/chapters.md
summary=$folder/summary.md
: >"$chapters"
: >"$summary"

say() { printf '\n%s\n' "$*" >>"$chapters"; }

# From the first such heading of a report to the next of any kind, without them.
section() { # REPORT HEADING
  awk -v wanted="$2" '
    inside && /^##/ { exit }
    inside { print }
    index($0, wanted) == 1 { inside = 1 }' "$1"
}

# What an error costs after a fit to one step, as the paper has it: the cheapest of the families without rotations.
one_step_cost=
one_step() { # NAME LEVEL OPTION...
  name=$1 level=$2
  shift 2
  echo "== $name, learned from one step"
  "$nysalt" compare --equal-cost --levels "$level" "$@" --methods "$explicit" --metric state --learn-loss state:1 --resume \
    --output "$folder/$name" >"$folder/$name.log" 2>&1 || {
    cat "$folder/$name.log"
    exit 1
  }
  "$(dirname "$0")/report_parts.py" "$folder/$name"
  one_step_cost=$(section "$folder/$name/report.md" "### The cost of an error of $level" | awk -F ' *[|] *' '
    $2 !~ /^learned/ || $3 ~ /above/ { next }
    { print "`" $2 "`, " $3; exit }')
}

compare() { # NAME TITLE METRIC LEVEL OPTION...: a chapter of the page; METRIC is the one that is shown
  name=$1 title=$2 metric=$3 level=$4
  shift 4
  echo "== $title"
  "$nysalt" compare --equal-cost --levels "$level" "$@" --resume --output "$folder/$name" >"$folder/$name.log" 2>&1 || {
    cat "$folder/$name.log"
    exit 1
  }
  "$(dirname "$0")/report_parts.py" "$folder/$name"
  report=$folder/$name/report.md
  say "## $title"
  say '```sh'
  section "$report" "# " | sed -n '/^```/,/^```/p' | sed -e '/^```/d' -e 's/ --resume//' -e 's/ --output .*//' \
    -e 's/^[^ ]*nysalt/nysalt/' >>"$chapters"
  echo '```' >>"$chapters"
  say "![$title: against evaluations](beyond/$name/${metric}_against_evaluations.svg)"
  say "![$title: against seconds](beyond/$name/${metric}_against_seconds.svg)"
  say "What an error of $level costs ([every row](beyond/$name/rows.csv), by every metric):"
  section "$report" "### The cost of an error of $level" >>"$chapters"
  section "$report" "### The cost of an error of $level" | awk -F ' *[|] *' -v case="$title" -v level="$level" -v one_step="$one_step_cost" '
    $2 !~ /^[a-z]/ || $2 == "method" || $3 ~ /above/ { next }
    $2 ~ /^learned.*\+p/ || $2 ~ /_processed$/ {
      if (processed == "") processed = "`" $2 "`, " $3
      next
    }
    $2 ~ /^learned/ && learned == "" { learned = "`" $2 "`, " $3 }
    $2 !~ /^learned/ && classical == "" { classical = "`" $2 "`, " $3 }
    $2 !~ /^(learned|impulse)/ && plain == "" { plain = "`" $2 "`, " $3 }
    $2 ~ /^learned/ && $2 !~ /:r_/ && learned_plain == "" { learned_plain = "`" $2 "`, " $3 }
    function or_none(x) { return x == "" ? "none" : x }
    END {
      printf "| %s | %s | %s | %s | %s | %s | %s | %s |\n", case, level, or_none(learned), or_none(learned_plain),
        or_none(one_step), or_none(processed), or_none(classical), or_none(plain)
    }' >>"$summary"
  one_step_cost=
  say "Best at its cost:"
  section "$report" "### Best at its cost" | sed '/^!/,$d' >>"$chapters"  # pictures of steps are in the report
}

one_step fpu_50_state_one_step 0.01 --system fpu --parameter omega=50 \
  --trajectories 48 --steps 0.001,0.002,0.004,0.0056,0.008,0.0112,0.016,0.0225,0.032 --horizon 10
compare fpu_50_state "FPU chain, omega = 50, on [0, 10]: the state" state 0.01 --system fpu --parameter omega=50 \
  --trajectories 48 --steps 0.001,0.002,0.004,0.0056,0.008,0.0112,0.016,0.0225,0.032 \
  --methods $explicit,$processed,$rotating,$classical,$fitted,impulse --horizon 10 \
  --metric state,path,exchange,energy
compare fpu_50_stiff "FPU chain, omega = 50, on [0, 100]: the stiff energy, of fewer methods" path_stiff_energy 0.003 \
  --system fpu --parameter omega=50 --trajectories 48 --steps 0.002,0.004,0.0056,0.008,0.0112,0.016,0.0225,0.032 \
  --methods learned:nystrom,learned:aba4,learned:aba3_free,learned:fg_chin,learned:fg4,learned:r_aba4,verlet,pefrl,mclachlan5,srkn6b,chin4a,omelyan_fg4,phase_fitted_chin4a,phase_fitted_mclachlan5,impulse \
  --horizon 100 --metric path,exchange
one_step fpu_200_state_one_step 0.01 --system fpu --parameter omega=200 \
  --trajectories 48 --steps 0.00025,0.0005,0.001,0.0014,0.002,0.0028,0.004,0.0056,0.008 --horizon 10
compare fpu_200_state "FPU chain, omega = 200, on [0, 10]: the state" state 0.01 --system fpu --parameter omega=200 \
  --trajectories 48 --steps 0.00025,0.0005,0.001,0.0014,0.002,0.0028,0.004,0.0056,0.008 \
  --methods $explicit,$processed,$rotating,$classical,$fitted,impulse --horizon 10 \
  --metric state,path,exchange,energy

one_step henon_heiles_one_step 0.0001 --system henon_heiles \
  --trajectories 48 --horizon 30 --steps 0.05,0.07,0.1,0.14,0.2,0.28,0.4
compare henon_heiles "Henon and Heiles' system on [0, 30]: the state" state 0.0001 --system henon_heiles \
  --trajectories 48 --horizon 30 --metric state,energy \
  --steps 0.05,0.07,0.1,0.14,0.2,0.28,0.4 --methods "$explicit,$processed,$rotating,$classical,$fitted,impulse"
one_step phi4_one_step 0.01 --system phi4 --parameter masses=8 \
  --trajectories 48 --horizon 10 --steps 0.035,0.05,0.07,0.1,0.14,0.2
compare phi4 "The phi^4 chain of 8 wells on [0, 10]: the state" state 0.01 --system phi4 --parameter masses=8 \
  --trajectories 48 --horizon 10 --metric state,energy \
  --steps 0.035,0.05,0.07,0.1,0.14,0.2 --methods "$explicit,$processed,$rotating,$classical,$fitted,impulse"
one_step kepler_one_step 0.0001 --system kepler \
  --trajectories 48 --horizon 20 --steps 0.0035,0.005,0.007,0.01,0.014,0.02,0.028,0.04
compare kepler "Kepler's problem, eccentricity 0.6, on [0, 20]: the state" state 0.0001 --system kepler \
  --trajectories 48 --horizon 20 --metric state,energy \
  --steps 0.0035,0.005,0.007,0.01,0.014,0.02,0.028,0.04 --methods "$explicit,$processed,$classical"

bath="--system fpu --friction 0.01 --sigma 0.05 --steps 0.0035,0.005,0.007,0.01,0.014,0.02"
in_bath="$explicit,$rotating,$classical,$fitted,impulse,baoab,aboba,obabo"
compare langevin_paths "The FPU chain in the paper's bath, on [0, 5]: paths of the stiff energy" path_stiff_energy 0.1 \
  $bath --trajectories 96 --horizon 5 --metric path,state --methods "$in_bath"
compare langevin_laws "The FPU chain in the paper's bath, on [0, 40]: the distribution of the stiff energy" \
  distribution_stiff_energy 0.1 $bath --trajectories 500 --range 0,1 --horizon 40 --metric distribution,acf \
  --methods "$in_bath"

{
  echo "# Beyond the paper"
  echo
  echo "All families against all classical methods at equal cost: $("$nysalt" --version), $(date -u +%F), on $(
    sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | sort -u | head -n 1), $(nproc) cores. Made again by"
  echo "\`./dev beyond\`. Steps are per force evaluation (soft ones where a method rotates the quadratic part); what is"
  echo "learned is learned at each step on 100 trajectories that are none of the test's. Of processed methods the costs are those"
  echo "of one observation of each trajectory. \`marks\` and the rest are"
  echo "explained in [the program](../program.md)."
  echo
  echo "The cheapest at an error, in force evaluations per unit time (without rotations those that need no quadratic part):"
  echo
  echo "| case | error | learned | learned, without rotations | the same from one step | processed | classical | classical, without rotations |"
  echo "|---|---|---|---|---|---|---|---|"
  cat "$summary" "$chapters"
} >"$page"

echo "Written: $page"
