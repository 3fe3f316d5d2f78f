#!/bin/sh
# Which family when: errors of learned families and of classical methods at equal cost, stiff and not stiff.
# usage: families.sh PROGRAM FOLDER
# What was finished in FOLDER before is not done again; remove it to begin anew.
set -eu
nysalt=$1
folder=$2
mkdir -p "$folder"

two_stage=learned:nystrom,verlet,mclachlan2,s_aia2
larger=learned:fg4,learned:fg_chin,learned:aba4,learned:aba3_free
six=learned:aba5,learned:aba6,learned:bab5,learned:bab6
fourth=pefrl,srkn6b,mclachlan_atela4,chin4a,omelyan_fg4,omelyan5v
# Their coefficients follow from the highest frequency, without data.
fitted=phase_fitted_mclachlan5,phase_fitted_chin4a,phase_fitted_omelyan_fg4,phase_fitted_pefrl,phase_fitted_srkn6b
all_learned=$larger,$six,learned:nystrom,learned:bab3,learned:bab4
all_learned=$all_learned,learned:aba4_free
all_classical=verlet,mclachlan2,bcss2,bcss3,bcss4,predescu3,forest_ruth,pefrl,vefrl,omelyan5v,omelyan5p
all_classical=$all_classical,mclachlan_atela4,mclachlan5,blanes_moan_s6,srkn6b,srkn11b,srkn14a,takahashi_imada,chin4a
all_classical=$all_classical,omelyan_fg4
equal_cost="--equal-cost --trajectories 96 --learn-loss state:1"  # the paper's

say() { echo "== $*"; }

compare() { # NAME OPTION...: into $folder/NAME; says only which fits could not be used
  name=$1
  shift
  "$nysalt" compare "$@" --resume --output "$folder/$name" >"$folder/$name.log" 2>&1 || cat "$folder/$name.log"
  sed -n 's/^\(.* at step .*: the fit is\)/   \1/p' "$folder/$name.log"
}

rows() { # TABLE...: method, step, size, evaluations, seconds, error, its own error
  for table in "$@"; do
    tail -n +3 "$folder/$table/rows.csv" | awk -F , -v OFS=, '{ print $2, $3, $4, $5, $6, $8, $9 }'
  done
}

draw() { # PICTURE YLABEL TABLE...: against evaluations and seconds; what is learned in colour and filled
  picture=$1 label=$2
  shift 2
  rows "$@" | awk -F , '
    function print_those(learned) {
      for (i = 1; i <= n; ++i) if ((name[i] ~ /learned/) == learned) print name[i] "\n" points[name[i]] "\n"
    }
    $6 == "" { next }
    !($1 in points) { name[++n] = $1 }
    { points[$1] = points[$1] $4 " " $5*1e9 " " $6 " " $7 "\n" }
    END { print_those(1); print_those(0) }' >"$folder/$picture.dat"
  cat >"$folder/$picture.gp" <<END
set terminal svg size 800,420 background 'white' font 'sans,13' noenhanced
set grid lw 0.5 lc '#cccccc'
set key outside right top
set logscale xy
set format y '%.0e'
set ylabel '$label'
learned = $(grep -c '^learned' "$folder/$picture.dat")
blocks = $(grep -c '^[a-z]' "$folder/$picture.dat")
filled = "7 5 9 13 15"
hollow = "6 4 8 12 10 14 2 1"
do for [cost = 1:2] {
  set output cost == 1 ? '$picture.svg' : '${picture}_seconds.svg'
  set xlabel cost == 1 ? 'force evaluations per unit time' : 'nanoseconds per unit time'
  plot for [k = 0:blocks-1] '$picture.dat' index k using cost:3:4 with yerrorlines title columnheader(1) \\
    lc rgb (k < learned ? '#D55E00' : '#444444') lw (k < learned ? 2 : 1) \\
    pt int(k < learned ? word(filled, k % 5 + 1) : word(hollow, (k - learned) % 8 + 1))
}
END
  (cd "$folder" && gnuplot "$picture.gp") || echo "   $picture is not drawn: that takes gnuplot"
}

first_crossing() { # LEVEL TABLE...: where the error comes to LEVEL, on a logarithmic line between two steps
  level=$1
  shift
  rows "$@" | sort -t , -k 1,1 -k 2,2g | awk -F , -v level="$level" '
    function end() { if (method != "" && !done) printf "| `%s` | > %s |\n", method, step }
    $1 != method { end(); method = $1; done = 0; step = "" }
    done { next }
    $6 != "" && $6 < level { step = $2; error = $6; next }
    { done = 1 }
    step == "" { printf "| `%s` | < %s |\n", method, $2; next }
    $6 == "" { printf "| `%s` | %s, and nothing usable at %s |\n", method, step, $2; next }
    { printf "| `%s` | %.5f |\n", method, step*exp(log($2/step)*log(level/error)/log($6/error)) }
    END { end() }'
}

# For each case the best of the classical methods, and how many times smaller the errors of others are.
gains() { # COLUMNS TABLE...
  columns=$1
  shift
  echo "| case | step | best classical | its error | $(echo "$columns" | sed 's/ / | /g') |"
  echo "|---|---|---|---|$(echo "$columns" | sed 's/[^ ]* */---|/g')"
  for table in "$@"; do
    rows "$table" | sed 's/^[^,]*\.\([a-z0-9_]*\)\.json/old:\1/' | sort -s -t , -k 2,2g |
      awk -F , -v table="${table##*/}" -v columns="$columns" '
        function end() {
          if (step == "") return
          line = sprintf("| %s | %s | `%s` | %.2e |", table, step, best, least)
          for (k = 1; k <= n; ++k) {
            gain = error[column[k]] == "" ? 0 : least/error[column[k]]
            line = line (gain > 0 ? sprintf(" %.2g |", gain) : " - |")
          }
          print line
        }
        BEGIN { n = split(columns, column, " ") }
        $2 != step { end(); step = $2; least = "" }
        { error[$1] = $6 }
        $1 !~ /^(learned|old):/ && $6 != "" {
          if (least == "" || $6 < least) { least = $6; best = $1 }
        }
        END { end() }'
  done
}

stiff() { # NAME METRIC HORIZON METHODS STEPS
  compare "$1" --system fpu $equal_cost --metric "$2" --horizon "$3" --methods "$4" --steps "$5"
}
learned_steps=0.0025,0.0051,0.0073,0.0087,0.0104,0.0124,0.0148,0.0177,0.0212,0.0254

say "The stiff chain, omega = 50: the state on [0, 10]"
stiff state_larger state 10 $larger,$six,$fitted $learned_steps
stiff state_fourth state 10 $fourth,mclachlan5 0.0018,0.0021,0.0025,0.003,0.0036,0.0043,0.0051,0.0061
stiff state_two_stage state 10 $two_stage 0.00025,0.0003,0.00036
draw stiff_state 'state error on [0, 10]' state_larger state_fourth state_two_stage

say "The energy of its stiff springs on [0, 100]"
stiff energy_larger relative 100 $larger,$six,$fitted $learned_steps
stiff exchange exchange 100 $larger,$six,$fitted 0.0051,0.0087,0.0124,0.0148,0.0163
stiff energy_fourth relative 100 $fourth,mclachlan5 0.0043,0.0051,0.0061,0.0073,0.0087
stiff energy_two_stage relative 100 $two_stage 0.0012,0.0014,0.0017
stiff energy_near_pi relative 100 learned:fg4,learned:aba4 0.0151,0.0154,0.0157,0.016,0.0164
stiff energy_near_pi_3 relative 100 learned:fg_chin,learned:aba3_free 0.0199,0.0204,0.0209,0.0214,0.0223
draw stiff_energy 'error of I on [0, 100]' energy_larger energy_fourth energy_two_stage

say "The same with exact rotations; soft evaluations are charged"
compare rotation --system fpu $equal_cost --metric relative --learn-horizon 2 --horizon 100 \
  --methods learned:r_aba4,learned:r_aba6,learned:r_fg4,impulse,learned:fg4 \
  --steps 0.0148,0.0177,0.0212,0.0254,0.03,0.035,0.041,0.048,0.055
resonances=0.0628318530718,0.125663706144,0.188495559215  # pi, 2 pi and 3 pi over omega
compare resonances --system fpu --metric relative --trajectories 96 --learn-horizon 2 --horizon 100 --steps $resonances \
  --methods impulse,learned:r_aba4,learned:r_aba6

say "A stiffer chain, omega = 200"
stiffer() { # NAME METHODS STEPS
  compare "$1" --system fpu --parameter omega=200 $equal_cost --metric relative --fine-step 1e-4 --horizon 100 --methods "$2" --steps "$3"
}
stiffer stiffer_larger learned:fg4,learned:fg_chin,phase_fitted_chin4a 0.0031,0.0036,0.0042,0.0048,0.0056,0.0064,0.0072,0.0082
stiffer stiffer_fourth pefrl,mclachlan_atela4,chin4a,mclachlan5 0.0012,0.0014,0.0016

say "Systems that are not stiff"
soft() { # SYSTEM LEARN_HORIZON HORIZON STEPS OPTION...; ten steps of six evaluations at least
  system=$1 learn_horizon=$2 horizon=$3 steps=$4
  shift 4
  compare "$system" --system "$system" $equal_cost --metric state --horizon "$horizon" --steps "$steps" \
    --learn-horizon "$learn_horizon" --methods "$all_learned,$all_classical$with_frequency" "$@"
}
with_frequency=,$fitted
soft henon_heiles 20 30 0.25,0.5
soft pendulum 40 60 0.5,1
soft phi4 8 10 0.1,0.15
with_frequency=
soft kepler 2 10 0.02,0.05
soft lennard_jones 1 10 0.01,0.02 --fine-step 0.001

say "The chain of wells over a range of costs"
compare phi4_range --system phi4 $equal_cost --metric state --horizon 10 --learn-horizon 8 \
  --methods $larger,learned:nystrom,verlet,pefrl,srkn6b,chin4a,mclachlan5 --steps 0.07,0.1,0.14,0.2
draw phi4 'state error on [0, 10]' phi4_range

say "Initial distributions other than those of the training data"
learn() { # SYSTEM LEARN_HORIZON FAMILY STEP
  "$nysalt" learn --system "$1" --horizon "$2" --family "$3" --step "$4" --loss state:1 \
    --output "$folder/$1.$3.json" >"$folder/$1.$3.log" 2>&1 || echo "   learned:$3 at step $4 of $1: not usable"
}
other_law() { # NAME SYSTEM LEARN_HORIZON STEP OPTION...
  name=$1 system=$2 learn_horizon=$3 step=$4 old=$folder/$2
  shift 4
  schemes=
  with_frequency=,$fitted
  [ "$system" != kepler ] || with_frequency=  # it declares none
  for family in fg4 fg_chin aba3_free; do
    [ ! -f "$old.$family.json" ] || schemes=$schemes$old.$family.json,
  done
  compare "$name" --system "$system" "$@" $equal_cost --metric state --horizon 10 --steps "$step" \
    --learn-horizon "$learn_horizon" --methods "${schemes}learned:fg4,verlet,mclachlan2,$fourth$with_frequency"
}
learn phi4 8 fg4 0.4
learn phi4 8 fg_chin 0.3
learn phi4 8 aba3_free 0.3
learn henon_heiles 20 fg4 1
learn henon_heiles 20 fg_chin 0.75
learn henon_heiles 20 aba3_free 0.75
learn kepler 2 fg4 0.08
learn kepler 2 fg_chin 0.06
learn kepler 2 aba3_free 0.06
for spread in 0.5 1.5 2; do other_law "phi4, spread $spread" phi4 8 0.1 --spread $spread; done
for spread in 0.5 1.5; do
  other_law "henon_heiles, spread $spread" henon_heiles 20 0.25 --spread $spread
done
for e in 0.4 0.75; do other_law "kepler, eccentricity $e" kepler 2 0.02 --parameter eccentricity=$e; done

say "Tables"
{
  echo "The largest step per evaluation before the error of the state on [0, 10] comes to 1 %:"
  printf '\n| method | step |\n|---|---|\n'
  first_crossing 0.01 state_larger state_fourth state_two_stage
  printf '\nThe state on [0, 10]:\n\n| method | step | error |\n|---|---|---|\n'
  rows state_larger | sort -t , -s -k 1,1 | awk -F , '{ printf "| `%s` | %s | %s |\n", $1, $2, $6 == "" ? "-" : sprintf("%.2e", $6) }'
  printf '\nExchange of the stiff energies on [0, 100]:\n\n| method | step | error |\n|---|---|---|\n'
  rows exchange | sort -t , -s -k 1,1 | awk -F , '{ printf "| `%s` | %s | %s |\n", $1, $2, $6 == "" ? "-" : sprintf("%.2e", $6) }'
  printf '\nThe same for I on [0, 100]; with rotations soft evaluations count:\n\n| method | step |\n|---|---|\n'
  first_crossing 0.01 energy_larger energy_fourth energy_two_stage
  first_crossing 0.01 rotation | grep 'r_\|impulse'
  printf '\nOmega = 200, I on [0, 100] to 0.3 %%:\n\n| method | step |\n|---|---|\n'
  first_crossing 0.003 stiffer_larger stiffer_fourth
  printf '\nI on [0, 100] near a step of pi/omega, where explicit families resonate:\n\n'
  printf '| method | step | omega times the whole step | error |\n|---|---|---|---|\n'
  rows energy_near_pi energy_near_pi_3 | sort -t , -s -k 1,1 |
    awk -F , '{ printf "| `%s` | %s | %.2f | %s |\n", $1, $2, 50*$3, $6 == "" ? "-" : sprintf("%.1e", $6) }'
  printf '\nErrors of I on [0, 100] where the step times omega is pi, 2 pi, 3 pi:\n\n| method | step | error |\n|---|---|---|\n'
  rows resonances | awk -F , '{ printf "| `%s` | %.4f | %.1e |\n", $1, $2, $6 }'
} >"$folder/thresholds.md"

python3 "$(dirname "$0")/families_tables.py" "$folder" henon_heiles pendulum kepler lennard_jones phi4 >"$folder/gains.md"
gains "old:fg4 old:fg_chin old:aba3_free learned:fg4" "phi4, spread 0.5" "phi4, spread 1.5" "phi4, spread 2" \
  "henon_heiles, spread 0.5" "henon_heiles, spread 1.5" "kepler, eccentricity 0.4" "kepler, eccentricity 0.75" \
  >"$folder/other_laws.md"
cat "$folder/thresholds.md" "$folder/gains.md" "$folder/other_laws.md"
