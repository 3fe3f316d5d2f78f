#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Outcomes of the long checks: each with the date, commit, time and counts of the run, and a table of all.

usage: outcomes.py commit            the commit of the sources, for `add`
       outcomes.py add FOLDER CHECK PIECE COMMIT STATUS SECONDS COUNTS
       outcomes.py count REPORT      the counts of a JUnit report of ctest, in words
       outcomes.py table FOLDER      print the table

`add` keeps FOLDER/outcomes/CHECK_PIECE.json, in place of an older outcome of that piece, and writes FOLDER/table.md.
"""
import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree

CHECKS = {
    "gcc": "all tests, built by g++",
    "clang": "all tests, built by clang++",
    "address": "AddressSanitizer, UndefinedBehaviorSanitizer",
    "threads": "ThreadSanitizer, tests that use threads",
    "tidy": "clang-tidy, src and all headers",
    "fuzz": "libFuzzer, with both sanitizers of addresses",
    "faults": "failures of each call that writes",
    "coverage": "lines that tests run",
    "seeds": "stochastic tests at many seeds",
    "mutants": "mistakes planted in the product",
}


def git(*words):
    if not shutil.which("git"):
        return ""
    done = subprocess.run(["git", *words], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else ""


def commit():
    """The commit, with + where tracked files differ from it."""
    name = git("rev-parse", "--short=10", "HEAD")
    return (name or "unknown") + ("+" if name and git("status", "--porcelain", "--untracked-files=no") else "")


def counted(report):
    """"45 tests: 43 passed, 1 failed (NAME), 1 skipped" of a JUnit report."""
    failed, skipped, passed = [], 0, 0
    for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
        status = case.get("status")
        if status == "fail":
            failed.append(case.get("name"))
        elif status == "run":
            passed += 1
        else:
            skipped += 1
    text = f"{passed + len(failed) + skipped} tests: {passed} passed"
    if failed:
        text += f", {len(failed)} failed ({', '.join(failed)})"
    return text + (f", {skipped} skipped" if skipped else "")


def add(folder, check, piece, commit_before, status, seconds, counts):
    outcome = {
        "check": check,
        "piece": piece,
        "passed": int(status) == 0,
        "counts": counts.strip() or "it ended before anything was counted",
        "seconds": int(seconds),
        "commit": commit_before,
        "date": datetime.date.today().isoformat(),
    }
    outcomes = folder / "outcomes"
    outcomes.mkdir(parents=True, exist_ok=True)
    name = re.sub(r"[^a-z0-9_]+", "_of_", f"{check}_{piece}")
    unfinished = outcomes / f"{name}.json.{os.getpid()}"
    unfinished.write_text(json.dumps(outcome, indent=1) + "\n", encoding="utf-8")
    unfinished.replace(outcomes / f"{name}.json")
    (folder / "table.md").write_text(table(folder), encoding="utf-8")
    print(f"{check} {piece}: {'passed' if outcome['passed'] else 'FAILED'}; {outcome['counts']}")


def not_run(name, found):
    """What is missing of a check whose pieces are K/N; None if nothing is."""
    if not found:
        return "not run"
    for parts in {piece.split("/")[1] for piece in found if "/" in piece}:
        missing = [k for k in range(1, int(parts) + 1) if f"{k}/{parts}" not in found]
        if not missing:
            return None
    cut = [piece for piece in found if "/" in piece]
    return "the other pieces were not run" if cut and len(found) == len(cut) else None


def table(folder):
    outcomes = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((folder / "outcomes").glob("*.json"))]
    lines = [
        "# The long checks",
        "",
        "What `./dev check` found, check by check; a commit with + had changes beside it. `./dev check` wrote this.",
        "",
        "| check | piece | outcome | counts | minutes | commit | date |",
        "|---|---|---|---|---|---|---|",
    ]

    def order(outcome):
        numbers = re.fullmatch(r"(\d+)/(\d+)", outcome["piece"])
        return (int(numbers[2]), int(numbers[1]), "") if numbers else (0, 0, outcome["piece"])

    for name, what in CHECKS.items():
        here = sorted((one for one in outcomes if one["check"] == name), key=order)
        for one in here:
            lines.append(
                f"| `{name}`, {what} | {one['piece']} | {'passed' if one['passed'] else '**failed**'} | {one['counts']}"
                f" | {one['seconds'] / 60:.1f} | {one['commit']} | {one['date']} |")
        missing = not_run(name, {one["piece"] for one in here})
        if missing:
            lines.append(f"| `{name}`, {what} | | {missing} | | | | |")
    return "\n".join(lines) + "\n"


def main():
    command, *words = sys.argv[1:]
    if command == "commit":
        print(commit())
    elif command == "add":
        add(pathlib.Path(words[0]), *words[1:])
    elif command == "count":
        print(counted(words[0]))
    else:
        print(table(pathlib.Path(words[0])), end="")


if __name__ == "__main__":
    main()
