#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What the races say of the library's speed: table.md, ratios.json and performance.svg.

usage: ratios.py FOLDER, which holds g++.*.json and clang++.*.json of the races
"""
import dataclasses
import json
import math
import pathlib
import statistics
import sys
from typing import Optional, Tuple

from pages import draw_script, markdown, processor


class Measurements:
    """Nanoseconds for a unit of work, by race and runner, one for each round; the rounds of a race are those of all its runners."""

    def __init__(self):
        self.races, self.failures, self.context = {}, {}, {}

    def add(self, document):
        """A document of google-benchmark: one round is one repetition, with a counter "ns/RUNNER" for each. Throws ValueError if
        it is none."""
        if not isinstance(document, dict) or "benchmarks" not in document:
            raise ValueError("not what the races write: no benchmarks")
        self.context = document.get("context", {})
        for entry in document["benchmarks"]:
            if entry.get("run_type", "iteration") != "iteration":
                continue  # means and medians of theirs
            name = entry.get("name", "").split("/")[0]
            if entry.get("error_occurred"):
                self.failures[name] = entry.get("error_message", "no reason given")
                continue
            race = self.races.setdefault(name, {})
            for key, value in entry.items():
                if not key.startswith("ns/"):
                    continue
                if not isinstance(value, (int, float)) or not 0 < value < math.inf:
                    raise ValueError(f"not what the races write: {key} of {entry['name']} is no time")
                race.setdefault(key[3:], []).append(value)
        for name, race in self.races.items():
            rounds = max(map(len, race.values()), default=0)
            for runner, times in race.items():
                if len(times) != rounds:
                    raise ValueError(f"not what the races write: {runner} missed a round of {name}")
            if not race:
                raise ValueError(f"not what the races write: nobody ran in {name}")

    @classmethod
    def of_compiler(cls, folder, compiler):
        """All COMPILER.*.json of the folder: one for each time that the program was run."""
        paths = sorted(pathlib.Path(folder).glob(f"{compiler}.*.json"))
        if not paths:
            raise ValueError(f"no {compiler}.*.json in {folder}: run ./dev bench")
        result = cls()
        for path in paths:
            try:
                result.add(json.loads(path.read_text(encoding="utf-8")))
            except json.JSONDecodeError:
                raise ValueError(f"{path} holds no JSON document") from None
        return result

    def has(self, race, *runners):
        return all(runner in self.races.get(race, {}) for runner in runners)

    def times(self, race, runner):
        if self.has(race, runner):
            return self.races[race][runner]
        if race in self.failures:
            raise ValueError(f"the race '{race}' failed: {self.failures[race]}")
        raise ValueError(f"nobody called '{runner}' was measured in the race '{race}'")

    def median(self, race, runner):
        return statistics.median(self.times(race, runner))


@dataclasses.dataclass
class Ratio:
    """The median of paired ratios; it is between low and high with a confidence of 95 %. The spread is the distance of the
    quartiles, relative to the median."""
    value: float
    low: float
    high: float
    spread: float
    least: float
    largest: float
    pairs: int

    def cells(self):
        return [f"{self.value:.3g}", self.interval()]

    def interval(self):
        return f"{self.low:.3g} - {self.high:.3g}"

    def document(self):
        return {"value": self.value, "interval": [self.low, self.high], "spread": self.spread, "pairs": self.pairs}


def paired_ratio(over, under):
    """Of over[i]/under[i], each pair from one round."""
    if len(over) != len(under) or not over:
        raise ValueError("a ratio needs pairs")
    r, n = sorted(a / b for a, b in zip(over, under)), len(over)
    # How many of n lie below the median is binomial: n/2 +- 1.96 sqrt(n)/2, whatever their distribution.
    j = max(math.floor(0.5 * (n - 1.96 * math.sqrt(n))) - 1, 0)
    middle = statistics.median(r)
    return Ratio(middle, r[j], r[-1 - j], (r[3 * n // 4] - r[n // 4]) / middle, r[0], r[-1], n)


LARGEST_SPREAD = 0.2  # beyond this the median of what should be one number says little


def verdict(found, at_least, bound):
    """Whether a ratio is at least or at most so much, if the whole interval is on one side; where the spread is too large, every
    pair must be. Else None, with the reason."""
    def met(value):
        return value >= bound if at_least else value <= bound
    if found.spread > LARGEST_SPREAD and met(found.least) != met(found.largest):
        return None, (f"too noisy: the quartiles of {found.pairs} pairs are {100 * found.spread:.0f} % apart, and the pairs on both "
                      "sides of the target")
    if met(found.low) != met(found.high):
        return None, f"too noisy: the median of {found.pairs} pairs is between {found.low:.4g} and {found.high:.4g}"
    return met(found.value), ""


@dataclasses.dataclass
class Row:
    """Who is compared with whom, the fastest of `against`. speed: their time over ours, at least the bound; else our time over
    theirs, at most. No bound: only reported. premise: (subject, against, at least, reason) of a kernel that certainly can show
    what is asked; where it cannot, the machine is to blame."""
    name: str
    race: str
    subject: str
    against: Tuple[str, ...]
    bound: Optional[float] = None
    speed: bool = True
    premise: Optional[tuple] = None
    note: str = ""

    def ratio(self, of):
        ours, theirs = of.times(self.race, self.subject), of.times(self.race, self.fastest(of))
        return paired_ratio(theirs, ours) if self.speed else paired_ratio(ours, theirs)

    def fastest(self, of):
        return min(self.against, key=lambda one: of.median(self.race, one))


class Judged:
    """A row of g++, beside that of clang++ where it ran."""

    def __init__(self, row, gnu, clang=None):
        self.row, self.against, self.found = row, row.fastest(gnu), row.ratio(gnu)
        self.subject_ns, self.against_ns = gnu.median(row.race, row.subject), gnu.median(row.race, self.against)
        self.beside = row.ratio(clang) if clang and clang.has(row.race, row.subject, *row.against) else None
        self.holds, self.reason = None, ""
        if row.bound is None:
            return
        self.holds, self.reason = verdict(self.found, row.speed, row.bound)
        if row.premise and self.holds is not True:
            subject, against, at_least, otherwise = row.premise
            can = paired_ratio(gnu.times(row.race, against), gnu.times(row.race, subject))
            if can.value < at_least:
                self.holds, self.reason = None, f"{otherwise} ({can.value:.3g} of at least {at_least:g})"

    def relation(self):
        return ">=" if self.row.speed else "<="

    def document(self):
        row, result = self.row, {"name": self.row.name, **self.found.document()}
        if row.bound is not None:
            result.update(target=row.bound, relation=self.relation(), holds=self.holds)
            if self.holds is None:
                result["reason"] = self.reason
        result.update(compiler="g++", race=row.race, subject={"name": row.subject, "ns": self.subject_ns},
                      against={"name": self.against, "ns": self.against_ns})
        if row.note:
            result["note"] = row.note
        if self.beside:
            result["clang++"] = self.beside.document()
        return result

    def cells(self):
        asked = ["", ""]
        if self.row.bound is not None:
            asked = [f"{self.relation()} {self.row.bound:g}", {None: "?", True: "yes", False: "NO"}[self.holds]]
        return [self.row.name, *asked, *self.found.cells(), *(self.beside.cells() if self.beside else ["-", "-"])]

    def margins(self):
        """How far the ratios are on the good side of the target: 1 is just met."""
        return [math.nan if r is None else r.value / self.row.bound if self.row.speed else self.row.bound / r.value
                for r in (self.found, self.beside)]


COLUMNS = ["what", "target", "holds", "g++", "95 %", "clang++", "95 %"]


def asked_rows():
    """Peers and ours with the same flags, contraction off. What fusing changes stands in rows without a target."""
    normal = ("std::normal_distribution", "std::normal_distribution, splitmix64")
    ziggurat = ("Boost's ziggurat", "Boost's ziggurat, splitmix64")
    quiet = ("kernel, two threads", "kernel, one thread", 1.9,
             "the machine is not quiet: two threads of a kernel that shares nothing gain too little")
    rows = [Row("ensemble, two-stage: speed of its mix of operations", "ensemble", "ours", ("same mix",), 0.80),
            Row("ensemble: time of a hand-written kernel", "ensemble", "ours", ("hand-written",), 1.05, False),
            Row("ensemble: speed-up over Boost.Odeint", "ensemble", "ours", ("odeint arrays",), 7.0),
            Row("ensemble: speed-up over Boost.Odeint with packs", "ensemble", "ours", ("odeint packs",), 1.25),
            Row("one trajectory, Verlet: time of Boost.Odeint", "single trajectory", "ours",
                ("odeint velocity_verlet", "odeint Nystrom stepper"), 0.9, False),
            Row("noise: speed-up over std::normal_distribution", "noise", "ours", normal, 4.5),
            Row("noise: speed-up over Boost's ziggurat", "noise", "ours", ziggurat, 1.8),
            Row("BAOAB in lanes: speed-up over std::normal_distribution", "langevin", "ours", normal, 5.5),
            Row("BAOAB in lanes: speed-up over Boost's ziggurat", "langevin", "ours", ziggurat, 2.2),
            Row("learner, 10^5 samples: speed-up over a block for each", "learning", "compressed", ("block per sample",), 10.0),
            Row("learner, a pass over 10^5 pairs: time of its arithmetic", "learning pass", "pass", ("same number of operations",),
                1.3, False),
            Row("chain of 1000 masses: time of the textbook's loop", "long chain", "ours", ("textbook",), 0.6, False),
            Row("two threads: speed-up over one", "threads", "two threads", ("one thread",), 1.8, premise=quiet)]
    for n in (6, 7):
        chain = f"one chain of 10^{n}"
        rows += [Row(f"{chain} masses: speed-up over the textbook's loop", chain, "one thread", ("textbook",), 2.0),
                 Row(f"{chain} masses, two threads: speed-up over one", chain, "two threads", ("one thread",), 1.8)]
    return rows + [Row(f"by the library, {name}: time of the typed system", race, "ours, by the library", ("ours",), bound, False)
                   for name, race, bound in (("ensemble", "ensemble", 1.15), ("BAOAB in lanes", "langevin", 1.1),
                                             ("one trajectory", "single trajectory", 1.3))]


def told_rows():
    """Rows as (name, race, subject, against...)."""
    speeds = [(f"moving the data of 10^{n} masses, two threads: speed-up over one", f"one chain of 10^{n}",
               "moving the data, two threads", "moving the data, one thread") for n in (6, 7)] + [
        ("ensemble: share of the peak of fused multiply-adds", "ensemble", "ours", "fused multiply-adds"),
        ("ensemble, ours fused: the same share", "ensemble", "ours, fused", "fused multiply-adds"),
        ("ensemble, both fused: speed-up over Boost.Odeint", "ensemble", "ours, fused", "odeint arrays, fused"),
        ("ensemble, both fused: speed-up over Boost.Odeint with packs", "ensemble", "ours, fused", "odeint packs, fused"),
        ("ensemble, only they fused: speed-up over Boost.Odeint", "ensemble", "ours", "odeint arrays, fused"),
        ("ensemble, only they fused: speed-up over Boost.Odeint with packs", "ensemble", "ours", "odeint packs, fused"),
        ("ensemble: speed-up over Boost.Odeint, steps merged by hand", "ensemble", "ours", "odeint arrays, merged"),
        ("ensemble: speed-up over Boost.Odeint with packs, steps merged by hand", "ensemble", "ours", "odeint packs, merged"),
        ("liquid of 32000 atoms, two threads: speed-up over one", "liquid on threads", "two threads", "one thread"),
        ("beside it a kernel that shares nothing, two threads: speed-up over one", "liquid on threads", "kernel, two threads",
         "kernel, one thread")]
    times = [
        ("ensemble: time of a hand-written kernel, constants folded", "ensemble", "ours", "hand-written, folded"),
        ("ensemble, both fused: time of a hand-written kernel", "ensemble", "ours, fused", "hand-written, fused",
         "hand-written, folded, fused"),
        ("one trajectory, only they fused: time of Boost.Odeint", "single trajectory", "ours", "odeint velocity_verlet, fused",
         "odeint Nystrom stepper, fused"),
        ("chain of 1000 masses, only they fused: time of the textbook's loop", "long chain", "ours", "textbook, fused"),
        ("learner, a pass over 10^5 pairs: time of reading the data alone", "learning pass", "pass", "reading the data alone"),
        ("liquid of 4000 atoms: time of LAMMPS", "liquid", "ours, 4000 atoms", "LAMMPS, 4000 atoms"),
        ("liquid of 32000 atoms: time of LAMMPS", "liquid", "ours, 32000 atoms", "LAMMPS, 32000 atoms"),
        ("BAOAB in lanes: share of its noise alone", "langevin", "noise alone", "ours"),
        ("two-stage in a bath, O symmetric: time of the step with none", "langevin", "two-stage, O symmetric", "two-stage, no bath"),
        ("two-stage in a bath, O symmetric: time of O at the end", "langevin", "two-stage, O symmetric", "two-stage, O at the end"),
        ("compiling a first example, time with the learner against without", "compiling", "with learner", "without learner"),
        *((f"{race}, {word}, by the library: time of the typed system", race, f"{word}, by the library", word)
          for race in ("words, one trajectory", "words, lanes") for word in ("A B", "A B, eleven stages", "G", "R S", "O"))]
    return [Row(name, race, subject, tuple(against), speed=rows is speeds)
            for rows in (speeds, times) for name, race, subject, *against in rows]


@dataclasses.dataclass
class Growth:
    """Sizes of an ensemble or a chain, from small to large, and what streaming as many bytes takes: the runner `stream` SIZE, with
    `unit` bytes of a unit of the size. No stream: never memory bound."""
    name: str
    race: str
    sizes: Tuple[str, ...]
    stream: str = ""
    unit: float = 0.0

    def row(self, of):
        """The largest cost of a unit of work relative to that of the smallest size, up to where memory bounds it: the first size at
        which moving the data alone takes as long as the whole step of the smallest size."""
        first = self.sizes[0]
        subject, largest, note = first, 0.0, f"no memory bound up to {self.sizes[-1]}"
        for size in self.sizes[1:]:
            if self.stream and of.median(self.race, self.stream + size) >= of.median(self.race, first):
                note = f"memory bound from {size} on, where the state takes {float(size) * self.unit / 1024:.0f} kB"
                break
            if of.median(self.race, size) > largest:
                subject, largest = size, of.median(self.race, size)
        return Row(self.name, self.race, subject, (first,), 1.3, False, note=note)

    def table(self, gnu, clang):
        def number(of, runner):
            return f"{of.median(self.race, runner):.3g}" if of.has(self.race, runner) else "-"
        return markdown(["size", "g++", "clang++", "moving the data alone"],
                        [[size, number(gnu, size), number(clang, size), number(gnu, self.stream + size) if self.stream else "-"]
                         for size in self.sizes], 0)


GROWTHS = (Growth("cost of a trajectory-step, 10^3 to 10^6 trajectories", "growing ensemble", ("1000", "10000", "100000", "1000000")),
           Growth("cost of a mass-step, 10^3 masses to where memory bounds it", "growing chain",
                  ("1000", "3000", "10000", "30000", "100000", "300000", "1000000"), "stream ", 16.0))


def heaviest_run(gnu, clang):
    """Seconds that the heaviest run of [li_lu_tao_ye_2023] takes, and the same with learned steps."""
    rows = []
    for run in ("BAOAB, step .0001", "learned, O at the end, step .019", "learned, O symmetric, step .019"):
        for threads in ("one", "two"):
            race = f"heaviest run, {threads} thread{'s' if threads == 'two' else ''}"
            rows.append([run, threads, *(f"{1e-9 * of.median(race, run):.3g}" if of.has(race, run) else "-" for of in (gnu, clang))])
    return markdown(["seconds", "threads", "g++", "clang++"], rows, 1)


def machine(gnu, clang):
    return {"processor": processor(), "cores": gnu.context.get("num_cpus", 0),
            **{key: int(gnu.context.get(key, "0")) for key in ("l1_bytes", "l2_bytes", "l3_bytes")},
            "compilers": [f"{of.context.get('compiler', 'unknown')} {of.context.get('flags', '')}" for of in (gnu, clang)]}


def page(asked, told, gnu, clang):
    facts = machine(gnu, clang)
    caches = [facts[key] // 1024 for key in ("l1_bytes", "l2_bytes", "l3_bytes")]
    remarks = [f"- {one.row.name}: {text}" for one in asked for text in (one.reason, one.row.note) if text]
    remarks += [f"- the race '{race}' failed: {why}" for of in (gnu, clang) for race, why in of.failures.items()]
    lines = [f"{facts['processor']}, {facts['cores']} cores; caches of {caches[0]} kB, {caches[1]} kB and {caches[2]} kB",
             *facts["compilers"], "", markdown(COLUMNS, [one.cells() for one in asked]), *remarks, "", "Reported without a target:", "",
             markdown(COLUMNS, [one.cells() for one in told])]
    for growth in GROWTHS:
        lines += [f"{growth.name}, nanoseconds:", "", growth.table(gnu, clang)]
    lines += ["The heaviest run of the paper, 10^4 trajectories in a bath over a time of 40:", "", heaviest_run(gnu, clang)]
    if gnu.has("compiling", "with learner"):
        seconds = [1e-9 * gnu.median("compiling", name) for name in ("with learner", "without learner")]
        lines += [f"Compiling a first example takes g++ {seconds[0]:.1f} s with the learner, {seconds[1]:.1f} s without."]
    return "\n".join(lines).rstrip() + "\n"


def picture(folder, asked, gnu, clang):
    """Bars under the roof, the kernel with the same mix of operations, and ratios against their targets; bars lie, so that long
    names can be read, two a place, one for each compiler."""
    shares = [(name, *(paired_ratio(of.times("ensemble", "same mix"), of.times("ensemble", name)).value for of in (gnu, clang)))
              for name in ("ours", "hand-written", "odeint packs", "odeint arrays")]
    margins = [(one.row.name + (" (?)" if one.holds is None else ""), *one.margins()) for one in asked]
    script = ("set datafile missing 'nan'\nset yrange [*:*] reverse\nset offsets 0,0,0.7,0.7\nset ytics scale 0\nset lmargin 54\n"
              "set key outside right top\nset rmargin 18\n"
              "set arrow 1 from first 1, graph 0 to first 1, graph 1 nohead lw 2 lc '#D55E00' front\n")
    for name, bars in (("shares", shares), ("margins", margins)):
        script += f"${name} << end\n" + "".join(f"{i} \"{label}\" {a:.5g} {b:.5g}\n" for i, (label, a, b) in enumerate(bars)) + "end\n"
    script += "set multiplot\n"
    for name, title, place, start in (
            ("shares", "Speed of a two-stage step on an ensemble: 1 is the roof",
             "set origin 0,0.66\nset size 1,0.34\nset xrange [0:1.1]", 0),
            ("margins", "Beyond its target (right of the line) or short of it, by which factor",
             "set origin 0,0\nset size 1,0.66\nset logscale x 2\nset xrange [0.25:8]", 1)):
        bars = ", ".join(f"${name} using ({start}):($1{shift:+}):({start}):{column}:($1{shift:+}-0.18):($1{shift:+}+0.18) with boxxyerror "
                         f"fs solid lc '{colour}' title '{compiler}'" for column, shift, colour, compiler in
                         ((3, -0.18, "#0072B2", "g++"), (4, 0.18, "#E69F00", "clang++")))
        script += f"set title '{title}'\n{place}\nplot {bars}, ${name} using ({start}):1:ytic(2) with dots lc 'white' notitle\n"
    return draw_script(folder / "performance", script, 1000, 800)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: ratios.py FOLDER")
    folder = pathlib.Path(sys.argv[1])
    try:
        gnu, clang = (Measurements.of_compiler(folder, name) for name in ("g++", "clang++"))
        asked = [Judged(row, gnu, clang) for row in (*asked_rows(), *(growth.row(gnu) for growth in GROWTHS))]
        told = [Judged(row, gnu, clang) for row in told_rows() if gnu.has(row.race, row.subject, *row.against)]
        times = {race: {runner: {name: of.median(race, runner) for name, of in (("g++", gnu), ("clang++", clang))
                                 if of.has(race, runner)} for runner in runners} for race, runners in gnu.races.items()}
        document = {"machine": machine(gnu, clang), "ratios": [one.document() for one in asked],
                    "reported": [one.document() for one in told], "nanoseconds": times}
        (folder / "ratios.json").write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
        (folder / "table.md").write_text(page(asked, told, gnu, clang), encoding="utf-8")
        print(page(asked, told, gnu, clang), end="")
        if not picture(folder, asked, gnu, clang):
            print("no picture: gnuplot is not there or failed")
    except ValueError as problem:
        sys.exit(f"ratios.py: {problem}")


if __name__ == "__main__":
    main()
