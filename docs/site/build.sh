#!/usr/bin/env bash
# Builds the documentation site, without network: build.sh [FOLDER], build/docs if none. Warnings of Doxygen and Sphinx,
# broken links and public names without a comment are errors.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "${1:-$root/build/docs}"
site=$(cd "${1:-$root/build/docs}" && pwd)
if [[ -n $(ls "$site") && ! -e $site/.source/README.md ]]; then
  echo "build.sh: $site is not empty, and no site was built there before" >&2
  exit 2
fi
rm -rf "${site:?}"/* "$site/.source" "$site/.api"
mkdir "$site/.source" "$site/.api"
wrong=0

# What Sphinx reads: the project as it is, and pages of the C++ interface and of sources.
for name in "$root"/*; do
  [[ $name == */build ]] || ln -s "$name" "$site/.source/"
done
python3 -B "$root/docs/site/api.py" "$root" "$site/.api" || wrong=1
python3 -B "$root/docs/site/sources.py" "$root" "$site/.api"
ln -s "$site/.api/api" "$site/.api/sources" "$site/.source/"

NYSALT_SITE_XML=$site/.api/xml sphinx-build -q -W --keep-going -c "$root/docs/site" -d "$site/.api/doctrees" \
  "$site/.source" "$site" || wrong=1
cp "$site/README.html" "$site/index.html"  # the first page of a folder
python3 -B "$root/docs/site/links.py" "$root" "$site" || wrong=1
exit "$wrong"
