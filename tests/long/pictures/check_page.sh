#!/usr/bin/env bash
# Whether a report shows its pictures: headless Chromium lays the page out, alone in a folder, and draws it.
# usage: check_page.sh PAGE.html; exit code 0 if all is well, else 1 and a sentence.
set -euo pipefail

page=$1
pictures=$(dirname "${BASH_SOURCE[0]}")
source "$pictures/browser.sh"

bytes=$(stat -c %s "$page")
((bytes < 2000000)) || fail "it has $bytes bytes, and should stay below 2 MB"

# Chromium draws pages of some 16000 pixels: without its long tables the pictures of a report fit.
{ cat "$page"; echo '<style>table, ul, pre { display: none }</style>'; } >"$scratch/page/report.html"

# First what the page holds, and where: figures, pictures, height, what it asks for, one x,y,width,height each.
with_script "$scratch/page/report.html" "$pictures/measure.js" >"$scratch/page/measured.html"
browser --window-size=1200,1000 --dump-dom "$scratch/page/measured.html" >"$scratch/dom"
read -r figures svgs height asked boxes <<<"$(found "$scratch/dom")"
[[ -n ${asked-} ]] || fail 'its contents could not be measured'
((svgs > 0 && svgs == figures)) || fail "it has $figures figures, but $svgs pictures"
[[ $asked == nothing ]] || fail "it asks for $asked, and should stand alone"

# Then the page as a person would see it, and how much of each picture is not white: in thousandths.
((height < 16000)) || fail "its pictures take $height pixels, more than Chromium draws"
browser --window-size="1200,$height" --screenshot="$scratch/page.png" "$scratch/page/report.html"
{
  echo "<body><script>const boxes = '$boxes';"
  echo "const screenshot = 'data:image/png;base64,$(base64 -w 0 "$scratch/page.png")';"
  cat "$pictures/ink.js"
  echo '</script>'
} >"$scratch/ink.html"
browser --dump-dom "$scratch/ink.html" >"$scratch/dom"
read -r -a inks <<<"$(found "$scratch/dom")"
((${#inks[@]} == svgs)) || fail 'its screenshot could not be read'
for k in "${!inks[@]}"; do
  ((inks[k] >= 2)) || fail "picture $((k + 1)) of $svgs draws nothing"  # a frame alone has 5
  ((inks[k] < 900)) || fail "picture $((k + 1)) of $svgs is not in the screenshot"
done
printf '%s: %d bytes, %d pictures, of which %s thousandths are drawn\n' "$page" "$bytes" "$svgs" "${inks[*]}"
