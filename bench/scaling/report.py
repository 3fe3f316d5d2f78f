#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""How work that ranks share scales: a cost model of what one rank takes, and what it foretells: table.md, rows.csv, scaling.svg.

usage: report.py FOLDER, which holds *.jsonl of nysalt_scaling. docs/scaling.md has the formulas.
"""
import csv
import dataclasses
import json
import math
import pathlib
import statistics
import sys
from typing import List, NamedTuple

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pages import Curve, Panel, draw, markdown, processor  # noqa: E402
from ratios import paired_ratio, verdict  # noqa: E402

# What is assumed of a cluster, where nothing was measured.
RANKS = 10_000
LATENCY = 2e-6  # seconds of a message between machines
BANDWIDTH = 1e10  # bytes a second into one rank: a link of 100 Gbit/s, less what it takes itself
SPREAD = 0.05  # the slowest rank's time over the median one's, less 1
START_UP = 30.0  # seconds until all ranks run
DISK = 1e9  # bytes a second that one rank writes to a shared file system

LEAF = 16  # trajectories that a rank has at least, as in nysalt/core/tree_sum.hpp
JOBS, STEPS_OF_LEARNING, STEPS_OF_RUN, LOOKS_OF_RUN = 10**9, 16, 1e6, 1000.0  # trajectories; times at which sums are wanted
NAMES = {"kernel": "kernel that shares nothing", "two-stage": "steps, two-stage", "BAOAB": "steps in a bath, BAOAB",
         "data": "making data", "pass": "pass over the data", "learn": "learn()"}


class Cost(NamedTuple):
    value: float = 0.0
    error: float = 0.0

    def text(self, unit):
        if self.value == 0:
            return "too small to fit"
        error = self.error / unit
        return f"{self.value / unit:.4g} +- " + (f"{error:.0f}" if error >= 10 else f"{error:.2g}")


def fitted_costs(x, y):
    """Costs, none of them negative, by least squares of relative errors of y = x @ costs, and their standard errors from the
    scatter that is left; NaN if none can be. Those that would be negative are 0, the most negative first."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if x.ndim != 2 or len(x) < x.shape[1]:
        raise ValueError("too little was measured to fit a cost model")
    result, free = [Cost()] * x.shape[1], list(range(x.shape[1]))
    while free:
        a = x[:, free] / y[:, None]
        sizes = np.linalg.norm(a, axis=0)  # bytes beside seconds: columns of one size, or rounding decides
        a = a / sizes
        inverse = np.linalg.inv(a.T @ a)
        c = inverse @ a.sum(axis=0)
        if c.min() < 0:
            del free[int(c.argmin())]
            continue
        left = np.sum((1 - a @ c) ** 2) / (len(y) - len(free)) if len(y) > len(free) else math.nan
        for j, k in enumerate(free):
            result[k] = Cost(c[j] / sizes[j], math.sqrt(left * inverse[j, j]) / sizes[j])
        break
    return result


def largest_share_of(trajectories, ranks):
    """M_r of the rank that has most, as nysalt::shard has it: 2^k leaves a block, k as large as leaves 32 blocks a rank."""
    leaf, blocks = LEAF, -(-trajectories // LEAF)
    while blocks // 2 >= 32 * ranks:
        blocks, leaf = (blocks + 1) // 2, 2 * leaf
    return min(trajectories, leaf * -(-blocks // ranks))


def levels_over(ranks):
    """Levels of the tree over the ranks: ceil(log2 R)."""
    return (ranks - 1).bit_length()


def bytes_of_pass(parameters):
    """Bytes of the sum that a pass over the data makes: r^T r, J^T r and half of J^T J."""
    return 8.0 * (1 + parameters + parameters * (parameters + 1) // 2)


@dataclasses.dataclass
class Reductions:
    """T_red(R) = a + a' bytes + ceil(log2 R) (b + beta bytes)."""
    here: Cost
    here_byte: Cost
    level: Cost
    level_byte: Cost

    def seconds(self, ranks, size):
        return self.here.value + self.here_byte.value * size + levels_over(ranks) * (self.level.value + self.level_byte.value * size)


@dataclasses.dataclass
class Work:
    """Rounds of one piece of work. Round i of all pieces of the same `what` was made at about the same time."""
    what: str
    scaling: str
    ranks: int
    threads: int
    trajectories: int
    steps: int
    largest_share: int
    seconds: List[float] = dataclasses.field(default_factory=list)

    def middle(self):
        return statistics.median(self.seconds)

    def pairs(self):
        return float(self.largest_share * self.steps)


class Measured:
    """What nysalt_scaling printed, by what it measures. Throws ValueError if that is not what is there."""

    def __init__(self, folder):
        works, sums, self.memory, self.rows = {}, {}, [], {}
        for path in sorted(pathlib.Path(folder).glob("*.jsonl")):
            for line in path.read_text(encoding="utf-8").splitlines():
                try:
                    self._add(json.loads(line), works, sums)
                except (json.JSONDecodeError, KeyError, TypeError) as problem:
                    raise ValueError(f"{path}: {problem!r}") from None
        self.times, self.sums = list(works.values()), list(sums.values())
        if not self.times:
            raise ValueError(f"no times in {folder}: run ./dev scaling")
        for one in self.times:
            if one.what != "kernel" and one.threads == 1 and one.largest_share != largest_share_of(one.trajectories, one.ranks):
                raise ValueError(f"the largest share of {one.trajectories} trajectories on {one.ranks} ranks must be "
                                 f"{largest_share_of(one.trajectories, one.ranks)}, got {one.largest_share}")

    def _add(self, row, works, sums):
        what = row["what"]
        if what == "reduction":
            one = sums.setdefault((row["ranks"], row["doubles"]), {**row, "seconds": [], "seconds_90": []})
            one["seconds"].append(row["seconds"])  # medians of thousands
            one["seconds_90"].append(row["seconds_90"])
        elif what == "memory":
            self.memory.append({key: row[key] for key in ("ranks", "trajectories", "steps", "share", "bytes")})
        elif what.startswith("row of "):
            one = self.rows.setdefault(what, {"seconds": []})
            one["seconds"].append(row["seconds"])
            one["bytes"] = row["bytes"]
        else:
            key = tuple(row[name] for name in ("what", "scaling", "ranks", "threads", "trajectories", "steps"))
            works.setdefault(key, Work(*key, row["largest_share"])).seconds.append(row["seconds"])

    def of(self, what):
        return [one for one in self.times if one.what == what]

    def find(self, what, ranks, threads=1):
        """The same work for any number of ranks."""
        for one in self.of(what):
            if (one.scaling, one.ranks, one.threads) == ("strong", ranks, threads):
                return one
        raise ValueError(f"{what} on {ranks} ranks was not measured: run ./dev scaling on two cores or more")


class Model:
    """Costs of one rank alone, in seconds, so that what more ranks take is foretold, not fitted; only messages need more."""

    def __init__(self, measured):
        def alone(what, x):
            work = [one for one in measured.of(what) if one.ranks == 1 and one.threads == 1]
            return fitted_costs([x(one) for one in work], [one.middle() for one in work])

        # T_run = t_step n M_r + t_start M_r; else T = t_pair P_r + t_0, what is no message of a pass or of all of learn().
        self.of_steps = {what: alone(what, lambda one: [one.pairs(), one.largest_share]) for what in ("two-stage", "BAOAB")}
        self.of_pairs = {what: alone(what, lambda one: [one.pairs(), 1.0]) for what in ("data", "pass", "learn")}
        # Ranks beyond the cores wait for a core, not for messages: they do not count.
        seen = [(one["ranks"], 8.0 * one["doubles"], s) for one in measured.sums if one["ranks"] <= one["cores"]
                for s in one["seconds"]]
        self.reduction = Reductions(*fitted_costs([[1.0, size, levels_over(r), levels_over(r) * size] for r, size, _ in seen],
                                                  [s for _, _, s in seen]))
        # Bytes of a rank: c_0 + c_pair P_r + c_trajectory M_r, data and held-out data of P_r pairs each.
        self.memory = fitted_costs([[1.0, one["share"] * one["steps"], one["share"]] for one in measured.memory],
                                   [one["bytes"] for one in measured.memory])
        # A rank beside as many others as the machine has cores, against one alone: of BAOAB with as much a rank.
        weak = [one for one in measured.of("BAOAB") if one.scaling == "weak"]
        full = max(weak, key=lambda one: one.ranks, default=None)
        self.slower = 1.0 if full is None else max(1.0, paired_ratio(full.seconds, measured.find("BAOAB", 1).seconds).value)

    def passes(self):
        """Passes over the data that learn() takes, whatever they are."""
        return self.of_pairs["learn"][0].value / self.of_pairs["pass"][0].value

    def of_costs(self, what, pairs, share):
        if what in self.of_steps:
            step, start = self.of_steps[what]
            return step.value * pairs + start.value * share
        pair, none = self.of_pairs[what]
        return pair.value * pairs + none.value

    def seconds(self, work):
        """Of a piece of work, as if all cores were as quick as one alone."""
        total = self.reduction.seconds(work.ranks, bytes_of_pass(2)) if work.ranks > 1 else 0.0
        return self.of_costs(work.what, work.pairs(), work.largest_share) + total * (self.passes() if work.what == "learn" else 1)

    def bytes(self, pairs, share):
        return self.memory[0].value + self.memory[1].value * pairs + self.memory[2].value * share


class Foretold:
    """Seconds of jobs on the cluster: up the tree and down are two messages a level; what a rank does by itself is as measured."""

    def __init__(self, model):
        self.model = model
        self.reduction = Reductions(model.reduction.here, model.reduction.here_byte, Cost(2 * LATENCY), Cost(2 / BANDWIDTH))

    def sum(self, ranks):
        return self.reduction.seconds(ranks, bytes_of_pass(2)) if ranks > 1 else 0.0

    def slowest(self, seconds, ranks):
        return seconds * self.model.slower * (1 + SPREAD) if ranks > 1 else seconds

    def of_pairs(self, what, trajectories, ranks):
        """What grows with the data of a rank, and what does not."""
        pair, none = self.model.of_pairs[what]
        return self.slowest(pair.value * largest_share_of(trajectories, ranks) * STEPS_OF_LEARNING, ranks), none.value

    def making_data(self, trajectories, ranks):
        growing, none = self.of_pairs("data", trajectories, ranks)
        return 2 * growing + none  # held-out data, too

    def a_pass(self, trajectories, ranks):
        return sum(self.of_pairs("pass", trajectories, ranks)) + self.sum(ranks)

    def learning(self, trajectories, ranks):
        return sum(self.of_pairs("learn", trajectories, ranks)) + self.model.passes() * self.sum(ranks)

    def run(self, trajectories, ranks):
        share = largest_share_of(trajectories, ranks)
        return self.slowest(self.model.of_costs("BAOAB", STEPS_OF_RUN * share, share), ranks) + LOOKS_OF_RUN * self.sum(ranks)

    def ranks_of_dear_sums(self, trajectories):
        """The fewest ranks whose sum takes a tenth of their pass; in steps of a tenth."""
        ranks = 2.0
        while 10 * self.sum(int(ranks)) < self.a_pass(trajectories, int(ranks)):
            ranks *= 1.1
        return int(ranks)


def efficiency(seconds, ranks):
    """T(1)/(R T(R)) for the same job."""
    return seconds(1) / (ranks * seconds(ranks))


def duration(seconds):
    for most, unit, name in ((1e-6, 1e-9, "ns"), (1e-3, 1e-6, "us"), (1.0, 1e-3, "ms"), (600.0, 1.0, "s"), (3.6e5, 3600.0, "h")):
        if seconds < most:
            return f"{seconds / unit:.3g} {name}"
    return f"{seconds / 86400:.3g} days"


def amount(size):
    for most, unit, name in ((1e3, 1.0, "B"), (1e6, 1e3, "kB"), (1e9, 1e6, "MB"), (1e12, 1e9, "GB")):
        if size < most:
            return f"{size / unit:.3g} {name}"
    return f"{size / 1e12:.3g} TB"


def acceptance(measured):
    """Two ranks against one, and against two threads: what is asked, and whether it holds. A machine whose bare kernel gains less than
    1.9 has not two cores to give."""
    def ratio(what, over, under):
        return paired_ratio(measured.find(what, *over).seconds, measured.find(what, *under).seconds)

    def say(found, bound):
        holds, _ = verdict(found, True, bound)
        return "yes" if holds else "?" if holds is None or ratio("kernel", (1,), (2,)).value < 1.9 else "NO"

    rows = []
    for what, name in NAMES.items():
        gain = ratio(what, (1,), (2,))
        beside = None if what == "kernel" else ratio(what, (1, 2), (2,))
        rows.append([name, *gain.cells(), *(["", "", "", ""] if beside is None else
                                            [say(gain, 1.8), *beside.cells(), say(beside, 0.95)])])
    return ["what", "two ranks, speed-up", "95 %", ">= 1.8", "speed by two threads'", "95 %", ">= 0.95"], rows, 1


def efficiency_of(measured, work):
    """T(1)/(R T(R)) of the same work, T(1)/T(R) of as much a rank."""
    found = paired_ratio(measured.find(work.what, 1).seconds, work.seconds)
    by = work.ranks if work.scaling == "strong" else 1
    return dataclasses.replace(found, value=found.value / by, low=found.low / by, high=found.high / by)


def beside_model(work, model):
    return [duration(model.seconds(work)), f"{work.middle() / model.seconds(work):.3g}"]


def efficiencies(measured, model):
    rows = [[NAMES[what], one.scaling, one.ranks, duration(one.middle()), *efficiency_of(measured, one).cells(),
             *(["", ""] if what == "kernel" else beside_model(one, model))]
            for what in NAMES for one in measured.of(what) if one.scaling != "size" and one.threads == 1]
    return ["what", "scaling", "ranks", "time", "efficiency", "95 %", "model's time", "measured by model"], rows, 2


def sizes(measured, model):
    return (["what", "trajectories", "steps", "time", "model's time", "measured by model"],
            [[NAMES[one.what], one.trajectories, one.steps, duration(one.middle()), *beside_model(one, model)]
             for one in measured.times if one.scaling == "size"], 1)


def costs(model):
    rows = []
    for what in ("two-stage", "BAOAB"):
        step, start = model.of_steps[what]
        rows += [[what, "t_step", step.text(1e-9), "ns a trajectory-step"], [what, "t_start", start.text(1e-9), "ns a trajectory"]]
    for what, of, name, none, unit, size in (("data", "data", "t_data", "t_0", "us", 1e-6), ("pass", "pass", "t_pair", "t_0", "us", 1e-6),
                                             ("learn", "learn()", "t_learn", "t_serial", "ms", 1e-3)):
        pair, fixed = model.of_pairs[what]
        rows += [[of, name, pair.text(1e-9), "ns a pair"], [of, none, fixed.text(size), unit]]
    rows.append(["learn()", "N = t_learn/t_pair", f"{model.passes():.3g}", "passes"])
    of_sum, of_memory = dataclasses.astuple(model.reduction), model.memory
    rows += [["one sum", name, Cost(*cost).text(size), unit] for name, cost, unit, size in
             zip(("a", "a'", "b", "beta"), of_sum, ("us", "ns a byte", "us a level", "ns a byte and level"), (1e-6, 1e-9, 1e-6, 1e-9))]
    rows += [["memory", name, cost.text(size), unit] for name, cost, unit, size in
             zip(("c_0", "c_pair", "c_trajectory"), of_memory, ("MB", "B a pair", "B a trajectory"), (1e6, 1.0, 1.0))]
    return ["of", "cost", "value", "unit"], [*rows, ["a rank", "slower", f"{model.slower:.3g}", "all cores busy, against one"]], 2


def reductions(measured, model):
    rows = []
    for one in measured.sums:
        has_cores = one["ranks"] <= one["cores"]
        rows.append([one["ranks"], one["doubles"], *(duration(statistics.median(one[key])) for key in ("seconds", "seconds_90")),
                     duration(model.reduction.seconds(one["ranks"], 8.0 * one["doubles"])) if has_cores else "-",
                     "one a rank" if has_cores else "fewer than ranks"])
    return ["ranks", "doubles", "median", "90 %", "model", "cores"], rows, 0


def memory(measured, model):
    """The largest and the smallest of the ranks, which are printed together."""
    rows, i = [], 0
    while i < len(measured.memory):
        first = measured.memory[i]
        these = measured.memory[i:i + first["ranks"]]
        i += first["ranks"]
        share, sizes_of = max(one["share"] for one in these), [one["bytes"] for one in these]
        rows.append([first["trajectories"], first["steps"], first["ranks"], amount(max(sizes_of)),
                     amount(model.bytes(share * first["steps"], share)), amount(min(sizes_of))])
    return ["trajectories", "pairs of each", "ranks", "most", "model", "least"], rows, 0


def assumptions():
    rows = [["ranks, one a core", RANKS], ["a message between machines takes", duration(LATENCY)],
            ["and for its bytes, one link of", f"{amount(BANDWIDTH)}/s"],
            ["the slowest rank is slower than the median by", f"{100 * SPREAD:.3g} %"],
            ["until all ranks run", duration(START_UP)], ["one rank writes to the shared disk", f"{amount(DISK)}/s"]]
    return ["assumed", "value"], rows, 1


def learning_job(on):
    def total(ranks):
        return on.making_data(JOBS, ranks) + on.learning(JOBS, ranks)

    def started(ranks):
        return total(ranks) + (START_UP if ranks > 1 else 0.0)

    shares = {ranks: largest_share_of(JOBS, ranks) for ranks in (1, RANKS)}
    rows = [["trajectories of the largest share", *(f"{share:.4g}" for share in shares.values())],
            ["memory of a rank", *(amount(on.model.bytes(share * STEPS_OF_LEARNING, share)) for share in shares.values())]]
    rows += [[name, *(duration(seconds(ranks)) for ranks in shares)] for name, seconds in (
        ("making data and held-out data", lambda ranks: on.making_data(JOBS, ranks)),
        ("a pass over the data", lambda ranks: on.a_pass(JOBS, ranks)), ("of it the sum over the ranks", on.sum),
        ("learn()", lambda ranks: on.learning(JOBS, ranks)),
        ("of it what each rank does again", lambda _: on.model.of_pairs["learn"][1].value), ("all, without start-up", total))]
    rows += [["efficiency, without start-up", "1", f"{efficiency(total, RANKS):.3g}"],
             ["efficiency, with it", "1", f"{efficiency(started, RANKS):.3g}"]]
    return ["learning from 10^9 trajectories of 16 steps", "one core", f"{RANKS} cores"], rows, 1


def langevin_job(on):
    def run(ranks):
        return on.run(JOBS, ranks)

    return (["10^6 steps of BAOAB each, sums at 1000 times", "one core", f"{RANKS} cores"],
            [["all steps and sums, without start-up", duration(run(1)), duration(run(RANKS))],
             ["of it sums over the ranks", duration(0.0), duration(LOOKS_OF_RUN * on.sum(RANKS))],
             ["efficiency, without start-up", "1", f"{efficiency(run, RANKS):.3g}"]], 1)


def gathering_job(measured):
    """A row a trajectory, of a number, a time and two observables: what it takes to bring them together."""
    numbers = 32.0  # bytes of four
    rows = [[what, f"{times:g}", f"{one['bytes']:.3g}", amount(one["bytes"] * times * JOBS), duration(numbers * times * JOBS / BANDWIDTH),
             duration(statistics.median(one["seconds"]) * times * JOBS), duration(one["bytes"] * times * JOBS / DISK)]
            for what, one in sorted(measured.rows.items()) for times in (1.0, LOOKS_OF_RUN)]
    return ["10^9 rows at rank 0", "times", "bytes of one", "bytes", "on the way", "made", "to the disk"], rows, 1


def too_many(on):
    return (["trajectories of 16 steps", "a share is a leaf from ... ranks on", "the sum is a tenth of a pass from ... ranks on"],
            [[f"{m:.0e}", -(-m // LEAF), f"{float(on.ranks_of_dear_sums(m)):.2g}"] for m in (10**3, 10**5, 10**7, 10**9)], 0)


def page(measured, model):
    on, lines = Foretold(model), [f"{processor()}, {measured.sums[0]['cores']} cores", ""]

    def add(title, table):
        lines.extend([title, "", markdown(*table)])

    add("Two ranks (? where the machine is too busy to say; then its bare kernel gains less than 1.9, too):", acceptance(measured))
    add("More ranks, for the same work (strong) and for as much a rank (weak); the model knows a single rank:",
        efficiencies(measured, model))
    add("The model's costs, and their standard errors:", costs(model))
    add("The work of one rank that they were fitted to, beside the strong one above:", sizes(measured, model))
    add("One sum over all ranks. With fewer cores than ranks it waits for cores, and is not fitted:", reductions(measured, model))
    add("Peak memory of a rank that learns, data and held-out data of as many trajectories each:", memory(measured, model))
    lines.extend(["## Foretold", ""])
    add("Assumed of a cluster:", assumptions())
    for title, table in (("(a)", learning_job(on)), ("(b)", langevin_job(on)), ("(c)", gathering_job(measured)),
                         ("Too many ranks for a pass:", too_many(on))):
        add(title, table)
    return "\n".join(lines).rstrip() + "\n"


def picture(folder, measured, model):
    """Efficiency against ranks: as measured beside the model, and as the model goes on."""
    curves, on = [], Foretold(model)
    for what in ("BAOAB", "pass"):
        alone = model.seconds(measured.find(what, 1))
        for scaling in ("strong", "weak"):
            work = [one for one in measured.of(what) if (one.scaling, one.threads) == (scaling, 1) and one.ranks > 1]
            ranks, found = [1, *(one.ranks for one in work)], [efficiency_of(measured, one) for one in work]
            curves.append(Curve(f"{what}, {scaling}", ranks, [1, *(e.value for e in found)],
                                [0, *(0.5 * (e.high - e.low) for e in found)]))
            if scaling == "strong":
                curves.append(Curve(f"{what}, {scaling}, model", ranks, [1, *(alone / model.seconds(one) / one.ranks for one in work)],
                                    dashed=True))
    ranks = [2**k for k in range(21)]
    jobs = {"10^6, learn()": lambda r: on.learning(10**6, r), "10^6, pass": lambda r: on.a_pass(10**6, r),
            "10^9, learn()": lambda r: on.learning(JOBS, r), "10^9, pass": lambda r: on.a_pass(JOBS, r),
            "10^9, BAOAB": lambda r: on.run(JOBS, r)}
    foretold = [Curve(label, ranks, [efficiency(seconds, r) for r in ranks]) for label, seconds in jobs.items()]
    return draw(folder / "scaling",
                [Panel("Measured, and the model (dashed)", "ranks: 1, 2, 4, ... and all of the machine", "efficiency", curves, "x", "[0:1.1]"),
                 Panel("Foretold, at fixed trajectories", "ranks", "efficiency", foretold, "x", "[0:1.1]")], 1200, 560)


def write_rows(path, measured):
    """For programs: medians and quartiles."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        to = csv.writer(file, lineterminator="\n")
        to.writerow(["what", "scaling", "ranks", "threads", "trajectories", "steps", "largest_share", "rounds", "median_seconds",
                     "lower_quartile", "upper_quartile"])
        for one in measured.times:
            ordered, n = sorted(one.seconds), len(one.seconds)
            to.writerow([one.what, one.scaling, one.ranks, one.threads, one.trajectories, one.steps, one.largest_share, n,
                         *(f"{x:.6g}" for x in (one.middle(), ordered[n // 4], ordered[3 * n // 4]))])


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: report.py FOLDER")
    folder = pathlib.Path(sys.argv[1])
    try:
        measured = Measured(folder)
        model = Model(measured)
        text = page(measured, model)
    except ValueError as problem:
        sys.exit(f"report.py: {problem}")
    write_rows(folder / "rows.csv", measured)
    (folder / "table.md").write_text(f"# How it scales\n\n{text}", encoding="utf-8")
    print(text, end="")
    if not picture(folder, measured, model):
        print("no picture: gnuplot is not there or failed")


if __name__ == "__main__":
    main()
