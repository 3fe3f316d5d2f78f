# The tests of tier 1, of both tiers, or those named; sourced by dev. tests/CMakeLists.txt says what stands in which tier.

# test [PRESET] | test all [PRESET] | test NAME... | test --changed [REVISION] | test --record
run_tests() {
  case ${1-} in
    '' | release | clang | portable) test_tier 1 "$@" ;;
    all) test_tier 2 "${@:2}" ;;
    --changed)
      (($# <= 2)) || refuse "test --changed takes at most one revision"
      local folders
      folders=$(tests/checks/changed.py "${2:-HEAD}")
      [[ -n $folders ]] || { say "no file has changed that a test can reach"; return; }
      # shellcheck disable=SC2086
      test_named $folders
      ;;
    --record)
      (($# == 1)) || refuse "test --record takes nothing"
      configure
      NYSALT_RECORD=1 test_named programs/cases
      git status --short -- tests
      ;;
    -*) refuse "test takes PRESET, all, --changed, --record or names of tests, got '$1'" ;;
    *) test_named "$@" ;;
  esac
}

test_tier() {  # TIER [PRESET]
  local tier=$1 built status=0 report chosen=()
  choose_preset "${@:2}"
  ((tier == 1)) || packages+=("${docs_packages[@]}" dpkg-dev file pkg-config groff-base)
  configure -D NYSALT_TEST_PICTURES=OFF
  SECONDS=0
  if ((tier == 1)); then
    build tier1
    chosen=(-LE '^long$')
  else
    build all headers_alone
  fi
  built=$SECONDS
  report=$PWD/build/$preset/tests.xml
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" "${chosen[@]}" \
    --output-junit "$report" || status=$?
  say "built in $built s, tested in $((SECONDS - built)) s"
  if ((tier == 1)); then
    tests/checks/budget.py "build/$preset" "$report" --whole || status=1
    say "left out: $(names_of_tests -L '^long$' | wc -l) long tests, which ./dev test all runs too"
  else
    tests/checks/budget.py "build/$preset" "$report"
  fi
  return "$status"
}

names_of_tests() {  # OPTION-OF-CTEST...
  ctest --test-dir "build/$preset" -N "$@" | sed -n 's/^ *Test *#[0-9]*: //p'
}

# Builds and runs what is named: a test, a file or a folder; learning_search_test, learning/search, tests/learning.
test_named() {  # NAME...
  local name names=() found all targets needed=()
  configure
  all=$(names_of_tests)
  for name in "$@"; do
    name=${name#tests/}
    name=${name%/}
    name=${name%.*}
    name=${name//\//_}
    found=$(grep -E "^${name}(_|\$)" <<<"$all") || refuse "no test begins with '$name'; ctest --test-dir build/$preset -N has all"
    mapfile -t -O "${#names[@]}" names <<<"$found"
  done
  targets=$(cmake --build --preset "$preset" --target help | sed 's/:.*//')
  for name in "${names[@]}"; do
    grep -qx "$name" <<<"$targets" && needed+=("$name")
  done
  ((${#needed[@]} == ${#names[@]})) || needed+=(nysalt_program)  # of the tests without a target some run it
  ! grep -q '^\(long_\)\?\(python\|paper\)' <<<"${names[*]}" || needed+=(nysalt_python_neighbour)
  build "${needed[@]}"
  printf -v found '%s|' "${names[@]}"
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" -R "^(${found%|})\$"
}
