#!/usr/bin/env bash
# Which public names of include/ lack a comment, by file: undocumented.sh [ROOT].
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "${1:-$PWD}" && pwd)
staged=$(mktemp -d)
trap 'rm -rf "$staged"' EXIT
concepts=$(/usr/bin/python3 "$here/stage.py" "$root" "$staged" --headers 2>&1)
{ cat "$here/Doxyfile"
  printf '%s\n' "INPUT = $staged" 'FILTER_PATTERNS =' "STRIP_FROM_PATH = $staged" "OUTPUT_DIRECTORY = $staged/site" 'GENERATE_HTML = NO' \
    'HAVE_DOT = NO' 'WARN_AS_ERROR = NO'
} | doxygen - 2>&1 >/dev/null | { grep '^[^ ]*: warning: ' || true; } | sed "s|^$staged/||" |
  cat - <(printf '%s' "${concepts:+$concepts$'\n'}") | sort -t: -k1,1 -k2,2n
