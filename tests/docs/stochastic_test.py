# SPDX-License-Identifier: BSL-1.0
"""tests/stochastic.md lists the cases that are there, and their rates of false alarms are together below 1e-3."""
import pathlib
import re
import sys

TESTS = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TESTS / "checks"))
import seeds  # noqa: E402

BUDGET = 1e-3


def problems(rates, sources):
    """What is wrong of the rates of the table, given the texts of the tests that take shifted seeds."""
    found = [f"{test} takes shifted seeds and is not in tests/stochastic.md" for test in sources if test not in rates]
    for test, cases in rates.items():
        if test not in sources:
            found.append(f"{test} of tests/stochastic.md takes no shifted seeds")
            continue
        for case in cases:
            if not re.search(rf"_TEST_CASE(_TEMPLATE)?\(\s*{case}\b", sources[test]):
                found.append(f"{test} has no case {case}")
    total = sum(rate for cases in rates.values() for rate in cases.values())
    if total >= BUDGET:
        found.append(f"the rates together must be below {BUDGET:g}, got {total:.3g}")
    return found


def main():
    sources = {}
    for path in TESTS.rglob("*_test.cpp"):
        text = path.read_text(encoding="utf-8")
        if "support/seeds.hpp" in text:
            sources[str(path.relative_to(TESTS).with_suffix("")).replace("/", "_")] = text
    rates = seeds.stated()
    found = problems(rates, sources)
    # What must be found: a case that is not there, a test that is not listed, and rates that are too large.
    one = next(iter(sources))
    for wrong, texts in (({one: {"no_such_case": 0.0}}, {one: sources[one]}), ({}, {one: sources[one]}),
                         ({one: {case: 1.0 for case in rates[one]}}, {one: sources[one]})):
        if len(problems(wrong, texts)) != 1:
            found.append(f"{wrong} must be found wrong in one way")
    # Boost.Test's report: a case that failed, one that did not run, and nothing at all after a crash.
    report = ('<TestResult><TestSuite><TestCase name="a" result="passed"/><TestCase name="b&lt;int&gt;" result="failed"/>'
              '</TestSuite></TestResult>')
    if seeds.failed_of(report, ["a", "b", "c"]) != ["b", "c"] or seeds.failed_of("", ["a"]) != ["a"]:
        found.append("failures are not read from reports as they are")
    # One failure of 200 is no accident of the rate 1e-6, and one of the rate 1e-5 may be; none of 200 is below 1.5 %.
    if not seeds.tail(1, 200, 1e-6) < seeds.CHANCE < seeds.tail(1, 200, 1e-5):
        found.append("the probability of failures is wrong")
    if abs(seeds.upper_bound(0, 200) - 0.0149) > 1e-4:
        found.append("the upper bound of a rate is wrong")
    for one in found:
        print(one)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
