# SPDX-License-Identifier: BSL-1.0
# Headless Chromium, for the checks beside: they set page, and have what they need in the folder scratch.
fail() { printf '%s: %s: %s\n' "$(basename "$0" .sh)" "$page" "$*" >&2; exit 1; }

command -v chromium >/dev/null || fail 'chromium is not installed: ./dev pictures installs it'
[[ -s $page ]] || fail 'there is no such page'
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/page"

browser() {  # OPTION... PAGE
  local sandbox=()
  ((EUID != 0)) || sandbox=(--no-sandbox)  # Chromium refuses to run as root with it
  timeout 120 chromium --headless --disable-gpu --hide-scrollbars --user-data-dir="$scratch/profile" \
    "${sandbox[@]}" --virtual-time-budget=10000 "${@:1:$#-1}" "file://${!#}" 2>"$scratch/log" ||
    { tail -n 3 "$scratch/log" >&2; fail 'chromium could not show it'; }
}

# The line that a script of ours leaves in <pre id="found">.
found() { sed -n 's|.*<pre id="found">\(.*\)</pre>.*|\1|p' "$1"; }
