#!/bin/sh
# Writes the manual page of PROGRAM to standard output: TEMPLATE, with what the program's own --help-all tells of its
# commands and options in place of the lines @commands@ and @examples@.
#
# usage: manual.sh PROGRAM TEMPLATE
set -eu
program=$1
template=$2

# One after the other: what fails in a pipe is not seen.
version=$("$program" --version)
help=$("$program" --help)
commands=$(printf '%s\n' "$help" | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ -n "$commands" ] || { printf 'manual.sh: %s --help names no commands\n' "$program" >&2; exit 1; }
[ -r "$template" ] || { printf 'manual.sh: cannot read %s\n' "$template" >&2; exit 1; }
help=$(
  for command in $commands; do
    printf '@command %s\n' "$command"
    "$program" "$command" --help-all
  done
)
printf '%s\n' "$help" | awk -v version="$version" -v template="$template" '
  function roff(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    sub(/^[.\047]/, "\\\\\\&&", text)
    return text
  }
  function paragraph(option, meaning) {
    return ".TP\n.B " roff(option) "\n" roff(meaning) "\n"
  }
  function keep() {
    if (option == "") return
    if (!((option, meaning) in times)) all[++kinds] = option SUBSEP meaning
    times[option, meaning]++
    of[command, ++options[command]] = option SUBSEP meaning
    option = ""
  }

  /^@command / { command = $2; names[++number] = command; part = "about"; next }
  part == "about" { about[command] = $0; part = "usage"; next }
  /^Usage: / { usage[command] = substr($0, 8); next }
  /^Examples:$/ { part = "examples"; next }
  part ~ /usage|options/ && /^[A-Z].*:$/ { part = "options"; next }  # a group
  part == "options" && /^$/ { keep(); next }
  part == "options" && /^--config / { part = "footer"; next }
  part == "options" && /^  [^ ]/ {
    keep()
    # What it means comes after two spaces or more, or on the next line if the option is too long for that.
    option = substr($0, 3)
    meaning = ""
    if (match(option, /  +/)) {
      meaning = substr(option, RSTART + RLENGTH)
      option = substr(option, 1, RSTART - 1)
    }
    next
  }
  part == "options" { sub(/^ +/, ""); meaning = meaning (meaning == "" ? "" : " ") $0; next }
  part == "examples" && NF { sub(/^ +/, ""); shown[command, ++examples[command]] = $0 }

  END {
    shared_by = 4
    for (i = 1; i <= number; i++) {
      command = names[i]
      text = text ".SS " roff(usage[command]) "\n" roff(about[command]) "\n"
      shared = ""
      for (k = 1; k <= options[command]; k++) {
        split(of[command, k], one, SUBSEP)
        if (times[one[1], one[2]] < shared_by) {
          text = text paragraph(one[1], one[2])
        } else {
          split(one[1], word, /[ =]/)
          if (word[1] !~ /--help/) shared = shared (shared == "" ? "" : ", ") word[1]
        }
      }
      if (shared != "") text = text ".PP\nAnd of those that several commands take: " roff(shared) ".\n"
      for (k = 1; k <= examples[command]; k++) lines = lines ".PP\n.EX\n" roff(shown[command, k]) "\n.EE\n"
    }
    text = text ".SS Options of several commands\n"
    for (k = 1; k <= kinds; k++) {
      split(all[k], one, SUBSEP)
      if (times[one[1], one[2]] >= shared_by) text = text paragraph(one[1], one[2])
    }
    while ((getline line < template) > 0) {
      if (line == "@commands@") printf "%s", text
      else if (line == "@examples@") printf "%s", lines
      else { gsub(/@version@/, version, line); print line }
    }
  }'
