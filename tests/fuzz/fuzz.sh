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
# -entropic=0: the entropic power schedule costs more than most inputs, as the program has thousands of features.
"$program" -runs="$inputs" -entropic=0 -timeout=60 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1 \
  -artifact_prefix="$kept." "$kept" "$corpus" >"$log" 2>&1 ||
  { tail -n 40 "$log" >&2; exit 1; }
number_of() { sed -n "s/^stat::$1: *//p" "$log" | tail -n 1; }
followed=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
executed=$(number_of number_of_executed_units)
if ((${executed:-0} < inputs)) || ((${followed:-0} < 2)); then
  tail -n 5 "$log" >&2
  printf 'fuzz.sh: %s was not fuzzed: %s inputs of %s, %s places of the program reached\n' "${program##*/}" \
    "${executed:-0}" "$inputs" "${followed:-0}" >&2
  exit 1
fi
least=$kept.least
rm -rf "$least"
mkdir "$least"
"$program" -merge=1 -timeout=60 -rss_limit_mb=2048 -max_len=4096 "$least" "$kept" "$corpus" >"$log.merge" 2>&1 ||
  { tail -n 20 "$log.merge" >&2; exit 1; }
rm -rf "$kept"
mv "$least" "$kept"
printf '%s inputs, %s places of the program reached, %s kept, slowest %s s, %s MB at most\n' "$executed" "$followed" \
  "$(find "$kept" -type f | wc -l)" "$(number_of slowest_unit_time_sec)" "$(number_of peak_rss_mb)"
