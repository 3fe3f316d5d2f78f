#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Whether the tests find the mistakes of mutants.py: one build with all mutants, and the tests once for each.

usage: run.py [--list] [--only NUMBERS] [--from N] [--all] [--tests REGEX] [--near] [--again] [--build DIR] ...

A copy of the tree is made in build/check/mutants/source and built in build/check/mutants/build; without a mutant all
its tests must pass. For each mutant the tests of tier 1 run, those of the nearest folders first, until one fails; with
--all those of tests/long too. What is known is kept in build/check/mutants/table.json, of which table.md is the table,
and not run again unless the mutant has changed: so the whole may be done in pieces, or stopped and begun again.
Exit code 1: a mutant survives that is not stated to be equivalent; 2: the build or a test fails without a mutant.
"""
import argparse
import hashlib
import itertools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import mutants  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What runs nothing of the product: tests of texts, and of what must not compile.
WITHOUT_PRODUCT = r"^(long_)?(docs|must_not_compile|core_layers_test|checks|version|package)"


def fail(text):
    print(f"run.py: {text}", file=sys.stderr)
    sys.exit(2)


# ---- The list.

def numbers_in(text):
    """3,7-12 as {3, 7, 8, ...}."""
    result = set()
    for part in text.split(","):
        first, _, last = part.partition("-")
        result.update(range(int(first), int(last or first) + 1))
    return result


def key_of(mutant):
    """Changes where the mutant changes."""
    return hashlib.sha256(repr((mutant.file, mutant.edits)).encode()).hexdigest()[:16]


def check_list():
    seen = set()
    for mutant in mutants.ALL:
        if mutant.number in seen:
            fail(f"mutant {mutant.number} is there twice")
        seen.add(mutant.number)


def mutated(texts):
    """The texts of files with all mutants; an old text that is not there exactly once is an error."""
    result = dict(texts)
    problems = []
    for mutant in mutants.ALL:
        for old, new in mutant.edits:
            # In the file as it is, and as the mutants before have left it: two must not change one place.
            counts = {text.get(mutant.file, "").count(old) for text in (texts, result)}
            if counts != {1}:
                problems.append(f"mutant {mutant.number} ({mutant.what}): {mutant.file} must hold once, has "
                                f"{' and '.join(map(str, sorted(counts)))} times: {old}")
                continue
            result[mutant.file] = result[mutant.file].replace(old, new.replace("MUTANT", mutant.condition()))
    if problems:
        fail("\n".join(problems))
    for file in {mutant.file for mutant in mutants.ALL if not mutant.file.endswith(".py")}:
        include = "#include \"" + mutants.HEADER.removeprefix("include/") + "\"\n"
        begin = result[file].index("#include")
        result[file] = result[file][:begin] + include + result[file][begin:]
    result[mutants.HEADER] = mutants.SWITCH
    return result


# ---- The build.

def files_of_tree():
    if shutil.which("git") and (ROOT / ".git").exists():
        found = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                               capture_output=True, text=True, check=True).stdout.split("\0")
        return [name for name in found if name and (ROOT / name).is_file()]
    return [str(path.relative_to(ROOT)) for path in ROOT.rglob("*")
            if path.is_file() and path.relative_to(ROOT).parts[0] not in (".git", "build")]


def copy_tree(target):
    """What has not changed is left alone, so that it is not compiled again."""
    names = files_of_tree()
    changed = mutated({file: (ROOT / file).read_text(encoding="utf-8")
                       for file in {mutant.file for mutant in mutants.ALL} if (ROOT / file).is_file()})
    wanted = set(names) | set(changed)
    for path in list(target.rglob("*")):
        if path.is_file() and str(path.relative_to(target)) not in wanted:
            path.unlink()
    for name in sorted(wanted):
        to = target / name
        content = changed[name].encode() if name in changed else (ROOT / name).read_bytes()
        if not to.is_file() or to.read_bytes() != content:
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(content)
        if name not in changed:
            shutil.copymode(ROOT / name, to)


def build(source, folder, targets, jobs):
    print(f"-- building all mutants in {folder}", flush=True)
    commands = [["cmake", "--preset", "release", "-S", str(source), "-B", str(folder), "--log-level=WARNING",
                 "-D", "NYSALT_BUILD_EXAMPLES=OFF", "-D", "NYSALT_TEST_PICTURES=OFF"],
                ["cmake", "--build", str(folder), "--parallel", str(jobs), "--target", *targets]]
    for command in commands:
        done = subprocess.run(command, cwd=source, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            fail("\n".join([*(done.stdout + done.stderr).splitlines()[-40:], "the mutants cannot be built"]))


# ---- The tests.

class Suite:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder
        self.labels = {}
        self.sound = set()    # tests that pass without a mutant, as far as that is known
        self.unsound = set()  # and those that do not
        listed = subprocess.run(["ctest", "--test-dir", str(folder), "--show-only=json-v1"], capture_output=True,
                                text=True, check=True).stdout
        left_out = 0
        for test in json.loads(listed[listed.index("{"):])["tests"]:
            name = test["name"]
            labels = next((one["value"] for one in test.get("properties", []) if one["name"] == "LABELS"), [])
            if re.search(options.without, name) or not re.search(options.tests, name):
                continue
            if "long" in labels and not options.all:
                continue
            if not shutil.which(test.get("command", [""])[0]):
                left_out += 1
                continue
            self.labels[name] = labels
        if left_out:
            print(f"-- {left_out} tests are not built and left out")
        if not self.labels:
            fail(f"no test is named like {options.tests}")

    def tier(self, name):
        return 2 if "long" in self.labels[name] else 1

    def run(self, names, number, stop):
        """Names of the tests that fail, with mutant number, or without one if it is 0."""
        if not names:
            return []
        environment = dict(os.environ, NYSALT_MUTANT=str(number))
        if number == 0:
            del environment["NYSALT_MUTANT"]
        with tempfile.TemporaryDirectory() as scratch:
            report = pathlib.Path(scratch) / "tests.xml"
            command = ["ctest", "--test-dir", str(self.folder), "-j", str(self.options.jobs), "--timeout",
                       str(self.options.timeout), "--output-junit", str(report), "-R",
                       "^(" + "|".join(map(re.escape, names)) + ")$"]
            if stop:
                command.append("--stop-on-failure")
            subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
            if not report.is_file():
                fail("ctest has written no report")
            cases = xml.etree.ElementTree.parse(report).getroot().iter("testcase")
            return [case.get("name") for case in cases
                    if case.get("status") == "fail" and case.get("name") in self.labels]

    GRADES = (4.0, 30.0)  # seconds: what is quick runs first

    def costs(self):
        """Seconds of each test, as far as ctest has seen it run."""
        file = self.folder / "Testing/Temporary/CTestCostData.txt"
        rows = [line.split() for line in file.read_text(encoding="utf-8").splitlines()] if file.is_file() else []
        return {row[0]: float(row[2]) for row in rows if len(row) == 3}

    def in_order(self, mutant, killer):
        """Groups of tests: what found the mutant before, the nearest folders, the others; tier 1 before tier 2, and of
        each the quick ones first."""
        left = dict.fromkeys(sorted(self.labels))
        if killer in left:
            del left[killer]
            yield [killer]
        for tier in (1, 2):
            groups = [f"^(long_)?{near}(_|$)" for near in mutant.near.split()]
            groups += [] if self.options.near else [""]
            for group in groups:
                names = [name for name in left if self.tier(name) == tier and re.search(group, name)]
                for name in names:
                    del left[name]
                costs = self.costs()
                for low, high in itertools.pairwise((0.0, *self.GRADES, float("inf"))):
                    if some := [name for name in names if low <= costs.get(name, 0.0) < high]:
                        yield some

    def is_sound(self, name):
        if name not in self.sound | self.unsound:
            (self.unsound if self.run([name], 0, stop=False) else self.sound).add(name)
        return name in self.sound

    def examine(self, mutant, killer):
        """What a table says of a mutant."""
        began = time.monotonic()
        tried = 0
        for group in self.in_order(mutant, killer):
            tried += len(group)
            while names := [name for name in group if name not in self.unsound]:
                failed = self.run(names, mutant.number, stop=True)
                if not failed:
                    break
                # Again, as a test may have failed by chance or for want of time; and not without the mutant.
                group = [name for name in group if name not in failed]
                failed = [name for name in failed
                          if self.is_sound(name) and self.run([name], mutant.number, stop=False)]
                if failed:
                    return {"killed_by": failed[0], "tier": self.tier(failed[0]),
                            "seconds": round(time.monotonic() - began, 1)}
        return {"killed_by": None, "tried": tried, "all": self.options.all, "near": self.options.near,
                "tests": self.options.tests, "seconds": round(time.monotonic() - began, 1)}


# ---- The table.

def read_table(file):
    known = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    return {int(number): row for number, row in known.items()}


def write_table(file, known):
    file.parent.mkdir(parents=True, exist_ok=True)
    rows = ["| mutant | what | killed by | tier | seconds |", "| --- | --- | --- | --- | --- |"]
    for mutant in sorted(mutants.ALL, key=lambda one: one.number):
        row = known.get(mutant.number)
        if row is None:
            continue
        survives = f"equivalent: {mutant.equivalent}" if mutant.equivalent else f"**none of {row.get('tried')} tests**"
        rows.append(f"| {mutant.number} | {mutant.what} | {row['killed_by'] or survives} | {row.get('tier', '')} "
                    f"| {row['seconds']} |")
    for path, text in ((file, json.dumps(known, indent=1, sort_keys=True)), (file.with_suffix(".md"), "\n".join(rows))):
        part = path.with_name(path.name + ".part")
        part.write_text(text + "\n", encoding="utf-8")
        part.replace(path)


def is_settled(row, mutant, options):
    """Whether these options can say no more."""
    if row is None or row["key"] != key_of(mutant) or options.again:
        return False
    if row["killed_by"]:
        return True
    return ((row["all"] or not options.all) and (options.near or not row["near"])
            and row["tests"] in ("", options.tests))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="the mutants; nothing is run")
    parser.add_argument("--only", type=numbers_in, help="numbers, such as 3,7-12")
    parser.add_argument("--from", dest="first", type=int, default=0, help="from this place in the list on")
    parser.add_argument("--all", action="store_true", help="tests of both tiers")
    parser.add_argument("--tests", default="", help="only tests with names like this")
    parser.add_argument("--without", default=WITHOUT_PRODUCT, help="no tests with names like this")
    parser.add_argument("--near", action="store_true", help="only tests of the nearest folders")
    parser.add_argument("--again", action="store_true", help="also what the table has")
    parser.add_argument("--build", type=pathlib.Path, help="a folder where all mutants are built already")
    parser.add_argument("--table", type=pathlib.Path, default=ROOT / "build/check/mutants/table.json")
    parser.add_argument("--targets", nargs="+", help="what is built [tier1; with --all all]")
    parser.add_argument("--timeout", type=int, default=300, help="seconds of a test")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="tests at a time")
    parser.add_argument("--trust", action="store_true", 
                        help="run without a mutant only the tests that fail with one")
    options = parser.parse_args()

    check_list()
    chosen = [mutant for mutant in mutants.ALL[max(0, options.first - 1):]
              if not options.only or mutant.number in options.only]
    if options.list:
        for mutant in chosen:
            print(f"{mutant.number:4}  {mutant.file}: {mutant.what}")
        return 0
    known = read_table(options.table)
    to_do = [mutant for mutant in chosen if not is_settled(known.get(mutant.number), mutant, options)]
    if to_do:
        folder = options.build
        if folder is None:
            folder = ROOT / "build/check/mutants/build"
            copy_tree(ROOT / "build/check/mutants/source")
            targets = options.targets or ["all" if options.all else "tier1"]
            build(ROOT / "build/check/mutants/source", folder, targets, os.cpu_count())
        suite = Suite(options, folder.resolve())
        if not options.trust:
            print(f"-- without a mutant: {len(suite.labels)} tests", flush=True)
            failed = suite.run(list(suite.labels), 0, stop=False)
            failed = [name for name in failed if suite.run([name], 0, stop=False)]
            if failed:
                fail("without a mutant these fail: " + ", ".join(failed))
            suite.sound.update(suite.labels)
    for mutant in to_do:
        killer = known.get(mutant.number, {}).get("killed_by")
        known[mutant.number] = {"what": mutant.what, "key": key_of(mutant), **suite.examine(mutant, killer)}
        write_table(options.table, known)
        row = known[mutant.number]
        killer = row["killed_by"] or "SURVIVES"
        print(f"{mutant.number:4}  {row['seconds']:7.1f} s  {killer}: {mutant.what}", flush=True)
    survivors = [mutant for mutant in chosen if not known[mutant.number]["killed_by"] and not mutant.equivalent]
    print(f"{len(chosen)} mutants, {len(chosen) - len(survivors)} killed or equivalent, {len(survivors)} survive"
          + ("" if not survivors else ": " + ", ".join(str(mutant.number) for mutant in survivors)))
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
