#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Where trajectories in a bath begin: in the Gibbs distribution where there is one, else at the usual starts, with the reason.

usage: starts_in_bath.py PROGRAM FOLDER [--temperatures A,B]

There is a Gibbs distribution if the integral of exp(-V/kT) is finite. It is claimed where the starts of `run` are drawn
from it. Claimed where there is none it is a false promise, not found where there is one a loss that is said: both are
faults here. Writes starts_in_bath.md. Exit code 1 if there is a fault.
"""
import argparse
import json
import pathlib
import subprocess
import sys

# V, its variables, and whether exp(-V/kT) has a finite integral: at any kT, at none, or below this one. FLAT: but for a
# direction along which V does not change or repeats itself, as the centre of mass; the rest has a distribution.
FLAT = "but for a flat direction"


class Well:
    """An open well of this depth. Chains stay in it for some e^depth/kT of its periods: a distribution of its own from
    ten kT on; none below three; between them either answer is right."""

    def __init__(self, depth):
        self.depth = depth

    def __str__(self):
        return f"an open well, {self.depth:.3g} deep"


POTENTIALS = [
    ("x^2/2", "x", True),
    ("x^4", "x", True),
    ("1e-6*x^4", "x", True),
    ("25*x^4", "x", True),
    ("abs(x)", "x", True),
    ("1e4*x^2/2", "x", True),
    ("(x^2 - 1)^2", "x", True),
    ("x^2/2 + y^2/2 + x*y/2", "x,y", True),
    ("x^2/2 + 50*(y - x^2/10)^2", "x,y", True),
    ("x^2/2 + 2*cos(5*x)", "x", True),
    ("exp(x) - x", "x", True),
    ("x + exp(-x)", "x", True),
    ("cosh(x)", "x", True),
    ("(1 - exp(-x))^2 + 0.01*x^2", "x", True),
    ("sqrt(1 + x^2)", "x", True),
    ("x^2/2 + y^4 + z^6", "x,y,z", True),
    ("0*x", "x", False),
    ("9.81*x", "x", False),
    ("x^3", "x", False),
    ("x^2/2 - x^3/3", "x", Well(1 / 6)),
    ("x^2/2 - x^4", "x", Well(1 / 16)),
    ("-x^2/2", "x", False),
    ("exp(x)", "x", False),
    ("-1/sqrt(x^2 + 0.01)", "x", Well(10.0)),
    ("(1 - exp(-x))^2", "x", Well(1.0)),
    ("max(0, x)^2", "x", False),
    ("max(0, x)^2 + y^2/2", "x,y", False),
    ("max(0, x)^2 + max(0, y)^4", "x,y", False),
    ("max(0, x - y)^2 + y^2/2", "x,y", False),
    ("exp(x) + y^2/2", "x,y", False),
    ("x^2/2 + 0*y", "x,y", FLAT),
    ("x^2/2 + y", "x,y", False),
    ("(x - y)^2/2", "x,y", FLAT),
    ("-cos(x)", "x", FLAT),
    ("-cos(x) - cos(y - x)", "x,y", FLAT),
    ("-exp(-x^2)", "x", Well(1.0)),
    ("log(1 + x^2)/100", "x", 0.02),
    ("log(1 + x^2)/2", "x", 1.0),
]

PAGE = """# Where trajectories in a bath begin

g: in the Gibbs distribution, which pilots found; u: at the usual starts, with a warning that says why. "Exists": exp(-V/kT) has a finite
integral. K is p^2/2. A cell with ! is a fault. Made by

```sh
bench/studies/soundness/starts_in_bath.py build/release/nysalt build/starts_in_bath
```

"""


def right_at(exists, temperature):
    """The answers that are right."""
    if isinstance(exists, Well):
        return ["g"] * (temperature < exists.depth / 3) + ["u"] * (temperature >= exists.depth / 10)
    if isinstance(exists, float):
        return ["g" if temperature < exists else "u"]
    return ["g" if exists else "u"]


def begins(program, text, variables, temperature):
    """g, u or what else the program answered."""
    done = subprocess.run([program, "run", "--potential", text, "--variables", variables, "--friction", "1",
                           "--temperature", str(temperature), "--method", "baoab", "--step", "0.001", "--horizon", "0.002",
                           "--trajectories", "2", "--no-checks", "--json"], capture_output=True, text=True, check=False)
    try:
        document = json.loads(done.stdout)
    except json.JSONDecodeError:
        return (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    is_said = any("not in the Gibbs distribution" in text for text in document["warnings"])
    if document["starts"].startswith("gibbs"):
        return "g and said not to be" if is_said else "g"
    return "u" if is_said else f"unsaid: {document['starts']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--temperatures", default="0.01,0.1,1,10")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    temperatures = asked.temperatures.split(",")
    faults = 0
    with open(asked.folder / "starts_in_bath.md", "w", encoding="utf-8") as page:
        page.write(PAGE)
        print("| V | exists | " + " | ".join(f"kT = {one}" for one in temperatures) + " |", file=page)
        print("|---|---|" + "---|" * len(temperatures), file=page)
        for text, variables, exists in POTENTIALS:
            found = [begins(asked.program.resolve(), text, variables, one) for one in temperatures]
            cells = [one if one in right_at(exists, float(kT)) else f"{one} !" for one, kT in zip(found, temperatures)]
            wrong = sum(cell.endswith("!") for cell in cells)
            faults += wrong
            says = ("yes" if exists else "no") if isinstance(exists, bool) else str(exists)
            if isinstance(exists, float):
                says = f"below {exists:g}"
            print(f"| `{text}` | {says} | " + " | ".join(cells) + " |", file=page)
            print(f"{text:28} {says:26}", *cells, flush=True)
        print(f"\n{faults} of {len(POTENTIALS) * len(temperatures)} are faults.", file=page)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
