#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Processor time of a step of `nysalt run` and `nysalt compare`, over that of a loop of types that does the same.

usage: bench/program/against_types.py PROGRAM TYPED_LOOP [ROUNDS]

A command is timed by the processor time that it had, at two numbers of steps; the difference is that of the steps alone.
Both must end at the same energies, to all printed digits. Rounds of all rows are interleaved.
"""
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from ratios import paired_ratio  # noqa: E402

PLUGIN = pathlib.Path(__file__).resolve().parents[2] / "examples/plugins/toda.hpp"
TRAJECTORIES = 64
TRIED = 25_000  # steps beyond which a trial run before the run takes no longer
SYSTEMS = {  # name: options of the program, step, evaluations of some .3 s, where these are enough
    "fpu": (["--system", "fpu"], 0.01, 6_000_000),
    "henon_heiles": (["--system", "henon_heiles"], 0.1, 8_000_000),
    "phi4": (["--system", "phi4"], 0.05, 1_200_000),
    "toda": (["--system", str(PLUGIN)], 0.05, 40_000),
}
METHODS = {"verlet": 1, "mclachlan2": 2, "srkn6b": 6}  # evaluations a step


def processor_seconds(command):
    """Processor time of the command, and what it printed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout.decode())


class Row:
    def __init__(self, program, loop, system, method, folder):
        options, self.step, steps = SYSTEMS[system]
        self.name, self.method, self.program, self.options = system, method, program, options
        self.steps = max(steps // METHODS[method], TRIED)
        self.output = folder / f"{system}.{method}.csv"
        self.run = lambda n: [program, "run", *options, "--method", method, "--step", str(self.step), "--horizon",
                              repr(n * self.step), "--sample-every", str(n), "--trajectories", str(TRAJECTORIES),
                              "--observables", "energy", "--threads", "1", "--output", str(self.output)]
        self.loop = lambda n: [loop, system, method, str(self.step), str(TRAJECTORIES), str(n)]
        self.ratios, self.nanoseconds, self.compared = [], [], []

    def of_step(self, command):
        n = self.steps
        seconds = processor_seconds(command(2 * n))[0] - processor_seconds(command(n))[0]
        return 1e9 * seconds / (n * TRAJECTORIES)

    def require_same_end(self):
        n = 1000
        processor_seconds(self.run(n))
        lines = [line for line in self.output.read_text().splitlines() if line and not line.startswith("#")]
        energy = lines[0].split(",").index("energy")
        t = lines[0].split(",").index("t")
        ends = [float(line.split(",")[energy]) for line in lines[1:] if float(line.split(",")[t]) > 0]
        theirs = [float(line) for line in processor_seconds(self.loop(n))[1].split()]
        if ends != theirs or len(ends) != TRAJECTORIES:
            sys.exit(f"against_types.py: {self.name}, {self.method}: the ends differ: {ends[:3]} and {theirs[:3]}")

    def race(self, in_order):
        if in_order:
            ours, theirs = self.of_step(self.run), self.of_step(self.loop)
        else:
            theirs, ours = self.of_step(self.loop), self.of_step(self.run)
        self.ratios.append(ours / theirs)
        self.nanoseconds.append(theirs)

    def compare(self):
        """Seconds as `nysalt compare` says them."""
        horizon = str(64 * self.step)
        text = processor_seconds([self.program, "compare", *self.options, "--methods", self.method, "--steps",
                                  str(self.step), "--horizon", horizon, "--metric", "energy", "--trajectories", "64",
                                  "--threads", "1", "--json"])[1]
        row = json.loads(text)["rows"][0]
        self.compared.append(1e9 * row["seconds_per_time"] * row["step_size"])


def interval(values):
    found = paired_ratio(values, [1.0] * len(values))
    return f"{found.value:.3f} ({found.low:.3f} to {found.high:.3f})"


def main():
    program, loop = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:3])
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 9
    with tempfile.TemporaryDirectory() as folder:
        rows = [Row(program, loop, system, method, pathlib.Path(folder)) for system in SYSTEMS for method in METHODS]
        for row in rows:
            row.require_same_end()
        for n in range(rounds):
            for row in rows:
                row.race(n % 2 == 0)
                row.compare()
    print("| system | method | ns a step of the typed loop | run, over it | compare, over it |\n|---|---|---|---|---|")
    for row in rows:
        compared = [ours / theirs for ours, theirs in zip(row.compared, row.nanoseconds)]
        print(f"| {row.name} | {row.method} | {statistics.median(row.nanoseconds):.3g} | {interval(row.ratios)} | "
              f"{interval(compared)} |")
    worst = max(statistics.median(row.ratios) for row in rows)
    print(f"\nWorst of run: {worst:.3f}, {rounds} rounds, {TRAJECTORIES} trajectories, one thread.")


if __name__ == "__main__":
    main()
