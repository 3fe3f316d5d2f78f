# The checks of `./dev check`, each in a build of its own, as sanitizers do not mix. Sourced by dev.
# Each check leaves its outcome in build/check/outcomes; build/check/table.md is all of them, with what was not run.

check() {
  local what=${1:-all} argument=${2-} target=${3-}
  (($# <= 2)) || [[ $# == 3 && $what == fuzz ]] ||
    refuse "check takes a name and at most one argument, fuzz two, got $# arguments"
  packages+=(clang)
  case $what in
    gcc | clang | address | threads)
      local piece=${argument:-1/1}
      [[ $piece =~ ^([1-9][0-9]{0,2})/([1-9][0-9]{0,2})$ ]] && ((BASH_REMATCH[1] <= BASH_REMATCH[2])) ||
        refuse "check $what takes a piece such as 3/8, got '$piece'"
      recorded "$what" "$piece" check_tests "$what" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
      ;;
    fuzz)
      local runs=${argument:-20000}
      [[ $runs =~ ^[1-9][0-9]{0,8}$ ]] || refuse "check fuzz takes a number of inputs, got '$runs'"
      [[ -z $target || -d tests/long/fuzz/corpus/$target ]] ||
        refuse "check fuzz takes a target, one of $(cd tests/long/fuzz/corpus && echo *), got '$target'"
      build_fuzz_targets
      for target in tests/long/fuzz/corpus/${target:-*}; do
        recorded fuzz "${target##*/}" check_fuzz_target "${target##*/}" "$runs"
      done
      ;;
    seeds)
      local seeds=${argument:-200}
      [[ $seeds =~ ^[1-9][0-9]{0,5}$ ]] || refuse "check seeds takes a number of seeds, got '$seeds'"
      recorded seeds "$seeds" check_seeds "$seeds"
      ;;
    coverage)
      [[ -z $argument || $argument =~ ^(failed|tier1)$ ]] ||
        refuse "check coverage takes nothing, 'tier1' or 'failed', got '$argument'"
      local tiers=all
      [[ $argument != tier1 ]] || tiers=tier1
      recorded coverage "$tiers" check_coverage "$argument"
      ;;
    mutants)
      [[ -z $argument || $argument =~ ^[0-9,-]+$ ]] || refuse "check mutants takes numbers such as 3,7-12, got '$argument'"
      recorded mutants "${argument:-all}" check_mutants "$argument"
      ;;
    tidy | faults)
      [[ -z $argument ]] || refuse "check $what takes no argument, got '$argument'"
      recorded "$what" 1/1 "check_$what"
      ;;
    all)
      [[ -z $argument ]] || refuse "check all takes no argument, got '$argument'"
      local one
      for one in gcc clang tidy threads address fuzz faults coverage seeds mutants; do check "$one"; done
      ;;
    table) tests/checks/outcomes.py table build/check ;;
    *) refuse "unknown check '$what': it is gcc, clang, address, threads, tidy, fuzz, faults, coverage, seeds, mutants, table or all" ;;
  esac
}

# recorded WHAT PIECE COMMAND...: runs the command and records exit status, seconds and the counts it wrote, with the
# commit of before, as hours later the sources may be those of another.
recorded() {
  local what=$1 piece=$2 began=$SECONDS status=0 commit
  commit=$(tests/checks/outcomes.py commit)
  counts=$PWD/build/check/outcomes/counts.$$
  mkdir -p build/check/outcomes
  : >"$counts"
  set +e
  (set -e; "${@:3}")
  status=$?
  set -e
  tests/checks/outcomes.py add build/check "$what" "$piece" "$commit" "$status" $((SECONDS - began)) "$(cat "$counts")"
  rm -f "$counts"
  ((status == 0)) || exit "$status"
}

# check_tests PRESET K N: the K-th of N equal slices of the preset's tests, and only what these need is built.
check_tests() {
  preset=$1
  [[ $preset != gcc ]] || preset=release
  local k=$2 n=$3 name
  configure -D NYSALT_TEST_PICTURES=OFF
  local -A targets=()
  while IFS=: read -r name _; do targets[$name]=1; done < <(cmake --build --preset "$preset" --target help)
  local names=() needed=(nysalt_program)
  mapfile -t names < <(ctest --preset "$preset" -N | sed -n 's/^ *Test *#[0-9]*: //p')
  local first=$(((k - 1) * ${#names[@]} / n)) last=$((k * ${#names[@]} / n - 1)) piece
  ((first <= last)) || refuse "there are ${#names[@]} tests of $preset: they cannot be cut into $n pieces"
  printf -v piece '%s|' "${names[@]:first:last - first + 1}"
  for name in "${names[@]:first:last - first + 1}"; do
    if [[ -v targets[$name] ]]; then
      needed+=("$name")
    elif [[ $preset == release || $preset == clang ]]; then
      needed=(all headers_alone)  # of the tests without a target some take what is installed
      break
    fi
  done
  ((n > 1)) || [[ $preset == threads ]] || needed=(all)
  build "${needed[@]}"
  local report=$PWD/build/check/outcomes/tests.$$.xml status=0 jobs=2 others=()
  [[ $preset != threads ]] || jobs=1
  [[ $preset == release || $preset == clang ]] || others=(-LE '^docs$')  # which run nothing that is built
  ctest --preset "$preset" -j "$jobs" "${others[@]}" -R "^(${piece%|})\$" --output-junit "$report" || status=$?
  tests/checks/outcomes.py count "$report" >"$counts"
  rm -f "$report"
  return "$status"
}

check_tidy() {
  packages+=(clang-tidy)
  preset=tidy
  configure
  say "reading src/ and all headers"
  local folder=$PWD/build/check/tidy log=build/check/tidy.log status=0 sources
  sources=$(tests/checks/tidy_units.py "$folder/compile_commands.json" "$folder/units" \
    "$PWD/src" "$folder/every_header.cpp")
  run-clang-tidy -quiet -p "$folder/units" -j "$(nproc)" 2>/dev/null | sed 's/\x1b\[[0-9;]*m//g' >"$log" || status=$?
  grep -E '(warning|error): ' "$log" | sort -u || true
  printf '%d sources and all headers, %d findings' "$((sources - 1))" \
    "$(grep -E '(warning|error): ' "$log" | sort -u | wc -l)" >"$counts"
  return "$status"
}

build_fuzz_targets() {
  preset=address
  configure
  build fuzz_targets
}

# check_fuzz_target TARGET INPUTS: what libFuzzer finds of interest is kept, the least that reaches as much.
check_fuzz_target() {
  say "$1, $2 inputs"
  mkdir -p build/check/fuzz/corpus
  tests/long/fuzz/fuzz.sh "$PWD/build/check/address/tests/long/fuzz/fuzz_$1" "$2" "$PWD/tests/long/fuzz/corpus/$1" \
    "$PWD/build/check/fuzz/corpus/$1" | tee "$counts"
}

check_faults() {
  preset=release
  configure
  build nysalt_program nysalt_faults
  tests/faults/faults.py build/release/nysalt build/release/tests/libnysalt_faults.so build/check/faults | tee build/check/faults.log
  tail -n 1 build/check/faults.log >"$counts"
}

# check_seeds N: stochastic tests at N seeds each, and how often they fail.
check_seeds() {
  preset=release
  configure -D NYSALT_TEST_PICTURES=OFF
  local needed=()
  mapfile -t needed < <(ctest --preset "$preset" -N -L '^stochastic$' | sed -n 's/^ *Test *#[0-9]*: //p')
  build "${needed[@]}"
  say "${#needed[@]} tests, each at $1 seeds"
  tests/checks/seeds.py "build/$preset" "$1" "$counts"
}

# check_mutants [NUMBERS]: whether the tests of tier 1 find the mutants, or those of the numbers, such as 3,7-12.
check_mutants() {
  preset=release
  setup "${packages[@]}"
  tests/mutants/run.py ${1:+--only "$1"} | tee build/check/mutants.log
  tail -n 1 build/check/mutants.log >"$counts"
}

# check_coverage [tier1 | failed]: of tier 1 alone, or the tests that failed in the last run, whose counts are kept.
check_coverage() {
  packages+=(llvm)
  preset=coverage
  configure
  local folder=$PWD/build/check/coverage chosen=() tests=() status=0 objects=() program
  local report=$folder/tests.xml before=$folder/before.txt
  if [[ $1 == tier1 ]]; then
    build tier1
    chosen=(-LE '^long$')
  else
    build all
  fi
  if [[ $1 == failed ]]; then
    [[ -s $before ]] || refuse "check coverage failed needs a whole run before; run ./dev check coverage"
    chosen=(--rerun-failed)
  else
    rm -rf "$folder/profiles" "$before"
  fi
  ctest --preset coverage -j2 "${chosen[@]}" --output-junit "$report" || status=$?
  mapfile -t tests < <(cat "$before" 2>/dev/null || true)
  tests+=("$(tests/checks/outcomes.py count "$report") at $(tests/checks/outcomes.py commit)")
  printf '%s\n' "${tests[@]}" >"$before"
  for program in "$folder"/tests/*_tests; do objects+=(-object "$program"); done
  llvm-profdata merge -sparse -o "$folder/all.profdata" "$folder"/profiles/*.profraw
  llvm-cov export -format=lcov -instr-profile="$folder/all.profdata" "$folder/nysalt" "${objects[@]}" \
    "$PWD/include" "$PWD/src" >"$folder/all.lcov"
  awk -v root="$PWD/" -v target=90 -f tests/checks/coverage.awk "$folder/all.lcov" | tee build/check/coverage.log || status=1
  {
    awk '/whole$|together$/ { printf "%s%s %% of %s lines of %s", comma, $3, $1, $4; comma = ", " }' \
      build/check/coverage.log
    printf '; %s' "${tests[0]}"
    ((${#tests[@]} == 1)) || printf '; what failed again: %s' "${tests[@]:1}"
  } >"$counts"
  return "$status"
}
