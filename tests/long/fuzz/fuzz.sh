#!/usr/bin/env bash
# usage: fuzz.sh PROGRAM INPUTS CORPUS KEPT
# Feeds a target of libFuzzer with mutations of the files in CORPUS and KEPT. What it finds of interest is kept in
# KEPT: of all the least that reaches as much of the program. Prints one line of counts. The exit status is 1 where
# an input breaks a promise, and where the target was not really fuzzed: no corpus, too few inputs, nothing that
# libFuzzer can follow. An input that breaks a promise is KEPT.crash-...
set -euo pipefail
(($# == 4)) || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
program=$1 inputs=$2 corpus=$3 kept=$4
for path in "$program" "$corpus" "$kept"; do
  # A target may change the folder that it runs in.
  [[ $path == /* ]] || { printf 'fuzz.sh: a path must be absolute, got %s\n' "$path" >&2; exit 2; }
done
files=("$corpus"/*)
[[ -f ${files[0]} ]] || { printf 'fuzz.sh: there is no file in %s\n' "$corpus" >&2; exit 1; }
mkdir -p "$kept"
log=$kept.log
number_of() { sed -n "s/^stat::$1: *//p" "$log" | tail -n 1; }
larger() { printf '%s\n' "$1" "$2" | sort -n | tail -n 1; }
# In rounds, after each of which it can be gone on with as long as the program is the same: hours may be cut short.
round=${FUZZ_ROUND:-100000}
rounds=$kept.rounds  # the program, inputs so far, places reached, the slowest input, memory, seconds
identity=$(sha256sum "$program" | cut -d ' ' -f 1)
executed=0 followed=0 slowest=0 memory=0 seconds=0
if [[ -f $rounds ]]; then
  read -r of_program executed followed slowest memory seconds <"$rounds"
  [[ $of_program == "$identity" ]] || { executed=0 followed=0 slowest=0 memory=0 seconds=0; }
fi
while ((executed < inputs)); do
  began=$SECONDS
  asked=$((inputs - executed < round ? inputs - executed : round))
  # -entropic=0: the entropic power schedule costs more than most inputs, as the program has thousands of features.
  "$program" -runs="$asked" -entropic=0 -timeout=60 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1 \
    -artifact_prefix="$kept." "$kept" "$corpus" >"$log" 2>&1 ||
    { tail -n 40 "$log" >&2; exit 1; }
  new=$(number_of number_of_executed_units)
  reached=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  if ((${new:-0} < asked)) || ((${reached:-0} < 2)); then
    tail -n 5 "$log" >&2
    printf 'fuzz.sh: %s was not fuzzed: %s inputs of %s, %s places of the program reached\n' "${program##*/}" \
      "${new:-0}" "$asked" "${reached:-0}" >&2
    exit 1
  fi
  ((executed += new))
  followed=$(larger "$followed" "$reached")
  slowest=$(larger "$slowest" "$(number_of slowest_unit_time_sec)")
  memory=$(larger "$memory" "$(number_of peak_rss_mb)")
  ((seconds += SECONDS - began + 1))
  printf '%s\n' "$identity $executed $followed $slowest $memory $seconds" >"$rounds.new"
  mv "$rounds.new" "$rounds"
done
least=$kept.least
rm -rf "$least"
mkdir "$least"
"$program" -merge=1 -timeout=60 -rss_limit_mb=2048 -max_len=4096 "$least" "$kept" "$corpus" >"$log.merge" 2>&1 ||
  { tail -n 20 "$log.merge" >&2; exit 1; }
rm -rf "$kept" "$rounds"
mv "$least" "$kept"
printf '%s inputs in %d minutes, %s places of the program reached, %s kept, slowest %s s, %s MB at most\n' "$executed" \
  $((seconds / 60)) "$followed" "$(find "$kept" -type f | wc -l)" "$slowest" "$memory"
