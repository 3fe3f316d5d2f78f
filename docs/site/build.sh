#!/usr/bin/env bash
# Builds the documentation site, without network: build.sh [FOLDER], build/docs if none. Warnings and broken links are
# errors.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "${1:-$here/../../build/docs}"
NYSALT_SITE=$(cd "${1:-$here/../../build/docs}" && pwd)
export NYSALT_SITE
cd "$here/../.."
wrong=0

if [[ -n $(ls "$NYSALT_SITE") && ! -d $NYSALT_SITE/staged ]]; then
  echo "build.sh: $NYSALT_SITE is not empty, and no site was built there before" >&2
  exit 2
fi
rm -rf "${NYSALT_SITE:?}"/*
python3 -B docs/site/stage.py . "$NYSALT_SITE/staged" || wrong=1
[[ -e $NYSALT_SITE/staged/layout.xml ]] || exit 1

# Doxygen's own header, with what makes the theme's buttons work.
(cd "$NYSALT_SITE/staged" && doxygen -w html plain_header.html footer.html style.css) 2>/dev/null
sed "/<\/head>/{
  r docs/site/head.html
  N
}" "$NYSALT_SITE/staged/plain_header.html" >"$NYSALT_SITE/staged/header.html"

doxygen docs/site/Doxyfile 2>"$NYSALT_SITE/staged/warnings" || wrong=1
sed "s|^$PWD/||" "$NYSALT_SITE/staged/warnings" >&2
cp -r "$NYSALT_SITE"/staged/html/. "$NYSALT_SITE"
python3 -B docs/site/links.py . "$NYSALT_SITE" || wrong=1
exit "$wrong"
