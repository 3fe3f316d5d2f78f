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

# with_script PAGE SCRIPT: the page with a script of ours at the end, which the policy of the page is made to allow.
with_script() {
  local hash
  hash=$({ echo; cat "$2"; } |
    python3 -c 'import base64, hashlib, sys; print(base64.b64encode(hashlib.sha256(sys.stdin.buffer.read()).digest()).decode())')
  sed "s|script-src '|script-src 'sha256-$hash' '|" "$1"
  echo '<script>'
  cat "$2"
  echo '</script>'
}

# The line that a script of ours leaves in <pre id="found">.
found() { sed -n 's|.*<pre id="found">\(.*\)</pre>.*|\1|p' "$1"; }
