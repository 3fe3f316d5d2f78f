# Line coverage of what is below `root`, from lcov records: a table of the files that are not covered whole, with
# the numbers of their lines that no test runs, and the sums. Ends with 1 if less than `target` per cent is covered.

/^SF:/ { file = substr($0, 4); is_ours = index(file, root) == 1; file = substr(file, length(root) + 1) }
/^DA:/ && is_ours {
  split(substr($0, 4), fields, ",")
  if (fields[1] == last[file]) next
  last[file] = fields[1]
  ++lines[file]
  if (fields[2] > 0) { ++covered[file]; in_gap[file] = 0; next }
  if (in_gap[file]) to[file, gaps[file]] = fields[1]
  else { ++gaps[file]; from[file, gaps[file]] = to[file, gaps[file]] = fields[1]; in_gap[file] = 1 }
}

function percent(some, all) { return all ? 100 * some / all : 100 }

END {
  printf "%7s %7s %7s  %s\n", "lines", "not run", "%", "file: lines that are not run"
  for (file in lines) {
    part = file; sub("/.*", "", part)
    lines_in[part] += lines[file]; covered_in[part] += covered[file]
    all += lines[file]; all_covered += covered[file]
    if (!gaps[file]) continue
    text = ""
    for (k = 1; k <= gaps[file]; ++k) {
      a = from[file, k]; b = to[file, k]
      text = text (k > 1 ? ", " : "") (a == b ? a : a "-" b)
    }
    printf "%7d %7d %7.1f  %s: %s\n", lines[file], lines[file] - covered[file],
           percent(covered[file], lines[file]), file, text | "sort -k2,2nr -k4,4"
  }
  close("sort -k2,2nr -k4,4")
  for (part in lines_in) {
    printf "%7d %7d %7.2f  %s/ whole\n", lines_in[part], lines_in[part] - covered_in[part],
           percent(covered_in[part], lines_in[part]), part
  }
  printf "%7d %7d %7.2f  together\n", all, all - all_covered, percent(all_covered, all)
  if (percent(all_covered, all) < target) {
    printf "less than %g %% of the lines are run\n", target
    exit 1
  }
}
