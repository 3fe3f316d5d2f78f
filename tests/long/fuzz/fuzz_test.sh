#!/usr/bin/env bash
# usage: fuzz_test.sh FOLDER SOURCES
# Whether fuzz.sh finds what is planted, and says so where nothing is fuzzed. Skipped (77) without libFuzzer.
set -euo pipefail
folder=$(realpath -m "$1") sources=$2
rm -rf "$folder"
mkdir -p "$folder/empty"
compile() {  # NAME [OPTION]
  clang++ -std=c++20 -g1 -O1 -fsanitize=fuzzer "${@:2}" "$sources/planted.cpp" -o "$folder/$1" 2>"$folder/$1.messages"
}
compile sound || { echo "skipped: clang++ with libFuzzer is not here"; exit 77; }
compile planted -DPLANTED
failed=0
expect() {  # STATUS CASE WORDS PROGRAM CORPUS
  local status=0
  "$sources/fuzz.sh" "$folder/$4" 2000 "$5" "$folder/kept.$2" >"$folder/$2.out" 2>&1 || status=$?
  if ((status == $1)) && grep -q -- "$3" "$folder/$2.out"; then
    printf '%-10s as expected\n' "$2"
  else
    failed=1
    printf '%-10s ended with %d, expected %d and "%s":\n' "$2" "$status" "$1" "$3"
    tail -n 20 "$folder/$2.out"
  fi
}
printf '#!/bin/sh\nexit 0\n' >"$folder/silent"  # a target that does nothing at all
chmod +x "$folder/silent"
expect 0 sound '^2[0-9]* inputs' sound "$sources/one_letter"
expect 1 planted 'deadly signal' planted "$sources/one_letter"
expect 1 silent 'was not fuzzed' silent "$sources/one_letter"
expect 1 empty 'no file' sound "$folder/empty"
expect 2 relative 'must be absolute' sound one_letter
# What was cut short goes on: of four rounds two are made before the program fails, and two after it.
cat >"$folder/mortal" <<END
#!/bin/sh
echo x >>"$folder/calls"
[ "\$(wc -l <"$folder/calls")" -ne 3 ] || { echo "cut short"; exit 1; }
exec "$folder/sound" "\$@"
END
chmod +x "$folder/mortal"
: >"$folder/calls"
export FUZZ_ROUND=500
expect 1 mortal 'cut short' mortal "$sources/one_letter"
expect 0 mortal '^2[0-9]* inputs' mortal "$sources/one_letter"
calls=$(wc -l <"$folder/calls")
((calls == 6)) || { failed=1; echo "mortal was called $calls times, expected 6: 2 rounds, a failure, 2 rounds, a merge"; }
exit "$failed"
