#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Stochastic test cases at many seeds: how often each fails, against the rate that tests/stochastic.md states.

usage: seeds.py BUILD SEEDS COUNTS

Runs the tests with the label `stochastic` of the folder BUILD, only the cases of the table, SEEDS times, with the
environment variable NYSALT_TEST_SEED_SHIFT = 1, 2, ... Ends with 1 if a case failed more often than its rate
allows: that many failures or more have a probability below 0.001. Writes the counts, in words, to the file COUNTS.
"""
import collections
import concurrent.futures
import json
import math
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

TABLE = pathlib.Path(__file__).resolve().parent.parent / "stochastic.md"
CHANCE = 1e-3  # below it a count of failures is no accident


def stated(table=TABLE):
    """The rates of the table: {test: {case: rate}}, where a_test is folder_name_test."""
    rates = collections.defaultdict(dict)
    for line in table.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 6 and cells[0].startswith("`") and cells[0].endswith("_test.cpp`"):
            test = cells[0].strip("`").removesuffix(".cpp").replace("/", "_")
            rates[test][cells[1].strip("`")] = float(cells[4])
    return dict(rates)


def commands(build):
    """{test: its command} of the tests with the label `stochastic`."""
    done = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", "-L", "^stochastic$"],
                          capture_output=True, text=True, check=True)
    return {test["name"]: test["command"] for test in json.loads(done.stdout)["tests"]}


def chosen(command, cases):
    """The command for these cases only; of a template the name goes on after `<`."""
    suite = [word.removeprefix("--run_test=") + "/" for word in command if word.startswith("--run_test=")]
    words = [word for word in command if not word.startswith("--run_test=")]
    names = ",".join(name for case in cases for name in (case, case + "<*"))
    return [*words, f"--run_test={''.join(suite)}{names}", "--report_level=detailed", "--report_format=XML"]


def failed_of(report, cases):
    """The cases that failed, by what Boost.Test reports; all if it reports nothing, as after a crash."""
    begin, end = report.find("<TestResult"), report.find("</TestResult>")
    if begin < 0 or end < 0:
        return list(cases)
    failed, seen = set(), set()
    for case in xml.etree.ElementTree.fromstring(report[begin:end] + "</TestResult>").iter("TestCase"):
        name = case.get("name").split("<")[0]
        if case.get("result") != "skipped":
            seen.add(name)
        if case.get("result") not in ("passed", "skipped"):
            failed.add(name)
    return [case for case in cases if case in failed or case not in seen]


def run(job):
    test, command, cases, shift = job
    environment = os.environ | {"NYSALT_TEST_SEED_SHIFT": str(shift), "BOOST_TEST_COLOR_OUTPUT": "no"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    failed = failed_of(done.stderr, cases)
    lines = [line for line in (done.stdout + done.stderr).splitlines() if "error: in" in line]
    return test, shift, failed, lines


def tail(failures, runs, rate):
    """The probability of that many failures or more."""
    return 1.0 - sum(math.comb(runs, k) * rate**k * (1.0 - rate) ** (runs - k) for k in range(failures))


def upper_bound(failures, runs):
    """The rate at which that many failures or fewer have a probability of 5 % (Clopper, Pearson)."""
    low, high = failures / runs, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if 1.0 - tail(failures + 1, runs, middle) > 0.05 else (low, middle)
    return high


def main():
    build, number, file_of_counts = sys.argv[1:]
    number = int(number)
    rates, known = stated(), commands(build)
    missing = sorted(set(rates) - set(known)) + sorted(set(known) - set(rates))
    if missing:
        sys.exit(f"seeds.py: tests/stochastic.md and the label `stochastic` must have the same tests, got one only: "
                 f"{', '.join(missing)}")
    jobs = [(test, chosen(known[test], cases), list(cases), shift) for shift in range(1, number + 1) for test, cases in rates.items()]
    counts, of_run = collections.Counter(), set()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for test, shift, failed, lines in pool.map(run, jobs):
            for case in failed:
                counts[test, case] += 1
                of_run.add(shift)
                print(f"{test}/{case} failed at the shift {shift}", *lines, sep="\n  ", flush=True)
    excessive = [one for one in counts if tail(counts[one], number, rates[one[0]][one[1]]) < CHANCE]
    for (test, case), count in counts.most_common():
        print(f"{count:4} of {number}: {test}/{case}, stated rate {rates[test][case]:g}"
              f"{', TOO OFTEN' if (test, case) in excessive else ''}")
    cases = sum(len(of_test) for of_test in rates.values())
    text = (f"{number} seeds x {cases} cases: {sum(counts.values())} failed; rate of a run below "
            f"{upper_bound(len(of_run), number):.2g} (95 %), stated "
            f"{sum(sum(of_test.values()) for of_test in rates.values()):.2g}")
    print(text)
    pathlib.Path(file_of_counts).write_text(text, encoding="utf-8")
    return 1 if excessive else 0


if __name__ == "__main__":
    sys.exit(main())
