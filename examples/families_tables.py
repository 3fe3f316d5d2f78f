#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""How many times smaller the error of a learned method is than that of the best classical one: tables in Markdown.

usage: families_tables.py FOLDER CASE...        each CASE is a folder of FOLDER with the rows.csv of a comparison

Twice: at equal force evaluations, as compared; and at equal seconds, where a classical method that takes less time takes
smaller steps instead. What these gain follows from the order that the method has between its two rows of that comparison.
"""
import csv
import math
import statistics
import sys
from collections import defaultdict


def rows_of(path):
    """By method and nominal step: evaluations, seconds and error of what is ranked."""
    result = defaultdict(dict)
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            value = row["error"] or row["acceptance"]
            if not value or "diverged" in row.get("marks", "") or "reference" in row.get("marks", ""):
                continue
            result[row["method"]][float(row["step"])] = {
                "seconds": float(row["seconds_per_time"]), "value": float(value),
                "median": float(row["median"]) if row.get("median") else math.nan,
                "tail": "tail" in row.get("marks", "")}
    return result


def is_learned(method):
    return method.startswith("learned:")


def error_in(rows, step, by_median):
    row = rows[step]
    return row["median"] if by_median else row["value"]


def order_of(rows, by_median):
    """Of a method between its smallest and its largest step; one if it has a single row."""
    steps = sorted(rows)
    if len(steps) < 2:
        return 1.0
    low, high = steps[0], steps[-1]
    slope = math.log(error_in(rows, high, by_median) / error_in(rows, low, by_median)) / math.log(high / low)
    return max(0.0, slope)


def gains_of(table, step, by_median):
    """(best classical, its error, by learned method (gain at equal evaluations, at equal seconds))."""
    classical = {name: rows for name, rows in table.items() if not is_learned(name) and step in rows}
    best = min(classical, key=lambda name: error_in(classical[name], step, by_median))
    least = error_in(classical[best], step, by_median)
    gains = {}
    for name, rows in table.items():
        if not is_learned(name) or step not in rows:
            continue
        own, seconds = error_in(rows, step, by_median), rows[step]["seconds"]
        rival = min(error_in(rival_rows, step, by_median)
                    * min(1.0, rival_rows[step]["seconds"] / seconds) ** order_of(rival_rows, by_median)
                    for rival_rows in classical.values())
        gains[name] = (least / own, rival / own)
    return best, least, gains


def cell(value):
    return f"{value:.2g}" if value is not None else "-"


def main(folder, cases):
    found = []
    for case in cases:
        table = rows_of(f"{folder}/{case}/rows.csv")
        for step in sorted({step for rows in table.values() for step in rows}):
            by_median = any(rows[step]["tail"] for rows in table.values() if step in rows)
            found.append((case, step, by_median, *gains_of(table, step, by_median)))
    families = sorted({name for *_, gains in found for name in gains},
                      key=lambda name: -statistics.median(gains.get(name, (0.0,))[0] for *_, gains in found))
    for which, title in enumerate(("At equal evaluations", "At equal seconds")):
        print(f"{title}:\n")
        print("| case | step | best classical | its error | " + " | ".join(name[len("learned:"):] for name in families) + " |")
        print("|---" * (4 + len(families)) + "|")
        for case, step, by_median, best, least, gains in found:
            cells = [cell(gains[name][which] if name in gains else None) for name in families]
            error = f"{least:.2e}" + (" (median)" if by_median else "")
            print(f"| {case} | {step:g} | `{best}` | {error} | " + " | ".join(cells) + " |")
        medians = [statistics.median(gains.get(name, (0.0, 0.0))[which] for *_, gains in found) for name in families]
        print("| median, a fit that is not usable counts 0 | | | | " + " | ".join(cell(value) for value in medians) + " |")
        best_of = [max((gain[which] for gain in gains.values()), default=0.0) for *_, gains in found]
        print(f"\nMedian of the best learned family in each case: {statistics.median(best_of):.2g}\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
