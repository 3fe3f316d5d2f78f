#!/usr/bin/env bash
# Whether the controls of a page work in headless Chromium: tables are sorted and filtered.
# usage: check_controls.sh PAGE.html; exit code 0 if all is well, else 1 and a sentence.
set -euo pipefail

page=$1
pictures=$(dirname "${BASH_SOURCE[0]}")
source "$pictures/browser.sh"

with_script "$page" "$pictures/controls.js" >"$scratch/page/report.html"
browser --window-size=1200,1000 --dump-dom "$scratch/page/report.html" >"$scratch/dom"
said=$(found "$scratch/dom")
[[ -n $said ]] || fail 'its controls could not be tried'
[[ $said != wrong* ]] || fail "$said"
printf '%s: %s\n' "$page" "$said"
