#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every command on kinds of K and V: works, or says why it makes no sense.

usage: every_command.py PROGRAM FOLDER [--systems A,B] [--commands A,B]

A cell is `works` (exit code 0), the clause of the refusal (exit code 2 and one line), or `no result` with what was said
(exit code 3). Everything else is a fault: another exit code, a refusal of several lines, none at all, or a time above ten
minutes. Writes every_command.md, and the systems that are no formula as plug-ins. Exit code 1 if there is a fault.
"""
import argparse
import pathlib
import re
import subprocess
import sys

PLUGIN = """#include <cmath>
#include <nysalt/plugin.hpp>
struct {name} {{
  static constexpr int dimension = {n};
{members}}};
NYSALT_SYSTEM({name}, "{text}", starts([](const {name}&, double spread) {{
  nysalt::vector<double, {n}> q, p;
  q << {q};
  p << {p};
  return normal_around<{n}>({{q, p}}, {deviation} * spread, {deviation} * spread);
}}));
"""
OVER_T = "  template <class T> T {name}(const nysalt::vector<T, {n}>& {of}) const {{ using std::exp, std::sqrt, std::cos; return {value}; }}\n"


def plugin(name, text, n, potential, kinetic="", q="0", p="0", deviation=0.1, more=""):
    members = OVER_T.format(name="potential", n=n, of="q", value=potential)
    if kinetic:
        members += OVER_T.format(name="kinetic_energy", n=n, of="p", value=kinetic)
    at = lambda first: ", ".join([first] + ["0"] * (n - 1))
    return PLUGIN.format(name=name, text=text, n=n, members=members + more, q=at(q), p=at(p), deviation=deviation)


# Kinds of K and V, by name: what the page says, and the source of a plug-in or the options of a formula.
MORSE = "(exp(-q[0]) - 1.0) * (exp(-q[0]) - 1.0) + (exp(-q[1]) - 1.0) * (exp(-q[1]) - 1.0)"
FORMULA = lambda text, variables="x", *more: ["--potential", text, "--variables", variables, *more]
KINDS = {
    "quadratic": ("K = p^2/2m, V of a pendulum with masses", FORMULA("-cos(x) + y^2", "x,y", "--mass", "1,3")),
    "cross_terms": ("K = p1^2 + p2^2 - p1 p2, Morse bonds",
                    plugin("cross_terms", "bonds", 2, MORSE, "p[0] * p[0] + p[1] * p[1] - p[0] * p[1]")),
    "exponential": ("K = e^p - p, V = e^q - q: Lotka and Volterra",
                    plugin("exponential", "prey", 1, "exp(q[0]) - q[0]", "exp(p[0]) - p[0]")),
    "relativistic": ("K = sqrt(1 + p^2)", plugin("relativistic", "fast", 1, "q[0] * q[0] * 0.5",
                                                  "sqrt(p[0] * p[0] + 1.0)", deviation=0.5)),
    "lattice": ("K = -cos p, V = q^2/2: a band", plugin("lattice", "band", 1, "q[0] * q[0] * 0.5", "cos(p[0]) * -1.0")),
    "time_as_coordinate": ("V(q, t), with the time as a coordinate", """#include <cmath>
#include <nysalt/plugin.hpp>
#include <nysalt/systems/in_time.hpp>
struct swing {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q, const T& t) const {
    using std::cos;
    return cos(q[0]) * (cos(t * 0.7) * 0.3 + 1.0) * -1.0;
  }
};
using time_as_coordinate = nysalt::in_time<swing>;
NYSALT_SYSTEM(time_as_coordinate, "a swing", starts([](const time_as_coordinate&, double spread) {
  const nysalt::vector<double, 2> zero = nysalt::vector<double, 2>::Zero();
  return normal_around<2>({zero, zero}, 0.1 * spread, 0.1 * spread);
}));
"""),
    "constant_force": ("V = 9.81 z", FORMULA("9.81*x")),
    "free": ("V = 0", FORMULA("0*x")),
    "cusp": ("V = abs(x)", FORMULA("abs(x)")),
    "unbounded": ("V = x^2/2 - x^3/3, open above 1/6", FORMULA("x^2/2 - x^3/3")),
    "singular": ("V = -1/r, an ellipse", FORMULA("-1/sqrt(x^2 + y^2)", "x,y", "--around", "x=1", "--parameter",
                                                 "deviation_q=0.01,deviation_p=0.01", "--at", "x=1;py=0.9", "--spread", "0.01")),
    "wall": ("V = max(0, x)^2 + y^2, flat on one side", FORMULA("max(0, x)^2 + y^2", "x,y")),
    "stiff": ("V of frequencies 1 and 300", FORMULA("x^2/2 + 45000*(y - x^2/10)^2", "x,y")),
    "heavy": ("masses of 1e-3 and 1e6", FORMULA("x^2 + y^2 + 0.1*x*y", "x,y", "--mass", "1e-3,1e6")),
}
COMMANDS = {
    "run": ["run", "--method", "verlet", "--step", "0.05", "--horizon", "1"],
    "run of order 6": ["run", "--method", "blanes_moan_s10", "--step", "0.05", "--horizon", "1"],
    "run in a bath": ["run", "--method", "baoab", "--step", "0.05", "--horizon", "1", "--friction", "1", "--temperature", "0.1"],
    "stability": ["stability", "--method", "verlet", "--step", "0.05"],
    "learn": ["learn", "--family", "bab3", "--step", "0.1", "--trajectories", "16", "--effort", "quick"],
    "compare": ["compare", "--steps", "0.05", "--horizon", "2", "--trajectories", "4"],
    "compare states": ["compare", "--methods", "verlet,pefrl,blanes_moan_s10,learned:bab3", "--steps", "0.05", "--horizon", "2",
                       "--trajectories", "4", "--learn-trajectories", "8", "--metric", "state"],
    "recommend": ["recommend", "--error", "1e-3", "--horizon", "2", "--families", "bab3", "--trajectories", "4",
                  "--learn-trajectories", "8"],
    "sample": ["sample", "--length", "1", "--chains", "4", "--draws", "50"],
}


def outcome(program, options, folder):
    """What a cell says, and whether that is a fault."""
    try:
        done = subprocess.run([program, *options], capture_output=True, text=True, timeout=600, cwd=folder, check=False)
    except subprocess.TimeoutExpired:
        return "no answer in 10 minutes", True
    said = [line for line in done.stderr.strip().splitlines() if not line.startswith("nysalt: warning")]
    if done.returncode == 0:
        return "works", False
    if done.returncode == 2:
        return (said or ["nothing said"])[-1].removeprefix("nysalt: "), len(said) != 1
    last = (done.stderr.strip().splitlines() or ["nothing said"])[-1]
    return "no result: " + last.removeprefix("nysalt: "), done.returncode != 3 or not done.stderr.strip()


PAGE = """# Every command on every kind of system

w: works, with exit code 0 (`sample` says beside it whether its chains agree, which they do not where there is no distribution); a number:
the answer below, in one line. K is sum p^2/2m unless it is said. Made by

```sh
bench/studies/soundness/every_command.py build/release/nysalt build/every_command
```

"""


def write_page(path, rows):
    """The table of rows (system, command, answer, whether that is a fault)."""
    own = r"(the system )?\b({0}\(\)|{0}|swing in time|given_potential\([^;]*; [a-z,]*\))"
    plain = lambda name, said: re.sub(own.format(name), "the system", said).replace("the system: the system", "the system")
    rows = [(name, command, plain(name, said)) for name, command, said, _ in rows]
    notes = list(dict.fromkeys(said for *_, said in rows if said != "works"))
    commands = list(dict.fromkeys(command for _, command, _ in rows))
    with open(path, "w", encoding="utf-8") as file:
        file.write(PAGE)
        print("| " + " | ".join(["system", *commands]) + " |\n|" + "---|" * (len(commands) + 1), file=file)
        for name in dict.fromkeys(name for name, *_ in rows):
            cells = ["w" if said == "works" else str(notes.index(said) + 1) for who, _, said in rows if who == name]
            print("| " + " | ".join([KINDS[name][0], *cells]) + " |", file=file)
        print(file=file)
        for number, said in enumerate(notes, 1):
            print(f"{number}. {said}", file=file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--systems", default=",".join(KINDS))
    parser.add_argument("--commands", default=",".join(COMMANDS))
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    rows = []
    faults = 0
    for name in asked.systems.split(","):
        _, source = KINDS[name]
        system = source
        if isinstance(source, str):
            (asked.folder / f"{name}.hpp").write_text(source, encoding="utf-8")
            system = ["--system", f"./{name}.hpp"]
        for command in asked.commands.split(","):
            said, is_fault = outcome(asked.program.resolve(), [*COMMANDS[command], *system], asked.folder)
            faults += is_fault
            rows.append((name, command, said, is_fault))
            print(f"{name:20} {command:16} {'FAULT ' if is_fault else ''}{said}", flush=True)
    write_page(asked.folder / "every_command.md", rows)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
