# SPDX-License-Identifier: BSL-1.0
"""Claims of the paper [li_lu_tao_ye_2023] beside what is measured, verdicts by rules, and the page of all."""
import dataclasses
import math
from typing import Dict, List, NamedTuple, Tuple, Union

import numpy as np


class Estimate(NamedTuple):
    """A number with its standard error; NaN or 0 where that is not known or there is none."""
    mean: float
    error: float = 0.0

    def __str__(self):
        """The error with two digits, and the value with as many places."""
        if not (self.error > 0 and math.isfinite(self.error)):
            return f"{self.mean:.5g}"
        places = 1 - math.floor(math.log10(self.error))
        if not 0 <= places <= 7 or abs(self.mean) >= 1e5:
            return f"{self.mean:.3g} +- {self.error:.1g}"
        return f"{self.mean:.{places}f} +- {self.error:.{places}f}"


def mean_of(samples):
    """Mean and standard error of those samples that are not NaN."""
    x = np.asarray(samples, dtype=float)
    x = x[~np.isnan(x)]
    return Estimate(float(x.mean()), float(x.std(ddof=1) / len(x) ** 0.5) if len(x) > 1 else math.nan)


def exponent(x, y):
    """Of y ~ x^exponent by least squares of logarithms, with the standard error of the residuals."""
    u, v = np.log(x), np.log(y)
    if len(u) < 2:
        return Estimate(0.0, 0.0)
    spread = np.sum((u - u.mean()) ** 2)
    slope = np.sum((u - u.mean()) * (v - v.mean())) / spread
    residuals = v - v.mean() - slope * (u - u.mean())
    error = math.sqrt(np.sum(residuals**2) / (len(u) - 2) / spread) if len(u) > 2 else math.nan
    return Estimate(float(slope), error)


def agrees(ours, printed, last_digit):
    """Whether a number that is printed to `last_digit` is ours: within half of that and two standard errors."""
    error = ours.error if math.isfinite(ours.error) else 0.0
    return abs(ours.mean - printed) <= 0.5 * last_digit + 2 * error + 1e-12  # rounding of numbers of order 1


@dataclasses.dataclass
class Claim:
    """One claim: as printed, what was measured, our number, whether it holds, and by which rule.

    Where the text can be read in several ways, `holds` has each by name and `choice` says in what they differ.
    `command` is that of nysalt which gives the number; empty: none alone does.
    """
    claim: str
    quantity: str
    ours: str
    holds: Union[bool, Dict[str, bool]]
    rule: str = ""
    choice: str = ""
    command: str = ""

    @property
    def verdict(self):
        outcomes = set(self.holds.values()) if isinstance(self.holds, dict) else {self.holds}
        if len(outcomes) > 1:
            return f"depends on {self.choice}"
        return "reproduced" if outcomes == {True} else "not reproduced"

    @property
    def reason(self):
        if not isinstance(self.holds, dict):
            return self.rule
        names = {said: ", ".join(name for name, one in self.holds.items() if one == (said == "holds"))
                 for said in ("holds", "fails")}
        summary = "; ".join(f"{said} for {those}" for said, those in names.items() if those)
        return f"{summary}; {self.rule}" if self.rule else summary


@dataclasses.dataclass
class Exhibit:
    """A table, figure or remark of the paper. Tables: (sentence, columns, rows, texts at the left); figures: (name,
    panels, (width, height), caption)."""
    title: str
    place: str
    claims: List[Claim]
    remarks: List[str] = dataclasses.field(default_factory=list)
    tables: List[Tuple] = dataclasses.field(default_factory=list)
    figures: List[Tuple] = dataclasses.field(default_factory=list)


def items(parts):
    """All claims in the order of the paper, as documents; parts: exhibits by the name of the part."""
    return [{"part": part, "exhibit": exhibit.title, "place": exhibit.place, "claim": one.claim, "quantity": one.quantity,
             "ours": one.ours, "verdict": one.verdict, "reason": one.reason, "command": one.command or None}
            for part, exhibits in parts.items() for exhibit in exhibits for one in exhibit.claims]
