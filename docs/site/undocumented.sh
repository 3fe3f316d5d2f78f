#!/usr/bin/env bash
# Which public names of include/ lack a comment, by file: undocumented.sh [ROOT].
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "${1:-$PWD}" && pwd)
staged=$(mktemp -d)
trap 'rm -rf "$staged"' EXIT
python3 -B "$here/stage.py" "$root" "$staged" --headers 2>"$staged/concepts"
{ cat "$here/comments.doxyfile"
  printf '%s\n' "INPUT = $staged/include $staged/pages" "STRIP_FROM_PATH = $staged" "OUTPUT_DIRECTORY = $staged" \
    'GENERATE_HTML = NO' "WARN_LOGFILE = $staged/warnings"
} | doxygen - 2> >(grep -v 'No output formats selected' >&2)
sed "s|^$staged/||" "$staged/concepts" "$staged/warnings" | { grep -v 'No output formats selected' || true; } |
  sort -t: -k1,1 -k2,2n
